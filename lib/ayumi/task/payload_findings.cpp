#include "ayumi/task/payload_findings.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ayumi/base/text.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/sim/payload.hpp"
#include "ayumi/task/acting_disturbances.hpp"

namespace ayumi {

namespace {

// Number of steps of the bisection for the mass that a motion bears. Chosen: the result is exact to
// 3 % of the payload.
constexpr int kMassSteps = 5;

std::string mass_text(double mass) { return text::brief(mass, 4) + " kg"; }

// The mass in whole grams, not above the mass itself.
double rounded_down(double mass) { return 1e-3 * std::floor(1e3 * mass); }

// The errors that this payload brings when its mass is multiplied by `share`. Payloads that are
// carried at the same time are included.
std::vector<Finding> errors_with(const Task& task, const CheckOptions& options,
                                 const ConsistencyReport& plain, size_t which, double share) {
  std::vector<Disturbance> scenario = task.pattern.scenario;
  std::get<Payload>(scenario[which].what).mass *= share;
  const Disturbance& carried = scenario[which];
  const RobotModel loaded =
      with_payloads(task.robot, masses_carried_while(carried, scenario, task.robot));
  return errors_brought_by(carried, check_consistency(loaded, task.series, options), plain);
}

// A payload that causes errors.
struct HeavyPayload {
  size_t which = 0;
  std::vector<Finding> errors;
  double bearable = 0;  ///< the largest mass that causes no errors [kg]
};

std::vector<HeavyPayload> heavy_payloads(const Task& task, const CheckOptions& options,
                                         const ConsistencyReport& plain) {
  std::vector<HeavyPayload> heavy;
  for (size_t i = 0; i < task.pattern.scenario.size(); ++i) {
    const auto* payload = std::get_if<Payload>(&task.pattern.scenario[i].what);
    if (!payload) continue;
    HeavyPayload found{i, errors_with(task, options, plain, i, 1)};
    if (found.errors.empty()) continue;
    double least = 0, most = 1;
    for (int step = 0; step < kMassSteps; ++step) {
      const double share = 0.5 * (least + most);
      (errors_with(task, options, plain, i, share).empty() ? least : most) = share;
    }
    found.bearable = rounded_down(least * payload->mass);
    heavy.push_back(std::move(found));
  }
  return heavy;
}

}  // namespace

std::vector<Mistake> judge_payloads(const Task& task, const CheckOptions& options,
                                    ConsistencyReport& report) {
  const std::vector<HeavyPayload> all = heavy_payloads(task, options, report);
  if (all.empty()) return {};
  std::vector<Mistake> mistakes;
  std::vector<Finding> findings = report.findings;
  for (const HeavyPayload& heavy : all) {
    const auto& payload = std::get<Payload>(task.pattern.scenario[heavy.which].what);
    const std::string mass = mass_text(payload.mass), carried = mass + " on " + payload.on;
    const std::string bearable =
        heavy.bearable > 0 ? "up to " + mass_text(heavy.bearable) : "no mass";
    for (Finding f : heavy.errors) {
      f.where += " with " + carried;
      f.hint = f.remedy = "the payload of " + carried +
                          " causes this finding. In this motion, the robot can carry " + bearable +
                          " there";
      f.follows_from.clear();
      f.cause = -1;
      findings.push_back(std::move(f));
    }
    mistakes.push_back({"/scenario/" + std::to_string(heavy.which),
                        "the payload on " + payload.on + " is " + mass +
                            ", which is too heavy for this motion. The robot can carry " +
                            bearable + " there"});
  }
  // Errors come first in the report, and causes are counted among them.
  std::vector<size_t> order(findings.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return findings[a].severity < findings[b].severity; });
  std::vector<int> place(order.size());
  report.findings.clear();
  for (const size_t i : order) {
    place[i] = static_cast<int>(report.findings.size());
    report.findings.push_back(findings[i]);
  }
  for (Finding& f : report.findings)
    if (f.cause >= 0) f.cause = place[static_cast<size_t>(f.cause)];
  report.consistent = false;
  return mistakes;
}

}  // namespace ayumi
