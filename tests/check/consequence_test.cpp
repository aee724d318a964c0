// One fault shows in many findings: the one that brings the others about stays an error, and a
// second fault beside it stays one too.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "ayumi/check/consistency.hpp"
#include "ayumi/pattern/generate.hpp"
#include "tests/support/check_report.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

using Eigen::Vector3d;
using Kinds = std::set<std::string>;

constexpr double kDegree = M_PI / 180;

Pattern table_of(Pattern pattern, const std::string& profile = "") {
  pattern.robot = "hoap1";
  pattern.profile = profile;
  return baked(hoap1(), pattern);
}

const Pattern& walk() {
  static const Pattern pattern = table_of(walk_pattern(hoap1(), {.steps = 3, .period = 0.8}));
  return pattern;
}

const Pattern& hops() {
  static const Pattern pattern = [] {
    JumpParameters jump = jump_defaults(hoap1());
    jump.times = 2;
    return table_of(jump_pattern(hoap1(), jump), "hoap1-strong");
  }();
  return pattern;
}

double begin_of(const Pattern& pattern, size_t phase) {
  return phase > 0 ? pattern.phases[phase - 1].until : 0;
}

double middle_of(const Pattern& pattern, size_t phase) {
  return 0.001 * std::round(500 * (begin_of(pattern, phase) + pattern.phases[phase].until));
}

struct Errors {
  Kinds kinds;
  std::vector<Finding> all;
  std::string told;
};

Errors errors_of(const Pattern& pattern) {
  Errors errors;
  std::ostringstream told;
  for (const Finding& f : report_of(hoap1(), pattern).findings) {
    told << name_of(f.severity) << " " << f.kind << " " << f.where << " at " << f.at << " worst "
         << f.worst << " <- " << f.follows_from << "\n";
    if (f.severity != Severity::error) continue;
    errors.kinds.insert(f.kind);
    errors.all.push_back(f);
  }
  errors.told = told.str();
  return errors;
}

// The left foot carries in phase 1 of the walk.
Pattern slipping(const Vector3d& way, const std::function<double(double t)>& shape) {
  Pattern p = walk();
  move_body(hoap1(), *p.table,
            [&](double t, BasePose&, auto& feet) { feet[0].translation() += shape(t) * way; });
  return p;
}

// All joints of a leg jump to where the sole is and back: not each of them by the same angle, for
// the body has moved on meanwhile.
TEST(Consequence, OfASlipThatBeginsAndEndsAtOnce) {
  const double from = begin_of(walk(), 1) + 0.02, to = walk().phases[1].until - 0.02;
  for (const Vector3d& way :
       {Vector3d(0.005, 0, 0), Vector3d(0, 0.005, 0), Vector3d(0.0035, -0.0035, 0)}) {
    const Errors e = errors_of(slipping(way, [&](double t) { return t > from && t < to; }));
    EXPECT_EQ(e.kinds, (Kinds{"foot_slip"})) << e.told;
    ASSERT_EQ(e.all.size(), 1u) << e.told;
    EXPECT_EQ(e.all[0].where, "left");
    EXPECT_NEAR(e.all[0].worst, 0.005, 1e-4);
  }
}

// Its flanks are slower than what counts as a slip, and break off at 0.05 mm: still the same slip.
TEST(Consequence, OfASlipAreForcesAsLongAsTheSoleIsOff) {
  const double at = middle_of(walk(), 1),
               half = 0.5 * (walk().phases[1].until - begin_of(walk(), 1));
  const Errors e = errors_of(slipping({0.005, 0, 0}, [&](double t) {
    const double s = (t - at) / half;
    return std::abs(s) < 1 ? std::exp(-4.5 * s * s) : 0;
  }));
  EXPECT_EQ(e.kinds, (Kinds{"foot_slip"})) << e.told;
  EXPECT_NEAR(e.all[0].at, at, 0.002) << e.told;
}

// Feet that turn pass each other closely: what a slip closes of that gap is the slip's doing.
TEST(Consequence, OfASlipAreFeetThatTouch) {
  Pattern p = table_of(
      walk_pattern(hoap1(), {.steps = 3, .stride = 0.02, .period = 0.8, .turn = 15 * kDegree}));
  slip_foot(hoap1(), *p.table, Side::left, {0.004, -0.004, 0}, middle_of(p, 1) + 0.1, 0.4);
  const Errors e = errors_of(p);
  EXPECT_EQ(e.kinds, (Kinds{"foot_slip"})) << e.told;
  EXPECT_NE(e.told.find("warning self_collision r_foot - l_foot"), std::string::npos) << e.told;
}

// A hip and an ankle that turn against each other put the sole 5 mm aside and lift it on the way:
// it is told at its farthest, not where it leaves the ground.
TEST(Consequence, OfASlipIsThatTheSoleRises) {
  Pattern p = walk();
  const double at = middle_of(walk(), 1), width = 0.5;
  move_joint(hoap1(), *p.table, "l_hip_pitch", 0.03, at, width);
  move_joint(hoap1(), *p.table, "l_ankle_pitch", -0.03, at, width);
  const Errors e = errors_of(p);
  EXPECT_EQ(e.kinds, (Kinds{"foot_slip"})) << e.told;
  ASSERT_EQ(e.all.size(), 1u) << e.told;
  EXPECT_NEAR(e.all[0].at, at, 0.02) << e.told;
  EXPECT_GT(e.all[0].worst, 0.005);
}

TEST(Consequence, OfAnAngleThatIsWrongForAWhile) {
  const double at = middle_of(walk(), 1);
  const int column = hoap1().find_dof("r_hip_roll");
  // Inwards beyond its limit the leg meets the other one.
  Pattern legs = walk();
  const double now = legs.table->theta(std::lround(at / legs.table->dt), column);
  move_joint(hoap1(), *legs.table, "r_hip_roll", 25 * kDegree - now, at, 0.8);
  Errors e = errors_of(legs);
  EXPECT_EQ(e.kinds, (Kinds{"joint_position"})) << e.told;
  EXPECT_NE(e.told.find("warning self_collision"), std::string::npos) << e.told;
  // Offset at once while it swings: beyond the limit only for a part of that time.
  Pattern hard = walk();
  for_rows(*hard.table, [&](double t, size_t k) {
    if (std::abs(t - at) < 0.25) hard.table->theta(static_cast<Eigen::Index>(k), column) -= 0.50;
  });
  e = errors_of(hard);
  EXPECT_EQ(e.kinds, (Kinds{"joint_position"})) << e.told;
  // What does not hang on that leg is a fact of its own.
  for (const auto& [joint, degrees] : std::vector<std::pair<std::string, double>>{
           {"l_shoulder_pitch", 42}, {"l_shoulder_twist", 85}, {"l_elbow", -64}})
    move_joint(hoap1(), *legs.table, joint, degrees * kDegree, at, 1.5);
  move_joint(hoap1(), *legs.table, "l_shoulder_roll", -10 * kDegree, at, 1.5);
  e = errors_of(legs);
  EXPECT_TRUE(e.kinds.count("joint_position")) << e.told;
  EXPECT_TRUE(e.kinds.count("self_collision")) << e.told;
}

// Without the force that no ground gives, the motors have nothing to do for it.
TEST(Consequence, OfAFlightThatIsNotFreeAreTorques) {
  const double from = begin_of(hops(), 1), to = hops().phases[1].until, at = middle_of(hops(), 1);
  const auto kink = [&](double t) {
    return std::max(0.0, 1 - std::abs(t - at) / (0.3 * (to - from)));
  };
  for (const Vector3d& way : {Vector3d(0.01, 0, 0), Vector3d(0, 0.01, 0), Vector3d(0, 0, 0.01)}) {
    Pattern p = hops();
    for_rows(*p.table, [&](double t, size_t k) { p.table->base[k].position += kink(t) * way; });
    Errors e = errors_of(p);
    EXPECT_EQ(e.kinds, (Kinds{"ballistic"})) << e.told;
    EXPECT_NEAR(e.all[0].at, at, 0.002) << e.told;
    // An arm that is thrown in the next flight is another fault.
    move_joint(hoap1(), *p.table, "l_shoulder_pitch", 0.6, middle_of(p, 3), 0.05);
    e = errors_of(p);
    EXPECT_TRUE(e.kinds.count("ballistic") && e.all.size() > 1) << e.told;
  }
}

// A flight at another scale ends with a jump to the ground: soles and forces there are not the
// cause.
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
    EXPECT_EQ(e.kinds, (Kinds{"ballistic"})) << scale << "\n" << e.told;
  }
}

// Parallel to the true flight, but nothing throws a robot there.
TEST(Consequence, OfAFlightThatLeapsAreItsEdges) {
  const double dt = hops().table->dt, from = begin_of(hops(), 1), to = hops().phases[1].until;
  for (const Vector3d& way : {Vector3d(0.005, 0, 0), Vector3d(0, -0.003, 0), Vector3d(0, 0, 0.02),
                              Vector3d(0, 0, -0.01)}) {
    for (const bool command : {false, true}) {
      for (const double less : {0.0, 1.0}) {  // sample before the end
        Pattern p = hops();
        for_rows(*p.table, [&](double t, size_t k) {
          if (t < from - 0.5 * dt || t > to + (0.5 - less) * dt) return;
          p.table->base[k].position += way;
          if (command) p.table->cog[k] += way;
        });
        const Errors e = errors_of(p);
        EXPECT_EQ(e.kinds, (Kinds{"ballistic"})) << way.transpose() << "\n" << e.told;
        ASSERT_EQ(e.all.size(), 1u) << e.told;
        EXPECT_EQ(e.all[0].where, way.z() != 0 ? "z" : way.x() != 0 ? "x" : "y");
        EXPECT_TRUE(std::abs(e.all[0].at - from) < 0.0021 || std::abs(e.all[0].at - to) < 0.0021);
        EXPECT_NE(e.all[0].hint.find("leaps by"), std::string::npos) << e.all[0].hint;
      }
    }
  }
  // Out of its place for the first part of the next stance, and in it from then on: a foot's.
  Pattern p = hops();
  const double begin = to, end = to + 0.4 * (p.phases[2].until - to);
  for_rows(*p.table, [&](double t, size_t k) {
    if (t < begin - 0.5 * dt || t > end - 0.5 * dt) return;
    p.table->base[k].position.x() += 0.005;
    p.table->cog[k].x() += 0.005;
  });
  EXPECT_EQ(errors_of(p).kinds, (Kinds{"foot_slip"})) << errors_of(p).told;
}

// A commanded COG that is bent in the flight only is a flight that is not free; beyond it, a key.
TEST(Consequence, OfACommandedCogDependsOnWhereItEnds) {
  const double at = middle_of(hops(), 1), length = hops().phases[1].until - begin_of(hops(), 1);
  for (const double share : {0.9, 6.0}) {
    Pattern p = hops();
    for_rows(*p.table, [&](double t, size_t k) {
      p.table->cog[k].x() += 0.015 * std::max(0.0, 1 - std::abs(t - at) / (0.5 * share * length));
    });
    const Errors e = errors_of(p);
    EXPECT_EQ(e.kinds, (Kinds{share < 1 ? "ballistic" : "cog_residual"})) << e.told;
  }
}

// A flight, or a stance between two flights, 60 ms early at both its ends.
TEST(Consequence, OfAPhaseThatHasMoved) {
  for (const size_t phase : {1, 2, 3}) {
    Pattern p = hops();
    p.phases[phase - 1].until -= 0.060;
    p.phases[phase].until -= 0.060;
    const Errors e = errors_of(p);
    EXPECT_EQ(e.kinds, (Kinds{"foot_float"})) << phase << "\n" << e.told;
    EXPECT_EQ(e.all.size(), 2u) << e.told;
  }
  // The next flight, not free.
  Pattern p = hops();
  const double at = middle_of(p, 3);
  for_rows(*p.table,
           [&](double t, size_t k) { p.table->base[k].position.x() += 0.01 * bump(t, at, 0.06); });
  p.phases[0].until -= 0.060;
  p.phases[1].until -= 0.060;
  const Errors e = errors_of(p);
  EXPECT_EQ(e.kinds, (Kinds{"foot_float", "ballistic"})) << e.told;
}

// The foot that is let go stands still meanwhile: silent in forces where the ZMP is already over
// the other one.
TEST(Consequence, OfAFootThatIsLetGoTooEarly) {
  for (const size_t both : {0, 2, 4}) {
    Pattern p = walk();
    ASSERT_EQ(p.phases[both].support, Support::both);
    const double lifts = p.phases[both].until -= 0.060;
    Errors e = errors_of(p);
    EXPECT_EQ(e.kinds, (Kinds{"foot_float"})) << both << "\n" << e.told;
    ASSERT_EQ(e.all.size(), 1u) << e.told;
    EXPECT_EQ(e.all[0].where, name_of(p.phases[both + 1].swing->foot)) << e.told;
    EXPECT_NEAR(e.all[0].at, lifts, 0.002);
    EXPECT_EQ(e.all[0].unit, "s");
    EXPECT_NEAR(e.all[0].worst, 0.060, 0.005);
    EXPECT_NE(e.all[0].hint.find("stands still"), std::string::npos) << e.all[0].hint;
    // Its swing moved as a whole: told where the foot lands.
    p.phases[both + 1].until -= 0.060;
    e = errors_of(p);
    EXPECT_EQ(e.kinds, (Kinds{"foot_float"})) << both << "\n" << e.told;
    ASSERT_EQ(e.all.size(), 1u) << e.told;
    EXPECT_NEAR(e.all[0].at, p.phases[both + 1].until, 0.002);
    // Another fault at that time stays one.
    const double at = lifts + 0.03;
    for_rows(*p.table,
             [&](double t, size_t k) { p.table->cog[k].x() += 0.015 * bump(t, at, 0.3); });
    EXPECT_EQ(errors_of(p).kinds, (Kinds{"foot_float", "cog_residual"})) << errors_of(p).told;
  }
  // Both feet, before a flight: what pushes there is no flight that is not free.
  Pattern p = hops();
  p.phases[0].until -= 0.060;
  const Errors e = errors_of(p);
  EXPECT_EQ(e.kinds, (Kinds{"foot_float"})) << e.told;
  EXPECT_EQ(e.all.size(), 2u) << e.told;
}

// A foot that stays on the ground without bearing, the whole phase long, is no matter of timing.
TEST(Consequence, OfAFootThatOnlyBearsNothingIsNone) {
  Pattern p = table_of(sway_pattern(hoap1(), {.side = 0.039, .period = 3, .cycles = 1}));
  const CommandSeries series = sample(hoap1(), p);
  double from = 0, to = 0;  // while the ZMP is well inside the left sole
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const Vector3d zmp = series.samples[k].feet[0].inverse() * series.samples[k].zmp;
    if (std::abs(zmp.y()) > 0.02) continue;
    to = p.table->dt * static_cast<double>(k);
    if (from == 0) from = to;
  }
  ASSERT_GT(to, from + 0.1);
  const double end = p.phases.back().until;
  p.phases = {{from, Support::both, {}}, {to, Support::left, {}}, {end, Support::both, {}}};
  EXPECT_TRUE(errors_of(p).kinds.empty()) << errors_of(p).told;
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
    EXPECT_EQ(e.kinds, (Kinds{"foot_float"})) << phase << "\n" << e.told;
  }
}

// The trunk sways out, and the ZMP commanded for it stays where it was.
TEST(Consequence, OfAMotionWhoseZmpLeavesTheSupportIsItsDistance) {
  Pattern p = table_of(sway_pattern(hoap1(), {.side = 0.02, .period = 2, .cycles = 2}));
  const double at = 0.5 * p.phases.back().until;
  sway_base(hoap1(), *p.table, {0, 0.02, 0}, at, 0.5);
  p.table->cog.clear();
  const Errors e = errors_of(p);
  EXPECT_EQ(e.kinds, (Kinds{"support_margin"})) << e.told;
  EXPECT_NE(e.told.find("warning zmp_residual"), std::string::npos) << e.told;
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
  EXPECT_EQ(e.kinds, (Kinds{"foot_slip", "support_margin", "fz_residual"})) << e.told;
}

// Feet that the keys move while a shifted phase says they carry: the check tells it.
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
  ASSERT_TRUE(errors_of(p).kinds.empty()) << errors_of(p).told;
  p.phases[1].until -= 0.060;
  EXPECT_EQ(errors_of(p).kinds, (Kinds{"foot_float"})) << errors_of(p).told;
}

}  // namespace
}  // namespace ayumi::test
