#pragma once
// A picture in memory, the text written onto it, and its PNG file.

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace ayumi {

/// A picture in sRGB, with 8 bits per channel, rows from the top and no padding.
struct Image {
  int width = 0, height = 0;      ///< size [pixel]
  std::vector<std::uint8_t> rgb;  ///< 3 width height bytes

  const std::uint8_t* pixel(int x, int y) const { return &rgb[3 * (size_t(y) * width + x)]; }
  std::uint8_t* pixel(int x, int y) { return &rgb[3 * (size_t(y) * width + x)]; }
};

/// The bytes of a PNG file.
std::string encode_png(const Image& image);

/// A picture as the content of a PNG file.
struct PngPicture {
  int width, height;  ///< size [pixel]
  std::string bytes;
};

/// Writes the file whole or not at all. Throws Error(bad_file) with the path and the reason.
void write_png(const std::filesystem::path& path, const Image& image);

enum class TextAnchor { left, center, right };

struct TextStyle {
  double size = 16;  ///< font size [pixel]
  bool bold = false;
  TextAnchor anchor = TextAnchor::left;
  Eigen::Vector4f color = {0.1f, 0.1f, 0.12f, 1.0f};  ///< sRGB and alpha
  /// Box behind the text; there is none with alpha 0.
  Eigen::Vector4f plate = {1.0f, 1.0f, 1.0f, 0.0f};
};

/// The width that draw_text() takes for this text [pixel].
int drawn_width(const std::string& text, const TextStyle& style);

/// Writes one line of text. (x, y) is its anchor on the vertical middle of the line [pixel]. Parts
/// outside the picture are left out. Returns the width that the text takes [pixel].
int draw_text(Image& image, double x, double y, const std::string& text, const TextStyle& style);

}  // namespace ayumi
