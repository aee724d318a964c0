#pragma once
// One interface for all control laws: open loop, DTAD, VIIP's steps and its jump. The law may
// change from phase to phase of a pattern. The new law continues from the posture, velocity and
// footholds of the previous one. If the whole motion is planned in advance, without VIIP goals, the
// servos receive the torques of the plan under every law (control/torque_feedforward).

#include <memory>
#include <variant>

#include "ayumi/control/laws/dtad.hpp"
#include "ayumi/control/laws/open_loop.hpp"
#include "ayumi/control/laws/viip.hpp"
#include "ayumi/control/laws/viip_jump.hpp"

namespace ayumi {

/// Throws Error(usage) for an unknown gain or a gain out of range, and Error(bad_model) if this
/// gain is in the sidecar.
void check_controller(const RobotModel& model, const ControllerSpec& spec);

/// The gains by name as the controller uses them; there are none in open loop. Throws the same
/// errors as check_controller().
std::vector<std::pair<std::string, double>> gains_in_use(const RobotModel& model,
                                                         const ControllerSpec& spec);

class Controller {
 public:
  /// The series and the model must outlive the controller and its copies. Throws the same errors as
  /// check_controller(), and Error(bad_pattern) for a VIIP phase that the law cannot execute, or if
  /// VIIP is chosen for a pattern without VIIP phases.
  Controller(const RobotModel& model, const ActuatorLimits& limits, const CommandSeries& series,
             const ControllerSpec& spec);

  /// The plan of the coming tick: the command relative to the robot's feet, or VIIP's own plan.
  const CommandSample& plan() const {
    return std::visit([](const auto& law) -> const CommandSample& { return law.plan(); }, law_);
  }

  /// Whether the coming tick depends on measurements.
  bool measures() const {
    const auto* open = std::get_if<OpenLoop>(&law_);
    return !open || open->measures();
  }

  /// Posture of the robot before the first tick. It is the planned posture. If the joint angles of
  /// the plan are servo targets, it is the posture to which the servos yield under the weight.
  const RobotState& start() const { return start_; }
  /// The last servo targets [rad]. Before the first tick, these are the targets that hold the start
  /// posture.
  const Eigen::VectorXd& target() const { return target_; }

  /// Computes one tick. The output does not change until the next update.
  const ControlOutput& update(const Estimate& estimate);

 private:
  using Law = std::variant<OpenLoop, Dtad, Viip, ViipJump>;

  Law first_law();
  Law law_of_command(Handover from) const;
  const ViipSpan* span_at(long k) const;
  void enter(long k);
  void start_viip(const ViipSpan& span, long k);
  void set_goal(const ViipSpan& span, long k);

  const RobotModel* model_;
  ActuatorLimits limits_;
  const CommandSeries* series_;
  ControllerSpec spec_;
  long tick_ = 0;  // index of the coming tick
  RobotState start_;
  Eigen::VectorXd target_;
  /// Offsets of the servo targets for each sample of the series [rad]; a single column applies to
  /// all samples.
  std::shared_ptr<const Eigen::MatrixXd> torque_lead_;
  Law law_;
  const ViipSpan* span_ = nullptr;  // the span that law_ executes; null if law_ follows the command
  ControlOutput out_;
};

}  // namespace ayumi
