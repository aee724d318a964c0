#include "ayumi/task/scenario_findings.hpp"

#include <algorithm>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/sim/payload.hpp"
#include "ayumi/sim/run_caution.hpp"
#include "ayumi/task/acting_disturbances.hpp"

namespace ayumi {

std::vector<std::string> findings_under_scenario(const Task& task, const CheckOptions& options,
                                                 const ConsistencyReport& plain) {
  std::vector<std::string> sentences;
  const bool has_payload =
      std::any_of(task.pattern.scenario.begin(), task.pattern.scenario.end(),
                  [](const Disturbance& d) { return std::holds_alternative<Payload>(d.what); });
  for (const Disturbance& d : task.pattern.scenario) {
    if (!std::holds_alternative<FrictionChange>(d.what)) continue;
    // The check includes the changes of friction and the payloads that act at the same time as this
    // one.
    CheckOptions loaded = options;
    for (const Disturbance& other : task.pattern.scenario)
      if (const auto* friction = std::get_if<FrictionChange>(&other.what);
          friction && act_together(d, other))
        loaded.friction = std::min(loaded.friction, friction->friction);
    const std::vector<CarriedMass> carried =
        masses_carried_while(d, task.pattern.scenario, task.robot);
    const RobotModel robot = with_payloads(task.robot, carried);
    // The verdict counts only the errors that the payloads cause.
    const ConsistencyReport& counted =
        carried.empty() ? plain : check_consistency(robot, task.series, options);
    const std::vector<Finding> errors =
        errors_brought_by(d, check_consistency(robot, task.series, loaded), counted);
    std::string words = words_of({d}) + " is a disturbance, and the verdict does not consider " +
                        (has_payload ? "disturbances other than payloads" : "disturbances") +
                        ". With this disturbance, ";
    if (errors.empty())
      words += "check finds no other error";
    else
      words += "check finds " + kind_place_and_time(errors[0]) + ": " + amount_text(errors[0]) +
               (errors.size() > 1 ? " (and " + text::counted(errors.size() - 1, "more error") + ")"
                                  : "");
    sentences.push_back(words);
  }
  return sentences;
}

}  // namespace ayumi
