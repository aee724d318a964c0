// push_and_export PATTERN ROBOTS TABLE: checks a pattern, pushes the robot while it moves, and
// writes the joint table of the run without the push, if the robot survives it.
#include <ayumi/ayumi.hpp>

int main(int argc, char** argv) try {
  if (argc != 4) return std::cerr << "usage: push_and_export PATTERN ROBOTS TABLE\n", 2;
  const ayumi::Task task = ayumi::load_task(argv[1], {.robots = {{argv[2]}}});
  const ayumi::Judgement judgement = ayumi::judge(task);
  std::cout << task.pattern.name << " on " << task.robot.name() << ": "
            << (judgement.good() ? "consistent" : judgement.reason()) << "\n";

  ayumi::SimulateOptions options = ayumi::simulate_options(task);
  options.scenario = {{.at = 2.0, .duration = 0.02, .what = ayumi::Push{.magnitude = 0.8}}};
  const ayumi::SimulationLog pushed = ayumi::simulate(task, options);
  std::cout << "pushed forwards with 0.8 N s: " << ayumi::name_of(pushed.result.outcome) << "\n";
  if (!ayumi::unfit_reasons(judgement, pushed).empty()) return 1;

  options.scenario.clear();
  const ayumi::SimulationLog log = ayumi::simulate(task, options);
  const ayumi::SafeTable safe = ayumi::make_safe(
      task.robot, ayumi::extract_reference(task.robot, log), ayumi::safety_options(task));
  if (!safe.report.safe) return std::cerr << text_of(safe.report.violations.front()) << "\n", 1;
  ayumi::write_file(argv[3], ayumi::reference_csv(safe.table));
} catch (const ayumi::Error& error) {
  return std::cerr << error.what() << "\n", 3;
}
