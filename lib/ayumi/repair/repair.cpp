// Rounds of: choose windows around what the check found, solve, lay the correction over the motion
// at full rate, check again. A later round frees more (wider windows, finer knots), watches every
// limit and keeps a little more margin. Windows are enough because what a correction changes dies
// away: the COG forgets it as exp(-omega t), omega about 6 1/s for a small robot, 5 % after half a
// second, and the ZMP margin at the window's edge takes up the rest. Where it does not, the windows
// grow, at last to the whole motion.
#include "ayumi/repair/repair.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <set>

#include "ayumi/base/text.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/repair/constraint_relaxation.hpp"
#include "ayumi/repair/correction_problem.hpp"
#include "ayumi/repair/infeasibility_report.hpp"
#include "ayumi/repair/initial_guess.hpp"
#include "ayumi/repair/repair_setup.hpp"
#include "ayumi/repair/robustness_cost.hpp"
#include "ayumi/repair/tighten_to_check_limits.hpp"

namespace ayumi {

using Eigen::VectorXd;

namespace {

using FoundAt = std::pair<FindingKind, std::string>;  // kind and place

constexpr int kRounds = 8;
constexpr size_t kReasons = 6;  // told at most
constexpr double kPad = 0.5;    // free time around a finding, doubled when it is not enough [s]
constexpr double kRoundJointMargin = 5e-4;  // [rad]
constexpr double kRoundShare = 0.004;       // of speed limits and friction
constexpr double kWarmBarrier = 1e-5;       // of a start that violates little, where the first
constexpr double kNearlyMet = 1e-3;         // an unsolved program's violation, to go on from there
constexpr double kFarOff = 1e-3;            // barrier would only lead away from it
constexpr double kWarmPush = 1e-6;          // of that start off its bounds, likewise
constexpr int kUnsolved = 3;                // rounds without a solution
constexpr int kHalvings = 2;                // of the knots' spacing, at most
constexpr double kFinest = 8;               // samples between knots that are not halved any more
constexpr double kRoundMargin = 0.001;      // more ZMP margin each round [m]
constexpr int kPolishRounds = 4;            // at the limits of the check itself
constexpr int kBeforeFinerKnots = 50;       // iterations of the first program
constexpr double kAside = 0.1;              // from a result that fails to one that passes, to begin
constexpr double kLittle = 1e-4;            // of the way back, rather than another round
constexpr double kRoundTolerance = 1e-3;    // the least change is looked for at the end
constexpr double kPolishTolerance = 1e-7;   // of optimality, over what the change costs

class Repair {
 public:
  Repair(const RobotModel& model, const CommandSeries& series, const RepairOptions& options,
         const Progress& progress)
      : model_(model), series_(series), options_(options), progress_(progress), collisions_(model) {
    spec_ = asked_ = repair_spec(model, series, options);
    spec_.collisions = &collisions_;
  }

  RepairResult run() {
    result_.series = series_;
    result_.check = result_.before = check_consistency(model_, series_, options_.check);
    if (result_.check.consistent) {
      result_.status = RepairStatus::already_consistent;
      return result_;
    }
    spec_.wrong_plan = wrong_plan(result_.before);
    // COG, ZMP and f_z of the full model: what is left is wrong with the motion itself.
    take(CorrectionProblem(model_, series_, spec_).track(VectorXd()));
    as_given_ = result_;
    flight_ = flight_is_at_fault(result_.check);
    spec_.spacing =
        std::min(spec_.spacing, spacing_of_faults(series_, result_.check, kFinest * series_.dt));
    if (locked_out(spec_, result_.check))
      last_status_ = NlpStatus::infeasible;
    else
      solve_rounds();
    if (done() && result_.work.rounds > 0 && !flight_) polish();
    conclude();
    return result_;
  }

 private:
  void solve_rounds() {
    free_ends();
    double pad = kPad;
    int unsolved = 0;
    for (int round = 0; round < kRounds && unsolved < kUnsolved; ++round) {
      if (round == 0 ? sound() : done()) break;
      if (result_.check.consistent) passing_ = track_;
      choose_windows(round, pad);
      try {
        solve_round("repair round " + std::to_string(round + 1), kRoundTolerance);
      } catch (const Interrupted&) {
        if (!options_.keep_partial) throw;
        keep_partial();
        return;
      }
      spec_.zmp_margin += kRoundMargin;
      spec_.safe_margin += kRoundMargin;
      if (last_status_ != NlpStatus::solved) {
        if (round > 0 || flight_) ++unsolved;  // the first one may only have been cut short
        pad *= 2;
        // Finer knots first; then safety gives way before the repair does.
        if (unsolved > 1 || last_status_ == NlpStatus::infeasible) {
          spec_.safe_margin = spec_.zmp_margin;
          spec_.gentle_swings = false;
          spec_.sole_at_knots = 1;
        }
      }
      if (2 * (round + 1) >= kRounds) spec_.gentle_swings = false;
      spec_.joint_margin += kRoundJointMargin;
      spec_.share -= kRoundShare;
      refine(round);
    }
    if (!result_.check.consistent && passing_) {
      take(*passing_);
      return;
    }
    if (!result_.check.consistent) solve_elastic();
  }

  // Where an error outlasts the instants that were added for it, or no solution is found, the knots
  // are too far apart: soles in their places ask for more than a coarse spline can follow.
  void refine(int round) {
    if (result_.check.consistent) return;
    std::set<FoundAt> errors;
    bool again = round + 2 == kRounds || last_status_ != NlpStatus::solved;
    for (const Finding& f : result_.check.findings) {
      if (f.severity != Severity::error) continue;
      errors.emplace(f.kind, f.where);
      again = again || errors_.contains({f.kind, f.where});
    }
    errors_ = last_status_ == NlpStatus::solved ? errors : std::set<FoundAt>();
    if (!again || halvings_ == kHalvings || track_.spacing < kFinest * series_.dt) return;
    ++halvings_;
    errors_.clear();
    spec_.spacing = track_.spacing / 2;
    if (spec_.start.size() > 0) spec_.start = with_halved_knots(spec_.start);
  }

  // The least correction that passes, from one that does: limits where the check has them.
  void polish() {
    const RepairResult found = result_;
    const CorrectionTrack passing = track_;
    const bool as_table = table_passes();
    spec_.pressed = problem_->beside_pressed(problem_->point(track_.coefficients));
    const double tolerance = std::clamp(kPolishTolerance * objective_, 1e-9, 1e-6);
    set_limits_of_the_check();
    try {
      for (int round = 0; round < kPolishRounds; ++round) {
        solve_round("repair, least change", tolerance);
        if (last_status_ != NlpStatus::solved || result_.check.consistent) break;
        if (round + 1 < kPolishRounds && take_between(passing, kLittle, as_table)) break;
        add_instants(result_.check, series_.dt, spec_.extra);
        spec_.start = between(track_, passing, kAside).coefficients;
      }
    } catch (const Interrupted&) {
      if (!options_.keep_partial) throw;
      result_ = found;
      result_.partial = true;
      return;
    }
    if (last_status_ == NlpStatus::solved && take_between(passing, 1, as_table)) return;
    take(passing);
    result_.constraint_violation = found.constraint_violation;
    last_status_ = NlpStatus::solved;
  }

  // The result, or the first that passes from it to `passing`, at most a share of the way.
  bool take_between(const CorrectionTrack& passing, double most, bool as_table) {
    const CorrectionTrack wanted = track_;
    auto passes = [&] { return result_.check.consistent && (!as_table || table_passes()); };
    if (passes()) return true;
    for (double share = 1e-6; share <= most; share *= 10) {
      take(between(wanted, passing, share));
      if (passes()) return true;
    }
    take(wanted);
    return false;
  }

  // A table of the result, whose rates are differences of its rows.
  bool table_passes() const {
    CommandSeries table = result_.series;
    fill_rates(table.samples, table.dt, false);
    return report_of(table).consistent;
  }

  void set_limits_of_the_check() {
    spec_ = at_limits(spec_, asked_, options_.safety);
    spec_.spacing = track_.spacing;
    spec_.start = track_.coefficients;
  }

  // What is to be mended anyhow also gets the margin that the check asks for.
  bool sound() const {
    const auto& findings = result_.check.findings;
    return result_.check.consistent &&
           std::none_of(findings.begin(), findings.end(), [](const Finding& f) {
             return f.kind == FindingKind::support_margin && f.severity == Severity::warning;
           });
  }

  // A motion that passes though its program was not solved to the end is looked at once more.
  bool done() const {
    constexpr double kMet = 1e-6;
    return result_.check.consistent && result_.constraint_violation <= kMet;
  }

  void choose_windows(int round, double pad) {
    const auto now = result_.check.findings;
    findings_.insert(findings_.end(), now.begin(), now.end());
    for (const Finding& f : now)
      if (f.severity == Severity::error && round > 0)
        spec_.extra.insert(spec_.extra.end(), {f.begin, f.at, f.end});
    spec_.windows = windows_around(findings_, pad);
    add_near_pairs(model_, result_.series, collisions_, spec_.near_pairs);
  }

  // The first and last posture move only where they are themselves at fault. What the tick of an
  // end says of a mean over many ticks is no fault of that posture.
  void free_ends() {
    for (const Finding& f : result_.check.findings) {
      if (f.severity != Severity::error || f.kind == FindingKind::continuous_torque) continue;
      if (f.begin < spec_.spacing) spec_.free_ends[0] = true;
      if (f.end > series_.duration() - spec_.spacing) spec_.free_ends[1] = true;
    }
  }

  void take(const CorrectionTrack& track) {
    track_ = track;
    result_.correction = kept_at(trimmed(track), spec_.kept_instants);
    result_.series = apply_correction(model_, series_, result_.correction);
    result_.check = report_of(result_.series);
  }

  // A trusted quantity is judged as it was commanded, not as the corrected motion has it.
  ConsistencyReport report_of(const CommandSeries& series) const {
    if (options_.trust == Trust::posture) return check_consistency(model_, series, options_.check);
    CommandSeries judged = series;
    for (size_t k = 0; k < judged.samples.size(); ++k) {
      if (options_.trust == Trust::cog) judged.samples[k].cog = series_.samples[k].cog;
      if (options_.trust == Trust::zmp) judged.samples[k].zmp = series_.samples[k].zmp;
    }
    return check_consistency(model_, judged, options_.check);
  }

  NlpOptions nlp_options(bool warm) {
    NlpOptions options;
    options.max_iterations = options_.max_iterations;
    options.mumps = options_.mumps;
    options.least_violating = &least_violating_;
    if (!warm) return options;
    options.start_barrier = kWarmBarrier;
    options.start_push = kWarmPush;
    return options;
  }

  void note_work(const Nlp& nlp, const NlpSolution& solution) {
    RepairWork& work = result_.work;
    ++work.rounds;
    work.iterations += solution.iterations;
    work.variables = static_cast<int>(nlp.start.size());
    work.constraints = static_cast<int>(nlp.constraint_lower.size());
    work.jacobian_nonzeros = nlp.jacobian.size();
    work.hessian_nonzeros = nlp.hessian.size();
    work.function_seconds += solution.function_seconds;
    work.solver_seconds += solution.solver_seconds;
    result_.variables = work.variables;
    result_.constraints = work.constraints;
    result_.iterations = work.iterations;
    result_.constraint_violation = solution.violation;
  }

  void solve_round(const std::string& stage, double tolerance) {
    if (result_.work.rounds > 0) spec_.seen.push_back(&seen_.emplace_back(result_.series));
    problem_.emplace(model_, series_, spec_);
    Nlp hard = problem_->nlp();
    if (spec_.start.size() == 0)
      hard.start = start_of(*problem_, hard, model_, series_, result_.before.findings);
    const bool warm = spec_.start.size() > 0 && violation_at_start(hard) < kFarOff;
    NlpOptions options = nlp_options(warm);
    const Nlp nlp =
        with_soft_safety(*problem_, hard, series_.dt, options_.safety, options.start_barrier);
    if (!flight_) options.tolerance = tolerance;
    if (!flight_ && result_.work.rounds == 0)
      options.max_iterations = std::min(options.max_iterations, kBeforeFinerKnots);
    const NlpSolution solution = solve(nlp, options, progress_, stage);
    note_work(nlp, solution);
    last_status_ = solution.status;
    objective_ = solution.objective;
    take(problem_->track(solution.x.head(problem_->variable_count())));
    // Bodies that have met are hard to part again: then from the start.
    const bool on_its_way = last_status_ == NlpStatus::iteration_limit &&
                            result_.check.summary[FindingKind::self_collision] > 0;
    spec_.start =
        last_status_ == NlpStatus::solved || (on_its_way && solution.violation < kNearlyMet)
            ? track_.coefficients
            : Eigen::MatrixXd();
  }

  // The motion that violates least, in the order of what is worth most, tells what is in the way.
  void solve_elastic() {
    const Nlp hard = problem_->nlp();
    const Nlp soft = elastic(*problem_, hard, series_.dt);
    constexpr int kEnough = 60;  // iterations: what is in the way shows long before the optimum
    NlpOptions options = nlp_options(false);
    options.max_iterations = std::min(options.max_iterations, kEnough);
    options.least_violating = nullptr;
    const NlpSolution solution = solve(soft, options, progress_, "repair, what is in the way");
    const double violation = result_.constraint_violation;
    note_work(soft, solution);
    result_.constraint_violation = violation;
    // The least violating motion there is nearby, and still one too many: nothing passes.
    if (solution.status != NlpStatus::failed) last_status_ = NlpStatus::infeasible;
    cut_short_ = solution.status == NlpStatus::iteration_limit;
    take(problem_->track(solution.x.head(problem_->variable_count())));
    // Stopped on its way it has errors of its own making: then those of the motion itself tell.
    if (!cut_short_ && total_excess(result_.check) < total_excess(as_given_.check)) return;
    result_.correction = as_given_.correction;
    result_.series = as_given_.series;
    result_.check = as_given_.check;
  }

  void keep_partial() {
    result_.partial = true;
    last_status_ = NlpStatus::iteration_limit;
    if (problem_ && least_violating_.size() >= problem_->variable_count())
      take(problem_->track(least_violating_.head(problem_->variable_count())));
  }

  void conclude() {
    const bool solved = result_.check.consistent && !result_.partial;
    result_.status = solved                                  ? RepairStatus::repaired
                     : last_status_ == NlpStatus::infeasible ? RepairStatus::infeasible
                                                             : RepairStatus::not_converged;
    if (!solved && !result_.partial) {
      result_.obstacles = obstacles(model_, result_.series, result_.check, options_);
      for (const Obstacle& o : result_.obstacles) result_.reasons.push_back(o.text);
      const size_t count = result_.reasons.size();
      if (count > kReasons) {
        result_.reasons.resize(kReasons);
        result_.reasons.push_back(std::to_string(count - kReasons) + " more like these");
      }
      if (cut_short_)
        result_.reasons.push_back(
            "the search for a nearer motion stopped at its limit of iterations: these are the "
            "motion's own errors, no proof that nothing passes");
    }
    result_.moved = motion_change(model_, series_, result_.series);
    result_.change = weighted_change(model_, series_, result_.series, spec_.weights);
    result_.change.safety = safety_price(model_, series_, result_.series, options_, result_.before);
    result_.max_joint_change = result_.moved.joint.size;
    result_.max_cog_change = result_.moved.cog.size;
    result_.at = result_.moved.joint.at;
    if (!result_.moved.joints.empty()) result_.where = result_.moved.joints.front().joint;
  }

  const RobotModel& model_;
  const CommandSeries& series_;
  const RepairOptions& options_;
  const Progress& progress_;
  const CollisionModel collisions_;
  CorrectionSpec spec_, asked_;               // now and of the first round
  std::optional<CorrectionProblem> problem_;  // of the last round
  std::deque<CommandSeries> seen_;            // results of earlier rounds
  std::set<FoundAt> errors_;                  // left over by the last round, where it was solved
  int halvings_ = 0;                          // of the knots' spacing
  bool flight_ = false;                       // one is at fault
  Eigen::VectorXd least_violating_;
  RepairResult result_;
  CorrectionTrack track_;                   // of the result, every control point
  std::optional<CorrectionTrack> passing_;  // an earlier one, where the last does not pass
  std::vector<Finding> findings_;
  RepairResult as_given_;  // the motion itself; COG, ZMP and f_z those of its posture
  NlpStatus last_status_ = NlpStatus::failed;
  double objective_ = 0;    // of the last program
  bool cut_short_ = false;  // the program of what is in the way, by its limit of iterations
};

}  // namespace

RepairResult repair(const RobotModel& model, const CommandSeries& series,
                    const RepairOptions& options, const Progress& progress) {
  if (!(options.knot_spacing > 2 * series.dt))
    fail(ErrorCode::usage, "knot spacing " + text::exact(options.knot_spacing) +
                               " s must be above two samples (" + text::exact(2 * series.dt) +
                               " s)");
  return Repair(model, series, options, progress).run();
}

}  // namespace ayumi
