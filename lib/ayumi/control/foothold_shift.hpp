#pragma once
// Moves the coming footholds of a pattern, and hurries its clock, where a push is more than the
// present support can answer: what is left over is stepped out. docs/theory.md, "Moving footholds".

#include <vector>

#include "ayumi/control/estimator.hpp"
#include "ayumi/control/footsteps.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// One swing of a pattern; places of its clock count ticks.
struct PlannedSwing {
  double lift = 0, land = 0;  ///< begin and end of the single support
  double rest = 0;            ///< end of the double support after it
  Side foot = Side::right;    ///< in the air
};

/// The swings that end in a double support, in time order.
std::vector<PlannedSwing> swings_of(const CommandSeries& series);

/// The command at a place between ticks; after the end that of the end.
CommandSample command_between(const CommandSeries& series, double place);
void command_between(const CommandSeries& series, double place, CommandSample& command);

struct FootholdParams {
  double share = 0;    ///< of what the supports leave over that footholds take; 0: off
  double hurry = 2.5;  ///< fastest clock of the pattern, at least 1
};

/// The plan of a pattern whose footholds move. Until something is left over it is the pattern to
/// the last bit; from then on footholds, ZMP and COG to come are shifted over the ground.
class FootholdShift {
 public:
  /// Model and series outlive it.
  FootholdShift(const RobotModel& model, const CommandSeries& series, const FootholdParams& params);

  /// Of the coming tick.
  const CommandSample& plan() const { return plan_; }

  /// The tick of plan() has been measured: the next foothold is chosen and the clock goes on. True
  /// when a foot has landed before its time: it stays where it is and the plan's feet jump there.
  bool advance(const Estimate& estimate);

  double rate() const { return rate_; }    ///< of the clock
  double place() const { return place_; }  ///< of plan() in the pattern [samples]
  /// Of a foot against the pattern [m].
  const Eigen::Vector2d& shift(Side side) const { return foot_[static_cast<int>(side)]; }

 private:
  /// A swing with what the pattern has planned for it, world axes.
  struct Step {
    PlannedSwing swing;
    Eigen::Vector2d zmp;         // in its single support [m]
    Eigen::Vector2d xi;          // at the landing [m]
    ConvexPolygon both;          // support before lift-off
    ConvexPolygon single, next;  // this one and that of the landing foot, about the ZMP [m]
    GroundPose stance, landing;  // of the feet at the landing
    double share = 1;            // of a foothold's shift that xi makes by the landing
  };
  Step step_of(const PlannedSwing& swing) const;
  double seconds_to(double place) const { return (place - place_) * series_->dt; }
  double ramp_share(double time) const;
  Eigen::Vector2d zmp_shift() const;
  Eigen::Vector2d xi_shift(double rate, const Eigen::Vector2d& target) const;
  Eigen::Vector2d left_over(const Eigen::Vector2d& xi, double rate) const;
  Eigen::Vector2d not_crossing(const Eigen::Vector2d& target) const;
  Eigen::Vector2d reachable(const Eigen::Vector2d& target, double rate) const;
  void choose(const Estimate& estimate);
  bool lands_early(const Estimate& estimate) const;
  void meet(const Estimate& estimate);
  void land();
  void go_on();
  void move_foot();
  void refresh();

  const RobotModel* model_;
  const CommandSeries* series_;
  FootholdParams params_;
  double omega_, height_, half_width_;
  std::vector<Step> steps_;
  size_t coming_ = 0;  // of steps_: the next to land
  double place_ = 0, rate_ = 1;
  bool moved_ = false;
  std::array<Eigen::Vector2d, 2> foot_;              // of each foot against the pattern [m]
  Eigen::Vector2d before_, after_;                   // of the ZMP in a double support: from, to [m]
  Eigen::Vector2d target_;                           // of the coming foothold [m]
  Eigen::Vector2d cog_;                              // of the COG [m]
  Eigen::Vector2d swing_rate_, swing_acceleration_;  // of the foot in the air
  CommandSample now_, plan_;                         // of the pattern; shifted
  CommandSample work_;                               // to work in
  RobotData data_;
};

}  // namespace ayumi
