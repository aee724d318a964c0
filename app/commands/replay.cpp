// Plays a table as the robot would play it. The table is read back, turned into counts and clamped
// as the motor boards do it, and played open loop on the servos of the simulated robot. The judged
// values are the values that are sent.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/motor_board.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/import_pattern.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/run/run_output.hpp"
#include "ayumi/io/table/csv_dialect.hpp"
#include "ayumi/io/table/motion_import.hpp"
#include "ayumi/io/table/table.hpp"
#include "ayumi/io/table/table_columns.hpp"
#include "ayumi/io/table/table_note.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/run_caution.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "run_robot.hpp"
#include "simulation.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct ReplayCommand {
  std::string file, robot, profile, plant = "both", out;
  double rate = 0, settle = 1;
};

/// The table and its recognized format.
struct Played {
  ReferenceTrajectory table;
  std::string format, layout;
  TableCaution caution;  ///< cautions in its head and in the note beside it
};

/// How closely a simulated robot follows the targets.
struct Tracking {
  double mean = 0, most = 0;  ///< mean and largest |angle - target| of the joints [rad]
  std::string joint;          ///< joint of the largest difference
  double at = 0;              ///< time of the largest difference [s]
};

std::vector<std::string> plants_of(const std::string& choice) {
  if (choice == "both") return built_plants();
  plant_of(choice);
  return {choice};
}

std::string robot_in_head(const std::string& bytes, const std::string& file) {
  const NumberTable table = number_table(bytes, file);
  for (const char* key : {"robot", "provenance.robot"})
    if (const auto found = table.header.find(key); found != table.header.end())
      return read_header_value(found->second);
  return "";
}

// Whether a table may name its robot. Other programs write JSON, too, but without "columns".
bool has_head(const std::string& bytes) {
  const size_t first = bytes.find_first_not_of(" \t\r\n");
  return first != std::string::npos &&
         (bytes[first] == '#' ||
          (bytes[first] == '{' && bytes.find("\"columns\"") != std::string::npos));
}

RobotModel robot_of(const ReplayCommand& options, const Context& context,
                    const std::string& bytes) {
  if (is_pattern_text(bytes))
    fail(ErrorCode::bad_file, {options.file},
         "this is a pattern, but replay needs a table. `ayumi export` writes the table of a "
         "pattern");
  std::string recorded;
  if (options.robot.empty() && has_head(bytes)) recorded = robot_in_head(bytes, options.file);
  if (options.robot.empty() && recorded.empty())
    fail(ErrorCode::usage, {options.file}, "the file does not name its robot. Give --robot ROBOT");
  return robot_of_run(context, options.robot, recorded);
}

/// The cautions in the note beside the table. Standard input has no note.
TableCaution note_of(const std::string& file) {
  return file == "-" ? TableCaution() : read_table_note(file);
}

Played read_played(const ReplayCommand& options, const RobotModel& model,
                   const std::string& bytes) {
  if (looks_like_hoap(bytes, model)) {
    const HoapFile sequence =
        parse_hoap(bytes, options.file, model,
                   options.rate > 0 ? static_cast<int>(std::lround(1000 / options.rate)) : 0);
    return {hoap_targets(model, sequence), "hoap", sequence.layout.name, note_of(options.file)};
  }
  const ImportedMotion read =
      read_motion_rows(bytes, options.file, model, {.rate = options.rate, .sent = true});
  Played played{{}, read.format, "", note_of(options.file)};
  add_caution(played.caution, read.caution);
  played.table.dt = read.motion.dt;
  played.table.joints = model.dof_names();
  for (Eigen::Index k = 0; k < read.motion.theta.rows(); ++k) {
    ReferenceRow row;
    row.theta = read.motion.theta.row(k).transpose();
    played.table.rows.push_back(std::move(row));
  }
  return played;
}

/// The motion of the table as a plan, which states where feet and COG should be, for the verdict.
Task planned(const ReplayCommand& options, const RobotModel& model, const std::string& bytes,
             const BoardTargets& board, const Context& context) {
  ImportedMotion read = read_motion(bytes, options.file, model,
                                    {.rate = options.rate, .commands = true, .sent = true});
  // In the ramp, the columns of the base do not belong to its posture; there, the standing feet
  // determine the base.
  const std::vector<Support>& support = read.motion.support;
  if (std::find(support.begin(), support.end(), Support::none) == support.end())
    read.motion.base.clear();
  read.motion.cog.clear();
  read.motion.zmp.clear();
  read.motion.fz.clear();
  Pattern pattern = grounded(model, read.motion, "").pattern;
  pattern.name = "replay of " + fs::path(options.file).filename().string();
  pattern.robot = model.name();
  pattern.profile = options.profile;
  pattern.file = options.file;
  pattern.controller = {ControllerKind::none, {}};
  Task task = make_task(std::move(pattern), model, options.profile, context.progress());
  task.tick = board.dt;
  task.series = sample(model, task.pattern, {.dt = board.dt}, context.progress());
  task.series.targets = board.targets;
  const auto length = static_cast<size_t>(board.targets.cols());
  while (task.series.samples.size() < length)
    task.series.samples.push_back(task.series.samples.back());
  return task;
}

Tracking tracking_of(const SimulationLog& log, size_t rows) {
  Tracking tracking;
  double sum = 0;
  long count = 0;
  for (size_t k = 0; k < std::min(rows, log.samples.size()); ++k) {
    const double t = static_cast<double>(k) * log.dt;
    if (log.result.fell_at >= 0 && t > log.result.fell_at) break;
    const SimulationSample& s = log.samples[k];
    for (Eigen::Index j = 0; j < s.target.size(); ++j) {
      const double error = std::abs(s.state.theta[j] - s.target[j]);
      sum += error;
      ++count;
      if (error <= tracking.most) continue;
      tracking.most = error;
      tracking.joint = log.joints[static_cast<size_t>(j)];
      tracking.at = t;
    }
  }
  tracking.mean = count > 0 ? sum / static_cast<double>(count) : 0;
  return tracking;
}

std::string in_degrees(double angle, int digits = 3) {
  return text::fixed(angle * 180 / EIGEN_PI, digits) + " deg";
}

std::string text_of(const Clamp& clamp) {
  return clamp.joint + " by up to " + in_degrees(clamp.change) + " at " + text::fixed(clamp.t, 3) +
         " s. They do so in " + text::counted(clamp.rows, "servo period") +
         ", because of the limit of the " +
         (clamp.kind == Clamp::Kind::range ? "counts of 16 bits" : name_of(clamp.kind));
}

Json json_of(const Clamp& clamp) {
  return {{"kind", name_of(clamp.kind)},
          {"joint", clamp.joint},
          {"at_s", clamp.t},
          {"change_rad", clamp.change},
          {"ticks", clamp.rows}};
}

Json json_of(const SimulationLog& log, const Tracking& tracking) {
  Json json = Json::parse(simulation_json(log));
  json["tracking"] = {{"mean_rad", tracking.mean},
                      {"max_rad", tracking.most},
                      {"joint", tracking.joint},
                      {"at_s", tracking.at}};
  return json;
}

void write_folder(const ReplayCommand& options, const Context& context,
                  const std::vector<SimulationLog>& logs, const TableCaution& caution,
                  const Json& json) {
  RunFolder run;
  // The tables of this run follow from its logs, so run.json holds their cautions.
  run.light = true;
  run.reference_caution = caution;
  if (!caution.unfit.empty()) run.unfit.push_back(caution.unfit);
  run.provenance = logs.front().provenance;
  for (const SimulationLog& log : logs) {
    run.logs[log.plant] = log;
    const std::string unfit = unfit_words(log);
    if (!unfit.empty()) run.unfit.push_back("in the simulator " + log.plant + ", " + unfit);
  }
  run.sections.emplace_back("replay", json.dump());
  RunOutput output(options.out, context.force);
  write_run(output.folder(), run);
  output.deliver();
}

void replay(Context& context, const ReplayCommand& options) {
  const std::vector<std::string> plants = plants_of(options.plant);
  if (!options.out.empty())
    require_run_target(options.out, context.force,
                       {"run.json", log_file_name("ayumi"), log_file_name("mujoco")});
  const std::string bytes = plain_table_text(read_input(options.file), options.file);
  const RobotModel model = robot_of(options, context, bytes);
  const Played played = read_played(options, model, bytes);
  SafetyOptions safety;
  safety.profile = model.limits(options.profile).name;
  const BoardTargets board = board_targets(model, played.table, safety);
  const Task task = planned(options, model, bytes, board, context);

  std::string words = options.file + ": " + std::to_string(played.table.rows.size()) +
                      " rows, one every " + text::brief(1000 * played.table.dt) + " ms (" +
                      played.format + (played.layout.empty() ? "" : ", " + played.layout) +
                      "), profile " + safety.profile + "\n";
  const TableCaution& caution = played.caution;
  for (const std::string& line : words_of(caution)) words += "  " + line + "\n";
  if (board.clamps.empty()) words += "  the motor boards send every row to the motors unchanged\n";
  for (size_t i = 0; i < std::min<size_t>(board.clamps.size(), 5); ++i)
    words += "  the motor boards change the target of " + text_of(board.clamps[i]) + "\n";
  if (board.clamps.size() > 5)
    words += "  and they make " + text::counted(board.clamps.size() - 5, "smaller change") + "\n";
  Json clamps = Json::array();
  for (const Clamp& clamp : board.clamps) clamps.push_back(json_of(clamp));

  std::vector<SimulationLog> logs;
  Json simulated = Json::object();
  bool stands = true;
  for (const std::string& plant : plants) {
    SimulateOptions how = simulate_options(task);
    how.plant = plant_of(plant);
    how.settle = options.settle;
    how.seed = context.seed;
    logs.push_back(simulate(task, how, context.progress(), context.command_line));
    const Tracking tracking = tracking_of(logs.back(), static_cast<size_t>(board.targets.cols()));
    words += "  simulator " + plant + ": " + outcome_text(logs.back()) + ". The joints are " +
             in_degrees(tracking.mean) + " from their targets on average and " +
             in_degrees(tracking.most, 2) + " at most (" + tracking.joint + " at " +
             text::fixed(tracking.at, 3) + " s)\n";
    simulated[plant] = json_of(logs.back(), tracking);
    stands = stands && logs.back().result.outcome == Outcome::stands;
  }
  const Json json = {
      {"table", options.file},
      {"format", played.format},
      {"layout", played.layout.empty() ? Json() : Json(played.layout)},
      {"robot", model.name()},
      {"profile", safety.profile},
      {"rows", played.table.rows.size()},
      {"interval_ms", 1000 * played.table.dt},
      {"duration_s", static_cast<double>(played.table.rows.size() - 1) * played.table.dt},
      {"verdict", stands ? "stands" : "falls or does not settle"},
      {"disturbances", caution.disturbances.empty() ? Json() : Json(caution.disturbances)},
      {"unfit", caution.unfit.empty() ? Json() : Json(caution.unfit)},
      {"clamps", clamps},
      {"plants", simulated}};
  if (!options.out.empty()) {
    write_folder(options, context, logs, caution, json);
    words += "  written to " + options.out + "\n";
  }
  context.print(words);
  context.print_json(json.dump(2));
  context.exit_code = stands ? 0 : 1;
}

}  // namespace

void add_replay(Command& app, Context& context) {
  Command* command = app.add_subcommand(
      "replay", "send a table or sequence to the servos of the simulated robot, row by row");
  command->footer(
      "Examples:\n  ayumi replay walk_hoap.csv --robot hoap1\n"
      "  ayumi replay out/reference.csv --profile hoap1-strong --json\n"
      "  ayumi replay walk_hoap.csv --robot hoap1 -o replayed/");
  auto options = std::make_shared<ReplayCommand>();
  command->add_option("TABLE", options->file, "HOAP sequence or joint table; - is standard input.")
      ->required();
  command
      ->add_option("--robot", options->robot,
                   "Robot that plays the table (default: the robot that the table names).")
      ->type_name("ROBOT");
  command
      ->add_option("--profile", options->profile,
                   "Actuator profile. The simulated servos have the constants of this profile "
                   "(default: the first profile of the robot).")
      ->type_name("NAME");
  command
      ->add_option(
          "--plant", options->plant,
          "Simulator: ayumi, mujoco or both. If this program was built without MuJoCo, both "
          "means ayumi alone.")
      ->type_name("NAME")
      ->capture_default_str();
  command
      ->add_option("--rate", options->rate,
                   "Rows per second of a table without a time column [1/s].")
      ->check(number_within(ImportOptions::kRate))
      ->type_name("HZ");
  command
      ->add_option("--settle", options->settle,
                   "Time for which the last row is held after the table [s].")
      ->check(number_within(0.0, 60.0))
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "Folder for the run.")->type_name("DIR");
  command->callback([options, &context] { replay(context, *options); });
}

}  // namespace ayumi::app
