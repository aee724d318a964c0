#include "ayumi/check/block_hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/number_slips.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/hypotheses/examined_pattern.hpp"

namespace ayumi {

namespace {

// Two durations that differ by less than this are meant to be equal [s]. Chosen: times are written
// in milliseconds.
constexpr double kSameDuration = 1e-3;
// No phase and no segment between two keyframes becomes shorter than this [s]. Chosen: ten times
// less than the shortest steps of small robots.
constexpr double kShortest = 0.02;

/// A block that repeats, after its rounds were expanded: items of the list that follow each other.
struct Block {
  std::string place;  ///< JSON pointer of the block
  size_t first = 0;   ///< its first item in the list
  size_t each = 1;    ///< number of items in one round
  size_t rounds = 1;  ///< number of rounds
  double begin = 0;   ///< time of the first item of the first round [s]
  double period = 0;  ///< time between the first items of two rounds [s]
  size_t end() const { return first + each * rounds; }
};

// "/keyframes/2" for "/keyframes/2/keyframes/1"; empty for an item that is in no block.
std::string block_of(const std::string& pointer) {
  const size_t list = pointer.find('/', 1);
  const size_t item = list == std::string::npos ? list : pointer.find('/', list + 1);
  return item == std::string::npos ? "" : pointer.substr(0, item);
}

// Whether an item is in a block that is in another block, as "/keyframes/2/keyframes/0/keyframes/1"
// is. The pointer does not show to which round of the outer block such an item belongs.
bool is_nested(const std::string& pointer) {
  // Number of slashes in the pointer of an item in one block. Definition: "/list/block/list/item".
  constexpr long kInOneBlock = 4;
  return std::count(pointer.begin(), pointer.end(), '/') > kInOneBlock;
}

// The first block with at least two rounds; nothing if it contains another block. `time_of` gives
// the time of an item.
template <class Items, class TimeOf>
std::optional<Block> first_block(const Items& items, const TimeOf& time_of) {
  for (size_t i = 0; i < items.size(); ++i) {
    Block block{.place = block_of(items[i].pointer), .first = i};
    if (block.place.empty()) continue;
    size_t end = i;
    for (; end < items.size() && block_of(items[end].pointer) == block.place; ++end)
      if (is_nested(items[end].pointer)) return std::nullopt;
    block.rounds = static_cast<size_t>(
        std::count_if(items.begin() + static_cast<long>(i), items.begin() + static_cast<long>(end),
                      [&](const auto& item) { return item.pointer == items[i].pointer; }));
    if (block.rounds < 2 || (end - i) % block.rounds != 0) return std::nullopt;
    block.each = (end - i) / block.rounds;
    block.begin = time_of(i);
    block.period = time_of(i + block.each) - block.begin;
    return block;
  }
  return std::nullopt;
}

/// Finds changes after which two blocks fit each other.
class Fit {
 public:
  Fit(const Pattern& pattern, const Block& phases, const Block& keys)
      : pattern_(pattern), phases_(phases), keys_(keys) {}

  std::vector<Hypothesis> made() {
    if (std::abs(phases_.period - keys_.period) > kSameDuration) {
      durations();
      segments();
    } else if (phases_.rounds != keys_.rounds) {
      rounds();
    } else {
      late_keys();
    }
    return std::move(made_);
  }

 private:
  double begin_of(size_t phase) const { return phase > 0 ? pattern_.phases[phase - 1].until : 0.0; }

  void add(const std::string& place, const std::string& written, const std::string& instead,
           Mend mend, double change = 0) {
    made_.push_back({Rank::geometry, {place, written, instead}, std::move(mend), change});
  }

  // ---- another number of rounds

  // The times of the items after the block move by this when the block gets `rounds` rounds.
  static double shift(const Block& block, size_t rounds) {
    return (static_cast<double>(rounds) - static_cast<double>(block.rounds)) * block.period;
  }

  // Gives the block the number of rounds. The items of added rounds are those of the last round.
  template <class Items, class Time>
  static void repeat(Items& items, const Block& block, size_t rounds, const Time& time) {
    const Items last(items.begin() + static_cast<long>(block.end() - block.each),
                     items.begin() + static_cast<long>(block.end()));
    const Items after(items.begin() + static_cast<long>(block.end()), items.end());
    items.resize(block.first + block.each * std::min(rounds, block.rounds));
    for (size_t round = block.rounds; round < rounds; ++round)
      for (auto item : last) {
        time(item) += static_cast<double>(round - block.rounds + 1) * block.period;
        items.push_back(item);
      }
    for (auto item : after) {
      time(item) += shift(block, rounds);
      items.push_back(item);
    }
  }

  void rounds() {
    const std::string times = " repeats " + text::counted(keys_.rounds, "time") +
                              ", but the block of phases " + phases_.place + " repeats " +
                              text::counted(phases_.rounds, "time");
    add(keys_.place, "the block of keyframes" + times,
        "with \"repeat\": " + std::to_string(phases_.rounds) + " here",
        [keys = keys_, rounds = phases_.rounds](Pattern& p) {
          repeat(p.keyframes, keys, rounds, [](Keyframe& key) -> double& { return key.t; });
        });
    add(phases_.place,
        "the block of phases repeats " + text::counted(phases_.rounds, "time") +
            ", but the block of keyframes " + keys_.place + " repeats " +
            text::counted(keys_.rounds, "time"),
        "with \"repeat\": " + std::to_string(keys_.rounds) + " here",
        [phases = phases_, rounds = keys_.rounds](Pattern& p) {
          repeat(p.phases, phases, rounds, [](Phase& phase) -> double& { return phase.until; });
        });
  }

  // ---- another length of a round

  std::string lengths() const {
    return "The phases of one round of " + phases_.place + " last " +
           hypotheses::seconds(phases_.period) + ", but the keyframes of " + keys_.place +
           " repeat every " + hypotheses::seconds(keys_.period);
  }

  // -1 if one wrong digit explains the difference; otherwise the relative difference.
  static double unlikeliness(double written, double meant) {
    for (const double slip : number_slips(written))
      if (std::abs(slip - meant) < kSameDuration) return -1;
    return std::abs(meant - written) / std::max(meant, written);
  }

  void durations() {
    for (size_t j = 0; j < phases_.each; ++j) {
      const size_t phase = phases_.first + j;
      const double lasts = pattern_.phases[phase].until - begin_of(phase);
      const double meant = lasts + keys_.period - phases_.period;
      if (meant < kShortest) continue;
      add(
          pattern_.phases[phase].pointer,
          "the phase lasts " + hypotheses::seconds(lasts) + ". " + lengths(),
          "with a duration of " + hypotheses::seconds(meant),
          [block = phases_, j, by = meant - lasts](Pattern& p) {
            double later = 0;
            for (size_t i = block.first; i < p.phases.size(); ++i) {
              if (i < block.end() && (i - block.first) % block.each == j) later += by;
              p.phases[i].until += later;
            }
          },
          unlikeliness(lasts, meant));
    }
  }

  void segments() {
    for (size_t j = 0; j < keys_.each; ++j) {
      // For the first keyframe of a round, the segment begins at the last keyframe of the previous
      // round.
      const size_t key = keys_.first + j;
      const double lasts = j > 0 ? pattern_.keyframes[key].t - pattern_.keyframes[key - 1].t
                                 : keys_.period - (pattern_.keyframes[key + keys_.each - 1].t -
                                                   pattern_.keyframes[key].t);
      const double meant = lasts + phases_.period - keys_.period;
      if (meant < kShortest) continue;
      add(
          pattern_.keyframes[key].pointer,
          "the keyframe comes " + hypotheses::seconds(lasts) + " after the keyframe before it. " +
              lengths(),
          "with " + hypotheses::seconds(meant) + " between these two keyframes",
          [block = keys_, j, by = meant - lasts](Pattern& p) {
            double later = 0;
            for (size_t i = block.first; i < p.keyframes.size(); ++i) {
              const bool first = i < block.first + block.each && j == 0;
              if (i < block.end() && (i - block.first) % block.each == j && !first) later += by;
              p.keyframes[i].t += later;
            }
          },
          unlikeliness(lasts, meant));
    }
  }

  // ---- the same rounds at another time

  void late_keys() {
    const double late = keys_.begin - phases_.begin, rounds = std::round(late / keys_.period);
    if (rounds == 0 || std::abs(late - rounds * keys_.period) > kSameDuration) return;
    add(keys_.place,
        "the repeated keyframes begin at " + hypotheses::seconds(keys_.begin) +
            ", but the repeated phases begin at " + hypotheses::seconds(phases_.begin) +
            ". One round lasts " + hypotheses::seconds(keys_.period),
        "with these and all later keyframes " + hypotheses::seconds(std::abs(late)) +
            (late > 0 ? " earlier," : " later,"),
        [first = keys_.first, late](Pattern& p) {
          for (size_t i = first; i < p.keyframes.size(); ++i) p.keyframes[i].t -= late;
        });
  }

  const Pattern& pattern_;
  Block phases_, keys_;
  std::vector<Hypothesis> made_;
};

}  // namespace

std::vector<Hypothesis> block_hypotheses(const Pattern& pattern) {
  const auto phases = first_block(
      pattern.phases, [&](size_t i) { return i > 0 ? pattern.phases[i - 1].until : 0.0; });
  const auto keys =
      first_block(pattern.keyframes, [&](size_t i) { return pattern.keyframes[i].t; });
  if (!phases || !keys || keys->period <= 0) return {};
  return Fit(pattern, *phases, *keys).made();
}

}  // namespace ayumi
