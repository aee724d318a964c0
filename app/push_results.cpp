#include "push_results.hpp"

#include <algorithm>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/largest_number.hpp"
#include "ayumi/io/json/json_depth.hpp"
#include "ayumi/io/run/seal.hpp"

namespace ayumi::app {

using Json = nlohmann::ordered_json;

namespace {

constexpr const char* kPushFormat = "ayumi.push/1";

Json limit_json(const PushLimit& limit) {
  return {{"impulse_Ns", limit.impulse},
          {"capped", limit.capped},
          {"runs", limit.runs},
          {"moderate",
           {{"survives", limit.moderate.survives},
            {"foot_tilt_s", limit.moderate.foot_tilt},
            {"recovery_s", limit.moderate.recovery},
            {"trunk_tilt_rad", limit.moderate.trunk_tilt}}}};
}

PushLimit limit_from(const nlohmann::json& json) {
  const Json& moderate = json.at("moderate");
  return {.impulse = json.at("impulse_Ns"),
          .capped = json.at("capped"),
          .moderate = {.survives = moderate.at("survives"),
                       .foot_tilt = moderate.at("foot_tilt_s"),
                       .recovery = moderate.at("recovery_s"),
                       .trunk_tilt = moderate.at("trunk_tilt_rad")},
          .runs = json.at("runs")};
}

Json case_json(const PushCase& push) {
  Json limits = Json::array();
  for (const PushLimit& limit : push.limits) limits.push_back(limit_json(limit));
  return {{"phase", push.phase.name},
          {"at_s", push.phase.at},
          {"standing", push.phase.standing},
          {"direction_rad", push.direction},
          {"bound_Ns", push.bound},
          {"edge_bound_Ns", push.edge_bound},
          {"mass_kg", push.mass},
          {"height_m", push.height},
          {"open_loop", limit_json(push.open_loop)},
          {"limits", limits}};
}

PushCase case_from(const nlohmann::json& json) {
  PushCase push;
  push.phase = {json.at("phase"), json.at("at_s"), json.at("standing")};
  push.direction = json.at("direction_rad");
  push.bound = json.at("bound_Ns");
  push.edge_bound = json.at("edge_bound_Ns");
  push.mass = json.at("mass_kg");
  push.height = json.at("height_m");
  push.open_loop = limit_from(json.at("open_loop"));
  for (const auto& limit : json.at("limits")) push.limits.push_back(limit_from(limit));
  return push;
}

// Whether the numbers are those of a push of some robot. A file that was edited may have others.
bool is_possible(const PushCase& push) {
  const auto within = [](double value, double least) {
    return value >= least && value <= kLargestNumber;
  };
  const auto is_limit = [&](const PushLimit& limit) {
    return within(limit.impulse, 0) && limit.runs >= 0 &&
           within(limit.moderate.foot_tilt, -kLargestNumber) &&
           within(limit.moderate.recovery, -kLargestNumber) &&
           within(limit.moderate.trunk_tilt, -kLargestNumber);
  };
  return within(push.phase.at, 0) && within(push.direction, -kLargestNumber) &&
         within(push.bound, -kLargestNumber) && within(push.edge_bound, -kLargestNumber) &&
         push.mass > 0 && within(push.mass, 0) && push.height > 0 && within(push.height, 0) &&
         is_limit(push.open_loop) && std::all_of(push.limits.begin(), push.limits.end(), is_limit);
}

Json summary_json(const PushSummary& s) {
  return {{"cases", s.cases},
          {"worst_ratio", s.worst},
          {"mean_ratio", s.mean},
          {"worst_J_per_m_m_per_s", s.worst_speed},
          {"mean_J_per_m_m_per_s", s.mean_speed},
          {"worst_J_per_m_sqrt_gz", s.worst_froude},
          {"mean_J_per_m_sqrt_gz", s.mean_froude},
          {"open_loop_worst_ratio", s.open_worst},
          {"open_loop_mean_ratio", s.open_mean},
          {"below_open_loop", s.below_open}};
}

}  // namespace

Json thresholds_json(const std::vector<PushCase>& cases,
                     const std::vector<ControllerSpec>& controllers) {
  Json thresholds = Json::array();
  for (const PushCase& push : cases)
    for (size_t c = 0; c < controllers.size(); ++c) {
      const Json limit = limit_json(push.limits[c]);
      thresholds.push_back({{"phase", push.phase.name},
                            {"direction_rad", push.direction},
                            {"at_s", push.phase.at},
                            {"controller", name_of(controllers[c].type)},
                            {"impulse_Ns", push.limits[c].impulse},
                            {"open_loop_Ns", push.open_loop.impulse},
                            {"bound_Ns", push.bound},
                            {"edge_bound_Ns", push.edge_bound},
                            {"capped", push.limits[c].capped},
                            {"moderate", limit.at("moderate")},
                            {"open_loop_moderate", limit_json(push.open_loop).at("moderate")}});
    }
  return thresholds;
}

Json summaries_json(const std::vector<PushCase>& cases, const PushOptions& options) {
  Json summaries = Json::array();
  for (size_t c = 0; c < options.controllers.size(); ++c)
    summaries.push_back({{"controller", name_of(options.controllers[c].type)},
                         {"walking", summary_json(summarize(cases, c, false, options.step))},
                         {"standing", summary_json(summarize(cases, c, true, options.step))}});
  return summaries;
}

std::string results_text(const Json& study, const KnownCases& cases) {
  Json list = Json::array();
  for (size_t i = 0; i < cases.size(); ++i) {
    if (!cases[i]) continue;
    Json entry = {{"index", i}};
    entry.update(case_json(*cases[i]));
    list.push_back(entry);
  }
  const Json file = {{"format", kPushFormat}, {"study", study}, {"cases", list}};
  return sealed(file.dump(1));
}

KnownCases read_results(const std::filesystem::path& file, const Json& study, size_t count) {
  KnownCases known(count);
  if (!std::filesystem::exists(file)) return known;
  const auto refuse = [&](const std::string& why) {
    fail(ErrorCode::bad_file, {file.string()},
         why + ". Choose another name, or replace the file with --force");
  };
  const std::string bytes = read_file(file);
  try {
    const auto json = shallow_json<nlohmann::json>(bytes);
    if (json.at("format") != kPushFormat)
      refuse("this file does not contain results of ayumi push");
    if (const std::string wrong = wrong_seal(bytes); !wrong.empty()) refuse(wrong);
    // The order of the keys does not matter.
    if (json.at("study") != nlohmann::json::parse(study.dump()))
      refuse("this file contains the results of a study with other settings");
    for (const auto& entry : json.at("cases")) {
      if (entry.at("limits").size() != study.at("controllers").size())
        refuse(
            "the number of results of a push differs from the number of controllers of the study");
      bool counted = entry.at("index").is_number_unsigned();
      for (const auto& limit : entry.at("limits"))
        counted = counted && limit.at("runs").is_number_integer();
      if (!counted)
        refuse("this file has a push whose index or number of runs is not a whole number");
      const PushCase push = case_from(entry);
      if (!is_possible(push)) refuse("this file contains numbers that are not possible for a push");
      known.at(entry.at("index")) = push;
    }
  } catch (const Json::exception&) {
    refuse("this file does not contain results of ayumi push");
  } catch (const std::out_of_range&) {
    refuse("this file has a push that does not belong to this study");
  }
  return known;
}

}  // namespace ayumi::app
