#pragma once
// The command of a pattern relative to the robot's feet. It is the sampled command, or the same
// command moved over the ground after VIIP has placed steps, or with footholds that respond to a
// push. Laws that follow a command take their plan from here.

#include <optional>

#include "ayumi/control/foothold_shift.hpp"
#include "ayumi/control/plan_shift.hpp"

namespace ayumi {

class CommandPlan {
 public:
  /// The command as sampled, from the first sample on. The series must outlive this object and its
  /// copies.
  explicit CommandPlan(const CommandSeries& series);

  double dt() const { return series_->dt; }  ///< time of one tick [s]
  const CommandSeries& series() const { return *series_; }

  /// The command of the coming tick.
  const CommandSample& now() const { return is_sampled() ? sampled(tick_) : now_; }

  /// Whether measurements change the command.
  bool measures() const { return footholds_.has_value(); }

  /// The command of tick k at the place where the feet are. After the end of the series, it is the
  /// last posture at rest.
  CommandSample at(long k) const;

  /// The index of the sample from which now() comes; a moved plan has its own clock.
  long sample() const;

  /// Whether now() is after the last sample, where the plan is at rest.
  bool at_rest() const { return sample() >= static_cast<long>(series_->samples.size()); }

  /// W of now() [dof]; null for the robot's own weights.
  const Eigen::VectorXd* joint_weight() const { return series_->joint_weight_at(sample()); }

  /// Continues at tick k after another law. The command is moved and turned to the feet of `from`.
  /// A foot that deviates slightly stays where it is until its next swing; an offset of the COG
  /// decreases slowly to zero.
  void go_on_from(const CommandSample& from, long k);

  /// From now on, the footholds respond to pushes. May only be called before the first tick.
  void move_footholds(const RobotModel& model, const FootholdParams& params);

  /// The command one tick after now(), which depends on the measurements. If a foot has landed
  /// early, now() has the foot at its real place from then on. The reference is valid until the
  /// next call.
  const CommandSample& look_ahead(const Estimate& estimate);

  /// Makes the result of look_ahead() the result of now(). The reference that look_ahead() returned
  /// is then no longer valid.
  void advance();

 private:
  /// How the command has been moved after another law.
  struct Placement {
    Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
    /// For each foot, the motion from its turned command to the place where it stands; it decreases
    /// to zero while the foot swings.
    std::array<Eigen::Isometry3d, 2> rest = {Eigen::Isometry3d::Identity(),
                                             Eigen::Isometry3d::Identity()};
    std::array<double, 2> share = {1, 1};  ///< share of `rest` that still applies, for each foot
    /// Offset of COG and ZMP, which is slowly reduced to zero [m].
    Eigen::Vector3d cog = Eigen::Vector3d::Zero();
    long since = 0;  ///< tick at which the offset began
    bool moved = false;
  };
  const CommandSample& sampled(long k) const;
  bool is_sampled() const { return !footholds_ && !placement_.moved; }

  const CommandSeries* series_;
  Placement placement_;
  std::optional<FootholdShift> footholds_;
  CommandSample rest_;        // command after the end
  CommandSample now_, next_;  // commands of a moved plan
  long tick_ = 0;             // tick of now_
};

}  // namespace ayumi
