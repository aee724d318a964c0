#include "ayumi/repair/repair_state.hpp"

#include <algorithm>

#include "ayumi/repair/constraint_relaxation.hpp"
#include "ayumi/repair/initial_guess.hpp"
#include "ayumi/repair/repair_setup.hpp"

namespace ayumi {

namespace policy = repair_policy;

using Eigen::VectorXd;

RepairState repair_state(const RobotModel& model, const CommandSeries& series,
                         const RepairOptions& options, const Progress& progress) {
  RepairState state{
      model, series, options, progress, CollisionModel(model), repair_spec(model, series, options)};
  state.result.series = series;
  state.result.check = state.result.before = check_consistency(model, series, options.check);
  if (options.on_check) options.on_check(state.result.check);
  return state;
}

ConsistencyReport report_of(const RepairState& state, const CommandSeries& series) {
  const RepairOptions& options = state.options;
  if (options.trust == Trust::posture) return check_consistency(state.model, series, options.check);
  CommandSeries judged = series;
  for (size_t k = 0; k < judged.samples.size(); ++k) {
    const CommandSample& commanded = state.series.samples[k];
    if (options.trust == Trust::cog) judged.samples[k].cog = commanded.cog;
    if (options.trust == Trust::zmp) judged.samples[k].zmp = commanded.zmp;
  }
  return check_consistency(state.model, judged, options.check);
}

void take(RepairState& state, const CorrectionTrack& track) {
  state.track = track;
  RepairResult& result = state.result;
  result.correction = kept_at(trimmed(track), state.spec.kept_times);
  result.series = apply_correction(state.model, state.series, result.correction);
  result.check = report_of(state, result.series);
  if (state.options.on_check) state.options.on_check(result.check);
}

bool is_done(const RepairState& state) {
  return state.result.check.consistent && state.result.constraint_violation <= policy::rounds::kMet;
}

double work_left(const RepairState& state, double kept_back) {
  const double most =
      state.options.most_work * std::max(state.series.duration(), policy::rounds::kShortestForWork);
  return (1 - kept_back) * most - state.result.work.amount;
}

NlpOptions nlp_options(RepairState& state, bool warm) {
  NlpOptions options;
  options.max_iterations = state.options.max_iterations;
  options.mumps = state.options.mumps;
  options.least_violating = &state.least_violating;
  if (!warm) return options;
  options.start_barrier = policy::solver::kWarmBarrier;
  options.start_push = policy::solver::kWarmPush;
  return options;
}

void note_work(RepairState& state, const Nlp& nlp, const NlpSolution& solution) {
  RepairResult& result = state.result;
  RepairWork& work = result.work;
  ++work.rounds;
  work.iterations += solution.iterations;
  work.amount += solution.work;
  work.variables = static_cast<int>(nlp.start.size());
  work.constraints = static_cast<int>(nlp.constraint_lower.size());
  work.jacobian_nonzeros = nlp.jacobian.size();
  work.hessian_nonzeros = nlp.hessian.size();
  work.function_seconds += solution.function_seconds;
  work.solver_seconds += solution.solver_seconds;
  result.variables = work.variables;
  result.constraints = work.constraints;
  result.iterations = work.iterations;
  result.constraint_violation = solution.violation;
}

namespace {

// Whether the next program starts at this result. Bodies that overlap are hard to separate again,
// so the overlapping result of an unsolved program is not used as a start.
bool is_next_start(const RepairState& state, double violation) {
  if (state.status == NlpStatus::solved) return true;
  return state.status == NlpStatus::iteration_limit && violation < policy::rounds::kNearlyMet &&
         state.result.check.summary[FindingKind::self_collision] > 0;
}

// Calls use(key, row) for every row of the program.
template <class Use>
void for_rows(const CorrectionProblem& problem, const Use& use) {
  for (const RowBlock& block : problem.blocks())
    for (int line = 0; line < block.rows(); ++line)
      use(std::tuple(problem.points()[static_cast<size_t>(block.point)].sample, block.kind,
                     block.item, line),
          block.row + line);
}

void keep_multipliers(RepairState& state, const VectorXd& multipliers) {
  state.multipliers.clear();
  for_rows(*state.problem, [&](const auto& key, int row) {
    if (multipliers[row] != 0) state.multipliers[key] = multipliers[row];
  });
}

VectorXd kept_multipliers(const RepairState& state) {
  VectorXd multipliers = VectorXd::Zero(state.problem->constraint_count());
  for_rows(*state.problem, [&](const auto& key, int row) {
    if (const auto found = state.multipliers.find(key); found != state.multipliers.end())
      multipliers[row] = found->second;
  });
  return multipliers;
}

// The start of a program. A warm start is near the solution. A known start also has the multipliers
// of the last program.
struct Start {
  bool warm = false, known = false;
  double violation = 0;
};

Start start_of(const RepairState& state, const Nlp& hard) {
  if (state.spec.initial.size() == 0) return {};
  const bool known = !state.multipliers.empty();
  const double near = known ? policy::rounds::kNearKnown : policy::rounds::kNearlyMet;
  const double violation = violation_at_start(hard);
  const bool warm = violation < near;
  return {warm, warm && known, violation};
}

// A violation can only be removed by moving as far. Slacks that are much smaller would cut all
// steps short, so a warm start keeps a distance from its bounds that fits its violation.
void make_room(NlpOptions& options, double violation) {
  using namespace policy::solver;
  options.start_push = std::clamp(kPushShare * violation, options.start_push, kStartPush);
  options.start_barrier =
      std::clamp(kBarrierShare * violation, options.start_barrier, kStartBarrier);
}

// Solves the program from hard.start, with its soft goals relaxed, and keeps its multipliers.
NlpSolution solve_relaxing_goals(RepairState& state, Nlp& hard, const std::string& stage,
                                 double tolerance) {
  const Start start = start_of(state, hard);
  NlpOptions options = nlp_options(state, start.warm);
  if (start.known) {
    options.start_barrier = state.barrier;
    hard.start_multipliers = kept_multipliers(state);
  }
  if (start.warm) make_room(options, start.violation);
  options.most_work = work_left(state, policy::rounds::kWorkForReasons);
  if (!state.flight) options.tolerance = tolerance;
  const bool is_round = tolerance >= policy::rounds::kTolerance;
  options.still_change = is_round ? policy::solver::kKinkChange : policy::solver::kStillChange;
  if (!is_round) options.still_complementarity = policy::solver::kStillBarrier * tolerance;
  if (!state.flight && state.result.work.rounds == 0)
    options.max_iterations = std::min(options.max_iterations, policy::rounds::kBeforeFinerKnots);
  const Slacks slacks = soft_goal_slacks(*state.problem, state.series.dt, state.options.safety,
                                         options.start_barrier);
  const Nlp nlp = slacks.price.size() > 0 ? relaxed(hard, slacks) : hard;
  const NlpSolution solution = solve(nlp, options, state.progress, stage);
  note_work(state, nlp, solution);
  if (solution.multipliers.size() > 0)
    keep_multipliers(state, unrelaxed_multipliers(hard, slacks, solution.multipliers));
  state.barrier =
      std::clamp(tolerance, policy::solver::kKnownBarrier, policy::solver::kWarmBarrier);
  return solution;
}

}  // namespace

void solve_program(RepairState& state, const std::string& stage, double tolerance) {
  CorrectionSpec& spec = state.spec;
  const bool first = state.result.work.rounds == 0;
  if (!first) spec.seen.push_back(&state.earlier.emplace_back(state.result.series));
  const CorrectionProblem& problem = state.problem.emplace(state.model, state.series, spec);
  Nlp hard = problem.nlp();
  const VectorXd usual =
      spec.initial.size() > 0
          ? hard.start
          : initial_guess(problem, hard, state.model, state.series, state.result.before.findings);
  const bool at_random = first && state.options.random_start.size > 0;
  hard.start = at_random ? random_start(problem, state.options.random_start) : usual;
  NlpSolution solution = solve_relaxing_goals(state, hard, stage, tolerance);
  if (at_random && solution.status != NlpStatus::solved) {  // such a start is not used again
    hard.start = usual;
    solution = solve_relaxing_goals(state, hard, stage, tolerance);
  }
  state.status = solution.status;
  state.objective = solution.objective;
  take(state, problem.track(solution.x.head(problem.variable_count())));
  spec.initial =
      is_next_start(state, solution.violation) ? state.track.coefficients : Eigen::MatrixXd();
}

}  // namespace ayumi
