#pragma once
// A sampled motion without the library's kinematics and dynamics: poses of all links by products of
// homogeneous matrices, then plain sums over the links. Rates are fourth-order differences of link
// positions and attitudes in time, so that no Jacobian and no recursion enters.

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

#include "ayumi/model/gravity.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi::test {

/// The pose of every body, by index, as 4 x 4 matrices.
inline std::vector<Eigen::Matrix4d> plain_poses(const RobotModel& model, const RobotState& state) {
  using Eigen::Matrix3d;
  using Eigen::Matrix4d;
  std::vector<Matrix4d> poses;
  for (const Body& body : model.bodies()) {
    Matrix4d own = Matrix4d::Identity();
    if (body.parent < 0) {
      const Eigen::Quaterniond& q = state.base.attitude;
      own.topLeftCorner<3, 3>() << 1 - 2 * (q.y() * q.y() + q.z() * q.z()),
          2 * (q.x() * q.y() - q.w() * q.z()), 2 * (q.x() * q.z() + q.w() * q.y()),
          2 * (q.x() * q.y() + q.w() * q.z()), 1 - 2 * (q.x() * q.x() + q.z() * q.z()),
          2 * (q.y() * q.z() - q.w() * q.x()), 2 * (q.x() * q.z() - q.w() * q.y()),
          2 * (q.y() * q.z() + q.w() * q.x()), 1 - 2 * (q.x() * q.x() + q.y() * q.y());
      own.topRightCorner<3, 1>() = state.base.position;
      poses.push_back(own);
      continue;
    }
    const double angle = body.ratio * state.theta[body.dof] + body.offset;
    if (body.prismatic) {
      own.topRightCorner<3, 1>() = angle * body.axis;
    } else {  // the formula of Rodrigues
      Matrix3d cross;
      cross << 0, -body.axis.z(), body.axis.y(), body.axis.z(), 0, -body.axis.x(), -body.axis.y(),
          body.axis.x(), 0;
      own.topLeftCorner<3, 3>() =
          Matrix3d::Identity() + std::sin(angle) * cross + (1 - std::cos(angle)) * cross * cross;
    }
    poses.push_back(poses[static_cast<size_t>(body.parent)] * body.placement.matrix() * own);
  }
  return poses;
}

inline Eigen::Vector3d at_pose(const Eigen::Matrix4d& pose, const Eigen::Vector3d& point) {
  return (pose * point.homogeneous()).head<3>();
}

/// The corners of a sole in the world.
inline std::vector<Eigen::Vector3d> plain_sole(const RobotModel& model,
                                               const std::vector<Eigen::Matrix4d>& poses,
                                               Side side) {
  const Sole& sole = model.sole(side);
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector2d& v : sole.polygon)
    corners.push_back(at_pose(poses[static_cast<size_t>(sole.body)] * sole.frame.matrix(),
                              Eigen::Vector3d(v.x(), v.y(), 0)));
  return corners;
}

/// One link at one sample.
struct PlainLink {
  double mass = 0;
  Eigen::Vector3d com, acceleration;  ///< place and acceleration in the world [m], [m/s^2]
  Eigen::Vector3d spin, spin_rate;    ///< angular momentum about its own COG, and its rate
};

/// The links of all bodies at the five samples k-2 ... k+2.
inline std::vector<PlainLink> plain_links(const RobotModel& model, const CommandSeries& series,
                                          int k) {
  const double h = series.dt;
  std::array<std::vector<Eigen::Matrix4d>, 5> poses;
  for (int i = 0; i < 5; ++i)
    poses[static_cast<size_t>(i)] =
        plain_poses(model, series.samples[static_cast<size_t>(k - 2 + i)].state);
  const auto rate = [h](const auto& x) -> std::decay_t<decltype(x(0))> {
    return (x(0) - 8 * x(1) + 8 * x(3) - x(4)) / (12 * h);
  };
  const auto second = [h](const auto& x) -> std::decay_t<decltype(x(0))> {
    return (-x(0) + 16 * x(1) - 30 * x(2) + 16 * x(3) - x(4)) / (12 * h * h);
  };
  const auto vee = [](const Eigen::Matrix3d& m) {
    return Eigen::Vector3d(
        0.5 * Eigen::Vector3d(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)));
  };
  std::vector<PlainLink> links;
  for (const Link& link : model.links()) {
    const auto pose = [&](int i) {
      return Eigen::Matrix4d(poses[static_cast<size_t>(i)][static_cast<size_t>(link.body)] *
                             link.pose.matrix());
    };
    const auto com = [&](int i) { return at_pose(pose(i), link.inertia.com); };
    const auto turn = [&](int i) { return Eigen::Matrix3d(pose(i).topLeftCorner<3, 3>()); };
    const Eigen::Matrix3d R = turn(2);
    const Eigen::Vector3d w = vee(rate(turn) * R.transpose());
    const Eigen::Vector3d dw = vee(second(turn) * R.transpose());
    const Eigen::Matrix3d I = R * link.inertia.about_com * R.transpose();
    PlainLink p;
    p.mass = link.inertia.mass;
    p.com = com(2);
    p.acceleration = second(com);
    p.spin = I * w;
    p.spin_rate = I * dw + w.cross(p.spin);
    links.push_back(p);
  }
  return links;
}

inline Eigen::Vector3d plain_cog(const RobotModel& model,
                                 const std::vector<Eigen::Matrix4d>& poses) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double mass = 0;
  for (const Link& link : model.links()) {
    sum += link.inertia.mass *
           at_pose(poses[static_cast<size_t>(link.body)] * link.pose.matrix(), link.inertia.com);
    mass += link.inertia.mass;
  }
  return sum / mass;
}

/// The force of the ground, and its moment about the origin of the world.
struct PlainGround {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
};
inline PlainGround plain_ground(const std::vector<PlainLink>& links) {
  PlainGround ground;
  for (const PlainLink& p : links) {
    const Eigen::Vector3d f = p.mass * (p.acceleration + Eigen::Vector3d(0, 0, kGravity));
    ground.force += f;
    ground.moment += p.com.cross(f) + p.spin_rate;
  }
  return ground;
}

/// The distance of a point inside the hull of `corners`, seen from above, computed without that
/// hull: of all directions perpendicular to a pair of corners, the smallest distance by which the
/// corners extend beyond the point. It only holds for points inside.
inline double plain_margin(const std::vector<Eigen::Vector3d>& corners,
                           const Eigen::Vector2d& point) {
  double least = 1e300;
  for (const Eigen::Vector3d& a : corners)
    for (const Eigen::Vector3d& b : corners) {
      const Eigen::Vector2d way = (b - a).head<2>();
      if (way.norm() < 1e-9) continue;
      const Eigen::Vector2d across = Eigen::Vector2d(way.y(), -way.x()).normalized();
      double reach = -1e300;
      for (const Eigen::Vector3d& c : corners)
        reach = std::max(reach, across.dot(c.head<2>() - point));
      least = std::min(least, reach);
    }
  return least;
}

}  // namespace ayumi::test
