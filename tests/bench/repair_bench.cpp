// Repairs of HOAP-1 walks with faults in every step, measured: size of the program, iterations,
// seconds in functions and in the linear algebra of Ipopt, peak memory of the process.

#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <string>

#include "ayumi/io/robot_file.hpp"
#include "ayumi/optimize/repair.hpp"
#include "ayumi/pattern/generate.hpp"
#include "ayumi/pattern/sample.hpp"

using namespace ayumi;

namespace {

// Knees that may bend two degrees less than the walk bends them.
RobotModel tight_knees(const RobotDescription& robot, const CommandSeries& series) {
  RobotDescription d = robot;
  const RobotModel model(d);
  for (JointDescription& joint : d.joints) {
    if (!joint.name.ends_with("_knee")) continue;
    joint.upper = 0;
    for (const CommandSample& s : series.samples)
      joint.upper = std::max(joint.upper, s.state.theta[model.find_dof(joint.name)]);
    joint.upper -= 2 * EIGEN_PI / 180;
  }
  return RobotModel(d);
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void measure(const char* name, const RobotModel& model, const CommandSeries& series,
             RepairOptions options, bool mumps = false) {
  options.mumps = mumps;
  const auto begin = std::chrono::steady_clock::now();
  const RepairResult r = repair(model, series, options);
  const double wall = seconds_since(begin);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const RepairWork& w = r.work;
  std::printf(
      "%-24s %5.2f s walk  %-10s %d rounds  %5d variables %5d constraints %7d nonzeros J %6d H  "
      "%3d iterations  functions %5.2f s  linear algebra %5.2f s  check and the rest %5.2f s  "
      "together %5.2f s  violation %.1e  peak %4ld MB\n",
      name, series.duration(), name_of(r.status), w.rounds, w.variables, w.constraints,
      w.jacobian_nonzeros, w.hessian_nonzeros, w.iterations, w.function_seconds, w.solver_seconds,
      wall - w.function_seconds - w.solver_seconds, wall, r.constraint_violation,
      usage.ru_maxrss / 1024);
  std::fflush(stdout);
}

CommandSeries walk_of(const RobotModel& model, int steps) {
  WalkParameters options;
  options.steps = steps;
  return sample(model, walk_pattern(model, options));
}

}  // namespace

int main(int count, char** arguments) {
  const RobotDescription robot = load_robot_description(AYUMI_SOURCE_DIR "/robots/hoap1");
  const RobotModel model(robot);
  const bool mumps = count > 1 && std::string(arguments[1]) == "mumps";
  for (const int steps : {3, 8, 13}) {
    const CommandSeries series = walk_of(model, steps);
    measure("knees bend less", tight_knees(robot, series), series, {}, mumps);
  }
  RepairOptions slippery;
  slippery.check.friction = 0.1;
  for (const int steps : {3, 8, 13})
    measure("friction 0.10", model, walk_of(model, steps), slippery, mumps);
}
