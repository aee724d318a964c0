#include "ayumi/render/frames.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/render/log_reading.hpp"

namespace ayumi {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Largest tilt of a sole against the plan [rad] with which this sole still determines the place of
// the plan. Chosen: soles of a walk tilt by less than 3 degrees, and a robot that falls exceeds
// this at once.
constexpr double kTilted = 0.1;

/// The poses of the soles' middles in many postures.
class SolePoses {
 public:
  explicit SolePoses(const RobotModel& model)
      : model_(model), data_(model), state_(model.rest_state()) {}

  Isometry3d at(Side side, const BasePose& base, const Eigen::VectorXd& theta) {
    state_.base = base;
    state_.theta = theta;
    update_positions(model_, state_, data_);
    const Sole& sole = model_.sole(side);
    const Isometry3d pose = data_.pose(sole.body) * sole.frame;
    return pose * Eigen::Translation3d(sole.center.x(), sole.center.y(), 0);
  }

 private:
  const RobotModel& model_;
  RobotData data_;
  RobotState state_;
};

/// The pose without its tilt.
Isometry3d upright(const Isometry3d& pose) {
  Isometry3d upright = Isometry3d::Identity();
  upright.translation() = pose.translation();
  upright.rotate(
      Eigen::AngleAxisd(std::atan2(pose.linear()(1, 0), pose.linear()(0, 0)), Vector3d::UnitZ()));
  return upright;
}

void move(const Isometry3d& by, BasePose& base) {
  base.position = by * base.position;
  base.attitude = Eigen::Quaterniond(by.linear()) * base.attitude;
}

void move(const Isometry3d& by, const std::vector<Vector3d*>& places,
          const std::vector<Vector3d*>& directions) {
  for (Vector3d* place : places) *place = by * *place;
  for (Vector3d* direction : directions) *direction = by.linear() * *direction;
}

/// Moves the parts of a sample that are in the frame of the plan.
void move_plan(const Isometry3d& by, SimulationSample& s) {
  move(by, s.command_base);
  move(by, s.reference_base);
  move(by,
       {&s.measured_cog, &s.measured_zmp, &s.command_cog, &s.command_zmp, &s.reference_cog,
        &s.reference_zmp},
       {&s.measured_dcog, &s.command_dcog, &s.reference_dcog, &s.reference_ddcog});
}

/// Moves the parts of a sample that really happened, in the world.
void move_world(const Isometry3d& by, SimulationSample& s) {
  move(by, s.state.base);
  move(by, {&s.cog, &s.zmp, &s.foot_cop[0], &s.foot_cop[1], &s.push_point},
       {&s.dcog, &s.foot_force[0], &s.foot_force[1], &s.push_force, &s.state.base_velocity,
        &s.state.base_angular_velocity});
}

}  // namespace

const std::vector<std::string>& frame_names() {
  static const std::vector<std::string> names = {"world", "foot"};
  return names;
}

Frame frame_of(const std::string& name) {
  if (name == "world") return Frame::world;
  if (name == "foot") return Frame::foot;
  fail(ErrorCode::usage, "frame: '" + name + "' is not one of " + text::join(frame_names(), ", ") +
                             text::suggestion(name, frame_names()));
}

SimulationLog in_frame(const RobotModel& model, SimulationLog log, Frame frame) {
  if (!model.has_soles()) {
    if (frame == Frame::world) return log;
    fail(ErrorCode::usage,
         "frame foot: the robot " + model.name() +
             " has no soles; state them in its sidecar, or choose the frame world");
  }
  SolePoses soles(model);
  Side side = Side::left;
  Isometry3d real = Isometry3d::Identity(), plan = real;
  for (SimulationSample& s : log.samples) {
    const bool left = s.planned_contact[0], right = s.planned_contact[1];
    if (left != right) side = left ? Side::left : Side::right;
    if (left || right) {
      const Isometry3d now = soles.at(side, s.state.base, s.state.theta);
      const bool has_reference = s.reference_theta.size() == model.dof_count();
      const bool has_command = s.command_theta.size() == model.dof_count();
      const Isometry3d planned = has_reference ? soles.at(side, s.reference_base, s.reference_theta)
                                 : has_command ? soles.at(side, s.command_base, s.command_theta)
                                               : now;
      if (now.linear().col(2).dot(planned.linear().col(2)) > std::cos(kTilted)) {
        real = upright(now);
        plan = upright(planned);
      }
    }
    if (frame == Frame::world) {
      move_plan(real * plan.inverse(), s);
    } else {
      move_plan(plan.inverse(), s);
      move_world(real.inverse(), s);
    }
  }
  if (frame == Frame::foot) log.world.height = 0;
  return log;
}

void require_level_ground(const SimulationLog& log, Frame frame) {
  if (frame == Frame::world) return;
  const World& world = log.world;
  const bool bump = std::any_of(log.scenario.begin(), log.scenario.end(), [](const Disturbance& d) {
    return std::holds_alternative<Bump>(d.what);
  });
  if (!world.slope.isZero(0) || !world.blocks.empty() || !world.fields.empty() ||
      !world.patches.empty() || bump || floor_moves(log))
    fail(ErrorCode::usage,
         "frame foot: the ground of this run is not a level plane at rest, so the ground would "
         "jump at every step of the robot in this frame; choose the frame world");
}

}  // namespace ayumi
