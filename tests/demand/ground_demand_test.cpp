#include "ayumi/demand/ground_demand.hpp"

#include <gtest/gtest.h>

#include "ayumi/demand/contact_plan.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/math/rotation.hpp"
#include "tests/support/limited_biped.hpp"
#include "tests/support/random_robot.hpp"
#include "tests/support/walk.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

std::array<Eigen::Isometry3d, 2> random_soles(Random& random, bool level) {
  std::array<Eigen::Isometry3d, 2> soles;
  for (int s = 0; s < 2; ++s) {
    soles[s].setIdentity();
    soles[s].translation() = Vector3d(random.uniform(-0.1, 0.1), s == 0 ? 0.04 : -0.04,
                                      level ? 0.1 : random.uniform(-0.02, 0.02));
    soles[s].linear() =
        exp_rotation(Vector3d(level ? 0 : random.uniform(-0.1, 0.1),
                              level ? 0 : random.uniform(-0.1, 0.1), random.uniform(-0.4, 0.4)))
            .toRotationMatrix();
  }
  return soles;
}

}  // namespace

// On level ground, the plane gives the same ZMP as dynamics/zmp.hpp, which has a formula of its
// own.
TEST(Residuals, GroundUseAgreesWithGroundReaction) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const auto soles = random_soles(random, true);
    const SupportPlane plane = support_plane(limited_biped(), Support::both, soles);
    const Vector3d base = random.vector(0.3);
    Vector6d wrench;
    wrench << random.vector(10), random.vector(5);
    wrench[2] += 60;
    const GroundDemand use = ground_demand(plane, plane_wrench(plane, base, wrench), 1);
    const GroundReaction reaction = ground_reaction(base, wrench, 0.1);
    EXPECT_NEAR((use.zmp_world - reaction.zmp).norm(), 0, 1e-12);
    EXPECT_NEAR(use.yaw_moment, reaction.yaw_moment, 1e-12);
    EXPECT_NEAR(use.normal_force, reaction.force.z(), 1e-12);
  }
}

// On a slope the moment about the ZMP is normal to the plane: the definition of the ZMP.
TEST(Residuals, MomentAboutZmpIsNormalOnASlope) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const auto soles = random_soles(random, false);
    const SupportPlane plane = support_plane(limited_biped(), Support::left, soles);
    const Vector3d base = random.vector(0.3);
    Vector6d wrench;
    wrench << random.vector(10), random.vector(5);
    wrench[2] += 60;
    const GroundDemand use = ground_demand(plane, plane_wrench(plane, base, wrench), 1);
    const Vector3d normal = soles[0].linear().col(2);
    const Vector3d moment =
        wrench.tail<3>() - (use.zmp_world - base).cross(Vector3d(wrench.head<3>()));
    EXPECT_NEAR((moment - use.yaw_moment * normal).norm(), 0, 1e-11);
    EXPECT_NEAR(normal.dot(use.zmp_world - soles[0].translation()), 0, 1e-12);
  }
}

// The rows that the nonlinear program constrains give the margin that the report prints.
TEST(Residuals, SupportRowsGiveTheMargin) {
  Random random(3);
  int inside = 0;
  for (int i = 0; i < 200; ++i) {
    const SupportPlane plane =
        support_plane(limited_biped(), Support::both, random_soles(random, false));
    const double fz = 60;
    const Vector2d zmp(random.uniform(-0.15, 0.15), random.uniform(-0.08, 0.08));
    Vector6d wrench;
    wrench << random.uniform(), random.uniform(), fz, fz * zmp.y(), -fz * zmp.x(), 0.3;
    const GroundDemand use = ground_demand(plane, wrench, 1);
    EXPECT_NEAR((use.zmp - zmp).norm(), 0, 1e-14);
    const double least = (support_rows(plane) * wrench).minCoeff() / fz;
    if (use.margin >= 0) {
      ++inside;
      EXPECT_NEAR(least, use.margin, 1e-14);
    } else {
      EXPECT_LT(least, 0);
    }
  }
  EXPECT_GT(inside, 30);
}

// The lever is computed again by sampling: points are drawn with a uniform distribution, and are
// kept if they and their mirror image are inside.
TEST(Residuals, YawLeverAgreesWithSampling) {
  Random random(4);
  const ConvexPolygon polygon({{-0.05, -0.03}, {0.05, -0.03}, {0.06, 0.02}, {-0.04, 0.035}});
  for (const Vector2d& zmp : {Vector2d(0, 0), Vector2d(0.03, 0.01), Vector2d(-0.03, -0.02)}) {
    double sum = 0;
    int count = 0;
    for (int i = 0; i < 400000; ++i) {
      const Vector2d r(random.uniform(-0.11, 0.11), random.uniform(-0.11, 0.11));
      if (polygon.margin(zmp + r) < 0 || polygon.margin(zmp - r) < 0) continue;
      sum += r.norm();
      ++count;
    }
    EXPECT_NEAR(torsional_friction_arm(polygon, zmp), sum / count, 0.02 * sum / count);
  }
  EXPECT_EQ(torsional_friction_arm(polygon, {0.2, 0}), 0);
}

// Feet and motors together make the generalised force: J' w + S' tau = RNEA, base rows included.
TEST(Residuals, FootWrenchesAndMotorsBalance) {
  RobotDescription description = limited_biped_description();
  description.servos.clear();
  const RobotModel model(description);
  Random random(5);
  RobotData data(model);
  for (Support support : {Support::both, Support::left, Support::right}) {
    for (int i = 0; i < 20; ++i) {
      RobotState state = random_state(model, random);
      const VectorXd acceleration = random.vector(model.velocity_count(), 3);
      const auto soles = random_soles(random, false);
      const VectorXd force = inverse_dynamics(model, state, acceleration, data);
      const SupportPlane plane = support_plane(model, support, soles);
      const Vector6d wrench = force.head<6>();
      const GroundDemand use =
          ground_demand(plane, plane_wrench(plane, state.base.position, wrench), 1e-6);
      const auto feet =
          foot_wrenches(model, support, soles, plane, use, state.base.position, wrench);
      VectorXd total = VectorXd::Zero(model.velocity_count());
      total.tail(model.dof_count()) =
          motor_torques(model, model.limits(), state, acceleration, force, feet, data);
      for (Side side : {Side::left, Side::right})
        total +=
            body_jacobian(model, data, model.sole(side).body, state.base.position).transpose() *
            feet[static_cast<int>(side)];
      EXPECT_NEAR((total - force).norm(), 0, 1e-10 * force.norm());
    }
  }
}

// If the ZMP is inside the hull of two level feet, each foot's own centre of pressure is inside its
// sole.
TEST(Residuals, CentresOfPressureStayInTheSoles) {
  Random random(6);
  int tried = 0;
  for (int i = 0; i < 400; ++i) {
    auto soles = random_soles(random, true);
    const SupportPlane plane = support_plane(limited_biped(), Support::both, soles);
    const Vector2d zmp(random.uniform(-0.15, 0.15), random.uniform(-0.08, 0.08));
    if (plane.polygon.margin(zmp) < 0) continue;
    ++tried;
    const Vector3d base(0, 0, 0.3), f(3, -2, 60);
    const Vector3d z = plane.frame * Vector3d(zmp.x(), zmp.y(), 0);
    Vector6d wrench;
    wrench << f, (z - base).cross(f) + 0.2 * Vector3d::UnitZ();
    const GroundDemand use = ground_demand(plane, plane_wrench(plane, base, wrench), 1);
    const auto feet =
        foot_wrenches(limited_biped(), Support::both, soles, plane, use, base, wrench);
    EXPECT_NEAR((feet[0] + feet[1] - wrench).norm(), 0, 1e-11);
    for (Side side : {Side::left, Side::right}) {
      const Vector6d& w = feet[static_cast<int>(side)];
      EXPECT_GE(w[2], 0);
      if (w[2] < 1e-6) continue;
      const SupportPlane own = support_plane(
          limited_biped(), side == Side::left ? Support::left : Support::right, soles);
      const GroundDemand pressure = ground_demand(own, plane_wrench(own, base, w), 1e-9);
      EXPECT_GE(pressure.margin, -1e-9) << name_of(side) << " share " << w[2] / 60;
    }
  }
  EXPECT_GT(tried, 60);
}

TEST(Residuals, SoleErrorOfKnownDisplacements) {
  const Sole& sole = limited_biped().sole(Side::left);
  Eigen::Isometry3d planned = Eigen::Isometry3d::Identity(), actual = planned;
  actual.translation() = Vector3d(0.003, 0.004, 0.002);
  SoleError e = sole_error(sole, actual, planned);
  EXPECT_NEAR(e.slip, 0.005, 1e-15);
  EXPECT_NEAR(e.gap, 0.002, 1e-15);
  EXPECT_EQ(e.penetration, 0);
  actual.translation() = Vector3d(0, 0, -0.002);
  e = sole_error(sole, actual, planned);
  EXPECT_NEAR(e.penetration, 0.002, 1e-15);
  EXPECT_EQ(e.gap, 0);
  actual.setIdentity();
  actual.linear() = exp_rotation({0, 0.1, 0}).toRotationMatrix();  // the toes point down
  e = sole_error(sole, actual, planned);
  EXPECT_NEAR(e.penetration, 0.055 * std::sin(0.1), 1e-12);
  EXPECT_NEAR(e.gap, 0.045 * std::sin(0.1), 1e-12);
}

TEST(Residuals, ContactIntervalsStandAtTheirMiddle) {
  CommandSeries series;
  series.samples.resize(100);
  for (int k = 0; k < 100; ++k) {
    series.samples[k].support = k < 40 ? Support::both : k < 70 ? Support::left : Support::both;
    series.samples[k].feet[1].translation().x() = k;
  }
  const ContactPlan plan = contact_plan(series);
  ASSERT_EQ(plan.intervals[0].size(), 1u);
  ASSERT_EQ(plan.intervals[1].size(), 3u);
  EXPECT_EQ(plan.intervals[1][1].first, 40);
  EXPECT_EQ(plan.intervals[1][1].last, 69);
  EXPECT_FALSE(plan.intervals[1][1].contact);
  EXPECT_EQ(plan.at(Side::right, 99).sole.translation().x(), (70 + 99) / 2);
  EXPECT_EQ(plan.support(50), Support::left);
}
