#pragma once
// Marks that a picture shows besides the robot: COG, ZMP, reference ZMP, support polygon, contact
// forces, pushes, trails. Each has its own colour and shape, so that they can be distinguished
// without colours.

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/render/log_reading.hpp"
#include "ayumi/render/triangles.hpp"

namespace ayumi {

struct OverlayOptions {
  bool cog = true;            ///< the COG as a sphere, a plumb line and a cross on the ground
  bool zmp = true;            ///< the ZMP as a disc
  bool reference_zmp = true;  ///< the reference ZMP as a ring
  bool support = true;        ///< hull of the soles of the planned contact feet
  bool forces = true;         ///< arrow per foot
  bool push = true;           ///< arrow with its value
  bool trails = true;         ///< trails of COG (on the ground) and ZMP
  bool model = false;         ///< outlines of the soles, axes of the joints, arrow ahead
  /// Bodies whose joint is near a limit are amber, and those at a limit are red.
  bool heat = false;
  bool scale = true;         ///< heights in a parallel view
  bool caption = true;       ///< line of text and legend of the marks
  double trail = 2.0;        ///< length of the trails [s]
  double push_length = 0.6;  ///< length of the arrow of a push, as a share of the robot's height
  double push_hold = 0.6;    ///< a push is shown at least this long from its start [s]
};

/// Text at a place in the world.
struct Label {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< place in the world [m]
  std::string text;
  double opacity = 1;  ///< from 0 to 1
};

struct Overlay {
  Triangles triangles;
  std::vector<Label> labels;
};

/// Colours of the marks: sRGB and alpha, from 0 to 1.
namespace overlay_color {
inline const Eigen::Vector4f kCog = {0.95f, 0.72f, 0.10f, 1};
inline const Eigen::Vector4f kZmp = {0.84f, 0.15f, 0.12f, 1};
inline const Eigen::Vector4f kReferenceZmp = {0.05f, 0.30f, 0.75f, 1};
inline const Eigen::Vector4f kSupport = {0.10f, 0.45f, 0.80f, 1};
inline const Eigen::Vector4f kForce = {0.05f, 0.55f, 0.35f, 1};
inline const Eigen::Vector4f kAxis = {0.40f, 0.20f, 0.60f, 1};
inline const Eigen::Vector4f kAhead = {0.84f, 0.15f, 0.12f, 1};
inline const Eigen::Vector4f kPush = {0.78f, 0.25f, 0.62f, 1};
}  // namespace overlay_color

/// The corners of the support polygon of the planned contact feet on the ground plane (z of its
/// frame is the normal), counter-clockwise seen from above. The list is empty without contact or
/// without soles.
std::vector<Eigen::Vector3d> support_corners(
    const RobotModel& model, const std::vector<Eigen::Isometry3d>& poses,
    const std::array<bool, 2>& contact,
    const Eigen::Isometry3d& ground = Eigen::Isometry3d::Identity());

/// For each body, how near its joint is to its limits of position, speed and torque. The value is 0
/// up to two thirds of the limit of speed or torque, and outside the last tenth of the range of
/// positions; it is 1 at a limit. If the home posture is near the end of this range, the last tenth
/// is reduced to a third of the distance at home, so that nothing is near a limit at home.
/// `profile` is the name of an actuator profile; the default one is used if it is unknown.
std::vector<float> joint_heat(const RobotModel& model, const std::string& profile,
                              const SimulationSample& sample);

/// Whether a push is shown at some time from `begin` to `end`.
bool shows_push(const std::vector<PushRecord>& pushed, double begin, double end,
                const OverlayOptions& options);

/// The overlay of the log at time t. `pushed` are the log's pushes(), `sample` and `poses` are
/// those of t, and the `height` of the robot [m] scales the marks.
Overlay make_overlay(const RobotModel& model, const SimulationLog& log,
                     const std::vector<PushRecord>& pushed, double t,
                     const SimulationSample& sample, const std::vector<Eigen::Isometry3d>& poses,
                     double height, const OverlayOptions& options);

}  // namespace ayumi
