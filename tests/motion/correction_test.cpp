#include "ayumi/motion/correction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/motion/controller_spec.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/biped.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

CorrectionTrack random_track(const RobotModel& model, double scale) {
  test::Random random(11);
  CorrectionTrack track;
  track.begin = 0.3;
  track.spacing = 0.2;
  track.joints = {"l_knee", "r_shoulder"};
  track.coefficients = Eigen::MatrixXd::Zero(14, 8);
  for (int i = 3; i < 11; ++i) track.coefficients.row(i) = random.vector(8, scale).transpose();
  EXPECT_GE(model.find_dof("l_knee"), 0);
  return track;
}

TEST(Correction, WeightsSumToOneAndHaveTheirDerivatives) {
  CorrectionTrack track;
  track.begin = 0.3;
  track.spacing = 0.2;
  track.coefficients = Eigen::MatrixXd::Zero(10, 6);
  const double h = 1e-6;
  for (double t = 0.31; t < 1.69; t += 0.013) {
    const SplineWeights w = correction_weights(track, t);
    EXPECT_NEAR(w.value.sum(), 1, 1e-14);
    EXPECT_NEAR(w.rate.sum(), 0, 1e-12);
    EXPECT_GE(w.first, 0);
    EXPECT_LE(w.first + 3, 9);
    const SplineWeights a = correction_weights(track, t - h), b = correction_weights(track, t + h);
    if (a.first != w.first || b.first != w.first) continue;
    EXPECT_LT(((b.value - a.value) / (2 * h) - w.rate).norm(), 1e-7);
    EXPECT_LT(((b.rate - a.rate) / (2 * h) - w.acceleration).norm(), 1e-6);
  }
  EXPECT_EQ(correction_weights(track, 0.29).value.norm(), 0);
  EXPECT_NEAR(correction_weights(track, 1.7 - 1e-12).value.sum(), 1, 1e-12);
  EXPECT_EQ(correction_weights(track, 1.71).value.norm(), 0);
}

// A linear ramp of coefficients gives a line: the times of the knots are those of the middle
// control points.
TEST(Correction, ALineIsReproduced) {
  CorrectionTrack track;
  track.begin = 0;
  track.spacing = 0.1;
  track.coefficients = Eigen::MatrixXd::Zero(12, 6);
  for (int i = 0; i < 12; ++i) track.coefficients(i, 0) = 0.1 * (i - 1);
  for (double t = 0; t < 0.9; t += 0.03) {
    const SplineWeights w = correction_weights(track, t);
    EXPECT_NEAR(track.coefficients.col(0).segment<4>(w.first).dot(w.value), t, 1e-14);
  }
}

TEST(Correction, VelocitiesAndAccelerationsFollow) {
  const RobotModel model = test::biped();
  WalkParameters p;
  p.steps = 2;
  const CommandSeries series = sample(model, walk_pattern(model, p));
  // For 0.3 rad, the closed form of the rotation's Jacobian is used, and for 0.01 rad its series.
  for (const double scale : {0.01, 0.3}) {
    const CommandSeries corrected = apply_correction(model, series, random_track(model, scale));
    std::vector<CommandSample> again = corrected.samples;
    fill_rates(again, series.dt, true);
    for (size_t k = 10; k + 10 < again.size(); ++k) {
      EXPECT_LT((again[k].state.velocity() - corrected.samples[k].state.velocity()).norm(), 2e-5);
      EXPECT_LT((again[k].acceleration - corrected.samples[k].acceleration).norm(),
                0.1 * (1 + scale));
      EXPECT_LT((again[k].dcog - corrected.samples[k].dcog).norm(), 2e-5);
      EXPECT_LT((again[k].ddcog - corrected.samples[k].ddcog).norm(), 0.05);
    }
    EXPECT_EQ(corrected.samples[5].state.theta, series.samples[5].state.theta);
    EXPECT_NE(corrected.samples[1500].state.theta, series.samples[1500].state.theta);
  }
}

TEST(Correction, IsAppliedByTheSampler) {
  const RobotModel model = test::biped();
  Pattern pattern = stand_pattern(model, 2.0);
  const CommandSeries plain = sample(model, pattern);
  pattern.correction = random_track(model, 0.02);
  const CommandSeries corrected = sample(model, pattern);
  const CommandSeries expected = apply_correction(model, plain, *pattern.correction);
  EXPECT_EQ(corrected.samples[1000].state.theta, expected.samples[1000].state.theta);
  EXPECT_EQ(corrected.samples[1000].zmp, expected.samples[1000].zmp);
}

TEST(Correction, NamesWhatIsWrong) {
  const RobotModel model = test::biped();
  const CommandSeries series = sample(model, stand_pattern(model, 0.2));
  const auto message = [&](const CorrectionTrack& track) -> std::string {
    try {
      apply_correction(model, series, track);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  CorrectionTrack track = random_track(model, 0.01);
  track.joints[0] = "l_kne";
  EXPECT_NE(message(track).find("did you mean 'l_knee'"), std::string::npos);
  track.joints.pop_back();
  EXPECT_NE(message(track).find("8 columns"), std::string::npos);
}

// A track that does not fit the robot, or that is no valid track, is refused.
TEST(Correction, TracksThatDoNotFitAreRefused) {
  const RobotModel model = test::biped();
  const CommandSeries series = sample(model, stand_pattern(model, 0.5));
  const auto refused = [&](const CorrectionTrack& track) {
    return test::error_message([&] { apply_correction(model, series, track); },
                               ErrorCode::bad_pattern);
  };
  const CorrectionTrack good = random_track(model, 0.001);
  EXPECT_EQ(refused(good), "no error");
  CorrectionTrack track = good;
  track.joints.pop_back();
  EXPECT_EQ(refused(track), "correction: there are 8 columns, but the base and the joints need 7");
  const std::string finite =
      "correction: the spacing must be above 0 and every coefficient a finite number";
  for (const double spacing : {0.0, -0.1, std::nan("")}) {
    track = good;
    track.spacing = spacing;
    EXPECT_EQ(refused(track), finite) << spacing;
  }
  track = good;
  track.begin = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refused(track), finite);
  track = good;
  track.coefficients(5, 7) = std::nan("");
  EXPECT_EQ(refused(track), finite);
  track = good;
  track.joints[1] = "r_shouldr";
  EXPECT_NE(refused(track).find("r_shouldr"), std::string::npos) << refused(track);
}

TEST(Controllers, AnUnknownNameIsRefusedWithTheNearest) {
  for (const std::string& name : controller_names())
    EXPECT_EQ(name_of(controller_type(name)), name);
  const std::string message =
      test::error_message([] { controller_type("dtadd"); }, ErrorCode::usage);
  EXPECT_NE(message.find("unknown controller 'dtadd'; did you mean 'dtad'? (known: "),
            std::string::npos)
      << message;
}

}  // namespace
}  // namespace ayumi
