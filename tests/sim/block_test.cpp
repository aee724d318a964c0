// Closed forms of the plant: impacts of a rocking block, landing, an ankle's torque at rest, and
// energy in flight. It is also tested what the plant refuses.

#include "tests/support/block.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/mechanical_energy.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::error_message;

constexpr double kHigh = 5.0;  // friction that holds every edge

// The share of the energy that is left after each impact of a block that rocks about its edges. The
// energy, relative to the block at rest, is computed at the turning points.
std::vector<double> rocking_ratios(const Vector3d& size, double lean, int impacts, double h) {
  const double alpha = std::atan2(size.x(), size.z());
  const double radius = 0.5 * std::hypot(size.x(), size.z());
  const RobotModel model(test::block_description(size, 2.0));
  Plant plant(model, model.limits(), World{kHigh});
  RobotState s = model.rest_state();
  const double tilt = lean * alpha;  // lean about the edge at +x
  s.base.attitude = exp_rotation({0, tilt, 0});
  s.base.position = Vector3d(0.5 * size.x(), 0, 0) +
                    s.base.attitude * Vector3d(-0.5 * size.x(), 0, 0.5 * size.z());
  plant.set_state(s);
  std::vector<double> peaks, ratios;
  double sign = 1, highest = tilt;
  for (int i = 0; i < 8.0 / h && static_cast<int>(peaks.size()) <= impacts; ++i) {
    plant.step(VectorXd(0), {}, h);
    const double angle = matrix_to_rpy(plant.state().base.attitude.toRotationMatrix()).y();
    if (angle * sign < 0) {
      peaks.push_back(radius * std::cos(alpha - highest) - 0.5 * size.z());
      sign = -sign;
      highest = 0;
    }
    highest = std::max(highest, std::abs(angle));
  }
  for (size_t i = 1; i < peaks.size(); ++i) ratios.push_back(peaks[i] / peaks[i - 1]);
  return ratios;
}

// Each impact multiplies the rate by 1 - 1.5 sin^2(a), where a is the angle between a side and a
// diagonal: the angular momentum about the new edge is kept. The blocks have the sizes of parts of
// a walking robot, slender and squat, at the default step. Energy must also be kept between impacts
// for the shares to be right.
TEST(RockingBlock, LosesEnergyAtEachImpactAsRigidBodiesDo) {
  struct Case {
    Vector3d size;
    double lean;
    int impacts;
  };
  for (const Case& c : {Case{{0.05, 0.1, 0.2}, 0.6, 5}, Case{{0.05, 0.1, 0.2}, 0.3, 5},
                        Case{{0.03, 0.1, 0.3}, 0.7, 5}, Case{{0.1, 0.1, 0.14}, 0.6, 3},
                        Case{{0.3, 0.2, 0.6}, 0.5, 5}, Case{{0.5, 0.1, 2.0}, 0.9, 5},
                        Case{{0.02, 0.02, 0.06}, 0.6, 5}, Case{{0.1, 0.1, 0.1}, 0.8, 2}}) {
    const double alpha = std::atan2(c.size.x(), c.size.z());
    const double rate = 1 - 1.5 * std::sin(alpha) * std::sin(alpha);
    const std::vector<double> ratios = rocking_ratios(c.size, c.lean, c.impacts, 1e-3);
    ASSERT_EQ(static_cast<int>(ratios.size()), c.impacts) << c.size.transpose();
    for (const double r : ratios)
      EXPECT_NEAR(std::sqrt(r), rate, 0.003) << c.size.transpose() << " from " << c.lean;
  }
}

TEST(RockingBlock, ErrorFallsWithTheStep) {
  const Vector3d size(0.1, 0.1, 0.2);
  const double alpha = std::atan2(size.x(), size.z());
  const double share = std::pow(1 - 1.5 * std::sin(alpha) * std::sin(alpha), 2);
  EXPECT_NEAR(rocking_ratios(size, 0.6, 1, 1e-3)[0], share, 2e-3);
  EXPECT_NEAR(rocking_ratios(size, 0.6, 1, 2.5e-4)[0], share, 5e-4);
}

// The step that meets the ground ends on it; after the next step the block rests, and it does not
// rebound.
TEST(Landing, StopsBouncingInOneStep) {
  const RobotModel model(test::block_description({0.2, 0.1, 0.04}, 2.0));
  for (const double h : {1e-3, 2.5e-4}) {
    Plant plant(model, model.limits(), World{0.5});
    RobotState s = model.rest_state();
    s.base.position.z() = 0.02 + 0.1;
    plant.set_state(s);
    double arrival = 0, after = 0, highest = -1;
    for (int i = 0; i < std::lround(0.5 / h); ++i) {
      const double before = plant.state().base_velocity.z();
      plant.step(VectorXd(0), {}, h);
      const double now = plant.state().base_velocity.z();
      if (arrival == 0 && now > before) {
        arrival = before;
        plant.step(VectorXd(0), {}, h);
        after = plant.state().base_velocity.z();
      } else if (arrival != 0) {
        highest = std::max(highest, now);
      }
    }
    EXPECT_NEAR(arrival, -std::sqrt(2 * kGravity * 0.1), 0.02);
    EXPECT_LT(std::abs(after), 0.01 * std::abs(arrival));
    EXPECT_LT(highest, 1e-3 * std::abs(arrival));
    EXPECT_LT(std::abs(plant.state().base_velocity.z()), 1e-12);
  }
}

/// A foot plate with a body on an ankle hinge about y; the body's centre of mass is `lever` ahead
/// of the hinge [m].
RobotDescription leaning_description(double mass, double lever) {
  RobotDescription d = test::block_description({0.3, 0.1, 0.02}, 1.0);
  LinkDescription body;
  body.name = "body";
  body.has_inertial = true;
  body.inertia.mass = mass;
  body.inertia.com = {lever, 0, 0.2};
  body.inertia.about_com = 0.01 * Eigen::Matrix3d::Identity();
  d.links.push_back(body);
  JointDescription ankle;
  ankle.name = "ankle";
  ankle.type = JointType::revolute;
  ankle.parent = "block";
  ankle.child = "body";
  ankle.origin.translation() = Vector3d(0, 0, 0.05);
  ankle.axis = Vector3d::UnitY();
  d.joints.push_back(ankle);
  d.servos["ankle"] = {800.0, 16.0, 0.003, 0.0, 0.0};
  return d;
}

TEST(Ankle, TorqueAtRestIsWeightTimesLever) {
  const double mass = 4.0;
  for (const double lever : {-0.03, 0.02, 0.06}) {
    const RobotModel model(leaning_description(mass, lever));
    Plant plant(model, model.limits(), World{});
    RobotState s = model.rest_state();
    s.base.position.z() = 0.01;
    plant.set_state(s);
    StepReport report;
    for (int i = 0; i < 3000; ++i) report = plant.step(VectorXd::Zero(1), {}, 1e-3);
    // This is the lever after the servo has given way.
    RobotData data(model);
    update_positions(model, plant.state(), data);
    const double now = data.com[1].x() - data.position[1].x();
    EXPECT_NEAR(report.torque[0], -mass * kGravity * now, 1e-6 * mass * kGravity * 0.1);
    EXPECT_NEAR(now, lever, 0.003);
  }
}

// Bodies tumble with loose joints: half the step gives half the error of the energy.
TEST(PassiveFlight, EnergyErrorFallsWithFirstOrder) {
  RobotDescription d = test::random_tree(3, 10, false);
  for (JointDescription& joint : d.joints) {
    joint.has_limits = false;
    if (joint.type == JointType::revolute) joint.type = JointType::continuous;
    if (joint.type == JointType::prismatic) joint.type = JointType::fixed;
    if (joint.type != JointType::fixed) d.servos[joint.name] = {1e-12, 0.0, 0.0, 0.0, 0.0};
  }
  const RobotModel model(d);
  test::Random random(5);
  RobotState start = test::random_state(model, random);
  start.base.position.z() = 100;
  std::vector<double> error;
  for (const double h : {1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
    Plant plant(model, model.limits(), World{});
    plant.set_state(start);
    const double before = test::mechanical_energy(model, start);
    for (int i = 0; i < std::lround(0.4 / h); ++i)
      plant.step(VectorXd::Zero(model.dof_count()), {}, h);
    error.push_back(std::abs(test::mechanical_energy(model, plant.state()) - before));
  }
  for (size_t i = 1; i < error.size(); ++i) {
    EXPECT_LT(error[i], error[i - 1] / 1.7);
    EXPECT_GT(error[i], error[i - 1] / 2.4);
  }
}

TEST(Plant, RefusesNumbersThatAreNoneWithPlaceAndTime) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const RobotModel model(leaning_description(4.0, 0.02));
  Plant plant(model, model.limits(), World{});
  RobotState s = model.rest_state();
  s.base.position.z() = 0.01;
  plant.set_state(s);
  VectorXd target = VectorXd::Zero(1);
  for (int i = 0; i < 20; ++i) plant.step(target, {}, 1e-3);
  for (const double bad : {nan, 1e9, -std::numeric_limits<double>::infinity()}) {
    target[0] = bad;
    const std::string text = error_message([&] { plant.step(target, {}, 1e-3); });
    EXPECT_NE(text.find("block: servo target of ankle"), std::string::npos) << text;
    EXPECT_NE(text.find("0.020 s"), std::string::npos) << text;
  }
  target[0] = 0;
  ExternalWrench push;
  push.force.y() = nan;
  EXPECT_NE(error_message([&] { plant.step(target, {push}, 1e-3); }).find("external force"),
            std::string::npos);
  EXPECT_NE(error_message([&] { plant.step(VectorXd::Zero(2), {}, 1e-3); }).find("2 servo targets"),
            std::string::npos);
  EXPECT_NE(error_message([&] { plant.step(target, {}, 0); }).find("step length"),
            std::string::npos);
  plant.step(target, {}, 1e-3);  // the plant can still be used
  s.base.position.x() = nan;
  EXPECT_NE(error_message([&] { plant.set_state(s); }).find("base position"), std::string::npos);
}

}  // namespace
}  // namespace ayumi
