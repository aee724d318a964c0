#include "ayumi/render/log_reading.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {
namespace {

/// a towards b by `share`; vectors of different sizes (an empty one) stay a.
template <typename Vector>
Vector mix(const Vector& a, const Vector& b, double share) {
  if (a.size() != b.size()) return a;
  return a + share * (b - a);
}

BasePose mix(const BasePose& a, const BasePose& b, double share) {
  return {mix(a.position, b.position, share), a.attitude.slerp(share, b.attitude)};
}

/// Stretches of ticks in which just these feet (left, right) are planned on the ground.
std::vector<FlightRecord> stretches(const SimulationLog& log, const std::array<bool, 2>& feet) {
  std::vector<FlightRecord> result;
  bool before = false;
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const bool now = log.samples[k].planned_contact == feet;
    const double t = static_cast<double>(k) * log.dt;
    if (now && !before) result.push_back({t, t});
    if (now) result.back().end = t + log.dt;
    before = now;
  }
  return result;
}

/// Instants evenly spaced over a walk may meet every other step only: one on the same foot as the
/// instant before it moves to the middle of a step on the other foot within `reach` [s].
void alternate_feet(const SimulationLog& log, double reach, std::vector<double>& times) {
  for (size_t i = 1; i + 1 < times.size(); ++i) {
    const std::array<bool, 2> before = sample_at(log, times[i - 1]).planned_contact;
    if (before[0] == before[1] || sample_at(log, times[i]).planned_contact != before) continue;
    double nearest = times[i] + reach;
    for (const FlightRecord& step : stretches(log, {before[1], before[0]})) {
      const double middle = 0.5 * (step.begin + step.end);
      if (std::abs(middle - times[i]) < std::abs(nearest - times[i])) nearest = middle;
    }
    if (std::abs(nearest - times[i]) < reach) times[i] = nearest;
  }
}

}  // namespace

double duration(const SimulationLog& log) {
  if (log.samples.empty())
    fail(ErrorCode::usage, "the run's log has no samples: there is nothing to show");
  return log.dt * static_cast<double>(log.samples.size() - 1);
}

SimulationSample sample_at(const SimulationLog& log, double t) {
  const double position = std::clamp(t, 0.0, duration(log)) / log.dt;
  // A time within a millionth of a tick is that tick's.
  const double nearest = std::round(position);
  const double before = std::abs(position - nearest) < 1e-6 ? nearest : std::floor(position);
  const auto index = static_cast<size_t>(before);
  const double share = std::max(0.0, position - before);
  if (share < 1e-6 || index + 1 >= log.samples.size()) return log.samples[index];
  SimulationSample sample = log.samples[index];
  const SimulationSample& next = log.samples[index + 1];
  sample.state.base = mix(sample.state.base, next.state.base, share);
  sample.command_base = mix(sample.command_base, next.command_base, share);
  sample.reference_base = mix(sample.reference_base, next.reference_base, share);
  const auto blend = [&](auto& value, const auto& after) { value = mix(value, after, share); };
  blend(sample.state.theta, next.state.theta);
  blend(sample.reference_theta, next.reference_theta);
  blend(sample.command_theta, next.command_theta);
  blend(sample.cog, next.cog);
  blend(sample.zmp, next.zmp);
  blend(sample.command_cog, next.command_cog);
  blend(sample.command_zmp, next.command_zmp);
  blend(sample.reference_cog, next.reference_cog);
  blend(sample.reference_zmp, next.reference_zmp);
  sample.fz += share * (next.fz - sample.fz);
  for (size_t side = 0; side < 2; ++side) {
    blend(sample.foot_force[side], next.foot_force[side]);
    blend(sample.foot_cop[side], next.foot_cop[side]);
  }
  return sample;
}

Eigen::Isometry3d floor_at(const SimulationLog& log, double t) {
  return floor_pose(log.world, floor_motions(log.scenario), t);
}

Eigen::Isometry3d ground_at(const SimulationLog& log, double t) {
  return floor_at(log, t) * Eigen::Translation3d(0, 0, log.world.height);
}

bool floor_moves(const SimulationLog& log) {
  return !log.world.motions.empty() || !floor_motions(log.scenario).empty();
}

Eigen::Isometry3d marked_ground(const SimulationLog& log, double t,
                                const SimulationSample& sample) {
  constexpr double kLevel = 5e-4;  // [m] loaded soles sink in by less, steps are higher
  Eigen::Isometry3d ground = ground_at(log, t);
  double height = 0;
  for (size_t side = 0; side < 2; ++side)
    if (sample.foot_force[side].norm() > 0.02 * sample.fz && sample.fz > 0)
      height = std::max(height, (ground.inverse() * sample.foot_cop[side]).z());
  if (height > kLevel) ground.translate(Eigen::Vector3d(0, 0, height));
  return ground;
}

std::vector<PushRecord> pushes(const SimulationLog& log) {
  std::vector<PushRecord> records;
  bool active = false;
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const SimulationSample& sample = log.samples[k];
    if (sample.push_force.squaredNorm() == 0) {
      active = false;
      continue;
    }
    const double t = static_cast<double>(k) * log.dt;
    if (!active)
      records.push_back({.begin = t,
                         .end = t,
                         .point = sample.push_point,
                         .from_cog = sample.push_point - sample.cog});
    active = true;
    PushRecord& record = records.back();
    record.end = t + log.dt;
    record.impulse += sample.push_force * log.dt;
    if (sample.push_force.norm() > record.peak.norm()) record.peak = sample.push_force;
  }
  return records;
}

std::string push_text(const PushRecord& push) {
  return push.end - push.begin <= 0.2 + 1e-9 ? text::brief(push.impulse.norm(), 3) + " N s"
                                             : text::brief(push.peak.norm(), 3) + " N";
}

std::vector<FlightRecord> flights(const SimulationLog& log) {
  return stretches(log, {false, false});
}

double telling_instant(const SimulationLog& log) {
  const std::vector<PushRecord> pushed = pushes(log);
  const std::vector<FlightRecord> flown = flights(log);
  const double last = duration(log);
  if (!pushed.empty()) return std::min(last, pushed.front().begin + 0.25);
  if (log.result.outcome == Outcome::fell) return std::min(last, log.result.fell_at);
  return flown.empty() ? 0.5 * last : 0.5 * (flown.front().begin + flown.front().end);
}

std::vector<double> telling_instants(const SimulationLog& log, int count) {
  // The push before the flights and the landing after them [s].
  constexpr double kBefore = 0.25, kAfter = 0.35;
  // From a push to the end of what it causes, and after a fall [s].
  constexpr double kRecovery = 1.25;
  const std::vector<FlightRecord> flown = flights(log);
  const std::vector<PushRecord> pushed = pushes(log);
  double begin = 0, end = duration(log);
  if (flown.empty() && !pushed.empty()) {
    begin = std::max(begin, pushed.front().begin - kBefore);
    const double last = std::max(pushed.back().end, log.result.fell_at);
    end = std::min(end, last + kRecovery);
  } else if (!flown.empty()) {
    begin = std::max(begin, flown.front().begin - kBefore);
    end = std::min(end, flown.back().end + kAfter);
  }
  std::vector<double> times;
  for (int i = 0; i < count; ++i)
    times.push_back(begin + (end - begin) * i / std::max(1, count - 1));
  if (flown.empty() && pushed.empty())
    alternate_feet(log, 0.5 * (end - begin) / std::max(1, count - 1), times);
  const auto show = [&](const auto& records) {
    if (2 * static_cast<int>(records.size()) > count) return;
    for (const auto& record : records) {
      const double middle = 0.5 * (record.begin + record.end);
      *std::min_element(times.begin(), times.end(), [&](double a, double b) {
        return std::abs(a - middle) < std::abs(b - middle);
      }) = middle;
    }
  };
  if (flown.empty())
    show(pushed);
  else
    show(flown);
  return times;
}

}  // namespace ayumi
