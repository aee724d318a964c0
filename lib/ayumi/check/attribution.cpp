// Quantities depend on each other in one direction: joint angles determine poses, poses and time
// determine rates, rates determine forces, and the command is compared with all of them. A finding
// is a consequence if a finding earlier in this chain, at the same place in the motion, is
// sufficient to cause it. One function, execute(), applies the rules in their order. It takes the
// open errors of the rule's cause one after the other, in the order that the rule names. Another
// open error becomes a consequence if three conditions hold: its kind is one of the rule's effects,
// its window overlaps the interval of this effect, and it passes the condition of this effect. An
// error is open as long as it is not a consequence of another error.
#include "ayumi/check/attribution.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "ayumi/check/counterfactuals.hpp"
#include "ayumi/check/influence_interval.hpp"
#include "ayumi/check/time_scaling.hpp"

namespace ayumi {

// A namespace of its own, because the rules have short names.
namespace attribution {
namespace {

// ---- the parts of a rule

/// The findings of a motion during the search for their causes.
struct Scene {
  JudgedMotion& motion;
  std::vector<FindingWindow>& windows;

  int count() const { return static_cast<int>(windows.size()); }
  const FindingWindow& window(int i) const { return windows[i]; }
  const Violation& of(int i) const { return windows[i].worst; }
  bool open(int i) const {
    return windows[i].cause < 0 && windows[i].worst.severity == Severity::error;
  }
};

struct FindingSet {
  const char* words;
  bool (*contains)(const Violation&);
};

/// The interval in which effects of cause i are searched.
struct Where {
  const char* words;
  std::vector<Interval> (*of)(const Scene&, int i);
};

/// Whether finding j, which touches the interval of finding i, is a consequence of i.
struct Condition {
  const char* words;
  bool (*holds)(Scene&, int i, int j, const Interval& interval);
};

struct Effect {
  FindingSet findings;
  Where where;
  Condition condition;
};

enum class Order {
  by_time,      ///< the causes in order of time
  by_severity,  ///< the worst cause first
  /// The worst cause first; between two rests of the motion, only the worst cause has effects.
  worst_of_each_motion,
  by_effect  ///< each effect follows from its first cause
};

struct Rule {
  FindingSet cause;
  Order order;
  std::vector<Effect> effects;
};

// ---- sets of findings

bool is_class(const Violation& v, LimitClass limit_class) {
  return spec_of(v.kind).limit_class == limit_class;
}

bool is_foot(FindingKind k) {
  return k == FindingKind::foot_slip || k == FindingKind::foot_penetration ||
         k == FindingKind::foot_float;
}

// Everything that is computed from accelerations. The support margin of the commanded ZMP is not.
bool is_force(const Violation& v) {
  return is_class(v, LimitClass::force) &&
         (v.kind != FindingKind::support_margin || v.item == kMotionZmp);
}

bool is_flight(const Violation& v) {
  return v.kind == FindingKind::ballistic || v.kind == FindingKind::angular_momentum;
}

template <FindingKind kind>
bool is_kind(const Violation& v) {
  return v.kind == kind;
}

const FindingSet kFeet = {"`foot_slip`, `foot_penetration`, `foot_float`",
                          [](const Violation& v) { return is_foot(v.kind); }};
const FindingSet kScrape = {"`foot_scrape`", is_kind<FindingKind::foot_scrape>};
const FindingSet kFeetAndTiming = {
    "`foot_slip`, `foot_penetration`, `foot_float`, `foot_scrape`, `contact_ends_early`",
    [](const Violation& v) {
      return is_foot(v.kind) || v.kind == FindingKind::foot_scrape ||
             v.kind == FindingKind::contact_ends_early;
    }};
const FindingSet kSlip = {"`foot_slip`", is_kind<FindingKind::foot_slip>};
const FindingSet kFloat = {"`foot_float`", is_kind<FindingKind::foot_float>};
const FindingSet kPenetration = {"`foot_penetration`", is_kind<FindingKind::foot_penetration>};
const FindingSet kEndsEarly = {"`contact_ends_early`", is_kind<FindingKind::contact_ends_early>};
const FindingSet kTiming = {"`foot_float`, `contact_ends_early`", [](const Violation& v) {
                              return v.kind == FindingKind::foot_float ||
                                     v.kind == FindingKind::contact_ends_early;
                            }};
const FindingSet kPosition = {"`joint_position`", is_kind<FindingKind::joint_position>};
const FindingSet kSpeed = {"`joint_speed`", is_kind<FindingKind::joint_speed>};
const FindingSet kTorque = {"`joint_torque`", is_kind<FindingKind::joint_torque>};
const FindingSet kStep = {"`servo_step`", is_kind<FindingKind::servo_step>};
const FindingSet kMotor = {"`motor_acceleration`", is_kind<FindingKind::motor_acceleration>};
const FindingSet kStepAndMotor = {"`servo_step`, `motor_acceleration`", [](const Violation& v) {
                                    return v.kind == FindingKind::servo_step ||
                                           v.kind == FindingKind::motor_acceleration;
                                  }};
const FindingSet kSpeedAndStep = {"`joint_speed`, `servo_step`", [](const Violation& v) {
                                    return v.kind == FindingKind::joint_speed ||
                                           v.kind == FindingKind::servo_step;
                                  }};
const FindingSet kRates = {"rates",
                           [](const Violation& v) { return is_class(v, LimitClass::rate); }};
const FindingSet kCollision = {"`self_collision`", is_kind<FindingKind::self_collision>};
const FindingSet kForces = {"forces", is_force};
const FindingSet kForcesOnGround = {
    "forces except `ballistic`, `angular_momentum`",
    [](const Violation& v) { return is_force(v) && !is_flight(v); }};
const FindingSet kForcesButTorque = {"forces except `joint_torque`", [](const Violation& v) {
                                       return is_force(v) && v.kind != FindingKind::joint_torque;
                                     }};
const FindingSet kForcesAndMargins = {
    "forces, `support_margin` of the command",
    [](const Violation& v) { return is_force(v) || v.kind == FindingKind::support_margin; }};
const FindingSet kFlight = {"`ballistic`, `angular_momentum`", is_flight};
const FindingSet kFall = {"`ballistic`", is_kind<FindingKind::ballistic>};
const FindingSet kLeaps = {"`ballistic` with a leap of the COG", [](const Violation& v) {
                             return v.kind == FindingKind::ballistic && v.item == kMotionLeaps;
                           }};
const FindingSet kCommandFall = {
    "`ballistic` of the commanded COG",
    [](const Violation& v) { return v.kind == FindingKind::ballistic && v.item == kCommandFalls; }};
const FindingSet kMomentum = {"`angular_momentum`", is_kind<FindingKind::angular_momentum>};
const FindingSet kCommand = {"command residuals",
                             [](const Violation& v) { return is_class(v, LimitClass::command); }};
const FindingSet kCog = {"`cog_residual`", is_kind<FindingKind::cog_residual>};
const FindingSet kZmp = {"`zmp_residual`", is_kind<FindingKind::zmp_residual>};
const FindingSet kZmpAndForce = {"`zmp_residual`, `fz_residual`", [](const Violation& v) {
                                   return v.kind == FindingKind::zmp_residual ||
                                          v.kind == FindingKind::fz_residual;
                                 }};
const FindingSet kCogAndForce = {"`cog_residual`, `fz_residual`", [](const Violation& v) {
                                   return v.kind == FindingKind::cog_residual ||
                                          v.kind == FindingKind::fz_residual;
                                 }};
const FindingSet kSupport = {"`support_margin`", is_kind<FindingKind::support_margin>};
const FindingSet kMotionSupport = {"`support_margin` of the motion", [](const Violation& v) {
                                     return v.kind == FindingKind::support_margin &&
                                            v.item == kMotionZmp;
                                   }};
const FindingSet kFriction = {"`friction`", is_kind<FindingKind::friction>};
const FindingSet kTorsion = {"`yaw_moment`", is_kind<FindingKind::yaw_moment>};

// ---- intervals

// Number of samples before and after a lift-off or landing that a discontinuity of the path
// affects. Derived: differences reach over three samples, and two more samples on either side
// belong neither to the flight nor to the support.
constexpr int kEdgeReach = 5;

Interval influence_of(const Scene& scene, int i) {
  Interval s = deviation_around(scene.motion, scene.window(i));
  if (is_foot(scene.of(i).kind)) {
    const Interval off = displacement_around(scene.motion, scene.window(i));
    s = {std::min(s.first, off.first), std::max(s.last, off.last)};
  }
  return around(s, pad_samples(scene.motion));
}

Interval edges_of(const Scene& scene, int i) {
  return {scene.window(i).first - kDifferenceReach, scene.window(i).last + 1 + kDifferenceReach};
}

const Where kAnywhere = {"anywhere", [](const Scene& scene, int) {
                           return std::vector<Interval>{{0, scene.motion.count()}};
                         }};
const Where kWindow = {"in the window of the cause", [](const Scene& scene, int i) {
                         return std::vector<Interval>{around(scene.window(i))};
                       }};
const Where kNearWindow = {
    "within 3 samples of the window of the cause", [](const Scene& scene, int i) {
      return std::vector<Interval>{around(scene.window(i), kDifferenceReach)};
    }};
const Where kBesideWindow = {"within 5 samples of the window of the cause",
                             [](const Scene& scene, int i) {
                               return std::vector<Interval>{around(scene.window(i), kEdgeReach)};
                             }};
const Where kPaddedWindow = {
    "within 50 ms of the window of the cause", [](const Scene& scene, int i) {
      return std::vector<Interval>{around(scene.window(i), pad_samples(scene.motion))};
    }};
const Where kInfluence = {"in the influence interval of the cause", [](const Scene& scene, int i) {
                            return std::vector<Interval>{influence_of(scene, i)};
                          }};
const Where kAngleInfluence = {
    "in the excursion of the joint, or in the influence interval of the cause",
    [](const Scene& scene, int i) {
      return std::vector<Interval>{
          around(wrong_angle_around(scene.motion, scene.window(i)), pad_samples(scene.motion))};
    }};
const Where kDeviation = {
    "while the COG differs from its command", [](const Scene& scene, int i) {
      return std::vector<Interval>{deviation_around(scene.motion, scene.window(i))};
    }};
const Where kEdges = {
    "within 3 samples of the beginning or the end of the cause",
    [](const Scene& scene, int i) { return std::vector<Interval>{edges_of(scene, i)}; }};
const Where kSameFlight = {
    "in the flight in which the cause occurs", [](const Scene& scene, int i) {
      return std::vector<Interval>{flight_around(scene.motion, scene.window(i))};
    }};
const Where kFlightEdges = {
    "within 5 samples of the lift-off or the landing", [](const Scene& scene, int i) {
      const Interval f = flight_around(scene.motion, scene.window(i));
      return std::vector<Interval>{{f.first - kEdgeReach, f.first + kEdgeReach},
                                   {f.last - kEdgeReach, f.last + kEdgeReach}};
    }};
const Where kNearFlight = {"within 5 samples of the flight in which the cause occurs",
                           [](const Scene& scene, int i) {
                             return std::vector<Interval>{
                                 around(flight_around(scene.motion, scene.window(i)), kEdgeReach)};
                           }};
const Where kPhases = {
    "in the phase of the cause, or in an adjacent swing or flight of the same foot",
    [](const Scene& scene, int i) {
      return std::vector<Interval>{
          around(moved_phases(scene.motion, scene.of(i)), kDifferenceReach)};
    }};
const Where kBetweenRests = {
    "between the same two rests as the cause", [](const Scene& scene, int i) {
      return std::vector<Interval>{motion_around(scene.motion, scene.of(i).sample)};
    }};

// ---- conditions

// The torsional friction arm underestimates the resistance to turning by at most this factor.
// Source: docs/attribution.md.
constexpr double kArmFactor = 2;
// A sole whose displacement is below this share of the largest one counts as back in its place.
// Chosen: a tenth. No measured case changes between half and twice the value (constants.md).
constexpr double kBackShare = 0.1;

bool same_item(const Scene& scene, int i, int j) { return scene.of(i).item == scene.of(j).item; }

bool is_jump(const Scene& scene, int j, int sample) {
  const FindingWindow& w = scene.window(j);
  return is_class(w.worst, LimitClass::rate) && w.last - w.first <= 2 * kDifferenceReach &&
         around(w, kDifferenceReach).contains(sample);
}

// Whether a sole leaves its place suddenly, and comes back suddenly or at the end of its contact.
// If so, the angles of the leg's joints change suddenly with the sole, each by the amount that the
// geometry requires.
bool stands_before_and_after(const Scene& scene, const FindingWindow& w) {
  const JudgedMotion& motion = scene.motion;
  const int foot = w.worst.item;
  const ContactInterval& contact = motion.plan.at(static_cast<Side>(foot), w.worst.sample);
  const double small = kBackShare * displacement(motion, foot, w.worst.sample);
  const auto stands = [&](int k) {
    return k < contact.first || k > contact.last || displacement(motion, foot, k) <= small;
  };
  return contact.contact && stands(w.first - kDifferenceReach) && stands(w.last + kDifferenceReach);
}

// The interval from the last sudden change of the joint's angle before this window to the first one
// after the window.
Interval held_around(const Scene& scene, const FindingWindow& w, int dof) {
  Interval held = {0, scene.motion.count() - 1};
  for (const FindingWindow& jump : scene.windows) {
    const Violation& v = jump.worst;
    const bool of_joint =
        v.severity == Severity::error && v.item == dof && is_class(v, LimitClass::rate);
    if (!of_joint) continue;
    if (jump.first <= w.first + kDifferenceReach) held.first = std::max(held.first, jump.first);
    if (jump.last >= w.last + 1 - kDifferenceReach) held.last = std::min(held.last, jump.last);
  }
  return held;
}

const Condition kAlways = {"always", [](Scene&, int, int, const Interval&) { return true; }};

const Condition kNotAskedFor = {
    "always, except for a ZMP that is outside the support because the commanded ZMP is outside",
    [](Scene& scene, int, int j, const Interval&) {
      return !is_asked_for(scene.motion, scene.of(j));
    }};

const Condition kLargerOfOneFoot = {
    "cause and effect concern the same foot, and the displacement of the cause is larger",
    [](Scene& scene, int i, int j, const Interval&) {
      const double cause = std::abs(scene.of(i).value), effect = std::abs(scene.of(j).value);
      return same_item(scene, i, j) && (cause != effect ? cause > effect : i < j);
    }};

const Condition kJointOfLeg = {"the joint belongs to a leg",
                               [](Scene& scene, int i, int, const Interval&) {
                                 return scene.motion.model.is_leg_joint(scene.of(i).item);
                               }};

const Condition kTouchesByAngle = {
    "the wrong angle makes the bodies overlap", [](Scene& scene, int i, int j, const Interval&) {
      return touches_by_limits(scene.motion, scene.of(j)) ||
             (hangs_on(scene.motion, scene.of(j), scene.of(i).item) &&
              wrong_angle_around(scene.motion, scene.window(i)).contains(scene.window(j)));
    }};

const Condition kRateOfAngle = {
    "cause and effect concern the same joint. If the effect is a jump, the joint also jumps back",
    [](Scene& scene, int i, int j, const Interval&) {
      const Violation& v = scene.of(j);
      if (!same_item(scene, i, j)) return false;
      return !broken_by_jump(scene.motion, v.sample) ||
             comes_back(
                 scene.motion, v.item,
                 around(wrong_angle_around(scene.motion, scene.window(i)), kDifferenceReach));
    }};

const Condition kSameJoint = {
    "cause and effect concern the same joint",
    [](Scene& scene, int i, int j, const Interval&) { return same_item(scene, i, j); }};

const Condition kSameFoot = {
    "cause and effect concern the same foot",
    [](Scene& scene, int i, int j, const Interval&) { return same_item(scene, i, j); }};

const Condition kInsideInterval = {"the effect begins and ends within this interval",
                                   [](Scene& scene, int, int j, const Interval& interval) {
                                     return interval.contains(scene.window(j));
                                   }};

const Condition kJumpThereAndBack = {
    "the joint of the effect jumps with the foot",
    [](Scene& scene, int i, int j, const Interval& interval) {
      const FindingWindow& w = scene.window(i);
      const Violation& v = scene.of(j);
      if (!is_jump(scene, j, w.first) && !is_jump(scene, j, w.last + 1)) return false;
      return comes_back(scene.motion, v.item, interval) ||
             (stands_before_and_after(scene, w) &&
              scene.motion.model.in_leg(static_cast<Side>(scene.of(i).item), v.item));
    }};

const Condition kHeldJoint = {
    "the joint jumps into the overlap or out of the overlap",
    [](Scene& scene, int i, int j, const Interval&) {
      const int dof = scene.of(j).item;
      if (!sets_distance(scene.motion, scene.of(i), dof)) return false;
      const Interval held = held_around(scene, scene.window(i), dof);
      return comes_back(scene.motion, dof, held) && held.touches(scene.window(j)) &&
             (is_jump(scene, j, held.first) || is_jump(scene, j, held.last));
    }};

// A displaced foot on the ground does not disturb a free flight. But where the foot is displaced
// suddenly, the rates of a few samples before it are also wrong, because they are differences
// across the discontinuity.
const Condition kNearDisplacement = {
    "the effect is within 3 samples of the displacement of the foot",
    [](Scene& scene, int i, int j, const Interval&) {
      const Interval off = displacement_around(scene.motion, scene.window(i));
      const int sample = scene.of(j).sample;
      return off.first <= sample + kDifferenceReach && sample - kDifferenceReach <= off.last;
    }};

const Condition kMovesCog = {
    "the COG error is at most the displacement of the sole, or the COG error vanishes when the "
    "whole robot is moved so that the sole is in its place",
    [](Scene& scene, int i, int j, const Interval&) {
      return moves_cog(scene.motion, scene.of(i), scene.of(j));
    }};

const Condition kTouchesByFoot = {
    "the leg of this foot overlaps only while the foot is displaced, and the overlap is at most as "
    "large as the displacement",
    [](Scene& scene, int i, int j, const Interval&) {
      const Violation& foot = scene.of(i);
      const int hip = scene.motion.model.leg(static_cast<Side>(foot.item)).front();
      return -scene.of(j).value <= displacement(scene.motion, foot.item, foot.sample) &&
             hangs_on(scene.motion, scene.of(j), hip) &&
             displacement_around(scene.motion, scene.window(i)).contains(scene.window(j));
    }};

const Condition kBeyondFlight = {"the COG error lasts more than 3 samples longer than the flight",
                                 [](Scene& scene, int, int, const Interval& off) {
                                   return !(scene.motion.flies(off.first + kDifferenceReach) &&
                                            scene.motion.flies(off.last - kDifferenceReach));
                                 }};

const Condition kHoldsInFreeFlight = {
    "the torque would be within its limit if the robot fell freely in this flight",
    [](Scene& scene, int, int j, const Interval&) {
      return holds_in_free_flight(scene.motion, scene.of(j));
    }};

const Condition kOfFlight = {
    "the effect begins and ends within this interval, or is within 3 samples of the cause",
    [](Scene& scene, int i, int j, const Interval& near) {
      return near.contains(scene.window(j)) ||
             around(scene.window(i), kDifferenceReach).touches(scene.window(j));
    }};

const Condition kUncountedFoot = {"a foot stands on the ground without a planned contact",
                                  [](Scene& scene, int, int j, const Interval&) {
                                    return uncounted_foot_stands(scene.motion, scene.of(j).sample);
                                  }};

const Condition kSlowerPace = {"both the cause and the effect come from the speed",
                               [](Scene& scene, int i, int j, const Interval&) {
                                 return slower_pace_removes(scene.motion, scene.of(i), scene.of(j));
                               }};

const Condition kTorqueOfLeg = {"the joint belongs to a leg",
                                [](Scene& scene, int, int j, const Interval&) {
                                  return scene.motion.model.is_leg_joint(scene.of(j).item);
                                }};

const Condition kHeldByFriction = {
    "the yaw moment is at most twice its limit, if this limit is computed with the friction "
    "coefficient that the motion needs",
    [](Scene& scene, int i, int j, const Interval&) {
      const double more = scene.of(i).value / scene.of(i).limit;
      return scene.of(j).value <= kArmFactor * more * scene.of(j).limit;
    }};

// ---- the rules, in their order

std::vector<Effect> effects_of_foot() {
  return {{kFlight, kInfluence, kNearDisplacement},
          {kCog, kInfluence, kMovesCog},
          {kForcesOnGround, kInfluence, kNotAskedFor},
          {kZmpAndForce, kInfluence, kAlways},
          {kCollision, kInfluence, kTouchesByFoot}};
}

Rule jumps_beside(const FindingSet& foot) {
  return {foot, Order::by_time, {{kRates, kEdges, kJumpThereAndBack}}};
}

const std::vector<Rule>& rules() {
  static const std::vector<Rule> table = {
      {kFeet, Order::by_effect, {{kFeet, kPaddedWindow, kLargerOfOneFoot}}},
      {kFeet, Order::by_effect, {{kScrape, kPaddedWindow, kSameFoot}}},
      {kPosition,
       Order::by_time,
       {{kForces, kAngleInfluence, kNotAskedFor},
        {kCommand, kAngleInfluence, kAlways},
        {kFeetAndTiming, kAngleInfluence, kJointOfLeg},
        {kCollision, kAngleInfluence, kTouchesByAngle},
        {kRates, kAngleInfluence, kRateOfAngle}}},
      {kLeaps, Order::by_time, {{kFeet, kBesideWindow, kInsideInterval}}},
      jumps_beside(kSlip),
      jumps_beside(kFloat),
      jumps_beside(kPenetration),
      {kCollision, Order::by_time, {{kRates, kAnywhere, kHeldJoint}}},
      {kFloat, Order::by_time, effects_of_foot()},
      {kSlip, Order::by_time, effects_of_foot()},
      {kCog, Order::by_time, {{kCommandFall, kDeviation, kBeyondFlight}}},
      {kFall,
       Order::by_severity,
       {{kTorque, kSameFlight, kHoldsInFreeFlight},
        {kFlight, kSameFlight, kAlways},
        {kPenetration, kSameFlight, kAlways},
        {kForces, kFlightEdges, kInsideInterval},
        {kCommand, kFlightEdges, kInsideInterval},
        {kCogAndForce, kNearFlight, kOfFlight}}},
      {kMomentum,
       Order::by_severity,
       {{kTorque, kSameFlight, kHoldsInFreeFlight},
        {kFlight, kSameFlight, kAlways},
        {kPenetration, kSameFlight, kAlways}}},
      {kPenetration, Order::by_time, effects_of_foot()},
      {kCollision,
       Order::by_time,
       {{kForces, kInfluence, kNotAskedFor}, {kCommand, kInfluence, kAlways}}},
      {kStep,
       Order::by_time,
       {{kForces, kInfluence, kNotAskedFor},
        {kCommand, kInfluence, kAlways},
        {kFeetAndTiming, kInfluence, kJointOfLeg},
        {kRates, kInfluence, kSameJoint}}},
      {kFloat, Order::by_time, {{kEndsEarly, kPhases, kAlways}}},
      {kTiming, Order::by_time, {{kForcesAndMargins, kPhases, kUncountedFoot}}},
      {kSpeed,
       Order::worst_of_each_motion,
       {{kForcesButTorque, kBetweenRests, kSlowerPace},
        {kZmpAndForce, kBetweenRests, kSlowerPace},
        {kStepAndMotor, kBetweenRests, kSlowerPace}}},
      {kTorque,
       Order::worst_of_each_motion,
       {{kForcesButTorque, kBetweenRests, kSlowerPace},
        {kZmpAndForce, kBetweenRests, kSlowerPace},
        {kStepAndMotor, kBetweenRests, kSlowerPace}}},
      {kSpeedAndStep, Order::by_severity, {{kMotor, kNearWindow, kSameJoint}}},
      {kTorque, Order::by_severity, {{kMotor, kNearWindow, kSameJoint}}},
      {kMotionSupport, Order::by_time, {{kTorque, kNearWindow, kTorqueOfLeg}}},
      {kFriction, Order::by_severity, {{kTorsion, kAnywhere, kHeldByFriction}}},
      {kCog, Order::by_severity, {{kZmpAndForce, kInfluence, kAlways}}},
      {kSupport, Order::by_severity, {{kZmp, kWindow, kAlways}}}};
  return table;
}

// ---- execution of the rules

bool follows(Scene& scene, const Effect& effect, const std::vector<Interval>& intervals, int i,
             int j) {
  return std::any_of(intervals.begin(), intervals.end(), [&](const Interval& interval) {
    return interval.touches(scene.window(j)) && effect.condition.holds(scene, i, j, interval);
  });
}

void mark(Scene& scene, const Rule& rule, int i) {
  for (const Effect& effect : rule.effects) {
    const std::vector<Interval> intervals = effect.where.of(scene, i);
    for (int j = 0; j < scene.count(); ++j)
      if (j != i && scene.open(j) && effect.findings.contains(scene.of(j)) &&
          follows(scene, effect, intervals, i, j))
        scene.windows[j].cause = i;
  }
}

std::vector<int> causes_of(const Scene& scene, const Rule& rule) {
  std::vector<int> causes;
  for (int i = 0; i < scene.count(); ++i)
    if (scene.open(i) && rule.cause.contains(scene.of(i))) causes.push_back(i);
  if (rule.order != Order::by_time)
    std::stable_sort(causes.begin(), causes.end(),
                     [&](int a, int b) { return scene.of(a).size > scene.of(b).size; });
  return causes;
}

void mark_by_effect(Scene& scene, const Rule& rule) {
  const Effect& effect = rule.effects.front();
  for (int j = 0; j < scene.count(); ++j) {
    if (!effect.findings.contains(scene.of(j))) continue;
    for (int i = 0; i < scene.count() && scene.open(j); ++i)
      if (i != j && scene.open(i) && rule.cause.contains(scene.of(i)) &&
          follows(scene, effect, effect.where.of(scene, i), i, j))
        scene.windows[j].cause = i;
  }
}

// Only the worst joint of each motion between two rests is used as a cause.
void mark_by_motion(Scene& scene, const Rule& rule) {
  std::vector<Interval> marked;
  for (const int i : causes_of(scene, rule)) {
    if (std::any_of(marked.begin(), marked.end(),
                    [&](const Interval& s) { return s.touches(scene.window(i)); }))
      continue;
    marked.push_back(motion_around(scene.motion, scene.of(i).sample));
    mark(scene, rule, i);
  }
}

void execute(Scene& scene, const Rule& rule) {
  if (rule.order == Order::by_effect) return mark_by_effect(scene, rule);
  if (rule.order == Order::worst_of_each_motion) return mark_by_motion(scene, rule);
  for (const int i : causes_of(scene, rule))
    if (scene.open(i)) mark(scene, rule, i);
}

}  // namespace
}  // namespace attribution

void mark_consequences(JudgedMotion& motion, std::vector<FindingWindow>& windows) {
  attribution::Scene scene = {motion, windows};
  for (const attribution::Rule& rule : attribution::rules()) attribution::execute(scene, rule);
  for (FindingWindow& w : windows)
    if (w.cause >= 0) w.worst.severity = Severity::warning;
}

// The joint at which a finding occurs, if it occurs at a joint.
static std::optional<int> joint_of(const JudgedMotion& motion, const Violation& v) {
  const auto place = spec_of(v.kind).place;
  if (!place) return std::nullopt;
  const Place at = place(motion, v);
  const auto* joint = std::get_if<JointPlace>(&at);
  return joint ? std::optional(joint->dof) : std::nullopt;
}

void add_table_findings(JudgedMotion& motion, std::vector<FindingWindow>& windows) {
  const attribution::Scene scene = {motion, windows};
  std::vector<std::pair<int, Interval>> reached;
  for (int i = 0; i < scene.count(); ++i) {
    if (!scene.open(i)) continue;
    reached.emplace_back(i, attribution::influence_of(scene, i));
    const Violation& v = scene.of(i);
    if (attribution::is_class(v, LimitClass::rate) || attribution::is_force(v))
      reached.emplace_back(i, motion_around(motion, v.sample));
  }
  std::vector<FindingWindow> found = motion.table.finish();
  for (FindingWindow& w : found) {
    if (w.worst.severity != Severity::error) continue;
    // An error of the same joint is a better explanation than an earlier one of another joint.
    const std::optional<int> joint = joint_of(motion, w.worst);
    const auto touches = [&](const auto& r) { return r.second.touches(w); };
    const auto same_joint = [&](const auto& r) {
      return joint && touches(r) && joint_of(motion, scene.of(r.first)) == joint;
    };
    auto cause = std::find_if(reached.begin(), reached.end(), same_joint);
    if (cause == reached.end()) cause = std::find_if(reached.begin(), reached.end(), touches);
    if (cause == reached.end()) continue;
    w.cause = cause->first;
    w.worst.severity = Severity::warning;
  }
  windows.insert(windows.end(), found.begin(), found.end());
}

std::vector<std::array<std::string, 4>> attribution_table() {
  std::vector<std::array<std::string, 4>> table;
  for (const attribution::Rule& rule : attribution::rules())
    for (const attribution::Effect& effect : rule.effects)
      table.push_back(
          {rule.cause.words, effect.findings.words, effect.where.words, effect.condition.words});
  return table;
}

}  // namespace ayumi
