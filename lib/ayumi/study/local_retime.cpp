#include "ayumi/study/local_retime.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/motion/servo_feedforward.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/plan/viip_phases.hpp"
#include "ayumi/sim/simulator.hpp"
#include "ayumi/study/pauses.hpp"

namespace ayumi {

namespace {

// Share of the distance between standing still and a limit that a timing may use at first. Chosen:
// the remaining share is larger than the effect of the smoothing and of the ticks between two
// points.
constexpr double kFirstShare = 0.97;
// Factor by which this share is reduced around an error of the check: the limit divided by the
// value, within these bounds, and the time to either side [s of the path]. Chosen: one to three
// rounds remove the errors that were seen.
constexpr double kLeastShareStep = 0.9, kMostShareStep = 0.94;
constexpr double kAround = 0.04;
// Largest number of timings that are checked. Chosen: twice the largest number that a walk needed.
constexpr int kMostRounds = 10;
// Number of timings, each of which gives the tangents of the next one, in the first and in later
// rounds. Measured: the third changes the duration by less than 0.1 %; a later round begins near
// its result.
constexpr int kTimings = 3, kLaterTimings = 2;

// Width of one of the three boxes that smooth a timing [s], so that s'' has no jump and no kink.
// Chosen: servos of small robots answer within 30 ms, and the motion gets 36 ms longer.
constexpr double kBox = 0.013;

// Period of sampling in the search for the pace of the path [s]. Chosen: the search then takes a
// tenth of the usual work.
constexpr double kSearchPeriod = 0.01;
// Spacing of the points in this search [s]. Chosen: each peak of a swing of 0.2 s has several
// points.
constexpr double kSearchSpacing = 0.02;
// Relative accuracy of the pace that this search finds, and the factor by which the path is then
// slower. Chosen: coarse samples miss the peaks by about a percent.
constexpr double kPaceAccuracy = 0.02;
constexpr double kPaceSpare = 1.01;
// Factor between paces if the ZMP leaves the support, which no row predicts. Chosen.
constexpr double kSlowerPace = 1.25;
// Largest number of paces that are tried. Chosen: more than the search needs from one end of its
// range to the other.
constexpr int kMostPaces = 25;
// Factor by which the path becomes slower if limits contradict each other, and the largest number
// of such changes. Chosen: the share of the limits that is used requires 1.5 %.
constexpr double kSlowerPath = 1.03;
constexpr int kMostSlower = 6;

// Smallest factor on the time of the part of a pause without motion, if its ends last longer than
// on the path. Definition: the largest pace is four times that of the path.
constexpr double kLeastStill = 0.25;

// Smallest margin of the ZMP that is kept if 80 % of the path's margin is smaller, as a share of
// half the width of the narrower sole. Chosen: a quarter.
constexpr double kLeastMargin = 0.25;

// Largest margins that are kept in other timings, as shares of half this width. Chosen: between
// kLeastMargin and the whole half; H1 stands with each of them.
constexpr double kOtherMargins[] = {0.6, 0.75, 0.9};

bool keys_fly(const Pattern& pattern) {
  return std::any_of(pattern.phases.begin(), pattern.phases.end(),
                     [](const Phase& phase) { return phase.support == Support::none; });
}

class LocalSearch {
 public:
  LocalSearch(const RobotModel& model, const Pattern& pattern, const std::string& table,
              const LocalRetimeOptions& options, const Progress& progress)
      : model_(model),
        pattern_(pattern),
        table_(table),
        options_(options),
        progress_(progress),
        given_duration_(pattern.duration()) {
    if (pattern_.table)
      *pattern_.table =
          postures_of(model, model.limits(options.path.check.profile), *pattern_.table);
    if (options.keep_pauses)
      pauses_ =
          pauses_of(sample(model, pattern_, {.dt = std::max(options.dt, kSearchPeriod)}, progress));
  }

  LocalPace run() {
    const double scale = keys_fly(pattern_) ? 1 : path_scale();
    search(scale, options_.path.most_margin);
    if (result_.found && options_.world) stand_if_path_stands();
    return std::move(result_);
  }

 private:
  // Begins with a path and a trial (see below), and remembers the trial with which it ends.
  void search(double path_scale, double most_margin, int first_trial = 0) {
    result_ = {};
    result_.path_scale = path_scale;
    most_margin_ = most_margin;
    // The smallest margin is given up first, because a posture may be nearer to the edge than this
    // margin at every pace. After that, the path becomes slower.
    for (trial_ = first_trial; trial_ <= kMostSlower; ++trial_) {
      result_.limited_by.clear();
      if (trial_ > std::max(1, first_trial)) result_.path_scale *= kSlowerPath;
      take_path(trial_ == 0 ? kLeastMargin * half_sole_width(model_) : 0);
      if (play_rounds() || !stuck_ || (limits_->flies() && trial_ > 0)) break;
    }
  }

  // A timing keeps the ZMP near the edge of a sole, and torques near their limits, for longer than
  // the uniform pace, so the robot may fall although it stands at that pace. No margin predicts
  // this: HOAP-1 may fall with its ZMP 15 mm inside its soles. Then timings are tried whose ZMP
  // need not be so far inside in the double support, and finally the uniform pace.
  void stand_if_path_stands() {
    const double half = half_sole_width(model_);
    try {
      result_.stands = stands(result_.series);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::bad_model) throw;
      result_.not_simulated = error.what();
      return;
    }
    if (*result_.stands) return;
    const CommandSeries path = path_;
    const Pattern path_pattern = path_pattern_;
    const double path_scale = path_scale_;
    const int trial = trial_;
    if (!stands(path)) {
      result_.stands = true;  // no worse than at the uniform pace
      return;
    }
    const LocalPace first = result_;
    for (const double share : kOtherMargins) {
      if (share * half >= options_.path.most_margin) break;  // more than the caller allows
      report(progress_,
             {"changing the timing", -1, "the robot falls in open loop; another timing is tried"});
      search(path_scale, share * half, trial);
      if (result_.found && stands(result_.series)) {
        result_.stands = true;
        return;
      }
    }
    result_ = first;
    if (take_uniform(path_scale, path_pattern, path)) return;
    // Flights keep their pace.
    double slower = path_scale;
    for (int n = 1; n <= kMostSlower && !keys_fly(pattern_); ++n) {
      slower *= kSlowerPath;
      report(progress_, {"changing the timing", -1, "uniform scale " + text::fixed(slower, 4)});
      try {
        const Pattern pattern = at_scale(slower);
        const CommandSeries series = sample(model_, pattern, {.dt = options_.dt}, progress_);
        if (take_uniform(slower, pattern, series) && stands(series)) return;
      } catch (const Error& error) {  // the COG sways further at this pace than the legs reach
        if (error.code() != ErrorCode::bad_pattern) throw;
      }
      result_ = first;
    }
  }

  // Makes the motion at a uniform pace the result if it passes the check.
  bool take_uniform(double scale, const Pattern& pattern, const CommandSeries& series) {
    ConsistencyReport report = check_consistency(model_, series, options_.path.check);
    if (!report.consistent) return false;
    result_.stands = result_.uniform = true;
    result_.path_scale = scale;
    result_.pattern = pattern;
    result_.series = series;
    result_.report = std::move(report);
    result_.scale = series.duration() / given_duration_;
    result_.binding = {};
    return true;
  }

  // Whether the robot stands at the end when the motion is simulated in open loop, without pushes.
  // Throws Error(bad_model) for a robot that cannot be simulated.
  bool stands(const CommandSeries& series) const {
    SimulateOptions play;
    play.controller.type.kind = ControllerKind::none;
    play.profile = options_.path.check.profile;
    play.world = *options_.world;
    Simulator run(model_, series, play);
    run.gather_verdict_only();
    // Number of ticks between two looks at whether the robot fell. Chosen: a fallen robot takes
    // long to simulate, and a look takes no time.
    constexpr long kTicks = 100;
    try {
      while (!run.fell() && run.advance(kTicks, progress_)) continue;
    } catch (const Error& error) {  // the state of a fall may become infinite
      if (error.code() != ErrorCode::internal) throw;
      return false;
    }
    return !run.fell() && run.result().outcome == Outcome::stands;
  }

  struct Timing {
    std::vector<double> u, x;
  };

  /// A pause on the path, and the part of the pause without motion.
  struct Pause {
    double begin = 0, end = 0;  ///< places on the path
    double length = 0;          ///< length in the given pattern [s]
    TimeSpan still;             ///< places on the path of the part without motion
  };

  // Plays the path at one pace, except in the pauses that are kept.
  Pattern at_scale(double scale) const {
    Pattern path = retimed(model_, pattern_, scale);
    std::vector<TimeSpan> scaled = pauses_;
    for (TimeSpan& pause : scaled) pause = {scale * pause.first, scale * pause.second};
    return pauses_.empty() ? path : with_pauses_stretched(model_, path, scaled, 1 / scale);
  }

  // On a faster path, the motion in a pause may come to rest later.
  void find_pauses() {
    kept_.clear();
    if (pauses_.empty()) return;
    const std::vector<TimeSpan> still = pauses_of(path_);
    const bool stretches = !pattern_.table && !pattern_.correction;
    const double scale = result_.path_scale;
    double later = 0;
    for (const TimeSpan& given : pauses_) {
      Pause pause;
      pause.length = given.second - given.first;
      pause.begin = scale * given.first + later;
      pause.end = pause.begin + (stretches ? 1 : scale) * pause.length;
      later = pause.end - scale * given.second;
      for (const TimeSpan& span : still) {
        const TimeSpan common = {std::max(pause.begin, span.first),
                                 std::min(pause.end, span.second)};
        if (common.second - common.first > pause.still.second - pause.still.first)
          pause.still = common;
      }
      if (pause.still.second > pause.still.first) kept_.push_back(pause);
    }
  }

  void take_path(double least_margin) {
    if (path_.samples.empty() || path_scale_ != result_.path_scale) {
      path_scale_ = result_.path_scale;
      path_pattern_ = at_scale(path_scale_);
      path_ = sample(model_, path_pattern_, {.dt = options_.dt}, progress_);
      find_pauses();
    }
    PathLimitOptions path = options_.path;
    path.least_margin = least_margin;
    path.most_margin = most_margin_;
    for (const Pause& pause : kept_) path.pauses.push_back(pause.still);
    limits_.emplace(model_, path_, path);
    share_.assign(limits_->points().size(), kFirstShare);
    timing_ = {};
  }

  // Repeats until the check passes, or until the remaining limits contradict each other.
  bool play_rounds() {
    for (int round = 1; round <= kMostRounds; ++round) {
      const std::optional<Timing> timing = quickest();
      stuck_ = !timing;
      if (stuck_) return false;
      ++result_.rounds;
      if (play(*timing)) return true;
      if (result_.by_posture) break;
    }
    result_.limited_by = first_error();
    return false;
  }

  // The smallest scale at which the whole path is within its limits, found with coarse samples,
  // times kPaceSpare. It is 1 if no such scale is found.
  double path_scale() {
    PathLimitOptions path = options_.path;
    path.own_margin = 0;
    path.spacing = kSearchSpacing;
    double scale = 1, keeps = 0, fails = 0;
    for (int n = 0; n < kMostPaces && scale <= options_.slowest; ++n) {
      report(progress_, {"changing the timing", -1, "scale " + text::fixed(scale, 4)});
      const std::optional<PathLimits::UniformPace> pace = coarse_pace(scale, path);
      const bool foretold = pace && pace->pace > 0;
      if (pace && pace->keeps) {
        keeps = scale;
        if (pace->pace < 1 + kPaceAccuracy || keeps <= options_.fastest) break;
        scale = std::max(scale / pace->pace, options_.fastest);
      } else {
        fails = scale;
        scale *= foretold && pace->pace < 1 ? (1 + kPaceAccuracy / 2) / pace->pace : kSlowerPace;
      }
      if (keeps == 0 || fails == 0) continue;
      if (keeps < fails * (1 + kPaceAccuracy)) break;
      if (scale <= fails || scale >= keeps) scale = std::sqrt(keeps * fails);
    }
    return keeps > 0 ? std::min(keeps * kPaceSpare, options_.slowest) : 1;
  }

  std::optional<PathLimits::UniformPace> coarse_pace(double scale, const PathLimitOptions& path) {
    try {
      const double period = std::max(options_.dt, kSearchPeriod);
      const CommandSeries series = sample(model_, at_scale(scale), {.dt = period}, progress_);
      return PathLimits(model_, series, path).uniform_pace();
    } catch (const Error& error) {
      if (error.code() != ErrorCode::bad_pattern || scale == 1) throw;
      return std::nullopt;
    }
  }

  // The timing of this round. Returns nothing if the limits contradict each other.
  std::optional<Timing> quickest() {
    const std::vector<TimingPoint>& points = limits_->points();
    const int timings = timing_.x.empty() ? kTimings : kLaterTimings;
    if (timing_.x.empty())
      timing_ = {std::vector<double>(points.size(), 0), std::vector<double>(points.size(), 1)};
    for (int n = 0; n < timings; ++n) {
      limits_->linearize(timing_.u, timing_.x, share_);
      PathTiming found = quickest_timing(points);
      if (found.x.empty()) {
        const std::string broken = limits_->broken_at(found.stuck);
        const double at = given_time(points[static_cast<size_t>(found.stuck)].at);
        result_.limited_by = "at " + text::fixed(at, 3) + " s, no pace satisfies all limits" +
                             (broken.empty() ? "" : "; even a robot at rest violates " + broken);
        return std::nullopt;
      }
      timing_.x = std::move(found.x);
      for (size_t i = 0; i + 1 < points.size(); ++i)
        timing_.u[i] = (timing_.x[i + 1] - timing_.x[i]) / (2 * (points[i + 1].at - points[i].at));
      timing_.u.back() = 0;
    }
    return timing_;
  }

  // Samples and checks the result. Returns whether the check passes.
  bool play(const Timing& timing) {
    report(progress_, {"changing the timing", -1, "round " + std::to_string(result_.rounds)});
    const std::vector<double> times = times_of(timing.x);
    result_.binding = limits_->binding(timing.u, timing.x, times);
    const TimeCourse course = course_of(timing.x, times);
    result_.pattern = with_course(model_, path_pattern_, path_, course, table_);
    result_.series = sample(model_, result_.pattern, {.dt = options_.dt}, progress_);
    result_.report = check_consistency(model_, result_.series, options_.path.check);
    result_.scale = result_.series.duration() / given_duration_;
    result_.found = result_.report.consistent;
    if (result_.found) return true;
    for (const Finding& f : result_.report.findings) {
      if (f.severity != Severity::error) continue;
      result_.by_posture = result_.by_posture || is_of_posture(f);
      const double over = std::abs(f.limit) / std::max(std::abs(f.worst), 1e-9);
      lower_share(
          place(course, f.begin) - kAround, place(course, f.end) + kAround,
          f.limit == 0 ? kMostShareStep : std::clamp(over, kLeastShareStep, kMostShareStep));
    }
    return false;
  }

  double place(const TimeCourse& course, double t) const {
    const long last = static_cast<long>(course.at.size()) - 1;
    return course.at[static_cast<size_t>(std::clamp(std::lround(t / course.dt), 0L, last))];
  }

  void lower_share(double begin, double end, double factor) {
    for (size_t i = 0; i < share_.size(); ++i)
      if (limits_->points()[i].at >= begin && limits_->points()[i].at <= end) share_[i] *= factor;
  }

  // The time of the given pattern at a place on the path.
  double given_time(double place) const {
    double time = place / result_.path_scale;
    for (const Pause& pause : kept_) {
      const double inside = std::clamp(place - pause.begin, 0.0, pause.end - pause.begin);
      time += pause.length * inside / (pause.end - pause.begin) - inside / result_.path_scale;
    }
    return time;
  }

  // The time of each point. The part of a pause without motion lasts until the whole pause has its
  // length.
  std::vector<double> times_of(const std::vector<double>& x) const {
    const std::vector<TimingPoint>& points = limits_->points();
    std::vector<double> times = times_along(points, x);
    const auto first_at = [&](double place) {
      return static_cast<size_t>(
          std::lower_bound(points.begin(), points.end(), place - 1e-9,
                           [](const TimingPoint& point, double at) { return point.at < at; }) -
          points.begin());
    };
    for (const Pause& pause : kept_) {
      const size_t begin = first_at(pause.begin), end = std::min(first_at(pause.end), x.size() - 1);
      const size_t from = first_at(pause.still.first);
      const size_t to = std::min(first_at(pause.still.second), x.size() - 1);
      if (from >= to) continue;
      const double missing = pause.length - (times[end] - times[begin]);
      const double still = times[to] - times[from];
      const double factor = std::max(kLeastStill, 1 + missing / still);
      const double start = times[from];
      for (size_t i = from + 1; i < times.size(); ++i)
        times[i] = i <= to ? start + factor * (times[i] - start) : times[i] + (factor - 1) * still;
    }
    return times;
  }

  // The place s at each tick, smoothed by three boxes, from rest to rest.
  TimeCourse course_of(const std::vector<double>& x, const std::vector<double>& times) const {
    const std::vector<TimingPoint>& points = limits_->points();
    const int half = std::max(1, static_cast<int>(std::lround(kBox / options_.dt / 2)));
    const auto beside = static_cast<size_t>(3 * half);
    const double end = points.back().at;
    const auto count = static_cast<size_t>(std::ceil(times.back() / options_.dt - 1e-9)) + 1;
    std::vector<double> at(beside, 0.0);
    size_t i = 0;
    for (size_t k = 0; k < count; ++k) {
      const double t = options_.dt * static_cast<double>(k);
      while (i + 2 < times.size() && times[i + 1] <= t) ++i;
      const double step = points[i + 1].at - points[i].at;
      // The duration of this step that follows from x. In a pause, `times` has another duration.
      const double lasts = 2 * step / (std::sqrt(x[i]) + std::sqrt(x[i + 1]));
      const double later = (t - times[i]) * lasts / (times[i + 1] - times[i]);
      const double u = (x[i + 1] - x[i]) / (2 * step);
      at.push_back(std::min(points[i].at + later * (std::sqrt(x[i]) + 0.5 * u * later), end));
    }
    at.insert(at.end(), beside, end);
    for (int round = 0; round < 3; ++round) at = box_mean(at, half);
    at.front() = 0;
    at.back() = end;
    TimeCourse course;
    course.dt = options_.dt;
    course.at = std::move(at);
    return course;
  }

  static std::vector<double> box_mean(const std::vector<double>& values, int half) {
    const int last = static_cast<int>(values.size()) - 1;
    std::vector<double> result(values.size());
    for (int k = 0; k <= last; ++k) {
      double sum = 0;
      for (int j = k - half; j <= k + half; ++j)
        sum += values[static_cast<size_t>(std::clamp(j, 0, last))];
      result[static_cast<size_t>(k)] = sum / (2 * half + 1);
    }
    return result;
  }

  std::string first_error() const {
    const Finding* shown = nullptr;
    for (const Finding& f : result_.report.findings)
      if (f.severity == Severity::error && (!shown || (is_of_posture(f) && !is_of_posture(*shown))))
        shown = &f;
    if (!shown) return "the check";
    return kind_place_and_time(*shown) + ": " + amount_text(*shown) + " (when the motion takes " +
           text::fixed(result_.series.duration(), 3) + " s)";
  }

  const RobotModel& model_;
  Pattern pattern_;
  const std::string& table_;
  const LocalRetimeOptions& options_;
  const Progress& progress_;
  const double given_duration_;
  LocalPace result_;
  std::vector<TimeSpan> pauses_;  // pauses of the given pattern, if they are kept
  std::vector<Pause> kept_;
  double most_margin_ = kUnbounded;  // largest margin of the ZMP that is kept [m]
  double path_scale_ = 0;            // the scale of the path that was sampled last
  Pattern path_pattern_;
  CommandSeries path_;
  std::optional<PathLimits> limits_;
  Timing timing_;
  std::vector<double> share_;  // share of the distance to a limit that may be used, by point
  bool stuck_ = false;         // the limits contradict each other
  int trial_ = 0;              // the trial of the search (see search())
};

}  // namespace

LocalPace fastest_local_pace(const RobotModel& model, const Pattern& pattern,
                             const std::string& table, const LocalRetimeOptions& options,
                             const Progress& progress) {
  if (options.path.most_margin != kUnbounded)
    require_within("the largest margin of the ZMP", options.path.most_margin,
                   LocalRetimeOptions::kMostMargin);
  if (table.empty() || table.find('\0') != std::string::npos)
    fail(ErrorCode::usage,
         "the table of the new timing needs a file name without the character NUL");
  refuse_viip_phases(pattern, "retimed");
  return LocalSearch(model, pattern, table, options, progress).run();
}

}  // namespace ayumi
