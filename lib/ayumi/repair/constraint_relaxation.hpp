#pragma once
// Relaxation of a program: chosen rows may be violated at a price, by slack variables that the rows
// of one limit share within a window of time. Two programs use it. In the rounds, soft goals beyond
// the check (a safe ZMP margin, gentle landings, high swings, the planned DCM) are relaxed, each
// with a linear price. If no round succeeds, every limit is relaxed, and the limits that are then
// violated prevent the repair.

#include "ayumi/repair/correction_problem.hpp"

namespace ayumi {

/// Slack variables of a relaxed program.
struct Slacks {
  std::vector<int> group;  ///< index of the slack of each row; -1 for rows that are not relaxed
  Eigen::VectorXd unit;    ///< violation of the rows of each slack, for a slack of 1
  Eigen::VectorXd price;   ///< penalty of each slack in the objective, for a slack of 1
  Eigen::VectorXd most;    ///< upper bound of each slack; empty for no bound
  /// Each slack starts larger by this amount than the start of the program needs.
  double start = repair_policy::solver::kSlackStart;
};

/// Adds a variable s >= 0 for each slack. Its rows become g >= lower - unit s and g <= upper + unit
/// s, and price . s is added to the objective. The relaxation is exact if the price exceeds the
/// multipliers. Rows with two bounds appear twice. The result refers to `nlp`, which must outlive
/// it.
Nlp relaxed(const Nlp& nlp, const Slacks& slacks);

/// The multipliers of the rows of `nlp`, computed from those of relaxed(nlp, slacks).
Eigen::VectorXd unrelaxed_multipliers(const Nlp& nlp, const Slacks& slacks,
                                      const Eigen::VectorXd& multipliers);

/// The cost of a violation of rows, in addition to the weighted change. It is `change` [s], in the
/// measure of weighted_change(), for every `unit` of the largest violation of one limit in a
/// `window` [s].
struct ViolationPrice {
  double unit = 0, change = 0, window = 0;
};
ViolationPrice price_of(const RowKind& kind);

/// The program of `problem` in which every limit is relaxed, for each limit and window. Feet on the
/// ground and flights are violated last, and locked postures are never violated.
Nlp with_all_limits_relaxed(const CorrectionProblem& problem, const Nlp& nlp, double dt);

/// The slack variables that relax the soft goals of `problem`: the ZMP's safe margin down to the
/// smallest margin, and swings and the planned DCM without a bound. If there are no soft goals,
/// smallest margin, and swings and the planned DCM without a bound. If there are no soft goals,
/// there are no prices. `robustness` is a factor on the prices. `barrier` is the initial barrier
/// parameter of the solver; with a larger one, the slacks start larger.
Slacks soft_goal_slacks(const CorrectionProblem& problem, double dt, double robustness,
                        double barrier);

}  // namespace ayumi
