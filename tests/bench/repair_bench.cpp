// Measures repairs of HOAP-1 walks with faults in every step: size of the program, iterations,
// seconds in the functions of the program and in the linear algebra of Ipopt, and peak memory of
// the process. The same repair by MUMPS follows at once (processor time), with the ratio of the
// times that the linear algebra of an iteration takes with MUMPS and without it. The first argument
// is the number of rounds (default 2); the figures are those of the quickest round. A second
// argument is the number of steps of the longest walk (13). At the end, or alone if the first
// argument is "check", the check of a walk of 10 s at 1 kHz is measured by parts.

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/demand/collision_scan.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/repair/repair.hpp"

using namespace ayumi;

namespace {

// A robot whose knees may bend two degrees less than the walk bends them.
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

// The processor time of all threads of the process [s].
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Measured {
  RepairResult result;
  std::vector<int> programs;  // number of iterations of each
  double all = 0, wall = 0;   // processor time and elapsed time [s]
};

double wall_seconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

void keep_quicker(Measured& best, const RobotModel& model, const CommandSeries& series,
                  const RepairOptions& options) {
  std::vector<int> programs;
  auto count = [&programs](const ProgressEvent& event) {
    if (event.fraction == 0) programs.push_back(-1);
    ++programs.back();
    return true;
  };
  const double begin = processor_seconds(), wall_begin = wall_seconds();
  RepairResult r = repair(model, series, options, count);
  const double all = processor_seconds() - begin, wall = wall_seconds() - wall_begin;
  if (best.all > 0 && best.result.work.solver_seconds <= r.work.solver_seconds) return;
  best.result = std::move(r);
  best.programs = programs;
  best.all = all;
  best.wall = wall;
}

double milliseconds_each(const RepairWork& work) {
  return 1e3 * work.solver_seconds / std::max(1, work.iterations);
}

std::string listed(const std::vector<int>& numbers) {
  std::string list;
  for (const int n : numbers) list += (list.empty() ? "" : " + ") + std::to_string(n);
  return list;
}

void measure(const char* name, const RobotModel& model, const CommandSeries& series,
             RepairOptions options, int rounds) {
  Measured own, other;
  for (int i = 0; i < rounds; ++i) {
    options.mumps = false;
    keep_quicker(own, model, series, options);
    options.mumps = true;
    keep_quicker(other, model, series, options);
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const RepairResult& r = own.result;
  const RepairWork &w = r.work, &m = other.result.work;
  std::printf(
      "%-16s %5.2f s walk  %-10s %d rounds  %5d variables %5d constraints %7d nonzeros J %6d H  "
      "%3d iterations (%s)  functions %5.2f s  linear algebra %5.2f s  check and the rest %5.2f s  "
      "together %5.2f s (on the clock %5.2f s)  violation %.1e  peak %4ld MB\n"
      "    with MUMPS: %d iterations, linear algebra %.2f s, together %.2f s; an iteration's "
      "linear "
      "algebra %.1f ms, here %.2f ms, ratio %.2f\n",
      name, series.duration(), name_of(r.status), w.rounds, w.variables, w.constraints,
      w.jacobian_nonzeros, w.hessian_nonzeros, w.iterations, listed(own.programs).c_str(),
      w.function_seconds, w.solver_seconds, own.all - w.function_seconds - w.solver_seconds,
      own.all, own.wall, r.constraint_violation, usage.ru_maxrss / 1024, m.iterations,
      m.solver_seconds, other.all, milliseconds_each(m), milliseconds_each(w),
      milliseconds_each(m) / milliseconds_each(w));
  std::fflush(stdout);
}

// The smallest processor time of several runs [ms].
template <class Work>
double quickest(const Work& work) {
  double best = 1e9;
  for (int i = 0; i < 9; ++i) {
    const double begin = processor_seconds();
    work();
    best = std::min(best, 1e3 * (processor_seconds() - begin));
  }
  return best;
}

void measure_check(const RobotModel& model) {
  WalkParameters options;
  options.steps = 13;
  const Pattern walk = walk_pattern(model, options);
  const CommandSeries series = sample(model, walk);
  const CollisionModel collisions(model);
  RobotData data(model);
  const double dynamics = quickest([&] {
    for (const CommandSample& s : series.samples)
      inverse_dynamics(model, s.state, s.acceleration, data);
  });
  const double clearances = quickest(
      [&] { scan_clearance(model, series, collisions, 0.010, 0.002, [](int, int, double) {}); });
  const double all = quickest([&] { check_consistency(model, series); });
  const double sampled = quickest([&] { sample(model, walk); });
  std::printf(
      "check of a walk of %.2f s at 1 kHz: %.1f ms, of which dynamics %.1f ms, clearances %.1f ms; "
      "the motion sampled from its keyframes before that %.1f ms\n",
      series.duration(), all, dynamics, clearances, sampled);
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
  if (count > 1 && std::string(arguments[1]) == "check") {
    measure_check(model);
    return 0;
  }
  const int rounds = count > 1 ? std::max(1, std::atoi(arguments[1])) : 2;
  const int most = count > 2 ? std::atoi(arguments[2]) : 13;
  for (const int steps : {3, 8, 13}) {
    if (steps > most) continue;
    const CommandSeries series = walk_of(model, steps);
    measure("knees bend less", tight_knees(robot, series), series, {}, rounds);
  }
  RepairOptions slippery;
  slippery.check.friction = 0.1;
  for (const int steps : {3, 8, 13})
    if (steps <= most) measure("friction 0.10", model, walk_of(model, steps), slippery, rounds);
  measure_check(model);
}
