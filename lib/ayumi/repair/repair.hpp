#pragma once
// The nearest consistent pattern by Ipopt: smooth corrections (cubic B-splines) to base and joints
// that bring a command series back inside support, joint and contact limits with least change.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/repair/motion_change.hpp"
#include "ayumi/repair/weighted_change.hpp"

namespace ayumi {

struct RepairOptions {
  CheckOptions check;
  std::vector<std::string> locked_joints;  ///< do not change, to the bit
  std::array<bool, 2> locked_feet = {};    ///< by Side: keep their way (0.01 mm)
  /// Nothing changes there, to the bit; in one without length the posture of the sample there,
  /// while the motion through it may [s].
  std::vector<std::pair<double, double>> locked_windows;
  std::map<std::string, double> joint_weights;  ///< factors on the cost of a joint
  Trust trust = Trust::posture;
  /// Factor on the price of safety; 0: none is bought, the least change that passes the check.
  double safety = 1;
  bool keep_partial = false;   ///< stopped: conclude with the least violating point seen
  double knot_spacing = 0.05;  ///< of the B-splines [s]
  /// To keep the ZMP inside the support polygon where the motion's own is too near its edge [m];
  /// none: safe_margin().
  std::optional<double> zmp_margin;
  int max_iterations = 100;  ///< of Ipopt in each round
  bool mumps = false;        ///< its linear systems by MUMPS, to compare
};

enum class RepairStatus { already_consistent, repaired, infeasible, not_converged };
/// In the header, so that results are written as text without the solver.
inline const char* name_of(RepairStatus status) {
  constexpr const char* kNames[] = {"already_consistent", "repaired", "infeasible",
                                    "not_converged"};
  return kNames[static_cast<int>(status)];
}

/// Something that no correction could mend.
struct Obstacle {
  Finding finding;         ///< as the nearest motion found has it
  double excess = 0;       ///< worst over limit; of lengths and angles: what is missing
  bool is_ratio = false;   ///< `excess` is a ratio, else in the finding's unit
  double time_factor = 0;  ///< the window would pass when it took this much longer; 0: it would not
  std::string text;        ///< all of it in words
};

/// Work of the solver, over all rounds. The seconds differ from run to run.
struct RepairWork {
  int rounds = 0, iterations = 0;
  int variables = 0, constraints = 0;  ///< of the last round
  int jacobian_nonzeros = 0, hessian_nonzeros = 0;
  double function_seconds = 0, solver_seconds = 0;  ///< in functions and derivatives; in the rest
};

struct RepairResult {
  RepairStatus status = RepairStatus::not_converged;
  bool partial = false;         ///< stopped by the caller; the least violating point
  CorrectionTrack correction;   ///< empty when already consistent
  CommandSeries series;         ///< the repaired command series, full rate
  ConsistencyReport before;     ///< of the series as given
  ConsistencyReport check;      ///< of `series`
  MotionChange moved;           ///< from the series as given to `series`
  WeightedChange change;        ///< the same weighted: what was made small
  double max_joint_change = 0;  ///< [rad]
  double max_cog_change = 0;    ///< [m]
  std::string where;            ///< joint that moved most
  double at = 0;                ///< when [s]
  int variables = 0, constraints = 0, iterations = 0;
  double constraint_violation = 0;   ///< scaled, of the NLP
  std::vector<Obstacle> obstacles;   ///< when not repaired, ranked
  std::vector<std::string> reasons;  ///< the same in words, the first few
  RepairWork work;
};

/// A margin with which a walk played open loop stands, though its servos sag and its feet land a
/// little early: 0.9 of the largest circle's radius that the smaller sole holds about its centre.
double safe_margin(const RobotModel& model);

/// Throws Error(usage) for a joint, window or weight that is not there or out of range.
RepairResult repair(const RobotModel& model, const CommandSeries& series,
                    const RepairOptions& options = {}, const Progress& progress = {});

}  // namespace ayumi
