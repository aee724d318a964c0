#include "ayumi/motion/uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/math/statistics.hpp"

namespace ayumi {

double quantile(const Distribution& d, double u) {
  switch (d.kind) {
    case Distribution::Kind::uniform:
      return d.low + u * (d.high - d.low);
    case Distribution::Kind::normal:
      return d.mean + d.deviation * normal_quantile(u);
    case Distribution::Kind::truncated: {
      // Probabilities near 0 are exact and those near 1 are not, so a range above the mean is drawn
      // by its mirror image.
      const double side = d.low > d.mean ? -1 : 1;
      const double low = normal_probability(side * (d.low - d.mean) / d.deviation);
      const double high = normal_probability(side * (d.high - d.mean) / d.deviation);
      const double p = low + u * (high - low);
      if (!(p > 0 && p < 1)) return side * (p - 0.5) < 0 ? d.low : d.high;
      return std::clamp(d.mean + side * d.deviation * normal_quantile(p), d.low, d.high);
    }
    case Distribution::Kind::choice: {
      const auto weight = [&](size_t i) { return d.weights.empty() ? 1.0 : d.weights[i]; };
      double all = 0, sum = 0;
      for (size_t i = 0; i < d.values.size(); ++i) all += weight(i);
      for (size_t i = 0; i + 1 < d.values.size(); ++i)
        if ((sum += weight(i)) > u * all) return d.values[i];
      return d.values.back();
    }
  }
  return 0;
}

const std::vector<UncertainKindInfo>& uncertain_kinds() {
  using Kind = UncertainKind;
  using Target = UncertainKindInfo::Target;
  constexpr double none = -std::numeric_limits<double>::infinity();
  static const std::vector<UncertainKindInfo> kinds = {
      {Kind::mass, "mass", Target::link, false, false, 0, "factor on mass and inertia"},
      {Kind::cog, "cog", Target::link, true, false, none, "displacement of the centre of mass, m"},
      {Kind::inertia, "inertia", Target::link, false, false, 0, "factor on the inertia"},
      {Kind::friction, "friction", Target::none, false, false, 0,
       "friction coefficient of the ground"},
      {Kind::sole_stiffness, "sole_stiffness", Target::none, false, false, 0,
       "factor on the stiffness"},
      {Kind::sole_damping, "sole_damping", Target::none, false, false, 0, "factor on the damping"},
      {Kind::slope, "slope", Target::none, true, true, none, "angle of the ground, rad"},
      {Kind::bumps, "bumps", Target::none, false, false, 0,
       "depth of the hollows in the ground, m"},
      {Kind::servo_kp, "servo_kp", Target::joint, false, false, 0, "factor on the stiffness"},
      {Kind::servo_kd, "servo_kd", Target::joint, false, false, 0, "factor on the damping"},
      {Kind::servo_friction, "servo_friction", Target::joint, false, false, 0,
       "additional dry friction, N m"},
      {Kind::servo_delay, "servo_delay", Target::joint, false, false, 0, "delay of the servo, s"},
      {Kind::backlash, "backlash", Target::joint, false, true, 0, "whole play of the gear, rad"},
      {Kind::encoder_offset, "encoder_offset", Target::joint, false, true, none,
       "angle of the offset, rad"},
      {Kind::sensor_noise, "sensor_noise", Target::none, false, false, 0,
       "factor on the noise of all sensors"},
      {Kind::attitude_bias, "attitude_bias", Target::none, true, true, none,
       "angle of the bias, rad"},
      {Kind::gyro_bias, "gyro_bias", Target::none, true, true, none, "rate of the bias, rad/s"},
      {Kind::load_bias, "load_bias", Target::none, false, false, none,
       "offset of every load cell, N"},
      {Kind::sensor_latency, "sensor_latency", Target::none, false, false, 0,
       "latency of the sensors, s"},
      {Kind::payload, "payload", Target::link, false, false, 0, "mass of a load, kg"},
  };
  return kinds;
}

const UncertainKindInfo& info(UncertainKind kind) {
  using Target = UncertainKindInfo::Target;
  constexpr double none = -std::numeric_limits<double>::infinity();
  static const UncertainKindInfo push = {
      UncertainKind::push_size, "push", Target::none, false, false, none, "size of a push"};
  for (const UncertainKindInfo& each : uncertain_kinds())
    if (each.kind == kind) return each;
  return push;
}

bool is_assumed(const std::string& source) {
  return source.starts_with("assumed") || source.starts_with("Assumed");
}

}  // namespace ayumi
