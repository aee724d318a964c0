#pragma once
// A picture in memory, the text written onto it, and its PNG file.

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace ayumi {

/// sRGB, 8 bits per channel, rows from the top, no padding.
struct Image {
  int width = 0, height = 0;      ///< [pixel]
  std::vector<std::uint8_t> rgb;  ///< 3 width height

  const std::uint8_t* pixel(int x, int y) const { return &rgb[3 * (size_t(y) * width + x)]; }
  std::uint8_t* pixel(int x, int y) { return &rgb[3 * (size_t(y) * width + x)]; }
};

/// The bytes of a PNG file.
std::string encode_png(const Image& image);

/// Whole or not at all. Throws Error(bad_file) naming the path and the reason.
void write_png(const std::filesystem::path& path, const Image& image);

enum class TextAnchor { left, center, right };

struct TextStyle {
  double size = 16;  ///< font size [pixel]
  bool bold = false;
  TextAnchor anchor = TextAnchor::left;
  Eigen::Vector4f color = {0.1f, 0.1f, 0.12f, 1.0f};  ///< sRGB and alpha
  Eigen::Vector4f plate = {1.0f, 1.0f, 1.0f, 0.0f};   ///< box behind the text; alpha 0: none
};

/// Width that draw_text takes for it [pixel].
int drawn_width(const std::string& text, const TextStyle& style);

/// Writes one line of text; (x, y) is its anchor on the vertical middle of the line [pixel]. Parts
/// outside the picture are left out. Returns the width it takes [pixel].
int draw_text(Image& image, double x, double y, const std::string& text, const TextStyle& style);

}  // namespace ayumi
