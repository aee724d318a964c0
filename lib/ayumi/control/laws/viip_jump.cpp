// Heights above the ground, r = ref z_G, per unit mass; the reference body obeys z'' = f_z/m - g.
//   stoop   f_z/m = (kz w)^2 (r - zd - z) - 2 dz kz w z' + g            (24)(25)
//   push    f_z/m = k (r - z) + g,  k = 2 g zH / zd^2, until z = r      (26)
//           in its last tick z' = sqrt(2 g (r + zH - z)): the planned apex whatever the tick
//   flight  ballistic; base velocity V_b = M_bb^-1 ([m v; L] - M_bq dtheta), L its own at release
//   absorb  f_z/m = k (z1 - z) + g, k = z1'^2 / zd^2, until z' = 0      (27)
//   settle  as the stoop, towards r
// Zero angular momentum at release: that of a resolution is affine in the trunk's rate, so four
// resolutions give the rate that leaves none; it is blended in along the push, out along (27).
#include "ayumi/control/laws/viip_jump.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/laws/jump_parts.hpp"
#include "ayumi/control/support.hpp"
#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using namespace jump;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kMinForceShare = 0.1;  // of the weight, where feet are to stay on the ground
constexpr double kStoopTime = 5;        // least length of the stoop, times 1/omega
constexpr double kStoopNear = 0.01;     // of ref z_G: the stoop is reached
constexpr double kLean = 1.2;           // of the trunk when stooped, times z_d / ref z_G [rad]
constexpr double kSettleRate = 2.2;     // sqrt(K_Pz / m) after the landing, times omega
constexpr double kLift = 0.5;           // ground force that counts as none [N]
constexpr double kLiftTime = 0.015;     // for which it must last [s]
constexpr double kTargetRate = 3;       // of servo targets, times the joint's speed: they lead it
constexpr double kForwardTime = 0.3;    // over which torques are faded in and out [s]

}  // namespace

JumpFigures jump_figures(const JumpGoal& goal) {
  JumpFigures f;
  const double k = 2 * kGravity * goal.height / (goal.stoop * goal.stoop);
  const bool spring = goal.release == JumpGoal::Release::spring;
  f.lift_off = spring ? kGravity / k : 0.0;
  f.apex = goal.height + (spring ? 0.5 * kGravity / k : 0.0);
  f.lift_off_speed = std::sqrt(2 * kGravity * (f.apex - f.lift_off));
  f.touchdown_speed = std::sqrt(2 * kGravity * f.apex);
  // z - r = -zd cos(sqrt(k) t)
  f.push = std::acos(std::clamp(-f.lift_off / goal.stoop, -1.0, 1.0)) / std::sqrt(k);
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
      held_(held),
      plan_(held),
      data_(model),
      weight_(model.joint_weight()),
      lead_(servo_lead(model)),
      target_(start.target),
      reference_(start.reference),
      dcog_(start.dcog),
      zmp_filtered_(start.plan.zmp.head<2>()),
      zmp_(zmp_filtered_),
      left_(goal.times) {
  if (!(goal.height > 0) || !(goal.stoop > 0) || goal.times < 1)
    fail(ErrorCode::bad_pattern, "jump: height " + text::brief(goal.height) + " m, stoop " +
                                     text::brief(goal.stoop) + " m and times " +
                                     std::to_string(goal.times) + " must be above 0");
  if (goal.stoop > 0.5 * height_ || goal.height > 2 * height_)
    fail(ErrorCode::bad_pattern, "jump: a stoop of " + text::brief(goal.stoop) +
                                     " m or a height of " + text::brief(goal.height) +
                                     " m is out of proportion for a COG at " +
                                     text::brief(height_) + " m");
  if (goal.release == JumpGoal::Release::spring && goal.height <= 0.5 * goal.stoop)
    fail(ErrorCode::bad_pattern,
         "jump: released by the spring, a height of " + text::brief(goal.height) +
             " m needs a stoop below twice that, not " + text::brief(goal.stoop) +
             " m: f_z would never be zero; deepen the height or release at ref_z");
  offset_ = held.cog.head<2>() - middle_of(model, held.feet);
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
    stiffness_ = 2 * kGravity * goal_.height / (depth_ * depth_);
  } else if (stage == Stage::absorb) {
    depth_ = goal_.stoop;
    stiffness_ = dcog_.z() * dcog_.z() / (depth_ * depth_);
  }
}

// Per unit mass times m: ref f_z of the stage.
double ViipJump::vertical_force() const {
  const double m = model_->mass();
  const double z = data_.cog.z() - ground_of(plan_.feet), dz = dcog_.z();
  const auto towards = [&](double goal, double rate) {
    const double f = m * (rate * rate * (goal - z) - 2 * params_.dz * rate * dz + kGravity);
    return std::max(kMinForceShare * m * kGravity, f);
  };
  switch (stage_) {
    case Stage::stoop:
      return towards(height_ - goal_.stoop, params_.kz * omega_);
    case Stage::push:
      return std::max(0.0, m * (stiffness_ * (height_ - z) + kGravity));
    case Stage::flight:
      return 0;
    case Stage::absorb:
      return m * (stiffness_ * (from_ - z) + kGravity);
    case Stage::settle:
      break;
  }
  return towards(height_, kSettleRate * omega_);
}

// Of a push or an absorption, 0 to 1.
double ViipJump::progress() const {
  const double z = data_.cog.z() - ground_of(plan_.feet);
  return std::clamp(std::abs(z - from_) / depth_, 0.0, 1.0);
}

CogReference ViipJump::cog_reference(const Estimate& e) {
  const double m = model_->mass(), ground = ground_of(plan_.feet);
  CogReference ref;
  ref.fz = vertical_force();
  ref.ddcog.z() = ref.fz / m - kGravity;
  const double w2 = omega_squared(ref.fz, m, data_.cog.z() - ground);

  Vector2d goal = middle_of(*model_, plan_.feet) + offset_;
  Vector2d rate = Vector2d::Zero(), acceleration = Vector2d::Zero();
  if (stage_ == Stage::push && goal_.forward != 0) {
    // Speed for the way over push, flight and the same again on landing.
    const JumpFigures f = jump_figures(goal_);
    const double yaw = heading_of(plan_.feet), s = std::min(1.0, elapsed_ / f.push);
    const Vector2d speed =
        goal_.forward / (f.push + f.flight) * Vector2d(std::cos(yaw), std::sin(yaw));
    goal += speed * f.push * (s * s * s - 0.5 * s * s * s * s);
    rate = speed * smooth(s);
    acceleration = speed / f.push * 6 * s * (1 - s);
  }
  const ConvexPolygon polygon =
      support_polygon(*model_, plan_.feet, Support::both).shrunk(params_.margin * height_);
  const auto regulate = [&](const Vector3d& x, const Vector3d& dx) -> Vector2d {
    const Vector2d xi = x.head<2>() - goal + (dx.head<2>() - rate) / omega_;
    const Vector2d zmp = goal + (1 + params_.q) * xi - acceleration / std::max(w2, 1.0);
    return polygon.empty() ? zmp : polygon.project(zmp);
  };
  const Vector2d by_reference = regulate(data_.cog, dcog_);
  zmp_ = params_.feedback ? regulate(e.cog, e.dcog) : by_reference;
  ref.zmp << zmp_, ground;
  Vector2d ddx = w2 * (data_.cog.head<2>() - by_reference);
  if (params_.feedback) {
    ddx += params_.av * omega_ * (e.dcog - dcog_).head<2>() +
           params_.ax * omega_ * omega_ * (e.cog - data_.cog).head<2>();
    if (e.contact) {
      const double filter = 1.0 - std::exp(-dt_ * omega_ / params_.tau_z);
      zmp_filtered_ += filter * (e.zmp.head<2>() - zmp_filtered_);
      ddx += params_.ka * w2 * (zmp_filtered_ - zmp_);
    }
  }
  // What turning the body takes of the ground's moment.
  const double lever = m * (data_.cog.z() - ground);
  ddx += Vector2d(-momentum_rate_.y(), momentum_rate_.x()) / lever;
  ref.ddcog.head<2>() = ddx;
  return ref;
}

// The end of the push falls into this tick: the speed becomes the one whose parabola has the
// planned apex, from where the tick ends.
bool ViipJump::leaves_now() {
  const double spring = goal_.release == JumpGoal::Release::spring ? kGravity / stiffness_ : 0.0;
  const double z = data_.cog.z() - ground_of(plan_.feet) - height_;
  if (z + dt_ * dcog_.z() < spring) return false;
  const double way = std::max(0.0, goal_.height + 0.5 * spring - z);
  dcog_.z() = std::sqrt(kGravity * (kGravity * dt_ * dt_ + 2 * way)) - kGravity * dt_;
  return true;
}

// Forwards, as far as the legs' push and landing turn the trunk back [rad].
double ViipJump::lean() const {
  const double most = kLean * goal_.stoop / height_;
  if (stage_ == Stage::stoop) return most * smooth(elapsed_ * omega_ / kStoopTime);
  return stage_ == Stage::push ? most : 0.0;
}

// `level`: share of the correction that keeps the trunk as the pattern holds it.
Resolution ViipJump::resolve_standing(const Vector3d& trunk_rate, double level) const {
  CommandSample wanted = plan_;
  wanted.state.dtheta.setZero();
  wanted.state.base_angular_velocity = trunk_rate;
  ResolverOptions options;
  options.trunk_rate *= level;
  options.in_order = false;  // docs/theory.md says why
  const double yaw = heading_of(plan_.feet);
  options.lean = lean() * Vector3d(-std::sin(yaw), std::cos(yaw), 0);
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

// Of the servos for the motion of the reference: the ground's wrench is shared by both feet.
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
  for (int j = 0; j < model_->dof_count(); ++j)
    torque[j] += model_->dofs()[j].servo.rotor_inertia * acceleration[6 + j];
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

// The servo target leads by what damping and torque would hold the joint back.
void ViipJump::move_joints(const VectorXd& velocity, ControlOutput& out) {
  const VectorXd tau = torque(velocity);
  const bool last = stage_ == Stage::settle && elapsed_ > kForwardTime;
  forward_ = std::clamp(forward_ + (last ? -dt_ : dt_) / kForwardTime, 0.0, 1.0);
  reference_.dtheta = velocity.tail(model_->dof_count());
  reference_.theta += dt_ * reference_.dtheta;
  out.reference = reference_;
  out.target = reference_.theta + lead_.cwiseProduct(reference_.dtheta);
  for (int j = 0; j < out.target.size(); ++j) {
    const Dof& dof = model_->dofs()[j];
    const double most = limits_.peak_torque[j], step = kTargetRate * limits_.speed[j] * dt_;
    if (dof.servo.kp > 0)
      out.target[j] += smooth(forward_) * std::clamp(tau[j], -most, most) / dof.servo.kp;
    out.target[j] = std::clamp(out.target[j], target_[j] - step, target_[j] + step);
    if (dof.limited) out.target[j] = std::clamp(out.target[j], dof.lower, dof.upper);
  }
  target_ = out.target;
}

void ViipJump::stand(const Estimate& e, ControlOutput& out) {
  anchor_base(*model_, anchor_, plan_.feet[static_cast<size_t>(anchor_)], reference_, data_);
  out.cog = data_.cog;
  out.cog_reference = cog_reference(e);
  dcog_ += dt_ * out.cog_reference.ddcog;
  const bool last = stage_ == Stage::push && leaves_now();
  out.cog_reference.dcog = dcog_;
  const double share = stage_ == Stage::push     ? smooth(2 * progress())
                       : stage_ == Stage::absorb ? 1 - smooth(progress())
                                                 : 0.0;
  const Resolution r = resolve_with_momentum(share);
  for (const std::string& note : limit_notes(*model_, r)) out.notes.push_back(note);
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
          std::abs(z - height_ + goal_.stoop) < kStoopNear * height_)
        enter(Stage::push);
      break;
    case Stage::push: {
      unloaded_ = e.fz < kLift ? unloaded_ + dt_ : 0;
      // Legs that cannot follow the spring any more leave the ground there.
      const bool behind = r.scale < 1 && z > height_;
      if (last || behind || unloaded_ > kLiftTime) {
        release();
      } else if (elapsed_ > 3 * figures.push) {
        out.notes.push_back("no lift-off: the push does not reach its height");
        left_ = 0;
        enter(Stage::settle);
      }
      break;
    }
    case Stage::absorb:
      if (dcog_.z() >= 0) {
        --left_;
        enter(left_ > 0 ? Stage::stoop : Stage::settle);
      }
      break;
    default:
      break;
  }
}

void ViipJump::finish_plan() {
  plan_.support = stage_ == Stage::flight ? Support::none : Support::both;
  const Vector2d goal = middle_of(*model_, plan_.feet) + offset_;
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

ControlOutput ViipJump::update(const Estimate& estimate) {
  ControlOutput out;
  if (stage_ == Stage::flight)
    fly(estimate, out);
  else
    stand(estimate, out);
  finish_plan();
  return out;
}

}  // namespace ayumi
