// Rounds of: choose windows around what the check found, solve, lay the correction over the motion
// at full rate, check again. A later round frees more (wider windows, finer knots), watches every
// limit and keeps a little more margin. Windows are enough because what a correction changes dies
// away: the COG forgets it as exp(-omega t), omega about 6 1/s for a small robot, 5 % after half a
// second, and the ZMP margin at the window's edge takes up the rest. Where it does not, the windows
// grow, at last to the whole motion.
#include "ayumi/optimize/repair.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/optimize/correction_problem.hpp"

namespace ayumi {

using Eigen::VectorXd;

const char* name_of(RepairStatus status) {
  constexpr const char* kNames[] = {"already_consistent", "repaired", "infeasible",
                                    "not_converged"};
  return kNames[static_cast<int>(status)];
}

namespace {

constexpr int kRounds = 5;
constexpr size_t kReasons = 6;  // told at most
constexpr double kPad = 0.5;    // free time around a finding, doubled when it is not enough [s]
constexpr double kMarginBetween = 5e-4;     // of the ZMP, for what happens between constraints [m]
constexpr double kRoundJointMargin = 5e-4;  // [rad]
constexpr double kRoundShare = 0.004;       // of speed limits and friction
constexpr double kWarmBarrier = 1e-5;
constexpr double kRoundMargin = 0.001;  // more ZMP margin each round [m]

std::vector<std::pair<double, double>> windows_around(const std::vector<Finding>& findings,
                                                      double pad) {
  std::vector<std::pair<double, double>> windows;
  for (const Finding& f : findings)
    if (f.severity == Severity::error) windows.emplace_back(f.begin - pad, f.end + pad);
  std::sort(windows.begin(), windows.end());
  std::vector<std::pair<double, double>> merged;
  for (const auto& w : windows) {
    if (!merged.empty() && w.first <= merged.back().second)
      merged.back().second = std::max(merged.back().second, w.second);
    else
      merged.push_back(w);
  }
  return merged;
}

std::vector<bool> locked_dofs(const RobotModel& model, const std::vector<std::string>& names) {
  std::vector<bool> locked(model.dof_count(), false);
  for (const std::string& name : names) {
    const int dof = model.find_dof(name);
    if (dof < 0)
      fail(ErrorCode::usage, "locked joint '" + name + "': the robot '" + model.name() +
                                 "' has no such joint" + text::suggestion(name, model.dof_names()));
    locked[dof] = true;
  }
  return locked;
}

void note_changes(const RobotModel& model, const CommandSeries& before, RepairResult& result) {
  RobotData data(model);
  for (size_t k = 0; k < before.samples.size(); ++k) {
    const RobotState &a = before.samples[k].state, &b = result.series.samples[k].state;
    int joint = 0;
    const double change = (b.theta - a.theta).cwiseAbs().maxCoeff(&joint);
    if (change > result.max_joint_change) {
      result.max_joint_change = change;
      result.where = model.dofs()[joint].name;
      result.at = before.dt * static_cast<double>(k);
    }
    update_positions(model, a, data);
    const Eigen::Vector3d cog = data.cog;
    update_positions(model, b, data);
    result.max_cog_change = std::max(result.max_cog_change, (data.cog - cog).norm());
  }
}

// What is written to a file: numbers of nine decimals, and only the control points and joints that
// move, with the three zero points before and after that a cubic spline needs to begin at rest.
CorrectionTrack trimmed(const CorrectionTrack& track) {
  const Eigen::MatrixXd c = (track.coefficients * 1e9).array().round() / 1e9;
  Eigen::Index first = c.rows(), last = -1;
  for (Eigen::Index i = 0; i < c.rows(); ++i) {
    if (c.row(i).isZero(0)) continue;
    first = std::min(first, i);
    last = i;
  }
  CorrectionTrack result;
  result.spacing = track.spacing;
  if (last < 0) {
    result.coefficients.setZero(4, 6);
    return result;
  }
  first = std::max<Eigen::Index>(0, first - 3);
  last = std::min(c.rows() - 1, last + 3);
  result.begin = track.begin + track.spacing * static_cast<double>(first);
  std::vector<Eigen::Index> columns = {0, 1, 2, 3, 4, 5};
  for (Eigen::Index j = 6; j < c.cols(); ++j) {
    if (c.col(j).isZero(0)) continue;
    columns.push_back(j);
    result.joints.push_back(track.joints[j - 6]);
  }
  result.coefficients = c(Eigen::seq(first, last), columns);
  return result;
}

std::string subject(const RobotModel& model, const ConstraintBlock& block) {
  switch (block.group) {
    case ConstraintGroup::position:
      return model.dofs()[block.item].name + " cannot come inside its position limit";
    case ConstraintGroup::speed:
      return model.dofs()[block.item].name + " cannot stay below its speed limit";
    case ConstraintGroup::stance:
      return std::string("the ") + name_of(static_cast<Side>(block.item)) +
             " foot cannot stay at its place";
    case ConstraintGroup::swing:
      return std::string("the ") + name_of(static_cast<Side>(block.item)) +
             " foot cannot stay above the ground";
    case ConstraintGroup::support:
      return "the ZMP cannot come inside the support";
    case ConstraintGroup::unilateral:
      return "the ground would have to pull";
    case ConstraintGroup::yaw:
      return "the foot would turn on the ground";
    case ConstraintGroup::friction:
      return "the ground does not give enough friction";
    default:
      return "the flight cannot be ballistic";
  }
}

// The largest violation of every group and item, worst first. Rows are metres, radians or shares
// near one, so their sizes can be compared.
std::vector<std::string> violated(const RobotModel& model, const CorrectionProblem& problem,
                                  const VectorXd& x, double dt) {
  struct Worst {
    double size = 0, at = 0;
    const ConstraintBlock* block = nullptr;
  };
  std::map<std::pair<int, int>, Worst> groups;
  const VectorXd g = problem.constraints(x);
  for (const ConstraintBlock& block : problem.blocks()) {
    Worst& worst = groups[{static_cast<int>(block.group), block.item}];
    for (int i = block.row; i < block.row + block.rows; ++i) {
      const double size = std::max(problem.lower()[i] - g[i], g[i] - problem.upper()[i]);
      if (size > worst.size) worst = {size, problem.instants()[block.instant].sample * dt, &block};
    }
  }
  std::vector<Worst> ranked;
  for (const auto& entry : groups)
    if (entry.second.size > 1e-6) ranked.push_back(entry.second);
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Worst& a, const Worst& b) { return a.size > b.size; });
  std::vector<std::string> reasons;
  for (const Worst& w : ranked)
    reasons.push_back(subject(model, *w.block) + " at " + text::fixed(w.at, 3) +
                      " s: " + text::brief(w.size, 3) + " is missing");
  return reasons;
}

std::string in_words(const Finding& f) {
  return f.kind + " of " + f.where + " at " + text::fixed(f.at, 3) + " s, " + text::brief(f.worst) +
         " against " + text::brief(f.limit) + " " + f.unit + ": " + f.hint;
}

class Repair {
 public:
  Repair(const RobotModel& model, const CommandSeries& series, const RepairOptions& options,
         const Progress& progress)
      : model_(model), series_(series), options_(options), progress_(progress) {
    spec_.spacing = options.knot_spacing;
    spec_.locked = locked_dofs(model, options.locked_joints);
    spec_.profile = options.check.profile;
    spec_.friction = options.check.friction;
    spec_.zmp_margin = options.zmp_margin + kMarginBetween;
  }

  RepairResult run() {
    result_.series = series_;
    result_.check = check_consistency(model_, series_, options_.check);
    if (result_.check.consistent) {
      result_.status = RepairStatus::already_consistent;
      return result_;
    }
    // COG, ZMP and f_z of the full model: what is left is wrong with the motion itself.
    take(CorrectionProblem(model_, series_, spec_).track(VectorXd()));
    if (locked_out_of_limits()) return result_;
    free_ends();
    double pad = kPad;
    int unsolved = 0;
    // Wider windows help once against a program without a solution; twice was never seen to.
    for (int round = 0; round < kRounds && !result_.check.consistent && unsolved < 2; ++round) {
      const auto now = result_.check.findings;
      findings_.insert(findings_.end(), now.begin(), now.end());
      for (const Finding& f : now)
        if (f.severity == Severity::error && round > 0)
          spec_.extra.insert(spec_.extra.end(), {f.begin, f.at, f.end});
      spec_.windows = windows_around(findings_, pad);
      last_status_ = solve_round(round);
      if (last_status_ != NlpStatus::solved) {
        ++unsolved;
        pad *= 2;
      }
      spec_.zmp_margin += kRoundMargin;
      spec_.joint_margin += kRoundJointMargin;
      spec_.share -= kRoundShare;
    }
    conclude();
    return result_;
  }

 private:
  // A joint that may not move and is beyond its limits: there is nothing to solve.
  bool locked_out_of_limits() {
    for (const Finding& f : result_.check.findings) {
      const int dof = f.severity == Severity::error ? model_.find_dof(f.where) : -1;
      if (dof < 0 || !spec_.locked[dof]) continue;
      if (f.kind != "joint_position" && f.kind != "joint_speed" && f.kind != "servo_step") continue;
      result_.status = RepairStatus::infeasible;
      result_.reasons.push_back(f.where +
                                " is locked, and that is where it is wrong: " + in_words(f));
    }
    return !result_.reasons.empty();
  }

  // The first and last posture move only where they are themselves at fault. What the tick of an
  // end says of a mean over many ticks is no fault of that posture.
  void free_ends() {
    for (const Finding& f : result_.check.findings) {
      if (f.severity != Severity::error || f.kind == "continuous_torque") continue;
      if (f.begin < spec_.spacing) spec_.free_ends[0] = true;
      if (f.end > series_.duration() - spec_.spacing) spec_.free_ends[1] = true;
    }
  }

  void take(const CorrectionTrack& track) {
    result_.correction = trimmed(track);
    result_.series = apply_correction(model_, series_, result_.correction);
    result_.check = check_consistency(model_, result_.series, options_.check);
  }

  NlpStatus solve_round(int round) {
    const CommandSeries current = result_.series;
    spec_.current = &current;
    const CorrectionProblem problem(model_, series_, spec_);
    NlpOptions nlp_options;
    nlp_options.max_iterations = options_.max_iterations;
    if (spec_.start.size() > 0) nlp_options.start_barrier = kWarmBarrier;
    const NlpSolution solution =
        solve(problem.nlp(), nlp_options, progress_, "repair round " + std::to_string(round + 1));
    result_.variables = problem.variable_count();
    result_.constraints = problem.constraint_count();
    result_.iterations += solution.iterations;
    result_.constraint_violation = solution.violation;
    const CorrectionTrack track = problem.track(solution.x);
    take(track);
    spec_.start = solution.status == NlpStatus::solved ? track.coefficients : Eigen::MatrixXd();
    reasons_ = violated(model_, problem, solution.x, series_.dt);
    if (round + 2 == kRounds) spec_.spacing /= 2;
    spec_.current = nullptr;
    return solution.status;
  }

  void conclude() {
    if (result_.check.consistent) {
      result_.status = RepairStatus::repaired;
    } else {
      result_.status = last_status_ == NlpStatus::infeasible ? RepairStatus::infeasible
                                                             : RepairStatus::not_converged;
      result_.reasons = reasons_;
      for (const Finding& f : result_.check.findings)
        if (f.severity == Severity::error) result_.reasons.push_back(in_words(f));
      const size_t count = result_.reasons.size();
      if (count > kReasons) {
        result_.reasons.resize(kReasons);
        result_.reasons.push_back(std::to_string(count - kReasons) + " more findings like these");
      }
    }
    note_changes(model_, series_, result_);
  }

  const RobotModel& model_;
  const CommandSeries& series_;
  const RepairOptions& options_;
  const Progress& progress_;
  CorrectionSpec spec_;
  RepairResult result_;
  std::vector<Finding> findings_;
  std::vector<std::string> reasons_;
  NlpStatus last_status_ = NlpStatus::failed;
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
