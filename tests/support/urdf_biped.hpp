#pragma once
// The text of a URDF of a two-legged robot, as they occur in practice: with legs that stand
// straight at 0, in several kinds.

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/urdf.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi::test {

struct UrdfBiped {
  std::string name = "robot";
  double size = 1;  ///< factor on lengths
  double mass = 1;  ///< factor on masses
  /// Order of yaw, inclined yaw (i), roll, pitch and turn of the thigh (t) from the trunk outwards.
  std::string hips = "yrp";
  double facing = 0;          ///< turn of the whole robot about z [rad]
  bool opposed = false;       ///< axes of the right leg point the other way
  bool ankle_roll = true;     ///< without it, legs have five joints
  bool coupled_hips = false;  ///< one skew joint moves both hips
  bool placeholders = false;  ///< +-162 deg, 100 rad/s and 1000 N m for every joint
  bool spheres = false;       ///< feet touch with four spheres of 5 mm radius
  bool rollers = false;       ///< feet touch with two cylinders that lie along them
  bool tandem_knee = false;   ///< the knee has two joints, and the second one mimics the first
  bool toes = false;          ///< a toe at the front of each foot touches the ground
  std::string left = "l_", right = "r_";
  double hip = 0.05, thigh = 0.12, shank = 0.12, ankle = 0.04, foot_length = 0.13,
         foot_width = 0.07;    ///< width of the feet [m]
  double trunk_bottom = 0.03;  ///< height above the hips [m]
  /// Height of a wide cylinder at the ankle above the ground [m]; 0 if there is none.
  double ankle_shape = 0;
  std::function<double(const std::string&)> effort = [](const std::string&) { return 10; };
  double speed = 8;  ///< limit of speed [rad/s]

  std::string text() const {
    using text::exact;
    const double c = std::cos(facing), s = std::sin(facing);
    const auto numbers = [](double x, double y, double z) {
      return text::brief(x, 9) + " " + text::brief(y, 9) + " " + text::brief(z, 9);
    };
    const auto turned = [&](double x, double y, double z) {
      return numbers(c * x - s * y, s * x + c * y, z);
    };
    const auto place = [&](double x, double y, double z) {
      return turned(size * x, size * y, size * z);
    };
    const std::string yaw = "rpy=\"0 0 " + text::brief(facing, 9) + "\"";
    std::string urdf = "<?xml version=\"1.0\"?>\n<robot name=\"" + name + "\">\n";
    const auto link = [&](const std::string& link_name, double m, double x, double y, double z,
                          double dx, double dy, double dz, bool shaped,
                          const std::string& collisions = "") {
      const double k = mass * m * size * size / 12;
      urdf += "<link name=\"" + link_name + "\"><inertial><origin xyz=\"" + place(x, y, z) + "\" " +
              yaw + "/><mass value=\"" + exact(mass * m) + "\"/><inertia ixx=\"" +
              exact(k * (dy * dy + dz * dz)) + "\" iyy=\"" + exact(k * (dx * dx + dz * dz)) +
              "\" izz=\"" + exact(k * (dx * dx + dy * dy)) +
              "\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>";
      const std::string box = "<origin xyz=\"" + place(x, y, z) + "\" " + yaw +
                              "/><geometry><box size=\"" +
                              numbers(size * dx, size * dy, size * dz) + "\"/></geometry>";
      if (shaped) urdf += "<visual>" + box + "</visual>";
      if (shaped && collisions.empty()) urdf += "<collision>" + box + "</collision>";
      urdf += collisions + "</link>\n";
    };
    const auto joint = [&](const std::string& joint_name, const std::string& parent,
                           const std::string& child, double x, double y, double z, double ax,
                           double ay, double az, double lower, double upper,
                           const std::string& mimic = "") {
      double way = 1;
      if (opposed && joint_name.starts_with(right)) {
        way = -1;
        std::swap(lower, upper);
        lower = -lower;
        upper = -upper;
      }
      if (placeholders) lower = -(upper = 162 * std::numbers::pi / 180);
      urdf += "<joint name=\"" + joint_name + "\" type=\"revolute\"><parent link=\"" + parent +
              "\"/><child link=\"" + child + "\"/><origin xyz=\"" + place(x, y, z) +
              "\"/><axis xyz=\"" + turned(way * ax, way * ay, way * az) + "\"/><limit lower=\"" +
              exact(lower) + "\" upper=\"" + exact(upper) + "\" effort=\"" +
              exact(placeholders ? 1000 : effort(joint_name)) + "\" velocity=\"" +
              exact(placeholders ? 100 : speed) + "\"/>" + mimic + "</joint>\n";
    };
    link("trunk", 4, 0.004, 0, trunk_bottom + 0.11, 0.10, 0.16, 0.22, true);
    for (const bool is_left : {true, false}) {
      const std::string side = is_left ? left : right;
      const double y = is_left ? 1 : -1;
      std::string parent = "trunk";
      for (size_t i = 0; i < hips.size(); ++i) {
        const bool last = i + 1 == hips.size();
        const std::string child = side + (last ? "thigh" : "hip" + std::to_string(i + 1));
        if (last)
          link(child, 0.7, 0.004, 0.002 * y, -thigh / 2, 0.05, 0.05, 0.9 * thigh, true);
        else
          link(child, 0.1, 0, 0, 0, 0.03, 0.03, 0.03, false);
        const double at = i == 0 ? hip * y : 0;
        if (hips[i] == 'y' && coupled_hips)
          joint(side + "hip_yaw_pitch", parent, child, 0, at, 0, 0, std::sqrt(0.5),
                y * std::sqrt(0.5), -1.1, 0.75,
                is_left ? "" : "<mimic joint=\"" + left + "hip_yaw_pitch\" multiplier=\"1\"/>");
        else if (hips[i] == 'y')
          joint(side + "hip_yaw", parent, child, 0, at, 0, 0, 0, 1, -1, 1);
        else if (hips[i] == 'r')
          joint(side + "hip_roll", parent, child, 0, at, 0, 1, 0, 0, -0.6, 0.6);
        else if (hips[i] == 'i')
          joint(side + "hip_yaw", parent, child, 0, at, 0, 0, y * std::sqrt(0.5), std::sqrt(0.5),
                -1, 1);
        else if (hips[i] == 't')
          joint(side + "thigh_turn", parent, child, 0, at, 0, 0, 0, 1, -1, 1);
        else
          joint(side + "hip_pitch", parent, child, 0, at, 0, 0, 1, 0, -1.8, 1.2);
        parent = child;
      }
      link(side + "shank", 0.4, 0.006, 0, -shank / 2, 0.04, 0.04, 0.8 * shank, true);
      if (tandem_knee) {
        link(side + "kneecap", 0.1, 0, 0, 0, 0.03, 0.03, 0.03, false);
        joint(side + "knee", parent, side + "kneecap", 0, 0, -thigh, 0, 1, 0, -0.01, 1.15);
        joint(side + "lower_knee", side + "kneecap", side + "shank", 0, 0, -0.02, 0, 1, 0, -0.01,
              1.15, "<mimic joint=\"" + side + "knee\"/>");
      } else {
        joint(side + "knee", parent, side + "shank", 0, 0, -thigh, 0, 1, 0, -0.02, 2.3);
      }
      std::string below = side + "shank";
      double down = -shank;
      if (ankle_roll) {
        const std::string shape =
            ankle_shape > 0 ? "<collision><origin xyz=\"0 0 0\" rpy=\"1.5707963 0 0\"/><geometry>"
                              "<cylinder radius=\"" +
                                  exact(size * ankle - ankle_shape) + "\" length=\"" +
                                  exact(0.8 * size * foot_width) + "\"/></geometry></collision>"
                            : "";
        link(side + "ankle", 0.1, 0, 0, 0, 0.03, 0.03, 0.03, false, shape);
        joint(side + "ankle_pitch", below, side + "ankle", 0, 0, down, 0, 1, 0, -1.2, 1.2);
        below = side + "ankle";
        down = 0;
      }
      const double ahead = 0.015 * foot_length / 0.13;
      std::string contacts;
      if (spheres)
        for (const double x : {-0.35, 0.6})
          for (const double across : {-0.4, 0.4})
            contacts += "<collision><origin xyz=\"" +
                        place(x * foot_length, across * foot_width, 0.005 / size - ankle) +
                        "\"/><geometry><sphere radius=\"0.005\"/></geometry></collision>";
      if (rollers)
        for (const double across : {-0.4, 0.4})
          contacts += "<collision><origin xyz=\"" +
                      place(ahead, across * foot_width, 0.005 - ankle) + "\" rpy=\"0 1.5707963 " +
                      text::brief(facing, 9) + "\"/><geometry><cylinder radius=\"" +
                      exact(0.005 * size) + "\" length=\"" + exact(foot_length * size) +
                      "\"/></geometry></collision>";
      link(side + "foot", 0.25, ahead, 0, -ankle + 0.0125, foot_length, foot_width, 0.025, true,
           contacts);
      if (ankle_roll)
        joint(side + "ankle_roll", below, side + "foot", 0, 0, down, 1, 0, 0, -0.5, 0.5);
      else
        joint(side + "ankle_pitch", below, side + "foot", 0, 0, down, 0, 1, 0, -1.2, 1.2);
      if (toes) {
        link(side + "toe", 0.05, 0.02, 0, 0.005, 0.04, foot_width, 0.01, true);
        joint(side + "toe_pitch", side + "foot", side + "toe", ahead + foot_length / 2, 0, -ankle,
              0, 1, 0, -0.7, 0.7);
      }
      link(side + "arm", 0.35, 0, 0.01 * y, -0.09, 0.04, 0.04, 0.18, true);
      joint(side + "shoulder", "trunk", side + "arm", 0, 0.11 * y, 0.2, 0, 1, 0, -2.5, 2.5);
    }
    return urdf + "</robot>\n";
  }
};

/// The robot with bent knees and with soles whose frames lie under the ankles.
inline RobotModel standing_model(const UrdfBiped& kind) {
  RobotDescription robot = parse_urdf(kind.text(), "robot.urdf");
  for (const bool is_left : {true, false}) {
    const std::string& side = is_left ? kind.left : kind.right;
    SoleDescription& sole = robot.soles[is_left ? "left" : "right"];
    sole.link = side + "foot";
    sole.frame.translation().z() = -kind.size * kind.ankle;
    const double half = kind.size * kind.foot_width / 2, ahead = kind.size * kind.foot_length / 2;
    sole.polygon = {{-ahead, -half}, {ahead, -half}, {ahead, half}, {-ahead, half}};
    robot.postures["home"][side + "hip_pitch"] = -0.4;
    robot.postures["home"][side + "knee"] = kind.tandem_knee ? 0.4 : 0.8;
    robot.postures["home"][side + "ankle_pitch"] = -0.4;
  }
  return RobotModel(robot);
}

}  // namespace ayumi::test
