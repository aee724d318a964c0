// Sound motions that are baked to tables pass. For one planted fault, the kind, the place and the
// time are found, and nothing else.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/generate/generate.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/check_report.hpp"
#include "tests/support/degree.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi::test {
namespace {

using Kinds = std::set<std::string>;

// The pattern goes through files, as for a user.
Pattern bake(const Pattern& pattern) {
  const TemporaryFolder folder;
  const Pattern dense = baked(hoap1(), pattern, sample(hoap1(), pattern), "baked.csv");
  write_pattern_and_table(folder.path() / "baked.json", dense);
  return read_pattern(folder.path() / "baked.json");
}

Pattern named(Pattern pattern) {
  pattern.robot = "hoap1";
  return pattern;
}

const Pattern& walk() {
  static const Pattern pattern = bake(named(walk_pattern(hoap1(), {.steps = 4})));
  return pattern;
}

const Finding& first(const ConsistencyReport& r, const std::string& kind) {
  for (const Finding& f : r.findings)
    if (name_of(f.kind) == kind && f.severity == Severity::error) return f;
  static const Finding none;
  ADD_FAILURE() << "no error " << kind << "\n" << print(r);
  return none;
}

// Beginning and end of the n-th phase with this support.
std::pair<double, double> phase(const Pattern& pattern, Support support, int n) {
  double begin = 0;
  for (const Phase& each : pattern.phases) {
    if (each.support == support && n-- == 0) return {begin, each.until};
    begin = each.until;
  }
  return {};
}

double middle(std::pair<double, double> phase) { return 0.5 * (phase.first + phase.second); }

Eigen::Index joint_column(const Pattern& pattern, const std::string& joint) {
  const auto& joints = pattern.table->joints;
  return std::find(joints.begin(), joints.end(), joint) - joints.begin();
}

void bend(Pattern& pattern, const std::string& joint, double center, double width, double height) {
  DenseTable& table = *pattern.table;
  const Eigen::Index column = joint_column(pattern, joint);
  for (Eigen::Index k = 0; k < table.theta.rows(); ++k)
    table.theta(k, column) += height * bump(static_cast<double>(k) * table.dt, center, width);
}

double angle_at(const Pattern& pattern, const std::string& joint, double t) {
  return pattern.table->theta(std::lround(t / pattern.table->dt), joint_column(pattern, joint));
}

TEST(PlantedFault, SoundMotionsPassBaked) {
  for (const Pattern& pattern :
       {named(walk_pattern(hoap1(), {.steps = 4})),
        named(walk_pattern(hoap1(), {.steps = 4, .stride = 0, .turn = 0.05})),
        named(sway_pattern(hoap1(), sway_defaults(hoap1()))),
        named(squat_pattern(hoap1(), squat_defaults(hoap1())))}) {
    const ConsistencyReport r = report_of(bake(pattern));
    EXPECT_TRUE(r.consistent) << print(r);
    for (const Finding& f : r.findings) EXPECT_EQ(f.severity, Severity::info) << print(r);
  }
}

TEST(PlantedFault, CogMoved) {
  for (const int axis : {0, 1, 2}) {
    Pattern p = walk();
    for (size_t k = 0; k < p.table->cog.size(); ++k)
      p.table->cog[k][axis] += 0.015 * bump(static_cast<double>(k) * p.table->dt, 2.0, 0.6);
    const ConsistencyReport r = report_of(p);
    EXPECT_EQ(error_kinds(r), Kinds{"cog_residual"}) << print(r);
    const Finding& f = first(r, "cog_residual");
    EXPECT_NEAR(f.at, 2.0, 0.002);
    EXPECT_NEAR(f.worst, 0.015, 1e-6);
    EXPECT_EQ(f.where, std::string(1, "xyz"[axis]));
  }
}

TEST(PlantedFault, ZmpOutside) {
  for (const Support support : {Support::left, Support::right}) {
    Pattern p = walk();
    const double at = middle(phase(p, support, 1));
    const double outwards = support == Support::left ? 1 : -1;
    for (size_t k = 0; k < p.table->zmp.size(); ++k)
      p.table->zmp[k].y() +=
          outwards * (0.0315 + 0.020) * bump(static_cast<double>(k) * p.table->dt, at, 0.3);
    const ConsistencyReport r = report_of(p);
    EXPECT_EQ(error_kinds(r), Kinds{"support_margin"}) << print(r);
    EXPECT_NEAR(first(r, "support_margin").at, at, 0.002);
    EXPECT_NEAR(first(r, "support_margin").worst, -0.020, 1e-3);
    EXPECT_EQ(first(r, "support_margin").where, name_of(support));
  }
}

TEST(PlantedFault, ForceScaled) {
  for (const auto& [begin, end] : {std::pair{1.5, 2.2}, std::pair{0.0, 100.0}}) {
    Pattern p = walk();
    for (size_t k = 0; k < p.table->fz.size(); ++k) {
      const double t = static_cast<double>(k) * p.table->dt;
      if (t >= begin - 1e-9 && t <= end) p.table->fz[k] *= 1.1;
    }
    const ConsistencyReport r = report_of(p);
    EXPECT_EQ(error_kinds(r), Kinds{"fz_residual"}) << print(r);
    EXPECT_NEAR(first(r, "fz_residual").begin, begin, 0.002);
    EXPECT_NEAR(first(r, "fz_residual").worst, -0.1 * hoap1().mass() * kGravity, 0.4);
  }
}

TEST(PlantedFault, JointBeyondItsLimit) {
  const std::vector<std::pair<std::string, double>> limits = {
      {"l_elbow", -95}, {"r_elbow", 6},        {"l_shoulder_pitch", 155}, {"r_shoulder_twist", -95},
      {"r_knee", -4},   {"r_ankle_roll", -22}, {"l_ankle_roll", 22},      {"l_hip_pitch", -119}};
  for (const auto& [joint, degrees] : limits) {
    for (const auto& [at, width] : {std::pair{2.0, 1.2}, std::pair{2.6, 0.5}}) {
      Pattern p = walk();
      bend(p, joint, at, width, degrees * kDegree - angle_at(p, joint, at));
      const ConsistencyReport r = report_of(p);
      EXPECT_EQ(error_kinds(r), Kinds{"joint_position"}) << joint << "\n" << print(r);
      const Finding& f = first(r, "joint_position");
      EXPECT_EQ(f.where, joint);
      // The walk itself moves the joint, so that the worst sample is not exactly at the maximum of
      // the added bump.
      Eigen::Index worst = 0;
      (p.table->theta.col(joint_column(p, joint)) * (degrees > 0 ? 1 : -1)).maxCoeff(&worst);
      EXPECT_NEAR(f.at, static_cast<double>(worst) * p.table->dt, 0.002);
      EXPECT_LE(f.begin, at);
      EXPECT_GE(f.end, at);
    }
  }
}

// The whole table in `scale` times its duration, with its commands and phases.
Pattern squeezed(const Pattern& pattern, double scale) {
  Pattern p = pattern;
  p.table->dt *= scale;
  for (Phase& each : p.phases) each.until *= scale;
  return p;
}

TEST(PlantedFault, TimeSqueezed) {
  const Pattern squat = bake(named(squat_pattern(hoap1(), squat_defaults(hoap1()))));
  for (const auto& [pattern, scale] :
       {std::pair{walk(), 0.65}, std::pair{walk(), 0.5}, std::pair{squat, 0.25}}) {
    const ConsistencyReport r = report_of(squeezed(pattern, scale));
    for (const std::string& kind : error_kinds(r))
      EXPECT_TRUE(kind == "joint_speed" || kind == "joint_torque" || kind == "table_step")
          << print(r);
    EXPECT_FALSE(r.consistent);
    EXPECT_NE(first(r, "joint_speed").where.find("knee"), std::string::npos) << print(r);
  }
}

TEST(PlantedFault, StanceFootSlips) {
  for (const Support support : {Support::left, Support::right}) {
    for (const int axis : {0, 1}) {
      Pattern p = walk();
      const double at = middle(phase(p, support, 1));
      for (size_t k = 0; k < p.table->base.size(); ++k)
        p.table->base[k].position[axis] +=
            0.005 * bump(static_cast<double>(k) * p.table->dt, at, 0.35);
      const ConsistencyReport r = report_of(p);
      EXPECT_EQ(error_kinds(r), Kinds{"foot_slip"}) << print(r);
      EXPECT_EQ(first(r, "foot_slip").where, name_of(support));
      EXPECT_NEAR(first(r, "foot_slip").at, at, 0.002);
      EXPECT_NEAR(first(r, "foot_slip").worst, 0.005, 1e-4);
    }
  }
}

TEST(PlantedFault, StanceFootSlipsByItsLeg) {
  Pattern p = walk();
  const double at = middle(phase(p, Support::right, 1));
  bend(p, "r_hip_pitch", at, 0.35, -0.025);
  bend(p, "r_ankle_pitch", at, 0.35, 0.025);
  const ConsistencyReport r = report_of(p);
  EXPECT_EQ(error_kinds(r), Kinds{"foot_slip"}) << print(r);
  EXPECT_EQ(first(r, "foot_slip").where, "right");
  EXPECT_NEAR(first(r, "foot_slip").at, at, 0.002);
}

TEST(PlantedFault, ContactTooEarly) {
  for (const size_t swing : {1, 3, 5}) {
    for (const bool whole : {false, true}) {
      Pattern p = walk();
      ASSERT_TRUE(p.phases[swing].swing);
      const double landing = p.phases[swing].until - 0.060;
      p.phases[swing].until = landing;
      if (whole) p.phases[swing + 1].until -= 0.060;
      const ConsistencyReport r = report_of(p);
      EXPECT_EQ(error_kinds(r), Kinds{"foot_float"}) << print(r);
      EXPECT_EQ(first(r, "foot_float").where, name_of(p.phases[swing].swing->foot));
      EXPECT_NEAR(first(r, "foot_float").at, landing, 0.002);
    }
  }
}

TEST(PlantedFault, ContactTooEarlyWithoutFootholds) {
  Pattern p = walk();
  for (Phase& each : p.phases) each.swing.reset();
  EXPECT_TRUE(report_of(p).consistent) << print(report_of(p));
  p.phases[3].until -= 0.060;
  const ConsistencyReport r = report_of(p);
  EXPECT_EQ(error_kinds(r), Kinds{"foot_float"}) << print(r);
  EXPECT_NEAR(first(r, "foot_float").at, p.phases[3].until, 0.002);
}

TEST(PlantedFault, ArmThroughTheTorso) {
  for (const char* side : {"l", "r"}) {
    Pattern p = walk();
    const double in = side[0] == 'l' ? 1 : -1;  // the forearm turns towards the body
    bend(p, std::string(side) + "_shoulder_pitch", 2.0, 2.0, 42 * kDegree);
    bend(p, std::string(side) + "_shoulder_roll", 2.0, 2.0, -in * 10 * kDegree);
    bend(p, std::string(side) + "_shoulder_twist", 2.0, 2.0, in * 85 * kDegree);
    bend(p, std::string(side) + "_elbow", 2.0, 2.0, -64 * kDegree);
    const ConsistencyReport r = report_of(p);
    EXPECT_EQ(error_kinds(r), Kinds{"self_collision"}) << print(r);
    const Finding& f = first(r, "self_collision");
    EXPECT_NE(f.where.find("torso"), std::string::npos) << f.where;
    EXPECT_NEAR(f.at, 2.0, 0.002);
  }
}

// The collision and the exceeded limit are two separate errors.
TEST(PlantedFault, ArmThroughTheTorsoBeyondItsLimit) {
  Pattern p = walk();
  bend(p, "l_shoulder_roll", 2.0, 2.0, -0.7);
  const ConsistencyReport r = report_of(p);
  EXPECT_EQ(error_kinds(r), (Kinds{"joint_position", "self_collision"})) << print(r);
}

TEST(PlantedFault, SlipperyGround) {
  Pattern p = walk();
  p.world.friction = 0.10;
  const ConsistencyReport r = report_of(p);
  EXPECT_EQ(error_kinds(r), Kinds{"friction"}) << print(r);
}

const Pattern& jump() {
  static const Pattern pattern = [] {
    Pattern p = named(jump_pattern(hoap1(), jump_defaults(hoap1())));
    p.profile = "hoap1-strong";
    return bake(p);
  }();
  return pattern;
}

TEST(PlantedFault, ASoundJumpPassesBaked) {
  const ConsistencyReport r = report_of(jump());
  EXPECT_TRUE(r.consistent) << print(r);
}

// The posture rises, the command rises, both rise, or an arm swings. In none of these cases does
// the robot fall freely.
TEST(PlantedFault, FlightIsNotBallistic) {
  const auto [begin, end] = phase(jump(), Support::none, 0);
  const double at = 0.5 * (begin + end), width = 0.9 * (end - begin);
  for (const std::string fault : {"base", "cog", "both", "arm"}) {
    Pattern p = jump();
    for (size_t k = 0; k < p.table->cog.size(); ++k) {
      const double rise = 0.004 * bump(static_cast<double>(k) * p.table->dt, at, width);
      if (fault == "base" || fault == "both") p.table->base[k].position.z() += rise;
      if (fault == "cog" || fault == "both") p.table->cog[k].z() += rise;
    }
    if (fault == "arm") bend(p, "l_shoulder_pitch", at, width, -0.5);
    const ConsistencyReport r = report_of(p);
    EXPECT_EQ(error_kinds(r), Kinds{"ballistic"}) << fault << "\n" << print(r);
    EXPECT_NEAR(first(r, "ballistic").at, at, 0.002) << fault;
    EXPECT_EQ(first(r, "ballistic").where, fault == "arm" ? "x" : "z");
  }
}

TEST(PlantedFault, ForceInFlight) {
  Pattern p = jump();
  const auto [begin, end] = phase(jump(), Support::none, 0);
  for (size_t k = 0; k < p.table->fz.size(); ++k)
    p.table->fz[k] +=
        30 * bump(static_cast<double>(k) * p.table->dt, 0.5 * (begin + end), 0.8 * (end - begin));
  const ConsistencyReport r = report_of(p);
  EXPECT_EQ(error_kinds(r), Kinds{"fz_residual"}) << print(r);
  EXPECT_NEAR(first(r, "fz_residual").at, 0.5 * (begin + end), 0.002);
}

// The limit of moments in flight grows with the robot, unless it was set; then it may be smaller.
TEST(PlantedFault, MomentsInFlightAreJudgedByTheRobotOrByWhatWasSet) {
  const CommandSeries series = sample(hoap1(), jump());
  const FindingKind kind = FindingKind::angular_momentum;
  const double height = series.samples[0].cog.z(), weight = hoap1().mass() * kGravity;
  CheckOptions options;
  options.profile = jump().profile;
  EXPECT_NEAR(tolerances(options, hoap1(), series)[kind], 0.0065 * weight * height, 1e-12);
  const double used =
      check_consistency(hoap1(), series, options).summary[FindingKind::angular_momentum];
  ASSERT_GT(used, 0.02);
  ASSERT_LT(used, 0.0065 * weight * height);
  options.tolerances["angular_momentum"] = 0.9 * used;
  const ConsistencyReport r = check_consistency(hoap1(), series, options);
  EXPECT_EQ(error_kinds(r), Kinds{"angular_momentum"}) << print(r);
  EXPECT_NEAR(first(r, "angular_momentum").limit, 0.9 * used, 1e-12);
}

// A ZMP error counts by its moment: if the load is below a quarter of the weight, the limit is 5 mm
// times a quarter divided by that share.
TEST(PlantedFault, ZmpErrorsBelowAQuarterOfTheWeight) {
  const CommandSeries sound = sample(hoap1(), walk());
  const size_t at = sound.samples.size() / 2;
  for (const auto& [share, limit] : {std::pair{0.125, 0.010}, {0.25, 0.005}, {0.9, 0.005}}) {
    for (const double size : {0.9, 1.1}) {
      CommandSeries series = sound;
      for (size_t k = at; k < at + 5; ++k) {
        series.samples[k].fz = share * hoap1().mass() * kGravity;
        series.samples[k].zmp.x() += size * limit;
      }
      Kinds expected = {"fz_residual"};
      if (size > 1) expected.insert("zmp_residual");
      EXPECT_EQ(error_kinds(check_consistency(hoap1(), series)), expected) << share << " " << size;
    }
  }
}

// Single samples may be off by up to three limits; a longer or larger deviation is an error.
TEST(PlantedFault, ZmpErrorsOfAFewSamples) {
  const CommandSeries sound = sample(hoap1(), walk());
  for (const auto& [samples, size, wrong] :
       {std::tuple{4, 0.012, false}, {5, 0.012, true}, {1, 0.017, true}}) {
    CommandSeries series = sound;
    for (int k = 0; k < samples; ++k) series.samples[sound.samples.size() / 2 + k].zmp.x() += size;
    const ConsistencyReport r = check_consistency(hoap1(), series);
    EXPECT_EQ(error_kinds(r), wrong ? Kinds{"zmp_residual"} : Kinds{}) << samples << print(r);
    EXPECT_NEAR(r.summary[FindingKind::zmp_residual], size, 1e-3);
  }
}

// Two faults at once, far apart, are two errors.
TEST(PlantedFault, NoFaultHidesAnother) {
  Pattern p = walk();
  bend(p, "l_elbow", 1.2, 0.6, -95 * kDegree - angle_at(p, "l_elbow", 1.2));
  for (size_t k = 0; k < p.table->cog.size(); ++k)
    p.table->cog[k].x() += 0.015 * bump(static_cast<double>(k) * p.table->dt, 2.4, 0.4);
  for (size_t k = 0; k < p.table->fz.size(); ++k)
    if (std::abs(static_cast<double>(k) * p.table->dt - 0.4) < 0.1) p.table->fz[k] *= 1.1;
  const ConsistencyReport r = report_of(p);
  EXPECT_EQ(error_kinds(r), (Kinds{"joint_position", "cog_residual", "fz_residual"})) << print(r);
}

}  // namespace
}  // namespace ayumi::test
