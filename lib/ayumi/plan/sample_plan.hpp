#pragma once
// The motion that follows from the plan of a pattern alone.

#include <array>
#include <optional>

#include "ayumi/math/track.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi {

/// How the COG of a plan moves along the ground.
enum class PlannedCog {
  keys,  ///< its keys, and the ZMP in the axes without keys
  /// The ZMP: its keys and then, if time is left, the last place that the keys give to the COG.
  /// Without keys of the ZMP, it moves over the centres of the supporting soles, from the first to
  /// the last place that the keys give to the COG.
  zmp
};

/// Replaces parts of a pattern for sample_plan().
struct PlanLead {
  PlannedCog cog = PlannedCog::keys;
  /// The ZMP in the world [m], in place of the ZMP of the phases and of keys.
  std::optional<std::array<Track, 3>> zmp = {};
  /// Time over which the feet take up the COG's speed in a flight [s].
  double flight_ramp = kFlightRamp;
};

/// The motion that inverse kinematics finds for the contacts, the planned feet and the planned COG
/// of a pattern. Keys and table columns of leg joints, hands and gaze are left out. If the legs
/// cannot reach the feet, the motion goes smoothly through the nearest postures; so a repair can
/// start from it. Throws the same errors as sample(), but never because a foot is out of reach.
CommandSeries sample_plan(const RobotModel& model, const Pattern& pattern,
                          const SampleOptions& options = {}, const Progress& progress = {},
                          const PlanLead& lead = {});

}  // namespace ayumi
