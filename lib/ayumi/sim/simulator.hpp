#pragma once
// One run in progress: plant, sensors, estimator, controller and judge advanced tick by tick. A
// copy is a branch: it goes on from the same state to the last bit, so that many pushes can share
// the way up to the push. simulate() is a Simulator run to its end.

#include <set>

#include "ayumi/base/progress.hpp"
#include "ayumi/control/controller.hpp"
#include "ayumi/sim/plant_interface.hpp"
#include "ayumi/sim/schedule.hpp"
#include "ayumi/sim/sensors.hpp"
#include "ayumi/sim/simulate.hpp"
#include "ayumi/sim/verdict.hpp"

namespace ayumi {

class Simulator {
 public:
  /// The servos have held the first posture for a moment; the next tick is 0. Model and series must
  /// outlive the simulator and its copies. Throws as simulate() does.
  Simulator(const RobotModel& model, const CommandSeries& series, const SimulateOptions& options);

  /// Disturbances from now on; those of the past stay done. Throws Error(bad_pattern) for an
  /// unknown link.
  void set_scenario(const std::vector<Disturbance>& scenario);

  /// Keep a sample per tick (the default) or only the figures of the judge.
  void keep_samples(bool keep) { keep_samples_ = keep; }

  /// Goes on by at most `ticks` control ticks; false once the run is over: the series and its
  /// settling time have passed, or the robot has lain for a moment.
  bool advance(long ticks, const Progress& progress = {});

  long tick() const { return tick_; }  ///< ticks done
  double time() const;                 ///< of the next tick [s]
  bool fell() const { return fell_; }
  const RobotState& state() const { return plant_.state(); }     ///< true state
  const SimulationSample& last_sample() const { return last_; }  ///< of the last tick done
  const Estimate& last_estimate() const { return estimate_; }
  /// What the controller planned for the last tick done: the command where the feet are, or VIIP's
  /// own motion.
  const CommandSample& plan() const { return plan_; }
  /// The command of tick k as sampled; that of the end after it.
  const CommandSample& command(long k) const;

  /// Verdict on the run so far.
  SimulationResult result() const;

  /// Everything kept so far, with the verdict; the samples move into it.
  SimulationLog take_log();

 private:
  void step_once();
  double energy() const;
  void see_truth();
  void take_sample(const CommandSample& cmd, const Estimate& estimate, const ControlOutput& out);
  void take_forces(const CommandSample& cmd);
  void note(double t, const std::vector<std::string>& texts);

  const RobotModel* model_;
  const CommandSeries* series_;
  SimulateOptions options_;
  ActuatorLimits limits_;
  double h_;  // integrator step [s]
  AnyPlant plant_;
  Sensors sensors_;
  Estimator estimator_;
  Judge judge_;
  Schedule schedule_;
  StepInput input_;
  Controller controller_;
  CommandSample plan_;  // of the last tick done
  StepReport report_;
  Eigen::Vector3d zmp_ = Eigen::Vector3d::Zero();
  std::set<std::string> noted_;
  std::vector<char> saturated_;  // by dof: told already
  std::vector<SimulationEvent> events_;
  SimulationSample last_;
  Estimate estimate_;
  std::vector<SimulationSample> samples_;
  bool keep_samples_ = true, fell_ = false;
  bool touched_ = false;  // itself, told already
  Work work_;
  long tick_ = 0, planned_ = 0, end_ = 0;  // ticks done, of the whole run, where it stops
};

}  // namespace ayumi
