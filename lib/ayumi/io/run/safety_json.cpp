#include <cmath>
#include <nlohmann/json.hpp>

#include "ayumi/io/run/results_json.hpp"

namespace ayumi {

namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson figure(double value) {
  return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

OrderedJson json_of(const SafetyViolation& v) {
  return {{"kind", v.kind},   {"joint", v.joint}, {"at_s", v.t},   {"value", figure(v.value)},
          {"limit", v.limit}, {"unit", v.unit},   {"rows", v.rows}};
}

}  // namespace

std::string safety_json(const SafetyReport& report) {
  OrderedJson violations = OrderedJson::array();
  for (const SafetyViolation& violation : report.violations)
    violations.push_back(json_of(violation));
  return OrderedJson({{"safe", report.safe},
                      {"ramp_s", report.ramp},
                      {"hold_s", report.hold},
                      {"max_step_ratio", figure(report.max_step_ratio)},
                      {"worst_joint", report.worst_joint},
                      {"worst_at_s", report.worst_at},
                      {"min_limit_margin_rad", figure(report.min_limit_margin)},
                      {"margin_joint", report.margin_joint},
                      {"start_speed_rad_s", figure(report.start_speed)},
                      {"end_speed_rad_s", figure(report.end_speed)},
                      {"violations", violations}})
      .dump(2);
}

}  // namespace ayumi
