#include "ayumi/io/robot/robot_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <numbers>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/urdf.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "tests/support/degree.hpp"
#include "tests/support/json.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

using test::TemporaryFolder;

using test::kDegree;
const std::string kRobots = AYUMI_SOURCE_DIR "/robots";

TEST(Hoap1, HasTheFiguresOfItsReadme) {
  const RobotModel model = load_robot("hoap1", {{kRobots}}, {.meshes = true});
  EXPECT_EQ(model.dof_count(), 20);
  EXPECT_NEAR(model.mass(), 6.5, 1e-9);
  EXPECT_EQ(model.dof_names().front(), "r_hip_yaw");
  EXPECT_EQ(model.dof_names().back(), "l_elbow");
  EXPECT_EQ(model.leg(Side::right), (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(model.leg(Side::left), (std::vector<int>{10, 11, 12, 13, 14, 15}));
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(model.dofs()[i].encoder.device, i + 1);
    EXPECT_EQ(std::abs(model.dofs()[i].encoder.counts_per_degree), 209);
  }
  const Dof& knee = model.dofs()[model.find_dof("l_knee")];
  EXPECT_NEAR(knee.upper, 120 * kDegree, 1e-12);
  const ServoDescription& servo = model.limits().servo[model.find_dof("l_knee")];
  EXPECT_NEAR(servo.lag(), 0.0036, 1e-4);
  EXPECT_GE(servo.kp, 2500);  // the measured values are 2500 to 5000 N m/rad
  EXPECT_LE(servo.kp, 5000);
  const ServoDescription& soft = model.limits("hoap1-soft").servo[model.find_dof("l_knee")];
  EXPECT_EQ(soft.kp, 600);
  EXPECT_EQ(soft.lag(), 0.020);
  EXPECT_DOUBLE_EQ(model.limits().servo[model.find_dof("l_elbow")].kp, servo.kp / 2);
  EXPECT_EQ(model.limits().peak_torque[model.find_dof("l_knee")], 4.5);
  EXPECT_EQ(model.limits().peak_torque[model.find_dof("l_hip_pitch")], 3);
  EXPECT_EQ(model.limits("hoap1-strong").speed[0], 25);
  EXPECT_EQ(model.joint_weight()[model.find_dof("r_elbow")], 10);
  EXPECT_TRUE(model.sole(Side::left).center.isApprox(Eigen::Vector2d(0.007, 0)));
}

TEST(Hoap1, StandsAtHomeOverTheMiddleOfItsSoles) {
  const RobotModel model = load_robot("hoap1", {{kRobots}});
  RobotData data(model);
  RobotState state = model.rest_state();
  update_positions(model, state, data);
  anchor_base(model, Side::left, Eigen::Isometry3d::Identity(), state, data);
  EXPECT_TRUE(state.base.attitude.toRotationMatrix().isIdentity(1e-12));  // the trunk is upright
  const Eigen::Isometry3d right = sole_pose(model, data, Side::right);
  EXPECT_TRUE(right.linear().isIdentity(1e-12));
  EXPECT_TRUE(right.translation().isApprox(Eigen::Vector3d(0, -0.078, 0), 1e-12));
  EXPECT_NEAR(data.cog.x(), 0.007, 1e-5);
  EXPECT_NEAR(data.cog.y(), -0.039, 1e-9);
  EXPECT_NEAR(data.cog.z(), 0.245, 1e-5);
}

TEST(Hoap1, IsTheSameByNameFolderAndFile) {
  const RobotDescription named = load_robot_description("hoap1", {{kRobots}});
  EXPECT_EQ(load_robot_description(kRobots + "/hoap1").sha256, named.sha256);
  EXPECT_EQ(load_robot_description(kRobots + "/hoap1/robot.json").sha256, named.sha256);
  EXPECT_EQ(named.sha256, sha256(read_file(kRobots + "/hoap1/robot.urdf") +
                                 read_file(kRobots + "/hoap1/robot.json")));
}

// A folder is recognized as a folder, whatever its name ends with, and also without the slash at
// its end.
TEST(RobotFile, TheNameOfAFolderMayEndLikeThatOfAFile) {
  const std::string sha256 = load_robot_description("hoap1", {{kRobots}}).sha256;
  const TemporaryFolder folder;
  for (const std::string name : {"my.urdf", "robot.json", "my.mjcf", "my.xml"}) {
    for (const std::string file : {"/robot.urdf", "/robot.json"})
      folder.write(name + file, read_file(kRobots + "/hoap1" + file));
    const std::string path = (folder.path() / name).string();
    EXPECT_EQ(load_robot_description(path).sha256, sha256) << name;
    EXPECT_EQ(load_robot_description(path + "/").sha256, sha256) << name;
  }
  // Such a folder does not count as a robot file of the folder that contains it.
  folder.write("nested/robot.urdf", read_file(kRobots + "/hoap1/robot.urdf"));
  folder.write("nested/meshes.xml/notes.txt", "no robot here");
  EXPECT_EQ(load_robot_description((folder.path() / "nested").string()).sha256,
            load_robot_description(kRobots + "/hoap1/robot.urdf").sha256);
  folder.write("empty.urdf/notes.txt", "no robot here");
  try {
    load_robot_description((folder.path() / "empty.urdf").string());
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("holds neither"), std::string::npos) << error.what();
  }
}

// In an earlier version, the robot was read without its sidecar, with servos that nobody had
// stated.
TEST(RobotFile, ASidecarThatIsNoFileIsRefused) {
  const TemporaryFolder folder;
  folder.write("pipe/robot.urdf", read_file(kRobots + "/hoap1/robot.urdf"));
  ASSERT_EQ(::mkfifo((folder.path() / "pipe/robot.json").c_str(), 0600), 0);
  folder.write("link/robot.urdf", read_file(kRobots + "/hoap1/robot.urdf"));
  std::filesystem::create_symlink("nowhere.json", folder.path() / "link/robot.json");
  for (const auto& [name, words] :
       {std::pair("pipe", "robot.json: this is a device or a named pipe"),
        std::pair("link", "robot.json: no such file")})
    try {
      load_robot_description((folder.path() / name).string());
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
}

// Values that are inferred from the bare URDF are close to those of the sidecar, and are reported.
TEST(Hoap1, BareUrdfIsInferred) {
  const RobotModel model = load_robot(kRobots + "/hoap1/robot.urdf");
  const RobotModel full = load_robot("hoap1", {{kRobots}});
  for (const Side side : {Side::left, Side::right}) {
    EXPECT_EQ(model.bodies()[model.sole(side).body].name, full.bodies()[full.sole(side).body].name);
    ASSERT_EQ(model.sole(side).polygon.size(), 4u);
    for (int i = 0; i < 4; ++i)
      EXPECT_LT((model.sole(side).polygon[i] - full.sole(side).polygon[i]).norm(), 1e-4);
  }
  // Full effort, 3 N m, at 0.2 rad is less than the 20 m g z that a leg needs.
  EXPECT_NEAR(model.limits().servo[0].kp / (20 * model.mass() * 9.80665 * 0.25), 1, 0.1);
  EXPECT_GE(model.description().assumptions.size(), 4u);
}

TEST(RobotFile, AnEarlierFolderHidesALaterOne) {
  const TemporaryFolder folder;
  folder.write("hoap1/robot.json", read_file(kRobots + "/hoap1/robot.json"));
  const auto found = find_robots({{folder.path(), kRobots}});
  const auto is_hoap1 = [](const RobotEntry& entry) { return entry.name == "hoap1"; };
  ASSERT_EQ(std::count_if(found.begin(), found.end(), is_hoap1), 1);
  EXPECT_EQ(std::find_if(found.begin(), found.end(), is_hoap1)->sidecar,
            folder.path() / "hoap1/robot.json");
  EXPECT_THROW(load_robot("hoap2", {{kRobots}}), Error);
}

// A working folder may contain a folder of that name with other things in it.
TEST(RobotFile, AFolderWithoutARobotHidesNone) {
  const TemporaryFolder folder;
  folder.write("hoap1/notes.txt", "no robot here");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  EXPECT_EQ(load_robot("hoap1", {{kRobots}}).name(), "hoap1");
  EXPECT_THROW(load_robot("hoap1", {}), Error);
  std::filesystem::current_path(before);
}

TEST(Urdf, TurnsInertiaIntoLinkAxesAndKeepsOrder) {
  const RobotDescription robot = parse_urdf(
      "<robot name=\"r\"><link name=\"z\"><inertial><origin xyz=\"1 2 3\" "
      "rpy=\"0 0 1.5707963267948966\"/><mass value=\"2\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
      "iyy=\"2\" iyz=\"0\" izz=\"2.5\"/></inertial></link><link name=\"a\"/>"
      "<joint name=\"j\" type=\"fixed\"><parent link=\"z\"/><child link=\"a\"/></joint></robot>",
      "r.urdf");
  EXPECT_EQ(robot.links[0].name, "z");
  EXPECT_TRUE(robot.links[0].inertia.com.isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_TRUE(robot.links[0].inertia.about_com.diagonal().isApprox(Eigen::Vector3d(2, 1, 2.5)));
  EXPECT_FALSE(robot.links[1].has_inertial);
}

TEST(Urdf, AColourMayBeNamedBeforeTheVisualThatDefinesIt) {
  const auto visual = [](const std::string& material) {
    return "<visual><geometry><sphere radius=\"1\"/></geometry>" + material + "</visual>";
  };
  const RobotDescription robot =
      parse_urdf("<robot name=\"r\"><link name=\"a\">" + visual("<material name=\"red\"/>") +
                     visual("<material name=\"red\"><color rgba=\"1 0 0 1\"/></material>") +
                     visual("<material name=\"red\"><color rgba=\"0 1 0 1\"/></material>") +
                     visual("<material name=\"none\"/>") + "</link></robot>",
                 "r.urdf");
  const auto& visuals = robot.links[0].visuals;
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(visuals[i].has_color) << i;
    EXPECT_EQ(visuals[i].color, Eigen::Vector4f(1, 0, 0, 1)) << i << ": the first definition holds";
  }
  EXPECT_FALSE(visuals[3].has_color);
}

TEST(Urdf, UnstatedLimitsAreUnlimited) {
  const std::string inertial =
      "<inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" "
      "izz=\"1\"/></inertial>";
  const RobotModel model(
      parse_urdf("<robot name=\"r\"><link name=\"a\">" + inertial + "</link><link name=\"b\">" +
                     inertial + "</link><link name=\"c\">" + inertial +
                     "</link><joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child "
                     "link=\"b\"/></joint>"
                     "<joint name=\"k\" type=\"revolute\"><parent link=\"b\"/><child link=\"c\"/>"
                     "<limit lower=\"-0.5\" upper=\"1\"/></joint></robot>",
                 "r.urdf"));
  EXPECT_FALSE(model.dofs()[0].limited);
  EXPECT_TRUE(model.dofs()[1].limited);
  EXPECT_EQ(model.dofs()[1].lower, -0.5);
  EXPECT_TRUE(std::isinf(model.limits().peak_torque[1]));
}

TEST(Sidecar, LocksJoints) {
  const TemporaryFolder folder;
  folder.write("robot.urdf", read_file(kRobots + "/hoap1/robot.urdf"));
  std::filesystem::create_directory_symlink(kRobots + "/hoap1/meshes", folder.path() / "meshes");
  folder.write("robot.json", R"({"format": "ayumi.robot/1", "urdf": "robot.urdf",
                                 "locked_joints": ["l_elbow", "r_elbow"]})");
  const RobotModel model = load_robot(folder.path().string());
  EXPECT_EQ(model.dof_count(), 18);
  EXPECT_NEAR(model.mass(), 6.5, 1e-9);
}

TEST(Sidecar, StatesLoadCellsAndTheLatencyOfEachSensor) {
  const test::JsonSchema schema(
      test::json_of(read_file(AYUMI_SOURCE_DIR "/docs/schemas/robot-1.schema.json"), true));
  const TemporaryFolder folder;
  folder.write("robot.urdf", read_file(kRobots + "/hoap1/robot.urdf"));
  std::filesystem::create_directory_symlink(kRobots + "/hoap1/meshes", folder.path() / "meshes");
  nlohmann::json sidecar = test::json_of(read_file(kRobots + "/hoap1/robot.json"), true);
  const auto load = [&](const std::string& sensors) {
    sidecar["sensors"] = test::json_of(sensors);
    EXPECT_TRUE(schema.accepts(sidecar)) << sensors;
    folder.write("robot.json", sidecar.dump());
    return load_robot(folder.path().string());
  };
  const RobotModel model =
      load(R"({"latency": 0.003, "encoder_latency": 0.001, "force_latency": 0.004,
               "force_readings": 8,
               "force_cells": {"left": [{"gain": 1.1}, {"dead_zone": 0.5}, {"hysteresis": 2},
                                        {"saturation": 80}],
                               "right": [{"gain": 0.9}]}})");
  const SensorDescription& s = model.description().sensors;
  EXPECT_EQ(s.encoder_latency, 0.001);
  EXPECT_EQ(s.imu_latency, std::nullopt);
  EXPECT_EQ(s.force_latency, 0.004);
  EXPECT_NEAR(s.oldest(0.001), 0.0075, 1e-15);
  EXPECT_EQ(s.force_readings, 8);
  const std::vector<CellResponse>& left = s.force_cells.at("left");
  ASSERT_EQ(left.size(), 4u);
  EXPECT_EQ(left[0], (CellResponse{.gain = 1.1}));
  EXPECT_EQ(left[1], (CellResponse{.dead_zone = 0.5}));
  EXPECT_EQ(left[2], (CellResponse{.hysteresis = 2}));
  EXPECT_EQ(left[3], (CellResponse{.saturation = 80}));
  EXPECT_EQ(s.force_cells.at("right"), (std::vector<CellResponse>{{.gain = 0.9}}));

  try {
    load(R"({"force_cells": {"left": [{}, {}, {}]}})");
    FAIL() << "three cells on four corners";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find(
                  "/sensors/force_cells/left: there are 3 load cells, but the sole has 4"),
              std::string::npos)
        << e.what();
  }
  for (const char* bad :
       {R"({"force_readings": 0})", R"({"force_cells": {"middle": [{}]}})",
        R"({"force_cells": {"left": [{"gain": -1}]}})", R"({"imu_latency": 2})"}) {
    sidecar["sensors"] = test::json_of(bad);
    EXPECT_FALSE(schema.accepts(sidecar)) << bad;
    folder.write("robot.json", sidecar.dump());
    EXPECT_THROW(load_robot(folder.path().string()), Error) << bad;
  }
}

// The published schema accepts the bundled sidecar, and refuses what the reader refuses.
TEST(Sidecar, FitsItsSchema) {
  const auto json = [](const std::string& file) { return test::json_of(read_file(file), true); };
  const test::JsonSchema schema(json(AYUMI_SOURCE_DIR "/docs/schemas/robot-1.schema.json"));
  const nlohmann::json good = json(kRobots + "/hoap1/robot.json");
  EXPECT_TRUE(schema.accepts(good));
  for (const char* patch :
       {R"({"sole": {}})", R"({"format": "ayumi.robot/2"})", R"({"urdf": 3})",
        R"({"soles": {"left": {"link": "l_foot"}}})", R"({"servos": [{"kp": 300}]})",
        R"({"servos": [{"joints": ["*"], "kp": -1}]})",
        R"({"encoders": {"r_knee": {"device": 0}}})",
        R"({"control": {"joint_weight": [{"joints": ["*"], "weight": 0}]}})"}) {
    nlohmann::json bad = good;
    bad.update(test::json_of(patch));
    EXPECT_FALSE(schema.accepts(bad)) << patch;
    const TemporaryFolder folder;
    folder.write("robot.urdf", read_file(kRobots + "/hoap1/robot.urdf"));
    std::filesystem::create_directory_symlink(kRobots + "/hoap1/meshes", folder.path() / "meshes");
    folder.write("robot.json", bad.dump());
    EXPECT_THROW(load_robot(folder.path().string()), Error) << patch;
  }
}

}  // namespace
}  // namespace ayumi
