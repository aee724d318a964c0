#include "sign_test_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/encoder_angles.hpp"
#include "ayumi/render/clip.hpp"

namespace ayumi::app {

namespace {

// Angle by which a joint is drawn away from its first angle [rad]. Chosen: the 5 degrees of the
// test itself would hardly be visible in a picture.
constexpr double kDrawnAngle = 30 * EIGEN_PI / 180;
constexpr double kDrawnSlide = 0.05;  // distance of a drawn sliding joint from its start [m]

// Distance from the middle of the robot beyond which a joint belongs to one side [m]. Chosen: far
// less than the distance between two legs.
constexpr double kBeside = 0.005;

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

struct View {
  const char* name = "iso";  ///< camera of the picture
  double turn = 0;         ///< angle by which the robot is turned to the left for this camera [rad]
  const char* words = "";  ///< place of the camera, as seen from the robot
  std::string motion = {};  ///< the direction in which a turning joint moves in the picture
};

/// The best view. A rotation is seen best along its axis; from above, the trunk would hide the
/// legs. A joint of the left side is seen from the left, because the right side would hide it.
View view_of(const RobotModel& model, const SignTest& test) {
  RobotState state = model.rest_state();
  state.theta = test.table.rows.front().theta;
  RobotData data(model);
  update_positions(model, state, data);
  const auto body = static_cast<size_t>(model.dofs()[static_cast<size_t>(test.dof)].body);
  const Eigen::Vector3d axis = data.rotation[body] * model.bodies()[body].axis,
                        along = axis.cwiseAbs();
  const bool left = data.position[body].y() > kBeside;
  View view;
  Eigen::Vector3d towards;  // direction to the observer for whom the sense of rotation is stated
  std::string where = "seen from the ";
  if (along.z() > std::max(along.x(), along.y())) {
    // The camera "iso" stands to the right of the robot, by 50 degrees from its front.
    view = left ? View{"iso", -100 * EIGEN_PI / 180, "front left"} : View{"iso", 0, "front right"};
    towards = Eigen::Vector3d::UnitZ();
    where = "seen from above";
  } else if (along.x() > along.y()) {
    view = {"front", 0, "front"};
    towards = Eigen::Vector3d::UnitX();
    where += view.words;
  } else {
    view = left ? View{"side", -EIGEN_PI, "left"} : View{"side", 0, "right"};
    towards = (left ? 1 : -1) * Eigen::Vector3d::UnitY();
    where += view.words;
  }
  const Dof& dof = model.dofs()[static_cast<size_t>(test.dof)];
  const double turns = axis.dot(towards) * (test.to - test.from);
  if (!dof.prismatic && turns != 0)
    view.motion = (turns > 0 ? "counterclockwise " : "clockwise ") + where;
  return view;
}

std::string counts_words(const Dof& dof, const SignTest& test, double zero) {
  if (dof.encoder.device < 1) return "";
  const double scale = dof.encoder.counts_per_degree * 180 / EIGEN_PI;
  return text::fixed((test.from - zero) * scale + 0.0, 0) + " to " +  // not "-0"
         text::fixed((test.to - zero) * scale + 0.0, 0);
}

}  // namespace

std::string sign_test_words(const RobotModel& model, const std::vector<SignTest>& tests) {
  const Eigen::VectorXd& start = tests.front().table.rows.front().theta;
  const Eigen::VectorXd zeros = encoder_zeros(model);
  std::string bent;
  for (const SignTest& test : tests) {
    const Dof& dof = model.dofs()[static_cast<size_t>(test.dof)];
    if (start[test.dof] != zeros[test.dof])
      bent += (bent.empty() ? "" : ", ") + dof.name + " (" + in_units(dof, start[test.dof]) + ")";
  }
  if (bent.empty())
    return "Every test begins and ends with all joints at 0. A target of 0 means the encoder "
           "count 0, whatever the sign of the joint is. So a joint with a wrong sign does not jump "
           "when a test begins.";
  return "Caution: these joints do not begin at 0: " + bent +
         ". When a test begins, each of these joints whose sign is wrong jumps to the opposite "
         "angle.";
}

std::string sign_test_view(const RobotModel& model, const SignTest& test) {
  return view_of(model, test).words;
}

Image sign_test_picture(const RobotModel& model, const SignTest& test) {
  const Dof& dof = model.dofs()[static_cast<size_t>(test.dof)];
  SimulationLog log;
  log.joints = model.dof_names();
  log.dt = 1;
  RobotState state = model.rest_state();
  state.theta = test.table.rows.front().theta;
  RobotData data(model);
  update_positions(model, state, data);
  if (model.has_soles()) anchor_base(model, Side::left, Eigen::Isometry3d::Identity(), state, data);
  const View view = view_of(model, test);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(view.turn, Eigen::Vector3d::UnitZ()));
  state.base = {turn * state.base.position, turn * state.base.attitude};
  log.samples.push_back(hanging(model, state));
  const double factor = drawn_factor(dof, test);
  state.theta[test.dof] += factor * (test.to - test.from);
  log.samples.push_back(hanging(model, state));
  ClipOptions options;
  options.picture.width = options.picture.height = 640;
  options.picture.ground = options.picture.shadow = false;
  options.camera.view = view.name;
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
  draw_text(image, 16, 616,
            "seen from: " + std::string(view.words) +
                (view.motion.empty() ? "" : ". The joint turns " + view.motion),
            {.size = 14, .plate = {1, 1, 1, 0.8F}});
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
      "</h1>\n<p>Hang the robot up so that its feet are free. While the motors are off, move the "
      "robot by hand to the pale posture. Then switch the motors on and play one file at a time. "
      "The joint has to move from the pale posture to the posture in full colour, and back. If the "
      "joint moves the other way, stop the motion, and change the sign of its "
      "<code>counts_per_degree</code> in the sidecar. If another joint moves, change the "
      "<code>device</code> of the joint that should move. The pictures show the motion larger than "
      "it is.</p>\n<p>" +
      sign_test_words(model, tests) + "</p>\n";
  const Eigen::VectorXd zeros = encoder_zeros(model);
  for (const SignTest& test : tests) {
    const Dof& dof = model.dofs()[static_cast<size_t>(test.dof)];
    const std::string counts = counts_words(dof, test, zeros[test.dof]),
                      motion = view_of(model, test).motion;
    page += "<figure><img src=\"" + test.name + ".png\" alt=\"" + dof.name + "\"><figcaption><b>" +
            test.name + extension + "</b><br>" + dof.name + ": " + in_units(dof, test.from) +
            " to " + in_units(dof, test.to) + (motion.empty() ? "" : ",<br>" + motion) +
            (counts.empty()
                 ? ""
                 : "<br>device " + std::to_string(dof.encoder.device) + ", counts " + counts) +
            "<br>moved this way: &#9744; yes &#9744; no</figcaption></figure>\n";
  }
  return page + "</body></html>\n";
}

}  // namespace ayumi::app
