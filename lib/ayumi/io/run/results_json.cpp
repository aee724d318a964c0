#include "ayumi/io/run/results_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "ayumi/io/run/simulation_log_file.hpp"

namespace ayumi {

namespace {

using OrderedJson = nlohmann::ordered_json;

std::string text_of(const OrderedJson& json) {
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

// A figure that does not exist (never fell, nothing to measure) is null.
OrderedJson figure(double value, bool exists = true) {
  return exists && std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

OrderedJson json_of(const Finding& f) {
  return {{"kind", name_of(f.kind)},
          {"severity", name_of(f.severity)},
          {"begin_s", f.begin},
          {"end_s", f.end},
          {"at_s", f.at},
          {"worst", figure(f.worst)},
          {"limit", figure(f.limit)},
          {"unit", f.unit},
          {"where", f.where},
          {"hint", f.hint},
          {"follows_from",
           f.follows_from.empty() ? OrderedJson(nullptr) : OrderedJson(f.follows_from)}};
}

OrderedJson json_of(const CheckSummary& summary) {
  OrderedJson json = OrderedJson::object();
  for (const FindingSpec* spec : summary_figures())
    json[spec->figure.key] = figure(summary[spec->kind]);
  return json;
}

OrderedJson json_of(const ConsistencyReport& report) {
  OrderedJson findings = OrderedJson::array();
  for (const Finding& finding : report.findings) findings.push_back(json_of(finding));
  return {{"verdict", report.consistent ? "consistent" : "inconsistent"},
          {"profile", report.profile},
          {"findings", findings},
          {"summary", json_of(report.summary)}};
}

}  // namespace

std::string check_json(const ConsistencyReport& report) { return text_of(json_of(report)); }

std::string simulation_json(const SimulationLog& log) {
  const SimulationResult& r = log.result;
  OrderedJson events = OrderedJson::array();
  for (const SimulationEvent& event : log.events)
    events.push_back({{"t_s", event.t}, {"kind", event.kind}, {"text", event.text}});
  const double duration =
      log.samples.empty() ? 0 : log.dt * static_cast<double>(log.samples.size() - 1);
  return text_of({{"controller", log.controller ? name_of(*log.controller) : ""},
                  {"plant", log.plant},
                  {"outcome", name_of(r.outcome)},
                  {"fell_at_s", figure(r.fell_at, r.fell_at >= 0)},
                  {"duration_s", duration},
                  {"max_tilt_rad", figure(r.max_tilt)},
                  {"final_cog_error_m", figure(r.final_cog_error)},
                  {"final_speed_m_s", figure(r.final_speed)},
                  {"zmp_tracking_rms_m", figure(r.zmp_tracking_rms)},
                  {"flight_s", figure(r.flight)},
                  {"apex_m", figure(r.apex, r.flight > 0)},
                  {"steps", r.steps},
                  {"max_joint_speed_ratio", figure(r.max_speed_ratio)},
                  {"max_torque_ratio", figure(r.max_torque_ratio)},
                  {"max_penetration_m", figure(r.max_penetration)},
                  {"max_foot_slip_m", figure(r.max_slip)},
                  {"max_contact_residual_m_s", figure(r.max_contact_residual)},
                  {"max_contact_iterations", r.max_contact_iterations},
                  {"mean_contact_iterations", figure(r.mean_contact_iterations)},
                  {"events", events},
                  {"log_hash", log_hash(log)}});
}

}  // namespace ayumi
