#include "ayumi/plan/viip_phases.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/merge_keyframes.hpp"
#include "ayumi/motion/pattern_context.hpp"

namespace ayumi {

namespace {

/// COG speed below which the robot is at rest, in units of omega z. Chosen: the DCM is then within
/// 1.5 % of z of the COG, 3 mm for z = 0.22 m. No measured case changes between half and twice the
/// value (constants.md).
constexpr double kAtRest = 0.015;
/// Time that is sampled for a pattern with VIIP phases only [s]. Chosen: 100 ticks of 1 ms; the
/// posture is the same at all of them. No measured case changes between half and twice the value
/// (constants.md).
constexpr double kShortestSample = 0.1;

/// A VIIP phase: its number, its beginning and end, and the total duration of the VIIP phases
/// before it.
struct Cut {
  size_t phase;
  double begin, end, before;
};

std::vector<Cut> cuts_of(const Pattern& pattern) {
  std::vector<Cut> cuts;
  double begin = 0, before = 0;
  for (size_t i = 0; i < pattern.phases.size(); ++i) {
    const Phase& phase = pattern.phases[i];
    if (!(phase.until > begin))
      fail(ErrorCode::bad_pattern, place_of_phase(pattern, i),
           "the phase begins at " + text::exact(begin) + " s and ends at " +
               text::exact(phase.until) + " s; give a later \"until\"");
    if (phase.viip) {
      cuts.push_back({i, begin, phase.until, before});
      before += phase.until - begin;
    }
    begin = phase.until;
  }
  return cuts;
}

double time_without(const std::vector<Cut>& cuts, double t) {
  double cut = 0;
  for (const Cut& each : cuts) cut += std::clamp(t - each.begin, 0.0, each.end - each.begin);
  return t - cut;
}

/// A sample at rest in the posture of `from`.
CommandSample held(const RobotModel& model, const CommandSample& from) {
  CommandSample s = from;
  s.state.dtheta.setZero();
  s.state.base_velocity.setZero();
  s.state.base_angular_velocity.setZero();
  s.acceleration.setZero();
  s.dcog.setZero();
  s.ddcog.setZero();
  s.zmp.head<2>() = s.cog.head<2>();
  s.fz = model.mass() * kGravity;
  return s;
}

}  // namespace

bool has_viip_phases(const Pattern& pattern) {
  return std::any_of(pattern.phases.begin(), pattern.phases.end(),
                     [](const Phase& phase) { return phase.viip.has_value(); });
}

void refuse_viip_phases(const Pattern& pattern, const std::string& done) {
  for (size_t i = 0; i < pattern.phases.size(); ++i)
    if (pattern.phases[i].viip)
      fail(ErrorCode::bad_pattern, place_of_phase(pattern, i),
           "the controller decides the motion of a phase with a goal, so the pattern cannot "
           "be " +
               done + ". Simulate the pattern, and use the tables of the run");
}

Pattern without_viip_phases(const Pattern& pattern) {
  if (pattern.table)
    fail(ErrorCode::bad_pattern, in_file(pattern, "/table"),
         "a pattern cannot have both a table of a motion and phases with \"viip\". Remove the "
         "table or these phases");
  const std::vector<Cut> cuts = cuts_of(pattern);
  Pattern result = pattern;
  result.correction.reset();
  result.phases.clear();
  result.keyframes.clear();
  for (const Phase& phase : pattern.phases)
    if (!phase.viip) {
      result.phases.push_back(phase);
      result.phases.back().until = time_without(cuts, phase.until);
    }
  if (result.phases.empty()) result.phases.push_back({kShortestSample, Support::both, {}, {}});
  for (const Keyframe& key : pattern.keyframes) {
    for (const Cut& cut : cuts)
      if (key.t > cut.begin && key.t < cut.end)
        fail(ErrorCode::bad_pattern, key.place,
             "the key at " + text::exact(key.t) + " s lies inside the VIIP phase from " +
                 text::exact(cut.begin) + " to " + text::exact(cut.end) +
                 " s, but in such a phase goals replace keys. Move the key");
    Keyframe moved = key;
    moved.t = time_without(cuts, key.t);
    if (!result.keyframes.empty() && moved.t <= result.keyframes.back().t + 1e-9)
      merge(result.keyframes.back(), moved);
    else
      result.keyframes.push_back(moved);
  }
  return result;
}

CommandSeries with_viip_phases(const RobotModel& model, const Pattern& pattern,
                               const CommandSeries& cut) {
  const std::vector<Cut> cuts = cuts_of(pattern);
  const double dt = cut.dt;
  CommandSeries series = cut;
  series.samples.clear();
  const auto tick = [&](double t) { return std::lround(t / dt); };
  const long last = static_cast<long>(cut.samples.size()) - 1;
  long done = 0;  // number of samples of `cut` that are used
  for (const Cut& each : cuts) {
    const long at = std::min(last, tick(each.begin - each.before));
    for (; done < at; ++done) series.samples.push_back(cut.samples[static_cast<size_t>(done)]);
    const CommandSample& from = cut.samples[static_cast<size_t>(at)];
    const SourcePlace place = place_of_phase(pattern, each.phase);
    // At the last sample of a step, the support is still the support of the step.
    const CommandSample& rests = cut.samples[static_cast<size_t>(std::max(0l, at - 1))];
    if (from.support != Support::both && rests.support != Support::both)
      fail(ErrorCode::bad_pattern, place,
           "the phase begins on one foot. Put a phase with support \"both\" before this phase");
    const double z = from.cog.z() - from.zmp.z();
    const double limit = kAtRest * std::sqrt(kGravity * z);
    if (from.dcog.norm() > limit)
      fail(ErrorCode::bad_pattern, place,
           "the phase begins while the COG moves at " + text::fixed(from.dcog.norm(), 3) +
               " m/s (limit " + text::fixed(limit, 3) +
               " m/s). Let the motion before this phase come to rest");
    const ViipSpan span{static_cast<long>(series.samples.size()), tick(each.end),
                        *pattern.phases[each.phase].viip};
    CommandSample rest = held(model, from);
    rest.support = Support::both;
    series.samples.resize(static_cast<size_t>(span.end), rest);
    series.viip.push_back(span);
  }
  const bool all = cuts.back().phase + 1 == pattern.phases.size();
  if (all)
    series.samples.push_back(series.samples.back());
  else
    for (; done <= last; ++done) series.samples.push_back(cut.samples[static_cast<size_t>(done)]);
  series.origin["viip"] = std::to_string(cuts.size()) + (cuts.size() == 1 ? " phase" : " phases") +
                          " with VIIP goals. Only the simulation computes the motion of such a "
                          "phase; the check assumes that the robot keeps its posture";
  return series;
}

}  // namespace ayumi
