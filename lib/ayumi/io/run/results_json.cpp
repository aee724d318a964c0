#include "ayumi/io/run/results_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "ayumi/io/run/simulation_log_file.hpp"

namespace ayumi {

namespace {

using OrderedJson = nlohmann::ordered_json;

std::string dumped(const OrderedJson& json) {
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

// A figure that does not exist (the robot never fell, nothing to measure) is null.
OrderedJson figure(double value, bool exists = true) {
  return exists && std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

OrderedJson json_of(const Finding& f) {
  return {
      {"kind", name_of(f.kind)},
      {"severity", name_of(f.severity)},
      {"begin_s", f.begin},
      {"end_s", f.end},
      {"at_s", f.at},
      {"worst", figure(f.worst)},
      {"limit", figure(f.limit)},
      {"unit", f.unit},
      {"where", f.where},
      {"hint", f.hint},
      {"follows_from", f.follows_from.empty() ? OrderedJson(nullptr) : OrderedJson(f.follows_from)},
      {"cause", f.cause < 0 ? OrderedJson(nullptr) : OrderedJson(f.cause)}};
}

OrderedJson json_of(const CheckSummary& summary) {
  OrderedJson json = OrderedJson::object();
  for (const FindingSpec* spec : summary_figures())
    json[spec->figure.key] = figure(summary[spec->kind]);
  return json;
}

OrderedJson json_of(const FigurePlaces& places) {
  OrderedJson json = OrderedJson::object();
  for (const FindingSpec* spec : summary_figures()) {
    const FigurePlace& place = places[spec->kind];
    if (std::isfinite(place.at))
      json[spec->figure.key] = {{"where", place.where}, {"at_s", place.at}};
  }
  return json;
}

OrderedJson json_of(const ConsistencyReport& report) {
  OrderedJson findings = OrderedJson::array();
  for (const Finding& finding : report.findings) findings.push_back(json_of(finding));
  return {{"verdict", verdict_of(report)},
          {"profile", report.profile},
          {"findings", findings},
          {"summary", json_of(report.summary)},
          {"summary_at", json_of(report.summary_at)}};
}

OrderedJson largest(const LargestChange& change, const char* unit) {
  return {{std::string("most_") + unit, figure(change.size)}, {"at_s", figure(change.at)}};
}

OrderedJson cause_json(const InfeasibilityCause& cause) {
  return {{"kind", name_of(cause.finding.kind)},
          {"where", cause.finding.where},
          {"begin_s", figure(cause.finding.begin)},
          {"end_s", figure(cause.finding.end)},
          {"at_s", figure(cause.finding.at)},
          {"worst", figure(cause.finding.worst)},
          {"limit", figure(cause.finding.limit)},
          {"unit", cause.finding.unit},
          {"ratio", cause.is_ratio ? figure(cause.violation) : OrderedJson(nullptr)},
          {"time_factor", cause.time_factor > 0 ? figure(cause.time_factor) : OrderedJson(nullptr)},
          {"text", cause.text}};
}

OrderedJson json_of(const SafetyViolation& v) {
  const bool in_motion = v.t >= v.begin && v.t <= v.end;
  return {{"kind", name_of(v.kind)},
          {"joint", v.joint},
          {"at_s", v.t},
          {"pattern_at_s", in_motion ? OrderedJson(v.t - v.begin) : OrderedJson(nullptr)},
          {"value", figure(v.value)},
          {"limit", v.limit},
          {"unit", v.unit},
          {"rows", v.rows}};
}

}  // namespace

std::string check_json(const ConsistencyReport& report) { return dumped(json_of(report)); }

std::string motion_change_json(const MotionChange& change) {
  OrderedJson joints = OrderedJson::array();
  for (const JointChange& j : change.joints)
    joints.push_back({{"joint", j.joint},
                      {"most_rad", figure(j.most)},
                      {"at_s", figure(j.at)},
                      {"begin_s", figure(j.begin)},
                      {"end_s", figure(j.end)}});
  const OrderedJson json = {{"joints", joints},
                            {"cog", largest(change.cog, "m")},
                            {"foot", largest(change.foot, "m")},
                            {"zmp", largest(change.zmp, "m")},
                            {"fz", largest(change.fz, "N")}};
  return dumped(json);
}

std::string weighted_change_json(const WeightedChange& change) {
  OrderedJson parts = OrderedJson::array();
  for (const ChangePart& p : change.parts)
    parts.push_back({{"what", p.what}, {"weight", figure(p.weight)}, {"change", figure(p.change)}});
  return dumped({{"total", figure(change.total())},
                 {"change", figure(change.change)},
                 {"safety", figure(change.safety)},
                 {"parts", parts}});
}

std::string repair_json(const RepairResult& result) {
  OrderedJson moved = {{"max_joint_rad", figure(result.max_joint_change)},
                       {"max_cog_m", figure(result.max_cog_change)},
                       {"where", result.where},
                       {"at_s", result.at}};
  moved.update(OrderedJson::parse(motion_change_json(result.moved)));
  const OrderedJson margin = {
      {"before_m", figure(result.before.summary[FindingKind::support_margin])},
      {"after_m", figure(result.check.summary[FindingKind::support_margin])}};
  OrderedJson causes = OrderedJson::array();
  for (const InfeasibilityCause& cause : result.causes) causes.push_back(cause_json(cause));
  OrderedJson smooth = OrderedJson::array();
  for (const SmoothWindow& window : result.correction.smooth)
    smooth.push_back({window.begin, window.end});
  const OrderedJson json = {
      {"status", name_of(result.status)},
      {"partial", result.partial},
      {"moved", moved},
      {"smooth_s", smooth},
      {"weighted_change", OrderedJson::parse(weighted_change_json(result.change))},
      {"zmp_margin", margin},
      {"variables", result.variables},
      {"constraints", result.constraints},
      {"iterations", result.iterations},
      {"constraint_violation", figure(result.constraint_violation)},
      {"reasons", result.reasons},
      {"obstacles", causes},
      {"check", OrderedJson::parse(check_json(result.check))}};
  return dumped(json);
}

namespace {

OrderedJson json_of_run(const SimulationLog& log, size_t rows, const std::string& log_hash) {
  const SimulationResult& r = log.result;
  OrderedJson events = OrderedJson::array();
  for (const SimulationEvent& event : log.events)
    events.push_back({{"t_s", event.t}, {"kind", name_of(event.kind)}, {"text", event.text}});
  OrderedJson places = OrderedJson::object();
  for (const auto& [key, share] :
       {std::pair("max_joint_speed_ratio", r.speed), {"max_torque_ratio", r.torque}})
    if (share.joint >= 0)
      places[key] = {{"where", log.joints[static_cast<size_t>(share.joint)]}, {"at_s", share.at}};
  const double duration = rows == 0 ? 0 : log.dt * static_cast<double>(rows - 1);
  return {{"controller", log.controller ? name_of(*log.controller) : ""},
          {"plant", log.plant},
          {"outcome", name_of(r.outcome)},
          {"fell_at_s", figure(r.fell_at, r.fell_at >= 0)},
          {"duration_s", duration},
          {"max_tilt_rad", figure(r.max_tilt)},
          {"final_cog_error_m", figure(r.final_cog_error)},
          {"final_speed_m_s", figure(r.final_speed)},
          {"zmp_tracking_rms_m", figure(r.zmp_tracking_rms)},
          {"zmp_amplitude_m", figure(r.zmp_amplitude)},
          {"zmp_frequency_Hz", figure(r.zmp_frequency, r.zmp_amplitude > 0)},
          {"flight_s", figure(r.flight)},
          {"apex_m", figure(r.apex, r.flight > 0)},
          {"steps", r.steps},
          {"max_joint_speed_ratio", figure(r.speed.ratio)},
          {"max_torque_ratio", figure(r.torque.ratio)},
          {"max_penetration_m", figure(r.max_penetration)},
          {"max_foot_slip_m", figure(r.max_slip)},
          {"max_contact_residual_m_s", figure(r.max_contact_residual)},
          {"max_contact_iterations", r.max_contact_iterations},
          {"mean_contact_iterations", figure(r.mean_contact_iterations)},
          {"figures_at", places},
          {"events", events},
          {"log_hash", log_hash}};
}

}  // namespace

std::string simulation_json(const SimulationLog& log) {
  return dumped(json_of_run(log, log.samples.size(), log_hash(log)));
}

std::string simulation_json(const WrittenLog& log) {
  return dumped(json_of_run(log.about, log.rows, log.log_hash));
}

std::string safety_json(const SafetyReport& report) {
  OrderedJson violations = OrderedJson::array();
  for (const SafetyViolation& violation : report.violations)
    violations.push_back(json_of(violation));
  return dumped({{"safe", report.safe},
                 {"ramp_s", report.ramp},
                 {"motion_s", report.motion},
                 {"hold_s", report.hold},
                 {"max_step_ratio", figure(report.max_step_ratio)},
                 {"worst_joint", report.worst_joint},
                 {"worst_at_s", report.worst_at},
                 {"min_limit_margin_rad", figure(report.min_limit_margin)},
                 {"margin_joint", report.margin_joint},
                 {"start_speed_rad_s", figure(report.start_speed)},
                 {"end_speed_rad_s", figure(report.end_speed)},
                 {"violations", violations}});
}

}  // namespace ayumi
