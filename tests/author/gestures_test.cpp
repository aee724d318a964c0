// Generated gestures on both robots reach what is asked for in metres and degrees.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/biped.hpp"
#include "tests/support/robot_motions.hpp"

namespace ayumi::test {
namespace {

using Eigen::Vector3d;

class Gesture : public testing::TestWithParam<const char*> {
 protected:
  const RobotModel& model = bundled_robot(GetParam());

  CommandSeries consistent(const Pattern& pattern) const {
    const CommandSeries series = sample(model, pattern);
    EXPECT_TRUE(check_consistency(model, series).consistent);
    return series;
  }
  double pitch_of_trunk(const CommandSample& sample) const {
    RobotData data(model);
    update_positions(model, sample.state, data);
    return matrix_to_rpy(data.rotation[static_cast<size_t>(model.trunk_body())]).y();
  }
  // The motion ends where it began, at rest.
  static void expect_closed(const CommandSeries& series, double near = 1e-6) {
    const RobotState &a = series.samples.front().state, &b = series.samples.back().state;
    EXPECT_LT((a.theta - b.theta).cwiseAbs().maxCoeff(), near);
    EXPECT_LT(b.velocity().norm(), 1e-3);
  }
};

TEST_P(Gesture, BowLeansTheTrunk) {
  BowParameters p = bow_defaults(model);
  p.angle = 0.4;
  const CommandSeries series = consistent(bow_pattern(model, p));
  double most = 0;
  for (const CommandSample& sample : series.samples) most = std::max(most, pitch_of_trunk(sample));
  EXPECT_NEAR(most, 0.4, 1e-4);
  expect_closed(series, 1e-3);  // keys of the height are written in units of 0.1 mm
}

// An author reads and changes the angles: they are written in tenths of a degree, and requested
// values stay as they are.
TEST_P(Gesture, AnglesAreThoseThatAnAuthorWouldWrite) {
  constexpr double degree = M_PI / 180;
  BowParameters bow = bow_defaults(model);
  bow.angle = 28.6 * degree;
  const Pattern bent = bow_pattern(model, bow);
  const bool there =
      std::any_of(bent.keyframes.begin(), bent.keyframes.end(),
                  [&](const auto& key) { return key.torso && key.torso->y() == 28.6 * degree; });
  EXPECT_TRUE(there);
  const Pattern wave = wave_pattern(model, wave_defaults(model));
  for (const auto& [joint, angle] : wave.keyframes[3].joints) {
    const double tenths = std::round(10 * angle / degree);
    const bool at_home = angle == model.rest_state().theta[model.find_dof(joint)];
    EXPECT_TRUE(at_home || angle == tenths / 10 * degree) << joint << " " << angle / degree;
  }
}

// The whole hand is above its shoulder, and moves to and fro as often as asked.
TEST_P(Gesture, WaveRaisesTheHand) {
  for (const Side side : {Side::left, Side::right}) {
    WaveParameters p = wave_defaults(model);
    p.side = side;
    p.cycles = 3;
    const Pattern pattern = wave_pattern(model, p);
    const CommandSeries series = consistent(pattern);
    expect_closed(series);
    const std::string joint = pattern.keyframes[2].joints.begin()->first;
    EXPECT_EQ(joint[0], side == Side::left ? 'l' : 'r');
    // The body of the hand: the one farthest down the arm.
    int hand = 0;
    for (const auto& [name, angle] : pattern.keyframes[2].joints)
      hand = std::max(hand, model.dofs()[static_cast<size_t>(model.find_dof(name))].body);
    RobotData data(model);
    const auto place = [&](double t) {
      update_positions(model, series.samples[static_cast<size_t>(std::lround(t / series.dt))].state,
                       data);
      return Vector3d(data.pose(hand) *
                      (2 * model.bodies()[static_cast<size_t>(hand)].inertia.com));
    };
    const double low = place(0).z();
    std::vector<double> times;
    for (size_t i = 2; i + 1 < pattern.keyframes.size(); ++i)
      times.push_back(pattern.keyframes[i].t);
    ASSERT_EQ(times.size(), 7u);
    for (size_t i = 0; i < times.size(); ++i) {
      EXPECT_GT(place(times[i]).z(), low + 0.1 * series.samples[0].cog.z());
      if (i == 0) continue;
      EXPECT_GT((place(times[i]) - place(times[i - 1])).norm(), 0.02);
    }
  }
}

TEST_P(Gesture, KickBringsTheFootAhead) {
  for (const Side side : {Side::left, Side::right}) {
    KickParameters p = kick_defaults(model);
    p.side = side;
    const CommandSeries series = consistent(kick_pattern(model, p));
    const auto foot = static_cast<size_t>(side);
    const Vector3d start = series.samples.front().feet[foot].translation();
    Vector3d most = Vector3d::Constant(-1);
    for (const CommandSample& sample : series.samples) {
      most = most.cwiseMax(sample.feet[foot].translation() - start);
      EXPECT_LT((sample.feet[1 - foot].translation() -
                 series.samples.front().feet[1 - foot].translation())
                    .norm(),
                1e-12);
    }
    EXPECT_NEAR(most.x(), p.length, 2e-4);
    EXPECT_NEAR(most.z(), p.height, 2e-4);
    EXPECT_LT((series.samples.back().feet[foot].translation() - start).norm(), 1e-4);
    expect_closed(series);
  }
}

TEST_P(Gesture, SitAndRiseAreOneMotionToAndFro) {
  const SeatParameters p = seat_defaults(model);
  const CommandSeries down = consistent(sit_pattern(model, p));
  const CommandSeries up = consistent(rise_pattern(model, p));
  EXPECT_NEAR(down.samples.front().cog.z() - down.samples.back().cog.z(), p.depth, 1e-4);
  ASSERT_EQ(down.samples.size(), up.samples.size());
  double lean = 0;
  for (size_t k = 0; k < down.samples.size(); ++k) {
    const CommandSample& back = up.samples[up.samples.size() - 1 - k];
    EXPECT_NEAR(down.samples[k].cog.z(), back.cog.z(), 1e-6);
    lean = std::max(lean, pitch_of_trunk(down.samples[k]));
  }
  EXPECT_NEAR(lean, p.lean, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Robots, Gesture, testing::Values("hoap1", "humanoid30"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Gestures, RefuseWhatIsOutOfRange) {
  const RobotModel model = biped();
  const auto message = [](const auto& make) -> std::string {
    try {
      make();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message([&] { bow_pattern(model, {.angle = 3}); }).find("bow: angle 171"),
            std::string::npos);
  EXPECT_NE(message([&] { kick_pattern(model, {.length = 9}); }).find("kick: length 9 m"),
            std::string::npos);
  EXPECT_NE(message([&] { sit_pattern(model, {.depth = -1}); }).find("sit: depth -1 m"),
            std::string::npos);
  EXPECT_NE(message([&] { wave_pattern(model, {.cycles = 0}); }).find("wave: cycles 0"),
            std::string::npos);
}

}  // namespace
}  // namespace ayumi::test
