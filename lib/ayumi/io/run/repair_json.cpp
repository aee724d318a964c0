#include <cmath>
#include <nlohmann/json.hpp>

#include "ayumi/io/run/results_json.hpp"

namespace ayumi {

namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson figure(double value) {
  return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

}  // namespace

namespace {

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

}  // namespace

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
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

std::string weighted_change_json(const WeightedChange& change) {
  OrderedJson parts = OrderedJson::array();
  for (const ChangePart& p : change.parts)
    parts.push_back({{"what", p.what}, {"weight", figure(p.weight)}, {"change", figure(p.change)}});
  return OrderedJson({{"total", figure(change.total())},
                      {"change", figure(change.change)},
                      {"safety", figure(change.safety)},
                      {"parts", parts}})
      .dump(2, ' ', false, OrderedJson::error_handler_t::replace);
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
  const OrderedJson json = {
      {"status", name_of(result.status)},
      {"partial", result.partial},
      {"moved", moved},
      {"weighted_change", OrderedJson::parse(weighted_change_json(result.change))},
      {"zmp_margin", margin},
      {"variables", result.variables},
      {"constraints", result.constraints},
      {"iterations", result.iterations},
      {"constraint_violation", figure(result.constraint_violation)},
      {"reasons", result.reasons},
      {"obstacles", causes},
      {"check", OrderedJson::parse(check_json(result.check))}};
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace ayumi
