#pragma once
// Random robots as two texts made from the same numbers: a URDF as users write them (links and
// joints in any order, inertias turned against the link, links without mass, chains of mimic
// joints, meshes) and a MuJoCo model in which every link is a body and every joint is free. The
// library is not used for this.

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <string>
#include <vector>

#include "tests/support/random_robot.hpp"

namespace ayumi::test {

struct OddLink {
  /// Names of the link and its joint; the joint is empty for the root.
  std::string name, parent_joint;
  double mass = 0;
  Eigen::Vector3d com, rpy;   ///< pose of the inertial frame
  Eigen::Vector3d principal;  ///< principal moments [kg m^2]
  Eigen::Vector3d turn;       ///< rotation vector from the inertial frame to the principal axes
};

struct OddJoint {
  std::string name, type, parent, child;
  Eigen::Vector3d xyz, rpy, axis;
  std::string mimic;
  double multiplier = 1, offset = 0;
  bool moves() const { return type != "fixed"; }
};

struct OddRobot {
  std::vector<OddLink> links;
  std::vector<OddJoint> joints;

  const OddJoint* joint(const std::string& name) const {
    for (const OddJoint& each : joints)
      if (each.name == name) return &each;
    return nullptr;
  }
  /// The position of a moving joint is factor * (position of its driver) + offset.
  struct Tie {
    std::string driver;
    double factor = 1, offset = 0;
  };
  Tie tie(const std::string& name) const {
    const OddJoint& own = *joint(name);
    if (own.mimic.empty()) return {name, 1, 0};
    const Tie above = tie(own.mimic);
    return {above.driver, own.multiplier * above.factor,
            own.multiplier * above.offset + own.offset};
  }
};

inline std::string number(double x) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, x).ptr};
}
inline std::string numbers(const Eigen::Vector3d& v) {
  return number(v.x()) + " " + number(v.y()) + " " + number(v.z());
}
/// The text "w x y z" of a rotation about fixed axes, x first, as in URDF.
inline Eigen::Quaterniond from_rpy(const Eigen::Vector3d& rpy) {
  return Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX());
}
inline std::string quaternion(const Eigen::Quaterniond& q) {
  return number(q.w()) + " " + number(q.x()) + " " + number(q.y()) + " " + number(q.z());
}

inline OddRobot odd_robot(unsigned seed, int count) {
  Random random(seed + 7000);
  OddRobot robot;
  std::vector<std::string> movers;  // joints that may be mimicked
  for (int i = 0; i < count; ++i) {
    OddLink link;
    link.name = "part" + std::to_string(i);
    const Eigen::Vector3d e = random.vector(0.05).cwiseAbs() + Eigen::Vector3d::Constant(0.02);
    link.mass = random.uniform(0.05, 1);
    link.com = random.vector(0.05);
    link.rpy = random.vector(2);
    link.turn = random.vector(1.5);
    link.principal = link.mass / 12 *
                     Eigen::Vector3d(e.y() * e.y() + e.z() * e.z(), e.x() * e.x() + e.z() * e.z(),
                                     e.x() * e.x() + e.y() * e.y());
    if (i > 0) {
      OddJoint joint;
      joint.name = "axis" + std::to_string(i);
      joint.child = link.name;
      joint.parent = robot.links[static_cast<size_t>(random.uniform(0, i - 1e-9))].name;
      const int kind = static_cast<int>(random.uniform(0, 8 - 1e-9));
      joint.type = kind == 0   ? "fixed"
                   : kind == 1 ? "prismatic"
                   : kind <= 3 ? "continuous"
                               : "revolute";
      joint.xyz = random.vector(0.2);
      joint.rpy = random.vector(3);
      joint.axis = kind == 2 ? Eigen::Vector3d(0, -2, 0) : random.vector(2);
      if (joint.moves() && !movers.empty() && random.uniform(0, 1) < 0.3) {
        joint.mimic = movers[static_cast<size_t>(
            random.uniform(0, static_cast<double>(movers.size()) - 1e-9))];
        joint.multiplier = random.uniform(-1.5, 1.5);
        joint.offset = random.uniform(-0.3, 0.3);
      }
      if (joint.moves()) movers.push_back(joint.name);
      robot.joints.push_back(joint);
    }
    robot.links.push_back(link);
  }
  // A link between two axes may have no mass if a link with mass follows.
  for (OddLink& link : robot.links) {
    const bool inner = std::any_of(
        robot.joints.begin(), robot.joints.end(),
        [&](const OddJoint& j) { return j.parent == link.name && j.moves() && j.mimic.empty(); });
    if (inner && link.name != "part0" && random.uniform(0, 1) < 0.3) link.mass = 0;
  }
  return robot;
}

template <typename Item>
std::vector<Item> shuffled(std::vector<Item> items, Random& random) {
  for (size_t i = items.size(); i > 1; --i)
    std::swap(items[i - 1],
              items[static_cast<size_t>(random.uniform(0, static_cast<double>(i) - 1e-9))]);
  return items;
}

/// The URDF with links and joints mixed in any order: the root is hardly ever first, and mimic
/// joints come before their drivers.
inline std::string urdf_text(const OddRobot& robot, unsigned seed) {
  Random random(seed + 8000);
  std::vector<std::string> elements;
  for (const OddLink& link : robot.links) {
    std::string text = "  <link name=\"" + link.name + "\"";
    if (link.mass > 0) {
      const Eigen::Matrix3d Q =
          Eigen::AngleAxisd(link.turn.norm(), link.turn.normalized()).toRotationMatrix();
      const Eigen::Matrix3d I = Q * link.principal.asDiagonal() * Q.transpose();
      text += "><inertial><mass value=\"" + number(link.mass) + "\"/><origin rpy=\"" +
              numbers(link.rpy) + "\" xyz=\"" + numbers(link.com) + "\"/><inertia ixx=\"" +
              number(I(0, 0)) + "\" ixy=\"" + number(I(0, 1)) + "\" ixz=\"" + number(I(0, 2)) +
              "\" iyy=\"" + number(I(1, 1)) + "\" iyz=\"" + number(I(1, 2)) + "\" izz=\"" +
              number(I(2, 2)) + "\"/></inertial></link>\n";
    } else {
      text += "/>\n";
    }
    elements.push_back(text);
  }
  for (const OddJoint& joint : robot.joints) {
    std::string text = "  <joint name=\"" + joint.name + "\" type=\"" + joint.type +
                       "\"><child link=\"" + joint.child + "\"/><parent link=\"" + joint.parent +
                       "\"/><origin xyz=\"" + numbers(joint.xyz) + "\" rpy=\"" +
                       numbers(joint.rpy) + "\"/>";
    if (joint.moves()) text += "<axis xyz=\"" + numbers(joint.axis) + "\"/>";
    if (joint.type == "revolute" || joint.type == "prismatic")
      text += "<limit lower=\"-3\" upper=\"3\" effort=\"10\" velocity=\"20\"/>";
    if (!joint.mimic.empty())
      text += "<mimic joint=\"" + joint.mimic + "\" multiplier=\"" + number(joint.multiplier) +
              "\" offset=\"" + number(joint.offset) + "\"/>";
    elements.push_back(text + "</joint>\n");
  }
  std::string text = "<robot name=\"odd\">\n";
  for (const std::string& element : shuffled(elements, random)) text += element;
  return text + "</robot>\n";
}

/// The body with every joint free. MuJoCo requires that moving parts have mass: they get some,
/// which is removed later.
inline std::string mujoco_body_text(const OddRobot& robot, const OddLink& link,
                                    const OddJoint* joint) {
  std::string text = "<body name='" + link.name + "'";
  if (joint) {
    text += " pos='" + numbers(joint->xyz) + "' quat='" + quaternion(from_rpy(joint->rpy)) + "'>";
    if (joint->moves())
      text += "<joint name='" + joint->name + "' type='" +
              (joint->type == "prismatic" ? "slide" : "hinge") + "' axis='" +
              numbers(joint->axis.normalized()) + "'/>";
  } else {
    text += "><freejoint name='root'/>";
  }
  if (link.mass > 0) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(link.turn.norm(), link.turn.normalized()));
    text += "<inertial mass='" + number(link.mass) + "' pos='" + numbers(link.com) + "' quat='" +
            quaternion(from_rpy(link.rpy) * turn) + "' diaginertia='" + numbers(link.principal) +
            "'/>";
  } else {
    text += "<inertial mass='1' pos='0 0 0' diaginertia='1 1 1'/>";
  }
  for (const OddJoint& next : robot.joints)
    if (next.parent == link.name)
      for (const OddLink& child : robot.links)
        if (child.name == next.child) text += mujoco_body_text(robot, child, &next);
  return text + "</body>";
}
inline std::string mujoco_text(const OddRobot& robot) {
  return "<mujoco><compiler angle='radian'/><worldbody>" +
         mujoco_body_text(robot, robot.links[0], nullptr) + "</worldbody></mujoco>";
}

}  // namespace ayumi::test
