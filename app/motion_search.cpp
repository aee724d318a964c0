#include "motion_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/check/mistake_trials.hpp"
#include "ayumi/control/gain_design.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/repair/infeasibility_report.hpp"
#include "ayumi/task/task.hpp"
#include "simulation.hpp"

namespace ayumi::app {

namespace {

// Largest number of motions that are sampled, and of those that are checked in full. Chosen:
// sampling a walk of 12 s at kCoarse takes 0.05 s and a full check takes 0.5 s, so a search ends
// within ten seconds; on 14 robots and 69 variants of them, the longest search took 8 s.
constexpr int kMostSampled = 90, kMostChecked = 8;
// Total length of all tried motions at which the search from the nearest trial ends [s]. A motion
// that is checked or simulated counts several times. Chosen: the quick check of look_at() takes 2
// to 4 ms for a second of motion, so that a search ends within ten seconds.
constexpr double kMostWork = 1800;
constexpr double kWorkOfCheck = 4, kWorkOfRun = 5;
// Shares of the range of a dial by which its value is moved: the first and the last one. Chosen:
// the last one is the smallest move for which the errors of a walk can be distinguished.
constexpr double kFirstMove = 0.25, kLastMove = 0.015;
// Largest number of sets of directions in which all values are moved together. Chosen: one set of
// six values has at most twelve trials, so that kMostWork is reached first.
constexpr int kMostSets = 400;
// Largest number of motions that are simulated. Chosen: a walk of 12 s takes 0.3 to 1 s.
constexpr int kMostSimulated = 5;
// Sample period of the first check [s]. Chosen: only postures are judged, 45 of them in a swing of
// 0.45 s.
constexpr double kCoarse = 0.01;

bool cannot_be_done(const Error& error) {
  return error.code() == ErrorCode::bad_pattern || error.code() == ErrorCode::usage;
}

// The result of the quick check of a motion.
struct Look {
  std::string posture;  // the error in its postures; "" if there is none
  double beyond = 0;    // the sum of the shares by which it exceeds limits
};

Look look_at(const RobotModel& model, const Pattern& pattern) {
  ConsistencyReport report = check_consistency(model, sample(model, pattern, {.dt = kCoarse}));
  std::erase_if(report.findings, [](const Finding& finding) {
    return finding.kind != FindingKind::table_position && needs_servo_period(finding.kind);
  });
  Look look{"", total_violation(report)};
  for (const Finding& finding : report.findings)
    if (look.posture.empty() && finding.severity == Severity::error &&
        (is_of_posture(finding) || finding.kind == FindingKind::table_position))
      look.posture = finding_with_hint(finding);
  return look;
}

// The errors of a motion: the first one, and the one that exceeds its limit most.
struct Wrong {
  std::string first, worst;
  double severity = 0;
};

// The errors of all limits, judged by the strongest profile of the robot.
Wrong wrong_motion(const RobotModel& model, const Pattern& pattern) {
  const Judgement judged = judge(make_task(pattern, model, "", {}));
  if (judged.good() || !judged.motion_need.sufficient.empty()) return {};
  Wrong wrong;
  for (const Finding& finding : judged.report.findings) {
    if (finding.severity != Severity::error) continue;
    if (wrong.first.empty()) wrong.first = finding_with_hint(finding);
    const double severity = severity_of(finding);
    if (severity <= wrong.severity) continue;
    wrong.severity = severity;
    wrong.worst = kind_place_and_time(finding) + ": " + amount_text(finding);
  }
  if (wrong.first.empty())
    wrong.first = judged.report.findings.empty()
                      ? "the motion does not pass the check"
                      : finding_with_hint(judged.report.findings.front());
  return wrong;
}

// All combinations of indices into the lists of values, sorted by the sum of the indices.
std::vector<std::vector<size_t>> nearest_first(const std::vector<Dial>& dials) {
  std::vector<std::vector<size_t>> all = {{}};
  for (const Dial& dial : dials) {
    std::vector<std::vector<size_t>> longer;
    for (const auto& places : all)
      for (size_t i = 0; i < dial.values.size(); ++i) {
        longer.push_back(places);
        longer.back().push_back(i);
      }
    all = std::move(longer);
  }
  const auto sum = [](const std::vector<size_t>& v) {
    return std::accumulate(v.begin(), v.end(), size_t{0});
  };
  std::stable_sort(all.begin(), all.end(),
                   [&](const auto& a, const auto& b) { return sum(a) < sum(b); });
  return all;
}

// The end of a motion in a simulation with the default controller.
struct End {
  std::string falls;  // such as "with dtad, the robot fell at 3.2 s ..."; "" if the robot stands
  double share = 1;   // share of the motion before the fall
  bool unstable = false;  // the gains are unstable, so nothing was simulated
};

End end_in_simulation(const RobotModel& model, const Pattern& pattern) {
  Task task = make_task(pattern, model, "", {});
  const Judgement judged = judge(task);
  // This is the profile that write_new_pattern() chooses.
  if (pattern.profile.empty() && !judged.motion_need.sufficient.empty())
    task.profile = judged.motion_need.sufficient.front();
  const SimulateOptions options = simulate_options(task);
  const CommandSample& first = task.series.samples.front();
  const std::string unstable = instability(model, model.limits(task.profile), options.controller,
                                           first.cog.z() - first.zmp.z(), task.series.dt);
  if (!unstable.empty()) return {unstable, 0, true};
  const SimulationLog log = simulate(task, options);
  if (log.result.outcome != Outcome::fell) return {};
  return {outcome_text(log), log.result.fell_at / pattern.duration(), false};
}

class MotionSearch {
 public:
  MotionSearch(const RobotModel& model, const std::vector<Dial>& dials,
               const std::function<Pattern(const std::vector<double>&)>& make,
               const Progress& progress, bool simulated, const UsedValues& used)
      : model_(model),
        dials_(dials),
        make_(make),
        progress_(progress),
        simulated_(simulated),
        used_(used) {}

  SearchResult run() {
    try_lists();
    if (!result_.found && !unstable_ && !result_.limit.empty()) go_on_from_nearest();
    if (!result_.found && !accepted_.empty()) {
      result_.found = true;
      result_.values = accepted_;
    }
    return result_;
  }

 private:
  using Values = std::vector<double>;

  // The errors of a motion, and its fall in a simulation. If `first` is "", there is no error and
  // no fall. The severity of a fall is less than that of any error, and less if it comes later.
  Wrong wrong_with(const Pattern& pattern, const Values& values) {
    ++checked_;
    work_ += kWorkOfCheck * pattern.duration();
    const Wrong motion = wrong_motion(model_, pattern);
    if (!motion.worst.empty() && motion.severity < nearest_) {
      nearest_ = motion.severity;
      result_.nearest = motion.worst;
      result_.nearest_values = values;
    }
    if (!motion.first.empty() || !simulated_) return motion;
    ++runs_;
    work_ += kWorkOfRun * pattern.duration();
    const End end = end_in_simulation(model_, pattern);
    if (!end.falls.empty() && result_.falls.empty()) {
      result_.falls = end.falls;
      accepted_ = values;
    }
    unstable_ |= end.unstable;
    return {end.falls, "", -end.share};
  }

  void note_trial() {
    ++result_.tried;
    // The lists are the first half of the search, and what goes on from them is the second one.
    const double done = goes_on_from_ ? 0.5 + 0.5 * (work_ - *goes_on_from_) /
                                                  std::max(1.0, kMostWork - *goes_on_from_)
                                      : 0.5 * result_.tried / kMostSampled;
    report(progress_, {"looking for a motion that passes the check", std::min(1.0, done), ""});
  }

  void take(const Values& values) {
    result_.found = true;
    result_.values = values;
    result_.falls.clear();
  }

  void try_lists() {
    // Indices of the dials that do not change postures, for trials whose postures passed, but not
    // their speeds, torques or ZMP. Another posture does not correct these errors.
    std::set<std::vector<size_t>> hopeless;
    for (const std::vector<size_t>& places : nearest_first(dials_)) {
      std::vector<size_t> others;
      for (size_t i = 0; i < dials_.size(); ++i)
        if (!dials_[i].posture) others.push_back(places[i]);
      if (hopeless.contains(others)) continue;
      Values values;
      for (size_t i = 0; i < dials_.size(); ++i) values.push_back(dials_[i].values[places[i]]);
      std::string wrong;
      try {
        Pattern pattern = make_(values);
        pattern.file.clear();
        const Look look = look_at(model_, pattern);
        work_ += pattern.duration();
        double beyond = look.beyond;
        wrong = look.posture;
        if (wrong.empty()) {
          const Wrong motion = wrong_with(pattern, values);
          wrong = motion.first;
          if (!wrong.empty()) hopeless.insert(others);
          // At the servo's own period, more may be wrong than in the quick check.
          if (beyond == 0) beyond = motion.severity;
        }
        note_look(values, beyond);
      } catch (const Error& error) {
        if (!cannot_be_done(error)) throw;
        wrong = error.what();
        if (result_.tried == 0) result_.refused = true;
      }
      note_trial();
      if (result_.tried == 1) {
        result_.values = values;
        result_.limit = wrong;
      }
      if (wrong.empty()) return take(values);
      if (result_.tried == kMostSampled || checked_ == kMostChecked || runs_ == kMostSimulated)
        return;
    }
  }

  void note_look(const Values& values, double beyond) {
    if (beyond >= least_beyond_) return;
    least_beyond_ = beyond;
    start_ = values;
  }

  // Checks the motion with these values quickly, if it can be made and was not checked before.
  // Returns whether it is nearer to passing than all others.
  bool looks_nearer(const Values& values) {
    if (!looked_at_.insert(values).second) return false;
    try {
      Pattern pattern = make_(values);
      pattern.file.clear();
      work_ += pattern.duration();  // also for a motion that is out of reach when it is sampled
      double beyond = look_at(model_, pattern).beyond;
      note_trial();
      if (beyond == 0) {
        const Wrong motion = wrong_with(pattern, values);
        if (motion.first.empty()) {
          take(values);
          return true;
        }
        beyond = motion.severity;
      }
      if (beyond >= least_beyond_) return false;
      note_look(values, beyond);
      return true;
    } catch (const Error& error) {
      if (!cannot_be_done(error)) throw;
      note_trial();
      return false;
    }
  }

  bool ended() const {
    return result_.found || unstable_ || runs_ >= kMostSimulated || work_ > kMostWork;
  }

  // Moves one value after the other as long as this comes nearer to passing, and does the same with
  // moves of half the size. Then it moves all values together.
  void go_on_from_nearest() {
    if (start_.empty()) return;
    goes_on_from_ = work_;
    start_ = used_(start_);  // a move of a value that has no effect comes nearer to nothing
    for (double share = kFirstMove; share >= kLastMove && !ended(); share /= 2)
      while (move_one(share)) {
      }
    move_together();
    if (result_.found || !accepted_.empty()) return;
    try {
      Pattern pattern = make_(start_);
      pattern.file.clear();
      if (wrong_with(pattern, start_).first.empty()) take(start_);
    } catch (const Error& error) {
      if (!cannot_be_done(error)) throw;
    }
  }

  bool move_one(double share) {
    bool nearer = false;
    for (size_t i = 0; i < dials_.size(); ++i)
      for (const double way : {-share, share})
        while (!ended() && looks_nearer(moved(start_, i, way))) nearer = true;
    return nearer && !ended();
  }

  // Moves all values together, in sets of orthogonal directions that differ from set to set. This
  // finds values that pass only in a narrow range that is oblique to the dials, where no move of
  // one or two values comes nearer. Source: mesh adaptive direct search with Householder
  // directions, Abramson, Audet, Dennis and Le Digabel, SIAM J. Optim. 20 (2009) 948-966.
  void move_together() {
    std::vector<size_t> movable;
    for (size_t i = 0; i < dials_.size(); ++i)
      if (dials_[i].most > dials_[i].least) movable.push_back(i);
    if (movable.size() < 2) return;
    Random random(1);
    double share = kFirstMove;
    for (int set = 0; set < kMostSets && !ended(); ++set) {
      Eigen::VectorXd normal(static_cast<Eigen::Index>(movable.size()));
      random.normals(normal.data(), static_cast<int>(normal.size()));
      normal.normalize();
      bool nearer = false;
      for (Eigen::Index k = 0; k < normal.size() && !nearer && !ended(); ++k)
        for (const double way : {-share, share}) {
          const Eigen::VectorXd direction =
              Eigen::VectorXd::Unit(normal.size(), k) - 2 * normal[k] * normal;
          Values values = start_;
          for (size_t i = 0; i < movable.size(); ++i)
            values = moved(values, movable[i], way * direction[static_cast<Eigen::Index>(i)]);
          nearer = looks_nearer(values);
          if (nearer || ended()) break;
        }
      share = nearer ? std::min(kFirstMove, 2 * share) : share / 2;
      if (share < kLastMove) share = kFirstMove;
    }
  }

  Values moved(Values values, size_t i, double share) const {
    const Dial& dial = dials_[i];
    if (dial.most <= dial.least) return values;
    const double to = dial.meant(values[i]) + share * (dial.most - dial.least);
    values[i] = std::clamp(dial.step * std::round(to / dial.step), dial.least, dial.most);
    return values;
  }

  const RobotModel& model_;
  const std::vector<Dial>& dials_;
  const std::function<Pattern(const Values&)>& make_;
  const Progress& progress_;
  bool simulated_;
  const UsedValues& used_;
  SearchResult result_;
  int checked_ = 0, runs_ = 0;
  bool unstable_ = false;           // whether the gains let the robot fall in any motion
  double nearest_ = HUGE_VAL;       // severity of the worst error of the nearest motion
  Values accepted_;                 // values that the check accepts, but with which the robot falls
  double least_beyond_ = HUGE_VAL;  // smallest sum of shares by which a motion exceeds limits
  Values start_;                    // values of this motion
  std::set<Values> looked_at_;
  double work_ = 0;                     // length of the motions that were worked on [s]
  std::optional<double> goes_on_from_;  // this length, where the search goes on from the nearest
};

}  // namespace

SearchResult search_motion(const RobotModel& model, const std::vector<Dial>& dials,
                           const std::function<Pattern(const std::vector<double>&)>& make,
                           const Progress& progress, bool simulated, const UsedValues& used) {
  return MotionSearch(model, dials, make, progress, simulated, used).run();
}

bool postures_pass(const RobotModel& model, const std::function<Pattern()>& make) {
  try {
    Pattern pattern = make();
    pattern.file.clear();
    return look_at(model, pattern).posture.empty();
  } catch (const Error& error) {
    if (!cannot_be_done(error)) throw;
    return false;
  }
}

std::string changed_values(const std::vector<Dial>& dials, const std::vector<double>& values) {
  std::vector<std::string> changed;
  for (size_t i = 0; i < dials.size(); ++i)
    if (values[i] != dials[i].values.front())
      changed.push_back(dials[i].name + " " + text::brief(values[i]) +
                        (dials[i].unit.empty() ? "" : " " + dials[i].unit));
  return text::join(changed, ", ");
}

}  // namespace ayumi::app
