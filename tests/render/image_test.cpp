#include "ayumi/render/image.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"

namespace ayumi {
namespace {

Image white(int width, int height) {
  return {width, height, std::vector<std::uint8_t>(size_t(3) * width * height, 255)};
}

int dark_pixels(const Image& image, int from_x, int to_x) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = from_x; x < to_x; ++x) count += image.pixel(x, y)[0] < 128;
  return count;
}

TEST(Image, TextIsDrawnWhereItsAnchorSays) {
  Image left = white(200, 40), right = white(200, 40);
  const int width = draw_text(left, 100, 20, "1.1 N s", {.size = 16});
  draw_text(right, 100, 20, "1.1 N s", {.size = 16, .anchor = TextAnchor::right});
  EXPECT_GT(width, 40);
  EXPECT_LT(width, 100);
  EXPECT_GT(dark_pixels(left, 100, 200), 60);
  EXPECT_EQ(dark_pixels(left, 0, 100), 0);
  EXPECT_EQ(dark_pixels(right, 0, 100), dark_pixels(left, 100, 200));
  EXPECT_EQ(dark_pixels(right, 100, 200), 0);
}

TEST(Image, DifferentTextDiffers) {
  Image a = white(100, 30), b = white(100, 30);
  draw_text(a, 0, 15, "t = 1.234 s", {.size = 12});
  draw_text(b, 0, 15, "t = 1.235 s", {.size = 12});
  EXPECT_NE(a.rgb, b.rgb);
}

// In an earlier version, the name of a pattern of 5000 letters ended `run` and `report` with an
// internal error.
TEST(Image, TextOfAnyLengthIsCutOffToo) {
  Image image = white(40, 20);
  draw_text(image, 0, 10, std::string(100'000, 'n'), {});
  EXPECT_GT(dark_pixels(image, 0, 40), 40);
}

TEST(Image, TextOutsideIsCutOff) {
  Image image = white(50, 20);
  draw_text(image, -1000, 10, "far away", {});
  draw_text(image, 10, 1000, "far away", {});
  EXPECT_EQ(image.rgb, white(50, 20).rgb);
  draw_text(image, -10, 0, "across the corner", {});
  draw_text(image, 45, 20, "across the corner", {});
  EXPECT_NE(image.rgb, white(50, 20).rgb);
}

TEST(Image, PngHasSizeAndSameBytes) {
  Image image = white(17, 5);
  image.pixel(3, 2)[1] = 0;
  const std::string bytes = encode_png(image);
  ASSERT_GT(bytes.size(), 24u);
  EXPECT_EQ(bytes.substr(1, 3), "PNG");
  EXPECT_EQ(bytes[19], 17);
  EXPECT_EQ(bytes[23], 5);
  EXPECT_EQ(encode_png(image), bytes);
}

TEST(Image, AMissingFolderIsNamed) {
  try {
    write_png("/nowhere/at/all/x.png", white(2, 2));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_file);
    EXPECT_NE(std::string(error.what()).find("/nowhere/at/all does not exist"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace ayumi
