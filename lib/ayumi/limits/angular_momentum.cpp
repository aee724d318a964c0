// In flight no external moment acts, so the angular momentum L about the COG is constant, dL/dt =
// 0. Here, dL/dt is the moment of the demanded ground wrench about the COG. The rate of a single
// sample contains the rounding of differences, so the mean over five samples is judged. A repair
// keeps this limit together with the force, in the rows of free_fall.cpp.
#include <algorithm>

#include "ayumi/limits/flight_moment.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector3d;

namespace {

// Rate of the angular momentum in flight [N m]. Source: docs/attribution.md: legs that swing at
// 1000 rad/s^2 leave 0.1 N m of rounding in single samples of a robot of 6 kg.
constexpr double kMomentTolerance = 0.1;

// The same limit as a share of weight times COG height, for larger robots. Source:
// docs/attribution.md; it is 0.1 N m for a robot of 6 kg whose COG is 0.26 m high.
constexpr double kMomentShare = 0.0065;

// Number of samples on either side of the mean. Derived: the reach of fill_rates().
constexpr int kMeanReach = 2;

}  // namespace

bool flies_freely(const CommandSeries& series, int sample) {
  return sample >= 0 && sample < static_cast<int>(series.samples.size()) &&
         series.samples[sample].support == Support::none && !at_flight_edge(series, sample);
}

Vector3d mean_flight_moment(const CommandSeries& series, int sample,
                            const std::function<Vector3d(int)>& moment) {
  Vector3d sum = Vector3d::Zero();
  int samples = 0;
  for (int i = sample - kMeanReach; i <= sample + kMeanReach; ++i) {
    if (!flies_freely(series, i)) continue;
    sum += moment(i);
    ++samples;
  }
  if (samples > 0) sum /= samples;
  return sum;
}

namespace {

double least_moment_tolerance(const RobotModel& model, const CommandSeries& series) {
  return kMomentShare * model.mass() * kGravity * series.samples.front().cog.z();
}

void note_moment(JudgedMotion& motion, const JudgedSample& s, const RobotData&) {
  if (s.known && s.flies()) motion.flight_moment[s.k] = s.demand.moment;
}

void judge_angular_momentum(JudgedMotion& motion) {
  const double limit = motion.tolerance(FindingKind::angular_momentum);
  for (int k = 0; k < motion.count(); ++k) {
    if (!motion.flies_freely(k)) continue;
    const Vector3d mean =
        mean_flight_moment(motion.series, k, [&](int i) { return motion.flight_moment[i]; });
    const double size = mean.norm();
    motion.raise(FindingKind::angular_momentum, size, k, 0, largest_axis(mean));
    if (size > limit)
      motion.add(FindingKind::angular_momentum, 0, k, size, limit, size, largest_axis(mean));
  }
}

bool angular_momentum_holds(JudgedMotion& motion, const Violation& v, double pace) {
  return motion.dynamics.at(v.sample, pace).moment.norm() <= std::abs(v.limit) &&
         flight_is_free(motion, v.sample, pace, motion.tolerance(FindingKind::ballistic));
}

Advice angular_momentum_advice(const JudgedMotion&, const FindingWindow&) {
  return {"the angular momentum cannot change in flight",
          "move arms and legs so that their angular momenta cancel each other", ""};
}

std::string angular_momentum_infeasibility(const Finding&, double) {
  return "the angular momentum changes in flight";
}

}  // namespace

const Limit& angular_momentum_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::angular_momentum,
                    .limit_class = LimitClass::force,
                    .unit = "N m",
                    .tolerance = kMomentTolerance,
                    .meaning = "rate of the angular momentum about the COG in flight",
                    .least_tolerance = least_moment_tolerance,
                    .figure = {.key = "max_momentum_rate_Nm",
                               .label = "largest rate of the angular momentum in flight",
                               .unit = "N m",
                               .line = 19},
                    .repair = {.in_flight = true},
                    .place = axis_place,
                    .advice = angular_momentum_advice,
                    .infeasibility = angular_momentum_infeasibility,
                    .holds_at = angular_momentum_holds}},
      .note_sample = note_moment,
      .judge_motion = judge_angular_momentum};
  return limit;
}

}  // namespace ayumi
