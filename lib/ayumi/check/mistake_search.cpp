#include "ayumi/check/mistake_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>
#include <tuple>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"
#include "ayumi/check/mistake_trials.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

namespace {

// Largest numbers of values that are left out one at a time, that are tried with the other sign,
// and that are examined closely. Chosen: a time at which a motion fails lies between at most two
// keys of each of about ten tracks.
constexpr size_t kTriedValues = 24;
constexpr size_t kTriedSigns = 12;
constexpr size_t kSuspects = 3;
// Number of bisection steps for the range of a value, counted from the first value that is
// possible. Chosen: an accuracy of 3 % of the distance.
constexpr int kBisections = 5;
// Largest number of bisection steps in all. Chosen: the range of a length that was written in mm
// instead of m begins at the tenth step.
constexpr int kMostBisections = 14;
// If more than this share of a value is possible, the value is not wrong by a factor of ten.
// Chosen: a value with a misplaced decimal point is possible up to a share of 0.1, and motions
// seldom tolerate five times what their author meant.
constexpr double kGrossShare = 0.5;
// If less than this share of a value is possible, its sign is wrong and not its size. Chosen: the
// tolerances of the check allow this share.
constexpr double kNoShare = 0.05;
// A value that is farther than this from its neighbours is tried at a tenth of its size. Chosen:
// half the length of a leg, or half a radian; a step or a swing of a joint within one segment is
// usually shorter.
constexpr double kGrossSuspicion = 0.5;
// If another error appears when a value is left out, the value is tried at this share of the
// distance from its neutral value to itself. Chosen: feet then turn less or land nearer, but not
// beside each other.
constexpr double kHalfWay = 0.5;
// A change is small if it is less than this share of a value. Chosen: more than rounding, and less
// than a typing error.
constexpr double kSmallChange = 0.2;
// Number of mistakes that are named if several explain the same errors. Chosen: a third one would
// hide the first.
constexpr size_t kNamedTogether = 2;
// Number of mistakes that are searched one after the other in a pattern with several. Chosen: if
// there are more of them, an author corrects the first and asks again.
constexpr int kRounds = 3;
// A value that would have to change by more than this is clearly wrong, whatever else is wrong. The
// bound is also a share of the value's unit. Chosen: 12 mm for a leg of 0.24 m, 3 deg.
constexpr double kLargeChange = 0.05;
// The size that is given to a change of sign or digit that removes only a part of the errors.
// Definition: larger than all other changes.
constexpr double kGuessed = 1e3;
// Largest number of trials of smaller hops if nothing else helps. Chosen: more than all 20 of them,
// which count twice for legs of fewer than six joints.
constexpr int kHopTrials = 60;
// Largest number of trials of ways to keep bodies apart. Chosen: more than all 8 of them, which
// count twice for legs of fewer than six joints, and more often for a long motion.
constexpr int kRoomTrials = 60;
// Number of hypotheses of one kind that are tried. Chosen: more than there usually are, except for
// errors that last for the whole motion.
constexpr size_t kTriedOfOneKind = 64;

struct Candidate {
  Hypothesis hypothesis;
  TrialOutcome outcome;
};

/// The measure by which outcomes are compared. Where two mistakes move one joint, an error of one
/// of them may count as a consequence of the other one; then no change leaves fewer errors, but
/// some leave fewer findings.
enum class Measure { errors, findings };

bool is_better(const TrialOutcome& a, const TrialOutcome& b, Measure measure) {
  if (measure == Measure::errors || a.errors != b.errors) return a.errors < b.errors;
  return a.findings < b.findings;
}

/// The search in one pattern.
class Search {
 public:
  /// `rounds` is the number of changes that may be named from now on, one after the other.
  Search(Trials& trials, const RobotModel& model, const Pattern& pattern, const TrialOutcome& found,
         int rounds)
      : trials_(trials),
        model_(model),
        pattern_(pattern),
        found_(found),
        rounds_(rounds),
        hypotheses_(model, pattern, found) {}

  /// The best explanations, with equal remaining errors and equal rank. After drop(), these are the
  /// next best ones.
  std::vector<Candidate> best() {
    struct Stage {
      Rank reached;  ///< explanations of this rank make the stage needless
      Kind kind;
      bool values = false;  ///< whether the written values are examined first
      bool last = false;    ///< whether the stage is needless if anything helps
    };
    static const std::vector<Stage> usual = {
        {Rank::unit, Kind::units},       {Rank::unit, Kind::supports},
        {Rank::unit, Kind::times, true}, {Rank::slip, Kind::exchanges},
        {Rank::sign, Kind::missing},     {Rank::amount, Kind::nearer},
        {Rank::amount, Kind::paces},     {Rank::amount, Kind::small_swings, false, true}};
    // For slight errors, a hypothesis of another sign, digit or foot is only tried if something in
    // the pattern makes it likely.
    static const std::vector<Stage> slight = {{Rank::unit, Kind::units},
                                              {Rank::unit, Kind::irregular, true},
                                              {Rank::amount, Kind::nearer},
                                              {Rank::amount, Kind::paces},
                                              {Rank::amount, Kind::small_swings, false, true}};
    const std::vector<Stage>& stages = found_.slight ? slight : usual;
    for (; stage_ < stages.size(); ++stage_) {
      if (enough(stages[stage_].reached) || (stages[stage_].last && !chosen().empty())) break;
      if (stages[stage_].values) values();
      test(hypotheses_.of(stages[stage_].kind));
    }
    return chosen();
  }

  /// Removes explanations that turned out to be wrong.
  void drop(const std::vector<Candidate>& candidates) {
    std::erase_if(tried_, [&](const Candidate& tried) {
      return std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
        return c.hypothesis.says.place == tried.hypothesis.says.place &&
               c.hypothesis.says.written == tried.hypothesis.says.written &&
               c.hypothesis.says.instead == tried.hypothesis.says.instead;
      });
    });
  }

 private:
  using Kind = Hypotheses::Kind;

  bool enough(Rank reached) const {
    return std::any_of(tried_.begin(), tried_.end(), [&](const Candidate& c) {
      return c.outcome.good() && c.hypothesis.rank <= reached;
    });
  }

  void test(std::vector<Hypothesis> hypotheses) {
    if (hypotheses.size() > kTriedOfOneKind) {
      hypotheses.resize(kTriedOfOneKind);
      trials_.leave_out();
    }
    std::vector<Mend> mends;
    for (const Hypothesis& h : hypotheses) mends.push_back(h.mend);
    const std::vector<TrialOutcome> outcomes = trials_.after(pattern_, mends);
    for (size_t i = 0; i < hypotheses.size(); ++i)
      if (outcomes[i].good() || !hypotheses[i].only_if_enough)
        note({std::move(hypotheses[i]), outcomes[i]});
  }

  // The search goes on beyond kPatience only after a change that leaves few errors.
  void note(Candidate candidate) {
    if (helps(candidate, Measure::findings) && leaves_few(candidate.outcome)) trials_.go_on();
    tried_.push_back(std::move(candidate));
  }

  // Values without which the errors vanish, with the probably intended value and the range of
  // possible values.
  void values() {
    std::vector<WrittenValue> suspects;
    for (const WrittenValue& value : hypotheses_.values())
      if (value.suspicion(model_) > kLeastMistake && found_.touches(value.begin, value.end))
        suspects.push_back(value);
    std::stable_sort(suspects.begin(), suspects.end(),
                     [&](const WrittenValue& a, const WrittenValue& b) {
                       return a.suspicion(model_) > b.suspicion(model_);
                     });
    if (suspects.size() > kTriedValues) suspects.resize(kTriedValues);
    // If only a small share of the value is possible, this value is seldom at fault. Therefore the
    // values are also tried half-way between their neutral value and themselves.
    const auto is_mild = [](const Candidate& c) {
      return c.outcome.good() && c.hypothesis.rank <= Rank::amount &&
             c.hypothesis.change < 1 - kGrossShare;
    };
    if (!look_at_best(suspects, 0) || std::none_of(tried_.begin(), tried_.end(), is_mild))
      look_at_best(suspects, kHalfWay);
    demote_slips();
  }

  // Whether one of the values is at fault. Each value is set to `share` of the distance from its
  // neutral value to itself; at 0 it is left out.
  bool look_at_best(const std::vector<WrittenValue>& suspects, double share) {
    std::vector<Mend> mends;
    std::vector<double> shares;  // those nearest to `share` that can be written as messages do
    for (const WrittenValue& value : suspects) {
      shares.push_back(share == 0 ? 0 : value.written_share(pattern_, share));
      mends.push_back([&value, tried = shares.back()](Pattern& p) {
        if (tried == 0)
          value.leave_out(p);
        else
          value.pull(p, tried);
      });
    }
    const std::vector<TrialOutcome> without = trials_.after(pattern_, mends);
    const auto fewer = [&](const TrialOutcome& o) { return is_better(o, found_, Measure::errors); };
    const bool by_errors = std::any_of(without.begin(), without.end(), fewer);
    const Measure measure = by_errors ? Measure::errors : Measure::findings;
    TrialOutcome least = found_;
    for (const TrialOutcome& outcome : without)
      if (is_better(outcome, least, measure)) least = outcome;
    if (is_better(least, found_, measure) && leaves_few(least)) trials_.go_on();
    if (!found_.slight && share == 0) test_other_numbers(suspects, without);
    if (!is_better(least, found_, measure)) return false;
    size_t looked_at = 0;
    for (size_t i = 0; i < suspects.size() && looked_at < kSuspects; ++i)
      if (!is_better(least, without[i], measure)) {
        look_at(suspects[i], without[i], measure, shares[i]);
        ++looked_at;
      }
    return true;
  }

  // For each value whose removal leaves errors, tries the value with the opposite sign and, if it
  // is far from its neighbours, a tenth of the value.
  void test_other_numbers(const std::vector<WrittenValue>& suspects,
                          const std::vector<TrialOutcome>& without) {
    std::vector<Hypothesis> signs, tenths;
    for (size_t i = 0; i < suspects.size(); ++i) {
      if (without[i].errors == 0) continue;
      if (suspects[i].has_sign(model_) && signs.size() < kTriedSigns)
        signs.push_back(sign_of(suspects[i], suspects[i].elsewhere()));
      if (suspects[i].suspicion(model_) > kGrossSuspicion) tenths.push_back(tenth_of(suspects[i]));
    }
    test(std::move(signs));
    test(std::move(tenths));
  }

  // If a small change of another value is enough, a misplaced decimal point is not more likely than
  // a value of a wrong size.
  void demote_slips() {
    const auto small = [](const Candidate& c) {
      return c.hypothesis.rank == Rank::amount && c.hypothesis.change < kSmallChange;
    };
    const auto found = std::find_if(tried_.begin(), tried_.end(), small);
    if (found == tried_.end()) return;
    const std::string place = found->hypothesis.says.place;
    for (Candidate& c : tried_)
      if (c.hypothesis.rank == Rank::slip && c.hypothesis.says.place != place) {
        c.hypothesis.rank = Rank::amount;
        c.hypothesis.change = 1;
      }
  }

  void look_at(const WrittenValue& value, const TrialOutcome& without, Measure measure,
               double least) {
    double possible = least, impossible = 1;
    TrialOutcome at_limit = without;
    const auto bisect = [&](const auto& outcome_at) {
      int within = 0;
      for (int i = 0; i < kMostBisections && within < kBisections; ++i) {
        // The nearest share whose value can be written as the message names it.
        const double share = value.written_share(pattern_, 0.5 * (possible + impossible));
        if (share <= possible || share >= impossible) break;
        const TrialOutcome outcome = outcome_at(share);
        const bool worse = is_better(without, outcome, measure);
        (worse ? impossible : possible) = share;
        if (!worse) at_limit = outcome;
        if (possible > 0) ++within;
      }
    };
    const auto at = [&](double share) {
      return [&value, share](Pattern& p) { value.pull(p, share); };
    };
    bisect([&](double share) { return trials_.after(pattern_, at(share)); });
    // The table for the robot, which quick trials do not check, may make the range smaller.
    const auto exactly = [&](double share) { return trials_.exactly(pattern_, at(share)); };
    if (at_limit.good() && !trials_.exact() && possible > least && !exactly(possible).good() &&
        exactly(least).good()) {
      impossible = possible;
      possible = least;
      at_limit = without;
      bisect(exactly);
    }
    // If even the smallest share of the value is impossible, the message suggests the value that
    // the track would have without it. This suggestion, rounded as it is printed and put in place
    // of all numbers of the value, must be as good as leaving the value out.
    if (possible == 0) {
      possible = value.written_share(pattern_, 0);
      at_limit = trials_.after(pattern_, at(possible));
      if (is_better(without, at_limit, measure)) return;
    }
    const WrittenNumber& number = value.numbers.front();
    const double limit = number.neutral + possible * (number.value - number.neutral);
    const std::string bound = (number.value > number.neutral ? "of at most " : "of at least ") +
                              value.text(pattern_, limit);
    const std::string written = value.words + " is " + value.text(pattern_, number.value);
    // A change this small is only named if it is enough: then the author need not change more.
    const bool tiny = std::abs(number.value - limit) < kLeastMistake * value.unit(model_);
    if (tiny && !at_limit.good()) return;
    const double from = number.neutral + least * (number.value - number.neutral);
    const auto [smaller, larger] = std::minmax({from, limit});
    const std::string range =
        (least > 0 ? "from " + value.text(pattern_, smaller) + " to " + value.text(pattern_, larger)
                   : bound) +
        value.elsewhere();
    note({{Rank::amount,
           {value.place, written, "with a value " + range},
           // The errors that remain are those after the smallest change, because an author takes
           // the smallest one.
           [value, possible](Pattern& p) { value.pull(p, possible); },
           number.value == 0 ? 1 : std::abs(1 - limit / number.value),
           std::abs(number.value - limit) / value.unit(model_)},
          at_limit});
    if (found_.slight || least > 0 || tiny) return;
    std::vector<Hypothesis> slips;
    // The sign is probably wrong: almost no value of this sign is possible, and the size of the
    // value is usual.
    const bool other_sign =
        limit / number.value < kNoShare && std::abs(number.value) < value.unit(model_);
    if (value.has_sign(model_))
      slips.push_back(sign_of(value, ", or with a value " + range,
                              value.across ? Rank::slip
                              : other_sign ? Rank::exchange
                                           : Rank::sign));
    const bool too_large = limit / number.value < kGrossShare && !other_sign;
    const bool too_small = limit / number.value > 1 / kGrossShare;
    const auto add = [&](double factor, const std::string& why) {
      slips.push_back({Rank::slip,
                       {value.place, written,
                        why + " (" + value.text(pattern_, factor * number.value) +
                            "), or with a value " + range + ","},
                       [value, factor](Pattern& p) { value.scale(p, factor); }});
    };
    // The smallest change comes first.
    if (too_large) add(0.1, "with the decimal point one place further left");
    if (too_large && value.quantity == Quantity::angle && !pattern_.degrees)
      add(std::numbers::pi / 180, "with the number read in deg");
    if (too_large && value.quantity == Quantity::length) {
      add(1e-2, "with the number read in cm");
      add(1e-3, "with the number read in mm");
    }
    if (too_small && value.quantity == Quantity::force) add(kGravity, "with the number read in kg");
    if (too_small) add(10, "with the decimal point one place further right");
    if (too_small && value.quantity == Quantity::angle && pattern_.degrees)
      add(180 / std::numbers::pi, "with the number read in rad");
    test(std::move(slips));
  }

  // The hypothesis that a tenth of the value was meant. It is tried for a value that is far from
  // its neighbours (kGrossSuspicion).
  Hypothesis tenth_of(const WrittenValue& value) const {
    const double number = value.numbers.front().value;
    return {Rank::slip,
            {value.place, value.words + " is " + value.text(pattern_, number),
             "with the decimal point one place further left (" +
                 value.text(pattern_, 0.1 * number) + ")" + value.elsewhere() + ","},
            [value](Pattern& p) { value.scale(p, 0.1); }};
  }

  Hypothesis sign_of(const WrittenValue& value, const std::string& more,
                     Rank rank = Rank::sign) const {
    const double number = value.numbers.front().value;
    const std::string negated = value.text(pattern_, -number);
    return {rank,
            {value.place, value.words + " is " + value.text(pattern_, number),
             (value.across ? "with " + negated + " (perhaps left and right were exchanged)"
                           : "with the other sign (" + negated + ")") +
                 more + ","},
            [value](Pattern& p) { value.scale(p, -1); }};
  }

  /// Whether a change can be a cause. If n changes may still be named, including this one, it must
  /// remove at least 1/n of the errors (at least half if it is the last one).
  bool leaves_few(const TrialOutcome& outcome) const {
    if (found_.errors == kUnsampled) return true;
    const int changes = std::max(2, rounds_);  // the last one removes at least half
    const auto few = [&](int left, int of) { return left * changes <= of * (changes - 1); };
    return outcome.errors == found_.errors ? few(outcome.findings, found_.findings)
                                           : few(outcome.errors, found_.errors);
  }

  /// A value that is clearly wrong is examined in any case, after those values whose change leaves
  /// few errors.
  bool is_believable(const Candidate& c) const {
    return leaves_few(c.outcome) ||
           (c.outcome.errors < found_.errors && c.hypothesis.rank == Rank::amount &&
            (c.hypothesis.change >= kSmallChange || c.hypothesis.size >= kLargeChange));
  }

  /// A contradiction of the geometry also counts if its correction leaves fewer findings, even if
  /// some of these findings were consequences before.
  bool helps(const Candidate& c, Measure measure) const {
    return is_better(c.outcome, found_, measure) ||
           (c.hypothesis.rank == Rank::geometry && is_better(c.outcome, found_, Measure::findings));
  }

  /// The first few candidates, sorted by the number of remaining errors, then from the most
  /// specific rank on.
  std::vector<Candidate> chosen() const {
    std::vector<Candidate> sorted;
    for (const Measure measure : {Measure::errors, Measure::findings}) {
      if (!sorted.empty()) break;
      for (const Candidate& c : tried_)
        if (helps(c, measure) && is_believable(c)) sorted.push_back(c);
    }
    // Another sign, another digit or another pace counts as intended only if no errors remain.
    const auto is_guess = [](const Candidate& c) { return c.hypothesis.change == kGuessed; };
    for (Candidate& c : sorted)
      if ((c.hypothesis.rank == Rank::sign || c.hypothesis.rank == Rank::slip ||
           c.hypothesis.rank == Rank::pace) &&
          !c.outcome.good()) {
        c.hypothesis.rank = Rank::amount;
        c.hypothesis.change = kGuessed;
      }
    if (!std::all_of(sorted.begin(), sorted.end(), is_guess)) std::erase_if(sorted, is_guess);
    const auto key = [&](const Candidate& c) {
      return std::tuple(!leaves_few(c.outcome), c.outcome.errors, c.hypothesis.rank,
                        c.hypothesis.change);
    };
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const Candidate& a, const Candidate& b) { return key(a) < key(b); });
    std::vector<Candidate> best;
    for (const Candidate& c : sorted) {
      if (c.outcome.errors != sorted.front().outcome.errors ||
          c.hypothesis.rank != sorted.front().hypothesis.rank || best.size() == kNamedTogether)
        break;
      // One contradiction of the geometry may be corrected in several ways; the first is enough.
      const auto same = [&](const Candidate& b) {
        return b.hypothesis.says.place == c.hypothesis.says.place &&
               (b.hypothesis.says.written == c.hypothesis.says.written ||
                c.hypothesis.rank == Rank::geometry);
      };
      if (std::none_of(best.begin(), best.end(), same)) best.push_back(c);
    }
    return best;
  }

  Trials& trials_;
  const RobotModel& model_;
  const Pattern& pattern_;
  const TrialOutcome& found_;
  int rounds_;
  Hypotheses hypotheses_;
  size_t stage_ = 0;  // the first stage that was not tried yet
  std::vector<Candidate> tried_;
};

std::string result_words(const TrialOutcome& before, const TrialOutcome& after) {
  if (after.good()) return "the pattern would be consistent";
  if (before.errors == kUnsampled)
    return "the motion could be computed, and " + text::counted(after.errors, "error") +
           " would remain";
  if (after.errors >= before.errors)
    return text::remaining(after.findings, before.findings, "finding");
  return text::remaining(after.errors, before.errors, "error");
}

// The result, in words, of a change that leaves no errors in a quick trial, after it was tried
// again at the servo's period.
std::string words_at_period(const TrialOutcome& before, const TrialOutcome& after) {
  if (after.good()) return result_words(before, after);
  return "only " + text::counted(after.errors, "error") + " would remain, " +
         (after.of_table ? "in the joint table for the robot"
                         : "which a check at the period of the servos finds");
}

// The place and the words before the first number: what a change concerns, whatever its value.
std::string value_of(const Explanation& e) {
  std::string words = e.place + ":";
  std::istringstream each(e.written);
  for (std::string word; each >> word;) {
    if (word.find_first_of("0123456789") <= 1) break;  // a number, perhaps with a sign
    words += " " + word;
  }
  return words;
}

// The places whose changes are also needed.
std::string together_with(const std::vector<Explanation>& changes) {
  std::vector<std::string> places;
  for (const Explanation& change : changes)
    if (std::find(places.begin(), places.end(), change.place) == places.end())
      places.push_back(change.place);
  return " (together with the first change for " +
         text::join(places, " and the first change for ") + ")";
}

// "with t = 1 s, ": the condition of a sentence.
std::string before_result(const std::string& instead) {
  return instead + (instead.ends_with(',') ? " " : ", ");
}

// Used if no sequence of changes is enough. Returns the first smaller hop that is enough, or else
// the hop that leaves the fewest errors at the servo's period, if they are fewer than `left`.
std::optional<Candidate> smaller_hop(Trials& trials, const RobotModel& model,
                                     const Pattern& pattern, const TrialOutcome& found, int left) {
  const Hypotheses hypotheses(model, pattern, found);  // the changes refer to it
  std::vector<Hypothesis> hops = hypotheses.of(Hypotheses::Kind::hops);
  std::vector<Mend> mends;
  for (const Hypothesis& hop : hops) mends.push_back(hop.mend);
  const std::vector<TrialOutcome> outcomes = trials.after(pattern, mends);
  std::optional<Candidate> best;
  for (size_t i = 0; i < hops.size() && !(best && best->outcome.good()); ++i) {
    if (!outcomes[i].good()) continue;
    const TrialOutcome exact = trials.exact() ? outcomes[i] : trials.exactly(pattern, hops[i].mend);
    if (exact.errors < (best ? best->outcome.errors : left)) best = {std::move(hops[i]), exact};
  }
  if (!best) return best;
  Explanation& says = best->hypothesis.says;
  says.instead = before_result(says.instead) + words_at_period(found, best->outcome);
  says.enough = best->outcome.good();
  return best;
}

// If bodies meet and no sequence of changes is enough: the smallest change of each kind that keeps
// them apart and leaves no error. A named mistake that is enough comes before, because then these
// ways out are not tried.
std::vector<Explanation> room_for_bodies(Trials& trials, const RobotModel& model,
                                         const Pattern& pattern, const TrialOutcome& found) {
  std::vector<Explanation> ways;
  if (found.meeting.empty()) return ways;
  const Hypotheses hypotheses(model, pattern, found);  // the changes refer to it
  const std::vector<Hypothesis> room = hypotheses.of(Hypotheses::Kind::room);
  std::vector<Mend> mends;
  for (const Hypothesis& one : room) mends.push_back(one.mend);
  const std::vector<TrialOutcome> outcomes = trials.after(pattern, mends);
  for (size_t i = 0; i < room.size(); ++i) {
    const auto is_same = [&](const Explanation& e) { return e.written == room[i].says.written; };
    if (!outcomes[i].good() || std::any_of(ways.begin(), ways.end(), is_same)) continue;
    const TrialOutcome exact = trials.exact() ? outcomes[i] : trials.exactly(pattern, room[i].mend);
    if (!exact.good()) continue;
    ways.push_back(room[i].says);
    ways.back().instead = before_result(ways.back().instead) + result_words(found, exact);
    ways.back().enough = ways.back().is_way_out = true;
  }
  return ways;
}

}  // namespace

Explanations find_explanations(const RobotModel& model, const Pattern& pattern,
                               const CheckOptions& options, const Progress& progress,
                               int most_trials) {
  Explanations result;
  if (pattern.table || pattern.phases.empty() || !model.has_soles()) return result;
  Trials trials(model, pattern, options, progress, most_trials);
  Pattern current = pattern;
  std::vector<Explanation> changed;  // the changes of the previous rounds
  TrialOutcome found = trials.of(current);
  if (found.good()) {  // the errors show only at the servo's period
    trials.make_exact();
    found = trials.of(current);
  }
  const TrialOutcome given = found;
  for (int round = 0; round < kRounds && !found.good() && !trials.ended(); ++round) {
    const int left_rounds = kRounds - round;
    std::optional<Search> search(std::in_place, trials, model, current, found, left_rounds);
    // The functions that make the changes of these candidates refer to `search`, which must live
    // longer.
    std::vector<Candidate> possible;
    while (possible.empty()) {
      std::vector<Candidate> best = search->best();
      if (best.empty() && !trials.exact() && trials.finer_when_exact()) {
        // Quick trials may find errors that do not exist in exact trials.
        const TrialOutcome exact = trials.of(current, true);
        if (exact.errors < found.errors) {
          trials.make_exact();
          found = exact;
          search.emplace(trials, model, current, found, left_rounds);
          best = search->best();
        }
      }
      // A second change of the same value would contradict the first one.
      std::vector<Candidate> again;
      std::erase_if(best, [&](const Candidate& c) {
        const Explanation& says = c.hypothesis.says;
        const auto is_same = [&](const Explanation& e) { return value_of(e) == value_of(says); };
        const auto is_here = [&](const Explanation& e) { return e.place == says.place; };
        const bool is_again = std::any_of(changed.begin(), changed.end(), is_same) ||
                              (is_repeated(pattern, says.place) &&
                               std::any_of(result.found.begin(), result.found.end(), is_here));
        if (is_again) again.push_back(c);
        return is_again;
      });
      if (best.empty() && again.empty()) break;
      std::vector<Candidate> unsampled;
      for (Candidate& c : best) {
        // A quick trial does not find the errors that only show at the servo's period.
        const bool looked_closer = c.outcome.good() && !trials.exact();
        if (looked_closer) c.outcome = trials.exactly(current, c.hypothesis.mend);
        if (c.outcome.errors == kUnsampled) {
          unsampled.push_back(std::move(c));
          continue;
        }
        c.hypothesis.says.instead =
            before_result(c.hypothesis.says.instead) +
            (looked_closer ? words_at_period(found, c.outcome) : result_words(found, c.outcome));
        c.hypothesis.says.enough = c.outcome.good();
        // The changes of the previous rounds are also needed.
        c.hypothesis.says.round = round;
        if (round > 0) c.hypothesis.says.instead += together_with(changed);
        // A mistake that was named together with another change is enough only after that change.
        std::erase_if(result.found, [&](const Explanation& e) {
          return e.place == c.hypothesis.says.place && e.written == c.hypothesis.says.written;
        });
        result.found.push_back(c.hypothesis.says);
        possible.push_back(std::move(c));
      }
      if (trials.ended()) break;
      // The next best explanations may be possible.
      unsampled.insert(unsampled.end(), again.begin(), again.end());
      search->drop(unsampled);
    }
    if (possible.empty()) break;
    Pattern mended = current;
    possible.front().hypothesis.mend(mended);
    changed.push_back(possible.front().hypothesis.says);
    const TrialOutcome left = possible.front().outcome;
    if (left.table_alone) trials.make_exact();
    current = std::move(mended);
    found = left;
  }
  result.trials = trials.made();
  result.complete = !(trials.ended() || trials.left_out());
  // Makes a few more of the `most_trials` trials, even if the search lost patience, because nothing
  // else has found a remedy.
  const auto with_few_trials = [&](const Pattern& of, int most, const auto& search) {
    Trials few(model, of, options, progress, std::min(most, most_trials - result.trials));
    auto best = search(few);
    result.trials += few.made();
    result.complete = result.complete && !few.ended();
    return best;
  };
  if (!found.good()) {
    const auto hop = with_few_trials(pattern, kHopTrials, [&](Trials& few) {
      return smaller_hop(few, model, pattern, given, found.errors);
    });
    if (hop) {
      result.found = {hop->hypothesis.says};
      found = hop->outcome;
      changed.clear();  // they are not named any more
    }
  }
  if (!found.good()) {
    const auto room = [&](const Pattern& of, const TrialOutcome& outcome) {
      return with_few_trials(of, kRoomTrials,
                             [&](Trials& few) { return room_for_bodies(few, model, of, outcome); });
    };
    std::vector<Explanation> ways = room(pattern, given);
    if (ways.empty() && !changed.empty()) {
      ways = room(current, found);
      for (Explanation& way : ways) {
        way.round = static_cast<int>(changed.size());
        way.instead += together_with(changed);
      }
    }
    result.found.insert(result.found.end(), ways.begin(), ways.end());
  }
  // If a mistake is named that is enough, no other cause is needed. A way out is no such mistake.
  result.complete = result.complete || found.good();
  return result;
}

}  // namespace ayumi
