#include "ayumi/render/image.hpp"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"

namespace ayumi {
namespace {

using SurfacePointer = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using ContextPointer = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

// Largest width of a surface [pixel]. Definition: cairo makes no wider surface of an image.
constexpr double kWidestSurface = 32767;

SurfacePointer make_surface(cairo_format_t format, int width, int height) {
  SurfacePointer surface(cairo_image_surface_create(format, width, height), cairo_surface_destroy);
  require(cairo_surface_status(surface.get()) == CAIRO_STATUS_SUCCESS,
          "a picture could not be set up for drawing");
  return surface;
}

cairo_status_t append_bytes(void* target, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(target)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

void set_font(cairo_t* context, const TextStyle& style) {
  cairo_select_font_face(context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, style.size);
}

/// The text with its plate on a transparent surface just large enough for it.
SurfacePointer render_text(const std::string& text, const TextStyle& style) {
  const SurfacePointer scratch = make_surface(CAIRO_FORMAT_A8, 1, 1);
  const ContextPointer measure(cairo_create(scratch.get()), cairo_destroy);
  set_font(measure.get(), style);
  cairo_text_extents_t extents;
  cairo_font_extents_t font;
  cairo_text_extents(measure.get(), text.c_str(), &extents);
  cairo_font_extents(measure.get(), &font);
  const double pad = std::ceil(0.35 * style.size);
  // A name may have any length. The part that is cut off here would be outside every picture.
  const int width =
      static_cast<int>(std::min(kWidestSurface, std::ceil(extents.x_advance + 2 * pad)));
  const int height = static_cast<int>(std::ceil(font.ascent + font.descent + 0.4 * pad));
  SurfacePointer surface = make_surface(CAIRO_FORMAT_ARGB32, width, height);
  const ContextPointer context(cairo_create(surface.get()), cairo_destroy);
  cairo_set_source_rgba(context.get(), style.plate[0], style.plate[1], style.plate[2],
                        style.plate[3]);
  cairo_paint(context.get());
  set_font(context.get(), style);
  cairo_set_source_rgba(context.get(), style.color[0], style.color[1], style.color[2],
                        style.color[3]);
  cairo_move_to(context.get(), pad, std::round(0.2 * pad + font.ascent));
  cairo_show_text(context.get(), text.c_str());
  cairo_surface_flush(surface.get());
  return surface;
}

// Largest number of texts that are kept drawn. Chosen: more than one frame has. With half of the
// value, a legend of many marks is drawn anew for every frame; with twice, memory holds the times
// of past frames, which are never shown again.
constexpr size_t kMostTexts = 64;
// Number of bytes of the longest text that is kept. Chosen: the words of the legend have about 50;
// a longer title is shortened letter by letter, and all its lengths would displace the others.
constexpr size_t kLongestKept = 100;

/// Does the same as render_text(), but keeps the last results: the frames of a clip have the same
/// words, and the width of each text is asked for before it is drawn.
std::shared_ptr<cairo_surface_t> text_surface(const std::string& text, const TextStyle& style) {
  thread_local std::map<std::string, std::shared_ptr<cairo_surface_t>> kept;
  std::string key(reinterpret_cast<const char*>(&style.size), sizeof style.size);
  key += style.bold ? 'b' : ' ';
  for (const Eigen::Vector4f* color : {&style.color, &style.plate})
    key.append(reinterpret_cast<const char*>(color->data()), 4 * sizeof(float));
  key += text;
  const auto found = kept.find(key);
  if (found != kept.end()) return found->second;
  std::shared_ptr<cairo_surface_t> drawn = render_text(text, style);
  if (text.size() > kLongestKept) return drawn;
  if (kept.size() >= kMostTexts) kept.clear();
  return kept[key] = std::move(drawn);
}

/// Puts a premultiplied ARGB surface over the picture, with its top left corner at (left, top).
void compose(Image& image, cairo_surface_t* surface, int left, int top) {
  const int width = cairo_image_surface_get_width(surface);
  const int height = cairo_image_surface_get_height(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  const unsigned char* data = cairo_image_surface_get_data(surface);
  for (int y = std::max(0, -top); y < height && top + y < image.height; ++y) {
    for (int x = std::max(0, -left); x < width && left + x < image.width; ++x) {
      const unsigned char* source =
          data + size_t(y) * stride + 4 * x;  // the order is B G R A in memory
      std::uint8_t* target = image.pixel(left + x, top + y);
      for (int channel = 0; channel < 3; ++channel)
        target[channel] = static_cast<std::uint8_t>(
            std::min(255, source[2 - channel] + (target[channel] * (255 - source[3]) + 127) / 255));
    }
  }
}

}  // namespace

std::string encode_png(const Image& image) {
  require(image.width > 0 && image.height > 0 &&
              image.rgb.size() == size_t(3) * image.width * image.height,
          "a picture's bytes do not fit its size");
  const SurfacePointer surface = make_surface(CAIRO_FORMAT_RGB24, image.width, image.height);
  unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* source = image.pixel(x, y);
      unsigned char* target = data + size_t(y) * stride + 4 * x;
      target[0] = source[2];
      target[1] = source[1];
      target[2] = source[0];
    }
  }
  cairo_surface_mark_dirty(surface.get());
  std::string bytes;
  const cairo_status_t status =
      cairo_surface_write_to_png_stream(surface.get(), append_bytes, &bytes);
  require(status == CAIRO_STATUS_SUCCESS, "a picture could not be encoded as PNG");
  return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) {
  write_file(path, encode_png(image));
}

int drawn_width(const std::string& text, const TextStyle& style) {
  return text.empty() ? 0 : cairo_image_surface_get_width(text_surface(text, style).get());
}

int draw_text(Image& image, double x, double y, const std::string& text, const TextStyle& style) {
  if (text.empty()) return 0;
  const std::shared_ptr<cairo_surface_t> surface = text_surface(text, style);
  const int width = cairo_image_surface_get_width(surface.get());
  const int height = cairo_image_surface_get_height(surface.get());
  const double share = style.anchor == TextAnchor::left     ? 0.0
                       : style.anchor == TextAnchor::center ? 0.5
                                                            : 1.0;
  compose(image, surface.get(), static_cast<int>(std::lround(x - share * width)),
          static_cast<int>(std::lround(y - 0.5 * height)));
  return width;
}

}  // namespace ayumi
