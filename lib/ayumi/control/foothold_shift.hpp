#pragma once
// If a push is too large for the present support, moves the coming footholds of a pattern and
// speeds up its clock, so that the next step compensates the rest of the push. docs/theory.md,
// "Moving footholds".

#include <optional>
#include <vector>

#include "ayumi/control/estimator.hpp"
#include "ayumi/control/footsteps.hpp"
#include "ayumi/control/plan_shift.hpp"
#include "ayumi/control/step_program.hpp"
#include "ayumi/control/swing_foot.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// One swing of a pattern. Its times are counted in samples of the series.
struct PlannedSwing {
  double lift = 0, land = 0;  ///< beginning and end of the single support
  double rest = 0;            ///< end of the double support after it
  Side foot = Side::right;    ///< foot in the air
};

/// The swings that end in a double support, in time order.
std::vector<PlannedSwing> swings_of(const CommandSeries& series);

/// The command at `phase` [samples], which may be between two samples. After the end, it is the
/// last posture at rest.
CommandSample command_between(const CommandSeries& series, double phase);
void command_between(const CommandSeries& series, double phase, CommandSample& command);

struct FootholdParams {
  /// The supports cannot always remove the whole DCM error. This is the share of the remaining
  /// error that the footholds remove; 0 switches this off.
  double share = 0;
  double time_scale_limit = 2.5;  ///< fastest clock of the pattern, at least 1
  /// Footholds and clock are chosen by the program of control/step_program, which corrects every
  /// error. Without it, a search corrects only the part of an error that the supports cannot
  /// remove.
  std::optional<StepWeights> program = {};
};

/// The plan of a pattern whose footholds move. As long as the supports can correct all errors, the
/// plan equals the pattern to the last bit. After that, the coming footholds, ZMP and COG are
/// shifted over the ground.
class FootholdShift {
 public:
  /// The model and the series must outlive this object.
  FootholdShift(const RobotModel& model, const CommandSeries& series, const FootholdParams& params);

  /// The plan of the coming tick.
  const CommandSample& plan() const { return plan_; }

  /// Must be called after the tick of plan() has been measured. It chooses the next foothold and
  /// advances the clock. Returns true if a foot has landed early. Then the foot stays where it is,
  /// and the foot of the plan is set to this place.
  bool advance(const Estimate& estimate);

  /// The rate of the pattern's clock; 1 is its own pace.
  double time_scale() const { return time_scale_; }
  double phase() const { return phase_; }  ///< phase of plan() in the pattern [samples]
  /// Offset of a foot from the pattern [m].
  const Eigen::Vector2d& shift(Side side) const { return foot_[static_cast<int>(side)]; }

 private:
  /// A swing with the values that the pattern has planned for it, in world axes.
  struct Step {
    PlannedSwing swing;
    Eigen::Vector2d zmp;   // ZMP in its single support [m]
    Eigen::Vector2d dcm;   // DCM at the landing [m]
    ConvexPolygon before;  // support before lift-off
    // Support during the swing, and support of the foot that lands; both relative to the ZMP [m].
    ConvexPolygon single, next;
    GroundPose stance, landing;  // places of the feet at the landing
    double share = 1;            // share of a foothold's shift that the DCM makes by the landing
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
  size_t coming_ = 0;      // index in steps_ of the next step to land
  double phase_ = 0;       // phase of plan_ in the pattern [samples]
  double time_scale_ = 1;  // samples of the pattern per tick
  bool moved_ = false;
  // Offsets from the pattern [m]: of each foot, of the ZMP before and after a double support, of
  // the coming foothold, and of the COG.
  std::array<Eigen::Vector2d, 2> foot_;
  Eigen::Vector2d before_, after_;
  Eigen::Vector2d target_;
  Eigen::Vector2d cog_;
  SwingReplan<2> swing_;      // path of the foot in the air
  CommandSample now_, plan_;  // the pattern's command and the shifted one
  CommandSample work_;        // workspace
  RobotData data_;
};

}  // namespace ayumi
