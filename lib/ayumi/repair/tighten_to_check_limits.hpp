#pragma once
// From a correction that passes the check to the least one that does. The rounds of a repair keep a
// small distance from the check's limits, so that what happens between two collocation points
// passes too. Here the rows stand at the check's own limits. Where the result then violates them
// between two points, points are added there; what remains is removed by going back a small share
// of the way to the correction that passed.

#include "ayumi/repair/repair_state.hpp"

namespace ayumi {

/// `spec` with every limit where the check has it, less rounding, and with the ZMP margins that
/// were `asked` for and could be reached. With a robustness factor above 0, feet, clearances and
/// the ZMP keep what is wanted beyond the check's limits; with 0 they do not.
CorrectionSpec at_check_limits(const CorrectionSpec& spec, const CorrectionSpec& asked,
                               double robustness);

/// Adds the times of every error, to be collocation points.
void add_error_times(const ConsistencyReport& report, double dt, std::vector<double>& times);

/// a + share (b - a); both have the same knots.
CorrectionTrack between(const CorrectionTrack& a, const CorrectionTrack& b, double share);

/// Replaces the result, which passes, by the least one that passes too; keeps it where none is
/// found.
void tighten(RepairState& state);

}  // namespace ayumi
