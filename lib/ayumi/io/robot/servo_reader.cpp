#include "ayumi/io/robot/servo_reader.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/degrees.hpp"
#include "ayumi/model/device_limits.hpp"

namespace ayumi {

namespace {

/// Limits of servo constants, which detect a wrong unit. Chosen: stiffness, inertia, torque and
/// friction may be a hundred times those of a humanoid of 50 kg; a zero offset of more than 0.5 rad
/// would mean that a horn is on another tooth of its shaft. The limits of delay and play are in
/// model/device_limits.hpp.
constexpr double kMostStiffness = 1e7;  // largest stiffness that is accepted [N m/rad]
constexpr double kMostDamping = 1e6;    // largest damping that is accepted [N m s/rad]
constexpr double kMostInertia = 1e3;    // largest inertia that is accepted [kg m^2]
constexpr double kMostTorque = 1e5;     // largest torque that is accepted [N m]
constexpr double kMostOffset = 0.5;     // largest offset that is accepted [rad]
constexpr double kMostRate = 1e4;       // largest rate that is accepted [rad/s]
/// Share of a gear's torque that its friction takes. Definition: at 1 the gear cannot turn.
constexpr double kMostLoadFriction = 1;

/// The values that a constant of a servo may have, with its unit and the advice for other values.
struct ValueRange {
  double least, most;
  const char* unit;
  const char* advice = "";
};
constexpr ValueRange kStiffness = {0, kMostStiffness, "N m/rad"};
constexpr ValueRange kDamping = {0, kMostDamping, "N m s/rad"};
constexpr ValueRange kInertia = {0, kMostInertia, "kg m^2"};
constexpr ValueRange kTorque = {0, kMostTorque, "N m"};
constexpr ValueRange kDelay = {0, kMostServoDelay, "s", "; state it in seconds: 3.7 ms is 0.0037"};
constexpr ValueRange kRate = {0, kMostRate, "rad/s"};
constexpr ValueRange kExponent = {0.1, 10, ""};
constexpr ValueRange kPlay = {0, kMostServoPlay, "rad",
                              "; for degrees, use the key that ends in _deg"};
constexpr ValueRange kPlayDeg = {0, kMostServoPlay / kRadiansPerDegree, "deg"};
constexpr ValueRange kOffset = {
    -kMostOffset, kMostOffset, "rad",
    "; for degrees, use the key that ends in _deg. For a larger offset, "
    "mount the horn in another position"};
constexpr ValueRange kOffsetDeg = {-kMostOffset / kRadiansPerDegree,
                                   kMostOffset / kRadiansPerDegree, "deg",
                                   "; for a larger offset, mount the horn in another position"};
constexpr ValueRange kPositionGain = {0, 1e5, "1/s"};
constexpr ValueRange kTorqueConstant = {0, kMostTorque, "N m/A"};
constexpr ValueRange kResistance = {0, 1e6, "ohm"};
constexpr ValueRange kVoltage = {0, 1e4, "V"};
constexpr ValueRange kVoltageGain = {0, kMostStiffness, "V/rad"};
constexpr ValueRange kShare = {0, kMostLoadFriction, ""};
constexpr ValueRange kPerTorque = {0, kMostLoadFriction, "1/(N m)"};

std::string with_unit(double value, const char* unit) {
  return text::brief(value) + (*unit ? " " : "") + unit;
}

double within(const JsonNode& node, const ValueRange& bounds) {
  const double value = node.number();
  const bool small = value < bounds.least;
  if (small || value > bounds.most)
    node.complain(with_unit(value, bounds.unit) + " is too " + (small ? "small" : "large") +
                  "; the " + (small ? "smallest" : "largest") + " allowed value is " +
                  with_unit(small ? bounds.least : bounds.most, bounds.unit) + bounds.advice);
  return value;
}

double positive(const JsonNode& node, const ValueRange& bounds) {
  const double value = within(node, bounds);
  if (value == 0) node.complain("this value must be above 0, but it is 0");
  return value;
}

/// A key of a group, the field that it fills, and the values that a servo may have.
struct Field {
  const char* key;
  double ServoDescription::*value;
  ValueRange bounds;
  double unit = 1;
};

using S = ServoDescription;
const std::vector<Field>& fields() {
  static const std::vector<Field> all = {
      {"kp", &S::kp, kStiffness},
      {"kd", &S::kd, kDamping},
      {"rotor_inertia", &S::rotor_inertia, kInertia},
      {"viscous", &S::viscous, kDamping},
      {"coulomb", &S::coulomb, kTorque},
      {"delay", &S::delay, kDelay},
      {"speed_command_limit", &S::speed_command_limit, kRate},
      {"stribeck_torque", &S::stribeck_torque, kTorque},
      {"stribeck_rate", &S::stribeck_rate, kRate},
      {"stribeck_exponent", &S::stribeck_exponent, kExponent},
      {"backlash", &S::backlash, kPlay},
      {"backlash_deg", &S::backlash, kPlayDeg, kRadiansPerDegree},
      {"gear_stiffness", &S::gear_stiffness, kStiffness},
      {"gear_damping", &S::gear_damping, kDamping},
      {"dead_band", &S::dead_band, kPlay},
      {"dead_band_deg", &S::dead_band, kPlayDeg, kRadiansPerDegree},
      {"offset", &S::offset, kOffset},
      {"offset_deg", &S::offset, kOffsetDeg, kRadiansPerDegree}};
  return all;
}

struct LoadField {
  const char *key, *bam;
  double LoadFriction::*value;
  ValueRange bounds = kShare;
};
constexpr std::array<LoadField, 6> kLoadFields = {{
    {"motor", "load_friction_motor", &LoadFriction::motor},
    {"external", "load_friction_external", &LoadFriction::external},
    {"motor_stribeck", "load_friction_motor_stribeck", &LoadFriction::motor_stribeck},
    {"external_stribeck", "load_friction_external_stribeck", &LoadFriction::external_stribeck},
    {"motor_quadratic", "load_friction_motor_quad", &LoadFriction::motor_quadratic, kPerTorque},
    {"external_quadratic", "load_friction_external_quad", &LoadFriction::external_quadratic,
     kPerTorque},
}};

/// A motor behind its gear.
struct Motor {
  double torque_constant = 0;  ///< torque constant [N m/A]
  double resistance = 0;       ///< resistance of the winding [ohm]
};

/// The parts of the file that each of BAM's models has.
struct BamModel {
  const char* name;
  bool stribeck, load, directional, quadratic;
};
constexpr std::array<BamModel, 6> kBamModels = {{{"m1", false, false, false, false},
                                                 {"m2", true, false, false, false},
                                                 {"m3", false, true, false, false},
                                                 {"m4", true, true, false, false},
                                                 {"m5", true, true, true, false},
                                                 {"m6", true, true, true, true}}};

const BamModel& bam_model(const JsonNode& root) {
  std::vector<std::string> names;
  for (const BamModel& model : kBamModels) names.emplace_back(model.name);
  const std::string name = root.at("model").one_of(names);
  for (const BamModel& model : kBamModels)
    if (name == model.name) return model;
  root.complain("unknown model");
}

LoadFriction bam_load(const JsonNode& root, const BamModel& model) {
  LoadFriction load;
  const auto share = [&](const char* key) { return within(root.at(key), kShare); };
  if (!model.load) return load;
  if (!model.directional) {
    load.motor = load.external = share("load_friction_base");
    if (model.stribeck)
      load.motor_stribeck = load.external_stribeck = share("load_friction_stribeck");
    return load;
  }
  for (const LoadField& field : kLoadFields)
    if (model.quadratic || (field.value != &LoadFriction::motor_quadratic &&
                            field.value != &LoadFriction::external_quadratic))
      load.*field.value = within(root.at(field.bam), field.bounds);
  return load;
}

/// The entries of a file of BAM that Ayumi knows, whether or not the file's model has them. The
/// zero offset in the file belongs to the test bench, so it is not used.
bool is_known_of_bam(const std::string& entry) {
  constexpr std::array<const char*, 15> kEntries = {"model",
                                                    "actuator",
                                                    "kt",
                                                    "R",
                                                    "armature",
                                                    "q_offset",
                                                    "command_delay",
                                                    "friction_base",
                                                    "friction_viscous",
                                                    "friction_stribeck",
                                                    "dtheta_stribeck",
                                                    "alpha",
                                                    "load_friction_base",
                                                    "load_friction_stribeck",
                                                    "comment"};
  const auto is_entry = [&](const char* known) { return entry == known; };
  return std::any_of(kEntries.begin(), kEntries.end(), is_entry) ||
         std::any_of(kLoadFields.begin(), kLoadFields.end(),
                     [&](const LoadField& field) { return entry == field.bam; });
}

/// A sentence about the entries that are not used, such as the bound of the current; empty if all
/// are known.
std::string unused_of_bam(const JsonNode& root, const std::filesystem::path& path) {
  std::vector<std::string> names;
  for (const auto& [entry, value] : root.members())
    if (!is_known_of_bam(entry)) names.push_back(entry);
  if (names.empty()) return "";
  return path.filename().string() + ": " + text::join(names, ", ") +
         (names.size() == 1 ? " of this servo has" : " of this servo have") +
         " no counterpart in Ayumi, so the simulated servo ignores " +
         (names.size() == 1 ? "this entry" : "these entries");
}

Motor read_bam(const JsonNode& node, ServoDescription& servo, ServoGroups& out,
               std::string& bytes) {
  const std::filesystem::path path =
      std::filesystem::path(node.file()).parent_path() / node.string();
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    node.complain("there is no file " + path.string() +
                  "; state the path relative to the folder of this sidecar");
  const std::string text = read_file(path);
  bytes += text;
  const Json document = parse_json(text, path.string(), ErrorCode::bad_file);
  const JsonNode root = root_of(document, path.string(), ErrorCode::bad_file);
  const BamModel& model = bam_model(root);
  servo.rotor_inertia = within(root.at("armature"), kInertia);
  servo.coulomb = within(root.at("friction_base"), kTorque);
  servo.viscous = within(root.at("friction_viscous"), kDamping);
  servo.stribeck_torque = servo.stribeck_rate = 0;
  if (model.stribeck) {
    servo.stribeck_torque = within(root.at("friction_stribeck"), kTorque);
    servo.stribeck_rate = positive(root.at("dtheta_stribeck"), kRate);
    servo.stribeck_exponent = within(root.at("alpha"), kExponent);
  }
  servo.load = bam_load(root, model);
  if (const auto delay = root.find("command_delay")) servo.delay = within(*delay, kDelay);
  if (const std::string unused = unused_of_bam(root, path); !unused.empty())
    out.unused.insert(unused);
  return {positive(root.at("kt"), kTorqueConstant), positive(root.at("R"), kResistance)};
}

// The voltage of a motor bounds its torque. If the gain is in volts per radian, the position loop
// commands a voltage, and the motor's own back-EMF is its damping.
void read_motor(const JsonNode& node, Motor motor, ServoDescription& servo) {
  node.only_keys({"torque_constant", "resistance", "voltage", "gain"});
  if (const auto constant = node.find("torque_constant"))
    motor.torque_constant = positive(*constant, kTorqueConstant);
  if (const auto resistance = node.find("resistance"))
    motor.resistance = positive(*resistance, kResistance);
  if (motor.torque_constant == 0) node.at("torque_constant");  // complains about the missing key
  if (motor.resistance == 0) node.at("resistance");
  const double voltage = positive(node.at("voltage"), kVoltage);
  servo.stall_torque = motor.torque_constant * voltage / motor.resistance;
  servo.back_emf = motor.torque_constant * motor.torque_constant / motor.resistance;
  if (const auto gain = node.find("gain")) {
    servo.kp = motor.torque_constant * within(*gain, kVoltageGain) / motor.resistance;
    servo.kd = servo.back_emf;
    servo.speed_command_limit = 0;
  }
}

void read_speed_loop(const JsonNode& group, ServoDescription& servo) {
  if (!group.has("position_gain") && !group.has("speed_gain")) return;
  const double position = positive(group.at("position_gain"), kPositionGain);
  servo.kd = positive(group.at("speed_gain"), kDamping);
  servo.kp = position * servo.kd;
}

/// Refuses a group in which two keys state the same quantity in two ways.
void refuse_both(const JsonNode& group, const char* one, const char* other) {
  if (group.has(one) && group.has(other))
    group.complain("the group has both '" + std::string(one) + "' and '" + other +
                   "', which state the same quantity; keep one of these keys");
}

bool has_gain(const JsonNode& group) {
  const auto motor = group.find("motor");
  return motor && motor->has("gain");
}

void check_group(const JsonNode& group) {
  std::vector<std::string> keys = {"joints", "position_gain", "speed_gain", "motor",
                                   "bam",    "load_friction", "quantized",  "comment"};
  for (const Field& field : fields()) keys.emplace_back(field.key);
  group.only_keys(keys);
  for (const char* key : {"kp", "kd"})
    for (const char* other : {"position_gain", "speed_gain"}) refuse_both(group, key, other);
  for (const char* key : {"backlash", "dead_band", "offset"})
    refuse_both(group, key, (std::string(key) + "_deg").c_str());
  if (has_gain(group))
    for (const char* key : {"kp", "kd", "position_gain", "speed_gain"})
      if (group.has(key))
        group.at("motor").at("gain").complain("the group also states '" + std::string(key) +
                                              "', but the gain of the motor determines this value; "
                                              "keep one of these keys");
}

// Checks that concern more than one field.
void check_servo(const JsonNode& group, const std::string& joint, const ServoDescription& servo) {
  if (servo.stribeck_torque > 0 && servo.stribeck_rate <= 0)
    group.complain(
        "joint " + joint +
        ": with a stribeck_torque, stribeck_rate must be above 0. It is the joint rate at "
        "which the Stribeck friction fades");
  if (servo.stribeck_rate <= 0 &&
      (servo.load.motor_stribeck > 0 || servo.load.external_stribeck > 0 ||
       servo.load.motor_quadratic > 0 || servo.load.external_quadratic > 0))
    group.complain(
        "joint " + joint +
        ": with load friction at rest, stribeck_rate must be above 0. It is the joint rate "
        "at which this friction fades");
  if (servo.speed_command_limit > 0 && servo.kd <= 0)
    group.complain("joint " + joint +
                   ": speed_command_limit is given, but the servo has no inner speed loop; state "
                   "position_gain and speed_gain");
  if (servo.quantized && servo.kp <= 0)
    group.complain("joint " + joint +
                   ": 'quantized' is given, but the joint has no servo; state kp of this joint, or "
                   "remove 'quantized'");
}

}  // namespace

void read_servo_group(const JsonNode& group, const std::vector<std::string>& joints,
                      ServoGroups& out) {
  check_group(group);
  std::string bytes;
  for (const std::string& joint : joints) {
    ServoDescription& servo = out.servos[joint];
    Motor motor;
    bytes.clear();
    if (const auto bam = group.find("bam")) motor = read_bam(*bam, servo, out, bytes);
    for (const Field& field : fields())
      if (const auto found = group.find(field.key))
        servo.*field.value = field.unit * within(*found, field.bounds);
    read_speed_loop(group, servo);
    if (const auto node = group.find("motor"))
      read_motor(*node, motor, servo);
    else if (group.has("bam"))
      group.complain("a group with 'bam' needs 'motor' with the voltage [V] and the gain [V/rad]");
    if (const auto load = group.find("load_friction")) {
      std::vector<std::string> keys;
      for (const LoadField& field : kLoadFields) keys.emplace_back(field.key);
      load->only_keys(keys);
      for (const LoadField& field : kLoadFields)
        if (const auto share = load->find(field.key))
          servo.load.*field.value = within(*share, field.bounds);
    }
    if (const auto quantized = group.find("quantized")) servo.quantized = quantized->boolean();
    check_servo(group, joint, servo);
    if (group.has("kp") || group.has("position_gain") || has_gain(group)) out.stated[joint] = true;
  }
  out.files += bytes;
}

}  // namespace ayumi
