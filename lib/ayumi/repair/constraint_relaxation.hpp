#pragma once
// Relaxation of a program: chosen rows may be violated at a price, by slack variables that rows of
// one limit share within a window of time. Two programs use it. In the rounds, soft goals beyond
// the check (a safe ZMP margin, gentle landings, high swings, the planned DCM) are relaxed, each
// with a linear price. Where no round succeeds, every limit is relaxed, and what is then violated
// stands in the way.

#include "ayumi/repair/correction_problem.hpp"

namespace ayumi {

/// Slack variables of a relaxed program.
struct Slacks {
  std::vector<int> group;  ///< index of the slack of each row; -1 for rows that stay hard
  Eigen::VectorXd unit;    ///< violation of the rows of each slack, for a slack of 1
  Eigen::VectorXd price;   ///< penalty of each slack in the objective, for a slack of 1
  Eigen::VectorXd most;    ///< upper bound of each slack; empty: no bound
  double start = repair_policy::solver::kSlackStart;  ///< distance of each slack from the value
                                                      ///< that the start needs
};

/// Adds a variable s >= 0 for each slack: g >= lower - unit s, g <= upper + unit s for its rows,
/// and price . s in the objective (exact where the price exceeds the multipliers). Rows with two
/// bounds appear twice. Refers to `nlp`, which must outlive it.
Nlp relaxed(const Nlp& nlp, const Slacks& slacks);

/// Multipliers of the rows of `nlp` from those of relaxed(nlp, slacks).
Eigen::VectorXd unrelaxed_multipliers(const Nlp& nlp, const Slacks& slacks,
                                      const Eigen::VectorXd& multipliers);

/// Cost of a violation of rows, in addition to the weighted change: `change` [s], in the measure of
/// weighted_change(), for every `unit` of the largest violation of one limit in a `window` [s].
struct ViolationPrice {
  double unit = 0, change = 0, window = 0;
};
ViolationPrice price_of(const RowKind& kind);

/// The program of `problem` in which every limit is relaxed, for each limit and window. Feet on the
/// ground and flights are violated last, and locked postures never.
Nlp with_all_limits_relaxed(const CorrectionProblem& problem, const Nlp& nlp, double dt);

/// The slack variables that relax the soft goals of `problem`: the ZMP's safe margin down to the
/// least margin, and swings and the planned DCM without bound; no prices where there are no soft
/// goals. `robustness` is a factor on the prices; `barrier` the one that the solution starts with,
/// which asks for that much more of each slack.
Slacks soft_goal_slacks(const CorrectionProblem& problem, double dt, double robustness,
                        double barrier);

}  // namespace ayumi
