// The main job: check -> (repair when asked) -> simulate, open loop beside closed loop -> joint
// tables -> clip, snapshots, loci. Results are made in a folder beside DIR and moved there when all
// of them are there.

#include <unistd.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/actuator_need.hpp"
#include "ayumi/check/table_safety.hpp"
#include "ayumi/control/viip_goals.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/table/table.hpp"
#include "ayumi/plot/com_zmp_plot.hpp"
#include "ayumi/render/snapshots.hpp"
#include "ayumi/repair/repair.hpp"
#include "pattern_input.hpp"
#include "repairing.hpp"
#include "report_input.hpp"
#include "simulation.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct RunCommand {
  std::vector<std::string> patterns;
  std::string out;
  PatternOptions input;
  SimulationChoice choice;
  bool repair = false;
  bool pictures = true;
};

/// A folder that becomes DIR only when everything in it is there.
class Workshop {
 public:
  explicit Workshop(const fs::path& target) : target_(target) {
    const fs::path clean = (target / "").parent_path();
    const fs::path parent = clean.has_parent_path() ? clean.parent_path() : fs::path(".");
    std::error_code error;
    fs::create_directories(parent, error);
    folder_ = parent / (clean.filename().string() + ".part" + std::to_string(getpid()));
    fs::create_directory(folder_, error);
    if (error)
      fail(ErrorCode::bad_file, target.string() + ": cannot be made (" + error.message() + ")");
  }
  ~Workshop() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  fs::path file(const std::string& name) const { return folder_ / name; }
  const fs::path& folder() const { return folder_; }

  /// Moves every file to its place, run.json last.
  void deliver() const {
    try {
      fs::create_directories(target_);
      std::vector<fs::path> files;
      for (const auto& entry : fs::directory_iterator(folder_)) files.push_back(entry.path());
      std::stable_sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
        return (a.filename() == "run.json") < (b.filename() == "run.json");
      });
      for (const fs::path& file : files) fs::rename(file, target_ / file.filename());
    } catch (const fs::filesystem_error& error) {
      fail(ErrorCode::bad_file,
           target_.string() + ": cannot be written (" + error.code().message() + ")");
    }
  }

 private:
  fs::path target_, folder_;
};

class MainJob {
 public:
  MainJob(Context& context, const RunCommand& options, const fs::path& target)
      : context_(context), options_(options), target_(target) {}

  /// Returns whether check and closed loop are good.
  bool run(const std::string& pattern);
  const Json& summary() const { return summary_; }

 private:
  void say(const std::string& stage, const std::string& text) const {
    context_.print("  " + stage + std::string(10 - std::min<size_t>(9, stage.size()), ' ') + text +
                   "\n");
  }
  void note_file(const std::string& name) { folder_.files.push_back(name); }

  bool check(PatternInput& input);
  void repair_pattern(PatternInput& input);
  bool simulate(const PatternInput& input);
  void export_tables(const PatternInput& input);
  void draw(const RobotModel& model, const std::string& title);
  void write_report(const RobotModel& model, const std::string& title);

  Context& context_;
  const RunCommand& options_;
  fs::path target_;
  std::optional<Workshop>
      workshop_;  // opened when the input has been read: bad input leaves nothing
  RunFolder folder_;
  Json summary_ = Json::object();
};

std::string check_text(const ConsistencyReport& report) {
  std::string text = report.consistent ? "consistent" : "inconsistent";
  text += ": ZMP margin " + text::fixed(1e3 * report.summary[FindingKind::support_margin], 1) +
          " mm, joint speed " + text::fixed(100 * report.summary[FindingKind::joint_speed], 0) +
          " %, torque " + text::fixed(100 * report.summary[FindingKind::joint_torque], 0) +
          " % of " + report.profile;
  for (const Finding& finding : report.findings)
    if (finding.severity == Severity::error)
      text += std::string("\n            ") + name_of(finding.kind) + " at " +
              text::fixed(finding.at, 3) + " s, " + finding.where + ": " +
              text::brief(finding.worst) + " " + finding.unit + ", limit " +
              text::brief(finding.limit) + "; " + finding.hint;
  return text;
}

bool MainJob::check(PatternInput& input) {
  const CheckOptions judged = check_options(input);
  ConsistencyReport report = check_consistency(input.model, input.series, judged);
  const ActuatorNeed need = actuator_need(
      input.model, keyed_goals(input.model, input.series, input.pattern.controller), judged);
  const bool mendable = !report.consistent;
  report.consistent = report.consistent && need.text.empty();
  say("check", check_text(report) + (need.text.empty() ? "" : "\n            " + need.text));
  summary_["check"] = Json::parse(check_json(report));
  summary_["repair"] = nullptr;  // stays so unless a repair was asked for and needed
  folder_.sections.emplace_back("check", check_json(report));
  if (!mendable) return report.consistent;  // goals of VIIP are not keys that repair could move
  if (!options_.repair) {
    say("repair", "not asked for; --repair looks for the nearest consistent pattern");
    return false;
  }
  repair_pattern(input);
  return summary_["repair"]["status"] == "repaired" && need.text.empty();
}

void MainJob::repair_pattern(PatternInput& input) {
  RepairOptions options = wished_options(input.pattern);
  options.check = check_options(input);
  const RepairResult result = repair_input(context_, input, options);
  say("repair", std::string(name_of(result.status)) + ": " + std::to_string(result.iterations) +
                    " iterations, joints moved by at most " +
                    text::fixed(result.max_joint_change * 180 / EIGEN_PI, 2) + " deg, COG by " +
                    text::fixed(1e3 * result.max_cog_change, 1) + " mm");
  summary_["repair"] = Json::parse(repair_json(result));
  folder_.sections.emplace_back("repair", repair_json(result));
  if (result.status != RepairStatus::repaired) return;
  input.series = result.series;
  input.pattern.correction = result.correction;
  write_pattern(workshop_->file("repaired.json"), input.pattern);
  note_file("repaired.json");
}

bool MainJob::simulate(const PatternInput& input) {
  SimulationChoice open = options_.choice;
  open.controller = name_of(ControllerKind::none);
  open.gains.clear();
  folder_.logs["open_loop"] = simulate_once(context_, input, open);
  say("simulate", outcome_text(folder_.logs["open_loop"]));
  folder_.logs["closed_loop"] = simulate_once(context_, input, options_.choice);
  const SimulationLog& closed = folder_.logs["closed_loop"];
  say("", outcome_text(closed));
  folder_.provenance = closed.provenance;
  Json both;
  for (const char* name : {"open_loop", "closed_loop"})
    both[name] = Json::parse(simulation_json(folder_.logs[name]));
  folder_.sections.emplace_back("simulate", both.dump());
  summary_["simulate"] = both;
  return closed.result.outcome == Outcome::stands;
}

void MainJob::export_tables(const PatternInput& input) {
  const ReferenceTrajectory reference = extract_reference(input.model, folder_.logs["closed_loop"]);
  folder_.reference = reference;
  write_file(workshop_->file("reference.json"), reference_json(reference));
  note_file("reference.json");
  SafetyOptions safety;
  safety.profile = input.profile;
  const SafeTable safe = make_safe(input.model, reference, safety);
  folder_.sections.emplace_back("export", safety_json(safe.report));
  std::string text = "reference.csv, reference.json";
  const bool encoders = input.model.dofs().front().encoder.device > 0;
  if (encoders && safe.report.safe) {
    write_file(workshop_->file("hoap.csv"), hoap_csv(input.model, safe.table, safety));
    note_file("hoap.csv");
    text += ", hoap.csv (" + std::to_string(safe.table.rows.size()) + " rows, largest step " +
            text::fixed(100 * safe.report.max_step_ratio, 0) + " % of the limit)";
  } else if (encoders) {
    text += "; no hoap.csv, the table is unsafe: " + text_of(safe.report.violations.front());
  }
  say("export", text);
}

void MainJob::draw(const RobotModel& model, const std::string& title) {
  const SimulationLog& closed = folder_.logs["closed_loop"];
  const std::vector<LociRun> runs = {{"open loop", &folder_.logs["open_loop"]},
                                     {name_of(closed.controller.value()), &closed}};
  LociOptions loci;
  loci.title = title;
  loci.model = &model;
  for (const char* name : {"loci.svg", "loci.png"}) {
    write_loci(runs, workshop_->file(name), loci);
    note_file(name);
  }
  StripOptions strip;
  strip.clip.title = title;
  strip.clip.picture.width = 640;
  strip.clip.picture.height = 480;
  write_strip(model, closed, workshop_->file("snapshots.png"), strip);
  note_file("snapshots.png");
  say("plot", "loci.svg, loci.png, snapshots.png");
  ClipOptions clip;
  clip.title = title;
  clip.threads = context_.threads > 0
                     ? context_.threads
                     : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const ClipSummary summary =
      write_clip(model, closed, workshop_->file("clip.mp4"), clip, context_.progress());
  note_file("clip.mp4");
  say("preview", "clip.mp4 (" + std::to_string(summary.frames) + " frames, " +
                     std::to_string(summary.width) + "x" + std::to_string(summary.height) + ")");
}

void MainJob::write_report(const RobotModel& model, const std::string& title) {
  ReportInput input = report_input(folder_, target_.string());
  if (!title.empty()) input.title = title;
  const Report made = make_report(model, input, {}, context_.progress());
  write_file(workshop_->file("report.html"), made.html);
  note_file("report.html");
  say("report", "report.html (" + std::to_string(made.html.size() / 1000) + " kB" +
                    (has_replay() ? ")" : "; without replay, the program was built without npm)"));
}

bool MainJob::run(const std::string& file) {
  context_.print(file + "\n");
  PatternInput input = load_pattern(context_, file, options_.input, options_.pictures);
  refuse_unstable_gains(input, chosen_controller(input, options_.choice), options_.choice.unstable);
  workshop_.emplace(target_);
  const bool consistent = check(input);
  const bool stands = simulate(input);
  export_tables(input);
  if (options_.pictures) {
    draw(input.model, input.pattern.name);
    write_report(input.model, input.pattern.name);
  }
  write_run(workshop_->folder(), folder_);
  workshop_->deliver();
  std::vector<std::string> files = folder_.files;
  for (const char* name : {"run.json", "log_open_loop.bin", "log_closed_loop.bin", "reference.csv"})
    files.emplace_back(name);
  std::sort(files.begin(), files.end());
  summary_["files"] = files;
  say("written", (target_ / "").string());
  return consistent && stands;
}

void run_patterns(Context& context, const RunCommand& options) {
  const bool several = options.patterns.size() > 1;
  std::vector<fs::path> targets;
  for (const std::string& pattern : options.patterns) {
    const fs::path target =
        several ? fs::path(options.out) / fs::path(pattern).stem() : fs::path(options.out);
    if (std::find(targets.begin(), targets.end(), target) != targets.end())
      fail(ErrorCode::usage, pattern + ": two inputs would be written to " + target.string());
    if (fs::exists(target) && !fs::is_directory(target))
      fail(ErrorCode::bad_file, target.string() + ": is a file, a folder is needed");
    if (fs::exists(target / "run.json")) refuse_overwriting(context, target);
    targets.push_back(target);
  }
  Json results = Json::array();
  bool good = true;
  for (size_t i = 0; i < targets.size(); ++i) {
    MainJob job(context, options, targets[i]);
    good &= job.run(options.patterns[i]);
    results.push_back(job.summary());
  }
  context.print_json((several ? Json{{"runs", results}} : results.front()).dump(2));
  context.exit_code = good ? 0 : 1;
}

}  // namespace

void add_run(CLI::App& app, Context& context) {
  CLI::App* command = app.add_subcommand("run", "the main job: check, simulate, export, see");
  command->footer(
      "Examples:\n  ayumi run patterns/hoap1_walk.json -o out/\n"
      "  ayumi run walk.json --repair -o out/walk\n"
      "  ayumi run a.json b.json -o out/ --no-pictures --json");
  auto options = std::make_shared<RunCommand>();
  command->add_option("PATTERN", options->patterns, "pattern files")->required();
  command->add_option("-o,--out", options->out, "folder for the results")
      ->type_name("DIR")
      ->required();
  command->add_flag("--repair", options->repair, "mend an inconsistent pattern first");
  command->add_flag_callback(
      "--no-pictures", [options] { options->pictures = false; }, "tables and verdicts only");
  add_pattern_options(*command, options->input);
  add_simulation_options(*command, options->choice);
  command->callback([options, &context] { run_patterns(context, *options); });
}

}  // namespace ayumi::app
