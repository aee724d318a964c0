#include "ayumi/check/consistency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/demand/contact_plan.hpp"
#include "ayumi/demand/motion_demand.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/model/gravity.hpp"
#include "tests/support/check_report.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/limited_biped.hpp"
#include "tests/support/walk.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::Vector3d;

namespace {

const CommandSeries& good_walk() {
  static const CommandSeries series = walk(limited_biped());
  return series;
}

const Finding& find(const ConsistencyReport& r, const std::string& kind) {
  for (const Finding& f : r.findings)
    if (name_of(f.kind) == kind) return f;
  static const Finding none;
  ADD_FAILURE() << "no finding " << kind << "\n" << print(r);
  return none;
}

// The middle of the n-th single support of a walk.
double middle_of_step(int n, const WalkShape& w = {}) {
  return w.lead + n * w.period + 0.5 * (w.period - w.double_support);
}

void bend(CommandSeries& series, const char* joint, double center, double width, double height) {
  const int dof = limited_biped().find_dof(joint);
  for (size_t k = 0; k < series.samples.size(); ++k)
    series.samples[k].state.theta[dof] += height * bump(k * series.dt, center, width);
  complete_series(limited_biped(), series);
}

}  // namespace

TEST(Consistency, GoodMotionsHaveNoFindingAboveInfo) {
  for (const CommandSeries& series : {good_walk(), standing(limited_biped(), 1.0)}) {
    const ConsistencyReport r = check_consistency(limited_biped(), series);
    EXPECT_TRUE(r.consistent);
    for (const Finding& f : r.findings) EXPECT_EQ(f.severity, Severity::info) << print(r);
    EXPECT_GT(r.summary[FindingKind::support_margin], 0.02);
    EXPECT_LT(r.summary[FindingKind::foot_slip], 1e-9);
    EXPECT_EQ(r.profile, "plain");
  }
}

// The report has findings of the samples, of the clearance and of the exported table.
TEST(Consistency, SameReportForAnyNumberOfThreads) {
  CommandSeries series = good_walk();
  bend(series, "l_hip_roll", 1.5, 0.8, 0.5);
  CheckOptions options;
  options.threads = 1;
  const std::string one = check_json(check_consistency(limited_biped(), series, options));
  for (const char* kind : {"self_collision", "table_step", "joint_position"})
    EXPECT_NE(one.find(kind), std::string::npos) << kind << "\n" << one;
  for (const int threads : {2, 3, 8}) {
    options.threads = threads;
    EXPECT_EQ(check_json(check_consistency(limited_biped(), series, options)), one) << threads;
  }
}

TEST(Consistency, CogKeyMoved) {
  CommandSeries series = good_walk();
  for (size_t k = 0; k < series.samples.size(); ++k)
    series.samples[k].cog.x() += 0.015 * bump(k * series.dt, 2.5, 0.6);
  const ConsistencyReport r = check_consistency(limited_biped(), series);
  EXPECT_EQ(error_kinds(r), std::set<std::string>{"cog_residual"}) << print(r);
  const Finding& f = find(r, "cog_residual");
  EXPECT_NEAR(f.at, 2.5, 2 * series.dt);
  EXPECT_NEAR(f.worst, 0.015, 1e-9);
  EXPECT_EQ(f.where, "x");
  EXPECT_NEAR(r.summary[FindingKind::cog_residual], 0.015, 1e-9);
}

TEST(Consistency, ZmpTrackOutside) {
  CommandSeries series = good_walk();
  const double at = middle_of_step(1);  // on the left foot, whose outer edge is 30 mm away
  for (size_t k = 0; k < series.samples.size(); ++k)
    series.samples[k].zmp.y() -= 0.050 * bump(k * series.dt, at, 0.3);
  const ConsistencyReport r = check_consistency(limited_biped(), series);
  EXPECT_EQ(error_kinds(r), std::set<std::string>{"support_margin"}) << print(r);
  EXPECT_NEAR(find(r, "support_margin").at, at, 2 * series.dt);
  EXPECT_NEAR(find(r, "zmp_residual").worst, 0.050, 1e-3);
  EXPECT_EQ(find(r, "zmp_residual").where, "y");
  EXPECT_EQ(find(r, "zmp_residual").follows_from.rfind("support_margin of the right foot at", 0),
            0u);
  EXPECT_NEAR(find(r, "support_margin").worst, -0.020, 2e-3);
  EXPECT_EQ(find(r, "support_margin").where, "right");
}

TEST(Consistency, VerticalForceScaled) {
  CommandSeries series = good_walk();
  size_t worst = 2000;
  for (size_t k = 2000; k <= 2600; ++k) {
    series.samples[k].fz *= 1.1;
    if (series.samples[k].fz > series.samples[worst].fz) worst = k;
  }
  const ConsistencyReport r = check_consistency(limited_biped(), series);
  EXPECT_EQ(error_kinds(r), std::set<std::string>{"fz_residual"}) << print(r);
  const Finding& f = find(r, "fz_residual");
  EXPECT_NEAR(f.at, worst * series.dt, 2 * series.dt);
  EXPECT_NEAR(f.begin, 2.0, 1e-9);
  EXPECT_NEAR(f.end, 2.6, 1e-9);
  EXPECT_LT(f.worst, -0.09 * limited_biped().mass() * kGravity);
}

TEST(Consistency, JointBeyondItsLimit) {
  CommandSeries series = good_walk();
  bend(series, "l_shoulder_pitch", 2.5, 2.0, 2.1);
  const ConsistencyReport r = check_consistency(limited_biped(), series);
  EXPECT_EQ(error_kinds(r), std::set<std::string>{"joint_position"}) << print(r);
  const Finding& f = find(r, "joint_position");
  EXPECT_EQ(f.where, "l_shoulder_pitch");
  EXPECT_NEAR(f.at, 2.5, 2 * series.dt);
  EXPECT_NEAR(f.worst, 2.1, 1e-6);
  EXPECT_EQ(f.limit, 2);
  EXPECT_NE(f.hint.find("5.73 deg"), std::string::npos) << f.hint;
}

TEST(Consistency, JointTooFast) {
  CommandSeries series = good_walk();
  bend(series, "r_elbow", 2.5, 0.5, -0.9);
  const ConsistencyReport r = check_consistency(limited_biped(), series);
  EXPECT_EQ(error_kinds(r), std::set<std::string>{"joint_speed"}) << print(r);
  EXPECT_EQ(find(r, "joint_speed").where, "r_elbow");
  // cos^4 is steepest where tan = 1/sqrt 3, which is a sixth of the width from the top.
  EXPECT_NEAR(std::abs(find(r, "joint_speed").at - 2.5), 0.5 / 6, 2 * series.dt);
}

TEST(Consistency, MotorTooWeak) {
  RobotDescription d = limited_biped_description();
  for (auto& [joint, torque] : d.profiles[0].peak_torque)
    if (joint == "l_knee") torque = 1.0;
  for (auto& [joint, torque] : d.profiles[0].continuous_torque)
    if (joint == "r_knee") torque = 0.5;
  const RobotModel weak(d);
  const ConsistencyReport r = check_consistency(weak, good_walk());
  EXPECT_EQ(error_kinds(r), std::set<std::string>{"joint_torque"});
  EXPECT_EQ(find(r, "joint_torque").where, "l_knee");
  EXPECT_EQ(find(r, "continuous_torque").where, "r_knee");
  EXPECT_EQ(find(r, "continuous_torque").severity, Severity::warning);
}

// The sums of squares are kept for one window only. The test sums each window separately.
TEST(Consistency, MeanTorqueOfAWindowShorterThanTheMotion) {
  RobotDescription d = limited_biped_description();
  d.profiles[0].thermal_window = 0.3;
  const RobotModel model(d);
  const CommandSeries series = good_walk();
  const ConsistencyReport r = check_consistency(model, series);
  const ContactPlan plan = contact_plan(series);
  MotionDynamics motion(model, model.limits(), series, plan);
  const int count = static_cast<int>(series.samples.size());
  const int window = static_cast<int>(std::lround(0.3 / series.dt));
  ASSERT_GT(count, 3 * window);
  Eigen::MatrixXd given = Eigen::MatrixXd::Zero(model.dof_count(), count);
  for (int k = 0; k < count; ++k)
    if (!at_flight_edge(series, k))
      given.col(k) = motion.at(k).torque.cwiseAbs().cwiseMin(model.limits().peak_torque);
  double lasting = 0, at = 0;
  for (int i = 0; i < model.dof_count(); ++i)
    for (int begin = 0; begin + window <= count; ++begin) {
      const double rms = std::sqrt(given.row(i).segment(begin, window).squaredNorm() / window);
      const double share = rms / model.limits().continuous_torque[i];
      if (share > lasting) at = (begin + window - 1) * series.dt;
      lasting = std::max(lasting, share);
    }
  EXPECT_NEAR(r.summary[FindingKind::continuous_torque], lasting, 1e-9);
  EXPECT_NEAR(r.summary_at[FindingKind::continuous_torque].at, at, 2 * series.dt);
}

TEST(Consistency, StanceFootSlips) {
  CommandSeries series = good_walk();
  const double at = middle_of_step(2);  // the robot stands on the left foot
  RobotData data(limited_biped());
  for (size_t k = 0; k < series.samples.size(); ++k) {
    CommandSample& s = series.samples[k];
    auto feet = s.feet;
    feet[0].translation().x() += 0.005 * bump(k * series.dt, at, 0.4);
    place_legs(limited_biped(), feet, s.state, data);
  }
  complete_series(limited_biped(), series);
  const ConsistencyReport r = check_consistency(limited_biped(), series);
  EXPECT_EQ(error_kinds(r), std::set<std::string>{"foot_slip"}) << print(r);
  EXPECT_EQ(find(r, "foot_slip").where, "left");
  EXPECT_NEAR(find(r, "foot_slip").at, at, 2 * series.dt);
  EXPECT_NEAR(find(r, "foot_slip").worst, 0.005, 1e-6);
}

TEST(Consistency, ContactPhaseTooEarly) {
  CommandSeries series = good_walk();
  const WalkShape w;
  const int landing =
      static_cast<int>(std::lround((w.lead + 2 * w.period + w.period - w.double_support) / w.dt));
  for (int k = landing - 60; k < landing; ++k) series.samples[k].support = Support::both;
  const ConsistencyReport r = check_consistency(limited_biped(), series);
  EXPECT_EQ(error_kinds(r), std::set<std::string>{"foot_float"}) << print(r);
  EXPECT_EQ(find(r, "foot_float").where, "right");
  EXPECT_NEAR(find(r, "foot_float").at, (landing - 60) * w.dt, 2 * w.dt);
}

TEST(Consistency, GroundTooSlippery) {
  CheckOptions options;
  options.friction = 0.10;
  const ConsistencyReport r = check_consistency(limited_biped(), good_walk(), options);
  EXPECT_EQ(error_kinds(r), std::set<std::string>{"friction"}) << print(r);
  const Finding& f = find(r, "friction");
  EXPECT_GT(f.worst, 1);
  EXPECT_NEAR(r.summary[FindingKind::friction] * 0.1,
              check_consistency(limited_biped(), good_walk()).summary[FindingKind::friction] * 0.8,
              1e-9);
}

TEST(Consistency, ArmThroughTorso) {
  CommandSeries series = good_walk();
  bend(series, "l_elbow", 2.5, 2.0, -1.3);
  const ConsistencyReport r = check_consistency(limited_biped(), series);
  EXPECT_EQ(error_kinds(r), std::set<std::string>{"self_collision"}) << print(r);
  const auto torso = std::find_if(r.findings.begin(), r.findings.end(),
                                  [](const Finding& f) { return f.where == "torso - l_forearm"; });
  ASSERT_NE(torso, r.findings.end()) << print(r);
  EXPECT_NEAR(torso->at, 2.5, 0.05);
  EXPECT_LT(r.summary[FindingKind::self_collision], -0.01);
}

TEST(Consistency, MotionZmpLeavesTheSupport) {
  CommandSeries series = good_walk();
  const double at = middle_of_step(3);
  RobotData data(limited_biped());
  for (size_t k = 0; k < series.samples.size(); ++k) {
    CommandSample& s = series.samples[k];
    s.state.base.position.x() -= 0.012 * bump(k * series.dt, at, 0.5);
    place_legs(limited_biped(), s.feet, s.state, data);
  }
  complete_series(limited_biped(), series);
  const ConsistencyReport r = check_consistency(limited_biped(), series);
  EXPECT_EQ(error_kinds(r), std::set<std::string>{"support_margin"}) << print(r);
  const Finding& f = find(r, "support_margin");
  EXPECT_LT(f.worst, 0);
  EXPECT_EQ(f.worst, r.summary[FindingKind::support_margin]);
}

// If kp of its servo is 0, a joint gives no torque, even if its peak torque is stated.
TEST(Consistency, AJointWithoutAMotorGivesNoTorque) {
  RobotDescription limp = hoap1().description();
  limp.servos.at("l_knee").kp = limp.servos.at("l_knee").kd = 0;
  for (ActuatorProfile& profile : limp.profiles) profile.servos.clear();
  const RobotModel model(limp);
  EXPECT_EQ(error_kinds(check_consistency(hoap1(), standing(hoap1(), 0.2))),
            std::set<std::string>{});
  const ConsistencyReport r = check_consistency(model, standing(model, 0.2));
  EXPECT_EQ(error_kinds(r), std::set<std::string>{"joint_torque"}) << print(r);
  const Finding& f = find(r, "joint_torque");
  EXPECT_EQ(f.where, "l_knee");
  EXPECT_NE(f.hint.find("l_knee, but this joint has none (kp of its servo is 0)"),
            std::string::npos)
      << f.hint;
  // A joint that bears no load needs no motor.
  RobotDescription wrist = hoap1().description();
  wrist.servos.at("l_elbow").kp = wrist.servos.at("l_elbow").kd = 0;
  for (ActuatorProfile& profile : wrist.profiles) profile.servos.clear();
  wrist.servos.at("l_elbow").coulomb = 1;
  const RobotModel dry(wrist);
  EXPECT_EQ(error_kinds(check_consistency(dry, standing(dry, 0.2))), std::set<std::string>{});
}

TEST(Consistency, JumpBetweenTwoSamples) {
  CommandSeries series = standing(limited_biped(), 1.0);
  const int dof = limited_biped().find_dof("l_elbow");
  for (size_t k = 500; k < series.samples.size(); ++k) series.samples[k].state.theta[dof] = 0.05;
  const ConsistencyReport r = check_consistency(limited_biped(), series);
  const Finding& f = find(r, "servo_step");
  EXPECT_EQ(f.where, "l_elbow");
  EXPECT_NEAR(f.at, 0.5, 1e-9);
  EXPECT_NEAR(f.worst, 0.05, 1e-12);
}

namespace {

CommandSeries flight(double gravity, double spin_up) {
  CommandSeries series = standing(limited_biped(), 0.3);
  for (size_t k = 0; k < series.samples.size(); ++k) {
    CommandSample& s = series.samples[k];
    const double t = k * series.dt;
    s.support = Support::none;
    s.state.base.position.z() += 0.2 + 1.4 * t - 0.5 * gravity * t * t;
    const double turn = 0.2 * t + 0.5 * spin_up * t * t;
    s.state.base.attitude = exp_rotation({0, 0, turn});
    // The turn is about the COG and not about the base.
    const Vector3d arm = s.cog - standing(limited_biped(), 0).samples[0].state.base.position;
    s.state.base.position -= exp_rotation({0, 0, turn}) * arm - arm;
    s.feet[0].translation().z() = s.feet[1].translation().z() = 0.2;
  }
  complete_series(limited_biped(), series);
  series.samples.front().acceleration = series.samples[1].acceleration;
  series.samples.back().acceleration = series.samples[series.samples.size() - 2].acceleration;
  for (CommandSample& s : series.samples) s.fz = 0;
  return series;
}

}  // namespace

TEST(Consistency, FreeFlightAndItsFaults) {
  EXPECT_EQ(error_kinds(check_consistency(limited_biped(), flight(kGravity, 0))),
            std::set<std::string>{})
      << print(check_consistency(limited_biped(), flight(kGravity, 0)));
  const ConsistencyReport slow = check_consistency(limited_biped(), flight(0.9 * kGravity, 0));
  EXPECT_EQ(error_kinds(slow), std::set<std::string>{"ballistic"}) << print(slow);
  EXPECT_NEAR(find(slow, "ballistic").worst, 0.1 * kGravity, 0.01);
  EXPECT_EQ(find(slow, "ballistic").where, "z");
  const ConsistencyReport spun = check_consistency(limited_biped(), flight(kGravity, 20));
  EXPECT_EQ(error_kinds(spun), std::set<std::string>{"angular_momentum"}) << print(spun);
  EXPECT_EQ(find(spun, "angular_momentum").where, "z");
}

TEST(Consistency, LandingTooFast) {
  CommandSeries series = standing(limited_biped(), 0.4);
  RobotData data(limited_biped());
  for (size_t k = 0; k < series.samples.size(); ++k) {
    CommandSample& s = series.samples[k];
    auto feet = s.feet;
    feet[1].translation().z() += 0.3 * std::max(0.0, 0.03 - k * series.dt);
    if (k < 30) s.support = Support::left;
    place_legs(limited_biped(), feet, s.state, data);
  }
  complete_series(limited_biped(), series);
  const Finding& f = find(check_consistency(limited_biped(), series), "landing_speed");
  EXPECT_EQ(f.where, "right");
  EXPECT_EQ(f.severity, Severity::warning);
  EXPECT_NEAR(f.worst, 0.3, 1e-6);
}

TEST(Consistency, TolerancesAreCheckedByName) {
  CheckOptions options;
  options.tolerances["cog_resdual"] = 1;
  try {
    check_consistency(limited_biped(), standing(limited_biped(), 0.1), options);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::usage);
    EXPECT_NE(std::string(e.what()).find("did you mean 'cog_residual'"), std::string::npos)
        << e.what();
  }
  options.tolerances = {{"support_margin", 0.05}};
  EXPECT_EQ(
      find(check_consistency(limited_biped(), good_walk(), options), "support_margin").severity,
      Severity::warning);
  EXPECT_EQ(finding_specs().size(), static_cast<size_t>(kFindingKindCount));
}

TEST(Consistency, SameReportTwice) {
  EXPECT_EQ(print(check_consistency(limited_biped(), good_walk())),
            print(check_consistency(limited_biped(), good_walk())));
}
