// Every kind of broken robot file gives one error that names the place.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>

#include "ayumi/base/error.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

using test::TemporaryFolder;

const char* const kInertia =
    "<inertial><origin xyz=\"0 0 0\"/><mass value=\"1\"/>"
    "<inertia ixx=\"0.01\" ixy=\"0\" ixz=\"0\" iyy=\"0.01\" iyz=\"0\" izz=\"0.01\"/></inertial>";

std::string link(const std::string& name, const std::string& inside = kInertia) {
  return "  <link name=\"" + name + "\">" + inside + "</link>\n";
}

std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& type = "revolute") {
  return "  <joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child +
         "\"/><axis xyz=\"0 1 0\"/><limit lower=\"-1\" upper=\"1\" effort=\"5\" velocity=\"4\"/>"
         "</joint>\n";
}

std::string urdf(const std::string& inside) {
  return "<?xml version=\"1.0\"?>\n<robot name=\"r\">\n" + inside + "</robot>\n";
}

const std::string kBody = link("trunk") + link("l_foot") + link("r_foot") +
                          joint("l_hip", "trunk", "l_foot") + joint("r_hip", "trunk", "r_foot");

std::string sidecar(const std::string& more) {
  return "{ \"format\": \"ayumi.robot/1\", \"urdf\": \"robot.urdf\"" + more + " }";
}

// The message of loading `name` in a folder, from which the folder's path is removed.
std::string message_of(const TemporaryFolder& folder, const std::string& name,
                       const LoadOptions& options = {}) {
  try {
    load_robot((folder.path() / name).string(), {}, options);
  } catch (const Error& error) {
    EXPECT_TRUE(error.code() == ErrorCode::bad_file || error.code() == ErrorCode::bad_model);
    std::string message = error.what();
    const std::string prefix = folder.path().string() + "/";
    for (size_t at; (at = message.find(prefix)) != std::string::npos;)
      message.erase(at, prefix.size());
    return message;
  }
  return "no error";
}

std::string urdf_error(const std::string& text) {
  const TemporaryFolder folder;
  folder.write("r.urdf", text);
  return message_of(folder, "r.urdf", {.meshes = true});
}

std::string sidecar_error(const std::string& more) {
  const TemporaryFolder folder;
  folder.write("robot.urdf", urdf(kBody));
  folder.write("robot.json", sidecar(more));
  return message_of(folder, "robot.json");
}

TEST(BrokenRobot, TheBodyItselfIsGood) {
  const TemporaryFolder folder;
  folder.write("r.urdf", urdf(kBody));
  EXPECT_EQ(message_of(folder, "r.urdf"), "no error");
}

TEST(BrokenRobot, WhatIsNoFile) {
  const TemporaryFolder folder;
  EXPECT_EQ(message_of(folder, "missing.urdf"), "missing.urdf: no such file");
  std::filesystem::create_directory(folder.path() / "folder.urdf");
  EXPECT_EQ(
      message_of(folder, "folder.urdf"),
      "folder.urdf: this folder holds neither a robot.json nor exactly one robot file in another "
      "format; name the file of the robot");
  EXPECT_EQ(message_of(folder, "empty_folder"),
            "robot 'empty_folder': no such file, folder or bundled robot");
  std::filesystem::create_directory(folder.path() / "bare");
  EXPECT_EQ(
      message_of(folder, "bare"),
      "bare: this folder holds neither a robot.json nor exactly one robot file in another format; "
      "name the file of the robot");
  std::filesystem::create_symlink("loop.urdf", folder.path() / "loop.urdf");
  EXPECT_EQ(message_of(folder, "loop.urdf"),
            "loop.urdf: the file cannot be read (Too many levels of symbolic links)");
}

TEST(BrokenRobot, WhatIsNoUrdf) {
  EXPECT_EQ(urdf_error(" \n"), "r.urdf: the file is empty, but a URDF is needed");
  // A file that was cut off: the message has the line of its end and a remedy.
  const std::string cut = urdf_error("<robot name=\"r\">\n<link name=\"a\">\n<mass>1.");
  EXPECT_TRUE(cut.starts_with("r.urdf:3: this is not valid XML")) << cut;
  EXPECT_NE(cut.find("copy the file again if it was cut off"), std::string::npos) << cut;
  EXPECT_TRUE(urdf_error("hello").starts_with("r.urdf: this is not XML"));
  EXPECT_TRUE(urdf_error("<robot name=\"r\">\n<link name=\"a\">\n</robot>").starts_with("r.urdf"));
  EXPECT_EQ(
      urdf_error("<sdf/>"),
      "r.urdf:1: the outermost element is <sdf>, but a URDF starts with <robot name=\"...\">");
  EXPECT_EQ(
      urdf_error(urdf("  <xacro:macro/>\n")),
      "r.urdf:3: this is a xacro file; expand it with `xacro FILE > robot.urdf` of ROS, and use "
      "robot.urdf");
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_EQ(urdf_error(deep),
            "r.urdf: elements are nested more than 200 levels deep, too deep for a URDF");
  EXPECT_EQ(urdf_error("<robot name=\"r\"/>"), "r.urdf: the robot has no link; add one");
}

// In an earlier version, each of these took minutes, gigabytes or the whole stack.
TEST(BrokenRobot, WhatIsFarTooLarge) {
  std::string chain = link("l0");
  for (int i = 1; i < 10'000; ++i) {
    const std::string before = "l" + std::to_string(i - 1), name = "l" + std::to_string(i);
    chain += link(name) + joint("j" + std::to_string(i), before, name, "fixed");
  }
  EXPECT_NE(urdf_error(urdf(chain)).find("more than 1000 links; simplify the robot"),
            std::string::npos);
  std::string attributes;
  for (int i = 0; i < 50'000; ++i) attributes += " a" + std::to_string(i) + "='='";
  EXPECT_EQ(urdf_error("<robot name=\"r\">\n<link name=\"l\"" + attributes + "/></robot>"),
            "r.urdf:2: an element has more than 100 attributes");
  EXPECT_EQ(urdf_error(urdf("<!-- " + std::string(200, '=') + " -->" + kBody)), "no error");
}

TEST(BrokenRobot, WrongMassesAndNumbers) {
  const auto with_trunk = [](const std::string& inside) {
    return urdf_error(urdf(link("trunk", inside) + link("l") + joint("j", "trunk", "l")));
  };
  const auto inertia = [](const std::string& mass, const std::string& ixx) {
    return "<inertial><mass value=\"" + mass + "\"/><inertia ixx=\"" + ixx +
           "\" ixy=\"0\" ixz=\"0\" iyy=\"0.01\" iyz=\"0\" izz=\"0.01\"/></inertial>";
  };
  EXPECT_EQ(
      urdf_error(urdf(link("trunk") + link("l", "") + joint("j", "trunk", "l"))),
      "r.urdf: link l: this link has no <inertial> although a joint moves this link; give the "
      "link a mass and an inertia");
  EXPECT_EQ(
      with_trunk(inertia("0", "0.01")),
      "r.urdf: link trunk: the mass of this link is 0 although it is the root of a robot that "
      "moves; give the link a mass and an inertia");
  EXPECT_EQ(with_trunk(inertia("-2", "0.01")),
            "r.urdf: link trunk: mass -2 kg is negative; give the link its mass");
  EXPECT_EQ(with_trunk(inertia("nan", "0.01")),
            "r.urdf:3: link trunk: <mass value=\"nan\">: 'nan' is not a finite number");
  EXPECT_EQ(with_trunk(inertia("1.5kg", "0.01")),
            "r.urdf:3: link trunk: <mass value=\"1.5kg\">: '1.5kg' is not a finite number");
  // A quotation mark is missing, so the value goes on to the next one.
  const std::string long_value =
      with_trunk(inertia("1\n <a/>\n" + std::string(2'000'000, 'x'), "1"));
  EXPECT_EQ(long_value.find('\n'), std::string::npos) << long_value;
  EXPECT_LT(long_value.size(), 250u) << long_value;
  EXPECT_EQ(with_trunk(inertia("1", "inf")),
            "r.urdf:3: link trunk: <inertia ixx=\"inf\">: 'inf' is not a finite number");
  EXPECT_EQ(with_trunk(inertia("2e6", "0.01")),
            "r.urdf: link trunk: mass 2e+06 kg is above 1e+06 kg; URDF masses are in kilograms");
  EXPECT_EQ(with_trunk("<inertial><origin xyz=\"0 20000 0\"/><mass value=\"1\"/><inertia ixx=\"1\" "
                       "ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>"),
            "r.urdf: link trunk: its centre of mass lies farther than 10000 m away; URDF lengths "
            "are in metres");
  EXPECT_EQ(with_trunk("<inertial><origin xyz=\"0 1\"/><mass value=\"1\"/><inertia ixx=\"1\" "
                       "ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>"),
            "r.urdf:3: link trunk: <origin xyz=\"0 1\">: 3 numbers are needed, found 2");
  EXPECT_EQ(with_trunk("<inertial><mass value=\"1\"/></inertial>"),
            "r.urdf:3: link trunk: <inertial> has no <inertia>; add it");
  EXPECT_NE(with_trunk(inertia("1", "-0.5")).find("negative principal moment"), std::string::npos);
}

TEST(BrokenRobot, WrongTrees) {
  EXPECT_EQ(urdf_error(urdf(kBody + joint("x", "l_foot", "trunk"))),
            "r.urdf: link trunk: the joints form a loop, so no link is the root; remove one joint");
  EXPECT_EQ(urdf_error(urdf(kBody + joint("x", "l_foot", "r_foot"))),
            "r.urdf: link r_foot: the joints r_hip and x both lead to this link, but closed chains "
            "are not supported; remove one of these joints");
  EXPECT_EQ(urdf_error(urdf(kBody + link("other"))),
            "r.urdf: there are several root links: trunk, other; add joints so that only one root "
            "link remains");
  EXPECT_EQ(urdf_error(urdf(kBody + link("trunk"))),
            "r.urdf: link trunk: two links have this name; rename one");
  EXPECT_EQ(urdf_error(urdf(kBody + joint("x", "trunc", "l_foot"))),
            "r.urdf: joint x: the link 'trunc' does not exist; did you mean 'trunk'?");
  EXPECT_EQ(urdf_error(urdf(kBody + link("a") + joint("x", "trunk", "a", "revolut"))),
            "r.urdf:9: joint x: unknown joint type 'revolut'; known: fixed, revolute, continuous, "
            "prismatic, floating, planar; did you mean 'revolute'?");
  EXPECT_EQ(urdf_error(urdf(kBody + link("a") + joint("x", "trunk", "a", "planar"))),
            "r.urdf:9: joint x: planar joints are not supported; use two prismatic and one "
            "continuous joint");
  EXPECT_NE(urdf_error(urdf(kBody + link("a") + joint("x", "trunk", "a", "floating")))
                .find("joint x: a floating joint may only carry the whole robot"),
            std::string::npos);
  EXPECT_EQ(urdf_error(urdf(link("a") + "  <link/>\n")),
            "r.urdf:4: <link> has no attribute 'name'");
}

TEST(BrokenRobot, APackageAroundTheWorkingFolderIsFound) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "meshes");
  folder.write("meshes/trunk.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string package = folder.path().filename().string();
  folder.write(
      "r.urdf",
      urdf(link("trunk", std::string(kInertia) + "<visual><geometry><mesh filename=\"package://" +
                             package + "/meshes/trunk.obj\"/></geometry></visual>")));
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  EXPECT_NO_THROW(load_robot("r.urdf", {}, {.meshes = true}));
  std::filesystem::current_path(before);
}

TEST(BrokenRobot, WrongMeshes) {
  const auto with_mesh = [](const std::string& file) {
    return urdf(link("trunk", std::string(kInertia) + "<visual><geometry><mesh filename=\"" + file +
                                  "\"/></geometry></visual>"));
  };
  const TemporaryFolder folder;
  folder.write("trunk.obj", "this is no mesh\n");
  folder.write("r.urdf", with_mesh("trunk.obj"));
  const std::string corrupt = message_of(folder, "r.urdf", {.meshes = true});
  EXPECT_TRUE(corrupt.starts_with("r.urdf: link trunk: mesh trunk.obj: ")) << corrupt;
  folder.write("trunk.obj", "");
  EXPECT_EQ(message_of(folder, "r.urdf", {.meshes = true}),
            "r.urdf: link trunk: mesh trunk.obj: the mesh file is empty");
  const char* const reader = std::getenv("AYUMI_MESH_READER");
  const std::string before = reader ? reader : "";
  setenv("AYUMI_MESH_READER", "no/reader", 1);
  const std::string unread = message_of(folder, "r.urdf", {.meshes = true});
  reader ? setenv("AYUMI_MESH_READER", before.c_str(), 1) : unsetenv("AYUMI_MESH_READER");
  EXPECT_TRUE(
      unread.starts_with("r.urdf: link trunk: mesh trunk.obj cannot be read: the program "
                         "ayumi-mesh-reader, which reads meshes, was not found. Install Ayumi"))
      << unread;
  EXPECT_EQ(urdf_error(urdf(link(
                "trunk", std::string(kInertia) + "<visual><geometry><cone/></geometry></visual>"))),
            "r.urdf:3: link trunk: unknown geometry <cone>; known: box, sphere, cylinder, mesh");
}

TEST(BrokenRobot, WrongSidecars) {
  EXPECT_EQ(sidecar_error(", \"sole\": {}"),
            "robot.json: /sole: unknown key; did you mean 'soles'?");
  EXPECT_TRUE(sidecar_error(",").starts_with("robot.json:1:"));
  EXPECT_EQ(sidecar_error(", \"soles\": {\"left\": {\"link\": \"left_foot\", \"polygon\": "
                          "[[0,0],[0.1,0],[0,0.1]]}, \"right\": {\"link\": \"r_foot\", "
                          "\"polygon\": [[0,0],[0.1,0],[0,0.1]]}}"),
            "robot.json: /soles/left/link: the link 'left_foot' does not exist; did you mean "
            "'l_foot'?");
  EXPECT_EQ(sidecar_error(", \"servos\": [{\"joints\": [\"*_knee\"], \"kp\": 1}]"),
            "robot.json: /servos/0/joints/0: no moving joint of the robot matches '*_knee'");
  EXPECT_EQ(sidecar_error(", \"servos\": [{\"joints\": [\"*\"], \"kp\": \"stiff\"}]"),
            "robot.json: /servos/0/kp: expected a number, found a string");
  EXPECT_EQ(sidecar_error(", \"postures_deg\": {\"home\": {\"l_hip\": 90}}"),
            "robot.json: /postures_deg/home/l_hip: the joint 'l_hip' is at 90 deg, above its limit "
            "of 57.3 deg");
  EXPECT_EQ(sidecar_error(", \"encoders\": {\"l_hip\": {\"device\": 1, \"counts_per_degree\": 1}, "
                          "\"r_hip\": {\"device\": 1, \"counts_per_degree\": 1}}"),
            "robot.json: /encoders/r_hip/device: device 1 belongs to the joint 'l_hip' already; "
            "give each joint a device of its own");
  EXPECT_EQ(sidecar_error(", \"joint_order\": [\"l_hip\"]"),
            "robot.json: /joint_order: the joint 'r_hip' is missing; add it");
  EXPECT_EQ(sidecar_error(", \"profiles\": [{\"name\": \"a\", \"limits\": [{\"joints\": [\"*\"], "
                          "\"speed\": 0}]}]"),
            "robot.json: /profiles: profile 'a': the speed of 'l_hip' is 0; it must be above 0");
  const TemporaryFolder folder;
  folder.write("robot.json", sidecar(""));
  EXPECT_EQ(
      message_of(folder, "robot.json"),
      "robot.json: /urdf: there is no file robot.urdf, and no folder of --robot-path contains "
      "robot.urdf or urdf/robot.urdf; correct the path");
  folder.write("robot.json", "");
  EXPECT_EQ(message_of(folder, "robot.json"), "robot.json: the file is empty, but JSON is needed");
  folder.write("robot.json", "{ \"format\": \"ayumi.pattern/1\" }");
  EXPECT_EQ(message_of(folder, "robot.json"),
            "robot.json: /format: this file is a pattern, which `ayumi check FILE` reads; a robot "
            "is needed here");
}

}  // namespace
}  // namespace ayumi
