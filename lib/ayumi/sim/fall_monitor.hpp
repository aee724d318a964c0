#pragma once
// The verdict of a run: whether the robot fell, stands or has not settled, and the figures of the
// run. This is the only definition of the verdict (docs/cli.md, "Simulating").

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/sim/simulation_log.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

/// Fraction of the weight above which a foot or the robot is on the ground. Chosen: above the noise
/// of contacts that open and close, below the load of any stance. Between half and twice the value,
/// figures change by less than 5 %.
inline constexpr double kTouchLoad = 0.05;

/// The largest errors of a run until its end or its fall.
struct LargestErrors {
  double cog = 0;        ///< error of the COG relative to the feet, horizontally [m]
  double foot_tilt = 0;  ///< tilt of a loaded foot that is planned to support the robot [rad]
};

/// Collects the figures of a run tick by tick.
class FallMonitor {
 public:
  FallMonitor(const RobotModel& model, const ActuatorLimits& limits, const World& world);

  /// Sets the pose of the floor from now on. The initial pose is that of the world.
  void set_ground(const Eigen::Isometry3d& pose) {
    ground_ = pose;
    to_ground_ = pose.inverse();
  }

  /// Takes one control tick: the plan, the true state and the report of the last step. `sample` is
  /// the log entry of this tick, and `truth` has the positions of its state. Returns true once, at
  /// the tick of the fall.
  bool observe(double t, const CommandSample& command, const SimulationSample& sample,
               const RobotData& truth, const StepReport& report, double dt);

  /// Takes one control tick for the verdict only. The result then only has the outcome with its
  /// time, the largest tilt and the figures of the end. Only the COG and the true ZMP with its
  /// force are read from `sample`.
  bool observe_verdict(double t, const CommandSample& command, const SimulationSample& sample,
                       const RobotData& truth, const StepReport& report, double dt);

  /// The verdict after the last tick. `command` is the end of the plan.
  SimulationResult conclude(const CommandSample& command, const RobotState& state);

  const std::vector<SimulationEvent>& events() const { return events_; }
  const LargestErrors& largest_errors() const { return largest_; }

 private:
  void judge_zmp();
  void observe_figures(double t, const CommandSample& command, const SimulationSample& sample,
                       const RobotData& truth, const StepReport& report, double dt);
  void observe_feet(double t, const CommandSample& command, const RobotData& truth,
                    const StepReport& report, double dt);

  const RobotModel* model_;
  ActuatorLimits limits_;
  Eigen::Vector3d normal() const { return ground_.linear().col(2); }

  Eigen::Isometry3d ground_ = Eigen::Isometry3d::Identity();
  // Motion from the world to the ground's frame.
  Eigen::Isometry3d to_ground_ = Eigen::Isometry3d::Identity();
  SimulationResult result_;
  LargestErrors largest_;
  double least_upright_ = 1;  // cosine of result_.max_tilt
  double least_level_ = 1;    // cosine of largest_.foot_tilt
  std::vector<SimulationEvent> events_;
  double zmp_square_sum_ = 0;
  long zmp_count_ = 0;
  double iterations_ = 0;
  long ticks_ = 0;
  double level_ = 0;        // commanded COG height; during a flight, that of the lift-off [m]
  double airborne_ = 0;     // duration of the present flight [s]
  double flight_apex_ = 0;  // apex of the present flight, over level_ [m]
  std::vector<Eigen::Vector2d> last_zmp_;    // ZMPs of the last ticks, as a ring [m]
  size_t next_zmp_ = 0;                      // next place in this ring
  double tick_ = 0;                          // control tick [s]
  std::array<double, 2> unloaded_ = {0, 0};  // time for which each foot has been off the ground [s]
  std::array<bool, 2> in_stance_ = {false, false};
  std::array<Eigen::Vector3d, 2>
      stance_start_;  // place at which each foot first carried load, in the floor's frame [m]
};

}  // namespace ayumi
