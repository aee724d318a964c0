#include "ayumi/author/edit/gait_cycle.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/motion/pattern_context.hpp"

namespace ayumi {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Middle of the feet and their mean heading.
Isometry3d middle_of(const CommandSample& sample) {
  const Isometry3d &left = sample.feet[0], &right = sample.feet[1];
  const double a = matrix_to_rpy(left.linear()).z();
  const double between = std::remainder(matrix_to_rpy(right.linear()).z() - a, 2 * M_PI);
  Isometry3d frame = Isometry3d::Identity();
  frame.translation() = 0.5 * (left.translation() + right.translation());
  frame.linear() = rpy_to_matrix({0, 0, a + 0.5 * between});
  return frame;
}

}  // namespace

GaitCycle gait_cycle(const RobotModel& model, const MotionPart& motion, int swing) {
  const std::vector<Phase>& phases = motion.pattern.phases;
  std::vector<size_t> swings;
  for (size_t i = 0; i < phases.size(); ++i)
    if (phases[i].swing) swings.push_back(i);
  const auto wanted = static_cast<size_t>(swing);
  if (swing < 0 || swings.size() < wanted + 3)
    fail(ErrorCode::bad_pattern, in_file(motion.pattern, "/phases"),
         "the motion has " + text::counted(swings.size(), "swing") + ", but at least " +
             std::to_string(wanted + 3) + " swings are needed to cut out a cycle of two steps");
  const double dt = motion.series.dt;
  const auto middle_before = [&](size_t i) {
    const size_t phase = swings[i];
    const double until = phase > 0 ? phases[phase - 1].until : 0;
    const double from = phase > 1 ? phases[phase - 2].until : 0;
    return 0.5 * (from + until);
  };
  GaitCycle cycle;
  const double begin = middle_before(wanted);
  cycle.begin = std::lround(begin / dt);
  cycle.end = cycle.begin + std::lround((middle_before(wanted + 2) - begin) / dt);
  cycle.first = phases[swings[wanted]].swing->foot;
  CommandSeries part;
  part.dt = dt;
  part.samples.assign(motion.series.samples.begin() + cycle.begin,
                      motion.series.samples.begin() + cycle.end + 1);
  cycle.gap = loop_gap(model, {motion.pattern, part});
  const Isometry3d from = middle_of(part.samples.front()), to = middle_of(part.samples.back());
  cycle.displacement = (from.inverse() * to.translation()).head<2>();
  cycle.turn =
      std::remainder(matrix_to_rpy(to.linear()).z() - matrix_to_rpy(from.linear()).z(), 2 * M_PI);
  return cycle;
}

namespace {

// Times closer than this are equal [s]. Chosen: above rounding, below a tick.
constexpr double kSameTick = 1e-6;

// The phases that end after `begin`, up to `end`, with times from 0 on.
std::vector<Phase> phases_within(const std::vector<Phase>& phases, double begin, double end) {
  std::vector<Phase> result;
  double from = 0;
  for (const Phase& phase : phases) {
    if (phase.until > begin + kSameTick && from < end - kSameTick) {
      result.push_back(phase);
      result.back().until = std::min(phase.until, end) - begin;
    }
    from = phase.until;
  }
  if (!result.empty()) result.back().until = end - begin;
  return result;
}

}  // namespace

Pattern cut(const RobotModel& model, const MotionPart& motion, long first, long last,
            const std::string& table) {
  const CommandSeries& series = motion.series;
  const auto count = static_cast<long>(series.samples.size());
  if (!(first >= 0 && first < last && last < count))
    fail(ErrorCode::usage, "samples " + std::to_string(first) + " to " + std::to_string(last) +
                               " cannot be cut out of a motion with the samples 0 to " +
                               std::to_string(count - 1) +
                               ". The last sample must come after the first");
  const CommandSample& start = series.samples[static_cast<size_t>(first)];
  for (const long k : {first, last})
    if (series.samples[static_cast<size_t>(k)].support != Support::both)
      fail(ErrorCode::bad_pattern, in_file(motion.pattern, "/phases"),
           "at " + text::exact(series.dt * static_cast<double>(k)) +
               " s, a foot is in the air. Let the part begin and end where "
               "both feet are on the ground");
  Pattern result = baked(model, motion.pattern, series, table);
  result.repair = {};  // its times and joints are those of the whole walk
  DenseTable& dense = *result.table;
  const long rows = last - first + 1;
  dense.theta = dense.theta.middleRows(first, rows).eval();
  dense.base = {dense.base.begin() + first, dense.base.begin() + last + 1};
  dense.cog.clear();
  dense.zmp.clear();
  dense.fz.clear();
  const double begin = series.dt * static_cast<double>(first);
  const double end = series.dt * static_cast<double>(last);
  result.phases = phases_within(result.phases, begin, end);
  for (const size_t side : {0, 1}) {
    const Eigen::Isometry3d& foot = start.feet[side];
    result.start_feet[side] = Foothold{foot.translation(), matrix_to_rpy(foot.linear())};
  }
  std::erase_if(result.keyframes, [&](const Keyframe& key) {
    return key.t < begin - kSameTick || key.t > end + kSameTick;
  });
  for (Keyframe& key : result.keyframes) key.t = std::clamp(key.t - begin, 0.0, end - begin);
  std::erase_if(result.scenario, [&](const Disturbance& each) {
    return each.at < begin - kSameTick || each.at > end - kSameTick;
  });
  for (Disturbance& each : result.scenario) each.at -= begin;
  // Weights that were given before `begin` still apply.
  Keyframe before;
  for (const Keyframe& key : motion.pattern.keyframes)
    if (key.t < begin - kSameTick)
      for (const auto& [joint, weight] : key.weights) before.weights[joint] = weight;
  if (before.weights.empty()) return result;
  if (result.keyframes.empty() || result.keyframes.front().t > kSameTick)
    result.keyframes.insert(result.keyframes.begin(), before);
  else
    result.keyframes.front().weights.merge(before.weights);
  return result;
}

CommandSeries with_closed_cycle(const CommandSeries& series, const GaitCycle& cycle) {
  CommandSeries result = series;
  const CommandSample& begin = series.samples[static_cast<size_t>(cycle.begin)];
  const CommandSample& end = series.samples[static_cast<size_t>(cycle.end)];
  const Isometry3d shift = middle_of(end) * middle_of(begin).inverse();
  const Vector3d place = shift * begin.state.base.position - end.state.base.position;
  const Eigen::Quaterniond turn = Eigen::Quaterniond(shift.linear()) * begin.state.base.attitude *
                                  end.state.base.attitude.conjugate();
  const Eigen::VectorXd joints = begin.state.theta - end.state.theta;
  const auto last = static_cast<long>(series.samples.size()) - 1;
  const auto rest_to_rest = [](double u) { return u * u * u * (10 - 15 * u + 6 * u * u); };
  for (long k = cycle.begin + 1; k <= last; ++k) {
    const double from = static_cast<double>(k - cycle.begin),
                 after = static_cast<double>(k - cycle.end);
    const double share = k <= cycle.end
                             ? rest_to_rest(from / static_cast<double>(cycle.end - cycle.begin))
                             : 1 - rest_to_rest(after / static_cast<double>(last - cycle.end));
    RobotState& state = result.samples[static_cast<size_t>(k)].state;
    state.base.position += share * place;
    state.base.attitude =
        (elementary::between(Eigen::Quaterniond::Identity(), turn, share) * state.base.attitude)
            .normalized();
    state.theta += share * joints;
  }
  return result;
}

}  // namespace ayumi
