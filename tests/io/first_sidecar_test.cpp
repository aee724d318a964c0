#include "ayumi/io/robot/first_sidecar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/inverse_kinematics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_guess.hpp"
#include "ayumi/math/polygon.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/urdf_biped.hpp"

namespace ayumi::test {
namespace {

constexpr double kRightAngle = std::numbers::pi / 2;

RobotDescription read(const UrdfBiped& kind, const TemporaryFolder& folder) {
  return load_robot_description(folder.write(kind.name + ".urdf", kind.text()).string());
}

RobotGuess guess(const UrdfBiped& kind, const TemporaryFolder& folder) {
  return guess_robot(load_robot_description(folder.write(kind.name + ".urdf", kind.text()).string(),
                                            {}, {.guess = false}));
}

// The distance by which the knee is ahead of the line from hip to ankle, from the positions of the
// bodies alone.
double knee_ahead(const RobotModel& model, const std::string& side) {
  RobotData data(model);
  update_positions(model, model.rest_state(), data);
  const auto at = [&](const std::string& joint) {
    return Eigen::Vector3d(data.position[model.dofs()[model.find_dof(joint)].body]);
  };
  const Eigen::Vector3d hip = at(side + "hip_pitch"), knee = at(side + "knee"),
                        ankle = at(side + "ankle_pitch");
  const double share = (knee.z() - hip.z()) / (ankle.z() - hip.z());
  return knee.x() - (hip + share * (ankle - hip)).x();
}

TEST(FirstSidecar, AnyFacingGivesTheSameRobot) {
  const TemporaryFolder folder;
  const RobotModel x(read({}, folder));
  for (const auto& [angle, facing] : std::map<double, std::string>{
           {0, "x"}, {kRightAngle, "y"}, {-kRightAngle, "-y"}, {2 * kRightAngle, "-x"}})
    for (const bool named : {true, false}) {
      const RobotGuess turned = guess(
          {.facing = angle, .left = named ? "l_" : "one_", .right = named ? "r_" : "two_"}, folder);
      EXPECT_EQ(turned.facing, facing) << named;
      const RobotModel model(turned.robot);
      EXPECT_LT((model.posture() - x.posture()).norm(), 1e-4);
      for (const Side side : {Side::left, Side::right})
        for (size_t i = 0; i < 4; ++i)
          EXPECT_LT((model.sole(side).polygon[i] - x.sole(side).polygon[i]).norm(), 1e-6);
      RobotData data(model), same(x);
      update_positions(model, model.rest_state(), data);
      update_positions(x, x.rest_state(), same);
      EXPECT_LT((data.cog - same.cog).norm(), 1e-5);
    }
}

TEST(FirstSidecar, SolesAreNotWiderThanWhatTouches) {
  const TemporaryFolder folder;
  const UrdfBiped kind{.spheres = true};
  const RobotModel model(read(kind, folder));
  for (const Side side : {Side::left, Side::right}) {
    const auto& corners = model.sole(side).polygon;
    ASSERT_EQ(corners.size(), 4u);
    for (const Eigen::Vector2d& corner : corners) {
      EXPECT_NEAR(std::abs(corner.y()), 0.4 * kind.foot_width, 1e-9);
      EXPECT_NEAR(corner.x(), corner.x() > 0 ? 0.6 * kind.foot_length : -0.35 * kind.foot_length,
                  1e-9);
    }
  }
}

// A foot that is not level with every joint at 0, or at the limit nearest to 0, has the same sole
// as a foot that is level there.
TEST(FirstSidecar, SolesOfTiltedFeetAreThoseOfLevelOnes) {
  const TemporaryFolder folder;
  const RobotModel level(guess({.name = "level"}, folder).robot);
  for (const double tilt : {-0.3, 0.087, 0.3}) {
    std::string text = UrdfBiped{.name = "tilted"}.text();
    const std::regex ankle("(joint name=\"._ankle_pitch\".*?lower=\")[^\"]*(\" upper=\")[^\"]*");
    text = std::regex_replace(text, ankle,
                              "$01" + std::to_string(std::min(2 * tilt, tilt)) + "$02" +
                                  std::to_string(std::max(2 * tilt, tilt)));
    const RobotModel tilted(
        guess_robot(load_robot_description(folder.write("tilted.urdf", text).string(), {},
                                           {.guess = false}))
            .robot);
    ASSERT_TRUE(tilted.has_soles());
    for (const Side side : {Side::left, Side::right}) {
      const Sole &a = level.sole(side), &b = tilted.sole(side);
      EXPECT_LT((a.frame.translation() - b.frame.translation()).norm(), 1e-6) << tilt;
      EXPECT_LT((a.frame.linear() - b.frame.linear()).norm(), 1e-6) << tilt;
      ASSERT_EQ(a.polygon.size(), b.polygon.size());
      for (size_t i = 0; i < a.polygon.size(); ++i)
        EXPECT_LT((a.polygon[i] - b.polygon[i]).norm(), 1e-6) << tilt;
    }
  }
}

// A passive joint of 1 deg beside a motor with the same axis is the play of its gear; a passive
// joint across that axis, or one of 20 deg, is a joint. As in an MJCF file, passive joints have
// servos without gains.
TEST(FirstSidecar, PlayOfGearsBecomesBacklash) {
  const auto robot = [](double range, const Eigen::Vector3d& axis) {
    RobotDescription made;
    JointDescription motor, play;
    motor.name = "motor";
    motor.type = play.type = JointType::revolute;
    motor.parent = "base";
    motor.child = play.parent = "between";
    motor.axis = Eigen::Vector3d::UnitZ();
    motor.effort = 3;
    play.name = "play";
    play.child = "arm";
    play.axis = axis;
    play.has_limits = true;
    play.lower = -range / 2;
    play.upper = range / 2;
    made.joints = {motor, play};
    made.servos["motor"].kp = 10;
    made.servos["play"].viscous = 0.01;
    return made;
  };
  RobotDescription geared = robot(kRightAngle / 90, -Eigen::Vector3d::UnitZ());
  EXPECT_EQ(hold_play_of_gears(geared), std::vector<std::string>{"play"});
  EXPECT_EQ(geared.joints[1].type, JointType::fixed);
  EXPECT_NEAR(geared.servos.at("motor").backlash, kRightAngle / 90, 1e-15);
  EXPECT_FALSE(geared.servos.contains("play"));
  EXPECT_TRUE(gaps_of_the_files(geared, 0).empty());  // a joint that is held is no passive joint
  RobotDescription across = robot(kRightAngle / 90, Eigen::Vector3d::UnitX());
  EXPECT_TRUE(hold_play_of_gears(across).empty());
  RobotDescription wide = robot(20 * kRightAngle / 90, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(hold_play_of_gears(wide).empty());
  EXPECT_EQ(gaps_of_the_files(wide, 0),
            std::vector<std::string>{"joints without an actuator are passive: play"});
}

TEST(FirstSidecar, HomeIsBalancedInsideTheLimits) {
  const TemporaryFolder folder;
  for (const UrdfBiped& kind :
       {UrdfBiped{}, UrdfBiped{.size = 2.6, .mass = 4.2, .hips = "pry"}, UrdfBiped{.hips = "rpy"},
        UrdfBiped{.ankle_roll = false}, UrdfBiped{.coupled_hips = true},
        UrdfBiped{.thigh = 0.2, .shank = 0.15}}) {
    const RobotModel model(read(kind, folder));
    RobotData data(model);
    RobotState home = model.rest_state();
    update_positions(model, home, data);
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Side side : {Side::left, Side::right}) {
      const Sole& sole = model.sole(side);
      const Eigen::Isometry3d pose = sole_pose(model, data, side);
      middle += 0.5 * (pose * Eigen::Vector3d(sole.center.x(), sole.center.y(), 0));
      EXPECT_GT(pose.linear()(2, 2), 1 - 1e-8);  // the sole is level
    }
    EXPECT_LT((data.cog - middle).head<2>().norm(), 1e-4 * kind.size);
    for (const std::string side : {"l_", "r_"}) EXPECT_GT(knee_ahead(model, side), 0.02);
    for (int i = 0; i < model.dof_count(); ++i) {
      EXPECT_GE(home.theta[i], model.dofs()[i].lower);
      EXPECT_LE(home.theta[i], model.dofs()[i].upper);
    }
  }
}

TEST(FirstSidecar, KneesOfOpposedAxesBothComeForward) {
  const TemporaryFolder folder;
  const RobotModel model(read({.opposed = true, .placeholders = true}, folder));
  EXPECT_GT(knee_ahead(model, "l_"), 0.02);
  EXPECT_GT(knee_ahead(model, "r_"), 0.02);
  const Eigen::VectorXd home = model.posture();
  EXPECT_NEAR(home[model.find_dof("l_knee")], -home[model.find_dof("r_knee")], 1e-4);
  EXPECT_EQ(direction_in_words(model, model.find_dof("l_knee")), "a positive angle bends the knee");
  EXPECT_EQ(direction_in_words(model, model.find_dof("r_knee")),
            "a positive angle straightens the knee");
  EXPECT_EQ(direction_in_words(model, model.find_dof("l_hip_pitch")),
            "a positive angle swings the leg back");
  EXPECT_EQ(direction_in_words(model, model.find_dof("r_ankle_pitch")),
            "a positive angle turns the toes up");
  EXPECT_EQ(direction_in_words(model, model.find_dof("l_shoulder")),
            "a positive angle moves l_arm back");
}

// The values are those of a torque-controlled robot of 28 kg: efforts differ from joint to joint.
TEST(FirstSidecar, ServosFollowTheEffortOfEachJoint) {
  const TemporaryFolder folder;
  UrdfBiped kind{.size = 2.6, .mass = 4.2};
  kind.effort = [](const std::string& joint) {
    return joint.ends_with("knee") ? 139.0 : joint.ends_with("shoulder") ? 25.0 : 88.0;
  };
  const RobotGuess guessed = guess(kind, folder);
  EXPECT_TRUE(guessed.placeholders.empty());
  const auto& servos = guessed.robot.servos;
  EXPECT_NEAR(servos.at("l_shoulder").kp, 25 / 0.2, 0.5);
  const RobotModel model(guessed.robot);
  // For the knee, the effort limit divided by 0.2 rad (139 N m / 0.2 rad) is less than the 20 m g z
  // per rad that a leg needs, so kp is 20 m g z.
  RobotData data(model);
  update_positions(model, model.rest_state(), data);
  const double z = data.cog.z() - sole_pose(model, data, Side::left).translation().z();
  EXPECT_NEAR(servos.at("l_knee").kp / (20 * model.mass() * 9.80665 * z), 1, 0.1);
  EXPECT_NEAR(servos.at("l_knee").rotor_inertia / servos.at("l_hip_roll").rotor_inertia, 139. / 88,
              0.1);
}

// In the air, a joint that turns at 1 rad/s makes the root link move so that the momentum stays
// zero. Twice the kinetic energy of this motion is the inertia that the joint moves, and its servo
// damps this inertia critically: kd = 2 sqrt(kp I). The root of the robot has no influence.
TEST(FirstSidecar, ServosDampTheirLimbCritically) {
  const TemporaryFolder folder;
  const RobotModel model(guess({}, folder).robot);
  const auto moving = [&](int row) {
    RobotState state = model.rest_state();
    Eigen::VectorXd rates = Eigen::VectorXd::Zero(model.velocity_count());
    rates[row] = 1;
    state.base_velocity = rates.head<3>();
    state.base_angular_velocity = rates.segment<3>(3);
    state.dtheta = rates.tail(model.dof_count());
    return state;
  };
  const auto momentum = [&](const RobotState& state) {
    RobotData data(model);
    update_velocities(model, state, data);
    const Momentum h = centroidal_momentum(model, data);
    Eigen::Matrix<double, 6, 1> both;
    both << h.linear, h.angular;
    return both;
  };
  Eigen::MatrixXd of_base(6, 6);
  for (int row = 0; row < 6; ++row) of_base.col(row) = momentum(moving(row));
  for (int i = 0; i < model.dof_count(); ++i) {
    RobotState state = moving(6 + i);
    const Eigen::VectorXd base = -solve_dense(of_base, momentum(state));
    state.base_velocity = base.head<3>();
    state.base_angular_velocity = base.tail<3>();
    RobotData data(model);
    update_velocities(model, state, data);
    double inertia = 0;
    for (size_t b = 0; b < model.bodies().size(); ++b) {
      const Inertia& body = model.bodies()[b].inertia;
      const Eigen::Vector3d w = data.angular_velocity[b];
      const Eigen::Vector3d own = data.rotation[b].transpose() * w;
      const Eigen::Vector3d v = data.velocity[b] + w.cross(data.com[b] - data.position[b]);
      inertia += body.mass * v.squaredNorm() + own.dot(body.about_com * own);
    }
    const ServoDescription& servo = model.limits().servo[static_cast<size_t>(i)];
    // kd is rounded to two digits.
    EXPECT_NEAR(servo.kd, 2 * std::sqrt(servo.kp * (inertia + servo.rotor_inertia)),
                0.05 * servo.kd)
        << model.dofs()[static_cast<size_t>(i)].name;
  }
}

TEST(FirstSidecar, PlaceholdersAreNamed) {
  const TemporaryFolder folder;
  const std::vector<PlaceholderLimits> found = guess({.placeholders = true}, folder).placeholders;
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].what + " " + found[0].value, "position limits -162 to 162 deg");
  EXPECT_EQ(found[1].what + " " + found[1].value, "speed limits 100 rad/s");
  EXPECT_EQ(found[2].what + " " + found[2].value, "effort limits 1000 N m");
  for (const PlaceholderLimits& each : found) EXPECT_EQ(each.joints.size(), 14u);
  EXPECT_TRUE(guess({}, folder).placeholders.empty());
}

// All joints of a leg are listed, also those that only keys move.
TEST(FirstSidecar, NamesTheJointsOfLongLegs) {
  const TemporaryFolder folder;
  const std::string urdf = folder.write("seven.urdf", UrdfBiped{.hips = "yrpt"}.text()).string();
  const std::vector<std::string> to_do = first_sidecar(urdf, folder.path() / "seven").to_do;
  const auto says = [&](const std::string& words) {
    return std::any_of(to_do.begin(), to_do.end(), [&](const std::string& item) {
      return item.find(words) != std::string::npos;
    });
  };
  EXPECT_TRUE(says("hip pitch l_hip_pitch, hip yaw l_thigh_turn, knee l_knee"));
  EXPECT_TRUE(says("for these joints if they should move: l_thigh_turn, r_thigh_turn. Six joints"));
}

// The limits of the arms may be true although those of the legs are placeholders.
TEST(FirstSidecar, PlaceholdersOfTheLegsAloneAreNamed) {
  const TemporaryFolder folder;
  std::string urdf = UrdfBiped{.placeholders = true}.text();
  for (const char* const side : {"l_", "r_"}) {
    const size_t joint = urdf.find("<joint name=\"" + std::string(side) + "shoulder\"");
    ASSERT_NE(joint, std::string::npos);
    const size_t limit = urdf.find("<limit", joint);
    urdf.replace(limit, urdf.find("/>", limit) - limit,
                 "<limit lower=\"-2.5\" upper=\"2.5\" effort=\"3\" velocity=\"8\"");
  }
  const RobotModel model(load_robot_description(folder.write("legs.urdf", urdf).string()));
  const std::vector<PlaceholderLimits> found = placeholder_limits(model);
  ASSERT_EQ(found.size(), 3u);
  for (const PlaceholderLimits& each : found) EXPECT_EQ(each.joints.size(), 12u) << each.what;
}

// The sidecar that is written reads back as the values that were guessed for the bare URDF.
TEST(FirstSidecar, ReadsBackAsItWasGuessed) {
  const TemporaryFolder folder;
  for (const UrdfBiped& kind : {UrdfBiped{.name = "turned", .facing = -kRightAngle},
                                UrdfBiped{.name = "five", .ankle_roll = false},
                                UrdfBiped{.name = "coupled", .coupled_hips = true}}) {
    const std::string urdf = folder.write(kind.name + ".urdf", kind.text()).string();
    const FirstSidecar sidecar = first_sidecar(urdf, folder.path() / kind.name);
    const RobotModel bare(load_robot_description(urdf)),
        stated(load_robot_description(folder.write(kind.name + "/robot.json", sidecar.text)));
    EXPECT_EQ(inferred_soles(bare.description()), inferred_soles(stated.description()));
    EXPECT_TRUE(inferred_soles(bare.description())
                    .starts_with("soles inferred from the points of the feet that are at most 1 mm "
                                 "above the ground: left l_foot, 130 x 70 mm, 4 corners; "));
    // A sole that was measured is no longer inferred, whatever the sidecar's sentences say.
    const std::regex mark("\"inferred_from\": \"shapes\",");
    const std::string words = "\"assumptions\": [\"" + inferred_soles(bare.description()) + "\"],";
    const RobotModel measured(load_robot_description(folder.write(
        kind.name + "/robot.json", std::regex_replace(sidecar.text, mark, "")
                                       .insert(sidecar.text.find("\"soles\": {"), words))));
    EXPECT_EQ(inferred_soles(measured.description()), "");
    for (const std::string& each : stated.description().assumptions)
      EXPECT_TRUE(each.find("placeholders") != std::string::npos ||
                  each == inferred_soles(stated.description()))
          << each;
    EXPECT_LT((bare.posture() - stated.posture()).norm(), 1e-9);
    EXPECT_EQ(bare.description().servos, stated.description().servos);
    for (const Side side : {Side::left, Side::right}) {
      EXPECT_LT((bare.sole(side).frame.matrix() - stated.sole(side).frame.matrix()).norm(), 1e-5);
      for (size_t i = 0; i < bare.sole(side).polygon.size(); ++i) {
        const Eigen::Vector2d wide = bare.sole(side).polygon[i],
                              narrow = stated.sole(side).polygon[i];
        EXPECT_LT((wide - narrow).norm(), 2e-4);
        EXPECT_LE(std::abs(narrow.y()), std::abs(wide.y()) + 1e-8);
      }
      EXPECT_NEAR(stated.sole(side).stiffness / bare.sole(side).stiffness, 1, 0.01);
    }
    for (const char* word :
         {"Facing", "Trunk", "Soles", "Softness", "Home posture", "Servos", "Motors", "Sensors"})
      EXPECT_NE(sidecar.text.find(std::string("// ") + word), std::string::npos) << word;
    EXPECT_GE(sidecar.to_do.size(), 6u);
  }
}

// Rounding to tenths of a millimetre leaves the outline of round edges convex and inside the true
// outline.
TEST(FirstSidecar, SolesOfCylindersStayConvex) {
  const TemporaryFolder folder;
  for (const double width : {0.03, 0.0401, 0.0532, 0.0707}) {
    const UrdfBiped kind{.rollers = true, .foot_width = width};
    const std::string urdf = folder.write("robot.urdf", kind.text()).string();
    const FirstSidecar sidecar = first_sidecar(urdf, folder.path() / "robot");
    const RobotModel bare(load_robot_description(urdf)),
        stated(load_robot_description(folder.write("robot/robot.json", sidecar.text)));
    for (const Side side : {Side::left, Side::right}) {
      const ConvexPolygon whole(bare.sole(side).polygon);
      double length = 0;
      for (const Eigen::Vector2d& corner : stated.sole(side).polygon) {
        EXPECT_GT(whole.margin(corner), -1e-7) << width;
        length = std::max(length, std::abs(corner.x()));
      }
      EXPECT_NEAR(length, 0.08, 2e-4) << width;
    }
  }
}

bool has_item(const FirstSidecar& sidecar, const std::string& begin) {
  return std::any_of(sidecar.to_do.begin(), sidecar.to_do.end(),
                     [&](const std::string& item) { return item.starts_with(begin); });
}

// A foot with a narrow underside and a wider part 3 mm above it has a rounded sole; the list of a
// robot with flat feet says nothing.
TEST(FirstSidecar, RoundedSolesAreOnTheList) {
  const TemporaryFolder folder;
  std::string text = UrdfBiped{}.text();
  const std::string item = "The undersides of the feet are rounded: the sole of the left foot ";
  EXPECT_FALSE(
      has_item(first_sidecar(folder.write("flat.urdf", text).string(), folder.path()), item));
  const std::string flat = "<box size=\"0.13 0.07 0.025\"/></geometry></collision>";
  ASSERT_NE(text.find(flat), std::string::npos) << text;
  for (size_t at; (at = text.find(flat)) != std::string::npos;)
    text.replace(at, flat.size(),
                 "<box size=\"0.13 0.02 0.025\"/></geometry></collision><collision><origin "
                 "xyz=\"0.015 0 -0.0245\"/><geometry><box size=\"0.130 0.07 0.025\"/></geometry>"
                 "</collision>");
  EXPECT_TRUE(
      has_item(first_sidecar(folder.write("round.urdf", text).string(), folder.path()), item));
}

// Masses in grams and limits in degrees are named as such.
TEST(FirstSidecar, OtherUnitsAreNamed) {
  const TemporaryFolder folder;
  const std::string text = UrdfBiped{}.text();
  const std::string grams =
      std::regex_replace(text, std::regex("mass value=\"([0-9.]+)\""), "mass value=\"$01e4\"");
  try {
    first_sidecar(folder.write("grams.urdf", grams).string(), folder.path());
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("heavier than a cube of lead"), std::string::npos)
        << error.what();
  }
  UrdfBiped large;
  large.size = 1000;
  try {
    first_sidecar(folder.write("millimetres.urdf", large.text()).string(), folder.path());
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("millimetres.urdf: the robot weighs"),
              std::string::npos)
        << error.what();
    EXPECT_NE(
        std::string(error.what()).find("if the lengths are in millimetres, divide them by 1000"),
        std::string::npos)
        << error.what();
  }
  const std::string degrees =
      std::regex_replace(text, std::regex("upper=\"[0-9.]+\""), "upper=\"60\"");
  EXPECT_TRUE(has_item(first_sidecar(folder.write("degrees.urdf", degrees).string(), folder.path()),
                       "Check the position limits of "));
}

// Whether the remarks contain these words, wherever their lines end.
bool says(std::string text, const std::string& words) {
  const std::string line_end = "\n  // ";
  for (size_t at = 0; (at = text.find(line_end, at)) != std::string::npos;)
    text.replace(at, line_end.size(), " ");
  return text.find(words) != std::string::npos;
}

// The trunk is the link that carries both legs, whichever link the file begins with. Soles and legs
// are named.
TEST(FirstSidecar, TheTrunkCarriesBothLegs) {
  const TemporaryFolder folder;
  std::string text = UrdfBiped{}.text();
  const FirstSidecar plain =
      first_sidecar(folder.write("plain.urdf", text).string(), folder.path());
  EXPECT_TRUE(says(plain.text, "Guess: this is the root link, which carries both legs"));
  EXPECT_NE(plain.text.find("\"trunk_link\": \"trunk\""), std::string::npos);
  std::string said;
  for (const std::string& item : plain.to_do) said += item + "\n";
  EXPECT_NE(said.find("the left sole (link l_foot) is 130 mm long and 70 mm wide, and reaches 80 "
                      "mm ahead of the ankle "
                      "and 50 mm behind the ankle; the right sole (link r_foot)"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("Left: hip yaw l_hip_yaw, hip roll l_hip_roll, hip pitch l_hip_pitch, knee "
                      "l_knee, ankle pitch l_ankle_pitch, ankle roll l_ankle_roll. Right: hip yaw "
                      "r_hip_yaw"),
            std::string::npos)
      << said;
  // The chest carries the pelvis, which is still named "trunk", by a waist joint.
  text.replace(
      text.find("</robot>"), 8,
      "<link name=\"chest\"><inertial><origin xyz=\"0 0 0.1\"/><mass value=\"1\"/><inertia "
      "ixx=\"0.005\" iyy=\"0.005\" izz=\"0.005\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>"
      "</inertial></link><joint name=\"waist\" type=\"revolute\"><parent link=\"chest\"/>"
      "<child link=\"trunk\"/><origin xyz=\"0 0 -0.1\"/><axis xyz=\"0 0 1\"/><limit "
      "lower=\"-1\" upper=\"1\" effort=\"10\" velocity=\"8\"/></joint></robot>");
  const FirstSidecar chest =
      first_sidecar(folder.write("chest.urdf", text).string(), folder.path());
  EXPECT_NE(chest.text.find("\"trunk_link\": \"trunk\""), std::string::npos) << chest.text;
  EXPECT_TRUE(says(chest.text, "Guess: this is the link that carries both legs"));
}

// Inertias of 1 kg m^2 and impossible inertias are replaced by those of boxes; the others stay.
TEST(FirstSidecar, PlaceholdersOfInertiasBecomeThoseOfTheShapes) {
  const TemporaryFolder folder;
  const std::string good = UrdfBiped{}.text();
  const RobotModel right(load_robot_description(folder.write("good.urdf", good).string()));
  EXPECT_EQ(
      first_sidecar((folder.path() / "good.urdf").string(), folder.path()).text.find("\"links\""),
      std::string::npos);
  std::string text = good;
  const auto spoil = [&](const std::string& link, const std::string& tensor) {
    const size_t begin = text.find("ixx=\"", text.find("<link name=\"" + link + "\""));
    text.replace(begin, text.find("ixy", begin) - begin, tensor);
  };
  spoil("l_thigh", "ixx=\"1\" iyy=\"1\" izz=\"1\" ");
  spoil("r_foot", "ixx=\"1e-4\" iyy=\"1e-4\" izz=\"9e-4\" ");
  const FirstSidecar sidecar =
      first_sidecar(folder.write("bad.urdf", text).string(), folder.path());
  const RobotModel mended(load_robot_description(folder.write("robot.json", sidecar.text)));
  for (const char* name : {"l_thigh", "r_foot", "trunk"}) {
    const auto inertia = [&](const RobotModel& model) {
      return model.links()[static_cast<size_t>(model.find_link(name))].inertia;
    };
    EXPECT_LT((inertia(mended).about_com - inertia(right).about_com).norm(),
              1e-3 * inertia(right).about_com.norm())
        << name;
    EXPECT_EQ(inertia(mended).mass, inertia(right).mass);
  }
  EXPECT_NE(sidecar.to_do.back().find("Replace the inertia of 2 links (l_thigh, r_foot)"),
            std::string::npos)
      << sidecar.to_do.back();
  // The gains are those for the true inertias. With 1 kg m^2 in a thigh, the damping of the hip
  // would be many times larger, and the targets would lead the motion by half a second.
  const RobotModel guessed(load_robot_description((folder.path() / "good.urdf").string()));
  for (const auto& [joint, servo] : guessed.description().servos)
    EXPECT_NEAR(mended.description().servos.at(joint).kd, servo.kd, 0.02 * servo.kd) << joint;
}

// What a sidecar says only of some robots: other names of the joints, packages, gains of the
// control law, and what the file does not state or states only because its format requires a
// number.
TEST(FirstSidecar, SaysWhatTheFileDoesNotState) {
  const TemporaryFolder folder;
  const UrdfBiped kind{.placeholders = true, .left = "one_", .right = "two_"};
  const std::string robot = folder.write("robot/robot.urdf", kind.text()).string();
  std::filesystem::create_directories(folder.path() / "packages");
  RobotSearch search;
  search.packages = {folder.path() / "packages"};
  const FirstSidecar first =
      first_sidecar(robot, folder.path() / "robot", search, [](const RobotModel&) {
        return SidecarGains{{{"K_P", 2.5}}, "the servos are soft", "the gains", "Check the gains."};
      });
  for (const char* const part :
       {"\"package_path\": [\"../packages\"]", "\"control\": { \"dtad\": { \"K_P\": 2.5 } }",
        "\"l_hip_yaw\": \"one_hip_yaw\"", "\"r_knee\": \"two_knee\"",
        "Placeholder: the URDF states effort limits of 1000 N m for 14 joints"})
    EXPECT_NE(first.text.find(part), std::string::npos) << part << "\n" << first.text;
  EXPECT_TRUE(says(first.text, "State the true limits in \"position_limits_deg\"."));
  folder.write("robot/robot.json", first.text);
  const RobotDescription read =
      load_robot_description((folder.path() / "robot").string(), {}, {.guess = false});
  EXPECT_EQ(read.aliases.at("r_ankle_roll"), "two_ankle_roll");
  EXPECT_EQ(read.control.dtad.at("K_P"), 2.5);
  const auto listed = [](const FirstSidecar& sidecar, const std::string& part) {
    return std::any_of(sidecar.to_do.begin(), sidecar.to_do.end(), [&](const std::string& item) {
      return item.find(part) != std::string::npos;
    });
  };
  EXPECT_TRUE(listed(first, "Replace the effort limits of 1000 N m on 14 joints, because"));
  // Limits of 0 are not stated.
  const UrdfBiped bare{.effort = [](const std::string&) { return 0; }, .speed = 0};
  const FirstSidecar unlimited =
      first_sidecar(folder.write("bare.urdf", bare.text()).string(), folder.path() / "bare");
  EXPECT_TRUE(listed(unlimited,
                     "The robot's file states no speed limit for 14 joints, and no torque limit "
                     "for 14 joints. Without these limits, `ayumi check` cannot say"));
}

TEST(FirstSidecar, RefusesARobotThatHasOne) {
  const TemporaryFolder folder;
  folder.write("robot/robot.urdf", UrdfBiped{}.text());
  const std::string robot = (folder.path() / "robot").string();
  folder.write("robot/robot.json", first_sidecar(robot, robot).text);
  EXPECT_THROW(first_sidecar(robot, robot), Error);
}

// The text of a biped whose legs have meshes that do not exist, in the place of their shapes.
std::string biped_without_meshes(const UrdfBiped& kind = {}) {
  std::string text = kind.text();
  for (const std::string side : {"l_", "r_"})
    for (const std::string link : {"thigh", "shank", "foot"}) {
      const size_t from = text.find("<link name=\"" + side + link);
      const size_t shape = text.find("<visual>", from), end = text.find("</link>", from);
      if (shape >= end) throw std::logic_error("the link has no shape");
      text.replace(
          shape, end - shape,
          "<visual><geometry><mesh filename=\"" + side + link + ".stl\"/></geometry></visual>");
    }
  return text;
}

// In an earlier version, with the meshes of the legs missing, the hands were taken for feet, and
// `init` failed because the COG was below them. Later, such a robot had no soles. The feet of this
// robot are boxes, so that their inertias give the true soles; also those of a robot that is turned
// against its root link.
TEST(FirstSidecar, TheInertiasOfFeetGiveTheSolesWhereTheMeshesAreMissing) {
  for (const double facing : {0.0, 0.5}) {
    SCOPED_TRACE(facing);
    const TemporaryFolder folder;
    const RobotModel whole(read({.name = "whole", .facing = facing}, folder));
    const std::string file =
        folder.write("r.urdf", biped_without_meshes({.facing = facing})).string();
    const FirstSidecar sidecar = first_sidecar(file, folder.path() / "r");
    ASSERT_EQ(sidecar.robot.soles.size(), 2u);
    EXPECT_TRUE(has_item(sidecar, "Measure the soles and state them. The feet have no shapes"));
    EXPECT_TRUE(says(sidecar.text, "the feet have no shapes, so Ayumi takes each foot as a box"));
    const RobotModel model(load_robot_description(file));
    for (const Side side : {Side::left, Side::right}) {
      const Sole &found = model.sole(side), &real = whole.sole(side);
      ASSERT_EQ(found.polygon.size(), real.polygon.size());
      for (size_t i = 0; i < real.polygon.size(); ++i)
        EXPECT_LT((found.polygon[i] - real.polygon[i]).norm(), 1e-6)
            << found.polygon[i].transpose();
      EXPECT_LT((found.frame.translation() - real.frame.translation()).norm(), 1e-6);
    }
    EXPECT_TRUE(
        std::any_of(sidecar.to_do.begin(), sidecar.to_do.end(), [](const std::string& item) {
          return item.find("6 meshes are missing and left out: ") != std::string::npos &&
                 item.find("r_foot.stl") == std::string::npos &&
                 item.find(" and 3 more (`ayumi inspect` lists all of them). ") !=
                     std::string::npos;
        }));
    EXPECT_TRUE(std::any_of(model.description().assumptions.begin(),
                            model.description().assumptions.end(), [](const std::string& all) {
                              return all.find("l_thigh.stl of link l_thigh") != std::string::npos &&
                                     all.find("r_foot.stl of link r_foot") != std::string::npos;
                            }));
    EXPECT_TRUE(says(inferred_soles(model.description()), "masses and inertias of the feet"));
  }
}

// The principal axes of a square foot are arbitrary: a product of inertia that is 0.2 % of a moment
// would turn them by 45 deg, and the corners of the sole would be 71 mm ahead of its centre.
TEST(FirstSidecar, SquareFeetWithoutShapesAreNotTurned) {
  for (const double width : {0.1, 0.098}) {
    const TemporaryFolder folder;
    std::string text = biped_without_meshes({.foot_length = 0.1, .foot_width = width});
    for (const char* const link : {"l_foot", "r_foot"}) {
      const size_t from = text.find("ixy=\"", text.find("<link name=\"" + std::string(link))) + 5;
      text.replace(from, text.find('"', from) - from, "1e-5");
    }
    const RobotModel model(load_robot_description(folder.write("r.urdf", text).string()));
    for (const Side side : {Side::left, Side::right}) {
      Eigen::AlignedBox2d sole;
      for (const Eigen::Vector2d& corner : model.sole(side).polygon) sole.extend(corner);
      EXPECT_NEAR(sole.sizes().x(), 0.1, 1e-6);
      EXPECT_NEAR(sole.sizes().y(), width, 1e-6);
    }
  }
}

// DARwIn-OP's file has inertias of bodies of more than 1 m. Feet without shapes get the inertia of
// a sphere with the density of water. The box of this inertia is a cube.
TEST(FirstSidecar, FeetWithoutMeshesAndUsableInertiasHaveSmallSoles) {
  const TemporaryFolder folder;
  std::string text = biped_without_meshes();
  for (const std::string side : {"l_", "r_"}) {
    const size_t foot = text.find("<link name=\"" + side + "foot");
    for (const std::string moment : {"ixx=\"", "iyy=\"", "izz=\""}) {
      const size_t from = text.find(moment, foot) + moment.size();
      text.replace(from, text.find('"', from) - from, "1");
    }
  }
  const FirstSidecar sidecar =
      first_sidecar(folder.write("r.urdf", text).string(), folder.path() / "r");
  EXPECT_TRUE(has_item(sidecar, "Measure the soles and state them. The feet have no shapes"));
  EXPECT_TRUE(says(sidecar.text,
                   "A link without shapes has the inertia of a sphere with the density of water"));
  EXPECT_TRUE(says(sidecar.text, "from \"links\" if this sidecar states them"));
  const RobotModel model(sidecar.robot);
  for (const Side side : {Side::left, Side::right}) {
    ASSERT_EQ(model.sole(side).polygon.size(), 4u);
    const double mass = model.bodies()[model.sole(side).body].inertia.mass;
    const Eigen::Vector2d size = model.sole(side).polygon[2] - model.sole(side).polygon[0];
    const double radius = std::cbrt(0.75 * mass / (std::numbers::pi * 1000));
    EXPECT_NEAR(std::abs(size.x()), std::sqrt(6 * 0.4) * radius, 1e-6);
    EXPECT_NEAR(std::abs(size.y()), std::sqrt(6 * 0.4) * radius, 1e-6);
  }
}

// A robot without shapes whose limbs hang down from its base or from an arm of two joints.
std::string limbs_without_shapes(int limbs, int joints, bool on_an_arm) {
  const std::string inertial =
      "<inertial><origin xyz=\"0 0 -0.02\"/><mass value=\"0.2\"/><inertia ixx=\"1e-4\" "
      "iyy=\"1e-4\" "
      "izz=\"1e-4\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>";
  std::string text = "<robot name=\"limbs\"><link name=\"base\">" + inertial + "</link>";
  const auto add = [&](const std::string& parent, const std::string& link, double x, double y,
                       double z) {
    text += "<link name=\"" + link + "\">" + inertial + "</link><joint name=\"j_" + link +
            "\" type=\"revolute\"><parent link=\"" + parent + "\"/><child link=\"" + link +
            "\"/><origin xyz=\"" + std::to_string(x) + " " + std::to_string(y) + " " +
            std::to_string(z) +
            "\"/><axis xyz=\"0 1 0\"/><limit lower=\"-2\" upper=\"2\" effort=\"20\" "
            "velocity=\"8\"/></joint>";
  };
  if (on_an_arm) {
    add("base", "upper", 0, 0, 0);
    add("upper", "lower", 0, 0, -0.2);
  }
  for (int limb = 0; limb < limbs; ++limb) {
    std::string parent = on_an_arm ? "lower" : "base";
    for (int joint = 0; joint < joints; ++joint) {
      const std::string link = "limb" + std::to_string(limb) + "_" + std::to_string(joint);
      if (joint == 0)
        add(parent, link, limb < 2 ? 0.1 : -0.1, limb % 2 == 0 ? 0.1 : -0.1, on_an_arm ? -0.2 : 0);
      else
        add(parent, link, 0, 0, -0.2);
      parent = link;
    }
  }
  return text + "</robot>";
}

// Without shapes, two of the feet of a robot with four legs, and fingers of an arm that hangs down,
// are not the feet of a robot with two legs.
TEST(FirstSidecar, FeetOfFourLegsAndFingersGetNoSoles) {
  const TemporaryFolder folder;
  const auto soles = [&](const std::string& name, const std::string& text) {
    return first_sidecar(folder.write(name, text).string(), folder.path() / "r").robot.soles.size();
  };
  EXPECT_EQ(soles("two.urdf", limbs_without_shapes(2, 4, false)), 2u);
  EXPECT_EQ(soles("four.urdf", limbs_without_shapes(4, 4, false)), 0u);
  EXPECT_EQ(soles("fingers.urdf", limbs_without_shapes(2, 1, true)), 0u);
}

// The feet are found even if a lower link exists that has no shape and does not belong to a leg,
// such as the end of a tether.
TEST(FirstSidecar, ALowLinkWithoutAShapeHidesNoFeet) {
  const TemporaryFolder folder;
  std::string text = UrdfBiped{}.text();
  text.insert(text.rfind("</robot>"),
              "<link name=\"end\"><inertial><mass value=\"0.01\"/><inertia ixx=\"1e-6\" "
              "ixy=\"0\" ixz=\"0\" iyy=\"1e-6\" iyz=\"0\" izz=\"1e-6\"/></inertial></link>"
              "<joint name=\"tether\" type=\"revolute\"><parent link=\"trunk\"/><child "
              "link=\"end\"/><origin xyz=\"0 0 -2\"/><axis xyz=\"0 1 0\"/><limit lower=\"-1\" "
              "upper=\"1\" effort=\"1\" velocity=\"1\"/></joint>");
  const FirstSidecar sidecar =
      first_sidecar(folder.write("r.urdf", text).string(), folder.path() / "r");
  EXPECT_EQ(sidecar.robot.soles.size(), 2u);
}

}  // namespace
}  // namespace ayumi::test
