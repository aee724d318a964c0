#include "ayumi/repair/tighten_to_check_limits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ayumi/motion/differentiate.hpp"
#include "ayumi/repair/repair_setup.hpp"

namespace ayumi {

namespace policy = repair_policy;

CorrectionSpec at_check_limits(const CorrectionSpec& spec, const CorrectionSpec& asked,
                               double robustness) {
  const bool reached = spec.safe_margin > spec.zmp_margin;
  CorrectionSpec limits = spec;
  limits.zmp_margin = asked.zmp_margin;
  limits.safe_margin = reached ? asked.safe_margin : asked.zmp_margin;
  // The goals of the swings may have been left out in the rounds, although there is a solution with
  // them.
  limits.swing_goals = spec.swing_goals || (reached && asked.swing_goals);
  limits.at_check_limits = true;
  limits.joint_margin = policy::kRounding;
  limits.limit_share = 1 - policy::kRounding;
  limits.least_normal_force = spec.tolerance[FindingKind::unilateral];
  if (robustness > 0) return limits;
  limits.least_normal_force = policy::kRounding;
  limits.clearance = policy::kRounding;
  limits.swing_goals = false;
  limits.zmp_margin = limits.safe_margin = policy::tighten::kZmpMargin;
  return limits;
}

CorrectionTrack between(const CorrectionTrack& a, const CorrectionTrack& b, double share) {
  CorrectionTrack track = a;
  track.coefficients += share * (b.coefficients - a.coefficients);
  return track;
}

namespace {

// Whether the table of the result passes. In a table, rates are differences of rows.
bool table_passes(const RepairState& state) {
  CommandSeries table = state.result.series;
  fill_rates(table.samples, table.dt, false);
  return report_of(state, table).consistent;
}

// The previous correction that passed, and whether its table passed.
struct PassingResult {
  RepairResult result;
  CorrectionTrack track;
  bool as_table;
};

// Keeps the result if it passes. Otherwise, moves it back towards the correction that passed, by a
// share `most_back` of their difference or less, so that it passes. Returns false and does not
// change the result if the motion with the share `most_back` does not pass; smaller shares are not
// tried then.
bool take_first_passing(RepairState& state, const PassingResult& passing, double most_back) {
  auto passes = [&] {
    return state.result.check.consistent && (!passing.as_table || table_passes(state));
  };
  if (passes()) return true;
  const CorrectionTrack wanted = state.track;
  RepairResult result = state.result;
  take(state, between(wanted, passing.track, most_back));
  if (!passes()) {
    state.result = std::move(result);
    state.track = wanted;
    return false;
  }
  // Bisection over the shares kFirstBack * kBackFactor^i finds a small share whose motion passes.
  // It is the smallest share that passes, provided that all larger shares pass, too.
  std::vector<double> shares;
  for (double share = policy::tighten::kFirstBack; share < most_back;
       share *= policy::tighten::kBackFactor)
    shares.push_back(share);
  CorrectionTrack nearest = state.track;
  result = state.result;
  size_t first = 0, end = shares.size();
  while (first < end) {
    const size_t middle = (first + end) / 2;
    take(state, between(wanted, passing.track, shares[middle]));
    if (!passes()) {
      first = middle + 1;
      continue;
    }
    end = middle;
    nearest = state.track;
    result = state.result;
  }
  state.result = std::move(result);
  state.track = nearest;
  return true;
}

void set_limits_of_the_check(RepairState& state) {
  const double spacing = state.track.spacing;
  state.spec.active = state.problem->beside_active(state.problem->point(state.track.coefficients));
  state.spec = at_check_limits(state.spec, state.asked, state.options.safety);
  state.spec.spacing = spacing;
  state.spec.initial = state.track.coefficients;
}

void solve_at_the_limits(RepairState& state, const PassingResult& passing) {
  const double tolerance =
      std::clamp(policy::tighten::kTolerance * state.objective, policy::tighten::kLeastTolerance,
                 policy::tighten::kMostTolerance);
  for (int round = 0; round < policy::tighten::kMostRounds; ++round) {
    if (work_left(state, policy::rounds::kWorkForReasons) <= 0) {
      state.status = NlpStatus::iteration_limit;
      return;
    }
    solve_program(state, "repairing, searching for the least change", tolerance);
    if (state.status != NlpStatus::solved || state.result.check.consistent) return;
    const bool last = round + 1 == policy::tighten::kMostRounds;
    const double most_back =
        round == 0 ? policy::tighten::kMostBack : policy::tighten::kMostBackLater;
    if (!last && take_first_passing(state, passing, most_back)) return;
    add_error_times(state.result.check, state.series.dt, state.spec.extra_times);
    state.spec.initial =
        between(state.track, passing.track, policy::tighten::kStartBack).coefficients;
  }
}

}  // namespace

void tighten(RepairState& state) {
  const PassingResult passing = {state.result, state.track, table_passes(state)};
  set_limits_of_the_check(state);
  try {
    solve_at_the_limits(state, passing);
  } catch (const Interrupted&) {
    if (!state.options.keep_partial) throw;
    state.result = passing.result;
    state.result.partial = true;
    return;
  }
  if (state.status == NlpStatus::solved && take_first_passing(state, passing, 1)) return;
  take(state, passing.track);
  state.result.constraint_violation = passing.result.constraint_violation;
  state.status = NlpStatus::solved;
}

}  // namespace ayumi
