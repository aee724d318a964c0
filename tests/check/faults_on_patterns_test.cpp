// Ten faults, each planted alone in the tables of motions of several kinds: one error names kind,
// place and instant, and all other findings are at most warnings.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/check/consistency.hpp"
#include "tests/support/check_report.hpp"
#include "tests/support/degree.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

using Eigen::Vector3d;

struct Motion {
  std::string name;
  Pattern pattern;  // the pattern as a table
  double at = 0;    // time in its first single support, or in its middle if it has none [s]
  double from = 0, to = 0;
  Support support = Support::both;
};

Motion motion_of(const std::string& name, Pattern pattern) {
  pattern.robot = "hoap1";
  Motion motion{name, baked(hoap1(), pattern)};
  motion.to = pattern.phases.back().until;
  double begin = 0;
  for (const Phase& phase : pattern.phases) {
    if (phase.support == Support::left || phase.support == Support::right) {
      motion.support = phase.support;
      motion.from = begin;
      motion.to = phase.until;
      break;
    }
    begin = phase.until;
  }
  const double dt = motion.pattern.table->dt;
  motion.at = dt * std::round(0.5 * (motion.from + motion.to) / dt);
  return motion;
}

const std::vector<Motion>& motions() {
  static const std::vector<Motion> all = {
      motion_of("turning walk, slow, left first",
                walk_pattern(hoap1(), {.steps = 3,
                                       .stride = 0.02,
                                       .period = 1.2,
                                       .turn = 0.06,
                                       .first_swing = Side::left})),
      motion_of("quick walk backwards",
                walk_pattern(hoap1(), {.steps = 4, .stride = -0.02, .period = 0.45})),
      motion_of("steps in place, high",
                walk_pattern(hoap1(), {.steps = 3, .stride = 0, .period = 0.8, .lift = 0.03})),
      motion_of("squat", squat_pattern(hoap1(), squat_defaults(hoap1()))),
      motion_of("sway", sway_pattern(hoap1(), sway_defaults(hoap1())))};
  return all;
}

// All errors are of one of the named kinds; the first is at `at` if a time is given.
void expect_alone(const Motion& motion, const Pattern& pattern, const std::set<std::string>& kinds,
                  const std::string& where, double at = -1) {
  const ConsistencyReport r = report_of(pattern);
  std::ostringstream told;
  told << motion.name << "\n";
  bool found = false;
  for (const Finding& f : r.findings) {
    if (f.severity != Severity::error) continue;
    told << name_of(f.kind) << " " << f.where << " at " << f.at << " worst " << f.worst << "\n";
    EXPECT_TRUE(kinds.count(name_of(f.kind))) << told.str();
    const bool then = at < 0 || std::abs(f.at - at) <= 2.01 * pattern.table->dt;
    found = found || (then && f.where.find(where) != std::string::npos);
  }
  EXPECT_TRUE(found) << told.str() << "expected " << where << " at " << at;
}

// The distance along y from the commanded ZMP at motion.at to a point 20 mm outside the sole.
double way_outside(const Motion& motion) {
  const CommandSeries series = sample(hoap1(), motion.pattern);
  const CommandSample& s = series.samples[std::lround(motion.at / series.dt)];
  const bool left = motion.support != Support::right;
  const Side side = left ? Side::left : Side::right;
  double edge = -1e9;
  for (const Eigen::Vector2d& v : hoap1().sole(side).polygon)
    edge = std::max(
        edge, (left ? 1 : -1) * (s.feet[static_cast<int>(side)] * Vector3d(v.x(), v.y(), 0)).y());
  return (left ? 1 : -1) * (edge + 0.020) - s.zmp.y();
}

TEST(FaultsOnPatterns, NoneWherePatternsAreSound) {
  for (const Motion& m : motions())
    for (const Finding& f : report_of(m.pattern).findings)
      EXPECT_EQ(f.severity, Severity::info) << m.name << " " << name_of(f.kind);
}

TEST(FaultsOnPatterns, CogAndForceCommands) {
  for (const Motion& m : motions()) {
    Pattern p = m.pattern;
    for_rows(*p.table,
             [&](double t, size_t k) { p.table->cog[k].y() -= 0.015 * bump(t, m.at, 0.5); });
    expect_alone(m, p, {"cog_residual"}, "y", m.at);
    p = m.pattern;
    for (double& fz : p.table->fz) fz *= 1.1;
    expect_alone(m, p, {"fz_residual"}, "z");
  }
}

TEST(FaultsOnPatterns, ZmpOutside) {
  for (const Motion& m : motions()) {
    const double way = way_outside(m), width = std::min(0.8 * (m.to - m.from), 0.4);
    Pattern smooth = m.pattern, single = m.pattern, whole = m.pattern;
    for_rows(*smooth.table,
             [&](double t, size_t k) { smooth.table->zmp[k].y() += way * bump(t, m.at, width); });
    size_t worst = 0;
    for_rows(*smooth.table, [&](double, size_t k) {
      if (way * (smooth.table->zmp[k] - smooth.table->zmp[worst]).y() > 0) worst = k;
    });
    expect_alone(m, smooth, {"support_margin"}, name_of(m.support),
                 static_cast<double>(worst) * smooth.table->dt);
    single.table->zmp[std::lround(m.at / single.table->dt)].y() += way;
    expect_alone(m, single, {"support_margin"}, name_of(m.support), m.at);
    for (Vector3d& zmp : whole.table->zmp) zmp.y() += way;
    expect_alone(m, whole, {"support_margin"}, "");
  }
}

TEST(FaultsOnPatterns, JointBeyondItsLimit) {
  const std::vector<std::pair<std::string, double>> keys = {
      {"l_elbow", -96}, {"r_knee", -3}, {"l_ankle_roll", 21}, {"r_shoulder_roll", 4}};
  for (const Motion& m : motions()) {
    for (const auto& [joint, degrees] : keys) {
      Pattern smooth = m.pattern, hard = m.pattern;
      const int column = hoap1().find_dof(joint);
      const double goal = degrees * kDegree;
      const auto row = std::lround(m.at / smooth.table->dt);
      move_joint(hoap1(), *smooth.table, joint, goal - smooth.table->theta(row, column), m.at, 1);
      Eigen::Index worst = 0;
      (smooth.table->theta.col(column) * (degrees > 0 ? 1 : -1)).maxCoeff(&worst);
      expect_alone(m, smooth, {"joint_position"}, joint,
                   static_cast<double>(worst) * smooth.table->dt);
      hard.table->theta.col(column).segment(row, 80).setConstant(goal);
      expect_alone(m, hard, {"joint_position"}, joint);
      Pattern single = m.pattern;
      single.table->theta(row, column) = goal;
      expect_alone(m, single, {"joint_position"}, joint, m.at);
    }
  }
}

TEST(FaultsOnPatterns, TimeSqueezed) {
  const std::vector<double> scales = {0.4, 0.6, 0.4, 0.22, 0.25};
  for (size_t i = 0; i < motions().size(); ++i) {
    Pattern p = motions()[i].pattern;
    squeeze(p, scales[i]);
    expect_alone(motions()[i], p, {"joint_speed", "joint_torque"}, "");
  }
}

TEST(FaultsOnPatterns, StanceFootSlips) {
  for (const Motion& m : motions()) {
    const Side side = m.support == Support::right ? Side::right : Side::left;
    const double width = std::min(0.8 * (m.to - m.from), 0.6);
    const Vector3d way(0.004, 0.003, 0);
    Pattern base = m.pattern, hard = m.pattern;
    for_rows(*base.table, [&](double t, size_t k) {
      base.table->base[k].position += bump(t, m.at, width) * way;
    });
    expect_alone(m, base, {"foot_slip"}, name_of(side), m.at);
    move_body(hoap1(), *hard.table, [&](double t, BasePose&, auto& feet) {
      if (std::abs(t - m.at) < 0.05) feet[static_cast<int>(side)].translation() += way;
    });
    expect_alone(m, hard, {"foot_slip"}, name_of(side));
  }
}

TEST(FaultsOnPatterns, ContactTooEarly) {
  for (const Motion& m : motions()) {
    for (size_t i = 0; i + 1 < m.pattern.phases.size(); ++i) {
      if (!m.pattern.phases[i].swing) continue;
      Pattern p = m.pattern;
      const double landing = p.phases[i].until -= 0.060;
      expect_alone(m, p, {"foot_float"}, name_of(p.phases[i].swing->foot), landing);
    }
  }
}

// During the whole swing, the sole hangs lower than it may float.
TEST(FaultsOnPatterns, ContactTooEarlyOnASlowWalk) {
  const Motion slow =
      motion_of("very slow walk", walk_pattern(hoap1(), {.steps = 2, .period = 1.6}));
  Pattern p = slow.pattern;
  const double landing = p.phases[1].until -= 0.060;
  const ConsistencyReport r = report_of(p);
  ASSERT_FALSE(r.findings.empty());
  const Finding& f = r.findings.front();
  EXPECT_EQ(f.kind, FindingKind::foot_float);
  EXPECT_NEAR(f.at, landing, 0.002);
  EXPECT_LT(f.worst, 0.3e-3);
  EXPECT_NE(f.hint.find("when its contact begins"), std::string::npos) << f.hint;
  expect_alone(slow, p, {"foot_float"}, f.where, landing);
  // The same foot, with a contact that ends too late.
  p = slow.pattern;
  const double lifting = p.phases[0].until += 0.060;
  expect_alone(slow, p, {"foot_float"}, f.where, lifting);
}

TEST(FaultsOnPatterns, ArmThroughTheTorso) {
  for (const Motion& m : motions()) {
    Pattern smooth = m.pattern, hard = m.pattern;
    const std::vector<std::pair<std::string, double>> keys = {{"l_shoulder_pitch", 42},
                                                              {"l_shoulder_roll", -10},
                                                              {"l_shoulder_twist", 85},
                                                              {"l_elbow", -64}};
    const auto row = std::lround(m.at / hard.table->dt);
    for (const auto& [joint, degrees] : keys) {
      move_joint(hoap1(), *smooth.table, joint, degrees * kDegree, m.at, 1.5);
      hard.table->theta.col(hoap1().find_dof(joint)).segment(row, 80).array() += degrees * kDegree;
    }
    expect_alone(m, smooth, {"self_collision"}, "torso", m.at);
    expect_alone(m, hard, {"self_collision"}, "torso");
  }
}

TEST(FaultsOnPatterns, SlipperyGround) {
  for (const Motion& m : motions()) {
    if (m.support == Support::both) continue;  // the foot hardly pushes sideways
    Pattern p = m.pattern;
    p.world.friction = m.name == "quick walk backwards" ? 0.10 : 0.04;
    expect_alone(m, p, {"friction"}, "");
  }
}

TEST(FaultsOnPatterns, FlightThatIsNotBallistic) {
  JumpParameters jump = jump_defaults(hoap1());
  jump.forward = 0.02;
  Pattern authored = jump_pattern(hoap1(), jump);
  authored.profile = "hoap1-strong";
  const Motion m = motion_of("jump forward", authored);
  double begin = 0, end = 0;
  for (const Phase& phase : m.pattern.phases) {
    if (phase.support == Support::none) end = phase.until;
    if (end == 0) begin = phase.until;
  }
  const double at = 0.5 * (begin + end), width = 0.9 * (end - begin);
  Pattern p = m.pattern;
  for_rows(*p.table, [&](double t, size_t k) {
    p.table->base[k].position.z() += 0.004 * bump(t, at, width);
  });
  expect_alone(m, p, {"ballistic"}, "z", m.pattern.table->dt * std::round(at / 0.001));
  // The COG moves on a level line instead of a parabola; the feet then also reach the ground.
  p = m.pattern;
  for_rows(*p.table, [&](double t, size_t k) {
    if (t > begin && t < end) p.table->base[k].position.z() -= 0.006 * bump(t, at, width);
  });
  expect_alone(m, p, {"ballistic"}, "z");
  // A COG key that is wrong both on the ground and in the air is not a fault of the flight.
  p = m.pattern;
  for_rows(*p.table, [&](double t, size_t k) { p.table->cog[k].x() += 0.015 * bump(t, at, 0.8); });
  expect_alone(m, p, {"cog_residual"}, "x");
}

}  // namespace
}  // namespace ayumi::test
