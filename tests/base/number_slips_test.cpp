#include "ayumi/base/number_slips.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace ayumi {
namespace {

bool may_mean(double typed, double meant) {
  const std::vector<double> slips = number_slips(typed);
  return std::any_of(slips.begin(), slips.end(),
                     [&](double slip) { return std::abs(slip - meant) < 1e-12; });
}

TEST(NumberSlips, AreThoseOfAKeyboard) {
  EXPECT_TRUE(may_mean(2300, 2.3));
  EXPECT_TRUE(may_mean(0.9, 0.09));
  EXPECT_TRUE(may_mean(2.03, 2.3));
  EXPECT_TRUE(may_mean(1.21, 1.12));
  EXPECT_TRUE(may_mean(1.5, 5.1));
  EXPECT_TRUE(may_mean(-1.21, -1.12));
  EXPECT_FALSE(may_mean(1.5, 1.6));
}

TEST(NumberSlips, NeverTheNumberItself) {
  for (const double typed : {1.0, 11.0, 2.2, 100.0, 0.05, 1e-9, 1e21})
    EXPECT_FALSE(may_mean(typed, typed));
}

}  // namespace
}  // namespace ayumi
