// A push moves from rest below ref z_G to the speed and the free fall of lift-off, as one quintic
// (the landing is its mirror image in time). Its duration is the one with the smallest peak
// acceleration among those that neither pull on the ground nor stoop deeper than given.
#include <algorithm>
#include <cmath>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/quintic.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

namespace {

/// Fraction of the stoop by which the COG may sink before it rises in a push. Chosen: small
/// compared with the stoop.
constexpr double kSink = 0.02;
/// Time of standing at both ends, in units of 1/omega. Chosen: the same as kZmpRest of the walk.
constexpr double kStanding = 4.5;
/// Time of stooping, and of rising after the landing, in units of 1/omega. Chosen: slow enough for
/// a COG that rests over the feet.
constexpr double kStooping = 4.0;

// The lowest value and the smallest and largest acceleration of a segment.
struct Extremes {
  double low = 1e9, least = 1e9, most = -1e9;
};

Extremes extremes(const QuinticEnd& from, const QuinticEnd& to) {
  Extremes e;
  // Number of samples. Chosen: extremes between samples differ by less than 1e-4.
  constexpr int kSteps = 400;
  for (int i = 1; i < kSteps; ++i) {
    const TrackPoint p = quintic_at(from, to, from.t + (to.t - from.t) * i / kSteps);
    e.low = std::min(e.low, p.value);
    e.least = std::min(e.least, p.acceleration);
    e.most = std::max(e.most, p.acceleration);
  }
  return e;
}

QuinticEnd moving(double t, double value, double rate) { return {t, value, rate, -kGravity}; }

// Time from rest at -stoop to lift-off at 0 with `speed` [s]; 0 when there is none.
double push_time(double stoop, double speed) {
  double best = 0, least = 1e9;
  for (int i = 0; i <= 300; ++i) {
    const double time = (0.8 + 0.01 * i) * stoop / speed;
    const Extremes e = extremes({0, -stoop, 0, 0}, moving(time, 0, speed));
    if (e.low < -(1 + kSink) * stoop || e.least < -1.0001 * kGravity || e.most > least) continue;
    least = e.most;
    best = time;
  }
  return best;
}

// Time on the ground between two flights in which the COG sinks by `stoop` [s].
double bounce_time(double stoop, double speed) {
  double low = stoop / speed, high = 8 * stoop / speed;
  for (int i = 0; i < 60; ++i) {
    const double time = 0.5 * (low + high);
    const bool deep = extremes(moving(0, 0, -speed), moving(time, 0, speed)).low < -stoop;
    (deep ? high : low) = time;
  }
  return low;
}

void check_parameters(const RobotModel& model, const JumpParameters& p) {
  const double leg = leg_length(model);
  require_range("jump", "height", p.height, 0.001, 0.5 * leg, " m");
  require_range("jump", "stoop", p.stoop, 0.02 * leg, 0.5 * leg, " m");
  require_range("jump", "forward", p.forward, -0.3 * leg, 0.3 * leg, " m");
  require_range("jump", "times", p.times, 1, 100, "");
  require_cog_height("jump", p.cog_height, leg);
}

}  // namespace

JumpParameters jump_defaults(const RobotModel& model) {
  const double size = size_beside_hoap1(model);
  JumpParameters p;
  p.height = to_tenth_millimetre(p.height * size);
  p.stoop = to_tenth_millimetre(p.stoop * size);
  p.cog_height = to_tenth_millimetre(p.cog_height * size);
  return p;
}

Pattern jump_pattern(const RobotModel& model, const JumpParameters& p) {
  check_parameters(model, p);
  Pattern pattern;
  pattern.robot = model.name();
  pattern.name = "jump of " + text::brief(1e3 * p.height) + " mm";
  const double home = to_tenth_millimetre(default_cog_height(model, pattern));
  const double ref = to_tenth_millimetre(p.cog_height);
  const double omega = std::sqrt(kGravity / home);
  const double standing = 0.01 * std::round(100 * kStanding / omega);
  const double stooping = 0.01 * std::round(100 * kStooping / omega);
  const double flight = to_millisecond(std::sqrt(8 * p.height / kGravity));
  const double speed = 0.5 * kGravity * flight;
  const double push = to_millisecond(push_time(p.stoop, speed));
  if (push <= 0)
    fail(ErrorCode::usage, "jump: with a stoop of " + text::brief(p.stoop) +
                               " m, no push-off reaches a height of " + text::brief(p.height) +
                               " m. Choose another stoop or another height");
  const double bounce = to_millisecond(bounce_time(p.stoop, speed));
  const double low = to_tenth_millimetre(ref - p.stoop);

  PatternBuilder writer{pattern};
  auto feet = start_feet(model, pattern);
  const auto key = [&](double at, double height, bool with_feet) {
    Keyframe k;
    k.cog_height = height;
    for (size_t s = 0; with_feet && s < 2; ++s) {
      Foothold foot;
      for (int i = 0; i < 3; ++i) foot.position[i] = to_tenth_millimetre(feet[s].translation()[i]);
      k.feet[s] = foot;
    }
    writer.add(at, k);
  };
  const bool travels = p.forward != 0;
  key(standing, home, false);
  key(standing + stooping, low, false);
  writer.phase(standing + stooping + push, Support::both);
  for (int i = 0; i < p.times; ++i) {
    if (i > 0) writer.phase(bounce, Support::both);
    key(writer.t, ref, travels);
    writer.phase(flight, Support::none);
    for (auto& foot : feet) foot.translation().x() += p.forward;
    key(writer.t, ref, travels);
  }
  key(writer.t + push, low, false);
  key(writer.t + push + stooping, home, false);
  writer.phase(push + stooping + standing, Support::both);
  return pattern;
}

}  // namespace ayumi
