#pragma once
// The nearest consistent pattern: smooth corrections (cubic B-splines) to base and joints that
// bring a command series back inside all limits of the check with least change, found by Ipopt.
//
// Ipopt takes Ayumi's linear solver under the name MA27, in one place of the whole process. That
// place is held only while a repair runs, for the threads that run one, and it is empty again
// afterwards. A host program that has its own MA27 keeps it, and repairs then use MUMPS. See
// repair/nlp/nlp.hpp.

#include <array>
#include <cstdint>
#include <functional>
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
#include "ayumi/repair/policy.hpp"
#include "ayumi/repair/weighted_change.hpp"

namespace ayumi {

/// Control points at random: joints and base rotation within +-size [rad], the base within a tenth
/// of it [m].
struct RandomStart {
  double size = 0;  ///< 0: the search starts as usual
  std::uint64_t seed = 0;
};

/// The series is a plan (sample_plan) and not yet a motion: the feet are moved to their places in
/// the plan, and the COG stays near the plan along the axes that count.
struct Generation {
  std::array<bool, 3> cog = {};  ///< x, y, z
};

struct RepairOptions {
  CheckOptions check;
  std::vector<std::string> locked_joints;  ///< joints that stay bit-identical
  std::array<bool, 2> locked_feet = {};    ///< by Side: feet that keep their paths (0.01 mm)
  /// Windows [begin, end] in which samples are bit-identical; begin == end fixes one posture, not
  /// its velocity [s].
  std::vector<std::pair<double, double>> locked_windows;
  std::map<std::string, double> joint_weights;  ///< factors on the cost of moving a joint
  Trust trust = Trust::posture;
  /// Factor on the robustness cost; 0: the smallest change that passes the check.
  double safety = 1;
  bool keep_partial = false;  ///< when stopped, conclude with the least violating point seen
  double knot_spacing = repair_policy::knots::kSpacing;  ///< of the B-splines [s]
  /// Wanted distance of the ZMP from the support edge where the motion has less [m]; none:
  /// safe_margin().
  std::optional<double> zmp_margin;
  int max_iterations = repair_policy::rounds::kMostIterations;  ///< of Ipopt in each round
  /// For each second of the motion, and for five seconds at least.
  double most_work = repair_policy::rounds::kMostWork;
  bool mumps = false;        ///< linear systems by MUMPS, to compare
  RandomStart random_start;  ///< of the first program, to see how little depends on the start
  std::optional<Generation> generate = {};
  /// Called with the check of the motion as it is given, and of every motion found after that: its
  /// errors are the ones that the repair has to remove. See remaining_errors().
  std::function<void(const ConsistencyReport& check)> on_check = {};
};

enum class RepairStatus { already_consistent, repaired, infeasible, not_converged };
/// In the header, so that results are written as text without the solver.
inline const char* name_of(RepairStatus status) {
  constexpr const char* kNames[] = {"already_consistent", "repaired", "infeasible",
                                    "not_converged"};
  return kNames[static_cast<int>(status)];
}

/// An error that no correction removed (infeasibility_report.hpp).
struct InfeasibilityCause {
  Finding finding;         ///< as in the nearest motion found
  double violation = 0;    ///< worst / limit, or worst - limit for lengths and angles
  bool is_ratio = false;   ///< `violation` is a ratio, else in the finding's unit
  double time_factor = 0;  ///< the window would pass if it took this much longer; 0: it would not
  std::string text;        ///< the whole in words
};

/// Work of the solver, over all rounds. Only the seconds differ from run to run.
struct RepairWork {
  int rounds = 0, iterations = 0;
  int variables = 0, constraints = 0;               ///< of the last round
  int jacobian_nonzeros = 0, hessian_nonzeros = 0;  ///< of the last round
  double amount = 0;                                ///< NlpSolution::work; it is limited
  double function_seconds = 0;                      ///< in functions and derivatives
  double solver_seconds = 0;                        ///< in Ipopt itself
};

struct RepairResult {
  RepairStatus status = RepairStatus::not_converged;
  bool partial = false;         ///< stopped by the caller: the least violating point
  CorrectionTrack correction;   ///< empty when the series was consistent
  CommandSeries series;         ///< the repaired command series, full rate
  ConsistencyReport before;     ///< of the series as given
  ConsistencyReport check;      ///< of `series`
  MotionChange moved;           ///< from the series as given to `series`
  WeightedChange change;        ///< the same, weighted: the quantity that was minimized
  double max_joint_change = 0;  ///< [rad]
  double max_cog_change = 0;    ///< [m]
  std::string where;            ///< joint that moved most
  double at = 0;                ///< time at which it moved most [s]
  int variables = 0, constraints = 0, iterations = 0;
  double constraint_violation = 0;         ///< scaled, of the last program
  std::vector<InfeasibilityCause> causes;  ///< when not repaired, the most severe first
  std::vector<std::string> reasons;        ///< the first few of them in words
  RepairWork work;
};

/// A ZMP margin with which a walk played open loop stands, although its servos sag and its feet
/// land a little early [m]: 0.9 of the radius of the largest circle about the centre of the smaller
/// sole.
double safe_margin(const RobotModel& model);

/// The errors of a motion in words, with their times, the most severe first; errors of one kind at
/// one place are named once, where they are worst. Empty where the motion passes.
std::vector<std::string> remaining_errors(const ConsistencyReport& check);

/// Throws Error(usage) for a joint, window or weight that does not exist or is out of range, and
/// Interrupted when `progress` stops the work and no partial result is wanted.
RepairResult repair(const RobotModel& model, const CommandSeries& series,
                    const RepairOptions& options = {}, const Progress& progress = {});

}  // namespace ayumi
