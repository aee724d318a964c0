#include "ayumi/math/random.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace ayumi {
namespace {

TEST(Random, SeveralNormalNumbersAreThoseOfSingleCalls) {
  Random one(3), many(3);
  double sum = 0, square = 0;
  int drawn = 0;
  for (int round = 0; round < 2000; ++round) {
    std::vector<double> numbers(static_cast<size_t>(round % 70));
    many.normals(numbers.data(), static_cast<int>(numbers.size()));
    for (const double x : numbers) {
      ASSERT_EQ(x, one.normal()) << "round " << round;
      sum += x;
      square += x * x;
      ++drawn;
    }
  }
  EXPECT_EQ(one.bits(), many.bits());
  // The tolerances are five standard deviations of the mean and of the mean square of this many
  // numbers.
  EXPECT_NEAR(sum / drawn, 0, 5 / std::sqrt(drawn));
  EXPECT_NEAR(square / drawn, 1, 5 * std::sqrt(2.0 / drawn));
}

}  // namespace
}  // namespace ayumi
