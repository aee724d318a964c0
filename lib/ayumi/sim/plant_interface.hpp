#pragma once
// The seam between the simulator and what moves the robot: state in, servo targets and what acts
// from outside in, next state and ground forces out. Any copyable class with the four members below
// is a plant; a copy of an AnyPlant is a plant of its own that goes on to the last bit as the
// original.

#include <any>
#include <utility>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

class AnyPlant {
 public:
  template <typename P>
  explicit AnyPlant(P plant) : plant_(std::move(plant)), calls_(&kCalls<P>) {}

  const RobotState& state() const { return calls_->state(plant_); }
  /// Positions and velocities of state().
  const RobotData& data() const { return calls_->data(plant_); }
  /// Puts the robot there and forgets contacts. Throws Error(usage) for what is not a number.
  void set_state(const RobotState& state) { calls_->set_state(plant_, state); }
  /// Advances by `dt` [s] with the servo targets [rad, m] held; the report holds until the next
  /// step. Throws Error(usage) with place and time for input that is not finite or beyond 1e6.
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
