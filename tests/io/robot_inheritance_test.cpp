// Robot files that only contain the differences from another one.

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "tests/support/json.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

using test::TemporaryFolder;

const std::string kBundled = AYUMI_SOURCE_DIR "/robots";

std::string over_base(const std::string& base, const std::string& more = "") {
  return "{ \"format\": \"ayumi.robot/1\", \"base\": \"" + base + "\"" + more + " }";
}

RobotDescription load_unit(const std::filesystem::path& file) {
  return load_robot_description(file.string(), {.folders = {kBundled}});
}

std::string unit_error(const std::filesystem::path& file) {
  try {
    const RobotModel model(load_unit(file));
  } catch (const Error& error) {
    std::string message = error.what();
    const std::string prefix = file.parent_path().string() + "/";
    for (size_t at; (at = message.find(prefix)) != std::string::npos;)
      message.erase(at, prefix.size());
    return message;
  }
  return "no error";
}

TEST(RobotInheritance, WithoutADifferenceTheRobotIsItsBase) {
  const TemporaryFolder folder;
  const RobotModel base = load_robot(kBundled + "/hoap1");
  for (const std::string& name : {std::string("hoap1"), kBundled + "/hoap1/robot.json"}) {
    const RobotModel unit(load_unit(folder.write("unit.json", over_base(name))));
    EXPECT_EQ(unit.dof_names(), base.dof_names());
    EXPECT_EQ(unit.posture(), base.posture());
    EXPECT_EQ(unit.mass(), base.mass());
    EXPECT_EQ(unit.limits().peak_torque, base.limits().peak_torque);
    EXPECT_EQ(unit.limits().servo[3].kp, base.limits().servo[3].kp);
    EXPECT_EQ(unit.description().control.dtad, base.description().control.dtad);
    EXPECT_NE(unit.description().sha256, base.description().sha256);
  }
}

TEST(RobotInheritance, MergesObjectsByKeyAndAppendsGroups) {
  const TemporaryFolder folder;
  const RobotModel base = load_robot(kBundled + "/hoap1");
  const RobotModel unit(load_unit(folder.write("unit.json", over_base("hoap1", R"(,
    "name": "unit 7",
    "servos": [{"joints": ["*_knee"], "kp": 4000, "kd": 9}],
    "encoders": {"l_knee": {"counts_per_degree": -210}},
    "postures_deg": {"home": {"l_elbow": -30}},
    "control": {"dtad": {"ks": 1.5}, "joint_weight": [{"joints": ["l_elbow"], "weight": 3}]},
    "profiles": [{"name": "hoap1-strong", "limits": [{"joints": ["*_knee"], "speed": 20}]},
                 {"name": "weak", "limits": [{"joints": ["*"], "peak_torque": 1}]}])"))));
  const int knee = base.find_dof("l_knee"), hip = base.find_dof("l_hip_roll");
  EXPECT_EQ(unit.name(), "unit 7");
  EXPECT_EQ(unit.limits().servo[knee].kp, 4000);
  EXPECT_EQ(unit.limits().servo[knee].kd, 9);
  EXPECT_EQ(unit.limits().servo[knee].rotor_inertia, base.limits().servo[knee].rotor_inertia);
  EXPECT_EQ(unit.limits().servo[hip].kp, base.limits().servo[hip].kp);
  EXPECT_EQ(unit.dofs()[knee].encoder.counts_per_degree, -210);
  EXPECT_EQ(unit.dofs()[knee].encoder.device, base.dofs()[knee].encoder.device);
  EXPECT_NEAR(unit.posture()[base.find_dof("l_elbow")], -30 * EIGEN_PI / 180, 1e-12);
  EXPECT_EQ(unit.posture()[knee], base.posture()[knee]);
  EXPECT_EQ(unit.description().control.dtad.at("ks"), 1.5);
  EXPECT_EQ(unit.description().control.dtad.at("q"), base.description().control.dtad.at("q"));
  EXPECT_EQ(unit.joint_weight()[base.find_dof("l_elbow")], 3);
  EXPECT_EQ(unit.joint_weight()[base.find_dof("r_elbow")], 10);
  EXPECT_EQ(unit.profile_names(), (std::vector<std::string>{"hoap1", "hoap1-soft", "hoap1-strong",
                                                            "hoap1-strong-soft", "weak"}));
  EXPECT_EQ(unit.limits("hoap1-strong").speed[knee], 20);
  EXPECT_EQ(unit.limits("hoap1-strong").speed[hip], 25);
  EXPECT_EQ(unit.limits("hoap1-strong").peak_torque[knee], 12);
}

TEST(RobotInheritance, AnglesMayHaveAnotherUnitThanInTheBase) {
  const TemporaryFolder folder;
  folder.write("base.json", over_base("hoap1", R"(, "soft_limit_margin_deg": 2)"));
  const RobotModel base(load_unit(folder.path() / "base.json"));
  const RobotModel unit(
      load_unit(folder.write("unit.json", over_base("base.json", R"(, "soft_limit_margin": 0.01,
                        "postures": {"home": {"l_knee": 0.5}, "other": {"l_knee": 1}})"))));
  const int knee = base.find_dof("l_knee");
  Eigen::VectorXd expected = base.posture();
  expected[knee] = 0.5;
  EXPECT_LT((unit.posture() - expected).norm(), 1e-15);
  EXPECT_EQ(unit.posture("other")[knee], 1);
  EXPECT_TRUE(unit.has_posture("zero"));
  EXPECT_EQ(unit.description().soft_limit_margin, 0.01);
}

// A chain of three files in three folders: the URDF is found beside the first of them.
TEST(RobotInheritance, PathsAreRelativeToTheFileThatNamesThem) {
  const TemporaryFolder folder;
  folder.write("type/base.json", R"({"format": "ayumi.robot/1", "urdf": ")" AYUMI_SOURCE_DIR
                                 R"(/examples/biped/biped.urdf", "name": "type"})");
  folder.write("type/strong/robot.json",
               over_base("../base.json", R"(, "servos": [{"joints": ["*"], "kp": 700, "kd": 9}])"));
  const auto unit = folder.write("unit.json", over_base("type/strong", R"(, "name": "unit")"));
  const RobotDescription robot = load_unit(unit);
  EXPECT_EQ(robot.name, "unit");
  EXPECT_EQ(robot.servos.at("l_knee").kp, 700);
  folder.write("bare.json", over_base(AYUMI_SOURCE_DIR "/examples/biped/biped.urdf"));
  EXPECT_EQ(load_unit(folder.path() / "bare.json").joints.size(), robot.joints.size());
}

TEST(RobotInheritance, TheFingerprintCoversEveryFile) {
  const TemporaryFolder folder;
  const auto unit = folder.write("unit.json", over_base("middle.json"));
  std::vector<std::string> seen;
  for (const char* more : {"", R"(, "name": "other")", R"(, "name": "another")"}) {
    folder.write("middle.json", over_base("hoap1", more));
    seen.push_back(load_unit(unit).sha256);
  }
  EXPECT_NE(seen[0], seen[1]);
  EXPECT_NE(seen[1], seen[2]);
}

TEST(RobotInheritance, MessagesNameTheFileThatIsWrong) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& text) {
    return unit_error(folder.write("unit.json", text));
  };
  EXPECT_EQ(error(over_base("hoap1", R"(, "servos": [{"joints": ["*"]}, {"joints": ["*_nee"]}])")),
            "unit.json: /servos/1/joints/0: no moving joint of the robot matches '*_nee'; did you "
            "mean 'r_knee'?");
  EXPECT_EQ(error(over_base("hoap1", R"(, "servo": [])")),
            "unit.json: /servo: unknown key; did you mean 'servos'?");
  EXPECT_EQ(error(over_base("hoap1", R"(, "encoders": {"l_knee": {"device": 0.5}})")),
            "unit.json: /encoders/l_knee/device: expected a whole number, found 0.5");
  EXPECT_EQ(error(over_base("hoap1", R"(, "profiles": [{"name": "hoap1", "limits": 3}])")),
            "unit.json: /profiles/0/limits: expected an array, found the number 3");
  folder.write("base.json", over_base("hoap1", R"(, "servo_period": "fast")"));
  EXPECT_EQ(error(over_base("base.json", R"(, "name": "unit")")),
            "base.json: /servo_period: expected a number, found a string");
}

TEST(RobotInheritance, AnErrorInAPostureNamesTheFileWithTheAngle) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& base, const std::string& unit) {
    folder.write("base.json", over_base("hoap1", R"(, "postures_deg": {"bow": )" + base + "}"));
    return unit_error(folder.write("unit.json", over_base("base.json", unit)));
  };
  const std::string both = R"({"l_knee": 20, "r_knee": 40})";
  const std::string limits = R"(, "position_limits_deg": {"r_knee": [0, 30]})";
  const std::string of_base =
      "base.json: /postures_deg/bow/r_knee: the joint 'r_knee' is at 40 deg, above its limit of 30 "
      "deg";
  EXPECT_EQ(error(both, limits), of_base);
  EXPECT_EQ(error(both, limits + R"(, "postures_deg": {"bow": {"l_knee": 10}})"), of_base);
  // The angles of the base are converted, but its file still states degrees.
  EXPECT_EQ(error(both, limits + R"(, "postures": {"bow": {"l_knee": 0.1}})"), of_base);
  EXPECT_EQ(error(both, limits + R"(, "postures_deg": {"bow": {"r_knee": 35}})"),
            "unit.json: /postures_deg/bow/r_knee: the joint 'r_knee' is at 35 deg, above its limit "
            "of 30 deg");
  EXPECT_EQ(error(R"({"l_kne": 20})", R"(, "postures": {"bow": {"l_knee": 0.1}})"),
            "base.json: /postures_deg/bow/l_kne: 'l_kne' is not a moving joint of the robot; did "
            "you mean 'l_knee'?");
  EXPECT_EQ(error(both, R"(, "postures": {"bow": {"r_kne": 0.1}})"),
            "unit.json: /postures/bow/r_kne: 'r_kne' is not a moving joint of the robot; did you "
            "mean 'r_knee'?");
  // The three files state degrees, radians and degrees.
  folder.write("base.json", over_base("hoap1", R"(, "postures_deg": {"bow": )" + both + "}"));
  folder.write("middle.json",
               over_base("base.json", R"(, "postures": {"bow": {"r_knee": 0.6, "l_knee": 0.3}})"));
  EXPECT_EQ(unit_error(folder.write(
                "unit.json",
                over_base("middle.json", limits + R"(, "postures_deg": {"bow": {"l_knee": 5}})"))),
            "middle.json: /postures/bow/r_knee: the joint 'r_knee' is at 34.38 deg, above its "
            "limit of 30 deg");
}

TEST(RobotInheritance, CirclesAndMissingBasesAreRefused) {
  const TemporaryFolder folder;
  const auto unit = folder.write("unit.json", over_base("a.json"));
  EXPECT_EQ(unit_error(unit), "unit.json: /base: robot 'a.json': no such file");
  folder.write("a.json", over_base("b/robot.json"));
  folder.write("b/robot.json", over_base("../unit.json"));
  EXPECT_EQ(unit_error(unit),
            "b/robot.json: /base: the bases form a circle: unit.json, a.json, b/robot.json. Each "
            "of these files names the next file as its base, and the last file names the "
            "first one. Remove \"base\" from one of these files");
  folder.write("unit.json", over_base("unit.json"));
  EXPECT_EQ(unit_error(unit),
            "unit.json: /base: 'unit.json' is this file itself; name another robot");
  folder.write("unit.json", over_base("hoap2"));
  EXPECT_EQ(unit_error(unit),
            "unit.json: /base: robot 'hoap2': no such file, folder or bundled robot; known: hoap1, "
            "humanoid30; did you mean 'hoap1'?");
  folder.write("unit.json", over_base(""));
  EXPECT_EQ(unit_error(unit), "unit.json: /base: the name or path of another robot is needed");
  folder.write("unit.json", R"({"format": "ayumi.robot/1", "base": ["hoap1"]})");
  EXPECT_EQ(unit_error(unit), "unit.json: /base: expected a string, found an array of length 1");
}

TEST(RobotInheritance, FitsTheSchema) {
  const test::JsonSchema schema(
      test::json_of(read_file(AYUMI_SOURCE_DIR "/docs/schemas/robot-1.schema.json"), true));
  EXPECT_TRUE(schema.accepts(test::json_of(over_base("hoap1"))));
  EXPECT_FALSE(schema.accepts(test::json_of(R"({"format": "ayumi.robot/1"})")));
}

}  // namespace
}  // namespace ayumi
