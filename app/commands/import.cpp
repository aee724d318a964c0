// Motions of other origin as patterns: HOAP sequences, tables of angles, Ayumi's own joint tables.

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/motion_formats.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/io/table/motion_import.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Bytes of a motion file. Chosen: an hour of 50 joints at 30 rows per second; a file and its copy
/// stay within 200 MB.
constexpr size_t kMostBytes = 64'000'000;

struct ImportCommand {
  std::string file, robot, out;
  bool ground = false;        ///< --ground
  double ramp = 0;            ///< --ramp [s]; 0: none
  ContactThresholds contact;  ///< as given
  ImportOptions import;
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
                  const ImportedMotion& imported, const GroundedMotion& motion) {
  const double duration = motion.pattern.duration();
  std::string words = options.out + ": " + text::fixed(duration, 3) + " s from " +
                      text::counted(imported.rows, "row") + " (" + imported.format +
                      (imported.reason.empty() ? "" : ", because " + imported.reason) + "), " +
                      text::counted(motion.contacts.size(), "contact") + ", " +
                      text::counted(motion.pattern.phases.size(), "phase") + "\n";
  for (const std::string& line : imported.filled) words += "  " + line + "\n";
  context.print(words);
  Json contacts = Json::array();
  for (const FootContact& contact : motion.contacts) contacts.push_back(json_of(contact));
  context.print_json(Json{
      {"output", options.out},
      {"table", table_beside(options.out).string()},
      {"sequence",
       imported.sequence.empty() ? Json() : Json(sequence_beside(options.out).string())},
      {"format", imported.format},
      {"format_reason", imported.reason.empty() ? Json(nullptr) : Json(imported.reason)},
      {"rows", imported.rows},
      {"duration_s", duration},
      {"contacts", contacts},
      {"filled",
       imported.filled}}.dump(2));
}

void add_ramps(const ImportCommand& options, const RobotModel& model, ImportedMotion& imported) {
  const CutEnds cut = cut_ends(model, imported.motion);
  if (options.ramp <= 0) {
    imported.filled.insert(imported.filled.end(), cut.words.begin(), cut.words.end());
    return;
  }
  const std::string ends = cut.begin && cut.end ? "begins and ends" : cut.begin ? "begins" : "ends";
  if (!cut.begin && !cut.end) {
    imported.filled.push_back("--ramp is not used, because the motion begins and ends at rest");
    return;
  }
  if (!imported.motion.zmp.empty() || !imported.motion.fz.empty())
    imported.filled.push_back(
        "the ZMP and the vertical force of the file are left out, because a ramp changes them");
  imported.motion = with_ramps(model, std::move(imported.motion), options.ramp);
  imported.sequence.clear();  // its rows are no longer those of the motion
  imported.filled.push_back("the motion " + ends + " slowly (--ramp): it takes " +
                            text::brief(options.ramp) +
                            " s between rest and the recorded speed, along the recorded path");
}

/// A file of key poses: the pattern has keys, and no table.
void import_keys(const Context& context, const ImportCommand& options, ImportedKeys keys) {
  Pattern& pattern = keys.pattern;
  pattern.name = "imported from " + fs::path(options.file).filename().string();
  pattern.robot = robot_as_written(options.robot);
  pattern.file = "imported";
  if (options.ground || options.ramp > 0)
    keys.filled.push_back("--ground and --ramp are not used, because the file has key poses");
  write_pattern(options.out, pattern, keys.filled);
  std::string words = options.out + ": " + text::fixed(pattern.duration(), 3) + " s, " +
                      text::counted(pattern.keyframes.size(), "keyframe") + " and " +
                      text::counted(pattern.phases.size(), "phase") + " (" + keys.format +
                      (keys.reason.empty() ? "" : ", because " + keys.reason) + ")\n";
  for (const std::string& line : keys.filled) words += "  " + line + "\n";
  context.print(words);
  context.print_json(Json{
      {"output", options.out},
      {"table", nullptr},
      {"sequence", nullptr},
      {"format", keys.format},
      {"format_reason", keys.reason.empty() ? Json(nullptr) : Json(keys.reason)},
      {"rows", pattern.keyframes.size()},
      {"duration_s", pattern.duration()},
      {"contacts", Json::array()},
      {"filled",
       keys.filled}}.dump(2));
}

// Not even --force lets the result replace the file that it comes from.
void refuse_own_input(const ImportCommand& options) {
  std::error_code ignored;
  for (const fs::path& path :
       {fs::path(options.out), table_beside(options.out), sequence_beside(options.out)})
    if (fs::equivalent(path, options.file, ignored))
      fail(ErrorCode::bad_file, options.file + ": the result would overwrite this file (" +
                                    path.string() + "); choose another name with -o");
}

void import_motion(const Context& context, const ImportCommand& options) {
  refuse_own_input(options);
  refuse_overwriting(context, options.out);
  refuse_overwriting(context, table_beside(options.out));
  refuse_overwriting(context, sequence_beside(options.out));
  const RobotModel model = load_robot(options.robot, robot_search(context));
  const std::string name = options.file == "-" ? "standard input" : options.file;
  const std::string bytes = read_input(options.file, kMostBytes);
  if (bytes.find("\"ayumi.pattern/") != std::string::npos)
    fail(ErrorCode::bad_file,
         name + ": this is a pattern already; import reads motions in the formats " +
             text::join(read_format_names(), ", "));
  if (std::optional<ImportedKeys> keys = read_key_poses(bytes, name, model, options.import)) {
    import_keys(context, options, std::move(*keys));
    return;
  }
  ImportedMotion imported = read_motion(bytes, name, model, options.import);
  imported.motion.contact = options.contact;
  add_ramps(options, model, imported);
  if (options.ground) imported.motion = put_on_ground(model, std::move(imported.motion));
  GroundedMotion motion =
      grounded(model, imported.motion, table_beside(options.out).filename().string());
  imported.filled.insert(imported.filled.end(), motion.notes.begin(), motion.notes.end());
  motion.pattern.name = "imported from " + fs::path(name).filename().string();
  motion.pattern.robot = robot_as_written(options.robot);
  motion.pattern.file = "imported";  // relative names hold from the working folder
  if (!imported.sequence.empty()) {
    motion.pattern.table->interval_ms = static_cast<int>(std::lround(1000 * imported.motion.dt));
    imported.filled.push_back(
        "a copy of the sequence is kept in " + sequence_beside(options.out).filename().string() +
        "; as long as the motion is unchanged, `ayumi export` writes the rows of this copy");
  }
  write_pattern_and_table(options.out, motion.pattern, imported.filled, imported.caution,
                          imported.sequence);
  print_import(context, options, imported, motion);
}

}  // namespace

void add_import(CLI::App& app, Context& context) {
  CLI::App* command =
      app.add_subcommand("import", "read a motion of another program or robot as a pattern");
  command->footer(
      "Examples:\n  ayumi import walk.csv --robot hoap1 -o walk.json\n"
      "  ayumi import m03.csv --robot examples/hoap3/robot.json --robot-path hoap3_description "
      "-o m03.json\n"
      "  ayumi import angles.csv --robot hoap1 --unit deg --rate 200 -o angles.json\n"
      "  ayumi import dance.csv --robot g1.urdf --rate 30 --order -o dance.json");
  static ImportCommand options;
  static std::string unit = "rad", signs = "encoder";
  command->add_option("FILE", options.file, "Motion file; - is standard input.")->required();
  command->add_option("--robot", options.robot, "Name of a bundled robot, folder, sidecar or URDF.")
      ->required()
      ->type_name("ROBOT");
  command
      ->add_option("-o,--out", options.out,
                   "Pattern file to write; its table is written beside it.")
      ->required()
      ->type_name("F");
  command
      ->add_option("--format", options.import.format,
                   "Format of the file (default: recognized by its content).")
      ->check(one_of(read_format_names()));
  command->add_option("--unit", unit, "Unit of angles where the file does not state it.")
      ->check(one_of({"rad", "deg"}))
      ->capture_default_str();
  command
      ->add_option("--rate", options.import.rate, "Rows per second of a file without times [1/s].")
      ->check(number_within(1.0, 1e5))
      ->type_name("HZ");
  command
      ->add_option("--signs", signs,
                   "Signs of the angles in a file with radians in the order of the motor numbers: "
                   "as the robot's encoders count (encoder), or as the robot's file defines the "
                   "joints (joint).")
      ->check(one_of({"encoder", "joint"}))
      ->capture_default_str();
  command->add_flag("--order", options.import.by_order,
                    "The columns are the joints of the robot, in the order of the robot's file.");
  command
      ->add_option("--joints", options.import.joints,
                   "Names of the joint columns, in the order of the file.")
      ->delimiter(',')
      ->type_name("A,B,...");
  command
      ->add_option(
          "--motion", options.import.motion,
          "Name or number of the motion, if the file has several motions (default: the first).")
      ->type_name("NAME");
  command->add_flag(
      "--ground", options.ground,
      "Move the robot up and down so that the soles that carry it are on the ground.");
  command
      ->add_option("--ramp", options.ramp,
                   "For a recording that begins or ends while the robot moves: time in which the "
                   "motion speeds up from rest, or slows down to rest [s].")
      ->check(number_within(0.02, 10.0))
      ->type_name("S");
  command
      ->add_option(
          "--contact-height", options.contact.height,
          "A sole that is higher than this above the lowest sole does not carry the robot [m].")
      ->check(number_within(0.0, 0.2))
      ->capture_default_str();
  command
      ->add_option("--contact-speed", options.contact.speed,
                   "A sole that moves faster than this does not carry the robot [m/s].")
      ->check(number_within(0.0, 5.0))
      ->capture_default_str();
  command
      ->add_option(
          "--contact-load", options.contact.load,
          "Smallest vertical force with which soles carry the robot, as a multiple of its weight.")
      ->check(number_within(0.0, 2.0))
      ->capture_default_str();
  command->add_flag("--commands", options.import.commands,
                    "The angles are servo targets, as export writes them: subtract the lead of the "
                    "servos to get the joint angles. For reference tables this is always done.");
  command
      ->add_option("--smooth", options.import.smooth,
                   "Largest change of an angle by smoothing [deg] (default: 0.1 for HOAP counts, 0 "
                   "for angle tables).")
      ->check(number_within(0.0, 5.0))
      ->type_name("DEG");
  command->callback([&context] {
    options.import.degrees = unit == "deg";
    options.import.encoder_signs = signs == "encoder";
    import_motion(context, options);
  });
}

}  // namespace ayumi::app
