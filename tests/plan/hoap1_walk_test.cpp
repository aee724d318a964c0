// The default walk on the project's HOAP-1: inside the limits of the real actuators with margin,
// and the ZMP of the full model well inside the soles.
#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using test::hoap1;

struct Figures {
  double zmp_error = 0, margin = 1, landing_speed = 0;
  double position = 0, speed = 0, torque = 0, continuous = 0;  // shares of the limits
};

// The joint torques with the ground force at the ZMP, which the soles share according to its place.
VectorXd joint_torques(const RobotModel& model, const CommandSample& now, RobotData& data) {
  const VectorXd force = inverse_dynamics(model, now.state, now.acceleration, data);
  const GroundReaction ground =
      ground_reaction(now.state.base.position, force.head<6>(), now.zmp.z());
  double left = now.support == Support::right ? 0 : 1;
  if (now.support == Support::both) {
    Vector2d centers[2];
    for (const Side side : {Side::left, Side::right}) {
      const Vector2d& c = model.sole(side).center;
      const Vector3d world = now.feet[static_cast<int>(side)] * Vector3d(c.x(), c.y(), 0);
      centers[static_cast<int>(side)] = world.head<2>();
    }
    const Vector2d across = centers[0] - centers[1];
    left = std::clamp((ground.zmp.head<2>() - centers[1]).dot(across) / across.squaredNorm(), 0.0,
                      1.0);
  }
  VectorXd torque = force.tail(model.dof_count());
  for (const Side side : {Side::left, Side::right}) {
    const double share = side == Side::left ? left : 1 - left;
    const auto J = body_jacobian(model, data, model.sole(side).body, ground.zmp);
    Eigen::Matrix<double, 6, 1> wrench;
    wrench << share * ground.force, 0, 0, share * ground.yaw_moment;
    torque -= (J.transpose() * wrench).tail(model.dof_count());
  }
  return torque;
}

Figures measure(const RobotModel& model, const CommandSeries& series) {
  const ActuatorLimits& limits = model.limits("hoap1");
  RobotData data(model);
  Figures worst;
  VectorXd squares = VectorXd::Zero(model.dof_count());
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const CommandSample& now = series.samples[k];
    const Vector3d zmp = full_model_reaction(model, now, data).zmp;
    worst.zmp_error = std::max(worst.zmp_error, (zmp - now.zmp).norm());
    std::vector<Vector2d> points;
    for (const Side side : {Side::left, Side::right}) {
      if (!supports(now.support, side)) continue;
      for (const Vector2d& v : model.sole(side).polygon)
        points.push_back((now.feet[static_cast<int>(side)] * Vector3d(v.x(), v.y(), 0)).head<2>());
      if (k > 0 && !supports(series.samples[k - 1].support, side)) {
        update_velocities(model, now.state, data);
        const Vector3d at = now.feet[static_cast<int>(side)].translation();
        worst.landing_speed =
            std::max(worst.landing_speed, point_velocity(data, model.sole(side).body, at).norm());
      }
    }
    worst.margin = std::min(worst.margin, ConvexPolygon(points).margin(zmp.head<2>()));
    const VectorXd torque = joint_torques(model, now, data);
    squares += torque.cwiseAbs2();
    for (int i = 0; i < model.dof_count(); ++i) {
      const Dof& dof = model.dofs()[i];
      const double middle = 0.5 * (dof.lower + dof.upper), half = 0.5 * (dof.upper - dof.lower);
      worst.position = std::max(worst.position, std::abs(now.state.theta[i] - middle) / half);
      worst.speed = std::max(worst.speed, std::abs(now.state.dtheta[i]) / limits.speed[i]);
      worst.torque = std::max(worst.torque, std::abs(torque[i]) / limits.peak_torque[i]);
    }
  }
  const VectorXd rms = (squares / static_cast<double>(series.samples.size())).cwiseSqrt();
  worst.continuous = rms.cwiseQuotient(limits.continuous_torque).maxCoeff();
  return worst;
}

TEST(Hoap1Walk, DefaultsKeepTheRealLimitsWithMargin) {
  const Figures worst = measure(hoap1(), sample(hoap1(), walk_pattern(hoap1(), {})));
  EXPECT_LT(worst.zmp_error, 0.0005);
  EXPECT_GT(worst.margin, 0.025);
  EXPECT_LT(worst.landing_speed, 0.002);
  EXPECT_LT(worst.position, 0.9);
  EXPECT_LT(worst.speed, 0.9);
  EXPECT_LT(worst.torque, 0.9);
  EXPECT_LT(worst.continuous, 0.9);
  RecordProperty("speed", std::to_string(worst.speed));
  RecordProperty("torque", std::to_string(worst.torque));
  RecordProperty("continuous", std::to_string(worst.continuous));
  RecordProperty("position", std::to_string(worst.position));
  RecordProperty("zmp_error", std::to_string(worst.zmp_error));
}

TEST(Hoap1Walk, TurningAndSteppingInPlace) {
  WalkParameters turning, in_place;
  turning.turn = 0.15;
  in_place.stride = 0;
  in_place.steps = 12;
  for (const WalkParameters& p : {turning, in_place}) {
    const Figures worst = measure(hoap1(), sample(hoap1(), walk_pattern(hoap1(), p)));
    EXPECT_LT(worst.zmp_error, 0.0005);
    EXPECT_GT(worst.margin, 0.025);
    EXPECT_LT(std::max({worst.position, worst.speed, worst.torque, worst.continuous}), 0.9);
  }
}

}  // namespace
}  // namespace ayumi
