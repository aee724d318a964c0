#include "ayumi/model/diagnose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/run/sha256.hpp"

namespace ayumi {
namespace {

RobotDescription hoap1() {
  return load_robot_description("hoap1", {{AYUMI_SOURCE_DIR "/robots"}}, {.meshes = true});
}

LinkDescription& link(RobotDescription& robot, const std::string& name) {
  for (LinkDescription& each : robot.links)
    if (each.name == name) return each;
  throw std::runtime_error(name);
}

JointDescription& joint(RobotDescription& robot, const std::string& name) {
  for (JointDescription& each : robot.joints)
    if (each.name == name) return each;
  throw std::runtime_error(name);
}

// The messages of the diagnosis for HOAP-1 after a change, one warning per line.
std::string findings(const std::function<void(RobotDescription&)>& spoil) {
  RobotDescription robot = hoap1();
  spoil(robot);
  std::string text;
  for (const ModelWarning& warning : diagnose(RobotModel(robot)))
    text += warning.where + ": " + warning.message + "\n";
  return text;
}

bool mentions(const std::string& text, const std::string& where, const std::string& what) {
  const size_t at = text.find(where + ": ");
  return at != std::string::npos && text.find(what, at) != std::string::npos;
}

TEST(Diagnose, FindsNothingWrongWithHoap1) {
  EXPECT_EQ(findings([](auto&) {}), "");
}

TEST(Diagnose, NamesImplausibleInertias) {
  EXPECT_TRUE(mentions(
      findings([](auto& r) { link(r, "l_shank").inertia.about_com = Eigen::Matrix3d::Identity(); }),
      "link l_shank", "a placeholder?"));
  EXPECT_TRUE(mentions(findings([](auto& r) {
                         link(r, "l_shank").inertia.about_com =
                             Eigen::Vector3d(1e-4, 1e-4, 3e-4).asDiagonal();
                       }),
                       "link l_shank", "exceeds the sum of the other two"));
  EXPECT_TRUE(mentions(findings([](auto& r) { link(r, "torso").inertia.com.z() = -0.2; }),
                       "link torso", "outside the shape"));
  EXPECT_TRUE(mentions(findings([](auto& r) {
                         const Eigen::Matrix3d same = link(r, "l_foot").inertia.about_com;
                         for (const char* name : {"l_shank", "r_foot", "r_shank"})
                           link(r, name).inertia.about_com = same;
                       }),
                       "links r_shank, r_foot, l_shank, l_foot", "the same inertia tensor"));
  EXPECT_TRUE(mentions(findings([](auto& r) { link(r, "l_foot").inertia.mass = 10; }),
                       "link l_foot", "above that of lead"));
}

TEST(Diagnose, NamesShapesThatDoNotFitTheRobot) {
  // The mesh is in millimetres.
  EXPECT_TRUE(
      mentions(findings([](auto& r) {
                 link(r, "l_shank").visuals.push_back({.name = "shin", .shape = Box{{30, 40, 0}}});
               }),
               "link l_shank", "the shape is far larger than the robot"));
  // No shape says how large the link is, but the robot is known to be 0.5 m high.
  const auto bare = [](double gyration) {
    return findings([&](auto& r) {
      LinkDescription& shank = link(r, "l_shank");
      shank.visuals.clear();
      shank.collisions.clear();
      shank.inertia.about_com =
          Eigen::Matrix3d::Identity() * shank.inertia.mass * 2 / 3 * gyration * gyration;
    });
  };
  EXPECT_TRUE(mentions(bare(5), "link l_shank", "a body larger than the robot"));
  EXPECT_FALSE(mentions(bare(0.05), "link l_shank", "a body larger than the robot"));
}

TEST(Diagnose, NamesAsymmetry) {
  EXPECT_TRUE(mentions(findings([](auto& r) { link(r, "l_foot").inertia.mass *= 1.1; }),
                       "links l_foot, r_foot", "left and right masses differ"));
  EXPECT_TRUE(mentions(findings([](auto& r) { joint(r, "l_hip_yaw").lower = -1.2; }),
                       "joints l_hip_yaw, r_hip_yaw", "left and right limits differ"));
  EXPECT_TRUE(
      mentions(findings([](auto& r) { joint(r, "l_hip_yaw").origin.translation().y() = 0.059; }),
               "joints l_hip_yaw, r_hip_yaw", "are not mirror images"));
  EXPECT_TRUE(
      mentions(findings([](auto& r) { joint(r, "l_hip_yaw").axis = Eigen::Vector3d(0.3, 0, 1); }),
               "joints l_hip_yaw, r_hip_yaw", "their axes are not mirror images"));
}

TEST(Diagnose, NamesAnEncoderWhoseSignDisagrees) {
  const std::string text =
      findings([](auto& r) { r.encoders.at("l_knee").counts_per_degree = 209; });
  EXPECT_TRUE(mentions(text, "joints l_knee/r_knee",
                       "the same direction, but in opposite directions on 9 other pairs"));
}

TEST(Diagnose, NamesMissingAndPlaceholderLimits) {
  EXPECT_TRUE(mentions(findings([](auto& r) { joint(r, "l_knee").has_limits = false; }),
                       "joint l_knee", "no position limits"));
  EXPECT_TRUE(mentions(findings([](auto& r) { joint(r, "l_shoulder_pitch").upper = 20; }),
                       "joint l_shoulder_pitch", "more than two turns"));
  EXPECT_TRUE(mentions(findings([](auto& r) {
                         JointDescription& elbow = joint(r, "l_elbow");
                         elbow.lower = elbow.upper = r.postures["home"]["l_elbow"];
                       }),
                       "joint l_elbow", "make the joint fixed"));
  EXPECT_TRUE(mentions(findings([](auto& r) {
                         joint(r, "l_knee").velocity = 0;
                         r.profiles[0].speed.erase("l_knee");
                       }),
                       "joint l_knee", "no speed limit is stated"));
  EXPECT_TRUE(mentions(findings([](auto& r) { r.profiles[0].peak_torque["l_knee"] = 5000; }),
                       "limits", "a torque limit of 5000 N m could throw the robot"));
  EXPECT_TRUE(mentions(findings([](auto& r) { r.profiles[0].speed["l_knee"] = 1000; }),
                       "joint l_knee", "higher than the speed of any servo"));
  EXPECT_TRUE(mentions(findings([](auto& r) {
                         for (auto& [name, torque] : r.profiles[0].peak_torque) torque = 100;
                       }),
                       "limits", "every joint has the torque limit 100 N m"));
  EXPECT_TRUE(mentions(findings([](auto& r) { r.servos.erase("l_knee"); }), "joint l_knee",
                       "no servo constants"));
  EXPECT_TRUE(
      mentions(findings([](auto& r) { r.servos["l_knee"].kp = 0; }), "joint l_knee", "is passive"));
  EXPECT_TRUE(mentions(findings([](auto& r) { r.encoders.erase("l_knee"); }), "joint l_knee",
                       "no encoder is stated"));
}

TEST(Diagnose, NamesAHomePostureThatCannotStand) {
  EXPECT_TRUE(mentions(findings([](auto& r) { r.postures["home"]["l_ankle_pitch"] = 0; }),
                       "posture home", "not on one plane"));
  EXPECT_TRUE(mentions(findings([](auto& r) {
                         for (const char* side : {"l_", "r_"}) {
                           r.postures["home"][std::string(side) + "hip_pitch"] -= 0.9;
                           r.postures["home"][std::string(side) + "ankle_pitch"] += 0.9;
                         }
                       }),
                       "posture home", "outside the soles"));
}

TEST(Diagnose, NamesLinksWithoutCollisionShape) {
  EXPECT_TRUE(mentions(findings([](auto& r) { link(r, "l_foot").collisions.clear(); }),
                       "link l_foot", "no collision shape is stated"));
}

// One cause gives one line, whatever the number of joints and links is.
TEST(Diagnose, SaysEachCauseOnce) {
  const std::string text = findings([](auto& r) {
    for (auto& [name, speed] : r.profiles[0].speed) speed = 100;
    for (LinkDescription& each : r.links) each.inertia.about_com *= 1000;
  });
  EXPECT_TRUE(mentions(text, "20 joints (r_hip_yaw, r_hip_roll, r_hip_pitch, ...)",
                       "the speed limit of 100 rad/s is higher"))
      << text;
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 3) << text;
}

// Partners are found even if their names say nothing about sides.
TEST(Diagnose, FindsMirroredPartnersByPlace) {
  RobotDescription robot = hoap1();
  const auto renamed = [](const std::string& name) { return "part_" + sha256(name).substr(0, 8); };
  for (LinkDescription& each : robot.links) each.name = renamed(each.name);
  for (JointDescription& each : robot.joints) {
    each.parent = renamed(each.parent);
    each.child = renamed(each.child);
  }
  for (auto& [side, sole] : robot.soles) sole.link = renamed(sole.link);
  robot.trunk_link = robot.sensors.imu_link = "";
  robot.collision_ignore.clear();
  link(robot, renamed("l_foot")).inertia.mass *= 1.1;
  std::string text;
  for (const ModelWarning& warning : diagnose(RobotModel(robot)))
    text += warning.where + ": " + warning.message + "\n";
  EXPECT_EQ(text.rfind("links " + renamed("l_foot") + ", " + renamed("r_foot") +
                           ": left and right masses differ",
                       0),
            0u)
      << text;
}

TEST(Diagnose, ExaminesAnUnknownUrdf) {
  const std::string file = AYUMI_SOURCE_DIR "/../shared/data/choreonoid/SR1/SR1.urdf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the SR1 model is not there";
  const std::vector<ModelWarning> warnings = diagnose(load_robot(file));
  const auto names_waist = [](const ModelWarning& w) {
    return w.where.find("WAIST") != std::string::npos &&
           w.message.find("placeholder") != std::string::npos;
  };
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), names_waist));
}

}  // namespace
}  // namespace ayumi
