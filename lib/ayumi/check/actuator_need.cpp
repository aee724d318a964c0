#include "ayumi/check/actuator_need.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ayumi/base/error.hpp"
#include "ayumi/base/significant.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

namespace {

// A joint of a leg that is too fast within this time before a lift-off or after a landing is fast
// because of the flight [s]. Chosen: the last part of a push; a stoop lasts 0.1 to 0.3 s.
constexpr double kPartOfPush = 0.1;
// The same time inside the flight, after its lift-off or before its landing [s]. Chosen: the legs
// still have the speed of the push.
constexpr double kAfterPush = 0.01;

// The error of this kind that is furthest beyond its limit.
const Finding* worst(const ConsistencyReport& report, FindingKind kind) {
  const Finding* found = nullptr;
  for (const Finding& f : report.findings)
    if (f.severity == Severity::error && f.kind == kind &&
        (!found || std::abs(f.worst / f.limit) > std::abs(found->worst / found->limit)))
      found = &f;
  return found;
}

std::vector<std::string> missing(const RobotModel& model, const ConsistencyReport& report) {
  std::vector<std::string> parts;
  for (const FindingSpec* spec : actuator_findings()) {
    const Finding* f = worst(report, spec->kind);
    if (!f) continue;
    const int dof = dof_of(*f);
    if (dof >= 0 && model.limits(report.profile).lacks_motor(dof)) {
      parts.push_back("a motor at " + f->where + " at " + text::fixed(f->at, 2) +
                      " s (this joint has none, because kp of its servo is 0)");
      continue;
    }
    const ShownUnit unit = shown_unit(f->unit, f->in_degrees);
    parts.push_back(text::significant(std::abs(f->worst) * unit.scale, 3) + " " + unit.name +
                    spec->actuator.after + " at " + f->where + " at " + text::fixed(f->at, 2) +
                    " s (limit " + text::significant(std::abs(f->limit) * unit.scale, 3) + " " +
                    unit.name + ")");
  }
  return parts;
}

// The flight that makes a joint fast at this time, if there is one.
std::optional<CommandSeries::Flight> flight_at(const CommandSeries& series, double at) {
  for (const CommandSeries::Flight& flight : series.flights()) {
    const double begin = static_cast<double>(flight.first) * series.dt,
                 end = static_cast<double>(flight.last) * series.dt;
    if ((at > begin - kPartOfPush && at < begin + kAfterPush) ||
        (at > end - kAfterPush && at < end + kPartOfPush))
      return flight;
  }
  return {};
}

// At lift-off and landing the COG has the speed g T / 2, and in one posture the speed of a joint of
// the legs is proportional to that of the COG. So each of these joints bounds the duration T of the
// flight, in which the robot rises by g T^2 / 8. The words are about the joint with the least
// bound.
std::string flight_words(const RobotModel& model, const CommandSeries& series,
                         const ConsistencyReport& report) {
  const Finding* least = nullptr;
  double possible = 0, lasts = 0;
  for (const Finding& f : report.findings) {
    if (f.kind != FindingKind::joint_speed || f.severity != Severity::error ||
        !model.is_leg_joint(dof_of(f)))
      continue;
    const std::optional<CommandSeries::Flight> flight = flight_at(series, f.at);
    if (!flight) continue;
    const double duration = static_cast<double>(flight->last + 1 - flight->first) * series.dt;
    const double bound = std::abs(f.limit / f.worst) * duration;
    if (least && bound >= possible) continue;
    least = &f;
    possible = bound;
    lasts = duration;
  }
  if (!least) return "";
  const auto rise = [](double duration) {
    return text::brief(1e3 * kGravity * duration * duration / 8, 2) + " mm";
  };
  return "the speed limit of " + least->where + " allows a flight of at most " +
         text::brief(possible, 2) + " s (a rise of " + rise(possible) +
         "), because a longer flight needs faster legs at lift-off and landing. The planned flight "
         "lasts " +
         text::brief(lasts, 3) + " s (a rise of " + rise(lasts) +
         "). This bound is for the planned postures of the legs, and considers " + least->where +
         " alone. With the other joints, the longest possible flight may be even shorter";
}

ActuatorNeed need_of(const RobotModel& model, const CommandSeries& series,
                     const CheckOptions& options, const ConsistencyReport& report) {
  ActuatorNeed need;
  const std::vector<std::string> parts = missing(model, report);
  if (parts.empty()) return need;
  for (const std::string& name : model.profile_names()) {
    if (name == report.profile) continue;
    CheckOptions other = options;
    other.profile = name;
    if (missing(model, check_consistency(model, series, other)).empty())
      need.sufficient.push_back(name);
  }
  need.text = "profile " + report.profile + " is too weak: the motion needs " +
              text::join(parts, ", ") + ". " +
              (need.sufficient.empty()
                   ? "No other profile is strong enough"
                   : (need.sufficient.size() > 1 ? "The profiles " : "The profile ") +
                         text::join(need.sufficient, ", ") +
                         (need.sufficient.size() > 1 ? " are strong enough" : " is strong enough"));
  need.flight = flight_words(model, series, report);
  return need;
}

}  // namespace

ActuatorNeed actuator_need(const RobotModel& model, const CommandSeries& series,
                           const CheckOptions& options, const ConsistencyReport& report) {
  return need_of(model, series, options, report);
}

ActuatorNeed actuator_need(const RobotModel& model, const std::vector<KeyedGoal>& goals,
                           const CheckOptions& options) {
  for (const KeyedGoal& goal : goals) {
    if (!goal.obstacle.empty()) return {goal.place + ": " + goal.obstacle, {}};
    ActuatorNeed need =
        need_of(model, goal.motion, options, check_consistency(model, goal.motion, options));
    if (need.text.empty()) continue;
    need.text =
        goal.place + ": " + need.text +
        ". In this message, the times at joints are counted from the beginning of the motion "
        "that Ayumi planned for this goal, not from the beginning of the pattern";
    return need;
  }
  return {};
}

}  // namespace ayumi
