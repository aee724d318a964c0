// With P the change of reference from the base to the support plane (axes R', arm from the plane's
// origin to the base), the plane wrench is w = P W, and W the base rows of inverse dynamics. A row
// g(w) has the derivatives  dg/dw P dW, and by the base position, whose arm moves,
//   - (dg/dw).moment skew(f).
// Torsional friction compares the yaw moment about the ZMP,  n_z + (n_x f_x + n_y f_y) / f_z,
// with  mu arm f_z, the arm held as it is in the given motion.
#include "ayumi/repair/ground_rows.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

namespace policy = repair_policy;

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

double yaw_moment_about_zmp(const Vector6d& w) { return w[5] + (w[3] * w[0] + w[4] * w[1]) / w[2]; }

Eigen::Matrix<double, 1, 6> yaw_gradient(const Vector6d& w) {
  Eigen::Matrix<double, 1, 6> g;
  g << w[3], w[4], -(w[3] * w[0] + w[4] * w[1]) / w[2], w[0], w[1], w[2];
  return g / w[2];
}

VectorXd values_of_wrench(const ConstraintBlock& block, const Vector6d& w) {
  if (block.group == ConstraintGroup::friction)
    return VectorXd::Constant(
        1, block.scale * (block.factor * w[2] - rounded_tangential_force(block, w)));
  if (block.group != ConstraintGroup::torsional_friction) return block.wrench_rows * w;
  const double most = block.factor * w[2], moment = yaw_moment_about_zmp(w);
  return block.scale * Eigen::Vector2d(most - moment, most + moment);
}

Vector6d base_wrench(const RobotModel& model, const CommandSample& sample, RobotData& data) {
  return inverse_dynamics(model, sample.state, sample.acceleration, data).head<6>();
}

double weight_of(const RobotModel& model) { return model.mass() * kGravity; }

}  // namespace

bool is_of_ground(ConstraintGroup group) { return group <= ConstraintGroup::torsional_friction; }

double contact_threshold(const RobotModel& model) {
  return kContactThreshold * model.mass() * kGravity;
}

double rounded_tangential_force(const ConstraintBlock& block, const Vector6d& w) {
  return std::sqrt(w.head<2>().squaredNorm() +
                   std::pow(policy::kFrictionRounding / block.scale, 2));
}

VectorXd ground_values(const ConstraintBlock& block, const CollocationPoint& point,
                       const PointState& state) {
  return values_of_wrench(
      block, plane_wrench(point.plane, state.motion.state.base.position, state.wrench));
}

MatrixXd ground_gradient(const ConstraintBlock& block, const Vector6d& w) {
  if (block.group == ConstraintGroup::friction) {
    MatrixXd row = MatrixXd::Zero(1, 6);
    row.leftCols<2>() = -w.head<2>().transpose() / rounded_tangential_force(block, w);
    row(0, 2) = block.factor;
    return block.scale * row;
  }
  if (block.group != ConstraintGroup::torsional_friction) return block.wrench_rows;
  MatrixXd rows(2, 6);
  rows << -yaw_gradient(w), yaw_gradient(w);
  rows.col(2).array() += block.factor;
  return block.scale * rows;
}

std::array<MatrixXd, 3> ground_derivatives(const ConstraintBlock& block,
                                           const CollocationPoint& point, const PointState& state) {
  const Matrix3d R = point.plane.frame.linear().transpose();
  const Vector3d base = state.motion.state.base.position;
  const Vector3d arm = base - point.plane.frame.translation();
  Eigen::Matrix<double, 6, 6> P = Eigen::Matrix<double, 6, 6>::Zero();
  P.topLeftCorner<3, 3>() = P.bottomRightCorner<3, 3>() = R;
  P.bottomLeftCorner<3, 3>() = R * skew(arm);
  const MatrixXd A = ground_gradient(block, plane_wrench(point.plane, base, state.wrench)) * P;
  std::array<MatrixXd, 3> by;
  for (int i = 0; i < 3; ++i) by[i] = A * state.wrench_by[i];
  by[0].leftCols<3>() -= A.rightCols<3>() * skew(Vector3d(state.wrench.head<3>()));
  return by;
}

Eigen::Matrix<double, 2, 6> planned_zmp_rows(const RowPlacement& p, int point) {
  const CollocationPoint& at = p.points[point];
  const Vector3d zmp = at.plane.frame.inverse() * p.series.samples[at.sample].zmp;
  Eigen::Matrix<double, 2, 6> rows;
  rows.row(0) << 0, 0, -zmp.x(), 0, -1, 0;
  rows.row(1) << 0, 0, -zmp.y(), 1, 0, 0;
  return rows / weight_of(p.model);
}

void set_zmp_margins(RowPlacement& p) {
  RobotData data(p.model);
  std::vector<double> own;
  for (const CollocationPoint& at : p.points) {
    const CommandSample& sample = p.series.samples[at.sample];
    const Vector6d wrench = base_wrench(p.model, sample, data);
    const GroundDemand demand =
        ground_demand(at.plane, plane_wrench(at.plane, sample.state.base.position, wrench),
                      contact_threshold(p.model));
    own.push_back(at.plane.empty() || !at.forces_known ? kNoBound
                  : demand.has_zmp                     ? demand.margin
                                                       : 0);
  }
  const double least_wanted = p.spec.zmp_margin;
  const double safe = std::max(p.spec.safe_margin, least_wanted);
  for (size_t i = 0; i < own.size(); ++i) {
    double least = own[i];
    for (size_t j = 0; j < own.size(); ++j)
      if (std::abs(p.points[i].sample - p.points[j].sample) * p.series.dt <=
          policy::zmp::kSafeAround)
        least = std::min(least, own[j]);
    p.points[i].zmp_margin = least < least_wanted
                                 ? safe
                                 : std::clamp(policy::zmp::kOwnShare * own[i], least_wanted, safe);
  }
}

namespace {

// Force and moment that the given motion needs in flight, about its planned COG, over the weight.
Vector6d own_flight_wrench(const RowPlacement& p, int sample) {
  const CommandSample& s = p.series.samples[sample];
  SupportPlane plane;
  plane.frame.translation() = s.cog;
  RobotData data(p.model);
  return plane_wrench(plane, s.state.base.position, base_wrench(p.model, s, data)) /
         weight_of(p.model);
}

// As in the check, because the moments of single samples hold the rounding of differences.
Vector3d mean_flight_moment(const RowPlacement& p, int sample) {
  const int last = static_cast<int>(p.series.samples.size()) - 1;
  Vector3d mean = Vector3d::Zero();
  int count = 0;
  for (int i = std::max(0, sample - policy::flight::kMean);
       i <= std::min(last, sample + policy::flight::kMean); ++i) {
    if (p.series.samples[i].support != Support::none || at_flight_edge(p.series, i)) continue;
    mean += own_flight_wrench(p, i).tail<3>();
    ++count;
  }
  if (count > 0) mean /= count;
  return mean;
}

// Nothing pushes in flight. The band is half of what the check allows, shared among three axes, or
// what the motion does by itself where that passes. A deviation of one sample from the mean moment
// is rounding and is left alone.
void place_flight_rows(RowPlacement& p, int point) {
  const int k = p.points[point].sample;
  const Vector6d own = own_flight_wrench(p, k);
  Vector6d kept, offset = Vector6d::Zero(), band;
  kept << own.head<3>(), mean_flight_moment(p, k);
  offset.tail<3>() = own.tail<3>() - kept.tail<3>();
  const double weight = weight_of(p.model);
  const double most[] = {p.tolerance(FindingKind::ballistic) / kGravity,
                         p.tolerance(FindingKind::angular_momentum) / weight};
  for (int part : {0, 1}) {
    const double used = kept.segment<3>(3 * part).norm() / most[part];
    kept.segment<3>(3 * part) *= used > policy::flight::kOwnShare ? 0.0 : 1.0;
    band.segment<3>(3 * part).setConstant(policy::flight::kBand / std::sqrt(3.0) * most[part]);
  }
  ConstraintBlock block = block_of(ConstraintGroup::flight, point, 0, 6);
  block.wrench_rows = Eigen::Matrix<double, 6, 6>::Identity() / weight;
  p.add(std::move(block), offset + (-band).cwiseMin(kept), offset + band.cwiseMax(kept));
}

// The largest demands of all samples that are watched.
struct WatchedDemand {
  double least_force;
  double friction = 0;  // tangential force over the friction available
  double torsion = 0;   // yaw moment over the torsional friction available
  double arm = 0;       // mu times the arm of torsional friction, of the latest iterate [m]
};

WatchedDemand watched_demand(const RowPlacement& p, int point) {
  const SupportPlane& plane = p.points[point].plane;
  WatchedDemand most{.least_force = weight_of(p.model)};
  RobotData data(p.model);
  for (const CommandSample* sample : p.watched(point)) {
    const Vector6d wrench =
        plane_wrench(plane, sample->state.base.position, base_wrench(p.model, *sample, data));
    const GroundDemand demand = ground_demand(plane, wrench, contact_threshold(p.model));
    most.least_force = std::min(most.least_force, demand.normal_force);
    if (!demand.has_zmp) continue;
    const double available = p.spec.friction * demand.normal_force;
    most.friction = std::max(most.friction, demand.tangential_force / available);
    const double arm = p.spec.friction * torsional_friction_arm(plane.polygon, demand.zmp);
    if (arm <= 0) continue;
    most.torsion =
        std::max(most.torsion, std::abs(demand.yaw_moment) / (arm * demand.normal_force));
    most.arm = arm;
  }
  return most;
}

void add_linear(RowPlacement& p, ConstraintGroup group, int point, const MatrixXd& rows,
                double lower) {
  ConstraintBlock block = block_of(group, point, 0, static_cast<int>(rows.rows()));
  block.wrench_rows = rows / weight_of(p.model);
  p.add(std::move(block), lower, kNoBound);
}

void add_friction(RowPlacement& p, int point) {
  ConstraintBlock block = block_of(ConstraintGroup::friction, point, 0, 1, 1 / weight_of(p.model));
  block.factor = p.spec.limit_share * p.tolerance(FindingKind::friction) * p.spec.friction *
                 (p.spec.at_check_limits ? 1 : policy::kFirstBackoff.friction_cone);
  p.add(std::move(block), 0, kNoBound);
}

void add_torsional_friction(RowPlacement& p, int point, double arm) {
  ConstraintBlock block =
      block_of(ConstraintGroup::torsional_friction, point, 0, 2, 1 / weight_of(p.model));
  block.factor = p.spec.limit_share * p.tolerance(FindingKind::yaw_moment) * arm;
  p.add(std::move(block), 0, kNoBound);
}

}  // namespace

void place_ground_rows(RowPlacement& p, int point) {
  const CollocationPoint& at = p.points[point];
  if (at.plane.empty()) {
    if (at.only.empty()) place_flight_rows(p, point);
    return;
  }
  MatrixXd rows = support_rows(at.plane);
  rows.col(2).array() -= at.zmp_margin;
  add_linear(p, ConstraintGroup::support, point, rows, 0);
  const WatchedDemand demand = watched_demand(p, point);
  if (demand.least_force < policy::collocation::kLightShare * weight_of(p.model)) {
    rows.setZero(1, 6);
    rows(0, 2) = 1;
    add_linear(p, ConstraintGroup::normal_force, point, rows, p.spec.least_normal_force);
  }
  if (demand.friction > p.spec.watched_share * p.tolerance(FindingKind::friction))
    add_friction(p, point);
  if (demand.arm > 0 &&
      demand.torsion > p.spec.watched_share * p.tolerance(FindingKind::yaw_moment))
    add_torsional_friction(p, point, demand.arm);
}

}  // namespace ayumi
