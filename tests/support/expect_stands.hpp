#pragma once

#include <gtest/gtest.h>

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi::test {

/// Expects that the robot stands at the end, at most this far from its command [m], and that no
/// motor was asked for more than its torque.
inline void expect_stands(const SimulationResult& result, double final_error) {
  EXPECT_EQ(result.outcome, Outcome::stands) << "fell at " << result.fell_at;
  EXPECT_LE(result.final_cog_error, final_error);
  EXPECT_LE(result.torque.ratio, 1 + 1e-9);
}

}  // namespace ayumi::test
