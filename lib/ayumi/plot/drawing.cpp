#include "ayumi/plot/drawing.hpp"

#include <cairo.h>

#include <cmath>
#include <memory>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {
namespace {

constexpr const char* kFont = "DejaVu Sans";

using SurfacePointer = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using ContextPointer = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

std::string number(double value) {
  std::string digits = text::fixed(value, 2);
  while (digits.back() == '0') digits.pop_back();
  if (digits.back() == '.') digits.pop_back();
  return digits == "-0" ? "0" : digits;
}

std::string hex(const Eigen::Vector4f& color) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string out = "#";
  for (int i = 0; i < 3; ++i) {
    const long byte = std::lround(255 * color[i]);
    out += {kDigits[byte / 16], kDigits[byte % 16]};
  }
  return out;
}

/// The attributes of a colour, such as fill="#rrggbb" fill-opacity="0.5".
std::string paint(const std::string& what, const Eigen::Vector4f& color) {
  if (color[3] <= 0) return " " + what + "=\"none\"";
  std::string out = " " + what + "=\"" + hex(color) + "\"";
  if (color[3] < 1) out += " " + what + "-opacity=\"" + number(color[3]) + "\"";
  return out;
}

std::string svg_of(const DrawnPath& path) {
  std::string out = path.closed ? "<polygon points=\"" : "<polyline points=\"";
  for (size_t i = 0; i < path.points.size(); ++i)
    out += number(path.points[i].x()) + "," + number(path.points[i].y()) +
           (i + 1 < path.points.size() ? " " : "");
  out += '"';
  out += paint("fill", path.fill) + paint("stroke", path.stroke);
  if (path.stroke[3] > 0) out += " stroke-width=\"" + number(path.width) + "\"";
  if (!path.dashes.empty()) {
    out += " stroke-dasharray=\"";
    for (size_t i = 0; i < path.dashes.size(); ++i)
      out += number(path.dashes[i]) + (i + 1 < path.dashes.size() ? " " : "");
    out += "\"";
  }
  return out + "/>\n";
}

std::string svg_of(const DrawnText& text) {
  const std::string x = number(text.position.x()), y = number(text.position.y());
  std::string out = "<text x=\"" + x + "\" y=\"" + y + "\" font-size=\"" + number(text.size) + "\"";
  if (text.anchor != TextAnchor::left)
    out += text.anchor == TextAnchor::center ? " text-anchor=\"middle\"" : " text-anchor=\"end\"";
  if (text.bold) out += " font-weight=\"bold\"";
  if (text.upwards) out += " transform=\"rotate(-90 " + x + " " + y + ")\"";
  return out + paint("fill", text.color) + ">" + escaped(text.text) + "</text>\n";
}

void set_color(cairo_t* context, const Eigen::Vector4f& color) {
  cairo_set_source_rgba(context, color[0], color[1], color[2], color[3]);
}

void set_font(cairo_t* context, double size, bool bold) {
  cairo_select_font_face(context, kFont, CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, size);
}

void draw(cairo_t* context, const DrawnPath& path) {
  if (path.points.empty()) return;
  cairo_new_path(context);
  for (const Eigen::Vector2d& point : path.points) cairo_line_to(context, point.x(), point.y());
  if (path.closed) cairo_close_path(context);
  if (path.fill[3] > 0) {
    set_color(context, path.fill);
    cairo_fill_preserve(context);
  }
  if (path.stroke[3] > 0) {
    set_color(context, path.stroke);
    cairo_set_line_width(context, path.width);
    cairo_set_dash(context, path.dashes.data(), static_cast<int>(path.dashes.size()), 0);
    cairo_stroke_preserve(context);
  }
  cairo_new_path(context);
}

void draw(cairo_t* context, const DrawnText& text) {
  set_font(context, text.size, text.bold);
  cairo_text_extents_t extents;
  cairo_text_extents(context, text.text.c_str(), &extents);
  const double share = text.anchor == TextAnchor::left     ? 0.0
                       : text.anchor == TextAnchor::center ? 0.5
                                                           : 1.0;
  cairo_save(context);
  cairo_translate(context, text.position.x(), text.position.y());
  if (text.upwards) cairo_rotate(context, -std::acos(-1.0) / 2);
  cairo_move_to(context, -share * extents.x_advance, 0);
  set_color(context, text.color);
  cairo_show_text(context, text.text.c_str());
  cairo_restore(context);
}

}  // namespace

DrawnPath filled_box(const Eigen::Vector2d& corner, const Eigen::Vector2d& opposite,
                     const Eigen::Vector4f& color) {
  return {.points = {corner, {opposite.x(), corner.y()}, opposite, {corner.x(), opposite.y()}},
          .closed = true,
          .stroke = {0, 0, 0, 0},
          .fill = color};
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (static_cast<unsigned char>(c) >= 0x20 || c == '\n')
      out += c;
  }
  return out;
}

double text_width(const std::string& text, double size, bool bold) {
  const SurfacePointer scratch(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1),
                               cairo_surface_destroy);
  const ContextPointer context(cairo_create(scratch.get()), cairo_destroy);
  set_font(context.get(), size, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(context.get(), text.c_str(), &extents);
  return extents.x_advance;
}

std::string to_svg(const Drawing& drawing) {
  const std::string width = number(drawing.width), height = number(drawing.height);
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
      width + "\" height=\"" + height + "\" viewBox=\"0 0 " + width + " " + height +
      "\" role=\"img\" font-family=\"" + kFont + ", Verdana, sans-serif\">\n";
  out += "<title>" + escaped(drawing.title) + "</title>\n";
  out += "<desc>" + escaped(drawing.description) + "</desc>\n";
  out += "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  for (const auto& item : drawing.items)
    out += std::visit([](const auto& drawn) { return svg_of(drawn); }, item);
  return out + "</svg>\n";
}

Image to_image(const Drawing& drawing, double scale) {
  Image image;
  image.width = static_cast<int>(std::ceil(drawing.width * scale));
  image.height = static_cast<int>(std::ceil(drawing.height * scale));
  if (!(scale > 0) || image.width < 1 || image.height < 1 || image.width > 16384 ||
      image.height > 16384)
    fail(ErrorCode::usage, "plot size " + std::to_string(image.width) + "x" +
                               std::to_string(image.height) +
                               ": each edge must be 1 to 16384 pixels");
  const SurfacePointer surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height),
      cairo_surface_destroy);
  const ContextPointer context(cairo_create(surface.get()), cairo_destroy);
  cairo_set_source_rgb(context.get(), 1, 1, 1);
  cairo_paint(context.get());
  cairo_scale(context.get(), scale, scale);
  cairo_set_line_join(context.get(), CAIRO_LINE_JOIN_ROUND);
  for (const auto& item : drawing.items)
    std::visit([&](const auto& drawn) { draw(context.get(), drawn); }, item);
  cairo_surface_flush(surface.get());
  const unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  image.rgb.resize(size_t(3) * image.width * image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int channel = 0; channel < 3; ++channel)
        image.pixel(x, y)[channel] = data[size_t(y) * stride + 4 * x + 2 - channel];
  return image;
}

void write_drawing(const std::filesystem::path& path, const Drawing& drawing, double png_scale) {
  if (path.extension() == ".svg")
    write_file(path, to_svg(drawing));
  else if (path.extension() == ".png")
    write_png(path, to_image(drawing, png_scale));
  else
    fail(ErrorCode::usage, {path.string()},
         "the format '" + path.extension().string() + "' is not one of .svg, .png");
}

}  // namespace ayumi
