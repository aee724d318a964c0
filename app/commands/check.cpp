// Is a pattern physically consistent?

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/likely_mistakes.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/motion/shown_name.hpp"
#include "ayumi/plot/com_zmp_plot.hpp"
#include "ayumi/task/foothold_collisions.hpp"
#include "ayumi/task/payload_findings.hpp"
#include "ayumi/task/plan_log.hpp"
#include "ayumi/task/scenario_findings.hpp"
#include "check_table.hpp"
#include "file_stamp.hpp"
#include "load_or_explain.hpp"
#include "motion_words.hpp"
#include "pattern_input.hpp"
#include "signals.hpp"
#include "terminal.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct CheckCommand {
  std::vector<std::string> patterns, tolerances;
  std::string plot;
  PatternOptions input;
  bool list_tolerances = false, watch = false, all = false;
};

void print_tolerances(const Context& context) {
  context.print(broken_at(tolerance_table(), terminal_columns()));
  Json kinds = Json::array();
  for (const FindingSpec* spec : finding_specs())
    kinds.push_back({{"kind", name_of(spec->kind)},
                     {"tolerance", spec->tolerance},
                     {"unit", spec->unit},
                     {"meaning", spec->meaning}});
  context.print_json(Json{{"tolerances", kinds}}.dump(2));
}

bool has_encoders(const RobotModel& model) {
  const auto& dofs = model.dofs();
  return std::any_of(dofs.begin(), dofs.end(), [](const Dof& d) { return d.encoder.device > 0; });
}

bool is_of_table(const Finding& f) {
  return f.kind == FindingKind::table_step || f.kind == FindingKind::table_position ||
         f.kind == FindingKind::table_rest;
}

// A table for the robot is judged by the robot's own actuators. If the pattern assumes other ones,
// this says what the motion needs beyond the robot's own actuators. If they are strong enough, it
// says why `export` refuses the table nevertheless.
std::string own_need(const Task& input, CheckOptions judged) {
  const std::string own = input.robot.limits().name;
  if (judged.profile.empty() || judged.profile == own) return "";
  judged.profile = own;
  const ConsistencyReport report = check_consistency(input.robot, input.series, judged);
  const ActuatorNeed need = actuator_need(input.robot, input.series, judged, report);
  if (!need.text.empty()) return need.text;
  const auto found = std::find_if(report.findings.begin(), report.findings.end(), is_of_table);
  return found == report.findings.end() ? "" : found->hint;
}

// What the motion needs of the actuators. Shorter forms are whole sentences, too: a number without
// its joint and time says nothing.
std::vector<AnswerPart> need_parts(const ActuatorNeed& need, const std::string& profile) {
  const std::string weak =
      "  profile " + profile +
      " is too weak: the motion needs more than the motors of this profile give";
  const std::string enough = need.sufficient.empty() ? "No other profile is strong enough"
                                                     : "Profiles that are strong enough: " +
                                                           text::join(need.sufficient, ", ");
  return {{Worth::remark, {"  " + need.text + "\n", weak + ". " + enough + "\n", weak + "\n"}}};
}

// The reasons for which `export` refuses the pattern, without the findings.
std::vector<AnswerPart> refusal_parts(const Task& input, const Judgement& judgement) {
  std::vector<std::string> reasons = export_refusals(input, judgement);
  std::erase(reasons, judgement.reason());
  return remark_parts("`export` would refuse the table of this pattern: ", reasons);
}

// ---- the joints of a motion against their limits

// Number of panels for each quantity. Chosen: nine panels fill a page.
constexpr size_t kPanels = 3;

using Share = std::function<double(const SimulationSample&, int dof)>;

// The joints with an error of this kind, then the joints that use most of their limit.
std::vector<int> worst_joints(const Task& task, const ConsistencyReport& report, FindingKind kind,
                              const SimulationLog& log, const Share& share) {
  std::vector<int> chosen;
  for (const Finding& f : report.findings) {
    const int dof = dof_of(f);
    const bool known = std::find(chosen.begin(), chosen.end(), dof) != chosen.end();
    if (f.kind == kind && dof >= 0 && !known && chosen.size() < kPanels) chosen.push_back(dof);
  }
  std::vector<std::pair<double, int>> used;
  for (int dof = 0; dof < task.robot.dof_count(); ++dof) {
    double most = 0;
    for (const SimulationSample& s : log.samples) most = std::max(most, share(s, dof));
    used.emplace_back(-most, dof);
  }
  std::sort(used.begin(), used.end());
  for (const auto& entry : used)
    if (chosen.size() < kPanels &&
        std::find(chosen.begin(), chosen.end(), entry.second) == chosen.end())
      chosen.push_back(entry.second);
  return chosen;
}

// The distance of a joint from the middle of its range, as a share of half the range; 0 for a joint
// without limits.
double position_share(const RobotModel& model, const SimulationSample& s, int dof) {
  const Dof& d = model.dofs()[static_cast<size_t>(dof)];
  if (!d.limited) return 0;
  const double middle = 0.5 * (d.lower + d.upper), half = 0.5 * (d.upper - d.lower);
  return std::abs(s.state.theta[dof] - middle) / half;
}

// Angle, speed and torque over time, with the limits of the profile that `report` was judged by.
// Returns the names of the panels.
std::vector<std::string> plot_joints_against_limits(const Task& task,
                                                    const ConsistencyReport& report,
                                                    const fs::path& path) {
  const ActuatorLimits& limits = task.robot.limits(report.profile);
  SimulationLog log = plan_log(task.robot, limits, task.series, task.series);
  LociOptions options;
  options.title = shown_name(task.pattern) + ": joints against their limits (" + limits.name + ")";
  options.model = &task.robot;
  options.profile = report.profile;
  options.cog = options.zmp = options.fz = false;
  options.command = options.reference = false;
  options.limits_in_view = true;
  options.joints = worst_joints(
      task, report, FindingKind::joint_position, log,
      [&](const SimulationSample& s, int dof) { return position_share(task.robot, s, dof); });
  options.speeds = worst_joints(task, report, FindingKind::joint_speed, log,
                                [&](const SimulationSample& s, int dof) {
                                  return std::abs(s.state.dtheta[dof]) / limits.speed[dof];
                                });
  options.torques = worst_joints(task, report, FindingKind::joint_torque, log,
                                 [&](const SimulationSample& s, int dof) {
                                   return std::abs(s.torque[dof]) / limits.peak_torque[dof];
                                 });
  write_loci({{"motion", &log}}, path, options);
  return loci_series(options);
}

// ---- the printed answer

struct Checked {
  std::string words;
  Json json;
  int errors = 0;
};

// `rows_above` is the number of rows of the screen above the answer that other lines take.
Checked checked_one(const Context& context, const CheckCommand& options, const std::string& file,
                    size_t rows_above = 0) {
  const auto begin = std::chrono::steady_clock::now();
  const Task input = load_or_explain(context, file, options.input, options.tolerances);
  const CheckOptions judged = check_options(input, options.tolerances);
  std::vector<Mistake> payloads;
  const Judgement judgement = judge(input, judged, &payloads);
  const ConsistencyReport& report = judgement.report;
  const ActuatorNeed& need = judgement.need();
  const std::string own = own_need(input, judged);
  const std::vector<Mistake> mistakes =
      report.consistent   ? doubtful_values(input.robot, input.pattern)
      : !payloads.empty() ? payloads
                          : likely_causes(input, judged, report, context.progress());
  const std::vector<std::string> disturbed = findings_under_scenario(input, judged, report);
  std::vector<std::string> assumptions;
  if (const std::string soles = inferred_soles(input.robot.description()); !soles.empty())
    assumptions.push_back(soles);
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  Checked checked;
  std::vector<AnswerPart> parts = {
      {Worth::verdict,
       {file + ": " + painted_verdict(report) + ", " + text::fixed(input.series.duration(), 2) +
        " s, profile " + report.profile + "\n"}}};
  append(parts, mistake_parts(mistakes, report.consistent));
  append(parts, remark_parts(painted(Paint::caution, "scenario:") + " ", disturbed));
  if (!need.text.empty()) append(parts, need_parts(need, report.profile));
  if (!need.flight.empty()) append(parts, remark_parts("", {need.flight}));
  if (!own.empty())
    append(parts, remark_parts("with the robot's own motors, ",
                               {own + (has_encoders(input.robot)
                                           ? " (`export --format hoap` judges by these motors)"
                                           : "")}));
  append(parts, refusal_parts(input, judgement));
  append(parts, remark_parts(painted(Paint::caution, "assumption:") + " ", assumptions));
  append(parts, check_parts(report, input.robot, options.all ? Shown::findings : Shown::causes));
  append(parts, search_parts(mistakes));
  parts.push_back({Worth::origin, {origin_words(input.series.origin), ""}, kOriginHang});
  std::vector<std::string> panels;
  if (!options.plot.empty()) {
    panels = plot_joints_against_limits(input, report, options.plot);
    parts.push_back(
        {Worth::verdict, {"  drawn in " + options.plot + ": " + text::join(panels, ", ") + "\n"}});
  }
  Room room = room_of(rows_for(report));
  room.rows -= rows_above;
  checked.words = options.all ? in_full(parts) : fitted(parts, room, where_more_is(report));
  checked.errors = static_cast<int>(
      std::count_if(report.findings.begin(), report.findings.end(),
                    [](const Finding& f) { return f.severity == Severity::error; }));
  Json& json = checked.json = {{"pattern", file}};
  json.update(Json::parse(check_json(report)));
  json["actuators"] = {{"enough", need.text.empty()},
                       {"need", need.text.empty() ? Json(nullptr) : Json(need.text)},
                       {"sufficient_profiles", need.sufficient},
                       {"flight", need.flight.empty() ? Json(nullptr) : Json(need.flight)},
                       {"own", own.empty() ? Json(nullptr) : Json(own)}};
  json["likely_mistakes"] = cause_texts(mistakes);
  json["with_disturbances"] = disturbed;
  json["assumptions"] = assumptions;
  json["export_refuses"] = export_refusals(input, judgement);
  if (!options.plot.empty()) json["plot"] = {{"output", options.plot}, {"series", panels}};
  json["sampled_from"] = input.series.origin;
  json["wall_s"] = wall;
  return checked;
}

std::string time_of_day() {
  const std::time_t now = std::time(nullptr);
  char words[16];
  std::strftime(words, sizeof words, "%H:%M:%S", std::localtime(&now));
  return words;
}

// The change of the number of errors after two spaces, such as
//   "  3 errors, now 1".
std::string change_words(std::optional<int> before, int now) {
  if (!before) return "  " + text::counted(now, "error");
  if (*before == now) return "  " + text::counted(now, "error") + ", as before";
  return "  " + text::counted(*before, "error") + ", now " + std::to_string(now);
}

using Stamps = std::map<fs::path, FileStamp>;

Stamps stamps_of(const std::vector<fs::path>& files) {
  Stamps stamps;
  for (const fs::path& file : files) stamps[file] = stamp_of(file);
  return stamps;
}

// The bytes of the files; a file that cannot be read is empty.
std::vector<std::string> contents_of(const std::vector<fs::path>& files) {
  std::vector<std::string> contents;
  for (const fs::path& file : files) try {
      contents.push_back(read_file(file));
    } catch (const Error&) {
      contents.emplace_back();
    }
  return contents;
}

// The files that the pattern names now, and the files that it named before it became unreadable.
std::vector<fs::path> watched_files(const std::string& file, const Stamps& before) {
  try {
    return pattern_files(file);
  } catch (const Error&) {
    std::vector<fs::path> files = {file};
    for (const auto& entry : before) files.push_back(entry.first);
    return files;
  }
}

// A file that is being written may be incomplete: its error is printed, and the next change is
// awaited. `errors` is the number of errors of the last check, or nothing.
void check_once(Context& context, const CheckCommand& options, const std::string& file,
                std::optional<int>& errors) {
  const std::string head = time_of_day();
  try {
    Checked checked = checked_one(context, options, file, 1);
    if (!context.json) clear_screen();
    context.print(head + change_words(errors, checked.errors) + "\n" + checked.words);
    context.print_json(checked.json.dump());
    context.exit_code = checked.json["verdict"] == "consistent" ? 0 : 1;
    errors = checked.errors;
  } catch (const Error& error) {
    if (!context.json) clear_screen();
    context.print(head + "\n" + painted(Paint::bad, error.what()) + "\n");
    context.print_json(Json{{"pattern", file}, {"error", error.what()}}.dump());
    context.exit_code = 3;
  }
  std::fflush(stdout);
}

void wait_or_stop() {
  if (stop_requested()) throw Interrupted();
  std::this_thread::sleep_for(kFileLook);
}

// An editor that replaces a file removes it for a moment.
void await_return(const std::string& file) {
  for (auto waited = kFileLook; waited <= kFileGone && !fs::exists(file); waited += kFileLook)
    wait_or_stop();
}

// Returns when one of the files differs from what was read at `read_at`.
void await_change(const std::vector<fs::path>& files, const Stamps& stamps,
                  const std::vector<std::string>& contents,
                  std::chrono::steady_clock::time_point read_at) {
  bool compared = false;
  while (stamps_of(files) == stamps) {
    if (!compared && std::chrono::steady_clock::now() - read_at > kFileClockStep) {
      compared = true;
      if (contents_of(files) != contents) return;
    }
    wait_or_stop();
  }
}

// Checks again at every change, until Ctrl-C.
void watch(Context& context, const CheckCommand& options) {
  if (options.patterns.size() != 1)
    fail(ErrorCode::usage, "check --watch: name exactly one PATTERN");
  const std::string& file = options.patterns.front();
  if (file == "-")
    fail(
        ErrorCode::usage,
        "check --watch: standard input does not change, so there is nothing to watch. Name a file");
  Stamps seen;
  std::optional<int> errors;
  while (true) {
    // The files contain the names of further files, and they may change while they are read. So the
    // stamps from before the reading are kept.
    std::vector<fs::path> known = {file};
    for (const auto& entry : seen) known.push_back(entry.first);
    const Stamps before = stamps_of(known);
    const std::vector<fs::path> files = watched_files(file, seen);
    seen = stamps_of(files);
    for (auto& [path, stamp] : seen)
      if (const auto earlier = before.find(path); earlier != before.end()) stamp = earlier->second;
    const std::vector<std::string> contents = contents_of(files);
    const auto read_at = std::chrono::steady_clock::now();
    check_once(context, options, file, errors);
    await_change(files, seen, contents, read_at);
    await_return(file);
    await_written(file);
    if (!shows_colours()) context.print("\n");
  }
}

void check(Context& context, const CheckCommand& options) {
  if (options.list_tolerances) {
    print_tolerances(context);
    return;
  }
  if (options.patterns.empty()) fail(ErrorCode::usage, "check: name at least one PATTERN");
  refuse_unknown_tolerances(options.tolerances);
  if (!options.plot.empty()) {
    if (options.patterns.size() != 1 || options.watch)
      fail(ErrorCode::usage, "check --plot: name exactly one PATTERN, and leave --watch out");
    refuse_overwriting(context, options.plot);
  }
  if (options.watch) {
    watch(context, options);
    return;
  }
  Json all = Json::array();
  bool consistent = true;
  for (const std::string& file : options.patterns) {
    const Checked checked = checked_one(context, options, file);
    context.print(checked.words);
    all.push_back(checked.json);
    consistent = consistent && all.back()["verdict"] == "consistent";
  }
  const Json many = {{"verdict", verdict_of(consistent)}, {"checks", all}};
  context.print_json((all.size() == 1 ? all[0] : many).dump(2));
  context.exit_code = consistent ? 0 : 1;
}

}  // namespace

void add_check(Command& app, Context& context) {
  Command* command = app.add_subcommand("check", "say whether a motion is physically consistent");
  command->footer(
      "Examples:\n  ayumi check patterns/hoap1_walk.json\n"
      "  ayumi check walk.json --profile hoap1-strong --tolerance support_margin=0.01\n"
      "  ayumi check a.json b.json --json\n  ayumi check walk.json --watch\n"
      "  ayumi check walk.json --plot joints.svg\n"
      "  ayumi check --tolerances\n"
      "check assumes level ground. Slopes, bumps and moving floors are tested by simulate only.");
  static CheckCommand options;
  command->add_option("PATTERN", options.patterns, "Pattern files.");
  command
      ->add_option("--tolerance", options.tolerances,
                   "Tolerance of one kind of finding (default: the tolerance in the pattern).")
      ->type_name("KIND=VALUE")
      ->allow_extra_args(false);
  command->add_flag("--tolerances", options.list_tolerances,
                    "List all kinds of findings with their tolerances.");
  command->add_flag("--all", options.all,
                    "Print every finding and all other parts of the answer in full. Without this "
                    "option, the answer has one entry for each cause and fits on a screen.");
  command
      ->add_option("--plot", options.plot, "Draw the joints against their limits (.svg or .png).")
      ->type_name("F");
  command->add_flag("--watch", options.watch,
                    "Check again whenever a file of the pattern changes. Press Ctrl-C to stop.");
  add_pattern_options(*command, options.input);
  command->callback([&context] { check(context, options); });
}

}  // namespace ayumi::app
