#include "ayumi/task/scenario_findings.hpp"

#include <algorithm>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/sim/payload.hpp"
#include "ayumi/sim/run_caution.hpp"

namespace ayumi {

std::vector<std::string> findings_under_scenario(const Task& task, const CheckOptions& options,
                                                 const ConsistencyReport& plain) {
  const auto overlap = [](const Disturbance& a, const Disturbance& b) {
    return a.at <= b.at + b.duration && b.at <= a.at + a.duration;
  };
  std::vector<std::string> sentences;
  for (const Disturbance& d : task.pattern.scenario) {
    if (!std::holds_alternative<FrictionChange>(d.what)) continue;
    // What acts at the same time acts together with it.
    CheckOptions loaded = options;
    std::vector<CarriedMass> masses;
    for (const Disturbance& other : task.pattern.scenario) {
      if (!overlap(d, other)) continue;
      if (const auto* friction = std::get_if<FrictionChange>(&other.what))
        loaded.friction = std::min(loaded.friction, friction->friction);
      const auto* payload = std::get_if<Payload>(&other.what);
      for (size_t i = 0; payload && i < task.robot.links().size(); ++i)
        if (task.robot.links()[i].name == payload->on)
          masses.push_back({static_cast<int>(i), payload->point, payload->mass});
    }
    const ConsistencyReport report =
        check_consistency(with_payloads(task.robot, masses), task.series, loaded);
    const auto is_new = [&](const Finding& f) {
      return f.severity == Severity::error && spec_of(f.kind).limit_class != LimitClass::command &&
             f.begin <= d.at + d.duration && f.end >= d.at &&
             std::none_of(plain.findings.begin(), plain.findings.end(), [&](const Finding& p) {
               return p.severity == Severity::error && p.kind == f.kind && p.where == f.where &&
                      p.begin <= f.end && f.begin <= p.end;
             });
    };
    const auto first = std::find_if(report.findings.begin(), report.findings.end(), is_new);
    const auto count = std::count_if(report.findings.begin(), report.findings.end(), is_new);
    std::string words =
        words_of({d}) +
        " is a disturbance, and the verdict is without disturbances. With this disturbance, ";
    if (first == report.findings.end())
      words += "check finds no other error";
    else
      words += std::string("check finds ") + name_of(first->kind) + " " + first->where + " at " +
               text::fixed(first->at, 3) + " s: " + amount_text(*first) +
               (count > 1 ? " (and " + text::counted(count - 1, "more error") + ")" : "");
    sentences.push_back(words);
  }
  return sentences;
}

}  // namespace ayumi
