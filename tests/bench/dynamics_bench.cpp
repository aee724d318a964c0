// Kernels of the dynamics on HOAP-1, one state per call, beside MuJoCo's of the same job where it
// is installed. Single runs drift on a shared machine: compare with --benchmark_repetitions=5
// --benchmark_enable_random_interleaving=true and take medians.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot_file.hpp"
#include "tests/support/random_robot.hpp"
#ifdef AYUMI_HAS_MUJOCO
#include "tests/support/mujoco_model.hpp"
#endif

namespace ayumi {
namespace {

/// HOAP-1 in 128 random states, gone through in turn.
struct Fixture {
  Fixture() : model(load_robot(AYUMI_SOURCE_DIR "/robots/hoap1/robot.json")), data(model) {
    test::Random random(1);
    for (int i = 0; i < 128; ++i) {
      states.push_back(test::random_state(model, random));
      accelerations.push_back(random.vector(model.velocity_count(), 5.0));
    }
  }
  size_t next() { return index = (index + 1) % states.size(); }

  RobotModel model;
  RobotData data;
  std::vector<RobotState> states;
  std::vector<Eigen::VectorXd> accelerations;
  size_t index = 0;
};

void rnea(benchmark::State& run) {
  Fixture f;
  for (auto _ : run) {
    const size_t i = f.next();
    benchmark::DoNotOptimize(
        inverse_dynamics(f.model, f.states[i], f.accelerations[i], f.data).eval());
  }
}
BENCHMARK(rnea);

void crba(benchmark::State& run) {
  Fixture f;
  Eigen::MatrixXd M;
  for (auto _ : run) {
    update_positions(f.model, f.states[f.next()], f.data);
    mass_matrix(f.model, f.data, M);
    benchmark::DoNotOptimize(M.data());
  }
}
BENCHMARK(crba);

void forward(benchmark::State& run) {
  Fixture f;
  const Eigen::VectorXd force = Eigen::VectorXd::Zero(f.model.velocity_count());
  for (auto _ : run)
    benchmark::DoNotOptimize(forward_dynamics(f.model, f.states[f.next()], force, f.data).eval());
}
BENCHMARK(forward);

void cog(benchmark::State& run) {
  Fixture f;
  for (auto _ : run) {
    update_positions(f.model, f.states[f.next()], f.data);
    benchmark::DoNotOptimize(cog_jacobian(f.model, f.data, Side::left).eval());
  }
}
BENCHMARK(cog)->Name("cog_jacobian");

void derivatives(benchmark::State& run) {
  Fixture f;
  InverseDynamicsDerivatives result;
  for (auto _ : run) {
    const size_t i = f.next();
    inverse_dynamics_derivatives(f.model, f.states[i], f.accelerations[i], f.data, result);
    benchmark::DoNotOptimize(result.configuration.data());
  }
}
BENCHMARK(derivatives)->Name("rnea_derivatives");

#ifdef AYUMI_HAS_MUJOCO

/// MuJoCo's copy of the robot, ready to be put into the same states.
struct MujocoFixture : Fixture {
  MujocoFixture() : robot(test::MujocoRobot::from_model(model)) {
    for (const RobotState& state : states) {
      robot.set_state(state);
      positions.emplace_back(robot.data()->qpos, robot.data()->qpos + robot.model()->nq);
      velocities.emplace_back(robot.data()->qvel, robot.data()->qvel + robot.model()->nv);
    }
  }
  /// The kinematics that every kernel of MuJoCo starts from.
  void load_next() {
    const size_t i = next();
    std::copy(positions[i].begin(), positions[i].end(), robot.data()->qpos);
    std::copy(velocities[i].begin(), velocities[i].end(), robot.data()->qvel);
    mj_kinematics(robot.model(), robot.data());
    mj_comPos(robot.model(), robot.data());
  }
  test::MujocoRobot robot;
  std::vector<std::vector<double>> positions, velocities;
};

void mujoco_rnea(benchmark::State& run) {
  MujocoFixture f;
  std::vector<double> force(static_cast<size_t>(f.robot.model()->nv));
  for (auto _ : run) {
    f.load_next();
    mj_comVel(f.robot.model(), f.robot.data());
    mj_rne(f.robot.model(), f.robot.data(), 1, force.data());
    benchmark::DoNotOptimize(force.data());
  }
}
BENCHMARK(mujoco_rnea);

void mujoco_crba(benchmark::State& run) {
  MujocoFixture f;
  for (auto _ : run) {
    f.load_next();
    mj_crb(f.robot.model(), f.robot.data());
    benchmark::DoNotOptimize(f.robot.data()->qM);
  }
}
BENCHMARK(mujoco_crba);

void mujoco_cog(benchmark::State& run) {
  MujocoFixture f;
  std::vector<double> jacobian(static_cast<size_t>(3 * f.robot.model()->nv));
  for (auto _ : run) {
    f.load_next();
    mj_jacSubtreeCom(f.robot.model(), f.robot.data(), jacobian.data(), 1);
    benchmark::DoNotOptimize(jacobian.data());
  }
}
BENCHMARK(mujoco_cog)->Name("mujoco_cog_jacobian");

#endif

/// The usual table, then how many times faster than MuJoCo each kernel is.
class RatioReporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      const bool median = run.run_type == Run::RT_Aggregate && run.aggregate_name == "median";
      if (median ||
          (run.run_type == Run::RT_Iteration && !run.error_occurred && run.repetitions < 2))
        times_[run.run_name.function_name] = run.GetAdjustedCPUTime();
    }
    ConsoleReporter::ReportRuns(runs);
  }
  void print_ratios() const {
    for (const auto& [name, time] : times_)
      if (const auto peer = times_.find("mujoco_" + name); peer != times_.end())
        std::printf("MuJoCo / Ayumi, %-14s %.2f\n", name.c_str(), peer->second / time);
  }

 private:
  std::map<std::string, double> times_;
};

}  // namespace
}  // namespace ayumi

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  ayumi::RatioReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  reporter.print_ratios();
}
