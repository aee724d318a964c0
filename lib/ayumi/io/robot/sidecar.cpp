#include "ayumi/io/robot/sidecar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/degrees.hpp"
#include "ayumi/io/json/document_format.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/io/robot/facing.hpp"
#include "ayumi/io/robot/robot_guess.hpp"
#include "ayumi/io/robot/robot_source.hpp"
#include "ayumi/io/robot/servo_reader.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/device_limits.hpp"
#include "ayumi/model/validate.hpp"

namespace ayumi {

namespace {

/// Longest running mean of load cells. Definition: a second of readings that are taken every
/// millisecond, which is the bound of a latency.
constexpr int kMostForceReadings = 1000;

// '*' stands for any run of characters.
bool matches(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  if (pattern[0] != '*')
    return !name.empty() && pattern[0] == name[0] && matches(pattern.substr(1), name.substr(1));
  for (size_t skip = 0; skip <= name.size(); ++skip)
    if (matches(pattern.substr(1), name.substr(skip))) return true;
  return false;
}

std::vector<std::string> moving_joints(const RobotDescription& robot) {
  std::vector<std::string> names;
  for (const JointDescription& joint : robot.joints)
    if (joint.type != JointType::fixed && joint.type != JointType::floating && joint.mimic.empty())
      names.push_back(joint.name);
  return names;
}

bool is_among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// The joints of one group, such as {"joints": ["*_knee", "l_elbow"], ...}.
std::vector<std::string> group_joints(const JsonNode& group, const RobotDescription& robot) {
  const std::vector<std::string> names = moving_joints(robot);
  std::vector<std::string> chosen;
  for (const JsonNode& pattern : group.at("joints").items()) {
    const size_t before = chosen.size();
    for (const std::string& name : names)
      if (matches(pattern.string(), name)) chosen.push_back(name);
    if (chosen.size() == before)
      pattern.complain("no moving joint of the robot matches '" + pattern.string() + "'" +
                       text::suggestion(pattern.string(), names));
  }
  return chosen;
}

Eigen::Isometry3d pose_of(const JsonNode& node) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (const auto origin = node.find("origin")) pose.translation() = origin->vector3();
  if (const auto rpy = node.find("rpy")) {
    const Eigen::Vector3d angles = rpy->vector3();
    pose.linear() = rpy_to_matrix(angles);
  }
  return pose;
}

void read_number(const JsonNode& node, const std::string& key, double& value) {
  if (const auto found = node.find(key)) value = found->number();
}

void read_not_negative(const JsonNode& node, const std::string& key, double& value) {
  if (const auto found = node.find(key)) value = found->number_within(0, 1e12);
}

void read_soles(const JsonNode& node, RobotDescription& robot) {
  node.only_keys({"left", "right"});
  for (const auto& [side, foot] : node.members()) {
    foot.only_keys(
        {"link", "origin", "rpy", "polygon", "stiffness", "damping_time", "inferred_from"});
    SoleDescription sole;
    sole.link = foot.at("link").string();
    sole.frame = pose_of(foot);
    for (const JsonNode& corner : foot.at("polygon").items())
      sole.polygon.push_back(corner.vector2());
    read_not_negative(foot, "stiffness", sole.stiffness);
    read_not_negative(foot, "damping_time", sole.damping_time);
    if (const auto from = foot.find("inferred_from"))
      sole.source = from->one_of({"shapes", "inertias"}) == "shapes" ? SoleSource::shapes
                                                                     : SoleSource::inertias;
    robot.soles[side] = sole;
  }
}

void read_postures(const JsonNode& node, double unit, RobotDescription& robot) {
  for (const auto& [name, joints] : node.members()) {
    if (robot.postures.contains(name)) joints.complain("this posture is given twice; keep one");
    auto& posture = robot.postures[name];
    for (const auto& [joint, value] : joints.members()) {
      posture[joint] = unit * value.number();
      const JsonPlace place = value.place();
      robot.angle_places[name][joint] = {place.file, place.pointer};
    }
  }
}

// A joint whose gain no group states has no servo; one whose gain is stated as 0 has no motor. The
// bytes of parameter files are part of the robot's identity.
std::map<std::string, ServoDescription> read_servos(
    const JsonNode& node, const std::map<std::string, ServoDescription>& before,
    RobotDescription& robot, std::string& files) {
  ServoGroups groups;
  for (const JointDescription& joint : robot.joints) {
    if (!is_among(moving_joints(robot), joint.name)) continue;
    const auto known = before.find(joint.name);
    if (known != before.end()) groups.stated[joint.name] = true;
    groups.servos[joint.name] = known != before.end() ? known->second
                                                      : ServoDescription{.viscous = joint.damping,
                                                                         .coulomb = joint.friction};
  }
  for (const JsonNode& group : node.items())
    read_servo_group(group, group_joints(group, robot), groups);
  files += groups.files;
  for (const std::string& unused : groups.unused)
    if (!is_among(robot.assumptions, unused)) robot.assumptions.push_back(unused);
  std::map<std::string, ServoDescription> servos;
  for (const auto& [joint, stated] : groups.stated) servos[joint] = groups.servos[joint];
  for (const auto& [joint, servo] : groups.servos)
    if (servo.offset != 0 && !groups.stated.contains(joint))
      node.complain("the groups state an offset of " + joint +
                    ", but no servo of this joint; state its kp, too");
  return servos;
}

void read_profiles(const JsonNode& node, RobotDescription& robot, std::string& files) {
  for (const JsonNode& item : node.items()) {
    item.only_keys({"name", "thermal_window", "limits", "servos"});
    ActuatorProfile profile;
    profile.name = item.at("name").string();
    for (const ActuatorProfile& other : robot.profiles)
      if (other.name == profile.name) item.complain("two profiles are named '" + other.name + "'");
    read_number(item, "thermal_window", profile.thermal_window);
    const std::map<std::string, std::map<std::string, double>*> limits = {
        {"speed", &profile.speed},
        {"peak_torque", &profile.peak_torque},
        {"continuous_torque", &profile.continuous_torque}};
    for (const JsonNode& group : item.at("limits").items()) {
      group.only_keys({"joints", "speed", "peak_torque", "continuous_torque"});
      for (const std::string& joint : group_joints(group, robot)) {
        for (const auto& [key, values] : limits)
          if (const auto limit = group.find(key)) (*values)[joint] = limit->number();
      }
    }
    if (const auto servos = item.find("servos"))
      profile.servos = read_servos(*servos, robot.servos, robot, files);
    robot.profiles.push_back(profile);
  }
}

void read_encoders(const JsonNode& node, RobotDescription& robot) {
  std::map<int, std::string> owner;
  for (const auto& [joint, entry] : node.members()) {
    entry.only_keys({"device", "counts_per_degree"});
    EncoderDescription encoder;
    encoder.device = entry.at("device").integer();
    if (encoder.device < 1)
      entry.at("device").complain("device numbers start at 1, but this number is " +
                                  std::to_string(encoder.device));
    const auto [other, fresh] = owner.emplace(encoder.device, joint);
    if (!fresh)
      entry.at("device").complain("device " + std::to_string(encoder.device) +
                                  " belongs to the joint '" + other->second +
                                  "' already; give each joint a device of its own");
    encoder.counts_per_degree = entry.at("counts_per_degree").number();
    if (encoder.counts_per_degree == 0)
      entry.at("counts_per_degree").complain("counts per degree cannot be 0");
    robot.encoders[joint] = encoder;
  }
}

// Reads the names of joints in files with motions, such as {"LHipYaw": "l_hip_yaw"}.
void read_aliases(const JsonNode& node, RobotDescription& robot) {
  const std::vector<std::string> names = moving_joints(robot);
  for (const auto& [alias, joint] : node.members()) {
    if (!is_among(names, joint.string()))
      joint.complain("'" + joint.string() + "' is not a moving joint of the robot" +
                     text::suggestion(joint.string(), names));
    if (is_among(names, alias))
      joint.complain("'" + alias + "' is itself a joint of the robot; remove this alias");
    robot.aliases[alias] = joint.string();
  }
}

// Reads the columns before and after those of the motors, such as ["interval", "2", "motors", "60",
// "R"].
void read_columns(const JsonNode& node, SequenceLayout& layout) {
  std::vector<std::string>* side = &layout.before;
  for (const JsonNode& item : node.items()) {
    const std::string column = item.string();
    if (column == "motors") {
      if (side == &layout.after) item.complain("the column 'motors' is given twice");
      side = &layout.after;
      continue;
    }
    if (column == "interval" && (side == &layout.after || !side->empty()))
      item.complain("the column 'interval' must be the first one");
    if (column.empty() || column.find_first_of(", \t\r\n\"") != std::string::npos)
      item.complain("'" + column +
                    "' cannot be the text of a column; give interval, motors, * or a text without "
                    "blanks, commas and quotation marks");
    side->push_back(column);
  }
  if (side == &layout.before) node.complain("the column 'motors' is missing");
  if (!layout.has_interval()) return;
  if (layout.before.size() != 2 || layout.before[1] != "2")
    node.complain(
        "after 'interval', a layout needs \"2\", which is the code of a row of targets, and then "
        "'motors'");
  if (is_among(layout.after, "*"))
    node.complain(
        "'*' (any text) is possible only in layouts without 'interval'. Ayumi writes files in the "
        "layouts with 'interval', so it must know every text in these layouts");
}

void read_layouts(const JsonNode& node, RobotDescription& robot) {
  // Definition: this number is larger than that of any bus of a humanoid.
  constexpr int kMostMotors = 127;
  constexpr int kLongestInterval = 60000;  // Definition: the longest interval is a minute [ms]
  for (const JsonNode& item : node.items()) {
    item.only_keys({"name", "columns", "motors", "unit", "intervals_ms"});
    SequenceLayout layout;
    layout.name = item.at("name").string();
    for (const SequenceLayout& other : robot.layouts)
      if (other.name == layout.name) item.complain("two layouts are named '" + layout.name + "'");
    read_columns(item.at("columns"), layout);
    layout.motors = item.at("motors").integer();
    if (layout.motors < 1 || layout.motors > kMostMotors)
      item.at("motors").complain(std::to_string(layout.motors) +
                                 " motors are not possible; expected 1 to " +
                                 std::to_string(kMostMotors));
    if (const auto unit = item.find("unit"))
      layout.radians = unit->one_of({"counts", "rad"}) == "rad";
    if (layout.radians && layout.has_interval())
      item.at("unit").complain(
          "a layout with 'interval' contains servo targets, and the unit of servo targets must be "
          "counts");
    if (const auto intervals = item.find("intervals_ms"))
      for (const JsonNode& interval : intervals->items()) {
        layout.intervals_ms.push_back(interval.integer());
        if (layout.intervals_ms.back() < 1 || layout.intervals_ms.back() > kLongestInterval)
          interval.complain("an interval of " + std::to_string(layout.intervals_ms.back()) +
                            " ms is not possible; expected 1 to " +
                            std::to_string(kLongestInterval));
      }
    robot.layouts.push_back(layout);
  }
}

std::vector<int> column_numbers(const JsonNode& node) {
  std::vector<int> columns;
  for (const JsonNode& item : node.items()) {
    columns.push_back(item.integer());
    if (columns.back() < 1) item.complain("columns are counted from 1");
  }
  return columns;
}

void read_load_cells(const JsonNode& node, std::map<std::string, LoadCells>& feet) {
  node.only_keys({"left", "right"});
  for (const auto& [side, foot] : node.members()) {
    foot.only_keys({"columns", "cells", "force"});
    LoadCells cells;
    cells.columns = column_numbers(foot.at("columns"));
    for (const JsonNode& cell : foot.at("cells").items()) cells.cells.push_back(cell.numbers());
    if (cells.cells.size() != cells.columns.size())
      foot.at("cells").complain("there are " + std::to_string(cells.cells.size()) +
                                " polynomials for " + std::to_string(cells.columns.size()) +
                                " columns; give one polynomial for each column");
    cells.force = foot.at("force").numbers();
    feet[side] = cells;
  }
}

void read_axes(const JsonNode& node, AxisReadings& axes) {
  node.only_keys({"columns", "zero", "scale"});
  axes.columns = column_numbers(node.at("columns"));
  if (axes.columns.size() != 3) node.at("columns").complain("expected the columns of x, y and z");
  if (const auto zero = node.find("zero")) axes.zero = zero->vector3();
  if (const auto scale = node.find("scale")) axes.scale = scale->vector3();
}

void read_force_cells(const JsonNode& node,
                      std::map<std::string, std::vector<CellResponse>>& feet) {
  node.only_keys({"left", "right"});
  for (const auto& [side, foot] : node.members()) {
    std::vector<CellResponse> cells;
    for (const JsonNode& item : foot.items()) {
      item.only_keys({"dead_zone", "hysteresis", "gain", "saturation"});
      CellResponse cell;
      read_not_negative(item, "dead_zone", cell.dead_zone);
      read_not_negative(item, "hysteresis", cell.hysteresis);
      read_not_negative(item, "gain", cell.gain);
      read_not_negative(item, "saturation", cell.saturation);
      cells.push_back(cell);
    }
    feet[side] = cells;
  }
}

void read_sensors(const JsonNode& node, SensorDescription& sensors) {
  node.only_keys({"imu_link", "imu_position", "latency", "attitude_noise", "attitude_bias",
                  "gyro_noise", "accelerometer_noise", "force_noise", "force_resolution",
                  "encoder_quantisation", "load_cells", "accelerometer", "gyro", "encoder_latency",
                  "imu_latency", "force_latency", "force_readings", "force_cells"});
  if (const auto cells = node.find("load_cells")) read_load_cells(*cells, sensors.load_cells);
  if (const auto axes = node.find("accelerometer")) read_axes(*axes, sensors.accelerometer);
  if (const auto axes = node.find("gyro")) read_axes(*axes, sensors.gyro);
  if (const auto link = node.find("imu_link")) sensors.imu_link = link->string();
  if (const auto position = node.find("imu_position")) sensors.imu_position = position->vector3();
  if (const auto latency = node.find("latency"))
    sensors.latency = latency->number_within(0, kMostSensorLatency);
  for (const auto& [key, latency] : {std::pair("encoder_latency", &sensors.encoder_latency),
                                     std::pair("imu_latency", &sensors.imu_latency),
                                     std::pair("force_latency", &sensors.force_latency)})
    if (const auto found = node.find(key)) *latency = found->number_within(0, kMostSensorLatency);
  if (const auto readings = node.find("force_readings")) {
    sensors.force_readings = readings->integer();
    if (sensors.force_readings < 1 || sensors.force_readings > kMostForceReadings)
      readings->complain("a mean of " + std::to_string(sensors.force_readings) +
                         " readings is not possible; expected a number from 1 (no mean) to " +
                         std::to_string(kMostForceReadings));
  }
  if (const auto cells = node.find("force_cells")) read_force_cells(*cells, sensors.force_cells);
  read_not_negative(node, "attitude_noise", sensors.attitude_noise);
  read_number(node, "attitude_bias", sensors.attitude_bias);
  read_not_negative(node, "gyro_noise", sensors.gyro_noise);
  read_not_negative(node, "accelerometer_noise", sensors.accelerometer_noise);
  read_not_negative(node, "force_noise", sensors.force_noise);
  read_not_negative(node, "force_resolution", sensors.force_resolution);
  if (const auto rounds = node.find("encoder_quantisation"))
    sensors.encoder_quantisation = rounds->boolean();
}

void read_control(const JsonNode& node, RobotDescription& robot) {
  node.only_keys({"joint_weight", "dtad", "viip"});
  if (const auto groups = node.find("joint_weight"))
    for (const JsonNode& group : groups->items()) {
      group.only_keys({"joints", "weight"});
      const double weight = group.at("weight").number();
      if (!(weight > 0))
        group.at("weight").complain("a weight must be above 0, but it is " + text::exact(weight));
      for (const std::string& joint : group_joints(group, robot))
        robot.control.joint_weight[joint] = weight;
    }
  if (const auto gains = node.find("dtad"))
    for (const auto& [name, value] : gains->members()) robot.control.dtad[name] = value.number();
  if (const auto gains = node.find("viip"))
    for (const auto& [name, value] : gains->members()) robot.control.viip[name] = value.number();
}

void lock_joints(const JsonNode& node, RobotDescription& robot) {
  const std::vector<std::string> names = moving_joints(robot);
  for (const JsonNode& item : node.items()) {
    const auto joint =
        std::find_if(robot.joints.begin(), robot.joints.end(),
                     [&](const JointDescription& each) { return each.name == item.string(); });
    if (joint == robot.joints.end() || joint->type == JointType::fixed)
      item.complain("'" + item.string() + "' is not a moving joint of the URDF" +
                    text::suggestion(item.string(), names));
    hold_joint(robot, *joint);
  }
}

// Mass properties that replace those of the URDF. Values that an entry leaves out stay.
void read_links(const JsonNode& node, RobotDescription& robot) {
  std::vector<std::string> names;
  for (const LinkDescription& link : robot.links) names.push_back(link.name);
  for (const auto& [name, entry] : node.members()) {
    const auto link =
        std::find_if(robot.links.begin(), robot.links.end(),
                     [&name = name](const LinkDescription& each) { return each.name == name; });
    if (link == robot.links.end())
      entry.complain("the URDF has no link '" + name + "'" + text::suggestion(name, names));
    entry.only_keys({"mass", "com", "inertia"});
    link->has_inertial = true;
    read_not_negative(entry, "mass", link->inertia.mass);
    if (const auto com = entry.find("com")) link->inertia.com = com->vector3();
    if (const auto inertia = entry.find("inertia")) {
      const std::vector<JsonNode> items = inertia->items();
      if (items.size() != 6) inertia->complain("expected six numbers: xx, xy, xz, yy, yz, zz");
      std::array<double, 6> i;
      for (size_t k = 0; k < 6; ++k) i[k] = items[k].number();
      link->inertia.about_com << i[0], i[1], i[2], i[1], i[3], i[4], i[2], i[4], i[5];
    }
  }
}

void read_position_limits(const JsonNode& node, RobotDescription& robot) {
  for (const auto& [name, entry] : node.members()) {
    const auto joint =
        std::find_if(robot.joints.begin(), robot.joints.end(),
                     [&name = name](const JointDescription& each) { return each.name == name; });
    if (joint == robot.joints.end() || !is_among(moving_joints(robot), name))
      entry.complain("'" + name + "' is not a moving joint of the robot" +
                     text::suggestion(name, moving_joints(robot)));
    const Eigen::Vector2d limits = kRadiansPerDegree * entry.vector2();
    if (limits.x() > limits.y())
      entry.complain("the lower limit " + text::brief(limits.x() / kRadiansPerDegree) +
                     " deg exceeds the upper limit " + text::brief(limits.y() / kRadiansPerDegree) +
                     " deg; swap them");
    joint->has_limits = true;
    joint->lower = limits.x();
    joint->upper = limits.y();
    if (joint->type == JointType::continuous) joint->type = JointType::revolute;
  }
}

void read_lists(const JsonNode& root, RobotDescription& robot) {
  if (const auto order = root.find("joint_order")) robot.joint_order = order->strings();
  if (const auto pairs = root.find("collision_ignore"))
    for (const JsonNode& pair : pairs->items()) {
      const std::vector<std::string> links = pair.strings();
      if (links.size() != 2) pair.complain("expected the names of two links");
      robot.collision_ignore.emplace_back(links[0], links[1]);
    }
  if (const auto assumptions = root.find("assumptions"))
    for (const std::string& assumption : assumptions->strings())
      robot.assumptions.push_back(assumption);
}

const std::vector<std::string> kKeys = {"$schema",
                                        "format",
                                        "name",
                                        "base",
                                        "urdf",
                                        "package_path",
                                        "joint_order",
                                        "locked_joints",
                                        "links",
                                        "position_limits_deg",
                                        "facing",
                                        "trunk_link",
                                        "soles",
                                        "postures",
                                        "postures_deg",
                                        "servos",
                                        "servo_period",
                                        "profiles",
                                        "encoders",
                                        "aliases",
                                        "layouts",
                                        "sensors",
                                        "control",
                                        "soft_limit_margin",
                                        "soft_limit_margin_deg",
                                        "collision_ignore",
                                        "assumptions"};

// A servo can round to counts only if its encoder has counts.
void check_counts(const JsonNode& root, const RobotDescription& robot) {
  const auto check = [&](const char* key, const std::map<std::string, ServoDescription>& servos) {
    for (const auto& [joint, servo] : servos)
      if (servo.quantized && !robot.encoders.contains(joint))
        root.at(key).complain("the servo of " + joint +
                              " is quantized, but 'encoders' gives no counts_per_degree for it");
  };
  check("servos", robot.servos);
  for (const ActuatorProfile& profile : robot.profiles) check("profiles", profile.servos);
}

// An offset belongs to the encoder of this robot unit and not to the actuators that a profile
// assumes, so it has to be the same in all profiles.
void check_offsets(const JsonNode& root, const RobotDescription& robot) {
  const auto degrees = [](double offset) {
    return text::brief(offset / kRadiansPerDegree, 4) + " deg";
  };
  for (const std::string& joint : moving_joints(robot)) {
    const auto common = robot.servos.find(joint);
    std::optional<double> known;
    std::string where = "'servos'";
    if (common != robot.servos.end()) known = common->second.offset;
    for (const ActuatorProfile& profile : robot.profiles) {
      const auto own = profile.servos.find(joint);
      const double offset = own != profile.servos.end()    ? own->second.offset
                            : common != robot.servos.end() ? common->second.offset
                                                           : 0;
      if (known && *known != offset)
        root.at("profiles")
            .complain("the encoder of " + joint + " has an offset of " + degrees(offset) +
                      " in the profile '" + profile.name + "', but an offset of " +
                      degrees(*known) + " in " + where +
                      ". An offset belongs to the robot and not to a profile, so state it once, in "
                      "'servos'");
      if (!known) where = "the profile '" + profile.name + "'";
      known = offset;
    }
  }
}

void read_root(const JsonNode& root, RobotDescription& robot, std::string& files) {
  const std::vector<std::pair<const char*, std::function<void(const JsonNode&)>>> readers = {
      {"facing", [&](const JsonNode& node) { turn_to_face_x(robot, node.one_of(facing_names())); }},
      {"locked_joints", [&](const JsonNode& node) { lock_joints(node, robot); }},
      {"position_limits_deg", [&](const JsonNode& node) { read_position_limits(node, robot); }},
      {"links", [&](const JsonNode& node) { read_links(node, robot); }},
      {"name", [&](const JsonNode& node) { robot.name = node.string(); }},
      {"trunk_link", [&](const JsonNode& node) { robot.trunk_link = node.string(); }},
      {"soles", [&](const JsonNode& node) { read_soles(node, robot); }},
      {"postures", [&](const JsonNode& node) { read_postures(node, 1, robot); }},
      {"postures_deg",
       [&](const JsonNode& node) { read_postures(node, kRadiansPerDegree, robot); }},
      {"servos", [&](const JsonNode& node) { robot.servos = read_servos(node, {}, robot, files); }},
      {"profiles", [&](const JsonNode& node) { read_profiles(node, robot, files); }},
      {"encoders", [&](const JsonNode& node) { read_encoders(node, robot); }},
      {"aliases", [&](const JsonNode& node) { read_aliases(node, robot); }},
      {"layouts", [&](const JsonNode& node) { read_layouts(node, robot); }},
      {"sensors", [&](const JsonNode& node) { read_sensors(node, robot.sensors); }},
      {"control", [&](const JsonNode& node) { read_control(node, robot); }},
      {"soft_limit_margin", [&](const JsonNode& node) { robot.soft_limit_margin = node.number(); }},
      {"soft_limit_margin_deg",
       [&](const JsonNode& node) { robot.soft_limit_margin = kRadiansPerDegree * node.number(); }},
      {"servo_period", [&](const JsonNode& node) { robot.servo_period = node.number(); }},
  };
  for (const auto& [key, read] : readers)
    if (const auto node = root.find(key)) read(*node);
  read_lists(root, robot);
  check_counts(root, robot);
  check_offsets(root, robot);
}

std::filesystem::path find_urdf(const JsonNode& node,
                                const std::vector<std::filesystem::path>& folders) {
  const std::filesystem::path name = node.string(),
                              beside = std::filesystem::path(node.file()).parent_path() / name;
  std::error_code ignored;
  if (std::filesystem::exists(beside, ignored)) return beside;
  for (const std::filesystem::path& folder : folders)
    for (const std::filesystem::path& path : {folder / name, folder / "urdf" / name})
      if (std::filesystem::exists(path, ignored)) return path;
  node.complain("there is no file " + beside.string() +
                ", and no folder of --robot-path contains " + name.string() + " or urdf/" +
                name.string() + "; correct the path");
}

}  // namespace

RobotDescription read_sidecar(const std::filesystem::path& file,
                              const std::vector<std::filesystem::path>& folders,
                              const std::vector<std::filesystem::path>& packages,
                              const FindRobot& find) {
  const MergedSidecar sidecar = read_merged_sidecar(file, find);
  const JsonNode root = sidecar.root();
  root.only_keys(kKeys);
  require_format(root, "ayumi.robot/1");
  const std::filesystem::path urdf = find_urdf(root.at("urdf"), folders);
  const std::string urdf_bytes = read_file(urdf);
  std::vector<std::filesystem::path> places = packages;
  if (const auto folders_of_packages = root.find("package_path"))
    for (const JsonNode& folder : folders_of_packages->items())
      places.push_back(std::filesystem::path(folder.file()).parent_path() / folder.string());
  RobotDescription robot = parse_robot(urdf_bytes, urdf, places);
  robot.sidecar_file = file.string();
  std::string files;
  read_root(root, robot, files);
  robot.sha256 = sha256(urdf_bytes + sidecar.bytes + files);
  return robot;
}

}  // namespace ayumi
