#include "ayumi/math/quintic.hpp"

#include <gtest/gtest.h>

namespace ayumi {
namespace {

TEST(Quintic, MeetsBothEnds) {
  const QuinticEnd from{0.2, 1, 0.5, -3}, to{0.9, 2, -1.5, 4};
  for (const QuinticEnd& end : {from, to}) {
    const TrackPoint p = quintic_at(from, to, end.t);
    EXPECT_NEAR(p.value, end.value, 1e-13);
    EXPECT_NEAR(p.rate, end.rate, 1e-12);
    EXPECT_NEAR(p.acceleration, end.acceleration, 1e-11);
  }
  // The rates are the derivatives of the values.
  constexpr double h = 1e-6;
  for (double t = 0.25; t < 0.9; t += 0.1) {
    const TrackPoint a = quintic_at(from, to, t - h), b = quintic_at(from, to, t + h);
    EXPECT_NEAR((b.value - a.value) / (2 * h), quintic_at(from, to, t).rate, 1e-6);
    EXPECT_NEAR((b.rate - a.rate) / (2 * h), quintic_at(from, to, t).acceleration, 1e-6);
  }
}

TEST(Quintic, OfAParabolaIsTheParabola) {
  const auto fall = [](double t) { return QuinticEnd{t, 2 + 3 * t - 4.5 * t * t, 3 - 9 * t, -9}; };
  for (double t = 0; t < 0.5; t += 0.03) {
    EXPECT_NEAR(quintic_at(fall(0), fall(0.5), t).value, fall(t).value, 1e-13);
    EXPECT_NEAR(quintic_at(fall(0), fall(0.5), t).acceleration, -9, 1e-10);
  }
}

TEST(Quintic, AsATrackKeepsItsShape) {
  const QuinticEnd rest{0, 0, 0, 0}, off{0.12, 0.03, 0.7, -9.8}, down{0.26, 0.03, -0.7, -9.8},
      still{0.5, 0, 0, 0};
  const Track track(quintic_keys({rest, off, down, still}));
  for (double t = 0.001; t < 0.12; t += 0.002) {
    EXPECT_NEAR(track.at(t).value, quintic_at(rest, off, t).value, 2e-6);
    EXPECT_NEAR(track.at(t).rate, quintic_at(rest, off, t).rate, 2e-3);
  }
  EXPECT_EQ(track.at(0.6).value, 0);
}

}  // namespace
}  // namespace ayumi
