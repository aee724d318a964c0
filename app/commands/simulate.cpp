// One closed-loop run in Ayumi's own integrator under the pattern's scenario.

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
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
#include "uncertain_input.hpp"

namespace ayumi::app {

namespace {

struct SimulateCommand {
  std::string pattern, out;
  PatternOptions input;
  SimulationChoice choice;
  std::string study;
  long number = -1;  // of a case of `certify`; negative: none
};

/// One case of `certify`: the robot, ground and pushes that it draws.
SimulationLog simulate_case(const Context& context, const Task& input,
                            const SimulateCommand& options) {
  Study study = load_study(input, options.study);
  const bool stated = !options.study.empty() || !input.pattern.uncertainty.empty();
  context.print(fit_to_plant(study, options.choice.plant, stated));
  const UncertainTask task(input.robot, input.series, study.uncertainty,
                           simulation_options(context, input, options.choice));
  const CaseNumbers numbers = task.numbers(context.seed, options.number);
  const std::vector<double> drawn = task.draw(numbers);
  task.check(drawn, "case " + std::to_string(options.number));
  const RobotUnit robot = task.unit(drawn);
  SimulateOptions simulate_options = task.options(numbers, drawn);
  simulate_options.unit = &robot;
  SimulationLog log = simulate(input, simulate_options, context.progress(), context.command_line);
  std::string values;
  for (size_t i = 0; i < drawn.size(); ++i)
    values += (i == 0 ? ": " : ", ") + task.value_text(i, drawn[i]);
  log.events.insert(log.events.begin(),
                    {0, "case", "case " + std::to_string(options.number) + values});
  return log;
}

RunFolder run_of(const Task& input, SimulationLog simulated) {
  RunFolder run;
  const SimulationLog& log = run.logs["closed_loop"] = std::move(simulated);
  run.provenance = log.provenance;
  const Judgement judged = judge(input, check_options(input));
  run.sections.emplace_back("sampled_from", nlohmann::ordered_json(input.series.origin).dump());
  run.sections.emplace_back("check", check_json(judged.report));
  run.sections.emplace_back("simulate", simulation_json(log));
  run.unfit = unfit_reasons(judged, log);
  const bool pushed = !log.scenario.empty();
  (pushed ? run.pushed : run.reference) =
      table_of_log(input.robot, input.profile, log, ServoContent::lead);
  (pushed ? run.pushed_caution : run.reference_caution) = table_caution(input, log, run.unfit);
  return run;
}

void simulate_pattern(Context& context, const SimulateCommand& options) {
  if (!options.study.empty() && options.number < 0)
    fail(ErrorCode::usage,
         "--study works only together with --case; add --case N, or leave --study out");
  plant_of(options.choice.plant);  // a missing plant is refused before anything is computed
  if (!options.out.empty())
    require_run_target(
        options.out, context.force,
        {"run.json", "log_closed_loop.bin", "reference.csv", "reference_pushed.csv"});
  const Task input = load_pattern(context, options.pattern, options.input);
  const auto begin = std::chrono::steady_clock::now();
  SimulationLog log = options.number < 0 ? simulate_once(context, input, options.choice)
                                         : simulate_case(context, input, options);
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  context.print(options.pattern + ": " + outcome_text(log) + "\n");
  if (options.number >= 0) context.print("  " + log.events.front().text + "\n");
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(simulation_json(log));
  json["realtime_factor"] = static_cast<double>(log.samples.size()) * log.dt / wall;
  context.exit_code = log.result.outcome == Outcome::stands ? 0 : 1;
  if (!options.out.empty()) {
    const RunFolder run = run_of(input, std::move(log));
    RunOutput output(options.out, context.force);
    write_run(output.folder(), run);
    output.deliver();
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
