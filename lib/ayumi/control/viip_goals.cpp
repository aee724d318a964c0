// A displacement is reachable if the robot can stand at its end. For this, the COG must be inside
// the support of the feet with the margin that VIIP keeps, and VIIP's own inverse kinematics
// (resolve()) must reach it with all joints inside their limits. Bisection finds the possible part
// of a displacement. A velocity is reachable if the robot can stand and stop at the end of the
// motion: the DCM is inside the support, too. For steps, a walk of the same shape is generated with
// keys and sampled.
#include "ayumi/control/viip_goals.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/laws/viip.hpp"
#include "ayumi/control/support_region.hpp"
#include "ayumi/control/whole_body.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// A goal counts as reached if the COG is within this distance [m]. Chosen: half of the 2 mm to
// which a displacement is to settle. Between half and twice the value, figures change by less than
// 5 %.
constexpr double kGoalReached = 0.001;

// Length of the ticks in which the reference is moved to a goal [s], and their largest number.
// Chosen: together 6 s, several times the duration of the slowest displacement. No measured case
// changes between half and twice the value (constants.md).
constexpr double kLeadTick = 0.004;
// No measured case changes between half and twice the value (constants.md).
constexpr int kLeadTicks = 1500;

// Time in which the reference moves the remaining distance [s], and its largest speed [m/s].
// Chosen: so slow that only position limits count. Between half and twice the value, figures change
// by less than 5 %.
constexpr double kLeadTime = 0.1;
// No measured case changes between half and twice the value (constants.md).
constexpr double kLeadSpeed = 0.1;

// Lowest COG that is tried, as a share of the height that the pattern holds. Chosen: no leg of a
// humanoid can fold so far. Between half and twice the value, figures change by less than 5 %.
constexpr double kLowestShare = 0.3;

// Number of bisections in the search for the possible part of a goal. Chosen: the result is
// accurate to a thousandth of the goal. Between half and twice the value, figures change by less
// than 5 %.
constexpr int kHalvings = 10;

// Number of steps of the keyed walk that is judged instead of a goal. Chosen: a longer walk repeats
// itself. No measured case changes between half and twice the value (constants.md).
constexpr int kMostKeyedSteps = 6;

// Largest turn in one step [rad]: 20 deg. Chosen: soles beside each other must not meet. Half or
// twice the value changes measured cases by 5 % or more (constants.md).
constexpr double kStepTurnLimit = 0.35;

const CommandSample& held_in(const CommandSeries& series, const ViipSpan& span) {
  return series.samples[static_cast<size_t>(span.begin)];
}

CommandSeries keyed_steps(const RobotModel& model, const CommandSample& held,
                          const ViipParams& params, const StepGoal& goal) {
  const double z = held.cog.z() - ground_of(held.feet), omega = std::sqrt(kGravity / z);
  WalkParameters w = walk_defaults(model);
  w.steps = goal.steps > 0 ? std::clamp(goal.steps - 1, 1, kMostKeyedSteps) : kMostKeyedSteps;
  w.period = (params.single_support + params.double_support) / omega;
  w.double_support = params.double_support / (params.single_support + params.double_support);
  w.stride = goal.velocity.x() * w.period;
  w.side = 2 * goal.velocity.y() * w.period;
  w.turn = goal.turn * w.period;
  w.lift = params.lift * z;
  w.cog_height = z;
  w.first_swing = goal.velocity.y() > 0 || goal.turn > 0 ? Side::left : Side::right;
  return sample(model, walk_pattern(model, w));
}

CommandSeries keyed_jump(const RobotModel& model, const CommandSample& held, const JumpGoal& goal) {
  JumpParameters p = jump_defaults(model);
  p.height = goal.height;
  p.stoop = goal.stoop;
  p.forward = goal.forward;
  p.cog_height = held.cog.z() - ground_of(held.feet);
  return sample(model, jump_pattern(model, p));
}

std::string in_millimetres(const Vector3d& d) {
  return text::fixed(1e3 * d.x(), 1) + ", " + text::fixed(1e3 * d.y(), 1) + ", " +
         text::fixed(1e3 * d.z(), 1) + " mm";
}

/// How near resolve() comes to a COG, and the joint that stops it.
struct Attempt {
  double miss = 0;  ///< remaining distance from the wanted COG [m]
  std::string joint;
};

bool in_a_leg(const RobotModel& model, int dof) {
  for (const Side side : {Side::left, Side::right})
    for (int i = model.sole(side).body; i > 0; i = model.bodies()[static_cast<size_t>(i)].parent)
      if (model.bodies()[static_cast<size_t>(i)].dof == dof) return true;
  return false;
}

// The posture of the reference after it was moved to the goal as VIIP moves it, but so slowly that
// only position limits matter.
Attempt lead_to(const RobotModel& model, const CommandSample& held, const Vector3d& goal) {
  CommandSample wanted = held;
  wanted.state.dtheta.setZero();
  wanted.state.base_angular_velocity.setZero();
  RobotState state = held.state;
  RobotData data(model);
  ResolverOptions options;
  options.in_order = false;
  Attempt attempt;
  for (int i = 0; i < kLeadTicks; ++i) {
    anchor_base(model, Side::left, held.feet[0], state, data);
    const Vector3d remaining = goal - data.cog;
    attempt.miss = remaining.norm();
    if (attempt.miss < kGoalReached) break;
    const Resolution r = resolve(model, model.limits(), state, data, Side::left,
                                 remaining / std::max(kLeadTime, remaining.norm() / kLeadSpeed),
                                 wanted, wanted, kLeadTick, model.joint_weight(), options);
    state.theta += kLeadTick * r.dtheta;
    attempt.joint.clear();
    for (const int dof : r.held)
      if (in_a_leg(model, dof)) attempt.joint = model.dofs()[static_cast<size_t>(dof)].name;
  }
  return attempt;
}

// The reason why the robot cannot stand displaced; "" if it can.
std::string obstacle(const RobotModel& model, const CommandSample& held, const ViipParams& params,
                     const Vector3d& displacement) {
  const double yaw = matrix_to_rpy(held.feet[0].linear()).z();
  const Vector3d goal = held.cog + rpy_to_matrix({0, 0, yaw}) * displacement;
  const double height = held.cog.z() - ground_of(held.feet), margin = params.margin * height;
  if (!(height + displacement.z() > kLowestShare * height))
    return "the COG would be " + text::fixed(1e3 * std::abs(height + displacement.z()), 1) +
           " mm " + (height + displacement.z() < 0 ? "below" : "above") +
           " the ground, but must be at least " + text::fixed(1e3 * kLowestShare * height, 1) +
           " mm above the ground";
  const double inside = support_polygon(model, held.feet, Support::both).margin(goal.head<2>());
  if (inside < margin)
    return "the COG would be " + text::fixed(1e3 * std::abs(inside), 1) + " mm " +
           (inside < 0 ? "outside" : "inside") + " the support of the feet, but must be at least " +
           text::fixed(1e3 * margin, 1) + " mm inside";
  const Attempt attempt = lead_to(model, held, goal);
  if (attempt.miss < kGoalReached) return {};
  return "the legs bring the COG no closer than " + text::fixed(1e3 * attempt.miss, 1) +
         " mm to the commanded place" +
         (attempt.joint.empty() ? "" : ", because " + attempt.joint + " is at its limit there");
}

// The largest share of a goal, from 0 to 1, that the robot can reach.
double possible_share(const std::function<std::string(double)>& obstacle_of) {
  double possible = 0, not_possible = 1;
  if (obstacle_of(0).empty())
    for (int i = 0; i < kHalvings; ++i) {
      const double share = 0.5 * (possible + not_possible);
      (obstacle_of(share).empty() ? possible : not_possible) = share;
    }
  return possible;
}

void require_reachable(const RobotModel& model, const CommandSample& held, const ViipParams& params,
                       const std::string& place, const CogGoal& goal) {
  if (!goal.displacement.allFinite())
    fail(ErrorCode::bad_pattern, place + "a COG displacement is not a finite number");
  const std::string why = obstacle(model, held, params, goal.displacement);
  if (why.empty()) return;
  const double possible = possible_share(
      [&](double share) { return obstacle(model, held, params, share * goal.displacement); });
  fail(ErrorCode::bad_pattern,
       place + "COG displacement " + in_millimetres(goal.displacement) + ": " + why + ". " +
           (possible > 0
                ? "In this direction, a displacement of " +
                      in_millimetres(possible * goal.displacement) +
                      " is possible. Reduce the displacement, or keep the COG at another height"
                : std::string("Even the posture without a displacement is not possible")));
}

/// A velocity of the COG, with the place where it begins and its duration [m], [s].
struct CogPath {
  Vector3d from, velocity;
  double time = 0;
};

// The displacement at the beginning of a span, which the goals directly before it have produced,
// and the velocity and the duration of the span. Steps, jumps and times without a goal reset the
// displacement to zero.
CogPath cog_path(const CommandSeries& series, const ViipSpan& span) {
  CogPath path = {Vector3d::Zero(), Vector3d::Zero(), 0};
  long end = 0;
  for (const ViipSpan& each : series.viip) {
    path.from = each.begin == end ? Vector3d(path.from + path.time * path.velocity)
                                  : Vector3d(Vector3d::Zero());
    path.velocity.setZero();
    path.time = static_cast<double>(each.end - each.begin) * series.dt;
    end = each.end;
    const auto* moving = std::get_if<CogVelocityGoal>(&each.goal);
    if (moving) path.velocity = moving->velocity;
    if (&each == &span) break;
    if (!moving) path.from.setZero();
    if (const auto* cog = std::get_if<CogGoal>(&each.goal)) path.from = cog->displacement;
  }
  return path;
}

void require_reachable(const RobotModel& model, const CommandSample& held, const ViipParams& params,
                       const std::string& place, const CogPath& path) {
  if (!path.velocity.allFinite())
    fail(ErrorCode::bad_pattern, place + "a COG velocity is not a finite number");
  const double height = held.cog.z() - ground_of(held.feet);
  const auto obstacle_at = [&](double share) {
    const Vector3d velocity = share * path.velocity, end = path.from + path.time * velocity;
    const std::string why = obstacle(model, held, params, end);
    if (!why.empty()) return "after " + text::fixed(path.time, 3) + " s " + why;
    const double rate = std::sqrt(kGravity / (height + end.z()));
    Vector3d stops = velocity / rate;
    stops.z() = 0;
    const double yaw = matrix_to_rpy(held.feet[0].linear()).z();
    const Vector3d dcm = held.cog + rpy_to_matrix({0, 0, yaw}) * (end + stops);
    const double inside = support_polygon(model, held.feet, Support::both).margin(dcm.head<2>());
    if (inside >= params.margin * height) return std::string();
    return "the COG could not stop inside the support of the feet, because stopping takes " +
           text::fixed(1e3 * stops.norm(), 1) + " mm at this speed";
  };
  const std::string why = obstacle_at(1);
  if (why.empty()) return;
  const double possible = possible_share(obstacle_at);
  fail(ErrorCode::bad_pattern,
       place + "COG velocity " + in_millimetres(path.velocity) + "/s: " + why + ". " +
           (possible > 0
                ? "In this direction, a velocity of " + in_millimetres(possible * path.velocity) +
                      "/s is possible. Reduce the velocity, or make the phase shorter"
                : std::string("Even a small velocity in this direction is not possible")));
}

void require_reachable(const RobotModel& model, const CommandSample& held, const ViipParams& params,
                       const std::string& place, const StepGoal& goal) {
  if (!goal.velocity.allFinite() || !std::isfinite(goal.turn))
    fail(ErrorCode::bad_pattern, place + "a velocity is not a finite number");
  const double z = held.cog.z() - ground_of(held.feet);
  const double period = (params.single_support + params.double_support) / std::sqrt(kGravity / z);
  const double length = period * goal.velocity.norm(), most = params.reach * z;
  if (!(length <= most))
    fail(ErrorCode::bad_pattern,
         place + "a COG velocity of " + text::brief(goal.velocity.norm()) + " m/s needs steps of " +
             text::fixed(1e3 * length, 1) + " mm every " + text::fixed(period, 3) +
             " s. The largest step is " + text::fixed(1e3 * most, 1) +
             " mm, which gives a velocity of " + text::fixed(most / period, 3) + " m/s");
  const double turn = std::abs(goal.turn) * period;
  if (!(turn <= kStepTurnLimit))
    fail(ErrorCode::bad_pattern,
         place + "turning by " + text::brief(goal.turn * 180 / M_PI) + " deg/s needs " +
             text::fixed(turn * 180 / M_PI, 1) + " deg in every step, but the largest turn is " +
             text::fixed(kStepTurnLimit * 180 / M_PI, 1) + " deg per step, or " +
             text::fixed(kStepTurnLimit / period * 180 / M_PI, 1) + " deg/s");
  try {
    keyed_steps(model, held, params, goal);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal) throw;
    fail(ErrorCode::bad_pattern, place + "steps at " + text::brief(goal.velocity.x()) + ", " +
                                     text::brief(goal.velocity.y()) + " m/s: " + error.what());
  }
}

}  // namespace

std::vector<KeyedGoal> keyed_goals(const RobotModel& model, const CommandSeries& series,
                                   const ControllerSpec& controller) {
  std::vector<KeyedGoal> result;
  const ViipParams params = viip_params(model, controller);
  for (const ViipSpan& span : series.viip) {
    const CommandSample& held = held_in(series, span);
    KeyedGoal keyed;
    const std::string at =
        " at " + text::fixed(static_cast<double>(span.begin) * series.dt, 2) + " s";
    try {
      if (const auto* cog = std::get_if<CogGoal>(&span.goal)) {
        if (cog->displacement.norm() == 0) continue;
        keyed.place = "VIIP displacement" + at;
        require_reachable(model, held, params, "", *cog);
        continue;  // slow and from rest to rest: only the posture at the end counts
      } else if (std::holds_alternative<CogVelocityGoal>(span.goal)) {
        keyed.place = "VIIP velocity" + at;
        require_reachable(model, held, params, "", cog_path(series, span));
        continue;
      } else if (const auto* steps = std::get_if<StepGoal>(&span.goal)) {
        keyed.place = "VIIP steps" + at;
        require_reachable(model, held, params, "", *steps);
        keyed.motion = keyed_steps(model, held, params, *steps);
      } else {
        keyed.place = "VIIP jump" + at;
        keyed.motion = keyed_jump(model, held, std::get<JumpGoal>(span.goal));
      }
    } catch (const Error& error) {
      if (error.code() == ErrorCode::internal) throw;
      keyed.obstacle = error.what();
    }
    result.push_back(std::move(keyed));
  }
  return result;
}

void require_reachable_goals(const RobotModel& model, const CommandSeries& series,
                             const ControllerSpec& controller) {
  const ViipParams params = viip_params(model, controller);
  for (const ViipSpan& span : series.viip) {
    const std::string place =
        "VIIP goal at " + text::fixed(static_cast<double>(span.begin) * series.dt, 2) + " s: ";
    if (const auto* cog = std::get_if<CogGoal>(&span.goal)) {
      if (!(cog->displacement.norm() == 0))
        require_reachable(model, held_in(series, span), params, place, *cog);
    } else if (std::holds_alternative<CogVelocityGoal>(span.goal)) {
      require_reachable(model, held_in(series, span), params, place, cog_path(series, span));
    } else if (const auto* steps = std::get_if<StepGoal>(&span.goal)) {
      require_reachable(model, held_in(series, span), params, place, *steps);
    }
  }
}

}  // namespace ayumi
