// What must hold at every instant: a row for every limit that the motion, or where it has come to,
// is near; the check of the result looks at the rest.
#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/repair/correction_problem.hpp"
#include "ayumi/repair/motor_torque.hpp"

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kInsideCone = 0.98;  // where limits are not those of the check

}  // namespace

void CorrectionProblem::add_block(ConstraintBlock block, double lower, double upper) {
  if (!wanted(block)) return;
  block.row = static_cast<int>(lower_.size());
  lower_.conservativeResize(block.row + block.rows);
  upper_.conservativeResize(block.row + block.rows);
  lower_.tail(block.rows).setConstant(lower);
  upper_.tail(block.rows).setConstant(upper);
  columns_.push_back(block_columns(model_, block, instants_[block.instant]));
  blocks_.push_back(std::move(block));
}

bool CorrectionProblem::wanted(const ConstraintBlock& block) const {
  const auto few = only_.find(instants_[block.instant].sample);
  return few == only_.end() || few->second.contains({block.group, block.item});
}

std::vector<PressedLimit> CorrectionProblem::beside_pressed(const VectorXd& x) const {
  constexpr double kPressed = 1e-3, kPressedCone = 0.05;  // shares
  constexpr int kParts = 4;                               // of the way to the next instant
  const VectorXd g = constraints(x);
  std::vector<PressedLimit> rows;
  for (const ConstraintBlock& b : blocks_) {
    const bool one = b.group == ConstraintGroup::friction || b.group == ConstraintGroup::speed ||
                     b.group == ConstraintGroup::position || b.group == ConstraintGroup::torque;
    const double near = b.group == ConstraintGroup::friction ? kPressedCone * b.factor : kPressed;
    if (!one || std::min(g[b.row] - lower_[b.row], upper_[b.row] - g[b.row]) > near) continue;
    const int here = instants_[b.instant].sample;
    for (const int beside : {b.instant - 1, b.instant + 1}) {
      if (beside < 0 || beside >= static_cast<int>(instants_.size())) continue;
      const int there = instants_[beside].sample;
      for (int part = 1; part <= kParts; ++part)
        rows.push_back({here + (there - here) * part / kParts, b.group, b.item});
    }
  }
  return rows;
}

void CorrectionProblem::place_constraints() {
  place_margins();
  measure_swings();
  measure_capture();
  for (int i = 0; i < static_cast<int>(instants_.size()); ++i) {
    const bool all = !only_.contains(instants_[i].sample);
    if (all) place_kept_pose(i);
    if (all) place_foot_blocks(i);
    place_joint_blocks(i);
    if (instants_[i].known) {
      place_ground_blocks(i);
      place_torque_blocks(i);
    }
    if (all) place_clearance_blocks(i);
    if (all) place_command_blocks(i);
    if (all) place_capture_block(i);
  }
}

// Where the motion's ZMP is outside, or too near the edge, it is brought back to where it is safe,
// and so around that: a step that begins badly is not safe when its end is. Where it is inside
// anyhow it stays as far inside as it is, or safe is.
void CorrectionProblem::place_margins() {
  constexpr double kAround = 0.5;  // [s]
  constexpr double kOwn = 0.8;     // share of its own margin that a sound motion keeps
  RobotData data(model_);
  std::vector<double> own;
  for (const CollocationPoint& at : instants_) {
    const CommandSample& sample = series_.samples[at.sample];
    const Vector6d wrench =
        inverse_dynamics(model_, sample.state, sample.acceleration, data).head<6>();
    const GroundDemand use =
        ground_demand(at.plane, plane_wrench(at.plane, sample.state.base.position, wrench),
                      kContactThreshold * model_.mass() * kGravity);
    own.push_back(at.plane.empty() || !at.known ? kNoBound : use.has_zmp ? use.margin : 0);
  }
  const double safe = std::max(spec_.safe_margin, spec_.zmp_margin);
  for (size_t i = 0; i < own.size(); ++i) {
    double least = own[i];
    for (size_t j = 0; j < own.size(); ++j)
      if (std::abs(instants_[i].sample - instants_[j].sample) * series_.dt <= kAround)
        least = std::min(least, own[j]);
    margin_.push_back(least < spec_.zmp_margin ? safe
                                               : std::clamp(kOwn * own[i], spec_.zmp_margin, safe));
  }
}

// What the motion as given asks of the air, about its planned COG, over the weight.
Vector6d CorrectionProblem::own_wrench(int sample) const {
  const CommandSample& s = series_.samples[sample];
  SupportPlane plane;
  plane.frame.translation() = s.cog;
  RobotData data(model_);
  const Vector6d wrench = inverse_dynamics(model_, s.state, s.acceleration, data).head<6>();
  return plane_wrench(plane, s.state.base.position, wrench) / (model_.mass() * kGravity);
}

// Nothing pushes in flight: half of what the check allows in each of three axes, or what the motion
// does by itself where that passes. The check takes a mean of moments, for those of single samples
// hold the rounding of differences; what a sample is off its mean is not to be mended.
void CorrectionProblem::place_flight_block(int instant) {
  constexpr int kMean = 2;  // samples to either side
  constexpr double kShare = 0.85;
  const int k = instants_[instant].sample, last = static_cast<int>(series_.samples.size()) - 1;
  const Vector6d own = own_wrench(k);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  int count = 0;
  for (int i = std::max(0, k - kMean); i <= std::min(last, k + kMean); ++i) {
    if (series_.samples[i].support != Support::none || at_flight_edge(series_, i)) continue;
    mean += own_wrench(i).tail<3>();
    ++count;
  }
  if (count > 0) mean /= count;
  Vector6d kept, offset = Vector6d::Zero(), slack;
  kept << own.head<3>(), mean;
  offset.tail<3>() = own.tail<3>() - mean;
  const double weight = model_.mass() * kGravity;
  const double most[] = {tolerance(FindingKind::ballistic) / kGravity,
                         tolerance(FindingKind::angular_momentum) / weight};
  for (int part : {0, 1}) {
    const double used = kept.segment<3>(3 * part).norm() / most[part];
    kept.segment<3>(3 * part) *= used > kShare ? 0.0 : 1.0;
    slack.segment<3>(3 * part).setConstant(0.5 / std::sqrt(3.0) * most[part]);
  }
  ConstraintBlock block = block_of(ConstraintGroup::flight, instant, 0, 6);
  block.wrench_rows = Eigen::Matrix<double, 6, 6>::Identity() / weight;
  add_block(std::move(block), 0, 0);
  lower_.tail<6>() = offset + (-slack).cwiseMin(kept);
  upper_.tail<6>() = offset + slack.cwiseMax(kept);
}

void CorrectionProblem::place_friction(int instant) {
  ConstraintBlock block =
      block_of(ConstraintGroup::friction, instant, 0, 1, 1 / (model_.mass() * kGravity));
  block.factor = spec_.share * tolerance(FindingKind::friction) * spec_.friction *
                 (spec_.at_limits ? 1 : kInsideCone);
  add_block(std::move(block), 0, kNoBound);
}

void CorrectionProblem::place_ground_blocks(int instant) {
  const SupportPlane& plane = instants_[instant].plane;
  const double weight = model_.mass() * kGravity;
  auto add = [&](ConstraintGroup group, const MatrixXd& rows, double lower, double upper) {
    ConstraintBlock block = block_of(group, instant, 0, static_cast<int>(rows.rows()));
    block.wrench_rows = rows / weight;
    add_block(std::move(block), lower, upper);
  };
  if (plane.empty()) {
    if (!only_.contains(instants_[instant].sample)) place_flight_block(instant);
    return;
  }
  MatrixXd rows = support_rows(plane);
  rows.col(2).array() -= margin_[instant];
  add(ConstraintGroup::support, rows, 0, kNoBound);

  RobotData data(model_);
  double least_force = weight, most_grip = 0, most_yaw = 0, lever = 0;
  for (const CommandSample* sample : watched(instant)) {
    const Vector6d wrench =
        plane_wrench(plane, sample->state.base.position,
                     inverse_dynamics(model_, sample->state, sample->acceleration, data).head<6>());
    const GroundDemand use = ground_demand(plane, wrench, kContactThreshold * weight);
    least_force = std::min(least_force, use.normal_force);
    if (!use.has_zmp) continue;
    const double grip = spec_.friction * use.normal_force;
    most_grip = std::max(most_grip, use.tangential_force / grip);
    const double arm = spec_.friction * torsional_friction_arm(plane.polygon, use.zmp);
    if (arm > 0) most_yaw = std::max(most_yaw, std::abs(use.yaw_moment) / (arm * use.normal_force));
    if (arm > 0) lever = arm;  // the last one told: that of the current motion
  }
  if (least_force < 0.5 * weight) {
    rows.setZero(1, 6);
    rows(0, 2) = 1;
    add(ConstraintGroup::unilateral, rows, spec_.force_share, kNoBound);
  }
  if (most_grip > spec_.watched_share * tolerance(FindingKind::friction)) place_friction(instant);
  if (lever > 0 && most_yaw > spec_.watched_share * tolerance(FindingKind::yaw_moment)) {
    ConstraintBlock block = block_of(ConstraintGroup::yaw, instant, 0, 2, 1 / weight);
    block.factor = spec_.share * tolerance(FindingKind::yaw_moment) * lever;
    add_block(std::move(block), 0, kNoBound);
  }
}

// A foot that lands or lifts off softly is not quite in its place for a moment. The check allows
// that; what the motion does so by itself stays, up to a share of what is allowed.
void CorrectionProblem::soften_landing(int instant, Side side) {
  constexpr double kMoment = 0.05;  // [s]
  constexpr double kShare = 0.6;
  constexpr double kMargin = 0.4;  // of the band upwards: a swing must not run on between instants
  const CollocationPoint& at = instants_[instant];
  const ContactInterval& contact = plan_.at(side, at.sample);
  const int last = static_cast<int>(series_.samples.size()) - 1;
  const double landed = contact.first == 0 ? kMoment : (at.sample - contact.first) * series_.dt;
  const double left = contact.last == last ? kMoment : (contact.last - at.sample) * series_.dt;
  if (std::min(landed, left) >= kMoment) return;
  const Eigen::Isometry3d& sole = at.path[static_cast<int>(side)];
  const SoleError error = sole_error(model_.sole(side), sole, contact.sole);
  const double used = std::max({error.gap / tolerance(FindingKind::foot_float),
                                error.penetration / tolerance(FindingKind::foot_penetration),
                                error.slip / tolerance(FindingKind::foot_slip)});
  Vector6d own = std::min(1.0, kShare / std::max(used, 1e-9)) * sole_deviation(sole, contact.sole);
  // A sole over its place has not landed yet: that is what is to be mended.
  const Eigen::Vector3d normal = contact.sole.linear().col(2);
  own.head<3>() -= std::max(0.0, normal.dot(own.head<3>())) * normal;
  upper_.tail<6>()[2] *= kMargin;
  lower_.tail<6>() += own.cwiseMin(0);
  upper_.tail<6>() += own.cwiseMax(0);
}

// What a sole may turn in its place: a long one less, for its corners rise and sink.
double CorrectionProblem::sole_angle(Side side) const {
  constexpr double kShare = 0.6;  // of what a corner may be off
  double reach = 0;
  for (const Eigen::Vector2d& v : model_.sole(side).polygon) reach = std::max(reach, v.lpNorm<1>());
  const double off =
      std::min(tolerance(FindingKind::foot_float), tolerance(FindingKind::foot_penetration));
  return std::min(spec_.sole_angle, kShare * off / reach);
}

// As good as nothing; kept_at() does the rest.
void CorrectionProblem::place_kept_pose(int instant) {
  constexpr double kNothing = 1e-7;  // [m], [rad]
  const int k = instants_[instant].sample;
  for (const double t : spec_.kept_instants) {
    if (std::lround(t / series_.dt) != k) continue;
    add_block(block_of(ConstraintGroup::pose, instant, 0, model_.velocity_count()), -kNothing,
              kNothing);
    return;
  }
}

void CorrectionProblem::place_foot_blocks(int instant) {
  for (Side side : {Side::left, Side::right}) {
    const int s = static_cast<int>(side);
    if (instants_[instant].contact[s]) {
      const double share = instants_[instant].at_knot ? spec_.sole_at_knots : 1;
      const double slack =
          share * std::min({spec_.sole_position, 0.2 * tolerance(FindingKind::foot_slip),
                            0.2 * tolerance(FindingKind::foot_penetration),
                            0.2 * tolerance(FindingKind::foot_float)});
      add_block(block_of(ConstraintGroup::stance, instant, s, 6), -slack, slack);
      const double angle = share * sole_angle(side);
      lower_.tail<3>().setConstant(-angle);
      upper_.tail<3>().setConstant(angle);
      soften_landing(instant, side);
    }
    if (spec_.locked_feet[s]) {
      constexpr double kSameWay = 1e-5;  // [m], [rad]
      add_block(block_of(ConstraintGroup::path, instant, s, 6), -kSameWay, kSameWay);
    }
    if (instants_[instant].contact[s] || spec_.locked_feet[s]) continue;
    if (spec_.gentle_swings) place_landing(instant, side);
    place_swing(instant, side);
  }
}

void CorrectionProblem::place_joint_blocks(int instant) {
  const ActuatorLimits& limits = model_.limits(spec_.profile);
  const double soft = model_.description().soft_limit_margin + spec_.joint_margin;
  const VectorXd bound = acceleration_bound(model_, limits, spec_.tolerance);
  for (int i = 0; i < model_.dof_count(); ++i) {
    if (!spec_.locked.empty() && spec_.locked[i]) continue;
    const Dof& dof = model_.dofs()[i];
    const double lower = dof.lower + soft, upper = dof.upper - soft;
    const double fastest = limits.speed[i] * tolerance(FindingKind::joint_speed);
    double position = 0, speed = 0, acceleration = 0;
    for (const CommandSample* sample : watched(instant)) {
      const double theta = sample->state.theta[i];
      if (dof.limited)
        position =
            std::max(position, std::abs(theta - 0.5 * (lower + upper)) / (0.5 * (upper - lower)));
      speed = std::max(speed, std::abs(sample->state.dtheta[i]));
      acceleration = std::max(acceleration, std::abs(sample->acceleration[6 + i]));
    }
    if (position > spec_.watched_share)
      add_block(block_of(ConstraintGroup::position, instant, i, 1), lower, upper);
    if (speed > spec_.watched_share * fastest)
      add_block(block_of(ConstraintGroup::speed, instant, i, 1, 1 / fastest), -spec_.share,
                spec_.share);
    if (acceleration > spec_.watched_share * bound[i])
      add_block(block_of(ConstraintGroup::acceleration, instant, i, 1, 1 / bound[i]), -spec_.share,
                spec_.share);
    // No rougher than a motion that is rough already: that is told, but no fault.
    const double own = std::abs(watched(instant)[0]->acceleration[6 + i]);
    const double roughest = std::max(tolerance(FindingKind::joint_acceleration), own);
    if (acceleration > spec_.watched_share * roughest)
      add_block(block_of(ConstraintGroup::acceleration, instant, i, 1, 1 / roughest), -1, 1);
  }
}

void CorrectionProblem::place_torque_blocks(int instant) {
  const Eigen::VectorXd most =
      model_.limits(spec_.profile).peak_torque * tolerance(FindingKind::joint_torque);
  RobotData data(model_);
  Eigen::VectorXd ratio = Eigen::VectorXd::Zero(model_.dof_count());
  for (const CommandSample* sample : watched(instant)) {
    PointState state;
    state.motion.state = sample->state;
    state.motion.acceleration = sample->acceleration;
    const VectorXd force = inverse_dynamics(model_, sample->state, sample->acceleration, data);
    state.wrench = force.head<6>();
    fill_motor_torques(model_, instants_[instant], force, nullptr, data, state);
    ratio = ratio.cwiseMax(state.torque.cwiseQuotient(most).cwiseAbs());
  }
  for (int i = 0; i < model_.dof_count(); ++i) {
    if (ratio[i] <= spec_.watched_share) continue;
    instants_[instant].torques = true;
    add_block(block_of(ConstraintGroup::torque, instant, i, 1, 1 / most[i]), -spec_.share,
              spec_.share);
  }
}

// f_n times the ZMP from the commanded one, over the weight.
Eigen::Matrix<double, 2, 6> CorrectionProblem::planned_zmp_rows(int instant) const {
  const CollocationPoint& at = instants_[instant];
  const Eigen::Vector3d zmp = at.plane.frame.inverse() * series_.samples[at.sample].zmp;
  Eigen::Matrix<double, 2, 6> rows;
  rows.row(0) << 0, 0, -zmp.x(), 0, -1, 0;
  rows.row(1) << 0, 0, -zmp.y(), 1, 0, 0;
  return rows / (model_.mass() * kGravity);
}

// What is trusted beside the posture.
void CorrectionProblem::place_command_blocks(int instant) {
  const CollocationPoint& at = instants_[instant];
  constexpr double kShare = 0.25;  // of what the check allows
  if (spec_.trust == Trust::cog)
    add_block(block_of(ConstraintGroup::cog, instant, 0, 3),
              -kShare * tolerance(FindingKind::cog_residual),
              kShare * tolerance(FindingKind::cog_residual));
  if (spec_.trust != Trust::zmp || at.plane.empty() || !at.known) return;
  ConstraintBlock block = block_of(ConstraintGroup::zmp, instant, 0, 2);
  block.wrench_rows = planned_zmp_rows(instant);
  const double slack = kShare * tolerance(FindingKind::zmp_residual);
  add_block(std::move(block), -slack, slack);
}

}  // namespace ayumi
