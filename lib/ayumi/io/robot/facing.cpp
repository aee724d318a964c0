#include "ayumi/io/robot/facing.hpp"

#include <algorithm>
#include <set>

#include "ayumi/base/error.hpp"

namespace ayumi {

const std::vector<std::string>& facing_names() {
  static const std::vector<std::string> names = {"x", "y", "-x", "-y"};
  return names;
}

Eigen::Vector3d facing_direction(const std::string& facing) {
  if (facing == "x") return Eigen::Vector3d::UnitX();
  if (facing == "y") return Eigen::Vector3d::UnitY();
  if (facing == "-x") return -Eigen::Vector3d::UnitX();
  if (facing == "-y") return -Eigen::Vector3d::UnitY();
  fail(ErrorCode::internal, "facing '" + facing + "' is not one of x, y, -x and -y");
}

void turn_to_face_x(RobotDescription& robot, const std::string& facing) {
  if (facing == "x") return;
  const Eigen::Vector3d x = facing_direction(facing), z = Eigen::Vector3d::UnitZ();
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();  // turn relative to the URDF's root frame
  turn.linear().row(0) = x;
  turn.linear().row(1) = z.cross(x);
  turn.linear().row(2) = z;
  std::set<std::string> children;
  for (const JointDescription& joint : robot.joints) children.insert(joint.child);
  for (LinkDescription& link : robot.links) {
    if (children.contains(link.name)) continue;
    link.inertia.com = turn * link.inertia.com;
    link.inertia.about_com = turn.linear() * link.inertia.about_com * turn.linear().transpose();
    for (auto* shapes : {&link.visuals, &link.collisions})
      for (PlacedShape& placed : *shapes) placed.pose = turn * placed.pose;
    for (JointDescription& joint : robot.joints)
      if (joint.parent == link.name) joint.origin = turn * joint.origin;
  }
}

}  // namespace ayumi
