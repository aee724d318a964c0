// Plant, sensors, estimator and controller on the walking pattern at 1 kHz on one core. The physics
// of the run is printed beside its speed: a fast step in which the robot sinks or slips is no gain.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <numeric>
#include <optional>

#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "ayumi/sim/simulator.hpp"
#include "tests/bench/bench.hpp"
#ifdef BENCH_HAS_MUJOCO
#include "ayumi/sim/plant_mujoco/mujoco_plant.hpp"
#endif

namespace ayumi::bench {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kStiff = 1e7;  // stiffness of a sole [N/m]

/// A plant of any kind that records how long each of its steps took [us].
struct TimedPlant {
  PlantInterface inner;
  std::shared_ptr<double> step_time;
  const RobotState& state() const { return inner.state(); }
  const RobotData& data() const { return inner.data(); }
  void set_state(const RobotState& state) { inner.set_state(state); }
  const StepReport& step(const Eigen::VectorXd& targets, const StepInput& input, double dt) {
    const auto start = Clock::now();
    const StepReport& report = inner.step(targets, input, dt);
    *step_time = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
    return report;
  }
};

/// The run is the same in every round, so that the shortest time of each tick is the time that it
/// takes when nothing disturbs it.
struct Contender {
  std::string name;
  PlantKind kind;
  const RobotModel* model;
  std::vector<double> loop = {}, plant = {};  ///< shortest time of each tick [us]
  SimulationLog log = {};
};

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void keep_least(std::vector<double>& times, size_t tick, double time) {
  if (tick == times.size()) times.push_back(time);
  times[tick] = std::min(times[tick], time);
}

void run_once(const CommandSeries& series, SimulateOptions options, Contender& contender) {
  const auto step_time = std::make_shared<double>(0);
  const PlantKind kind = contender.kind;
  options.plant.name = kind.name;
  options.plant.make = [kind, step_time](const RobotModel& robot, const ActuatorLimits& limits,
                                         const World& world) {
    return PlantInterface(TimedPlant{
        kind.make ? kind.make(robot, limits, world) : PlantInterface(Plant(robot, limits, world)),
        step_time});
  };
  Simulator simulator(*contender.model, series, options);
  bool goes_on = true;
  for (size_t tick = 0; goes_on; ++tick) {
    const auto start = Clock::now();
    goes_on = simulator.advance(1);
    const double time = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
    keep_least(contender.loop, tick, time);
    keep_least(contender.plant, tick, *step_time);
  }
  contender.log = simulator.take_log();
}

void report(const Contender& c, const Contender& ours, double dt) {
  const double loop = mean(c.loop), plant = mean(c.plant);
  double residual = 0;
  for (const SimulationSample& sample : c.log.samples)
    residual = std::max(residual, sample.contact_residual);
  const SimulationResult& r = c.log.result;
  std::printf(
      "%-24s %9.2f %9.2f %8.1fx %7.2f %7.2f   %s, penetration %.3f mm, slip %.2f mm, "
      "residual %.0e m/s, COG at the end %.2f mm off\n",
      c.name.c_str(), loop, plant, 1e6 * dt / loop, loop / mean(ours.loop),
      plant / mean(ours.plant), name_of(r.outcome), 1e3 * r.max_penetration, 1e3 * r.max_slip,
      residual, 1e3 * r.final_cog_error);
}

/// The walk in a closed loop.
struct Walk {
  Walk() {
    options.controller = pattern.controller;
    options.world = pattern.world;
  }
  RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  Pattern pattern = read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json");
  CommandSeries series = sample(model, pattern);
  SimulateOptions options;
};

/// The robot with every form of servo at every joint, as in the servos of small humanoids.
RobotModel with_every_servo_form(const RobotModel& model) {
  RobotDescription robot = model.description();
  for (auto& [joint, servo] : robot.servos) {
    servo.delay = 0.0037;
    servo.speed_command_limit = 30;
    servo.viscous = 0.01;
    servo.coulomb = 0.03;
    servo.stribeck_torque = 0.02;
    servo.stribeck_rate = 0.1;
    servo.stribeck_exponent = 1.4;
    servo.load = {0.02, 0.04, 0.01, 0.02, 0.001, 0.001};
    servo.backlash = 0.001;
    servo.stall_torque = 10;
    servo.back_emf = 0.3;
    servo.dead_band = 2e-4;
    servo.quantized = true;
    servo.offset = 1e-3;
  }
  return RobotModel(robot);
}

Kernel tick_of(const std::string& name, const PlantKind& kind) {
  struct Run : Walk {
    std::optional<Simulator> simulator;
  };
  const auto made = std::make_shared<std::optional<Run>>();  // the run is made at its first use
  return {"walking tick",
          name,
          "closed loop, without the log",
          [made, kind](size_t) {
            if (!*made) made->emplace().options.plant = kind;
            Run* run = &**made;
            if (run->simulator && run->simulator->advance(1)) return;
            run->simulator.emplace(run->model, run->series, run->options);
            run->simulator->keep_samples(false);
          },
          {}};
}

}  // namespace

Kernels tick_kernels() {
  Kernels kernels = {tick_of("Ayumi", {})};
#ifdef BENCH_HAS_MUJOCO
  kernels.push_back(tick_of("MuJoCo", mujoco_plant_kind(1)));
#endif
  return kernels;
}

int run_closed_loop(int rounds) {
  const Walk walk;
  // MuJoCo's contacts are as soft as its time step allows, whatever the sole is; Ayumi's may be
  // stiff.
  RobotDescription stiff_soles = walk.model.description();
  for (auto& [side, sole] : stiff_soles.soles) sole.stiffness = kStiff;
  const RobotModel stiff(stiff_soles);
  std::vector<Contender> contenders;
  contenders.push_back({"Ayumi", {}, &walk.model});
  contenders.push_back({"Ayumi, stiff soles", {}, &stiff});
  const RobotModel servos = with_every_servo_form(walk.model);
  contenders.push_back({"Ayumi, all servo forms", {}, &servos});
#ifdef BENCH_HAS_MUJOCO
  contenders.push_back({"MuJoCo, one step of 1 ms", mujoco_plant_kind(1), &walk.model});
  contenders.push_back({"MuJoCo", mujoco_plant_kind(), &walk.model});
#endif
  for (int round = 0; round < rounds; ++round)
    for (Contender& each : contenders) run_once(walk.series, walk.options, each);
  std::printf("hoap1_walk.json with its controller, least time of each step in %d rounds\n",
              rounds);
  std::printf("%-24s %9s %9s %9s %7s %7s\n", "plant", "loop us", "plant us", "real time", "loop",
              "plant");
  for (const Contender& each : contenders) report(each, contenders.front(), walk.series.dt);
  return 0;
}

}  // namespace ayumi::bench
