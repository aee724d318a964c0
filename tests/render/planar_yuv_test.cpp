#include "ayumi/render/planar_yuv.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace ayumi {
namespace {

Image plain(int width, int height, std::array<std::uint8_t, 3> color) {
  Image image{width, height, {}};
  for (int i = 0; i < width * height; ++i)
    image.rgb.insert(image.rgb.end(), color.begin(), color.end());
  return image;
}

TEST(PlanarYuv, ColoursAreThoseOfTheStandard) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> byte(0, 255);
  for (int trial = 0; trial < 200; ++trial) {
    const std::array<std::uint8_t, 3> c = {std::uint8_t(byte(random)), std::uint8_t(byte(random)),
                                           std::uint8_t(byte(random))};
    std::vector<std::uint8_t> planes;
    to_yuv420(plain(4, 2, c), planes);
    ASSERT_EQ(planes.size(), 12u);
    const double luma = (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]) / 255;
    EXPECT_NEAR(planes[0], 16 + 219 * luma, 0.51);
    EXPECT_NEAR(planes[8], 128 + 112 * (c[2] / 255.0 - luma) / 0.9278, 0.51);
    EXPECT_NEAR(planes[10], 128 + 112 * (c[0] / 255.0 - luma) / 0.7874, 0.51);
  }
}

TEST(PlanarYuv, GreyHasNoColourAndTheRangeIsKept) {
  for (int grey = 0; grey < 256; ++grey) {
    std::vector<std::uint8_t> planes;
    const auto g = static_cast<std::uint8_t>(grey);
    to_yuv420(plain(2, 2, {g, g, g}), planes);
    EXPECT_EQ(planes[4], 128);
    EXPECT_EQ(planes[5], 128);
    if (grey == 0) {
      EXPECT_EQ(planes[0], 16);
    }
    if (grey == 255) {
      EXPECT_EQ(planes[0], 235);
    }
  }
}

TEST(PlanarYuv, PixelsStayInTheirPlaces) {
  Image image = plain(4, 4, {0, 0, 0});
  for (int channel = 0; channel < 3; ++channel) image.pixel(3, 2)[channel] = 255;
  image.pixel(0, 1)[0] = 255;
  std::vector<std::uint8_t> planes;
  to_yuv420(image, planes);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      EXPECT_EQ(planes[size_t(4 * y + x)], x == 3 && y == 2 ? 235 : x == 0 && y == 1 ? 63 : 16);
  EXPECT_EQ((std::vector<std::uint8_t>(planes.begin() + 16, planes.end())),
            (std::vector<std::uint8_t>{122, 128, 128, 128, 156, 128, 128, 128}));
}

// The bytes are compared with those of pictures of two pixels a side, which do not have eight
// pixels to be converted at once.
TEST(PlanarYuv, EightPixelsAtOnceGiveTheSameBytes) {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> byte(0, 255);
  for (const int width : {2, 8, 10, 12, 18, 26, 64}) {
    Image image = plain(width, 4, {0, 0, 0});
    for (std::uint8_t& value : image.rgb) value = static_cast<std::uint8_t>(byte(random));
    std::vector<std::uint8_t> planes;
    to_yuv420(image, planes);
    const size_t w = size_t(width), cb = 4 * w, cr = cb + w;
    for (size_t y = 0; y < 4; y += 2)
      for (size_t x = 0; x < w; x += 2) {
        Image small = plain(2, 2, {0, 0, 0});
        for (size_t row = 0; row < 2; ++row)
          std::copy_n(&image.rgb[3 * (w * (y + row) + x)], 6, &small.rgb[6 * row]);
        std::vector<std::uint8_t> expected;
        to_yuv420(small, expected);
        EXPECT_EQ(planes[w * y + x], expected[0]);
        EXPECT_EQ(planes[w * y + x + 1], expected[1]);
        EXPECT_EQ(planes[w * (y + 1) + x], expected[2]);
        EXPECT_EQ(planes[w * (y + 1) + x + 1], expected[3]);
        EXPECT_EQ(planes[cb + w / 2 * (y / 2) + x / 2], expected[4]);
        EXPECT_EQ(planes[cr + w / 2 * (y / 2) + x / 2], expected[5]);
      }
  }
}

}  // namespace
}  // namespace ayumi
