#pragma once
// The mirror images of a robot and its plan: y -> -y. Left and right are exchanged, and so are
// names with them. Every joint keeps its angle, since its axis turns the other way.

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi::test {

inline Eigen::Matrix3d mirror_matrix() { return Eigen::Vector3d(1, -1, 1).asDiagonal(); }

inline Eigen::Vector3d mirrored(const Eigen::Vector3d& p) { return {p.x(), -p.y(), p.z()}; }
/// The mirror image of a rotation, an angular velocity or an axis.
inline Eigen::Vector3d mirrored_turn(const Eigen::Vector3d& w) { return {-w.x(), w.y(), -w.z()}; }

inline Eigen::Isometry3d mirrored(const Eigen::Isometry3d& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = mirror_matrix() * pose.linear() * mirror_matrix();
  result.translation() = mirrored(Eigen::Vector3d(pose.translation()));
  return result;
}

/// The name of the mirrored part: that of "l_knee" is "r_knee".
inline std::string mirrored(const std::string& name) {
  if (name.starts_with("l_")) return "r_" + name.substr(2);
  if (name.starts_with("r_")) return "l_" + name.substr(2);
  return name;
}

template <typename Value>
std::map<std::string, Value> mirrored(const std::map<std::string, Value>& by_name) {
  std::map<std::string, Value> result;
  for (const auto& [name, value] : by_name) result[mirrored(name)] = value;
  return result;
}

inline void mirror(std::vector<PlacedShape>& shapes) {
  for (PlacedShape& placed : shapes) {
    placed.pose = mirrored(placed.pose);
    if (auto* mesh = std::get_if<MeshShape>(&placed.shape))
      for (MeshPart& part : mesh->mesh.parts)
        for (Eigen::Vector3f& v : part.vertices) v.y() = -v.y();
  }
}

/// Mirrors the names of links, joints and soles; the order of joints by name stays.
inline RobotDescription mirrored(RobotDescription d) {
  for (LinkDescription& link : d.links) {
    link.name = mirrored(link.name);
    link.inertia.com = mirrored(link.inertia.com);
    link.inertia.about_com = mirror_matrix() * link.inertia.about_com * mirror_matrix();
    mirror(link.visuals);
    mirror(link.collisions);
  }
  for (JointDescription& joint : d.joints) {
    for (std::string* name : {&joint.name, &joint.parent, &joint.child, &joint.mimic})
      *name = mirrored(*name);
    joint.origin = mirrored(joint.origin);
    joint.axis =
        joint.type == JointType::prismatic ? mirrored(joint.axis) : mirrored_turn(joint.axis);
  }
  std::swap(d.soles["left"], d.soles["right"]);
  for (auto& [side, sole] : d.soles) {
    sole.link = mirrored(sole.link);
    sole.frame = mirrored(sole.frame);
    for (Eigen::Vector2d& p : sole.polygon) p.y() = -p.y();
    std::reverse(sole.polygon.begin(), sole.polygon.end());
  }
  for (auto& [name, posture] : d.postures) posture = mirrored(posture);
  d.servos = mirrored(d.servos);
  d.encoders = mirrored(d.encoders);
  for (ActuatorProfile& profile : d.profiles)
    for (auto* limit : {&profile.speed, &profile.peak_torque, &profile.continuous_torque})
      *limit = mirrored(*limit);
  d.sensors.imu_link = mirrored(d.sensors.imu_link);
  d.sensors.imu_position = mirrored(d.sensors.imu_position);
  d.control.joint_weight = mirrored(d.control.joint_weight);
  d.trunk_link = mirrored(d.trunk_link);
  for (auto& [a, b] : d.collision_ignore) a = mirrored(a), b = mirrored(b);
  return d;
}

/// The angles of `model` for the mirrored robot.
inline Eigen::VectorXd mirrored(const RobotModel& model, const RobotModel& image,
                                const Eigen::VectorXd& theta) {
  Eigen::VectorXd result(theta.size());
  for (int j = 0; j < model.dof_count(); ++j)
    result[image.find_dof(mirrored(model.dofs()[j].name))] = theta[j];
  return result;
}

inline RobotState mirrored(const RobotModel& model, const RobotModel& image, RobotState s) {
  s.base.position = mirrored(s.base.position);
  s.base.attitude.coeffs() << mirrored_turn(s.base.attitude.vec()), s.base.attitude.w();
  s.base_velocity = mirrored(s.base_velocity);
  s.base_angular_velocity = mirrored_turn(s.base_angular_velocity);
  s.theta = mirrored(model, image, s.theta);
  s.dtheta = mirrored(model, image, s.dtheta);
  return s;
}

inline CommandSeries mirrored(const RobotModel& model, const RobotModel& image, CommandSeries c) {
  for (CommandSample& s : c.samples) {
    s.state = mirrored(model, image, s.state);
    Eigen::VectorXd a = s.acceleration;
    a << mirrored(Eigen::Vector3d(s.acceleration.head<3>())),
        mirrored_turn(s.acceleration.segment<3>(3)),
        mirrored(model, image, Eigen::VectorXd(s.acceleration.tail(model.dof_count())));
    s.acceleration = a;
    for (Eigen::Vector3d* v : {&s.cog, &s.dcog, &s.ddcog, &s.zmp}) *v = mirrored(*v);
    if (s.support == Support::left || s.support == Support::right)
      s.support = s.support == Support::left ? Support::right : Support::left;
    s.feet = {mirrored(s.feet[1]), mirrored(s.feet[0])};
  }
  for (JointWeight& w : c.joint_weight) w.value = mirrored(model, image, w.value);
  return c;
}

}  // namespace ayumi::test
