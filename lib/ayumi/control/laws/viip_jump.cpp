// Heights are above the ground, r = ref z_G, and forces are per unit mass; the reference body obeys
// z'' = f_z/m - g.
//   stoop    f_z/m = (kz w)^2 (r - zd - z) - 2 dz kz w z' + g            (24)(25)
//   push     f_z/m = k (r - z) + g,  k = 2 g zH / zd^2, until z = r      (26)
//            in its last tick z' = sqrt(2 g (r + zH - z)), so the tick does not change the apex
//   flight   ballistic; no foot is anchored and momentum gives the base velocity,
//            V_b = M_bb^-1 ([m v; L_B] - M_bq dtheta),  L_B = L + (p_G - p_B) x m v,
//            with L of the release; the IMU gives the attitude, the parabola the position
//   landing  f_z/m = k (z1 - z) + g, k = z1'^2 / zd^2, until z' = 0      (27)
//   settle   as the stoop, towards r
// The angular momentum is zero at release. The angular momentum of a resolution (28) is affine in
// the trunk's rate, so four resolutions determine the rate at which it is zero. This rate is
// blended in during the push, and out during (27).
#include "ayumi/control/laws/viip_jump.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/support_region.hpp"
#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/linear_solve.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/math/weighted_solve.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Smallest duration of the stoop, as a multiple of 1/omega: 0.75 s on HOAP-1. Measured with the
// prototype: a stoop of 0.4 s leaves the apex 5 mm low, one of 0.8 s does not.
constexpr double kStoopTime = 5;

// Distance from its depth at which the stoop counts as reached, as a multiple of ref z_G: 2 mm on
// HOAP-1. Chosen: an error of the depth that changes the apex by less than the acceptance of 5 %.
// No measured case changes between half and twice the value (constants.md).
constexpr double kStoopReached = 0.01;

// Lean of the trunk in the stoop, per z_d / ref z_G [rad]. Derivation: docs/theory_flight.md,
// "Lean". Measured with version 0.1: with 0, jumps with the release `spring` reach an apex that is
// 8 to 10 % too low.
constexpr double kStoopLean = 1.2;

// sqrt(K_Pz / m) after the landing, as a multiple of omega. Chosen: the COG is back at ref z_G
// within the 0.6 s that the acceptance test requires. Its effect is in constants.md.
constexpr double kSettleRate = 2.2;

// Ground force that counts as zero [N], and the time for which it must last [s]. Measured with the
// prototype: without this time, chattering contacts trigger the release, and the apex is at 10 mm
// instead of 20 mm.
constexpr double kNoForce = 0.5;
constexpr double kNoForceTime = 0.015;

// Largest rate of a servo target, as a multiple of the joint's speed limit: targets lead the joint
// by (delay + kd/kp) dtheta + tau/kp. Chosen: this lead must build up within the push. Between half
// and twice the value, figures change by less than 5 %.
constexpr double kTargetRate = 3;

// Time over which the torque feedforward is faded in and out [s]. Chosen: within the stoop, and
// long against the lag of servos, up to 20 ms. Its effect is in constants.md.
constexpr double kTorqueFadeTime = 0.3;

// Time constant with which the motion of the legs decays after release [s]. Source:
// docs/theory_flight.md, "Flight": an immediate stop would require tens of newton metres. The
// prototype had 20 ms.
constexpr double kRunOnTime = 0.030;

// Before the touchdown, the legs retract with up to this share of the falling speed. They reach the
// share within the first time [s]. They keep it from the second time [s] before the planned
// touchdown until the same time after it. Measured on 23 jumps of HOAP-1 (z_H 20 to 50 mm, both
// releases), as the largest ratio of the peak force to twice the peak force of (27): 0.71 with
// these values, 0.81 with 0.07 s for the first time. With 0.02 s for the second time, or a share of
// 0.95, the legs are stretched too far before the touchdown, and in the highest jumps the ratio is
// 1.5 and 2.1.
constexpr double kRetractionTime = 0.050;
constexpr double kRetractionHold = 0.010;
constexpr double kRetractionShare = 0.9;

// Longest retraction as a share of the flight. Chosen: the legs then have the middle of the flight
// to swing to their landing places. Its effect is in constants.md.
constexpr double kRetractionFlightShare = 0.4;

// Time after release in which forces do not yet mean a touchdown [s]. Chosen with the prototype:
// the feet may still touch the ground that they leave. No measured case changes between half and
// twice the value (constants.md).
constexpr double kTouchdownBlindTime = 0.040;

// A touchdown is a force of the first share of the weight that lasts for the time [s], or a force
// of the second, larger share at once. Chosen: above the noise of the load cells, within three
// ticks of the impact. Between half and twice the value, figures change by less than 5 %.
constexpr double kTouchdownShare = 0.1;
// No measured case changes between half and twice the value (constants.md).
constexpr double kTouchdownTime = 0.003;
// Its effect is in constants.md.
constexpr double kHardTouchdownShare = 0.4;

// A flight that is longer than planned by this ends as if the feet had touched down [s]. Chosen:
// half of the duration of a flight with an apex of 0.1 m; the landing then meets a ground that is
// lower than planned. No measured case changes between half and twice the value (constants.md).
constexpr double kLateTouchdown = 0.15;

// Correction of the feet in flight [1/s], pull towards the held posture [1/s], damping of the
// flight's solve (times trace / rows) and the length that makes its angular rows comparable with
// linear ones [m]. Chosen as in control/whole_body; the feet only have the 0.1 s of the flight.
// Its effect is in constants.md.
constexpr double kFlightFootRate = 40;
// Between half and twice the value, figures change by less than 5 %.
constexpr double kFlightPostureRate = 2;
// Its effect is in constants.md.
constexpr double kFlightDamping = 1e-5;
// Its effect is in constants.md.
constexpr double kFlightLength = 0.2;

double smooth_rise(double x) {
  const double s = std::clamp(x, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

Vector2d middle_of_soles(const RobotModel& model, const std::array<Eigen::Isometry3d, 2>& feet) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Side side : {Side::left, Side::right}) {
    const Eigen::Vector2d& c = model.sole(side).center;
    sum += 0.5 * (feet[static_cast<size_t>(side)] * Eigen::Vector3d(c.x(), c.y(), 0)).head<2>();
  }
  return sum;
}

double heading_of_feet(const std::array<Eigen::Isometry3d, 2>& feet) {
  const Eigen::Vector3d x = feet[0].linear().col(0) + feet[1].linear().col(0);
  return elementary::atan2(x.y(), x.x());
}

/// The angular momentum about the COG for each unit of generalised velocity: 3 x (6 + dof).
Eigen::MatrixXd angular_momentum_rows(const RobotData& data, const Eigen::MatrixXd& M) {
  return M.middleRows<3>(3) - skew(data.cog_offset) * M.topRows<3>();
}

}  // namespace

JumpFigures jump_figures(const JumpGoal& goal) {
  JumpFigures f;
  const double k = push_stiffness(goal.height, goal.stoop);
  const bool spring = goal.release == JumpGoal::Release::spring;
  f.lift_off = spring ? kGravity / k : 0.0;
  f.apex = goal.height + (spring ? 0.5 * kGravity / k : 0.0);
  f.lift_off_speed = std::sqrt(2 * kGravity * (f.apex - f.lift_off));
  f.touchdown_speed = std::sqrt(2 * kGravity * f.apex);
  // z - r = -zd cos(sqrt(k) t)
  f.push = elementary::acos(std::clamp(-f.lift_off / goal.stoop, -1.0, 1.0)) / std::sqrt(k);
  f.flight = (f.lift_off_speed + f.touchdown_speed) / kGravity;
  return f;
}

ViipJump::ViipJump(const RobotModel& model, const ActuatorLimits& limits, const ViipParams& params,
                   double dt, const Handover& start, const CommandSample& held,
                   const JumpGoal& goal)
    : model_(&model),
      limits_(limits),
      params_(params),
      dt_(dt),
      goal_(goal),
      height_(held.cog.z() - ground_of(held.feet)),
      omega_(std::sqrt(kGravity / height_)),
      command_(start.command),
      held_(held),
      plan_(held),
      data_(model),
      weight_(model.joint_weight()),
      lead_(velocity_lead(limits)),
      target_(start.target),
      reference_(start.reference),
      dcog_(start.dcog),
      filter_(start.plan.zmp.head<2>(), start.plan.fz),
      zmp_(filter_.zmp()),
      left_(goal.times) {
  if (!(goal.height > 0) || !(goal.stoop > 0) || goal.times < 1)
    fail(ErrorCode::bad_pattern, "jump: the height is " + text::brief(goal.height) +
                                     " m, the stoop is " + text::brief(goal.stoop) +
                                     " m and the number of jumps is " + std::to_string(goal.times) +
                                     "; all three must be above 0");
  if (goal.stoop > 0.5 * height_ || goal.height > 2 * height_)
    fail(ErrorCode::bad_pattern,
         "jump: the stoop is " + text::brief(goal.stoop) + " m and the height is " +
             text::brief(goal.height) + " m. With the COG at a height of " + text::brief(height_) +
             " m, the stoop must be at most " + text::brief(0.5 * height_) +
             " m and the height must be at most " + text::brief(2 * height_) + " m");
  if (goal.release == JumpGoal::Release::spring && goal.height <= 0.5 * goal.stoop)
    fail(ErrorCode::bad_pattern,
         "jump: with the release 'spring' the stoop must be less than twice the height of " +
             text::brief(goal.height) + " m. With a stoop of " + text::brief(goal.stoop) +
             " m, f_z would never be zero. Choose a smaller stoop or a larger height, or set the "
             "release to 'ref_z'");
  offset_ = held.cog.head<2>() - middle_of_soles(model, held.feet);
  plan_.feet = start.plan.feet;
  plan_.support = Support::both;
  if (start.plan.support == Support::right) anchor_ = Side::right;
  anchor_base(model, anchor_, plan_.feet[static_cast<size_t>(anchor_)], reference_, data_);
  enter(Stage::stoop);
  finish_plan();
}

void ViipJump::enter(Stage stage) {
  stage_ = stage;
  elapsed_ = 0;
  unloaded_ = loaded_ = 0;
  from_ = data_.cog.z() - ground_of(plan_.feet);
  if (stage == Stage::push) {
    depth_ = height_ - from_;
    stiffness_ = push_stiffness(goal_.height, depth_);
  } else if (stage == Stage::landing) {
    depth_ = goal_.stoop;
    stiffness_ = landing_stiffness(dcog_.z(), depth_);
  }
}

LawStage ViipJump::law_stage() const {
  switch (stage_) {
    case Stage::stoop:
      return LawStage::stoop;
    case Stage::push:
      return LawStage::push;
    case Stage::flight:
      return LawStage::flight;
    case Stage::landing:
      return LawStage::landing;
    case Stage::settle:
      break;
  }
  return LawStage::settle;
}

// The ref f_z of the stage, by (24)-(27) with gains per unit of mass.
double ViipJump::vertical_force(LawTerms& terms) const {
  const double m = model_->mass();
  const double z = data_.cog.z() - ground_of(plan_.feet), dz = dcog_.z();
  const auto note = [&](double goal, const HeightGains& gains) {
    terms.K_Pz = m * gains.stiffness;
    terms.K_Dz = m * gains.damping;
    terms.spring_goal = goal;
    terms.spring_height = z;
    terms.spring_rate = dz;
  };
  const auto towards = [&](double goal, double rate) {
    const HeightGains gains = {rate * rate, 2 * params_.height_damping * rate};
    note(goal, gains);
    return admissible_force(m * height_force(gains, kGravity, goal, z, dz), m);
  };
  const auto spring = [&](double middle) {
    note(middle, {stiffness_, 0});
    return m * height_force({stiffness_, 0}, kGravity, middle, z, dz);
  };
  switch (stage_) {
    case Stage::stoop:
      return towards(height_ - goal_.stoop, params_.height_rate * omega_);
    case Stage::push:
      return std::max(0.0, spring(height_));
    case Stage::flight:
      return 0;
    case Stage::landing:
      return spring(from_);
    case Stage::settle:
      break;
  }
  return towards(height_, kSettleRate * omega_);
}

// The share of a push or a landing that has passed, 0 to 1.
double ViipJump::progress() const {
  const double z = data_.cog.z() - ground_of(plan_.feet);
  return std::clamp(std::abs(z - from_) / depth_, 0.0, 1.0);
}

CogReference ViipJump::cog_reference(const Estimate& e, LawTerms& terms) {
  const double m = model_->mass(), ground = ground_of(plan_.feet);
  CogReference ref;
  const double z = data_.cog.z() - ground;
  terms = {.stage = law_stage(), .height = z};
  ref.fz = vertical_force(terms);
  ref.ddcog.z() = vertical_acceleration(ref.fz, m);
  const double w2 = omega_squared(ref.fz, m, z);
  terms.omega2 = w2;
  terms.motion.z() = ref.ddcog.z();

  Vector2d goal = middle_of_soles(*model_, plan_.feet) + offset_;
  Vector2d rate = Vector2d::Zero(), acceleration = Vector2d::Zero();
  if (stage_ == Stage::push && goal_.forward != 0) {
    // The horizontal speed with which the robot covers the distance during push, flight and
    // landing; the landing lasts as long as the push.
    const JumpFigures f = jump_figures(goal_);
    const double yaw = heading_of_feet(plan_.feet), s = std::min(1.0, elapsed_ / f.push);
    const Vector2d speed =
        goal_.forward / (f.push + f.flight) * Vector2d(elementary::cos(yaw), elementary::sin(yaw));
    goal += speed * f.push * (s * s * s - 0.5 * s * s * s * s);
    rate = speed * smooth_rise(s);
    acceleration = speed / f.push * 6 * s * (1 - s);
  }
  const ConvexPolygon polygon =
      support_polygon(*model_, plan_.feet, Support::both).shrunk(params_.margin * height_);
  // (18)(19) about the moving goal.
  const auto regulate = [&](const Vector3d& x, const Vector3d& dx) -> Vector2d {
    const Vector2d dcm = x.head<2>() - goal + (dx.head<2>() - rate) / omega_;
    return goal + (1 + params_.pole_ratio) * dcm - acceleration / std::max(w2, 1.0);
  };
  const auto inside = [&](const Vector2d& zmp) {
    return polygon.empty() ? zmp : polygon.project(zmp);
  };
  Vector2d wanted = regulate(data_.cog, dcog_);
  const Vector2d by_reference = inside(wanted);
  if (params_.feedback) wanted = regulate(e.cog, e.dcog);
  zmp_ = inside(wanted);
  terms.K = 1 + params_.pole_ratio;
  terms.D = terms.K / omega_;
  terms.planned_zmp << by_reference, ground;
  terms.wanted_zmp << wanted, ground;
  ref.zmp << zmp_, ground;
  const ReferencePendulum reference = {data_.cog.head<2>(), dcog_.head<2>(), by_reference};
  Vector2d ddx = viip_acceleration(params_, omega_, w2, dt_, reference, zmp_, e, filter_, terms);
  // The share of the ground's moment that turns the body.
  const Vector2d turning = turning_acceleration(momentum_rate_, m, z);
  ddx += turning;
  terms.motion.head<2>() += turning;
  terms.filtered_zmp << filter_.zmp(), ground;
  ref.ddcog.head<2>() = ddx;
  return ref;
}

// Whether the end of the push falls into this tick. If so, the speed becomes the one whose parabola
// has the planned apex, from the place where the tick ends.
bool ViipJump::leaves_now() {
  const double spring = goal_.release == JumpGoal::Release::spring ? kGravity / stiffness_ : 0.0;
  const double z = data_.cog.z() - ground_of(plan_.feet) - height_;
  if (z + dt_ * dcog_.z() < spring) return false;
  const double rise = std::max(0.0, goal_.height + 0.5 * spring - z);
  dcog_.z() = std::sqrt(kGravity * (kGravity * dt_ * dt_ + 2 * rise)) - kGravity * dt_;
  return true;
}

// Forward lean of the trunk that compensates for its turn during push and landing [rad].
double ViipJump::lean() const {
  const double most = kStoopLean * goal_.stoop / height_;
  if (stage_ == Stage::stoop) return most * smooth_rise(elapsed_ * omega_ / kStoopTime);
  return stage_ == Stage::push ? most : 0.0;
}

// `level` is the share of the correction that keeps the trunk as the pattern holds it.
Resolution ViipJump::resolve_standing(const Vector3d& trunk_rate, double level) const {
  CommandSample wanted = plan_;
  wanted.state.dtheta.setZero();
  wanted.state.base_angular_velocity = trunk_rate;
  ResolverOptions options;
  options.trunk_rate *= level;
  options.in_order = false;  // docs/theory_flight.md gives the reason
  const double yaw = heading_of_feet(plan_.feet);
  options.turn.lean = lean() * Vector3d(-elementary::sin(yaw), elementary::cos(yaw), 0);
  return resolve(*model_, limits_, reference_, data_, anchor_, dcog_, wanted, wanted, dt_, weight_,
                 options);
}

Resolution ViipJump::resolve_with_momentum(double share) {
  if (share <= 0) return resolve_standing(Vector3d::Zero(), 1);
  MatrixXd M;
  mass_matrix(*model_, data_, M);
  const MatrixXd momentum =
      angular_momentum_rows(data_, M) * anchored_velocity_map(*model_, data_, anchor_);
  const Vector3d without = momentum * resolve_standing(Vector3d::Zero(), 0).dtheta;
  Matrix3d per_rate;
  for (int i = 0; i < 3; ++i)
    per_rate.col(i) = momentum * resolve_standing(Vector3d::Unit(i), 0).dtheta - without;
  const Vector3d rate = -per_rate.partialPivLu().solve(without);
  return resolve_standing(share * rate, 1 - share);
}

// Torques of the servos for the motion of the reference. Both feet take equal shares of the
// ground's wrench.
VectorXd ViipJump::torque(const VectorXd& velocity) {
  const VectorXd acceleration = velocity_.size() == 0 ? VectorXd(VectorXd::Zero(velocity.size()))
                                                      : VectorXd((velocity - velocity_) / dt_);
  velocity_ = velocity;
  RobotState state = reference_;
  state.base_velocity = velocity.head<3>();
  state.base_angular_velocity = velocity.segment<3>(3);
  state.dtheta = velocity.tail(model_->dof_count());
  const VectorXd force = inverse_dynamics(*model_, state, acceleration, data_);
  VectorXd torque = force.tail(model_->dof_count());
  for (int j = 0; j < model_->dof_count(); ++j) {
    const ServoDescription& servo = limits_.servo[static_cast<size_t>(j)];
    const double rate = state.dtheta[j];
    torque[j] += servo.rotor_inertia * acceleration[6 + j] + servo.viscous * rate +
                 servo.coulomb * std::clamp(rate / kCoulombRate, -1.0, 1.0);
  }
  if (stage_ == Stage::flight) return torque;
  const Vector3d f = 0.5 * force.head<3>(), n = 0.5 * force.segment<3>(3);
  for (const Side side : {Side::left, Side::right})
    for (int i = model_->sole(side).body; i > 0; i = model_->bodies()[i].parent) {
      const Body& body = model_->bodies()[i];
      torque[body.dof] -=
          body.ratio *
          data_.axis[i].dot(body.prismatic ? f : Vector3d(n - data_.position[i].cross(f)));
    }
  return torque;
}

// The servo target leads the posture by the angle by which damping and torque would hold the joint
// back.
void ViipJump::move_joints(const VectorXd& velocity, ControlOutput& out) {
  const VectorXd tau = torque(velocity);
  const bool last = stage_ == Stage::settle && elapsed_ > kTorqueFadeTime;
  forward_ = std::clamp(forward_ + (last ? -dt_ : dt_) / kTorqueFadeTime, 0.0, 1.0);
  reference_.dtheta = velocity.tail(model_->dof_count());
  out.reference = reference_;  // the posture of this tick with its base
  reference_.theta += dt_ * reference_.dtheta;
  out.target = reference_.theta + lead_.cwiseProduct(reference_.dtheta);
  for (int j = 0; j < out.target.size(); ++j) {
    const Dof& dof = model_->dofs()[j];
    const double most = limits_.peak_torque[j], step = kTargetRate * limits_.speed[j] * dt_;
    const double kp = limits_.servo[static_cast<size_t>(j)].kp;
    if (kp > 0) out.target[j] += smooth_rise(forward_) * std::clamp(tau[j], -most, most) / kp;
    out.target[j] = std::clamp(out.target[j], target_[j] - step, target_[j] + step);
    if (dof.limited) out.target[j] = std::clamp(out.target[j], dof.lower, dof.upper);
  }
  target_ = out.target;
}

void ViipJump::stand(const Estimate& e, ControlOutput& out) {
  anchor_base(*model_, anchor_, plan_.feet[static_cast<size_t>(anchor_)], reference_, data_);
  out.cog = data_.cog;
  out.cog_reference = cog_reference(e, out.terms);
  dcog_ += dt_ * out.cog_reference.ddcog;
  const bool last = stage_ == Stage::push && leaves_now();
  out.cog_reference.dcog = dcog_;
  const double share = stage_ == Stage::push      ? smooth_rise(2 * progress())
                       : stage_ == Stage::landing ? 1 - smooth_rise(progress())
                                                  : 0.0;
  const Resolution r = resolve_with_momentum(share);
  for (const std::string& note : limit_notes(*model_, r)) out.notes.push_back(note);
  out.residuals = r.residuals;
  out.weight = weight_;
  dcog_ *= r.scale;
  const VectorXd velocity = anchored_velocity_map(*model_, data_, anchor_) * r.dtheta;
  MatrixXd M;
  mass_matrix(*model_, data_, M);
  const Vector3d momentum = angular_momentum_rows(data_, M) * velocity;
  if (velocity_.size() > 0) momentum_rate_ = (momentum - momentum_) / dt_;
  momentum_ = momentum;
  move_joints(velocity, out);
  elapsed_ += dt_;

  const double z = data_.cog.z() - ground_of(plan_.feet) + dt_ * dcog_.z();
  const JumpFigures figures = jump_figures(goal_);
  switch (stage_) {
    case Stage::stoop:
      if (elapsed_ > kStoopTime / omega_ &&
          std::abs(z - height_ + goal_.stoop) < kStoopReached * height_)
        enter(Stage::push);
      break;
    case Stage::push: {
      unloaded_ = e.fz < kNoForce ? unloaded_ + dt_ : 0;
      // If the legs can no longer follow the spring, the robot leaves the ground at this moment.
      const bool behind = r.scale < 1 && z > height_;
      if (last || behind || unloaded_ > kNoForceTime) {
        release();
      } else if (elapsed_ > 3 * figures.push) {
        out.notes.push_back(
            "no lift-off: the COG does not reach the lift-off height in the push phase");
        left_ = 0;
        enter(Stage::settle);
      }
      break;
    }
    case Stage::landing:
      if (dcog_.z() >= 0) {
        --left_;
        enter(left_ > 0 ? Stage::stoop : Stage::settle);
      }
      break;
    default:
      break;
  }
}

// The flight begins at the posture to which the joints were moved in this tick.
void ViipJump::release() {
  const VectorXd rates = anchored_velocity_map(*model_, data_, anchor_) * reference_.dtheta;
  MatrixXd M;
  mass_matrix(*model_, data_, M);
  flight_.momentum = angular_momentum_rows(data_, M) * rates;
  flight_.velocity = M.topRows<3>() * rates / model_->mass();
  anchor_base(*model_, anchor_, plan_.feet[static_cast<size_t>(anchor_)], reference_, data_);
  flight_.cog = data_.cog;
  const double v = flight_.velocity.z(), ground = ground_of(plan_.feet);
  const double fall = std::max(0.0, flight_.cog.z() - ground - height_);
  const double down = std::sqrt(v * v + 2 * kGravity * fall);
  flight_.duration = (v + down) / kGravity;
  flight_.touchdown_speed = down;
  const double scale = std::min(
      1.0, kRetractionFlightShare * flight_.duration / (kRetractionTime + kRetractionHold));
  flight_.rise = scale * kRetractionTime;
  flight_.hold = scale * kRetractionHold;
  flight_.retraction = retraction(flight_.duration);

  const double yaw = heading_of_feet(plan_.feet);
  const Vector3d forward = goal_.forward * Vector3d(elementary::cos(yaw), elementary::sin(yaw), 0);
  Vector3d landing = flight_.cog + flight_.duration * flight_.velocity;
  landing.z() = ground + height_ + flight_.retraction;
  for (const Side side : {Side::left, Side::right}) {
    const auto s = static_cast<size_t>(side);
    flight_.feet[s] = plan_.feet[s].translation() - flight_.cog;
    plan_.feet[s].translation() += forward;
    flight_.landing[s] = plan_.feet[s].translation() - landing;
  }
  enter(Stage::flight);
}

// Distance by which the legs have retracted before the coming touchdown, t after release. It is the
// integral of a share of the falling speed. The share rises, stays constant and fades.
double ViipJump::retraction(double t) const {
  const double T = flight_.duration, rise = flight_.rise, hold = flight_.hold;
  const double begin = T - hold - rise;  // times after release [s]
  if (t <= begin) return 0;
  const auto falling = [&](double at) { return flight_.touchdown_speed + kGravity * (at - T); };
  const double u = std::min(1.0, (t - begin) / rise);
  double way =
      rise * u * u * (falling(begin) * (1 - u / 3) + kGravity * rise * u * (2.0 / 3 - u / 4));
  if (u == 1) {
    const double held = std::min(t, T + hold) - (T - hold);
    way += held * (falling(T - hold) + kGravity * held / 2);
  }
  if (t > T + hold) way += rise * falling(T + hold) * (1 - elementary::exp((T + hold - t) / rise));
  return kRetractionShare * way;
}

// Place of a sole relative to the COG, t after release. The legs first keep the speed that they
// had, swing to the landing places, and retract shortly before the landing.
Vector3d ViipJump::foot_position(int side, double t) const {
  const Flight& f = flight_;
  const auto s = static_cast<size_t>(side);
  const double T = f.duration;
  const double swung = smooth_rise((t / T - 0.05) / 0.75);
  Vector3d place = f.feet[s] + swung * (f.landing[s] - f.feet[s]) -
                   (1 - swung) * f.velocity * t * elementary::exp(-t / kRunOnTime);
  place.z() += retraction(t);
  return place;
}

void ViipJump::fly(const Estimate& e, ControlOutput& out) {
  const double t = elapsed_;
  const Vector3d fall(0, 0, -kGravity);
  const Vector3d cog = flight_.cog + t * flight_.velocity + 0.5 * t * t * fall;
  dcog_ = flight_.velocity + t * fall;
  reference_.base.attitude = e.state.base.attitude;
  reference_.base.position.setZero();
  update_positions(*model_, reference_, data_);
  reference_.base.position = cog - data_.cog;
  move_base(reference_.base, data_);
  out.cog = cog;
  out.cog_reference = {Vector3d(zmp_.x(), zmp_.y(), ground_of(plan_.feet)), 0, fall, dcog_};
  out.terms = {.stage = LawStage::flight};
  out.terms.planned_zmp = out.terms.wanted_zmp = out.cog_reference.zmp;
  out.terms.motion = fall;

  MatrixXd M;
  mass_matrix(*model_, data_, M);
  const int n = model_->dof_count();
  Eigen::Matrix<double, 6, 1> momentum;  // vectors about the base origin
  momentum << model_->mass() * dcog_,
      flight_.momentum + data_.cog_offset.cross(model_->mass() * dcog_);
  const MatrixXd base_inertia = M.topLeftCorner<6, 6>();
  const MatrixXd base_map = -solve_general(base_inertia, MatrixXd(M.topRightCorner(6, n)));
  const VectorXd base_drift = solve_general(base_inertia, VectorXd(momentum));

  MatrixXd J(12, n);
  VectorXd u(12);
  for (const Side side : {Side::left, Side::right}) {
    const int s = static_cast<int>(side);
    const Isometry3d sole = sole_pose(*model_, data_, side);
    const MatrixXd rows =
        body_jacobian(*model_, data_, model_->sole(side).body, sole.translation());
    Eigen::Matrix<double, 6, 1> wanted;
    const Vector3d now = foot_position(s, t), next = foot_position(s, t + dt_);
    wanted.head<3>() =
        (next - now) / dt_ + dcog_ + kFlightFootRate * (cog + now - sole.translation());
    wanted.tail<3>() =
        kFlightFootRate *
        log_rotation(Eigen::Quaterniond(
            Matrix3d(plan_.feet[static_cast<size_t>(s)].linear() * sole.linear().transpose())));
    J.middleRows<6>(6 * s) = rows.rightCols(n) + rows.leftCols<6>() * base_map;
    u.segment<6>(6 * s) = wanted - rows.leftCols<6>() * base_drift;
    J.middleRows<3>(6 * s + 3) *= kFlightLength;
    u.segment<3>(6 * s + 3) *= kFlightLength;
  }
  const VectorXd bias = kFlightPostureRate * (held_.state.theta - reference_.theta);
  VectorXd dtheta = weighted_least_norm(J, u, weight_, bias, kFlightDamping);
  for (int j = 0; j < n; ++j) {
    const Dof& dof = model_->dofs()[j];
    dtheta[j] = std::clamp(dtheta[j], -limits_.speed[j], limits_.speed[j]);
    if (dof.limited)
      dtheta[j] = std::clamp(dtheta[j], (dof.lower - reference_.theta[j]) / dt_,
                             (dof.upper - reference_.theta[j]) / dt_);
  }
  // The rows of both soles.
  const VectorXd left = J * dtheta - u;
  out.residuals = {};
  out.residuals.foot = elementary::hypot(left.head<3>().norm(), left.segment<3>(6).norm());
  out.residuals.foot_turn =
      elementary::hypot(left.segment<3>(3).norm(), left.tail<3>().norm()) / kFlightLength;
  out.weight = weight_;
  VectorXd velocity(6 + n);
  velocity << base_map * dtheta + base_drift, dtheta;
  move_joints(velocity, out);
  elapsed_ += dt_;
  const double load = e.fz / (model_->mass() * kGravity);
  loaded_ = load > kTouchdownShare ? loaded_ + dt_ : 0;
  const bool touched =
      elapsed_ > kTouchdownBlindTime && (loaded_ >= kTouchdownTime || load > kHardTouchdownShare);
  if (touched) dcog_.z() = std::min(speed_before_, 0.0);  // (27) uses the measured speed
  if (touched || elapsed_ > flight_.duration + kLateTouchdown) touch_down(e);
}

// The vertical speed of the COG. While the feet carry load, it is measured relative to the ground;
// after that, it is the integral of the load cells' reading minus the weight. Load cells and
// encoders have the same delay, so the delay does not change the measured duration of a flight. The
// speed before an impact is the one before the load began.
void ViipJump::measure_speed(const Estimate& e) {
  const double load = e.fz / (model_->mass() * kGravity);
  const bool may_land = stage_ == Stage::flight && elapsed_ > kTouchdownBlindTime;
  if (load <= kTouchdownShare) speed_before_ = speed_;
  if (load > kHardTouchdownShare && !may_land)
    speed_ = e.dcog.z();
  else
    speed_ += dt_ * kGravity * ((load > kTouchdownShare ? load : 0.0) - 1);
}

// The reference continues from the posture and speed at the landing.
void ViipJump::touch_down(const Estimate& e) {
  momentum_rate_.setZero();
  velocity_.resize(0);
  zmp_ = e.zmp.head<2>();
  filter_ = ReactionFilter(zmp_, e.fz);
  const auto a = static_cast<size_t>(anchor_), f = static_cast<size_t>(other(anchor_));
  anchor_base(*model_, anchor_, plan_.feet[a], reference_, data_);
  // The other foot stays where it has come down.
  const Isometry3d sole = sole_pose(*model_, data_, other(anchor_));
  const double height = plan_.feet[f].translation().z();
  plan_.feet[f].translation() << sole.translation().head<2>(), height;
  plan_.feet[f].linear() = rpy_to_matrix({0, 0, matrix_to_rpy(sole.linear()).z()});
  enter(Stage::landing);
}

void ViipJump::finish_plan() {
  plan_.support = stage_ == Stage::flight ? Support::none : Support::both;
  const Vector2d goal = middle_of_soles(*model_, plan_.feet) + offset_;
  plan_.cog << goal, height_ + ground_of(plan_.feet);
  plan_.dcog.setZero();
  plan_.ddcog.setZero();
  plan_.zmp << zmp_, ground_of(plan_.feet);
  plan_.fz = stage_ == Stage::flight ? 0.0 : model_->mass() * kGravity;
  plan_.state.base = held_.state.base;
  plan_.state.base.position.head<2>() += goal - held_.cog.head<2>();
  plan_.state.theta = held_.state.theta;
  plan_.state.dtheta.setZero();
}

void ViipJump::update(const Estimate& estimate, ControlOutput& out) {
  measure_speed(estimate);
  if (stage_ == Stage::flight)
    fly(estimate, out);
  else
    stand(estimate, out);
  finish_plan();
}

}  // namespace ayumi
