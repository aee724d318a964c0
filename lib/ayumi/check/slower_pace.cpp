#include "ayumi/check/slower_pace.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector3d;

namespace {

constexpr double kSlowest = 0.05;  // pace down to which haste is looked for
constexpr double kStep = 0.97;     // from pace to pace: commands tell their own pace within 6 %
constexpr double kCoarseStep = 0.85;
constexpr int kStencil = 3;         // samples that one jump spoils by differences
constexpr int kFlightLooks = 5;     // at other samples of a flight
constexpr int kThermalLooks = 100;  // of the RMS torque at another pace

}  // namespace

bool SlowerPace::rms_holds(const Violation& v, double pace) {
  const int whole = static_cast<int>(std::lround(pass_.limits.thermal_window / pass_.series.dt));
  const int length = std::clamp(whole, 1, v.sample + 1);
  double sum = 0;
  for (int n = 0; n < kThermalLooks; ++n) {
    const int k = v.sample - static_cast<int>(static_cast<long>(n) * length / kThermalLooks);
    const double torque = std::min(std::abs(pass_.dynamics.at(k, pace).torque[v.item]),
                                   pass_.limits.peak_torque[v.item]);
    sum += torque * torque;
  }
  return std::sqrt(sum / kThermalLooks) <= v.limit;
}

// A flight has one pace at which it is free: all of it must be so, for the acceleration of a single
// sample can be scaled to that of gravity whatever made it.
bool SlowerPace::flight_is_free(int sample, double pace, double limit) {
  const auto flies = [&](int k) {
    return k >= 0 && k < pass_.count() && pass_.series.samples[k].support == Support::none &&
           !pass_.at_flight_edge(k);
  };
  int first = sample, last = sample;
  while (flies(first - 1)) --first;
  while (flies(last + 1)) ++last;
  for (int n = 0; n <= kFlightLooks; ++n) {
    const int k = n == kFlightLooks ? sample : first + n * (last - first) / (kFlightLooks - 1);
    const Vector3d ddcog = pass_.dynamics.at(k, pace).ddcog;
    if ((ddcog + Vector3d(0, 0, kGravity)).norm() > limit) return false;
  }
  return true;
}

// What is asked of the ground, and what commands say of it.
bool SlowerPace::ground_holds(const Violation& v, double pace) {
  const SampleDynamics& now = pass_.dynamics.at(v.sample, pace);
  const CommandSample& s = pass_.series.samples[v.sample];
  const double limit = std::abs(v.limit);
  switch (v.kind) {
    case FindingKind::zmp_residual:
      return now.use.has_zmp && (now.use.zmp_world - s.zmp).norm() <= limit;
    case FindingKind::fz_residual:
      return std::abs(now.wrench[2] - s.fz) <= limit;
    case FindingKind::support_margin:
      return now.use.has_zmp && now.use.margin >= -kRounding;
    case FindingKind::unilateral:
      return now.use.normal_force >= 0;
    case FindingKind::friction:
      return now.use.tangential_force <= limit * pass_.friction * now.use.normal_force;
    case FindingKind::yaw_moment:
      return std::abs(now.use.yaw_moment) <=
             limit * pass_.friction * now.use.normal_force *
                 torsional_friction_arm(pass_.dynamics.plane().polygon, now.use.zmp);
    case FindingKind::ballistic:
      return flight_is_free(v.sample, pace, limit);
    case FindingKind::angular_momentum:
      return now.moment.norm() <= limit &&
             flight_is_free(v.sample, pace, pass_.tolerance(FindingKind::ballistic));
    default:
      return false;
  }
}

// Whether the worst sample of a finding is sound when the path is played at this pace.
bool SlowerPace::holds(const Violation& v, double pace) {
  switch (v.kind) {
    case FindingKind::joint_speed:
    case FindingKind::servo_step:
      return std::abs(v.value) * pace <= std::abs(v.limit);
    case FindingKind::joint_torque:
      return std::abs(pass_.dynamics.at(v.sample, pace).torque[v.item]) <= std::abs(v.limit);
    case FindingKind::continuous_torque:
      return rms_holds(v, pace);
    default:
      return ground_holds(v, pace);
  }
}

bool SlowerPace::rough_near(int sample) const {
  for (int k = std::max(0, sample - kStencil); k <= std::min(pass_.count() - 1, sample + kStencil);
       ++k)
    if (pass_.rough[k]) return true;
  return false;
}

bool SlowerPace::mends(const Violation& cause, const Violation& v) {
  const bool flies = v.kind == FindingKind::ballistic || v.kind == FindingKind::angular_momentum;
  if (!flies && rough_near(v.sample)) return v.kind != FindingKind::servo_step;
  const double step = v.kind == FindingKind::continuous_torque ? kCoarseStep : kStep;
  for (double pace = step; pace > kSlowest; pace *= step)
    if (holds(cause, pace) && holds(v, pace)) return true;
  return false;
}

}  // namespace ayumi
