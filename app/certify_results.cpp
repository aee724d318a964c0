#include "certify_results.hpp"

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/largest_number.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/json/json_depth.hpp"
#include "ayumi/io/run/seal.hpp"

namespace ayumi::app {

using Json = nlohmann::ordered_json;

namespace {

constexpr const char* kCertifyFormat = "ayumi.certify/1";
/// Largest number of cases in a file. Definition: the limit of `certify --runs`.
constexpr size_t kMostCases = 100000000;

Outcome outcome_of(const std::string& name) {
  for (const Outcome each : {Outcome::stands, Outcome::unsettled, Outcome::fell})
    if (name == name_of(each)) return each;
  throw std::out_of_range(name);
}

Json case_json(const CaseResult& r) {
  return {name_of(r.outcome), r.fell_at, r.cog_error, r.torque, r.foot_tilt};
}

CaseResult case_of(const nlohmann::json& json) {
  return {.outcome = outcome_of(json.at(0)),
          .fell_at = json.at(1),
          .cog_error = json.at(2),
          .torque = json.at(3),
          .foot_tilt = json.at(4)};
}

/// JSON has no infinite numbers.
Json bound_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

std::string case_results_text(const Json& study, const std::string& shard, const FileCases& cases) {
  Json head = {{"format", kCertifyFormat}, {"study", study}};
  if (!shard.empty()) head["shard"] = shard;
  head["columns"] = {"case",        "outcome",      "fell_at_s",
                     "cog_error_m", "torque_ratio", "foot_tilt_rad"};
  std::string text = head.dump(1);
  text.resize(text.size() - 2);  // removes the end of the object
  text += ",\n \"cases\": [";
  const char* separator = "\n";
  for (const auto& [number, result] : cases) {
    Json row = Json::array({number});
    for (const Json& cell : case_json(result)) row.push_back(cell);
    text += separator + row.dump();
    separator = ",\n";
  }
  return sealed(text + "\n ]\n}");
}

std::string add_case_results(const std::filesystem::path& file, const Json& study, bool must_exist,
                             FileCases& cases) {
  if (!must_exist && !std::filesystem::exists(file)) return "";
  std::string shard;
  const auto refuse = [&](const std::string& why) {
    fail(ErrorCode::bad_file, {file.string()}, why);
  };
  // A file to be merged must exist; any other one is the file of -o.
  const std::string remedy =
      must_exist
          ? "Leave this file out of --merge, or run the shard of this file again with --force"
          : "Choose another name, or replace the file with --force";
  const std::string bytes = read_file(file);
  try {
    const auto json = shallow_json<nlohmann::json>(bytes);
    if (json.at("format") != kCertifyFormat)
      refuse("this file does not contain results of ayumi certify");
    if (const std::string wrong = wrong_seal(bytes); !wrong.empty()) refuse(wrong + ". " + remedy);
    // The order of the keys does not matter.
    const auto& theirs = json.at("study");
    const auto ours = nlohmann::json::parse(study.dump());
    if (theirs != ours) {
      std::string key;
      for (const auto& [name, value] : ours.items())
        if (key.empty() && (!theirs.contains(name) || theirs.at(name) != value)) key = name;
      refuse("this file contains the results of another study ('" + key + "' differs). " + remedy);
    }
    shard = json.value("shard", "");
    for (const auto& row : json.at("cases")) {
      if (!row.at(0).is_number_unsigned()) refuse("a case has no number. " + remedy);
      const size_t number = row.at(0);
      if (number >= kMostCases)
        refuse("the number " + std::to_string(number) + " of a case is too large. The largest is " +
               std::to_string(kMostCases - 1));
      const CaseResult result = case_of(nlohmann::json(row.begin() + 1, row.end()));
      for (const double figure :
           {result.fell_at, result.cog_error, result.torque, result.foot_tilt})
        if (!(std::abs(figure) <= kLargestNumber))
          refuse("case " + std::to_string(number) + " has the value " + text::brief(figure) +
                 ", which no simulation gives. " + remedy);
      const auto [known, is_new] = cases.emplace(number, result);
      if (!is_new && !(known->second == result))
        refuse("the result of case " + std::to_string(number) +
               " differs from the result in another file of the same study. Run the study again "
               "with --force");
    }
  } catch (const Json::exception&) {
    refuse(
        "this file does not contain results of ayumi certify, or a part of the file is missing. " +
        remedy);
  } catch (const std::out_of_range&) {
    refuse("this file has an outcome that this version of Ayumi does not know. " + remedy);
  }
  return shard;
}

KnownResults first_cases(const FileCases& cases, long count) {
  KnownResults results(static_cast<size_t>(count));
  for (const auto& [number, result] : cases)
    if (number < results.size()) results[number] = result;
  return results;
}

void add_cases(const KnownResults& results, FileCases& cases) {
  for (size_t i = 0; i < results.size(); ++i)
    if (results[i]) cases.insert_or_assign(i, *results[i]);
}

std::string case_table(const UncertainTask& task, std::uint64_t seed, const KnownResults& results) {
  std::string text = "case,outcome,fell_at[s],cog_error[m],torque_ratio[1],foot_tilt[rad]";
  for (const DrawnValue& value : task.values()) text += "," + value.name;
  text += "\n";
  for (size_t i = 0; i < results.size(); ++i) {
    if (!results[i]) continue;
    const CaseResult& r = *results[i];
    text += std::to_string(i) + "," + name_of(r.outcome) + ",";
    if (r.fell_at >= 0) text += text::exact(r.fell_at);
    for (const double figure : {r.cog_error, r.torque, r.foot_tilt})
      text += "," + text::exact(figure);
    for (const double value : task.draw(task.numbers(seed, static_cast<long>(i))))
      text += "," + text::exact(value);
    text += "\n";
  }
  return text;
}

Json certificate_json(const Certificate& c, const CertifyOptions& options) {
  Json bounds = nullptr;
  if (c.largest.runs > 0)
    bounds = {{"quantile", 1 - options.failure},
              {"runs", c.largest.runs},
              {"cog_error_m", bound_json(c.largest.cog_error)},
              {"torque_ratio", bound_json(c.largest.torque)},
              {"foot_tilt_rad", bound_json(c.largest.foot_tilt)}};
  return {{"certified", c.outcome.certified},
          {"decided", c.outcome.stopped},
          {"failure", options.failure},
          {"confidence", options.confidence},
          {"runs", c.outcome.runs},
          {"failures", c.outcome.failures},
          {"falls", c.falls},
          {"unsettled", c.unsettled},
          {"failure_upper_bound", c.upper},
          {"failure_lower_bound", c.lower},
          {"upper_bounds_of_quantiles", bounds}};
}

Json influences_json(const std::vector<ValueInfluence>& influences) {
  Json list = Json::array();
  for (const ValueInfluence& each : influences) {
    Json halves = Json::array();
    for (size_t half = 0; half < 2; ++half)
      halves.push_back({{"failures", each.failures[half]},
                        {"runs", each.runs[half]},
                        {"low", each.rate[half].low},
                        {"high", each.rate[half].high}});
    list.push_back({{"value", each.name},
                    {"rank_correlation", each.correlation},
                    {"lower_half", halves[0]},
                    {"upper_half", halves[1]}});
  }
  return list;
}

Json worst_cases_json(const UncertainTask& task, std::uint64_t seed, const KnownResults& results,
                      const std::vector<long>& numbers) {
  Json list = Json::array();
  for (const long number : numbers) {
    const CaseResult& r = *results[static_cast<size_t>(number)];
    const CaseNumbers drawn_numbers = task.numbers(seed, number);
    const std::vector<double> drawn = task.draw(drawn_numbers);
    Json values = Json::object();
    for (size_t i = 0; i < drawn.size(); ++i) values[task.values()[i].name] = drawn[i];
    Json entry = {{"case", number},
                  {"outcome", name_of(r.outcome)},
                  {"cog_error_m", r.cog_error},
                  {"torque_ratio", r.torque},
                  {"foot_tilt_rad", r.foot_tilt},
                  {"noise_seed", drawn_numbers.noise}};
    if (r.fell_at >= 0) entry["fell_at_s"] = r.fell_at;
    entry["values"] = values;
    list.push_back(entry);
  }
  return list;
}

}  // namespace ayumi::app
