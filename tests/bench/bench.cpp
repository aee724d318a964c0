// Usage: ayumi_bench [--rounds N] [--only JOB] [--list] [--count JOB WHO CALLS] [--closed-loop]
//   --only         runs only this job
//   --count        calls one kernel this many times and does nothing else, for callgrind
//   --closed-loop  runs plant and controller on the walking pattern instead of kernels
#include "tests/bench/bench.hpp"

#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>

#include "ayumi/io/robot/robot_file.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi::bench {

Problem::Problem(const RobotModel& robot, int count) : model(&robot) {
  test::Random random(1);
  for (int i = 0; i < count; ++i) {
    states.push_back(test::random_state(robot, random));
    accelerations.push_back(random.vector(robot.velocity_count(), 5.0));
    forces.push_back(random.vector(robot.velocity_count(), 2.0));
  }
}

double disagreement(const Kernels& kernels, const Kernel& kernel, const Problem& problem) {
  const auto first = std::find_if(kernels.begin(), kernels.end(), [&](const Kernel& other) {
    return other.job == kernel.job && other.result;
  });
  if (first == kernels.end() || !kernel.result || &*first == &kernel) return -1;
  double worst = 0;
  for (size_t i = 0; i < std::min<size_t>(16, problem.states.size()); ++i) {
    const Eigen::VectorXd expected = first->result(i);
    worst = std::max(worst, (kernel.result(i) - expected).norm() / expected.norm());
  }
  return worst;
}

namespace {

/// The processor time of this thread [ns], which does not include the time of other programs.
double now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// The median over passes through all states [ns per state].
double one_round(const Kernel& kernel, const Problem& problem, double seconds) {
  const size_t count = problem.states.size() / static_cast<size_t>(kernel.states_per_call);
  std::vector<double> times;
  const double begin = now();
  do {
    const double start = now();
    for (size_t i = 0; i < count; ++i) kernel.run(i);
    times.push_back((now() - start) / static_cast<double>(problem.states.size()));
  } while (now() - begin < 1e9 * seconds || times.size() < 5);
  return median(times);
}

}  // namespace

std::vector<double> measure(const Kernels& kernels, const Problem& problem, int rounds,
                            double seconds_per_round) {
  std::vector<std::vector<double>> all(kernels.size());
  for (int round = 0; round < rounds; ++round)
    for (size_t k = 0; k < kernels.size(); ++k)
      all[k].push_back(one_round(kernels[k], problem, seconds_per_round));
  std::vector<double> result;
  for (const std::vector<double>& times : all) result.push_back(median(times));
  return result;
}

namespace {

Kernels all_kernels(const Problem& problem) {
  Kernels all = ayumi_kernels(problem);
  for (auto* find : {mujoco_kernels, dart_kernels, bullet_kernels, pinocchio_kernels, rbdl_kernels})
    for (Kernel& kernel : find(problem)) all.push_back(std::move(kernel));
  for (Kernel& kernel : tick_kernels()) all.push_back(std::move(kernel));
  return all;
}

/// Joint torques, masses and so on must be equal before it makes sense to compare times.
bool check_agreement(const Kernels& kernels, const Problem& problem) {
  bool good = true;
  for (const Kernel& kernel : kernels) {
    const double difference = disagreement(kernels, kernel, problem);
    if (difference < 0) continue;
    const bool agrees = difference < 1e-9;
    good &= agrees;
    std::printf("%-28s %-16s differs by %.1e%s\n", kernel.job.c_str(), kernel.who.c_str(),
                difference, agrees ? "" : "  NOT THE SAME ROBOT");
  }
  return good;
}

void print_table(const Kernels& kernels, const std::vector<double>& times) {
  std::printf("\n%-28s %-16s %10s %8s\n", "job", "library", "ns/state", "ratio");
  std::set<std::string> done;
  for (const Kernel& job : kernels) {
    if (!done.insert(job.job).second) continue;
    double ours = 0;
    for (size_t k = 0; k < kernels.size(); ++k) {
      if (kernels[k].job != job.job) continue;
      if (ours == 0) ours = times[k];
      std::printf("%-28s %-16s %10.0f %8.2f  %s\n", job.job.c_str(), kernels[k].who.c_str(),
                  times[k], times[k] / ours, kernels[k].note.c_str());
    }
  }
}

int count_calls(const Kernels& kernels, const Problem& problem, const std::string& job,
                const std::string& who, long calls) {
  for (const Kernel& kernel : kernels) {
    if (kernel.job != job || kernel.who != who) continue;
    const size_t count = problem.states.size() / static_cast<size_t>(kernel.states_per_call);
    for (long i = 0; i < calls; ++i) kernel.run(static_cast<size_t>(i) % count);
    return 0;
  }
  std::fprintf(stderr, "no kernel '%s' of '%s'; see --list\n", job.c_str(), who.c_str());
  return 2;
}

int usage() {
  std::fprintf(stderr,
               "usage: ayumi_bench [--rounds N] [--only JOB] [--list] [--count JOB WHO CALLS]\n"
               "                   [--closed-loop]\n");
  return 2;
}

}  // namespace

int run(int argc, char** argv) {
  int rounds = 5;
  std::string only;
  bool list = false, closed_loop = false;
  const char* count[3] = {};
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--rounds" && i + 1 < argc)
      rounds = std::atoi(argv[++i]);
    else if (option == "--only" && i + 1 < argc)
      only = argv[++i];
    else if (option == "--list")
      list = true;
    else if (option == "--closed-loop")
      closed_loop = true;
    else if (option == "--count" && i + 3 < argc)
      for (const char*& each : count) each = argv[++i];
    else
      return usage();
  }
  if (rounds < 1) return usage();
  if (closed_loop) return run_closed_loop(rounds);
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  const Problem problem(model, 128);
  Kernels kernels = all_kernels(problem);
  if (!only.empty())
    std::erase_if(kernels, [&](const Kernel& kernel) { return kernel.job != only; });
  if (list) {
    for (const Kernel& kernel : kernels)
      std::printf("%s\t%s\t%d\n", kernel.job.c_str(), kernel.who.c_str(), kernel.states_per_call);
    return 0;
  }
  if (count[0]) return count_calls(kernels, problem, count[0], count[1], std::atol(count[2]));
  if (!check_agreement(kernels, problem)) return 1;
  print_table(kernels, measure(kernels, problem, rounds, 0.05));
  return 0;
}

}  // namespace ayumi::bench

int main(int argc, char** argv) { return ayumi::bench::run(argc, argv); }
