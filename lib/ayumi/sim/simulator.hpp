#pragma once
// One run in progress: plant, sensors, estimator, controller and verdict advance tick by tick. A
// copy of a simulator is an independent branch that continues identically from the same state, so
// that many pushes can share the simulation before the push. simulate() runs a Simulator to its
// end.

#include <functional>
#include <set>
#include <utility>

#include "ayumi/base/progress.hpp"
#include "ayumi/control/controller.hpp"
#include "ayumi/sim/fall_monitor.hpp"
#include "ayumi/sim/plant_interface.hpp"
#include "ayumi/sim/schedule.hpp"
#include "ayumi/sim/sensors.hpp"
#include "ayumi/sim/simulate.hpp"

namespace ayumi {

class Simulator {
 public:
  /// After construction, the servos have held the first posture until the robot rests; the next
  /// tick is 0. Model and series must outlive the simulator and its copies. Throws the same errors
  /// as simulate().
  Simulator(const RobotModel& model, const CommandSeries& series, const SimulateOptions& options);

  /// Replaces the disturbances from now on; the effect of past ones remains. Throws
  /// Error(bad_pattern) for an unknown link.
  void set_scenario(const std::vector<Disturbance>& scenario);

  /// Keeps a sample for each tick (the default), or only the figures of the verdict. Without
  /// samples, the energy is not computed.
  void keep_samples(bool keep) { keep_samples_ = keep; }

  /// From now on, only the verdict is computed: result() has the outcome with its time, the largest
  /// tilt and the figures of the end. The robot moves exactly as without this. After each
  /// advance(), plan() and last_estimate() are valid, and so are the COG, the true ZMP with its
  /// force and the reference posture of last_sample(). Samples, events and the other figures are no
  /// longer complete.
  void gather_verdict_only() {
    verdict_only_ = true;
    keep_samples_ = false;
  }

  /// From now on, gives each sample to `sink` instead of keeping it; the log then has no samples.
  /// Copies of the simulator share the state of the function.
  using SampleSink = std::function<void(const SimulationSample&)>;
  void send_samples(SampleSink sink) { sink_ = std::move(sink); }

  /// Advances by at most `ticks` control ticks. Returns false when the run is over: the series and
  /// its settling time have passed, or the robot has fallen and the short time after a fall has
  /// passed.
  bool advance(long ticks, const Progress& progress = {});

  long tick() const { return tick_; }  ///< number of ticks that are done
  double time() const;                 ///< time of the next tick [s]
  bool fell() const { return fell_; }
  const RobotState& state() const { return plant_.state(); }  ///< true state
  /// Sample of the last tick that is done.
  const SimulationSample& last_sample() const { return last_; }
  const Estimate& last_estimate() const { return estimate(); }
  /// The controller's plan for the last tick that is done: the command relative to the feet, or
  /// VIIP's own motion.
  const CommandSample& plan() const { return plan_; }
  /// The command of tick k as sampled; after the end, the last one.
  const CommandSample& command(long k) const;

  /// The verdict of the run so far.
  SimulationResult result() const;
  /// The largest errors so far.
  const LargestErrors& largest_errors() const { return monitor_.largest_errors(); }

  /// The log so far with the verdict. The samples are moved into it.
  SimulationLog take_log();

 private:
  void step_once();
  void step_for_verdict(bool last);
  const Measurement& measure(long step);
  const Eigen::VectorXd& sent(const Eigen::VectorXd& target);
  void move(long step, const Eigen::VectorXd& target);
  void check_finite(double t) const;
  void end_soon_after_fall();
  double energy() const;
  const Estimate& estimate() const {
    return options_.true_state ? true_estimate_ : estimator_.last();
  }
  void replace_estimate_by_truth();
  void calibrate_ankles();
  const Measurement& corrected(const Measurement& measurement);
  const ControlOutput& in_counts(const ControlOutput& out);
  const ControlOutput& with_targets_of_caller(double t, const ControlOutput& law);
  void take_sample(const CommandSample& cmd, const Estimate& estimate, const ControlOutput& out);
  void take_forces();
  void note(double t, const std::vector<std::string>& texts);

  const RobotModel* model_;      // model of the simulated robot
  const RobotModel* law_model_;  // model that the controller uses
  const CommandSeries* series_;
  SimulateOptions options_;
  ActuatorLimits limits_;  // limits of the simulated robot
  double h_;               // length of the integrator step [s]
  PlantInterface plant_;
  Sensors sensors_;
  Estimator estimator_;
  FallMonitor monitor_;
  Schedule schedule_;
  StepInput input_;
  Controller controller_;
  ControlOutput changed_;  // output of the law with the targets of the caller, or with whole counts
  bool counts_targets_;    // servos receive whole counts of their encoders
  Eigen::VectorXd counts_;  // counts per rad, for counts_targets_; 0 if they are unknown
  Eigen::VectorXd zeros_;   // zeros of the encoders that the law knows; empty if all are 0
  Eigen::VectorXd sent_;    // targets as encoder angles
  Measurement corrected_;   // readings as joint angles, minus encoder_offset_
  // Offsets that were estimated while the robot stands [rad, m]; empty if none was found.
  Eigen::VectorXd encoder_offset_;
  CommandSample plan_;  // plan of the last tick that is done
  StepReport report_;
  Eigen::Vector3d zmp_ = Eigen::Vector3d::Zero();
  std::set<std::string> noted_;
  std::vector<char> saturated_;  // by dof: whether there is an event for it
  std::vector<SimulationEvent> events_;
  SimulationSample last_;
  Estimate true_estimate_;  // replaces the estimator's value if the law knows the true state
  std::vector<SimulationSample> samples_;
  SampleSink sink_;  // receives the samples; if empty, samples are kept
  bool keep_samples_ = true, verdict_only_ = false, fell_ = false;
  bool touched_ = false;  // whether an event says that the robot touched itself
  EnergyBalance work_;
  long tick_ = 0, planned_ = 0, end_ = 0;  // ticks that are done, ticks without a fall, last tick
};

}  // namespace ayumi
