// One HTML page of a run.

#include <filesystem>
#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "report_input.hpp"
#include "run_robot.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

struct ReportCommand {
  std::string input, output, robot, push, frame = "world";
  ReportOptions report;
  double max_megabytes = 8;
  bool no_replay = false;
};

void report_run(ReportCommand options, Context& context) {
  if (fs::path(options.output).extension() != ".html")
    fail(ErrorCode::usage, "--out " + options.output + ": the name must end in .html");
  refuse_overwriting(context, options.output);
  if (!is_run_folder(options.input))
    fail(ErrorCode::bad_file, {options.input},
         "this is not a RUN (a folder that `ayumi run` or `ayumi simulate` wrote)");
  if (!(options.max_megabytes > 0) || options.max_megabytes > 1000)
    fail(ErrorCode::usage, "--max-size: the size must be above 0 and at most 1000 MB");
  options.report.max_bytes = static_cast<size_t>(1e6 * options.max_megabytes);
  options.report.replay = !options.no_replay;
  options.report.frame = frame_of(options.frame);
  const RunFolder run = read_run(options.input);
  ReportInput input = report_input(run, options.input);
  const std::string push =
      options.push.empty() ? (fs::path(options.input) / "push.json").string() : options.push;
  if (!options.push.empty() || fs::exists(push)) input.thresholds = read_push_thresholds(push);
  const RobotModel model =
      robot_of_run(context, options.robot, run.provenance.robot, {.meshes = true});
  for (const auto& [name, log] : run.logs)
    require_log_of(model, options.robot, log, options.input + ", " + name);
  const Report made = make_report(model, input, options.report, context.progress());
  write_file(options.output, made.html);
  context.print(options.output + ": " + std::to_string(made.html.size() / 1000) + " kB\n");
  for (const std::string& cap : made.caps) context.print("  " + cap + "\n");
  const nlohmann::ordered_json json = {
      {"output", options.output}, {"bytes", made.html.size()}, {"caps", made.caps}};
  context.print_json(json.dump(2));
}

}  // namespace

void add_report(Command& app, Context& context) {
  auto options = std::make_shared<ReportCommand>();
  Command* command =
      app.add_subcommand("report", "write one HTML page of a run with verdict, replay and curves");
  command->add_option("run", options->input, "Folder that run or simulate wrote.")
      ->required()
      ->type_name("RUN");
  command->add_option("-o,--out", options->output, "Page to write (.html).")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--push", options->push,
                   "Results file of ayumi push (default: push.json in RUN, if it exists).")
      ->type_name("FILE");
  command->add_option("--robot", options->robot,
                      "Robot to use in place of the robot that the run names.");
  command->add_option("--max-size", options->max_megabytes, "Largest size of the page [MB].")
      ->capture_default_str();
  command->add_option("--rate", options->report.rate, "Postures per second of the replay.")
      ->check(number_within(1.0, 1000.0))
      ->capture_default_str();
  command
      ->add_option(
          "--frame", options->frame,
          "Reference frame of curves and replay: world, or foot (the supporting foot stands "
          "still).")
      ->check(one_of(frame_names()).description(""))
      ->capture_default_str();
  command->add_flag("--no-replay", options->no_replay, "Write the page without the replay.");
  command->footer(
      "Examples:\n"
      "  ayumi report out/ -o out/report.html\n"
      "  ayumi report out/ --push thresholds.json --max-size 3 -o small.html");
  command->callback([options, &context] { report_run(*options, context); });
}

}  // namespace ayumi::app
