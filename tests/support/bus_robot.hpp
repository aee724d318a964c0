#pragma once
// A robot of three joints on a bus, in another order than the model's, for tests of tables, counts
// and sequences.

#include "ayumi/model/robot_model.hpp"

namespace ayumi::test {

inline RobotDescription bus_description() {
  constexpr double degree = EIGEN_PI / 180;
  RobotDescription d;
  d.name = "bus";
  for (const char* const name : {"root", "one", "two", "three"}) {
    LinkDescription link;
    link.name = name;
    link.has_inertial = true;
    link.inertia.mass = 1;
    link.inertia.about_com.setIdentity();
    link.inertia.about_com *= 0.01;
    d.links.push_back(link);
  }
  const auto joint = [&](const char* name, const char* child, int device, double counts) {
    JointDescription j;
    j.name = name;
    j.type = JointType::revolute;
    j.parent = "root";
    j.child = child;
    j.has_limits = true;
    j.lower = -18 * degree;
    j.upper = 90 * degree;
    j.velocity = 4.76;
    d.joints.push_back(j);
    d.encoders[name] = {device, counts};
  };
  joint("a", "one", 3, 209);
  joint("b", "two", 1, -209);
  joint("c", "three", 2, 209);
  ActuatorProfile profile;
  profile.name = "real";
  for (const char* const name : {"a", "b", "c"}) profile.speed[name] = 4.76;
  d.profiles = {profile};
  d.postures["home"] = {{"a", 10 * degree}, {"b", 0}, {"c", 0}};
  return d;
}

inline RobotModel bus_robot() { return RobotModel(bus_description()); }

}  // namespace ayumi::test
