#pragma once
// The same robot, servos and soles in MuJoCo with the interface of Plant. It is an independent
// reference for Ayumi's own integrator. The same points touch the ground: corners of soles and
// shapes.

#include <memory>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/sim/simulate.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

/// Number of MuJoCo's steps in a step of the plant. MuJoCo finds contact forces before it damps
/// joints implicitly, as if the servo torques at the start of the step lasted. If kd h is larger
/// than the rotor inertia (twice as large on HOAP-1 at 1 ms), a force that changes as fast as in a
/// jump makes the soles chatter. Chosen: with 4 steps, kd h is half of the rotor inertia.
constexpr int kMujocoSteps = 4;

class MujocoPlant {
 public:
  /// The model must outlive the plant. Throws Error(bad_model) for a robot with mimic joints or
  /// without servos.
  MujocoPlant(const RobotModel& model, const ActuatorLimits& limits, const World& world,
              int steps = kMujocoSteps);
  ~MujocoPlant();
  MujocoPlant(const MujocoPlant& other);
  MujocoPlant& operator=(const MujocoPlant& other);
  MujocoPlant(MujocoPlant&&) noexcept;
  MujocoPlant& operator=(MujocoPlant&&) noexcept;

  const RobotState& state() const;
  const RobotData& data() const;
  void set_state(const RobotState& state);

  /// Advances like Plant::step(). Throws Error(bad_pattern) for more than kMujocoBumps bumps at
  /// once.
  const StepReport& step(const Eigen::VectorXd& targets, const StepInput& input, double dt);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// MuJoCo as the plant of SimulateOptions.
PlantKind mujoco_plant_kind(int steps = kMujocoSteps);

}  // namespace ayumi
