#include "ayumi/check/actuator_need.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/limits/amount_text.hpp"

namespace ayumi {

namespace {

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
      parts.push_back("a motor at " + f->where + ", which has none (kp of its servo is 0), at " +
                      text::fixed(f->at, 2) + " s");
      continue;
    }
    const ShownUnit unit = shown_unit(f->unit, f->in_degrees);
    parts.push_back(text::brief(std::abs(f->worst) * unit.scale, 3) + " " + unit.name +
                    spec->actuator.after + " at " + f->where + " at " + text::fixed(f->at, 2) +
                    " s (limit " + text::brief(std::abs(f->limit) * unit.scale, 3) + ")");
  }
  return parts;
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
              text::join(parts, ", ") + "; " +
              (need.sufficient.empty()
                   ? "no other profile is strong enough"
                   : (need.sufficient.size() > 1 ? "the profiles " : "the profile ") +
                         text::join(need.sufficient, ", ") +
                         (need.sufficient.size() > 1 ? " are strong enough" : " is strong enough"));
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
        " (times are counted from the beginning of the motion that was planned for this goal)";
    return need;
  }
  return {};
}

}  // namespace ayumi
