#include "ayumi/check/mistake_hypotheses.hpp"

#include <algorithm>
#include <initializer_list>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/block_hypotheses.hpp"
#include "ayumi/check/hypotheses/cog_hypotheses.hpp"
#include "ayumi/check/hypotheses/exchange_hypotheses.hpp"
#include "ayumi/check/hypotheses/foothold_hypotheses.hpp"
#include "ayumi/check/hypotheses/part_hypotheses.hpp"
#include "ayumi/check/hypotheses/room_hypotheses.hpp"
#include "ayumi/check/hypotheses/swing_hypotheses.hpp"
#include "ayumi/check/hypotheses/time_hypotheses.hpp"
#include "ayumi/check/hypotheses/torso_hypotheses.hpp"
#include "ayumi/check/hypotheses/unit_hypotheses.hpp"
#include "ayumi/check/hypotheses/zmp_hypotheses.hpp"

namespace ayumi {

namespace {

using HypothesisFinder = void(const ExaminedPattern&, std::vector<Hypothesis>&);

// The hypotheses of these functions, in the order of the functions.
std::vector<Hypothesis> found_by(std::initializer_list<HypothesisFinder*> finders,
                                 const ExaminedPattern& of) {
  std::vector<Hypothesis> made;
  for (HypothesisFinder* const find : finders) find(of, made);
  return made;
}

void unequal_blocks(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  made = block_hypotheses(of.pattern);
}

std::vector<Hypothesis> nearer(const ExaminedPattern& of) {
  std::vector<Hypothesis> made;
  hypotheses::near_footholds(of, made);
  hypotheses::lesser_turns(of, made);
  // If a motion cannot be sampled, smaller swings are tried later (small_swings()), because another
  // change may keep more of the motion.
  if (of.found.errors != kUnsampled) hypotheses::smaller_swings(of, made, hypotheses::kMildShares);
  return made;
}

std::vector<Hypothesis> small_swings(const ExaminedPattern& of) {
  std::vector<Hypothesis> made;
  if (of.found.errors == kUnsampled) hypotheses::smaller_swings(of, made, hypotheses::kMildShares);
  hypotheses::smaller_swings(of, made, hypotheses::kSmallShares);
  return made;
}

std::vector<Hypothesis> paces(const ExaminedPattern& of) {
  std::vector<Hypothesis> made;
  hypotheses::cog_height(of, made);
  hypotheses::superfluous_keys(of, made);
  if (of.pattern.table || of.pattern.correction) return made;
  hypotheses::lower_take_offs(of, made);
  hypotheses::shorter_flights(of, made);
  // For slight errors, shorter times are also tried, because the COG sways less if the steps are
  // quicker.
  const std::vector<double> usual = {1.25, 1.6, 2.0, 3.0, 5.0},
                            slight = {1.03, 0.9, 1.1, 0.8, 1.25};
  for (const double factor : of.found.slight ? slight : usual)
    made.push_back({Rank::pace,
                    {"/phases", "the motion takes " + hypotheses::seconds(of.pattern.duration()),
                     "with all times multiplied by " + text::brief(factor)},
                    [&of, factor](Pattern& p) { p = retimed(of.model, p, factor); }});
  return made;
}

}  // namespace

bool is_repeated(const Pattern& pattern, const std::string& place) {
  const auto rounds = [&](const auto& items) {
    return std::count_if(items.begin(), items.end(),
                         [&](const auto& item) { return item.pointer == place; });
  };
  return !place.empty() && (rounds(pattern.phases) > 1 || rounds(pattern.keyframes) > 1);
}

Hypotheses::Hypotheses(const RobotModel& model, const Pattern& pattern, const TrialOutcome& found)
    : examined_(std::make_unique<const ExaminedPattern>(model, pattern, found)) {}

Hypotheses::~Hypotheses() = default;

const std::vector<WrittenValue>& Hypotheses::values() const { return examined_->values; }

std::vector<Hypothesis> Hypotheses::of(Kind kind) const {
  switch (kind) {
    case Kind::units:
      return found_by({hypotheses::angle_units, hypotheses::time_units, hypotheses::stretched_keys,
                       hypotheses::length_units, hypotheses::target_units},
                      *examined_);
    case Kind::supports:
      return found_by({hypotheses::zmp_keys}, *examined_);
    case Kind::times:
      return found_by(
          {unequal_blocks, hypotheses::ground_heights, hypotheses::turns,
           hypotheses::trunk_headings, hypotheses::level_feet, hypotheses::stoops,
           hypotheses::missing_flight_keys, hypotheses::all_sides, hypotheses::crossed_footholds,
           hypotheses::key_times, hypotheses::phase_times},
          *examined_);
    case Kind::irregular:
      return found_by({unequal_blocks, hypotheses::ground_heights, hypotheses::phase_times,
                       hypotheses::foothold_exchanges, hypotheses::zmp_sides, hypotheses::zmp_keys,
                       hypotheses::all_zmp_keys, hypotheses::turns, hypotheses::trunk_headings,
                       hypotheses::swings, hypotheses::double_supports, hypotheses::leg_keys,
                       hypotheses::unlike_sides, hypotheses::interpolations, hypotheses::rests,
                       hypotheses::level_feet, hypotheses::stoops},
                      *examined_);
    case Kind::exchanges:
      return found_by({hypotheses::footholds, hypotheses::swapped_axes, hypotheses::zmp_sides,
                       hypotheses::all_zmp_keys, hypotheses::phase_sides, hypotheses::starts,
                       hypotheses::key_sides, hypotheses::unlike_sides},
                      *examined_);
    case Kind::missing:
      return found_by({hypotheses::swings, hypotheses::double_supports, hypotheses::leg_keys,
                       hypotheses::interpolations, hypotheses::level_cog, hypotheses::held_cog,
                       hypotheses::rests},
                      *examined_);
    case Kind::nearer:
      return nearer(*examined_);
    case Kind::paces:
      return paces(*examined_);
    case Kind::small_swings:
      return small_swings(*examined_);
    case Kind::hops:
      if (examined_->pattern.table || examined_->pattern.correction) return {};
      return found_by({hypotheses::smaller_hops}, *examined_);
    case Kind::room:
      if (examined_->pattern.table || examined_->pattern.correction) return {};
      return found_by({hypotheses::arms_aside, hypotheses::lesser_shifts}, *examined_);
  }
  return {};
}

}  // namespace ayumi
