// The main command: check -> (repair if requested) -> simulate, both open and closed loop -> joint
// tables -> clip, snapshots, plots. The table for the robot is that of the law without the scripted
// disturbances; the run with the disturbances is the one that is judged.

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/run/run_output.hpp"
#include "ayumi/io/table/table.hpp"
#include "ayumi/limits/table_safety.hpp"
#include "ayumi/motion/shown_name.hpp"
#include "ayumi/plot/com_zmp_plot.hpp"
#include "ayumi/render/encoder.hpp"
#include "ayumi/render/snapshots.hpp"
#include "ayumi/repair/repair_pattern.hpp"
#include "ayumi/task/servo_table.hpp"
#include "check_table.hpp"
#include "pattern_input.hpp"
#include "repairing.hpp"
#include "report_input.hpp"
#include "screen.hpp"
#include "simulation.hpp"
#include "streamed_run.hpp"
#include "terminal.hpp"

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
  bool light = false;  ///< whether only the logs and the verdicts are written
  bool all = false;    ///< every finding
};

/// The names of the files that the run writes, as far as they are known before the run.
std::vector<std::string> names_of_files(const RunCommand& options) {
  std::vector<std::string> names = {"run.json", "log_open_loop.bin", "log_closed_loop.bin",
                                    "log_undisturbed.bin"};
  if (!options.light)
    for (const char* name : {"reference.csv", "reference.json", "reference_pushed.csv", "hoap.csv"})
      names.emplace_back(name);
  if (options.repair) names.emplace_back("repaired.json");
  if (options.pictures)
    for (const char* name : {"loci.svg", "loci.png", "snapshots.png", "clip.mp4", "report.html"})
      names.emplace_back(name);
  return names;
}

// Column at which the text after the name of a stage begins.
constexpr size_t kStageHang = 12;

std::string stage_line(const std::string& stage, const std::string& text) {
  return padded("  " + stage, kStageHang) + text + "\n";
}

class MainJob {
 public:
  MainJob(Context& context, const RunCommand& options, const fs::path& target)
      : context_(context), options_(options), target_(target) {}

  /// Returns whether the pattern is consistent and the law keeps the robot upright, with the
  /// disturbances and without.
  bool run(const std::string& pattern);
  const Json& summary() const { return summary_; }

 private:
  void say(const std::string& stage, const std::string& text) const {
    context_.print(in_full({{Worth::verdict, {stage_line(stage, text)}, kStageHang}}));
  }
  void note_file(const std::string& name) { folder_.files.push_back(name); }

  void check(Task& input);
  void repair_pattern(Task& input);
  void simulate(const Task& input);
  void export_tables(const Task& input);
  StreamedRun run_streamed(const Task& input, const std::string& name,
                           const SimulationChoice& choice, const StreamedParts& parts);
  void write_hoap(const Task& input);
  void read_back();
  void draw(const RobotModel& model, const std::shared_ptr<const RobotLook>& look,
            const std::string& title);
  void write_report(const RobotModel& model, const std::shared_ptr<const RobotLook>& look,
                    const std::string& title);
  std::vector<std::string> file_names() const;

  const StreamedRun& judged_run() const { return closed_loop_; }
  /// The run from which the table for the robot comes: the one without the disturbances.
  const StreamedRun& table_run() const { return undisturbed_ ? *undisturbed_ : closed_loop_; }

  Context& context_;
  const RunCommand& options_;
  fs::path target_;
  std::optional<RunOutput>
      output_;  // opened after the input has been read, so that bad input leaves no files
  // Why the (repaired) pattern is inconsistent; empty if it is consistent.
  std::string inconsistent_;
  RunFolder folder_;
  StreamedRun closed_loop_;
  // The run without disturbances, if the pattern has disturbances.
  std::optional<StreamedRun> undisturbed_;
  PngPicture snapshots_ = {};
  Json summary_ = Json::object();
};

// Number of rows for other lines than the check. Chosen: the name of the pattern and the lines
// after the check take 12 rows of 80 columns if everything is written, and up to 3 more if the run
// is worse than open loop.
constexpr size_t kRowsOfOtherStages = 14;

// The verdict, in a form with the shares of the limits and in a form without them.
AnswerPart check_part(const ConsistencyReport& report, const RobotModel& model) {
  const std::string verdict = painted_verdict(report) + ": ZMP margin " +
                              text::fixed(1e3 * report.summary[FindingKind::support_margin], 1) +
                              " mm";
  return {Worth::figure,
          {stage_line("check", verdict + ", share of the limits of " + report.profile + ": " +
                                   shares_of_limits(report, model)),
           stage_line("check", verdict)},
          kStageHang};
}

void MainJob::check(Task& input) {
  const Judgement judged = judge(input, check_options(input));
  const std::string& need = judged.need().text;
  std::vector<AnswerPart> parts = {check_part(judged.report, input.robot)};
  append(parts,
         finding_parts(judged.report, input.robot, options_.all ? Shown::findings : Shown::causes));
  if (!need.empty()) append(parts, remark_parts("", {need}));
  Room room = room_of(rows_for(judged.report));
  room.rows -= kRowsOfOtherStages;
  context_.print(options_.all ? in_full(parts) : fitted(parts, room, where_more_is(judged.report)));
  summary_["check"] = Json::parse(check_json(judged.report));
  summary_["repair"] = nullptr;  // stays null unless a repair was requested and needed
  folder_.sections.emplace_back("sampled_from", Json(input.series.origin).dump());
  folder_.sections.emplace_back("check", check_json(judged.report));
  inconsistent_ = judged.reason();
  if (judged.motion_consistent) return;  // repair cannot change goals of VIIP, which are no keys
  if (options_.repair)
    repair_pattern(input);
  else
    say("repair", "not done (--repair looks for the nearest consistent pattern)");
}

void MainJob::repair_pattern(Task& input) {
  RepairOptions options = preferred_options(input.pattern);
  options.check = check_options(input);
  const RepairResult result = repair_task(input, options, context_.progress());
  say("repair", (result.status == RepairStatus::not_converged ? std::string("no repair was found")
                                                              : name_of(result.status)) +
                    ": " + std::to_string(result.iterations) +
                    " iterations, joints moved by at most " +
                    text::fixed(result.max_joint_change * 180 / EIGEN_PI, 2) + " deg, COG by " +
                    text::fixed(1e3 * result.max_cog_change, 1) + " mm");
  summary_["repair"] = Json::parse(repair_json(result));
  folder_.sections.emplace_back("repair", repair_json(result));
  if (result.status != RepairStatus::repaired) return;
  inconsistent_.clear();
  input.series = result.series;
  input.pattern.correction = result.correction;
  write_pattern(output_->file("repaired.json"), input.pattern);
  note_file("repaired.json");
}

StreamedRun MainJob::run_streamed(const Task& input, const std::string& name,
                                  const SimulationChoice& choice, const StreamedParts& parts) {
  StreamedRun run = simulate_streamed(context_, input, simulation_options(context_, input, choice),
                                      output_->file(log_file_name(name)), parts);
  folder_.written[name] = run.log;
  return run;
}

void MainJob::simulate(const Task& input) {
  SimulationChoice open = options_.choice;
  open.controller = name_of(ControllerKind::none);
  open.gains.clear();
  const WrittenLog open_log = run_streamed(input, "open_loop", open, {}).log;
  say("simulate", outcome_text(open_log));
  closed_loop_ =
      run_streamed(input, "closed_loop", options_.choice, {.postures = true, .torque = true});
  const WrittenLog& closed = closed_loop_.log;
  say("", outcome_text(closed));
  const std::vector<std::string> worse = worse_than_open_loop(open_log.about, closed.about);
  if (!worse.empty())
    say("", painted(Paint::caution, kWorseWithControl) + ": " + text::join(worse, "; "));
  summary_["worse_than_open_loop"] = worse;
  folder_.provenance = closed.about.provenance;
  Json both;
  both["open_loop"] = Json::parse(simulation_json(open_log));
  both["closed_loop"] = Json::parse(simulation_json(closed));
  summary_["simulate"] = both;
  summary_["undisturbed"] = nullptr;
  folder_.sections.emplace_back("simulate", both.dump());
  if (closed.about.scenario.empty()) return;
  closed_loop_.torque.resize(0, 0);  // the table for the robot comes from the other run
  SimulationChoice calm = options_.choice;
  calm.scenario = "none";
  undisturbed_ = run_streamed(input, "undisturbed", calm, {.postures = true, .torque = true});
  say("", "without disturbances, " + outcome_text(undisturbed_->log));
  summary_["undisturbed"] = Json::parse(simulation_json(undisturbed_->log));
  folder_.sections.emplace_back("undisturbed", simulation_json(undisturbed_->log));
}

void MainJob::export_tables(const Task& input) {
  const SimulationLog& table = table_run().log.about;
  folder_.reference = table_of_postures(input.robot, input.profile, table, table_run().postures);
  folder_.reference_caution = table_caution(input, table, folder_.unfit);
  if (!options_.light) {
    write_file(output_->file("reference.json"),
               reference_json(*folder_.reference, folder_.reference_caution));
    note_file("reference.json");
  }
  if (undisturbed_) {
    const SimulationLog& judged = judged_run().log.about;
    folder_.pushed = table_of_postures(input.robot, input.profile, judged,
                                       std::exchange(closed_loop_.postures, {}));
    folder_.pushed_caution = table_caution(input, judged, folder_.unfit);
  }
  write_hoap(input);
}

// A table for the robot is judged by the robot's own actuators. Actuators that a study assumes are
// not used.
void MainJob::write_hoap(const Task& input) {
  SafetyOptions safety;
  safety.profile = input.robot.limits().name;
  StreamedRun& run = undisturbed_ ? *undisturbed_ : closed_loop_;
  const SafeTable safe = make_safe_run(input.robot,
                                       table_of_postures(input.robot, safety.profile, run.log.about,
                                                         std::exchange(run.postures, {})),
                                       std::exchange(run.torque, {}), safety);
  folder_.sections.emplace_back("export", safety_json(safe.report));
  std::string text =
      options_.light
          ? "no table is written with --light. `ayumi export` makes a table from the logs"
          : "reference.csv, reference.json";
  if (folder_.pushed && !options_.light)
    text += ", reference_pushed.csv (with the reactions to the disturbances)";
  const bool encoders = input.robot.dofs().front().encoder.device > 0;
  const TableCaution& caution = folder_.reference_caution;
  const std::string still = std::string("\n") + std::string(kStageHang, ' ') +
                            (options_.light ? "" : "written, but not for a robot: ");
  if (!caution.unfit.empty()) {
    text = "no table for a robot: " + caution.unfit + still + text;
  } else if (!caution.disturbances.empty()) {
    text =
        "no table for a robot, because the table of the pattern is from a run with disturbances (" +
        caution.disturbances + ")" + still + text;
  } else if (encoders && safe.report.safe && !options_.light) {
    try {
      write_file(output_->file("hoap.csv"), hoap_csv(input.robot, safe.table, safety));
      note_file("hoap.csv");
      text += ", hoap.csv (" + std::to_string(safe.table.rows.size()) +
              " rows, largest step from row to row " +
              text::fixed(100 * safe.report.max_step_ratio, 0) + " % of the limit" +
              (safe.report.worst_joint.empty()
                   ? ""
                   : " (" + safe.report.worst_joint + " at " +
                         text::fixed(safe.report.worst_at, 3) + " s of the table)") +
              ")";
    } catch (const Error& error) {  // the run is whole without a file that cannot hold its table
      if (error.code() != ErrorCode::bad_pattern) throw;
      text += std::string(". hoap.csv is not written: ") + error.what() +
              " (`ayumi export` can write the table at another interval)";
    }
  } else if (encoders && !safe.report.safe) {
    text += (options_.light ? ". The table for the robot is unsafe: "
                            : ". hoap.csv is not written, because the table is unsafe: ") +
            text_of(safe.report.violations.front());
  }
  say("export", text);
}

// Reads the samples of the logs back, which pictures and the report need.
void MainJob::read_back() {
  for (const char* name : {"open_loop", "closed_loop"})
    folder_.logs[name] = with_samples(folder_.written.at(name), output_->file(log_file_name(name)));
}

void MainJob::draw(const RobotModel& model, const std::shared_ptr<const RobotLook>& look,
                   const std::string& title) {
  // Pictures show the plan in the frame of the robot; curves choose their frame themselves.
  const SimulationLog closed = in_frame(model, folder_.logs.at("closed_loop"), Frame::world);
  const std::vector<LociRun> runs = {{"open loop", &folder_.logs.at("open_loop")},
                                     {name_of(closed.controller.value()), &closed}};
  LociOptions loci;
  loci.title = title;
  loci.model = &model;
  const Drawing drawing = draw_loci(runs, loci);
  for (const char* name : {"loci.svg", "loci.png"}) {
    write_drawing(output_->file(name), drawing, loci.png_scale);
    note_file(name);
  }
  ClipOptions clip;
  clip.title = title;
  clip.look = look;
  snapshots_ = snapshots_of_run(model, closed, clip);
  write_file(output_->file("snapshots.png"), snapshots_.bytes);
  note_file("snapshots.png");
  say("plot", "loci.svg, loci.png, snapshots.png");
  clip.threads = context_.threads > 0
                     ? context_.threads
                     : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const ClipSummary summary =
      write_clip(model, closed, output_->file("clip.mp4"), clip, context_.progress());
  note_file("clip.mp4");
  say("preview", "clip.mp4 (" + std::to_string(summary.frames) + " frames, " +
                     std::to_string(summary.width) + "x" + std::to_string(summary.height) + ")");
  for (const std::string& note : summary.notes) say("", note);
}

void MainJob::write_report(const RobotModel& model, const std::shared_ptr<const RobotLook>& look,
                           const std::string& title) {
  ReportInput input = report_input(folder_, target_.string());
  if (!title.empty()) input.title = title;
  const Report made =
      make_report(model, input, {.look = look, .snapshots = &snapshots_}, context_.progress());
  write_file(output_->file("report.html"), made.html);
  note_file("report.html");
  say("report",
      "report.html (" + std::to_string(made.html.size() / 1000) + " kB" +
          (has_replay() ? ")"
                        : ", without the replay, because the program was built without npm)"));
}

std::vector<std::string> MainJob::file_names() const {
  std::vector<std::string> names = folder_.files;
  names.emplace_back("run.json");
  if (!folder_.light) names.emplace_back("reference.csv");
  if (folder_.pushed && !folder_.light) names.emplace_back("reference_pushed.csv");
  for (const auto& [name, log] : folder_.written) names.push_back(log_file_name(name));
  std::sort(names.begin(), names.end());
  return names;
}

bool MainJob::run(const std::string& file) {
  context_.print(file + "\n");
  folder_.light = options_.light;
  Task input = load_pattern(context_, file, options_.input, options_.pictures);
  refuse_unstable_gains(input, chosen_controller(input, options_.choice), options_.choice.unstable);
  output_.emplace(target_, context_.force);
  check(input);
  simulate(input);
  folder_.unfit = unfit_reasons(inconsistent_, judged_run().log.about,
                                undisturbed_ ? &undisturbed_->log.about : nullptr);
  export_tables(input);
  if (options_.pictures) {
    read_back();
    const std::shared_ptr<const RobotLook> look = robot_look(input.robot);
    draw(input.robot, look, shown_name(input.pattern));
    write_report(input.robot, look, shown_name(input.pattern));
  }
  write_run(output_->folder(), folder_);
  output_->deliver();
  summary_["unfit"] = folder_.unfit;
  summary_["files"] = file_names();
  say("written", (target_ / "").string());
  return folder_.unfit.empty();
}

void run_patterns(Context& context, const RunCommand& options) {
  plant_of(options.choice.plant);  // a missing plant is refused before anything is computed
  if (options.pictures) require_encoder();
  const bool several = options.patterns.size() > 1;
  std::vector<fs::path> targets;
  for (const std::string& pattern : options.patterns) {
    const fs::path target =
        several ? fs::path(options.out) / fs::path(pattern).stem() : fs::path(options.out);
    if (std::find(targets.begin(), targets.end(), target) != targets.end())
      fail(ErrorCode::usage, {pattern},
           "another input has the same name, so both results would be written to " +
               target.string() +
               ". Run the command once for each of the two, each time with "
               "another -o");
    require_run_target(target, context.force, names_of_files(options));
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

void add_run(Command& app, Context& context) {
  Command* command =
      app.add_subcommand("run", "do the whole job: check, simulate, export, draw and report");
  command->footer(
      "Examples:\n  ayumi run patterns/hoap1_walk.json -o out/\n"
      "  ayumi run walk.json --repair -o out/walk\n"
      "  ayumi run a.json b.json -o out/ --no-pictures --json\n"
      "  ayumi run walk.json --light -o out/        then, for example: ayumi report out/ -o "
      "walk.html");
  auto options = std::make_shared<RunCommand>();
  command->add_option("PATTERN", options->patterns, "Pattern files.")->required();
  command->add_option("-o,--out", options->out, "Folder for the results.")
      ->type_name("DIR")
      ->required();
  command->add_flag("--repair", options->repair, "Repair an inconsistent pattern first.");
  command->add_flag_callback(
      "--no-pictures", [options] { options->pictures = false; },
      "Write only the logs, tables and verdicts, without pictures, clips and report.");
  command->add_flag_callback(
      "--light",
      [options] {
        options->light = true;
        options->pictures = false;
      },
      "Write only the logs and verdicts. Tables, plots, clips and the report can be made from the "
      "logs later.");
  command->add_flag("--all", options->all,
                    "Print every finding. Without this option, the answer fits on a screen.");
  add_pattern_options(*command, options->input);
  add_simulation_options(*command, options->choice);
  add_noise_flag(*command, options->choice.noise);
  command->callback([options, &context] { run_patterns(context, *options); });
}

}  // namespace ayumi::app
