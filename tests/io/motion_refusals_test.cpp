// What the readers of motions refuse, with the place and the reason, and rare forms that they read.

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/motion_formats.hpp"
#include "ayumi/io/formats/npz_archive.hpp"
#include "ayumi/math/rotation.hpp"
#include "tests/io/moving_motion.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi::test {
namespace {

struct Refused {
  std::string bytes, part;  // part: of the message
};

void expect_refused(const std::vector<Refused>& cases, const std::string& file,
                    const ImportOptions& options = {}) {
  for (const Refused& each : cases) {
    const std::string message =
        error_message([&] { read_motion_rows(each.bytes, file, hoap1(), options); });
    EXPECT_NE(message.find(each.part), std::string::npos) << message << "\n" << each.bytes;
    EXPECT_TRUE(message.starts_with(file)) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

std::string notes_of(const ImportedMotion& motion) {
  std::string all;
  for (const std::string& note : motion.filled) all += note + "\n";
  return all;
}

std::string sequence(const std::string& content, const std::string& rest) {
  return "  -\n    type: MultiValueSeq\n    content: " + content + "\n" + rest;
}

std::string body(const std::string& components) {
  return "type: CompositeSeq\ncontent: BodyMotion\nformat_version: 2\ncomponents:\n" + components;
}

const std::string kKnee =
    "    part_labels: [ l_knee ]\n    frames:\n      - [ 0.1 ]\n      - [ 0.2 ]\n      - [ 0.3 ]\n"
    "      - [ 0.4 ]\n      - [ 0.5 ]\n      - [ 0.6 ]\n";

// Six times the same frame.
std::string frames(const std::string& row) {
  std::string text = "    frames:\n";
  for (int k = 0; k < 6; ++k) text += "      - " + row + "\n";
  return text;
}

TEST(MotionRefusals, BodyMotions) {
  const std::string joints = sequence("JointDisplacement", kKnee);
  const auto root = [&](const std::string& rest) {
    return body(joints + sequence("LinkPosition", rest));
  };
  expect_refused(
      {{"type: CompositeSeq\ncontent: BodyMotion\ncomponent: 1\n", "`components` is missing"},
       {body(sequence("JointDisplacement", "")), "the sequence 'JointDisplacement' has no frames"},
       {body(sequence("ZMP", "    frames:\n      - [ 0, 0, 0 ]\n")),
        "there is no sequence of joint angles"},
       {body(sequence("JointDisplacement", "    frame_rate: 50\n" + kKnee) +
             sequence("ZMP", "    frame_rate: 60\n    frames:\n      - [ 0, 0, 0 ]\n")),
        "the sequence 'ZMP' has 60 frames per second, but another sequence has 50"},
       {body(sequence("JointDisplacement", "    frames:\n      - [ a ]\n")),
        "a list of finite numbers is needed"},
       {body(joints + sequence("ZMP", "    frames: []\n")), "the sequence has no frame"},
       {body(sequence("JointDisplacement", "    num_parts: 2\n" + kKnee)),
        "m.yaml:11: the frame has 1 value, but 2 are needed"},
       {body(joints + sequence("ZMP", "    frames:\n      - [ 0, 0, 0 ]\n")),
        "the sequence has 1 frame, but another sequence has 6"},
       {root(frames("[ 0, 0 ]")), "the position of a link has 2 values, but 7 are needed"},
       {root("    frames: [ 1, 2, 3, 4, 5, 6 ]\n"),
        "the position of a link has 1 value, but 7 are needed"},
       {root(frames("[ 0, 0, 0, 1, 1, 0, 0 ]")), "the quaternion has length 1.4"}},
      "m.yaml");
}

TEST(MotionRefusals, RareBodyMotionsAreRead) {
  const std::string joints = sequence("JointDisplacement", kKnee);
  const std::string text = body(
      joints +
      sequence("LinkPosition", "    num_parts: 2\n    SE3Format: XYZRPY\n" +
                                   frames("[ [ 1, 0, 0.3, 0, 0, 0.5 ], [ 9, 9, 9, 0, 0, 0 ] ]")) +
      sequence("RelativeZMP", frames("[ 0.1, 0, -0.3 ]")) +
      sequence("VerticalForce", frames("[ 60 ]")) + sequence("Eyes", frames("[ 1 ]")) +
      "  -\n    type: Vector3Seq\n    content: COG\n" + frames("[ 1, 0, 0.3 ]"));
  const ImportedMotion read = read_motion_rows(text, "m.yaml", hoap1());
  ASSERT_EQ(read.motion.base.size(), 6u);
  EXPECT_EQ(read.motion.dt, 0.01);
  const BasePose& base = read.motion.base[1];
  EXPECT_LE((matrix_to_rpy(base.attitude.toRotationMatrix()) - Eigen::Vector3d(0, 0, 0.5)).norm(),
            1e-12);
  EXPECT_LE(
      (read.motion.zmp.at(1) - (base.position + base.attitude * Eigen::Vector3d(0.1, 0, -0.3)))
          .norm(),
      1e-12);
  EXPECT_EQ(read.motion.fz.at(2), 60);
  EXPECT_EQ(read.motion.cog.at(2), Eigen::Vector3d(1, 0, 0.3));
  const std::string notes = notes_of(read);
  for (const char* const note :
       {"frame rate: 100 per second, because the file states none", "sequences left out: Eyes",
        "positions of several links; Ayumi reads the positions of the first link",
        "quaternion order: none, because the file has roll, pitch and yaw",
        "the ZMP is relative to the root, as the file says"})
    EXPECT_NE(notes.find(note), std::string::npos) << note << "\n" << notes;
  const ImportedMotion lost = read_motion_rows(
      body(joints + sequence("RelativeZMP", frames("[ 0.1, 0, -0.3 ]"))), "m.yaml", hoap1());
  EXPECT_TRUE(lost.motion.zmp.empty());
  EXPECT_NE(notes_of(lost).find("the ZMP is left out, because it is relative to the root"),
            std::string::npos);
  // The word may also be the type.
  const ImportedMotion typed =
      read_motion_rows(body(joints + "  -\n    type: RelativeZMP\n    content: Balance\n" +
                            frames("[ 0.1, 0, -0.3 ]")),
                       "m.yaml", hoap1());
  EXPECT_TRUE(typed.motion.zmp.empty());
}

// A motion of DeepMimic with y up is the same motion as one with z up.
TEST(MotionRefusals, MotionsWithYUpAreTurned) {
  const auto file = [](const std::string& frames) {
    return R"({"Joints": ["l_knee"], "Frames": [)" + frames + "]}";
  };
  // A quarter turn about the vertical.
  const std::string turned = "[0.02, 1, 0.3, -2, 0.7071067811865476, 0, 0.7071067811865476, 0, ";
  std::string six;
  for (int k = 0; k < 6; ++k) six += (k > 0 ? ", " : "") + turned + "0." + std::to_string(k) + "]";
  const ImportedMotion read = read_motion_rows(file(six), "m.json", hoap1());
  EXPECT_EQ(read.motion.dt, 0.02);
  ASSERT_EQ(read.motion.base.size(), 6u);
  EXPECT_LE((read.motion.base[0].position - Eigen::Vector3d(1, 2, 0.3)).norm(), 1e-12);
  EXPECT_LE((matrix_to_rpy(read.motion.base[0].attitude.toRotationMatrix()) -
             Eigen::Vector3d(0, 0, EIGEN_PI / 2))
                .norm(),
            1e-12);
  const std::string upright = "[0.02, 0, 0.3, 0, 1, 0, 0, 0, ";
  expect_refused(
      {{file(""), "the file has no frame, so there is no motion to read"},
       {file("[1, 2]"), "the frame has 2 values, but at least 9 are needed"},
       {file(upright + "1], " + upright + "1, 2]"), "the frame has 10 values, but 9 are needed"},
       {file("[0, 0, 0.3, 0, 1, 0, 0, 0, 1], " + upright + "1]"),
        "frame 1: the duration must be above 0 s, but it is"},
       {file("[0.02, 0, 0.3, 0, 2, 0, 0, 0, 1], " + upright + "1]"),
        "frame 1: the quaternion of the root has length 2, but 1 is needed"},
       {file(upright + "1, 2], " + upright + "1, 2]"),
        "\"Joints\" has 1 name, but the frames have 2 joint columns"}},
      "m.json");
}

TEST(MotionRefusals, Tables) {
  const std::string base = "base.x[m],base.y[m],base.z[m],base.qw,base.qx,base.qy,base.qz";
  const std::string head = "t[s],theta.l_knee[rad]," + base;
  std::string long_rows;
  for (int k = 0; k < 70; ++k) long_rows += std::to_string(60 * k) + ",0\n";
  expect_refused(
      {{"t,l_knee,theta.l_knee[rad]\n0,1,2\n0.1,1,2\n",
        "the column 'theta.l_knee[rad]' is given twice"},
       {head + "\n0,0,0,0,0.3,1,0,0,0\n0.01,0,0,0,0.3,2,0,0,0\n",
        "data row 2: the quaternion of the root has length 2, but a unit quaternion"},
       {"# format: ayumi.motion/9\nt[s],theta.l_knee[rad]\n0,0\n0.01,0\n",
        "format 'ayumi.motion/9' cannot be read; this version of Ayumi reads"},
       {"t[s],theta.l_knee[rad]\n0,0\n", "the table has only one row; a motion needs more"},
       {"t[s],theta.l_knee[rad]\n0,0\n0.01,0\n0.005,0\n",
        "data row 3: time 0.005 s does not come after 0.01 s"},
       {"t[s],theta.l_knee[rad]\n0,0\n0.01,0\n1e9,0\n",
        "data row 3 comes 1e+09 s after the row before"},
       {"t[s],theta.l_knee[rad]\n" + long_rows, "the motion lasts 4140 s"}},
      "m.csv");
  const std::string rows =
      head +
      ",cog.x[m],cog.y[m],cog.z[m],fz[N],contact.left,contact.right\n"
      "0,0.1,0,0,0.3,1,0,0,0,0,0,0.2,60,1,1\n0.01,0.2,0,0,0.3,1,0,0,0,0,0,0.2,61,1,0\n"
      "0.03,0.3,0,0,0.3,1,0,0,0,0,0,0.2,62,0,1\n0.04,0.4,0,0,0.3,1,0,0,0,0,0,0.2,63,0,0\n"
      "0.05,0.5,0,0,0.3,1,0,0,0,0,0,0.2,63,1,1\n";
  const ImportedMotion read = read_motion_rows(rows, "m.csv", hoap1());
  ASSERT_EQ(read.motion.theta.rows(), 6);
  EXPECT_NEAR(read.motion.theta(2, hoap1().find_dof("l_knee")), 0.25, 1e-12);
  EXPECT_NEAR(read.motion.fz.at(2), 61.5, 1e-9);
  EXPECT_NE(notes_of(read).find("the rows are not evenly spaced in time, so Ayumi interpolates"),
            std::string::npos);
  // Options that say another thing than the file are refused, or named as not used.
  EXPECT_NE(error_message([&] {
              read_motion_rows(rows, "m.csv", hoap1(), {.format = "abacus"});
            }).find("--format abacus cannot be read; import reads "),
            std::string::npos);
  ImportOptions options;
  options.rate = 50;
  options.motion = "dance";
  const std::string notes = notes_of(read_motion_rows(rows, "m.csv", hoap1(), options));
  EXPECT_NE(notes.find("--motion is not used, because the file has one motion"), std::string::npos);
  EXPECT_NE(notes.find("--rate is not used, because the file states the times"), std::string::npos);
  expect_refused({{std::string("0 0.1\0 0.2\n", 12), "this is a binary file, but text is needed"}},
                 "m.dat", {.format = "webots"});
}

TEST(MotionRefusals, RowsOfNumbers) {
  expect_refused(
      {{"#WEBOTS_MOTION,V1.0,l_knee\n1:2:3:4,p,0\n", "'1:2:3:4' is not a time of the form"},
       {"#WEBOTS_MOTION,V1.0,l_knee\n40,p,0\n40,q,0\n",
        "m.dat:3: time 0.04 s does not come after 0.04 s"},
       {"#WEBOTS_MOTION,V1.0,l_knee\n", "the file has no pose"},
       {"#WEBOTS_MOTION,V1.0,,l_knee\n0,p,0,0\n", "m.dat:1: a column has no name"},
       {"#WEBOTS_MOTION,V1.1\na%l_knee\n0%1\n", "the row has 2 cells"},
       {"0.02 2 ( 1 2 )\n0.02 1 ( 1 )\n", "m.dat:2: the row has 1 value, but the first row has 2"},
       {"0 1 ( 1 )\n", "m.dat:1: dt 0 s is not possible; the step must be above 0 s"},
       {"time,0,0.2,0.1\nl_knee,0,1,2\n", "m.dat:1: time 0.1 s does not come after 0.2 s"},
       {"time [ms],0,200,100\nl_knee,0,1,2\n", "m.dat:1: time 0.1 s does not come after 0.2 s"},
       // The first cell of rows without names is lost, although the other rows count.
       {"# recorded\n,0,0.3,0,0,0,1,0\n0,0,0.3,0,0,0,1,0\n1,0,0.3,0,0,0,1,0\n",
        "m.dat:2: the first cell is empty, but only a column that counts the rows"},
       {"time,0,0.1,0.2\n", "no row of a joint below the row of times"}},
      "m.dat");
  ImportOptions options;
  options.by_order = true;
  expect_refused({{"0 0.1\n0.1 0.1\n0.2 0.1\n", "the file has 1 joint column, but 'hoap1' has 20"}},
                 "m.pos", options);
  options.by_order = false;
  options.joints = {"l_knee", "r_knee"};
  expect_refused(
      {{"0 0.1\n0.1 0.1\n0.2 0.1\n", "the file has 1 joint column, but --joints has 2 names"}},
      "m.pos", options);
  expect_refused({{"0 0.1\n", "name the .pos file beside it"}}, "m.waist", {.format = "hrpsys"});
}

TEST(MotionRefusals, Animations) {
  const auto curve = [](const std::string& keys, const std::string& actuator = "l_knee") {
    return "<ActuatorCurve fps=\"25\" actuator=\"" + actuator + "\">" + keys + "</ActuatorCurve>\n";
  };
  const std::string key = "<Key value=\"1\" frame=\"0\"/>";
  expect_refused(
      {{"<a>\n" + curve(key), "this is not valid XML: "},
       {"<a>\n" + curve(key) + "</a>\n<b/>\n", "a second <b> begins here, but a file has one"},
       {"<a>\n" + curve(key) + curve(key) + "</a>\n", "the actuator 'l_knee' has two curves"},
       {"<a>\n" + curve("") + "</a>\n", "the file has no key"},
       {"<a>\n" + curve("<Key value=\"1\"/>") + "</a>\n", "a key has no frame"},
       {"<a>\n" + curve(key + key) + "</a>\n", ":2: frame 0 does not come after frame 0"},
       {"<a>\n" + curve(key + "<Key value=\"1\" frame=\"-5\"/>") + "</a>\n",
        "frame -5 does not come after frame 0 of the key before; frames must increase"},
       {"<a fps=\"0\">\n" + curve(key) + "</a>\n", "m.qianim:1: fps is 0; give the number"},
       {"<a fps=\"many\">\n" + curve(key) + "</a>\n", "m.qianim:1: fps: 'many' is not a number"},
       {"<a fps=\"30\">\n" + curve(key) + "</a>\n",
        ":2: fps is 25, but another part of the file has 30"}},
      "m.qianim");
  // The rate that an editor shows is another one.
  std::string keys;
  for (int frame = 0; frame < 6; ++frame)
    keys += "<Key value=\"1\" frame=\"" + std::to_string(frame) + "\"/>";
  for (const std::string shown : {"30", "0"})
    EXPECT_NO_THROW(read_motion_rows("<a editor:fps=\"" + shown + "\">\n" + curve(keys) + "</a>\n",
                                     "m.qianim", hoap1(), {}));
}

// The rate and the times of rows, in whatever format they are stated.
TEST(MotionRefusals, RatesAndTimesThatNoMotionHas) {
  const auto rows = [](const std::vector<std::string>& times) {
    std::string text = "t[s],theta.l_knee[rad]\n";
    for (const std::string& time : times) text += time + ",0.1\n";
    return text;
  };
  expect_refused(
      {{rows({"0", "0.001", "0.002", "3599"}),
        "data row 4 comes 3599 s after the row before, but the time between two rows must be from "
        "0.01 ms to 10 s; correct the times, or cut the file where rows are missing"},
       {rows({"0", "1", "2", "100"}),
        "data row 4 comes 98 s after the row before, but the time between two rows must be from "
        "0.01 ms to 60 s"},
       {rows({"0", "1e-9", "2e-9"}), "the rows are 1e-06 ms apart"}},
      "m.csv");
  const auto curve_at = [](const std::string& rate) {
    return "<a><ActuatorCurve fps=\"" + rate +
           "\" actuator=\"l_knee\"><Key value=\"1\" frame=\"0\"/><Key value=\"2\" "
           "frame=\"1\"/></ActuatorCurve></a>";
  };
  expect_refused({{curve_at("1e300"), "the rows are 1e-297 ms apart"},
                  {curve_at("1e-300"), "data row 2 comes 1e+300 s after the row before"}},
                 "m.qianim");
  const std::string sequence_at = sequence("JointDisplacement", "    frame_rate: RATE\n" + kKnee);
  for (const std::string rate : {"1e300", "-5", "1e-300"}) {
    std::string text = body(sequence_at);
    text.replace(text.find("RATE"), 4, rate);
    expect_refused({{text, "the file states " + text::brief(std::stod(rate)) + " rows per second"}},
                   "m.yaml");
  }
  for (const double rate : {1e300, -1.0, std::nan("")})
    EXPECT_NE(error_message([&] { read_motion_rows("0.1\n", "m", hoap1(), {.rate = rate}); },
                            ErrorCode::usage)
                  .find("the rate of the rows is "),
              std::string::npos);
}

TEST(MotionRefusals, Trajectories) {
  const auto points = [](const std::string& text) {
    return "joint_names: [l_knee]\npoints:\n" + text;
  };
  const std::string time = "    time_from_start: {sec: 1, nanosec: 0}\n";
  expect_refused(
      {{"joint_names: []\npoints:\n  - positions: [0]\n" + time, "names of joints are needed"},
       {points("  - positions: [0]\n" + time + "  - positions: [1]\n" + time),
        "time 1 s does not come after 1 s"},
       {points("  - positions: [0, 1]\n" + time),
        "the point has 2 positions, but there are 1 joint"},
       {points("  - velocities: [0]\n" + time), "a point needs positions and time_from_start"},
       {points("  - positions: [x]\n" + time), "the positions are not finite numbers"},
       {points("  - positions: [0]\n    velocities: [x]\n" + time),
        "the velocities are not finite numbers"},
       {points("  - positions: [0]\n    effort: [1, 2]\n" + time),
        "effort has 2 values, but there are 1 joint"},
       {points("  - positions: [0]\n    time_from_start: {nanosec: 0}\n"),
        "time_from_start has no seconds"}},
      "m.yaml");
  const auto motion = [](const std::string& text) {
    return "play_motion2:\n  ros__parameters:\n    motions:\n      wave:\n" + text;
  };
  const std::string joints = "        joints: [l_knee]\n";
  expect_refused(
      {{motion(joints + "        times_from_start: [0, 1]\n"),
        "a motion needs joints, positions and times_from_start"},
       {motion(joints + "        positions: [0, 1, 2]\n        times_from_start: [0, 1]\n"),
        "the motion has 3 positions, but 1 joint at 2 times need 2"},
       {motion(joints + "        positions: [0, nan]\n        times_from_start: [0, 1]\n"),
        "or some of them are not finite numbers"},
       {motion(joints + "        positions: [[0], [1]]\n        times_from_start: [0, 1]\n"),
        "the positions must be one list of finite numbers, but here they are rows"},
       {motion(joints + "        positions: [0, 1]\n        times_from_start: [0, x]\n"),
        "the times are not finite numbers"},
       {"play_motion:\n  motions:\n    wave:\n      points:\n        - positions: [0]\n"
        "          time_from_start: 1\n    bow:\n      joints: [l_knee]\n",
        "a motion with points needs joints"}},
      "m.yaml");
}

// In an earlier version, numbers that were saved as text, and positions without bodies, ended the
// program by a memory error.
TEST(MotionRefusals, ArraysWithoutNumbers) {
  const size_t rows = 6, joints = static_cast<size_t>(hoap1().dof_count());
  const std::string fps = npy_numbers({50}, {1}),
                    angles = npy_numbers(std::vector<double>(rows * joints), {rows, joints}),
                    words = npy_words(std::vector<std::string>(rows * joints, "0"), {rows, joints}),
                    places = npy_numbers(std::vector<double>(rows * 3), {rows, 1, 3}),
                    none = npy_numbers({}, {rows, 0, 3}),
                    turns = npy_numbers(std::vector<double>(rows * 4, 0.5), {rows, 1, 4}),
                    no_turns = npy_numbers({}, {rows, 0, 4});
  const auto archive = [&](const std::string& joint_pos, const std::string& body_pos,
                           const std::string& body_quat) {
    return zip_of({{"fps.npy", fps},
                   {"joint_pos.npy", joint_pos},
                   {"body_pos_w.npy", body_pos},
                   {"body_quat_w.npy", body_quat}});
  };
  expect_refused(
      {{archive(words, places, turns), "joint_pos holds text; save it as numbers"},
       {archive(angles, none, turns), "body_pos_w is empty; save the motion again"},
       {archive(angles, places, no_turns), "body_quat_w is empty; save the motion again"}},
      "m.npz");
}

TEST(MotionRefusals, FilesBesideAFileOfAngles) {
  TemporaryFolder folder;
  const std::string main = (folder.path() / "m.pos").string();
  const std::string angles = "0 0.1\n0.01 0.1\n0.02 0.1\n0.03 0.1\n0.04 0.1\n0.05 0.1\n";
  write_file(main, angles);
  ImportOptions options;
  options.joints = {"l_knee"};
  const auto beside = [&](const std::string& extension, const std::string& row, int rows = 6) {
    std::string text;
    for (int k = 0; k < rows; ++k) text += "0.0" + std::to_string(k) + " " + row + "\n";
    write_file(folder.path() / ("m" + extension), text);
  };
  const auto message = [&] {
    return error_message([&] { read_motion_rows(angles, main, hoap1(), options); });
  };
  beside(".waist", "0 0 0.3 0 0 0", 2);
  EXPECT_NE(message().find("m.waist: this file has 2 rows, but the .pos file has 6"),
            std::string::npos)
      << message();
  beside(".waist", "0 0 0.3 0 0");
  EXPECT_NE(message().find("the row has 5 values after the time, but 6 or 12 or 18 are needed"),
            std::string::npos)
      << message();
  // The older form has the rotation as a matrix; .hip says another attitude; the ZMP hovers.
  beside(".waist", "0 0 0.3 1 0 0 0 1 0 0 0 1");
  beside(".hip", "0 0 0.1");
  beside(".zmp", "0 0 -0.2");
  beside(".torque", "1");
  const ImportedMotion read = read_motion_rows(angles, main, hoap1(), options);
  const std::string notes = notes_of(read);
  for (const char* const note :
       {"the .waist file differ by up to 5.7", "is up to 100 mm away from the ground",
        "the torques of the .torque file are left out"})
    EXPECT_NE(notes.find(note), std::string::npos) << notes;
  EXPECT_LE((matrix_to_rpy(read.motion.base.at(0).attitude.toRotationMatrix()) -
             Eigen::Vector3d(0, 0, 0.1))
                .norm(),
            1e-12);
}

}  // namespace
}  // namespace ayumi::test
