#include "ayumi/check/judge.hpp"

#include <algorithm>

#include "ayumi/base/text.hpp"
#include "ayumi/limits/amount_text.hpp"

namespace ayumi {

std::string Judgement::reason() const {
  if (good()) return "";
  const auto is_error = [](const Finding& f) { return f.severity == Severity::error; };
  const auto first = std::find_if(report.findings.begin(), report.findings.end(), is_error);
  if (first == report.findings.end()) return "the pattern is inconsistent: " + need().text;
  const auto errors = std::count_if(report.findings.begin(), report.findings.end(), is_error);
  std::string text =
      "the pattern is inconsistent: " + kind_place_and_time(*first) + ": " + amount_text(*first);
  if (errors > 1)
    text +=
        " (and " + std::to_string(errors - 1) + (errors == 2 ? " more error)" : " more errors)");
  return text;
}

Judgement judge(const RobotModel& model, const CommandSeries& series,
                const std::vector<KeyedGoal>& goals, const CheckOptions& options,
                const SampleObserver& observe) {
  Judgement judgement;
  judgement.report = check_consistency(model, series, options, observe);
  judgement.motion_consistent = judgement.report.consistent;
  judgement.motion_need = actuator_need(model, series, options, judgement.report);
  judgement.goal_need = actuator_need(model, goals, options);
  judgement.report.consistent = judgement.motion_consistent && judgement.goal_need.text.empty();
  return judgement;
}

}  // namespace ayumi
