#pragma once
// Finds the smallest correction that passes the check, starting from one that passes. The rounds of
// a repair keep a small distance from the check's limits, so that the motion between two
// collocation points passes too. Here the rows have the check's own limits. If the result then
// violates limits between two points, points are added there. A remaining violation is removed by a
// small step back towards the correction that passed.

#include "ayumi/repair/repair_state.hpp"

namespace ayumi {

/// `spec` with the limits of the check, reduced only for rounding, and with the ZMP margins that
/// were `asked` for and could be reached. With a robustness factor above 0, feet, clearances and
/// the ZMP keep the goals beyond the check's limits; with 0 they do not.
CorrectionSpec at_check_limits(const CorrectionSpec& spec, const CorrectionSpec& asked,
                               double robustness);

/// Computes a + share (b - a); both have the same knots.
CorrectionTrack between(const CorrectionTrack& a, const CorrectionTrack& b, double share);

/// Replaces the result, which passes, by the smallest correction that also passes. Keeps the result
/// if none is found.
void tighten(RepairState& state);

}  // namespace ayumi
