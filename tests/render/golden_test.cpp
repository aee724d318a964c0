// Pictures are compared with pictures kept in tests/render/golden, with a tolerance for differences
// that an eye does not see. AYUMI_WRITE_GOLDEN=1 writes them anew; look at them before they are
// committed.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/render/clip.hpp"
#include "ayumi/render/texture.hpp"
#include "tests/render/box_robot.hpp"

namespace ayumi::test {
namespace {

namespace fs = std::filesystem;

struct Difference {
  double mean = 0;   ///< mean difference over the picture, of 255
  double share = 0;  ///< share of pixels that differ by more than 24 of 255
};

/// The mean of the 3 x 3 pixels around (x, y), since edges may move by a fraction of a pixel.
Eigen::Array3d softened(const Image& image, int x, int y) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const std::uint8_t* p = image.pixel(std::clamp(x + dx, 0, image.width - 1),
                                          std::clamp(y + dy, 0, image.height - 1));
      sum += Eigen::Array3d(p[0], p[1], p[2]);
    }
  return sum / 9;
}

Difference difference(const Image& a, const Image& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  Difference out;
  if (a.rgb.size() != b.rgb.size()) return {255, 1};
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const double worst = (softened(a, x, y) - softened(b, x, y)).abs().maxCoeff();
      out.mean += worst;
      out.share += worst > 24 ? 1 : 0;
    }
  const double pixels = double(a.width) * a.height;
  return {out.mean / pixels, out.share / pixels};
}

bool alike(const Image& a, const Image& b) {
  const Difference d = difference(a, b);
  return d.mean < 1.0 && d.share < 0.002;
}

Image read_picture(const fs::path& file) {
  std::vector<std::string> notes;
  const Texture texture = read_texture(file.string(), notes);
  Image image{texture.width, texture.height, {}};
  image.rgb.resize(size_t(3) * image.width * image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      std::copy_n(&texture.rgba[4 * (size_t(image.height - 1 - y) * image.width + x)], 3,
                  image.pixel(x, y));
  return image;
}

void expect_golden(const std::string& name, const Image& image) {
  const fs::path file = fs::path(AYUMI_SOURCE_DIR) / "tests/render/golden" / (name + ".png");
  if (std::getenv("AYUMI_WRITE_GOLDEN")) {
    fs::create_directories(file.parent_path());
    write_png(file, image);
    return;
  }
  ASSERT_TRUE(fs::exists(file)) << file;
  const Difference d = difference(image, read_picture(file));
  EXPECT_LT(d.mean, 1.0) << name;
  EXPECT_LT(d.share, 0.002) << name;
}

ClipOptions small() {
  ClipOptions options;
  options.picture.width = 320;
  options.picture.height = 180;
  return options;
}

/// A log in which HOAP-1 stands on the ground with bent knees, pushed from its right.
SimulationLog bent(const RobotModel& model) {
  SimulationLog log;
  log.controller = ControllerKind::dtad;
  log.provenance.pattern = "bent";
  log.joints = model.dof_names();
  log.result.outcome = Outcome::stands;
  SimulationSample s;
  s.state = model.rest_state();
  RobotData data(model);
  Eigen::Isometry3d sole = Eigen::Isometry3d::Identity();
  sole.translation() = Eigen::Vector3d(0, 0.039, 0);
  anchor_base(model, Side::left, sole, s.state, data);
  s.command_base = s.state.base;
  s.command_base.position.x() += 0.06;
  s.command_theta = s.torque = s.state.theta;
  s.cog = s.command_cog = data.cog;
  s.zmp = {data.cog.x(), -0.02, 0};
  s.reference_zmp = {data.cog.x(), 0.02, 0};
  s.fz = 9.80665 * model.mass();
  s.foot_force = {Eigen::Vector3d(0, 0, 0.4 * s.fz), Eigen::Vector3d(0, 2, 0.6 * s.fz)};
  s.foot_cop = {Eigen::Vector3d(0, 0.039, 0), Eigen::Vector3d(0, -0.039, 0)};
  s.push_force = {0, 55, 0};
  s.push_point = s.cog;
  log.samples.assign(20, s);
  return log;
}

TEST(Golden, Hoap1PushedWithAllMarks) {
  const RobotModel model =
      load_robot(std::string(AYUMI_SOURCE_DIR) + "/robots/hoap1", {}, {.meshes = true});
  const SimulationLog log = bent(model);
  ClipOptions options = small();
  options.ghost.command = true;
  expect_golden("hoap1_push", ClipRenderer(model, log, options).frame(0));
  options.ghost = {};
  options.camera.view = "back";
  options.overlay = no_marks();
  expect_golden("hoap1_back", ClipRenderer(model, log, options).frame(0));
}

TEST(Golden, BoxesAtSeveralInstants) {
  const RobotModel model = box_robot();
  const SimulationLog log = box_run(model);
  ClipOptions options = small();
  options.camera.mode = CameraMode::fixed;
  options.camera.view = "front";
  expect_golden("boxes_exposures", ClipRenderer(model, log, options).exposures({0.2, 0.5, 0.8}));
}

TEST(Golden, TheToleranceSeesAMissingLinkAndNotAFaintChange) {
  RobotModel model = box_robot();
  const SimulationLog log = box_run(model);
  const Image whole = ClipRenderer(model, log, small()).frame(0.5);
  RobotDescription headless = model.description();
  for (LinkDescription& link : headless.links)
    if (link.name == "head") link.visuals.clear();
  const RobotModel without(headless);
  EXPECT_FALSE(alike(whole, ClipRenderer(without, log, small()).frame(0.5)));
  Image faint = whole;
  for (std::uint8_t& byte : faint.rgb) byte = static_cast<std::uint8_t>(byte ^ 1);
  EXPECT_FALSE(whole.rgb == faint.rgb);
  EXPECT_TRUE(difference(whole, faint).mean <= 1.0);
}

}  // namespace
}  // namespace ayumi::test
