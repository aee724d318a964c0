// Footholds that move: the shifted plan against the pendulum it must obey, and pushes of the walk
// of HOAP-1 that the planned footholds do not survive.
#include "ayumi/control/foothold_shift.hpp"

#include <gtest/gtest.h>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/control/laws/dtad.hpp"
#include "ayumi/control/support_region.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulator.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Walk {
  RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  CommandSeries series = sample(model, read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json"));
};
const Walk& walk() {
  static const Walk w;
  return w;
}

double omega_of(const CommandSample& c) { return std::sqrt(kGravity / (c.cog.z() - c.zmp.z())); }

/// The measured state of a robot on its plan, in which the DCM is wrong by `error`.
Estimate on_plan(const CommandSample& plan, const Vector2d& error) {
  Estimate e;
  e.state = plan.state;
  e.cog = plan.cog;
  e.dcog = plan.dcog;
  e.dcog.head<2>() += omega_of(plan) * error;
  const double weight = walk().model.mass() * kGravity;
  e.foot_fz = {supports(plan.support, Side::left) ? weight : 0.0,
               supports(plan.support, Side::right) ? weight : 0.0};
  e.fz = weight;
  e.stance = plan.support == Support::right ? Side::right : Side::left;
  return e;
}

TEST(FootholdShift, SwingsAreThoseOfThePattern) {
  const std::vector<PlannedSwing> swings = swings_of(walk().series);
  ASSERT_EQ(swings.size(), 9u);
  EXPECT_EQ(swings[0].foot, Side::right);
  EXPECT_EQ(swings[0].lift, 1120);
  EXPECT_EQ(swings[0].land, 1571);
  EXPECT_EQ(swings[0].rest, 1670);
  EXPECT_EQ(swings[8].land, 5971);
}

TEST(FootholdShift, CommandBetweenTicksIsBetween) {
  const CommandSeries& s = walk().series;
  const CommandSample half = command_between(s, 1300.5);
  EXPECT_LT((half.cog - 0.5 * (s.samples[1300].cog + s.samples[1301].cog)).norm(), 1e-15);
  EXPECT_LT((half.feet[1].translation() -
             0.5 * (s.samples[1300].feet[1].translation() + s.samples[1301].feet[1].translation()))
                .norm(),
            1e-15);
  EXPECT_EQ(command_between(s, 1e9).cog, s.samples.back().cog);
}

TEST(FootholdShift, NothingLeftOverIsThePatternToTheLastBit) {
  FootholdShift shift(walk().model, walk().series, {.share = 1});
  for (size_t k = 0; k + 1 < walk().series.samples.size(); k += 1) {
    const CommandSample& cmd = walk().series.samples[k];
    ASSERT_EQ(shift.plan().cog, cmd.cog) << k;
    ASSERT_EQ(shift.plan().feet[0].matrix(), cmd.feet[0].matrix()) << k;
    ASSERT_EQ(shift.plan().zmp, cmd.zmp) << k;
    shift.advance(on_plan(cmd, {0.005, 0.002}));
  }
}

constexpr size_t kJump = 2450;

/// A pendulum that walks beside the pattern, with (18)(19) about the plan acting on its ZMP: y is
/// its COG minus the pattern's, so that y'' = omega^2 (y - (Z - pattern's Z)) whatever the plan
/// does. Its DCM changes by `jump` at tick kJump. Returns the distance of its DCM from the plan's
/// at the end of the walk.
double pendulum_error(double share, const Vector2d& jump) {
  const std::vector<CommandSample>& s = walk().series.samples;
  const double omega = omega_of(s.front()), dt = walk().series.dt;
  FootholdShift shift(walk().model, walk().series, {.share = share, .time_scale_limit = 1});
  Vector2d y(0, 0), dy(0, 0);
  double error = 0;
  for (size_t k = 0; k + 1 < s.size(); ++k) {
    if (k == kJump) dy += omega * jump;
    const CommandSample& plan = shift.plan();
    Estimate e = on_plan(plan, {0, 0});
    e.cog.head<2>() = s[k].cog.head<2>() + y;
    e.dcog.head<2>() = s[k].dcog.head<2>() + dy;
    const Vector2d off = (e.cog - plan.cog + (e.dcog - plan.dcog) / omega).head<2>();
    const ConvexPolygon support = support_polygon(walk().model, plan.feet, plan.support);
    const Vector2d zmp = support.project(plan.zmp.head<2>() + 1.25 * off);
    dy += dt * omega * omega * (y - (zmp - s[k].zmp.head<2>()));
    y += dt * dy;
    error = off.norm();
    shift.advance(e);
    if (error > 1) break;
  }
  return error;
}

TEST(FootholdShift, PendulumStepsOutWhatItsSupportCannotAnswer) {
  for (const Vector2d& jump : {Vector2d(0.062, 0), Vector2d(-0.062, 0), Vector2d(0.043, -0.043)}) {
    EXPECT_GT(pendulum_error(0, jump), 1) << jump.transpose();
    EXPECT_LT(pendulum_error(1, jump), 1e-4) << jump.transpose();
  }
}

// While footholds move, the velocity of the COG in the plan is the derivative of its position. At
// the end, the COG is displaced by the same vector as the feet.
TEST(FootholdShift, ShiftedPlanIsSmooth) {
  FootholdShift shift(walk().model, walk().series, {.share = 1, .time_scale_limit = 1.5});
  const double dt = walk().series.dt;
  Vector3d cog = shift.plan().cog, dcog = shift.plan().dcog;
  for (int k = 0; k < 7000; ++k) {
    const bool push = k >= 2300 && k < 2310;
    shift.advance(on_plan(shift.plan(), push ? Vector2d(0.07, 0) : Vector2d(0, 0)));
    if (k > 2320) {
      EXPECT_LT(((shift.plan().cog - cog) / dt - dcog).norm(), 0.02) << k;
    }
    cog = shift.plan().cog;
    dcog = shift.plan().dcog;
  }
  const CommandSample& end = walk().series.samples.back();
  const Vector3d moved = shift.plan().feet[0].translation() - end.feet[0].translation();
  EXPECT_LT((shift.plan().cog - end.cog - moved).norm(), 1e-6);
}

// In the plan, the foot is next to the ground for the last part of a swing. A load on it then
// counts as the planned landing, and the plan's motion continues without a discontinuity; the
// velocity of the COG changes by no more than the ZMP at the edge of a sole requires, 3 mm/s in a
// tick.
TEST(FootholdShift, AFootThatBearsWhereThePlanHasItOnTheGroundIsNotEarly) {
  FootholdShift shift(walk().model, walk().series, {.share = 1, .time_scale_limit = 1.5});
  const std::vector<PlannedSwing> swings = swings_of(walk().series);
  const double weight = walk().model.mass() * kGravity;
  Vector3d dcog = shift.plan().dcog;
  int bears = 0;
  for (int k = 0; k < 7000; ++k) {
    const bool push = k >= 2300 && k < 2310;
    Estimate e = on_plan(shift.plan(), push ? Vector2d(0.07, 0) : Vector2d(0, 0));
    for (const PlannedSwing& swing : swings)
      if (shift.phase() > swing.land - 25 && shift.phase() < swing.land) {
        e.foot_fz[static_cast<size_t>(swing.foot)] = 0.2 * weight;
        ++bears;
      }
    shift.advance(e);
    if (k > 2320) {
      ASSERT_LT((shift.plan().dcog - dcog).norm(), 0.004) << k;
    }
    dcog = shift.plan().dcog;
  }
  EXPECT_GT(bears, 8 * 15);
}

struct Outcomes {
  SimulationResult result;
  Vector2d beside;  // change of the feet relative to each other [m]
  Vector2d moved;   // displacement of both feet at the end, on average [m]
  double nearest;   // smallest distance of the planned feet across the path [m]
  double stride;    // largest stride along the path [m]
};

Outcomes pushed(double at, const Vector3d& direction, double impulse, double step) {
  SimulateOptions options;
  options.profile = "hoap1-strong";
  options.controller.gains = {{"step", step}};
  const Push push{.magnitude = impulse, .direction = direction};
  options.scenario = {{.at = at, .duration = 0.02, .what = push}};
  Simulator run(walk().model, walk().series, options);
  run.keep_samples(false);
  Outcomes o;
  o.nearest = 1;
  o.stride = 0;
  while (run.advance(5)) {
    const Vector3d way = run.plan().feet[0].translation() - run.plan().feet[1].translation();
    o.nearest = std::min(o.nearest, way.y());
    o.stride = std::max(o.stride, std::abs(way.x()));
  }
  o.result = run.result();
  const CommandSample& end = walk().series.samples.back();
  const auto off = [&](int i) -> Vector2d {
    return (run.plan().feet[i].translation() - end.feet[i].translation()).head<2>();
  };
  o.beside = off(0) - off(1);
  o.moved = 0.5 * (off(0) + off(1));
  return o;
}

TEST(FootholdShift, ForwardPushIsSteppedOut) {
  const Outcomes fixed = pushed(3.37, {1, 0, 0}, 3.0, 0);
  // The push is 1.4 times the capture bound.
  const Outcomes stepped = pushed(3.37, {1, 0, 0}, 3.0, 1);
  EXPECT_EQ(fixed.result.outcome, Outcome::fell);
  EXPECT_EQ(stepped.result.outcome, Outcome::stands);
  EXPECT_LT(fixed.stride, 0.031);
  EXPECT_GT(stepped.stride, 0.06);
  EXPECT_LT(stepped.result.final_cog_error, 0.001);
  EXPECT_LT(stepped.beside.norm(), 0.005);
}

TEST(FootholdShift, FeetDoNotCross) {
  for (const double y : {-1.0, 1.0}) {
    const Outcomes o = pushed(3.518, {0, y, 0}, 2.0, 1);
    EXPECT_EQ(o.result.outcome, Outcome::stands) << y;
    EXPECT_GT(o.nearest, 0.063) << y;
  }
}

TEST(FootholdShift, WalkWithoutAPushIsTheSame) {
  const Outcomes fixed = pushed(3.37, {1, 0, 0}, 0, 0);
  const Outcomes free = pushed(3.37, {1, 0, 0}, 0, 1);
  EXPECT_EQ(fixed.result.final_cog_error, free.result.final_cog_error);
  EXPECT_EQ(free.moved, Vector2d(0, 0));
}

// The pattern's own footholds may be nearer to each other than footholds that are moved.
TEST(FootholdShift, TurningAndSideWalksWithoutAPushAreTheSame) {
  const RobotModel& model = walk().model;
  for (const WalkParameters& gait : {WalkParameters{.steps = 4, .stride = 0.02, .turn = 0.2},
                                     WalkParameters{.steps = 4, .stride = 0, .side = 0.04}}) {
    const CommandSeries series = sample(model, walk_pattern(model, gait));
    SimulateOptions options;
    options.profile = "hoap1-strong";
    options.controller.gains = {{"step", 1}};
    options.settle = 0;
    Simulator run(model, series, options);
    run.keep_samples(false);
    bool same = true;
    while (run.advance(1))
      same = same && run.plan().cog == run.command(run.tick() - 1).cog &&
             run.plan().feet[0].matrix() == run.command(run.tick() - 1).feet[0].matrix();
    EXPECT_TRUE(same) << gait.turn;
    EXPECT_EQ(run.result().outcome, Outcome::stands);
  }
}

TEST(FootholdShift, GainsOutOfRangeAreRefused) {
  for (const auto& [gain, value, said] :
       {std::tuple{"step", 1.5, "step is 1.5; it must be from 0 to 1"},
        {"hurry", 0.5, "at least 1"}}) {
    try {
      dtad_params(walk().model, {ControllerKind::dtad, {{gain, value}}});
      FAIL() << gain;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace ayumi
