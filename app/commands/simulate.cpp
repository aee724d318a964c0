// Runs one closed-loop simulation in Ayumi's own integrator under the pattern's scenario.

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "ayumi/base/text.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/run/run_output.hpp"
#include "ayumi/study/uncertain_task.hpp"
#include "ayumi/task/servo_table.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "simulation.hpp"
#include "streamed_run.hpp"
#include "uncertain_input.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

struct SimulateCommand {
  std::string pattern, out;
  PatternOptions input;
  SimulationChoice choice;
  std::string study;
  long number = -1;  // number of a case of `certify`; negative if there is none
};

// The file of the log while it is being made; empty if no run is written.
fs::path log_file(const std::optional<RunOutput>& output) {
  return output ? output->file(log_file_name("closed_loop")) : fs::path();
}

StreamedRun simulate_pattern_once(const Context& context, const Task& input,
                                  const SimulateCommand& options,
                                  const std::optional<RunOutput>& output) {
  return simulate_streamed(context, input, simulation_options(context, input, options.choice),
                           log_file(output), {.postures = output.has_value()});
}

struct SimulatedCase {
  StreamedRun run;
  std::string rows;  ///< the case in words, with one row for each kind of values
};

/// Simulates one case of `certify` with the robot, ground and pushes that it draws.
SimulatedCase simulate_case(const Context& context, const Task& input,
                            const SimulateCommand& options,
                            const std::optional<RunOutput>& output) {
  Study study = load_study(input, options.study);
  const bool stated = !options.study.empty() || !input.pattern.uncertainty.empty();
  context.print(fit_to_plant(study, input.robot, options.choice.plant, stated));
  const UncertainTask task(input.robot, input.series, study.uncertainty,
                           simulation_options(context, input, options.choice));
  const CaseNumbers numbers = task.numbers(context.seed, options.number);
  const std::vector<double> drawn = task.draw(numbers);
  task.check(drawn, "case " + std::to_string(options.number));
  const RobotUnit robot = task.unit(drawn);
  SimulateOptions simulate_options = task.options(numbers, drawn);
  simulate_options.unit = &robot;
  const std::vector<std::string> values = task.values_by_kind(drawn);
  const std::string words = "case " + std::to_string(options.number) + (values.empty() ? "" : ": ");
  return {.run = simulate_streamed(
              context, input, simulate_options, log_file(output),
              {.postures = output.has_value(),
               .first_events = {{0, EventKind::study_case, words + text::join(values, "; ")}}}),
          .rows = "  " + words + text::join(values, "\n    ") + "\n"};
}

RunFolder run_of(const Task& input, StreamedRun simulated) {
  RunFolder run;
  const WrittenLog& log = run.written["closed_loop"] = std::move(simulated.log);
  run.provenance = log.about.provenance;
  const Judgement judged = judge(input, check_options(input));
  run.sections.emplace_back("sampled_from", nlohmann::ordered_json(input.series.origin).dump());
  run.sections.emplace_back("check", check_json(judged.report));
  run.sections.emplace_back("simulate", simulation_json(log));
  run.unfit = unfit_reasons(judged, log.about);
  const bool pushed = !log.about.scenario.empty();
  (pushed ? run.pushed : run.reference) =
      table_of_postures(input.robot, input.profile, log.about, std::move(simulated.postures));
  (pushed ? run.pushed_caution : run.reference_caution) =
      table_caution(input, log.about, run.unfit);
  return run;
}

void simulate_pattern(Context& context, const SimulateCommand& options) {
  if (!options.study.empty() && options.number < 0)
    fail(ErrorCode::usage,
         "--study works only together with --case. Add --case N, or leave --study out");
  plant_of(options.choice.plant);  // a missing plant is refused before anything is computed
  if (!options.out.empty())
    require_run_target(
        options.out, context.force,
        {"run.json", "log_closed_loop.bin", "reference.csv", "reference_pushed.csv"});
  const Task input = load_pattern(context, options.pattern, options.input);
  refuse_unstable_gains(input, chosen_controller(input, options.choice), options.choice.unstable);
  // The output is opened after the input has been read, so that bad input leaves no files.
  std::optional<RunOutput> output;
  if (!options.out.empty()) output.emplace(options.out, context.force);
  SimulatedCase result =
      options.number < 0 ? SimulatedCase{simulate_pattern_once(context, input, options, output), ""}
                         : simulate_case(context, input, options, output);
  StreamedRun& simulated = result.run;
  const WrittenLog& log = simulated.log;
  context.print(options.pattern + ": " + outcome_text(log) + "\n");
  context.print(result.rows);
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(simulation_json(log));
  json["realtime_factor"] = static_cast<double>(log.rows) * log.about.dt / simulated.wall;
  context.exit_code = log.about.result.outcome == Outcome::stands ? 0 : 1;
  if (output) {
    const RunFolder run = run_of(input, std::move(simulated));
    write_run(output->folder(), run);
    output->deliver();
    for (const std::string& reason : run.unfit)
      context.print("  no table for a robot: " + reason + "\n");
    context.print("  written to " + options.out + "\n");
  }
  context.print_json(json.dump(2));
}

}  // namespace

void add_simulate(Command& app, Context& context) {
  Command* command = app.add_subcommand(
      "simulate", "simulate the robot with its controller and with disturbances");
  command->footer(
      "Examples:\n  ayumi simulate patterns/hoap1_walk.json -o out/walk\n"
      "  ayumi simulate walk.json --controller none --scenario none\n"
      "  ayumi simulate walk.json --profile hoap1-strong --gain ka=1 --json\n"
      "  ayumi simulate walk.json --study study.json --case 1234 -o out/case");
  auto options = std::make_shared<SimulateCommand>();
  command->add_option("PATTERN", options->pattern, "Pattern file.")->required();
  command->add_option("-o,--out", options->out, "Folder for the run.")->type_name("DIR");
  add_pattern_options(*command, options->input);
  add_simulation_options(*command, options->choice);
  add_noise_flag(*command, options->choice.noise);
  command
      ->add_option("--case", options->number,
                   "Simulate the case of `ayumi certify` that has this number.")
      ->check(whole_number_within(0, 1000000000).description(""))
      ->type_name("N");
  command
      ->add_option(
          "--study", options->study,
          "Study file with the uncertainty of the case (default: the uncertainty of the pattern, "
          "or of the robot if the pattern has none).")
      ->type_name("F");
  command->callback([options, &context] { simulate_pattern(context, *options); });
}

}  // namespace ayumi::app
