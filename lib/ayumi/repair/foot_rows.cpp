// Rotation error of a sole: e = vee(E - E')/2 with E = R R_planned'; a turn w of the sole changes
// it by de = (tr(E) 1 - E) w / 2.
#include "ayumi/repair/foot_rows.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

namespace policy = repair_policy;

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

bool is_of_foot(ConstraintGroup group) {
  return group >= ConstraintGroup::stance && group <= ConstraintGroup::foot_clearance;
}

namespace {

bool is_of_heights(ConstraintGroup group) {
  return group == ConstraintGroup::swing || group == ConstraintGroup::foot_clearance;
}

Matrix3d rotation_error(const Isometry3d& actual, const Isometry3d& planned) {
  return actual.linear() * planned.linear().transpose();
}

// Of sole_deviation(), with J the Jacobian of the sole.
MatrixXd deviation_derivatives(const Isometry3d& sole, const Isometry3d& planned,
                               const MatrixXd& J) {
  const Matrix3d E = rotation_error(sole, planned);
  MatrixXd by(6, J.cols());
  by << J.topRows<3>(), 0.5 * (E.trace() * Matrix3d::Identity() - E) * J.bottomRows<3>();
  return by;
}

std::vector<Vector3d> sole_corners(const RobotModel& model, Side side, const Isometry3d& sole) {
  std::vector<Vector3d> result;
  for (const Eigen::Vector2d& v : model.sole(side).polygon)
    result.push_back(sole * Vector3d(v.x(), v.y(), 0));
  return result;
}

double height_over(const Isometry3d& place, const Isometry3d& sole) {
  return place.linear().col(2).dot(sole.translation() - place.translation());
}

// What a sole row is measured from.
const Isometry3d& reference_pose(const ConstraintBlock& block, const CollocationPoint& point) {
  return block.group == ConstraintGroup::path ? point.path[block.item] : point.ground[block.item];
}

}  // namespace

Vector6d sole_deviation(const Isometry3d& actual, const Isometry3d& planned) {
  const Matrix3d E = rotation_error(actual, planned);
  Vector6d deviation;
  deviation << actual.translation() - planned.translation(),
      0.5 * Vector3d(E(2, 1) - E(1, 2), E(0, 2) - E(2, 0), E(1, 0) - E(0, 1));
  return deviation;
}

Eigen::Matrix<double, 5, 6> landing_rows(const RobotModel& model, Side side,
                                         const Isometry3d& place) {
  double reach = 0;
  for (const Eigen::Vector2d& v : model.sole(side).polygon) reach = std::max(reach, v.norm());
  Eigen::Matrix<double, 5, 6> rows = Eigen::Matrix<double, 5, 6>::Zero();
  rows.topLeftCorner<2, 3>() = place.linear().leftCols<2>().transpose();
  rows.bottomRightCorner<3, 3>() = reach * place.linear().transpose();
  return rows;
}

Eigen::Matrix<double, 5, 1> landing_offset(const RobotModel& model, Side side,
                                           const Isometry3d& actual, const Isometry3d& place) {
  return landing_rows(model, side, place) * sole_deviation(actual, place);
}

VectorXd foot_values(const RobotModel& model, const ConstraintBlock& block,
                     const CollocationPoint& point, const PointState& state) {
  const Isometry3d &sole = state.soles[block.item], &from = reference_pose(block, point);
  VectorXd values(block.rows);
  if (block.group == ConstraintGroup::landing) {
    const Isometry3d& place = point.place[block.item];
    const auto offset = landing_offset(model, static_cast<Side>(block.item), sole, place);
    const double height = height_over(place, sole);
    values << offset, -offset;
    return (block.factor * height * height - values.array()).matrix();
  }
  if (!is_of_heights(block.group)) return sole_deviation(sole, from);
  const Vector3d normal = from.linear().col(2);
  const auto corners = sole_corners(model, static_cast<Side>(block.item), sole);
  for (int i = 0; i < block.rows; ++i) values[i] = normal.dot(corners[i] - from.translation());
  return values;
}

MatrixXd foot_derivatives(const RobotModel& model, const ConstraintBlock& block,
                          const CollocationPoint& point, const PointState& state) {
  const Isometry3d &sole = state.soles[block.item], &from = reference_pose(block, point);
  const MatrixXd& J = state.sole_by[block.item];
  MatrixXd by(block.rows, model.velocity_count());
  if (block.group == ConstraintGroup::landing) {
    const Isometry3d& place = point.place[block.item];
    const Vector3d normal = place.linear().col(2);
    const double height = height_over(place, sole);
    const MatrixXd offset = landing_rows(model, static_cast<Side>(block.item), place) *
                            deviation_derivatives(sole, place, J);
    by << -offset, offset;
    by.rowwise() += 2 * block.factor * height * normal.transpose() * J.topRows<3>();
    return by;
  }
  if (!is_of_heights(block.group)) return deviation_derivatives(sole, from, J);
  const Vector3d normal = from.linear().col(2);
  const auto corners = sole_corners(model, static_cast<Side>(block.item), sole);
  for (int i = 0; i < block.rows; ++i) {
    const Vector3d arm = corners[i] - sole.translation();
    by.row(i) =
        normal.transpose() * J.topRows<3>() + arm.cross(normal).transpose() * J.bottomRows<3>();
  }
  return by;
}

// ---- the motion's own swings

namespace {

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

int samples_of(double period, double dt) { return std::max(1, static_cast<int>(period / dt)); }

// The largest offset / height^2 of a swing near one of its places.
double landing_factor(const RowPlacement& p, Side side, const ContactInterval& swing,
                      const Isometry3d& place, bool lands) {
  const int every = samples_of(policy::swing::kLandingPeriod, p.series.dt);
  const int count = std::min((swing.last - swing.first) / 2,
                             static_cast<int>(policy::swing::kNearPlace / p.series.dt));
  RobotData data(p.model);
  double most = 0;
  for (int k = 0; k < count; k += every) {
    const int sample = lands ? swing.last - k : swing.first + k;
    update_positions(p.model, p.series.samples[sample].state, data);
    const Isometry3d sole = sole_pose(p.model, data, side);
    const double height = height_over(place, sole);
    if (height < policy::swing::kLowestMeasured) continue;
    const double offset = landing_offset(p.model, side, sole, place).cwiseAbs().maxCoeff();
    most = std::max(most, (offset - policy::swing::kPlaceSlack) / (height * height));
  }
  return most;
}

// 1.5 x the median over swings of offset / height^2; the median ignores a faulty swing.
double own_landing_factor(const RowPlacement& p) {
  std::vector<double> factors;
  for (Side side : {Side::left, Side::right}) {
    const auto& intervals = p.plan.intervals[static_cast<int>(side)];
    for (size_t i = 0; i < intervals.size(); ++i) {
      if (intervals[i].contact) continue;
      if (i > 0)
        factors.push_back(landing_factor(p, side, intervals[i], intervals[i - 1].sole, false));
      if (i + 1 < intervals.size())
        factors.push_back(landing_factor(p, side, intervals[i], intervals[i + 1].sole, true));
    }
  }
  const double least = 1 / (policy::swing::kLeastLandingHeight * p.series.samples.front().cog.z());
  if (factors.empty()) return least;
  return std::max(least, policy::swing::kOwnLandingFactor * median_of(factors));
}

// Height of the lowest corner in the middle half of a swing, over both of its places.
double lowest_height(const RowPlacement& p, Side side,
                     const std::vector<ContactInterval>& intervals, size_t i) {
  const int every = samples_of(policy::swing::kHeightPeriod, p.series.dt);
  const int quarter = (intervals[i].last - intervals[i].first) / 4;
  RobotData data(p.model);
  double lowest = kNoBound;
  for (int k = intervals[i].first + quarter; k <= intervals[i].last - quarter; k += every) {
    update_positions(p.model, p.series.samples[k].state, data);
    const Isometry3d sole = sole_pose(p.model, data, side);
    for (size_t j : {i - 1, i + 1})
      lowest = std::min(lowest, sole_error(p.model.sole(side), sole, intervals[j].sole).lowest);
  }
  return lowest;
}

// The median over the motion's swings.
double own_foot_clearance(const RowPlacement& p) {
  std::vector<double> heights;
  for (Side side : {Side::left, Side::right}) {
    const auto& intervals = p.plan.intervals[static_cast<int>(side)];
    for (size_t i = 1; i + 1 < intervals.size(); ++i)
      if (!intervals[i].contact) heights.push_back(lowest_height(p, side, intervals, i));
  }
  return heights.empty() ? 0 : median_of(heights);
}

}  // namespace

SwingGoals swing_goals(const RowPlacement& p) {
  return {own_landing_factor(p),
          std::max(0.0, policy::swing::kHeightShare * own_foot_clearance(p))};
}

// ---- placement

namespace {

// How far a sole may turn in its place. A long sole may turn less, because its corners rise and
// sink.
double sole_angle(const RowPlacement& p, Side side) {
  double reach = 0;
  for (const Eigen::Vector2d& v : p.model.sole(side).polygon)
    reach = std::max(reach, v.lpNorm<1>());
  const double off =
      std::min(p.tolerance(FindingKind::foot_float), p.tolerance(FindingKind::foot_penetration));
  return std::min(p.spec.sole_angle, policy::stance::kCornerShare * off / reach);
}

// A foot that lands or lifts off softly is not quite in its place for a moment. The check allows
// that; what the motion does so by itself stays, up to a share of what is allowed.
void soften_landing(const RowPlacement& p, int point, Side side, Vector6d& lower, Vector6d& upper) {
  constexpr double kSoft = policy::stance::kSoftTime;
  const CollocationPoint& at = p.points[point];
  const ContactInterval& contact = p.plan.at(side, at.sample);
  const int last = static_cast<int>(p.series.samples.size()) - 1;
  const double landed = contact.first == 0 ? kSoft : (at.sample - contact.first) * p.series.dt;
  const double left = contact.last == last ? kSoft : (contact.last - at.sample) * p.series.dt;
  if (std::min(landed, left) >= kSoft) return;
  const Isometry3d& sole = at.path[static_cast<int>(side)];
  const SoleError error = sole_error(p.model.sole(side), sole, contact.sole);
  const double used = std::max({error.gap / p.tolerance(FindingKind::foot_float),
                                error.penetration / p.tolerance(FindingKind::foot_penetration),
                                error.slip / p.tolerance(FindingKind::foot_slip)});
  Vector6d own = std::min(1.0, policy::stance::kSoftShare / std::max(used, 1e-9)) *
                 sole_deviation(sole, contact.sole);
  // A sole above its place has not landed yet: that is what is to be mended.
  const Vector3d normal = contact.sole.linear().col(2);
  own.head<3>() -= std::max(0.0, normal.dot(own.head<3>())) * normal;
  upper[2] *= policy::stance::kSoftUpwards;
  lower += own.cwiseMin(0);
  upper += own.cwiseMax(0);
}

void place_stance(RowPlacement& p, int point, Side side) {
  const double share = p.points[point].at_knot ? p.spec.sole_at_knots : 1;
  constexpr double kShare = policy::stance::kToleranceShare;
  const double band =
      share * std::min({p.spec.sole_position, kShare * p.tolerance(FindingKind::foot_slip),
                        kShare * p.tolerance(FindingKind::foot_penetration),
                        kShare * p.tolerance(FindingKind::foot_float)});
  const double angle = share * sole_angle(p, side);
  Vector6d upper;
  upper << band, band, band, angle, angle, angle;
  Vector6d lower = -upper;
  soften_landing(p, point, side, lower, upper);
  p.add(block_of(ConstraintGroup::stance, point, static_cast<int>(side), 6), lower, upper);
}

// Near its landing and its lift-off a swinging sole is wanted over its place: played open loop the
// servos sag, and a sole that comes in low or tilted touches down while it still moves.
void place_landing(RowPlacement& p, int point, Side side, const SwingGoals& goals) {
  const CollocationPoint& at = p.points[point];
  const ContactInterval& swing = p.plan.at(side, at.sample);
  const int last = static_cast<int>(p.series.samples.size()) - 1;
  const int after = swing.first == 0 ? last : at.sample - swing.first;
  const int before = swing.last == last ? last : swing.last - at.sample;
  if (std::min(after, before) * p.series.dt > policy::swing::kNearPlace) return;
  ConstraintBlock block = block_of(ConstraintGroup::landing, point, static_cast<int>(side), 10);
  block.factor = goals.landing_factor;
  p.add(std::move(block), -policy::swing::kPlaceSlack, kNoBound);
}

// Over the ground everywhere; in the middle half of a swing at a share of the height that the
// motion's own swings have.
void place_swing(RowPlacement& p, int point, Side side, const SwingGoals& goals) {
  const int s = static_cast<int>(side);
  const CollocationPoint& at = p.points[point];
  double lowest = kNoBound;
  RobotData data(p.model);
  for (const CommandSample* sample : p.watched(point)) {
    update_positions(p.model, sample->state, data);
    const Isometry3d sole = sole_pose(p.model, data, side);
    lowest = std::min(lowest, sole_error(p.model.sole(side), sole, at.ground[s]).lowest);
  }
  const int corners = static_cast<int>(p.model.sole(side).polygon.size());
  if (lowest < policy::swing::kWatchedHeight)
    p.add(block_of(ConstraintGroup::swing, point, s, corners), -p.spec.sole_position, kNoBound);
  const ContactInterval& swing = p.plan.at(side, at.sample);
  const int quarter = (swing.last - swing.first) / 4;
  const bool middle = at.sample >= swing.first + quarter && at.sample <= swing.last - quarter;
  if (p.spec.swing_goals && middle && p.spec.watched_share * lowest < goals.clearance)
    p.add(block_of(ConstraintGroup::foot_clearance, point, s, corners), goals.clearance, kNoBound);
}

}  // namespace

void place_foot_rows(RowPlacement& p, int point, const SwingGoals& goals) {
  for (Side side : {Side::left, Side::right}) {
    const int s = static_cast<int>(side);
    const bool contact = p.points[point].contact[s];
    if (contact) place_stance(p, point, side);
    if (p.spec.locked_feet[s])
      p.add(block_of(ConstraintGroup::path, point, s, 6), -policy::stance::kLockedFoot,
            policy::stance::kLockedFoot);
    if (contact || p.spec.locked_feet[s]) continue;
    if (p.spec.swing_goals) place_landing(p, point, side, goals);
    place_swing(p, point, side, goals);
  }
}

}  // namespace ayumi
