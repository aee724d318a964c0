#include "ayumi/io/robot/first_sidecar.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/inverse_kinematics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_guess.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/diagnose.hpp"
#include "ayumi/model/outline.hpp"

namespace ayumi {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRadian = 180 / std::numbers::pi;  // a radian in degrees [deg]

// Noise of sensors for which nobody has measured it yet. Source: data sheets of usual MEMS inertial
// units and of hobby load cells; the values only affect simulations with noise.
constexpr double kAttitudeNoise = 0.002, kGyroNoise = 0.01, kAccelerometerNoise = 0.1,
                 kForceNoise = 1;
// Latency of the sensors [s]. Chosen: two periods of 1 ms.
constexpr double kLatency = 0.002;

std::string json_text(const std::string& text) { return nlohmann::json(text).dump(); }

// The value, rounded to this number of digits after the point, as text.
std::string rounded_text(double value, int digits) {
  double unit = 1;
  for (int i = 0; i < digits; ++i) unit *= 10;
  return text::exact(std::round(value * unit) / unit + 0.0);
}

// The sentence as comment lines of at most `width` characters, each with `indent` and "// " before
// its words.
std::string remark(const std::string& sentence, const std::string& indent = "  ") {
  constexpr size_t width = 96;
  std::string lines, line;
  size_t begin = 0;
  while (begin < sentence.size()) {
    const size_t end = std::min(sentence.find(' ', begin), sentence.size());
    const std::string word = sentence.substr(begin, end - begin);
    if (!line.empty() && indent.size() + 3 + line.size() + 1 + word.size() > width) {
      lines += indent + "// " + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
    begin = end + 1;
  }
  return line.empty() ? lines : lines + indent + "// " + line + "\n";
}

std::string guessed(const std::string& what, const GuessReason& reason) {
  return remark(what + " Guess: " + reason.why + ".") +
         (reason.check.empty() ? "" : remark("Check " + reason.check + "."));
}

// The corners in whole tenths of a millimetre, towards the middle, so that a rounded sole is not
// wider than the true one. Rounding moves a corner between two others onto their line or inside it,
// as corners of rounded edges are; such corners are left out.
std::vector<Vector2d> rounded_inwards(const std::vector<Vector2d>& corners) {
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& corner : corners) middle += corner / static_cast<double>(corners.size());
  std::vector<Vector2d> rounded;
  for (const Vector2d& corner : corners) {
    Vector2d tenths = corner * 1e4;
    for (int i = 0; i < 2; ++i)
      tenths[i] =
          corner[i] > middle[i] ? std::floor(tenths[i] + 1e-4) : std::ceil(tenths[i] - 1e-4);
    rounded.push_back(tenths);
  }
  for (size_t i = 0; i < rounded.size() && rounded.size() > 3;) {
    const size_t n = rounded.size();
    const Vector2d in = rounded[i] - rounded[(i + n - 1) % n],
                   out = rounded[(i + 1) % n] - rounded[i];
    if (in.x() * out.y() - in.y() * out.x() > 0) {
      ++i;
      continue;
    }
    rounded.erase(rounded.begin() + static_cast<std::ptrdiff_t>(i));
    i = 0;
  }
  return rounded;
}

std::string sole_text(const SoleDescription& sole, const RobotModel& model, Side side) {
  const Vector3d at = sole.frame.translation(), rpy = matrix_to_rpy(sole.frame.linear());
  std::vector<std::string> corners;
  for (const Vector2d& p : rounded_inwards(sole.polygon))
    corners.push_back("[" + rounded_text(1e-4 * p.x(), 4) + ", " + rounded_text(1e-4 * p.y(), 4) +
                      "]");
  std::string text = "    " + json_text(name_of(side)) +
                     ": {\n      \"link\": " + json_text(sole.link) + ",\n      \"origin\": [" +
                     rounded_text(at.x(), 6) + ", " + rounded_text(at.y(), 6) + ", " +
                     rounded_text(at.z(), 6) + "],\n";
  if (rpy.norm() > 1e-6)
    text += "      \"rpy\": [" + rounded_text(rpy.x(), 6) + ", " + rounded_text(rpy.y(), 6) + ", " +
            rounded_text(rpy.z(), 6) + "],\n";
  if (sole.source != SoleSource::stated)
    text += std::string("      \"inferred_from\": \"") +
            (sole.source == SoleSource::shapes ? "shapes" : "inertias") +
            "\",  // delete this when the sole is that of the robot\n";
  const Sole& whole = model.sole(side);
  return text + "      \"polygon\": [" + text::join(corners, ", ") +
         "],\n      \"stiffness\": " + text::brief(whole.stiffness, 3) +
         ", \"damping_time\": " + text::exact(whole.damping_time) + "\n    }";
}

// The lowest body that carries both feet.
int body_above_both_legs(const RobotModel& model) {
  if (!model.has_soles()) return 0;
  std::vector<char> above(model.bodies().size(), 0);
  for (int body = model.sole(Side::left).body; body >= 0; body = model.bodies()[body].parent)
    above[static_cast<size_t>(body)] = 1;
  int body = model.sole(Side::right).body;
  while (!above[static_cast<size_t>(body)]) body = model.bodies()[body].parent;
  return body;
}

std::string trunk_text(const RobotModel& model) {
  const int body = body_above_both_legs(model);
  const std::string& name = model.bodies()[static_cast<size_t>(body)].name;
  return remark(std::string(
                    "Trunk: the tilt of this link shows whether the robot has fallen. Guess: ") +
                (!model.has_soles() ? "this is the root link, because no legs were recognized."
                 : body == 0        ? "this is the root link, which carries both legs."
                                    : "this is the link that carries both legs.")) +
         "  \"trunk_link\": " + json_text(name) + ",\n";
}

// The joints that move this leg alone, also those that inverse kinematics does not solve.
std::vector<int> joints_of_leg(const RobotModel& model, Side side) {
  const std::vector<int>& others = model.leg(other(side));
  std::vector<int> joints;
  for (const int dof : model.leg(side))
    if (std::find(others.begin(), others.end(), dof) == others.end()) joints.push_back(dof);
  return joints;
}

// A leg in words, such as "hip yaw J0, hip roll J1, knee J3, ankle pitch J4".
std::string leg_in_words(const RobotModel& model, Side side) {
  const InverseKinematics ik(model, model.posture());
  RobotData data(model);
  update_positions(model, model.rest_state(), data);
  const Eigen::Matrix3d trunk = data.rotation[body_above_both_legs(model)];
  std::vector<std::string> words;
  std::string part = "hip ";
  for (const int dof : joints_of_leg(model, side)) {
    const std::string& name = model.dofs()[dof].name;
    if (dof == ik.knee(side)) {
      words.push_back("knee " + name);
      part = "ankle ";
      continue;
    }
    int major = 0;
    (trunk.transpose() * data.axis[model.dofs()[dof].body]).cwiseAbs().maxCoeff(&major);
    const char* turns[] = {"roll ", "pitch ", "yaw "};
    if (model.dofs()[dof].prismatic) {  // a telescopic leg has no knee
      words.push_back("slide " + name);
      part = "ankle ";
    } else {
      words.push_back(part + turns[major] + name);
    }
  }
  return text::join(words, ", ");
}

// A sole in words, such as "the left sole (link l_foot) is 98 mm long and 62 mm wide, and reaches
// ...".
std::string sole_in_words(const RobotModel& model, Side side) {
  const SoleDescription& sole = model.description().soles.at(name_of(side));
  Vector2d low = sole.polygon[0], high = low;
  for (const Vector2d& corner : sole.polygon) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const auto millimetres = [](double length) { return text::fixed(1e3 * length, 0) + " mm"; };
  const std::string reach =
      low.x() > 0
          ? "from " + millimetres(low.x()) + " to " + millimetres(high.x()) + " ahead of the ankle"
      : high.x() < 0
          ? "from " + millimetres(-high.x()) + " to " + millimetres(-low.x()) + " behind the ankle"
          : millimetres(high.x()) + " ahead of the ankle and " + millimetres(-low.x()) +
                " behind the ankle";
  return "the " + std::string(name_of(side)) + " sole (link " + sole.link + ") is " +
         millimetres(high.x() - low.x()) + " long and " + millimetres(high.y() - low.y()) +
         " wide, and reaches " + reach;
}

std::string soles_text(const RobotModel& model, const RobotGuess& guess) {
  if (!model.has_soles())
    return remark(
        "Soles: no sole was recognized, and without soles no motion can be made. State the link of "
        "each foot, the pose of its sole frame (under the ankle, x forward, z up) and the corners "
        "of its outline: \"soles\": {\"left\": {\"link\": ..., \"origin\": [x, y, z], \"polygon\": "
        "[[x, y], ...]}, \"right\": ...}");
  const auto& soles = model.description().soles;
  return guessed("Soles: the frame lies on the sole plane under the ankle, x forward, z up [m].",
                 guess.sole_reason) +
         remark(
             "Softness: stiffness [N/m] and damping time [s] of a whole sole on the ground. Guess: "
             "the whole weight compresses hard rubber by 0.1 mm. Check these values by loading a "
             "foot. The softness of the soles can decide whether the robot falls when it walks.") +
         "  \"soles\": {\n" + sole_text(soles.at("left"), model, Side::left) + ",\n" +
         sole_text(soles.at("right"), model, Side::right) + "\n  },\n";
}

std::string home_text(const RobotModel& model, const RobotGuess& guess) {
  const Eigen::VectorXd home = model.posture();
  std::string text =
      guessed("Home posture [deg]: every motion starts here.", guess.home_reason) +
      remark(
          "The comment after each joint says what a positive angle does. Check each comment "
          "on the robot, one joint at a time.") +
      "  \"postures_deg\": {\n    \"home\": {\n";
  std::string sliders;
  std::vector<int> turning;
  for (int i = 0; i < model.dof_count(); ++i) {
    if (!model.dofs()[i].prismatic)
      turning.push_back(i);
    else if (home[i] != 0)
      sliders += (sliders.empty() ? "" : ", ") + json_text(model.dofs()[i].name) + ": " +
                 rounded_text(home[i], 5);
  }
  for (const int i : turning)
    text += "      " + json_text(model.dofs()[i].name) + ": " + rounded_text(home[i] * kRadian, 3) +
            (i == turning.back() ? "" : ",") + "  // " + direction_in_words(model, i) + "\n";
  text += "    }\n  },\n";
  if (!sliders.empty())
    text += remark("Sliding joints are given in metres, under \"postures\": " + sliders);
  return text;
}

// Names by which motion files may call the joints of the legs: l_hip_yaw to r_ankle_roll.
std::map<std::string, std::string> leg_aliases(const RobotModel& model) {
  std::map<std::string, std::string> aliases;
  if (!model.has_soles()) return aliases;
  const InverseKinematics ik(model, model.posture());
  RobotData data(model);
  update_positions(model, model.rest_state(), data);
  const Eigen::Matrix3d trunk = data.rotation[model.trunk_body()];
  for (const Side side : {Side::left, Side::right}) {
    const std::string prefix = side == Side::left ? "l_" : "r_";
    bool below = false;
    std::map<std::string, std::vector<std::string>> roles;
    for (const int dof : ik.leg(side)) {
      const std::string& name = model.dofs()[dof].name;
      if (dof == ik.knee(side)) {
        below = true;
        roles[prefix + "knee"].push_back(name);
        continue;
      }
      if (model.dofs()[dof].prismatic) {
        below = true;
        continue;
      }
      int major = 0;
      (trunk.transpose() * data.axis[model.dofs()[dof].body]).cwiseAbs().maxCoeff(&major);
      const char* turns[] = {"roll", "pitch", "yaw"};
      roles[prefix + (below ? "ankle_" : "hip_") + turns[major]].push_back(name);
    }
    for (const auto& [role, joints] : roles)
      if (joints.size() == 1 && model.find_dof(role) < 0) aliases[role] = joints[0];
  }
  return aliases;
}

std::string aliases_text(const RobotModel& model) {
  const auto aliases = leg_aliases(model);
  if (aliases.empty()) return "";
  std::string text = remark(
      "Aliases: other names that motion files may use for the joints. Guess: the joints of the "
      "legs "
      "were recognized by their axes. Add the names that your motion files use.");
  text += "  \"aliases\": {\n";
  size_t left = aliases.size();
  for (const auto& [alias, joint] : aliases)
    text += "    " + json_text(alias) + ": " + json_text(joint) + (--left ? "," : "") + "\n";
  return text + "  },\n";
}

std::string joint_list(const std::vector<std::string>& joints) {
  std::vector<std::string> names;
  for (const std::string& joint : joints) names.push_back(json_text(joint));
  return "[" + text::join(names, ", ") + "]";
}

std::string servos_text(const RobotModel& model, const RobotGuess& guess) {
  using Values = std::array<double, 6>;
  std::vector<std::pair<Values, std::vector<std::string>>> groups;
  for (const Dof& dof : model.dofs()) {
    const ServoDescription& servo = model.description().servos.at(dof.name);
    const Values values = {servo.kp,      servo.kd,      servo.rotor_inertia,
                           servo.viscous, servo.coulomb, servo.backlash};
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&](const auto& group) { return group.first == values; });
    if (same == groups.end())
      groups.push_back({values, {dof.name}});
    else
      same->second.push_back(dof.name);
  }
  std::string text =
      guessed("Servos: kp [N m/rad], kd [N m s/rad], rotor inertia at the joint [kg m^2].",
              guess.servo_reason) +
      "  \"servo_period\": " + text::exact(model.description().servo_period) +
      ",  // time between two targets [s]; check the cycle time of the robot's bus\n" +
      "  \"servos\": [\n";
  for (const auto& group : groups) {
    const auto& [kp, kd, rotor, viscous, coulomb, backlash] = group.first;
    text += "    { \"joints\": " + joint_list(group.second) +
            ",\n      \"kp\": " + text::exact(kp) + ", \"kd\": " + text::exact(kd) +
            ", \"rotor_inertia\": " + text::exact(rotor) +
            ", \"viscous\": " + text::exact(viscous) + ", \"coulomb\": " + text::exact(coulomb) +
            (backlash > 0 ? ", \"backlash\": " + rounded_text(backlash, 5) : "") + " }" +
            (&group == &groups.back() ? "\n" : ",\n");
  }
  return text + "  ],\n";
}

std::string profiles_text(const RobotModel& model, const RobotGuess& guess) {
  const ActuatorLimits& limits = model.limits();
  std::map<std::pair<double, double>, std::vector<std::string>> groups;
  for (int i = 0; i < model.dof_count(); ++i)
    if (std::isfinite(limits.speed[i]) || std::isfinite(limits.peak_torque[i]))
      groups[{limits.speed[i], limits.peak_torque[i]}].push_back(model.dofs()[i].name);
  std::string text = remark(
      "Motors: speed [rad/s] and peak torque [N m] at the joint, from the robot's file. The "
      "robot's file does not state the continuous torque, which a motor bears without a time "
      "limit. "
      "Add \"continuous_torque\" to each group.");
  for (const PlaceholderLimits& each : guess.placeholders)
    text +=
        remark("Placeholder: the URDF states " + each.what + " of " + each.value + " for " +
               text::counted(each.joints.size(), "joint") +
               (each.joints.size() <= 3 ? " (" + text::join(each.joints, ", ") + ")" : "") +
               ". These limits are probably not true, because the format requires a number. " +
               (each.what == "position limits" ? "State the true limits in \"position_limits_deg\"."
                                               : "Replace these limits by those of the motor."));
  if (groups.empty()) return text;
  text += "  \"profiles\": [\n    {\n      \"name\": \"urdf\",\n      \"limits\": [\n";
  size_t left = groups.size();
  for (const auto& [values, joints] : groups) {
    text += "        { \"joints\": " + joint_list(joints);
    if (std::isfinite(values.first)) text += ", \"speed\": " + text::exact(values.first);
    if (std::isfinite(values.second)) text += ", \"peak_torque\": " + text::exact(values.second);
    text += std::string(" }") + (--left ? ",\n" : "\n");
  }
  return text + "      ]\n    }\n  ],\n";
}

std::string gains_text(const SidecarGains& gains) {
  if (gains.dtad.empty()) return "";
  std::vector<std::string> values;
  for (const auto& [name, value] : gains.dtad)
    values.push_back(json_text(name) + ": " + text::exact(value));
  return guessed("Gains of the control law DTAD.", {gains.why, gains.check}) +
         "  \"control\": { \"dtad\": { " + text::join(values, ", ") + " } },\n";
}

std::string imu_link(const RobotModel& model) {
  for (const Link& link : model.links()) {
    std::string name = link.name;
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (name.find("imu") != std::string::npos) return link.name;
  }
  return model.bodies()[model.trunk_body()].name;
}

std::string sensors_text(const RobotModel& model) {
  return remark(
             "Sensors: simulations with --noise use these values. Guess: a typical inertial unit "
             "is on "
             "this link, and load cells are at the corners of the soles. Check the place, the "
             "latency "
             "[s] and the noise (standard deviations [rad, rad/s, m/s^2, N]).") +
         "  \"sensors\": {\n    \"imu_link\": " + json_text(imu_link(model)) +
         ", \"imu_position\": [0, 0, 0],\n    \"latency\": " + text::exact(kLatency) +
         ", \"attitude_noise\": " + text::exact(kAttitudeNoise) +
         ", \"gyro_noise\": " + text::exact(kGyroNoise) +
         ",\n    \"accelerometer_noise\": " + text::exact(kAccelerometerNoise) +
         ", \"force_noise\": " + text::exact(kForceNoise) + "\n  }\n";
}

std::string seen_from(const std::filesystem::path& folder, const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  return fs::weakly_canonical(fs::absolute(file))
      .lexically_relative(fs::weakly_canonical(fs::absolute(folder)))
      .generic_string();
}

std::string packages_text(const RobotSearch& search, const std::filesystem::path& folder) {
  if (search.packages.empty()) return "";
  std::vector<std::string> folders;
  for (const std::filesystem::path& each : search.packages)
    folders.push_back(json_text(seen_from(folder, each)));
  return remark("Folders that contain the packages of the meshes, from --package-path.") +
         "  \"package_path\": [" + text::join(folders, ", ") + "],\n";
}

std::string held_text(const std::vector<std::string>& massless,
                      const std::vector<std::string>& play) {
  std::vector<std::string> held = massless;
  held.insert(held.end(), play.begin(), play.end());
  if (held.empty()) return "";
  std::string text;
  if (!massless.empty())
    text += remark(
        "Joints that are held at 0. Guess: these joints do not move, because their links have no "
        "mass. If a joint should move, give its link a mass in \"links\".");
  if (!play.empty())
    text += remark(
        "Joints that are held at 0: " + text::join(play, ", ") +
        ". Guess: each of these joints is passive, has a small range, and has the same axis as a "
        "motor beside it. So the joint represents the play of this motor's gear. This play is the "
        "\"backlash\" of the motor's servo below. Check the play by turning the joint while the "
        "motor "
        "holds its position.");
  return text + "  \"locked_joints\": " + joint_list(held) + ",\n";
}

// ---- inertias

// The box around all shapes of a link, and the distance that they reach from the link's centre of
// mass.
struct LinkExtent {
  Eigen::AlignedBox3d box;
  double reach = 0;
};

LinkExtent extent_of(const LinkDescription& link) {
  LinkExtent extent;
  for (const auto* shapes : {&link.visuals, &link.collisions})
    for (const PlacedShape& placed : *shapes)
      for (const Vector3d& point : outline(placed.shape)) {
        extent.box.extend(placed.pose * point);
        extent.reach = std::max(extent.reach, (placed.pose * point - link.inertia.com).norm());
      }
  return extent;
}

// Whether the inertia of the link cannot be true: it is missing, no body can have it, or a body
// with this inertia would be larger than the link's shape (see model/diagnose). For a link without
// a shape, `largest` is the largest reach of all links [m].
bool is_inertia_of_no_link(const LinkDescription& link, const LinkExtent& extent, double largest) {
  const Eigen::Matrix3d& tensor = link.inertia.about_com;
  const Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor).eigenvalues();
  const double gyration = std::sqrt(tensor.trace() / 2 / link.inertia.mass);
  return !(moments[0] > 0) || moments[2] > 1.01 * (moments[0] + moments[1]) ||
         gyration > (extent.box.isEmpty() ? largest : extent.reach);
}

Eigen::Matrix3d inertia_of_extent(const LinkDescription& link, const LinkExtent& extent) {
  // Density of a link without a shape [kg/m^3]. Chosen: that of water, between plastics and motors.
  constexpr double kDensity = 1000;
  // Smallest edge of a box [m]. Chosen: a sheet still has an inertia about every axis.
  constexpr double kSheet = 1e-3;
  const double mass = link.inertia.mass;
  if (extent.box.isEmpty()) {
    const double radius =
        elementary::exp(elementary::log(0.75 * mass / (std::numbers::pi * kDensity)) / 3);
    return 0.4 * mass * radius * radius * Eigen::Matrix3d::Identity();
  }
  const Vector3d square = extent.box.sizes().cwiseMax(kSheet).cwiseAbs2();
  return mass / 12 * (Vector3d::Constant(square.sum()) - square).asDiagonal().toDenseMatrix();
}

// Gives the inertia of a box to every link that cannot have the inertia in its file. Returns the
// names of these links.
std::vector<std::string> take_inertias_of_shapes(RobotDescription& robot) {
  std::vector<LinkExtent> extents;
  double largest = 0;
  for (const LinkDescription& link : robot.links) {
    extents.push_back(extent_of(link));
    largest = std::max(largest, extents.back().reach);
  }
  std::vector<std::string> changed;
  for (size_t i = 0; i < robot.links.size(); ++i) {
    LinkDescription& link = robot.links[i];
    if (!(link.inertia.mass > 0) || !is_inertia_of_no_link(link, extents[i], largest)) continue;
    link.inertia.about_com = inertia_of_extent(link, extents[i]);
    changed.push_back(link.name);
  }
  return changed;
}

std::string inertias_text(const RobotDescription& robot, const std::vector<std::string>& changed) {
  if (changed.empty()) return "";
  std::string text = remark(
      "Inertias [kg m^2]: xx, xy, xz, yy, yz, zz about the centre of mass. The robot's file states "
      "placeholders for these links: no body can have these inertias, or only a body that is "
      "larger "
      "than the link. Guess: a link has the inertia of a box with the extent of its shapes and the "
      "mass in the file. A link without shapes has the inertia of a sphere with the density of "
      "water. Check these values, or state the values of the CAD model.");
  text += "  \"links\": {\n";
  for (const LinkDescription& link : robot.links) {
    if (std::find(changed.begin(), changed.end(), link.name) == changed.end()) continue;
    const Eigen::Matrix3d& tensor = link.inertia.about_com;
    std::vector<std::string> numbers;
    for (int row = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column)
        numbers.push_back(text::brief(tensor(row, column), 4));
    text += "    " + json_text(link.name) + ": { \"inertia\": [" + text::join(numbers, ", ") +
            "] }" + (link.name == changed.back() ? "\n" : ",\n");
  }
  return text + "  },\n";
}

// Throws if the robot is heavier than lead or lighter than helium, because nothing that is guessed
// from such masses or lengths is of use.
void require_weight(const RobotModel& model, const std::string& file) {
  constexpr double kLead = 11340, kHelium = 0.18;  // densities [kg/m^3]
  RobotState state = model.rest_state();
  state.theta.setZero();
  RobotData data(model);
  update_positions(model, state, data);
  Eigen::AlignedBox3d box;
  for (const auto& position : data.position) box.extend(Vector3d(position));
  const double size = box.diagonal().norm();
  if (size > 0 && model.mass() > kLead * size * size * size)
    fail(ErrorCode::bad_file, {file},
         "the robot weighs " + text::brief(model.mass()) + " kg and its joints are at most " +
             text::brief(size) +
             " m apart, so the robot is heavier than a cube of lead with this edge. Masses must be "
             "in "
             "kg and lengths in m; if the masses are in grams, divide them by 1000");
  if (model.mass() < kHelium * size * size * size)
    fail(ErrorCode::bad_file, {file},
         "the robot weighs " + text::brief(model.mass()) + " kg and its joints are up to " +
             text::brief(size) +
             " m apart, so the robot is lighter than a cube of helium with this edge. Masses must "
             "be "
             "in kg and lengths in m; if the lengths are in millimetres, divide them by 1000, "
             "otherwise give the true masses");
}

std::vector<std::string> to_do_list(const RobotModel& model, const RobotGuess& guess) {
  std::vector<std::string> items;
  items.push_back(
      "Check in the picture that the robot stands upright, looks along the red arrow, and has its "
      "left leg on its left side. If this is not so, correct \"facing\", which is now the axis " +
      guess.facing + " of the URDF.");
  if (!model.has_soles()) {
    items.push_back(
        guess.robot.missing_meshes.empty()
            ? "State the soles of both feet, because without soles no motion can be made."
            : "No soles were recognized, because meshes are missing. Find the missing "
              "meshes (see below) and run `ayumi init` again, or state the soles of both "
              "feet. Without soles no motion can be made.");
  } else {
    if (model.description().soles.at("left").source == SoleSource::inertias)
      items.push_back(
          "Measure the soles and state them. The feet have no shapes, so this sidecar has the "
          "undersides of boxes with the inertias of the feet. Every verdict about a motion depends "
          "on the soles.");
    items.push_back("Compare the outline of the soles with the real feet. In this sidecar, " +
                    sole_in_words(model, Side::left) + "; " + sole_in_words(model, Side::right) +
                    ".");
    if (!guess.rounded_soles.empty()) items.push_back(guess.rounded_soles);
    if (!guess.more_feet.empty()) items.push_back(guess.more_feet);
    const InverseKinematics ik(model, model.posture());
    items.push_back(
        "Compare this order of the leg joints, from the trunk down, with the real robot. Left: " +
        leg_in_words(model, Side::left) + ". Right: " + leg_in_words(model, Side::right) + ".");
    if (ik.lacks_joints())
      items.push_back(
          "Expect a smaller range of motions. Each leg has fewer than six joints of its own, so at "
          "some places a leg cannot put its sole flat on the ground. The robot can stand, squat "
          "and "
          "take small steps, and its trunk leans.");
    std::vector<std::string> held;
    for (const Side side : {Side::left, Side::right})
      for (const int dof : joints_of_leg(model, side))
        if (!ik.solves(dof)) held.push_back(model.dofs()[dof].name);
    if (!held.empty())
      items.push_back(
          "Add keys or postures for these joints if they should move: " + text::join(held, ", ") +
          ". Six joints are enough to put a sole in its place, and the legs have more. So Ayumi "
          "does "
          "not move these joints without keys or postures.");
    items.push_back("Measure the stiffness of the soles.");
  }
  items.push_back(
      "Move each joint alone by a small positive angle, and compare the motion with the comment "
      "after this joint in the home posture.");
  for (const PlaceholderLimits& each : guess.placeholders)
    items.push_back("Replace the " + each.what + " of " + each.value + " on " +
                    text::counted(each.joints.size(), "joint") +
                    ", because these limits are probably placeholders.");
  std::vector<std::string> wide;
  for (const Dof& dof : model.dofs())
    if (!dof.prismatic && dof.limited && dof.upper - dof.lower > 4 * std::numbers::pi)
      wide.push_back(dof.name);
  constexpr size_t kMostWide = 3;  // number of joints that are named
  if (!wide.empty())
    items.push_back("Check the position limits of " + text::counted(wide.size(), "joint") + " (" +
                    text::join_first(wide, kMostWide) +
                    "): the range is more than two turns. Limits of a URDF are in radians.");
  const ActuatorLimits& limits = model.limits();
  const std::vector<std::string> passive = passive_joints(guess.robot);
  const auto unlimited = [&](const Eigen::VectorXd& values) {
    Eigen::Index count = 0;
    for (Eigen::Index i = 0; i < values.size(); ++i)
      if (std::isinf(values[i]) &&
          std::find(passive.begin(), passive.end(), model.dofs()[static_cast<int>(i)].name) ==
              passive.end())
        ++count;
    return count;
  };
  const Eigen::Index fast = unlimited(limits.speed), strong = unlimited(limits.peak_torque);
  if (fast + strong > 0)
    items.push_back(
        "State the limits of the motors in \"profiles\". The robot's file states " +
        (fast > 0 ? "no speed limit for " + text::counted(static_cast<size_t>(fast), "joint")
                  : std::string()) +
        (fast > 0 && strong > 0 ? ", and " : "") +
        (strong > 0 ? "no torque limit for " + text::counted(static_cast<size_t>(strong), "joint")
                    : std::string()) +
        ". Without these limits, `ayumi check` cannot say whether the motors can follow a motion.");
  items.push_back(
      "State kp, kd and the rotor inertia of the servos. `ayumi identify` can find kp and kd in a "
      "recording.");
  items.push_back("State the continuous torque of the motors.");
  items.push_back("State the place, the latency and the noise of the sensors.");
  for (const ModelWarning& warning : diagnose(model))
    if (warning.subject == ModelWarning::Subject::link)
      items.push_back("Check " + warning.where + ": " + warning.message + ".");
  return items;
}

}  // namespace

FirstSidecar first_sidecar(const std::string& robot, const std::filesystem::path& folder,
                           const RobotSearch& search,
                           const std::function<SidecarGains(const RobotModel&)>& gains) {
  RobotDescription stated = load_robot_description(robot, search, {.meshes = true, .guess = false});
  if (!stated.sidecar_file.empty())
    fail(ErrorCode::usage, {robot},
         "this robot already has the sidecar " + stated.sidecar_file +
             ". To write a new sidecar from the beginning, give the URDF file of the robot in "
             "place of its "
             "name");
  namespace fs = std::filesystem;
  const fs::path urdf = fs::weakly_canonical(fs::absolute(stated.urdf_file));
  const std::string urdf_as_written = seen_from(folder, urdf);
  // What the files state, before anything is guessed.
  std::vector<std::string> read = stated.assumptions;
  const std::vector<std::string> massless = hold_joints_without_mass(stated);
  const std::vector<std::string> play = hold_play_of_gears(stated);
  constexpr size_t kMostNamed = 3;  // number of missing meshes that the to-do list names
  for (const std::string& gap : gaps_of_the_files(stated, kMostNamed)) read.push_back(gap);
  // The gains of the servos are guessed from the inertias, so placeholders are replaced first.
  const std::vector<std::string> boxes = take_inertias_of_shapes(stated);
  RobotGuess guess = guess_robot(std::move(stated));
  const RobotModel model(guess.robot);
  require_weight(model, robot);
  FirstSidecar result;
  result.to_do = to_do_list(model, guess);
  for (const std::string& note : read)
    result.to_do.push_back("Check this note about the robot's file: " + note + ".");
  if (!boxes.empty())
    result.to_do.push_back(
        "Replace the inertia of " + text::counted(boxes.size(), "link") + " (" +
        text::join({boxes.begin(), boxes.begin() + std::min<long>(3, std::ssize(boxes))}, ", ") +
        (boxes.size() > 3 ? ", ..." : "") +
        "). The robot's file states placeholders, so this sidecar has the inertias of boxes "
        "instead.");
  const SidecarGains chosen = gains && model.has_soles() ? gains(model) : SidecarGains{};
  if (!chosen.to_do.empty()) result.to_do.push_back(chosen.to_do);
  for (const auto& [name, value] : chosen.dtad) guess.robot.control.dtad[name] = value;
  result.text = "{\n" +
                remark("The first sidecar of " + model.name() +
                       ", written by ayumi init. Check all values whose comment has the word "
                       "\"Guess\". docs/formats.md explains the keys.") +
                "  \"format\": \"ayumi.robot/1\",\n  \"name\": " + json_text(model.name()) +
                ",\n  \"urdf\": " + json_text(urdf_as_written) + ",\n" +
                packages_text(search, folder) + held_text(massless, play) +
                guessed(
                    "Facing: the axis of the URDF's root link along which the robot looks. Ayumi "
                    "turns the root link so that x is forward.",
                    guess.facing_reason) +
                "  \"facing\": " + json_text(guess.facing) + ",\n" +
                inertias_text(guess.robot, boxes) + trunk_text(model) + soles_text(model, guess) +
                home_text(model, guess) + aliases_text(model) + servos_text(model, guess) +
                profiles_text(model, guess) + gains_text(chosen) + sensors_text(model) + "}\n";
  result.robot = guess.robot;
  return result;
}

}  // namespace ayumi
