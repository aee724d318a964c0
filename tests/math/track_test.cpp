#include "ayumi/math/track.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ayumi/base/error.hpp"

namespace ayumi {
namespace {

const Interpolation kAll[] = {Interpolation::linear, Interpolation::cubic,
                              Interpolation::minimum_jerk, Interpolation::hold,
                              Interpolation::spline};

std::vector<TrackKey> random_keys(unsigned seed, int count, bool mixed, Interpolation way) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(0.1, 1.0);
  std::vector<TrackKey> keys;
  double t = -0.3;
  for (int i = 0; i < count; ++i) {
    t += uniform(engine);
    keys.push_back({t, 4 * uniform(engine) - 2, mixed ? kAll[engine() % 5] : way});
  }
  return keys;
}

TEST(Track, PassesThroughItsKeysAndHoldsOutside) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto keys = random_keys(seed, 7, true, Interpolation::linear);
    const Track track(keys);
    for (const TrackKey& key : keys) EXPECT_NEAR(track.at(key.t).value, key.value, 1e-12);
    EXPECT_EQ(track.at(keys.front().t - 5).value, keys.front().value);
    EXPECT_EQ(track.at(keys.back().t + 5).value, keys.back().value);
    EXPECT_EQ(track.at(keys.back().t + 5).rate, 0);
  }
}

// For a straight track through keys with many different spacings, the right segment is always
// found.
TEST(Track, FindsTheSegmentHoweverTheKeysAreSpaced) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<TrackKey> keys = {{-1.0, 0.5, Interpolation::linear}};
    const double spread = trial % 5;
    const int count = 2 + static_cast<int>(engine() % 60);
    for (int i = 0; i < count; ++i)
      keys.push_back({keys.back().t + std::pow(10.0, -spread * uniform(engine)), uniform(engine),
                      Interpolation::linear});
    const Track track(keys);
    for (size_t i = 0; i + 1 < keys.size(); ++i)
      for (const double share : {0.0, 0.25, 0.999}) {
        const double expected = keys[i].value + share * (keys[i + 1].value - keys[i].value);
        const double t = keys[i].t + share * (keys[i + 1].t - keys[i].t);
        EXPECT_NEAR(track.at(t).value, expected, 1e-9) << trial << " " << i;
      }
  }
}

TEST(Track, DerivativesAgreeWithDifferences) {
  const double h = 1e-5;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto keys = random_keys(seed, 6, true, Interpolation::linear);
    const Track track(keys);
    for (size_t i = 0; i + 1 < keys.size(); ++i)
      for (const double u : {0.2, 0.5, 0.9}) {
        const double t = keys[i].t + u * (keys[i + 1].t - keys[i].t);
        const TrackPoint p = track.at(t), a = track.at(t - h), b = track.at(t + h);
        EXPECT_NEAR(p.rate, (b.value - a.value) / (2 * h), 1e-5);
        EXPECT_NEAR(p.acceleration, (b.rate - a.rate) / (2 * h), 1e-4);
      }
  }
}

TEST(Track, SmoothnessAtTheKeys) {
  const double h = 1e-9;
  for (const Interpolation way :
       {Interpolation::cubic, Interpolation::minimum_jerk, Interpolation::spline}) {
    const auto keys = random_keys(5, 8, false, way);
    const Track track(keys);
    for (size_t i = 1; i + 1 < keys.size(); ++i) {
      const TrackPoint before = track.at(keys[i].t - h), after = track.at(keys[i].t + h);
      EXPECT_NEAR(before.rate, after.rate, 1e-5);
      if (way != Interpolation::cubic) {
        EXPECT_NEAR(before.acceleration, after.acceleration, 1e-4);
      }
      if (way == Interpolation::minimum_jerk) {
        EXPECT_NEAR(after.rate, 0, 1e-6);
      }
    }
    EXPECT_NEAR(track.at(keys.front().t + h).rate, 0, 1e-5);
    EXPECT_NEAR(track.at(keys.back().t - h).rate, 0, 1e-5);
  }
}

TEST(Track, SplineReproducesACubicAndHoldJumpsAtTheKey) {
  // u^2 (3 - 2 u) is at rest at 0 and 1: a clamped spline through its points is the cubic itself.
  std::vector<TrackKey> keys;
  for (const double u : {0.0, 0.15, 0.4, 0.7, 1.0})
    keys.push_back({u, u * u * (3 - 2 * u), Interpolation::spline});
  const Track track(keys);
  for (double u = 0; u < 1; u += 0.01) EXPECT_NEAR(track.at(u).value, u * u * (3 - 2 * u), 1e-14);

  const Track hold({{0, 1, Interpolation::hold}, {1, 3, Interpolation::hold}});
  EXPECT_EQ(hold.at(0.999).value, 1);
  EXPECT_EQ(hold.at(1).value, 3);
}

TEST(Track, RefusesTimesThatDoNotIncrease) {
  EXPECT_THROW(Track({{0, 1}, {0, 2}}), Error);
  EXPECT_THROW(Track(std::vector<TrackKey>{}), Error);
  EXPECT_THROW(Track({{0, NAN}}), Error);
}

}  // namespace
}  // namespace ayumi
