#include "ayumi/report/sections.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/shown_amount.hpp"
#include "ayumi/base/significant.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/check/finding_groups.hpp"
#include "ayumi/plot/compare_plot.hpp"
#include "ayumi/plot/push_map.hpp"
#include "ayumi/render/log_reading.hpp"
#include "ayumi/report/html.hpp"

namespace ayumi::html {
namespace {

using text::significant;

std::string three_digits(double value) { return significant(value, 3); }
std::string degrees(double radians) { return three_digits(radians * 180 / M_PI); }
std::string millimetres(double metres) {
  // A value below a hundredth of a millimetre counts as zero.
  return std::abs(metres) < 5e-6 ? "0" : three_digits(1e3 * metres);
}
std::string percent(double ratio) { return text::fixed(100 * ratio, 0); }

enum class Tone { good, neutral, bad };

/// Only good outcomes are green.
std::string marked(Tone tone, const std::string& words) {
  if (tone == Tone::neutral) return escaped(words);
  return std::string("<span class=\"") + (tone == Tone::good ? "good" : "bad") + "\">" +
         escaped(words) + "</span>";
}

std::string outcome_words(const SimulationResult& result) {
  if (result.outcome == Outcome::fell) return "falls at " + text::fixed(result.fell_at, 2) + " s";
  return result.outcome == Outcome::stands ? "stands" : "does not come to rest";
}

std::string outcome_cell(const SimulationResult& result) {
  return marked(result.outcome == Outcome::stands ? Tone::good : Tone::bad, outcome_words(result));
}

/// The pushes of a run, such as "pushed with 1.1 N s at 3 s".
std::string push_words(const SimulationLog& log) {
  std::string words;
  for (const PushRecord& push : pushes(log))
    words += (words.empty() ? ", pushed with " : ", ") + push_text(push) + " at " +
             text::brief(push.begin) + " s";
  return words;
}

/// A share with its place, such as "72 (l_knee at 2.90 s)".
std::string share_cell(const SimulationLog& log, const JointShare& share) {
  return percent(share.ratio) + escaped(place_in_brackets(log, share));
}

Table run_table(const ReportInput& input) {
  Table table = {"The simulated runs", {"run", "outcome"}, {}};
  for (const char* name :
       {"largest tilt [deg]", "final COG error [mm]", "ZMP tracking [mm rms]", "joint speed [%]",
        "torque [%]", "flight [s]", "steps", "foot slip [mm]"})
    table.head.emplace_back(name);
  for (const ReportRun& run : input.runs) {
    if (run.recorded) continue;
    const SimulationResult& r = run.log->result;
    table.rows.push_back({escaped(name_of(run)), outcome_cell(r), degrees(r.max_tilt),
                          millimetres(r.final_cog_error), millimetres(r.zmp_tracking_rms),
                          share_cell(*run.log, r.speed), share_cell(*run.log, r.torque),
                          text::fixed(r.flight, 2), std::to_string(r.steps),
                          millimetres(r.max_slip)});
  }
  return table;
}

std::string export_words(const ExportNote& note, bool good) {
  if (note.safe)
    return "<p>" + marked(good ? Tone::good : Tone::neutral, "The joint table is safe to replay") +
           ": its largest step from row to row is " + percent(note.max_step_ratio) +
           " % of the limit (" + escaped(note.worst_joint) + ").</p>\n";
  std::string words =
      "<p>" + marked(Tone::bad, "The joint table is not safe to replay") + ":</p>\n<ul>";
  for (const std::string& violation : note.violations)
    words += "<li>" + escaped(violation) + "</li>";
  return words + "</ul>\n";
}

/// Says from which of the runs the tables come, if the runs of this page were disturbed.
std::string source_of_tables(const SimulationLog& log) {
  if (log.scenario.empty()) return "";
  return "<p>The tables <code>reference.csv</code> and <code>hoap.csv</code> are from the run "
         "without disturbances. This page does not show that run. "
         "<code>reference_pushed.csv</code> is from the disturbed run. This table contains the "
         "reactions to the disturbances, so do not play it on a robot.</p>\n";
}

std::string margin(double metres) {
  return millimetres(std::abs(metres)) + (metres < 0 ? " mm outside" : " mm inside");
}

Table moved_table(const RepairNote& note) {
  constexpr size_t kMostRows = 8;  // largest number of rows, so that the table stays short
  constexpr double kLeast =
      0.005 * M_PI / 180;  // the move of a joint that would be printed as 0.00 deg is left out
  Table table = {
      "What the repair moved", {"joint", "by [deg]", "at [s]", "from [s]", "to [s]"}, {}};
  for (const RepairNote::Moved& j : note.joints)
    if (table.rows.size() < kMostRows && std::abs(j.most) >= kLeast)
      table.rows.push_back({escaped(j.joint), text::fixed(j.most * 180 / M_PI, 2),
                            text::fixed(j.at, 3), text::fixed(j.begin, 2), text::fixed(j.end, 2)});
  return table;
}

std::string repair_words(const RepairNote& note) {
  std::string words =
      "<p>Repair: " + escaped(note.status) + " after " + std::to_string(note.iterations) +
      " iterations. Joints moved by at most " + text::fixed(note.max_joint_change * 180 / M_PI, 2) +
      " deg, and the COG by at most " + millimetres(note.max_cog_change) + " mm. The ZMP was " +
      margin(note.margin_before) + " the support before the repair, and is " +
      margin(note.margin_after) + " the support after the repair.</p>\n";
  if (!note.joints.empty() && note.status == "repaired") words += table(moved_table(note));
  if (note.reasons.empty()) return words;
  words += "<ul>";
  for (const std::string& reason : note.reasons) words += "<li>" + escaped(reason) + "</li>";
  return words + "</ul>\n";
}

std::string figure(double value, const std::string& unit, bool in_degrees = true, int digits = 3) {
  if (!std::isfinite(value)) return "not known";
  // One unit for each quantity: lengths in mm, angles in deg, as in curves and tables. A finding
  // has the unit of its hint, which is that of the pattern.
  if (unit == "m")
    return (digits == 3 ? millimetres(value) : significant(1e3 * value, digits)) + " mm";
  const ShownUnit shown = shown_unit(unit, in_degrees);
  return significant(value * shown.scale, digits) + (unit == "1" ? "" : " " + escaped(shown.name));
}

// The value and its limit. If three digits are the same for both, both have more.
std::string amount_of(const Finding& f) {
  const std::string worst = figure(f.worst, f.unit, f.in_degrees);
  const std::string limit = figure(f.limit, f.unit, f.in_degrees);
  if (worst != limit) return worst + ", limit " + limit;
  constexpr int kMore = 6;
  return figure(f.worst, f.unit, f.in_degrees, kMore) + ", limit " +
         figure(f.limit, f.unit, f.in_degrees, kMore);
}

std::string consequences_of(const ConsistencyReport& check, const FindingGroup& group) {
  std::vector<std::string> parts;
  for (const GroupConsequence& c : group.consequences) {
    const Finding& f = check.findings[c.worst];
    parts.push_back(escaped(name_of(f.kind)) + " (" +
                    (c.count > 1 ? text::counted(c.count, "time") + ", worst " : "") +
                    escaped(place_words(f.where)) + " at " + time_link(f.at) +
                    " s: " + amount_of(f) + ")");
  }
  return parts.empty() ? "" : "<br>consequences: " + text::join(parts, ", ");
}

// The findings as a list with one entry for each cause.
std::string finding_list(const RobotModel& model, const ConsistencyReport& check) {
  std::string out = "<ul>\n";
  for (const FindingGroup& group : finding_groups(check, model)) {
    const Finding& worst = check.findings[group.worst];
    double begin = worst.begin, end = worst.end;
    for (const int i : group.members) {
      begin = std::min(begin, check.findings[i].begin);
      end = std::max(end, check.findings[i].end);
    }
    const std::string severity = ayumi::name_of(worst.severity);
    const size_t times = group.members.size();
    out += "<li>" + (worst.severity == Severity::error ? marked(Tone::bad, severity) : severity) +
           " <strong>" + escaped(name_of(worst.kind)) +
           "</strong>: " + escaped(text::join(group.places, ", ")) +
           (times > 1 ? ", " + text::counted(times, "time") + " within " : ", ") +
           text::fixed(begin, 2) + " to " + text::fixed(end, 2) + " s, worst " +
           (group.places.size() > 1 ? escaped(place_words(worst.where)) + " " : "") + "at " +
           time_link(worst.at) + " s: " + amount_of(worst) + "<br>" + escaped(worst.hint) +
           consequences_of(check, group) + "</li>\n";
  }
  return out + "</ul>\n";
}

Table summary_table(const RobotModel& model, const CheckSummary& summary) {
  // A value below this share of its tolerance counts as rounding of the computation. Chosen: the
  // landing speed of a foot at rest is computed as 1e-6 m/s, and no reader needs a ten-thousandth
  // of a tolerance.
  constexpr double kRoundingShare = 1e-4;
  Table table = {"Figures of the check", {}, {}};
  for (const FindingSpec* spec : summary_figures()) {
    const double value = spec->figure.scale * summary[spec->kind];
    const bool is_rounding =
        std::abs(summary[spec->kind]) < kRoundingShare * std::abs(spec->tolerance);
    table.rows.push_back(
        {spec->figure.label, has_limit(model, spec->kind)
                                 ? figure(is_rounding ? 0 : value, spec->figure.unit)
                                 : "no limit is stated"});
  }
  return table;
}

}  // namespace

std::string name_of(const ReportRun& run) {
  const std::optional<ControllerType>& law = run.log->controller;
  return !law || law == ControllerKind::none ? run.name : run.name + " (" + name_of(*law) + ")";
}

std::string verdict_section(const ReportInput& input) {
  const ReportRun& judged = input.runs.back();
  const SimulationResult& result = judged.log->result;
  const bool stands = result.outcome == Outcome::stands;
  const bool consistent = !input.results.check || input.results.check->consistent;
  const bool repaired = input.results.repair && input.results.repair->status == "repaired";
  std::string out = "<p class=\"verdict\">The " +
                    std::string(judged.name == judged.log->plant ? "robot in the plant " : "") +
                    escaped(name_of(judged)) + " " + outcome_cell(result) +
                    escaped(push_words(*judged.log));
  if (input.results.check)
    out +=
        ". The pattern is " +
        marked(consistent ? Tone::good
               : repaired ? Tone::neutral
                          : Tone::bad,
               verdict_of(consistent) +
                   std::string(!consistent && repaired ? " as written, but it was repaired" : ""));
  out += ".</p>\n" + table(run_table(input));
  if (input.results.repair) out += repair_words(*input.results.repair);
  if (input.results.safety) {
    out += export_words(*input.results.safety, stands);
    out += source_of_tables(*input.runs.back().log);
  }
  return section("verdict",
                 stands && (consistent || repaired) ? "Verdict: good" : "Verdict: not good", out);
}

namespace {

/// The map of push limits that a study found, in the order of the study.
PushMap threshold_map(const std::vector<PushThreshold>& thresholds) {
  PushMap map;
  map.title = "Largest survivable impulse by phase and direction";
  const auto position = [](std::vector<std::string>& names, const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at != names.end()) return static_cast<size_t>(at - names.begin());
    names.push_back(name);
    return names.size() - 1;
  };
  for (const PushThreshold& t : thresholds) position(map.laws, t.controller);
  std::vector<double> at;
  for (const PushThreshold& t : thresholds) {
    size_t p = 0;
    while (p < map.phases.size() &&
           (map.phases[p].name != t.phase || std::abs(at[p] - t.at) > 1e-9))
      ++p;
    if (p == map.phases.size()) {
      map.phases.push_back({t.phase, {}, {}, std::vector<PushMapCurve>(map.laws.size() + 1)});
      at.push_back(t.at);
    }
    PushMapPhase& phase = map.phases[p];
    const auto same = [&](double angle) { return std::abs(angle - t.direction) < 1e-9; };
    const auto known = std::find_if(phase.direction.begin(), phase.direction.end(), same);
    const auto i = static_cast<size_t>(known - phase.direction.begin());
    if (known == phase.direction.end()) {
      phase.direction.push_back(t.direction);
      phase.bound.push_back(t.bound);
      for (PushMapCurve& curve : phase.curves) {
        curve.impulse.push_back(0);
        curve.capped.push_back(false);
      }
      phase.curves[0].impulse[i] = t.open_loop;
    }
    PushMapCurve& curve = phase.curves[position(map.laws, t.controller) + 1];
    curve.impulse[i] = t.impulse;
    curve.capped[i] = t.capped;
  }
  return map;
}

}  // namespace

std::string findings_section(const RobotModel& model, const ReportInput& input) {
  if (!input.results.check) return "";
  const ConsistencyReport& check = *input.results.check;
  std::string out =
      "<p>The check used the limits of the actuator profile " + escaped(check.profile) + ".</p>\n";
  out +=
      check.findings.empty() ? "<p>The check has no findings.</p>\n" : finding_list(model, check);
  return section("findings", "Findings", out + table(summary_table(model, check.summary)));
}

namespace {

// A phase with its time, which may also be its name. A short one stays on one line.
std::string phase_words(const PushThreshold& threshold) {
  const std::string at = text::fixed(threshold.at, 3) + " s";
  if (threshold.phase == "t = " + at)
    return "t&nbsp;=&nbsp;" + text::fixed(threshold.at, 3) + "&nbsp;s";
  return escaped(threshold.phase) + ", " + text::fixed(threshold.at, 3) + "&nbsp;s";
}

}  // namespace

std::string thresholds_section(const ReportInput& input) {
  if (input.thresholds.empty()) return "";
  Table rows = {
      "Largest push that the robot survives, as an impulse within 20 ms through the COG. The bound "
      "is the impulse that a point mass on the planned footholds could absorb. The sign + means "
      "that "
      "the robot survives even the largest push of the study.",
      {"phase", "towards [deg]", "law", "impulse [N s]", "open loop [N s]", "bound [N s]",
       "share of the bound"},
      {}};
  for (const PushThreshold& t : input.thresholds)
    rows.rows.push_back({phase_words(t), text::fixed(t.direction * 180 / M_PI, 0),
                         escaped(t.controller), text::fixed(t.impulse, 2) + (t.capped ? "+" : ""),
                         text::fixed(t.open_loop, 2), text::fixed(t.bound, 2),
                         t.bound > 0 ? text::fixed(t.impulse / t.bound, 2) : "none"});
  const auto figure = [&](PushMapLayout layout, const std::string& kind) {
    const std::string svg = to_svg(draw_push_map(threshold_map(input.thresholds), layout));
    return "<div class=\"" + kind +
           "\"><figure class=\"wide natural\" tabindex=\"0\" role=\"region\" "
           "aria-label=\"Push map\">" +
           svg.substr(svg.find("<svg")) + "</figure></div>\n";
  };
  return section("thresholds", "Push thresholds",
                 figure(PushMapLayout::wide, "wide-curves") +
                     figure(PushMapLayout::narrow, "narrow-curves") + table(rows));
}

namespace {

/// A time [s] in ms, never printed as "-0".
std::string milliseconds(double time, int digits) {
  const double shown = std::round(1000 * time * std::pow(10, digits));
  return text::fixed(shown == 0 ? 0 : 1000 * time, digits);
}

}  // namespace

std::string comparison_section(const ReportInput& input) {
  if (!input.comparison) return "";
  const Comparison& found = *input.comparison;
  constexpr double kDegree = M_PI / 180;
  Table rows = {
      "Differences between the recording and the run. The recording begins " +
          text::fixed(std::abs(found.shift), 3) + (found.shift < 0 ? " s before" : " s after") +
          " the beginning of the run.",
      {"curve", "mean", "largest", "at [s]", "delay of the recording [ms]", "correlation"},
      {}};
  for (const auto* curves : {&found.joints, &found.loads, &found.imu})
    for (const ComparedCurve& curve : *curves) {
      const double unit = curve.unit == "rad" ? kDegree : 1;
      const std::string name = curve.unit == "rad" ? "deg" : curve.unit;
      rows.rows.push_back({escaped(curve.name + (name.empty() ? "" : " [" + name + "]")),
                           text::brief(curve.mean / unit, 3), text::brief(curve.largest / unit, 3),
                           text::fixed(curve.largest_at, 3), milliseconds(curve.lag, 1),
                           text::fixed(curve.correlation, 3)});
    }
  std::string words = table(rows);
  for (const std::string& note : found.notes) words += "<p>" + escaped(note) + "</p>\n";
  Table landings = {
      "Landings", {"foot", "run [s]", "recording [s]", "delay of the recording [ms]"}, {}};
  for (const ComparedLanding& landing : found.landings)
    landings.rows.push_back({ayumi::name_of(landing.foot), text::fixed(landing.simulated, 3),
                             text::fixed(landing.measured, 3),
                             milliseconds(landing.measured - landing.simulated, 0)});
  for (const LoneLanding& landing : found.lone_landings)
    landings.rows.push_back({ayumi::name_of(landing.foot),
                             landing.measured ? "none" : text::fixed(landing.t, 3),
                             landing.measured ? text::fixed(landing.t, 3) : "none", "none"});
  if (!landings.rows.empty()) words += table(landings);
  return section("comparison", "Comparison with a recording",
                 words + to_svg(draw_comparison(found, "Measured and simulated")));
}

std::string events_section(const ReportInput& input) {
  Table rows = {"Events of the " + name_of(input.runs.back()), {"time [s]", "kind", "what"}, {}};
  for (const SimulationEvent& event : input.runs.back().log->events)
    rows.rows.push_back({time_link(event.t), name_of(event.kind), escaped(event.text)});
  if (rows.rows.empty()) return "";
  return section("events", "Events", table(rows));
}

namespace {

// If two simulators differ in the softness of the soles, the robot may fall in one and stand in the
// other.
std::string softness_of_soles(const RobotModel& model, const std::string& plant) {
  if (!model.has_soles()) return "no soles";
  std::vector<std::string> soles;
  for (const Side side : {Side::left, Side::right}) {
    const Sole& sole = model.sole(side);
    soles.push_back(std::string(ayumi::name_of(side)) + " sole: stiffness " +
                    three_digits(1e-3 * sole.stiffness) + " kN/m, damping time " +
                    three_digits(1e3 * sole.damping_time) + " ms");
  }
  const bool used = model.description().states_softness_of_soles();
  return text::join(soles, "; ") +
         (plant == "ayumi" ? ""
          : used ? ". The plant " + plant + " uses these values along the normal of the sole only"
                 : ". The plant " + plant + " does not use these values, because it has its own");
}

}  // namespace

std::string provenance_section(const RobotModel& model, const ReportInput& input,
                               const std::vector<std::string>& caps) {
  const Provenance& p = input.runs.back().log->provenance;
  const auto code = [](const std::string& text) { return "<code>" + escaped(text) + "</code>"; };
  Table rows = {"", {}, {{"tool", escaped(std::string("ayumi ") + version())}}};
  if (!input.libraries.empty()) rows.rows.push_back({"libraries", escaped(input.libraries)});
  rows.rows.push_back({"robot", escaped(p.robot) + " " + code(p.robot_sha256)});
  rows.rows.push_back({"pattern", escaped(p.pattern) + " " + code(p.pattern_sha256)});
  rows.rows.push_back({"actuators", escaped(p.profile)});
  rows.rows.push_back(
      {"softness of the soles", escaped(softness_of_soles(model, input.runs.back().log->plant))});
  rows.rows.push_back({"controller", escaped(p.controller)});
  rows.rows.push_back({"command", code(p.command_line)});
  std::string out = table(rows);
  out += "<p>What this page leaves out:</p>\n<ul>";
  for (const std::string& cap : caps) out += "<li>" + escaped(cap) + "</li>";
  return section("provenance", "Provenance", caps.empty() ? table(rows) : out + "</ul>\n");
}

}  // namespace ayumi::html
