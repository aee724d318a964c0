// Motions of other programs and robots as patterns: HOAP sequences, tables of angles, Ayumi's own
// joint tables.

#include <filesystem>
#include <nlohmann/json.hpp>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/motion_formats.hpp"
#include "ayumi/io/import_pattern.hpp"
#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/io/table/table_note.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct ImportCommand {
  std::string file, robot, out;
  PatternImport how;
};

Json json_of(const FootContact& contact) {
  const Foothold& place = contact.place;
  return {{"foot", name_of(contact.foot)},
          {"begin_s", contact.begin},
          {"end_s", contact.end},
          {"position_m", {place.position.x(), place.position.y(), place.position.z()}},
          {"yaw_rad", place.rpy.z()}};
}

void print_import(const Context& context, const ImportCommand& options,
                  const ImportedPattern& imported) {
  const Pattern& pattern = imported.pattern;
  const bool keys = !pattern.table;
  const std::string from =
      imported.format + (imported.reason.empty() ? "" : ", because " + imported.reason) + ")";
  std::string words = options.out + ": " + text::fixed(pattern.duration(), 3) + " s" +
                      (keys ? ", " + text::counted(pattern.keyframes.size(), "keyframe") + " and " +
                                  text::counted(pattern.phases.size(), "phase") + " (" + from
                            : " from " + text::counted(imported.rows, "row") + " (" + from + ", " +
                                  text::counted(imported.contacts.size(), "contact") + ", " +
                                  text::counted(pattern.phases.size(), "phase")) +
                      "\n";
  for (const std::string& line : imported.filled) words += "  " + line + "\n";
  context.print(words);
  Json contacts = Json::array();
  for (const FootContact& contact : imported.contacts) contacts.push_back(json_of(contact));
  context.print_json(Json{
      {"output", options.out},
      {"table", keys ? Json(nullptr) : Json(table_beside(options.out).string())},
      {"sequence", imported.sequence.empty()
                       ? Json(nullptr)
                       : Json(copy_beside(options.out, imported.format).string())},
      {"format", imported.format},
      {"format_reason", imported.reason.empty() ? Json(nullptr) : Json(imported.reason)},
      {"rows", imported.rows},
      {"duration_s", pattern.duration()},
      {"contacts", contacts},
      {"filled",
       imported.filled}}.dump(2));
}

// Not even --force lets the result replace the file that it comes from.
void refuse_own_input(const ImportCommand& options) {
  std::error_code ignored;
  for (const fs::path& path : files_of_import(options.out))
    if (fs::equivalent(path, options.file, ignored))
      fail(ErrorCode::bad_file, {options.file},
           "the result would overwrite this file (" + path.string() +
               "). Choose another name with -o");
}

void import_motion(const Context& context, const ImportCommand& options) {
  refuse_own_input(options);
  for (const fs::path& path : files_of_import(options.out)) refuse_overwriting(context, path);
  const RobotModel model = load_robot(options.robot, robot_search(context));
  const std::string name = options.file == "-" ? "standard input" : options.file;
  ImportedPattern imported =
      import_pattern(read_input(options.file, kLargestMotionFile), name, model, options.how);
  if (options.file != "-") add_caution(imported.caution, read_table_note(options.file));
  for (const std::string& words : words_of(imported.caution)) imported.filled.push_back(words);
  imported.pattern.robot = robot_as_written(options.robot);
  write_imported(options.out, imported);
  print_import(context, options, imported);
}

}  // namespace

void add_import(Command& app, Context& context) {
  Command* command =
      app.add_subcommand("import", "read a motion of another program or robot as a pattern");
  command->footer(
      "Examples:\n  ayumi import walk.csv --robot hoap1 -o walk.json\n"
      "  ayumi import m03.csv --robot examples/hoap3/robot.json --robot-path hoap3_description "
      "-o m03.json\n"
      "  ayumi import angles.csv --robot hoap1 --unit deg --rate 200 -o angles.json\n"
      "  ayumi import dance.csv --robot g1.urdf --rate 30 --order -o dance.json");
  static ImportCommand options;
  static std::string unit = "rad", signs = "encoder", at;
  command->add_option("FILE", options.file, "Motion file; - is standard input.")->required();
  command
      ->add_option("--robot", options.robot,
                   "Name of a bundled robot, or a folder, sidecar or robot file (URDF, MJCF, SDF, "
                   "Choreonoid body, mi-lib ztk).")
      ->required()
      ->type_name("ROBOT");
  command
      ->add_option("-o,--out", options.out,
                   "Pattern file to write. The table of the pattern is written beside this file.")
      ->required()
      ->type_name("F");
  command
      ->add_option("--format", options.how.reading.format,
                   "Format of the file (default: recognized by its content).")
      ->check(one_of(read_format_names()));
  command->add_option("--unit", unit, "Unit of the angles if the file states no unit.")
      ->check(one_of({"rad", "deg"}))
      ->capture_default_str();
  command
      ->add_option("--rate", options.how.reading.rate,
                   "Rows per second of a file without times [1/s].")
      ->check(number_within(ImportOptions::kRate))
      ->type_name("HZ");
  command
      ->add_option("--signs", signs,
                   "Positive direction of the angles of the file. encoder: the direction in which "
                   "the encoder counts up. joint: the positive direction in the robot's file. This "
                   "option is for files in radians that have one column for each motor, in the "
                   "order of the motor numbers.")
      ->check(one_of({"encoder", "joint"}))
      ->capture_default_str();
  command->add_flag(
      "--order", options.how.reading.by_order,
      "Take the columns as the joints of the robot, in the order of the robot's file.");
  command
      ->add_option("--joints", options.how.reading.joints,
                   "Names of the joint columns, in the order of the file.")
      ->delimiter(',')
      ->type_name("A,B,...");
  command
      ->add_option(
          "--motion", options.how.reading.motion,
          "Name or number of the motion, if the file has several motions (default: the first).")
      ->type_name("NAME");
  command->add_flag(
      "--ground", options.how.ground,
      "Move the robot up and down so that the soles that carry it are on the ground.");
  command
      ->add_option("--ramp", options.how.ramp,
                   "For a recording that begins or ends while the robot moves: time in which the "
                   "motion speeds up from rest, or slows down to rest [s].")
      ->check(number_within(PatternImport::kRamp))
      ->type_name("S");
  command
      ->add_option("--contact-height", options.how.contact.height,
                   "A sole that is more than this height above the lowest sole does not carry the "
                   "robot [m].")
      ->check(number_within(ContactThresholds::kHeight))
      ->capture_default_str();
  command
      ->add_option("--contact-speed", options.how.contact.speed,
                   "A sole that moves faster than this does not carry the robot [m/s].")
      ->check(number_within(ContactThresholds::kSpeed))
      ->capture_default_str();
  command
      ->add_option("--contact-load", options.how.contact.load,
                   "If the vertical ground force is less than this, Ayumi takes the robot to be in "
                   "the air: no sole carries it [multiple of the weight].")
      ->check(number_within(ContactThresholds::kLoad))
      ->capture_default_str();
  command->add_flag("--commands", options.how.reading.commands,
                    "The angles of the file are servo targets, such as export --servo lead writes. "
                    "Servo targets are ahead of the posture by a time, the lead. Ayumi removes the "
                    "lead to get the joint angles. For reference tables (reference.csv of a run, "
                    "and the csv and json tables of export), Ayumi always does this.");
  command
      ->add_option("--measured-at", at,
                   "What the angles are. encoder: angles as the encoders count them, measured or "
                   "commanded. Ayumi adds to them the offsets that ROBOT states. joint: joint "
                   "angles. Default: encoder if --commands is given, or if the file has a format "
                   "that a robot plays or records, such as a HOAP sequence; otherwise joint. For a "
                   "table that Ayumi wrote, the offsets in the head of the table are used.")
      ->check(one_of({"encoder", "joint"}));
  command
      ->add_option("--smooth", options.how.reading.smooth,
                   "Largest change of an angle by smoothing [deg] (default: 0.1 for HOAP counts, 0 "
                   "for angle tables).")
      ->check(number_within(ImportOptions::kSmooth))
      ->type_name("DEG");
  command->callback([&context] {
    options.how.reading.degrees = unit == "deg";
    options.how.reading.encoder_signs = signs == "encoder";
    if (!at.empty()) options.how.reading.measured_at = measured_at(at);
    import_motion(context, options);
  });
}

}  // namespace ayumi::app
