#include "ayumi/model/foot_bodies.hpp"

#include <gtest/gtest.h>

#include "ayumi/sim/plant/contact_points.hpp"
#include "tests/support/urdf_biped.hpp"

namespace ayumi {
namespace {

// A toe stands on the ground like the foot that carries it. It is a part of the foot, so the robot
// has not fallen when it touches the ground.
TEST(FootBodies, ToesBelongToTheirFeet) {
  const RobotModel model = test::standing_model({.toes = true});
  for (const char* const link : {"l_foot", "l_toe", "r_foot", "r_toe"})
    EXPECT_TRUE(is_of_foot(model, model.links()[model.find_link(link)].body)) << link;
  for (const char* const link : {"trunk", "l_ankle", "r_shank", "l_arm"})
    EXPECT_FALSE(is_of_foot(model, model.links()[model.find_link(link)].body)) << link;
  for (const ContactPoint& point : contact_points(model))
    EXPECT_TRUE(point.side >= 0 || !is_of_foot(model, point.body));
}

}  // namespace
}  // namespace ayumi
