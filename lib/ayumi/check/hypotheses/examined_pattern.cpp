#include "ayumi/check/hypotheses/examined_pattern.hpp"

#include <cmath>
#include <numbers>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"
#include "ayumi/motion/pattern_context.hpp"

namespace ayumi {

namespace {

bool has_instant(const std::vector<double>& times, double t) {
  return hypotheses::has_beside(times, t,
                                [&](double other) { return std::abs(other - t) < kSameInstant; });
}

}  // namespace

ExaminedPattern::ExaminedPattern(const RobotModel& of_robot, const Pattern& examined,
                                 const TrialOutcome& outcome)
    : model(of_robot), pattern(examined), found(outcome), values(written_values(model, pattern)) {
  for (const Phase& phase : pattern.phases) ends.push_back(phase.until);
  for (const Keyframe& key : pattern.keyframes)
    if (hypotheses::is_of_contact(key)) contacts.push_back(key.t);
  std::sort(ends.begin(), ends.end());
  std::sort(contacts.begin(), contacts.end());
  try {
    feet.emplace(model, pattern);
  } catch (const Error&) {  // the phases themselves are wrong
  }
}

double ExaminedPattern::begin_of(size_t phase) const {
  return phase > 0 ? pattern.phases[phase - 1].until : 0.0;
}

std::string ExaminedPattern::phase_place(size_t i) const { return pointer_of_phase(pattern, i); }

std::string ExaminedPattern::key_place(size_t i) const { return pointer_of_keyframe(pattern, i); }

bool ExaminedPattern::reaches(size_t phase) const {
  const size_t last = std::min(phase + 4, pattern.phases.size() - 1);
  return found.touches(begin_of(phase), pattern.phases[last].until);
}

bool ExaminedPattern::reaches_key(size_t key) const {
  const auto& keys = pattern.keyframes;
  return found.touches(key > 0 ? keys[key - 1].t : 0,
                       key + 1 < keys.size() ? keys[key + 1].t : pattern.duration());
}

bool ExaminedPattern::is_repeated_key(size_t key) const {
  return is_repeated(pattern, pattern.keyframes[key].pointer);
}

bool ExaminedPattern::flies(double t) const {
  double from = 0;
  for (const Phase& phase : pattern.phases) {
    if (phase.support == Support::none && !phase.viip && t > from && t < phase.until) return true;
    from = phase.until;
  }
  return false;
}

bool ExaminedPattern::is_at_end(double t) const { return has_instant(ends, t); }

bool ExaminedPattern::has_key_of_contact(double t) const { return has_instant(contacts, t); }

std::string ExaminedPattern::angle(double radians) const {
  return pattern.degrees ? text::brief(radians * 180 / std::numbers::pi, 5) + " deg"
                         : text::brief(radians, 5) + " rad";
}

bool ExaminedPattern::has_place(size_t phase) const {
  return phase < pattern.phases.size() && pattern.phases[phase].swing &&
         !pattern.phases[phase].swing->step;
}

bool ExaminedPattern::has_cog_height() const {
  return std::any_of(pattern.keyframes.begin(), pattern.keyframes.end(),
                     [](const Keyframe& key) { return key.cog_height.has_value(); });
}

Support ExaminedPattern::support_at(double t) const {
  for (const Phase& phase : pattern.phases)
    if (t <= phase.until) return phase.support;
  return Support::both;
}

bool hypotheses::is_of_contact(const Keyframe& key) {
  return (key.zmp && key.zmp->place != ZmpKey::Place::center) || key.feet[0] || key.feet[1];
}

Keyframe& hypotheses::keyframe_at(Pattern& pattern, double t) {
  const auto after = std::find_if(pattern.keyframes.begin(), pattern.keyframes.end(),
                                  [&](const Keyframe& key) { return key.t > t - kSameInstant; });
  if (after != pattern.keyframes.end() && after->t < t + kSameInstant) return *after;
  Keyframe added;
  added.t = t;
  return *pattern.keyframes.insert(after, added);
}

double hypotheses::whole_degrees(double radians) {
  constexpr double degree = std::numbers::pi / 180;
  return std::round(radians / degree) * degree;
}

std::string hypotheses::seconds(double t) { return text::brief(t, 5) + " s"; }

bool hypotheses::is_single(Support support) {
  return support == Support::left || support == Support::right;
}

Side hypotheses::stance_of(Support support) {
  return support == Support::left ? Side::left : Side::right;
}

}  // namespace ayumi
