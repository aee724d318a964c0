// One closed-loop run in Ayumi's own integrator under the pattern's scenario.

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "ayumi/base/text.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/run/run_output.hpp"
#include "ayumi/task/servo_table.hpp"
#include "pattern_input.hpp"
#include "simulation.hpp"

namespace ayumi::app {

namespace {

struct SimulateCommand {
  std::string pattern, out;
  PatternOptions input;
  SimulationChoice choice;
};

RunFolder run_of(const Task& input, const SimulationLog& log) {
  RunFolder run;
  run.provenance = log.provenance;
  run.logs["closed_loop"] = log;
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
  plant_of(options.choice.plant);  // a missing plant is refused before anything is computed
  if (!options.out.empty())
    require_run_target(
        options.out, context.force,
        {"run.json", "log_closed_loop.bin", "reference.csv", "reference_pushed.csv"});
  const Task input = load_pattern(context, options.pattern, options.input);
  const auto begin = std::chrono::steady_clock::now();
  const SimulationLog log = simulate_once(context, input, options.choice);
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  context.print(options.pattern + ": " + outcome_text(log) + "\n");
  if (!options.out.empty()) {
    const RunFolder run = run_of(input, log);
    RunOutput output(options.out, context.force);
    write_run(output.folder(), run);
    output.deliver();
    for (const std::string& reason : run.unfit)
      context.print("  no table for a robot: " + reason + "\n");
    context.print("  written to " + options.out + "\n");
  }
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(simulation_json(log));
  json["realtime_factor"] = static_cast<double>(log.samples.size()) * log.dt / wall;
  context.print_json(json.dump(2));
  context.exit_code = log.result.outcome == Outcome::stands ? 0 : 1;
}

}  // namespace

void add_simulate(CLI::App& app, Context& context) {
  CLI::App* command = app.add_subcommand(
      "simulate", "simulate the robot with its controller and with disturbances");
  command->footer(
      "Examples:\n  ayumi simulate patterns/hoap1_walk.json -o out/walk\n"
      "  ayumi simulate walk.json --controller none --scenario none\n"
      "  ayumi simulate walk.json --profile hoap1-strong --gain ka=1 --json");
  auto options = std::make_shared<SimulateCommand>();
  command->add_option("PATTERN", options->pattern, "Pattern file.")->required();
  command->add_option("-o,--out", options->out, "Folder for the run.")->type_name("DIR");
  add_pattern_options(*command, options->input);
  add_simulation_options(*command, options->choice);
  command->callback([options, &context] { simulate_pattern(context, *options); });
}

}  // namespace ayumi::app
