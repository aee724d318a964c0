// With t' = s t, the accelerations of the same path are multiplied by 1/s^2:
//   f_z' = m (z'' / s^2 + g) = m g + (f_z - m g) / s^2.
#include <algorithm>
#include <cmath>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/edit/round_time.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/quintic.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/motion/servo_feedforward.hpp"
#include "ayumi/plan/viip_phases.hpp"

namespace ayumi {

Pattern retimed(const RobotModel& model, const Pattern& pattern, double scale) {
  if (!(scale >= 0.01 && scale <= 100))
    fail(ErrorCode::usage, "a time scale of " + text::exact(scale) +
                               " is not possible. Give a scale from 0.01 to 100");
  refuse_viip_phases(pattern, "retimed");
  Pattern result = pattern;
  if (scale == 1) return result;
  const double weight = model.mass() * kGravity;
  for (Phase& phase : result.phases) phase.until = round_time(scale * phase.until);
  for (Keyframe& key : result.keyframes) {
    key.t = round_time(scale * key.t);
    if (key.fz) *key.fz = weight + (*key.fz - weight) / (scale * scale);
  }
  for (Disturbance& push : result.scenario) push.at = round_time(scale * push.at);
  for (auto& [begin, end] : result.repair.windows) {
    begin *= scale;
    end *= scale;
  }
  if (result.table) {
    *result.table =
        postures_of(model, model.limits(result.profile),
                    *result.table);  // the lead is a property of the robot, so it does not change
    result.table->dt *= scale;
    result.table->zmp.clear();
    result.table->fz.clear();
  }
  if (result.correction) {
    result.correction->begin *= scale;
    result.correction->spacing *= scale;
    for (SmoothWindow& window : result.correction->smooth)
      window = {scale * window.begin, scale * window.end, scale * window.spacing};
  }
  return result;
}

Pattern stretched(const RobotModel& model, const Pattern& pattern, double begin, double end,
                  double factor) {
  if (!(factor >= 0.01 && factor <= 100) || !(begin < end))
    fail(ErrorCode::usage,
         "the part from " + text::exact(begin) + " to " + text::exact(end) +
             " s cannot be stretched by the factor " + text::exact(factor) +
             ". The part must end after it begins, and the factor must be from 0.01 "
             "to 100");
  refuse_viip_phases(pattern, "stretched");
  if (pattern.table || pattern.correction)
    fail(ErrorCode::bad_pattern, {pattern.file},
         "a time window of a table or of a correction cannot be "
         "stretched. Stretch the whole motion");
  // Times closer than this are equal [s]. Chosen: above rounding.
  constexpr double kSame = 1e-9;
  const double weight = model.mass() * kGravity;
  const auto later = [&](double t) {
    return t <= begin ? t
           : t < end  ? round_time(begin + factor * (t - begin))
                      : round_time(t + (factor - 1) * (end - begin));
  };
  Pattern result = pattern;
  for (Phase& phase : result.phases) phase.until = later(phase.until);
  for (Keyframe& key : result.keyframes) {
    if (key.fz && key.t > begin - kSame && key.t < end + kSame)
      *key.fz = weight + (*key.fz - weight) / (factor * factor);
    key.t = later(key.t);
  }
  for (Disturbance& push : result.scenario) push.at = later(push.at);
  for (auto& window : result.repair.windows) window = {later(window.first), later(window.second)};
  return result;
}

namespace {

// Value, rate and acceleration of all coordinates of a sample: base, attitude as a quaternion,
// joints.
struct Coordinates {
  Eigen::VectorXd value, rate, acceleration;
};

Coordinates coordinates_of(const CommandSample& sample, const Eigen::Quaterniond& near) {
  const RobotState& state = sample.state;
  const Eigen::Index dof = state.theta.size();
  Eigen::Quaterniond q = state.base.attitude;
  if (q.dot(near) < 0) q.coeffs() *= -1;
  const auto pure = [](const Eigen::Vector3d& v) {
    return Eigen::Quaterniond(0, v.x(), v.y(), v.z());
  };
  // q' = w q / 2, with w in the world.
  const Eigen::Quaterniond turn = pure(state.base_angular_velocity) * q;
  const Eigen::Quaterniond turn_on = pure(state.base_angular_velocity) * turn;
  const Eigen::Quaterniond bend = pure(sample.acceleration.segment<3>(3)) * q;
  Coordinates c;
  c.value.resize(7 + dof);
  c.rate.resize(7 + dof);
  c.acceleration.resize(7 + dof);
  c.value << state.base.position, q.coeffs(), state.theta;
  c.rate << state.base_velocity, 0.5 * turn.coeffs(), state.dtheta;
  c.acceleration << sample.acceleration.head<3>(), 0.5 * bend.coeffs() + 0.25 * turn_on.coeffs(),
      sample.acceleration.tail(dof);
  return c;
}

// The state of a motion at any time: quintics between its samples.
RobotState state_at(const CommandSeries& series, double t) {
  const auto last = static_cast<double>(series.samples.size() - 1);
  const auto k = static_cast<size_t>(std::clamp(std::floor(t / series.dt), 0.0, last - 1));
  const CommandSample &from = series.samples[k], &to = series.samples[k + 1];
  const Eigen::Quaterniond& near = from.state.base.attitude;
  const Coordinates a = coordinates_of(from, near), b = coordinates_of(to, near);
  const double begin = static_cast<double>(k) * series.dt;
  Eigen::VectorXd value(a.value.size());
  for (Eigen::Index i = 0; i < value.size(); ++i)
    value[i] = quintic_at({begin, a.value[i], a.rate[i], a.acceleration[i]},
                          {begin + series.dt, b.value[i], b.rate[i], b.acceleration[i]}, t)
                   .value;
  RobotState state = from.state;
  state.base.position = value.head<3>();
  state.base.attitude.coeffs() = value.segment<4>(3);
  state.base.attitude.normalize();
  state.theta = value.tail(value.size() - 7);
  return state;
}

}  // namespace

double TimeCourse::time_of(double given) const {
  const auto after = std::lower_bound(at.begin(), at.end(), given);
  if (after == at.begin()) return 0;
  if (after == at.end()) return duration();
  const auto k = static_cast<double>(after - at.begin());
  const double before = *(after - 1);
  return dt * (k - 1 + (given - before) / (*after - before));
}

Pattern with_course(const RobotModel& model, const Pattern& pattern, const CommandSeries& series,
                    const TimeCourse& course, const std::string& table) {
  Pattern result = baked(model, pattern, series, table);
  DenseTable& dense = *result.table;
  dense.dt = course.dt;
  dense.cog.clear();
  dense.zmp.clear();
  dense.fz.clear();
  dense.base.clear();
  dense.theta.resize(static_cast<Eigen::Index>(course.at.size()), model.dof_count());
  for (size_t k = 0; k < course.at.size(); ++k) {
    const RobotState state = state_at(series, course.at[k]);
    if (!dense.base.empty() && state.base.attitude.dot(dense.base.back().attitude) < 0)
      dense.base.push_back(
          {state.base.position, Eigen::Quaterniond(-state.base.attitude.coeffs())});
    else
      dense.base.push_back(state.base);
    dense.theta.row(static_cast<Eigen::Index>(k)) = state.theta.transpose();
  }
  for (Phase& phase : result.phases) {
    phase.until = course.time_of(phase.until);
    phase.swing.reset();
  }
  if (!result.phases.empty()) result.phases.back().until = course.duration();
  std::erase_if(result.keyframes, [](const Keyframe& key) { return key.weights.empty(); });
  for (Keyframe& key : result.keyframes) {
    key.t = course.time_of(key.t);
    key.feet = {};
  }
  for (Disturbance& push : result.scenario) push.at = course.time_of(push.at);
  for (auto& [begin, end] : result.repair.windows) {
    begin = course.time_of(begin);
    end = course.time_of(end);
  }
  return result;
}

}  // namespace ayumi
