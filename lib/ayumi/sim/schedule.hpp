#pragma once
// A scenario laid out on integrator steps: what acts on robot, ground and sensors in each of them.

#include <Eigen/Dense>
#include <vector>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/motion/scenario.hpp"
#include "ayumi/sim/simulation_log.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

/// What is wrong with the sensors.
struct SensorFault {
  double latency = 0;                              ///< beyond the robot's own [s]
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  ///< bias of the attitude, world axes [rad]
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();  ///< [rad/s]
  double force = 0;                                ///< of every load cell [N]
};

/// Where the world's floor is at `t` [s] with its own motions and these, and its mean velocity over
/// the step [s] from there.
FloorPose moving_floor(const World& world, const std::vector<FloorMotion>& motions, double t,
                       double step);

class Schedule {
 public:
  /// The model outlives the schedule; `step` [s] is the integrator's.
  Schedule(const RobotModel& model, const World& world, double step);

  /// Throws Error(bad_pattern) for an unknown link or joint.
  void set(const std::vector<Disturbance>& scenario);

  /// What acts during step k (from k step on; negative before the start) on a robot whose positions
  /// are `data`. The lists of `input` keep their room.
  void fill(long k, const RobotData& data, StepInput& input);
  SensorFault sensor_fault(long k) const;
  double largest_latency() const;  ///< ever [s]

  /// Start, and end of what lasts, in words.
  std::vector<SimulationEvent> events() const;

 private:
  struct Entry {
    Disturbance source;
    long first = 0, count = 1;
    int link = -1, joint = -1;  ///< -1: COG, all joints
    double per_step = 0;        ///< force or torque of a rectangle [N] or [N m]
    bool placed = false;        ///< a bump has found its place ...
    Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< ... in the ground's frame
  };
  bool acts(const Entry& entry, long k) const;
  ExternalWrench wrench(const Entry& entry, long k, const RobotData& data) const;
  Bump bump(Entry& entry, long k, const RobotData& data) const;
  void fault(const Entry& entry, std::vector<JointFault>& joints) const;

  const RobotModel* model_;
  World world_;
  double step_;
  std::vector<Entry> entries_;
  std::vector<FloorMotion> motions_;
};

}  // namespace ayumi
