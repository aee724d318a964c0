#pragma once
// The interface between the simulator and a plant, the part that moves the robot. Its input is the
// state, the servo targets and the forces from outside; its output is the next state and the ground
// forces. Any copyable class with the four members below is a plant. A copy of a PlantInterface is
// an independent plant that continues exactly as the original would, to the last bit.

#include <any>
#include <utility>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

class PlantInterface {
 public:
  template <typename P>
  explicit PlantInterface(P plant) : plant_(std::move(plant)), calls_(&kCalls<P>) {}

  const RobotState& state() const { return calls_->state(plant_); }
  /// The positions and velocities of state().
  const RobotData& data() const { return calls_->data(plant_); }
  /// Puts the robot in this state and removes all contacts. Throws Error(usage) for a value that is
  /// not a number.
  void set_state(const RobotState& state) { calls_->set_state(plant_, state); }
  /// Advances by `dt` [s] with constant servo targets [rad, m]. The targets are angles of the
  /// encoders (model/encoder_angles); the angles of state() are those of the joints. The report is
  /// valid until the next step. Throws Error(usage) with place and time for input that is not
  /// finite or not below 1e6.
  const StepReport& step(const Eigen::VectorXd& targets, const StepInput& input, double dt) {
    return calls_->step(plant_, targets, input, dt);
  }

 private:
  struct Calls {
    const RobotState& (*state)(const std::any&);
    const RobotData& (*data)(const std::any&);
    void (*set_state)(std::any&, const RobotState&);
    const StepReport& (*step)(std::any&, const Eigen::VectorXd&, const StepInput&, double);
  };
  template <typename P>
  static constexpr Calls kCalls = {
      [](const std::any& p) -> const RobotState& { return std::any_cast<P>(&p)->state(); },
      [](const std::any& p) -> const RobotData& { return std::any_cast<P>(&p)->data(); },
      [](std::any& p, const RobotState& state) { std::any_cast<P>(&p)->set_state(state); },
      [](std::any& p, const Eigen::VectorXd& targets, const StepInput& input, double dt)
          -> const StepReport& { return std::any_cast<P>(&p)->step(targets, input, dt); }};

  std::any plant_;
  const Calls* calls_;
};

}  // namespace ayumi
