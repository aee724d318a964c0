// Servos of a sidecar and parameter files of BAM: which are read, and which are refused with which
// message.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

using test::TemporaryFolder;

constexpr double kDegrees = std::numbers::pi / 180;

/// A sidecar based on the small biped.
std::string servo_sidecar(const std::string& servos, const std::string& more = "") {
  return R"({"format": "ayumi.robot/1", "urdf": ")" AYUMI_SOURCE_DIR
         R"(/examples/biped/biped.urdf", "servos": [{"joints": ["*"], "kp": 100, "kd": 2}, )" +
         servos + "]" + more + "}";
}

RobotModel robot_of(const TemporaryFolder& folder, const std::string& text) {
  return load_robot(folder.write("robot.json", text).string());
}

ServoDescription knee(const RobotModel& robot, const std::string& profile = "") {
  return robot.limits(profile).servo[static_cast<size_t>(robot.find_dof("l_knee"))];
}
ServoDescription knee_of(const std::string& keys) {
  const TemporaryFolder folder;
  return knee(robot_of(folder, servo_sidecar("{\"joints\": [\"*_knee\"], " + keys + "}")));
}

/// The message without the path of the folder.
std::string error_of(const TemporaryFolder& folder, const std::string& text) {
  try {
    robot_of(folder, text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_file) << error.what();
    std::string message = error.what();
    const std::string prefix = folder.path().string() + "/";
    for (size_t at; (at = message.find(prefix)) != std::string::npos;)
      message.erase(at, prefix.size());
    return message;
  }
  return "no error";
}
std::string group_error(const std::string& keys) {
  const TemporaryFolder folder;
  return error_of(folder, servo_sidecar("{\"joints\": [\"*_knee\"], " + keys + "}"));
}

/// Numbers as a fit writes them for a model of BAM, including numbers that the model does not use.
nlohmann::json bam_numbers(const std::string& model) {
  return {{"model", model},
          {"actuator", "example"},
          {"kt", 1.6},
          {"R", 2.1},
          {"armature", 0.012},
          {"q_offset", 0.05},
          {"command_delay", 0.006},
          {"friction_base", 0.031},
          {"friction_viscous", 0.072},
          {"friction_stribeck", 0.043},
          {"dtheta_stribeck", 0.24},
          {"alpha", 1.35},
          {"load_friction_base", 0.081},
          {"load_friction_stribeck", 0.022},
          {"load_friction_motor", 0.013},
          {"load_friction_external", 0.114},
          {"load_friction_motor_stribeck", 0.005},
          {"load_friction_external_stribeck", 0.016},
          {"load_friction_motor_quad", 0.0017},
          {"load_friction_external_quad", 0.0028}};
}
const std::string kBamGroup =
    R"({"joints": ["*_knee"], "bam": "motor.json", "motor": {"voltage": 7.4, "gain": 12}})";

TEST(ServoReader, ReadsEveryKeyInItsUnit) {
  const ServoDescription servo = knee_of(R"("rotor_inertia": 0.01, "viscous": 0.1, "coulomb": 0.2,
      "delay": 0.0037, "speed_command_limit": 5, "stribeck_torque": 0.3, "stribeck_rate": 0.4,
      "stribeck_exponent": 1.5, "backlash": 0.01, "gear_stiffness": 900, "gear_damping": 3,
      "dead_band": 0.002, "offset": -0.03, "comment": "measured", "load_friction": {
        "motor": 0.01, "external": 0.02, "motor_stribeck": 0.03, "external_stribeck": 0.04,
        "motor_quadratic": 0.05, "external_quadratic": 0.06},
      "motor": {"torque_constant": 1.5, "resistance": 3, "voltage": 12})");
  ServoDescription expected{100, 2, 0.01, 0.1, 0.2, 0.0037, 5, 0.3, 0.4, 1.5};
  expected.load = {0.01, 0.02, 0.03, 0.04, 0.05, 0.06};
  expected.backlash = 0.01;
  expected.gear_stiffness = 900;
  expected.gear_damping = 3;
  expected.stall_torque = 1.5 * 12 / 3;
  expected.back_emf = 1.5 * 1.5 / 3;
  expected.dead_band = 0.002;
  expected.offset = -0.03;
  EXPECT_EQ(servo, expected);
  const ServoDescription degrees =
      knee_of(R"("backlash_deg": 0.5, "dead_band_deg": 0.1, "offset_deg": -2)");
  EXPECT_NEAR(degrees.backlash, 0.5 * kDegrees, 1e-15);
  EXPECT_NEAR(degrees.dead_band, 0.1 * kDegrees, 1e-15);
  EXPECT_NEAR(degrees.offset, -2 * kDegrees, 1e-15);
  const ServoDescription loop = knee_of(R"("position_gain": 40, "speed_gain": 1.5)");
  EXPECT_EQ(loop.kp, 60);
  EXPECT_EQ(loop.kd, 1.5);
  EXPECT_NEAR(loop.lag(), 1.0 / 40, 1e-15);
  const ServoDescription gain =
      knee_of(R"("motor": {"torque_constant": 1.5, "resistance": 3, "voltage": 12, "gain": 20})");
  EXPECT_EQ(gain.kp, 1.5 * 20 / 3);
  EXPECT_EQ(gain.kd, 1.5 * 1.5 / 3);
  const TemporaryFolder folder;
  EXPECT_TRUE(knee(robot_of(folder, servo_sidecar(R"({"joints": ["*_knee"], "quantized": true})",
                                                  R"(, "encoders": {
      "l_knee": {"device": 1, "counts_per_degree": 20},
      "r_knee": {"device": 2, "counts_per_degree": 20}})")))
                  .quantized);
}

TEST(ServoReader, ServosOfAProfileGoOverThoseOfTheRobot) {
  const TemporaryFolder folder;
  const RobotModel robot =
      robot_of(folder, servo_sidecar(R"({"joints": ["*_knee"], "delay": 0.004})", R"(, "profiles": [
      {"name": "plain", "limits": []},
      {"name": "soft", "limits": [], "servos": [{"joints": ["*_knee"], "kp": 50}]}])"));
  EXPECT_EQ(knee(robot).kp, 100);
  EXPECT_EQ(knee(robot, "plain"), knee(robot));
  EXPECT_EQ(knee(robot, "soft").kp, 50);
  EXPECT_EQ(knee(robot, "soft").delay, 0.004);
  EXPECT_EQ(robot.limits("soft").servo[0], robot.limits().servo[0]);
}

class BamFile : public testing::TestWithParam<int> {};

TEST_P(BamFile, GivesWhatItsModelHas) {
  const int m = GetParam();
  const TemporaryFolder folder;
  folder.write("motor.json", bam_numbers("m" + std::to_string(m)).dump());
  const RobotModel robot = robot_of(folder, servo_sidecar(kBamGroup));
  ServoDescription expected{.kp = 1.6 * 12 / 2.1, .kd = 1.6 * 1.6 / 2.1};
  expected.rotor_inertia = 0.012;
  expected.viscous = 0.072;
  expected.coulomb = 0.031;
  expected.delay = 0.006;
  expected.stall_torque = 1.6 * 7.4 / 2.1;
  expected.back_emf = 1.6 * 1.6 / 2.1;
  if (m == 2 || m >= 4) {
    expected.stribeck_torque = 0.043;
    expected.stribeck_rate = 0.24;
    expected.stribeck_exponent = 1.35;
  }
  if (m == 3 || m == 4) expected.load.motor = expected.load.external = 0.081;
  if (m == 4) expected.load.motor_stribeck = expected.load.external_stribeck = 0.022;
  if (m >= 5) expected.load = {0.013, 0.114, 0.005, 0.016};
  if (m == 6) {
    expected.load.motor_quadratic = 0.0017;
    expected.load.external_quadratic = 0.0028;
  }
  EXPECT_EQ(knee(robot), expected);
  // The file is part of the robot: another number gives another fingerprint.
  nlohmann::json other = bam_numbers("m" + std::to_string(m));
  other["kt"] = 1.7;
  folder.write("motor.json", other.dump());
  EXPECT_NE(robot_of(folder, servo_sidecar(kBamGroup)).description().sha256,
            robot.description().sha256);
}

TEST_P(BamFile, NamesTheNumberThatIsMissing) {
  const int m = GetParam();
  const TemporaryFolder folder;
  std::vector<std::string> needed = {"kt", "R", "armature", "friction_base", "friction_viscous"};
  const auto need = [&](std::initializer_list<const char*> keys) {
    needed.insert(needed.end(), keys.begin(), keys.end());
  };
  if (m == 2 || m >= 4) need({"friction_stribeck", "dtheta_stribeck", "alpha"});
  if (m == 3 || m == 4) need({"load_friction_base"});
  if (m == 4) need({"load_friction_stribeck"});
  if (m >= 5)
    need({"load_friction_motor", "load_friction_external", "load_friction_motor_stribeck",
          "load_friction_external_stribeck"});
  if (m == 6) need({"load_friction_motor_quad", "load_friction_external_quad"});
  for (const std::string& key : needed) {
    nlohmann::json numbers = bam_numbers("m" + std::to_string(m));
    numbers.erase(key);
    folder.write("motor.json", numbers.dump());
    const std::string message = error_of(folder, servo_sidecar(kBamGroup));
    EXPECT_TRUE(message.starts_with("motor.json: ")) << message;
    EXPECT_NE(message.find("'" + key + "'"), std::string::npos) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(Models, BamFile, testing::Range(1, 7));

TEST(ServoReader, AKeyBesideABamFileGoesOverIt) {
  const TemporaryFolder folder;
  folder.write("motor.json", bam_numbers("m1").dump());
  const ServoDescription servo = knee(robot_of(
      folder, servo_sidecar(R"({"joints": ["*_knee"], "bam": "motor.json", "delay": 0.01, "kp": 30,
                          "kd": 1, "motor": {"voltage": 6}})")));
  EXPECT_EQ(servo.delay, 0.01);
  EXPECT_EQ(servo.kp, 30);
  EXPECT_EQ(servo.kd, 1);
  EXPECT_EQ(servo.coulomb, 0.031);
  EXPECT_EQ(servo.stall_torque, 1.6 * 6 / 2.1);
}

// Some files of BAM have numbers of one make of servos, such as the bound of a current. They are
// named, so that nobody takes the simulated servo for the complete one.
TEST(ServoReader, NamesTheNumbersOfABamFileThatItDoesNotUse) {
  const TemporaryFolder folder;
  const auto assumed = [&] {
    const RobotModel robot = robot_of(folder, servo_sidecar(kBamGroup));
    const std::vector<std::string>& lines = robot.description().assumptions;
    return std::count_if(lines.begin(), lines.end(), [](const std::string& line) {
      return line.starts_with("motor.json: current_limit, max_velocity of this servo have");
    });
  };
  nlohmann::json numbers = bam_numbers("m5");
  folder.write("motor.json", numbers.dump());
  EXPECT_EQ(assumed(), 0);
  numbers["current_limit"] = 1.37;
  numbers["max_velocity"] = 5.1;
  folder.write("motor.json", numbers.dump());
  EXPECT_EQ(assumed(), 1);
}

// The base is in another folder than the unit, and each has parameter files of its own beside it.
TEST(ServoReader, ABamFileStandsBesideTheFileThatNamesIt) {
  const TemporaryFolder folder;
  folder.write("type/motor.json", bam_numbers("m1").dump());
  nlohmann::json own = bam_numbers("m1");
  own["armature"] = 0.02;
  folder.write("motor.json", own.dump());
  folder.write(
      "type/robot.json",
      servo_sidecar(kBamGroup, R"(, "profiles": [{"name": "a", "limits": [], "servos": [)" +
                                   kBamGroup + "]}]"));
  const auto unit = [&](const std::string& more) {
    return robot_of(folder, R"({"format": "ayumi.robot/1", "base": "type")" + more + "}");
  };
  EXPECT_EQ(knee(unit("")).rotor_inertia, 0.012);
  EXPECT_EQ(knee(unit(""), "a").rotor_inertia, 0.012);
  EXPECT_EQ(
      unit(", \"servos\": [" + kBamGroup + "]").description().servos.at("l_knee").rotor_inertia,
      0.02);
  EXPECT_EQ(knee(unit(R"(, "servos": [{"joints": ["*_knee"], "offset": 0.01}])")).rotor_inertia,
            0.012);
  std::filesystem::remove(folder.path() / "type/motor.json");
  EXPECT_EQ(error_of(folder, R"({"format": "ayumi.robot/1", "base": "type"})"),
            "type/robot.json: /servos/1/bam: there is no file type/motor.json; state the path "
            "relative to the folder of this sidecar");
}

// The offset of an encoder belongs to the unit. Profiles with servos of their own inherit it, and
// none may have another one.
TEST(ServoReader, TheOffsetOfAnEncoderIsTheSameInAllProfiles) {
  const TemporaryFolder folder;
  const auto unit = [](const std::string& servos, const std::string& profile) {
    return servo_sidecar(servos, R"(, "profiles": [{"name": "a", "limits": []},
        {"name": "b", "limits": [], "servos": [)" +
                                     profile + "]}]");
  };
  const std::string offset = R"({"joints": ["l_knee"], "offset_deg": 0.4})",
                    other = R"({"joints": ["l_knee"], "offset_deg": 0.5})",
                    gain = R"({"joints": ["*"], "kp": 50})";
  for (const std::string& same : {gain, gain + ", " + offset}) {
    const RobotModel model = robot_of(folder, unit(gain + ", " + offset, same));
    for (const char* profile : {"a", "b"})
      EXPECT_DOUBLE_EQ(knee(model, profile).offset, 0.4 * EIGEN_PI / 180);
  }
  EXPECT_EQ(
      error_of(folder, unit(gain + ", " + offset, other)),
      "robot.json: /profiles: the encoder of l_knee has an offset of 0.5 deg in the profile "
      "'b', but an offset of 0.4 deg in 'servos'. An offset belongs to the robot and not to a "
      "profile, so state it once, in 'servos'");
  EXPECT_NE(error_of(folder, unit(gain, other)).find("but an offset of 0 deg in 'servos'"),
            std::string::npos);
  // A robot whose profiles alone state servos: the offset of `servos` would be lost.
  EXPECT_EQ(error_of(folder, R"({"format": "ayumi.robot/1", "urdf": ")" AYUMI_SOURCE_DIR
                             R"(/examples/biped/biped.urdf", "servos": [)" +
                                 offset + "]}"),
            "robot.json: /servos: the groups state an offset of l_knee, but no servo of this "
            "joint; state its kp, too");
}

TEST(ServoReader, SaysWhatAServoCannotBe) {
  const std::string at = "robot.json: /servos/1";
  EXPECT_EQ(group_error(R"("kp": -1)"),
            at + "/kp: -1 N m/rad is too small; the smallest allowed value is 0 N m/rad");
  EXPECT_EQ(group_error(R"("kd": 1e9)"),
            at + "/kd: 1e+09 N m s/rad is too large; the largest allowed value is 1e+06 N m s/rad");
  EXPECT_EQ(group_error(R"("delay": 1)"),
            at + "/delay: 1 s is too large; the largest allowed value is 0.1 s; state it in "
                 "seconds: 3.7 ms is 0.0037");
  EXPECT_EQ(group_error(R"("backlash": 1)"),
            at + "/backlash: 1 rad is too large; the largest allowed value is 0.2 rad; for "
                 "degrees, use the key that ends in _deg");
  EXPECT_EQ(group_error(R"("backlash_deg": 57.3)"),
            at + "/backlash_deg: 57.3 deg is too large; the largest allowed value is 11.46 deg");
  EXPECT_EQ(group_error(R"("offset": -2)"),
            at + "/offset: -2 rad is too small; the smallest allowed value is -0.5 rad; for "
                 "degrees, use the key that ends in _deg. For a larger offset, mount the horn in "
                 "another position");
  EXPECT_EQ(group_error(R"("stribeck_exponent": 0)"),
            at + "/stribeck_exponent: 0 is too small; the smallest allowed value is 0.1");
  EXPECT_EQ(group_error(R"("load_friction": {"motor": 2})"),
            at + "/load_friction/motor: 2 is too large; the largest allowed value is 1");
  for (const char* key : {"kp", "kd", "rotor_inertia", "viscous", "coulomb", "delay",
                          "speed_command_limit", "stribeck_torque", "stribeck_rate", "backlash",
                          "gear_stiffness", "gear_damping", "dead_band", "dead_band_deg"}) {
    const std::string text = std::string("\"") + key + "\": ";
    EXPECT_NE(group_error(text + "-0.001").find(" is too small"), std::string::npos) << key;
    EXPECT_NE(group_error(text + "1e12").find(" is too large"), std::string::npos) << key;
    EXPECT_NE(group_error(text + "\"x\"").find("expected a number"), std::string::npos) << key;
  }
}

TEST(ServoReader, SaysWhichKeysDoNotGoTogether) {
  const std::string at = "robot.json: /servos/1";
  EXPECT_EQ(group_error(R"("dely": 0.004)"), at + "/dely: unknown key; did you mean 'delay'?");
  EXPECT_EQ(group_error(R"("load_friction": {"moter": 0.1})"),
            at + "/load_friction/moter: unknown key; did you mean 'motor'?");
  EXPECT_EQ(group_error(R"("kp": 3, "position_gain": 2, "speed_gain": 1)"),
            at + ": the group has both 'kp' and 'position_gain', which state the same quantity; "
                 "keep one of these keys");
  EXPECT_EQ(group_error(R"("offset": 0, "offset_deg": 0)"),
            at + ": the group has both 'offset' and 'offset_deg', which state the same quantity; "
                 "keep one of these keys");
  EXPECT_EQ(group_error(R"("stribeck_torque": 0.1)"),
            at + ": joint r_knee: with a stribeck_torque, stribeck_rate must be above 0. It is the "
                 "joint rate at which the Stribeck friction fades");
  EXPECT_EQ(group_error(R"("load_friction": {"motor_stribeck": 0.1})"),
            at + ": joint r_knee: with load friction at rest, stribeck_rate must be above 0. It is "
                 "the joint rate at which this friction fades");
  EXPECT_EQ(group_error(R"("quantized": true)"),
            "robot.json: /servos: the servo of l_knee is quantized, but 'encoders' gives no "
            "counts_per_degree for it");
  EXPECT_NE(group_error(R"("position_gain": 2)").find("'speed_gain'"), std::string::npos);
  EXPECT_NE(group_error(R"("motor": {"voltage": 7})").find("'torque_constant'"), std::string::npos);
  EXPECT_EQ(group_error(R"("motor": {"voltage": 0, "torque_constant": 1, "resistance": 1})"),
            at + "/motor/voltage: this value must be above 0, but it is 0");
  EXPECT_EQ(
      group_error(R"("kp": 2, "motor": {"voltage": 7, "torque_constant": 1, "resistance": 1,
                           "gain": 3})"),
      at + "/motor/gain: the group also states 'kp', but the gain of the motor determines this "
           "value; keep one of these keys");
}

TEST(ServoReader, SaysWhatIsWrongWithABamFile) {
  const TemporaryFolder folder;
  const auto error = [&](const char* key, const nlohmann::json& value) {
    nlohmann::json numbers = bam_numbers("m6");
    numbers[key] = value;
    folder.write("motor.json", numbers.dump());
    return error_of(folder, servo_sidecar(kBamGroup));
  };
  EXPECT_NE(error("model", "m7").find("m7"), std::string::npos);
  EXPECT_EQ(error("friction_base", -0.1),
            "motor.json: /friction_base: -0.1 N m is too small; the smallest allowed value is 0 "
            "N m");
  EXPECT_EQ(error("command_delay", 6),
            "motor.json: /command_delay: 6 s is too large; the largest allowed value is 0.1 s; "
            "state it in seconds: 3.7 ms is 0.0037");
  EXPECT_EQ(error("R", 0), "motor.json: /R: this value must be above 0, but it is 0");
  EXPECT_EQ(error("kt", "high"), "motor.json: /kt: expected a number, found a string");
  EXPECT_EQ(error_of(folder, servo_sidecar(R"({"joints": ["*_knee"], "bam": "motor.json"})")),
            "motor.json: /kt: expected a number, found a string");
  folder.write("motor.json", bam_numbers("m6").dump());
  EXPECT_EQ(error_of(folder, servo_sidecar(R"({"joints": ["*_knee"], "bam": "motor.json"})")),
            "robot.json: /servos/1: a group with 'bam' needs 'motor' with the voltage [V] and the "
            "gain [V/rad]");
  folder.write("motor.json", "{");
  EXPECT_TRUE(error_of(folder, servo_sidecar(kBamGroup)).starts_with("motor.json:1:"));
}

}  // namespace
}  // namespace ayumi
