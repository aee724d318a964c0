#include "ayumi/check/profiles.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/pattern/generate.hpp"
#include "ayumi/pattern/sample.hpp"

namespace ayumi {

namespace {

bool of_actuators(const Finding& f) {
  return f.severity == Severity::error && (f.kind == "joint_speed" || f.kind == "joint_torque" ||
                                           f.kind == "servo_step" || f.kind == "continuous_torque");
}

// The finding of this kind that is furthest beyond its limit.
const Finding* worst(const ConsistencyReport& report, const std::string& kind) {
  const Finding* found = nullptr;
  for (const Finding& f : report.findings)
    if (of_actuators(f) && f.kind == kind &&
        (!found || std::abs(f.worst / f.limit) > std::abs(found->worst / found->limit)))
      found = &f;
  return found;
}

std::vector<std::string> missing(const ConsistencyReport& report) {
  std::vector<std::string> parts;
  for (const std::string kind :
       {"joint_torque", "continuous_torque", "joint_speed", "servo_step"}) {
    const Finding* f = worst(report, kind);
    if (!f) continue;
    parts.push_back(text::brief(std::abs(f->worst), 3) + " " + f->unit +
                    (kind == "continuous_torque" ? " lasting" : "") + " at " + f->where + " at " +
                    text::fixed(f->at, 2) + " s (has " + text::brief(std::abs(f->limit), 3) + ")");
  }
  return parts;
}

// The keyed jump of a goal, from the height at which the pattern holds the COG.
CommandSeries keyed_jump(const RobotModel& model, const CommandSeries& series, const ViipSpan& span,
                         const JumpGoal& goal) {
  const CommandSample& held = series.samples[static_cast<size_t>(span.begin)];
  JumpParameters p = jump_defaults(model);
  p.height = goal.height;
  p.stoop = goal.stoop;
  p.forward = goal.forward;
  p.cog_height =
      held.cog.z() - 0.5 * (held.feet[0].translation().z() + held.feet[1].translation().z());
  return sample(model, jump_pattern(model, p));
}

ActuatorNeed need_of(const RobotModel& model, const CommandSeries& series,
                     const CheckOptions& options, const ConsistencyReport& report) {
  ActuatorNeed need;
  const std::vector<std::string> parts = missing(report);
  if (parts.empty()) return need;
  for (const std::string& name : model.profile_names()) {
    if (name == report.profile) continue;
    CheckOptions other = options;
    other.profile = name;
    if (missing(check_consistency(model, series, other)).empty()) need.sufficient.push_back(name);
  }
  need.text = "profile " + report.profile + " is not enough: needs " + text::join(parts, ", ") +
              "; " +
              (need.sufficient.empty() ? "no other profile would do"
                                       : text::join(need.sufficient, ", ") + " would do");
  return need;
}

}  // namespace

ActuatorNeed actuator_need(const RobotModel& model, const CommandSeries& series,
                           const CheckOptions& options, const ConsistencyReport& report) {
  const ActuatorNeed need = need_of(model, series, options, report);
  if (!need.text.empty()) return need;
  for (const ViipSpan& span : series.viip) {
    const auto* goal = std::get_if<JumpGoal>(&span.goal);
    if (!goal) continue;
    const std::string place =
        "VIIP jump at " + text::fixed(static_cast<double>(span.begin) * series.dt, 2) + " s: ";
    try {
      const CommandSeries jump = keyed_jump(model, series, span, *goal);
      ActuatorNeed of_jump = need_of(model, jump, options, check_consistency(model, jump, options));
      if (of_jump.text.empty()) continue;
      of_jump.text = place + of_jump.text + " (times from the start of its keyed form)";
      return of_jump;
    } catch (const Error& error) {
      if (error.code() == ErrorCode::internal) throw;
      return {place + error.what(), {}};
    }
  }
  return need;
}

}  // namespace ayumi
