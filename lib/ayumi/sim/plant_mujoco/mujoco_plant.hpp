#pragma once
// The same robot, servos and soles in MuJoCo, behind the same face as Plant: an independent judge
// of Ayumi's own integrator. The same points touch the ground: corners of soles and shapes.

#include <memory>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/sim/simulate.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

/// MuJoCo's steps per step. It finds contact forces before it damps joints implicitly, as if the
/// servos' torque at the step's start lasted: where kd h is above the rotor's inertia (twice it, on
/// HOAP-1, at 1 ms) a force that changes as fast as in a jump makes the soles chatter.
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

  /// As Plant::step(). Throws Error(bad_pattern) for more bumps at once than it keeps room for.
  const StepReport& step(const Eigen::VectorXd& targets, const StepInput& input, double dt);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// For SimulateOptions::plant.
PlantKind mujoco_plant_kind(int steps = kMujocoSteps);

}  // namespace ayumi
