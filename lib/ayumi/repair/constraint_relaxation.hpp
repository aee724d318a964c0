#pragma once
// A program without a solution made soft: rows may be violated, by groups, at a price. What it then
// violates is what stands in the way.

#include "ayumi/repair/correction_problem.hpp"

namespace ayumi {

/// What gives way: `group` by row, -1 for rows that stay hard; by group what one of it is worth in
/// the row, its price, and the most there may be of it (empty: no end).
struct Slacks {
  std::vector<int> group;
  Eigen::VectorXd unit, price, most;
  double start = 0.01;  ///< more than is needed
};

/// One more variable s >= 0 per group: g >= lower - unit s, g <= upper + unit s for its rows, and
/// price . s in the objective (exact where the price exceeds the multipliers). Rows with two bounds
/// appear twice. Refers to `nlp`, which must outlive it.
Nlp elastic(const Nlp& nlp, const Slacks& slacks);

/// What a lack of one kind costs: `change`, in the measure of weighted_change() [s], for every
/// `unit` in the row that the largest lack of one limit has in a window of time [s].
struct Price {
  double unit = 0, change = 0, window = 0;
};
Price price_of(ConstraintGroup group);

/// The program of `problem` with every limit soft, per limit and tenth of a second. Feet on the
/// ground and flight are the last to give way.
Nlp elastic(const CorrectionProblem& problem, const Nlp& nlp, double dt);

/// The program of `problem` with what no check asks for to be had at a price, and to give way where
/// it costs more change than it is worth or is not to be had: the ZMP's safety, as far as to the
/// least margin asked for, landings over their places, feet off the ground, and xi and ZMP where
/// the plan has them. `factor` on the prices; `barrier` that the solution starts with, which asks
/// for so much more of each slack than is needed.
Nlp with_soft_safety(const CorrectionProblem& problem, const Nlp& nlp, double dt, double factor = 1,
                     double barrier = NlpOptions().start_barrier);

}  // namespace ayumi
