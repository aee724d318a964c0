// One fault shows in many findings: the finding that causes the others stays an error, and a second
// fault beside it stays an error too.

#include <gtest/gtest.h>

#include <algorithm>

#include "ayumi/check/consistency.hpp"
#include "tests/support/planted.hpp"

namespace ayumi::test {
namespace {

using Eigen::Vector3d;
using namespace planted;

// A walk whose left foot slips in phase 1, in which it carries the robot.
Pattern slipping(const Vector3d& way, const std::function<double(double t)>& shape) {
  Pattern p = walk();
  move_body(hoap1(), *p.table,
            [&](double t, BasePose&, auto& feet) { feet[0].translation() += shape(t) * way; });
  return p;
}

// The angles of the leg change suddenly when the sole is displaced, and again when it comes back.
// The two changes differ, because the body has moved on in between.
TEST(Consequence, OfASlipThatBeginsAndEndsAtOnce) {
  const double from = begin_of(walk(), 1) + 0.02, to = walk().phases[1].until - 0.02;
  for (const Vector3d& way :
       {Vector3d(0.005, 0, 0), Vector3d(0, 0.005, 0), Vector3d(0.0035, -0.0035, 0)}) {
    const Errors e = errors_of(slipping(way, [&](double t) { return t > from && t < to; }));
    EXPECT_EQ(e.kinds, (Kinds{"foot_slip"})) << e.printed;
    ASSERT_EQ(e.all.size(), 1u) << e.printed;
    EXPECT_EQ(e.all[0].where, "left");
    EXPECT_NEAR(e.all[0].worst, 0.005, 1e-4);
  }
}

// An arm is held in a wrong place, and the thigh moves into it. This is one wrong key: the sudden
// movements of the arm are consequences of the collision.
TEST(Consequence, OfAnArmHeldInTheWayAreItsJumps) {
  Pattern p = table_of(squat_pattern(hoap1(), squat_defaults(hoap1())));
  const std::vector<std::pair<std::string, double>> arm = {
      {"l_shoulder_pitch", 76}, {"l_shoulder_roll", 7}, {"l_shoulder_twist", 77}, {"l_elbow", -61}};
  for_rows(*p.table, [&](double t, size_t k) {
    if (std::abs(t - 3.95) > 0.7) return;
    for (const auto& [joint, degrees] : arm)
      p.table->theta(static_cast<Eigen::Index>(k), hoap1().find_dof(joint)) = degrees * kDegree;
  });
  Errors e = errors_of(p);
  EXPECT_EQ(e.kinds, (Kinds{"self_collision"})) << e.printed;
  ASSERT_EQ(e.all.size(), 1u) << e.printed;
  EXPECT_GT(e.all[0].begin, 3.29) << "the arm jumps at 3.25 s";
  // The collision of the left arm does not explain a sudden movement of the right one.
  for_rows(*p.table, [&](double t, size_t k) {
    if (std::abs(t - 3.95) < 0.7)
      p.table->theta(static_cast<Eigen::Index>(k), hoap1().find_dof("r_elbow")) -= 0.5;
  });
  e = errors_of(p);
  EXPECT_TRUE(e.kinds.count("self_collision") && e.kinds.count("joint_speed")) << e.printed;
  for (const Finding& f : e.all)
    EXPECT_TRUE(f.kind != FindingKind::joint_speed || f.where == "r_elbow");
}

// The foot is displaced for most of its contact. Its place at the beginning and at the end of the
// contact counts as its planned place.
TEST(Consequence, OfASlipThatLastsLongerThanTheFootStands) {
  const Pattern sway = table_of(sway_pattern(hoap1(), {.side = 0.015, .period = 2, .cycles = 2}));
  const double from = 1.0, to = sway.phases.back().until - 1.0;
  for (const bool base : {false, true}) {
    Pattern p = sway;
    const auto off = [&](double t) { return t > from && t < to ? 0.005 : 0.0; };
    if (base)
      for_rows(*p.table, [&](double t, size_t k) {
        p.table->base[k].position.x() += off(t);
        p.table->cog[k].x() += off(t);
      });
    else
      move_body(hoap1(), *p.table,
                [&](double t, BasePose&, auto& feet) { feet[0].translation().x() += off(t); });
    const Errors e = errors_of(p);
    EXPECT_EQ(e.kinds, (Kinds{"foot_slip"})) << e.printed;
    EXPECT_EQ(e.all.size(), base ? 2u : 1u) << e.printed;
    for (const Finding& f : e.all) EXPECT_NEAR(f.begin, from, 0.002) << e.printed;
  }
}

// At its beginning and end, the slip is slower than what counts as a slip, and its distance is 0.05
// mm. The forces at these times are nevertheless consequences of the slip.
TEST(Consequence, OfASlipAreForcesAsLongAsTheSoleIsOff) {
  const double at = middle_of(walk(), 1),
               half = 0.5 * (walk().phases[1].until - begin_of(walk(), 1));
  const Errors e = errors_of(slipping({0.005, 0, 0}, [&](double t) {
    const double s = (t - at) / half;
    return std::abs(s) < 1 ? std::exp(-4.5 * s * s) : 0;
  }));
  EXPECT_EQ(e.kinds, (Kinds{"foot_slip"})) << e.printed;
  EXPECT_NEAR(e.all[0].at, at, 0.002) << e.printed;
}

// Feet that turn pass each other closely. If a slip makes them touch, the collision is a
// consequence of the slip.
TEST(Consequence, OfASlipAreFeetThatTouch) {
  Pattern p = table_of(
      walk_pattern(hoap1(), {.steps = 3, .stride = 0.02, .period = 0.8, .turn = 15 * kDegree}));
  slip_foot(hoap1(), *p.table, Side::left, {0.004, -0.004, 0}, middle_of(p, 1) + 0.1, 0.4);
  const Errors e = errors_of(p);
  EXPECT_EQ(e.kinds, (Kinds{"foot_slip"})) << e.printed;
  EXPECT_NE(e.printed.find("warning self_collision r_foot - l_foot"), std::string::npos)
      << e.printed;
}

// A hip and an ankle that turn in opposite directions move the sole 5 mm aside and lift it on the
// way. The error is reported at the time of the largest displacement, not when the sole leaves the
// ground.
TEST(Consequence, OfASlipIsThatTheSoleRises) {
  Pattern p = walk();
  const double at = middle_of(walk(), 1), width = 0.5;
  move_joint(hoap1(), *p.table, "l_hip_pitch", 0.03, at, width);
  move_joint(hoap1(), *p.table, "l_ankle_pitch", -0.03, at, width);
  const Errors e = errors_of(p);
  EXPECT_EQ(e.kinds, (Kinds{"foot_slip"})) << e.printed;
  ASSERT_EQ(e.all.size(), 1u) << e.printed;
  EXPECT_NEAR(e.all[0].at, at, 0.02) << e.printed;
  EXPECT_GT(e.all[0].worst, 0.005);
}

TEST(Consequence, OfAnAngleThatIsWrongForAWhile) {
  const double at = middle_of(walk(), 1);
  const int column = hoap1().find_dof("r_hip_roll");
  // The leg is turned inwards beyond its limit and collides with the other leg.
  Pattern legs = walk();
  const double now = legs.table->theta(std::lround(at / legs.table->dt), column);
  move_joint(hoap1(), *legs.table, "r_hip_roll", 25 * kDegree - now, at, 0.8);
  Errors e = errors_of(legs);
  EXPECT_EQ(e.kinds, (Kinds{"joint_position"})) << e.printed;
  EXPECT_NE(e.printed.find("warning self_collision"), std::string::npos) << e.printed;
  // The offset begins at once while the leg swings: the joint is beyond the limit only for a part
  // of that time.
  Pattern hard = walk();
  for_rows(*hard.table, [&](double t, size_t k) {
    if (std::abs(t - at) < 0.25) hard.table->theta(static_cast<Eigen::Index>(k), column) -= 0.50;
  });
  e = errors_of(hard);
  EXPECT_EQ(e.kinds, (Kinds{"joint_position"})) << e.printed;
  // A collision that is caused by joints of an arm is an error of its own.
  for (const auto& [joint, degrees] : std::vector<std::pair<std::string, double>>{
           {"l_shoulder_pitch", 42}, {"l_shoulder_twist", 85}, {"l_elbow", -64}})
    move_joint(hoap1(), *legs.table, joint, degrees * kDegree, at, 1.5);
  move_joint(hoap1(), *legs.table, "l_shoulder_roll", -10 * kDegree, at, 1.5);
  e = errors_of(legs);
  EXPECT_TRUE(e.kinds.count("joint_position")) << e.printed;
  EXPECT_TRUE(e.kinds.count("self_collision")) << e.printed;
}

// The trunk sways outwards, but the commanded ZMP stays where it was.
TEST(Consequence, OfAMotionWhoseZmpLeavesTheSupportIsItsDistance) {
  Pattern p = table_of(sway_pattern(hoap1(), {.side = 0.02, .period = 2, .cycles = 2}));
  const double at = 0.5 * p.phases.back().until;
  sway_base(hoap1(), *p.table, {0, 0.02, 0}, at, 0.5);
  p.table->cog.clear();
  const Errors e = errors_of(p);
  EXPECT_EQ(e.kinds, (Kinds{"support_margin"})) << e.printed;
  EXPECT_NE(e.printed.find("warning zmp_residual"), std::string::npos) << e.printed;
}

// The commanded COG is wrong while a foot slips. The COG error is larger than the slip, so it stays
// an error of its own, whatever the cause of the slip is.
TEST(Consequence, NeverOfAFaultThatIsLarger) {
  const double at = middle_of(walk(), 1);
  for (const bool base : {false, true}) {
    Pattern p = walk();
    if (base)
      for_rows(*p.table, [&](double t, size_t k) {
        p.table->base[k].position.y() += 0.005 * bump(t, at, 0.4);
      });
    else
      slip_foot(hoap1(), *p.table, Side::left, {0.005, 0, 0}, at, 0.4);
    EXPECT_EQ(errors_of(p).kinds, (Kinds{"foot_slip"})) << errors_of(p).printed;
    for_rows(*p.table,
             [&](double t, size_t k) { p.table->cog[k].x() += 0.015 * bump(t, at, 0.4); });
    EXPECT_EQ(errors_of(p).kinds, (Kinds{"foot_slip", "cog_residual"})) << errors_of(p).printed;
  }
  // A trunk that turns about the ankle moves the COG farther than the sole: this is one fault.
  Pattern p = walk();
  for_rows(*p.table, [&](double t, size_t k) {
    BasePose& base = p.table->base[k];
    base.attitude = Eigen::AngleAxisd(0.08 * bump(t, at, 0.4), Vector3d::UnitX()) * base.attitude;
  });
  const Errors e = errors_of(p);
  EXPECT_FALSE(e.kinds.count("cog_residual")) << e.printed;
  EXPECT_NE(e.printed.find("warning cog_residual"), std::string::npos) << e.printed;
}

TEST(Consequence, NeverOfAFaultElsewhere) {
  Pattern p = walk();
  const double slips = middle_of(p, 1), other = middle_of(p, 3);
  slip_foot(hoap1(), *p.table, Side::left, {0.005, 0, 0}, slips, 0.3);
  for_rows(*p.table, [&](double t, size_t k) {
    p.table->zmp[k].y() -= 0.09 * bump(t, other, 0.3);
    p.table->fz[k] *= 1 + 0.1 * bump(t, 0.4, 0.4);
  });
  const Errors e = errors_of(p);
  EXPECT_EQ(e.kinds, (Kinds{"foot_slip", "support_margin", "fz_residual"})) << e.printed;
}

}  // namespace
}  // namespace ayumi::test
