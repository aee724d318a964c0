// Windows are enough because the effect of a correction decays. Its effect on the COG decays as
// exp(-omega t), with omega of about 6 1/s for a small robot, so 5 % are left after half a second.
// The ZMP margin at the edge of the window absorbs the rest. If this is not enough, the windows
// grow, at last to the whole motion.
#include "ayumi/repair/repair_rounds.hpp"

#include <algorithm>

#include "ayumi/repair/initial_guess.hpp"
#include "ayumi/repair/repair_setup.hpp"

namespace ayumi {

namespace policy = repair_policy;

namespace {

using FoundAt = std::pair<FindingKind, std::string>;  // kind and place of a finding

// Values that one round passes to the next.
struct RoundMemory {
  int round = 0;
  int unsolved = 0;                          // number of rounds without a solution
  int halvings = 0;                          // number of halvings of the spacing of the knots
  double pad = policy::rounds::kFreeAround;  // free time around a finding [s]
  std::vector<Finding> findings = {};        // findings of all rounds
  std::set<FoundAt> errors = {};             // errors that the last round left, if it was solved
};

// If a motion is repaired at all, a margin that only causes a warning is repaired, too.
bool has_full_margin(const ConsistencyReport& report) {
  return std::none_of(report.findings.begin(), report.findings.end(), [](const Finding& f) {
    return spec_of(f.kind).repair.warnings_too && f.severity == Severity::warning;
  });
}

// If a result passes although its program was not solved to the end, one more round is made.
bool is_over(const RepairState& state, const RoundMemory& memory) {
  if (memory.round >= policy::rounds::kMost || memory.unsolved >= policy::rounds::kMostUnsolved)
    return true;
  if (memory.round > 0 && work_left(state, policy::rounds::kWorkForReasons) <= 0) return true;
  if (memory.round > 0) return is_done(state);
  return state.result.check.consistent && has_full_margin(state.result.check);
}

void choose_windows(RepairState& state, RoundMemory& memory) {
  const std::vector<Finding>& now = state.result.check.findings;
  memory.findings.insert(memory.findings.end(), now.begin(), now.end());
  for (const Finding& f : now)
    if (f.severity == Severity::error && memory.round > 0)
      state.spec.extra_times.insert(state.spec.extra_times.end(), {f.begin, f.at, f.end});
  state.spec.windows = windows_around(memory.findings, memory.pad);
  add_near_pairs(state.model, state.result.series, state.collisions, state.spec.near_pairs);
}

// A first program without a solution may only have been stopped too early. So finer knots are tried
// first; then the soft goals are left out, before the repair ends.
void widen_after_failure(RepairState& state, RoundMemory& memory) {
  if (state.status == NlpStatus::solved) return;
  if (memory.round > 0 || state.flight) ++memory.unsolved;
  memory.pad *= 2;
  if (memory.unsolved <= 1 && state.status != NlpStatus::infeasible) return;
  state.spec.safe_margin = state.spec.zmp_margin;
  state.spec.swing_goals = false;
  state.spec.sole_at_knots = 1;
}

// In the next round, the motion keeps a larger distance from the limits.
void increase_backoff(CorrectionSpec& spec, int round) {
  if (2 * (round + 1) >= policy::rounds::kMost) spec.swing_goals = false;
  spec.joint_margin += policy::kBackoffStep.joint_position;
  spec.limit_share -= policy::kBackoffStep.limit_share;
}

// If an error remains although points were added for it, or if no solution is found, the knots are
// too far apart: a sole that has to stay in its place needs a finer spline.
void refine_knots(RepairState& state, RoundMemory& memory) {
  if (state.result.check.consistent) return;
  const bool solved = state.status == NlpStatus::solved;
  std::set<FoundAt> errors;
  bool again = memory.round + 2 == policy::rounds::kMost || !solved;
  for (const Finding& f : state.result.check.findings) {
    if (f.severity != Severity::error) continue;
    errors.emplace(f.kind, f.where);
    again = again || memory.errors.contains({f.kind, f.where});
  }
  memory.errors = solved ? errors : std::set<FoundAt>();
  const double finest = policy::knots::kFewestSamples * state.series.dt;
  if (!again || memory.halvings == policy::knots::kMostHalvings || state.track.spacing < finest)
    return;
  ++memory.halvings;
  memory.errors.clear();
  state.spec.spacing = state.track.spacing / 2;
  if (state.spec.initial.size() > 0) state.spec.initial = with_halved_knots(state.spec.initial);
}

void solve_round(RepairState& state, RoundMemory& memory) {
  if (state.result.check.consistent) state.passing = state.track;
  choose_windows(state, memory);
  solve_program(state, "repair round " + std::to_string(memory.round + 1),
                policy::rounds::kTolerance);
  state.spec.zmp_margin += policy::kBackoffStep.zmp;
  state.spec.safe_margin += policy::kBackoffStep.zmp;
  widen_after_failure(state, memory);
  increase_backoff(state.spec, memory.round);
  refine_knots(state, memory);
  ++memory.round;
}

// Keeps the point with the smallest violation of a program that was stopped.
void keep_partial(RepairState& state) {
  state.result.partial = true;
  state.status = NlpStatus::iteration_limit;
  if (!state.problem) return;
  const int count = state.problem->variable_count();
  if (state.least_violating.size() >= count)
    take(state, state.problem->track(state.least_violating.head(count)));
}

}  // namespace

void solve_rounds(RepairState& state) {
  state.spec.free_ends =
      faulty_ends(state.result.check, state.series.duration(), state.spec.spacing);
  RoundMemory memory;
  try {
    while (!is_over(state, memory)) solve_round(state, memory);
  } catch (const Interrupted&) {
    if (!state.options.keep_partial) throw;
    return keep_partial(state);
  }
  if (!state.result.check.consistent && state.passing) take(state, *state.passing);
}

}  // namespace ayumi
