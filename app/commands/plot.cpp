// Plots of one or several runs: COG, ZMP and f_z against time, or from above.

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/plot/com_zmp_plot.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "run_robot.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

struct PlotOptions {
  std::vector<std::string> inputs;
  std::string output, robot, frame = "world";
  std::vector<std::string> logs;
  LociOptions loci;
  bool top = false;
};

struct LabelledLog {
  std::string label;
  SimulationLog log;
};

// The name of a log for people ("open loop" for "open_loop"), with the controller if one closed the
// loop.
std::string label_of(const std::string& name, const SimulationLog& log) {
  std::string label = name;
  std::replace(label.begin(), label.end(), '_', ' ');
  return !log.controller || log.controller == ControllerKind::none
             ? label
             : label + ", " + name_of(*log.controller);
}

// The logs of a RUN. The open loop comes first, so that the closed loop is drawn above it.
std::vector<LabelledLog> logs_of(const PlotOptions& options) {
  std::vector<LabelledLog> logs;
  for (const std::string& input : options.inputs) {
    const std::string prefix =
        options.inputs.size() > 1 ? fs::path(input).lexically_normal().stem().string() + " " : "";
    if (!is_run_folder(input)) {
      SimulationLog log = read_run_log(input);
      logs.push_back({fs::path(input).stem().string(), std::move(log)});
      continue;
    }
    std::map<std::string, SimulationLog> all;
    if (options.logs.empty()) {
      all = read_run(input).logs;
      all.erase("undisturbed");  // the plot only shows the runs under the scenario
    } else
      for (const std::string& name : options.logs) all[name] = read_run_log(input, name);
    const auto first = static_cast<std::ptrdiff_t>(logs.size());
    for (auto& [name, log] : all) {
      std::string label = prefix + label_of(name, log);
      logs.push_back({std::move(label), std::move(log)});
    }
    std::stable_partition(logs.begin() + first, logs.end(), [](const LabelledLog& entry) {
      return entry.log.controller == ControllerKind::none;
    });
  }
  return logs;
}

// The robot for the panel of the margin. Without the robot, the plot has no such panel.
std::optional<RobotModel> robot_at_hand(const LabelledLog& entry, const PlotOptions& options,
                                        const Context& context) {
  try {
    return robot_of_run(context, options.robot, entry.log.provenance.robot);
  } catch (const Error& error) {
    if (!options.robot.empty()) throw;
    context.print(std::string("the ZMP margin is not drawn: ") + error.what() + "\n");
    return std::nullopt;
  }
}

// Throws if a log does not fit its robot; `model` is the robot of the last log.
void require_logs(const RobotModel& model, const std::vector<LabelledLog>& logs,
                  const PlotOptions& options, const Context& context) {
  for (const LabelledLog& entry : logs)
    if (entry.log.provenance.robot == logs.back().log.provenance.robot)
      require_log_of(model, options.robot, entry.log, entry.label);
    else
      static_cast<void>(robot_of_log(context, options.robot, entry.log, entry.label));
}

void plot(const PlotOptions& asked, Context& context) {
  refuse_overwriting(context, asked.output);
  PlotOptions options = asked;
  options.loci.frame = frame_of(options.frame);
  const std::vector<LabelledLog> logs = logs_of(options);
  std::vector<LociRun> runs;
  for (const LabelledLog& entry : logs) runs.push_back({entry.label, &entry.log});
  if (runs.empty())
    fail(ErrorCode::usage,
         "plot: the run has no simulation log, so there is nothing to draw. Simulate the pattern "
         "again");
  std::vector<std::string> series;
  if (options.top) {
    const RobotModel model = robot_of_run(context, options.robot, logs.back().log.provenance.robot);
    require_logs(model, logs, options, context);
    write_support_plot(model, runs, options.output, options.loci);
    series = {"COG x, y [mm]", "ZMP x, y [mm]", "footholds [mm]"};
  } else {
    const std::optional<RobotModel> model = robot_at_hand(logs.back(), options, context);
    LociOptions loci = options.loci;
    if (model) {
      require_logs(*model, logs, options, context);
      loci.model = &*model;
    }
    if (!model && loci.frame == Frame::foot)
      fail(ErrorCode::usage,
           "--frame foot: the robot of the run is not known. Name the robot with --robot");
    write_loci(runs, options.output, loci);
    series = loci_series(loci);
  }
  context.print(options.output + ": " + text::join(series, ", ") + "\n");
  nlohmann::ordered_json json = {{"output", options.output}, {"series", series}};
  for (const LociRun& run : runs) json["runs"].push_back(run.label);
  context.print_json(json.dump(2));
}

}  // namespace

void add_plot(Command& app, Context& context) {
  auto options = std::make_shared<PlotOptions>();
  Command* command = app.add_subcommand("plot", "draw curves of COG, ZMP and ground force of runs");
  command->add_option("run", options->inputs, "Run folders or log files.")
      ->required()
      ->type_name("RUN");
  command->add_option("-o,--out", options->output, "File to write, .svg or .png.")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--log", options->logs,
                   "Draw only these logs of a run, for example closed_loop.")
      ->allow_extra_args(false);
  command->add_flag("--top", options->top, "Draw the ground from above with the footholds.");
  command
      ->add_option("--from", options->loci.begin,
                   "Time of the motion at which the curves begin [s].")
      ->capture_default_str();
  command->add_option("--to", options->loci.end,
                      "Time of the motion at which the curves end [s] (default: the end).");
  command->add_option("--title", options->loci.title, "Title of the picture.");
  command->add_option("--width", options->loci.width, "Width in pixels.")->capture_default_str();
  command
      ->add_option(
          "--frame", options->frame,
          "Reference frame of positions: world, or foot (the middle of the supporting sole).")
      ->check(one_of(frame_names()).description(""))
      ->capture_default_str();
  command->add_option("--robot", options->robot,
                      "Robot to use in place of the robot that the run names.");
  command->footer(
      "Examples:\n"
      "  ayumi plot out/ -o loci.svg            open loop, closed loop and command together\n"
      "  ayumi plot out/ --top -o from_above.png\n"
      "  ayumi plot before/ after/ --log closed_loop -o compare.svg");
  command->callback([options, &context] { plot(*options, context); });
}

}  // namespace ayumi::app
