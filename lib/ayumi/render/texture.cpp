#include "ayumi/render/texture.hpp"

#include <cairo.h>
#include <jpeglib.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;
constexpr const char* kEmbedded = "data:";
// Largest number of pixels on an edge of the file's picture; larger pictures are refused to save
// memory.
constexpr int kMostPixels = 16384;

// ---- PNG

struct Reading {
  const std::string& bytes;
  size_t at = 0;
};

cairo_status_t read_some(void* closure, unsigned char* data, unsigned length) {
  auto& reading = *static_cast<Reading*>(closure);
  if (length > reading.bytes.size() - reading.at) return CAIRO_STATUS_READ_ERROR;
  std::memcpy(data, reading.bytes.data() + reading.at, length);
  reading.at += length;
  return CAIRO_STATUS_SUCCESS;
}

std::optional<Texture> decode_png(const std::string& bytes) {
  Reading reading{bytes};
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      cairo_image_surface_create_from_png_stream(read_some, &reading), cairo_surface_destroy);
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) return std::nullopt;
  const cairo_format_t format = cairo_image_surface_get_format(surface.get());
  if (format != CAIRO_FORMAT_ARGB32 && format != CAIRO_FORMAT_RGB24) return std::nullopt;
  Texture texture;
  texture.width = cairo_image_surface_get_width(surface.get());
  texture.height = cairo_image_surface_get_height(surface.get());
  texture.rgba.resize(size_t(4) * texture.width * texture.height);
  const int stride = cairo_image_surface_get_stride(surface.get());
  const unsigned char* data = cairo_image_surface_get_data(surface.get());
  for (int y = 0; y < texture.height; ++y)
    for (int x = 0; x < texture.width; ++x) {
      // Blue comes first, and colours are premultiplied.
      const unsigned char* from = data + size_t(y) * stride + 4 * x;
      std::uint8_t* to = &texture.rgba[4 * (size_t(texture.height - 1 - y) * texture.width + x)];
      const int alpha = format == CAIRO_FORMAT_ARGB32 ? from[3] : 255;
      for (int c = 0; c < 3; ++c)
        to[c] = static_cast<std::uint8_t>(alpha ? std::min(255, from[2 - c] * 255 / alpha) : 0);
      to[3] = static_cast<std::uint8_t>(alpha);
    }
  return texture;
}

// ---- JPEG

struct JpegErrors {
  jpeg_error_mgr manager;
  std::jmp_buf back;
};

void jump_back(j_common_ptr info) {
  std::longjmp(reinterpret_cast<JpegErrors*>(info->err)->back, 1);
}

/// Fills variables of its caller, because a jump out of this function runs no destructors.
bool decode_jpeg(const std::string& bytes, Texture& texture, std::vector<std::uint8_t>& row) {
  jpeg_decompress_struct info;
  JpegErrors errors;
  info.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = jump_back;
  errors.manager.output_message = [](j_common_ptr) {};
  if (setjmp(errors.back)) {
    jpeg_destroy_decompress(&info);
    return false;
  }
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&info, TRUE);
  if (info.image_width > kMostPixels || info.image_height > kMostPixels) {
    jpeg_destroy_decompress(&info);
    return false;
  }
  info.out_color_space = JCS_RGB;
  jpeg_start_decompress(&info);
  texture.width = static_cast<int>(info.output_width);
  texture.height = static_cast<int>(info.output_height);
  texture.rgba.assign(size_t(4) * texture.width * texture.height, 255);
  row.resize(size_t(3) * texture.width);
  while (info.output_scanline < info.output_height) {
    const int y = static_cast<int>(info.output_scanline);
    JSAMPROW line = row.data();
    jpeg_read_scanlines(&info, &line, 1);
    for (int x = 0; x < texture.width; ++x)
      std::copy_n(&row[size_t(3) * x], 3,
                  &texture.rgba[4 * (size_t(texture.height - 1 - y) * texture.width + x)]);
  }
  jpeg_finish_decompress(&info);
  jpeg_destroy_decompress(&info);
  return true;
}

/// A texture half as wide and high, in which each pixel is the mean of four.
Texture halved(const Texture& texture) {
  Texture out;
  out.width = std::max(1, texture.width / 2);
  out.height = std::max(1, texture.height / 2);
  out.rgba.resize(size_t(4) * out.width * out.height);
  const auto at = [&](int x, int y, int c) {
    x = std::min(x, texture.width - 1);
    y = std::min(y, texture.height - 1);
    return int(texture.rgba[4 * (size_t(y) * texture.width + x) + size_t(c)]);
  };
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      for (int c = 0; c < 4; ++c)
        out.rgba[4 * (size_t(y) * out.width + x) + size_t(c)] =
            static_cast<std::uint8_t>((at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c) +
                                       at(2 * x, 2 * y + 1, c) + at(2 * x + 1, 2 * y + 1, c) + 2) /
                                      4);
  return out;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// The file in the same folder whose name only differs by case; empty if there is none.
fs::path by_another_case(const fs::path& file) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(file.parent_path(), ignored))
    if (lower(entry.path().filename()) == lower(file.filename())) return entry.path();
  return {};
}

}  // namespace

std::string texture_bytes(const std::string& file, std::vector<std::string>& notes) {
  if (file.starts_with(kEmbedded)) return file.substr(std::strlen(kEmbedded));
  fs::path path = file;
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) {
    const fs::path other = by_another_case(path);
    if (other.empty()) {
      notes.push_back("texture " + file + ": there is no such file; the surface is drawn white");
      return "";
    }
    notes.push_back("texture " + file + ": there is no such file, so Ayumi uses " +
                    other.filename().string() +
                    ", whose name differs only in upper and lower case");
    path = other;
  }
  try {
    return read_file(path, size_t{256} << 20);
  } catch (const Error& error) {
    notes.push_back(std::string("texture ") + error.what() + "; the surface is drawn white");
    return "";
  }
}

Texture read_texture(const std::string& file, std::vector<std::string>& notes) {
  const std::string bytes = texture_bytes(file, notes);
  if (bytes.empty()) return {};
  std::optional<Texture> texture;
  if (bytes.starts_with("\x89PNG")) {
    texture = decode_png(bytes);
  } else if (bytes.starts_with("\xff\xd8")) {
    Texture jpeg;
    std::vector<std::uint8_t> row;
    if (decode_jpeg(bytes, jpeg, row)) texture = std::move(jpeg);
  }
  if (!texture) {
    const bool embedded = file.starts_with(kEmbedded);
    notes.push_back("texture " + (embedded ? "inside a mesh file" : file) +
                    ": the picture cannot be read as PNG or JPEG; the surface is drawn white");
    return {};
  }
  while (std::max(texture->width, texture->height) > kLargestTexture) *texture = halved(*texture);
  return std::move(*texture);
}

}  // namespace ayumi
