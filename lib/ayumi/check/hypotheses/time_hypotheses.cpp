#include "ayumi/check/hypotheses/time_hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/number_slips.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi::hypotheses {

namespace {

// A phase is as long as it was meant to be if its duration differs by less than this share from the
// duration of similar phases. Chosen: generated walks differ by 1 %.
constexpr double kUsualShare = 0.2;
// No phase of a robot is shorter [s]. Chosen: ten times less than the shortest steps of small
// robots. A time in seconds that is read in ms is below half of this bound, and steps are above
// twice this bound.
constexpr double kShortestPhase = 0.02;
// A segment that lasts less than this share of its neighbour is considered too short before any
// value is considered wrong by a power of ten. Chosen: keys of one motion are seldom so unequal.
constexpr double kShortSegment = 0.15;
// Sort value (Hypothesis::change) of a change that puts a keyframe at the end of a phase.
// Definition: below -2, the smallest value of other changes of times, so that it comes first.
constexpr double kCoincidence = -3;

// Number of keys in ExaminedPattern::contacts after the beginning of this phase that are at the end
// of a phase if the end of this phase and all later ends are moved by `later` [s]. Both lists are
// sorted, so one pass through them is enough: a long walk has thousands of phases and keys.
long keys_at_ends(const ExaminedPattern& of, size_t phase, double later) {
  long keys = 0;
  const double begin = of.begin_of(phase) + kSameInstant;
  size_t end = phase;
  for (auto key = std::lower_bound(of.contacts.begin(), of.contacts.end(), begin);
       key != of.contacts.end(); ++key) {
    while (end < of.ends.size() && of.ends[end] + later <= *key - kSameInstant) ++end;
    if (end == of.ends.size()) break;
    if (of.ends[end] + later < *key + kSameInstant) ++keys;
  }
  return keys;
}

// A key of the ZMP or of a foot at the end of a phase belongs to the change of the support.
bool belongs_to_phase(const ExaminedPattern& of, const Keyframe& key) {
  return (key.zmp || key.feet[0] || key.feet[1]) && of.is_at_end(key.t);
}

// The time since the previous key, which is the same in all rounds of a block, may be wrong by a
// digit. All later keys move with it.
void repeated_segments(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  const auto& keys = of.pattern.keyframes;
  std::set<std::string> seen;
  double longest = 0;
  for (size_t i = 1; i < keys.size(); ++i) longest = std::max(longest, keys[i].t - keys[i - 1].t);
  for (size_t i = 1; i < keys.size(); ++i) {
    if (!of.is_repeated_key(i) || !seen.insert(keys[i].pointer).second) continue;
    // All later keys move, so the error may come much later, but not before this segment.
    if (!of.found.touches(keys[i - 1].t, of.pattern.duration())) continue;
    const double lasts = keys[i].t - keys[i - 1].t;
    for (const double meant : number_slips(lasts)) {
      if (meant < kShortestPhase || meant > longest) continue;
      made.push_back({Rank::slip,
                      {of.key_place(i),
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

/// The median of the durations of other phases of the same kind; no value if there are fewer than
/// two of them.
std::optional<double> usual_duration(const ExaminedPattern& of, size_t phase) {
  std::vector<double> like;
  for (size_t i = 0; i < of.pattern.phases.size(); ++i)
    if (i != phase &&
        is_single(of.pattern.phases[i].support) == is_single(of.pattern.phases[phase].support) &&
        (of.pattern.phases[i].support == Support::none) ==
            (of.pattern.phases[phase].support == Support::none) &&
        of.pattern.phases[i].swing.has_value() == of.pattern.phases[phase].swing.has_value())
      like.push_back(of.pattern.phases[i].until - of.begin_of(i));
  if (like.size() < 2) return std::nullopt;
  std::sort(like.begin(), like.end());
  return like[like.size() / 2];
}

// If no keyframe with is_of_contact() is at the end of a phase, tries to move this end to such a
// keyframe nearby. The end at which the phase would have the duration `tried` is left out.
void ends_at_keys(const ExaminedPattern& of, size_t phase, double after,
                  std::optional<double> tried, std::vector<Hypothesis>& made) {
  const double begin = of.begin_of(phase), until = of.pattern.phases[phase].until;
  if (phase + 1 == of.pattern.phases.size() || of.has_key_of_contact(until)) return;
  // At the ends of a flight, keys of the COG height are tried, too.
  const bool flight = of.pattern.phases[phase].support == Support::none ||
                      of.pattern.phases[phase + 1].support == Support::none;
  for (size_t k = 0; k < of.pattern.keyframes.size(); ++k) {
    const Keyframe& key = of.pattern.keyframes[k];
    if (key.t <= begin + kShortestPhase || key.t >= after || of.is_at_end(key.t) ||
        !(is_of_contact(key) || (flight && key.cog_height)))
      continue;
    if (tried && std::abs(key.t - begin - *tried) < kSameInstant) continue;
    made.push_back(
        {Rank::slip,
         {of.phase_place(phase),
          "the phase ends at " + seconds(until) +
              ", but no keyframe moves the ZMP or a foot at this time. " + of.key_place(k) +
              " is at " + seconds(key.t) + ", but no phase ends at " + seconds(key.t),
          "with an end at " + seconds(key.t)},
         [phase, t = key.t](Pattern& p) { p.phases[phase].until = t; },
         kCoincidence});
  }
}

// A wrong duration moves all later phases, but not the keyframes, so that these no longer fit.
void durations(const ExaminedPattern& of, size_t phase, std::vector<Hypothesis>& made) {
  const double until = of.pattern.phases[phase].until, lasts = until - of.begin_of(phase);
  if (is_repeated(of.pattern, of.pattern.phases[phase].pointer)) return;
  const long now = keys_at_ends(of, phase, 0);
  for (const double meant : number_slips(lasts)) {
    if (meant < kShortestPhase) continue;
    const Mend mend = [phase, later = meant - lasts](Pattern& p) {
      for (size_t k = phase; k < p.phases.size(); ++k) p.phases[k].until += later;
    };
    const long more = keys_at_ends(of, phase, meant - lasts) - now;
    if (more <= 0) continue;
    made.push_back({Rank::slip,
                    {of.phase_place(phase),
                     "the phase lasts " + seconds(lasts) +
                         ", so the times of keyframes do not fit the ends of the phases",
                     "with a duration of " + seconds(meant) + " (then " +
                         text::counted(static_cast<size_t>(more), "more keyframe") +
                         (more == 1 ? " is" : " are") + " at the end of a phase),"},
                    mend,
                    kCoincidence - static_cast<double>(more)});
  }
}

}  // namespace

void key_times(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  const auto& keys = of.pattern.keyframes;
  repeated_segments(of, made);
  for (size_t i = 0; i < keys.size(); ++i) {
    if (!of.reaches_key(i) || of.is_repeated_key(i)) continue;
    const double before = i > 0 ? keys[i - 1].t : 0;
    const double after = i + 1 < keys.size() ? keys[i + 1].t : of.pattern.duration();
    const auto add = [&](Rank rank, double t, const std::string& why, double change = 0) {
      if (t <= before || t >= after || t == keys[i].t) return;
      // In a flight the COG follows its parabola: a key of the COG there would be the next error.
      if ((keys[i].cog_x || keys[i].cog_y || keys[i].cog_height) && of.flies(t)) return;
      made.push_back(
          {rank,
           {of.key_place(i), "t is " + seconds(keys[i].t) + why, "with t = " + seconds(t)},
           [i, t](Pattern& p) { p.keyframes[i].t = t; },
           change});
    };
    const double in = keys[i].t - before, out = after - keys[i].t;
    const bool too_early = in < kShortSegment * out;
    // The intended time must not leave a shorter segment than the written time.
    for (const double t : number_slips(keys[i].t))
      if (std::min(t - before, after - t) >= std::min(in, out))
        add(Rank::slip, t, "", too_early ? -2 : 0);
    if (is_of_contact(keys[i]) && !of.is_at_end(keys[i].t))
      for (auto end = std::upper_bound(of.ends.begin(), of.ends.end(), before);
           end != of.ends.end() && *end < after; ++end)
        if (!of.has_key_of_contact(*end))
          add(Rank::slip, *end,
              ", but no phase ends at this time. A phase ends at " + seconds(*end) +
                  ", but no keyframe moves the ZMP or a foot at " + seconds(*end),
              kCoincidence);
    if (i == 0 || (!too_early && belongs_to_phase(of, keys[i]))) continue;
    const std::string lasts = ", so the segment before this key lasts " + seconds(in) +
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

void phase_times(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  for (size_t i = 0; i < of.pattern.phases.size(); ++i) {
    if (!of.reaches(i)) continue;
    const double until = of.pattern.phases[i].until, begin = of.begin_of(i);
    const double after =
        i + 1 < of.pattern.phases.size() ? of.pattern.phases[i + 1].until : until * 1e3;
    const std::optional<double> usual = usual_duration(of, i);
    const bool is_usual = usual && std::abs(until - begin - *usual) < kUsualShare * *usual;
    ends_at_keys(of, i, after, is_usual ? std::nullopt : usual, made);
    durations(of, i, made);
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
    const bool last = i + 1 == of.pattern.phases.size();
    const double keyed = of.pattern.keyframes.empty() ? 0 : of.pattern.keyframes.back().t;
    const auto is_used = [&](double t) { return !last || t <= until || 2 * keyed > begin + t; };
    for (const double t : meant)
      if (t > begin + kShortestPhase && t < after && t != until && is_used(t))
        made.push_back({Rank::slip,
                        {of.phase_place(i), lasts, "with an end at " + seconds(t)},
                        [i, t](Pattern& p) { p.phases[i].until = t; }});
    if (!usual) continue;
    made.push_back({Rank::slip,
                    {of.phase_place(i), lasts,
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

}  // namespace ayumi::hypotheses
