#pragma once
// The same robot as MJCF, SDF and Choreonoid body, with all digits of every number. Each moving
// body is one link.

#include <Eigen/Dense>
#include <functional>
#include <numbers>
#include <string>

#include "ayumi/base/text.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi::test {

inline std::string numbers_of(const Eigen::VectorXd& values, const char* between = " ") {
  std::string out;
  for (const double value : values) out += (out.empty() ? "" : between) + text::exact(value);
  return out;
}

inline std::string quaternion_text(const Eigen::Matrix3d& turn) {
  const Eigen::Quaterniond q(turn);
  return numbers_of(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
}

inline std::string dof_name(const RobotModel& model, const Body& body) {
  return model.dofs()[static_cast<size_t>(body.dof)].name;
}

/// With `offsets`, joints are away from the origins of their bodies, and angles count from a
/// reference.
inline std::string mjcf_text_of(const RobotModel& model, bool diagonal = false,
                                bool offsets = false) {
  const Eigen::Vector3d away =
      offsets ? Eigen::Vector3d(0.01, -0.02, 0.03) : Eigen::Vector3d(0, 0, 0);
  const double reference = offsets ? 0.1 : 0;
  using Pose = Eigen::Isometry3d;
  // `above` is the parent's frame in the text, relative to the parent's own frame.
  const std::function<std::string(int, const Pose&)> body_text = [&](int index, const Pose& above) {
    const Body& body = model.bodies()[static_cast<size_t>(index)];
    Eigen::Isometry3d at = above.inverse() * body.placement;
    // The body frame of the text, relative to Ayumi's.
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    std::string joint;
    if (index == 0) {
      joint = "<freejoint/>";
    } else {
      // The text's frame is turned, with the joint at its reference, and is away from its axis.
      if (body.prismatic)
        at = at * Eigen::Translation3d(reference * body.axis);
      else
        at = at * Eigen::AngleAxisd(reference, body.axis);
      moved = Eigen::Translation3d(away);
      at = at * moved;
      const Dof& dof = model.dofs()[static_cast<size_t>(body.dof)];
      joint =
          "<joint name='" + dof.name + "' type='" + (body.prismatic ? "slide" : "hinge") +
          "' axis='" + numbers_of(body.axis) + "' pos='" + numbers_of(Eigen::Vector3d(-away)) +
          "' ref='" + text::exact(reference) + "'" +
          (dof.limited ? " range='" + text::exact(dof.lower) + " " + text::exact(dof.upper) + "'"
                       : "") +
          "/>";
    }
    const Eigen::Matrix3d& I = body.inertia.about_com;
    std::string inertia;
    if (diagonal) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(I);
      Eigen::Matrix3d axes = solver.eigenvectors();
      if (axes.determinant() < 0) axes.col(0) *= -1;
      inertia = "diaginertia='" + numbers_of(solver.eigenvalues()) + "' quat='" +
                quaternion_text(axes) + "'";
    } else {
      Eigen::VectorXd full(6);
      full << I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2);
      inertia = "fullinertia='" + numbers_of(full) + "'";
    }
    std::string out =
        "<body name='" + body.name + "' pos='" + numbers_of(at.translation()) + "' quat='" +
        quaternion_text(at.linear()) + "'>" + joint +
        (body.inertia.mass > 0
             ? "<inertial mass='" + text::exact(body.inertia.mass) + "' pos='" +
                   numbers_of(moved.inverse() * body.inertia.com) + "' " + inertia + "/>"
             : "");
    for (size_t i = 1; i < model.bodies().size(); ++i)
      if (model.bodies()[i].parent == index) out += body_text(static_cast<int>(i), moved);
    return out + "</body>";
  };
  return "<mujoco model='" + model.name() + "'><compiler angle='radian'/><worldbody>" +
         body_text(0, Pose::Identity()) + "</worldbody></mujoco>";
}

/// Links are placed in the model's frame, joints in the frames of links, and some in frames of
/// their own.
inline std::string sdf_text_of(const RobotModel& model) {
  const auto pose = [](const Eigen::Isometry3d& at, const std::string& relative) {
    Eigen::VectorXd v(6);
    v << at.translation(), matrix_to_rpy(at.linear());
    return "<pose" + (relative.empty() ? "" : " relative_to='" + relative + "'") + ">" +
           numbers_of(v) + "</pose>";
  };
  std::string out = "<?xml version='1.0'?><sdf version='1.7'><model name='" + model.name() + "'>";
  for (const Body& body : model.bodies()) {
    const Eigen::Matrix3d& I = body.inertia.about_com;
    const auto entry = [&](const char* name, int i, int j) {
      return std::string("<") + name + ">" + text::exact(I(i, j)) + "</" + name + ">";
    };
    const std::string parent =
        body.parent < 0 ? "" : model.bodies()[static_cast<size_t>(body.parent)].name;
    if (!parent.empty())
      out += "<frame name='at_" + body.name + "' attached_to='" + parent + "'>" +
             pose(body.placement, "") + "</frame>";
    out += "<link name='" + body.name + "'>" +
           (parent.empty() ? "" : pose(Eigen::Isometry3d::Identity(), "at_" + body.name)) +
           "<inertial>" + pose(Eigen::Isometry3d(Eigen::Translation3d(body.inertia.com)), "") +
           "<mass>" + text::exact(body.inertia.mass) + "</mass><inertia>" + entry("ixx", 0, 0) +
           entry("ixy", 0, 1) + entry("ixz", 0, 2) + entry("iyy", 1, 1) + entry("iyz", 1, 2) +
           entry("izz", 2, 2) + "</inertia></inertial></link>";
    if (parent.empty()) continue;
    const Dof& dof = model.dofs()[static_cast<size_t>(body.dof)];
    out += "<joint name='" + dof.name + "' type='" + (body.prismatic ? "prismatic" : "revolute") +
           "'><parent>" + parent + "</parent><child>" + body.name + "</child><axis><xyz>" +
           numbers_of(body.axis) + "</xyz>" +
           (dof.limited ? "<limit><lower>" + text::exact(dof.lower) + "</lower><upper>" +
                              text::exact(dof.upper) + "</upper></limit>"
                        : "") +
           "</axis></joint>";
  }
  return out + "</model></sdf>";
}

inline std::string body_text_of(const RobotModel& model) {
  std::string out =
      "format: ChoreonoidBody\nformat_version: 1.0\nangle_unit: radian\nname: " + model.name() +
      "\nlinks:\n";
  for (const Body& body : model.bodies()) {
    Eigen::VectorXd I(9);
    for (int i = 0; i < 9; ++i) I[i] = body.inertia.about_com(i / 3, i % 3);
    const auto list = [](const Eigen::VectorXd& v) { return "[ " + numbers_of(v, ", ") + " ]"; };
    out += "  -\n    name: " + body.name + "\n    mass: " + text::exact(body.inertia.mass) +
           "\n    center_of_mass: " + list(body.inertia.com) + "\n    inertia: " + list(I) + "\n";
    if (body.parent < 0) {
      out += "    joint_type: free\n";
      continue;
    }
    const Eigen::AngleAxisd turn(body.placement.linear());
    Eigen::Vector4d rotation;
    rotation << turn.axis(), turn.angle();
    const Dof& dof = model.dofs()[static_cast<size_t>(body.dof)];
    out += "    parent: " + model.bodies()[static_cast<size_t>(body.parent)].name +
           "\n    joint_type: " + (body.prismatic ? "prismatic" : "revolute") +
           "\n    joint_name: " + dof.name + "\n    joint_id: " + std::to_string(body.dof) +
           "\n    joint_axis: " + list(body.axis) +
           "\n    translation: " + list(body.placement.translation()) +
           "\n    rotation: " + list(rotation) + "\n";
    if (dof.limited)
      out += "    joint_range: " + list(Eigen::Vector2d(dof.lower, dof.upper)) + "\n";
  }
  return out;
}

}  // namespace ayumi::test
