#pragma once
// A small two-legged test robot with limits, servos and collision shapes, in round numbers: six
// joints per leg, two per arm, box soles.

#include <string>

#include "ayumi/model/robot_model.hpp"

namespace ayumi::test {

inline LinkDescription solid_box(const std::string& name, double mass, Eigen::Vector3d size,
                                 Eigen::Vector3d center, bool collides = true) {
  LinkDescription link;
  link.name = name;
  link.has_inertial = true;
  link.inertia.mass = mass;
  link.inertia.com = center;
  const Eigen::Vector3d s = size.cwiseAbs2();
  link.inertia.about_com =
      mass / 12 * Eigen::Vector3d(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()).asDiagonal();
  if (collides) {
    PlacedShape shape;
    shape.name = name;
    shape.shape = Box{size};
    shape.pose.translation() = center;
    link.collisions.push_back(shape);
  }
  return link;
}

inline JointDescription limited_hinge(const std::string& name, const std::string& parent,
                                      const std::string& child, Eigen::Vector3d origin,
                                      Eigen::Vector3d axis, double lower, double upper) {
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

inline void add_leg(RobotDescription& d, const std::string& p, double y) {
  using Eigen::Vector3d;
  const Vector3d X = Vector3d::UnitX(), Y = Vector3d::UnitY(), Z = Vector3d::UnitZ();
  d.links.push_back(solid_box(p + "hip", 0.05, {0.03, 0.03, 0.03}, {0, 0, 0.015}, false));
  d.links.push_back(solid_box(p + "hip2", 0.18, {0.04, 0.04, 0.04}, {0, 0, 0}, false));
  d.links.push_back(solid_box(p + "thigh", 0.45, {0.05, 0.05, 0.09}, {0.005, 0, -0.06}));
  d.links.push_back(solid_box(p + "shin", 0.3, {0.045, 0.045, 0.09}, {0.005, 0, -0.045}));
  d.links.push_back(solid_box(p + "ankle", 0.15, {0.03, 0.03, 0.03}, {0, 0, 0}, false));
  d.links.push_back(solid_box(p + "foot", 0.15, {0.1, 0.06, 0.015}, {0.005, 0, -0.0295}));
  d.joints.push_back(limited_hinge(p + "hip_yaw", "torso", p + "hip", {0, y, 0}, Z, -1, 1));
  d.joints.push_back(limited_hinge(p + "hip_roll", p + "hip", p + "hip2", {0, 0, 0}, X, -0.5, 0.5));
  d.joints.push_back(
      limited_hinge(p + "hip_pitch", p + "hip2", p + "thigh", {0, 0, 0}, Y, -2, 1.2));
  d.joints.push_back(limited_hinge(p + "knee", p + "thigh", p + "shin", {0, 0, -0.1}, Y, 0, 2.1));
  d.joints.push_back(
      limited_hinge(p + "ankle_pitch", p + "shin", p + "ankle", {0, 0, -0.1}, Y, -1.05, 1.05));
  d.joints.push_back(
      limited_hinge(p + "ankle_roll", p + "ankle", p + "foot", {0, 0, 0}, X, -0.35, 0.35));
  for (const char* joint :
       {"hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll"})
    d.postures["home"][p + joint] = 0;
  d.postures["home"][p + "hip_pitch"] = -0.4;
  d.postures["home"][p + "knee"] = 0.8;
  d.postures["home"][p + "ankle_pitch"] = -0.4;
}

inline void add_arm(RobotDescription& d, const std::string& p, double y) {
  using Eigen::Vector3d;
  d.links.push_back(solid_box(p + "upper_arm", 0.3, {0.04, 0.04, 0.1}, {0, 0, -0.05}));
  d.links.push_back(solid_box(p + "forearm", 0.12, {0.03, 0.03, 0.08}, {0, 0, -0.04}));
  d.joints.push_back(limited_hinge(p + "shoulder_pitch", "torso", p + "upper_arm", {0, y, 0.15},
                                   Vector3d::UnitY(), -2, 2));
  d.joints.push_back(limited_hinge(p + "elbow", p + "upper_arm", p + "forearm", {0, 0, -0.115},
                                   Vector3d::UnitX(), -2, 2));
}

/// The robot has 16 joints and a mass of 6.2 kg. In the home posture, the knees are bent by 0.8 rad
/// and the COG is near the middle of the soles.
inline RobotDescription limited_biped_description() {
  RobotDescription d;
  d.name = "biped";
  d.links.push_back(solid_box("torso", 2.8, {0.1, 0.12, 0.16}, {0, 0, 0.1}));
  add_leg(d, "l_", 0.04);
  add_leg(d, "r_", -0.04);
  add_arm(d, "l_", 0.105);
  add_arm(d, "r_", -0.105);
  for (const auto& [side, link] : {std::pair{"left", "l_foot"}, std::pair{"right", "r_foot"}}) {
    SoleDescription sole;
    sole.link = link;
    sole.frame.translation() = Eigen::Vector3d(0, 0, -0.037);
    for (const auto& [x, y] :
         {std::pair{-0.045, -0.03}, {0.055, -0.03}, {0.055, 0.03}, {-0.045, 0.03}})
      sole.polygon.emplace_back(x, y);
    d.soles[side] = sole;
  }
  ActuatorProfile profile;
  profile.name = "plain";
  for (const JointDescription& joint : d.joints) {
    profile.speed[joint.name] = 6;
    profile.peak_torque[joint.name] = 6;
    profile.continuous_torque[joint.name] = 3;
    d.servos[joint.name].rotor_inertia = 2e-4;
    d.servos[joint.name].viscous = 0.01;
    d.servos[joint.name].coulomb = 0.02;
  }
  d.profiles.push_back(profile);
  return d;
}

inline const RobotModel& limited_biped() {
  static const RobotModel model(limited_biped_description());
  return model;
}

}  // namespace ayumi::test
