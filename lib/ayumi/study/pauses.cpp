#include "ayumi/study/pauses.hpp"

#include "ayumi/author/edit/edit.hpp"

namespace ayumi {

namespace {

// Speeds of joints [rad/s] and of the trunk [m/s, rad/s] below which nothing moves. Chosen: to an
// observer, such a motion looks like standing; while a pose is held, the COG that is solved from
// the ZMP still settles by a millimetre or two. With a tenth of the values, holds of less than a
// second are missed; half or twice changes the length of a pause by a tenth of a second.
constexpr double kStillJoint = 0.01, kStillTrunk = 2e-3, kStillTurn = 0.01;
// Shortest pause [s]. Chosen: keyed joints that turn back rest for a few hundredths of a second.
constexpr double kShortest = 0.1;

bool is_still(const CommandSample& sample) {
  const RobotState& state = sample.state;
  return state.dtheta.lpNorm<Eigen::Infinity>() < kStillJoint &&
         state.base_velocity.norm() < kStillTrunk &&
         state.base_angular_velocity.norm() < kStillTurn;
}

}  // namespace

std::vector<TimeSpan> pauses_of(const CommandSeries& series) {
  std::vector<TimeSpan> result;
  const size_t count = series.samples.size();
  for (size_t k = 0; k < count; ++k) {
    const size_t begin = k;
    while (k < count && is_still(series.samples[k])) ++k;
    const double from = series.dt * static_cast<double>(begin);
    const double to = series.dt * (static_cast<double>(k) - 1);
    if (k > begin && to - from >= kShortest) result.emplace_back(from, to);
  }
  return result;
}

Pattern with_pauses_stretched(const RobotModel& model, const Pattern& pattern,
                              const std::vector<TimeSpan>& pauses, double factor) {
  Pattern result = pattern;
  if (pattern.table || pattern.correction) return result;
  for (auto pause = pauses.rbegin(); pause != pauses.rend(); ++pause)
    result = stretched(model, result, pause->first, pause->second, factor);
  return result;
}

}  // namespace ayumi
