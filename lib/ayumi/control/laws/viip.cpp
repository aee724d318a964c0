// For the axis x (and y likewise), with hats for measured values, r for the reference, Pi for the
// nearest point of the support region, and dcm = x + dx/w:
//   standing  Z(dcm) = Pi[xd + (1 + q)(dcm - xd - vd/w)]              (18)(19)
//   stepping  Z(dcm) = Pi[(dcm_e - dcm E) / (1 - E)],  E = exp(w T) to the landing, dcm_e = p + b
//   reffz = m (kz w)^2 (zd - zr) + 2 dz m kz w (vd - dzr) + m g       (24), (25) with the mass
//   ddzr  = (reffz - yield F)/m - g                                   (16), F: vertical push
//   w2    = reffz / (m zr)                                            (17)
//   ddxr  = w2 (xr - Z(dcm_r)) + ka w2 (zhat - Z(dcm^)) + av w (dx^ - dxr) + ax w^2 (x^ - xr)
//          - moment L'y / (m zr)
// The first term is (14) of the reference pendulum, and the second is the short-term absorption of
// laws/dtad.cpp. The next two terms keep the reference near the robot. With the last term, the ZMP
// stays where it is while the angular momentum L of the reference changes. The velocity in the dcm^
// of Z has passed a low pass. kz depends on the feet that carry load. A foot lands where dcm^ will
// need it: Z + (dcm^ - Z) E - b. The joints follow by (28)(29), control/whole_body.
#include "ayumi/control/laws/viip.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/support_region.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// If less than this time is left to a landing, the regulator no longer aims at it [s]. Chosen: the
// ZMP that it requires grows with 1 / (1 - E); later, only the foothold can still correct an error.
// Half or twice the value changes measured cases by 5 % or more (constants.md).
constexpr double kLeastTimeToLanding = 0.06;

// The weight shift ends when the DCM is within this distance of the place where the first step
// starts, as a multiple of z: 6 mm on HOAP-1. Chosen with the prototype: a smaller distance costs
// time, and a larger one disturbs the DCM. No measured case changes between half and twice the
// value (constants.md).
constexpr double kShiftDone = 0.027;

// Smallest duration of the weight shift, as a multiple of 1/omega: 0.36 s on HOAP-1. Chosen with
// the prototype: the regulator settles within this time. Its effect is in constants.md.
constexpr double kShiftTime = 2.4;

// Time that is reserved for standing after timed steps, as a multiple of 1/omega. Chosen: exp(-5)
// of an error is left. Its effect is in constants.md.
constexpr double kSettleTime = 5;

// A force on the swing foot before this share of the swing is not a landing. Chosen with the
// prototype: a foot still drags after its lift-off, and a landing is early by at most a third of a
// swing. Its effect is in constants.md.
constexpr double kStepLandingAfter = 0.6;

// Largest factor by which a step may be speeded up so that it lands earlier, relative to its
// planned speed. Chosen: joint speeds limit the swing before this factor is reached. No measured
// case changes between half and twice the value (constants.md).
constexpr double kStepTimeScaleLimit = 4;

// Share of the difference between a landing error and the known bias that is taken over at each
// landing. Chosen: the bias is known after three steps, and a single push changes it by half of the
// landing error that the push causes. Between half and twice the value, figures change by less than
// 5 %.
constexpr double kBiasShare = 0.5;

// Largest landing bias, as a multiple of z: 3.3 mm on HOAP-1. Chosen: twice the error that lagging
// servos make (1.5 mm). A larger error comes from a push. No measured case changes between half and
// twice the value (constants.md).
constexpr double kLandingBiasLimit = 0.015;

// Time after which a lasting tilt of the stance foot counts as a slope of the ground, as a multiple
// of 1/omega: 1 s on HOAP-1. Chosen: equal to the offset time of DTAD. Its effect is in
// constants.md.
constexpr double kSlopeTime = 6.6;

// Time constant of the low pass of the vertical push that the load cells measure [s]; the lag of
// the servos is added to it. Derived: with a low pass T and a force that is late by d, the loop
// obeys
//   T s = -exp(-s d),
// which is stable for d < T pi/2. Sensors may be 10 ms late.
constexpr double kPushFilterTime = 0.010;

// Time constant of the low pass of the measured velocity of the COG, from which VIIP computes ref
// ZMP, as a multiple of 1/omega: 6 ms on HOAP-1. Chosen: the rms of ZMP - ref ZMP in the walk of
// HOAP-1 with noise, as a mean of four seeds, is 10.5 mm without the low pass and 9.2 mm with it.
// It is 9.3 mm with half of the value, and 9.5 mm with twice.
constexpr double kVelocityFilterTime = 0.04;

// A measured velocity that differs by more than this from its low pass counts at once, as a
// multiple of omega z: 30 mm/s on HOAP-1. Chosen: 2.7 times the noise of the measured velocity (11
// mm/s rms on HOAP-1), so that a push counts without delay. With half of the value, the same rms
// is 9.9 mm, with twice 9.2 mm.
constexpr double kVelocityJump = 0.02;

// The longest lag of a servo of the legs [s].
double leg_lag(const RobotModel& model, const ActuatorLimits& limits) {
  const Eigen::VectorXd lead = velocity_lead(limits);
  double lag = 0;
  for (const Side side : {Side::left, Side::right})
    for (const int dof : model.leg(side)) lag = std::max(lag, lead[dof]);
  return lag;
}

GroundPose ground_middle(const RobotModel& model, const std::array<Isometry3d, 2>& feet) {
  const GroundPose left = ground_pose(model, Side::left, feet[0]);
  const GroundPose right = ground_pose(model, Side::right, feet[1]);
  return {0.5 * (left.position + right.position),
          left.yaw + 0.5 * std::remainder(right.yaw - left.yaw, 2 * M_PI)};
}

Vector3d rotated(const Vector3d& v, double yaw) { return rpy_to_matrix({0, 0, yaw}) * v; }

std::map<std::string, double*> gain_fields(ViipParams& p) {
  return {{"q", &p.pole_ratio},
          {"goal", &p.goal_lag},
          {"ka", &p.zmp_gain},
          {"av", &p.velocity_leak},
          {"ax", &p.position_leak},
          {"damp", &p.rocking_damping},
          {"tau_z", &p.zmp_filter},
          {"margin", &p.margin},
          {"kz", &p.height_rate},
          {"kz_one", &p.one_foot_rate},
          {"moment", &p.momentum_share},
          {"yield", &p.yielding},
          {"dz", &p.height_damping},
          {"ankle", &p.ankle_share},
          {"single", &p.single_support},
          {"both", &p.double_support},
          {"lift", &p.lift},
          {"reach", &p.reach},
          {"hold", &p.recovery},
          {"inside", &p.zmp_inset},
          {"hurry", &p.early_step_bound},
          {"soonest", &p.least_step_time}};
}

}  // namespace

std::vector<std::pair<std::string, double>> gains_of(ViipParams p) {
  std::vector<std::pair<std::string, double>> gains;
  for (const auto& [name, value] : gain_fields(p)) gains.emplace_back(name, *value);
  return gains;
}

ViipParams viip_params(const RobotModel& model, const ControllerSpec& spec) {
  ViipParams p;
  const std::map<std::string, double*> fields = gain_fields(p);
  std::vector<std::string> names;
  for (const auto& [name, field] : fields) names.push_back(name);
  auto set = [&](const std::string& name, double value, const auto& refuse) {
    if (const std::string reason = gain_out_of_range(name, value); !reason.empty()) refuse(reason);
    const auto found = fields.find(name);
    if (found == fields.end())
      refuse("viip has no gain '" + name + "'" + text::suggestion(name, names) +
             " (known: " + text::join(names, ", ") + ")");
    *found->second = value;
  };
  for (const auto& [name, value] : model.description().control.viip)
    set(name, value, [&](const std::string& what) {
      fail(ErrorCode::bad_model,
           {model.description().sidecar_file, "/control/viip/" + json_pointer_token(name)}, what);
    });
  if (spec.type.kind == ControllerKind::viip)
    for (const auto& [name, value] : spec.gains)
      set(name, value,
          [](const std::string& what) { fail(ErrorCode::usage, "controller gains: " + what); });
  for (const char* name : {"q", "goal", "tau_z", "kz", "kz_one", "single", "both", "lift"})
    if (!(*fields.at(name) > 0))
      fail(ErrorCode::usage, std::string("controller gains: ") + name + " is " +
                                 text::brief(*fields.at(name)) + "; it must be above 0");
  if (p.height_damping < 1 - 1e-9)
    fail(ErrorCode::usage, "controller gains: with dz = " + text::brief(p.height_damping) +
                               " the COG height overshoots. dz must be at least 1, because "
                               "equation (25) needs K_Dz^2 >= 4 m K_Pz");
  if (p.recovery > 1)
    fail(ErrorCode::usage,
         "controller gains: hold is " + text::brief(p.recovery) + "; it must be from 0 to 1");
  p.landings = spec.type.demonstration != Demonstration::no_feedback;
  p.feedback = p.landings && spec.type.demonstration != Demonstration::landings_only;
  return p;
}

double stepping_time(const ViipParams& p, double omega, int steps) {
  return (kShiftTime + steps * (p.single_support + p.double_support) + kSettleTime) / omega;
}

Vector2d turning_acceleration(const Vector3d& momentum_rate, double mass, double z) {
  return Vector2d(-momentum_rate.y(), momentum_rate.x()) / (mass * z);
}

HeightGains viip_height_gains(const ViipParams& p, double mass, double omega, int feet) {
  const double rate = (feet == 1 ? p.one_foot_rate : p.height_rate) * omega;
  HeightGains gains;
  gains.stiffness = mass * rate * rate;
  gains.damping = 2 * p.height_damping * std::sqrt(mass * gains.stiffness);
  return gains;
}

double viip_force(const HeightGains& gains, double mass, double goal, double z, double dz) {
  return height_force(gains, mass * kGravity, goal, z, dz);
}

Vector2d viip_acceleration(const ViipParams& p, double omega, double omega2, double dt,
                           const ReferencePendulum& reference, const Vector2d& measured_zmp,
                           const Estimate& e, ReactionFilter& filter, LawTerms& terms) {
  terms.motion.head<2>() = horizontal_acceleration(omega2, reference.cog, reference.zmp);
  Vector2d ddcog = terms.motion.head<2>();
  if (!p.feedback) return ddcog;
  terms.pull.head<2>() = p.velocity_leak * omega * (e.dcog.head<2>() - reference.dcog) +
                         p.position_leak * omega * omega * (e.cog.head<2>() - reference.cog);
  ddcog += terms.pull.head<2>();
  if (!e.contact) return ddcog;
  terms.rocking.head<2>() =
      rocking_acceleration(p.rocking_damping, omega, kGravity / (omega * omega),
                           Vector3d(reference.dcog.x(), reference.dcog.y(), 0), e);
  ddcog += terms.rocking.head<2>();
  filter.update(e, low_pass_share(dt, omega, p.zmp_filter));
  terms.short_term.head<2>() =
      short_term_acceleration(p.zmp_gain, omega2, filter.zmp() - measured_zmp);
  ddcog += terms.short_term.head<2>();
  return ddcog;
}

Viip::Viip(const RobotModel& model, const ActuatorLimits& limits, const ViipParams& params,
           double dt, const Handover& start, const CommandSample& held)
    : model_(&model),
      params_(params),
      dt_(dt),
      omega_(std::sqrt(kGravity / (held.cog.z() - ground_of(held.feet)))),
      height_(held.cog.z() - ground_of(held.feet)),
      push_filter_(leg_lag(model, limits) + kPushFilterTime),
      command_(start.command),
      body_(model, limits, dt, start.reference, start.target, {.in_order = false}),
      dynamics_(model, limits, dt),
      data_(model),
      held_(held),
      plan_(held),
      footsteps_(new_path(start.plan.feet)),
      filter_(start.plan.zmp.head<2>(), start.plan.fz) {
  body_.take_over(start);
  const GroundPose from = ground_middle(model, held.feet);
  Vector3d from3(from.position.x(), from.position.y(), ground_of(held.feet));
  offset_ = rotated(held.cog - from3, -from.yaw);
  velocity_ = body_.dcog().head<2>();
  plan_.feet = start.plan.feet;
  plan_.support = Support::both;
  plan_.state.dtheta.setZero();
  if (start.plan.support == Support::right) anchor_ = Side::right;
  zmp_ = zmp_before_ = {filter_.zmp(), filter_.zmp()};
  next_ = plan_;
  body_.anchor(anchor_, plan_.feet[index(anchor_)]);
  finish_plan();
  plan_ = next_;
}

Footsteps Viip::new_path(const std::array<Isometry3d, 2>& feet) const {
  const double period = params_.single_support + params_.double_support;
  return Footsteps(*model_, feet, period / omega_, elementary::exp(period), params_.recovery,
                   params_.zmp_inset * height_);
}

void Viip::set_goal(const ViipGoal& goal, long ticks) {
  ticks_left_ = ticks;
  goal_velocity_[0].setZero();
  if (const auto* steps = std::get_if<StepGoal>(&goal)) {
    steps_ = *steps;
    displacement_[0].setZero();
    start_steps();
  } else {
    if (const auto* cog = std::get_if<CogGoal>(&goal)) displacement_[0] = cog->displacement;
    if (const auto* moving = std::get_if<CogVelocityGoal>(&goal))
      goal_velocity_[0] = moving->velocity;
    steps_left_ = stage_ == Stage::single_support ? 1 : 0;  // a foot in the air comes down first
    if (stage_ == Stage::weight_shift) stage_ = Stage::stand;
  }
  finish_plan();
  plan_ = next_;
}

// Number of swings: the requested number, or as many as there is time for.
void Viip::start_steps() {
  const double period = (params_.single_support + params_.double_support) / omega_;
  const double time = static_cast<double>(ticks_left_) * dt_ - (kSettleTime + kShiftTime) / omega_;
  steps_left_ = steps_.steps > 0 ? steps_.steps : std::max(0, static_cast<int>(time / period));
  if (steps_left_ == 0 || stage_ != Stage::stand) return;
  footsteps_ = new_path(plan_.feet);
  const bool left_first = steps_.velocity.y() > 0 || steps_.turn > 0;
  anchor_ = left_first ? Side::right : Side::left;
  stage_ = Stage::weight_shift;
  elapsed_ = 0;
}

Vector3d Viip::standing_goal(const Vector3d& displacement) const {
  const GroundPose feet = ground_middle(*model_, next_.feet);
  const Vector3d on_ground(feet.position.x(), feet.position.y(), ground_of(next_.feet));
  return on_ground + rotated(offset_ + displacement, feet.yaw);
}

Vector3d Viip::standing_velocity(const Vector3d& velocity) const {
  return rotated(velocity, ground_middle(*model_, next_.feet).yaw);
}

// The nearest admissible ZMP, section 3.3 of the paper.
Vector2d Viip::inside_support(const Vector2d& zmp) const {
  const ConvexPolygon polygon =
      support_polygon(*model_, plan_.feet, plan_.support).shrunk(params_.margin * height_);
  return polygon.empty() ? zmp : polygon.project(zmp);
}

PlannedStep Viip::planned_step(Side stance) const {
  return footsteps_.step(steps_, stance, ground_pose(*model_, stance, plan_.feet[index(stance)]),
                         steps_left_, offset_.head<2>());
}

LawStage Viip::law_stage() const {
  switch (stage_) {
    case Stage::weight_shift:
      return LawStage::weight_shift;
    case Stage::single_support:
      return LawStage::single_support;
    case Stage::double_support:
      return LawStage::double_support;
    case Stage::stand:
      break;
  }
  return LawStage::stand;
}

Viip::WantedZmp Viip::regulate(const Vector2d& dcm, int state) const {
  const auto standing = [&](const Vector2d& goal) -> Vector2d {
    return regulating_zmp(goal, params_.pole_ratio, dcm);
  };
  const auto moving = [&] {
    const Vector2d ahead = standing_velocity(goal_velocity_[2]).head<2>() / omega_;
    return regulating_zmp(standing_goal(displacement_[2]).head<2>(), params_.pole_ratio,
                          dcm - ahead);
  };
  const auto growth = [&](double time) {  // derivative of zmp_to_arrive() with respect to the DCM
    const double E = elementary::exp(omega_ * time);
    return E / (E - 1);
  };
  const double stands = 1 + params_.pole_ratio;
  const auto arriving = [&](Side stance, double time) {
    const PlannedStep step = planned_step(stance);
    return zmp_to_arrive(dcm, step.landing.position + step.offset, elementary::exp(omega_ * time));
  };
  const double single = params_.single_support / omega_, both = params_.double_support / omega_;
  switch (stage_) {
    case Stage::stand:
      break;
    case Stage::weight_shift: {
      const PlannedStep step = planned_step(anchor_);
      const Vector2d to_landing = step.landing.position + step.offset - step.stance_place;
      return {standing(step.stance_place + to_landing * elementary::exp(-params_.single_support)),
              stands};
    }
    case Stage::single_support:
      // Shortly before the landing, only the foothold can still correct an error.
      if (time_to_landing() < kLeastTimeToLanding) return {zmp_[state], 0};
      return {arriving(anchor_, time_to_landing()), growth(time_to_landing())};
    case Stage::double_support: {
      const double share = std::min(1.0, elapsed_ / both);
      const Vector2d& before = zmp_before_[state];
      if (steps_left_ == 0) {
        const Vector2d after = moving();
        return {(1 - share) * before + share * after, share * stands};
      }
      // The ZMP moves gradually from foot to foot, but the reaction to a push is added at once.
      const Side foot = other(anchor_);
      const Vector2d place =
          footsteps_.zmp_on(foot, ground_pose(*model_, foot, plan_.feet[index(foot)]));
      const Vector2d after = arriving(foot, both - elapsed_ + single);
      return {(1 - share) * before + share * place + (after - place),
              growth(both - elapsed_ + single)};
    }
  }
  return {moving(), stands};
}

// The noise of the measured velocity moves ref ZMP. (14)(15) with the measured ZMP predict the
// change of the velocity, so the low pass delays only the part of the change that the ground force
// does not explain. After a push, the measured velocity is used without delay.
void Viip::follow_velocity(const Estimate& e) {
  const Vector2d measured = e.dcog.head<2>();
  if (e.contact) {
    const double w2 = omega_squared(e.fz, model_->mass(), e.cog.z() - ground_of(plan_.feet));
    velocity_ += dt_ * horizontal_acceleration(w2, e.cog.head<2>(), e.zmp.head<2>());
  }
  velocity_ += low_pass_share(dt_, omega_, kVelocityFilterTime) * (measured - velocity_);
  // The comparison is negated so that a velocity that is not a number is replaced, too.
  if (!((measured - velocity_).norm() <= kVelocityJump * omega_ * height_)) velocity_ = measured;
}

// (24), (16), (17), then (14)(15) closed on the measured ZMP.
CogReference Viip::cog_reference(const Estimate& e, LawTerms& terms) {
  const double m = model_->mass(), ground = ground_of(plan_.feet);
  const Vector3d goal = standing_goal(displacement_[2]);
  const double z = body_.cog().z() - ground, dz = body_.dcog().z() - goal_velocity_[2].z();
  CogReference ref;
  // Without feedback, the planned contact is used.
  const bool both = params_.feedback
                        ? bears(*model_, e, Side::left) == bears(*model_, e, Side::right)
                        : plan_.support == Support::both;
  const HeightGains gains = viip_height_gains(params_, m, omega_, both ? 2 : 1);
  const bool yields = params_.feedback && stage_ == Stage::stand && e.contact;
  sag_ =
      yields ? sag_ + low_pass_share(dt_, omega_, 1) * (e.cog.z() - body_.cog().z() - sag_) : 0.0;
  ref.fz = admissible_force(viip_force(gains, m, goal.z() - ground, z + sag_, dz), m);
  push_ = yields
              ? push_ + std::min(1.0, dt_ / push_filter_) * (e.fz - m * (kGravity + lift_) - push_)
              : 0.0;
  lift_ = vertical_acceleration(ref.fz - params_.yielding * push_, m);
  ref.ddcog.z() = lift_;
  const double w2 = omega_squared(ref.fz, m, z);
  terms = {.stage = law_stage(), .height = z, .omega2 = w2};
  terms.K_Pz = gains.stiffness;
  terms.K_Dz = gains.damping;
  terms.spring_goal = goal.z() - ground;
  terms.spring_height = z + sag_;
  terms.spring_rate = dz;
  terms.motion.z() = vertical_acceleration(ref.fz, m);
  terms.short_term.z() = lift_ - terms.motion.z();

  WantedZmp wanted = regulate(divergent_component(body_.cog(), body_.dcog(), omega_).head<2>(), 1);
  const WantedZmp by_robot =
      params_.feedback ? regulate(e.cog.head<2>() + velocity_ / omega_, 0) : wanted;
  zmp_[1] = inside_support(wanted.zmp);
  zmp_[0] = params_.feedback ? inside_support(by_robot.zmp) : zmp_[1];
  terms.planned_zmp << zmp_[1], ground;
  terms.wanted_zmp << by_robot.zmp, ground;
  terms.K = by_robot.gain;
  terms.D = by_robot.gain / omega_;
  ref.zmp << zmp_[0], ground;
  const ReferencePendulum reference = {body_.cog().head<2>(), body_.dcog().head<2>(), zmp_[1]};
  ref.ddcog.head<2>() =
      viip_acceleration(params_, omega_, w2, dt_, reference, zmp_[0], e, filter_, terms);
  const Vector2d turning =
      params_.momentum_share * turning_acceleration(dynamics_.momentum_rate(), m, z);
  ref.ddcog.head<2>() += turning;
  terms.motion.head<2>() += turning;
  terms.filtered_zmp << filter_.zmp(), ground;
  return ref;
}

void Viip::start_single_support() {
  stage_ = Stage::single_support;
  elapsed_ = 0;
  swing_.stop();
  if (steps_.steps == 0) {
    const double period = (params_.single_support + params_.double_support) / omega_;
    const double time = static_cast<double>(ticks_left_) * dt_ - kSettleTime / omega_;
    steps_left_ = std::max(1, static_cast<int>(time / period));
  }
  footsteps_.meet(anchor_, ground_pose(*model_, anchor_, plan_.feet[index(anchor_)]));
}

double Viip::time_to_landing() const {
  return std::max(params_.single_support / omega_ - elapsed_, 0.0) / time_scale_;
}

// While Z is at the edge, the DCM misses its place relative to the foot by a + c E with E = exp(w
// T). The step is made so much earlier that this error stays within `early_step_bound` z.
void Viip::choose_time_scale(const PlannedStep& step, const Vector2d& dcm) {
  const double left = std::max(params_.single_support / omega_ - elapsed_, 0.0);
  time_scale_ = 1;
  if (!params_.feedback || left <= dt_) return;
  const Vector2d a = zmp_[0] - step.offset - step.landing.position, c = dcm - zmp_[0];
  const double bound = params_.early_step_bound * height_, grown = elementary::exp(omega_ * left);
  if ((a + c * grown).norm() <= bound) return;
  // The larger root of |a + c E| = bound.
  const double cc = c.squaredNorm(), ac = a.dot(c);
  const double root = ac * ac - cc * (a.squaredNorm() - bound * bound);
  const double growth = root > 0 ? (std::sqrt(root) - ac) / cc : 1.0;
  const double time =
      std::max(elementary::log(std::max(growth, 1.0)), params_.least_step_time) / omega_;
  time_scale_ = std::clamp(left / time, 1.0, kStepTimeScaleLimit);
}

// The place where the DCM will need the foot, limited to the reach and kept beside the stance foot.
Vector2d Viip::landing_point(const PlannedStep& step, const Vector2d& dcm) const {
  const Side foot = other(anchor_);
  const double growth = elementary::exp(omega_ * time_to_landing());
  Vector2d target = zmp_[0] + (dcm - zmp_[0]) * growth - step.offset;
  const Vector2d nominal = step.landing.position;
  const double reach = params_.reach * height_;
  for (int i = 0; i < 2; ++i)
    target[i] = std::clamp(target[i], nominal[i] - reach, nominal[i] + reach);
  target -= elementary::turn_in_plane(step.landing.yaw) * landing_bias_[index(foot)];
  const GroundPose stance = ground_pose(*model_, anchor_, plan_.feet[index(anchor_)]);
  Vector2d beside_stance = elementary::turn_in_plane(-stance.yaw) * (target - stance.position);
  const double beside = 2 * sole_half_width(*model_) + kSoleClearance;
  if (foot == Side::left)
    beside_stance.y() = std::max(beside_stance.y(), beside);
  else
    beside_stance.y() = std::min(beside_stance.y(), -beside);
  return stance.position + elementary::turn_in_plane(stance.yaw) * beside_stance;
}

// The path of the swing foot: it lifts off, moves to the landing point, which may move, and comes
// down.
void Viip::move_swing_foot(const Vector2d& dcm) {
  const double length = params_.single_support / omega_;
  const Side foot = other(anchor_);
  const PlannedStep step = planned_step(anchor_);
  choose_time_scale(step, dcm);
  const Vector2d target = landing_point(step, dcm);
  GroundPose at = ground_pose(*model_, foot, plan_.feet[index(foot)]);
  const double begin = kSwingMargin * length;
  const double time = ((1 - kSwingMargin) * length - elapsed_) / time_scale_;
  if (elapsed_ > begin && time > dt_) {
    const Vector3d remaining(target.x() - at.position.x(), target.y() - at.position.y(),
                             std::remainder(step.landing.yaw - at.yaw, 2 * M_PI));
    const Vector3d move = swing_.step(remaining, time, dt_);
    at.position += move.head<2>();
    at.yaw += move.z();
  }
  const double after = std::min(1.0, (elapsed_ + time_scale_ * dt_) / length);
  const double ground = plan_.feet[index(anchor_)].translation().z();
  next_.feet[index(foot)] =
      sole_frame(*model_, foot, at, ground + swing_height(after) * params_.lift * height_);
}

// The place of the landed foot relative to the other foot, minus its planned place. The path of the
// plan is moved by this difference. The difference is measured when the foot carries load, because
// the foot still moves at first touch.
Vector2d Viip::landing_error(const Estimate& e, Side foot) {
  update_positions(*model_, e.state, data_);
  const auto off = [&](Side side) -> Vector3d {
    return sole_pose(*model_, data_, side).translation() - plan_.feet[index(side)].translation();
  };
  return (off(foot) - off(other(foot))).head<2>();
}

// First-order estimate of the systematic landing error, which landing_point() subtracts.
void Viip::update_landing_bias(const Vector2d& error) {
  footsteps_.shift(error);
  const double yaw = ground_pose(*model_, anchor_, plan_.feet[index(anchor_)]).yaw;
  Vector2d& bias = landing_bias_[index(anchor_)];
  bias += kBiasShare * (elementary::turn_in_plane(-yaw) * error - bias);
  const double most = kLandingBiasLimit * height_;
  if (bias.norm() > most) bias *= most / bias.norm();
}

// Stage, feet and support of the next tick.
void Viip::step_state_machine(const Estimate& e) {
  next_ = plan_;
  elapsed_ += time_scale_ * dt_;
  --ticks_left_;
  if (stage_ == Stage::stand) displacement_[0] += dt_ * goal_velocity_[0];
  if (ticks_left_ <= 0) goal_velocity_[0].setZero();
  const double lag = low_pass_share(dt_, omega_, params_.goal_lag);
  for (int i : {1, 2}) {
    displacement_[i] += lag * (displacement_[i - 1] - displacement_[i]);
    goal_velocity_[i] += lag * (goal_velocity_[i - 1] - goal_velocity_[i]);
  }
  const Vector3d dcm = params_.feedback ? divergent_component(e.cog, e.dcog, omega_)
                                        : divergent_component(body_.cog(), body_.dcog(), omega_);
  const double single = params_.single_support / omega_, both = params_.double_support / omega_;
  if (stage_ == Stage::weight_shift) {
    // The DCM has arrived when the ZMP that the regulator requires is at the DCM itself.
    const double gap = (zmp_[0] - dcm.head<2>()).norm() / params_.pole_ratio;
    if (steps_left_ == 0)
      stage_ = Stage::stand;
    else if (elapsed_ > kShiftTime / omega_ && gap < kShiftDone * height_)
      start_single_support();
  } else if (stage_ == Stage::single_support) {
    const Side foot = other(anchor_);
    move_swing_foot(dcm.head<2>());
    const bool landed =
        params_.landings && elapsed_ > kStepLandingAfter * single && bears(*model_, e, foot);
    if (landed || elapsed_ >= single) {
      early_ =
          next_.feet[index(foot)].translation().z() - plan_.feet[index(anchor_)].translation().z();
      footsteps_.advance(steps_, anchor_, steps_left_);
      --steps_left_;
      zmp_before_ = zmp_;
      stage_ = Stage::double_support;
      elapsed_ = 0;
      time_scale_ = 1;
    }
  } else if (stage_ == Stage::double_support) {
    // A foot that has met the ground early takes over its load as gradually as the ZMP moves.
    const double share = std::min(1.0, elapsed_ / both);
    next_.feet[index(other(anchor_))].translation().z() =
        plan_.feet[index(anchor_)].translation().z() +
        early_ * (1 - share * share * (3 - 2 * share));
  }
  if (stage_ == Stage::double_support && elapsed_ >= both) {
    if (steps_left_ > 0) {
      anchor_ = other(anchor_);
      if (params_.feedback) update_landing_bias(landing_error(e, anchor_));
      start_single_support();
    } else {
      stage_ = Stage::stand;
    }
  }
  next_.support = stage_ == Stage::single_support ? on(anchor_) : Support::both;
}

// COG, ZMP and trunk of the plan, for the fall monitor and resolve().
void Viip::finish_plan() {
  const GroundPose feet = ground_middle(*model_, next_.feet);
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
  next_.dcog = standing_velocity(goal_velocity_[0]);
  if (stage_ != Stage::stand) {
    next_.cog.head<2>() = body_.cog().head<2>();
    next_.dcog = body_.dcog();
  }
  next_.zmp << zmp_[1], ground_of(next_.feet);
  next_.fz = model_->mass() * kGravity;
}

void Viip::update(const Estimate& estimate, ControlOutput& out) {
  next_ = plan_;
  body_.anchor(anchor_, plan_.feet[index(anchor_)]);
  out.cog = body_.cog();
  follow_velocity(estimate);
  const CogReference wanted = cog_reference(estimate, out.terms);
  const double ankle = params_.feedback ? params_.ankle_share : 0;
  const Eigen::VectorXd offsets =
      dynamics_.lead() +
      body_.ankle_offsets(estimate, {.share = ankle, .slope_time = kSlopeTime / omega_});
  step_state_machine(estimate);
  const RobotState before = body_.state();
  body_.advance(wanted, height_, plan_, next_, offsets, out);
  std::array<Vector2d, 2> places;
  for (Side side : {Side::left, Side::right})
    places[index(side)] =
        footsteps_.zmp_on(side, ground_pose(*model_, side, plan_.feet[index(side)]));
  dynamics_.update(before, anchor_, out.reference.dtheta, plan_, places);
  finish_plan();
  plan_ = next_;
}

}  // namespace ayumi
