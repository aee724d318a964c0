// Which task gives way if a joint is at its limit, on the real HOAP-1.
#include "ayumi/control/whole_body.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;

struct Standing {
  RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  ActuatorLimits limits = model.limits("hoap1");
  CommandSample command;
  RobotData data{model};

  /// The robot is at rest with this bend of the knees, the trunk upright and the soles level.
  explicit Standing(double knee, bool at_stop = false) {
    if (at_stop) {
      RobotDescription description = model.description();
      for (JointDescription& joint : description.joints)
        if (joint.name.ends_with("_knee")) joint.lower = knee;
      model = RobotModel(description);
      data = RobotData(model);
    }
    const CommandSeries series = sample(model, stand_pattern(model, 0.01));
    command = series.samples.front();
    RobotState& s = command.state;
    for (const char* side : {"l_", "r_"}) {
      s.theta[model.find_dof(std::string(side) + "hip_pitch")] = -knee / 2;
      s.theta[model.find_dof(std::string(side) + "knee")] = knee;
      s.theta[model.find_dof(std::string(side) + "ankle_pitch")] = -knee / 2;
    }
    anchor_base(model, Side::left, command.feet[0], s, data);
  }

  Resolution solve(const Vector3d& velocity) {
    return resolve(model, limits, command.state, data, Side::left, velocity, command, command,
                   0.001, model.joint_weight());
  }

  /// The velocities of the COG and of the right sole that the rates give.
  std::pair<Vector3d, Vector3d> moves(const Resolution& r) {
    RobotState s = command.state;
    RobotData now(model), next(model);
    anchor_base(model, Side::left, command.feet[0], s, now);
    const Vector3d cog = now.cog, foot = sole_pose(model, now, Side::right).translation();
    s.theta += 1e-6 * r.dtheta;
    anchor_base(model, Side::left, command.feet[0], s, next);
    return {(next.cog - cog) / 1e-6,
            (sole_pose(model, next, Side::right).translation() - foot) / 1e-6};
  }
};

TEST(Resolver, BentKneesGiveAllTasks) {
  Standing robot(0.8);
  const Vector3d wanted(0.03, 0.04, 0.05);
  const Resolution r = robot.solve(wanted);
  EXPECT_TRUE(r.held.empty());
  EXPECT_FALSE(r.yielding.height);
  EXPECT_EQ(r.scale, 1);
  EXPECT_TRUE(limit_notes(robot.model, r).empty());
  const auto [cog, foot] = robot.moves(r);
  EXPECT_NEAR((cog - wanted).norm(), 0, 1e-3);
  EXPECT_NEAR(foot.norm(), 0, 1e-3);
}

TEST(Resolver, NearlyStraightKneesLetTheHeightGiveWay) {
  Standing robot(0.05);
  const Resolution r = robot.solve({0.03, 0.04, 0.3});
  EXPECT_TRUE(r.yielding.height);
  EXPECT_FALSE(r.yielding.trunk);
  EXPECT_EQ(r.scale, 1) << "the rest is not slowed";
  for (int j = 0; j < robot.model.dof_count(); ++j)
    EXPECT_LE(std::abs(r.dtheta[j]), robot.limits.speed[j]);
  const auto [cog, foot] = robot.moves(r);
  EXPECT_NEAR(cog.x(), 0.03, 2e-3);
  EXPECT_NEAR(cog.y(), 0.04, 2e-3);
  EXPECT_NEAR(foot.norm(), 0, 2e-3);
  const std::vector<std::string> notes = limit_notes(robot.model, r);
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes[0].find("deviates from the plan"), std::string::npos) << notes[0];
  EXPECT_NE(notes[0].find("the COG height"), std::string::npos) << notes[0];
}

TEST(Resolver, AKneeAtItsStopIsHeld) {
  Standing robot(0.7, true);
  const Resolution r = robot.solve({0, 0.03, 0.05});
  EXPECT_FALSE(r.held.empty());
  EXPECT_TRUE(r.yielding.height);
  for (int j = 0; j < robot.model.dof_count(); ++j) {
    const Dof& dof = robot.model.dofs()[j];
    const double after = robot.command.state.theta[j] + 0.001 * r.dtheta[j];
    EXPECT_GE(after, dof.lower - 1e-12) << dof.name;
    EXPECT_LE(after, dof.upper + 1e-12) << dof.name;
    EXPECT_LE(std::abs(r.dtheta[j]), robot.limits.speed[j]) << dof.name;
  }
  bool knee = false;
  for (const std::string& note : limit_notes(robot.model, r))
    knee = knee || note.find("knee is at its position limit: the COG height") != std::string::npos;
  EXPECT_TRUE(knee);
}

/// What the joints do while the trunk turns to the side until a hip is at its position limit, with
/// a deceleration before the limits of at most `braking`.
struct TurnToLimit {
  double excess = 0;  ///< largest excess of the way to a stop over the room to the limit [rad]
  double nearest = 1, largest_share = 0;
  bool brakes = false, arrives = false;  ///< what the notes say
};

TurnToLimit turn_to_limit(Support support, double braking, double planned_rate = 0) {
  Standing robot(0.8);
  const int n = robot.model.dof_count();
  const double dt = 0.001, z = 0.2;
  ReferenceBody body(robot.model, robot.limits, dt, robot.command.state, robot.command.state.theta);
  robot.command.support = support;
  for (int j = 0; j < n; ++j)
    if (robot.model.dofs()[j].name.find("hip_roll") != std::string::npos)
      robot.command.state.dtheta[j] = planned_rate;
  UpperBodyTurn turn;
  turn.joints.setZero(n);
  turn.joint_rates.setZero(n);
  turn.lean_rate.x() = 1.5;
  Eigen::VectorXd before = robot.command.state.theta;
  TurnToLimit result;
  for (int k = 0; k < 1000; ++k) {
    ControlOutput out;
    turn.lean.x() = turn.lean_rate.x() * dt * k;
    body.anchor(Side::left, robot.command.feet[0]);
    body.turn(turn);
    body.advance({}, z, robot.command, robot.command, Eigen::VectorXd::Zero(n), out);
    for (int j = 0; j < n; ++j) {
      const Dof& dof = robot.model.dofs()[j];
      const double rate = (body.state().theta[j] - before[j]) / dt;
      const double room = rate > 0 ? dof.upper - before[j] : before[j] - dof.lower;
      const double needed = std::abs(rate) * dt + rate * rate / (2 * braking);
      result.excess = std::max(result.excess, needed - room);
      if (std::abs(rate) > 0.5)
        result.largest_share = std::max(result.largest_share, needed / room);
      result.nearest = std::min(result.nearest, room - std::abs(rate) * dt);
    }
    before = body.state().theta;
    for (const std::string& note : out.notes) {
      result.brakes |= note.find("hip_roll brakes before its position limit") != std::string::npos;
      result.arrives |= note.find("hip_roll is at its position limit") != std::string::npos;
    }
  }
  return result;
}

// While one foot swings, each joint keeps a rate at which it can stop before its limit with the
// bounded deceleration. While both feet stand, it reaches the limit at full speed. A joint whose
// plan moves it towards the limit follows its plan.
TEST(ReferenceBody, JointsBrakeBeforeTheirPositionLimits) {
  const double braking = 5 * 9.81 / 0.2;
  const TurnToLimit one = turn_to_limit(Support::left, braking);
  EXPECT_LT(one.excess, 1e-9);
  EXPECT_LT(one.nearest, 0.002) << "a joint came to its limit";
  EXPECT_GT(one.largest_share, 0.9) << "a fast joint came near the limit";
  EXPECT_TRUE(one.brakes);
  const TurnToLimit both = turn_to_limit(Support::both, braking);
  EXPECT_GT(both.excess, 0.001);
  EXPECT_FALSE(both.brakes);
  EXPECT_TRUE(both.arrives);
  // The hips turn towards their lower limits.
  EXPECT_GT(turn_to_limit(Support::left, braking, -2).excess, 0.001);
}

// A joint beyond one of its limits is brought back in one tick, at either end.
TEST(Resolver, AJointBeyondItsLimitReturnsAtOnce) {
  Standing robot(0.8);
  const int n = robot.model.dof_count();
  int knee = -1;
  for (int j = 0; j < n; ++j)
    if (robot.model.dofs()[j].name == "l_knee") knee = j;
  ASSERT_GE(knee, 0);
  for (const bool above : {true, false}) {
    SCOPED_TRACE(above);
    const Dof& dof = robot.model.dofs()[knee];
    RobotState reference = robot.command.state;
    reference.theta[knee] = above ? dof.upper + 0.05 : dof.lower - 0.05;
    RobotData data(robot.model);
    ActuatorLimits fast = robot.limits;
    fast.speed.setConstant(1e4);
    ResolverOptions options;
    options.braking = 200;
    const Resolution r =
        resolve(robot.model, fast, reference, data, Side::left, Vector3d::Zero(), robot.command,
                robot.command, 0.001, robot.model.joint_weight(), options);
    EXPECT_NEAR(reference.theta[knee] + 0.001 * r.dtheta[knee], above ? dof.upper : dof.lower,
                1e-9);
  }
}

// A trunk that tilts to the side, with the COG and the soles at rest, turns until a hip is at its
// position limit. The room that is stated in advance ends there, on either side.
TEST(ReferenceBody, TheHipsLimitTheTurnOfTheTrunk) {
  for (const double side : {1.0, -1.0}) {
    SCOPED_TRACE(side);
    Standing robot(0.8);
    const int n = robot.model.dof_count();
    ReferenceBody body(robot.model, robot.limits, 0.001, robot.command.state,
                       robot.command.state.theta);
    EXPECT_EQ(body.turn_room().above.x(), INFINITY) << "nothing is known before the first tick";
    UpperBodyTurn turn;
    turn.joints.setZero(n);
    turn.joint_rates.setZero(n);
    double room = 0;
    bool at_limit = false;
    for (int k = 0; k < 1000 && !at_limit; ++k) {
      ControlOutput out;
      turn.lean.x() = side * 0.001 * k;
      turn.lean_rate.x() = side;
      body.anchor(Side::left, robot.command.feet[0]);
      body.turn(turn);
      body.advance({}, 0.2, robot.command, robot.command, Eigen::VectorXd::Zero(n), out);
      if (k == 10) {
        const TurnRoom left = body.turn_room();
        room = turn.lean.norm() + (side > 0 ? left.above.x() : left.below.x());
      }
      for (const std::string& note : out.notes)
        at_limit |= note.find("hip_roll is at its position limit") != std::string::npos;
    }
    EXPECT_TRUE(at_limit);
    EXPECT_GT(room, 0.2);
    EXPECT_NEAR(turn.lean.norm(), room, 0.05 * room);
  }
}

TEST(Resolver, WhatNoTaskCanGiveMakesTheMotionSlower) {
  Standing robot(0.8);
  const Resolution r = robot.solve({2.0, 0, 0});
  EXPECT_LT(r.scale, 1);
  for (int j = 0; j < robot.model.dof_count(); ++j)
    EXPECT_LE(std::abs(r.dtheta[j]), robot.limits.speed[j]);
  const std::vector<std::string> notes = limit_notes(robot.model, r);
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes[0].find("the whole motion becomes slower"), std::string::npos) << notes[0];
}

}  // namespace
}  // namespace ayumi
