#include "ayumi/render/robot_picture.hpp"

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/body_poses.hpp"
#include "ayumi/render/clip.hpp"

namespace ayumi {

namespace {

/// A posture on the ground with its COG, in the form of a log, so that it is drawn like an instant
/// of a run. The lower sole is on the ground.
SimulationLog stand_of(const RobotModel& model, const Eigen::VectorXd& theta) {
  for (Eigen::Index j = 0; j < theta.size(); ++j)
    if (!std::isfinite(theta[j]))
      fail(ErrorCode::usage, "the posture of the picture has " + text::exact(theta[j]) + " for " +
                                 model.dofs()[static_cast<size_t>(j)].name +
                                 "; every joint needs a finite number");
  SimulationLog log;
  log.joints = model.dof_names();
  log.dt = 1e-3;
  SimulationSample sample;
  sample.state = model.rest_state();
  sample.state.theta = theta;
  RobotData data(model);
  update_positions(model, sample.state, data);
  if (model.has_soles()) {
    const bool left = sole_pose(model, data, Side::left).translation().z() <=
                      sole_pose(model, data, Side::right).translation().z();
    anchor_base(model, left ? Side::left : Side::right, Eigen::Isometry3d::Identity(), sample.state,
                data);
  } else
    sample.state.base.position.z() -=
        robot_bounds(robot_surface(model), body_poses(model, sample.state)).min().z();
  update_positions(model, sample.state, data);
  sample.cog = data.cog;
  sample.torque = sample.command_theta = sample.state.theta;
  log.samples.push_back(std::move(sample));
  return log;
}

}  // namespace

RobotPicture draw_robot(const RobotModel& model, const std::string& view, bool marks,
                        const Eigen::VectorXd* theta) {
  ClipOptions options;
  options.camera.view = view;
  // A robot without motion has only a COG among the marks.
  OverlayOptions& overlay = options.overlay;
  overlay.zmp = overlay.reference_zmp = overlay.support = overlay.forces = overlay.push = false;
  overlay.trails = overlay.caption = false;
  overlay.model = marks;
  const SimulationLog log = stand_of(model, theta ? *theta : model.rest_state().theta);
  ClipRenderer renderer(model, log, options);
  return {renderer.frame(0), renderer.notes()};
}

}  // namespace ayumi
