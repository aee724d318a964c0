// Determines servo constants of a robot from a recording, and writes them as a sidecar that has the
// robot as its base.

#include "ayumi/identify/identify.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/identified_sidecar.hpp"
#include "ayumi/io/table/recording.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kIdentifiedDegree = M_PI / 180;

struct IdentifyCommand {
  std::string robot, command, measured, loads, out, per = "joint", stand = "auto", at = "encoder";
  RecordingOptions reading;
  double longest_lag_ms = 0;
};

// An estimate in words, such as "3.61 (3.52..3.70) ms".
std::string estimate_words(const ServoEstimate& e, double unit, int digits,
                           const std::string& name) {
  const auto number = [&](double x) {
    return std::isfinite(x) ? text::fixed(x / unit, digits) : std::string("inf");
  };
  return number(e.value) + " (" + number(e.lower) + ".." + number(e.upper) + ") " + name;
}

std::string joint_words(const IdentifiedJoint& j) {
  std::string words = "  " + j.joint + ": ";
  if (!j.moved)
    return words +
           "the command does not move this joint. The measured angle minus the command is " +
           text::fixed(j.offset.value / kIdentifiedDegree, 3) + " deg\n";
  words += j.delay_is_lag ? "lag (delay and damping) " + estimate_words(j.lag, 1e-3, 2, "ms")
                          : "delay " + estimate_words(j.delay, 1e-3, 2, "ms");
  if (j.kp.known)
    words += ", kp " + estimate_words(j.kp, 1, 0, "N m/rad");
  else if (j.kp.lower > 0)
    words += ", kp above " + text::brief(j.kp.lower, 3) + " N m/rad";
  if (j.damping.known)
    words += ", kd + viscous friction " + estimate_words(j.damping, 1, 2, "N m s/rad");
  if (j.coulomb.known) words += ", Coulomb friction " + estimate_words(j.coulomb, 1, 3, "N m");
  if (j.backlash.value > 0)
    words += ", backlash " + estimate_words(j.backlash, kIdentifiedDegree, 3, "deg");
  words += ", offset from the command " + estimate_words(j.offset, kIdentifiedDegree, 3, "deg");
  if (j.has_sag)
    words += ", sag " + text::fixed(j.sag / kIdentifiedDegree, 3) + " deg between swing and stance";
  words += ". The model differs from the recording by " +
           text::fixed(j.mean_error / kIdentifiedDegree, 3) + " deg on average and by at most " +
           text::fixed(j.largest_error / kIdentifiedDegree, 3) + " deg at " +
           text::fixed(j.largest_at, 3) + " s\n";
  for (const std::string& line : j.confounded) words += "    " + line + "\n";
  return words;
}

Json json_of(const ServoEstimate& e) {
  return {{"value", e.value},
          {"lower", e.lower},
          {"upper", std::isfinite(e.upper) ? Json(e.upper) : Json(nullptr)},
          {"known", e.known}};
}

Json json_of(const IdentifiedJoint& j) {
  Json json = {{"joint", j.joint}, {"type", j.type}, {"moved", j.moved}};
  json["offset_rad"] = json_of(j.offset);
  json["command_error_mean_rad"] = j.command_error;
  if (!j.moved) return json;
  json["delay_s"] = json_of(j.delay);
  json["delay_is_lag"] = j.delay_is_lag;
  json["lag_s"] = j.lag.value;
  json["lag_interval_s"] = {j.lag.lower, j.lag.upper};
  json["kp"] = json_of(j.kp);
  json["kd_and_viscous"] = json_of(j.damping);
  json["viscous"] = json_of(j.viscous);
  json["coulomb"] = json_of(j.coulomb);
  json["backlash_rad"] = json_of(j.backlash);
  json["sag_rad"] = j.has_sag ? Json(j.sag) : Json(nullptr);
  json["error_mean_rad"] = j.mean_error;
  json["error_max_rad"] = j.largest_error;
  json["error_max_at_s"] = j.largest_at;
  json["confounded"] = j.confounded;
  return json;
}

// The robot in the form in which a sidecar in the folder of `out` names it: bundled names stay as
// they are.
std::string base_name(const IdentifyCommand& options) {
  std::error_code ignored;
  if (!fs::exists(options.robot, ignored)) return options.robot;
  const fs::path folder = fs::absolute(options.out).parent_path();
  const fs::path base = fs::relative(fs::absolute(options.robot), folder, ignored);
  return base.empty() ? fs::absolute(options.robot).string() : base.generic_string();
}

std::string sidecar_text(const RobotModel& model, const IdentifyCommand& options,
                         const Identification& found) {
  return identified_sidecar(model, found,
                            {.base = base_name(options),
                             .name = fs::path(options.out).stem().string(),
                             .command = fs::path(options.command).filename().string(),
                             .measured = fs::path(options.measured).filename().string()});
}

void identify_servos(const Context& context, const IdentifyCommand& options) {
  if (!options.out.empty()) refuse_overwriting(context, options.out);
  const RobotModel model = load_robot(options.robot, robot_search(context));
  RecordedMotion motion;
  motion.command =
      read_angles(read_input(options.command), options.command, model, options.reading);
  // Rows without time have the times of the rows of the command.
  RecordingOptions measured = options.reading;
  if (measured.rate <= 0) measured.rate = 1 / motion.command.dt;
  measured.measured_at = measured_at(options.at);
  motion.measured = read_angles(read_input(options.measured), options.measured, model, measured);
  if (!options.loads.empty())
    motion.sensors = read_sensors_table(read_input(options.loads), options.loads, model, measured);
  IdentifyOptions how;
  how.per_type = options.per == "type";
  how.stand = options.stand == "fixed" || (options.stand == "auto" && !model.has_soles())
                  ? RobotStand::fixed
                  : RobotStand::feet;
  if (how.stand == RobotStand::feet && !model.has_soles())
    fail(ErrorCode::bad_model,
         options.robot +
             ": the robot has no soles. Add \"soles\" to the sidecar, or use --stand "
             "fixed");
  how.longest_lag = 0.001 * options.longest_lag_ms;
  how.loads_place = options.loads;
  how.threads = context.threads;
  const Identification found = identify(model, motion, how, options.measured, context.progress());
  std::string words = options.measured + ": " + text::fixed(found.seconds, 3) + " s, " +
                      std::to_string(found.joints.size()) +
                      " joints. Each value is followed by its 95 % interval\n";
  if (!found.caution.empty()) words += "  " + found.caution + "\n";
  Json joints = Json::array();
  bool advice = false;
  for (const IdentifiedJoint& joint : found.joints) {
    words += joint_words(joint);
    joints.push_back(json_of(joint));
    advice = advice || !joint.confounded.empty();
  }
  if (advice)
    words +=
        "  to distinguish these constants, record the motions that `ayumi new excite --robot " +
        options.robot + " -o excite.json` writes\n";
  if (!options.out.empty()) {
    write_file(options.out, sidecar_text(model, options, found));
    words += options.out + ": written\n";
    if (std::any_of(found.joints.begin(), found.joints.end(),
                    [](const IdentifiedJoint& joint) { return joint.delay_is_lag; }))
      words +=
          "  if the delay and the damping of a joint cannot be distinguished, the whole lag is "
          "written as damping: kd = kp times lag\n";
  }
  context.print(words);
  context.print_json(Json{
      {"output", options.out.empty() ? Json(nullptr) : Json(options.out)},
      {"seconds", found.seconds},
      {"caution", found.caution.empty() ? Json(nullptr) : Json(found.caution)},
      {"stand", how.stand == RobotStand::feet ? "feet" : "fixed"},
      {"joints", joints}}.dump(2));
}

}  // namespace

void add_identify(Command& app, Context& context) {
  Command* command =
      app.add_subcommand("identify", "find the servo constants of a robot from a recording");
  command->footer(
      "Examples:\n  ayumi identify hoap1 --command sent.csv --measured encoders.csv -o mine.json\n"
      "  ayumi identify hoap1 --command sent.csv --measured encoders.csv --loads sensors.csv "
      "--per type --json");
  static IdentifyCommand options;
  static std::string unit = "rad";
  command
      ->add_option("ROBOT", options.robot,
                   "Name of a bundled robot, or a folder, sidecar or robot file (URDF, MJCF, SDF, "
                   "Choreonoid body, mi-lib ztk).")
      ->required();
  command
      ->add_option(
          "--command", options.command,
          "Command that the robot received: a HOAP sequence, other rows of counts, or a table with "
          "joint columns.")
      ->required()
      ->type_name("F");
  command
      ->add_option(
          "--measured", options.measured,
          "Angles that the encoders measured: rows of counts, or a table with joint columns.")
      ->required()
      ->type_name("F");
  command
      ->add_option("--loads", options.loads,
                   "Recording of the load cells of the feet: raw readings (the sidecar has the "
                   "calibration), or a table with the columns \"fz.left[N]\" and \"fz.right[N]\" "
                   "(forces in newtons).")
      ->type_name("F");
  command
      ->add_option(
          "-o,--out", options.out,
          "Sidecar to write. The new sidecar refers to ROBOT and adds the servo constants.")
      ->type_name("F");
  command
      ->add_option("--per", options.per,
                   "Find one set of constants for each joint, or for each motor type.")
      ->check(one_of({"joint", "type"}))
      ->capture_default_str();
  command
      ->add_option("--stand", options.stand,
                   "How the robot is held during the recording. feet: the robot stands on level "
                   "ground. fixed: a fixture holds the root upright. auto: feet if the robot has "
                   "soles, otherwise fixed (default: auto).")
      ->check(one_of({"auto", "feet", "fixed"}));
  command
      ->add_option("--measured-at", options.at,
                   "What measured the angles. encoder: the encoders of the servos. Ayumi adds to "
                   "their readings the offsets that ROBOT states. joint: instruments at the "
                   "joints. Only such instruments show the offsets of the encoders, so the new "
                   "sidecar has new offsets only with --measured-at joint.")
      ->check(one_of({"encoder", "joint"}))
      ->capture_default_str();
  command->add_option("--unit", unit, "Unit of the joint columns whose names do not state a unit.")
      ->check(one_of({"rad", "deg"}))
      ->capture_default_str();
  command
      ->add_option("--rate", options.reading.rate,
                   "Rows per second of files without a time column [1/s] (default: 1000 for the "
                   "command; for the measured angles, the rate of the command).")
      ->check(number_within(kRecordingRate))
      ->type_name("HZ");
  command
      ->add_option("--longest-lag", options.longest_lag_ms,
                   "Largest time by which a servo may be behind its command [ms]. If a servo is "
                   "further behind, Ayumi refuses the recording, because the recording and the "
                   "command probably do not begin at the same time. The default is the larger of "
                   "two times: 30 ms, and twice the lag of the slowest servo of ROBOT.")
      ->check(number_within(1000 * IdentifyOptions::kLongestLag.least,
                            1000 * IdentifyOptions::kLongestLag.most))
      ->type_name("MS");
  command->callback([&context] {
    options.reading.degrees = unit == "deg";
    identify_servos(context, options);
  });
}

}  // namespace ayumi::app
