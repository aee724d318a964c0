// Every number that a plant is given may be not a number, infinite or absurd. Each such number is
// refused by name, with the time, and the plant stays as it was.

#include "ayumi/sim/step_check.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "ayumi/base/error.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "tests/support/biped.hpp"
#include "tests/support/block.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

const double kBad[] = {std::numeric_limits<double>::quiet_NaN(),
                       -std::numeric_limits<double>::infinity(), 1e9};

TEST(StepCheck, RefusesWhatIsNoNumberWithPlaceAndTime) {
  RobotDescription d = test::random_tree(3, 6, false);
  for (const JointDescription& joint : d.joints)
    if (joint.type != JointType::fixed) d.servos[joint.name] = {50.0, 1.0, 0.003, 0.0, 0.0};
  const RobotModel model(d);
  Plant plant(model, model.limits(), World{});
  RobotState start = model.rest_state();
  start.base.position.z() = 2;
  plant.set_state(start);
  const VectorXd targets = VectorXd::Zero(model.dof_count());
  for (int i = 0; i < 30; ++i) plant.step(targets, {}, 1e-3);
  const RobotState before = plant.state();
  const auto n = static_cast<size_t>(model.dof_count());
  for (const double bad : kBad) {
    const auto expect = [&](const std::string& place,
                            const std::function<void(StepInput&)>& spoil) {
      StepInput input;
      input.joints.resize(n);
      input.floor.emplace();
      spoil(input);
      const std::string text = test::error_message([&] { plant.step(targets, input, 1e-3); });
      EXPECT_NE(text.find(place), std::string::npos) << text;
      EXPECT_NE(text.find("0.030 s after"), std::string::npos) << text;
    };
    const ExternalWrench push;
    expect("external force", [&](StepInput& in) {
      in.wrenches = {push};
      in.wrenches[0].torque.y() = bad;
    });
    expect("external force", [&](StepInput& in) {
      in.wrenches = {push};
      in.wrenches[0].body = 1000;
    });
    expect("fault of joint " + model.dofs()[2].name,
           [&](StepInput& in) { in.joints[2].encoder = bad; });
    expect("fault of joint", [&](StepInput& in) { in.joints[0].gain = bad; });
    expect("fault of joint", [&](StepInput& in) { in.joints[1].coulomb = -1; });
    expect("payload", [&](StepInput& in) { in.payloads = {{0, Vector3d(0, 0, bad), 1.0}}; });
    expect("payload", [&](StepInput& in) { in.payloads = {{0, Vector3d::Zero(), bad}}; });
    expect("floor's motion", [&](StepInput& in) { in.floor->velocity.x() = bad; });
    expect("floor's motion", [&](StepInput& in) { in.floor->pose.translation().z() = bad; });
    expect("floor's friction", [&](StepInput& in) { in.friction = bad; });
    expect("bump", [&](StepInput& in) {
      in.bumps.resize(1);
      in.bumps[0].block.height = bad;
    });
    RobotState s = start;
    s.dtheta[1] = bad;
    EXPECT_NE(test::error_message([&] { plant.set_state(s); }).find("a joint rate"),
              std::string::npos);
  }
  RobotState s = start;
  s.base.attitude.coeffs() *= 0.5;
  EXPECT_NE(test::error_message([&] { plant.set_state(s); }).find("unit quaternion"),
            std::string::npos);
  EXPECT_EQ(plant.state().base.position, before.base.position);
  EXPECT_EQ(plant.state().theta, before.theta);
  plant.step(targets, {}, 1e-3);
}

TEST(StepCheck, RefusesAWorldThatIsNone) {
  const RobotModel model(test::block_description({0.1, 0.1, 0.1}, 1.0));
  const auto expect = [&](const std::string& place, const World& world) {
    const std::string text = test::error_message([&] { Plant(model, model.limits(), world); });
    EXPECT_NE(text.find(place), std::string::npos) << text;
  };
  for (const double bad : kBad) {
    expect("friction", World{.friction = bad});
    expect("slope", World{.slope = {bad, 0}});
    expect("slope or height", World{.height = bad});
    GroundBlock block;
    block.high.x() = bad;
    expect("block 1", World{.blocks = {GroundBlock{}, block}});
    FrictionPatch patch;
    patch.friction = bad;
    expect("patch 0", World{.patches = {patch}});
    HeightField field;
    field.heights = Eigen::MatrixXd::Constant(3, 3, bad);
    expect("field", World{.fields = {field}});
  }
  expect("friction", World{.friction = -0.1});
}

TEST(StepCheck, RefusesAReportThatIsNone) {
  const RobotModel model = test::biped();
  for (const double bad : kBad) {
    const auto expect = [&](const std::string& place,
                            const std::function<void(StepReport&)>& spoil) {
      StepReport report;
      report.torque = VectorXd::Zero(model.dof_count());
      for (const Side side : {Side::left, Side::right})
        report.soles[static_cast<size_t>(side)].resize(model.sole(side).polygon.size());
      check_report(model, report);
      spoil(report);
      const std::string text =
          test::error_message([&] { check_report(model, report); }, ErrorCode::usage);
      EXPECT_NE(text.find(place), std::string::npos) << text;
    };
    expect("a torque of", [&](StepReport& r) { r.torque[0] = bad; });
    expect("a force at a sole of", [&](StepReport& r) { r.soles[0][0].force.z() = bad; });
    expect("a place of a sole at", [&](StepReport& r) { r.soles[0][0].position.x() = bad; });
    expect("a gap of a sole of", [&](StepReport& r) { r.soles[0][0].gap = bad; });
  }
}

}  // namespace
}  // namespace ayumi
