// The angular momentum task: A_G compared with another computation, the moment that the task gives,
// its bounds, and its return.
#include "ayumi/control/angular_momentum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kHoapOmega = 6.3, kMomentumTick = 0.001;  // values of HOAP-1

struct AtHome {
  RobotModel model;
  RobotData data{model};
  RobotState state = model.rest_state();

  explicit AtHome(const char* name)
      : model(load_robot(std::string(AYUMI_SOURCE_DIR "/robots/") + name)) {
    update_positions(model, state, data);
  }
  ActuatorLimits limits() const { return model.limits(); }
};

/// The angular momentum of the bodies in `counted` about their centre of mass, from two postures dt
/// apart.
Vector3d momentum(const RobotModel& model, const std::vector<bool>& counted, const RobotData& from,
                  const RobotData& to, double dt) {
  double mass = 0;
  Vector3d centre = Vector3d::Zero();
  const auto com = [](const RobotData& d, size_t i) -> Vector3d {
    return d.base_position + d.com[i];
  };
  for (size_t i = 0; i < counted.size(); ++i)
    if (counted[i]) {
      mass += model.bodies()[i].inertia.mass;
      centre += model.bodies()[i].inertia.mass * com(from, i);
    }
  centre /= mass;
  Vector3d sum = Vector3d::Zero();
  for (size_t i = 0; i < counted.size(); ++i) {
    if (!counted[i]) continue;
    const Inertia& inertia = model.bodies()[i].inertia;
    const Vector3d velocity = (com(to, i) - com(from, i)) / dt;
    const Vector3d rate = log_rotation(Eigen::Quaterniond(
                              Eigen::Matrix3d(to.rotation[i] * from.rotation[i].transpose()))) /
                          dt;
    sum += inertia.mass * (com(from, i) - centre).cross(velocity) +
           from.rotation[i] * inertia.about_com * from.rotation[i].transpose() * rate;
  }
  return sum;
}

class UpperBody : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(AngularMomentum, UpperBody, testing::Values("hoap1", "humanoid30"));

TEST_P(UpperBody, MatrixIsTheMomentumOfTheUpperBodyByDifferences) {
  AtHome b(GetParam());
  b.state.base.position = {3, -2, 1};
  b.state.base.attitude = Eigen::Quaterniond(exp_rotation(Vector3d(0.2, -0.1, 0.7)));
  for (int j = 0; j < b.model.dof_count(); ++j) b.state.theta[j] += 0.1 * std::sin(3 * j);
  update_positions(b.model, b.state, b.data);
  AngularMomentumTask task(b.model, b.limits());
  const Eigen::Matrix3Xd A = task.matrix(b.data);
  ASSERT_EQ(A.cols(), 2 + std::ssize(task.joints()));
  EXPECT_GE(task.joints().size(), 8u);

  std::vector<bool> leg(b.model.bodies().size()), upper(b.model.bodies().size());
  for (const Side side : {Side::left, Side::right})
    for (const int j : b.model.leg(side))
      leg[static_cast<size_t>(b.model.dofs()[static_cast<size_t>(j)].body)] = true;
  for (size_t i = 0; i < upper.size(); ++i) {
    int k = static_cast<int>(i);
    bool in_leg = false;
    for (; k > 0; k = b.model.bodies()[static_cast<size_t>(k)].parent)
      in_leg |= leg[static_cast<size_t>(k)];
    upper[i] = !in_leg;
  }
  constexpr double kStep = 1e-6;
  for (Eigen::Index c = 0; c < A.cols(); ++c) {
    RobotState state = b.state;
    if (c < 2)
      state.base.attitude =
          Eigen::Quaterniond(exp_rotation(kStep * Vector3d::Unit(c))) * state.base.attitude;
    else
      state.theta[task.joints()[static_cast<size_t>(c) - 2]] += kStep;
    RobotData moved(b.model);
    update_positions(b.model, state, moved);
    const Vector3d expected = momentum(b.model, upper, b.data, moved, kStep);
    EXPECT_LT((A.col(c) - expected).norm(), 1e-4 * (A.col(0).norm() + expected.norm())) << c;
  }
}

TEST_P(UpperBody, GivesTheMomentAndNoneAboutTheVertical) {
  AtHome b(GetParam());
  AngularMomentumTask task(b.model, b.limits());
  const double size = 1e-3 * b.model.mass();
  const Vector3d moment(0.6 * size, -0.8 * size, 0);
  const UpperBodyTurn& turn = task.update(moment, b.data, b.state.theta, Vector2d::Zero(),
                                          TurnRoom{}, kHoapOmega, kMomentumTick);
  VectorXd rate(task.joints().size() + 2);
  rate.head<2>() = turn.lean_rate.head<2>();
  for (size_t i = 0; i < task.joints().size(); ++i)
    rate[static_cast<Eigen::Index>(i) + 2] = turn.joint_rates[task.joints()[i]];
  EXPECT_LT((task.matrix(b.data) * rate / kMomentumTick - moment).norm(), 0.01 * size);
  EXPECT_GT(turn.joint_rates.norm(), 0);
  for (const Side side : {Side::left, Side::right})
    for (const int j : b.model.leg(side)) EXPECT_EQ(turn.joint_rates[j], 0);
}

TEST_P(UpperBody, StaysWithinRangeSpeedAndTorqueAndComesBack) {
  AtHome b(GetParam());
  const ActuatorLimits limits = b.limits();
  AngularMomentumTask task(b.model, limits);
  const Vector3d moment = 5 * b.model.mass() * Vector3d(1, 1, 0);
  double most = 0, arms = 0;
  for (int k = 0; k < 4000; ++k) {
    const UpperBodyTurn& turn =
        task.update(k < 1000 ? moment : Vector3d(Vector3d::Zero()), b.data, b.state.theta,
                    Vector2d::Zero(), TurnRoom{}, kHoapOmega, kMomentumTick);
    most = std::max(most, turn.lean.cwiseAbs().maxCoeff());
    arms = std::max(arms, turn.joints.cwiseAbs().maxCoeff());
    for (int j = 0; j < b.model.dof_count(); ++j) {
      const Dof& dof = b.model.dofs()[static_cast<size_t>(j)];
      const double at = b.state.theta[j] + turn.joints[j];
      ASSERT_GE(at, std::min(dof.lower, b.state.theta[j]) - 0.01) << dof.name << " at tick " << k;
      ASSERT_LE(at, std::max(dof.upper, b.state.theta[j]) + 0.01) << dof.name << " at tick " << k;
      ASSERT_LE(std::abs(turn.joint_rates[j]), limits.speed[j]) << dof.name << " at tick " << k;
    }
  }
  EXPECT_GT(most, 0.3);
  EXPECT_LT(most, 0.45);
  EXPECT_GT(arms, 0.5);
  const UpperBodyTurn& last = task.update(Vector3d::Zero(), b.data, b.state.theta, Vector2d::Zero(),
                                          TurnRoom{}, kHoapOmega, kMomentumTick);
  EXPECT_LT(last.lean.norm(), 0.01);
  EXPECT_LT(last.joints.norm(), 0.01);
}

// The file of the robot states no torques: no bound tells how fast its trunk could be stopped.
TEST_P(UpperBody, WhatStatesNoTorqueDoesNotTurn) {
  AtHome b(GetParam());
  for (const bool arms : {false, true}) {
    SCOPED_TRACE(arms);
    ActuatorLimits limits = b.limits();
    limits.speed.setConstant(INFINITY);
    const std::vector<int> carried = AngularMomentumTask(b.model, limits).joints();
    for (int j = 0; j < b.model.dof_count(); ++j) {
      const bool arm = std::find(carried.begin(), carried.end(), j) != carried.end();
      if (!arms || !arm) limits.peak_torque[j] = INFINITY;
    }
    AngularMomentumTask task(b.model, limits);
    for (int k = 0; k < 200; ++k) {
      const UpperBodyTurn& turn =
          task.update(5 * b.model.mass() * Vector3d(1, 1, 0), b.data, b.state.theta,
                      Vector2d::Zero(), TurnRoom{}, kHoapOmega, kMomentumTick);
      ASSERT_EQ(turn.lean.norm(), 0);
      if (!arms) {
        ASSERT_EQ(turn.joints.norm(), 0);
      } else if (k == 199) {
        EXPECT_GT(turn.joints.norm(), 0.1);
      }
    }
  }
}

// If the plan tilts the trunk, the task turns it less far to the same side, so that the sum of tilt
// and turn stays below the tilt that counts as a fall.
TEST_P(UpperBody, ATiltedTrunkIsTurnedLessFar) {
  AtHome b(GetParam());
  const Vector2d tilt(0, 0.5);
  for (const double sign : {1.0, -1.0})
    for (const Vector3d& axis : {Vector3d(0, 1, 0), Vector3d(1, 0, 0)}) {
      SCOPED_TRACE(testing::Message() << sign << " " << axis.transpose());
      AngularMomentumTask task(b.model, b.limits());
      Vector2d most = Vector2d::Zero();
      for (int k = 0; k < 1000; ++k) {
        const UpperBodyTurn& turn =
            task.update(5 * sign * b.model.mass() * axis, b.data, b.state.theta, tilt, TurnRoom{},
                        kHoapOmega, kMomentumTick);
        most = most.cwiseMax(sign * turn.lean.head<2>());
        EXPECT_LT((tilt + turn.lean.head<2>()).norm(), 0.68);
      }
      if (axis.y() != 0) {
        EXPECT_NEAR(most.y(), sign > 0 ? 0.15 : 0.42, 0.03);
      } else {
        EXPECT_GT(most.x(), 0.3);
      }
    }
}

// The legs leave less room to the trunk than its own range: it brakes in time and stops there.
TEST_P(UpperBody, TheTrunkStopsWhereTheLegsEnd) {
  AtHome b(GetParam());
  constexpr double kEnd = 0.2;
  for (const double sign : {1.0, -1.0}) {
    AngularMomentumTask task(b.model, b.limits());
    double most = 0, turned = 0;
    for (int k = 0; k < 1000; ++k) {
      TurnRoom room;
      room.above.x() = kEnd - turned;
      room.below.x() = kEnd + turned;
      const UpperBodyTurn& turn =
          task.update(5 * sign * b.model.mass() * Vector3d(1, 0, 0), b.data, b.state.theta,
                      Vector2d::Zero(), room, kHoapOmega, kMomentumTick);
      turned = turn.lean.x();
      most = std::max(most, sign * turned);
    }
    EXPECT_GT(most, 0.95 * kEnd);
    EXPECT_LT(most, 1.02 * kEnd);
  }
}

// A joint with a larger weight in W turns less, and the other coordinates turn more.
TEST_P(UpperBody, WeightsMoveTheTurnFromTheArmsToTheTrunk) {
  AtHome b(GetParam());
  const Vector3d moment = 1e-3 * b.model.mass() * Vector3d(1, 0, 0);
  const auto turn_with = [&](double arms) {
    AngularMomentumTask task(b.model, b.limits());
    VectorXd weight = b.model.joint_weight();
    for (const int j : task.joints()) weight[j] = arms;
    task.weigh(weight);
    return task.update(moment, b.data, b.state.theta, Vector2d::Zero(), TurnRoom{}, kHoapOmega,
                       kMomentumTick);
  };
  const UpperBodyTurn light = turn_with(0.01), heavy = turn_with(1e6);
  EXPECT_LT(heavy.joint_rates.norm(), 1e-3 * light.joint_rates.norm());
  EXPECT_GT(heavy.lean_rate.norm(), 1.1 * light.lean_rate.norm());
}

}  // namespace
}  // namespace ayumi
