#include "ayumi/task/foothold_collisions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <set>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

namespace {

using Eigen::Isometry3d;

// Largest number of footholds that are examined. Chosen: each cause costs up to two checks. A walk
// whose every step collides has one cause.
constexpr size_t kMostFootholds = 3;
// Step between the changes to the side that are tried, and their largest size. Chosen: an author
// writes whole millimetres, and the largest size limits the search.
constexpr double kSideGrain = 1e-3, kMostSide = 0.2;  // [m]
constexpr double kDegree = EIGEN_PI / 180;            // a degree [rad]
constexpr double kRadianGrain = 0.01;  // step between turns if the pattern is in rad [rad]
// Largest overlap of the feet that is examined, as a share of the width of a sole. Chosen: the
// overlap of a step that is turned or narrowed a little too much. Feet that are exchanged, or on
// the wrong side, overlap by most of their width.
constexpr double kGrazing = 0.25;
constexpr double kRounding = 1e-9;  // Definition: rounding of sums of decimal numbers [m], [rad]

class Footholds {
 public:
  Footholds(const Task& task, const CheckOptions& options, const ConsistencyReport& report)
      : task_(task),
        options_(options),
        collisions_(task.robot),
        data_(task.robot),
        wanted_(tolerances(options, task.robot, task.series)[FindingKind::self_collision]),
        errors_(errors_of(report)) {}

  std::vector<Mistake> found(const ConsistencyReport& report) {
    std::vector<Mistake> mistakes;
    std::set<std::string> places;
    for (const Finding& finding : report.findings) {
      if (mistakes.size() == kMostFootholds) break;
      if (finding.severity != Severity::error || !is_of_feet(finding)) continue;
      const std::optional<size_t> phase = swing_before(finding.begin);
      if (!phase || !places.insert(pointer_of_phase(task_.pattern, *phase)).second) continue;
      if (const auto mistake = mistake_at(*phase)) mistakes.push_back(*mistake);
    }
    return mistakes;
  }

 private:
  using Change = std::function<void(Swing&)>;

  struct Remedy {
    std::string words;
    size_t errors = 0;
  };

  static size_t errors_of(const ConsistencyReport& report) {
    return static_cast<size_t>(
        std::count_if(report.findings.begin(), report.findings.end(),
                      [](const Finding& f) { return f.severity == Severity::error; }));
  }

  bool is_of_feet(const Finding& finding) const {
    const auto* pair = std::get_if<BodyPairPlace>(&finding.place);
    if (finding.kind != FindingKind::self_collision || !pair) return false;
    const std::pair<int, int> feet =
        std::minmax(task_.robot.sole(Side::left).body, task_.robot.sole(Side::right).body);
    return std::pair<int, int>(std::minmax(pair->a, pair->b)) == feet;
  }

  std::optional<size_t> swing_before(double t) const {
    std::optional<size_t> found;
    double begin = 0;
    for (size_t i = 0; i < task_.pattern.phases.size() && begin <= t + kRounding; ++i) {
      if (task_.pattern.phases[i].swing) found = i;
      begin = task_.pattern.phases[i].until;
    }
    return found;
  }

  double width_of_sole() const {
    double low = 0, high = 0;
    for (const Eigen::Vector2d& corner : task_.robot.sole(Side::left).polygon) {
      low = std::min(low, corner.y() - task_.robot.sole(Side::left).center.y());
      high = std::max(high, corner.y() - task_.robot.sole(Side::left).center.y());
    }
    return high - low;
  }

  // The clearance between the feet at the end of a phase, where the pattern plans them. Returns
  // nothing if the pattern plans no feet there.
  std::optional<double> clearance_at_end(const Pattern& pattern, size_t phase) {
    std::array<Isometry3d, 2> soles;
    try {
      soles = FootPlan(task_.robot, pattern).poses(pattern.phases[phase].until);
    } catch (const Error&) {
      return {};
    }
    data_.base_position.setZero();
    for (const Side side : {Side::left, Side::right}) {
      const Sole& sole = task_.robot.sole(side);
      const Isometry3d body = soles[static_cast<size_t>(index(side))] * sole.frame.inverse();
      data_.rotation[static_cast<size_t>(sole.body)] = body.linear();
      data_.position[static_cast<size_t>(sole.body)] = body.translation();
    }
    const auto [a, b] =
        std::minmax(task_.robot.sole(Side::left).body, task_.robot.sole(Side::right).body);
    return collisions_.clearance({a, b}, data_, kMostSide);
  }

  // The pattern with a change of one phase. A phase of a block that repeats is written once.
  Pattern changed(size_t phase, const Change& change) const {
    Pattern pattern = task_.pattern;
    const std::string pointer = pointer_of_phase(pattern, phase);
    for (size_t i = 0; i < pattern.phases.size(); ++i)
      if (pattern.phases[i].swing && pointer_of_phase(pattern, i) == pointer)
        change(*pattern.phases[i].swing);
    return pattern;
  }

  // The number of errors that the check finds with this change. Returns nothing if the robot cannot
  // do the motion.
  std::optional<size_t> errors_with(const Pattern& pattern) const {
    try {
      const CommandSeries series = sample_at_servo_period(task_.robot, pattern, {}, task_.threads);
      return errors_of(check_consistency(task_.robot, series, options_));
    } catch (const Error& error) {
      if (error.code() != ErrorCode::bad_pattern) throw;
      return {};
    }
  }

  // The first of the changes with which the feet are apart, provided that the check then finds
  // fewer errors.
  template <typename ChangeAt>
  std::optional<Remedy> first_apart(size_t phase, int count, const ChangeAt& change_at) {
    for (int n = 1; n <= count; ++n) {
      const auto [change, words] = change_at(n);
      const Pattern pattern = changed(phase, change);
      const std::optional<double> apart = clearance_at_end(pattern, phase);
      if (!apart) return {};
      if (*apart < wanted_) continue;
      const std::optional<size_t> errors = errors_with(pattern);
      if (!errors || *errors >= errors_) return {};
      return Remedy{words, *errors};
    }
    return {};
  }

  // The change that moves the foot outwards, as seen from the other foot.
  std::optional<Remedy> to_the_side(size_t phase) {
    const Swing& swing = *task_.pattern.phases[phase].swing;
    const double outwards = swing.foot == Side::left ? 1 : -1;
    const FootPlan plan(task_.robot, task_.pattern);
    const Isometry3d stance = plan.pose(other(swing.foot), task_.pattern.phases[phase].until);
    return first_apart(phase, static_cast<int>(std::lround(kMostSide / kSideGrain)), [&](int n) {
      // `to` is n whole steps beyond the written value, counted outwards.
      const double from = swing.step ? outwards * swing.step->side : 0;
      const double to = kSideGrain * (std::floor(from / kSideGrain + kRounding) + n);
      const Eigen::Vector3d shift = (to - from) * outwards * stance.linear().col(1);
      const Eigen::Vector3d place = swing.to.position + shift;
      const std::string words = swing.step ? "side = " + text::brief(outwards * to, 6) + " m"
                                           : "to = [" + text::brief(place.x(), 4) + ", " +
                                                 text::brief(place.y(), 4) + ", ...]";
      return std::pair<Change, std::string>(
          [=, by_step = swing.step.has_value()](Swing& s) {
            if (by_step)
              s.step->side += outwards * (to - from);
            else
              s.to.position += shift;
          },
          words);
    });
  }

  // The change that turns the foot less relative to the other foot than the pattern says.
  std::optional<Remedy> less_turned(size_t phase) {
    const Swing& swing = *task_.pattern.phases[phase].swing;
    if (!swing.step || std::abs(swing.step->turn) < kRounding) return {};
    const bool degrees = task_.pattern.degrees;
    const double grain = degrees ? kDegree : kRadianGrain, turn = swing.step->turn;
    const int whole = static_cast<int>(std::ceil(std::abs(turn) / grain - kRounding));
    return first_apart(phase, whole, [&](int n) {
      const double to = std::copysign((whole - n) * grain, turn);
      return std::pair<Change, std::string>(
          [=](Swing& s) { s.step->turn += to - turn; },
          "turn = " + (degrees ? text::brief(to / kDegree, 6) + " deg" : text::brief(to, 6)));
    });
  }

  std::optional<Mistake> mistake_at(size_t phase) {
    const std::optional<double> clearance = clearance_at_end(task_.pattern, phase);
    if (!clearance || *clearance >= 0) return {};  // the feet collide during the step
    if (-*clearance > kGrazing * width_of_sole()) return {};
    const Swing& swing = *task_.pattern.phases[phase].swing;
    std::string words = std::string("the ") + name_of(swing.foot) + " foot lands " +
                        text::fixed(-1e3 * *clearance, 1) + " mm inside the " +
                        name_of(other(swing.foot)) + " foot";
    for (const std::optional<Remedy>& remedy : {to_the_side(phase), less_turned(phase)}) {
      if (!remedy) continue;
      words += ". With " + remedy->words + ", " + text::remaining(remedy->errors, errors_, "error");
    }
    return Mistake{pointer_of_phase(task_.pattern, phase) + "/swing", words};
  }

  const Task& task_;
  const CheckOptions& options_;
  const CollisionModel collisions_;
  RobotData data_;
  const double wanted_;
  const size_t errors_;
};

}  // namespace

std::vector<Mistake> foothold_collisions(const Task& task, const CheckOptions& options,
                                         const ConsistencyReport& report) {
  if (task.pattern.table) return {};  // nobody wrote the postures of a table by hand
  return Footholds(task, options, report).found(report);
}

std::vector<Mistake> likely_causes(const Task& task, const CheckOptions& options,
                                   const ConsistencyReport& report, const Progress& progress) {
  std::vector<Mistake> causes = foothold_collisions(task, options, report);
  const std::vector<Mistake> mistakes =
      likely_mistakes(task.robot, task.pattern, options, progress);
  const auto explained = [&](const Mistake& foothold) {
    return mistakes.size() == 1 && mistakes[0].explains_all && !mistakes[0].place.empty() &&
           foothold.place.starts_with(mistakes[0].place);
  };
  std::erase_if(causes, explained);
  // A collision of the feet is only named after a cause that explains everything.
  const bool enough = std::any_of(mistakes.begin(), mistakes.end(),
                                  [](const Mistake& mistake) { return mistake.explains_all; });
  causes.insert(enough ? causes.begin() : causes.end(), mistakes.begin(), mistakes.end());
  return causes;
}

}  // namespace ayumi
