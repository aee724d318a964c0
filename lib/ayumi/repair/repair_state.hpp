#pragma once
// The data that the stages of one repair share: the request, the program of the last round, and the
// best result so far. The stages are functions of this state: repair_rounds,
// tighten_to_check_limits and infeasibility_report.

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "ayumi/repair/correction_problem.hpp"
#include "ayumi/repair/overlapping_feet.hpp"
#include "ayumi/repair/repair.hpp"

namespace ayumi {

struct RepairState {
  // The members of the request.
  const RobotModel& model;
  const CommandSeries& series;
  const RepairOptions& options;
  const Progress& progress;
  const CollisionModel collisions;
  CorrectionSpec asked;  ///< specification of the first round
  bool flight = false;   ///< whether a flight is at fault

  // These members describe the rounds so far.
  CorrectionSpec spec = {};                       ///< specification of the next program
  std::optional<CorrectionProblem> problem = {};  ///< the last program
  NlpStatus status = NlpStatus::failed;           ///< status of the last program
  double objective = 0;                           ///< objective of the last program
  double barrier = 0;  ///< approximate barrier parameter with which the last program ended
  std::deque<CommandSeries> earlier = {};  ///< results of earlier rounds, which `spec` refers to
  Eigen::VectorXd least_violating = {};  ///< point of the last program with the smallest violation

  /// Multipliers of those rows of the last program for which they are not 0, by sample, kind, item
  /// and line. The next program also has most of these rows.
  std::map<std::tuple<int, const RowKind*, int, int>, double> multipliers = {};

  // These members describe the result so far.
  CorrectionTrack track = {};  ///< every control point of the result
  RepairResult result = {};
  RepairResult as_given = {};                   ///< the motion itself, with its own COG and ZMP
  std::optional<CorrectionTrack> passing = {};  ///< an earlier result that passes the check
  /// The limit that stopped the search for the reasons, in words; empty if none did.
  std::string cut_short_by = {};
  std::optional<OverlappingFeet> overlap =
      {};  ///< feet that are planned at the same place, in which case there is no solution
};

/// The state before the first round, with the check of the motion as it is given.
RepairState repair_state(const RobotModel& model, const CommandSeries& series,
                         const RepairOptions& options, const Progress& progress);

/// Makes the motion with this correction the result, and checks it.
void take(RepairState& state, const CorrectionTrack& track);

/// The check of a motion. A trusted quantity is judged as it was commanded, and not as the
/// corrected motion has it.
ConsistencyReport report_of(const RepairState& state, const CommandSeries& series);

/// Whether the result passes and its program was solved to the end.
bool is_done(const RepairState& state);

/// Solves one program from `spec` and takes its result; the next program starts from this result if
/// the program was solved or nearly solved. Throws Interrupted.
void solve_program(RepairState& state, const std::string& stage, double tolerance);

/// Options of the solver, for a warm start if the start violates little.
NlpOptions nlp_options(RepairState& state, bool warm);

/// The work that may still be done when a share of the whole is reserved. It is below 0 if the
/// limit is reached.
double work_left(const RepairState& state, double kept_back);

/// Adds the work of one solution to the result.
void note_work(RepairState& state, const Nlp& nlp, const NlpSolution& solution);

}  // namespace ayumi
