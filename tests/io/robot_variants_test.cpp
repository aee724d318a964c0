// Robots as they occur in practice: URDF with byte order marks, comments, names in upper case,
// packages in other places, misspelt elements, missing meshes and links without mass.

#include <gtest/gtest.h>

#include <filesystem>

#include "ayumi/base/error.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/robot/urdf.hpp"
#include "tests/support/robot_texts.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/urdf_biped.hpp"

namespace ayumi {
namespace {

using test::TemporaryFolder;

std::string message_of(const std::filesystem::path& file, const RobotSearch& search = {}) {
  try {
    load_robot(file.string(), search, {.meshes = true});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

const std::string kTriangleText = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::string with_mesh(const std::string& file, const std::string& kind = "visual") {
  const std::string biped = test::UrdfBiped{}.text();
  const size_t at = biped.find("</link>");
  return biped.substr(0, at) + "<" + kind + "><geometry><mesh filename=\"" + file +
         "\"/></geometry></" + kind + ">" + biped.substr(at);
}

size_t mesh_shapes(const RobotDescription& robot) {
  size_t count = 0;
  for (const LinkDescription& link : robot.links)
    for (const auto* shapes : {&link.visuals, &link.collisions})
      for (const PlacedShape& placed : *shapes)
        count += std::holds_alternative<MeshShape>(placed.shape);
  return count;
}

bool says(const RobotDescription& robot, const std::string& words) {
  for (const std::string& each : robot.assumptions)
    if (each.find(words) != std::string::npos) return true;
  return false;
}

TEST(RobotVariants, MarksCommentsAndCapitalsBeforeTheRobot) {
  const TemporaryFolder folder;
  const std::string biped = test::UrdfBiped{}.text();
  const int dofs = load_robot(folder.write("plain.urdf", biped).string()).dof_count();
  const std::string body = biped.substr(biped.find("<robot"));
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"mark.urdf", "\xef\xbb\xbf" + biped},
           {"comment.urdf", "<!-- a -- robot -->\n<!-- > -->\n" + biped},
           {"both.URDF", "\xef\xbb\xbf<!-- made by hand -->\r\n" + replaced(body, "\n", "\r\n")},
           {"Upper.Urdf", biped},
           {"by_content.xml", "<?xml version=\"1.0\"?>\n<!-- <mujoco> -->\n" + body},
           {"no_ending", body}})
    EXPECT_EQ(load_robot(folder.write(name, text).string()).dof_count(), dofs) << name;
  std::filesystem::create_directory(folder.path() / "robot");
  folder.write("robot/Robot.URDF", biped);
  EXPECT_EQ(load_robot((folder.path() / "robot").string()).dof_count(), dofs);
}

TEST(RobotVariants, WhatIsNotReadIsNamed) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& name, const std::string& text) {
    const std::string words = message_of(folder.write(name, text));
    EXPECT_EQ(words.find('\n'), std::string::npos) << words;
    EXPECT_NE(words.find(name), std::string::npos) << words;
    return words;
  };
  const auto has = [](const std::string& words, const std::string& part) {
    EXPECT_NE(words.find(part), std::string::npos) << words;
  };
  const std::string biped = test::UrdfBiped{}.text();
  has(error("a.xml", "<COLLADA version=\"1\"/>"), "<COLLADA> is not a robot");
  has(error("a.wrl", "#VRML V2.0 utf8\n"), "VRML");
  has(error("a.urdf", std::string("\xff\xfe<\0r\0", 6)), "UTF-16 text; save the file as UTF-8");
  has(error("a.stl", std::string("solid\0\0\0\0", 9)), "binary data");
  has(error("a.txt", "hello"), "Ayumi reads robots as");
  has(error("a.xacro", replaced(biped, "<link name", "<xacro:arm/><link name")), "expand it with");
  has(error("a.urdf", replaced(biped, "<mass value=\"", "<mass value=\"${m}")), "expand it with");
  has(error("a.urdf", replaced(biped, "xyz=\"0 ", "xyz=\"0,0 ")), "have a decimal point");
}

TEST(RobotVariants, MisspeltElementsAreCounted) {
  const TemporaryFolder folder;
  const std::string biped = test::UrdfBiped{}.text();
  const auto error = [&](const std::string& from, const std::string& to) {
    return message_of(folder.write("r.urdf", replaced(biped, from, to)));
  };
  size_t links = 0;
  for (size_t at = biped.find("<inertial>"); at != std::string::npos;
       at = biped.find("<inertial>", at + 1))
    ++links;
  EXPECT_NE(error("inertial>", "intertial>")
                .find("<intertial> is not an element of a link; did you mean <inertial>? (in " +
                      std::to_string(links) + " links)"),
            std::string::npos);
  EXPECT_NE(error("<limit ", "<limits ").find("did you mean <limit>?"), std::string::npos);
  EXPECT_NE(error("geometry>", "geometri>").find("did you mean <geometry>?"), std::string::npos);
  // Elements that only other programs know do not matter to Ayumi.
  EXPECT_EQ(message_of(folder.write(
                "r.urdf", replaced(biped, "</robot>",
                                   "<gazebo/><transmission name=\"t\"/><sensor/></robot>"))),
            "no error");
}

TEST(RobotVariants, PackagesLieElsewhere) {
  const TemporaryFolder folder;
  const std::string name = "package://legs_description/meshes/a.obj";
  const std::string package = "<package><name>legs_description</name></package>";
  const auto meshes = [&](const std::string& file, const RobotSearch& search = {}) {
    return mesh_shapes(load_robot_description((folder.path() / file).string(), search));
  };
  folder.write("one/legs_bringup/urdf/r.urdf", with_mesh(name));
  EXPECT_EQ(meshes("one/legs_bringup/urdf/r.urdf"), 0u);
  // The package is beside the package of the URDF file, in a folder with another name.
  folder.write("one/legs_description-main/package.xml", package);
  folder.write("one/legs_description-main/meshes/a.obj", kTriangleText);
  EXPECT_EQ(meshes("one/legs_bringup/urdf/r.urdf"), 1u);
  folder.write("two/r.urdf", with_mesh(name));
  EXPECT_EQ(meshes("two/r.urdf"), 0u);
  EXPECT_EQ(meshes("two/r.urdf", {{}, {folder.path() / "one"}}), 1u);
  EXPECT_EQ(meshes("two/r.urdf", {{}, {folder.path() / "one/legs_description-main"}}), 1u);
  folder.write(
      "two/robot.json",
      "{\"format\": \"ayumi.robot/1\", \"urdf\": \"r.urdf\", \"package_path\": [\"../one\"]}");
  EXPECT_EQ(meshes("two/robot.json"), 1u);
  folder.write("three/copy/urdf/r.urdf", with_mesh(name));  // the package's folder was renamed
  folder.write("three/copy/meshes/a.obj", kTriangleText);
  EXPECT_EQ(meshes("three/copy/urdf/r.urdf"), 1u);
  // A package.xml that is too large or nested too deeply names no package.
  folder.write("four/legs_bringup/urdf/r.urdf", with_mesh(name));
  folder.write("four/legs_description-main/meshes/a.obj", kTriangleText);
  std::string deep;
  for (int i = 0; i < 300'000; ++i) deep += "<a>";
  for (const std::string& text : {package + std::string(size_t{2} << 20, ' '), deep}) {
    folder.write("four/legs_description-main/package.xml", text);
    EXPECT_EQ(meshes("four/legs_bringup/urdf/r.urdf"), 0u);
  }
  folder.write("four/legs_description-main/package.xml", package);
  EXPECT_EQ(meshes("four/legs_bringup/urdf/r.urdf"), 1u);
}

TEST(RobotVariants, AllMissingMeshesAreListedAtOnceAndLeftOut) {
  const TemporaryFolder folder;
  const std::string biped = test::UrdfBiped{}.text();
  const auto file = folder.write(
      "r.urdf",
      replaced(biped, "<collision>",
               "<visual><geometry><mesh filename=\"gone.stl\"/></geometry></visual>"
               "<visual><geometry><mesh filename=\"package://nowhere_else/a.stl\"/>"
               "</geometry></visual><visual><geometry><mesh filename=\"Meshes/Part.obj\"/>"
               "</geometry></visual><collision>"));
  folder.write("meshes/part.OBJ", kTriangleText);
  const RobotDescription robot = load_robot_description(file.string(), {}, {.meshes = true});
  EXPECT_TRUE(says(robot, "gone.stl of link ")) << robot.assumptions.front();
  EXPECT_TRUE(says(robot, "package://nowhere_else/a.stl of link "));
  EXPECT_TRUE(says(robot, "are missing and left out"));
  EXPECT_TRUE(says(robot, "part.OBJ for Meshes/Part.obj"));
  EXPECT_GT(mesh_shapes(robot), 0u);
  EXPECT_EQ(robot.soles.size(), 2u);
}

// The parser requires an effort wherever a joint states a limit, even for a joint that does not
// move.
TEST(RobotVariants, FixedJointsMayStateLimitsWithoutEffort) {
  const TemporaryFolder folder;
  std::string text = test::UrdfBiped{}.text();
  const size_t joint = text.find("<joint name=\"l_shoulder\" type=\"revolute\"");
  ASSERT_NE(joint, std::string::npos);
  text.replace(text.find("revolute", joint), 8, "fixed");
  const size_t effort = text.find(" effort=", joint);
  text.erase(effort, text.find("/>", effort) - effort);
  EXPECT_EQ(message_of(folder.write("r.urdf", text)), "no error");
}

// Whatever the file is called: the content decides.
TEST(RobotVariants, OnlyReadersOfUrdfIgnoreTheMassOfTheRoot) {
  const TemporaryFolder folder;
  const std::string biped = test::UrdfBiped{}.text();
  for (const char* const name : {"r.urdf", "r.xml", "r.sdf"})
    EXPECT_TRUE(says(load_robot_description(folder.write(name, biped).string()),
                     "Some URDF readers ignore the mass"))
        << name;
  const std::string sdf = test::sdf_text_of(RobotModel(parse_urdf(biped, "r.urdf", {})));
  for (const char* const name : {"s.sdf", "s.xml"})
    EXPECT_FALSE(says(load_robot_description(folder.write(name, sdf).string()),
                      "Some URDF readers ignore the mass"))
        << name;
}

TEST(RobotVariants, JointsWithoutMassAreHeld) {
  const TemporaryFolder folder;
  const std::string hand =
      "<link name=\"hand\"/><joint name=\"wrist\" type=\"revolute\"><parent link=\"trunk\"/>"
      "<child link=\"hand\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint>"
      "</robot>";
  std::string biped = test::UrdfBiped{}.text();
  const RobotModel plain = load_robot(folder.write("a.urdf", biped).string());
  biped = replaced(replaced(biped, "</robot>", hand), "parent link=\"trunk\"/><child link=\"hand",
                   "parent link=\"" + plain.links()[0].name + "\"/><child link=\"hand");
  const RobotDescription robot = load_robot_description(folder.write("b.urdf", biped).string());
  EXPECT_TRUE(says(robot, "these joints carry no mass, so Ayumi holds them at 0: wrist"));
  EXPECT_EQ(RobotModel(robot).dof_count(), plain.dof_count());
  EXPECT_NEAR(RobotModel(robot).mass(), plain.mass(), 1e-12);
}

}  // namespace
}  // namespace ayumi
