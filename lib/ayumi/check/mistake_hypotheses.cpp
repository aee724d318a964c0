#include "ayumi/check/mistake_hypotheses.hpp"

#include <algorithm>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/block_hypotheses.hpp"
#include "ayumi/check/hypotheses/cog_hypotheses.hpp"
#include "ayumi/check/hypotheses/exchange_hypotheses.hpp"
#include "ayumi/check/hypotheses/foothold_hypotheses.hpp"
#include "ayumi/check/hypotheses/part_hypotheses.hpp"
#include "ayumi/check/hypotheses/swing_hypotheses.hpp"
#include "ayumi/check/hypotheses/time_hypotheses.hpp"
#include "ayumi/check/hypotheses/unit_hypotheses.hpp"
#include "ayumi/check/hypotheses/zmp_hypotheses.hpp"

namespace ayumi {

namespace {

std::vector<Hypothesis> units(const ExaminedPattern& of) {
  std::vector<Hypothesis> made;
  hypotheses::angle_units(of, made);
  hypotheses::time_units(of, made);
  hypotheses::stretched_keys(of, made);
  hypotheses::length_units(of, made);
  hypotheses::target_units(of, made);
  return made;
}

std::vector<Hypothesis> times(const ExaminedPattern& of) {
  std::vector<Hypothesis> made = block_hypotheses(of.pattern);
  hypotheses::ground_heights(of, made);
  hypotheses::turns(of, made);
  hypotheses::level_feet(of, made);
  hypotheses::stoops(of, made);
  hypotheses::all_sides(of, made);
  hypotheses::crossed_footholds(of, made);
  hypotheses::key_times(of, made);
  hypotheses::phase_times(of, made);
  return made;
}

std::vector<Hypothesis> irregular(const ExaminedPattern& of) {
  std::vector<Hypothesis> made = block_hypotheses(of.pattern);
  hypotheses::ground_heights(of, made);
  hypotheses::phase_times(of, made);
  hypotheses::foothold_exchanges(of, made);
  hypotheses::zmp_sides(of, made);
  hypotheses::zmp_keys(of, made);
  hypotheses::all_zmp_keys(of, made);
  hypotheses::turns(of, made);
  hypotheses::swings(of, made);
  hypotheses::double_supports(of, made);
  hypotheses::leg_keys(of, made);
  hypotheses::unlike_sides(of, made);
  hypotheses::interpolations(of, made);
  hypotheses::rests(of, made);
  hypotheses::level_feet(of, made);
  hypotheses::stoops(of, made);
  return made;
}

std::vector<Hypothesis> exchanges(const ExaminedPattern& of) {
  std::vector<Hypothesis> made;
  hypotheses::footholds(of, made);
  hypotheses::swapped_axes(of, made);
  hypotheses::zmp_sides(of, made);
  hypotheses::zmp_keys(of, made);
  hypotheses::all_zmp_keys(of, made);
  hypotheses::phase_sides(of, made);
  hypotheses::starts(of, made);
  hypotheses::key_sides(of, made);
  hypotheses::unlike_sides(of, made);
  return made;
}

std::vector<Hypothesis> missing(const ExaminedPattern& of) {
  std::vector<Hypothesis> made;
  hypotheses::swings(of, made);
  hypotheses::double_supports(of, made);
  hypotheses::leg_keys(of, made);
  hypotheses::interpolations(of, made);
  hypotheses::level_cog(of, made);
  hypotheses::held_cog(of, made);
  hypotheses::rests(of, made);
  return made;
}

std::vector<Hypothesis> nearer(const ExaminedPattern& of) {
  std::vector<Hypothesis> made;
  hypotheses::near_footholds(of, made);
  hypotheses::lesser_turns(of, made);
  // Where a motion cannot be sampled, another change may keep more of it.
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
      return units(*examined_);
    case Kind::times:
      return times(*examined_);
    case Kind::irregular:
      return irregular(*examined_);
    case Kind::exchanges:
      return exchanges(*examined_);
    case Kind::missing:
      return missing(*examined_);
    case Kind::nearer:
      return nearer(*examined_);
    case Kind::paces:
      return paces(*examined_);
    case Kind::small_swings:
      return small_swings(*examined_);
  }
  return {};
}

}  // namespace ayumi
