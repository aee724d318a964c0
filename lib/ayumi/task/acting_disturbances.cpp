#include "ayumi/task/acting_disturbances.hpp"

#include <algorithm>
#include <variant>

#include "ayumi/limits/limit.hpp"

namespace ayumi {

bool act_together(const Disturbance& a, const Disturbance& b) {
  return a.at <= b.at + b.duration && b.at <= a.at + a.duration;
}

std::vector<CarriedMass> masses_carried_while(const Disturbance& acting,
                                              const std::vector<Disturbance>& scenario,
                                              const RobotModel& robot) {
  std::vector<CarriedMass> masses;
  for (const Disturbance& other : scenario) {
    const auto* payload = std::get_if<Payload>(&other.what);
    if (!payload || !act_together(acting, other)) continue;
    const int link = robot.find_link(payload->on);
    if (link >= 0) masses.push_back({link, payload->point, payload->mass});
  }
  return masses;
}

std::vector<Finding> errors_brought_by(const Disturbance& acting, const ConsistencyReport& loaded,
                                       const ConsistencyReport& plain) {
  std::vector<Finding> errors;
  for (const Finding& f : loaded.findings) {
    if (f.severity != Severity::error || spec_of(f.kind).limit_class == LimitClass::command ||
        f.begin > acting.at + acting.duration || f.end < acting.at)
      continue;
    const bool known =
        std::any_of(plain.findings.begin(), plain.findings.end(), [&](const Finding& p) {
          return p.severity == Severity::error && p.kind == f.kind && p.where == f.where &&
                 p.begin <= f.end && f.begin <= p.end;
        });
    if (!known) errors.push_back(f);
  }
  return errors;
}

}  // namespace ayumi
