#pragma once
// The laws behind one face: open loop, DTAD, VIIP. A pattern may pass the robot from one to another
// by phases; each goes on from the posture, velocity and footholds the last one left.

#include <optional>
#include <variant>

#include "ayumi/control/foothold_shift.hpp"
#include "ayumi/control/laws/dtad.hpp"
#include "ayumi/control/laws/viip.hpp"
#include "ayumi/control/laws/viip_jump.hpp"

namespace ayumi {

/// Throws Error(usage) for an unknown gain or a gain out of range.
void check_controller(const RobotModel& model, const ControllerSpec& spec);

class Controller {
 public:
  /// Series and model outlive it and its copies. Throws as check_controller() and
  /// Error(bad_pattern) for a VIIP phase that cannot be carried.
  Controller(const RobotModel& model, const ActuatorLimits& limits, const CommandSeries& series,
             const ControllerSpec& spec);

  /// The plan of the coming tick: the command where the robot's feet are, or VIIP's own.
  const CommandSample& plan() const { return plan_; }

  /// How the robot stands before the first tick: as planned; where the plan's joints are what
  /// servos receive, as they give way under the weight.
  const RobotState& start() const { return start_; }
  /// What the servos received last [rad]; before the first tick what they hold the start with.
  const Eigen::VectorXd& target() const { return target_; }

  /// One tick: goes on to the next. The output holds until the next update.
  const ControlOutput& update(const Estimate& estimate);

 private:
  /// The command itself on the servos.
  struct OpenLoop {
    Eigen::VectorXd lead;  ///< of the servo targets [s]
  };
  /// From the command as sampled to the feet as they are: after steps that VIIP placed.
  struct Placement {
    Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
    /// Of each foot, from its turned command to where it stands; fades when it swings.
    std::array<Eigen::Isometry3d, 2> rest = {Eigen::Isometry3d::Identity(),
                                             Eigen::Isometry3d::Identity()};
    std::array<double, 2> share = {1, 1};           ///< of `rest` that still holds
    Eigen::Vector3d cog = Eigen::Vector3d::Zero();  ///< of COG and ZMP, taken back slowly [m]
    long since = 0;                                 ///< tick at which it began
    bool moved = false;
  };

  const CommandSample& command(long k) const;
  CommandSample placed(long k) const;
  void place(const CommandSample& from);
  void enter(long k);
  void start_law(const ViipSpan* span);
  const ViipSpan* span_at(long k) const;
  Handover handover() const;

  const RobotModel* model_;
  ActuatorLimits limits_;
  const CommandSeries* series_;
  ControllerSpec spec_;
  Eigen::MatrixXd sag_;  // of the servos by sample, made up for [rad]; one column: throughout
  std::variant<OpenLoop, Dtad, Viip, ViipJump> law_;
  std::optional<FootholdShift> footholds_;  // of DTAD on a pattern without VIIP phases
  Placement placement_;
  CommandSample plan_, following_;  // of the coming tick, and after it where feet have moved
  ControlOutput out_;
  RobotState start_;
  Eigen::VectorXd target_;
  const ViipSpan* span_ = nullptr;
  long tick_ = 0;  // the coming one
};

}  // namespace ayumi
