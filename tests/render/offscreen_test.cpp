#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "ayumi/base/error.hpp"
#include "ayumi/render/clip.hpp"
#include "ayumi/render/offscreen_context.hpp"
#include "tests/render/box_robot.hpp"

namespace ayumi::test {
namespace {

bool has(Offscreen way) {
  const std::vector<Offscreen> ways = offscreen_ways();
  return std::find(ways.begin(), ways.end(), way) != ways.end();
}

/// The picture is drawn on a thread of its own, because the two ways share OpenGL's notion of the
/// current context.
Image picture(Offscreen way) {
  Image image;
  std::thread([&] {
    const RobotModel model = box_robot();
    const SimulationLog log = box_run(model);
    ClipOptions options;
    options.picture.width = 320;
    options.picture.height = 180;
    options.picture.way = way;
    image = ClipRenderer(model, log, options).frame(0.35);
  }).join();
  return image;
}

TEST(Offscreen, BothWaysGiveTheSamePicture) {
  for (const Offscreen way : {Offscreen::osmesa, Offscreen::egl})
    if (!has(way)) GTEST_SKIP() << "this build has only one way to draw off-screen";
  const Image mesa = picture(Offscreen::osmesa), egl = picture(Offscreen::egl);
  ASSERT_EQ(mesa.rgb.size(), egl.rgb.size());
  double sum = 0;
  int apart = 0;
  for (size_t i = 0; i < mesa.rgb.size(); ++i) {
    const int d = std::abs(int(mesa.rgb[i]) - int(egl.rgb[i]));
    sum += d;
    apart += d > 8 ? 1 : 0;
  }
  EXPECT_LT(sum / double(mesa.rgb.size()), 0.2);
  EXPECT_LT(apart, int(mesa.rgb.size() / 500));
  EXPECT_EQ(egl.rgb, picture(Offscreen::egl).rgb) << "the same bytes again";
}

TEST(Offscreen, AWayThatIsNotThereIsNamed) {
  for (const Offscreen way : {Offscreen::osmesa, Offscreen::egl}) {
    if (has(way)) continue;
    try {
      OffscreenContext context(way);
      FAIL();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("built without"), std::string::npos);
    }
  }
  EXPECT_FALSE(offscreen_ways().empty());
}

}  // namespace
}  // namespace ayumi::test
