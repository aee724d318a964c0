#pragma once
// From a correction that passes the check to the least one that does. The rounds of a repair keep a
// little more than the check asks for, so that what happens between their instants passes too. Here
// rows stand at the check's own limits; where the result is beyond them between two instants, more
// instants are put there, and what is left of that is taken up by a share of the correction begun
// with.

#include "ayumi/repair/correction_problem.hpp"

namespace ayumi {

/// `spec` with every limit where the check has it, less a hair, and margins of the ZMP as they were
/// `asked` for and were to be had. Where `safety` is above 0, feet, clearances and the ZMP keep
/// what is wanted beyond the check's limits; else that goes too.
CorrectionSpec at_limits(const CorrectionSpec& spec, const CorrectionSpec& asked, double safety);

/// The times of every error, to be instants.
void add_instants(const ConsistencyReport& report, double dt, std::vector<double>& instants);

/// a + share (b - a), both on the same knots.
CorrectionTrack between(const CorrectionTrack& a, const CorrectionTrack& b, double share);

}  // namespace ayumi
