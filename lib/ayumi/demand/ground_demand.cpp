// P is the frame of the plane, whose normal is z. With f, n the ground wrench about P's origin in
// P's axes,
//   ZMP = (-n_y, n_x) / f_z,   f_z d_e = f_z (a_e . ZMP - b_e) = -a_x n_y + a_y n_x - b f_z
// for an edge e with inward unit normal a and a.x >= b inside. This is linear in the wrench.
#include "ayumi/demand/ground_demand.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

double contact_threshold(const RobotModel& model) {
  return kContactThreshold * model.mass() * kGravity;
}

SupportPlane support_plane(const RobotModel& model, Support support,
                           const std::array<Isometry3d, 2>& soles) {
  SupportPlane plane;
  Vector3d origin = Vector3d::Zero(), normal = Vector3d::Zero(), forward = Vector3d::Zero();
  int count = 0;
  for (Side side : {Side::left, Side::right}) {
    if (!supports(support, side)) continue;
    const Isometry3d& sole = soles[static_cast<int>(side)];
    origin += sole.translation();
    normal += sole.linear().col(2);
    ++count;
  }
  if (count == 0) return plane;
  normal.normalize();
  forward = (Vector3d::UnitX() - normal.x() * normal).normalized();
  plane.frame.translation() = origin / count;
  plane.frame.linear() << forward, normal.cross(forward), normal;
  std::vector<Vector2d> points;
  for (Side side : {Side::left, Side::right}) {
    if (!supports(support, side)) continue;
    const Isometry3d in_plane = plane.frame.inverse() * soles[static_cast<int>(side)];
    for (const Vector2d& v : model.sole(side).polygon)
      points.push_back((in_plane * Vector3d(v.x(), v.y(), 0)).head<2>());
  }
  plane.polygon = ConvexPolygon(std::move(points));
  return plane;
}

Vector6d plane_wrench(const SupportPlane& plane, const Vector3d& base_position,
                      const Vector6d& base_wrench) {
  const Vector3d f = base_wrench.head<3>();
  const Vector3d n = base_wrench.tail<3>() + (base_position - plane.frame.translation()).cross(f);
  Vector6d result;
  result << plane.frame.linear().transpose() * f, plane.frame.linear().transpose() * n;
  return result;
}

Eigen::Matrix<double, Eigen::Dynamic, 6> support_rows(const SupportPlane& plane) {
  const std::vector<Vector2d>& v = plane.polygon.vertices();
  Eigen::Matrix<double, Eigen::Dynamic, 6> rows(v.size(), 6);
  rows.setZero();
  for (size_t i = 0; i < v.size(); ++i) {
    const Vector2d edge = (v[(i + 1) % v.size()] - v[i]).normalized();
    const Vector2d inward(-edge.y(), edge.x());
    rows(i, 2) = -inward.dot(v[i]);
    rows(i, 3) = inward.y();
    rows(i, 4) = -inward.x();
  }
  return rows;
}

GroundDemand ground_demand(const SupportPlane& plane, const Vector6d& wrench, double min_force) {
  GroundDemand use;
  use.normal_force = wrench[2];
  use.tangential_force = wrench.head<2>().norm();
  use.has_zmp = wrench[2] > min_force;
  if (!use.has_zmp) return use;
  use.zmp = Vector2d(-wrench[4], wrench[3]) / wrench[2];
  use.zmp_world = plane.frame * Vector3d(use.zmp.x(), use.zmp.y(), 0);
  use.margin = plane.polygon.margin(use.zmp);
  use.yaw_moment = wrench[5] - (use.zmp.x() * wrench[1] - use.zmp.y() * wrench[0]);
  return use;
}

namespace {

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Fills `kept` with the part of `polygon` on the left of the line from `point` along `direction`.
void clip(const std::vector<Vector2d>& polygon, const Vector2d& point, const Vector2d& direction,
          std::vector<Vector2d>& kept) {
  kept.clear();
  for (size_t j = 0; j < polygon.size(); ++j) {
    const Vector2d &p = polygon[j], &q = polygon[(j + 1) % polygon.size()];
    const double dp = cross(direction, p - point), dq = cross(direction, q - point);
    if (dp >= 0) kept.push_back(p);
    if ((dp >= 0) != (dq >= 0)) kept.push_back(p + dp / (dp - dq) * (q - p));
  }
}

// Integral of |r| over the triangle (0, a, b). With the distance h of the line ab from the origin,
// and the angle phi from the foot of the perpendicular, it is h^3/6 [sec phi tan phi + asinh(tan
// phi)] between both ends, where tan phi is the coordinate along ab divided by h.
double distance_integral(const Vector2d& a, const Vector2d& b) {
  const Vector2d along = (b - a).normalized();
  const double h = cross(a, along);
  if (h < 1e-9) return 0;
  auto primitive = [h](double s) {
    const double tan = s / h;
    return tan * std::sqrt(1 + tan * tan) + std::asinh(tan);
  };
  return h * h * h / 6.0 * (primitive(b.dot(along)) - primitive(a.dot(along)));
}

}  // namespace

double torsional_friction_arm(const ConvexPolygon& polygon, const Vector2d& zmp) {
  if (polygon.vertices().size() < 3 || polygon.margin(zmp) <= 0) return 0;
  // The part whose mirror image about the ZMP is inside too: clip by every mirrored edge.
  std::vector<Vector2d> part, kept;
  part.reserve(2 * polygon.vertices().size());
  kept.reserve(2 * polygon.vertices().size());
  for (const Vector2d& v : polygon.vertices()) part.push_back(v - zmp);
  const std::vector<Vector2d> whole = part;
  for (size_t i = 0; i < whole.size(); ++i) {
    clip(part, -whole[i], whole[i] - whole[(i + 1) % whole.size()], kept);
    part.swap(kept);
    if (part.empty()) return 0;
  }
  double area = 0, moment = 0;
  for (size_t j = 0; j < part.size(); ++j) {
    const Vector2d &p = part[j], &q = part[(j + 1) % part.size()];
    area += 0.5 * cross(p, q);
    if ((q - p).norm() > 1e-12) moment += distance_integral(p, q);
  }
  return area > 1e-12 ? moment / area : 0;
}

namespace {

// The share of the left foot and the two centres of pressure, in the plane.
struct Shares {
  double left = 0.5;
  std::array<Vector2d, 2> pressure;
};

// The part of a that lines through `zmp` connect with b: the part of a in the shadow of b, with the
// ZMP as the light.
std::vector<Vector2d> shadow(const ConvexPolygon& a, const ConvexPolygon& b, const Vector2d& zmp) {
  Vector2d right = zmp - b.vertices()[0], left = right;
  for (const Vector2d& v : b.vertices()) {
    const Vector2d ray = zmp - v;
    if (cross(right, ray) < 0) right = ray;
    if (cross(left, ray) > 0) left = ray;
  }
  std::vector<Vector2d> half, part;
  clip(a.vertices(), zmp, right, half);
  clip(half, zmp, -left, part);
  return part;
}

// The middle of the part of b on the ray from `point` through `zmp`.
Vector2d behind(const ConvexPolygon& b, const Vector2d& point, const Vector2d& zmp) {
  const Vector2d ray = zmp - point;
  double low = 0, high = 1e9;
  const std::vector<Vector2d>& v = b.vertices();
  for (size_t i = 0; i < v.size(); ++i) {
    const Vector2d edge = v[(i + 1) % v.size()] - v[i];
    const double rate = cross(edge, ray), at = cross(edge, point - v[i]);
    if (rate > 0) low = std::max(low, -at / rate);
    if (rate < 0) high = std::min(high, -at / rate);
  }
  return point + 0.5 * (low + high) * ray;
}

// 0 if u < 0, 1 if u > 1, and `u` in between. The function is rounded at both ends so that its
// slope is continuous, because the ZMP of a walk rests exactly there and the repair differentiates
// this function.
double rounded_clamp(double u) {
  // Rounded share at each end. Chosen: a tenth of the distance between the feet. Between half and
  // twice the value, figures change by less than 5 %.
  constexpr double kRound = 0.1;
  if (u > 0.5) return 1 - rounded_clamp(1 - u);
  if (u >= kRound) return u;
  return u <= -kRound ? 0 : (u + kRound) * (u + kRound) / (4 * kRound);
}

// Along the line between the sole centres the share follows the ZMP, and across it both centres of
// pressure shift by the same distance. One foot takes the whole force when the ZMP is past its
// centre. If a centre of pressure would leave its sole in this way, the ZMP lies near a corner of
// the hull. Then the centre of pressure of one foot is in the middle of its possible places, and
// that of the other foot is on the opposite side of the ZMP.
Shares share_zmp(const std::array<ConvexPolygon, 2>& soles, const Vector2d& zmp) {
  const Vector2d left = soles[0].centroid(), right = soles[1].centroid();
  const Vector2d line = left - right;
  Shares s;
  s.left = rounded_clamp((zmp - right).dot(line) / line.squaredNorm());
  const Vector2d shift = zmp - (s.left * left + (1 - s.left) * right);
  s.pressure = {left + shift, right + shift};
  const bool left_bears = s.left > 0, right_bears = s.left < 1;
  if ((!left_bears || soles[0].margin(s.pressure[0]) >= 0) &&
      (!right_bears || soles[1].margin(s.pressure[1]) >= 0))
    return s;
  for (int foot : {0, 1}) {
    if (soles[foot].margin(zmp) < 0) continue;
    s.left = foot == 0 ? 1 : 0;
    s.pressure[foot] = zmp;
    return s;
  }
  const ConvexPolygon lit(shadow(soles[0], soles[1], zmp));
  if (lit.empty()) return s;  // the ZMP is outside the hull
  s.pressure[0] = lit.centroid();
  s.pressure[1] = behind(soles[1], s.pressure[0], zmp);
  s.left = (zmp - s.pressure[1]).norm() / (s.pressure[0] - s.pressure[1]).norm();
  return s;
}

}  // namespace

std::array<Vector6d, 2> foot_wrenches(const RobotModel& model, Support support,
                                      const std::array<Isometry3d, 2>& soles,
                                      const SupportPlane& plane, const GroundDemand& use,
                                      const Vector3d& base_position, const Vector6d& base_wrench) {
  std::array<Vector6d, 2> result = {Vector6d::Zero(), Vector6d::Zero()};
  if (support == Support::none) return result;
  if (support != Support::both || !use.has_zmp) {
    if (support == Support::both)
      result[0] = result[1] = 0.5 * base_wrench;
    else
      result[support == Support::left ? 0 : 1] = base_wrench;
    return result;
  }
  std::array<ConvexPolygon, 2> polygons;
  for (Side side : {Side::left, Side::right}) {
    const Isometry3d in_plane = plane.frame.inverse() * soles[static_cast<int>(side)];
    std::vector<Vector2d> points;
    for (const Vector2d& v : model.sole(side).polygon)
      points.push_back((in_plane * Vector3d(v.x(), v.y(), 0)).head<2>());
    polygons[static_cast<int>(side)] = ConvexPolygon(std::move(points));
  }
  const Shares shares = share_zmp(polygons, use.zmp);
  const Vector3d f = base_wrench.head<3>();
  const Vector3d n = base_wrench.tail<3>();
  const Vector3d free_moment = n - (use.zmp_world - base_position).cross(f);
  for (int s = 0; s < 2; ++s) {
    const double share = s == 0 ? shares.left : 1 - shares.left;
    const Vector2d& c = shares.pressure[s];
    const Vector3d point = plane.frame * Vector3d(c.x(), c.y(), 0);
    result[s].head<3>() = share * f;
    result[s].tail<3>() = share * ((point - base_position).cross(f) + free_moment);
  }
  return result;
}

VectorXd motor_torques(const RobotModel& model, const ActuatorLimits& actuators,
                       const RobotState& state, const VectorXd& acceleration, const VectorXd& force,
                       const std::array<Vector6d, 2>& foot_wrench, const RobotData& data) {
  VectorXd torque = force.tail(model.dof_count());
  for (Side side : {Side::left, Side::right}) {
    const Vector6d& wrench = foot_wrench[static_cast<int>(side)];
    if (wrench.isZero(0)) continue;
    const Vector3d f = wrench.head<3>(), n = wrench.tail<3>();
    for (int i = model.sole(side).body; i > 0; i = model.bodies()[i].parent) {
      const Body& body = model.bodies()[i];
      torque[body.dof] -=
          body.ratio *
          data.axis[i].dot(body.prismatic ? f : Vector3d(n - data.position[i].cross(f)));
    }
  }
  for (int i = 0; i < model.dof_count(); ++i) {
    const ServoDescription& servo = actuators.servo[i];
    torque[i] += servo.rotor_inertia * acceleration[6 + i] + servo.viscous * state.dtheta[i] +
                 servo.coulomb * std::clamp(state.dtheta[i] / kCoulombRate, -1.0, 1.0);
  }
  return torque;
}

SoleError sole_error(const Sole& sole, const Isometry3d& actual, const Isometry3d& planned) {
  const Isometry3d relative = planned.inverse() * actual;
  SoleError error;
  error.lowest = 1e300;
  error.gap = -1e300;
  // The corners have no third coordinate.
  const Vector3d x = relative.linear().col(0), y = relative.linear().col(1);
  const Vector3d origin = relative.translation();
  double farthest = 0;  // square of the slip
  for (const Vector2d& v : sole.polygon) {
    const Vector3d p = origin + (x * v.x() + y * v.y());
    farthest = std::max(farthest, (p.head<2>() - v).squaredNorm());
    error.gap = std::max(error.gap, p.z());
    error.lowest = std::min(error.lowest, p.z());
  }
  error.slip = std::sqrt(farthest);
  error.penetration = std::max(0.0, -error.lowest);
  error.gap = std::max(0.0, error.gap);
  return error;
}

}  // namespace ayumi
