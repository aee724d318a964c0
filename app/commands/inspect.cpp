// Examines a robot: everything that its files say, what was inferred, and what is suspicious.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/controller.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/diagnose.hpp"
#include "ayumi/model/outline.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "ayumi/plan/place_text.hpp"
#include "ayumi/render/clip.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "robot_picture.hpp"
#include "terminal.hpp"

namespace ayumi::app {

namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180;

struct InspectOptions {
  std::string robot, picture, view = "iso";
};

struct Stance {
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();  // relative to the middle between the soles [m]
  double height = 0;  // height of the whole robot with every joint at 0 [m]
};

// The home posture with the robot on the ground, and with the origin midway between the sole
// frames.
Stance stance_of(const RobotModel& model) {
  Stance stance;
  RobotData data(model);
  RobotState state = model.rest_state();
  update_positions(model, state, data);
  if (model.has_soles()) {
    anchor_base(model, Side::left, Eigen::Isometry3d::Identity(), state, data);
    const Eigen::Vector3d right = sole_pose(model, data, Side::right).translation();
    stance.cog = data.cog - right / 2;
  } else {
    stance.cog = data.cog;
  }
  state = model.rest_state();
  state.theta.setZero();
  update_positions(model, state, data);
  Eigen::AlignedBox3d box;
  for (size_t i = 0; i < model.links().size(); ++i)
    for (const auto* shapes : {&model.links()[i].visuals, &model.links()[i].collisions})
      for (const PlacedShape& placed : *shapes)
        for (const Eigen::Vector3d& point : outline(placed.shape))
          box.extend(link_pose(model, data, static_cast<int>(i)) * placed.pose * point);
  stance.height = box.isEmpty() ? 0 : box.sizes().z();
  return stance;
}

// JSON has no number for infinity; a limit that is not stated is null.
OrderedJson number(double value) {
  return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

// The five constants of every servo, and what else the files state about it.
OrderedJson servo_json(const ServoDescription& servo) {
  OrderedJson json = {{"kp", servo.kp},
                      {"kd", servo.kd},
                      {"rotor_inertia", servo.rotor_inertia},
                      {"viscous", servo.viscous},
                      {"coulomb", servo.coulomb},
                      {"lag_s", servo.lag()}};
  const std::pair<const char*, double> further[] = {
      {"delay_s", servo.delay},
      {"speed_command_limit", servo.speed_command_limit},
      {"stribeck_torque", servo.stribeck_torque},
      {"stribeck_rate", servo.stribeck_rate},
      {"backlash_rad", servo.backlash},
      {"gear_stiffness", servo.gear_stiffness},
      {"gear_damping", servo.gear_damping},
      {"stall_torque", servo.stall_torque},
      {"back_emf", servo.back_emf},
      {"dead_band_rad", servo.dead_band},
      {"offset_rad", servo.offset}};
  for (const auto& [key, value] : further)
    if (value != 0) json[key] = value;
  if (servo.stribeck_rate > 0) json["stribeck_exponent"] = servo.stribeck_exponent;
  if (servo.quantized) json["quantized"] = true;
  if (!(servo.load == LoadFriction{}))
    json["load_friction"] = {{"motor", servo.load.motor},
                             {"external", servo.load.external},
                             {"motor_stribeck", servo.load.motor_stribeck},
                             {"external_stribeck", servo.load.external_stribeck},
                             {"motor_quadratic", servo.load.motor_quadratic},
                             {"external_quadratic", servo.load.external_quadratic}};
  return json;
}

OrderedJson joint_json(const RobotModel& model, int index) {
  const Dof& dof = model.dofs()[index];
  OrderedJson limits;
  for (const std::string& name : model.profile_names()) {
    const ActuatorLimits& profile = model.limits(name);
    limits[name] = {{"speed_rad_s", number(profile.speed[index])},
                    {"peak_torque_Nm", number(profile.peak_torque[index])},
                    {"continuous_torque_Nm", number(profile.continuous_torque[index])}};
  }
  return {{"name", dof.name},
          {"link", model.bodies()[dof.body].name},
          {"type", dof.prismatic ? "prismatic" : "revolute"},
          {"lower", number(dof.lower)},
          {"upper", number(dof.upper)},
          {"home", model.posture()[index]},
          {"weight", model.joint_weight()[index]},
          {"limits", limits},
          {"servo", servo_json(model.limits().servo[index])},
          {"encoder",
           {{"device", dof.encoder.device}, {"counts_per_degree", dof.encoder.counts_per_degree}}}};
}

OrderedJson soles_json(const RobotModel& model) {
  OrderedJson soles = OrderedJson::object();
  if (!model.has_soles()) return soles;
  for (const Side side : {Side::left, Side::right}) {
    const Sole& sole = model.sole(side);
    OrderedJson polygon = OrderedJson::array();
    for (const Eigen::Vector2d& corner : sole.polygon) polygon.push_back({corner.x(), corner.y()});
    soles[name_of(side)] = {{"link", model.description().soles.at(name_of(side)).link},
                            {"polygon_m", polygon},
                            {"stiffness_N_m", sole.stiffness},
                            {"damping_time_s", sole.damping_time}};
  }
  return soles;
}

std::vector<std::string> posture_names(const RobotModel& model) {
  std::vector<std::string> names;
  for (const auto& [name, angles] : model.description().postures) names.push_back(name);
  return names;
}

// Joints that move together: those that mimic another one, and those that move both legs.
struct Coupling {
  std::string joint, driver, relation;
};

std::vector<Coupling> couplings(const RobotModel& model) {
  std::vector<Coupling> found;
  for (const JointDescription& joint : model.description().joints) {
    if (joint.mimic.empty()) continue;
    const JointDescription* driver = &joint;
    double ratio = 1, offset = 0;
    while (!driver->mimic.empty()) {
      offset += ratio * driver->mimic_offset;
      ratio *= driver->mimic_multiplier;
      const std::string name = driver->mimic;
      for (const JointDescription& each : model.description().joints)
        if (each.name == name) driver = &each;
    }
    found.push_back(
        {joint.name, driver->name,
         text::brief(ratio) + " times " + driver->name +
             (offset == 0 ? ""
                          : (offset > 0 ? " + " : " - ") + text::brief(std::abs(offset)) +
                                (joint.type == JointType::prismatic ? " m" : " rad"))});
  }
  return found;
}

// Degrees of freedom that move a joint in each leg at the same time, such as coupled hips. A waist
// above both legs does not count.
std::vector<std::string> joints_of_both_legs(const RobotModel& model) {
  std::vector<std::string> names;
  if (!model.has_soles()) return names;
  for (int left = model.sole(Side::left).body; left > 0; left = model.bodies()[left].parent)
    for (int right = model.sole(Side::right).body; right > 0; right = model.bodies()[right].parent)
      if (left != right && model.bodies()[left].dof == model.bodies()[right].dof)
        names.push_back(model.dofs()[model.bodies()[left].dof].name);
  return names;
}

OrderedJson inspection_json(const RobotModel& model, const Stance& stance,
                            const std::vector<ModelWarning>& warnings) {
  OrderedJson joints = OrderedJson::array(), notes = OrderedJson::array();
  for (int i = 0; i < model.dof_count(); ++i) joints.push_back(joint_json(model, i));
  for (const ModelWarning& warning : warnings)
    notes.push_back({{"where", warning.where}, {"message", warning.message}});
  OrderedJson links = OrderedJson::array();
  for (const Link& link : model.links())
    links.push_back({{"name", link.name}, {"mass_kg", link.inertia.mass}});
  OrderedJson coupled = OrderedJson::array();
  for (const Coupling& each : couplings(model))
    coupled.push_back(
        {{"joint", each.joint}, {"driver", each.driver}, {"relation", each.relation}});
  const RobotDescription& files = model.description();
  return {{"robot", model.name()},
          {"dof", model.dof_count()},
          {"mass_kg", model.mass()},
          {"height_m", stance.height},
          {"cog_m", {stance.cog.x(), stance.cog.y(), stance.cog.z()}},
          {"joints", joints},
          {"coupled_joints", coupled},
          {"joints_of_both_legs", joints_of_both_legs(model)},
          {"links", links},
          {"soles", soles_json(model)},
          {"profiles", model.profile_names()},
          {"postures", posture_names(model)},
          {"gains", files.control.dtad},
          {"warnings", notes},
          {"assumptions", files.assumptions},
          {"sha256", files.sha256}};
}

std::string right_aligned(const std::string& text, size_t width) {
  return std::string(text.size() < width ? width - text.size() : 0, ' ') + text;
}

std::string angle(const Dof& dof, double value) {
  if (std::isinf(value)) return "-";
  return dof.prismatic ? text::fixed(1000 * value, 1) : text::fixed(value / kDegree, 1);
}

std::string limit(double value) { return std::isinf(value) ? "-" : text::brief(value); }

// The width of the longest name, so that columns do not touch each other.
size_t name_width(const RobotModel& model) {
  size_t width = 20;
  for (const Dof& dof : model.dofs()) width = std::max(width, dof.name.size());
  return width;
}

std::string joint_lines(const RobotModel& model) {
  const size_t width = name_width(model);
  std::string text =
      "Joints (angles in deg, sliding joints in mm); servo kp [N m/rad], kd [N m s/rad]; rotor "
      "inertia [kg m^2]; weight of the joint in a repair\n  " +
      padded("", width) + "   lower   upper    home       kp       kd     rotor  weight  " +
      "device  counts/deg\n";
  for (int i = 0; i < model.dof_count(); ++i) {
    const Dof& dof = model.dofs()[i];
    const auto column = [&](const std::string& value, size_t columns) {
      text += " " + right_aligned(value, columns - 1);
    };
    text += "  " + padded(dof.name, width);
    column(angle(dof, dof.lower), 8);
    column(angle(dof, dof.upper), 8);
    column(angle(dof, model.posture()[i]), 8);
    const ServoDescription& servo = model.limits().servo[i];
    column(text::brief(servo.kp), 9);
    column(text::brief(servo.kd), 9);
    column(text::brief(servo.rotor_inertia), 10);
    column(text::brief(model.joint_weight()[i]), 8);
    column(dof.encoder.device ? std::to_string(dof.encoder.device) : "-", 8);
    column(dof.encoder.device ? text::brief(dof.encoder.counts_per_degree) : "-", 12);
    text += "\n";
  }
  return text;
}

std::string posture_line(const RobotModel& model) {
  const std::vector<std::string> names = posture_names(model);
  return names.empty() ? "" : "Postures: " + text::join(names, ", ") + "\n";
}

std::string profile_lines(const RobotModel& model) {
  const size_t width = name_width(model);
  std::vector<std::string> lines(static_cast<size_t>(model.dof_count()) + 1,
                                 "  " + padded("", width));
  for (int i = 0; i < model.dof_count(); ++i)
    lines[static_cast<size_t>(i) + 1] = "  " + padded(model.dofs()[i].name, width);
  for (const std::string& name : model.profile_names()) {
    const ActuatorLimits& limits = model.limits(name);
    std::vector<std::string> cells = {name};
    size_t widest = 20;
    for (int i = 0; i < model.dof_count(); ++i)
      cells.push_back(limit(limits.speed[i] * (model.dofs()[i].prismatic ? 1e3 : 180 / EIGEN_PI)) +
                      "  " + limit(limits.peak_torque[i]) + " / " +
                      limit(limits.continuous_torque[i]));
    for (const std::string& cell : cells) widest = std::max(widest, cell.size());
    for (size_t i = 0; i < lines.size(); ++i) lines[i] += right_aligned(cells[i], widest + 2);
  }
  return "Actuator limits: speed [deg/s, mm/s], peak / continuous torque [N m]\n" +
         text::join(lines, "\n") + "\n";
}

std::string coupling_lines(const RobotModel& model) {
  std::string text;
  for (const Coupling& each : couplings(model))
    text += "  " + each.joint + " = " + each.relation + "\n";
  const std::vector<std::string> shared = joints_of_both_legs(model);
  if (!shared.empty())
    text += "  both legs move with " + text::join(shared, ", ") +
            ": the legs cannot turn relative to each other, so the trunk turns and leans instead\n";
  return text.empty() ? "" : "Coupled joints (angles in rad, sliding joints in m)\n" + text + "\n";
}

std::string sole_lines(const RobotModel& model) {
  if (!model.has_soles()) return "Soles: none\n";
  std::string text = "Soles [mm, ahead of and left of the ankle]\n";
  for (const Side side : {Side::left, Side::right}) {
    text += "  " + padded(name_of(side), 7) +
            padded(model.description().soles.at(name_of(side)).link, 14) + " ";
    for (const Eigen::Vector2d& corner : model.sole(side).polygon)
      text +=
          " (" + text::fixed(1000 * corner.x(), 1) + ", " + text::fixed(1000 * corner.y(), 1) + ")";
    text += "  " + text::brief(model.sole(side).stiffness) + " N/m\n";
  }
  return text;
}

/// The response of the load cells, for each foot.
std::string cell_lines(const SensorDescription& sensors) {
  std::string text;
  for (const auto& [side, cells] : sensors.force_cells) {
    text += "  cells of the " + side + " sole:";
    for (size_t i = 0; i < cells.size(); ++i) {
      const CellResponse& cell = cells[i];
      text += (i > 0 ? "; gain " : " gain ") + text::brief(cell.gain) + ", dead zone " +
              text::brief(cell.dead_zone) + " N, hysteresis " + text::brief(cell.hysteresis) +
              " N, " +
              (cell.saturation > 0 ? "at most " + text::brief(cell.saturation) + " N"
                                   : "no saturation");
    }
    text += cells.size() == 1 ? " (each)\n" : "\n";
  }
  return text;
}

std::string sensor_lines(const RobotModel& model) {
  const SensorDescription& sensors = model.description().sensors;
  const Eigen::Vector3d at = 1000 * sensors.imu_position;
  std::string text =
      "Sensors\n  IMU on " + (sensors.imu_link.empty() ? model.links()[0].name : sensors.imu_link) +
      " at (" + text::brief(at.x()) + ", " + text::brief(at.y()) + ", " + text::brief(at.z()) +
      ") mm: attitude noise " + text::brief(sensors.attitude_noise) + " rad, bias " +
      text::brief(sensors.attitude_bias) + " rad, gyro noise " + text::brief(sensors.gyro_noise) +
      " rad/s, accelerometer noise " + text::brief(sensors.accelerometer_noise) + " m/s^2\n";
  text += "  load cells at the sole corners: noise " + text::brief(sensors.force_noise) +
          " N, resolution " + text::brief(sensors.force_resolution) + " N";
  if (sensors.force_readings > 1)
    text += ", mean of " + std::to_string(sensors.force_readings) + " readings";
  text += "\n" + cell_lines(sensors) + "  latency " + text::brief(1000 * sensors.latency) + " ms";
  for (const auto& [latency, what] :
       {std::pair(sensors.encoder_latency, "joint angles"), std::pair(sensors.imu_latency, "IMU"),
        std::pair(sensors.force_latency, "load cells")})
    if (latency)
      text += ", latency of the " + std::string(what) + " " + text::brief(1000 * *latency) + " ms";
  return text + ", servo period " + text::brief(1000 * model.description().servo_period) +
         " ms, joint angles " +
         (sensors.encoder_quantisation ? "rounded to counts" : "not rounded") + "\n";
}

std::string gain_lines(const RobotModel& model) {
  if (model.description().control.dtad.empty()) return "";
  std::string text = "DTAD gains:";
  for (const auto& [name, value] : model.description().control.dtad)
    text += " " + name + " " + text::brief(value);
  return text + "\n";
}

std::string list_lines(const std::string& title, const std::vector<std::string>& items) {
  std::string text = title + (items.empty() ? ": none\n" : "\n");
  for (const std::string& item : items) text += "  - " + item + "\n";
  return text;
}

// The places of the feet for their first keys, in the form that a pattern has.
std::string feet_line(const RobotModel& model) {
  if (!model.has_soles() || !model.has_posture("home")) return "";
  const auto feet = start_feet(model, {});
  const auto place = [&](Side side) {
    return "\"" + std::string(name_of(side)) +
           "\": " + place_text(feet[static_cast<size_t>(index(side))].translation());
  };
  return "Feet at home, as in keys [m]: " + place(Side::left) + ", " + place(Side::right) + "\n";
}

std::string inspection_text(const RobotModel& model, const Stance& stance,
                            const std::vector<ModelWarning>& warnings) {
  std::vector<std::string> notes;
  for (const ModelWarning& warning : warnings)
    notes.push_back(warning.where + ": " + warning.message);
  const Eigen::Vector3d cog = 1000 * stance.cog;
  return model.name() + ": " + std::to_string(model.dof_count()) + " DOF, " +
         text::fixed(model.mass(), 3) + " kg, " + text::fixed(1000 * stance.height, 0) +
         " mm high (every joint at 0), " + std::to_string(model.bodies().size()) + " bodies, " +
         std::to_string(model.links().size()) + " links\nCOG at home: x " +
         text::fixed(cog.x(), 1) + ", y " + text::fixed(cog.y(), 1) + ", z " +
         text::fixed(cog.z(), 1) + " mm from " +
         (model.has_soles() ? "the middle between the sole frames" : "the root link") + "\n" +
         feet_line(model) + "\n" + joint_lines(model) + "\n" + coupling_lines(model) +
         profile_lines(model) + "\n" + sole_lines(model) + sensor_lines(model) + gain_lines(model) +
         posture_line(model) + "\n" + list_lines("Assumptions", model.description().assumptions) +
         list_lines("Warnings", notes);
}

void inspect(const Context& context, const InspectOptions& options) {
  const RobotModel model = load_robot(options.robot, robot_search(context), {.meshes = true});
  check_controller(model, {ControllerKind::dtad, {}});  // checks the sidecar's gains of both laws
  std::vector<std::string> notes;
  if (!options.picture.empty())
    notes = write_robot_picture(context, model, options.picture, options.view);
  const Stance stance = stance_of(model);
  const std::vector<ModelWarning> warnings = diagnose(model);
  context.print(inspection_text(model, stance, warnings));
  if (!options.picture.empty()) context.print("Picture " + options.picture + "\n");
  for (const std::string& note : notes) context.print("  - " + note + "\n");
  if (context.json) context.print_json(inspection_json(model, stance, warnings).dump(2));
}

}  // namespace

void add_inspect(Command& app, Context& context) {
  Command* command = app.add_subcommand(
      "inspect",
      "show everything that is known about a robot, and what is suspicious in its files");
  command->footer(
      "Examples:\n  ayumi inspect hoap1\n  ayumi inspect my_robot/robot.json --json\n"
      "  ayumi inspect somebody.urdf --picture somebody.png\n"
      "What the robot's file does not state is inferred and listed as an assumption.");
  auto options = std::make_shared<InspectOptions>();
  command
      ->add_option("robot", options->robot,
                   "Name of a bundled robot, or a folder, sidecar or robot file (URDF, MJCF, SDF, "
                   "Choreonoid body, mi-lib ztk).")
      ->required()
      ->type_name("ROBOT");
  command->add_option("--picture", options->picture, "Draw the home posture on the ground (.png).")
      ->type_name("FILE");
  command->add_option("--view", options->view, "View: " + text::join(view_names(), ", ") + ".")
      ->check(one_of(view_names()).description(""))
      ->capture_default_str();
  command->callback([&context, options] { inspect(context, *options); });
}

}  // namespace ayumi::app
