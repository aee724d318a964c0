#include "ayumi/dynamics/reach.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "tests/support/limited_biped.hpp"
#include "tests/support/random_robot.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::Vector3d;

namespace {

int body_of(const RobotModel& model, const std::string& joint) {
  return model.dofs()[static_cast<size_t>(model.find_dof(joint))].body;
}

Vector3d place_of(const RobotModel& model, const RobotState& state, int body,
                  const Vector3d& point) {
  RobotData data(model);
  update_positions(model, state, data);
  return data.pose(body) * point;
}

std::set<std::string> names(const RobotModel& model, const std::vector<int>& dofs) {
  std::set<std::string> result;
  for (const int dof : dofs) result.insert(model.dofs()[static_cast<size_t>(dof)].name);
  return result;
}

// The end of the left forearm.
const Vector3d kHand(0, 0, -0.08);

}  // namespace

// The place that a random posture of the arm reaches is searched from the home posture.
TEST(Reach, MeetsWhatTheArmCanReach) {
  const RobotModel& model = limited_biped();
  const int hand = body_of(model, "l_elbow");
  const std::vector<int> arm = limb_dofs(model, hand);
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    RobotState wanted = model.rest_state();
    wanted.base.position = random.vector(1);
    wanted.base.attitude = exp_rotation(random.vector(1));
    RobotState start = wanted;
    for (const int dof : arm) wanted.theta[dof] += random.uniform(-1.2, 1.2);
    const Vector3d place = place_of(model, wanted, hand, kHand);
    const ReachSolution found = reach(model, start, hand, kHand, place, arm);
    EXPECT_LT(found.missing, 1e-5) << trial;
    start.theta = found.theta;
    EXPECT_NEAR((place_of(model, start, hand, kHand) - place).norm(), found.missing, 1e-12);
    for (int dof = 0; dof < model.dof_count(); ++dof)
      if (std::find(arm.begin(), arm.end(), dof) == arm.end()) {
        EXPECT_EQ(found.theta[dof], wanted.theta[dof]);
      }
  }
}

// The place is beyond the length of a stretched leg: what is missing is its distance minus that
// length.
TEST(Reach, SaysWhatIsMissing) {
  const RobotModel& model = limited_biped();
  const int foot = body_of(model, "l_ankle_roll");
  const RobotState state = model.rest_state();
  const std::vector<int> dofs = {model.find_dof("l_hip_pitch"), model.find_dof("l_knee")};
  const Vector3d hip = place_of(model, state, body_of(model, "l_hip_pitch"), Vector3d::Zero());
  const Vector3d ankle = place_of(model, state, body_of(model, "l_ankle_pitch"), Vector3d::Zero());
  const Vector3d way = (ankle - hip).normalized();
  const ReachSolution found = reach(model, state, foot, Vector3d::Zero(), hip + 0.3 * way, dofs);
  EXPECT_NEAR(found.missing, 0.1, 1e-4);  // thigh and shank are 0.1 m long each
}

// Wherever the place is, no joint leaves its range, and the point never ends farther away than it
// began.
TEST(Reach, StaysWithinLimits) {
  const RobotModel& model = limited_biped();
  const int hand = body_of(model, "r_elbow");
  Random random(4);
  for (int trial = 0; trial < 30; ++trial) {
    const RobotState state = model.rest_state();
    const Vector3d place = random.vector(0.6);
    const ReachSolution found = reach(model, state, hand, kHand, place, limb_dofs(model, hand));
    EXPECT_LE(found.missing, (place - place_of(model, state, hand, kHand)).norm());
    for (size_t i = 0; i < model.dofs().size(); ++i) {
      EXPECT_GE(found.theta[static_cast<Eigen::Index>(i)], model.dofs()[i].lower);
      EXPECT_LE(found.theta[static_cast<Eigen::Index>(i)], model.dofs()[i].upper);
    }
  }
}

TEST(Reach, KeepsRoom) {
  const RobotModel& model = limited_biped();
  const int hand = body_of(model, "l_elbow");
  const std::vector<int> arm = limb_dofs(model, hand);
  Random random(5);
  for (int trial = 0; trial < 30; ++trial) {
    const ReachSolution found =
        reach(model, model.rest_state(), hand, kHand, random.vector(0.6), arm, 0.1);
    for (const int dof : arm) {
      const Dof& joint = model.dofs()[static_cast<size_t>(dof)];
      EXPECT_GE(found.theta[dof], joint.lower + 0.1);
      EXPECT_LE(found.theta[dof], joint.upper - 0.1);
    }
  }
}

TEST(Reach, LimbsEndWhereTheyMeet) {
  const RobotModel& model = limited_biped();
  EXPECT_EQ(names(model, limb_dofs(model, body_of(model, "l_elbow"))),
            (std::set<std::string>{"l_shoulder_pitch", "l_elbow"}));
  EXPECT_EQ(names(model, limb_dofs(model, body_of(model, "r_ankle_roll"))),
            (std::set<std::string>{"r_hip_yaw", "r_hip_roll", "r_hip_pitch", "r_knee",
                                   "r_ankle_pitch", "r_ankle_roll"}));
  // A body inside a limb is moved by the joints above it.
  EXPECT_EQ(names(model, limb_dofs(model, body_of(model, "r_hip_pitch"))),
            (std::set<std::string>{"r_hip_yaw", "r_hip_roll", "r_hip_pitch"}));
}

// Fingers are parts of a hand: the arm moves them, and the body that carries them is the end of the
// limb.
TEST(Reach, HandsWithFingersAreEnds) {
  RobotDescription d = limited_biped_description();
  for (const std::string side : {"l_", "r_"})
    for (int i = 0; i < 4; ++i) {
      const std::string finger = side + "finger" + std::to_string(i);
      d.links.push_back(solid_box(finger, 0.01, {0.01, 0.01, 0.03}, {0, 0, -0.015}, false));
      d.joints.push_back(limited_hinge(finger, side + "forearm", finger, {0.01 * i, 0, -0.04},
                                       Vector3d::UnitY(), -1, 1));
    }
  const RobotModel model(d);
  std::set<std::string> ends;
  for (const int body : limb_ends(model))
    ends.insert(model.bodies()[static_cast<size_t>(body)].name);
  EXPECT_EQ(ends, (std::set<std::string>{"l_foot", "r_foot", "l_forearm", "r_forearm"}));
  EXPECT_EQ(names(model, limb_dofs(model, body_of(model, "l_elbow"))),
            (std::set<std::string>{"l_shoulder_pitch", "l_elbow"}));
}
