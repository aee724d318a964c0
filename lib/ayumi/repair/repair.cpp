// The stages of a repair:
//   setup      check the motion, and decide how finely a correction has to act
//   rounds     solve, add the correction to the motion, check again (repair_rounds)
//   tighten    from a correction that passes to the least one (tighten_to_check_limits)
//   relaxed    if no round passes, find what prevents a repair (infeasibility_report)
//   conclude   determine status and reasons
// A motion with jumps or noise is first made smooth (rough_motion); if its repair fails, the motion
// is repaired as it was given. All changes are measured from the given motion.
#include "ayumi/repair/repair.hpp"

#include <algorithm>

#include "ayumi/base/text.hpp"
#include "ayumi/motion/correction.hpp"
#include "ayumi/repair/infeasibility_report.hpp"
#include "ayumi/repair/overlapping_feet.hpp"
#include "ayumi/repair/repair_rounds.hpp"
#include "ayumi/repair/repair_setup.hpp"
#include "ayumi/repair/repair_state.hpp"
#include "ayumi/repair/resting_joints.hpp"
#include "ayumi/repair/robustness_cost.hpp"
#include "ayumi/repair/rough_motion.hpp"
#include "ayumi/repair/tighten_to_check_limits.hpp"

namespace ayumi {

namespace policy = repair_policy;

namespace {

// The motion without a correction, with COG, ZMP and f_z of the full model: errors that remain are
// faults of the motion itself.
void set_up(RepairState& state) {
  state.spec = state.asked;
  state.spec.collisions = &state.collisions;
  state.spec.wrong_plan = wrong_plan(state.result.before);
  state.spec.resting =
      rests_at_limits(state.model, state.series, state.model.limits(state.spec.profile),
                      state.result.before.findings);
  const CorrectionProblem nothing_moves(state.model, state.series, state.spec);
  take(state, nothing_moves.track(Eigen::VectorXd()));
  state.as_given = state.result;
  state.flight = flight_is_at_fault(state.result.check);
  const double finest = policy::knots::kFewestSamples * state.series.dt;
  state.spec.spacing =
      std::min(state.spec.spacing, spacing_of_faults(state.series, state.result.check, finest));
}

RepairStatus status_of(const RepairState& state) {
  if (state.result.check.consistent && !state.result.partial) return RepairStatus::repaired;
  return state.status == NlpStatus::infeasible ? RepairStatus::infeasible
                                               : RepairStatus::not_converged;
}

void give_reasons(RepairState& state) {
  RepairResult& result = state.result;
  result.causes = infeasibility_report(state.model, result.series, result.check, state.options);
  if (state.overlap) result.reasons.push_back(words_of(*state.overlap));
  const size_t count = result.causes.size();
  const size_t named = std::min(count, policy::infeasible::kMostReasons);
  for (size_t i = 0; i < named; ++i) result.reasons.push_back(result.causes[i].text);
  if (count > named)
    result.reasons.push_back(count - named == 1
                                 ? "there is 1 more error"
                                 : "there are " + std::to_string(count - named) + " more errors");
  if (!state.cut_short_by.empty())
    result.reasons.push_back("the search stopped, because it reached the " + state.cut_short_by +
                             ". So it is not known whether a repair exists. The reasons above "
                             "are the errors of the motion before any repair");
}

// `before` is the check of the given motion.
void measure_change(const RepairState& given, const ConsistencyReport& before,
                    RepairResult& result) {
  const RobotModel& model = given.model;
  const CommandSeries& series = given.series;
  result.before = before;
  result.moved = motion_change(model, series, result.series);
  result.change = weighted_change(model, series, result.series, given.asked.weights);
  result.change.safety =
      robustness_cost(model, series, result.series, given.options, result.before);
  result.max_joint_change = result.moved.joint.size;
  result.max_cog_change = result.moved.cog.size;
  result.at = result.moved.joint.at;
  if (!result.moved.joints.empty()) result.where = result.moved.joints.front().joint;
}

void conclude(RepairState& state) {
  state.result.status = status_of(state);
  if (state.result.status != RepairStatus::repaired && !state.result.partial) give_reasons(state);
  if (state.options.on_check) state.options.on_check(state.result.check);
}

void require_knot_spacing(const RepairOptions& options, double dt) {
  if (options.knot_spacing > 2 * dt) return;
  fail(ErrorCode::usage, "knot spacing " + text::exact(options.knot_spacing) +
                             " s must be above two samples (" + text::exact(2 * dt) + " s)");
}

RepairResult repair_to_the_end(RepairState& state) {
  set_up(state);
  const RobotModel& model = state.model;
  const CommandSeries& series = state.series;
  state.overlap = overlapping_feet(model, series, state.result.before);
  if (state.overlap || locked_out(state.spec, state.result.check))
    state.status = NlpStatus::infeasible;
  else
    solve_rounds(state);
  const bool solved_any = state.result.work.rounds > 0;
  if (solved_any && !state.result.check.consistent && !state.result.partial) solve_relaxed(state);
  if (solved_any && is_done(state) && !state.flight) tighten(state);
  conclude(state);
  return state.result;
}

// The repair of the motion that smooth curves have made of `series` in these windows.
RepairResult repair_smoothed(const RobotModel& model, const CommandSeries& series,
                             const std::vector<SmoothWindow>& windows, const RepairOptions& options,
                             const Progress& progress) {
  const CommandSeries smooth = apply_smoothing(model, series, windows);
  RepairState state = repair_state(model, smooth, options, progress);
  RepairResult result = repair_to_the_end(state);
  result.correction.smooth = windows;
  return result;
}

// Smooth curves may also make a motion worse that could be repaired without them.
RepairResult repair_given(RepairState& state) {
  const std::vector<SmoothWindow> windows =
      rough_windows(state.model, state.series, state.result.check, state.options);
  if (!windows.empty()) {
    RepairResult result =
        repair_smoothed(state.model, state.series, windows, state.options, state.progress);
    if (result.status == RepairStatus::repaired || result.partial) return result;
  }
  return repair_to_the_end(state);
}

}  // namespace

RepairResult repair(const RobotModel& model, const CommandSeries& series,
                    const RepairOptions& options, const Progress& progress) {
  require_knot_spacing(options, series.dt);
  require_within("the weight of safety", options.safety, RepairOptions::kSafety);
  if (options.zmp_margin)
    require_within("the wanted margin of the ZMP", *options.zmp_margin, RepairOptions::kZmpMargin);
  require_within("the largest number of iterations", options.max_iterations,
                 RepairOptions::kMaxIterations);
  RepairState state = repair_state(model, series, options, progress);
  const ConsistencyReport before = state.result.check;
  if (before.consistent) {
    state.result.status = RepairStatus::already_consistent;
    return state.result;
  }
  RepairResult result = repair_given(state);
  measure_change(state, before, result);
  return result;
}

}  // namespace ayumi
