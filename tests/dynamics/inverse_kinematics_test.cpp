#include "ayumi/dynamics/inverse_kinematics.hpp"

#include <gtest/gtest.h>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "tests/support/biped.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/random_robot.hpp"
#include "tests/support/urdf_biped.hpp"

namespace ayumi {
namespace {

constexpr std::array<Side, 2> kSides = {Side::left, Side::right};

// The pose that a random posture near home reaches is searched from the home posture.
void expect_round_trip(const RobotModel& model, unsigned seed) {
  test::Random random(seed);
  const InverseKinematics ik(model, model.posture());
  RobotData data(model);
  for (int trial = 0; trial < 50; ++trial) {
    RobotState wanted = model.rest_state();
    wanted.base.position = random.vector(2.0);
    wanted.base.attitude = exp_rotation(random.vector(1.0));
    wanted.theta += random.vector(model.dof_count(), 0.25);
    update_positions(model, wanted, data);
    PostureTarget target;
    for (const Side side : kSides)
      target.feet[static_cast<int>(side)] = sole_pose(model, data, side);
    target.cog = data.cog;
    target.trunk = data.rotation[model.trunk_body()];

    RobotState state = wanted;  // joints that are not solved keep their values
    for (const Side side : kSides)
      for (const int dof : ik.leg(side)) state.theta[dof] = model.posture()[dof];
    state.base = BasePose{};
    RobotState near = wanted;  // a second guess
    near.theta.array() += 0.02;
    for (int dof = 0; dof < model.dof_count(); ++dof)
      if (!ik.solves(dof)) near.theta[dof] = wanted.theta[dof];
    ASSERT_TRUE(ik.solve(target, near, data).reached) << "trial " << trial;
    EXPECT_LT((near.theta - wanted.theta).norm(), 1e-8);
    const PostureSolution solution = ik.solve(target, state, data);
    ASSERT_TRUE(solution.reached) << "trial " << trial << " error " << solution.error;
    EXPECT_FALSE(solution.knee_flipped);
    update_positions(model, state, data);
    for (const Side side : kSides)
      EXPECT_LT(
          (sole_pose(model, data, side).matrix() - target.feet[static_cast<int>(side)].matrix())
              .cwiseAbs()
              .maxCoeff(),
          1e-10);
    EXPECT_LT((data.cog - target.cog).norm(), 1e-10);
    EXPECT_LT((data.rotation[model.trunk_body()] - target.trunk).norm(), 1e-10);
    EXPECT_LT((state.theta - wanted.theta).norm(), 1e-8);  // the solution is on the same branch
  }
}

TEST(InverseKinematics, MeetsRandomTargets) { expect_round_trip(test::biped(), 1); }

// A knee of two joints, of which the second mimics the first, is one joint of the leg.
TEST(InverseKinematics, MeetsRandomTargetsWithMimicJointsInTheLegs) {
  const RobotModel model = test::standing_model({.tandem_knee = true});
  EXPECT_EQ(model.leg(Side::left).size(), 6u);
  expect_round_trip(model, 2);
}

// An inclined yaw axis of the hip, as NAO has, is no second hip pitch, so the knee is found.
TEST(InverseKinematics, FindsTheKneesBelowInclinedHips) {
  const RobotModel model = test::standing_model({.hips = "irp"});
  const InverseKinematics ik(model, Eigen::VectorXd::Zero(model.dof_count()));
  EXPECT_EQ(model.dofs()[ik.knee(Side::left)].name, "l_knee");
  EXPECT_EQ(model.dofs()[ik.knee(Side::right)].name, "r_knee");
  expect_round_trip(model, 4);
}

// A leg of seven joints has infinitely many postures for one place of its foot. So one joint keeps
// its angle, and two guesses lead to one solution.
TEST(InverseKinematics, MeetsRandomTargetsWithLegsOfSevenJoints) {
  const RobotModel model = test::standing_model({.hips = "yrpt"});
  EXPECT_EQ(model.leg(Side::left).size(), 7u);
  const InverseKinematics ik(model, model.posture());
  for (const Side side : kSides) {
    EXPECT_EQ(ik.leg(side).size(), 6u);
    EXPECT_FALSE(ik.solves(model.find_dof(side == Side::left ? "l_thigh_turn" : "r_thigh_turn")));
  }
  EXPECT_FALSE(ik.lacks_joints());
  expect_round_trip(model, 3);
}

// A leg may be straight where the angle of its knee is not 0.
TEST(InverseKinematics, TheJointsOfStraightLongLegsDoNotDependOnTheZeroOfTheKnee) {
  RobotDescription robot = test::standing_model({.hips = "yrpt"}).description();
  for (const char* const side : {"l_", "r_"})
    for (const char* const joint : {"hip_pitch", "knee", "ankle_pitch"})
      robot.postures["home"][std::string(side) + joint] = 0;
  const RobotModel plain(robot);
  constexpr double kOffset = 0.5;
  for (JointDescription& joint : robot.joints)
    if (joint.name.ends_with("knee")) {
      joint.origin.linear() = rpy_to_matrix({0, -kOffset, 0}) * joint.origin.linear();
      robot.postures["home"][joint.name] = kOffset;
    }
  const RobotModel shifted(robot);
  const InverseKinematics at_zero(plain, plain.posture()), elsewhere(shifted, shifted.posture());
  for (const Side side : kSides) {
    EXPECT_EQ(at_zero.leg(side), elsewhere.leg(side));
    EXPECT_FALSE(
        elsewhere.solves(shifted.find_dof(side == Side::left ? "l_thigh_turn" : "r_thigh_turn")));
  }
}

// Hip and ankle turn back by the whole bend of a knee, also if the knee has two joints.
TEST(InverseKinematics, BentLegsKeepTheirSolesLevel) {
  for (const bool tandem : {false, true}) {
    const RobotModel model = test::standing_model({.tandem_knee = tandem});
    const InverseKinematics ik(model, Eigen::VectorXd::Zero(model.dof_count()));
    RobotState state = model.rest_state();
    state.theta = ik.start();
    RobotData data(model);
    update_positions(model, state, data);
    EXPECT_GT(std::abs(state.theta[model.find_dof("l_knee")]), 0.1);
    for (const Side side : kSides)
      EXPECT_LT(
          (sole_pose(model, data, side).linear() - state.base.attitude.toRotationMatrix()).norm(),
          1e-12)
          << tandem;
  }
}

// The determinant of the Jacobian of a leg of six joints.
double leg_determinant(const RobotModel& model, const InverseKinematics& ik, const RobotData& data,
                       Side side) {
  const Eigen::MatrixXd all =
      body_jacobian(model, data, model.sole(side).body, sole_pose(model, data, side).translation());
  Eigen::MatrixXd A(6, 6);
  for (int i = 0; i < 6; ++i) A.col(i) = all.col(6 + ik.leg(side)[static_cast<size_t>(i)]);
  return test::determinant(A);
}

// The guesses have any distance, and the legs are on either side of the straight knee: the target
// is met to rounding, and a leg counts as flipped exactly if the determinant of its Jacobian has
// changed sign.
TEST(InverseKinematics, NearGuessesEndAtTheTargetAndOnItsSide) {
  for (const RobotModel& model : {test::biped(), test::biped({.waist = true})}) {
    test::Random random(5);
    const InverseKinematics ik(model, model.posture());
    RobotData data(model);
    RobotState home = model.rest_state();
    home.theta = ik.start();
    update_positions(model, home, data);
    const double reference[2] = {leg_determinant(model, ik, data, Side::left),
                                 leg_determinant(model, ik, data, Side::right)};
    int flipped = 0, kept = 0;
    for (int trial = 0; trial < 400; ++trial) {
      RobotState wanted = home;
      wanted.base.position = random.vector(2.0);
      wanted.base.attitude = exp_rotation(random.vector(1.0));
      wanted.theta += random.vector(model.dof_count(), 0.3);
      if (trial % 2 > 0) {
        const int knee = ik.knee(Side::left);
        wanted.theta[knee] = random.uniform(-0.3, 0.3);
      }
      update_positions(model, wanted, data);
      PostureTarget target;
      for (const Side side : kSides)
        target.feet[static_cast<int>(side)] = sole_pose(model, data, side);
      target.cog = data.cog;
      target.trunk = data.rotation[model.trunk_body()];

      RobotState state = wanted;
      const double away = std::pow(10.0, random.uniform(-13, -3));
      state.base.position += random.vector(away);
      for (const Side side : kSides)
        for (const int dof : ik.leg(side)) state.theta[dof] += random.uniform(-away, away);
      const PostureSolution solution = ik.solve(target, state, data);
      if (!solution.reached) continue;  // the leg is nearly straight
      update_positions(model, state, data);
      bool changed = false;
      for (const Side side : kSides) {
        const int s = static_cast<int>(side);
        EXPECT_LT((sole_pose(model, data, side).translation() - target.feet[s].translation())
                      .cwiseAbs()
                      .maxCoeff(),
                  2e-13);
        changed = changed || leg_determinant(model, ik, data, side) * reference[s] <= 0;
      }
      EXPECT_LT((data.cog - target.cog).cwiseAbs().maxCoeff(), 2e-13);
      EXPECT_EQ(solution.knee_flipped, changed) << trial;
      ++(changed ? flipped : kept);
    }
    EXPECT_GT(flipped, 20);
    EXPECT_GT(kept, 200);
  }
}

TEST(InverseKinematics, TrunkAboveAWaistJoint) {
  expect_round_trip(test::biped({.waist = true}), 2);
}

// Targets of legs with a seventh joint are reached as well, with six of the joints.
TEST(InverseKinematics, SevenJointLegs) {
  RobotDescription robot = test::biped_description();
  for (const std::string s : {"l_", "r_"}) {
    for (JointDescription& joint : robot.joints)
      if (joint.name == s + "hip_pitch") joint.child = s + "hip3";
    robot.links.push_back(test::box_link(s + "hip3", 0.05, {0, 0, 0}, {0.02, 0.02, 0.02}));
    robot.joints.push_back(
        test::hinge(s + "thigh_twist", s + "hip3", s + "thigh", {0, 0, 0}, {0, 0, 1}, -1, 1));
  }
  const RobotModel model(robot);
  const InverseKinematics ik(model, model.posture());
  EXPECT_EQ(model.leg(Side::left).size(), 7u);
  EXPECT_EQ(ik.leg(Side::left).size(), 6u);
  RobotData data(model);
  RobotState state = model.rest_state();
  update_positions(model, state, data);
  PostureTarget target;
  for (const Side side : kSides) target.feet[static_cast<int>(side)] = sole_pose(model, data, side);
  target.cog = data.cog + Eigen::Vector3d(0.01, 0.02, -0.01);
  target.feet[0].translation() += Eigen::Vector3d(0.03, 0.01, 0.02);
  target.trunk = rpy_to_matrix({0, 0, 0.1});
  const PostureSolution solution = ik.solve(target, state, data);
  EXPECT_TRUE(solution.reached);
  EXPECT_LT(solution.error, 1e-10);
}

// Without the ankle's roll, and with feet that stand still, the COG only moves to the side if the
// trunk leans; soles stay within the stated tolerance.
TEST(InverseKinematics, FiveJointLegsLean) {
  RobotDescription robot = test::biped_description();
  for (JointDescription& joint : robot.joints)
    if (joint.name.ends_with("ankle_roll")) joint.type = JointType::fixed;
  const RobotModel model(robot);
  const InverseKinematics ik(model, model.posture());
  EXPECT_TRUE(ik.lacks_joints());
  RobotData data(model);
  RobotState state = model.rest_state();
  update_positions(model, state, data);
  PostureTarget target;
  for (const Side side : kSides) target.feet[static_cast<int>(side)] = sole_pose(model, data, side);
  for (const double aside : {0.0, 0.004, -0.004}) {
    target.cog = data.cog;
    target.cog.y() += aside;
    RobotState solved = state;
    RobotData there(model);
    const PostureSolution solution = ik.solve(target, solved, there);
    EXPECT_TRUE(solution.reached) << aside;
    update_positions(model, solved, there);
    EXPECT_LT((there.cog - target.cog).norm(), 1e-6);
    EXPECT_LE(solution.missing, kLackingTolerance);
    if (aside == 0)
      EXPECT_LT(solution.lean, 1e-6);
    else
      EXPECT_GT(solution.lean, 0.01);
  }
}

// A sole that swings carries nothing, so that it yields, and the sole that carries keeps its place.
TEST(InverseKinematics, FiveJointLegsLetTheSwingingFootYield) {
  RobotDescription robot = test::biped_description();
  for (JointDescription& joint : robot.joints)
    if (joint.name.ends_with("ankle_roll")) joint.type = JointType::fixed;
  const RobotModel model(robot);
  const InverseKinematics ik(model, model.posture());
  RobotData data(model);
  RobotState state = model.rest_state();
  update_positions(model, state, data);
  PostureTarget target;
  for (const Side side : kSides) target.feet[static_cast<int>(side)] = sole_pose(model, data, side);
  target.feet[1].translation().z() += 0.02;
  double before = 1;  // distance of the left sole from its place
  for (const double hold : {1.0, 0.25, 0.0}) {
    target.cog = data.cog + Eigen::Vector3d(0, 0.024, 0);
    target.hold = {1, hold};
    RobotState solved = state;
    RobotData there(model);
    const PostureSolution solution = ik.solve(target, solved, there);
    // If both soles are held with the same weight, each misses its place by more than is allowed
    // for a sole that carries.
    EXPECT_EQ(solution.reached, hold < 1)
        << hold << " " << solution.miss[0] << " " << solution.miss[1];
    EXPECT_LT(solution.miss[0], before) << hold;
    EXPECT_LE(solution.miss[1], kSwingingTolerance) << hold;
    before = solution.miss[0];
    EXPECT_LT((there.cog - target.cog).norm(), 1e-5);
  }
  EXPECT_LT(before, 1e-4);
}

// Both knees come forward, whatever the signs of their axes, if the limits do not decide.
TEST(InverseKinematics, StraightKneesComeForwardByGeometry) {
  RobotDescription robot = test::biped_description();
  for (JointDescription& joint : robot.joints) {
    joint.lower = -2.8;
    joint.upper = 2.8;
    if (joint.name.starts_with("r_")) joint.axis = -joint.axis;
  }
  robot.postures["home"] = {};
  const RobotModel model(robot);
  const InverseKinematics ik(model, model.posture());
  EXPECT_GT(ik.start()[model.find_dof("l_knee")], 0.1);
  EXPECT_LT(ik.start()[model.find_dof("r_knee")], -0.1);
  EXPECT_TRUE(ik.positive_bends_forward(Side::left));
  EXPECT_FALSE(ik.positive_bends_forward(Side::right));
}

// A knee that has room to one side only bends to that side.
TEST(InverseKinematics, LimitsTellTheKneeOfABird) {
  RobotDescription robot = test::biped_description();
  for (JointDescription& joint : robot.joints)
    if (joint.name.ends_with("knee")) {
      joint.lower = -2.2;
      joint.upper = 0.05;
    }
  robot.postures["home"] = {};
  robot.postures["squat"] = {};
  const RobotModel model(robot);
  EXPECT_LT(InverseKinematics(model, model.posture()).start()[model.find_dof("l_knee")], -0.1);
}

// If hips or ankles leave the knees little room to bend forward, and more to bend backward, the
// knees bend backward. Open Duck Mini is built in this way.
TEST(InverseKinematics, HipsTellTheKneeOfABird) {
  for (const std::string limited : {"hip_pitch", "ankle_pitch"}) {
    RobotDescription robot = test::biped_description();
    for (JointDescription& joint : robot.joints) {
      if (joint.name.ends_with("knee")) joint.lower = -(joint.upper = 1.57);
      if (joint.name.ends_with(limited)) {
        joint.lower =
            -0.5;  // less than half of a crouch, on the side of the knee that comes forward
        joint.upper = 1.2;
      }
    }
    robot.postures["home"] = {};
    robot.postures["squat"] = {};
    const RobotModel model(robot);
    const int knee = model.find_dof("l_knee");
    EXPECT_LT(InverseKinematics(model, model.posture()).start()[knee], -0.1) << limited;
    // With room on both sides, it comes forward.
    for (JointDescription& joint : robot.joints)
      if (joint.name.ends_with(limited)) joint.lower = -0.7;
    const RobotModel free(robot);
    EXPECT_GT(InverseKinematics(free, free.posture()).start()[knee], 0.1) << limited;
  }
}

// Redundant legs stay inside the position limits on their way to the target.
TEST(InverseKinematics, SevenJointLegsRespectLimits) {
  RobotDescription robot = test::biped_description();
  for (const std::string s : {"l_", "r_"}) {
    for (JointDescription& joint : robot.joints)
      if (joint.name == s + "hip_pitch") joint.child = s + "hip3";
    robot.links.push_back(test::box_link(s + "hip3", 0.05, {0, 0, 0}, {0.02, 0.02, 0.02}));
    robot.joints.push_back(
        test::hinge(s + "thigh_twist", s + "hip3", s + "thigh", {0, 0, 0}, {0, 0, 1}, -0.01, 0.01));
  }
  const RobotModel model(robot);
  const InverseKinematics ik(model, model.posture());
  RobotData data(model);
  RobotState state = model.rest_state();
  update_positions(model, state, data);
  PostureTarget target;
  for (const Side side : kSides) target.feet[static_cast<int>(side)] = sole_pose(model, data, side);
  target.cog = data.cog;
  target.feet[0].linear() = rpy_to_matrix({0, 0, 0.3});
  const PostureSolution solution = ik.solve(target, state, data);
  EXPECT_TRUE(solution.reached);
  for (const std::string s : {"l_", "r_"})
    EXPECT_LE(std::abs(state.theta[model.find_dof(s + "thigh_twist")]), 0.01);
}

TEST(InverseKinematics, SolvesLegsOnly) {
  const RobotModel model = test::biped({.waist = true});
  const InverseKinematics ik(model, model.posture());
  EXPECT_FALSE(ik.solves(model.find_dof("waist")));
  EXPECT_FALSE(ik.solves(model.find_dof("l_shoulder")));
  EXPECT_TRUE(ik.solves(model.find_dof("l_knee")));
  EXPECT_EQ(ik.leg(Side::right).size(), 6u);
}

TEST(InverseKinematics, TellsWhichFootIsHowFarAway) {
  const RobotModel model = test::biped();
  const InverseKinematics ik(model, model.posture());
  RobotData data(model);
  RobotState state = model.rest_state();
  update_positions(model, state, data);
  PostureTarget target;
  for (const Side side : kSides) target.feet[static_cast<int>(side)] = sole_pose(model, data, side);
  target.cog = data.cog;
  target.feet[1].translation().z() -= 0.3;
  const PostureSolution solution = ik.solve(target, state, data);
  EXPECT_FALSE(solution.reached);
  EXPECT_EQ(solution.foot, Side::right);
  EXPECT_GT(solution.missing, 0.15);
  EXPECT_LT(solution.missing, 0.3);
}

TEST(InverseKinematics, StraightReferenceBendsTheKneesForward) {
  const RobotModel model = test::biped();
  const InverseKinematics ik(model, model.posture("zero"));
  RobotData data(model);
  RobotState state = model.rest_state("home");
  update_positions(model, state, data);
  PostureTarget target;
  for (const Side side : kSides) target.feet[static_cast<int>(side)] = sole_pose(model, data, side);
  target.cog = data.cog;
  RobotState from = model.rest_state("zero");
  from.theta = ik.start();
  ASSERT_TRUE(ik.solve(target, from, data).reached);
  EXPECT_LT((from.theta - state.theta).norm(), 1e-9);
}

}  // namespace
}  // namespace ayumi
