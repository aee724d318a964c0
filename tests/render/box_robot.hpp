#pragma once
// A small walking machine of boxes, capsules and a ball, and a made-up run of it, for tests that
// draw.

#include <cmath>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/render/overlay.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi::test {

inline LinkDescription box_link(const std::string& name, double mass, PlacedShape visual) {
  LinkDescription link;
  link.name = name;
  link.has_inertial = true;
  link.inertia.mass = mass;
  link.inertia.com = visual.pose.translation();
  link.inertia.about_com = 1e-3 * mass * Eigen::Matrix3d::Identity();
  link.visuals.push_back(std::move(visual));
  return link;
}

inline PlacedShape placed(Shape shape, const Eigen::Vector3d& at, const Eigen::Vector4f& color) {
  PlacedShape out;
  out.shape = std::move(shape);
  out.pose.translation() = at;
  out.color = color;
  out.has_color = true;
  return out;
}

inline JointDescription hinge(const std::string& name, const std::string& parent,
                              const std::string& child, const Eigen::Vector3d& at) {
  JointDescription joint;
  joint.name = name;
  joint.type = JointType::revolute;
  joint.parent = parent;
  joint.child = child;
  joint.origin.translation() = at;
  joint.axis = Eigen::Vector3d::UnitY();
  joint.has_limits = true;
  joint.lower = -2;
  joint.upper = 2;
  joint.velocity = 5;
  joint.effort = 5;
  return joint;
}

/// A robot 0.48 m tall with a trunk above two legs of two hinges each; its base is 0.30 m above the
/// soles.
inline RobotModel box_robot() {
  RobotDescription d;
  d.name = "box_robot";
  d.links.push_back(box_link(
      "trunk", 3, placed(Box{{0.08, 0.14, 0.16}}, {0, 0, 0.06}, {0.85f, 0.86f, 0.90f, 1})));
  d.links.push_back(
      box_link("head", 0.3, placed(Sphere{0.045}, {0, 0, 0}, {0.10f, 0.25f, 0.80f, 1})));
  d.joints.push_back(hinge("neck", "trunk", "head", {0, 0, 0.135 + 0.045}));
  for (const auto& [side, y] : {std::pair<std::string, double>{"left", 0.04}, {"right", -0.04}}) {
    d.links.push_back(box_link(side + "_thigh", 0.6,
                               placed(Capsule{0.02, 0.10}, {0, 0, -0.07}, {0.9f, 0.5f, 0.1f, 1})));
    d.links.push_back(
        box_link(side + "_foot", 0.6,
                 placed(Box{{0.09, 0.05, 0.16}}, {0.01, 0, -0.08}, {0.15f, 0.6f, 0.3f, 1})));
    d.joints.push_back(hinge(side + "_hip", "trunk", side + "_thigh", {0, y, 0}));
    d.joints.push_back(hinge(side + "_knee", side + "_thigh", side + "_foot", {0, 0, -0.14}));
    SoleDescription sole;
    sole.link = side + "_foot";
    sole.frame.translation() = Eigen::Vector3d(0.01, 0, -0.16);
    sole.polygon = {{-0.045, -0.025}, {0.045, -0.025}, {0.045, 0.025}, {-0.045, 0.025}};
    d.soles[side] = sole;
  }
  d.postures["home"] = {};
  return RobotModel(d);
}

/// A run of one second in which the robot sways while it moves at 0.1 m/s, and is pushed by 20 N
/// for 20 ms at 0.3 s.
inline SimulationLog box_run(const RobotModel& model) {
  SimulationLog log;
  log.dt = 0.002;
  log.controller = ControllerKind::dtad;
  log.provenance.pattern = "patterns/sway.json";
  log.joints = model.dof_names();
  log.result.outcome = Outcome::stands;
  for (int k = 0; k <= 500; ++k) {
    const double t = k * log.dt;
    SimulationSample s;
    s.state = model.rest_state();
    s.state.base.position = {0.1 * t, 0.02 * std::sin(6 * t), 0.30};
    s.state.theta[0] = 0.3 * std::sin(6 * t);
    s.command_base.position = {0.1 * t, 0, 0.30};
    s.command_theta = Eigen::VectorXd::Zero(model.dof_count());
    s.cog = s.state.base.position + Eigen::Vector3d(0, 0, -0.02);
    s.zmp = {0.1 * t, 0.03 * std::sin(6 * t), 0};
    s.reference_zmp = {0.1 * t + 0.02, 0.02 * std::sin(6 * t), 0};
    s.command_cog = {0.1 * t, 0, 0.28};
    s.command_zmp = {0.1 * t, 0, 0};
    s.fz = s.command_fz = 9.81 * model.mass();
    s.planned_contact = {true, t < 0.6};
    s.foot_force[0] = {0, 0, 0.5 * s.fz};
    s.foot_cop[0] = {0.1 * t, 0.04, 0};
    if (t >= 0.3 - 1e-9 && t < 0.32 - 1e-9) {
      s.push_force = {0, 20, 0};
      s.push_point = s.cog + Eigen::Vector3d(0, -0.07, 0.1);
    }
    log.samples.push_back(s);
  }
  return log;
}

/// Options for a picture of the robot alone.
inline OverlayOptions no_marks() {
  return {.cog = false,
          .zmp = false,
          .reference_zmp = false,
          .support = false,
          .forces = false,
          .push = false,
          .trails = false,
          .scale = false,
          .caption = false};
}

}  // namespace ayumi::test
