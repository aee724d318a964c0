// Rows that a recording lost, on synthetic recordings whose joints have delays of their own.
#include "ayumi/identify/lost_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/math/random.hpp"

namespace ayumi::test {
namespace {

using Eigen::Index;

constexpr double kRow = 0.001;        // time between rows [s]
constexpr double kAngleNoise = 2e-4;  // noise of the measured angles [rad]

constexpr Index kJoints = 10, kFirst = 5;
const std::vector<Index> kAll = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};

// Ten joints for 24 s. With `one_after_the_other`, five of them move until 12 s and the others
// afterwards; otherwise all move all the time.
AngleTable commands(bool one_after_the_other) {
  AngleTable table;
  table.dt = kRow;
  table.has.assign(kJoints, 1);
  table.theta = Eigen::MatrixXd::Zero(24000, kJoints);
  for (Index k = 0; k < table.theta.rows(); ++k)
    for (Index j = 0; j < kJoints; ++j) {
      const double t = kRow * static_cast<double>(k), begin = j < kFirst ? 0.0 : 12.0,
                   end = one_after_the_other ? begin + 11.5 : 24.0,
                   s = one_after_the_other ? t - begin : t;
      if (one_after_the_other && (t < begin || t > end)) continue;
      const double fade = std::sin(M_PI * s / (one_after_the_other ? 11.5 : 24.0));
      const double n = static_cast<double>(j);
      table.theta(k, j) =
          0.3 * fade * (std::sin((3 + 0.4 * n) * s + n) + 0.4 * std::sin((7.1 + 0.5 * n) * s));
    }
  return table;
}

// The answer, in which the first five joints are 5 ms late and the others 8.3 ms. From row `at` on,
// `lost` rows are missing; if the number is negative, the row is repeated.
AngleTable recording(const AngleTable& command, Index at = 0, Index lost = 0) {
  AngleTable table = command;
  Random random(7);
  for (Index k = 0; k < table.theta.rows(); ++k)
    for (Index j = 0; j < kJoints; ++j) {
      const Index row = lost == 0 || k < at ? k : lost > 0 ? k + lost : std::max(at, k + lost);
      table.theta(k, j) =
          angle_at(command, j, kRow * static_cast<double>(row) - (j < kFirst ? 0.005 : 0.0083)) +
          kAngleNoise * random.normal();
    }
  return table;
}

TEST(LostRows, JointsWithOtherDelaysThatMoveLaterAreNoLostRows) {
  const AngleTable command = commands(true);
  const LostRows lost = lost_rows(command, recording(command), kAll, 0.006);
  EXPECT_FALSE(lost.found) << lost_rows_words(lost, command);
}

TEST(LostRows, AreFoundWhereJointsMove) {
  for (const bool one_after_the_other : {false, true})
    for (const Index rows : {2, -2}) {
      const AngleTable command = commands(one_after_the_other),
                       measured = recording(command, 6000, rows);
      const LostRows lost = lost_rows(command, measured, kAll, 0.006);
      ASSERT_TRUE(lost.found) << rows;
      EXPECT_TRUE(lost.exact) << rows;
      EXPECT_NEAR(static_cast<double>(lost.row), 6000, 3) << rows;
      EXPECT_EQ(lost.rows, static_cast<double>(rows));
    }
}

// The message only advises a time column if there is none.
TEST(LostRows, TheRemedyFitsTheFile) {
  const AngleTable command = commands(false);
  AngleTable measured = recording(command, 6000, 2);
  const LostRows lost = lost_rows(command, measured, kAll, 0.006);
  EXPECT_NE(lost_rows_words(lost, measured).find("give the rows a time column"), std::string::npos);
  measured.timed = true;
  EXPECT_EQ(lost_rows_words(lost, measured).find("give the rows a time column"), std::string::npos);
}

}  // namespace
}  // namespace ayumi::test
