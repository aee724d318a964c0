// A motor is heated by the square of its torque. Within its thermal window T, the root mean square
// of the torque must not exceed the continuous torque of the actuator profile:
//   sqrt(1/T sum tau^2 dt) <= continuous torque,
// where a torque above the peak torque counts as the peak torque, because a motor cannot give more.
// A motion that is shorter than T may be followed by rest; in this case the finding is a warning.
#include <algorithm>

#include "ayumi/base/text.hpp"
#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

namespace {

// Largest share of the continuous torque. Definition: the data sheet states the largest value.
constexpr double kWholeContinuousTorque = 1;

// Number of samples of the window at which torques are evaluated at another pace. Chosen:
// attribution only needs to know whether the mean keeps its limit, and each sample costs one
// inverse dynamics. No measured case changes between half and twice the value (constants.md).
constexpr int kThermalLooks = 100;

int thermal_samples(const JudgedMotion& motion) {
  return static_cast<int>(std::lround(motion.limits.thermal_window / motion.series.dt));
}

// Judges the mean over the window that ends with this sample.
void judge_heat_at(JudgedMotion& motion, const JudgedSample& s) {
  const int whole = thermal_samples(motion);
  const int window = std::clamp(whole, 1, motion.count());
  const Severity severity = motion.count() >= whole ? Severity::error : Severity::warning;
  const double most = motion.tolerance(FindingKind::continuous_torque);
  // Sums for the samples before this one, for all samples including this one, and for those before
  // the window: they are columns of a ring.
  const int columns = window + 1, end = s.k + 1;
  Heat& heat = motion.heat;
  if (heat.square_sum.size() == 0) {
    heat.square_sum.setZero(motion.model.dof_count(), columns);
    heat.largest.assign(static_cast<size_t>(motion.model.dof_count()), {});
  }
  for (int i = 0; i < motion.model.dof_count(); ++i) {
    const double torque = s.known ? s.demand.torque[i] : 0;
    const double given = std::min(std::abs(torque), motion.limits.peak_torque[i]);
    const double sum = heat.square_sum(i, s.k % columns) + given * given;
    heat.square_sum(i, end % columns) = sum;
    const double limit = motion.limits.continuous_torque[i];
    if (!std::isfinite(limit) || end < window) continue;
    const double mean = (sum - heat.square_sum(i, (end - window) % columns)) / window;
    const double rms = std::sqrt(std::max(0.0, mean));
    Heat::Largest& largest = heat.largest[static_cast<size_t>(i)];
    if (rms / limit > largest.share) largest = {rms / limit, s.k};
    if (rms > most * limit)
      motion.add(FindingKind::continuous_torque, i, s.k, rms, most * limit, rms / limit, 0,
                 severity);
  }
}

// If two joints have the same value, the first joint is named.
void note_heat(JudgedMotion& motion) {
  for (size_t i = 0; i < motion.heat.largest.size(); ++i) {
    const auto& [share, sample] = motion.heat.largest[i];
    if (sample >= 0)
      motion.raise(FindingKind::continuous_torque, share, sample, static_cast<int>(i));
  }
}

bool heat_holds(JudgedMotion& motion, const Violation& v, double pace) {
  const int length = std::clamp(thermal_samples(motion), 1, v.sample + 1);
  double sum = 0;
  for (int n = 0; n < kThermalLooks; ++n) {
    const int k = v.sample - static_cast<int>(static_cast<long>(n) * length / kThermalLooks);
    const double torque = std::min(std::abs(motion.dynamics.at(k, pace).torque[v.item]),
                                   motion.limits.peak_torque[v.item]);
    sum += torque * torque;
  }
  return std::sqrt(sum / kThermalLooks) <= v.limit;
}

const char* heat_unit(const JudgedMotion& motion, const Violation& v) {
  return joint_unit(motion, v, "N m", "N");
}

Advice heat_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  const std::string unit = std::string(" ") + heat_unit(motion, v);
  const double window_length =
      motion.series.dt * std::clamp(thermal_samples(motion), 1, motion.count());
  return {
      motion.model.dofs()[v.item].name + " needs " + text::brief(v.value, 3) + unit +
          " on average (root mean square over " + text::brief(window_length, 3) +
          " s), but its motor can give only " + text::brief(v.limit, 3) + unit +
          " without a time limit",
      "add a rest, or shorten the lever arm of the weight" + straighter_leg(motion.model, v.item),
      ""};
}

std::string heat_infeasibility(const Finding& f, double violation) {
  return "the mean torque of " + f.where + " in the thermal window of its motor reaches " +
         ratio_text(violation) + " times the continuous limit";
}

}  // namespace

const Limit& heat_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::continuous_torque,
                    .limit_class = LimitClass::force,
                    .unit = "1",
                    .tolerance = kWholeContinuousTorque,
                    .meaning = "root mean square of the motor torque in the thermal window of the "
                               "motor, as a share of the continuous limit. The finding is only a "
                               "warning if the motion is shorter than the window",
                    .figure = {.key = "max_continuous_torque_ratio",
                               .label = "largest continuous torque",
                               .unit = "% of the limit",
                               .scale = 100,
                               .share_name = "continuous torque",
                               .line = 10},
                    .actuator = {.line = 2, .after = " on average"},
                    .repair = {.is_mean = true},
                    .finding_unit = heat_unit,
                    .place = joint_place,
                    .advice = heat_advice,
                    .infeasibility = heat_infeasibility,
                    .holds_at = heat_holds}},
      .judge_sample = judge_heat_at,
      .judge_motion = note_heat};
  return limit;
}

}  // namespace ayumi
