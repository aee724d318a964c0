#include "ayumi/render/snapshots.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "tests/render/box_robot.hpp"
#include "tests/support/error_message.hpp"

namespace ayumi::test {
namespace {

Image tile(int width, int height, std::uint8_t value) {
  return {width, height, std::vector<std::uint8_t>(size_t(3) * width * height, value)};
}

StripOptions small(int count) {
  StripOptions options;
  options.clip.picture.width = 64;
  options.clip.picture.height = 48;
  options.count = count;
  options.columns = 2;
  return options;
}

/// The made-up run without its push, because snapshots would gather around it.
SimulationLog unpushed(const RobotModel& model) {
  SimulationLog log = box_run(model);
  for (SimulationSample& sample : log.samples) sample.push_force.setZero();
  return log;
}

/// A part of a sheet.
Image cut(const Image& sheet, int left, int top, int width, int height) {
  Image out = tile(width, height, 0);
  for (int y = 0; y < height; ++y)
    std::copy_n(sheet.pixel(left, top + y), 3 * width, out.pixel(0, y));
  return out;
}

TEST(Strip, TilesLieInReadingOrder) {
  const Image sheet = draw_sheet({tile(4, 3, 10), tile(4, 3, 20), tile(4, 3, 30)}, 2);
  EXPECT_EQ(sheet.width, 8);
  EXPECT_EQ(sheet.height, 6);
  EXPECT_EQ(*sheet.pixel(0, 0), 10);
  EXPECT_EQ(*sheet.pixel(7, 2), 20);
  EXPECT_EQ(*sheet.pixel(3, 5), 30);
  EXPECT_EQ(*sheet.pixel(4, 3), 255) << "white where no tile is left";
  EXPECT_EQ(draw_sheet({tile(4, 3, 10)}, 9).width, 4) << "no more columns than tiles";
}

// There is one title above and one legend below all snapshots, which have no captions of their own.
TEST(Strip, IsASheetWithOneTitleAndOneLegend) {
  const RobotModel model = box_robot();
  const SimulationLog log = unpushed(model);
  StripOptions options = small(4);
  const Image sheet = draw_strip(model, log, options);
  options.clip.overlay.caption = false;
  const Image bare = draw_strip(model, log, options);
  EXPECT_EQ(bare.width, 128);
  EXPECT_EQ(bare.height, 96);
  EXPECT_EQ(sheet.width, bare.width);
  EXPECT_GT(sheet.height, bare.height + 20);
  EXPECT_EQ(sheet.pixel(127, sheet.height - 1)[0], 255) << "the legend stands on white";
  // In the snapshot itself, only the corner with its time differs.
  ClipRenderer renderer(model, log, small(4).clip);
  const Image title = tile(128, 40, 255);
  Image written = title;
  const int head = int(std::ceil(renderer.write_title(written, 0, 10, 1)));
  for (int y = 24; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      ASSERT_TRUE(
          std::equal(sheet.pixel(x, head + y), sheet.pixel(x, head + y) + 3, bare.pixel(x, y)))
          << x << " " << y;
}

// The robot is seen from any side, from near or far, in a posture or lying on the ground.
TEST(Strip, TheRobotFillsItsCells) {
  const RobotModel model = box_robot();
  SimulationLog log = unpushed(model);
  const auto part_of = [&](const std::string& view, int width, int height) {
    StripOptions options = small(1);
    options.clip.picture = {
        .width = width, .height = height, .antialias = false, .shadow = false, .ground = false};
    options.clip.overlay = no_marks();
    options.clip.camera.view = view;
    options.times = {0.2};
    const Image with = draw_strip(model, log, options);
    Eigen::AlignedBox2d box;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)  // the sky is the same along a row
        if (std::abs(int(with.pixel(x, y)[0]) - with.pixel(0, y)[0]) +
                std::abs(int(with.pixel(x, y)[1]) - with.pixel(0, y)[1]) >
            20)
          box.extend(Eigen::Vector2d(x, y));
    EXPECT_GT(box.min().minCoeff(), 0) << view << ": nothing is cut off";
    EXPECT_LT(box.max().x(), width - 1) << view;
    EXPECT_LT(box.max().y(), height - 1) << view;
    return std::max(box.sizes().x() / width, box.sizes().y() / height);
  };
  for (const std::string& view : view_names()) {
    EXPECT_GT(part_of(view, 80, 120), 0.8) << view;
    EXPECT_GT(part_of(view, 200, 60), 0.6) << view;
  }
  for (SimulationSample& s : log.samples) {
    s.state.base.attitude = Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitX());
    s.state.base.position.z() = s.cog.z() = 0.06;
  }
  EXPECT_GT(part_of("front", 80, 120), 0.8) << "fallen";
}

TEST(Strip, ChosenInstantsAreHeldWithinTheRun) {
  const RobotModel model = box_robot();
  const SimulationLog log = box_run(model);
  StripOptions options = small(0);
  options.clip.overlay.caption = false;
  options.times = {-1, 99};
  const Image strip = draw_strip(model, log, options);
  options.times = {0, 1};
  EXPECT_EQ(strip.rgb, draw_strip(model, log, options).rgb);
  EXPECT_NE(cut(strip, 0, 0, 64, 48).rgb, cut(strip, 64, 0, 64, 48).rgb);
}

TEST(Strip, SeveralInstantsInOnePicture) {
  const RobotModel model = box_robot();
  SimulationLog log = unpushed(model);
  for (size_t k = 0; k < log.samples.size(); ++k)  // the robot moves two metres sideways
    log.samples[k].state.base.position.y() = log.samples[k].cog.y() = 0.004 * double(k);
  StripOptions options = small(3);
  options.one_picture = true;
  options.clip.picture = {.width = 240, .height = 90, .shadow = false, .ground = false};
  options.clip.camera.view = "front";
  options.clip.overlay = no_marks();
  options.times = {0, 0.5, 1};
  const Image all = draw_strip(model, log, options);
  ASSERT_EQ(all.width, 240);
  // The robot walks to the right of the picture: there are three robots, and earlier ones are
  // further left and lighter.
  options.count = 1;
  options.times = {99};
  const Image last = draw_strip(model, log, options);
  std::array<int, 3> change = {0, 0, 0};
  for (int x = 0; x < 240; ++x)
    for (int y = 0; y < 90; ++y)
      for (int c = 0; c < 3; ++c) {
        int& most = change[size_t(x / 80)];
        most = std::max(most, std::abs(int(all.pixel(x, y)[c]) - int(last.pixel(x, y)[c])));
      }
  EXPECT_EQ(change[2], 0) << "the last one stands alone on the right";
  EXPECT_GT(change[1], 60) << "the middle one is there";
  EXPECT_GT(change[0], 40) << "and the first";
  EXPECT_LT(change[0], 0.85 * change[1]) << "lighter";
}

TEST(Strip, NothingAndTooMuchAreRefused) {
  const RobotModel model = box_robot();
  const SimulationLog log = box_run(model);
  EXPECT_THROW(draw_strip(model, log, small(0)), Error);
  EXPECT_THROW(draw_sheet({}, 3), Error);
  const auto refused = [&](int count, int columns) {
    StripOptions options = small(count);
    options.columns = columns;
    return error_message([&] { draw_strip(model, log, options); }, ErrorCode::usage);
  };
  EXPECT_EQ(refused(1'000'000'000, 4),
            "the number of snapshots is 1e+09; it must be from 1 to 400");
  EXPECT_EQ(refused(4, -1), "the number of columns is -1; it must be from 1 to 100");
  StripOptions wide = small(40);
  wide.columns = 40;
  wide.clip.picture.width = 1000;
  EXPECT_EQ(error_message([&] { draw_strip(model, log, wide); }, ErrorCode::usage),
            "a sheet of 40 pictures would have 40000 x 48 pixels; a sheet must have at least one "
            "picture, and at most 16384 pixels on each side");
  StripOptions one = small(0);
  one.one_picture = true;
  EXPECT_THROW(draw_strip(model, log, one), Error);
  one.count = 101;
  EXPECT_EQ(error_message([&] { draw_strip(model, log, one); }, ErrorCode::usage),
            "the number of postures is 101; it must be from 1 to 100");
  try {
    draw_sheet(std::vector<Image>(5, tile(4000, 1, 0)), 5);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("16384 pixels"), std::string::npos);
  }
}

}  // namespace
}  // namespace ayumi::test
