#include "ayumi/check/hypotheses/cog_hypotheses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <tuple>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/quintic.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/folded_legs.hpp"

namespace ayumi::hypotheses {

namespace {

// A COG that is farther than this from the middle of the feet is not above them; the bound is a
// share of the length of a leg. Chosen: more than half of a sole.
constexpr double kNotedOffset = 0.25;
// The COG may sink below its lowest key before a lift-off or after a landing. If it sinks by less
// than this share of the stoop, the motion still counts as the one that the keys describe. Chosen:
// 3 mm for a stoop of 30 mm.
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
// Shares of the duration of a flight, and shares of the length of a leg by which the COG is lower
// at its ends, that are tried together. Chosen: with the smallest share the robot rises by a tenth;
// a joint that needs three times its largest speed is possible then.
constexpr std::array kSmallerHops = {0.8, 0.65, 0.5, 0.4, 0.3};
constexpr std::array kSmallerHopsLower = {0.0, 0.04, 0.08, 0.12};
// Smallest rise from the stoop to the lift-off that is tried, as a share of the length of a leg.
// Chosen: 5 mm for a leg of 0.25 m; with a smaller rise, the push would be a jerk.
constexpr double kLeastRise = 0.02;
// A motion begins and ends at rest, with the COG above the ZMP. If the ZMP moves less than this
// time after the beginning or before the end, the COG has too little time to start from rest or to
// come to rest. The time constant of the COG is sqrt(z/g), which is 0.16 s for HOAP-1. Derived:
// what is left of a movement after four time constants is 2 %.
constexpr double kShortRest = 4;
// Times of rest that are tried, in time constants of the COG. Chosen: up to the time in which the
// COG comes to rest, and half as much again.
constexpr std::array kRests = {2.0, 3.0, 4.0, 6.0};
// The planner moves ZMP keys near an end that has no rest. Such a change also affects the motion
// for this time before or after the movement of the ZMP, in time constants of the COG. Derived:
// e^-2 is 14 %.
constexpr double kRestReach = 2;
// Times of rest are named in whole multiples of a second divided by this number. Chosen: an author
// writes tenths of a second.
constexpr double kRestsPerSecond = 10;
// Number of bisection steps in the search for a time. Chosen: an interval of a second becomes a
// microsecond, and times are written in milliseconds.
constexpr int kHalvings = 20;

// The lowest height of a push that lasts `lasts` [s]: it begins at rest at height 0 and ends with
// a lift-off at height `rise` with this speed. A landing is the same motion backwards in time.
double lowest(double rise, double speed, double lasts) {
  double low = 0;
  for (int i = 1; i < kSinkPoints; ++i)
    low = std::min(
        low,
        quintic_at({0, 0, 0, 0}, {lasts, rise, speed, -kGravity}, lasts * i / kSinkPoints).value);
  return low;
}

// The longest duration of a push from rest to this lift-off in which the COG does not sink
// noticeably, at most `lasts` [s].
double longest_push(double rise, double speed, double lasts) {
  double possible = rise / speed, impossible = lasts;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (possible + impossible);
    (lowest(rise, speed, middle) < -kNotedSink * rise ? impossible : possible) = middle;
  }
  return possible;
}

// The keys that state the height of the COG.
std::vector<size_t> height_keys(const ExaminedPattern& of) {
  std::vector<size_t> keys;
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i)
    if (of.pattern.keyframes[i].cog_height) keys.push_back(i);
  return keys;
}

// The number, among these keys, of the key at the beginning of a flight, if the next one of them
// is at its end.
std::optional<size_t> key_of_lift_off(const ExaminedPattern& of, const std::vector<size_t>& keys,
                                      size_t phase) {
  const Phase& flight = of.pattern.phases[phase];
  if (flight.support != Support::none || flight.viip) return std::nullopt;
  const auto is_at = [&](size_t key, double t) {
    return std::abs(of.pattern.keyframes[key].t - t) < kSameInstant;
  };
  for (size_t k = 0; k + 1 < keys.size(); ++k)
    if (is_at(keys[k], of.begin_of(phase)))
      return is_at(keys[k + 1], flight.until) ? std::optional(k) : std::nullopt;
  return std::nullopt;
}

// Distance between hip and sole in the home posture, with the COG at this height, as a share of
// the straight leg.
double leg_share(const ExaminedPattern& of, double cog_height) {
  return (home_reach(of.model) + cog_height - default_cog_height(of.model, {})) /
         leg_length(of.model);
}

}  // namespace

// If the time between the lowest key and the lift-off, or between the landing and the lowest key,
// is too long, the COG sinks below that key, because its speed at the ground is that of the
// flight.
void stoops(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  const std::vector<size_t> keys = height_keys(of);
  for (size_t i = 1; i < of.pattern.phases.size(); ++i) {
    const std::optional<size_t> off = key_of_lift_off(of, keys, i);
    if (!off) continue;
    const double flight = of.pattern.phases[i].until - of.begin_of(i);
    const Keyframe &leaves = of.pattern.keyframes[keys[*off]],
                   &lands = of.pattern.keyframes[keys[*off + 1]];
    const double mean = (*lands.cog_height - *leaves.cog_height) / flight;
    // For each end of the flight: the neighbouring key outside the flight, the key at this end, and
    // the mean vertical speed of the flight. The sign of the speed is for a time that runs from the
    // first of these keys into the flight.
    std::vector<std::tuple<size_t, const Keyframe*, double>> sides;
    if (*off > 0) sides.emplace_back(keys[*off - 1], &leaves, mean);
    if (*off + 2 < keys.size()) sides.emplace_back(keys[*off + 2], &lands, -mean);
    for (const auto& [k, end, drift] : sides) {
      const Keyframe& low = of.pattern.keyframes[k];
      const double rise = *end->cog_height - *low.cog_height;
      const double speed = drift + kGravity * flight / 2, lasts = std::abs(end->t - low.t);
      if (of.is_repeated_key(k) || rise <= kNoLength || speed * lasts <= rise) continue;
      const double sink = -lowest(rise, speed, lasts);
      if (sink < kNotedSink * rise) continue;
      const bool before = low.t < end->t;
      const double push = longest_push(rise, speed, lasts);
      const double t = std::round(1000 * (before ? end->t - push : end->t + push)) / 1000;
      made.push_back(
          {Rank::geometry,
           {of.key_place(k),
            "t is " + seconds(low.t) + ", so the segment " +
                (before ? "from this key to the lift-off" : "from the landing to this key") +
                " lasts " + seconds(lasts) + ". The flight needs a COG speed of " +
                text::brief(speed, 2) + " m/s at its " + (before ? "beginning" : "end") +
                ". With this speed, the segment is so long that the COG sinks " +
                text::fixed(1000 * sink, 0) + " mm below the height of this key",
            "with t = " + seconds(t)},
           [k = k, t](Pattern& p) { p.keyframes[k].t = t; },
           -sink});
    }
  }
}

// The COG keeps its height above the mean of both soles, and a lifted foot raises this mean by
// half of its lift.
void level_cog(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (of.has_cog_height()) return;
  size_t highest = 0;
  double lift = 0;
  Side lifted = Side::left;
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i)
    for (const Side side : {Side::left, Side::right})
      if (const auto& foot = of.pattern.keyframes[i].feet[static_cast<size_t>(index(side))];
          foot && foot->position.z() > lift) {
        lift = foot->position.z();
        lifted = side;
        highest = i;
      }
  if (lift <= 0) return;
  for (const double share : {1.0, 0.99, 0.97, 0.94}) {
    const double height = std::round(1e4 * share * default_cog_height(of.model, of.pattern)) / 1e4;
    made.push_back({Rank::missing,
                    {of.key_place(highest),
                     std::string("the ") + name_of(lifted) + " foot is lifted by " +
                         text::fixed(1000 * lift, 0) +
                         " mm. The COG rises by half of this height, because without "
                         "keys the COG keeps its height above the mean of both soles",
                     "with keys of \"cog\": {\"height\": " + text::brief(height) +
                         "}, which keep the COG down,"},
                    [height](Pattern& p) {
                      for (Keyframe& key : p.keyframes) key.cog_height = height;
                    }});
  }
}

// If keys hold the COG at a place that the feet have left, tries the pattern without these keys.
void held_cog(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.feet) return;
  for (const auto& [axis, key_of] : {std::pair(0, &Keyframe::cog_x), {1, &Keyframe::cog_y}}) {
    const double before = of.feet->support_center(0)[axis];
    size_t worst = 0;
    double most = 0, feet_at = 0;
    for (size_t i = 0; i < of.pattern.keyframes.size(); ++i) {
      const Keyframe& key = of.pattern.keyframes[i];
      if (!(key.*key_of)) continue;
      const double center = of.feet->support_center(key.t)[axis];
      const double off = std::abs(*(key.*key_of) - center);
      // Only keys that lag behind the feet count, that is, keys that are nearer to the first
      // place of the feet than to their present place.
      if (off <= most || std::abs(*(key.*key_of) - before) >= off) continue;
      most = off;
      feet_at = center;
      worst = i;
    }
    if (most < kNotedOffset * leg_length(of.model)) continue;
    const std::string words = axis == 0 ? "the COG's x" : "the COG's y";
    made.push_back(
        {Rank::missing,
         {of.key_place(worst),
          words + " is " + text::brief(*(of.pattern.keyframes[worst].*key_of)) +
              " m, but the middle of the standing feet is at " + text::brief(feet_at, 3) + " m",
          "without keys of " + words + " (then the COG follows the ZMP)"},
         [key_of = key_of](Pattern& p) {
           for (Keyframe& key : p.keyframes) (key.*key_of).reset();
         }});
  }
}

// The nearer a leg is to straight, the quicker its knee turns at the same speed of the COG. Tries
// a lower COG at both ends of every flight whose take-off or landing is with rather straight
// legs.
void lower_take_offs(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.model.has_soles()) return;
  const std::vector<size_t> keys = height_keys(of);
  std::vector<size_t> lower;  // keys at ends of flights
  std::optional<size_t> first;
  for (size_t i = 1; i < of.pattern.phases.size(); ++i) {
    const std::optional<size_t> off = key_of_lift_off(of, keys, i);
    if (!off || !of.reaches(i - 1)) continue;
    const double highest = std::max(*of.pattern.keyframes[keys[*off]].cog_height,
                                    *of.pattern.keyframes[keys[*off + 1]].cog_height);
    if (leg_share(of, highest) < kStraightTakeOff) continue;
    if (!first) first = *off;
    lower.insert(lower.end(), {keys[*off], keys[*off + 1]});
  }
  if (!first) return;
  const size_t k = keys[*first];
  const double leaves = *of.pattern.keyframes[k].cog_height,
               lands = *of.pattern.keyframes[keys[*first + 1]].cog_height;
  const bool off = leaves >= lands;  // the end at which the legs are straighter
  const double bend = 2 * elementary::acos(std::min(1.0, leg_share(of, std::max(leaves, lands)))) *
                      180 / std::numbers::pi;
  for (const double share : kLowerTakeOffs) {
    const double by = std::round(1e3 * share * leg_length(of.model)) / 1e3;
    made.push_back(
        {Rank::pace,
         {of.key_place(off ? k : keys[*first + 1]),
          "the COG height is " + text::brief(std::max(leaves, lands)) + " m at the " +
              (off ? "lift-off" : "landing") + ", where the knees are bent by only about " +
              text::fixed(bend, 0) + " deg. The knee of an almost straight leg turns very fast",
          "with " + text::brief(leaves - by) + " m at the lift-off and " + text::brief(lands - by) +
              " m at the landing" +
              (lower.size() > 2
                   ? " (and a COG height that is lower by the same amount at both ends "
                     "of the other flights with straight legs),"
                   : "")},
         [lower, by](Pattern& p) {
           for (const size_t key : lower) *p.keyframes[key].cog_height -= by;
         }});
    made.back().only_if_enough = true;
  }
}

// If the ZMP still moves shortly before the end of the motion, or moves at once at its beginning,
// the COG cannot be at rest above it there. Tries a motion that rests longer.
void rests(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  std::vector<size_t> keys;
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i)
    if (of.pattern.keyframes[i].zmp) keys.push_back(i);
  const auto moves = [&](size_t k) {  // the ZMP moves between key k - 1 and key k
    const ZmpKey &from = *of.pattern.keyframes[keys[k - 1]].zmp,
                 &to = *of.pattern.keyframes[keys[k]].zmp;
    return from.place != to.place ||
           (from.place == ZmpKey::Place::point && (from.point - to.point).norm() > kNoLength);
  };
  if (of.pattern.phases.empty() || !of.model.has_soles()) return;
  const double constant = std::sqrt(default_cog_height(of.model, of.pattern) / kGravity);
  const double end = of.pattern.duration();
  const auto rest = [&](double share) {
    return std::ceil(share * constant * kRestsPerSecond) / kRestsPerSecond;
  };
  const auto add = [&](size_t k, const std::string& written, const auto& instead,
                       const std::function<void(Pattern&, double)>& mend) {
    for (const double share : kRests) {
      const double more = rest(share);
      made.push_back({Rank::missing,
                      {of.key_place(keys[k]), written, instead(seconds(more))},
                      [mend, more](Pattern& p) { mend(p, more); },
                      share});
    }
  };
  for (size_t k = keys.size(); k-- > 1;) {
    if (!moves(k)) continue;
    const double from = of.pattern.keyframes[keys[k - 1]].t,
                 until = of.pattern.keyframes[keys[k]].t;
    if (end - until > kShortRest * constant || !of.found.touches(from - kRestReach * constant, end))
      break;
    const bool longer = of.pattern.phases.back().support == Support::both &&
                        !is_repeated(of.pattern, of.pattern.phases.back().pointer);
    add(
        k,
        "the ZMP reaches its last place at " + seconds(until) + ", and the motion ends at " +
            seconds(end) + ". The COG has too little time to come to rest above the ZMP",
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
    const double from = of.pattern.keyframes[keys[k - 1]].t,
                 until = of.pattern.keyframes[keys[k]].t;
    if (from > kShortRest * constant || !of.found.touches(0, until + kRestReach * constant)) break;
    add(
        k,
        "the ZMP leaves its first place at " + seconds(from) +
            ". The COG has too little time to begin its movement from rest",
        [](const std::string& more) { return "with all times " + more + " later"; },
        [](Pattern& p, double more) {
          for (Phase& phase : p.phases) phase.until += more;
          for (Keyframe& key : p.keyframes) key.t += more;
          for (Disturbance& disturbance : p.scenario) disturbance.at += more;
        });
    break;
  }
}

void missing_flight_keys(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  for (size_t i = 1; i < of.pattern.phases.size(); ++i) {
    const Phase& flight = of.pattern.phases[i];
    if (flight.support != Support::none || flight.viip) continue;
    const double ends[] = {of.begin_of(i), flight.until};
    std::optional<double> heights[2];
    for (const size_t k : height_keys(of))
      for (int end = 0; end < 2; ++end)
        if (std::abs(of.pattern.keyframes[k].t - ends[end]) < kSameInstant)
          heights[end] = of.pattern.keyframes[k].cog_height;
    if (heights[0].has_value() == heights[1].has_value()) continue;
    const int missing = heights[0] ? 1 : 0;
    const double height = *heights[1 - missing];
    const char* names[] = {"lift-off", "landing"};
    made.push_back(
        {Rank::missing,
         {of.phase_place(i),
          std::string("no keyframe gives the COG height at the ") + names[missing] + " (" +
              seconds(ends[missing]) + "). The height at the " + names[1 - missing] + " is " +
              text::brief(height) + " m",
          "with a key of the same height there"},
         [t = ends[missing], height](Pattern& p) { keyframe_at(p, t).cog_height = height; }});
  }
}

// The length of a flight determines how high the robot rises, and how fast it is at both ends.
void shorter_flights(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  struct Flight {
    double begin, end, factor;
  };
  // With the last share, the robot rises half as high.
  for (const double share : {0.9, 0.8, 0.7}) {
    std::vector<Flight> flights;
    size_t first = 0;
    double lasts = 0, shorter = 0;  // the first flight [s]
    for (size_t i = 0; i < of.pattern.phases.size(); ++i) {
      if (of.pattern.phases[i].support != Support::none) continue;
      const double begin = of.begin_of(i), end = of.pattern.phases[i].until;
      const double now = std::round(1e3 * share * (end - begin)) / 1e3;  // rounded to 1 ms
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
         {of.phase_place(first),
          (one ? "the flight lasts " : "the first flight lasts ") + seconds(lasts) +
              ", in which the robot rises by " +
              text::fixed(1e3 * kGravity * lasts * lasts / 8, 0) + " mm",
          one ? "with a flight of " + seconds(shorter) + ", and everything after the flight " +
                    seconds(lasts - shorter) + " earlier"
              : "with every flight shortened to " + text::brief(share) +
                    " times its length, and everything after a flight earlier"},
         [&of, flights](Pattern& p) {
           for (auto flight = flights.rbegin(); flight != flights.rend(); ++flight)
             p = stretched(of.model, p, flight->begin, flight->end, flight->factor);
         }});
  }
}

// Weak motors allow only a flight that is shorter, from legs that are bent more, after a push that
// is as long as the new speed needs. One of these changes alone may help little. Tries all of them
// together, the longest flight first.
void smaller_hops(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.model.has_soles()) return;
  struct Flight {
    double begin = 0, end = 0;
    size_t before = 0, off = 0, land = 0, after = 0;  // keys: stoop, lift-off, landing, stoop
  };
  const std::vector<size_t> keys = height_keys(of);
  std::vector<Flight> flights;
  for (size_t i = 1; i < of.pattern.phases.size(); ++i) {
    if (of.pattern.phases[i].support != Support::none) continue;
    const std::optional<size_t> off = key_of_lift_off(of, keys, i);
    if (!off || *off == 0 || *off + 2 >= keys.size()) return;
    flights.push_back({of.begin_of(i), of.pattern.phases[i].until, keys[*off - 1], keys[*off],
                       keys[*off + 1], keys[*off + 2]});
    if (of.is_repeated_key(keys[*off - 1]) || of.is_repeated_key(keys[*off + 2])) return;
  }
  if (flights.empty()) return;
  const double leg = leg_length(of.model);
  const Flight& first = flights.front();
  const double lasts = first.end - first.begin;
  for (const double share : kSmallerHops) {
    const double shorter = std::round(1e3 * share * lasts) / 1e3;
    const double speed = kGravity * shorter / 2;
    for (const double lower : kSmallerHopsLower) {
      const double by = std::round(1e3 * lower * leg) / 1e3;
      const auto rise_to = [&](size_t end, size_t low) {
        return *of.pattern.keyframes[end].cog_height - by - *of.pattern.keyframes[low].cog_height;
      };
      const bool possible = std::all_of(flights.begin(), flights.end(), [&](const Flight& f) {
        return std::min(rise_to(f.off, f.before), rise_to(f.land, f.after)) > kLeastRise * leg;
      });
      if (!possible) continue;
      // The longest push from the stoop, and the longest landing into it [s].
      // The change outlives this loop, so it has its own copy of the speed.
      const auto push = [speed](double rise) {
        return std::round(1e3 * longest_push(rise, speed, 4 * rise / speed)) / 1e3;
      };
      const auto height = [&](size_t key) {
        return text::brief(*of.pattern.keyframes[key].cog_height - by, 4);
      };
      const double begins = push(rise_to(first.off, first.before)),
                   ends = push(rise_to(first.land, first.after));
      made.push_back(
          {Rank::pace,
           {of.key_place(first.off),
            (flights.size() == 1 ? "the flight lasts " : "the first flight lasts ") +
                seconds(lasts) + ", in which the robot rises by " +
                text::fixed(1e3 * kGravity * lasts * lasts / 8, 0) + " mm",
            "make the hop smaller: let the flight last " + seconds(shorter) + " (a rise of " +
                text::fixed(1e3 * kGravity * shorter * shorter / 8, 1) +
                " mm). Let the COG height be " + height(first.off) + " m at the lift-off and " +
                height(first.land) + " m at the landing. Let the COG be at its lowest place " +
                seconds(begins) + " before the lift-off (" + of.key_place(first.before) + ") and " +
                seconds(ends) + " after the landing (" + of.key_place(first.after) + "). " +
                (flights.size() > 1 ? "Change the other flights in the same way. " : "") +
                "With these changes"},
           [&of, flights, share, by, push](Pattern& p) {
             for (auto f = flights.rbegin(); f != flights.rend(); ++f) {
               const double length = f->end - f->begin;
               const double now = std::round(1e3 * share * length) / 1e3;
               p = stretched(of.model, p, f->begin, f->end, now / length);
               for (const size_t key : {f->off, f->land}) *p.keyframes[key].cog_height -= by;
               const auto rise = [&](size_t end, size_t low) {
                 return *p.keyframes[end].cog_height - *p.keyframes[low].cog_height;
               };
               p.keyframes[f->before].t = f->begin - push(rise(f->off, f->before));
               p.keyframes[f->after].t = f->begin + now + push(rise(f->land, f->after));
             }
           },
           1 - share + lower});
    }
  }
}

// The COG may be too high or too low. If the legs are folded, tries heights nearer to the COG
// height of the home posture; if they are nearly straight, tries lower heights.
void cog_height(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  const double height = default_cog_height(of.model, of.pattern);
  if (legs_are_folded(of.model, of.pattern, height)) {
    const double home = home_cog_height(of.model, of.pattern);
    for (const double share : {0.97, 0.94, 0.9, 0.85, 0.75})
      made.push_back(
          {Rank::amount,
           {"/defaults/cog_height",
            "the COG height is " + text::brief(height) + " m, which is " +
                text::fixed(100 * height / home, 0) + " % of the COG height in the home posture",
            "with " + text::brief(share * home, 3) + " m"},
           [higher = share * home](Pattern& p) { p.cog_height = higher; }});
    return;
  }
  for (const double share : {0.99, 0.97, 0.94, 0.9, 0.85})
    made.push_back({Rank::pace,
                    {"/defaults/cog_height",
                     "the COG height is " + text::brief(height) +
                         " m, and at this height the legs are nearly straight",
                     "with " + text::brief(share * height, 3) + " m"},
                    [lower = share * height](Pattern& p) { p.cog_height = lower; }});
}

}  // namespace ayumi::hypotheses
