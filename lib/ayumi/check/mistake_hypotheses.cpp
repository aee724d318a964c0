#include "ayumi/check/mistake_hypotheses.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <tuple>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/number_slips.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/block_hypotheses.hpp"
#include "ayumi/check/raised_feet.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/quintic.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/folded_legs.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

namespace {

// Share of a swing that becomes the missing double support. Chosen: the share of the generated
// walks.
constexpr double kDoubleSupport = 0.2;
// A phase is as long as it was meant to be if its duration differs by less than this share from the
// duration of similar phases. Chosen: generated walks differ by 1 %.
constexpr double kUsualShare = 0.2;
// No phase of a robot is shorter [s]. Chosen: ten times less than the shortest steps of small
// robots. A time in seconds that is read in ms is below half of this bound, and steps are above
// twice this bound.
constexpr double kShortestPhase = 0.02;
// If at least this many keyframes would fall on the ends of phases, this is no coincidence. Chosen:
// the keyframes of two steps.
constexpr long kManyKeys = 4;
// Two times are equal after one of them was multiplied by a factor if they differ by less than this
// share. Chosen: times are written in milliseconds, and a factor that is derived from such times
// has an error of this size.
constexpr double kSameStretchedTime = 0.005;
// Two times that differ by less than this are the same instant [s]. Chosen: times are written in
// milliseconds, and each of the two is rounded.
constexpr double kSameInstant = 0.002;
// A length below this counts as zero [m]. Definition: rounding errors are smaller.
constexpr double kNoLength = 1e-4;
// Numbers of a target below this are taken for metres, whatever the other numbers are. Chosen: read
// in mm or cm, they would be less than half a millimetre or half a centimetre.
constexpr double kLeastWritten = 0.5;
// Units in which lengths are written by mistake, instead of metres.
constexpr std::array kSmallerUnits = {std::pair("mm", 1e-3), std::pair("cm", 1e-2)};
// An angle below this counts as zero [rad]. Definition: rounding errors are smaller.
constexpr double kNoAngle = 1e-6;
// A level foot below a leg that leans by less than this is not named as a reason [rad]. Chosen:
// five degrees, which every ankle can bend.
constexpr double kNotedLean = 0.09;
// Number of further keys of a foot that are named with their turn, and of keys of a swing that are
// named with their place. Chosen: a kick has two or three keys in the air.
constexpr size_t kTurnedKeys = 3, kPlacedKeys = 3;
// Shares of the way of a foot in the air that are tried, for all its keys of one swing together.
// Chosen: with less than half, much of the motion is lost, and another change is probably better;
// below a quarter, little of the motion is left.
constexpr std::array kMildShares = {0.85, 0.7, 0.55}, kSmallShares = {0.55, 0.4, 0.25};
// Number of feet above the ground or in it that are tried one by one. Chosen: a wrong height of one
// step also raises the steps after it, and its own change mends them all.
constexpr size_t kRaisedAlone = 4;
// Below this, the turn of a foot against the other one is ignored [rad]. Chosen: ten degrees.
constexpr double kNotedTurn = 0.17;
// A COG that is farther than this from the middle of the feet is not above them; the bound is a
// share of the length of a leg. Chosen: more than half of a sole.
constexpr double kNotedOffset = 0.25;
// Largest lean of a leg with which a foot is turned [rad]. Chosen: beyond it, a foot that is pulled
// up to its hip would be turned upside down.
constexpr double kMostLean = 1.1;
// A segment that lasts less than this share of its neighbour is considered too short before any
// value is considered wrong by a power of ten. Chosen: keys of one motion are seldom so unequal.
constexpr double kShortSegment = 0.15;
// The COG may sink below its lowest key before a lift-off or after a landing. If it sinks by less
// than this share of the stoop, the motion counts as what the keys show. Chosen: 3 mm for a stoop
// of 30 mm.
constexpr double kNotedSink = 0.1;
// Number of points of a segment at which its lowest value is searched. Chosen: between two points,
// the value is lower by less than 1e-3 of the stoop.
constexpr int kSinkPoints = 100;
// A COG is only tried lower at the ends of a flight if a leg is longer there than this share of its
// straight length. Chosen: at 0.85, the knee is bent by 64 deg and turns by 0.9 deg for each
// millimetre of a leg of 0.25 m; at 0.95, it turns by 1.5 deg.
constexpr double kStraightTakeOff = 0.85;
// Shares of the length of a leg by which the COG is tried lower at the ends of a flight. Chosen:
// 5 to 20 mm for a leg of 0.25 m.
constexpr std::array kLowerTakeOffs = {0.02, 0.04, 0.06, 0.08};
// A motion begins and ends at rest, with the COG above the ZMP. If the ZMP moves less than this
// time after the beginning or before the end, the COG has too little time for it. The time
// constant of the COG is sqrt(z/g), which is 0.16 s for HOAP-1. Derived: what is left of a movement
// after four time constants is 2 %.
constexpr double kShortRest = 4;
// Times of rest that are tried, in time constants of the COG. Chosen: up to the time in which the
// COG comes to rest, and half as much again.
constexpr std::array kRests = {2.0, 3.0, 4.0, 6.0};
// The planner moves ZMP keys near an end that has no rest. The motion also changes this long before
// or after the movement of the ZMP, in time constants of the COG. Derived: e^-2 is 14 %.
constexpr double kRestReach = 2;
// Number of steps of a second in which rests are named. Chosen: an author writes tenths of a
// second.
constexpr double kRestsPerSecond = 10;
// Sort value (Hypothesis::change) of a change that puts a keyframe at the end of a phase.
// Definition: below -2, the smallest value of other changes of times, so that it comes first.
constexpr double kCoincidence = -3;
// Number of bisection steps in the search for a time. Chosen: an interval of a second becomes a
// microsecond, and times are written in milliseconds.
constexpr int kHalvings = 20;

std::string seconds(double t) { return text::brief(t, 5) + " s"; }

bool is_single(Support support) { return support == Support::left || support == Support::right; }

// Whether `same` holds for one of the two neighbours of `t` in a sorted list of times.
template <class Same>
bool has_beside(const std::vector<double>& times, double t, const Same& same) {
  const auto after = std::lower_bound(times.begin(), times.end(), t);
  return (after != times.end() && same(*after)) ||
         (after != times.begin() && same(*std::prev(after)));
}

bool has_instant(const std::vector<double>& times, double t) {
  return has_beside(times, t, [&](double other) { return std::abs(other - t) < kSameInstant; });
}

Side stance_of(Support support) { return support == Support::left ? Side::left : Side::right; }

}  // namespace

bool is_repeated(const Pattern& pattern, const std::string& place) {
  const auto rounds = [&](const auto& items) {
    return std::count_if(items.begin(), items.end(),
                         [&](const auto& item) { return item.pointer == place; });
  };
  return !place.empty() && (rounds(pattern.phases) > 1 || rounds(pattern.keyframes) > 1);
}

class Hypotheses::Maker {
 public:
  Maker(const RobotModel& model, const Pattern& pattern, const TrialOutcome& found)
      : model_(model), pattern_(pattern), found_(found), values_(written_values(model, pattern)) {
    for (const Phase& phase : pattern.phases) ends_.push_back(phase.until);
    for (const Keyframe& key : pattern.keyframes)
      if (is_of_contact(key)) contacts_.push_back(key.t);
    std::sort(ends_.begin(), ends_.end());
    std::sort(contacts_.begin(), contacts_.end());
    try {
      feet_.emplace(model, pattern);
    } catch (const Error&) {  // the phases themselves are wrong
    }
  }

  const std::vector<WrittenValue>& values() const { return values_; }

  std::vector<Hypothesis> units() const {
    std::vector<Hypothesis> made;
    angle_units(made);
    time_units(made);
    stretched_keys(made);
    length_units(made);
    target_units(made);
    return made;
  }

  std::vector<Hypothesis> times() const {
    std::vector<Hypothesis> made = block_hypotheses(pattern_);
    ground_heights(made);
    turns(made);
    level_feet(made);
    stoops(made);
    all_sides(made);
    crossed_footholds(made);
    key_times(made);
    phase_times(made);
    return made;
  }

  std::vector<Hypothesis> irregular() const {
    std::vector<Hypothesis> made = block_hypotheses(pattern_);
    ground_heights(made);
    phase_times(made);
    foothold_exchanges(made);
    zmp_sides(made);
    zmp_keys(made);
    all_zmp_keys(made);
    turns(made);
    swings(made);
    double_supports(made);
    leg_keys(made);
    unlike_sides(made);
    interpolations(made);
    rests(made);
    level_feet(made);
    stoops(made);
    return made;
  }

  std::vector<Hypothesis> exchanges() const {
    std::vector<Hypothesis> made;
    footholds(made);
    swapped_axes(made);
    zmp_sides(made);
    zmp_keys(made);
    all_zmp_keys(made);
    phase_sides(made);
    starts(made);
    key_sides(made);
    unlike_sides(made);
    return made;
  }

  std::vector<Hypothesis> missing() const {
    std::vector<Hypothesis> made;
    swings(made);
    double_supports(made);
    leg_keys(made);
    interpolations(made);
    level_cog(made);
    held_cog(made);
    rests(made);
    return made;
  }

  std::vector<Hypothesis> nearer() const {
    std::vector<Hypothesis> made;
    near_footholds(made);
    lesser_turns(made);
    // Where a motion cannot be sampled, another change may keep more of it.
    if (found_.errors != kUnsampled) smaller_swings(made, kMildShares);
    return made;
  }

  std::vector<Hypothesis> small_swings() const {
    std::vector<Hypothesis> made;
    if (found_.errors == kUnsampled) smaller_swings(made, kMildShares);
    smaller_swings(made, kSmallShares);
    return made;
  }

  std::vector<Hypothesis> paces() const {
    std::vector<Hypothesis> made;
    cog_height(made);
    superfluous_keys(made);
    if (pattern_.table || pattern_.correction) return made;
    lower_take_offs(made);
    shorter_flights(made);
    // For slight errors, shorter times are also tried, because the COG sways less if the steps are
    // quicker.
    const std::vector<double> usual = {1.25, 1.6, 2.0, 3.0, 5.0},
                              slight = {1.03, 0.9, 1.1, 0.8, 1.25};
    for (const double factor : found_.slight ? slight : usual)
      made.push_back({Rank::pace,
                      {"/phases", "the motion takes " + seconds(pattern_.duration()),
                       "with all times multiplied by " + text::brief(factor)},
                      [this, factor](Pattern& p) { p = retimed(model_, p, factor); }});
    return made;
  }

 private:
  double begin_of(size_t phase) const { return phase > 0 ? pattern_.phases[phase - 1].until : 0.0; }
  std::string phase_place(size_t i) const { return pointer_of_phase(pattern_, i); }
  std::string key_place(size_t i) const { return pointer_of_keyframe(pattern_, i); }
  /// Whether this phase may cause an error: there is an error between the beginning of the phase
  /// and the end of the fourth phase after it.
  bool reaches(size_t phase) const {
    const size_t last = std::min(phase + 4, pattern_.phases.size() - 1);
    return found_.touches(begin_of(phase), pattern_.phases[last].until);
  }
  bool reaches_key(size_t key) const {
    const auto& keys = pattern_.keyframes;
    return found_.touches(key > 0 ? keys[key - 1].t : 0,
                          key + 1 < keys.size() ? keys[key + 1].t : pattern_.duration());
  }

  void scale_all(Pattern& pattern, Quantity quantity, double factor) const {
    for (const WrittenValue& value : values_)
      if (value.quantity == quantity) value.scale(pattern, factor);
  }

  void angle_units(std::vector<Hypothesis>& made) const {
    double most = 0;
    for (const WrittenValue& value : values_)
      for (const WrittenNumber& number : value.numbers)
        if (value.quantity == Quantity::angle) most = std::max(most, std::abs(number.value));
    constexpr double degree = std::numbers::pi / 180;
    const bool small = most <= 2 * std::numbers::pi * degree;
    if (most == 0 || (pattern_.degrees && !small)) return;
    const std::string meant = pattern_.degrees ? "rad" : "deg",
                      unit = pattern_.degrees ? "deg" : "rad";
    made.push_back({Rank::unit,
                    {"/units",
                     "the angles are declared in " + unit + ", and the largest is " +
                         text::brief(pattern_.degrees ? most / degree : most) + " " + unit,
                     "with \"units\": {\"angle\": \"" + meant + "\"}"},
                    [this, factor = pattern_.degrees ? 1 / degree : degree](Pattern& p) {
                      scale_all(p, Quantity::angle, factor);
                    }});
  }

  void time_units(std::vector<Hypothesis>& made) const {
    for (const auto& [unit, factor] :
         {std::pair("ms", 1e-3), std::pair("hundredths of a second", 1e-2)})
      if (pattern_.duration() * factor > 0.1 && pattern_.duration() > 30)
        made.push_back({Rank::unit,
                        {"/phases", "the motion lasts " + seconds(pattern_.duration()),
                         std::string("times are in seconds; with all times read as ") + unit},
                        [factor = factor](Pattern& p) {
                          for (Phase& phase : p.phases) phase.until *= factor;
                          for (Keyframe& key : p.keyframes) key.t *= factor;
                        }});
  }

  // Perhaps only the phases or only the keyframes were stretched in time: tries one factor for the
  // times of all keyframes.
  void stretched_keys(std::vector<Hypothesis>& made) const {
    const auto& keys = pattern_.keyframes;
    const auto fitting = [&](double factor) {
      return std::count_if(keys.begin(), keys.end(), [&](const Keyframe& key) {
        const double t = factor * key.t;
        return has_beside(ends_, t,
                          [&](double end) { return std::abs(end - t) < kSameStretchedTime * end; });
      });
    };
    const long now = fitting(1);
    long most = now;
    double best = 1;
    for (const Keyframe& key : keys) {
      if (key.t <= 0) continue;
      const double factor = pattern_.phases.front().until / key.t;
      if (const long fit = fitting(factor); fit > most) {
        most = fit;
        best = factor;
      }
    }
    if (most < kManyKeys || most <= 2 * now || 2 * most < static_cast<long>(keys.size())) return;
    made.push_back(
        {Rank::unit,
         {"/keyframes",
          "the times of the keyframes do not fit those of the phases: " + std::to_string(now) +
              " of " + std::to_string(keys.size()) + " keyframes are at the end of a phase",
          "with the times of all keyframes multiplied by " + text::brief(best) + " (then " +
              std::to_string(most) + " keyframes are at the end of a phase)"},
         [best](Pattern& p) {
           for (Keyframe& key : p.keyframes) key.t *= best;
         }});
  }

  // Tries smaller units for all lengths if at least half of the lengths are larger than three leg
  // lengths.
  void length_units(std::vector<Hypothesis>& made) const {
    const double leg = leg_length(model_);
    int far = 0, all = 0;
    for (const WrittenValue& value : values_) {
      if (value.quantity != Quantity::length || value.suspicion(model_) == 0) continue;
      ++all;
      if (std::abs(value.numbers.front().value) > 3 * leg) ++far;
    }
    if (far < 2 || 2 * far < all) return;
    for (const auto& [unit, factor] : kSmallerUnits)
      made.push_back(
          {Rank::unit,
           {"/units", "lengths are in metres", std::string("with all lengths read as ") + unit},
           [this, factor = factor](Pattern& p) { scale_all(p, Quantity::length, factor); }});
  }

  // ---- times

  // A key of a block that repeats has no time of its own in the file.
  bool is_repeated_key(size_t key) const {
    return is_repeated(pattern_, pattern_.keyframes[key].pointer);
  }

  // Whether a time is within a flight; the ends of a flight do not belong to it.
  bool flies(double t) const {
    double from = 0;
    for (const Phase& phase : pattern_.phases) {
      if (phase.support == Support::none && !phase.viip && t > from && t < phase.until) return true;
      from = phase.until;
    }
    return false;
  }

  // Whether a phase ends at this time.
  bool is_at_end(double t) const { return has_instant(ends_, t); }

  // Whether a key states the place of a foot, or a place of the ZMP other than "center".
  static bool is_of_contact(const Keyframe& key) {
    return (key.zmp && key.zmp->place != ZmpKey::Place::center) || key.feet[0] || key.feet[1];
  }

  bool has_key_of_contact(double t) const { return has_instant(contacts_, t); }

  // Number of such keys after the beginning of this phase that are at the end of a phase if this
  // end and all later ones are `later`. Both lists are sorted, so one pass through them is enough:
  // a long walk has thousands of phases and keys.
  long keys_at_ends(size_t phase, double later) const {
    long keys = 0;
    const double begin = begin_of(phase) + kSameInstant;
    size_t end = phase;
    for (auto key = std::lower_bound(contacts_.begin(), contacts_.end(), begin);
         key != contacts_.end(); ++key) {
      while (end < ends_.size() && ends_[end] + later <= *key - kSameInstant) ++end;
      if (end == ends_.size()) break;
      if (ends_[end] + later < *key + kSameInstant) ++keys;
    }
    return keys;
  }

  // A key of the ZMP or of a foot at the end of a phase belongs to the change of the support.
  bool belongs_to_phase(const Keyframe& key) const {
    return (key.zmp || key.feet[0] || key.feet[1]) && is_at_end(key.t);
  }

  void key_times(std::vector<Hypothesis>& made) const {
    const auto& keys = pattern_.keyframes;
    repeated_segments(made);
    for (size_t i = 0; i < keys.size(); ++i) {
      if (!reaches_key(i) || is_repeated_key(i)) continue;
      const double before = i > 0 ? keys[i - 1].t : 0;
      const double after = i + 1 < keys.size() ? keys[i + 1].t : pattern_.duration();
      const auto add = [&](Rank rank, double t, const std::string& why, double change = 0) {
        if (t <= before || t >= after || t == keys[i].t) return;
        // In a flight the COG follows its parabola: a key of the COG there would be the next error.
        if ((keys[i].cog_x || keys[i].cog_y || keys[i].cog_height) && flies(t)) return;
        made.push_back(
            {rank,
             {key_place(i), "t is " + seconds(keys[i].t) + why, "with t = " + seconds(t)},
             [i, t](Pattern& p) { p.keyframes[i].t = t; },
             change});
      };
      const double in = keys[i].t - before, out = after - keys[i].t;
      const bool too_early = in < kShortSegment * out;
      // The intended time must not leave a shorter segment than the written time.
      for (const double t : number_slips(keys[i].t))
        if (std::min(t - before, after - t) >= std::min(in, out))
          add(Rank::slip, t, "", too_early ? -2 : 0);
      if (is_of_contact(keys[i]) && !is_at_end(keys[i].t))
        for (auto end = std::upper_bound(ends_.begin(), ends_.end(), before);
             end != ends_.end() && *end < after; ++end)
          if (!has_key_of_contact(*end))
            add(Rank::slip, *end,
                ", but no phase ends at this time; a phase ends at " + seconds(*end) +
                    ", but no keyframe moves the ZMP or a foot at that time",
                kCoincidence);
      if (i == 0 || (!too_early && belongs_to_phase(keys[i]))) continue;
      const std::string lasts = ", so the segment before it lasts " + seconds(in) +
                                " and the segment after it lasts " + seconds(out);
      // The key is moved into the longer one of its two neighbouring segments, and also into the
      // shorter one.
      for (const double share : {0.35, 0.6, 0.8}) {
        const double t = in < out ? keys[i].t + share * out : keys[i].t - share * in;
        if (too_early)
          add(Rank::slip, std::round(1000 * t) / 1000, lasts, -1);
        else
          add(Rank::amount, std::round(1000 * t) / 1000, lasts);
        const double back = in < out ? keys[i].t - share * in : keys[i].t + share * out;
        add(Rank::amount, std::round(1000 * back) / 1000, lasts);
      }
    }
  }

  // The time since the previous key, which is the same in all rounds of a block, may be wrong by a
  // digit. All later keys move with it.
  void repeated_segments(std::vector<Hypothesis>& made) const {
    const auto& keys = pattern_.keyframes;
    std::set<std::string> seen;
    double longest = 0;
    for (size_t i = 1; i < keys.size(); ++i) longest = std::max(longest, keys[i].t - keys[i - 1].t);
    for (size_t i = 1; i < keys.size(); ++i) {
      if (!is_repeated_key(i) || !seen.insert(keys[i].pointer).second) continue;
      // All later keys move, so the error may come much later, but not before this segment.
      if (!found_.touches(keys[i - 1].t, pattern_.duration())) continue;
      const double lasts = keys[i].t - keys[i - 1].t;
      for (const double meant : number_slips(lasts)) {
        if (meant < kShortestPhase || meant > longest) continue;
        made.push_back({Rank::slip,
                        {key_place(i),
                         "the keyframe comes " + seconds(lasts) + " after the keyframe before it",
                         "with " + seconds(meant) + " between these two keyframes"},
                        [pointer = keys[i].pointer, by = meant - lasts](Pattern& p) {
                          double later = 0;
                          for (Keyframe& key : p.keyframes) {
                            if (key.pointer == pointer) later += by;
                            key.t += later;
                          }
                        }});
      }
    }
  }

  // The lowest height of a push that lasts `lasts` [s]: it begins at rest at height 0 and ends with
  // a lift-off at height `rise` with this speed. A landing is the same motion backwards in time.
  static double lowest(double rise, double speed, double lasts) {
    double low = 0;
    for (int i = 1; i < kSinkPoints; ++i)
      low = std::min(
          low,
          quintic_at({0, 0, 0, 0}, {lasts, rise, speed, -kGravity}, lasts * i / kSinkPoints).value);
    return low;
  }

  // The longest duration of a push from rest to this lift-off in which the COG does not sink
  // noticeably, at most `lasts` [s].
  static double longest_push(double rise, double speed, double lasts) {
    double possible = rise / speed, impossible = lasts;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (possible + impossible);
      (lowest(rise, speed, middle) < -kNotedSink * rise ? impossible : possible) = middle;
    }
    return possible;
  }

  // The keys that state the height of the COG.
  std::vector<size_t> height_keys() const {
    std::vector<size_t> keys;
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i)
      if (pattern_.keyframes[i].cog_height) keys.push_back(i);
    return keys;
  }

  // The number, among these keys, of the key at the beginning of a flight, if the next one of them
  // is at its end.
  std::optional<size_t> key_of_lift_off(const std::vector<size_t>& keys, size_t phase) const {
    const Phase& flight = pattern_.phases[phase];
    if (flight.support != Support::none || flight.viip) return std::nullopt;
    const auto is_at = [&](size_t key, double t) {
      return std::abs(pattern_.keyframes[key].t - t) < kSameInstant;
    };
    for (size_t k = 0; k + 1 < keys.size(); ++k)
      if (is_at(keys[k], begin_of(phase)))
        return is_at(keys[k + 1], flight.until) ? std::optional(k) : std::nullopt;
    return std::nullopt;
  }

  // If the time between the lowest key and the lift-off, or between the landing and the lowest key,
  // is too long, the COG sinks below that key, because its speed at the ground is that of the
  // flight.
  void stoops(std::vector<Hypothesis>& made) const {
    const std::vector<size_t> keys = height_keys();
    for (size_t i = 1; i < pattern_.phases.size(); ++i) {
      const std::optional<size_t> off = key_of_lift_off(keys, i);
      if (!off) continue;
      const double flight = pattern_.phases[i].until - begin_of(i);
      const Keyframe &leaves = pattern_.keyframes[keys[*off]],
                     &lands = pattern_.keyframes[keys[*off + 1]];
      const double mean = (*lands.cog_height - *leaves.cog_height) / flight;
      // For each end of the flight: the neighbouring key outside the flight, the key at this end,
      // and the mean vertical speed of the flight, where time runs away from the first of these
      // keys.
      std::vector<std::tuple<size_t, const Keyframe*, double>> sides;
      if (*off > 0) sides.emplace_back(keys[*off - 1], &leaves, mean);
      if (*off + 2 < keys.size()) sides.emplace_back(keys[*off + 2], &lands, -mean);
      for (const auto& [k, end, drift] : sides) {
        const Keyframe& low = pattern_.keyframes[k];
        const double rise = *end->cog_height - *low.cog_height;
        const double speed = drift + kGravity * flight / 2, lasts = std::abs(end->t - low.t);
        if (is_repeated_key(k) || rise <= kNoLength || speed * lasts <= rise) continue;
        const double sink = -lowest(rise, speed, lasts);
        if (sink < kNotedSink * rise) continue;
        const bool before = low.t < end->t;
        const double push = longest_push(rise, speed, lasts);
        const double t = std::round(1000 * (before ? end->t - push : end->t + push)) / 1000;
        made.push_back(
            {Rank::geometry,
             {key_place(k),
              "t is " + seconds(low.t) + ", so the segment " +
                  (before ? "from here to the lift-off" : "from the landing to here") + " lasts " +
                  seconds(lasts) + ". The flight is so long that it needs a COG speed of " +
                  text::brief(speed, 2) + " m/s at its " + (before ? "beginning" : "end") +
                  ", and so the COG sinks " + text::fixed(1000 * sink, 0) +
                  " mm below the height of this key",
              "with t = " + seconds(t)},
             [k = k, t](Pattern& p) { p.keyframes[k].t = t; },
             -sink});
      }
    }
  }

  /// The median of the durations of other phases of the same kind; no value if there are fewer than
  /// two of them.
  std::optional<double> usual_duration(size_t phase) const {
    std::vector<double> like;
    for (size_t i = 0; i < pattern_.phases.size(); ++i)
      if (i != phase &&
          is_single(pattern_.phases[i].support) == is_single(pattern_.phases[phase].support) &&
          (pattern_.phases[i].support == Support::none) ==
              (pattern_.phases[phase].support == Support::none) &&
          pattern_.phases[i].swing.has_value() == pattern_.phases[phase].swing.has_value())
        like.push_back(pattern_.phases[i].until - begin_of(i));
    if (like.size() < 2) return std::nullopt;
    std::sort(like.begin(), like.end());
    return like[like.size() / 2];
  }

  void phase_times(std::vector<Hypothesis>& made) const {
    for (size_t i = 0; i < pattern_.phases.size(); ++i) {
      if (!reaches(i)) continue;
      const double until = pattern_.phases[i].until, begin = begin_of(i);
      const double after =
          i + 1 < pattern_.phases.size() ? pattern_.phases[i + 1].until : until * 1e3;
      const std::optional<double> usual = usual_duration(i);
      const bool is_usual = usual && std::abs(until - begin - *usual) < kUsualShare * *usual;
      ends_at_keys(i, after, is_usual ? std::nullopt : usual, made);
      durations(i, made);
      if (is_usual) continue;
      std::vector<double> meant;
      if (usual) meant.push_back(std::round(1000 * (begin + *usual)) / 1000);
      const auto unlike = [&](double t) { return usual ? std::abs(t - begin - *usual) : 0.0; };
      for (const double slip : number_slips(until))
        if (unlike(slip) <= unlike(until)) meant.push_back(slip);
      const std::string lasts = "the phase ends at " + seconds(until) + " and lasts " +
                                seconds(until - begin) +
                                (usual ? ", while similar phases last " + seconds(*usual) : "");
      // A motion that really lasts so long has keys at its end, too.
      const bool last = i + 1 == pattern_.phases.size();
      const double keyed = pattern_.keyframes.empty() ? 0 : pattern_.keyframes.back().t;
      const auto is_used = [&](double t) { return !last || t <= until || 2 * keyed > begin + t; };
      for (const double t : meant)
        if (t > begin + kShortestPhase && t < after && t != until && is_used(t))
          made.push_back({Rank::slip,
                          {phase_place(i), lasts, "with an end at " + seconds(t)},
                          [i, t](Pattern& p) { p.phases[i].until = t; }});
      if (!usual) continue;
      made.push_back(
          {Rank::slip,
           {phase_place(i), lasts,
            "with a duration of " + seconds(*usual) + ", and all times after this phase " +
                seconds(std::abs(*usual - (until - begin))) +
                (*usual > until - begin ? " later," : " earlier,")},
           [i, until, later = *usual - (until - begin)](Pattern& p) {
             for (size_t k = i; k < p.phases.size(); ++k) p.phases[k].until += later;
             for (Keyframe& key : p.keyframes)
               if (key.t >= until - 1e-9) key.t += later;
           }});
    }
  }

  // Moves the end of a phase without such a key to a key of the ZMP or of a foot beside it, except
  // to the end at which the phase has the duration `tried`.
  void ends_at_keys(size_t phase, double after, std::optional<double> tried,
                    std::vector<Hypothesis>& made) const {
    const double begin = begin_of(phase), until = pattern_.phases[phase].until;
    if (phase + 1 == pattern_.phases.size() || has_key_of_contact(until)) return;
    // The keys of the COG height belong to the ends of a flight.
    const bool flight = pattern_.phases[phase].support == Support::none ||
                        pattern_.phases[phase + 1].support == Support::none;
    for (size_t k = 0; k < pattern_.keyframes.size(); ++k) {
      const Keyframe& key = pattern_.keyframes[k];
      if (key.t <= begin + kShortestPhase || key.t >= after || is_at_end(key.t) ||
          !(is_of_contact(key) || (flight && key.cog_height)))
        continue;
      if (tried && std::abs(key.t - begin - *tried) < kSameInstant) continue;
      made.push_back(
          {Rank::slip,
           {phase_place(phase),
            "the phase ends at " + seconds(until) +
                ", but no keyframe moves the ZMP or a foot at this time; " + key_place(k) +
                " is at " + seconds(key.t) + ", but no phase ends at that time",
            "with an end at " + seconds(key.t)},
           [phase, t = key.t](Pattern& p) { p.phases[phase].until = t; },
           kCoincidence});
    }
  }

  // A wrong duration moves all later phases, but not the keyframes, so that these no longer fit.
  void durations(size_t phase, std::vector<Hypothesis>& made) const {
    const double until = pattern_.phases[phase].until, lasts = until - begin_of(phase);
    if (is_repeated(pattern_, pattern_.phases[phase].pointer)) return;
    const long now = keys_at_ends(phase, 0);
    for (const double meant : number_slips(lasts)) {
      if (meant < kShortestPhase) continue;
      const Mend mend = [phase, later = meant - lasts](Pattern& p) {
        for (size_t k = phase; k < p.phases.size(); ++k) p.phases[k].until += later;
      };
      const long more = keys_at_ends(phase, meant - lasts) - now;
      if (more <= 0) continue;
      made.push_back({Rank::slip,
                      {phase_place(phase),
                       "the phase lasts " + seconds(lasts) +
                           ", so the times of keyframes do not fit the ends of the phases",
                       "with a duration of " + seconds(meant) + " (then " +
                           text::counted(static_cast<size_t>(more), "more keyframe") +
                           (more == 1 ? " is" : " are") + " at the end of a phase)"},
                      mend,
                      kCoincidence - static_cast<double>(more)});
    }
  }

  // ---- sides

  static ZmpKey::Place place_under(Support single) {
    return single == Support::left ? ZmpKey::Place::left : ZmpKey::Place::right;
  }

  // Whether this key puts the ZMP under the foot on which the robot stands alone: at its place, or
  // at a point on its sole.
  bool is_under(const Keyframe& key, Support single) const {
    if (key.zmp->place != ZmpKey::Place::point) return key.zmp->place == place_under(single);
    if (!feet_) return false;
    const Side side = stance_of(single);
    Eigen::AlignedBox2d sole;
    for (const Eigen::Vector2d& corner : model_.sole(side).polygon) sole.extend(corner);
    const Eigen::Isometry3d place = feet_->pose(side, key.t);
    const Eigen::Vector3d zmp(key.zmp->point.x(), key.zmp->point.y(), place.translation().z());
    return sole.contains((place.inverse() * zmp).head<2>());
  }

  /// The keys that lead the ZMP while the robot stands on one foot, but do not put it under this
  /// foot: the keys of the phase and, where the phase begins or ends between two keys, the nearest
  /// keys outside of it.
  std::vector<size_t> wrong_zmp_keys(size_t phase) const {
    const double begin = begin_of(phase), until = pattern_.phases[phase].until;
    std::vector<size_t> keys, wrong;
    std::optional<size_t> before, after;
    for (size_t k = 0; k < pattern_.keyframes.size(); ++k) {
      const Keyframe& key = pattern_.keyframes[k];
      if (!key.zmp) continue;
      if (key.t <= begin + 1e-9) before = k;
      if (key.t >= until - 1e-9 && !after) after = k;
      if (key.t > begin + 1e-9 && key.t < until - 1e-9) keys.push_back(k);
    }
    if (before) keys.insert(keys.begin(), *before);
    if (after) keys.push_back(*after);
    for (const size_t k : keys)
      if (!is_under(pattern_.keyframes[k], pattern_.phases[phase].support)) wrong.push_back(k);
    return wrong;
  }

  // If keys put the ZMP elsewhere in several phases on one foot, tries all of them under the
  // supporting foot.
  void all_zmp_keys(std::vector<Hypothesis>& made) const {
    std::map<size_t, ZmpKey::Place> meant;
    std::vector<size_t> phases;
    for (size_t i = 0; i < pattern_.phases.size(); ++i) {
      if (!is_single(pattern_.phases[i].support)) continue;
      const std::vector<size_t> wrong = wrong_zmp_keys(i);
      if (!wrong.empty()) phases.push_back(i);
      for (const size_t k : wrong) meant[k] = place_under(pattern_.phases[i].support);
    }
    if (phases.size() < 2) return;
    const Phase& first = pattern_.phases[phases.front()];
    made.push_back({Rank::exchange,
                    {phase_place(phases.front()),
                     std::string("the robot stands on the ") + name_of(stance_of(first.support)) +
                         " foot, but " + key_place(wrong_zmp_keys(phases.front()).front()) +
                         " puts the ZMP " + zmp_words(wrong_zmp_keys(phases.front()).front()) +
                         "; this is so in " + std::to_string(phases.size()) + " phases",
                     "with the ZMP under the foot that carries the robot in each of these phases"},
                    [meant](Pattern& p) {
                      for (const auto& [k, place] : meant) p.keyframes[k].zmp->place = place;
                    }});
  }

  std::string zmp_words(size_t key) const {
    const ZmpKey::Place place = pattern_.keyframes[key].zmp->place;
    return place == ZmpKey::Place::left     ? "under the left foot"
           : place == ZmpKey::Place::right  ? "under the right foot"
           : place == ZmpKey::Place::center ? "at \"center\""
                                            : "at a point";
  }

  // If keys put the ZMP under the foot in the air in most phases on one foot, tries all keys of the
  // ZMP with left and right exchanged.
  void zmp_sides(std::vector<Hypothesis>& made) const {
    size_t wrong = 0, single = 0;  // numbers of phases
    for (size_t i = 0; i < pattern_.phases.size(); ++i) {
      const Phase& phase = pattern_.phases[i];
      if (!is_single(phase.support)) continue;
      ++single;
      const std::vector<size_t> keys = wrong_zmp_keys(i);
      if (std::any_of(keys.begin(), keys.end(), [&](size_t k) {
            return pattern_.keyframes[k].zmp->place == place_under(opposite(phase.support));
          }))
        ++wrong;
    }
    if (wrong < 2 || 2 * wrong <= single) return;
    made.push_back({Rank::exchange,
                    {"/keyframes",
                     "the keys put the ZMP under the left foot where the robot stands on the right "
                     "foot, or the other way round; perhaps left and right were exchanged",
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

  void zmp_keys(std::vector<Hypothesis>& made) const {
    for (size_t i = 0; i < pattern_.phases.size(); ++i) {
      const Phase& phase = pattern_.phases[i];
      if (!is_single(phase.support) || !reaches(i)) continue;
      const ZmpKey::Place meant = place_under(phase.support);
      const std::vector<size_t> wrong = wrong_zmp_keys(i);
      if (wrong.empty()) continue;
      std::vector<std::string> places;
      for (const size_t k : wrong) places.push_back(key_place(k));
      const std::string foot = name_of(stance_of(phase.support));
      const std::string at = zmp_words(wrong.front());
      made.push_back(
          {Rank::exchange,
           {phase_place(i),
            "the robot stands on the " + foot + " foot, but " + text::join(places, " and ") +
                (places.size() > 1 ? " put" : " puts") + " the ZMP " + at,
            "with \"zmp\": \"" + foot +
                (places.size() > 1 ? "\" in these keyframes" : "\" in this keyframe")},
           [wrong, meant](Pattern& p) {
             for (const size_t k : wrong) p.keyframes[k].zmp->place = meant;
           }});
      if (!has_zmp_key(begin_of(i), phase.until)) missing_zmp_keys(i, wrong.front(), made);
    }
  }

  // Whether the ZMP has a key between these times, or at one of them.
  bool has_zmp_key(double begin, double end) const {
    return std::any_of(pattern_.keyframes.begin(), pattern_.keyframes.end(),
                       [&](const Keyframe& key) {
                         return key.zmp && key.t >= begin - 1e-9 && key.t <= end + 1e-9;
                       });
  }

  // In a single support without keys of the ZMP, the ZMP follows the keys of the neighbouring
  // phases. Tries keys under the standing foot at both ends of the phase.
  void missing_zmp_keys(size_t phase, size_t wrong, std::vector<Hypothesis>& made) const {
    const Support support = pattern_.phases[phase].support;
    const double begin = begin_of(phase), until = pattern_.phases[phase].until;
    const std::string foot = name_of(stance_of(support));
    made.push_back({Rank::exchange,
                    {phase_place(phase),
                     "the robot stands on the " + foot + " foot from " + seconds(begin) + " to " +
                         seconds(until) + ", but no keyframe puts the ZMP under this foot; " +
                         key_place(wrong) + " puts the ZMP " + zmp_words(wrong),
                     "with \"zmp\": \"" + foot + "\" in keyframes at these two times"},
                    [begin, until, place = place_under(support)](Pattern& p) {
                      for (const double t : {begin, until}) {
                        const auto after =
                            std::find_if(p.keyframes.begin(), p.keyframes.end(),
                                         [&](const Keyframe& key) { return key.t > t - 1e-9; });
                        Keyframe added;
                        added.t = t;
                        const bool is_there =
                            after != p.keyframes.end() && std::abs(after->t - t) < 1e-9;
                        Keyframe& key = is_there ? *after : *p.keyframes.insert(after, added);
                        key.zmp = ZmpKey{place};
                      }
                    }});
  }

  /// Total distance between the successive footholds of each foot [m].
  double way_of_feet(const Pattern& pattern) const {
    double way = 0;
    std::array<std::optional<Eigen::Vector3d>, 2> at;
    for (const Phase& phase : pattern.phases) {
      if (!phase.swing || phase.swing->step) continue;
      auto& last = at[static_cast<size_t>(index(phase.swing->foot))];
      if (last) way += (phase.swing->to.position - *last).norm();
      last = phase.swing->to.position;
    }
    return way;
  }

  // Exchanged footholds lead the feet back and forth, so that another exchange shortens their path.
  // If the footholds are in good order, an exchange lengthens the path.
  bool exchange_shortens_way(size_t one, size_t other) const {
    Pattern exchanged = pattern_;
    std::swap(exchanged.phases[one].swing->to, exchanged.phases[other].swing->to);
    return way_of_feet(exchanged) < way_of_feet(pattern_) - kNoLength;
  }

  // Whether the foot that swings in this phase swings in the steps before and after it, too.
  bool swings_thrice(size_t phase) const {
    const auto foot_of = [&](size_t i) -> std::optional<Side> {
      if (!pattern_.phases[i].swing) return std::nullopt;
      return pattern_.phases[i].swing->foot;
    };
    std::optional<Side> before, after;
    for (size_t i = phase; i-- > 0 && !before;) before = foot_of(i);
    for (size_t i = phase + 1; i < pattern_.phases.size() && !after; ++i) after = foot_of(i);
    return foot_of(phase) && before == foot_of(phase) && after == before;
  }

  void phase_sides(std::vector<Hypothesis>& made) const {
    for (size_t i = 0; i < pattern_.phases.size(); ++i) {
      const Phase& phase = pattern_.phases[i];
      if (!is_single(phase.support) || !reaches(i)) continue;
      const Support meant = opposite(phase.support);
      made.push_back({Rank::exchange,
                      {phase_place(i),
                       std::string("support is ") + name_of(phase.support) +
                           (phase.swing ? std::string(" and the ") + name_of(phase.swing->foot) +
                                              " foot swings"
                                        : "") +
                           "; perhaps left and right were exchanged",
                       std::string("with support ") + name_of(meant) +
                           (phase.swing ? std::string(" and a swing of the ") +
                                              name_of(other(phase.swing->foot)) + " foot"
                                        : "")},
                      [i, meant](Pattern& p) {
                        p.phases[i].support = meant;
                        if (p.phases[i].swing)
                          p.phases[i].swing->foot = other(p.phases[i].swing->foot);
                      },
                      swings_thrice(i) ? -1.0 : 0.0});
      add_foothold_exchanges(i, made);
    }
  }

  void foothold_exchanges(std::vector<Hypothesis>& made) const {
    for (size_t i = 0; i < pattern_.phases.size(); ++i)
      if (is_single(pattern_.phases[i].support) && reaches(i)) add_foothold_exchanges(i, made);
  }

  // How far a foot lands on its own side of the other one [m].
  double outwards(size_t phase) const {
    const Swing& swing = *pattern_.phases[phase].swing;
    const Eigen::Isometry3d stance = feet_->pose(other(swing.foot), pattern_.phases[phase].until);
    return (swing.foot == Side::left ? 1 : -1) * (stance.inverse() * swing.to.position).y();
  }

  // If both feet land on the side of the other foot, two footholds were exchanged; this is more
  // probable than two wrong signs.
  void crossed_footholds(std::vector<Hypothesis>& made) const {
    if (!feet_) return;
    std::vector<Hypothesis> exchanges;
    for (size_t i = 0; i < pattern_.phases.size(); ++i)
      if (has_place(i) && is_single(pattern_.phases[i].support) && reaches(i) && outwards(i) < 0)
        add_foothold_exchanges(
            i, exchanges, [&](size_t k) { return foot_of(k) != foot_of(i) && outwards(k) < 0; });
    for (Hypothesis& exchange : exchanges) {
      exchange.rank = Rank::geometry;
      made.push_back(std::move(exchange));
    }
  }

  // If most feet land on the other side of the world's x axis than they start, y may have been
  // counted to the right, or the words left and right may have been exchanged. Both are tried.
  void all_sides(std::vector<Hypothesis>& made) const {
    if (!feet_) return;
    std::vector<size_t> crossed;
    size_t swings = 0;
    for (size_t i = 0; i < pattern_.phases.size(); ++i) {
      if (!has_place(i)) continue;
      ++swings;
      const Swing& swing = *pattern_.phases[i].swing;
      const double start = feet_->pose(swing.foot, 0).translation().y();
      if (start * swing.to.position.y() < 0) crossed.push_back(i);
    }
    if (crossed.size() < 2 || 2 * crossed.size() <= swings) return;
    const auto add = [&](const std::string& instead, Mend mend) {
      made.push_back({Rank::geometry,
                      {phase_place(crossed.front()),
                       std::to_string(crossed.size()) + " of " + std::to_string(swings) +
                           " footholds have the y of the other foot's side (y is positive to the "
                           "left); perhaps left and right were exchanged",
                       instead},
                      std::move(mend)});
    };
    add("with the other sign of y in these footholds", [crossed](Pattern& p) {
      for (const size_t i : crossed) p.phases[i].swing->to.position.y() *= -1;
    });
    add("with left and right exchanged in all phases, and in the feet and the ZMP of all keys",
        [](Pattern& p) {
          for (Phase& phase : p.phases) {
            phase.support = opposite(phase.support);
            if (phase.swing) phase.swing->foot = other(phase.swing->foot);
          }
          for (Keyframe& key : p.keyframes) {
            std::swap(key.feet[0], key.feet[1]);
            if (key.zmp) key.zmp->place = opposite(key.zmp->place);
          }
        });
  }

  Side foot_of(size_t phase) const { return pattern_.phases[phase].swing->foot; }

  // Adds the exchange of this foothold with each of the next two.
  void add_foothold_exchanges(
      size_t phase, std::vector<Hypothesis>& made,
      const std::function<bool(size_t)>& with = [](size_t) { return true; }) const {
    if (!has_place(phase)) return;
    int later = 0;
    for (size_t k = phase + 1; k < pattern_.phases.size() && later < 2; ++k) {
      if (!has_place(k)) continue;
      ++later;
      if (!with(k) || !exchange_shortens_way(phase, k)) continue;
      made.push_back({Rank::exchange,
                      {phase_place(phase),
                       std::string("the footholds of this phase and of ") + phase_place(k) +
                           " were perhaps exchanged",
                       "with the two exchanged"},
                      [phase, k](Pattern& p) {
                        std::swap(p.phases[phase].swing->to, p.phases[k].swing->to);
                      }});
    }
  }

  // Two numbers in the wrong order: x forward and y to the left.
  void swapped_axes(std::vector<Hypothesis>& made) const {
    const auto add = [&](const std::string& place, const std::string& words,
                         const Eigen::Vector3d& at,
                         const std::function<Eigen::Vector3d&(Pattern&)>& in) {
      if (std::abs(at.x() - at.y()) < kLeastMistake * leg_length(model_)) return;
      made.push_back({Rank::exchange,
                      {place,
                       words + " is at x = " + text::brief(at.x()) + " m and y = " +
                           text::brief(at.y()) + " m; x is forward, and y is to the left",
                       "with the two numbers exchanged"},
                      [in](Pattern& p) { std::swap(in(p).x(), in(p).y()); }});
      made.back().only_if_enough = true;
    };
    for (size_t i = 0; i < pattern_.phases.size(); ++i)
      if (has_place(i) && reaches(i))
        add(phase_place(i), std::string("the foothold of the ") + name_of(foot_of(i)) + " foot",
            pattern_.phases[i].swing->to.position,
            [i](Pattern& p) -> Eigen::Vector3d& { return p.phases[i].swing->to.position; });
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i)
      for (const Side side : {Side::left, Side::right})
        if (const auto s = static_cast<size_t>(index(side));
            pattern_.keyframes[i].feet[s] && reaches_key(i))
          add(key_place(i), std::string("the ") + name_of(side) + " foot",
              pattern_.keyframes[i].feet[s]->position,
              [i, s](Pattern& p) -> Eigen::Vector3d& { return p.keyframes[i].feet[s]->position; });
  }

  // Tries another unit for a whole foothold or foot key.
  void footholds(std::vector<Hypothesis>& made) const {
    const auto add = [&](const std::string& place, Side side, const Foothold& foot,
                         const std::function<Foothold&(Pattern&)>& in) {
      // A single number that is too large does not come from a wrong unit.
      for (const double length : foot.position)
        if (std::abs(length) > kNoLength && std::abs(length) < leg_length(model_)) return;
      if (foot.position.norm() < leg_length(model_)) return;
      for (const auto& [unit, factor] : kSmallerUnits) {
        const Eigen::Vector3d meant = foot.position * factor;
        made.push_back(
            {Rank::slip,
             {place,
              std::string("the ") + name_of(side) + " foot is at (" +
                  text::brief(foot.position.x()) + ", " + text::brief(foot.position.y()) + ", " +
                  text::brief(foot.position.z()) + ") m; lengths are in metres",
              std::string("with these numbers read in ") + unit + ", which gives (" +
                  text::brief(meant.x()) + ", " + text::brief(meant.y()) + ", " +
                  text::brief(meant.z()) + ") m,"},
             [in, factor = factor](Pattern& p) { in(p).position *= factor; }});
      }
    };
    for (size_t i = 0; i < pattern_.phases.size(); ++i) {
      const auto& swing = pattern_.phases[i].swing;
      if (swing && !swing->step && reaches(i))
        add(phase_place(i), swing->foot, swing->to,
            [i](Pattern& p) -> Foothold& { return p.phases[i].swing->to; });
    }
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i)
      for (const size_t side : {size_t(0), size_t(1)})
        if (const auto& foot = pattern_.keyframes[i].feet[side]; foot && reaches_key(i))
          add(key_place(i), static_cast<Side>(side), *foot,
              [i, side](Pattern& p) -> Foothold& { return *p.keyframes[i].feet[side]; });
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i) zmp_point(i, made);
    for (const FarTarget& target : far_targets())
      if (reaches_key(target.key)) target_unit(target, made);
  }

  // ---- targets of hands, other links and the gaze

  static constexpr const char* kGaze = "/gaze";

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

  std::vector<FarTarget> far_targets() const {
    std::vector<FarTarget> far;
    const auto look = [&](size_t key, const std::string& name, const std::string& pointer,
                          const LinkTarget& target,
                          const std::function<LinkTarget&(Pattern&)>& in) {
      if (!target.position || target.position->norm() < leg_length(model_)) return;
      // A single number that is too large does not come from a wrong unit.
      for (const double length : *target.position)
        if (std::abs(length) > kNoLength && std::abs(length) < kLeastWritten) return;
      far.push_back({key, name, key_place(key) + pointer, pointer == kGaze, *target.position,
                     [in](Pattern& p) -> Eigen::Vector3d& { return *in(p).position; }});
    };
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i) {
      const Keyframe& key = pattern_.keyframes[i];
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

  static std::string point(const Eigen::Vector3d& v) {
    return "(" + text::brief(v.x()) + ", " + text::brief(v.y()) + ", " + text::brief(v.z()) + ") m";
  }

  void target_unit(const FarTarget& target, std::vector<Hypothesis>& made) const {
    for (const auto& [unit, factor] : kSmallerUnits)
      made.push_back(
          {Rank::slip,
           {target.place,
            target.name + " is aimed at " + point(target.position) + "; lengths are in metres",
            std::string("with these numbers read in ") + unit + ", which gives " +
                point(factor * target.position) + ","},
           [in = target.in, factor = factor](Pattern& p) { in(p) *= factor; }});
  }

  // Tries another unit for all targets of the hands and other links, or for all targets of the
  // gaze.
  void target_units(std::vector<Hypothesis>& made) const {
    const std::vector<FarTarget> all = far_targets();
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
                  " at such a distance; lengths are in metres",
              std::string("with these targets read in ") + unit},
             [far, factor = factor](Pattern& p) {
               for (const FarTarget& target : far) target.in(p) *= factor;
             }});
    }
  }

  // Tries another unit for a whole point of the ZMP.
  void zmp_point(size_t key, std::vector<Hypothesis>& made) const {
    const auto& zmp = pattern_.keyframes[key].zmp;
    if (!zmp || zmp->place != ZmpKey::Place::point || zmp->point.norm() < leg_length(model_) ||
        !reaches_key(key))
      return;
    for (const auto& [unit, factor] : kSmallerUnits) {
      const Eigen::Vector2d meant = zmp->point.head<2>() * factor;
      made.push_back(
          {Rank::slip,
           {key_place(key),
            "the ZMP is at (" + text::brief(zmp->point.x()) + ", " + text::brief(zmp->point.y()) +
                ") m; lengths are in metres",
            std::string("with these numbers read in ") + unit + ", which gives (" +
                text::brief(meant.x()) + ", " + text::brief(meant.y()) + ") m,"},
           [key, factor = factor](Pattern& p) { p.keyframes[key].zmp->point *= factor; }});
    }
  }

  // The value "turn" of a step is relative to the heading of the other foot. If both feet have the
  // same turn, the robot turns twice as far, and every second foot is turned inwards.
  void turns(std::vector<Hypothesis>& made) const {
    const auto turn_of = [&](const Phase& phase) {
      return phase.swing && phase.swing->step ? phase.swing->step->turn : 0.0;
    };
    size_t first = 0;
    while (first < pattern_.phases.size() && std::abs(turn_of(pattern_.phases[first])) < kNoAngle)
      ++first;
    if (first == pattern_.phases.size()) return;
    const double turn = turn_of(pattern_.phases[first]);
    const Side leading = pattern_.phases[first].swing->foot;
    double sum = 0;
    std::vector<size_t> second;
    for (size_t i = first; i < pattern_.phases.size(); ++i) {
      const double here = turn_of(pattern_.phases[i]);
      sum += here;
      if (here * turn > 0 && pattern_.phases[i].swing->foot != leading) second.push_back(i);
    }
    if (second.empty()) return;
    const std::string foot = name_of(other(leading)), ahead = name_of(leading);
    const size_t n = second.size();
    made.push_back(
        {Rank::geometry,
         {phase_place(second.front()),
          "the " + foot + " foot's step turns by " + angle(turn_of(pattern_.phases[second[0]])) +
              " after the " + ahead + " foot has turned by " + angle(turn) +
              "; \"turn\" counts from the other foot, so all steps turn the robot by " + angle(sum),
          "with \"turn\" 0 in " + (n > 1 ? "the " + std::to_string(n) + " steps" : "the step") +
              " of the " + foot + " foot, which then " + (n > 1 ? "land" : "lands") +
              " parallel to the " + ahead + " foot,"},
         [second](Pattern& p) {
           for (const size_t i : second) p.phases[i].swing->step->turn = 0;
         }});
  }

  /// The nearest angle in whole degrees [rad].
  static double whole_degrees(double radians) {
    constexpr double degree = std::numbers::pi / 180;
    return std::round(radians / degree) * degree;
  }

  std::string angle(double radians) const {
    return pattern_.degrees ? text::brief(radians * 180 / std::numbers::pi, 5) + " deg"
                            : text::brief(radians, 5) + " rad";
  }

  bool has_place(size_t phase) const {
    return phase < pattern_.phases.size() && pattern_.phases[phase].swing &&
           !pattern_.phases[phase].swing->step;
  }
  bool has_later_place(size_t phase) const {
    for (size_t k = phase + 1; k < pattern_.phases.size(); ++k)
      if (has_place(k)) return true;
    return false;
  }

  // A foothold is moved nearer to the place beside the other foot, and all later footholds are
  // moved with it.
  void near_footholds(std::vector<Hypothesis>& made) const {
    if (!feet_) return;
    for (size_t i = 0; i < pattern_.phases.size(); ++i) {
      if (!has_place(i) || !reaches(i)) continue;
      const Swing& swing = *pattern_.phases[i].swing;
      const Side side = swing.foot;
      const Eigen::Isometry3d stance = feet_->pose(other(side), pattern_.phases[i].until);
      const double apart =
          (feet_->pose(other(side), 0).inverse() * feet_->pose(side, 0).translation()).y();
      const Eigen::Vector3d from_stance = stance.inverse() * swing.to.position;
      const Eigen::Vector3d away(from_stance.x(), from_stance.y() - apart, 0);
      if (away.norm() < kLeastMistake * leg_length(model_)) continue;
      for (const double share : {0.8, 0.6, 0.4, 0.2, 0.0}) {
        const auto grid = [](double metres) { return std::round(1e4 * metres) / 1e4; };
        Eigen::Vector3d place = swing.to.position + (share - 1) * (stance.linear() * away);
        place = {grid(place.x()), grid(place.y()), swing.to.position.z()};
        const Eigen::Vector3d moved = place - swing.to.position;
        made.push_back({Rank::amount,
                        {phase_place(i),
                         std::string("the ") + name_of(side) + " foot lands " +
                             text::fixed(1e3 * from_stance.head<2>().norm(), 0) + " mm from the " +
                             name_of(other(side)) + " foot, and at the beginning they are " +
                             text::fixed(1e3 * std::abs(apart), 0) + " mm apart",
                         "with \"to\" = [" + text::brief(place.x()) + ", " +
                             text::brief(place.y()) + ", ...]" +
                             (has_later_place(i) ? ", and all later footholds moved by the same [" +
                                                       text::brief(moved.x(), 3) + ", " +
                                                       text::brief(moved.y(), 3) + "] m,"
                                                 : "")},
                        [i, moved](Pattern& p) {
                          for (size_t k = i; k < p.phases.size(); ++k)
                            if (p.phases[k].swing && !p.phases[k].swing->step)
                              p.phases[k].swing->to.position += moved;
                        },
                        1 - share,
                        moved.norm() / leg_length(model_)});
      }
    }
  }

  // A foot turns less relative to the other foot, and the later footholds turn with it.
  void lesser_turns(std::vector<Hypothesis>& made) const {
    if (!feet_) return;
    for (size_t i = 0; i < pattern_.phases.size(); ++i) {
      if (!has_place(i) || !reaches(i)) continue;
      const Swing& swing = *pattern_.phases[i].swing;
      const Eigen::Matrix3d turned =
          (feet_->pose(other(swing.foot), pattern_.phases[i].until).inverse() * pose_of(swing.to))
              .linear();
      const double turn = elementary::atan2(turned(1, 0), turned(0, 0));
      if (std::abs(turn) < kNotedTurn) continue;
      for (const double share : {0.75, 0.5}) {
        const double less = whole_degrees((share - 1) * turn);
        made.push_back(
            {Rank::amount,
             {phase_place(i),
              std::string("the ") + name_of(swing.foot) + " foot turns by " + angle(turn) +
                  " against the " + name_of(other(swing.foot)) + " foot",
              "with a yaw of " + angle(swing.to.rpy.z() + less) +
                  (has_later_place(i) ? ", and all later footholds turned about this one by " +
                                            angle(less) + " (the turn then takes more steps),"
                                      : "")},
             [i, less](Pattern& p) {
               const Eigen::Vector3d about = p.phases[i].swing->to.position;
               const Eigen::Quaterniond by = exp_rotation({0, 0, less});
               for (size_t k = i; k < p.phases.size(); ++k) {
                 if (!p.phases[k].swing || p.phases[k].swing->step) continue;
                 Foothold& to = p.phases[k].swing->to;
                 to.position = about + by * (to.position - about);
                 to.rpy.z() += less;
               }
             },
             1 - share,
             std::abs(less)});
      }
    }
  }

  // A key of a foot in the air, and where the foot would be without the keys of this swing.
  struct AirKey {
    size_t key = 0;
    Eigen::Vector3d position = {}, neutral = {};
  };

  /// The keys of a foot while the robot stands on the other one in this phase.
  std::vector<AirKey> air_keys(size_t phase) const {
    const Side side = other(stance_of(pattern_.phases[phase].support));
    const auto s = static_cast<size_t>(index(side));
    const double begin = begin_of(phase), until = pattern_.phases[phase].until;
    const Eigen::Vector3d from = feet_->pose(side, begin).translation(),
                          to = feet_->pose(side, until).translation();
    std::vector<AirKey> keys;
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i) {
      const Keyframe& key = pattern_.keyframes[i];
      if (!key.feet[s] || key.t <= begin + 1e-9 || key.t >= until - 1e-9) continue;
      const Eigen::Vector3d neutral = from + (key.t - begin) / (until - begin) * (to - from);
      if (is_repeated_key(i)) return {};
      if ((key.feet[s]->position - neutral).norm() > kNoLength)
        keys.push_back({i, key.feet[s]->position, neutral});
    }
    return keys;
  }

  // All keys of a foot in the air are nearer to its place on the ground, or lower, or both.
  void smaller_swings(std::vector<Hypothesis>& made, const std::array<double, 3>& shares) const {
    if (!feet_) return;
    for (size_t phase = 0; phase < pattern_.phases.size(); ++phase) {
      if (!is_single(pattern_.phases[phase].support) || pattern_.phases[phase].swing ||
          !reaches(phase))
        continue;
      const std::vector<AirKey> keys = air_keys(phase);
      if (keys.size() < 2) continue;  // the numbers of a single key are values of their own
      const Side side = other(stance_of(pattern_.phases[phase].support));
      double far = 0, up = 0, down = 0;
      for (const AirKey& key : keys) {
        const Eigen::Vector3d way = key.position - key.neutral;
        far = std::max(far, way.head<2>().norm());
        up = std::max(up, way.z());
        down = std::max(down, -way.z());
      }
      const double high = std::max(up, down);
      std::vector<std::string> ways;
      for (const auto& [length, where] :
           {std::pair(far, "away from its place on the ground"), {up, "up"}, {down, "down"}})
        if (length >= kNoLength)
          ways.push_back("up to " + text::fixed(1e3 * length, 0) + " mm " + where);
      const SwingWords words = {
          std::string("the ") + name_of(side) + " foot moves " + text::join(ways, " and "),
          down < kNoLength ? "lower" : (up < kNoLength ? "higher" : "flatter")};
      for (const auto& [nearer, lower] : {std::pair(true, true), {true, false}, {false, true}}) {
        if ((nearer && far < kNoLength) || (lower && high < kNoLength)) continue;
        for (const double share : shares)
          made.push_back(smaller_swing(keys, side, nearer ? share : 1, lower ? share : 1, words));
      }
    }
  }

  // A position as a pattern has it [m].
  static std::string written_position(const Eigen::Vector3d& p) {
    return "[" + text::brief(p.x(), 9) + ", " + text::brief(p.y(), 9) + ", " +
           text::brief(p.z(), 9) + "]";
  }

  struct SwingWords {
    std::string written;  // how far the foot moves
    std::string lower;    // word for keys that move less up or down
  };

  Hypothesis smaller_swing(const std::vector<AirKey>& keys, Side side, double away, double up,
                           const SwingWords& words) const {
    std::vector<std::pair<size_t, Eigen::Vector3d>> places;
    std::vector<std::string> texts;
    double moved = 0;
    for (const AirKey& key : keys) {
      Eigen::Vector3d place = key.position;
      for (int axis = 0; axis < 3; ++axis)
        if (const double share = axis == 2 ? up : away; share != 1)
          place[axis] =
              std::round(1e4 * (key.neutral[axis] + share * (place[axis] - key.neutral[axis]))) /
              1e4;
      moved = std::max(moved, (place - key.position).norm());
      places.emplace_back(key.key, place);
      if (texts.size() < kPlacedKeys)
        texts.push_back(written_position(place) + " in " + key_place(key.key));
    }
    const double share = std::min(away, up);
    if (keys.size() > kPlacedKeys)
      texts.push_back("and in the later keys of this swing at " + text::fixed(100 * share, 0) +
                      " % of the " + (away == 1 ? "vertical " : (up == 1 ? "level " : "")) +
                      "distance from the line between the places of the foot on the ground");
    const auto s = static_cast<size_t>(index(side));
    return {Rank::amount,
            {key_place(keys.front().key), words.written,
             "with all keys of this swing " +
                 (away == 1 ? words.lower : (up == 1 ? "nearer" : "nearer and " + words.lower)) +
                 " (the " + name_of(side) + " foot at " + text::join(texts, ", ") + "),"},
            [places, s](Pattern& p) {
              for (const auto& [key, place] : places) p.keyframes[key].feet[s]->position = place;
            },
            1 - share,
            moved / leg_length(model_)};
  }

  // The foot with its turn as the author can write it: "left": {"position": [0, 0.039, 0.03],
  // "rpy": [0, -20, 0]}.
  std::string turned_foot(Side side, const Foothold& foot, double roll, double pitch) const {
    const double unit = pattern_.degrees ? std::numbers::pi / 180 : 1;
    return "\"" + std::string(name_of(side)) +
           "\": {\"position\": " + written_position(foot.position) + ", \"rpy\": [" +
           text::brief(roll / unit) + ", " + text::brief(pitch / unit) + ", " +
           text::brief(foot.rpy.z() / unit, 9) + "]}";
  }

  bool has_cog_height() const {
    return std::any_of(pattern_.keyframes.begin(), pattern_.keyframes.end(),
                       [](const Keyframe& key) { return key.cog_height.has_value(); });
  }

  /// The hip of a leg in the frame of its sole, while the robot stands at the height of the
  /// pattern.
  Eigen::Vector3d standing_hip(Side side) const {
    RobotData data(model_);
    update_positions(model_, model_.rest_state(), data);
    const int body = model_.dofs()[static_cast<size_t>(model_.leg(side).front())].body;
    Eigen::Vector3d hip = sole_pose(model_, data, side).inverse() * data.pose(body).translation();
    hip.z() += default_cog_height(model_, pattern_) - home_cog_height(model_, pattern_);
    return hip;
  }

  // If a foot stays level while its leg leans, the ankle has to compensate for the lean. Tries the
  // foot turned with its leg.
  void level_feet(std::vector<Hypothesis>& made) const {
    if (!feet_) return;
    for (const Side side : {Side::left, Side::right}) {
      const auto s = static_cast<size_t>(index(side));
      const Eigen::Isometry3d from = feet_->pose(side, 0);
      const Eigen::Vector3d hip = standing_hip(side);
      struct Lean {
        size_t key;
        double roll, pitch;
      };
      std::vector<Lean> leans;
      for (size_t i = 0; i < pattern_.keyframes.size(); ++i) {
        const auto& foot = pattern_.keyframes[i].feet[s];
        if (!foot || foot->rpy.head<2>().norm() > kNoAngle) continue;
        if (support_at(pattern_.keyframes[i].t) != on(other(side)) || !reaches_key(i)) continue;
        const Eigen::Vector3d way = from.inverse() * foot->position;
        if (way.z() < kNoLength) continue;
        // The hip moves with the COG, which is above the foot that stands.
        const double t = pattern_.keyframes[i].t;
        Eigen::Vector3d moved = feet_->support_center(t) - feet_->support_center(0);
        if (!has_cog_height()) moved.z() += way.z() / 2;
        const Eigen::Vector3d leg = way - hip - from.linear().transpose() * moved;
        const auto lean = [&](double across) {
          return std::clamp(elementary::atan2(across, -leg.z()), -kMostLean, kMostLean);
        };
        leans.push_back({i, lean(leg.y()), -lean(leg.x())});
      }
      if (leans.empty()) continue;
      const auto most = [&](const auto& amount) {
        return *std::max_element(leans.begin(), leans.end(), [&](const Lean& a, const Lean& b) {
          return std::abs(amount(a)) < std::abs(amount(b));
        });
      };
      const Lean widest = most([](const Lean&lean) { return lean.roll; }),
                 longest = most([](const Lean&lean) { return lean.pitch; });
      for (const auto& [roll, pitch] : {std::pair(true, false), {false, true}, {true, true}}) {
        if ((roll && std::abs(widest.roll) < kNotedLean) ||
            (pitch && std::abs(longest.pitch) < kNotedLean))
          continue;
        const size_t place = pitch ? longest.key : widest.key;
        const auto size = [](double lean) {
          return text::fixed(std::abs(lean) * 180 / std::numbers::pi, 0) + " deg";
        };
        std::vector<std::string> ways;
        if (roll) ways.push_back(size(widest.roll) + " to the side");
        if (pitch) ways.push_back(size(longest.pitch) + (longest.pitch < 0 ? " ahead" : " back"));
        for (const double share : {1.0, 0.6}) {
          const auto turn = [roll, pitch, share](const Lean& lean) {
            return Eigen::Vector2d(roll ? whole_degrees(share * lean.roll) : 0,
                                   pitch ? whole_degrees(share * lean.pitch) : 0);
          };
          std::string here, others;
          size_t more = 0;
          for (const Lean& lean : leans) {
            const Eigen::Vector2d by = turn(lean);
            const std::string turned =
                turned_foot(side, pattern_.keyframes[lean.key].feet[s].value(), by.x(), by.y());
            if (lean.key == place)
              here = turned;
            else if (!by.isZero() && ++more <= kTurnedKeys)
              others += "; in " + key_place(lean.key) + ", " + turned;
          }
          if (more > kTurnedKeys) others += "; in its later keys, by the lean of the leg there";
          made.push_back(
              {Rank::geometry,
               {key_place(place),
                std::string("the ") + name_of(side) + " foot stays level while its leg leans by " +
                    text::join(ways, " and ") + ", so the ankle bends by the same angle",
                "with the foot turned with the leg (" + here + others + "),"},
               [leans, turn, s](Pattern& p) {
                 for (const Lean& lean : leans)
                   p.keyframes[lean.key].feet[s]->rpy.head<2>() = turn(lean);
               },
               roll && pitch ? 1.0 : 0.0});
        }
      }
    }
  }

  void starts(std::vector<Hypothesis>& made) const {
    if (!pattern_.start_feet[0] || !pattern_.start_feet[1]) return;
    made.push_back(
        {Rank::exchange,
         {"/start", "the left and the right foot were perhaps exchanged", "with the two exchanged"},
         [](Pattern& p) { std::swap(p.start_feet[0], p.start_feet[1]); }});
  }

  Support support_at(double t) const {
    for (const Phase& phase : pattern_.phases)
      if (t <= phase.until) return phase.support;
    return Support::both;
  }

  void key_sides(std::vector<Hypothesis>& made) const {
    std::optional<MirrorMap> map;
    try {
      map = mirror_map(model_);
    } catch (const Error&) {  // the robot has no mirror image
    }
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i) {
      const Keyframe& key = pattern_.keyframes[i];
      if (!reaches_key(i)) continue;
      for (const Side side : {Side::left, Side::right}) {
        const auto s = static_cast<size_t>(index(side)), o = 1 - s;
        if (!key.feet[s] || key.feet[o] || support_at(key.t) != on(side)) continue;
        made.push_back(
            {Rank::exchange,
             {key_place(i),
              std::string("the key moves the ") + name_of(side) +
                  " foot, which carries the robot; perhaps left and right were exchanged",
              std::string("with the ") + name_of(other(side)) + " foot in its place"},
             [i, s, o](Pattern& p) { std::swap(p.keyframes[i].feet[s], p.keyframes[i].feet[o]); }});
      }
      if (key.feet[0] && key.feet[1])
        made.push_back(
            {Rank::exchange,
             {key_place(i), "the left and the right foot were perhaps exchanged",
              "with the two exchanged"},
             [i](Pattern& p) { std::swap(p.keyframes[i].feet[0], p.keyframes[i].feet[1]); }});
      if (!map || key.joints.empty()) continue;
      // Whether no other key moves the joints of this key.
      const bool is_alone = std::none_of(
          pattern_.keyframes.begin(), pattern_.keyframes.end(), [&](const Keyframe& k) {
            return &k != &key &&
                   std::any_of(key.joints.begin(), key.joints.end(),
                               [&](const auto& e) { return k.joints.contains(e.first); });
          });
      made.push_back(
          {is_alone ? Rank::slip : Rank::sign,
           {key_place(i),
            "the key moves " + key.joints.begin()->first +
                (key.joints.size() > 1 ? " and others" : "") +
                "; perhaps left and right were exchanged",
            "with keys for the joints of the other side"},
           [this, i, map](Pattern& p) {
             std::map<std::string, double> joints;
             for (const auto& [joint, angle] : p.keyframes[i].joints) {
               const int dof = model_.find_dof(joint);
               joints[dof < 0
                          ? joint
                          : model_.dofs()[static_cast<size_t>(map->dof[static_cast<size_t>(dof)])]
                                .name] = angle;
             }
             p.keyframes[i].joints = joints;
           }});
    }
  }

  // Where most joints of the two sides are mirror images of each other, one that is not may be
  // wrong. Tries the mirror image of its partner, for each of the two.
  void unlike_sides(std::vector<Hypothesis>& made) const {
    std::optional<MirrorMap> map;
    try {
      map = mirror_map(model_);
    } catch (const Error&) {  // the robot has no mirror image
      return;
    }
    using Joints = std::map<std::string, double>;
    const auto look = [&](const std::string& place, const Joints& joints,
                          const std::function<Joints&(Pattern&)>& in) {
      struct Pair {
        std::string wrong, partner;
        double angle = 0, meant = 0;
      };
      std::vector<Pair> unlike;
      size_t alike = 0;
      for (const auto& [joint, angle] : joints) {
        const int dof = model_.find_dof(joint);
        if (dof < 0) continue;
        const auto d = static_cast<size_t>(dof);
        const std::string partner = model_.dofs()[static_cast<size_t>(map->dof[d])].name;
        const auto found = joints.find(partner);
        if (partner == joint || found == joints.end()) continue;
        const double meant = map->sign[d] * found->second;
        if (std::abs(meant - angle) < kNoAngle)
          ++alike;
        else
          unlike.push_back({joint, partner, angle, meant});
      }
      // Both joints of a pair are unlike.
      if (unlike.size() != 2 || alike < unlike.size()) return;
      for (const Pair& pair : unlike)
        made.push_back({Rank::exchange,
                        {place,
                         pair.wrong + " (" + this->angle(pair.angle) + ") and " + pair.partner +
                             " (" + this->angle(joints.at(pair.partner)) +
                             ") are not mirror images; all other pairs of joints in this posture "
                             "are",
                         "with " + pair.wrong + " at " + this->angle(pair.meant)},
                        [in, pair](Pattern& p) { in(p).at(pair.wrong) = pair.meant; }});
    };
    for (const auto& [name, joints] : pattern_.postures)
      look("/postures/" + json_pointer_token(name), joints,
           [name = name](Pattern& p) -> Joints& { return p.postures.at(name); });
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i)
      if (reaches_key(i))
        look(key_place(i), pattern_.keyframes[i].joints,
             [i](Pattern& p) -> Joints& { return p.keyframes[i].joints; });
  }

  // ---- the ground

  // Feet that stand above the ground or in it. Tries the height of the ground for the first ones
  // that may cause the errors, and for all of them together: stairs that the world does not declare
  // raise the foot of each step.
  void ground_heights(std::vector<Hypothesis>& made) const {
    if (!feet_) return;
    const std::vector<RaisedFoot> raised = raised_feet(model_, pattern_, *feet_);
    size_t alone = 0;
    for (const RaisedFoot& foot : raised)
      if (alone < kRaisedAlone && reaches(static_cast<size_t>(feet_->phase(foot.begin)))) {
        made.push_back({Rank::geometry, {foot.place, foot.words, foot.instead}, foot.mend});
        ++alone;
      }
    const auto is_relative = [](const RaisedFoot& foot) { return foot.relative; };
    if (alone == 0 || raised.size() == 1 || std::any_of(raised.begin(), raised.end(), is_relative))
      return;
    made.push_back({Rank::geometry,
                    {raised.front().place,
                     raised.front().words + "; this is the first of " +
                         std::to_string(raised.size()) + " such heights",
                     "with all of them on the declared ground"},
                    [raised](Pattern& p) {
                      for (const RaisedFoot& foot : raised) foot.mend(p);
                    }});
  }

  // ---- missing or superfluous parts

  bool has_foot_key(Side side, double begin, double end) const {
    return std::any_of(pattern_.keyframes.begin(), pattern_.keyframes.end(),
                       [&](const Keyframe& key) {
                         return key.t >= begin - 1e-9 && key.t <= end + 1e-9 &&
                                key.feet[static_cast<size_t>(index(side))];
                       });
  }

  void swings(std::vector<Hypothesis>& made) const {
    if (!feet_) return;
    for (size_t i = 0; i < pattern_.phases.size(); ++i) {
      const Phase& phase = pattern_.phases[i];
      if (phase.swing || phase.viip || !is_single(phase.support)) continue;
      const Side idle = other(stance_of(phase.support));
      if (has_foot_key(idle, begin_of(i), phase.until)) continue;
      // The new foothold is ahead by half the length of the other foot's next step, or beside the
      // other foot if there is no such step.
      RelativeStep step;
      const Eigen::Isometry3d stance = feet_->pose(other(idle), phase.until);
      for (size_t k = i + 1; k < pattern_.phases.size(); ++k)
        if (pattern_.phases[k].swing && pattern_.phases[k].swing->foot == other(idle)) {
          const Eigen::Vector3d way =
              stance.inverse() * feet_->pose(other(idle), pattern_.phases[k].until).translation();
          step.forward = 0.5 * way.x();
          break;
        }
      double lift = Swing{}.lift;
      for (const Phase& like : pattern_.phases)
        if (like.swing) lift = like.swing->lift;
      made.push_back({Rank::missing,
                      {phase_place(i),
                       std::string("the robot stands on the ") + name_of(other(idle)) +
                           " foot alone, but the " + name_of(idle) +
                           " foot stays on the ground; its swing may be missing",
                       "with a swing to a place " + text::brief(step.forward, 3) +
                           " m ahead of the other foot"},
                      [i, idle, lift, step](Pattern& p) {
                        p.phases[i].swing =
                            Swing{.foot = idle, .to = {}, .lift = lift, .step = step};
                      }});
    }
  }

  void double_supports(std::vector<Hypothesis>& made) const {
    for (size_t i = 1; i < pattern_.phases.size(); ++i) {
      const Phase &before = pattern_.phases[i - 1], &phase = pattern_.phases[i];
      if (!is_single(phase.support) || before.support != opposite(phase.support)) continue;
      if (!reaches(i) && !reaches(i - 1)) continue;
      double until = before.until + kDoubleSupport * (phase.until - before.until);
      for (const Keyframe& key : pattern_.keyframes)
        if (key.zmp && key.t > before.until + 1e-9 && key.t < phase.until - 1e-9) {
          until = key.t;
          break;
        }
      made.push_back(
          {Rank::missing,
           {phase_place(i),
            std::string("the robot passes from the ") + name_of(before.support) + " foot to the " +
                name_of(phase.support) +
                " foot at once; a phase with support \"both\" may be missing before this phase",
            "with such a phase until " + seconds(until)},
           [i, until](Pattern& p) {
             Phase both;
             both.until = until;
             p.phases.insert(p.phases.begin() + static_cast<long>(i), both);
           }});
    }
  }

  bool is_leg_joint(const std::string& joint) const {
    const int dof = model_.find_dof(joint);
    for (const Side side : {Side::left, Side::right}) {
      const std::vector<int>& leg = model_.leg(side);
      if (dof >= 0 && std::find(leg.begin(), leg.end(), dof) != leg.end()) return true;
    }
    return false;
  }

  void leg_keys(std::vector<Hypothesis>& made) const {
    if (!model_.has_soles()) return;
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i)
      for (const auto& entry : pattern_.keyframes[i].joints) {
        if (!is_leg_joint(entry.first)) continue;
        made.push_back(
            {Rank::missing,
             {key_place(i),
              entry.first +
                  " is a joint of a leg. As soon as one leg joint has a key, all leg joints follow "
                  "only their keys, and the legs are not solved from the feet and the COG",
              "without keys of leg joints (give the COG, the feet or the torso instead)"},
             [this](Pattern& p) {
               for (Keyframe& key : p.keyframes)
                 std::erase_if(key.joints, [&](const auto& e) { return is_leg_joint(e.first); });
             }});
        return;
      }
  }

  // Keys of one quantity that contradict the others: f_z follows from the COG height, the ZMP from
  // the COG, and the COG in a flight from its ends. Tries the pattern without these keys.
  void superfluous_keys(std::vector<Hypothesis>& made) const {
    const auto& keys = pattern_.keyframes;
    const auto first = [&](const auto& has) {
      return static_cast<size_t>(std::find_if(keys.begin(), keys.end(), has) - keys.begin());
    };
    const auto add = [&](size_t key, const std::string& written, const std::string& instead,
                         Mend mend) {
      // Leaving out a key hides any wrong number in it. So this comes after all corrections of
      // numbers, and before the other changes of Rank::pace.
      made.push_back({Rank::pace, {key_place(key), written, instead}, std::move(mend), -1});
      made.back().only_if_enough = true;
    };
    if (const size_t k = first([](const Keyframe& key) { return key.fz.has_value(); });
        k < keys.size())
      add(k,
          "f_z is " + text::brief(*keys[k].fz) +
              " N, but the force follows from the weight and from the movement of the COG",
          "without keys of f_z", [](Pattern& p) {
            for (Keyframe& key : p.keyframes) key.fz.reset();
          });
    const size_t cog = first([](const Keyframe& key) { return key.cog_x || key.cog_y; });
    const size_t zmp = first([](const Keyframe& key) { return key.zmp.has_value(); });
    if (cog < keys.size() && zmp < keys.size()) {
      const std::string both = "both the COG (" + key_place(cog) + ") and the ZMP (" +
                               key_place(zmp) +
                               ") have keys, but one of them follows from the other";
      add(zmp, both, "without keys of the ZMP", [](Pattern& p) {
        for (Keyframe& key : p.keyframes) key.zmp.reset();
      });
      add(cog, both, "without keys of the COG's x and y", [](Pattern& p) {
        for (Keyframe& key : p.keyframes) {
          key.cog_x.reset();
          key.cog_y.reset();
        }
      });
    }
    const auto is_inside = [&](const Keyframe& key) {
      return (key.cog_x || key.cog_y || key.cog_height) && flies(key.t) && !is_at_end(key.t);
    };
    if (const size_t k = first(is_inside); k < keys.size())
      add(k,
          "the COG has a key at " + seconds(keys[k].t) +
              ", inside a flight, where it can only follow its parabola",
          "without keys of the COG inside the flight", [this, is_inside](Pattern& p) {
            for (Keyframe& key : p.keyframes)
              if (is_inside(key)) {
                key.cog_x.reset();
                key.cog_y.reset();
                key.cog_height.reset();
              }
          });
  }

  void interpolations(std::vector<Hypothesis>& made) const {
    const auto jumps = [](Interpolation i) {
      return i == Interpolation::hold || i == Interpolation::linear;
    };
    const auto add = [&](const std::string& place, Interpolation now, const Mend& mend) {
      made.push_back({Rank::missing,
                      {place,
                       std::string("interpolation \"") + name_of(now) + "\" makes " +
                           (now == Interpolation::hold ? "the angle jump" : "the speed jump"),
                       "with \"minimum_jerk\""},
                      mend});
    };
    if (jumps(pattern_.interpolation))
      add("/defaults/interpolation", pattern_.interpolation,
          [](Pattern& p) { p.interpolation = Interpolation::minimum_jerk; });
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i)
      if (const auto& own = pattern_.keyframes[i].interpolation;
          own && jumps(*own) && reaches_key(i))
        add(key_place(i), *own,
            [i](Pattern& p) { p.keyframes[i].interpolation = Interpolation::minimum_jerk; });
  }

  // The COG keeps its height above the mean of both soles, and a lifted foot raises this mean by
  // half of its lift.
  void level_cog(std::vector<Hypothesis>& made) const {
    if (has_cog_height()) return;
    size_t highest = 0;
    double lift = 0;
    Side lifted = Side::left;
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i)
      for (const Side side : {Side::left, Side::right})
        if (const auto& foot = pattern_.keyframes[i].feet[static_cast<size_t>(index(side))];
            foot && foot->position.z() > lift) {
          lift = foot->position.z();
          lifted = side;
          highest = i;
        }
    if (lift <= 0) return;
    for (const double share : {1.0, 0.99, 0.97, 0.94}) {
      const double height = std::round(1e4 * share * default_cog_height(model_, pattern_)) / 1e4;
      made.push_back(
          {Rank::missing,
           {key_place(highest),
            std::string("the ") + name_of(lifted) + " foot is " + text::fixed(1000 * lift, 0) +
                " mm up, and the COG rises by half of this height, because the COG height without "
                "keys is measured from the mean height of both soles",
            "with keys of \"cog\": {\"height\": " + text::brief(height) +
                "}, which keep the COG down,"},
           [height](Pattern& p) {
             for (Keyframe& key : p.keyframes) key.cog_height = height;
           }});
    }
  }

  // If keys hold the COG at a place that the feet have left, tries the pattern without these keys.
  void held_cog(std::vector<Hypothesis>& made) const {
    if (!feet_) return;
    for (const auto& [axis, key_of] : {std::pair(0, &Keyframe::cog_x), {1, &Keyframe::cog_y}}) {
      const double before = feet_->support_center(0)[axis];
      size_t worst = 0;
      double most = 0, feet_at = 0;
      for (size_t i = 0; i < pattern_.keyframes.size(); ++i) {
        const Keyframe& key = pattern_.keyframes[i];
        if (!(key.*key_of)) continue;
        const double center = feet_->support_center(key.t)[axis];
        const double off = std::abs(*(key.*key_of) - center);
        // Only keys that lag behind the feet count, that is, keys that are nearer to the first
        // place of the feet than to their present place.
        if (off <= most || std::abs(*(key.*key_of) - before) >= off) continue;
        most = off;
        feet_at = center;
        worst = i;
      }
      if (most < kNotedOffset * leg_length(model_)) continue;
      const std::string words = axis == 0 ? "the COG's x" : "the COG's y";
      made.push_back({Rank::missing,
                      {key_place(worst),
                       words + " is " + text::brief(*(pattern_.keyframes[worst].*key_of)) +
                           " m, while the middle of the feet that stand is at " +
                           text::brief(feet_at, 3) + " m",
                       "without keys of " + words + " (the COG then follows the ZMP)"},
                      [key_of = key_of](Pattern& p) {
                        for (Keyframe& key : p.keyframes) (key.*key_of).reset();
                      }});
    }
  }

  // The nearer a leg is to straight, the quicker its knee turns at the same speed of the COG. Tries
  // a lower COG at both ends of every flight whose take-off or landing is with rather straight
  // legs.
  void lower_take_offs(std::vector<Hypothesis>& made) const {
    if (!model_.has_soles()) return;
    const std::vector<size_t> keys = height_keys();
    std::vector<size_t> lower;  // keys at ends of flights
    std::optional<size_t> first;
    for (size_t i = 1; i < pattern_.phases.size(); ++i) {
      const std::optional<size_t> off = key_of_lift_off(keys, i);
      if (!off || !reaches(i - 1)) continue;
      const double highest = std::max(*pattern_.keyframes[keys[*off]].cog_height,
                                      *pattern_.keyframes[keys[*off + 1]].cog_height);
      if (leg_share(highest) < kStraightTakeOff) continue;
      if (!first) first = *off;
      lower.insert(lower.end(), {keys[*off], keys[*off + 1]});
    }
    if (!first) return;
    const size_t k = keys[*first];
    const double leaves = *pattern_.keyframes[k].cog_height,
                 lands = *pattern_.keyframes[keys[*first + 1]].cog_height;
    const bool off = leaves >= lands;  // the end at which the legs are straighter
    const double bend = 2 * elementary::acos(std::min(1.0, leg_share(std::max(leaves, lands)))) *
                        180 / std::numbers::pi;
    for (const double share : kLowerTakeOffs) {
      const double by = std::round(1e3 * share * leg_length(model_)) / 1e3;
      made.push_back(
          {Rank::pace,
           {key_place(off ? k : keys[*first + 1]),
            "the COG height is " + text::brief(std::max(leaves, lands)) + " m at the " +
                (off ? "lift-off" : "landing") + ", where the knees are bent by only about " +
                text::fixed(bend, 0) + " deg; the knee of an almost straight leg turns very fast",
            "with " + text::brief(leaves - by) + " m at the lift-off and " +
                text::brief(lands - by) + " m at the landing" +
                (lower.size() > 2 ? ", and with a COG height that is lower by the same amount "
                                    "at the ends of the other flights with straight legs,"
                                  : "")},
           [lower, by](Pattern& p) {
             for (const size_t key : lower) *p.keyframes[key].cog_height -= by;
           }});
      made.back().only_if_enough = true;
    }
  }

  // Distance between hip and sole in the home posture, with the COG at this height, as a share of
  // the straight leg.
  double leg_share(double cog_height) const {
    return (home_reach(model_) + cog_height - default_cog_height(model_, {})) / leg_length(model_);
  }

  // If the ZMP still moves shortly before the end of the motion, or moves at once at its beginning,
  // the COG cannot be at rest above it there. Tries a motion that rests longer.
  void rests(std::vector<Hypothesis>& made) const {
    std::vector<size_t> keys;
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i)
      if (pattern_.keyframes[i].zmp) keys.push_back(i);
    const auto moves = [&](size_t k) {  // the ZMP moves between key k - 1 and key k
      const ZmpKey &from = *pattern_.keyframes[keys[k - 1]].zmp,
                   &to = *pattern_.keyframes[keys[k]].zmp;
      return from.place != to.place ||
             (from.place == ZmpKey::Place::point && (from.point - to.point).norm() > kNoLength);
    };
    if (pattern_.phases.empty() || !model_.has_soles()) return;
    const double constant = std::sqrt(default_cog_height(model_, pattern_) / kGravity);
    const double end = pattern_.duration();
    const auto rest = [&](double share) {
      return std::ceil(share * constant * kRestsPerSecond) / kRestsPerSecond;
    };
    const auto add = [&](size_t k, const std::string& written, const auto& instead,
                         const std::function<void(Pattern&, double)>& mend) {
      for (const double share : kRests) {
        const double more = rest(share);
        made.push_back({Rank::missing,
                        {key_place(keys[k]), written, instead(seconds(more))},
                        [mend, more](Pattern& p) { mend(p, more); },
                        share});
      }
    };
    for (size_t k = keys.size(); k-- > 1;) {
      if (!moves(k)) continue;
      const double from = pattern_.keyframes[keys[k - 1]].t, until = pattern_.keyframes[keys[k]].t;
      if (end - until > kShortRest * constant || !found_.touches(from - kRestReach * constant, end))
        break;
      const bool longer = pattern_.phases.back().support == Support::both &&
                          !is_repeated(pattern_, pattern_.phases.back().pointer);
      add(
          k,
          "the ZMP reaches its last place at " + seconds(until) + ", and the motion ends at " +
              seconds(end) + ", so the COG has too little time to come to rest above the ZMP",
          [longer](const std::string& more) {
            return longer ? "with a last phase that is " + more + " longer"
                          : "with one more phase with support \"both\" at the end, which lasts " +
                                more + ",";
          },
          [longer](Pattern& p, double more) {
            Phase both;
            both.until = p.duration() + more;
            if (longer)
              p.phases.back().until = both.until;
            else
              p.phases.push_back(both);
          });
      break;
    }
    for (size_t k = 1; k < keys.size(); ++k) {
      if (!moves(k)) continue;
      const double from = pattern_.keyframes[keys[k - 1]].t, until = pattern_.keyframes[keys[k]].t;
      if (from > kShortRest * constant || !found_.touches(0, until + kRestReach * constant)) break;
      add(
          k,
          "the ZMP leaves its first place at " + seconds(from) +
              ", so the COG has too little time to begin its movement from rest",
          [](const std::string& more) { return "with all times " + more + " later"; },
          [](Pattern& p, double more) {
            for (Phase& phase : p.phases) phase.until += more;
            for (Keyframe& key : p.keyframes) key.t += more;
            for (Disturbance& disturbance : p.scenario) disturbance.at += more;
          });
      break;
    }
  }

  // The length of a flight determines how high the robot rises, and how fast it is at both ends.
  void shorter_flights(std::vector<Hypothesis>& made) const {
    struct Flight {
      double begin, end, factor;
    };
    // With the last share, the robot rises half as high.
    for (const double share : {0.9, 0.8, 0.7}) {
      std::vector<Flight> flights;
      size_t first = 0;
      double lasts = 0, shorter = 0;  // the first flight [s]
      for (size_t i = 0; i < pattern_.phases.size(); ++i) {
        if (pattern_.phases[i].support != Support::none) continue;
        const double begin = begin_of(i), end = pattern_.phases[i].until;
        const double now = std::round(1e3 * share * (end - begin)) / 1e3;  // as it is written
        if (flights.empty()) {
          first = i;
          lasts = end - begin;
          shorter = now;
        }
        flights.push_back({begin, end, now / (end - begin)});
      }
      if (flights.empty() || shorter <= 0) return;
      const bool one = flights.size() == 1;
      made.push_back(
          {Rank::pace,
           {phase_place(first),
            (one ? "the flight lasts " : "the first flight lasts ") + seconds(lasts) +
                ", in which the robot rises by " +
                text::fixed(1e3 * kGravity * lasts * lasts / 8, 0) + " mm",
            one ? "with a flight of " + seconds(shorter) + ", and everything after the flight " +
                      seconds(lasts - shorter) + " earlier"
                : "with " + text::brief(share) +
                      " times the length of every flight, and everything after a flight earlier"},
           [this, flights](Pattern& p) {
             for (auto flight = flights.rbegin(); flight != flights.rend(); ++flight)
               p = stretched(model_, p, flight->begin, flight->end, flight->factor);
           }});
    }
  }

  // The COG may be too high or too low. If the legs are folded, tries heights nearer to the COG
  // height of the home posture; if they are nearly straight, tries lower heights.
  void cog_height(std::vector<Hypothesis>& made) const {
    const double height = default_cog_height(model_, pattern_);
    if (legs_are_folded(model_, pattern_, height)) {
      const double home = home_cog_height(model_, pattern_);
      for (const double share : {0.97, 0.94, 0.9, 0.85, 0.75})
        made.push_back({Rank::amount,
                        {"/defaults/cog_height",
                         "the COG height is " + text::brief(height) + " m, " +
                             text::fixed(100 * height / home, 0) + " % of that of the home posture",
                         "with " + text::brief(share * home, 3) + " m"},
                        [higher = share * home](Pattern& p) { p.cog_height = higher; }});
      return;
    }
    for (const double share : {0.99, 0.97, 0.94, 0.9, 0.85})
      made.push_back({Rank::pace,
                      {"/defaults/cog_height",
                       "the COG height is " + text::brief(height) +
                           " m, at which the legs are nearly straight",
                       "with " + text::brief(share * height, 3) + " m"},
                      [lower = share * height](Pattern& p) { p.cog_height = lower; }});
  }

  const RobotModel& model_;
  const Pattern& pattern_;
  const TrialOutcome& found_;
  std::vector<WrittenValue> values_;
  std::optional<FootPlan> feet_ = {};
  std::vector<double> ends_;      // of the phases, sorted [s]
  std::vector<double> contacts_;  // of the keys for which is_of_contact(), sorted [s]
};

Hypotheses::Hypotheses(const RobotModel& model, const Pattern& pattern, const TrialOutcome& found)
    : maker_(std::make_unique<Maker>(model, pattern, found)) {}

Hypotheses::~Hypotheses() = default;

const std::vector<WrittenValue>& Hypotheses::values() const { return maker_->values(); }

std::vector<Hypothesis> Hypotheses::of(Kind kind) const {
  switch (kind) {
    case Kind::units:
      return maker_->units();
    case Kind::times:
      return maker_->times();
    case Kind::irregular:
      return maker_->irregular();
    case Kind::exchanges:
      return maker_->exchanges();
    case Kind::missing:
      return maker_->missing();
    case Kind::nearer:
      return maker_->nearer();
    case Kind::paces:
      return maker_->paces();
    case Kind::small_swings:
      return maker_->small_swings();
  }
  return {};
}

}  // namespace ayumi
