#include "ayumi/author/edit/gait_cycle.hpp"

#include <cmath>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
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
    fail(ErrorCode::bad_pattern, in_file(motion.pattern, "phases") + ": " +
                                     text::counted(swings.size(), "swing") +
                                     " are too few for a cycle of two steps in the middle; at "
                                     "least " +
                                     std::to_string(wanted + 3) + " are needed");
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

}  // namespace ayumi
