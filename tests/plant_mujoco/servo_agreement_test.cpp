// Every form of a servo in both plants, with the same joint under the same load.

#include <gtest/gtest.h>

#include "ayumi/sim/plant/plant.hpp"
#include "ayumi/sim/plant_mujoco/mujoco_plant.hpp"
#include "ayumi/sim/servo.hpp"
#include "tests/support/one_joint.hpp"

namespace ayumi {
namespace {

class ServoAgreement : public testing::TestWithParam<test::OneJoint> {};

TEST_P(ServoAgreement, OfBothPlants) {
  const test::OneJoint& joint = GetParam();
  const RobotModel model = test::model_of(joint);
  Plant ours(model, model.limits(), World{});
  MujocoPlant theirs(model, model.limits(), World{}, 8);
  const test::JointTrace a = test::simulate(joint, model, ours, 8),
                         b = test::simulate(joint, model, theirs, 1);
  const double joints = test::largest_difference(a.theta, b.theta),
               motors = test::largest_difference(a.motor, b.motor);
  std::cout << joint.name << ": joints " << joints << " rad, motors " << motors << " rad\n";
  EXPECT_LT(joints, joint.mujoco);
  EXPECT_LT(motors, joint.mujoco);
}

INSTANTIATE_TEST_SUITE_P(Forms, ServoAgreement, testing::ValuesIn(test::servo_forms()),
                         [](const auto& form) { return form.param.name; });

}  // namespace
}  // namespace ayumi
