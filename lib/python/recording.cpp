// Data that other programs and the robot itself provide: motions of other formats, and recordings
// from which servos are identified.

#include "ayumi/io/table/recording.hpp"

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/identify/identify.hpp"
#include "ayumi/io/formats/motion_formats.hpp"
#include "ayumi/io/import_pattern.hpp"
#include "ayumi/io/robot/identified_sidecar.hpp"
#include "bindings.hpp"

namespace ayumi::python {

namespace {

void bind_import(py::module_& m) {
  py::class_<FootContact>(m, "Contact", "One foot on the ground, in a motion that was imported.")
      .def_property_readonly(
          "foot", [](const FootContact& c) { return std::string(name_of(c.foot)); },
          "'left' or 'right'.")
      .def_readonly("begin", &FootContact::begin, "Beginning of the contact [s].")
      .def_readonly("end", &FootContact::end, "End of the contact [s].")
      .def_property_readonly(
          "position", [](const FootContact& c) { return c.place.position; },
          "Place of the sole in the world [m], shape (3,).")
      .def_property_readonly(
          "yaw", [](const FootContact& c) { return c.place.rpy.z(); },
          "Heading of the sole [rad].");
  py::class_<ImportedPattern>(m, "Import", "A motion of another program or robot as a pattern.")
      .def_readonly("pattern", &ImportedPattern::pattern,
                    "The pattern; ayumi.sample(found.pattern, robot) samples it.")
      .def_readonly("format", &ImportedPattern::format, "Name of the format of the file.")
      .def_readonly("reason", &ImportedPattern::reason,
                    "Why Ayumi chose this format; '' if the caller named the format.")
      .def_readonly("rows", &ImportedPattern::rows, "Data rows, or key poses, of the file.")
      .def_readonly(
          "contacts", &ImportedPattern::contacts,
          "Contacts of the feet, in the order of their beginning; none for a file of key poses.")
      .def_readonly("notes", &ImportedPattern::filled,
                    "What was assumed, left out or changed, one sentence each.")
      .def(
          "write",
          [](const ImportedPattern& found, const Path& path) {
            ImportedPattern written = found;
            write_imported(path, written);
          },
          py::arg("path"),
          "Writes the pattern and its table. For formats whose files can be exported unchanged, it "
          "also "
          "writes a copy of the file. It writes all of these files, or none.");
  m.def("motion_formats", &read_format_names, "Names of the formats that import_motion() reads.");
  m.def(
      "import_motion",
      [](const Path& path, const RobotModel& robot, const std::string& format, double rate,
         bool degrees, bool order, const std::vector<std::string>& joints,
         const std::string& motion, bool commands, const std::string& at,
         std::optional<double> smooth, bool ground, double ramp,
         std::optional<double> contact_height, std::optional<double> contact_speed,
         std::optional<double> contact_load) {
        PatternImport options;
        options.reading.format = format;
        options.reading.rate = rate;
        options.reading.degrees = degrees;
        options.reading.by_order = order;
        options.reading.joints = joints;
        options.reading.motion = motion;
        options.reading.commands = commands;
        if (!at.empty()) options.reading.measured_at = measured_at(at);
        options.reading.smooth = smooth;
        options.ground = ground;
        options.ramp = ramp;
        options.contact.height = contact_height.value_or(options.contact.height);
        options.contact.speed = contact_speed.value_or(options.contact.speed);
        options.contact.load = contact_load.value_or(options.contact.load);
        const py::gil_scoped_release release;
        ImportedPattern found =
            import_pattern(read_file(path, kLargestMotionFile), path.string(), robot, options);
        found.pattern.robot = robot.name();
        return found;
      },
      py::arg("path"), py::arg("robot"), py::kw_only(), py::arg("format") = "",
      py::arg("rate") = 0.0, py::arg("degrees") = false, py::arg("order") = false,
      py::arg("joints") = std::vector<std::string>(), py::arg("motion") = "",
      py::arg("commands") = false, py::arg("measured_at") = "", py::arg("smooth") = py::none(),
      py::arg("ground") = false, py::arg("ramp") = 0.0, py::arg("contact_height") = py::none(),
      py::arg("contact_speed") = py::none(), py::arg("contact_load") = py::none(),
      "Reads a motion of another program or robot, as `ayumi import` does. `format` is one of "
      "motion_formats(); without it, the format follows from the content. "
      "`rate` [1/s] is the number of rows per second, for rows without times. "
      "With `degrees`, angles without a unit in the file are in degrees. "
      "With `order`, the columns are the joints of the robot, in the order of the robot. "
      "`joints` are the names of the joint columns. "
      "`motion` is the name or the number of the motion in a file with several motions. "
      "With `commands`, the angles are servo targets. "
      "`measured_at` is 'encoder' for angles of the encoders, to which the offsets of the robot "
      "are added, 'joint' for angles of the joints, or '' if the format decides. "
      "`smooth` is the largest change of an angle by smoothing [deg]. "
      "With `ground`, the soles that carry the robot are put on the ground. "
      "`ramp` is the time between rest and the speed of a recording that begins or ends in motion "
      "[s]. A sole carries "
      "the robot when it is at most `contact_height` [m] above the lowest one, slower than "
      "`contact_speed` [m/s], and the motion of the COG needs at least `contact_load` times the "
      "weight as ground force.");
}

// Angles of the caller, as a time `dt` between rows and the rows, or those of a file.
using Angles = std::variant<Path, std::pair<double, Eigen::MatrixXd>>;

AngleTable angles_of(const Angles& given, const char* what, const RobotModel& robot,
                     const RecordingOptions& options) {
  if (const Path* path = std::get_if<Path>(&given))
    return read_angles(read_file(*path), path->string(), robot, options);
  const auto& [dt, theta] = std::get<1>(given);
  const std::string name = std::string(what) + ": ";
  if (!(dt > 0) || !std::isfinite(dt))
    fail(ErrorCode::usage, name + "the time between two rows is " + text::brief(dt) +
                               " s; it must be greater than 0");
  if (theta.cols() != robot.dof_count())
    fail(ErrorCode::usage, name + std::to_string(theta.cols()) + " columns, but robot '" +
                               robot.name() + "' has " + std::to_string(robot.dof_count()) +
                               " joints");
  if (theta.rows() < 2 || !theta.allFinite())
    fail(ErrorCode::usage, name + "two rows or more of finite angles are needed");
  AngleTable table;
  table.dt = dt;
  table.theta = theta;
  table.has.assign(static_cast<size_t>(theta.cols()), 1);
  table.resolution = Eigen::VectorXd::Zero(theta.cols());
  take_to_joints(robot, options.measured_at, table);
  return table;
}

std::string name_of_angles(const Angles& given, const char* other) {
  const Path* path = std::get_if<Path>(&given);
  return path ? path->filename().string() : other;
}

/// The constants that were identified, with the robot and the names of the recordings, for a
/// sidecar.
struct PyIdentification {
  Identification found;
  RobotModel robot;
  std::string command, measured;
};

void bind_identify(py::module_& m) {
  py::class_<ServoEstimate>(m, "ServoEstimate", "A value with its 95 % interval.")
      .def_readonly("value", &ServoEstimate::value, "The value.")
      .def_readonly("lower", &ServoEstimate::lower, "Lower end of the interval.")
      .def_readonly("upper", &ServoEstimate::upper, "Upper end; inf where there is none.")
      .def_readonly("known", &ServoEstimate::known,
                    "Whether the recording determines the value: its uncertainty is at most half "
                    "of the value.")
      .def("__repr__", [](const ServoEstimate& e) {
        return "<" + text::brief(e.value) + " (" + text::brief(e.lower) + ".." +
               text::brief(e.upper) + ")>";
      });
  py::class_<IdentifiedJoint>(m, "IdentifiedJoint", "The servo constants of one joint.")
      .def_readonly("joint", &IdentifiedJoint::joint, "Name of the joint.")
      .def_readonly("type", &IdentifiedJoint::type,
                    "Motor type of the joint, named after the first joint of the type.")
      .def_readonly(
          "moved", &IdentifiedJoint::moved,
          "Whether the joint moved. If not, only its mean distance from the command is known.")
      .def_readonly("delay", &IdentifiedJoint::delay, "Transport delay [s].")
      .def_readonly("kp", &IdentifiedJoint::kp, "Stiffness [N m/rad].")
      .def_readonly("damping", &IdentifiedJoint::damping, "kd + viscous friction [N m s/rad].")
      .def_readonly("viscous", &IdentifiedJoint::viscous, "Viscous friction [N m s/rad].")
      .def_readonly("coulomb", &IdentifiedJoint::coulomb, "Dry friction [N m].")
      .def_readonly("backlash", &IdentifiedJoint::backlash, "Whole play [rad].")
      .def_readonly("offset", &IdentifiedJoint::offset,
                    "Mean distance of the unloaded joint from its command [rad].")
      .def_readonly(
          "lag", &IdentifiedJoint::lag,
          "Time by which the angle is behind a slow command [s]: a value with its interval.")
      .def_readonly("mean_error", &IdentifiedJoint::mean_error,
                    "Mean error of the angle that remains with these constants [rad].")
      .def_readonly("largest_error", &IdentifiedJoint::largest_error,
                    "Largest error of the angle that remains with these constants [rad].")
      .def_readonly("confounded", &IdentifiedJoint::confounded,
                    "What cannot be distinguished in this recording, in words.");
  py::class_<PyIdentification>(m, "Identification", "Servo constants of a robot from a recording.")
      .def_property_readonly(
          "joints", [](const PyIdentification& i) { return i.found.joints; },
          "The joints that the recording has, in the order of the robot.")
      .def_property_readonly(
          "seconds", [](const PyIdentification& i) { return i.found.seconds; },
          "Length of the recording [s].")
      .def_property_readonly(
          "caution", [](const PyIdentification& i) { return i.found.caution; },
          "A warning if the recording may be shifted in time; '' otherwise.")
      .def(
          "sidecar",
          [](const PyIdentification& i, const std::string& base, const std::string& name) {
            return identified_sidecar(i.robot, i.found, {base, name, i.command, i.measured});
          },
          py::arg("base"), py::arg("name") = "identified",
          "The text of a sidecar with these servos. `base` is the name or path of the robot, as "
          "the "
          "sidecar names it; `name` is added to the name of the robot.");
  m.def(
      "identify",
      [](const RobotModel& robot, const Angles& command, const Angles& measured,
         const std::optional<Path>& loads, const std::string& at, bool per_type,
         const std::string& stand, double rate, bool degrees, double longest_lag, int threads,
         py::object progress) {
        if (stand != "auto" && stand != "feet" && stand != "fixed")
          fail(ErrorCode::usage, "stand '" + stand + "' is not one of auto, feet and fixed");
        if (stand == "feet" && !robot.has_soles())
          fail(ErrorCode::bad_model,
               robot.name() +
                   ": the robot has no soles; add \"soles\" to its sidecar, or use "
                   "stand='fixed'");
        const MeasuredAt place = measured_at(at);
        return Watch(std::move(progress)).run([&](const Progress& watched) {
          RecordedMotion motion;
          RecordingOptions reading{.degrees = degrees, .rate = rate};
          motion.command = angles_of(command, "command", robot, reading);
          if (reading.rate <= 0) reading.rate = 1 / motion.command.dt;
          reading.measured_at = place;
          motion.measured = angles_of(measured, "measured", robot, reading);
          IdentifyOptions options;
          if (loads) {
            motion.sensors = read_sensors_table(read_file(*loads), loads->string(), robot, reading);
            options.loads_place = loads->string();
          }
          options.per_type = per_type;
          options.stand = stand == "fixed" || (stand == "auto" && !robot.has_soles())
                              ? RobotStand::fixed
                              : RobotStand::feet;
          options.longest_lag = longest_lag;
          options.threads = threads;
          return PyIdentification{
              identify(robot, motion, options, name_of_angles(measured, "measured"), watched),
              robot, name_of_angles(command, "command"), name_of_angles(measured, "measured")};
        });
      },
      py::arg("robot"), py::arg("command"), py::arg("measured"), py::kw_only(),
      py::arg("loads") = py::none(), py::arg("measured_at") = "encoder",
      py::arg("per_type") = false, py::arg("stand") = "auto", py::arg("rate") = 0.0,
      py::arg("degrees") = false, py::arg("longest_lag") = 0.0, py::arg("threads") = 0,
      py::arg("progress") = py::none(),
      "The servo constants with which the simulated servos come nearest to what was measured. "
      "`command` and `measured` are files, or (dt, angles) with the time between two rows [s] and "
      "an array of angles [rad, m], shape (n, dof). `command` are angles of the encoders, as the "
      "robot received them. `measured_at` is 'encoder' if the encoders of the robot measured the "
      "angles, or 'joint' if instruments at the joints measured them; only such instruments show "
      "the offsets of the encoders. `loads` is a file of load cells. With `per_type`, all joints "
      "of one motor type get the same constants. `stand` is 'feet', 'fixed' (the root is held "
      "upright) or 'auto'. `rate` [1/s] and `degrees` apply to files that do not state their rate "
      "or their unit. A recording whose angles are later than `longest_lag` [s] is refused; 0 "
      "means "
      "30 ms or twice the lag of the slowest servo, whichever is larger.");
}

}  // namespace

void bind_recording(py::module_& m) {
  bind_import(m);
  bind_identify(m);
}

}  // namespace ayumi::python
