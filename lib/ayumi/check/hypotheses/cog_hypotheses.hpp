#pragma once
// Mistakes in heights and places of the COG that the legs cannot reach, and in times that are too
// short or too long for its movement. Each function adds to `made` the changes of the pattern that
// it describes.

#include <vector>

#include "ayumi/check/hypotheses/examined_pattern.hpp"
#include "ayumi/check/mistake_hypotheses.hpp"

namespace ayumi::hypotheses {

/// Another time between the lowest key of the COG and a lift-off or a landing.
void stoops(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// Keys that keep the COG down while a foot is lifted.
void level_cog(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// The removal of keys that hold the COG at a place that the feet have left.
void held_cog(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// A lower COG at both ends of flights with straight legs.
void lower_take_offs(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// A longer rest at the beginning or the end.
void rests(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// A missing key of the COG height at one end of a flight.
void missing_flight_keys(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// Shorter flights.
void shorter_flights(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// Shorter flights from legs that are bent more, with pushes and landings that fit.
void smaller_hops(const ExaminedPattern& of, std::vector<Hypothesis>& made);
/// Another COG height.
void cog_height(const ExaminedPattern& of, std::vector<Hypothesis>& made);

}  // namespace ayumi::hypotheses
