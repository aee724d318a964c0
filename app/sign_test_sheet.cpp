#include "sign_test_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/render/clip.hpp"

namespace ayumi::app {

namespace {

// Angle by which a joint is drawn away from home [rad]. Chosen: the 5 degrees of the test itself
// would hardly be visible in a picture.
constexpr double kDrawnAngle = 30 * EIGEN_PI / 180;
constexpr double kDrawnSlide = 0.05;  // distance of a drawn sliding joint from home [m]

std::string in_units(const Dof& dof, double value) {
  return dof.prismatic ? text::fixed(1000 * value, 1) + " mm"
                       : text::fixed(value * 180 / EIGEN_PI, 1) + " deg";
}

double drawn_factor(const Dof& dof, const SignTest& test) {
  const double change = std::abs(test.to - test.from);
  return change > 0 ? (dof.prismatic ? kDrawnSlide : kDrawnAngle) / change : 1;
}

SimulationSample hanging(const RobotModel& model, const RobotState& state) {
  SimulationSample sample;
  sample.state = state;
  RobotData data(model);
  update_positions(model, state, data);
  sample.cog = data.cog;
  sample.torque = sample.command_theta = state.theta;
  return sample;
}

/// The best view. A rotation is seen best along its axis; from above, the trunk would hide the
/// legs.
std::string view_of(const RobotModel& model, const SignTest& test, const RobotState& state) {
  RobotData data(model);
  update_positions(model, state, data);
  const auto body = static_cast<size_t>(model.dofs()[static_cast<size_t>(test.dof)].body);
  const Eigen::Vector3d axis = (data.rotation[body] * model.bodies()[body].axis).cwiseAbs();
  if (axis.z() > std::max(axis.x(), axis.y())) return "iso";
  return axis.x() > axis.y() ? "front" : "side";
}

std::string counts_words(const Dof& dof, const SignTest& test) {
  if (dof.encoder.device < 1) return "";
  const double scale = dof.encoder.counts_per_degree * 180 / EIGEN_PI;
  return text::fixed(test.from * scale, 0) + " to " + text::fixed(test.to * scale, 0);
}

}  // namespace

Image sign_test_picture(const RobotModel& model, const SignTest& test) {
  const Dof& dof = model.dofs()[static_cast<size_t>(test.dof)];
  SimulationLog log;
  log.joints = model.dof_names();
  log.dt = 1;
  RobotState state = model.rest_state();
  RobotData data(model);
  update_positions(model, state, data);
  if (model.has_soles()) anchor_base(model, Side::left, Eigen::Isometry3d::Identity(), state, data);
  log.samples.push_back(hanging(model, state));
  const std::string view = view_of(model, test, state);
  const double factor = drawn_factor(dof, test);
  state.theta[test.dof] += factor * (test.to - test.from);
  log.samples.push_back(hanging(model, state));
  ClipOptions options;
  options.picture.width = options.picture.height = 640;
  options.picture.ground = options.picture.shadow = false;
  options.camera.view = view;
  options.camera.mode = CameraMode::fixed;
  OverlayOptions& marks = options.overlay;
  marks.cog = marks.zmp = marks.reference_zmp = marks.support = marks.forces = marks.push = false;
  marks.trails = marks.caption = false;
  Image image = ClipRenderer(model, log, options).exposures({0, 1});
  draw_text(image, 16, 24, test.name, {.size = 22, .bold = true, .plate = {1, 1, 1, 0.8F}});
  draw_text(image, 16, 52,
            "pale: " + in_units(dof, test.from) + ", full colour: " + in_units(dof, test.to),
            {.size = 16, .plate = {1, 1, 1, 0.8F}});
  draw_text(image, 16, 76, "the picture enlarges the motion " + text::brief(factor, 2) + " times",
            {.size = 16, .plate = {1, 1, 1, 0.8F}});
  draw_text(image, 16, 616, "seen from: " + view, {.size = 14, .plate = {1, 1, 1, 0.8F}});
  return image;
}

std::string sign_test_page(const RobotModel& model, const std::vector<SignTest>& tests,
                           const std::string& extension) {
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Sign test of " +
      model.name() +
      "</title>\n<style>body{font:16px sans-serif;max-width:60em;margin:2em auto}"
      "figure{display:inline-block;width:18em;margin:1em;vertical-align:top}"
      "img{width:100%}</style></head><body>\n<h1>Sign test of " +
      model.name() +
      "</h1>\n<p>Hang the robot up so that its feet are free, and bring it to its home posture. "
      "Play one file at a time. The joint has to move from the pale posture to the posture in full "
      "colour, and back. If the joint moves the other way, change the sign of its "
      "<code>counts_per_degree</code> in the sidecar. If another joint moves, change the "
      "<code>device</code> of the joint that should move. The pictures show the motion larger than "
      "it is.</p>\n";
  for (const SignTest& test : tests) {
    const Dof& dof = model.dofs()[static_cast<size_t>(test.dof)];
    const std::string counts = counts_words(dof, test);
    page += "<figure><img src=\"" + test.name + ".png\" alt=\"" + dof.name + "\"><figcaption><b>" +
            test.name + extension + "</b><br>" + dof.name + ": " + in_units(dof, test.from) +
            " to " + in_units(dof, test.to) +
            (counts.empty()
                 ? ""
                 : "<br>device " + std::to_string(dof.encoder.device) + ", counts " + counts) +
            "<br>moved this way: &#9744; yes &#9744; no</figcaption></figure>\n";
  }
  return page + "</body></html>\n";
}

}  // namespace ayumi::app
