#include <cmath>
#include <nlohmann/json.hpp>

#include "ayumi/io/results_json.hpp"

namespace ayumi {

namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson figure(double value) {
  return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

}  // namespace

std::string repair_json(const RepairResult& result) {
  const OrderedJson json = {{"status", name_of(result.status)},
                            {"moved",
                             {{"max_joint_rad", figure(result.max_joint_change)},
                              {"max_cog_m", figure(result.max_cog_change)},
                              {"where", result.where},
                              {"at_s", result.at}}},
                            {"variables", result.variables},
                            {"constraints", result.constraints},
                            {"iterations", result.iterations},
                            {"constraint_violation", figure(result.constraint_violation)},
                            {"reasons", result.reasons},
                            {"check", OrderedJson::parse(check_json(result.check))}};
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace ayumi
