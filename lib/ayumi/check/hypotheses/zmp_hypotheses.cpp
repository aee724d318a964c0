#include "ayumi/check/hypotheses/zmp_hypotheses.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "ayumi/base/text.hpp"

namespace ayumi::hypotheses {

namespace {

ZmpKey::Place place_under(Support single) {
  return single == Support::left ? ZmpKey::Place::left : ZmpKey::Place::right;
}

// Whether this key puts the ZMP under the foot on which the robot stands alone: at its place, or
// at a point on its sole.
bool is_under(const ExaminedPattern& of, const Keyframe& key, Support single) {
  if (key.zmp->place != ZmpKey::Place::point) return key.zmp->place == place_under(single);
  if (!of.feet) return false;
  const Side side = stance_of(single);
  Eigen::AlignedBox2d sole;
  for (const Eigen::Vector2d& corner : of.model.sole(side).polygon) sole.extend(corner);
  const Eigen::Isometry3d place = of.feet->pose(side, key.t);
  const Eigen::Vector3d zmp(key.zmp->point.x(), key.zmp->point.y(), place.translation().z());
  return sole.contains((place.inverse() * zmp).head<2>());
}

/// The keys that determine the ZMP while the robot stands on one foot, but that do not put it under
/// this foot. They are found among the keys within the phase, the last key at or before its
/// beginning, and the first key at or after its end.
std::vector<size_t> wrong_zmp_keys(const ExaminedPattern& of, size_t phase) {
  const double begin = of.begin_of(phase), until = of.pattern.phases[phase].until;
  std::vector<size_t> keys, wrong;
  std::optional<size_t> before, after;
  for (size_t k = 0; k < of.pattern.keyframes.size(); ++k) {
    const Keyframe& key = of.pattern.keyframes[k];
    if (!key.zmp) continue;
    if (key.t <= begin + 1e-9) before = k;
    if (key.t >= until - 1e-9 && !after) after = k;
    if (key.t > begin + 1e-9 && key.t < until - 1e-9) keys.push_back(k);
  }
  if (before) keys.insert(keys.begin(), *before);
  if (after) keys.push_back(*after);
  for (const size_t k : keys)
    if (!is_under(of, of.pattern.keyframes[k], of.pattern.phases[phase].support))
      wrong.push_back(k);
  return wrong;
}

std::string zmp_words(const ExaminedPattern& of, size_t key) {
  const ZmpKey::Place place = of.pattern.keyframes[key].zmp->place;
  return place == ZmpKey::Place::left     ? "under the left foot"
         : place == ZmpKey::Place::right  ? "under the right foot"
         : place == ZmpKey::Place::center ? "at \"center\""
                                          : "at a point";
}

// Whether the ZMP has a key between these times, or at one of them.
bool has_zmp_key(const ExaminedPattern& of, double begin, double end) {
  return std::any_of(
      of.pattern.keyframes.begin(), of.pattern.keyframes.end(),
      [&](const Keyframe& key) { return key.zmp && key.t >= begin - 1e-9 && key.t <= end + 1e-9; });
}

// In a single support without keys of the ZMP, the ZMP follows the keys of the neighbouring
// phases. Tries keys under the standing foot at both ends of the phase.
void missing_zmp_keys(const ExaminedPattern& of, size_t phase, size_t wrong,
                      std::vector<Hypothesis>& made) {
  const Support support = of.pattern.phases[phase].support;
  const double begin = of.begin_of(phase), until = of.pattern.phases[phase].until;
  const std::string foot = name_of(stance_of(support));
  made.push_back({Rank::exchange,
                  {of.phase_place(phase),
                   "the robot stands on the " + foot + " foot from " + seconds(begin) + " to " +
                       seconds(until) + ", but no keyframe puts the ZMP under this foot. " +
                       of.key_place(wrong) + " puts the ZMP " + zmp_words(of, wrong),
                   "with \"zmp\": \"" + foot + "\" in keyframes at these two times"},
                  [begin, until, place = place_under(support)](Pattern& p) {
                    for (const double t : {begin, until}) keyframe_at(p, t).zmp = ZmpKey{place};
                  }});
}

// Points of the ZMP whose y has the wrong sign. On robots that have to keep the ZMP near the edge
// of a sole, the middle of the sole is no remedy.
void mirrored_points(const ExaminedPattern& of, size_t phase, const std::vector<size_t>& wrong,
                     std::vector<Hypothesis>& made) {
  const Support support = of.pattern.phases[phase].support;
  std::vector<std::string> places;
  for (const size_t k : wrong) {
    Keyframe key = of.pattern.keyframes[k];
    if (key.zmp->place != ZmpKey::Place::point) return;
    key.zmp->point.y() *= -1;
    if (!is_under(of, key, support)) return;
    places.push_back(of.key_place(k));
  }
  const auto y_of = [&](size_t k) { return of.pattern.keyframes[k].zmp->point.y(); };
  const double y = y_of(wrong.front());
  const bool one_y =
      std::all_of(wrong.begin(), wrong.end(), [&](size_t k) { return y_of(k) == y; });
  const bool several = places.size() > 1;
  made.push_back(
      {Rank::exchange,
       {of.phase_place(phase),
        std::string("the robot stands on the ") + name_of(stance_of(support)) + " foot, but " +
            text::join(places, " and ") + (several ? " put" : " puts") +
            " the ZMP on the side of the other foot" +
            (one_y ? " (y is " + text::brief(y) + " m)" : ""),
        std::string("with the other sign of y") + (several ? " in these keyframes" : "") +
            (one_y ? " (" + text::brief(-y) + " m)" : "")},
       [wrong](Pattern& p) {
         for (const size_t k : wrong) p.keyframes[k].zmp->point.y() *= -1;
       }});
}

}  // namespace

// If keys put the ZMP elsewhere in several phases on one foot, tries all of them under the
// supporting foot.
void all_zmp_keys(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  std::map<size_t, ZmpKey::Place> meant;
  std::vector<size_t> phases;
  for (size_t i = 0; i < of.pattern.phases.size(); ++i) {
    if (!is_single(of.pattern.phases[i].support)) continue;
    const std::vector<size_t> wrong = wrong_zmp_keys(of, i);
    if (!wrong.empty()) phases.push_back(i);
    for (const size_t k : wrong) meant[k] = place_under(of.pattern.phases[i].support);
  }
  if (phases.size() < 2) return;
  const Phase& first = of.pattern.phases[phases.front()];
  made.push_back(
      {Rank::exchange,
       {of.phase_place(phases.front()),
        std::string("the robot stands on the ") + name_of(stance_of(first.support)) +
            " foot, but " + of.key_place(wrong_zmp_keys(of, phases.front()).front()) +
            " puts the ZMP " + zmp_words(of, wrong_zmp_keys(of, phases.front()).front()) +
            ". The ZMP is wrong in the same manner in " + std::to_string(phases.size()) + " phases",
        "with the ZMP under the foot that carries the robot in each of these phases"},
       [meant](Pattern& p) {
         for (const auto& [k, place] : meant) p.keyframes[k].zmp->place = place;
       }});
}

// If keys put the ZMP under the foot in the air in most phases on one foot, tries all keys of the
// ZMP with left and right exchanged.
void zmp_sides(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  size_t wrong = 0, single = 0;  // numbers of phases
  for (size_t i = 0; i < of.pattern.phases.size(); ++i) {
    const Phase& phase = of.pattern.phases[i];
    if (!is_single(phase.support)) continue;
    ++single;
    const std::vector<size_t> keys = wrong_zmp_keys(of, i);
    if (std::any_of(keys.begin(), keys.end(), [&](size_t k) {
          return of.pattern.keyframes[k].zmp->place == place_under(opposite(phase.support));
        }))
      ++wrong;
  }
  if (wrong < 2 || 2 * wrong <= single) return;
  made.push_back({Rank::exchange,
                  {"/keyframes",
                   "the keys put the ZMP under the foot that does not carry the robot. "
                   "Perhaps left and right were exchanged",
                   "with left and right exchanged in all ZMP keys"},
                  [](Pattern& p) {
                    for (Keyframe& key : p.keyframes) {
                      if (!key.zmp) continue;
                      if (key.zmp->place == ZmpKey::Place::left)
                        key.zmp->place = ZmpKey::Place::right;
                      else if (key.zmp->place == ZmpKey::Place::right)
                        key.zmp->place = ZmpKey::Place::left;
                    }
                  }});
}

void zmp_keys(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  for (size_t i = 0; i < of.pattern.phases.size(); ++i) {
    const Phase& phase = of.pattern.phases[i];
    if (!is_single(phase.support) || !of.reaches(i)) continue;
    const ZmpKey::Place meant = place_under(phase.support);
    const std::vector<size_t> wrong = wrong_zmp_keys(of, i);
    if (wrong.empty()) continue;
    std::vector<std::string> places;
    for (const size_t k : wrong) places.push_back(of.key_place(k));
    const std::string foot = name_of(stance_of(phase.support));
    const std::string at = zmp_words(of, wrong.front());
    mirrored_points(of, i, wrong, made);
    made.push_back(
        {Rank::exchange,
         {of.phase_place(i),
          "the robot stands on the " + foot + " foot, but " + text::join(places, " and ") +
              (places.size() > 1 ? " put" : " puts") + " the ZMP " + at,
          "with \"zmp\": \"" + foot +
              (places.size() > 1 ? "\" in these keyframes" : "\" in this keyframe")},
         [wrong, meant](Pattern& p) {
           for (const size_t k : wrong) p.keyframes[k].zmp->place = meant;
         }});
    if (!has_zmp_key(of, of.begin_of(i), phase.until)) missing_zmp_keys(of, i, wrong.front(), made);
  }
}

}  // namespace ayumi::hypotheses
