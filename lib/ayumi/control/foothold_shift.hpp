#pragma once
// Moves the coming footholds of a pattern and speeds up its time if a push is too large for the
// present support: the next step answers the rest. docs/theory.md, "Moving footholds".

#include <optional>
#include <vector>

#include "ayumi/control/estimator.hpp"
#include "ayumi/control/footsteps.hpp"
#include "ayumi/control/plan_shift.hpp"
#include "ayumi/control/step_program.hpp"
#include "ayumi/control/swing_foot.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// One swing of a pattern; phases of the pattern count its samples.
struct PlannedSwing {
  double lift = 0, land = 0;  ///< begin and end of the single support
  double rest = 0;            ///< end of the double support after it
  Side foot = Side::right;    ///< in the air
};

/// The swings that end in a double support, in time order.
std::vector<PlannedSwing> swings_of(const CommandSeries& series);

/// The command at a phase between samples; after the end the last posture, at rest.
CommandSample command_between(const CommandSeries& series, double phase);
void command_between(const CommandSeries& series, double phase, CommandSample& command);

struct FootholdParams {
  double share = 0;               ///< of the DCM error that the supports leave over; 0: off
  double time_scale_limit = 2.5;  ///< fastest clock of the pattern, at least 1
  /// Footholds and clock by the program of control/step_program, which answers every error, in
  /// place of a search that answers only the part that the supports leave.
  std::optional<StepWeights> program = {};
};

/// The plan of a pattern whose footholds move. As long as the supports can answer all errors, the
/// plan equals the pattern to the last bit. After that, the coming footholds, ZMP and COG are
/// shifted over the ground.
class FootholdShift {
 public:
  /// Model and series outlive it.
  FootholdShift(const RobotModel& model, const CommandSeries& series, const FootholdParams& params);

  /// Of the coming tick.
  const CommandSample& plan() const { return plan_; }

  /// The tick of plan() has been measured: the next foothold is chosen and the clock goes on. True
  /// if a foot has landed early: the foot stays in its place, and the foot of the plan jumps there.
  bool advance(const Estimate& estimate);

  double time_scale() const { return time_scale_; }  ///< of the pattern's clock, 1: its own pace
  double phase() const { return phase_; }            ///< of plan() in the pattern [samples]
  /// Offset of a foot from the pattern [m].
  const Eigen::Vector2d& shift(Side side) const { return foot_[static_cast<int>(side)]; }

 private:
  /// A swing with what the pattern has planned for it, world axes.
  struct Step {
    PlannedSwing swing;
    Eigen::Vector2d zmp;         // in its single support [m]
    Eigen::Vector2d dcm;         // at the landing [m]
    ConvexPolygon before;        // support before lift-off
    ConvexPolygon single, next;  // this one and that of the landing foot, about the ZMP [m]
    GroundPose stance, landing;  // of the feet at the landing
    double share = 1;            // of a foothold's shift that the DCM makes by the landing
  };
  Step step_of(const PlannedSwing& swing) const;
  double seconds_to(double phase) const { return (phase - phase_) * series_->dt; }
  double ramp_share(double time) const;
  Eigen::Vector2d zmp_shift() const;
  Eigen::Vector2d dcm_shift(double time_scale, const Eigen::Vector2d& target) const;
  Eigen::Vector2d error_left_over(const Eigen::Vector2d& dcm, double time_scale) const;
  Eigen::Vector2d not_crossing(const Eigen::Vector2d& target) const;
  Eigen::Vector2d reachable(const Eigen::Vector2d& target, double time_scale) const;
  void choose_foothold(const Estimate& estimate);
  void search_foothold(const Eigen::Vector2d& dcm);
  void solve_foothold(const Eigen::Vector2d& dcm);
  double swing_room(double time_scale) const;
  bool lands_early(const Estimate& estimate) const;
  void land_where_it_is(const Estimate& estimate);
  void land();
  void go_on();
  void move_swing_foot();
  void update_plan();

  const RobotModel* model_;
  const CommandSeries* series_;
  FootholdParams params_;
  double omega_, height_, half_width_;
  std::vector<Step> steps_;
  size_t coming_ = 0;      // index in steps_ of the next to land
  double phase_ = 0;       // of plan_ in the pattern [samples]
  double time_scale_ = 1;  // samples of the pattern per tick
  bool moved_ = false;
  // Offsets from the pattern [m]: of each foot, of the ZMP before and after a double support, of
  // the coming foothold, of the COG.
  std::array<Eigen::Vector2d, 2> foot_;
  Eigen::Vector2d before_, after_;
  Eigen::Vector2d target_;
  Eigen::Vector2d cog_;
  SwingReplan<2> swing_;      // of the foot in the air
  CommandSample now_, plan_;  // the pattern's command and the shifted one
  CommandSample work_;        // room to work in
  RobotData data_;
};

}  // namespace ayumi
