// Per axis x (y alike), hats measured, r reference, xi = x + dx/w, polygon Pi of the feet down:
//   standing  Z(xi) = Pi[xd + (1 + q)(xi - xd)]
//   stepping  Z(xi) = Pi[(xi_e - xi E) / (1 - E)],  E = exp(w T) to the landing, xi_e = p + b
//   reffz = m (kz w)^2 (zd - zr) - 2 dz m kz w dzr + m g              (24), (25) with the mass
//   w2    = reffz / (m zr)                                            (17)
//   ddxr  = w2 (xr - Z(xi_r)) + ka w2 (zhat - Z(xi^)) + av w (dx^ - dxr) + ax w^2 (x^ - xr)
// The first term is (14) of the reference pendulum, the second the short-term absorption of
// dtad.cpp, the others keep the reference at the robot. A foot lands where xi^ will need it:
// Z + (xi^ - Z) E - b.
#include "ayumi/control/laws/viip.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/control/support.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kMinForceShare = 0.1;    // of the weight: f_min of the projection of f_z
constexpr double kLeastToLanding = 0.06;  // a landing is never aimed at from nearer than this [s]
constexpr double kShiftNear = 0.027;      // xi is where the first step starts, times z
constexpr double kShiftTime = 2.4;        // least length of the shift, times 1/omega
constexpr double kSettle = 5;             // kept for standing after timed steps, times 1/omega
constexpr double kTouchShare = 0.1;       // of the weight: the swing foot has landed
constexpr double kTouchAfter = 0.6;       // of the swing: earlier forces are not a landing
constexpr double kMostHurry = 4;          // of a step that comes sooner, times its own pace
constexpr double kHabit = 0.5;            // of what a foot misses is learned at each landing
constexpr double kMostHabit = 0.015;      // and at most this, times z
constexpr double kLeastReplan = 0.03;     // a swing is not planned for less than this [s]
constexpr double kFootClearance = 0.008;  // between the soles' sides [m]

GroundPose middle(const RobotModel& model, const std::array<Isometry3d, 2>& feet) {
  const GroundPose left = ground_pose(model, Side::left, feet[0]);
  const GroundPose right = ground_pose(model, Side::right, feet[1]);
  return {0.5 * (left.position + right.position),
          left.yaw + 0.5 * std::remainder(right.yaw - left.yaw, 2 * M_PI)};
}

Vector3d rotated(const Vector3d& v, double yaw) { return rpy_to_matrix({0, 0, yaw}) * v; }

}  // namespace

double stepping_time(const ViipParams& p, double omega, int steps) {
  return (kShiftTime + steps * (p.single + p.both) + kSettle) / omega;
}

double viip_force(const ViipParams& p, double mass, double omega, double goal, double z,
                  double dz) {
  const double rate = p.kz * omega;
  const double kp_z = mass * rate * rate, kd_z = 2 * p.dz * std::sqrt(mass * kp_z);
  return kp_z * (goal - z) - kd_z * dz + mass * kGravity;
}

Viip::Viip(const RobotModel& model, const ActuatorLimits& limits, const ViipParams& params,
           double dt, const Handover& start, const CommandSample& held)
    : model_(&model),
      params_(params),
      dt_(dt),
      omega_(std::sqrt(kGravity / (held.cog.z() - ground_of(held.feet)))),
      height_(held.cog.z() - ground_of(held.feet)),
      body_(model, limits, dt, start.reference, start.target, {.in_order = false}),
      data_(model),
      held_(held),
      plan_(held),
      footsteps_(model, start.plan.feet, (params.single + params.both) / omega_,
                 std::exp(params.single + params.both), params.hold, params.inside * height_) {
  body_.take_over(start);
  const GroundPose from = middle(model, held.feet);
  Vector3d from3(from.position.x(), from.position.y(), ground_of(held.feet));
  offset_ = rotated(held.cog - from3, -from.yaw);
  plan_.feet = start.plan.feet;
  plan_.support = Support::both;
  plan_.state.dtheta.setZero();
  if (start.plan.support == Support::right) anchor_ = Side::right;
  zmp_filtered_ = start.plan.zmp.head<2>();
  zmp_ = zmp_before_ = {zmp_filtered_, zmp_filtered_};
  next_ = plan_;
  body_.anchor(anchor_, plan_.feet[index(anchor_)]);
  finish_plan();
  plan_ = next_;
}

void Viip::set_goal(const ViipGoal& goal, long ticks) {
  ticks_left_ = ticks;
  if (const auto* cog = std::get_if<CogGoal>(&goal)) {
    displacement_[0] = cog->displacement;
    steps_left_ = stage_ == Stage::single ? 1 : 0;  // a foot in the air comes down first
    if (stage_ == Stage::shift) stage_ = Stage::stand;
  } else if (const auto* steps = std::get_if<StepGoal>(&goal)) {
    steps_ = *steps;
    displacement_[0].setZero();
    start_steps();
  }
  finish_plan();
  plan_ = next_;
}

// How many swings: as asked, or as many as fit.
void Viip::start_steps() {
  const double period = (params_.single + params_.both) / omega_;
  const double time = static_cast<double>(ticks_left_) * dt_ - (kSettle + kShiftTime) / omega_;
  steps_left_ = steps_.steps > 0 ? steps_.steps : std::max(0, static_cast<int>(time / period));
  if (steps_left_ == 0 || stage_ != Stage::stand) return;
  footsteps_ = Footsteps(*model_, plan_.feet, period, std::exp(params_.single + params_.both),
                         params_.hold, params_.inside * height_);
  const bool left_first = steps_.velocity.y() > 0 || steps_.turn > 0;
  anchor_ = left_first ? Side::right : Side::left;
  stage_ = Stage::shift;
  elapsed_ = 0;
}

Vector3d Viip::standing_goal(const Vector3d& displacement) const {
  const GroundPose feet = middle(*model_, next_.feet);
  const Vector3d on_ground(feet.position.x(), feet.position.y(), ground_of(next_.feet));
  return on_ground + rotated(offset_ + displacement, feet.yaw);
}

Vector2d Viip::clipped(const Vector2d& zmp) const {
  const ConvexPolygon polygon =
      support_polygon(*model_, plan_.feet, plan_.support).shrunk(params_.margin * height_);
  return polygon.empty() ? zmp : polygon.project(zmp);
}

Vector2d Viip::regulate(const Vector2d& xi, int state) const {
  const auto standing = [&](const Vector2d& goal) -> Vector2d {
    return goal + (1 + params_.q) * (xi - goal);
  };
  const auto arriving = [&](Side stance, int left, double time) {
    const PlannedStep step =
        footsteps_.step(steps_, stance, ground_pose(*model_, stance, plan_.feet[index(stance)]),
                        left, offset_.head<2>());
    return zmp_to_arrive(xi, step.landing.position + step.offset, std::exp(omega_ * time));
  };
  const double single = params_.single / omega_, both = params_.both / omega_;
  switch (stage_) {
    case Stage::stand:
      break;
    case Stage::shift: {
      const PlannedStep step = footsteps_.step(
          steps_, anchor_, ground_pose(*model_, anchor_, plan_.feet[index(anchor_)]), steps_left_,
          offset_.head<2>());
      const Vector2d way = step.landing.position + step.offset - step.stance_place;
      return clipped(standing(step.stance_place + way * std::exp(-params_.single)));
    }
    case Stage::single:
      // Shortly before the landing only the foothold can still answer.
      if (to_landing() < kLeastToLanding) return clipped(zmp_[state]);
      return clipped(arriving(anchor_, steps_left_, to_landing()));
    case Stage::both: {
      const double share = std::min(1.0, elapsed_ / both);
      const Vector2d& before = zmp_before_[state];
      if (steps_left_ == 0) {
        const Vector2d after = standing(standing_goal(displacement_[2]).head<2>());
        return clipped((1 - share) * before + share * after);
      }
      // From foot to foot the ZMP goes gradually; what a push asks for beside that, at once.
      const Side foot = other(anchor_);
      const Vector2d place =
          footsteps_.zmp_on(foot, ground_pose(*model_, foot, plan_.feet[index(foot)]));
      const Vector2d after = arriving(foot, steps_left_, both - elapsed_ + single);
      return clipped((1 - share) * before + share * place + (after - place));
    }
  }
  return clipped(standing(standing_goal(displacement_[2]).head<2>()));
}

CogReference Viip::cog_reference(const Estimate& e) {
  const double m = model_->mass(), ground = ground_of(plan_.feet);
  const Vector3d goal = standing_goal(displacement_[2]);
  const double z = body_.cog().z() - ground;
  CogReference ref;
  ref.fz = std::max(kMinForceShare * m * kGravity,
                    viip_force(params_, m, omega_, goal.z() - ground, z, body_.dcog().z()));
  ref.ddcog.z() = ref.fz / m - kGravity;
  const double w2 = omega_squared(ref.fz, m, z);

  const Vector2d x = body_.cog().head<2>(), dx = body_.dcog().head<2>();
  const Vector2d x_hat = e.cog.head<2>(), dx_hat = e.dcog.head<2>();
  zmp_[1] = regulate(x + dx / omega_, 1);
  zmp_[0] = params_.feedback ? regulate(x_hat + dx_hat / omega_, 0) : zmp_[1];
  ref.zmp << zmp_[0], ground;
  Vector2d ddx = w2 * (x - zmp_[1]);
  if (params_.feedback) {
    ddx += params_.av * omega_ * (dx_hat - dx) + params_.ax * omega_ * omega_ * (x_hat - x);
    if (e.contact) {
      const double filter = 1.0 - std::exp(-dt_ * omega_ / params_.tau_z);
      zmp_filtered_ += filter * (e.zmp.head<2>() - zmp_filtered_);
      ddx += params_.ka * w2 * (zmp_filtered_ - zmp_[0]);
    }
  }
  ref.ddcog.head<2>() = ddx;
  return ref;
}

void Viip::start_single() {
  stage_ = Stage::single;
  elapsed_ = 0;
  swing_rate_.setZero();
  swing_acceleration_.setZero();
  if (steps_.steps == 0) {
    const double period = (params_.single + params_.both) / omega_;
    const double time = static_cast<double>(ticks_left_) * dt_ - kSettle / omega_;
    steps_left_ = std::max(1, static_cast<int>(time / period));
  }
  footsteps_.meet(anchor_, ground_pose(*model_, anchor_, plan_.feet[index(anchor_)]));
}

double Viip::to_landing() const {
  return std::max(params_.single / omega_ - elapsed_, 0.0) / rate_;
}

// With Z at the edge xi gets away from where the foot was to meet it by a + c E, E = exp(w T): the
// step comes as much sooner as keeps that within `hurry` z.
void Viip::hurry(const PlannedStep& step, const Vector2d& xi) {
  const double left = std::max(params_.single / omega_ - elapsed_, 0.0);
  rate_ = 1;
  if (!params_.feedback || left <= dt_) return;
  const Vector2d a = zmp_[0] - step.offset - step.landing.position, c = xi - zmp_[0];
  const double bound = params_.hurry * height_, grown = std::exp(omega_ * left);
  if ((a + c * grown).norm() <= bound) return;
  // The larger root of |a + c E| = bound.
  const double cc = c.squaredNorm(), ac = a.dot(c);
  const double root = ac * ac - cc * (a.squaredNorm() - bound * bound);
  const double growth = root > 0 ? (std::sqrt(root) - ac) / cc : 1.0;
  const double time = std::max(std::log(std::max(growth, 1.0)), params_.soonest) / omega_;
  rate_ = std::clamp(left / time, 1.0, kMostHurry);
}

// The swing foot lifts off, goes to the landing point, which moves, and comes down.
void Viip::swing(const Vector2d& xi) {
  const double length = params_.single / omega_;
  const Side foot = other(anchor_);
  const PlannedStep step =
      footsteps_.step(steps_, anchor_, ground_pose(*model_, anchor_, plan_.feet[index(anchor_)]),
                      steps_left_, offset_.head<2>());
  const Vector2d zmp = zmp_[0];
  hurry(step, xi);
  const double growth = std::exp(omega_ * to_landing());
  Vector2d target = zmp + (xi - zmp) * growth - step.offset;
  const Vector2d nominal = step.landing.position;
  const double reach = params_.reach * height_;
  for (int i = 0; i < 2; ++i)
    target[i] = std::clamp(target[i], nominal[i] - reach, nominal[i] + reach);
  target -= Eigen::Rotation2Dd(step.landing.yaw) * habit_[index(foot)];
  // Soles side by side, seen from the stance foot.
  const GroundPose stance = ground_pose(*model_, anchor_, plan_.feet[index(anchor_)]);
  Vector2d way = Eigen::Rotation2Dd(-stance.yaw) * (target - stance.position);
  const double beside = 2 * sole_half_width(*model_) + kFootClearance;
  if (foot == Side::left)
    way.y() = std::max(way.y(), beside);
  else
    way.y() = std::min(way.y(), -beside);
  target = stance.position + Eigen::Rotation2Dd(stance.yaw) * way;

  // Least jerk from where the foot is to rest on the target, planned anew in every tick.
  GroundPose at = ground_pose(*model_, foot, plan_.feet[index(foot)]);
  const double begin = kSwingMargin * length;
  const double time = ((1 - kSwingMargin) * length - elapsed_) / rate_;
  if (elapsed_ > begin && time > dt_) {
    const Vector3d way_left(target.x() - at.position.x(), target.y() - at.position.y(),
                            std::remainder(step.landing.yaw - at.yaw, 2 * M_PI));
    const double t = std::max(time, kLeastReplan);
    const Vector3d jerk =
        60 / (t * t * t) * way_left - 36 / (t * t) * swing_rate_ - 9 / t * swing_acceleration_;
    swing_acceleration_ += dt_ * jerk;
    swing_rate_ += dt_ * swing_acceleration_;
    at.position += dt_ * swing_rate_.head<2>();
    at.yaw += dt_ * swing_rate_.z();
  }
  const double after = std::min(1.0, (elapsed_ + rate_ * dt_) / length);
  const double up = std::pow(4 * after * (1 - after), 3);
  const double ground = plan_.feet[index(anchor_)].translation().z();
  next_.feet[index(foot)] = sole_frame(*model_, foot, at, ground + up * params_.lift * height_);
}

// Where the landed foot stands beside the other one, from where the plan has it: the plan does not
// follow, its path does. To be asked when it bears: at first touch it is still on its way.
Vector2d Viip::missed(const Estimate& e, Side foot) {
  update_positions(*model_, e.state, data_);
  const auto off = [&](Side side) -> Vector3d {
    return sole_pose(*model_, data_, side).translation() - plan_.feet[index(side)].translation();
  };
  return (off(foot) - off(other(foot))).head<2>();
}

// What a foot misses step after step it is aimed off by; what a push made it miss once, hardly.
void Viip::learn(const Vector2d& miss) {
  footsteps_.shift(miss);
  const double yaw = ground_pose(*model_, anchor_, plan_.feet[index(anchor_)]).yaw;
  Vector2d& habit = habit_[index(anchor_)];
  habit += kHabit * (Eigen::Rotation2Dd(-yaw) * miss - habit);
  const double most = kMostHabit * height_;
  if (habit.norm() > most) habit *= most / habit.norm();
}

// Stages, feet and support of the next tick.
void Viip::go_on(const Estimate& e) {
  next_ = plan_;
  elapsed_ += rate_ * dt_;
  --ticks_left_;
  const double lag = 1 - std::exp(-dt_ * omega_ / params_.goal);
  for (int i : {1, 2}) displacement_[i] += lag * (displacement_[i - 1] - displacement_[i]);
  const Vector2d xi = params_.feedback
                          ? Vector2d(e.cog.head<2>() + e.dcog.head<2>() / omega_)
                          : Vector2d(body_.cog().head<2>() + body_.dcog().head<2>() / omega_);
  const double single = params_.single / omega_, both = params_.both / omega_;
  if (stage_ == Stage::shift) {
    // xi is where the regulator wants it when the ZMP it asks for is xi itself.
    const double gap = (zmp_[0] - xi).norm() / params_.q;
    if (steps_left_ == 0)
      stage_ = Stage::stand;
    else if (elapsed_ > kShiftTime / omega_ && gap < kShiftNear * height_)
      start_single();
  } else if (stage_ == Stage::single) {
    const Side foot = other(anchor_);
    swing(xi);
    const bool touched = params_.landings && elapsed_ > kTouchAfter * single &&
                         e.foot_fz[index(foot)] > kTouchShare * model_->mass() * kGravity;
    if (touched || elapsed_ >= single) {
      next_.feet[index(foot)].translation().z() = plan_.feet[index(anchor_)].translation().z();
      footsteps_.advance(steps_, anchor_, steps_left_);
      --steps_left_;
      zmp_before_ = zmp_;
      stage_ = Stage::both;
      elapsed_ = 0;
      rate_ = 1;
    }
  } else if (stage_ == Stage::both && elapsed_ >= both) {
    if (steps_left_ > 0) {
      anchor_ = other(anchor_);
      if (params_.feedback) learn(missed(e, anchor_));
      start_single();
    } else {
      stage_ = Stage::stand;
    }
  }
  next_.support = stage_ == Stage::single ? on(anchor_) : Support::both;
}

// COG, ZMP and trunk of the plan that the judge and the resolution see.
void Viip::finish_plan() {
  const GroundPose feet = middle(*model_, next_.feet);
  const double yaw_before = matrix_to_rpy(plan_.state.base.attitude.toRotationMatrix()).z();
  next_.state.base = body_.state().base;
  next_.state.base.attitude =
      Eigen::Quaterniond(rpy_to_matrix({0, 0, feet.yaw})) *
      Eigen::Quaterniond(
          rpy_to_matrix({0, 0, -matrix_to_rpy(held_.state.base.attitude.toRotationMatrix()).z()})) *
      held_.state.base.attitude;
  next_.state.base_angular_velocity.setZero();
  next_.state.base_angular_velocity.z() = std::remainder(feet.yaw - yaw_before, 2 * M_PI) / dt_;
  next_.cog = standing_goal(displacement_[0]);
  next_.dcog.setZero();
  if (stage_ != Stage::stand) {
    next_.cog.head<2>() = body_.cog().head<2>();
    next_.dcog = body_.dcog();
  }
  next_.zmp << zmp_[1], ground_of(next_.feet);
  next_.fz = model_->mass() * kGravity;
}

ControlOutput Viip::update(const Estimate& estimate) {
  ControlOutput out;
  next_ = plan_;
  body_.anchor(anchor_, plan_.feet[index(anchor_)]);
  out.cog = body_.cog();
  const CogReference wanted = cog_reference(estimate);
  const double ankle = params_.feedback ? params_.ankle : 0;
  const Eigen::VectorXd offsets =
      body_.ankle_offsets(estimate, {.share = ankle, .forget = 6.6 / omega_});
  go_on(estimate);
  body_.advance(wanted, height_, plan_, next_, offsets, out);
  finish_plan();
  plan_ = next_;
  return out;
}

}  // namespace ayumi
