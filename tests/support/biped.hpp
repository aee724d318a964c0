#pragma once
// A small two-legged robot with six-joint legs, one waist and one shoulder joint per side, written
// in code, for tests that must not depend on robot files.

#include <string>

#include "ayumi/model/robot_model.hpp"

namespace ayumi::test {

struct BipedOptions {
  bool waist = false;   ///< a yaw joint between root (pelvis) and trunk
  double arm_skew = 0;  ///< mass that is added to the left arm [kg]
};

inline LinkDescription box_link(const std::string& name, double mass, const Eigen::Vector3d& com,
                                const Eigen::Vector3d& edges) {
  LinkDescription link;
  link.name = name;
  link.has_inertial = true;
  link.inertia.mass = mass;
  link.inertia.com = com;
  const Eigen::Vector3d e = edges.cwiseProduct(edges);
  link.inertia.about_com =
      Eigen::Vector3d(e.y() + e.z(), e.x() + e.z(), e.x() + e.y()).asDiagonal() * (mass / 12);
  return link;
}

inline JointDescription hinge(const std::string& name, const std::string& parent,
                              const std::string& child, const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& axis, double lower, double upper) {
  JointDescription joint;
  joint.name = name;
  joint.type = JointType::revolute;
  joint.parent = parent;
  joint.child = child;
  joint.origin.translation() = origin;
  joint.axis = axis;
  joint.has_limits = true;
  joint.lower = lower;
  joint.upper = upper;
  return joint;
}

/// The hips are 0.10 m apart, the legs have 0.12 + 0.12 + 0.04 m, the knees are bent at home, and
/// the mass is 8.1 kg.
inline RobotDescription biped_description(const BipedOptions& options = {}) {
  const Eigen::Vector3d X(1, 0, 0), Y(0, 1, 0), Z(0, 0, 1), O(0, 0, 0);
  RobotDescription d;
  d.name = "biped";
  d.links.push_back(box_link("pelvis", 1.2, {0.005, 0, 0.02}, {0.10, 0.16, 0.08}));
  d.links.push_back(box_link("trunk", 3.0, {0.004, 0, 0.10}, {0.12, 0.18, 0.20}));
  JointDescription waist = hinge("waist", "pelvis", "trunk", {0, 0, 0.06}, Z, -1, 1);
  if (!options.waist) waist.type = JointType::fixed;
  d.joints.push_back(waist);
  for (const bool left : {true, false}) {
    const std::string s = left ? "l_" : "r_";
    const double y = left ? 1 : -1;
    const auto link = [&](const std::string& name, double mass, const Eigen::Vector3d& com,
                          const Eigen::Vector3d& edges) {
      d.links.push_back(box_link(s + name, mass, com, edges));
    };
    const auto joint = [&](const std::string& name, const std::string& parent,
                           const std::string& child, const Eigen::Vector3d& origin,
                           const Eigen::Vector3d& axis, double lower, double upper) {
      d.joints.push_back(hinge(s + name, parent, s + child, origin, axis, lower, upper));
    };
    link("hip1", 0.08, O, {0.03, 0.03, 0.03});
    link("hip2", 0.12, O, {0.03, 0.03, 0.03});
    link("thigh", 0.7, {0.005, 0.002 * y, -0.06}, {0.05, 0.05, 0.12});
    link("shank", 0.4, {0.008, 0, -0.05}, {0.05, 0.05, 0.12});
    link("ankle", 0.1, O, {0.03, 0.03, 0.03});
    link("foot", 0.25, {0.01, 0, -0.025}, {0.11, 0.07, 0.03});
    link("arm", 0.3, {0.01, 0.01 * y, -0.08}, {0.04, 0.04, 0.16});
    joint("hip_yaw", "pelvis", "hip1", {0, 0.05 * y, 0}, Z, -1, 1);
    joint("hip_roll", s + "hip1", "hip2", O, X, -0.6, 0.6);
    joint("hip_pitch", s + "hip2", "thigh", O, Y, -1.8, 1.2);
    joint("knee", s + "thigh", "shank", {0, 0, -0.12}, Y, 0, 2.2);
    joint("ankle_pitch", s + "shank", "ankle", {0, 0, -0.12}, Y, -1.2, 1.2);
    joint("ankle_roll", s + "ankle", "foot", O, X, -0.5, 0.5);
    joint("shoulder", "trunk", "arm", {0, 0.11 * y, 0.18}, Y, -2.5, 2.5);
    if (left) d.links.back().inertia.mass += options.arm_skew;
    SoleDescription sole;
    sole.link = s + "foot";
    sole.frame.translation() = Eigen::Vector3d(0, 0, -0.04);
    sole.polygon = {{-0.045, -0.035}, {0.065, -0.035}, {0.065, 0.035}, {-0.045, 0.035}};
    d.soles[left ? "left" : "right"] = sole;
    for (const auto& [name, angle] :
         std::map<std::string, double>{{"hip_pitch", -0.4}, {"knee", 0.8}, {"ankle_pitch", -0.4}}) {
      d.postures["home"][s + name] = angle;
      d.postures["squat"][s + name] = 1.5 * angle;
    }
  }
  d.postures["zero"] = {};
  if (options.waist) d.trunk_link = "trunk";
  return d;
}

inline RobotModel biped(const BipedOptions& options = {}) {
  return RobotModel(biped_description(options));
}

}  // namespace ayumi::test
