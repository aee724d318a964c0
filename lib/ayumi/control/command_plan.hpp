#pragma once
// The command of a pattern relative to the robot's feet: as sampled, or moved over the ground after
// steps that VIIP placed or by footholds that answer a push. The laws that follow a command take
// their plan from here.

#include <optional>

#include "ayumi/control/foothold_shift.hpp"
#include "ayumi/control/plan_shift.hpp"

namespace ayumi {

class CommandPlan {
 public:
  /// As sampled, from the first sample on. The series outlives this and its copies.
  explicit CommandPlan(const CommandSeries& series);

  double dt() const { return series_->dt; }  ///< [s]
  const CommandSeries& series() const { return *series_; }

  /// The command of the coming tick.
  const CommandSample& now() const { return is_sampled() ? sampled(tick_) : now_; }

  /// Whether measurements change the command.
  bool measures() const { return footholds_.has_value(); }

  /// The command of tick k where the feet are; after the end of the series its last posture, at
  /// rest.
  CommandSample at(long k) const;

  /// Sample of the series that now() comes from; a moved plan has a clock of its own.
  long sample() const;

  /// Whether now() is behind the last sample, where the plan is at rest.
  bool at_rest() const { return sample() >= static_cast<long>(series_->samples.size()); }

  /// W of now() [dof]; null: the robot's own.
  const Eigen::VectorXd* joint_weight() const { return series_->joint_weight_at(sample()); }

  /// Continues at tick k after another law: the command is moved and turned to the feet of `from`.
  /// A foot with a small deviation stays until its next swing; an offset of the COG fades slowly.
  void go_on_from(const CommandSample& from, long k);

  /// From now on footholds answer pushes; only before the first tick.
  void move_footholds(const RobotModel& model, const FootholdParams& params);

  /// The command one tick after now(), chosen by what is measured. If a foot has landed early, the
  /// feet of now() jump to its place. Holds until the next call.
  const CommandSample& look_ahead(const Estimate& estimate);

  /// The result of look_ahead() becomes now(); the reference that it returned is no longer valid.
  void advance();

 private:
  /// How the command has been moved after another law.
  struct Placement {
    Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
    /// Of each foot, from its turned command to where it stands; it fades when the foot swings.
    std::array<Eigen::Isometry3d, 2> rest = {Eigen::Isometry3d::Identity(),
                                             Eigen::Isometry3d::Identity()};
    std::array<double, 2> share = {1, 1};           ///< of `rest` that still holds
    Eigen::Vector3d cog = Eigen::Vector3d::Zero();  ///< of COG and ZMP, taken back slowly [m]
    long since = 0;                                 ///< tick at which it began
    bool moved = false;
  };
  const CommandSample& sampled(long k) const;
  bool is_sampled() const { return !footholds_ && !placement_.moved; }

  const CommandSeries* series_;
  Placement placement_;
  std::optional<FootholdShift> footholds_;
  CommandSample rest_;        // after the end
  CommandSample now_, next_;  // of a plan that has moved
  long tick_ = 0;             // of now_
};

}  // namespace ayumi
