#pragma once
// Finds the nearest consistent pattern: smooth corrections (cubic B-splines) of base and joints
// that bring a command series inside all limits of the check with the smallest change. Ipopt solves
// the program.
//
// Ipopt accepts Ayumi's linear solver only under the name MA27, and the whole process has only one
// place for it. Ayumi holds this place only while a repair runs, for the threads that run one;
// afterwards, the place is empty again. A host program that has its own MA27 keeps it, and repairs
// then use MUMPS. See repair/nlp/nlp.hpp.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/base/bounds.hpp"
#include "ayumi/base/progress.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/repair/motion_change.hpp"
#include "ayumi/repair/policy.hpp"
#include "ayumi/repair/weighted_change.hpp"

namespace ayumi {

/// Random control points: joints and base rotation are within +-size [rad], and the base position
/// is within +-0.1 m per radian of `size`.
struct RandomStart {
  /// Bound of the random control points [rad]; with 0, the search starts as usual.
  double size = 0;
  std::uint64_t seed = 0;
};

struct RepairOptions {
  /// Bounds of the options. Chosen: beyond 1e6, the size of the change has no weight any more; a
  /// margin of 0.1 m needs soles that are 0.2 m wide; and 10000 iterations take hours.
  static constexpr Bounds kSafety = {0, 1e6}, kZmpMargin = {0, 0.1, "m"},
                          kMaxIterations = {1, 10000};

  CheckOptions check;
  std::vector<std::string> locked_joints;  ///< joints that stay bit-identical
  std::array<bool, 2> locked_feet = {};    ///< feet that keep their paths (0.01 mm), by Side
  /// Windows [begin, end] in which samples stay bit-identical; begin == end fixes one posture, but
  /// not its velocity [s].
  std::vector<std::pair<double, double>> locked_windows;
  std::map<std::string, double> joint_weights;  ///< factors on the cost of moving a joint
  Trust trust = Trust::posture;  ///< quantity that is kept where posture, COG and ZMP disagree
  /// Factor on the robustness cost; 0 for the smallest change that passes the check.
  double safety = 1;
  /// Whether a stopped repair concludes with the point of the smallest violation so far.
  bool keep_partial = false;
  double knot_spacing = repair_policy::knots::kSpacing;  ///< distance of the B-splines' knots [s]
  /// The wanted distance of the ZMP from the support edge if the motion has less [m]; without a
  /// value: safe_margin().
  std::optional<double> zmp_margin;
  /// Largest number of Ipopt's iterations in each round.
  int max_iterations = repair_policy::rounds::kMostIterations;
  /// Largest work for each second of the motion. A motion of less than five seconds has the work of
  /// five seconds. If the motion was made smooth and its repair failed, the repair of the motion as
  /// it was given may do this work once more.
  double most_work = repair_policy::rounds::kMostWork;
  bool mumps = false;  ///< whether MUMPS solves the linear systems, for comparison
  /// Random start of the first program, to test how little depends on it.
  RandomStart random_start;
  /// This function is called with the check of the given motion, and of every motion that is found
  /// after that. Its errors are the ones that the repair has to remove. See remaining_errors().
  std::function<void(const ConsistencyReport& check)> on_check = {};
};

enum class RepairStatus { already_consistent, repaired, infeasible, not_converged };
/// Defined in the header, so that results can be written as text without the solver.
inline const char* name_of(RepairStatus status) {
  constexpr const char* kNames[] = {"already_consistent", "repaired", "infeasible",
                                    "not_converged"};
  return kNames[static_cast<int>(status)];
}

/// An error that no correction removed (infeasibility_report.hpp).
struct InfeasibilityCause {
  Finding finding;        ///< the finding in the nearest motion that was found
  double violation = 0;   ///< worst / limit, or worst - limit for lengths and angles
  bool is_ratio = false;  ///< whether `violation` is a ratio; otherwise it has the finding's unit
  /// The window would pass if it took longer by this factor; 0 if it would not.
  double time_factor = 0;
  std::string text;  ///< the complete reason in words
};

/// The work of the solver in all rounds that led to the result. Only the seconds differ from run to
/// run.
struct RepairWork {
  int rounds = 0, iterations = 0;
  int variables = 0, constraints = 0;               ///< numbers in the last round
  int jacobian_nonzeros = 0, hessian_nonzeros = 0;  ///< numbers in the last round
  double amount = 0;            ///< amount of work, as NlpSolution::work; it is limited
  double function_seconds = 0;  ///< time in functions and derivatives
  double solver_seconds = 0;    ///< time in Ipopt itself
};

struct RepairResult {
  RepairStatus status = RepairStatus::not_converged;
  bool partial = false;  ///< the caller stopped the repair: the point with the smallest violation
  CorrectionTrack correction;   ///< correction; empty if the series was consistent
  CommandSeries series;         ///< the repaired command series at its full rate
  ConsistencyReport before;     ///< check of the given series
  ConsistencyReport check;      ///< check of `series`
  MotionChange moved;           ///< change from the given series to `series`
  WeightedChange change;        ///< the same, weighted: the quantity that was minimized
  double max_joint_change = 0;  ///< largest change of a joint [rad]
  double max_cog_change = 0;    ///< largest change of the COG [m]
  std::string where;            ///< joint that moved most
  double at = 0;                ///< time at which it moved most [s]
  /// Numbers of variables and constraints in the last round, and of iterations in all rounds.
  int variables = 0, constraints = 0, iterations = 0;
  double constraint_violation = 0;  ///< scaled violation in the last program
  /// Causes if the motion was not repaired, the most severe first.
  std::vector<InfeasibilityCause> causes;
  std::vector<std::string> reasons;  ///< the first of them in words
  RepairWork work;
};

/// The ZMP margin with which the robot stands after a walk in open loop, although its servos sag
/// and its feet land a little early [m]: 0.9 times the radius of the largest circle about the
/// centre of the smaller sole.
double safe_margin(const RobotModel& model);

/// The errors of a motion in words with their times, the most severe first. Errors of one kind at
/// one place are named once, where they are worst. Empty if the motion passes.
std::vector<std::string> remaining_errors(const ConsistencyReport& check);

/// Throws Error(usage) for a joint, window or weight that does not exist or is out of range and for
/// options out of bounds, even if the motion is consistent, and Interrupted if `progress` stops the
/// work and no partial result is wanted.
RepairResult repair(const RobotModel& model, const CommandSeries& series,
                    const RepairOptions& options = {}, const Progress& progress = {});

}  // namespace ayumi
