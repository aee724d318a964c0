#include "ayumi/check/hypotheses/unit_hypotheses.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/counted.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi::hypotheses {

namespace {

// If at least this many keyframes would fall on the ends of phases, this is no coincidence. Chosen:
// the keyframes of two steps.
constexpr long kManyKeys = 4;
// Two times are equal after one of them was multiplied by a factor if they differ by less than this
// share. Chosen: times are written in milliseconds, and a factor that is derived from such times
// has an error of this size.
constexpr double kSameStretchedTime = 0.005;
// Numbers of a target below this are taken for metres, whatever the other numbers are. Chosen: read
// in mm or cm, they would be less than half a millimetre or half a centimetre.
constexpr double kLeastWritten = 0.5;
// Units in which lengths are written by mistake, instead of metres.
constexpr std::array kSmallerUnits = {std::pair("mm", 1e-3), std::pair("cm", 1e-2)};

void scale_all(const ExaminedPattern& of, Pattern& pattern, Quantity quantity, double factor) {
  for (const WrittenValue& value : of.values)
    if (value.quantity == quantity) value.scale(pattern, factor);
}

constexpr const char* kGaze = "/gaze";

// A target that is farther from the origin of its frame than a leg is long, and whose numbers may
// be centimetres or millimetres.
struct FarTarget {
  size_t key = 0;
  std::string name;   // "the left hand"
  std::string place;  // JSON pointer
  bool gaze = false;
  Eigen::Vector3d position = {};
  std::function<Eigen::Vector3d&(Pattern&)> in;
};

std::vector<FarTarget> far_targets(const ExaminedPattern& of) {
  std::vector<FarTarget> far;
  const auto look = [&](size_t key, const std::string& name, const std::string& pointer,
                        const LinkTarget& target, const std::function<LinkTarget&(Pattern&)>& in) {
    if (!target.position || target.position->norm() < leg_length(of.model)) return;
    // A single number that is too large does not come from a wrong unit.
    for (const double length : *target.position)
      if (std::abs(length) > kNoLength && std::abs(length) < kLeastWritten) return;
    far.push_back({key, name, of.key_place(key) + pointer, pointer == kGaze, *target.position,
                   [in](Pattern& p) -> Eigen::Vector3d& { return *in(p).position; }});
  };
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i) {
    const Keyframe& key = of.pattern.keyframes[i];
    for (const auto& [name, target] : key.hands)
      look(i, name == "left" || name == "right" ? "the " + name + " hand" : name,
           "/hands/" + json_pointer_token(name), target,
           [i, name = name](Pattern& p) -> LinkTarget& { return p.keyframes[i].hands.at(name); });
    if (key.gaze)
      look(i, "the gaze", kGaze, *key.gaze,
           [i](Pattern& p) -> LinkTarget& { return *p.keyframes[i].gaze; });
  }
  return far;
}

std::string point(const Eigen::Vector3d& v) {
  return "(" + text::brief(v.x()) + ", " + text::brief(v.y()) + ", " + text::brief(v.z()) + ") m";
}

void target_unit(const FarTarget& target, std::vector<Hypothesis>& made) {
  for (const auto& [unit, factor] : kSmallerUnits)
    made.push_back(
        {Rank::slip,
         {target.place,
          target.name + " is aimed at " + point(target.position) + ". Lengths are in metres",
          std::string("with these numbers read in ") + unit + ", which gives " +
              point(factor * target.position) + ","},
         [in = target.in, factor = factor](Pattern& p) { in(p) *= factor; }});
}

// Tries another unit for a whole point of the ZMP.
void zmp_point(const ExaminedPattern& of, size_t key, std::vector<Hypothesis>& made) {
  const auto& zmp = of.pattern.keyframes[key].zmp;
  if (!zmp || zmp->place != ZmpKey::Place::point || zmp->point.norm() < leg_length(of.model) ||
      !of.reaches_key(key))
    return;
  for (const auto& [unit, factor] : kSmallerUnits) {
    const Eigen::Vector2d meant = zmp->point.head<2>() * factor;
    made.push_back({Rank::slip,
                    {of.key_place(key),
                     "the ZMP is at (" + text::brief(zmp->point.x()) + ", " +
                         text::brief(zmp->point.y()) + ") m. Lengths are in metres",
                     std::string("with these numbers read in ") + unit + ", which gives (" +
                         text::brief(meant.x()) + ", " + text::brief(meant.y()) + ") m,"},
                    [key, factor = factor](Pattern& p) { p.keyframes[key].zmp->point *= factor; }});
  }
}

}  // namespace

void angle_units(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  double most = 0;
  for (const WrittenValue& value : of.values)
    for (const WrittenNumber& number : value.numbers)
      if (value.quantity == Quantity::angle) most = std::max(most, std::abs(number.value));
  constexpr double degree = std::numbers::pi / 180;
  // If angles in degrees were declared as radians, the largest number is at least this. Chosen:
  // nobody writes a motion whose angles are all below 2 degrees, and 2 rad is a large angle.
  constexpr double kLeastDegrees = 2;
  const bool small = most <= 2 * std::numbers::pi * degree;
  if (of.pattern.degrees ? most == 0 || !small : most < kLeastDegrees) return;
  const std::string meant = of.pattern.degrees ? "rad" : "deg",
                    unit = of.pattern.degrees ? "deg" : "rad";
  made.push_back({Rank::unit,
                  {"/units",
                   "the angles are declared in " + unit + ", and the largest is " +
                       text::brief(of.pattern.degrees ? most / degree : most) + " " + unit,
                   "with \"units\": {\"angle\": \"" + meant + "\"}"},
                  [&of, factor = of.pattern.degrees ? 1 / degree : degree](Pattern& p) {
                    scale_all(of, p, Quantity::angle, factor);
                  }});
}

void scale_times(Pattern& pattern, double factor) {
  for (Phase& phase : pattern.phases) phase.until *= factor;
  for (Keyframe& key : pattern.keyframes) key.t *= factor;
}

void time_units(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  for (const auto& [unit, factor] :
       {std::pair("ms", 1e-3), std::pair("hundredths of a second", 1e-2)})
    if (of.pattern.duration() * factor > 0.1 && of.pattern.duration() > 30)
      made.push_back(
          {Rank::unit,
           {"/phases",
            "the motion lasts " + seconds(of.pattern.duration()) + ". Times are in seconds",
            std::string("with all times read as ") + unit},
           [factor = factor](Pattern& p) { scale_times(p, factor); }});
}

// Perhaps only the phases or only the keyframes were stretched in time: tries one factor for the
// times of all keyframes.
void stretched_keys(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  const auto& keys = of.pattern.keyframes;
  const auto fitting = [&](double factor) {
    return std::count_if(keys.begin(), keys.end(), [&](const Keyframe& key) {
      const double t = factor * key.t;
      return has_beside(of.ends, t,
                        [&](double end) { return std::abs(end - t) < kSameStretchedTime * end; });
    });
  };
  const long now = fitting(1);
  long most = now;
  double best = 1;
  for (const Keyframe& key : keys) {
    if (key.t <= 0) continue;
    const double factor = of.pattern.phases.front().until / key.t;
    if (const long fit = fitting(factor); fit > most) {
      most = fit;
      best = factor;
    }
  }
  if (most < kManyKeys || most <= 2 * now || 2 * most < static_cast<long>(keys.size())) return;
  made.push_back({Rank::unit,
                  {"/keyframes",
                   "the times of the keyframes do not fit the times of the phases. Only " +
                       std::to_string(now) + " of " + std::to_string(keys.size()) +
                       " keyframes are at the end of a phase",
                   "with the times of all keyframes multiplied by " + text::brief(best) +
                       " (then " + std::to_string(most) + " keyframes are at the end of a phase),"},
                  [best](Pattern& p) {
                    for (Keyframe& key : p.keyframes) key.t *= best;
                  }});
}

// Tries smaller units for all lengths if at least half of the lengths are larger than three leg
// lengths.
void length_units(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  const double leg = leg_length(of.model);
  int far = 0, all = 0;
  for (const WrittenValue& value : of.values) {
    if (value.quantity != Quantity::length || value.suspicion(of.model) == 0) continue;
    ++all;
    if (std::abs(value.numbers.front().value) > 3 * leg) ++far;
  }
  if (far < 2 || 2 * far < all) return;
  for (const auto& [unit, factor] : kSmallerUnits)
    made.push_back(
        {Rank::unit,
         {"/units", "lengths are in metres", std::string("with all lengths read as ") + unit},
         [&of, factor = factor](Pattern& p) { scale_all(of, p, Quantity::length, factor); }});
}

// Tries another unit for all targets of the hands and other links, or for all targets of the
// gaze.
void target_units(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  const std::vector<FarTarget> all = far_targets(of);
  for (const bool gaze : {false, true}) {
    std::vector<FarTarget> far = all;
    std::erase_if(far, [gaze](const FarTarget& target) { return target.gaze != gaze; });
    if (far.size() < 2) continue;
    for (const auto& [unit, factor] : kSmallerUnits)
      made.push_back(
          {Rank::unit,
           {far.front().place,
            far.front().name + " is aimed at " + point(far.front().position) + ", and there " +
                (far.size() > 2 ? "are " : "is ") + text::counted(far.size() - 1, "more target") +
                " at such a distance. Lengths are in metres",
            std::string("with these targets read in ") + unit},
           [far, factor = factor](Pattern& p) {
             for (const FarTarget& target : far) target.in(p) *= factor;
           }});
  }
}

// Tries another unit for a whole foothold or foot key.
void footholds(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  const auto add = [&](const std::string& place, Side side, const Foothold& foot,
                       const std::function<Foothold&(Pattern&)>& in) {
    // A single number that is too large does not come from a wrong unit.
    for (const double length : foot.position)
      if (std::abs(length) > kNoLength && std::abs(length) < leg_length(of.model)) return;
    if (foot.position.norm() < leg_length(of.model)) return;
    for (const auto& [unit, factor] : kSmallerUnits) {
      const Eigen::Vector3d meant = foot.position * factor;
      made.push_back({Rank::slip,
                      {place,
                       std::string("the ") + name_of(side) + " foot is at (" +
                           text::brief(foot.position.x()) + ", " + text::brief(foot.position.y()) +
                           ", " + text::brief(foot.position.z()) + ") m. Lengths are in metres",
                       std::string("with these numbers read in ") + unit + ", which gives (" +
                           text::brief(meant.x()) + ", " + text::brief(meant.y()) + ", " +
                           text::brief(meant.z()) + ") m,"},
                      [in, factor = factor](Pattern& p) { in(p).position *= factor; }});
    }
  };
  for (size_t i = 0; i < of.pattern.phases.size(); ++i) {
    const auto& swing = of.pattern.phases[i].swing;
    if (swing && !swing->step && of.reaches(i))
      add(of.phase_place(i), swing->foot, swing->to,
          [i](Pattern& p) -> Foothold& { return p.phases[i].swing->to; });
  }
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i)
    for (const size_t side : {size_t(0), size_t(1)})
      if (const auto& foot = of.pattern.keyframes[i].feet[side]; foot && of.reaches_key(i))
        add(of.key_place(i), static_cast<Side>(side), *foot,
            [i, side](Pattern& p) -> Foothold& { return *p.keyframes[i].feet[side]; });
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i) zmp_point(of, i, made);
  for (const FarTarget& target : far_targets(of))
    if (of.reaches_key(target.key)) target_unit(target, made);
}

}  // namespace ayumi::hypotheses
