#include "ayumi/io/run/run_results.hpp"

#include <Eigen/Core>
#include <limits>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/largest_number.hpp"
#include "ayumi/base/shown_amount.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/io/run/seal.hpp"

namespace ayumi {
namespace {

/// A figure that does not exist is null.
double read_figure(const JsonNode& node) {
  return node.value().is_null() ? std::numeric_limits<double>::quiet_NaN() : node.number();
}

Severity severity_of(const JsonNode& node) {
  const std::string word = node.one_of({"error", "warning", "info"});
  return word == "error" ? Severity::error : word == "warning" ? Severity::warning : Severity::info;
}

Finding finding_of(const JsonNode& node) {
  Finding f;
  f.kind = *finding_kind(node.at("kind").one_of(finding_kind_names()));
  f.severity = severity_of(node.at("severity"));
  f.begin = node.at("begin_s").number();
  f.end = node.at("end_s").number();
  f.at = node.at("at_s").number();
  f.worst = read_figure(node.at("worst"));
  f.limit = read_figure(node.at("limit"));
  f.unit = node.at("unit").string();
  f.where = node.at("where").string();
  f.hint = node.at("hint").string();
  const auto cause = node.find("follows_from");
  if (cause && !cause->value().is_null()) f.follows_from = cause->string();
  return f;
}

// A run of an older version does not number the causes. A finding cannot be its own consequence,
// not even through others.
void read_causes(const std::vector<JsonNode>& nodes, std::vector<Finding>& findings) {
  const int count = static_cast<int>(findings.size());
  for (int i = 0; i < count; ++i)
    if (const auto node = nodes[i].find("cause"); node && !node->value().is_null()) {
      findings[i].cause = node->integer();
      if (findings[i].cause < 0 || findings[i].cause >= count)
        node->complain("the number of a cause must be the number of a finding, from 0 to " +
                       std::to_string(count - 1));
    }
  // For each finding, the number of the walk that first came to it. A walk ends at a finding of an
  // earlier walk, so the time is linear in their number.
  std::vector<int> met(findings.size(), -1);
  for (int i = 0; i < count; ++i)
    for (int at = i; at >= 0; at = findings[at].cause) {
      if (met[at] == i) nodes[at].complain("this finding is a consequence of itself");
      if (met[at] >= 0) break;
      met[at] = i;
    }
}

// A run of an older version may lack figures that later versions have added.
CheckSummary summary_of(const JsonNode& node) {
  CheckSummary summary;
  for (const FindingSpec* spec : summary_figures()) {
    const auto value = node.find(spec->figure.key);
    summary[spec->kind] = value ? read_figure(*value) : std::numeric_limits<double>::quiet_NaN();
  }
  return summary;
}

// A run of an older version does not have these places.
FigurePlaces places_of(const JsonNode& check) {
  FigurePlaces places;
  const auto node = check.find("summary_at");
  if (!node) return places;
  for (const FindingSpec* spec : summary_figures())
    if (const auto place = node->find(spec->figure.key))
      places[spec->kind] = {place->at("where").string(), place->at("at_s").number()};
  return places;
}

ConsistencyReport check_of(const JsonNode& node) {
  ConsistencyReport report;
  report.consistent =
      node.at("verdict").one_of({verdict_of(false), verdict_of(true)}) == verdict_of(true);
  report.profile = node.at("profile").string();
  const std::vector<JsonNode> findings = node.at("findings").items();
  for (const JsonNode& finding : findings) report.findings.push_back(finding_of(finding));
  read_causes(findings, report.findings);
  report.summary = summary_of(node.at("summary"));
  report.summary_at = places_of(node);
  return report;
}

RepairNote repair_of(const JsonNode& node) {
  const JsonNode moved = node.at("moved");
  std::vector<RepairNote::Moved> joints;
  for (const JsonNode& j : moved.at("joints").items())
    joints.push_back({j.at("joint").string(), read_figure(j.at("most_rad")),
                      read_figure(j.at("at_s")), read_figure(j.at("begin_s")),
                      read_figure(j.at("end_s"))});
  return {.status = node.at("status").string(),
          .max_joint_change = read_figure(moved.at("max_joint_rad")),
          .max_cog_change = read_figure(moved.at("max_cog_m")),
          .iterations = node.at("iterations").integer(),
          .reasons = node.at("reasons").strings(),
          .joints = joints,
          .margin_before = read_figure(node.at("zmp_margin").at("before_m")),
          .margin_after = read_figure(node.at("zmp_margin").at("after_m"))};
}

ExportNote export_of(const JsonNode& node) {
  ExportNote note;
  note.safe = node.at("safe").boolean();
  note.max_step_ratio = read_figure(node.at("max_step_ratio"));
  note.worst_joint = node.at("worst_joint").string();
  for (const JsonNode& violation : node.at("violations").items()) {
    // The report has angles in degrees.
    const std::string amount =
        amount_text(read_figure(violation.at("value")), read_figure(violation.at("limit")),
                    violation.at("unit").string(), true);
    note.violations.push_back(violation.at("kind").string() + " of " +
                              violation.at("joint").string() + " at " +
                              text::fixed(violation.at("at_s").number(), 3) + " s: " + amount);
  }
  return note;
}

}  // namespace

RunResults read_results(const RunFolder& run, const std::string& file) {
  RunResults results;
  for (const auto& [key, words] : run.sections) {
    if (key != "check" && key != "repair" && key != "export") continue;
    const Json document = parse_json(words, file + ": /" + key, ErrorCode::bad_file);
    if (document.is_null()) continue;
    const JsonNode node = root_of(document, file + ": /" + key, ErrorCode::bad_file);
    if (key == "check") results.check = check_of(node);
    if (key == "repair") results.repair = repair_of(node);
    if (key == "export") results.safety = export_of(node);
  }
  return results;
}

std::vector<PushThreshold> read_push_thresholds(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  const Json document = parse_json(bytes, file.string(), ErrorCode::bad_file);
  const JsonNode root = root_of(document, file.string(), ErrorCode::bad_file);
  root.expect_object();
  if (root.at("format").string() != "ayumi.push/1")
    root.at("format").complain("this is not the results file of a push study (ayumi.push/1)");
  if (const std::string wrong = wrong_seal(bytes); !wrong.empty())
    fail(ErrorCode::bad_file, {file.string()},
         wrong + "; run `ayumi push` again with --force, or move this file away");
  std::vector<std::string> controllers;
  for (const JsonNode& controller : root.at("study").at("controllers").items())
    controllers.push_back(controller.at("type").string());
  std::vector<PushThreshold> thresholds;
  for (const JsonNode& push : root.at("cases").items()) {
    const std::vector<JsonNode> limits = push.at("limits").items();
    if (limits.size() != controllers.size())
      push.at("limits").complain("one limit is needed for each controller of the study");
    for (size_t c = 0; c < limits.size(); ++c)
      thresholds.push_back(
          {.phase = push.at("phase").string(),
           .controller = controllers[c],
           .at = push.at("at_s").number_within(0, kLargestNumber),
           .direction = push.at("direction_rad").number_within(-kLargestNumber, kLargestNumber),
           .impulse = limits[c].at("impulse_Ns").number_within(0, kLargestNumber),
           .open_loop = push.at("open_loop").at("impulse_Ns").number_within(0, kLargestNumber),
           .bound = push.at("bound_Ns").number_within(-kLargestNumber, kLargestNumber),
           .capped = limits[c].at("capped").boolean()});
  }
  return thresholds;
}

}  // namespace ayumi
