// A flight without free fall, or a phase at the wrong time, gives one error; findings that follow
// from it are warnings. A second fault beside it is an error, too.

#include <gtest/gtest.h>

#include <algorithm>

#include "ayumi/check/consistency.hpp"
#include "tests/support/planted.hpp"
#include "tests/support/robot_motions.hpp"

namespace ayumi::test {
namespace {

using Eigen::Vector3d;
using namespace planted;

// The consequences are a force and a moment of one swinging leg, and the torques that hold a trunk
// that is turned.
TEST(Consequence, OfAFlightThatIsNotFreeIsOneFinding) {
  const double from = begin_of(hops(), 1), to = hops().phases[1].until, at = middle_of(hops(), 1);
  Pattern leg = hops();
  move_joint(hoap1(), *leg.table, "r_hip_pitch", 0.15, at, to - from);
  Errors e = errors_of(leg);
  EXPECT_EQ(e.kinds, (Kinds{"ballistic"})) << e.printed;
  EXPECT_NE(e.printed.find("warning angular_momentum"), std::string::npos) << e.printed;
  Pattern tilt = hops();
  for_rows(*tilt.table, [&](double t, size_t k) {
    BasePose& base = tilt.table->base[k];
    const Vector3d cog = tilt.table->cog[k];
    const Eigen::Quaterniond turn(
        Eigen::AngleAxisd(0.5 * bump(t, at, to - from), Vector3d::UnitY()));
    base.attitude = turn * base.attitude;
    base.position = cog + turn * (base.position - cog);
  });
  e = errors_of(tilt);
  EXPECT_EQ(e.kinds, (Kinds{"angular_momentum"})) << e.printed;
  EXPECT_NE(e.printed.find("warning joint_torque"), std::string::npos) << e.printed;
}

// A flight that is not free needs a force that no ground can give, and joint torques for this
// force. The torque errors are consequences of the error of the flight.
TEST(Consequence, OfAFlightThatIsNotFreeAreTorques) {
  const double from = begin_of(hops(), 1), to = hops().phases[1].until, at = middle_of(hops(), 1);
  const auto kink = [&](double t) {
    return std::max(0.0, 1 - std::abs(t - at) / (0.3 * (to - from)));
  };
  for (const Vector3d& way : {Vector3d(0.01, 0, 0), Vector3d(0, 0.01, 0), Vector3d(0, 0, 0.01)}) {
    Pattern p = hops();
    for_rows(*p.table, [&](double t, size_t k) { p.table->base[k].position += kink(t) * way; });
    Errors e = errors_of(p);
    EXPECT_EQ(e.kinds, (Kinds{"ballistic"})) << e.printed;
    EXPECT_NEAR(e.all[0].at, at, 0.002) << e.printed;
    // An arm that is thrown in the next flight is another fault.
    move_joint(hoap1(), *p.table, "l_shoulder_pitch", 0.6, middle_of(p, 3), 0.05);
    e = errors_of(p);
    EXPECT_TRUE(e.kinds.count("ballistic") && e.all.size() > 1) << e.printed;
  }
}

// In a long flight that is not free, the COG error is largest where the acceleration of the COG
// equals that of free fall again. This is not a separate error.
TEST(Consequence, OfALongFlightThatIsNotFreeIsTheCogInItsMiddle) {
  const RobotModel& robot = bundled_robot("humanoid30");
  Pattern p = baked(robot, pattern_of({"humanoid30", "jump"}));
  const double from = begin_of(p, 1), to = p.phases[1].until, at = 0.5 * (from + to);
  ASSERT_EQ(p.phases[1].support, Support::none);
  for_rows(*p.table, [&](double t, size_t k) {
    const double s = (t - at) / (0.5 * (to - from));
    if (std::abs(s) < 1) p.table->base[k].position.z() += 0.0015 * (1 + std::cos(M_PI * s));
  });
  int free = 0;
  for (const Finding& f : report_of(robot, p).findings) {
    EXPECT_FALSE(f.kind == FindingKind::cog_residual && f.severity == Severity::error) << f.at;
    free += f.kind == FindingKind::ballistic && f.severity == Severity::error;
  }
  EXPECT_EQ(free, 1);
}

// If the height of a flight is scaled, the posture is discontinuous at lift-off and landing. The
// errors of soles and forces at these times are consequences of the wrong flight.
TEST(Consequence, OfAFlightThatIsTooLowAreItsEdges) {
  for (const double scale : {0.5, 1.3}) {
    Pattern p = hops();
    const double from = begin_of(p, 1), to = p.phases[1].until;
    const double ground = p.table->base[std::lround(from / p.table->dt)].position.z();
    for_rows(*p.table, [&](double t, size_t k) {
      double& z = p.table->base[k].position.z();
      if (t >= from && t < to) z = ground + scale * (z - ground);
    });
    const Errors e = errors_of(p);
    EXPECT_EQ(e.kinds, (Kinds{"ballistic"})) << scale << "\n" << e.printed;
  }
}

// The COG moves parallel to the true flight, so the posture is discontinuous at lift-off and
// landing.
TEST(Consequence, OfAFlightThatLeapsAreItsEdges) {
  const double dt = hops().table->dt, from = begin_of(hops(), 1), to = hops().phases[1].until;
  for (const Vector3d& way : {Vector3d(0.005, 0, 0), Vector3d(0, -0.003, 0), Vector3d(0, 0, 0.02),
                              Vector3d(0, 0, -0.01)}) {
    for (const bool command : {false, true}) {
      for (const double less : {0.0, 1.0}) {  // samples before the end
        Pattern p = hops();
        for_rows(*p.table, [&](double t, size_t k) {
          if (t < from - 0.5 * dt || t > to + (0.5 - less) * dt) return;
          p.table->base[k].position += way;
          if (command) p.table->cog[k] += way;
        });
        const Errors e = errors_of(p);
        EXPECT_EQ(e.kinds, (Kinds{"ballistic"})) << way.transpose() << "\n" << e.printed;
        ASSERT_EQ(e.all.size(), 1u) << e.printed;
        EXPECT_EQ(e.all[0].where, way.z() != 0 ? "z" : way.x() != 0 ? "x" : "y");
        EXPECT_TRUE(std::abs(e.all[0].at - from) < 0.0021 || std::abs(e.all[0].at - to) < 0.0021);
        EXPECT_NE(e.all[0].hint.find("jumps by"), std::string::npos) << e.all[0].hint;
      }
    }
  }
  // If robot and commanded COG are displaced only during the first part of the stance after the
  // flight, the fault is a slip of the feet and not a fault of the flight.
  Pattern p = hops();
  const double begin = to, end = to + 0.4 * (p.phases[2].until - to);
  for_rows(*p.table, [&](double t, size_t k) {
    if (t < begin - 0.5 * dt || t > end - 0.5 * dt) return;
    p.table->base[k].position.x() += 0.005;
    p.table->cog[k].x() += 0.005;
  });
  EXPECT_EQ(errors_of(p).kinds, (Kinds{"foot_slip"})) << errors_of(p).printed;
}

// If the commanded COG deviates only within the flight, the error is a flight that is not free. If
// it also deviates before and after the flight, the error is a wrong COG key.
TEST(Consequence, OfACommandedCogDependsOnWhereItEnds) {
  const double at = middle_of(hops(), 1), length = hops().phases[1].until - begin_of(hops(), 1);
  for (const double share : {0.9, 6.0}) {
    Pattern p = hops();
    for_rows(*p.table, [&](double t, size_t k) {
      p.table->cog[k].x() += 0.015 * std::max(0.0, 1 - std::abs(t - at) / (0.5 * share * length));
    });
    const Errors e = errors_of(p);
    EXPECT_EQ(e.kinds, (Kinds{share < 1 ? "ballistic" : "cog_residual"})) << e.printed;
  }
}

// A flight, or a stance between two flights, is 60 ms early at both its ends.
TEST(Consequence, OfAPhaseThatHasMoved) {
  for (const size_t phase : {1, 2, 3}) {
    Pattern p = hops();
    p.phases[phase - 1].until -= 0.060;
    p.phases[phase].until -= 0.060;
    const Errors e = errors_of(p);
    EXPECT_EQ(e.kinds, (Kinds{"foot_float"})) << phase << "\n" << e.printed;
    EXPECT_EQ(e.all.size(), 2u) << e.printed;
  }
  // The next flight is not free.
  Pattern p = hops();
  const double at = middle_of(p, 3);
  for_rows(*p.table,
           [&](double t, size_t k) { p.table->base[k].position.x() += 0.01 * bump(t, at, 0.06); });
  p.phases[0].until -= 0.060;
  p.phases[1].until -= 0.060;
  const Errors e = errors_of(p);
  EXPECT_EQ(e.kinds, (Kinds{"foot_float", "ballistic"})) << e.printed;
}

// The foot that is planned to be lifted still stands on the ground, but no force shows this if the
// ZMP is already over the other foot.
TEST(Consequence, OfAFootThatIsLetGoTooEarly) {
  for (const size_t both : {0, 2, 4}) {
    Pattern p = walk();
    ASSERT_EQ(p.phases[both].support, Support::both);
    const double lifts = p.phases[both].until -= 0.060;
    Errors e = errors_of(p);
    EXPECT_EQ(e.kinds, (Kinds{"contact_ends_early"})) << both << "\n" << e.printed;
    ASSERT_EQ(e.all.size(), 1u) << e.printed;
    EXPECT_EQ(e.all[0].where, name_of(p.phases[both + 1].swing->foot)) << e.printed;
    EXPECT_NEAR(e.all[0].at, lifts, 0.002);
    EXPECT_EQ(e.all[0].unit, "s");
    EXPECT_NEAR(e.all[0].worst, 0.060, 0.005);
    EXPECT_NE(e.all[0].hint.find("stands still"), std::string::npos) << e.all[0].hint;
    // The whole swing of the foot is too early: the error is reported where the foot lands.
    p.phases[both + 1].until -= 0.060;
    e = errors_of(p);
    EXPECT_EQ(e.kinds, (Kinds{"foot_float"})) << both << "\n" << e.printed;
    ASSERT_EQ(e.all.size(), 1u) << e.printed;
    EXPECT_NEAR(e.all[0].at, p.phases[both + 1].until, 0.002);
    // Another fault at that time stays an error.
    const double at = lifts + 0.03;
    for_rows(*p.table,
             [&](double t, size_t k) { p.table->cog[k].x() += 0.015 * bump(t, at, 0.3); });
    EXPECT_EQ(errors_of(p).kinds, (Kinds{"foot_float", "cog_residual"})) << errors_of(p).printed;
  }
  // Both feet are planned to leave the ground too early before a flight. A ground force at this
  // time does not count as an error of the flight.
  Pattern p = hops();
  p.phases[0].until -= 0.060;
  const Errors e = errors_of(p);
  EXPECT_EQ(e.kinds, (Kinds{"contact_ends_early"})) << e.printed;
  EXPECT_EQ(e.all.size(), 2u) << e.printed;
}

// A foot that stays on the ground for the whole phase without carrying is not a fault of timing.
TEST(Consequence, OfAFootThatOnlyBearsNothingIsNone) {
  Pattern p = table_of(sway_pattern(hoap1(), {.side = 0.039, .period = 3, .cycles = 1}));
  const CommandSeries series = sample(hoap1(), p);
  double from = 0, to = 0;  // interval in which the ZMP is well inside the left sole
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const Vector3d zmp = series.samples[k].feet[0].inverse() * series.samples[k].zmp;
    if (std::abs(zmp.y()) > 0.02) continue;
    to = p.table->dt * static_cast<double>(k);
    if (from == 0) from = to;
  }
  ASSERT_GT(to, from + 0.1);
  const double end = p.phases.back().until;
  p.phases = {{from, Support::both, {}}, {to, Support::left, {}}, {end, Support::both, {}}};
  EXPECT_TRUE(errors_of(p).kinds.empty()) << errors_of(p).printed;
}

TEST(Consequence, OfAPhaseThatHasMovedOnStairs) {
  const Pattern stairs = table_of(walk_pattern(hoap1(), {.steps = 3,
                                                         .stride = 0.11,
                                                         .period = 0.6,
                                                         .lift = 0.016,
                                                         .cog_height = 0.2247,
                                                         .rise = 0.008}),
                                  "hoap1-strong");
  for (size_t phase = 2; phase + 1 < stairs.phases.size(); ++phase) {
    Pattern p = stairs;
    p.phases[phase - 1].until -= 0.060;
    p.phases[phase].until -= 0.060;
    const Errors e = errors_of(p);
    EXPECT_EQ(e.kinds, (Kinds{"foot_float"})) << phase << "\n" << e.printed;
  }
}

// A phase is shifted. According to the phase, the feet carry the robot, but their keys move them.
// The check reports this.
TEST(Consequence, OfAFlightWithFootKeysThatEndsEarly) {
  JumpParameters jump = jump_defaults(hoap1());
  jump.forward = 0.02;
  Pattern authored = jump_pattern(hoap1(), jump);
  authored.robot = "hoap1";
  authored.profile = "hoap1-strong";
  Pattern p = baked(hoap1(), authored);
  p.keyframes.clear();
  for (const Keyframe& key : authored.keyframes) {
    if (!key.feet[0] && !key.feet[1]) continue;
    p.keyframes.emplace_back();
    p.keyframes.back().t = key.t;
    p.keyframes.back().feet = key.feet;
  }
  ASSERT_FALSE(p.keyframes.empty());
  ASSERT_TRUE(errors_of(p).kinds.empty()) << errors_of(p).printed;
  p.phases[1].until -= 0.060;
  EXPECT_EQ(errors_of(p).kinds, (Kinds{"foot_float"})) << errors_of(p).printed;
}

}  // namespace
}  // namespace ayumi::test
