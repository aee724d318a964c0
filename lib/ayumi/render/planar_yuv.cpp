#include "ayumi/render/planar_yuv.hpp"

#include <array>

#include "ayumi/base/error.hpp"

// With R, G, B in 0..255 and L = 0.2126 R + 0.7152 G + 0.0722 B: Y = 16 + 219/255 L,
// Cb = 128 + 224/255 (B - L) / 1.8556, Cr = 128 + 224/255 (R - L) / 1.5748; whole numbers, 2^16 the
// unit. Of the sum of four pixels 2^18 is.

namespace ayumi {
namespace {

/// Shares of the luma. Source: ITU-R BT.709.
constexpr double kRed = 0.2126, kGreen = 0.7152, kBlue = 0.0722;

constexpr int unit(double share) {
  return static_cast<int>(share * 65536 + (share < 0 ? -0.5 : 0.5));
}
/// Weights of R, G, B; what they make of grey is exactly nothing for the two colours.
constexpr std::array<int, 3> kY = {unit(219.0 / 255 * kRed), unit(219.0 / 255 * kGreen),
                                   unit(219.0 / 255 * kBlue)};
/// Range of the colours over 2 (1 - kBlue) and 2 (1 - kRed). Source: ITU-R BT.709.
constexpr double kCbScale = 224.0 / 255 / 1.8556, kCrScale = 224.0 / 255 / 1.5748;
constexpr std::array<int, 3> kCb = {unit(-kCbScale * kRed), unit(-kCbScale* kGreen),
                                    -unit(-kCbScale* kRed) - unit(-kCbScale* kGreen)};
constexpr std::array<int, 3> kCr = {-unit(-kCrScale * kGreen) - unit(-kCrScale * kBlue),
                                    unit(-kCrScale* kGreen), unit(-kCrScale* kBlue)};

std::uint8_t luma(const std::uint8_t* p) {
  return static_cast<std::uint8_t>(
      (kY[0] * p[0] + kY[1] * p[1] + kY[2] * p[2] + (16 << 16) + (1 << 15)) >> 16);
}

std::uint8_t chroma(const std::array<int, 3>& weight, int r, int g, int b) {
  return static_cast<std::uint8_t>(
      (weight[0] * r + weight[1] * g + weight[2] * b + (128 << 18) + (1 << 17)) >> 18);
}

}  // namespace

void to_yuv420(const Image& image, std::vector<std::uint8_t>& planes) {
  const size_t width = static_cast<size_t>(image.width), height = static_cast<size_t>(image.height);
  require(width % 2 == 0 && height % 2 == 0, "video needs an even width and height");
  planes.resize(width * height * 3 / 2);
  std::uint8_t* cb = planes.data() + width * height;
  std::uint8_t* cr = cb + width * height / 4;
  for (size_t y = 0; y < height; y += 2) {
    const std::uint8_t *upper = &image.rgb[3 * width * y], *lower = upper + 3 * width;
    std::uint8_t* out = planes.data() + width * y;
    for (size_t x = 0; x < width; ++x) out[x] = luma(upper + 3 * x);
    for (size_t x = 0; x < width; ++x) out[width + x] = luma(lower + 3 * x);
    for (size_t x = 0; x < width; x += 2, upper += 6, lower += 6) {
      const int r = upper[0] + upper[3] + lower[0] + lower[3];
      const int g = upper[1] + upper[4] + lower[1] + lower[4];
      const int b = upper[2] + upper[5] + lower[2] + lower[5];
      *cb++ = chroma(kCb, r, g, b);
      *cr++ = chroma(kCr, r, g, b);
    }
  }
}

}  // namespace ayumi
