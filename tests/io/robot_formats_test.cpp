// One robot in several formats is the same robot: mass matrix, bias forces, COG and limits are
// equal.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <variant>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/robot/robot_source.hpp"
#include "ayumi/io/robot/ztk.hpp"
#include "tests/support/random_robot.hpp"
#include "tests/support/relative_error.hpp"
#include "tests/support/robot_texts.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

using test::relative_error;
using test::TemporaryFolder;

// Difference relative to the norms: the formats keep every digit, so that only rounding is left.
constexpr double kSameRobot = 1e-9;

bool has_mujoco() {
  try {
    parse_robot("<mujoco><worldbody><body/></worldbody></mujoco>", "m.xml", {});
  } catch (const Error& error) {
    return std::string(error.what()).find("built without MuJoCo") == std::string::npos;
  }
  return true;
}

RobotModel from_text(const std::string& text, const std::string& name) {
  return RobotModel(parse_robot(text, name, {}));
}

// The columns of `other` are in the order of the joints of `model`.
void expect_same(const RobotModel& model, const RobotModel& other, const std::string& what,
                 double degree_rounding = 0, double same = kSameRobot) {
  ASSERT_EQ(other.dof_count(), model.dof_count()) << what;
  const int n = model.velocity_count();
  std::vector<int> column(static_cast<size_t>(n));
  for (int i = 0; i < 6; ++i) column[static_cast<size_t>(i)] = i;
  for (int i = 0; i < model.dof_count(); ++i) {
    const int there = other.find_dof(model.dofs()[i].name);
    ASSERT_GE(there, 0) << what << ": " << model.dofs()[i].name;
    column[static_cast<size_t>(6 + i)] = 6 + there;
    EXPECT_EQ(other.dofs()[there].limited, model.dofs()[i].limited) << what;
    // Some formats have degrees, which causes rounding.
    EXPECT_NEAR(other.dofs()[there].lower, model.dofs()[i].lower, degree_rounding) << what;
    EXPECT_NEAR(other.dofs()[there].upper, model.dofs()[i].upper, degree_rounding) << what;
  }
  test::Random random(7);
  RobotData data(model), other_data(other);
  Eigen::MatrixXd M, other_M;
  for (int k = 0; k < 20; ++k) {
    const RobotState state = test::random_state(model, random);
    RobotState there = state;
    for (int i = 0; i < model.dof_count(); ++i) {
      there.theta[column[static_cast<size_t>(6 + i)] - 6] = state.theta[i];
      there.dtheta[column[static_cast<size_t>(6 + i)] - 6] = state.dtheta[i];
    }
    const Eigen::VectorXd bias = bias_force(model, state, data);
    const Eigen::VectorXd other_bias = bias_force(other, there, other_data);
    mass_matrix(model, data, M);
    mass_matrix(other, other_data, other_M);
    Eigen::VectorXd sorted_bias(n);
    Eigen::MatrixXd sorted_M(n, n);
    for (int i = 0; i < n; ++i) {
      sorted_bias[i] = other_bias[column[static_cast<size_t>(i)]];
      for (int j = 0; j < n; ++j)
        sorted_M(i, j) = other_M(column[static_cast<size_t>(i)], column[static_cast<size_t>(j)]);
    }
    ASSERT_LT(relative_error(sorted_M, M), same) << what << ", mass matrix";
    ASSERT_LT(relative_error(sorted_bias, bias), same) << what << ", bias forces";
    ASSERT_LT((other_data.cog - data.cog).norm(), same) << what << ", COG";
  }
}

void expect_same_in_all_formats(const RobotModel& model) {
  expect_same(model, from_text(test::sdf_text_of(model), "r.sdf"), "SDF of " + model.name());
  expect_same(model, from_text(test::body_text_of(model), "r.body"), "body of " + model.name());
  const RobotModel ztk = from_text(ztk_text(model.description(), model.dof_names()), "r.ztk");
  expect_same(model, ztk, "ztk of " + model.name(), 1e-14);
  EXPECT_EQ(ztk.dof_names(), model.dof_names());
  if (!has_mujoco()) return;
  for (const bool diagonal : {false, true})
    for (const bool offsets : {false, true})
      expect_same(model, from_text(test::mjcf_text_of(model, diagonal, offsets), "r.xml"),
                  "MJCF of " + model.name() + (diagonal ? ", diagonal" : "") +
                      (offsets ? ", with offsets" : ""));
}

TEST(RobotFormats, BundledRobotsAreTheSame) {
  for (const char* name : {"hoap1", "humanoid30"})
    expect_same_in_all_formats(load_robot(name, {{AYUMI_SOURCE_DIR "/robots"}}));
}

TEST(RobotFormats, RandomTreesAreTheSame) {
  for (unsigned seed = 1; seed <= 12; ++seed)
    expect_same_in_all_formats(
        RobotModel(test::random_tree(seed, 6 + static_cast<int>(seed), false)));
}

RobotDescription from_file(const std::string& file) {
  return parse_robot(read_file(file), file, {});
}

// A robot of another maker, from its URDF and from its MJCF, written in all formats and read again.
TEST(RobotFormats, TheRobotOfAnotherMakerIsTheSame) {
  const std::string folder = AYUMI_SOURCE_DIR "/../shared/data/unitree_h1/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the folder of Unitree H1 is not there";
  for (const char* const file : {"urdf/h1.urdf", "h1.xml"}) {
    SCOPED_TRACE(file);
    if (std::string(file).ends_with(".xml") && !has_mujoco()) continue;
    expect_same_in_all_formats(RobotModel(from_file(folder + file)));
  }
}

// The maker's MJCF of this robot has ten joints, its numbers have six digits, and the tensors of
// its ankles are not those of the URDF.
TEST(RobotFormats, UrdfAndMjcfOfTheMakerAreTheSameRobot) {
  const std::string folder = AYUMI_SOURCE_DIR "/../shared/data/unitree_h1/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the folder of Unitree H1 is not there";
  if (!has_mujoco()) GTEST_SKIP() << "built without MuJoCo";
  constexpr double kSixDigits = 1e-5;  // each number has an error of 5e-6 at most
  const RobotDescription mjcf = from_file(folder + "h1.xml");
  const RobotModel model(mjcf);
  RobotDescription urdf = from_file(folder + "urdf/h1.urdf");
  for (JointDescription& joint : urdf.joints)
    if (model.find_dof(joint.name) < 0) joint.type = JointType::fixed;
  for (LinkDescription& link : urdf.links)
    for (const LinkDescription& other : mjcf.links)
      if (other.name == link.name && link.name.ends_with("_ankle_link"))
        link.inertia.about_com = other.inertia.about_com;
  expect_same(model, RobotModel(urdf), "URDF of H1", 0, kSixDigits);
}

TEST(RobotFormats, BodyOrderIsThatOfTheIds) {
  const RobotModel model = load_robot("hoap1", {{AYUMI_SOURCE_DIR "/robots"}});
  EXPECT_EQ(from_text(test::body_text_of(model), "r.body").dof_names(), model.dof_names());
}

// Motors, mirrored shapes, remarks and both ways to write brackets, as RoKi's robots have them.
TEST(Ztk, IsReadAsRokiWritesIt) {
  const std::string text = R"([roki::chain]
name : legs
[zeo::optic]
name: red
diffuse: 1.0, 0.0, 0.0
[zeo::shape]
name: plate
type: polyhedron
optic: red
vert: 0 { 0.1, 0.0, 0.0 }
vert: 1  0.1, 0.1, 0.0
vert: 2  0.0, 0.0, 0.2
face: 0 1 2
[zeo::shape]
name: other_plate
mirror: plate y
[zeo::shape]
name: rod
type: cylinder
center: { 0, 0, 0 }
center: { 0, 0.2, 0 }
radius: 0.01
[roki::motor]
name: m
type: dc
motorconstant: 0.02
admittance: 0.5
maxvoltage: 24
minvoltage: -24
gearratio: 100
[roki::link]
name: base
jointtype: float
mass: 2.0   % a remark
inertia: {
 0.01, 0, 0
 0, 0.01, 0
 0, 0, 0.01
}
shape: plate
shape: other_plate
[roki::link]
name: knee
jointtype: revolute
min: -90
max: 45
coulomb: 1.5
motor: m
mass: 0.5
COM: { 0, 0, -0.1 }
inertia: {
 0.001, 0, 0
 0, 0.001, 0
 0, 0, 0.001
}
frame: {
 0, -1, 0, 0.1
 1, 0, 0, 0.2
 0, 0, 1, 0.3
}
shape: rod
parent: base
)";
  const RobotDescription robot = parse_robot(text, "legs.ztk", {});
  EXPECT_EQ(robot.name, "legs");
  ASSERT_EQ(robot.links.size(), 2u);
  ASSERT_EQ(robot.joints.size(), 1u);
  const JointDescription& knee = robot.joints[0];
  EXPECT_EQ(knee.type, JointType::revolute);
  EXPECT_EQ(knee.axis, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(knee.lower, -EIGEN_PI / 2, 1e-15);
  EXPECT_NEAR(knee.upper, EIGEN_PI / 4, 1e-15);
  EXPECT_EQ(knee.friction, 1.5);
  EXPECT_NEAR(knee.effort, 24, 1e-12);
  EXPECT_EQ(knee.origin.translation(), Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_LT((knee.origin.linear().col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_EQ(robot.joint_order, std::vector<std::string>{"knee"});
  ASSERT_EQ(robot.links[0].visuals.size(), 2u);
  const MeshPart& mirrored =
      std::get<MeshShape>(robot.links[0].visuals[1].shape).mesh.parts.front();
  EXPECT_EQ(mirrored.vertices[1], Eigen::Vector3f(0.1f, -0.1f, 0));
  const PlacedShape& rod = robot.links[1].visuals[0];
  EXPECT_EQ(std::get<Cylinder>(rod.shape).length, 0.2);
  EXPECT_LT((rod.pose * Eigen::Vector3d(0, 0, 0.1) - Eigen::Vector3d(0, 0.2, 0)).norm(), 1e-15);

  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string other = text;
    other.replace(other.find(from), from.size(), to);
    try {
      parse_robot(other, "legs.ztk", {});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  EXPECT_EQ(refusal("COM: { 0, 0, -0.1 }", "COM: { 0, 0, nan }"),
            "legs.ztk:50: COM: 'nan' is not a finite number");
  EXPECT_EQ(refusal("COM: { 0, 0, -0.1 }", "COM: { 0, -0.1 }"),
            "legs.ztk:50: COM: 3 numbers are needed, found 2");
  EXPECT_NE(refusal("jointtype: revolute", "jointtype: hooke").find("'hooke' is not supported"),
            std::string::npos);
  EXPECT_NE(refusal("face: 0 1 2", "face: 0 1 7")
                .find("corner 7 does not exist; the shape has 3 corners"),
            std::string::npos);
  EXPECT_NE(refusal(" 1, 0, 0, 0.2", " 2, 0, 0, 0.2").find("are not a rotation"),
            std::string::npos);
  EXPECT_NE(refusal("parent: base", "parent: bas").find("bas"), std::string::npos);
}

RobotDescription mjcf(const std::string& inside, const std::string& around = "") {
  return parse_robot("<mujoco model='m'><compiler angle='radian'/>" + around + "<worldbody>" +
                         inside + "</worldbody></mujoco>",
                     "m.xml", {});
}

// The result of MuJoCo's rules for a model: classes, several joints of a body, inertia from shapes,
// actuators, equalities, excluded pairs, and elements that the installed MuJoCo does not know.
TEST(Mjcf, IsReadAsMujocoCompilesIt) {
  if (!has_mujoco()) GTEST_SKIP() << "built without MuJoCo";
  const RobotDescription robot = parse_robot(R"(
    <mujoco model='legs'>
      <compiler angle='degree'/>
      <option timestep='0.002' later='1'/>
      <default><default class='motor'><joint armature='0.01' damping='0.5' actuatorfrcrange='-9 9'/>
        <position kp='20' kv='0.3' forcerange='-4 4'/></default></default>
      <asset><texture name='t' file='gone.png' type='2d'/><material name='m' texture='t' rgba='1 0 0 1'/></asset>
      <worldbody>
        <light pos='0 0 1'/><geom type='plane' size='1 1 1'/>
        <body name='base'><freejoint/><geom type='box' size='0.1 0.1 0.05' density='1000' material='m'/>
          <site name='imu' pos='0.01 0 0.02'/>
          <body name='leg' pos='0 0.1 0' childclass='motor'>
            <joint name='a' axis='1 0 0' range='-30 60'/><joint name='b' axis='0 1 0' pos='0 0 -0.1'/>
            <geom type='capsule' size='0.02 0.1' pos='0 0 -0.1' contype='0' conaffinity='0'/>
            <geom type='ellipsoid' size='0.02 0.03 0.1' pos='0 0 -0.1'/>
            <body name='toe' pos='0 0 -0.2'><joint name='c' type='slide' axis='1 0 0' range='0 0.02'/>
              <inertial pos='0 0 0' mass='0.2' diaginertia='1e-4 1e-4 1e-4'/></body>
          </body>
          <body name='tail'><joint name='d' axis='0 1 0'/><joint name='e' axis='1 0 0'/>
            <inertial pos='0 0 0' mass='0.1' diaginertia='1e-5 1e-5 1e-5'/></body>
        </body>
      </worldbody>
      <equality><joint joint1='d' joint2='b' polycoef='0.1 -2 0 0 0'/></equality>
      <contact><exclude body1='base' body2='toe'/></contact>
      <actuator><position class='motor' joint='a' gear='2'/><motor joint='b' ctrlrange='-3 3' ctrllimited='true' gear='2'/></actuator>
      <sensor><gyro site='imu'/></sensor>
      <keyframe><key qpos='0'/></keyframe>
    </mujoco>)",
                                             "legs.xml", {});
  const RobotModel model(robot);
  EXPECT_EQ(model.dof_names(), (std::vector<std::string>{"a", "b", "c", "e"}));
  EXPECT_NEAR(model.dofs()[0].upper, std::numbers::pi / 3, 1e-12);
  EXPECT_NEAR(model.dofs()[2].upper, 0.02, 1e-15);
  EXPECT_FALSE(model.dofs()[1].limited);
  const auto joint = [&](const std::string& name) {
    for (const JointDescription& each : robot.joints)
      if (each.name == name) return each;
    throw std::runtime_error(name);
  };
  EXPECT_EQ(joint("d").mimic, "b");
  EXPECT_EQ(joint("d").mimic_multiplier, -2);
  EXPECT_EQ(joint("d").mimic_offset, 0.1);
  EXPECT_EQ(joint("a").effort, 8);  // it is the force range at the joint
  EXPECT_EQ(joint("b").effort, 9);  // it is the actuatorfrcrange of its class
  EXPECT_EQ(joint("b").damping, 0.5);
  const ServoDescription& servo = robot.servos.at("a");
  EXPECT_EQ(servo.kp, 80);
  EXPECT_NEAR(servo.kd, 1.2, 1e-12);
  EXPECT_EQ(servo.rotor_inertia, 0.01);
  EXPECT_EQ(robot.servos.at("e").kp, 0);  // it has no actuator
  EXPECT_EQ(joint("c").effort, 0);        // it has none either, whatever limits its force
  EXPECT_EQ(robot.sensors.imu_link, "base");
  EXPECT_TRUE(robot.sensors.imu_position.isApprox(Eigen::Vector3d(0.01, 0, 0.02)));
  ASSERT_EQ(robot.collision_ignore.size(), 1u);
  EXPECT_EQ(robot.collision_ignore[0].second, "toe");
  const Link& base = model.links()[static_cast<size_t>(model.find_link("base"))];
  EXPECT_NEAR(base.inertia.mass, 0.2 * 0.2 * 0.1 * 1000, 1e-9);
  EXPECT_EQ(base.collisions.size(), 1u);
  EXPECT_EQ(base.visuals[0].color.x(), 1);
  const Link& leg = model.links()[static_cast<size_t>(model.find_link("leg"))];
  EXPECT_EQ(leg.visuals.size(), 1u);
  EXPECT_EQ(leg.collisions.size(), 1u);
  EXPECT_TRUE(leg.visuals[0].pose.translation().isApprox(Eigen::Vector3d(0, 0, 0), 1e-12) ||
              leg.visuals[0].pose.translation().norm() < 1e-12);
}

// A box of 0.2 x 0.4 x 0.6 m, away from the origin.
std::string box_in_millimetres() {
  std::string box;
  for (int i = 0; i < 8; ++i)
    box += "v " + std::to_string(i & 1 ? 300 : 100) + " " + std::to_string(i & 2 ? 200 : -200) +
           " " + std::to_string(i & 4 ? 600 : 0) + "\n";
  return box +
         "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 1 2 5\nf 2 6 5\nf 3 7 4\nf 4 7 8\nf 1 5 3\n"
         "f 3 5 7\nf 2 4 6\nf 4 8 6\n";
}

TEST(Mjcf, MeshesAreReadAsInOtherFormats) {
  if (!has_mujoco()) GTEST_SKIP() << "built without MuJoCo";
  const TemporaryFolder folder;
  folder.write("parts/Box.obj", box_in_millimetres());
  const std::string head =
      "<mujoco model='m'><compiler meshdir='parts'/><asset><mesh name='box' file='box.obj' "
      "scale='0.001 0.001 0.001'/><mesh file='gone.stl'/></asset><worldbody><body name='a'>"
      "<freejoint/>";
  const std::string tail =
      "<geom type='mesh' mesh='box' density='1000'/><body name='b'><joint name='j' axis='0 0 1'/>"
      "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><geom type='mesh' mesh='box' pos='0 0 "
      "1'/>"
      "<geom type='mesh' mesh='gone'/></body></body></worldbody></mujoco>";
  const auto file = folder.write("m.xml", head + tail);
  const RobotModel model = load_robot(file.string(), {}, {.meshes = true});
  EXPECT_NEAR(model.links()[0].inertia.mass, 48, 1e-4);
  EXPECT_TRUE(model.links()[0].inertia.com.isApprox(Eigen::Vector3d(0.2, 0, 0.3), 1e-6));
  const Link& b = model.links()[1];
  ASSERT_EQ(b.collisions.size(), 1u);
  EXPECT_TRUE(
      b.collisions[0].pose.isApprox(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1)), 1e-12));
  EXPECT_EQ(std::get<MeshShape>(b.collisions[0].shape).mesh.parts.size(), 1u);
  bool missing = false;
  for (const std::string& each : model.description().assumptions)
    missing |= each.find("gone.stl of link b") != std::string::npos;
  EXPECT_TRUE(missing);
  std::string without = head + tail;
  without.replace(without.find("mesh='box' density"), 10, "mesh='gone'");
  EXPECT_THROW(load_robot(folder.write("n.xml", without).string()), Error);
}

// A primitive that names a mesh gets the size that MuJoCo fits to the mesh, and not its own size.
TEST(Mjcf, PrimitivesFittedToAMeshHaveItsSize) {
  if (!has_mujoco()) GTEST_SKIP() << "built without MuJoCo";
  const TemporaryFolder folder;
  folder.write("box.obj", box_in_millimetres());
  const std::string text =
      "<mujoco model='m'><asset><mesh name='box' file='box.obj' scale='0.001 0.001 0.001'/>"
      "<mesh name='gone' file='gone.stl'/></asset>"
      "<default><default class='fits'><geom type='box' mesh='box' density='1000'/></default>"
      "</default><worldbody><body name='a'><freejoint/><geom class='fits'/>"
      "<geom type='mesh' mesh='box' density='0' pos='0 0 2'/>"
      "<body name='b'><joint name='j' axis='0 0 1'/><inertial pos='0 0 0' mass='1' "
      "diaginertia='1 1 1'/><geom type='sphere' mesh='box' pos='0 0 1' size='7'/>"
      "<geom type='capsule' mesh='box'/><geom type='cylinder' mesh='box'/>"
      "<geom mesh='box'/><geom type='box' mesh='gone'/></body></body></worldbody></mujoco>";
  const RobotModel model = load_robot(folder.write("m.xml", text).string(), {}, {.meshes = true});
  const Link& a = model.links()[0];
  EXPECT_NEAR(a.inertia.mass, 48, 1e-4);
  EXPECT_TRUE(a.inertia.com.isApprox(Eigen::Vector3d(0.2, 0, 0.3), 1e-6));
  ASSERT_EQ(a.collisions.size(), 2u);
  // The corners of the box are those of the mesh.
  const Eigen::Vector3d size = std::get<Box>(a.collisions[0].shape).size;
  Eigen::AlignedBox3d extent;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d half(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    extent.extend(a.collisions[0].pose * half.cwiseProduct(size));
  }
  EXPECT_TRUE(extent.min().isApprox(Eigen::Vector3d(0.1, -0.2, 0), 1e-5)) << extent.min();
  EXPECT_TRUE(extent.max().isApprox(Eigen::Vector3d(0.3, 0.2, 0.6), 1e-5)) << extent.max();
  // The mesh that is no primitive is where the model has it.
  EXPECT_TRUE(
      a.collisions[1].pose.isApprox(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 2)), 1e-12));
  // Definition: these are MuJoCo's rules for the half sizes 0.1, 0.2, 0.3 of the box of equal
  // inertia.
  const Link& b = model.links()[1];
  ASSERT_EQ(b.collisions.size(), 4u);
  EXPECT_NEAR(std::get<Sphere>(b.collisions[0].shape).radius, 0.2, 1e-6);
  EXPECT_TRUE(b.collisions[0].pose.translation().isApprox(Eigen::Vector3d(0.2, 0, 1.3), 1e-6));
  EXPECT_NEAR(std::get<Capsule>(b.collisions[1].shape).radius, 0.15, 1e-6);
  EXPECT_NEAR(std::get<Cylinder>(b.collisions[2].shape).radius, 0.15, 1e-6);
  EXPECT_NEAR(std::get<Cylinder>(b.collisions[2].shape).length, 0.6, 1e-6);
  EXPECT_NEAR(std::get<Sphere>(b.collisions[3].shape).radius, 0.2, 1e-6);
  bool missing = false;
  for (const std::string& each : model.description().assumptions)
    missing |= each.find("gone.stl of link b") != std::string::npos;
  EXPECT_TRUE(missing);
}

TEST(Mjcf, IncludedFilesStandInTheirPlace) {
  if (!has_mujoco()) GTEST_SKIP() << "built without MuJoCo";
  const TemporaryFolder folder;
  folder.write("legs.xml",
               "<mujocoinclude><body name='leg'><joint name='j' axis='0 1 0'/><geom size='0.1'/>"
               "</body></mujocoinclude>");
  const std::string body =
      "<body name='a'><freejoint/><geom size='0.1'/><include file='legs.xml'/></body>";
  const auto text = [&](const std::string& more) {
    return "<mujoco model='m'><worldbody>" + body + more + "</worldbody></mujoco>";
  };
  EXPECT_EQ(load_robot(folder.write("m.xml", text("")).string(), {}, {.guess = false}).dof_count(),
            1);
  const auto error = [&](const std::string& file) {
    try {
      load_robot((folder.path() / file).string());
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  folder.write("m.xml", text("<include file='legs.xml'/>"));
  EXPECT_NE(error("m.xml").find("is included twice"), std::string::npos) << error("m.xml");
  folder.write("m.xml", text("<include file='arms.xml'/>"));
  EXPECT_NE(error("m.xml").find("m.xml:1: the included file"), std::string::npos) << error("m.xml");
}

TEST(Mjcf, WrongModelsAreRefusedInOneLine) {
  if (!has_mujoco()) GTEST_SKIP() << "built without MuJoCo";
  const auto error = [](const std::string& inside, const std::string& around = "") {
    try {
      RobotModel(mjcf(inside, around));
    } catch (const Error& e) {
      const std::string words = e.what();
      EXPECT_EQ(words.find('\n'), std::string::npos) << words;
      EXPECT_TRUE(words.starts_with("m.xml")) << words;
      return words;
    }
    return std::string("no error");
  };
  const auto has = [](const std::string& words, const std::string& part) {
    EXPECT_NE(words.find(part), std::string::npos) << words;
  };
  const std::string base = "<body name='a'><freejoint/><geom size='0.1'/>";
  has(error(base + "<body><joint type='ball'/><geom size='0.1'/></body></body>"), "ball joints");
  has(error(base + "<body><joint axis='0 0 nan'/><geom size='0.1'/></body></body>"),
      "not a finite");
  has(error(base + "<body pos='0,1 0 0'><joint/><geom size='0.1'/></body></body>"),
      "decimal point");
  has(error(base + "<body><joint axis='0 0 0'/><geom size='0.1'/></body></body>"), "MuJoCo");
  has(error(base + "<attach/></body>"), "does not know <attach>");
  has(error("<geom size='1'/>"), "no body with a joint");
  has(error(base + "<body><joint/><geom class='none' size='0.1'/></body></body>"), "MuJoCo");
  EXPECT_THROW(parse_robot("<mujoco><worldbody>", "m.xml", {}), Error);
}

// MuJoCo gets a text that was prepared for it. Its message has the line of this text, but the user
// needs the line of the file.
TEST(Mjcf, TheLineOfTheFileIsNamed) {
  if (!has_mujoco()) GTEST_SKIP() << "built without MuJoCo";
  const auto error = [](const std::string& geom, const std::string& more = "") {
    const std::string text =
        "<mujoco>\n <!-- a\n comment -->\n\n <statistic extent='1'/>\n <worldbody>\n  <body "
        "name='a'><freejoint/>\n   <geom size='0.1'/>\n   <body name='b'><joint name='j'/>\n\n"
        "    <geom " +
        geom + "/></body>\n  </body>\n </worldbody>\n" + more + "</mujoco>\n";
    try {
      parse_robot(text, "m.xml", {});
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error("size='0.1' pos='hello 0 0'"),
            "m.xml:11: MuJoCo: XML Error: problem reading attribute 'pos' Element 'geom'; correct "
            "this place");
  EXPECT_EQ(error("size='0.1' pos='0 0'").substr(0, 58),
            "m.xml:11: MuJoCo: XML Error: attribute 'pos' does not have");
  const std::string actuator =
      error("size='0.1'", " <actuator>\n  <motor joint='k'/>\n </actuator>\n");
  EXPECT_TRUE(actuator.starts_with("m.xml:15: MuJoCo: ")) << actuator;
  EXPECT_EQ(actuator.find("line"), std::string::npos) << actuator;
}

// In an earlier version, the line of the included file stood behind the name of the other one.
TEST(Mjcf, NoLineOfAnIncludedFileIsNamedForTheFileThatIncludesIt) {
  if (!has_mujoco()) GTEST_SKIP() << "built without MuJoCo";
  const TemporaryFolder folder;
  folder.write("part.xml",
               "<mujoco>\n <worldbody>\n  <body name='a'><freejoint/>\n   <geom type='sphera' "
               "size='0.1'/>\n  </body>\n </worldbody>\n</mujoco>\n");
  try {
    parse_robot("<mujoco>\n <include file='part.xml'/>\n <worldbody/>\n\n\n</mujoco>\n",
                folder.path() / "m.xml", {});
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("m.xml: MuJoCo: "), std::string::npos) << e.what();
  }
}

// Old Mac programs end lines with a carriage return alone, and editors of Windows put a mark before
// the text.
TEST(RobotFormats, LineEndsAndMarksOfOtherSystems) {
  const RobotModel model = load_robot("hoap1", {{AYUMI_SOURCE_DIR "/robots"}});
  for (const auto& [text, name] :
       {std::pair<std::string, std::string>{test::body_text_of(model), "r.body"},
        {ztk_text(model.description(), model.dof_names()), "r.ztk"}})
    for (const std::string end : {"\r", "\r\n"}) {
      std::string other = "\xef\xbb\xbf";
      for (const char c : text) other += c == '\n' ? end : std::string(1, c);
      EXPECT_EQ(from_text(other, name).dof_names(), from_text(text, name).dof_names()) << name;
    }
}

TEST(RobotFormats, EmptyAndWideTextsAreNamed) {
  const auto error = [](const std::string& text, const std::string& file) {
    try {
      parse_robot(text, file, {});
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  for (const char* file : {"r.body", "r.ztk", "r.sdf", "r.xml", "r.urdf"})
    EXPECT_TRUE(error(" \n", file).starts_with(std::string(file) + ": the file is empty")) << file;
  EXPECT_NE(error(std::string("\xff\xfe\0\0<\0\0\0", 8), "r.urdf").find("UTF-32"),
            std::string::npos);
}

TEST(Sdf, FramesPosesAndNestedModels) {
  const auto model = [](const std::string& inside, const std::string& version = "1.9") {
    return parse_robot("<sdf version='" + version +
                           "'><world name='w'><model name='ground'/><model name='r'>" + inside +
                           "</model></world></sdf>",
                       "r.sdf", {});
  };
  const std::string mass = "<inertial><mass>1</mass></inertial>";
  const RobotDescription nested = model(
      "<pose>5 5 5 0 0 0</pose><link name='base'>" + mass +
      "</link><frame name='hip' "
      "attached_to='base'><pose degrees='true'>0 0.1 0 0 0 90</pose></frame><model name='leg'>"
      "<pose relative_to='hip'>1 0 0 0 0 0</pose><link name='thigh'><pose>0 0 1 0 0 0</pose>" +
      mass + "</link><link name='foot'>" + mass +
      "</link><joint name='knee' type='revolute'><pose>0 0 0.5 0 "
      "0 0</pose><parent>thigh</parent><child>foot</child><axis><xyz expressed_in='__model__'>1 0 0"
      "</xyz></axis></joint></model><joint name='hip_yaw' type='revolute'><parent>base</parent>"
      "<child>leg::thigh</child><axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>1</upper>"
      "<effort>7</effort></limit></axis></joint>"
      "<joint name='hold' type='fixed'><parent>world</parent><child>base</child></joint>");
  const RobotModel robot(nested);
  EXPECT_EQ(robot.dof_count(), 2);
  RobotData data(robot);
  RobotState state = robot.rest_state();
  state.theta.setZero();
  update_positions(robot, state, data);
  const auto at = [&](const char* link) {
    return link_pose(robot, data, robot.find_link(link)).translation().eval();
  };
  EXPECT_TRUE(at("leg::thigh").isApprox(Eigen::Vector3d(0, 1.1, 1), 1e-12)) << at("leg::thigh");
  // The place is that of its joint.
  EXPECT_TRUE(at("leg::foot").isApprox(Eigen::Vector3d(0, 1.1, 0.5), 1e-12));
  const Body& foot = robot.bodies()[static_cast<size_t>(
      robot.links()[static_cast<size_t>(robot.find_link("leg::foot"))].body)];
  EXPECT_TRUE((data.rotation[static_cast<size_t>(
                   robot.links()[static_cast<size_t>(robot.find_link("leg::foot"))].body)] *
               foot.axis)
                  .isApprox(Eigen::Vector3d(0, 1, 0), 1e-12));
  EXPECT_EQ(nested.joints[1].effort, 7);
  // Before version 1.5, an axis is given in the frame of the model.
  const std::string turned =
      "<link name='a'>" + mass + "</link><link name='b'><pose>0 0 0 0 0 1.5707963267948966</pose>" +
      mass +
      "</link><joint name='j' type='revolute'><parent>a</parent><child>b</child><axis><xyz>1 0 "
      "0</xyz></axis></joint>";
  EXPECT_TRUE(model(turned, "1.4").joints[0].axis.isApprox(Eigen::Vector3d(0, -1, 0), 1e-9));
  EXPECT_TRUE(model(turned, "1.6").joints[0].axis.isApprox(Eigen::Vector3d(1, 0, 0), 1e-9));
  const auto error = [&](const std::string& inside, const std::string& version = "1.9") {
    try {
      model(inside, version);
    } catch (const Error& e) {
      const std::string words = e.what();
      EXPECT_TRUE(words.starts_with("r.sdf:")) << words;
      return words;
    }
    return std::string("no error");
  };
  EXPECT_NE(error("<frame name='a'><pose relative_to='b'/></frame><frame name='b'><pose "
                  "relative_to='a'/></frame><link name='l'><pose relative_to='a'/></link>")
                .find("circle"),
            std::string::npos);
  EXPECT_NE(error("<link name='l'><pose relative_to='nowhere'/></link>").find("no frame 'nowhere'"),
            std::string::npos);
  EXPECT_NE(error("<link name='l'><pose>0 0 0,1 0 0 0</pose></link>").find("decimal point"),
            std::string::npos);
  EXPECT_NE(error("<link name='l'/>", "2.0").find("version 2.0"), std::string::npos);
}

// Every kind of shape, its colour and its place, the sensor, joints of two axes and one that
// follows another.
TEST(Sdf, ShapesSensorsAndJointsOfTwoAxes) {
  const std::string mass = "<inertial><mass>1</mass></inertial>";
  const auto visual = [](const std::string& geometry, const std::string& more = "") {
    return "<visual name='v'><pose>0 0 0.5 0 0 0</pose><geometry>" + geometry + "</geometry>" +
           more + "</visual>";
  };
  const RobotDescription robot = parse_robot(
      "<sdf version='1.9'><model name='r'><link name='base'>" + mass +
          visual("<box><size>1 2 3</size></box>",
                 "<material><diffuse>0.5\t0.25  0\n1</diffuse></material>") +
          visual("<sphere><radius>0.1</radius></sphere>",
                 "<material><diffuse>1  0 0</diffuse></material>") +
          visual("<cylinder><radius>0.1</radius><length>0.4</length></cylinder>") +
          visual("<capsule><radius>0.2</radius><length>0.3</length></capsule>") +
          visual("<ellipsoid><radii>0.1 0.2 0.3</radii></ellipsoid>") +
          visual("<plane><normal>0 0 1</normal></plane>") +
          "<sensor name='s' type='imu'><pose>0.1 0.2 0.3 0 0 0</pose></sensor></link>"
          "<link name='head'/>"
          "<link name='arm'><pose>0 1 0 0 0 0</pose>" +
          mass + "</link><link name='other'>" + mass +
          "</link><joint name='neck' type='universal'><parent>base</parent><child>head</child>"
          "<axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>1</upper></limit></axis>"
          "<axis2><xyz>0 1 0</xyz><limit><lower>-inf</lower><upper>inf</upper></limit></axis2>"
          "</joint><joint name='shoulder' type='prismatic'><parent>base</parent><child>arm</child>"
          "<axis><xyz>0 1 0</xyz><limit><lower>0</lower><upper>0.2</upper><velocity>2</velocity>"
          "</limit><dynamics><damping>3</damping><friction>4</friction></dynamics></axis></joint>"
          "<joint name='follower' type='continuous'><parent>base</parent><child>other</child>"
          "<axis><xyz>1 0 0</xyz><mimic joint='shoulder'><multiplier>2</multiplier>"
          "<offset>0.5</offset><reference>0.1</reference></mimic></axis></joint></model></sdf>",
      "r.sdf", {});
  const auto& shapes = robot.links.at(0).visuals;
  ASSERT_EQ(shapes.size(), 5u);  // planes belong to the world
  EXPECT_EQ(std::get<Box>(shapes[0].shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(shapes[0].color, Eigen::Vector4f(0.5f, 0.25f, 0, 1));
  EXPECT_EQ(shapes[0].pose.translation(), Eigen::Vector3d(0, 0, 0.5));
  EXPECT_EQ(shapes[1].color, Eigen::Vector4f(1, 0, 0, 1));
  EXPECT_EQ(std::get<Sphere>(shapes[1].shape).radius, 0.1);
  EXPECT_EQ(std::get<Cylinder>(shapes[2].shape).length, 0.4);
  EXPECT_EQ(std::get<Capsule>(shapes[3].shape).radius, 0.2);
  float reach = 0;
  for (const MeshPart& part : std::get<MeshShape>(shapes[4].shape).mesh.parts)
    for (const Eigen::Vector3f& v : part.vertices) reach = std::max(reach, v.z());
  EXPECT_NEAR(reach, 0.3, 1e-3);
  EXPECT_EQ(robot.sensors.imu_link, "base");
  EXPECT_EQ(robot.sensors.imu_position, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(robot.joints.size(), 4u);
  const auto joint = [&](const std::string& name) {
    return *std::find_if(robot.joints.begin(), robot.joints.end(),
                         [&](const JointDescription& each) { return each.name == name; });
  };
  EXPECT_EQ(joint("neck").upper, 1);
  EXPECT_EQ(joint("neck_2").type, JointType::continuous);
  EXPECT_EQ(joint("neck_2").axis, Eigen::Vector3d::UnitY());
  EXPECT_EQ(joint("shoulder").type, JointType::prismatic);
  EXPECT_EQ(joint("shoulder").damping, 3);
  EXPECT_EQ(joint("shoulder").velocity, 2);
  EXPECT_EQ(joint("follower").mimic, "shoulder");
  EXPECT_EQ(joint("follower").mimic_multiplier, 2);
  EXPECT_NEAR(joint("follower").mimic_offset, 0.3, 1e-15);
  const std::vector<std::string>& notes = robot.assumptions;
  EXPECT_NE(std::find(notes.begin(), notes.end(),
                      "links without <inertial> get a mass of 1 kg, as SDF defines it: head"),
            notes.end());
  EXPECT_EQ(RobotModel(robot).dof_count(), 3);
}

TEST(Sdf, IncludedModels) {
  const TemporaryFolder folder;
  folder.write("hand/model.config",
               "<model><name>hand</name><sdf version='1.9'> hand.sdf </sdf></model>");
  folder.write("hand/hand.sdf",
               "<sdf version='1.9'><model name='hand'><link name='palm'><pose>0 0 1 0 0 0</pose>"
               "<inertial><mass>2</mass></inertial></link></model></sdf>");
  const auto read = [&](const std::string& include) {
    const auto file = folder.write(
        "r.sdf",
        "<sdf version='1.9'><model name='r'><link name='base'><inertial><mass>1</mass></inertial>"
        "</link>" +
            include +
            "<joint name='wrist' type='revolute'><parent>base</parent><child>left::palm</child>"
            "<axis><xyz>0 0 1</xyz></axis></joint></model></sdf>");
    return load_robot(file.string(), {}, {.guess = false});
  };
  const RobotModel robot = read(
      "<include><uri>hand</uri><name>left</name>"
      "<pose>1 0 0 0 0 0</pose></include>");
  RobotData data(robot);
  update_positions(robot, robot.rest_state(), data);
  EXPECT_TRUE(link_pose(robot, data, robot.find_link("left::palm"))
                  .translation()
                  .isApprox(Eigen::Vector3d(1, 0, 1), 1e-12));
  EXPECT_NEAR(robot.mass(), 3, 1e-12);
  const auto error = [&](const std::string& include) {
    try {
      read(include);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(error("<include/>").find("<include> has no <uri>"), std::string::npos);
  EXPECT_NE(error("<include><uri>foot</uri></include>").find("the included model foot"),
            std::string::npos);
  EXPECT_NE(error("<include><uri>r.sdf</uri></include>").find("more than 20 levels deep"),
            std::string::npos);
}

TEST(Sdf, WrongModelsAreRefusedInOneLine) {
  const std::string link = "<link name='a'><inertial><mass>1</mass></inertial>",
                    other = "</link><link name='b'/>";
  const auto joint = [](const std::string& kind, const std::string& inside) {
    return "<joint name='j' type='" + kind + "'>" + inside + "</joint>";
  };
  const std::string ends = "<parent>a</parent><child>b</child>";
  const auto shape = [&](const std::string& geometry) {
    return link + "<collision name='c'><geometry>" + geometry + "</geometry></collision>" + other +
           joint("revolute", ends + "<axis/>");
  };
  const std::pair<std::string, std::string> wrong[] = {
      {link + other + joint("ball", ends), "the type 'ball' is not supported"},
      {link + other + joint("revolute", ends), "joint j has no <axis>"},
      {link + other + joint("revolute", "<parent>a</parent>"), "joint j has no <child>"},
      {link + other + joint("revolute", "<parent>a</parent><child>c</child><axis/>"),
       "there is no link 'c'"},
      {link + other + "<link/>", "<link> has no attribute 'name'"},
      {link + other + "<frame name='a'/>", "the name 'a' is given twice"},
      {link + "<pose rotation_format='quat_xyzw'>0 0 0 0 0 0 0</pose>" + other,
       "the quaternion of the pose is zero"},
      {shape("<sphere><radius>0</radius></sphere>"), "needs a <radius> above 0"},
      {shape("<box><size>1 -1 1</size></box>"), "link a: a shape has the negative size -1 m"}};
  for (const auto& [inside, part] : wrong) {
    std::string words = "no error";
    try {
      parse_robot("<sdf version='1.9'><model name='r'>" + inside + "</model></sdf>", "r.sdf", {});
    } catch (const Error& error) {
      words = error.what();
    }
    EXPECT_TRUE(words.starts_with("r.sdf:")) << words;
    EXPECT_NE(words.find(part), std::string::npos) << words;
  }
  EXPECT_THROW(parse_robot("<sdf version='1.9'><world name='w'/></sdf>", "r.sdf", {}), Error);
}

// A chain of frames is followed without recursion.
TEST(Sdf, VeryManyFramesInAChain) {
  constexpr int kFrames = 90000;
  std::string frames;
  for (int i = 0; i < kFrames; ++i)
    frames += "<frame name='f" + std::to_string(i) + "'><pose relative_to='f" +
              std::to_string(i + 1) + "'>0 0 0.001 0 0 0</pose></frame>";
  const RobotDescription robot = parse_robot(
      "<sdf version='1.9'><model name='r'><link name='base'/><link name='tip'><pose "
      "relative_to='f0'/></link><joint name='j' type='revolute'><parent>base</parent><child>tip"
      "</child><axis><xyz>0 0 1</xyz></axis></joint><frame name='f" +
          std::to_string(kFrames) + "'/>" + frames + "</model></sdf>",
      "r.sdf", {});
  EXPECT_NEAR(robot.joints.at(0).origin.translation().z(), 1e-3 * kFrames, 1e-6);
}

// In an earlier version, the time to follow a chain of joints that mimic each other grew with the
// third power of their number.
TEST(RobotFormats, AChainOfMimicJointsIsShort) {
  const auto words_for = [](int joints) {
    const std::string inside =
        "'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
        "</inertial></link>";
    std::string urdf = "<robot name='r'><link name='l0" + inside;
    for (int i = 1; i <= joints; ++i) {
      const std::string n = std::to_string(i);
      urdf += "<link name='l" + n + inside + "<joint name='j" + n +
              "' type='continuous'><parent link='l0'/><child link='l" + n + "'/>" +
              (i < joints ? "<mimic joint='j" + std::to_string(i + 1) + "'/>" : std::string()) +
              "</joint>";
    }
    try {
      from_text(urdf + "</robot>", "r.urdf");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  EXPECT_EQ(words_for(21), "read");
  EXPECT_NE(words_for(23).find("joint j1: this joint mimics another joint through "
                               "more than 20 joints"),
            std::string::npos)
      << words_for(23);
}

// More links than any robot has would take hours.
TEST(RobotFormats, TooManyLinksAreRefused) {
  std::string sdf = "<sdf version='1.9'><model name='r'>",
              body = "format: ChoreonoidBody\nlinks:\n", ztk = "[roki::chain]\nname: r\n",
              mjcf = "<mujoco><worldbody>";
  for (int i = 0; i <= 1000; ++i) {
    const std::string name = "l" + std::to_string(i);
    sdf += "<link name='" + name + "'/>";
    body += " - {name: " + name + "}\n";
    ztk += "[roki::link]\nname: " + name + "\n";
    mjcf += "<body name='" + name + "'><joint/><geom size='0.1'/></body>";
  }
  std::vector<std::pair<std::string, std::string>> files = {
      {sdf + "</model></sdf>", "r.sdf"}, {body, "r.body"}, {ztk, "r.ztk"}};
  if (has_mujoco()) files.emplace_back(mjcf + "</worldbody></mujoco>", "r.xml");
  for (const auto& [text, file] : files) {
    std::string words = "no error";
    try {
      parse_robot(text, file, {});
    } catch (const Error& error) {
      words = error.what();
    }
    EXPECT_TRUE(words.starts_with(file)) << words;
    EXPECT_NE(words.find("more than 1000 links; simplify the robot"), std::string::npos) << words;
  }
}

// Shapes of every kind, colours, the sensor, axes and ranges in each of their ways.
TEST(ChoreonoidBody, ShapesSensorsAxesAndRanges) {
  const RobotDescription robot = parse_robot(R"(format: ChoreonoidBody
format_version: 2.0
angle_unit: radian
name: r
links:
  - name: base
    mass: 1
    elements:
      - { type: AccelerationSensor, translation: [0.1, 0.2, 0.3] }
      - type: Shape
        translation: [0, 0, 0.5]
        geometry: { type: Box, size: [1, 2, 3] }
        appearance: { material: { diffuse: [0.5, 0.25, 0], transparency: 0.5 } }
      - { type: Visual, shape: { geometry: { type: Sphere, radius: 0.1 } } }
      - { type: Collision, shape: { geometry: { type: Capsule, radius: 0.1, height: 0.4 } } }
      - { type: Shape, rotation: [[1, 0, 0, 1.5707963267948966], [0, 0, 1, 0]], geometry: { type: Cylinder, radius: 0.1, height: 0.4 } }
      - { type: Shape, geometry: { type: Cone, radius: 0.1, height: 0.4 } }
      - type: Shape
        geometry: { type: IndexedFaceSet, coordinate: [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], coordIndex: [0, 1, 2, 3, -1] }
  - { name: a, parent: base, joint_type: revolute, joint_axis: -Y, joint_range: 0.5, joint_id: 1, max_joint_velocity: 3 }
  - { name: b, parent: a, joint_type: revolute, joint_axis: +x, joint_range: [unlimited, unlimited], joint_id: 0 }
  - { name: c, parent: b, joint_type: slide, joint_axis: [0, 0, 2], joint_range: [-0.1, 0.2], joint_effort_range: [-5, 7], joint_id: 1.0e+300 }
)",
                                             "r.body", {});
  const LinkDescription& base = robot.links.at(0);
  EXPECT_EQ(robot.sensors.imu_link, "base");
  EXPECT_EQ(robot.sensors.imu_position, Eigen::Vector3d(0.1, 0.2, 0.3));
  ASSERT_EQ(base.visuals.size(), 4u);
  EXPECT_EQ(std::get<Box>(base.visuals[0].shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(base.visuals[0].color, Eigen::Vector4f(0.5f, 0.25f, 0, 0.5f));
  EXPECT_EQ(base.visuals[0].pose.translation(), Eigen::Vector3d(0, 0, 0.5));
  EXPECT_TRUE(std::holds_alternative<Sphere>(base.visuals[1].shape));
  // Cylinders lie along y there; turned about x, this one stands.
  EXPECT_LT((base.visuals[2].pose.linear().col(2).cwiseAbs() - Eigen::Vector3d::UnitZ()).norm(),
            1e-12);
  EXPECT_EQ(std::get<MeshShape>(base.visuals[3].shape).mesh.parts.at(0).triangles.size(), 2u);
  ASSERT_EQ(base.collisions.size(), 4u);
  EXPECT_TRUE(std::holds_alternative<Capsule>(base.collisions[1].shape));
  EXPECT_EQ(robot.joints.at(0).axis, Eigen::Vector3d(0, -1, 0));
  EXPECT_EQ(robot.joints.at(0).lower, -0.5);
  EXPECT_EQ(robot.joints.at(0).velocity, 3);
  EXPECT_EQ(robot.joints.at(1).axis, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(robot.joints.at(1).type, JointType::continuous);
  EXPECT_EQ(robot.joints.at(2).upper, 0.2);
  EXPECT_EQ(robot.joints.at(2).effort, 7);
  EXPECT_EQ(robot.joint_order, (std::vector<std::string>{"b", "a", "c"}));
  const std::vector<std::string>& notes = robot.assumptions;
  EXPECT_NE(std::find(notes.begin(), notes.end(),
                      "shapes that Ayumi does not support are left out: Cone of base"),
            notes.end());
}

// The order of the joints follows from their ids. A joint that is held, because it carries no mass,
// has no place in it.
TEST(ChoreonoidBody, JointsThatAreHeldHaveNoPlaceInTheOrder) {
  const test::TemporaryFolder folder;
  const std::string joint = "mass: 1, joint_type: revolute, joint_axis: Y, joint_id: ";
  const std::string file =
      folder
          .write("r.body",
                 "format: ChoreonoidBody\nformat_version: 2.0\nlinks:\n"
                 "  - { name: base, mass: 1, inertia: [1, 0, 0, 0, 1, 0, 0, 0, 1] }\n"
                 "  - { name: a, parent: base, inertia: [1, 0, 0, 0, 1, 0, 0, 0, 1], " +
                     joint +
                     "2 }\n"
                     "  - { name: b, parent: a, inertia: [1, 0, 0, 0, 1, 0, 0, 0, 1], " +
                     joint +
                     "0 }\n"
                     "  - { name: c, parent: b, joint_type: revolute, joint_id: 3 }\n")
          .string();
  const RobotDescription robot = load_robot_description(file);
  EXPECT_EQ(RobotModel(robot).dof_names(), (std::vector<std::string>{"b", "a"}));
  const std::vector<std::string>& notes = robot.assumptions;
  EXPECT_NE(std::find(notes.begin(), notes.end(),
                      "no joint has the joint_id 1, but a joint has the joint_id 3, so the file "
                      "may be incomplete"),
            notes.end());
}

TEST(ChoreonoidBody, WrongBodiesAreRefusedInOneLine) {
  const std::string head = "format: ChoreonoidBody\nformat_version: 1.0\nlinks:\n";
  const auto error = [&](const std::string& text) {
    try {
      parse_robot(text, "r.body", {});
    } catch (const Error& e) {
      const std::string words = e.what();
      EXPECT_TRUE(words.starts_with("r.body")) << words;
      EXPECT_EQ(words.find('\n'), std::string::npos) << words;
      return words;
    }
    return std::string("no error");
  };
  const auto has = [](const std::string& words, const std::string& part) {
    EXPECT_NE(words.find(part), std::string::npos) << words;
  };
  has(error("format: ChoreonoidBody\nformat_version: 9\nlinks:\n - {name: a}\n"), "version 9");
  has(error(head + "  - { name: a, mass: nan }\n"), "r.body:4: 'nan' is not a finite number");
  has(error(head + "  - { name: a, mass: '1,5' }\n"),
      "'1,5' is not a finite number; write a decimal point");
  has(error(head + "  - { name: a, mass: 1, centerOfMass: [0,1, 0,2, 0] }\n"),
      "3 numbers are needed, found 5; if the commas are decimal commas, write decimal points");
  has(error(head + "  - { name: a, mass: 1\n"), "this is not valid YAML");
  has(error("format: ChoreonoidBody\n"), "no list of links");
  has(error("- a\n"), "must be a map");
  has(error("format: Robot\nlinks:\n - {name: a}\n"), "must have format: ChoreonoidBody");
  has(error("format: ChoreonoidBody\nangleUnit: turn\nlinks:\n - {name: a}\n"),
      "angle_unit is 'turn'");
  has(error(head + "  - { name: a, mass: 1, centerOfMass: 2 }\n"), "a list of 3 numbers is needed");
  has(error(head + "  - { name: a, mass: 1, centerOfMass: [1, 2] }\n"),
      "3 numbers are needed, found 2");
  const std::string joint = head + "  - { name: a }\n  - { name: b, parent: a, ";
  has(error(joint + "joint_type: revolute, joint_axis: W }\n"), "the axis 'W' is not one of X");
  has(error(joint + "joint_type: revolute, joint_id: 3 }\n  - { name: c, parent: b, joint_type: "
                    "revolute, joint_id: 3 }\n"),
      "have the same joint_id 3");
  const auto shape = [&](const std::string& geometry) {
    return error(head + "  - { name: a, elements: [ { type: Shape, geometry: " + geometry +
                 " } ] }\n");
  };
  has(shape("{ type: Sphere }"), "link a: the Sphere has no radius");
  has(shape("{ type: Cylinder, radius: 0, height: 1 }"), "the radius must be above 0, but it is 0");
  has(shape("{ type: IndexedFaceSet }"), "needs lists 'coordinate' and 'coordIndex'");
  has(shape("{ type: IndexedFaceSet, coordinate: [0, 0, 0], coordIndex: [0, 7] }"),
      "corner 7 does not exist");
  has(shape("{ type: IndexedFaceSet, coordinate: [0, 0, 0], coordIndex: [0, 0, 0] }"),
      "has no triangle");
  has(shape("Box"), "a geometry must be a map");
  has(error(head + "  - { name: a }\n  - { name: b, parent: a, joint_type: ball }\n"), "'ball'");
  // The file has aliases inside aliases.
  std::string bomb = "format: ChoreonoidBody\na0: &a0 { Shape: {} }\n";
  for (int i = 1; i < 40; ++i)
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) +
            " [ { type: Transform, elements: *a" + std::to_string(i - 1) +
            " }, { type: Transform, elements: *a" + std::to_string(i - 1) + " } ]\n";
  has(error(bomb + "links:\n  - { name: r, elements: *a39 }\n"), "elements; simplify the body");
}

}  // namespace
}  // namespace ayumi
