#pragma once
// The state of the robot, and how the solved velocity of a step moves it. Momentum is exact, and a
// robot that tips over an edge or a corner moves with second-order accuracy. docs/theory_plant.md,
// "The base" and "Pivoting".

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/sim/plant/step_system.hpp"

namespace ayumi {

/// The motion that the pressing contacts allow the whole robot with its joints locked.
struct Pivot {
  int freedom = 0;  ///< 3: it turns about a point; 1: about a line; 0: no motion
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< point in the world [m]
  /// Axis in the world; a unit vector if freedom is 1.
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
};

class Integrator {
 public:
  explicit Integrator(const RobotModel& model) : data_(model) {}

  const RobotState& state() const { return state_; }
  const RobotData& data() const { return data_; }  ///< positions and velocities of state()
  RobotData& data() { return data_; }              ///< the functions of a step use its workspace

  /// Puts `robot`, including its loads, in this state. Removes the pivot.
  void set_state(const RobotModel& robot, const RobotState& state, StepSystem& system);

  /// The robot takes up or puts down a load, which has the velocity of its links.
  void set_load(const RobotModel& robot, StepSystem& system);

  bool pivots() const { return pivot_.freedom > 0; }

  /// For a pivoting robot: writes the equation of a step of `dt` [s] in the axes of its posture
  /// half a step ahead.
  void turn_half(const RobotModel& robot, double dt, StepSystem& system,
                 std::vector<ActiveContact>& contacts) const;

  /// Time until a pivoting robot meets the ground with another point [s]; `dt` if none lands. To be
  /// called between solve() and advance().
  double time_of_landing(const StepSystem& system, const ContactSet& contacts, double dt) const;

  /// Moves the robot by the solved velocity over `dt` [s]. system.external() must contain the
  /// contacts.
  void advance(const RobotModel& robot, double dt, StepSystem& system, ContactSet& contacts);

 private:
  void find_pivot(const ContactSet& contacts);
  Eigen::Vector3d turn_about_pivot(const RobotModel& robot, const StepSystem& system,
                                   const Momentum& given) const;
  void follow_points(double dt, const StepSystem& system, ContactSet& contacts) const;

  RobotState state_;
  RobotData data_;
  // Momentum about the COG: the sum of what gravity and outside forces have given the robot.
  Momentum momentum_;
  Pivot pivot_;  // pivot of the last step
};

}  // namespace ayumi
