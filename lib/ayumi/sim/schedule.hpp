#pragma once
// A scenario in integrator steps: the disturbances of the robot, the ground and the sensors in each
// step.

#include <Eigen/Dense>
#include <optional>
#include <vector>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/motion/scenario.hpp"
#include "ayumi/sim/simulation_log.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

/// Errors of the sensors in a tick.
struct SensorFault {
  double latency = 0;                              ///< latency that is added to the robot's own [s]
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  ///< bias of the attitude in world axes [rad]
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();  ///< bias of the gyro [rad/s]
  double force = 0;                                ///< bias of every load cell [N]
};

/// The pose of the floor at `t` [s] with the world's motions and the given ones, and its mean
/// velocity during the following `step` [s].
FloorPose moving_floor(const World& world, const std::vector<FloorMotion>& motions, double t,
                       double step);

class Schedule {
 public:
  /// The model must outlive the schedule. `step` is the step of the integrator [s].
  Schedule(const RobotModel& model, const World& world, double step);

  /// Replaces the disturbances. Throws Error(bad_pattern) for an unknown link or joint.
  void set(const std::vector<Disturbance>& scenario);

  /// Fills the input of step k, which begins at k times `step` (k is negative before the start),
  /// for a robot whose positions are `data`. The lists of `input` keep their memory.
  void fill(long k, const RobotData& data, StepInput& input);
  SensorFault sensor_fault(long k) const;
  double largest_latency() const;  ///< largest latency in the whole scenario [s]

  /// The start of each disturbance, and the end of each lasting one, in words.
  std::vector<SimulationEvent> events() const;

 private:
  struct Entry {
    Disturbance source;
    long first = 0, count = 1;
    int link = -1, joint = -1;  ///< -1: link: the COG; joint: all joints
    double per_step = 0;        ///< force or torque if the push is a rectangle [N] or [N m]
    std::optional<Eigen::Vector2d>
        place{};  ///< place of a bump that has risen, in the ground's frame [m]
  };
  bool acts(const Entry& entry, long k) const;
  ExternalWrench wrench(const Entry& entry, const Push& push, long k, const RobotData& data) const;
  RisingDisc disc(Entry& entry, const Bump& bump, long k, const RobotData& data) const;

  const RobotModel* model_;
  World world_;
  double step_;
  std::vector<Entry> entries_;
  std::vector<FloorMotion> motions_;
};

}  // namespace ayumi
