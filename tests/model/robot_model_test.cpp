#include "ayumi/model/robot_model.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <random>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {
namespace {

LinkDescription heavy(const std::string& name, double mass = 1.0) {
  LinkDescription link;
  link.name = name;
  link.has_inertial = true;
  link.inertia = {mass, {0.01, 0.02, 0.03}, Eigen::Vector3d(0.01, 0.02, 0.025).asDiagonal()};
  return link;
}

JointDescription hinge(const std::string& name, const std::string& parent,
                       const std::string& child) {
  JointDescription joint;
  joint.name = name;
  joint.type = JointType::revolute;
  joint.parent = parent;
  joint.child = child;
  joint.origin =
      Eigen::Translation3d(0, 0, -0.1) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX());
  joint.axis = Eigen::Vector3d::UnitY();
  joint.has_limits = true;
  joint.lower = -1;
  joint.upper = 2;
  joint.velocity = 5;
  joint.effort = 7;
  return joint;
}

SoleDescription sole_on(const std::string& link) {
  SoleDescription sole;
  sole.link = link;
  sole.polygon = {{-0.04, -0.03}, {0.06, -0.03}, {0.06, 0.03}, {-0.04, 0.03}};
  return sole;
}

// A robot of trunk - l_hip - l_shank and trunk - r_hip - r_shank, with a cap fixed to the left
// shank.
RobotDescription biped() {
  RobotDescription robot;
  robot.name = "biped";
  robot.urdf_file = "biped.urdf";
  robot.sidecar_file = "robot.json";
  for (const char* name : {"cap", "l_thigh", "l_shank", "trunk", "r_thigh", "r_shank"})
    robot.links.push_back(heavy(name));
  robot.joints = {hinge("l_knee", "l_thigh", "l_shank"), hinge("l_hip", "trunk", "l_thigh"),
                  hinge("r_hip", "trunk", "r_thigh"), hinge("r_knee", "r_thigh", "r_shank"),
                  hinge("l_cap", "l_shank", "cap")};
  robot.joints.back().type = JointType::fixed;
  robot.soles = {{"left", sole_on("cap")}, {"right", sole_on("r_shank")}};
  return robot;
}

std::string error_of(const std::function<void(RobotDescription&)>& spoil) {
  RobotDescription robot = biped();
  spoil(robot);
  try {
    const RobotModel model(robot);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_model);
    return error.what();
  }
  return "no error";
}

TEST(RobotModel, SortsBodiesParentsFirstAndMergesFixedLinks) {
  const RobotModel model(biped());
  ASSERT_EQ(model.bodies().size(), 5u);
  EXPECT_EQ(model.bodies()[0].name, "trunk");
  for (size_t i = 1; i < model.bodies().size(); ++i)
    EXPECT_LT(model.bodies()[i].parent, static_cast<int>(i));
  EXPECT_EQ(model.links().size(), 6u);
  const Link& cap = model.links()[model.find_link("cap")];
  EXPECT_EQ(model.bodies()[cap.body].name, "l_shank");
  EXPECT_TRUE(cap.pose.isApprox(biped().joints.back().origin));
  EXPECT_DOUBLE_EQ(model.mass(), 6.0);
  EXPECT_EQ(model.dof_names(), (std::vector<std::string>{"l_knee", "l_hip", "r_hip", "r_knee"}));
  for (int i = 0; i < model.dof_count(); ++i)
    EXPECT_EQ(model.bodies()[model.dofs()[i].body].dof, i);
}

TEST(RobotModel, FollowsTheGivenJointOrder) {
  RobotDescription robot = biped();
  robot.joint_order = {"r_hip", "r_knee", "l_hip", "l_knee"};
  const RobotModel model(robot);
  EXPECT_EQ(model.dof_names(), robot.joint_order);
  EXPECT_EQ(model.leg(Side::left), (std::vector<int>{2, 3}));
  EXPECT_EQ(model.leg(Side::right), (std::vector<int>{0, 1}));
  EXPECT_EQ(model.bodies()[model.dofs()[3].body].name, "l_shank");
}

// The kinetic energy of a rigid pair is the same link by link and merged, for random twists.
TEST(RobotModel, MergedInertiaHasTheEnergyOfItsLinks) {
  const RobotModel model(biped());
  const int cap = model.find_link("cap"), shank = model.find_link("l_shank");
  const Body& body = model.bodies()[model.links()[cap].body];
  const auto energy = [](const Inertia& inertia, const Eigen::Vector3d& v,
                         const Eigen::Vector3d& w) {
    const Eigen::Vector3d at_com = v + w.cross(inertia.com);
    return 0.5 * inertia.mass * at_com.squaredNorm() + 0.5 * w.dot(inertia.about_com * w);
  };
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Vector3d v(uniform(random), uniform(random), uniform(random));
    const Eigen::Vector3d w(uniform(random), uniform(random), uniform(random));
    double expected = 0;
    for (const int index : {cap, shank}) {
      const Link& link = model.links()[index];
      const Eigen::Matrix3d turn = link.pose.linear().transpose();
      const Eigen::Vector3d at_link = v + w.cross(link.pose.translation());
      expected += energy(link.inertia, turn * at_link, turn * w);
    }
    EXPECT_NEAR(energy(body.inertia, v, w), expected, 1e-14);
  }
}

TEST(RobotModel, MimicJointsFollowThroughChains) {
  RobotDescription robot = biped();
  robot.joints[0].mimic = "l_hip";  // l_knee = 2 l_hip + 0.5
  robot.joints[0].mimic_multiplier = 2;
  robot.joints[0].mimic_offset = 0.5;
  robot.joints[3].mimic = "l_knee";  // r_knee = -1 l_knee + 0.25 = -2 l_hip - 0.25
  robot.joints[3].mimic_multiplier = -1;
  robot.joints[3].mimic_offset = 0.25;
  const RobotModel model(robot);
  EXPECT_EQ(model.dof_names(), (std::vector<std::string>{"l_hip", "r_hip"}));
  const auto body_of = [&](const char* link) {
    return model.bodies()[model.links()[model.find_link(link)].body];
  };
  EXPECT_EQ(body_of("r_shank").dof, 0);
  EXPECT_DOUBLE_EQ(body_of("r_shank").ratio, -2);
  EXPECT_DOUBLE_EQ(body_of("r_shank").offset, -0.25);
  EXPECT_EQ(model.bodies()[model.dofs()[0].body].name, "l_thigh");
}

TEST(RobotModel, SolesHaveCentroidAndConstants) {
  RobotDescription robot = biped();
  robot.soles["left"].polygon = {{0, 0}, {0.3, 0}, {0, 0.3}};
  robot.soles["left"].frame = Eigen::Translation3d(0, 0, -0.02) * Eigen::Isometry3d::Identity();
  robot.soles["left"].stiffness = 1000;
  const RobotModel model(robot);
  EXPECT_TRUE(model.sole(Side::left).center.isApprox(Eigen::Vector2d(0.1, 0.1)));
  EXPECT_TRUE(model.sole(Side::right).center.isApprox(Eigen::Vector2d(0.01, 0.0), 1e-12));
  EXPECT_DOUBLE_EQ(model.sole(Side::left).stiffness, 1000);
  EXPECT_NEAR(model.mass() * 9.80665 / model.sole(Side::right).stiffness, 0.0001, 1e-12);
  const Eigen::Isometry3d expected =
      biped().joints.back().origin * Eigen::Translation3d(0, 0, -0.02);
  EXPECT_TRUE(model.sole(Side::left).frame.isApprox(expected));
}

TEST(RobotModel, ProfilesFallBackToTheUrdf) {
  RobotDescription robot = biped();
  robot.joints[1].effort = 0;
  EXPECT_EQ(RobotModel(robot).profile_names(), std::vector<std::string>{"urdf"});
  ActuatorProfile slow;
  slow.name = "slow";
  slow.speed = {{"l_knee", 1.5}};
  robot.profiles = {slow};
  const RobotModel model(robot);
  const ActuatorLimits& limits = model.limits();
  EXPECT_EQ(limits.name, "slow");
  EXPECT_DOUBLE_EQ(limits.speed[model.find_dof("l_knee")], 1.5);
  EXPECT_DOUBLE_EQ(limits.speed[model.find_dof("l_hip")], 5);
  EXPECT_TRUE(std::isinf(limits.peak_torque[model.find_dof("l_hip")]));
  EXPECT_THROW(model.limits("fast"), Error);
}

TEST(RobotModel, PosturesLeaveOtherJointsAtZero) {
  RobotDescription robot = biped();
  robot.postures["bow"] = {{"l_hip", 0.5}};
  robot.joints[3].lower = 0.1;
  const RobotModel model(robot);
  EXPECT_DOUBLE_EQ(model.posture("bow")[model.find_dof("l_hip")], 0.5);
  EXPECT_DOUBLE_EQ(model.posture("bow")[model.find_dof("r_hip")], 0.0);
  EXPECT_DOUBLE_EQ(model.posture()[model.find_dof("r_knee")], 0.1);  // the value nearest to 0
  EXPECT_THROW(model.posture("bouw"), Error);
}

TEST(RobotModel, LetsABareFrameBetweenTwoAxesBeMassless) {
  RobotDescription robot = biped();
  robot.links[1].inertia = {};
  robot.links[1].has_inertial = false;  // l_thigh has no shape, and the shank is beyond it
  EXPECT_DOUBLE_EQ(RobotModel(robot).mass(), 5.0);
  robot.links[1].collisions.emplace_back();
  EXPECT_THROW(RobotModel{robot}, Error);
}

TEST(RobotModel, NamesWhatIsWrongInTheUrdf) {
  EXPECT_EQ(error_of([](auto& r) { r.links[0].name = "trunk"; }),
            "biped.urdf: link trunk: two links have this name; rename one");
  EXPECT_EQ(error_of([](auto& r) { r.joints[1].name = "r_hip"; }),
            "biped.urdf: joint r_hip: two joints have this name; rename one");
  EXPECT_EQ(error_of([](auto& r) { r.joints[0].parent = "l_thig"; }),
            "biped.urdf: joint l_knee: the link 'l_thig' does not exist; did you mean 'l_thigh'?");
  EXPECT_EQ(error_of([](auto& r) { r.links.push_back(heavy("stray")); }),
            "biped.urdf: there are several root links: trunk, stray; add joints so that only one "
            "root link remains");
  EXPECT_EQ(error_of([](auto& r) { r.joints.push_back(hinge("x", "r_shank", "l_shank")); }),
            "biped.urdf: link l_shank: the joints l_knee and x both lead to this link, but closed "
            "chains are not supported; remove one of these joints");
  EXPECT_EQ(error_of([](auto& r) { r.joints.push_back(hinge("x", "r_shank", "trunk")); }),
            "biped.urdf: link cap: the joints form a loop, so no link is the root; remove one "
            "joint");
  EXPECT_EQ(error_of([](auto& r) { r.joints[1].parent = "cap"; }),
            "biped.urdf: link cap: this link belongs to a loop of joints that is not connected to "
            "the root link "
            "trunk; remove one joint of the loop");
  EXPECT_EQ(error_of([](auto& r) { r.links[2].inertia.mass = -1; }),
            "biped.urdf: link l_shank: mass -1 kg is negative; give the link its mass");
  EXPECT_EQ(
      error_of([](auto& r) { r.links[5].inertia.mass = 0; }),
      "biped.urdf: link r_shank: the mass of this link is 0 although a joint moves this link; "
      "give the link a mass and an inertia");
  EXPECT_EQ(
      error_of([](auto& r) {
        r.links[3].inertia = {};
        r.links[3].has_inertial = false;
      }),
      "biped.urdf: link trunk: this link has no <inertial> although it is the root of a robot "
      "that moves; give the link a mass and an inertia");
  EXPECT_NE(error_of([](auto& r) { r.links[2].inertia.mass = 1e7; }).find("above 1e+06 kg"),
            std::string::npos);
  EXPECT_NE(error_of([](auto& r) {
              r.joints[2].origin.translation().x() = 1e5;
            }).find("joint r_hip: its origin lies farther than 10000 m"),
            std::string::npos);
  EXPECT_NE(error_of([](auto& r) { r.links[2].inertia.com.x() = std::nan(""); }).find("not finite"),
            std::string::npos);
  EXPECT_NE(error_of([](auto& r) {
              r.links[2].inertia.about_com(0, 0) = -0.01;
            }).find("link l_shank: its inertia tensor has the negative principal moment -0.01"),
            std::string::npos);
  EXPECT_EQ(error_of([](auto& r) { r.links[2].inertia.com.x() = 2e4; }),
            "biped.urdf: link l_shank: its centre of mass lies farther than 10000 m away; URDF "
            "lengths are in metres");
  EXPECT_EQ(error_of([](auto& r) { r.joints[0].damping = std::nan(""); }),
            "biped.urdf: joint l_knee: a number of this joint is not finite; correct this number");
  EXPECT_EQ(error_of([](auto& r) { r.joints[0].friction = -1; }),
            "biped.urdf: joint l_knee: its friction is -1; it cannot be negative");
  EXPECT_EQ(error_of([](auto& r) { r.joints[0].axis.setZero(); }),
            "biped.urdf: joint l_knee: its axis has length zero; give it a direction");
  EXPECT_EQ(error_of([](auto& r) { r.joints[0].lower = 3; }),
            "biped.urdf: joint l_knee: lower limit 3 exceeds the upper limit 2; swap them");
  EXPECT_EQ(error_of([](auto& r) { r.joints[0].mimic = "hip"; }),
            "biped.urdf: joint l_knee: this joint mimics the joint 'hip', which does not exist; "
            "did you mean "
            "'l_hip'?");
  EXPECT_EQ(error_of([](auto& r) {
              r.joints[0].mimic = "l_hip";
              r.joints[1].mimic = "l_knee";
            }),
            "biped.urdf: joint l_knee: this joint mimics itself through other joints; change "
            "<mimic> of one of these joints");
  EXPECT_EQ(error_of([](auto& r) { r.joints[0].mimic = "l_cap"; }),
            "biped.urdf: joint l_knee: this joint mimics the joint 'l_cap', which does not move");
}

// Without meshes, feet cannot be recognized, so the message about missing soles names this cause.
TEST(RobotModel, MissingMeshesMayBeWhySolesAreMissing) {
  RobotDescription robot = biped();
  robot.soles.clear();
  const auto message = [&] {
    try {
      RobotModel(robot).sole(Side::left);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(message().find("the robot has no soles"), std::string::npos) << message();
  EXPECT_EQ(message().find("meshes"), std::string::npos) << message();
  robot.missing_meshes = {"foot.stl"};
  EXPECT_NE(message().find(
                "find the missing meshes, because they may show the feet: `ayumi inspect` lists"),
            std::string::npos)
      << message();
}

TEST(RobotModel, NamesWhatIsWrongInTheSidecar) {
  EXPECT_EQ(error_of([](auto& r) { r.soles["left"].link = "capp"; }),
            "robot.json: /soles/left/link: the link 'capp' does not exist; did you mean 'cap'?");
  EXPECT_EQ(error_of([](auto& r) { r.soles.erase("left"); }),
            "robot.json: /soles: only one foot is given; name 'left' and 'right'");
  EXPECT_EQ(
      error_of([](auto& r) { r.soles["left"].link = "l_shank", r.soles["right"].link = "cap"; }),
      "robot.json: /soles: both feet are on one body; name two foot links");
  EXPECT_NE(
      error_of([](auto& r) { std::swap(r.soles["left"].polygon[1], r.soles["left"].polygon[3]); })
          .find("robot.json: /soles/left/polygon/1: at this corner, the polygon is not "
                "convex or not counter-clockwise"),
      std::string::npos);
  EXPECT_EQ(
      error_of([](auto& r) {
        r.postures["home"] = {{"l_kne", 0.1}};
      }),
      "robot.json: /postures/home/l_kne: 'l_kne' is not a moving joint of the robot; did you mean "
      "'l_knee'?");
  EXPECT_EQ(
      error_of([](auto& r) {
        r.postures["home"] = {{"l_knee", 2.9}};
      }),
      "robot.json: /postures/home/l_knee: the joint 'l_knee' is at 166.2 deg, above its limit of "
      "114.6 deg");
  EXPECT_EQ(error_of([](auto& r) {
              r.joint_order = {"l_hip", "l_knee", "r_hip"};
            }),
            "robot.json: /joint_order: the joint 'r_knee' is missing; add it");
  EXPECT_EQ(error_of([](auto& r) {
              r.control.joint_weight = {{"l_knee", 0.0}};
            }),
            "robot.json: /control/joint_weight: the weight of 'l_knee' is 0; it must be above 0");
  EXPECT_EQ(error_of([](auto& r) {
              r.joint_order = {"l_hip", "l_kne", "r_hip", "r_knee"};
            }),
            "robot.json: /joint_order/1: 'l_kne' is not a moving joint of the URDF; did you mean "
            "'l_knee'?");
  EXPECT_EQ(error_of([](auto& r) {
              r.joint_order = {"l_hip", "l_hip", "r_hip", "r_knee"};
            }),
            "robot.json: /joint_order: 'l_hip' appears twice; keep one");
  EXPECT_EQ(error_of([](auto& r) { r.trunk_link = "trunc"; }),
            "robot.json: /trunk_link: the link 'trunc' does not exist; did you mean 'trunk'?");
  EXPECT_EQ(error_of([](auto& r) { r.sensors.imu_link = "trunc"; }),
            "robot.json: /sensors/imu_link: the link 'trunc' does not exist; did you mean "
            "'trunk'?");
  EXPECT_EQ(error_of([](auto& r) {
              r.collision_ignore = {{"trunk", "l_shank"}, {"trunk", "l_shnk"}};
            }),
            "robot.json: /collision_ignore/1/1: the link 'l_shnk' does not exist; did you mean "
            "'l_shank'?");
  EXPECT_EQ(error_of([](auto& r) { r.encoders["l_kne"] = {}; }),
            "robot.json: /encoders: 'l_kne' is not a moving joint of the robot; did you mean "
            "'l_knee'?");
}

TEST(RobotModel, NamesNumbersThatTheSidecarCannotHave) {
  EXPECT_EQ(error_of([](auto& r) { r.servos["l_knee"].kp = -1; }),
            "robot.json: /servos/l_knee: kp is -1; it cannot be negative");
  for (const double period : {0.0, 1e-8, 11.0})
    EXPECT_EQ(
        error_of([&](auto& r) { r.servo_period = period; }),
        "robot.json: /servo_period: " + text::brief(period) + " s is given; give 1e-7 to 10 s");
  EXPECT_EQ(error_of([](auto& r) { r.soft_limit_margin = -0.01; }),
            "robot.json: /soft_limit_margin: the value is -0.01; it cannot be negative");
  const auto in_profile = [](const std::function<void(ActuatorProfile&)>& change) {
    return error_of([&](RobotDescription& robot) {
      robot.profiles.resize(1);
      robot.profiles[0].name = "strong";
      change(robot.profiles[0]);
    });
  };
  EXPECT_EQ(in_profile([](auto& p) { p.thermal_window = 0; }),
            "robot.json: /profiles: profile 'strong': thermal_window is 0 s; it must be above 0 s");
  EXPECT_EQ(
      in_profile([](auto& p) { p.speed["l_knee"] = 0; }),
      "robot.json: /profiles: profile 'strong': the speed of 'l_knee' is 0; it must be above 0");
  EXPECT_EQ(in_profile([](auto& p) { p.peak_torque["l_kne"] = 1; }),
            "robot.json: /profiles: profile 'strong': 'l_kne' is not a moving joint of the robot; "
            "did you "
            "mean 'l_knee'?");
}

TEST(RobotModel, NamesSolesThatCannotBe) {
  EXPECT_EQ(error_of([](auto& r) { r.soles["middle"] = r.soles["left"]; }),
            "robot.json: /soles/middle: unknown foot; the two feet are 'left' and 'right'");
  EXPECT_EQ(error_of([](auto& r) { r.soles["left"].polygon.resize(2); }),
            "robot.json: /soles/left/polygon: too few corners; give at least three corners of a "
            "convex polygon, counter-clockwise seen from above");
  const auto round = [](RobotDescription& robot, int corners) {
    auto& polygon = robot.soles["left"].polygon;
    polygon.clear();
    for (int i = 0; i < corners; ++i) {
      const double turn = 2 * M_PI * i / corners;
      polygon.emplace_back(0.05 * std::cos(turn), 0.05 * std::sin(turn));
    }
  };
  EXPECT_EQ(error_of([&](auto& r) { round(r, 32); }), "no error");
  EXPECT_EQ(error_of([&](auto& r) { round(r, 33); }),
            "robot.json: /soles/left/polygon: the sole has 33 corners, but at most 32 are "
            "possible; leave out corners between which the outline is almost straight");
  EXPECT_EQ(error_of([](auto& r) { r.soles["left"].damping_time = -1; }),
            "robot.json: /soles/left: damping_time is -1; it cannot be negative");
  EXPECT_EQ(error_of([](auto& r) { r.sensors.force_cells["middle"].resize(1); }),
            "robot.json: /sensors/force_cells/middle: the robot has no sole of this name");
  for (const size_t cells : {1, 4})
    EXPECT_EQ(error_of([&](auto& r) { r.sensors.force_cells["left"].resize(cells); }), "no error");
  EXPECT_EQ(error_of([](auto& r) { r.sensors.force_cells["left"].resize(3); }),
            "robot.json: /sensors/force_cells/left: there are 3 load cells, but the sole has 4 "
            "corners; give one load cell for each corner, or one for all");
}

// Values that no motor of a robot of this mass and size can have are refused, also in a profile.
// The robot has 6 kg. Stretched out, it is 0.474 m long: two legs of two links of 0.1 m each, and
// two centres of mass that are 37 mm beyond them.
TEST(RobotModel, RefusesServosThatAreTooLargeForIt) {
  const auto with = [](double ServoDescription::*constant, double value) {
    return error_of([&](RobotDescription& robot) { robot.servos["l_knee"].*constant = value; });
  };
  EXPECT_EQ(
      with(&ServoDescription::rotor_inertia, 100),
      "robot.json: /servos: profile 'urdf': joint l_knee: rotor_inertia 100 kg m^2 is too large "
      "for a "
      "robot of 6 kg and 0.475 m; the largest allowed value is 1.35 kg m^2. Check the unit of "
      "the constant, and the masses of the links");
  for (const auto constant :
       {&ServoDescription::coulomb, &ServoDescription::stribeck_torque, &ServoDescription::kp,
        &ServoDescription::kd, &ServoDescription::viscous})
    EXPECT_NE(with(constant, 9e6).find("is too large for a robot of 6 kg"), std::string::npos);
  EXPECT_EQ(with(&ServoDescription::rotor_inertia, 0.01), "no error");
  EXPECT_NE(
      error_of([](RobotDescription& robot) {
        robot.profiles.resize(2);
        robot.profiles[0].name = "first";
        robot.profiles[1].name = "second";
        robot.profiles[1].servos["r_hip"].coulomb = 100;
      }).find("robot.json: /profiles: profile 'second': joint r_hip: coulomb 100 N m is too large"),
      std::string::npos);
  // For a sliding joint, the bound is the mass of the whole robot.
  EXPECT_NE(
      error_of([](RobotDescription& robot) {
        robot.joints[0].type = JointType::prismatic;
        robot.servos["l_knee"].rotor_inertia = 7;
      })
          .find("rotor_inertia 7 kg is too large for a robot of 6 kg and 0.475 m; the largest "
                "allowed value is 6 kg"),
      std::string::npos);
}

}  // namespace
}  // namespace ayumi
