// Joint tables for a robot or another program: the reference of a run, or of a pattern replayed
// open loop, with ramp and hold around it. Unsafe tables are refused.

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/table_safety.hpp"
#include "ayumi/control/laws/dtad.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/table/table.hpp"
#include "ayumi/render/gltf.hpp"
#include "ayumi/sim/simulate.hpp"
#include "commands.hpp"
#include "log_export.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "run_robot.hpp"
#include "simulation.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  std::string input, format, output, robot, log;
  std::vector<std::string> set;
  SafetyOptions safety;
  bool pushed = false, force_unsafe = false;
};

struct Source {
  RobotModel model;
  ReferenceTrajectory reference;
  std::string disturbances;        ///< of the run that the table is from; empty: none
  Eigen::MatrixXd torque;          ///< of a run's motors, rows x dof; empty where not known
  std::optional<Task> plan;        ///< of a pattern: the check knows what it needs
  std::vector<std::string> unfit;  ///< why no robot should receive the table
};

// What the servos receive when a pattern is replayed as it is.
ReferenceTrajectory open_loop_reference(const RobotModel& model, const ActuatorLimits& actuators,
                                        const CommandSeries& series) {
  const Eigen::VectorXd lead = velocity_lead(actuators);
  ReferenceTrajectory reference;
  reference.dt = series.dt;
  reference.joints = model.dof_names();
  for (const CommandSample& sample : series.samples) {
    ReferenceRow row;
    row.theta = sample.state.theta + lead.cwiseProduct(sample.state.dtheta);
    row.base = sample.state.base;
    row.cog = sample.cog;
    row.zmp = sample.zmp;
    row.fz = sample.fz;
    row.contact = {supports(sample.support, Side::left), supports(sample.support, Side::right)};
    reference.rows.push_back(std::move(row));
  }
  return reference;
}

bool draws(const ExportOptions& options) { return options.format == "gltf"; }

/// The robot asked for, else `recorded`; with meshes where they are drawn.
RobotModel robot_named(const ExportOptions& options, const std::string& recorded,
                       const Context& context) {
  return robot_of_run(context, options.robot, recorded, {.meshes = draws(options)});
}

Source source_of_pattern(const ExportOptions& options, const Context& context) {
  Task input =
      load_pattern(context, options.input,
                   {.set = options.set, .profile = {}, .robot = options.robot}, draws(options));
  if (!input.series.viip.empty())
    fail(ErrorCode::bad_pattern,
         options.input +
             ": phases: the pattern has VIIP goals, so its joint angles are "
             "known only after a simulation; run it (ayumi run), then export the RUN");
  Source source{input.robot,
                open_loop_reference(input.robot, input.robot.limits(input.profile), input.series),
                input.caution.disturbances,
                {},
                {},
                {}};
  source.reference.provenance = provenance(input, "none", context.command_line);
  if (!options.robot.empty()) source.reference.provenance.robot = options.robot;
  if (!input.caution.unfit.empty()) source.unfit.push_back(input.caution.unfit);
  if (!draws(options) && input.robot.has_soles()) {
    const std::string reason = judge(input, check_options(input)).reason();
    if (!reason.empty()) source.unfit.push_back(reason);
  }
  source.plan = std::move(input);
  return source;
}

Source source_of_table(const ExportOptions& options, const Context& context,
                       ReferenceTrajectory reference, const TableCaution& caution) {
  const Provenance& made = reference.provenance;
  Source source{robot_named(options, made.robot, context),
                std::move(reference),
                caution.disturbances,
                {},
                {},
                {}};
  require_joints(source.reference, source.model.dof_names(), options.input);
  if (!made.robot_sha256.empty() && made.robot_sha256 != source.model.description().sha256)
    fail(ErrorCode::bad_file, options.input + ": robot '" + source.model.name() +
                                  "' has changed since this table was made; run the pattern again");
  if (!caution.unfit.empty()) source.unfit.push_back(caution.unfit);
  return source;
}

struct CautiousTable {
  ReferenceTrajectory reference;
  TableCaution caution;
};

// The table of a run that is asked for; `log` is the one that it is from.
CautiousTable table_of_run(const ExportOptions& options, const RunFolder& run,
                           const SimulationLog& log, const RobotModel& model) {
  if (!options.log.empty()) return {extract_reference(model, log), caution_of(log)};
  const bool disturbed = !log.scenario.empty();
  if (options.pushed && !(run.light ? disturbed : run.pushed.has_value()))
    fail(ErrorCode::usage,
         options.input + ": --pushed: the run has no disturbances; leave --pushed out");
  if (run.light)
    return {extract_reference(model, log), disturbed ? run.pushed_caution : run.reference_caution};
  if (!options.pushed && run.reference) return {*run.reference, run.reference_caution};
  if (run.pushed) return {*run.pushed, run.pushed_caution};
  return {extract_reference(model, log), caution_of(log)};
}

std::string log_of_table(const ExportOptions& options, const RunFolder& run) {
  if (!options.log.empty()) return options.log;
  return !options.pushed && run.logs.contains("undisturbed") ? "undisturbed" : "";
}

// Every file of the folder is first compared with what run.json says of it.
Source source_of_run(const ExportOptions& options, const Context& context) {
  verify_run(options.input);
  const RunFolder run = read_run(options.input);
  const SimulationLog log = read_run_log(options.input, log_of_table(options, run));
  const RobotModel model = robot_of_run(context, options.robot, log.provenance.robot);
  const CautiousTable table = table_of_run(options, run, log, model);
  Source source = source_of_table(options, context, table.reference, table.caution);
  if (log.samples.size() == source.reference.rows.size()) source.torque = torques_of(log);
  source.unfit = run.unfit;
  // What the run says of itself, and what is known of an open loop that is asked for.
  const std::string& own = table.caution.unfit;
  if (!own.empty() && text::join(run.unfit, "; ").find(own) == std::string::npos)
    source.unfit.push_back(own);
  return source;
}

// A CSV, or JSON that says so at its head.
bool is_reference_table(const std::string& path) {
  return path.ends_with(".csv") || (path != "-" && read_file(path).substr(0, 200).find(
                                                       "\"ayumi.reference/") != std::string::npos);
}

// A table of a run folder is part of that run: what holds of the folder holds of it.
void verify_run_of(const fs::path& table) {
  const fs::path folder = table.has_parent_path() ? table.parent_path() : fs::path(".");
  if (!is_run_folder(folder)) return;
  const std::vector<std::string> names = run_file_names(folder);
  if (std::find(names.begin(), names.end(), table.filename().string()) != names.end())
    verify_run(folder);
}

Source source_of(const ExportOptions& options, const Context& context) {
  if (fs::is_directory(options.input)) return source_of_run(options, context);
  refuse_log_file(options.input);
  if (!is_reference_table(options.input)) return source_of_pattern(options, context);
  verify_run_of(options.input);
  return source_of_table(options, context, read_reference(options.input),
                         read_table_caution(options.input));
}

constexpr double kGltfRate = 60;  // keys of an animation [Hz]; viewers draw evenly between them

/// The table as an animation of the robot: to be looked at, so neither ramped nor judged.
void export_gltf(const ExportOptions& options, Context& context) {
  if (fs::path(options.output).extension() != ".glb")
    fail(ErrorCode::usage, options.output + ": --format gltf writes a .glb");
  const Source source = source_of(options, context);
  const Motion motion = motion_of(source.reference, kGltfRate);
  const std::string bytes = glb_bytes(source.model, {motion});
  write_file(options.output, bytes);
  context.print(options.output + ": " + std::to_string(motion.times.size()) + " postures in " +
                text::brief(motion.times.back()) + " s, " +
                std::to_string(source.reference.joints.size()) + " joints (gltf)\n");
  const nlohmann::ordered_json json = {
      {"format", options.format},          {"output", options.output},
      {"rows", motion.times.size()},       {"rate_hz", kGltfRate},
      {"joints", source.reference.joints}, {"bytes", bytes.size()}};
  context.print_json(json.dump(2));
}

std::string bytes_of(const std::string& format, const Source& source,
                     const ReferenceTrajectory& table, const TableCaution& caution,
                     const SafetyOptions& safety) {
  if (format == "hoap") return hoap_csv(source.model, table, safety);
  return format == "json" ? reference_json(table, caution) : reference_csv(table, caution);
}

bool knows_torque(const Source& source) { return source.plan || source.torque.size() > 0; }

std::vector<SafetyViolation> torque_violations_of(const Source& source, const SafeTable& safe,
                                                  const std::string& profile) {
  const double begin = static_cast<double>(safe.first) * safe.table.dt;
  if (!source.plan)
    return torque_violations(source.model, source.torque, safe.table.dt, begin, profile);
  CheckOptions check = check_options(*source.plan);
  check.profile = profile;
  std::vector<SafetyViolation> found;
  for (const Finding& f : check_consistency(source.model, source.plan->series, check).findings)
    if (f.kind == FindingKind::joint_torque && f.severity == Severity::error)
      found.push_back({"torque", f.where, begin + f.at, std::abs(f.worst), std::abs(f.limit),
                       f.unit,
                       static_cast<int>(std::lround((f.end - f.begin) / safe.table.dt)) + 1});
  return found;
}

/// Ramp, hold and judgement, by the torque too where a robot is to receive the table.
SafeTable judged(const ExportOptions& options, const Source& source, const std::string& profile) {
  SafetyOptions safety = options.safety;
  safety.profile = profile;
  SafeTable safe = make_safe(source.model, source.reference, safety);
  if (options.format == "hoap" && knows_torque(source))
    add_violations(safe, torque_violations_of(source, safe, profile));
  return safe;
}

/// Profiles of the robot whose motors would carry out an unsafe table, the motor board's own cap of
/// counts per tick apart.
std::vector<std::string> sufficient_profiles(ExportOptions options, const Source& source) {
  const std::string profile = options.safety.profile;
  options.safety.counts_per_ms = 1e9;
  std::vector<std::string> names;
  for (const std::string& name : source.model.profile_names())
    if (name != profile && judged(options, source, name).report.safe) names.push_back(name);
  return names;
}

/// Why the table is not written, the reasons of its run or pattern first; empty: it is.
std::vector<std::string> refusals(const ExportOptions& options, const Source& source,
                                  const SafeTable& safe) {
  std::vector<std::string> reasons;
  const std::string& disturbances = source.disturbances;
  if (!options.force_unsafe) reasons = source.unfit;
  if (!disturbances.empty() && !options.pushed)
    reasons.push_back("the table is from a run with disturbances (" + disturbances +
                      ") and contains the reactions to them; --pushed exports it nevertheless");
  if (!safe.report.safe && !options.force_unsafe) reasons.emplace_back("the table is unsafe");
  return reasons;
}

std::string in_words(const ExportOptions& options, const Source& source, const SafeTable& safe,
                     const std::vector<std::string>& refused) {
  const SafetyReport& report = safe.report;
  std::string text;
  if (refused.empty())
    text = options.output + ": " + std::to_string(safe.table.rows.size()) + " rows at " +
           text::brief(1 / safe.table.dt) + " Hz, " + std::to_string(safe.table.joints.size()) +
           " joints (" + options.format + ")\n";
  else
    text = options.output + ": not written, because " + text::join(refused, "\n  and ") + "\n";
  if (refused.empty())
    for (const std::string& reason : source.unfit) text += "  written although " + reason + "\n";
  text += "  ramp " + text::brief(report.ramp) + " s, hold " + text::brief(report.hold) + " s";
  if (!report.worst_joint.empty())
    text += "; largest step " + text::fixed(100 * report.max_step_ratio, 1) + " % of the limit (" +
            report.worst_joint + " at " + text::fixed(report.worst_at, 3) + " s)";
  if (!report.margin_joint.empty())
    text += "; " + text::brief(report.min_limit_margin * 180 / EIGEN_PI, 3) +
            " deg from the nearest position limit (" + report.margin_joint + ")";
  text += "\n";
  for (const SafetyViolation& violation : report.violations)
    text += "  unsafe: " + text_of(violation) + "\n";
  if (!options.force_unsafe && (!source.unfit.empty() || !report.safe))
    text += "  --force-unsafe writes the table nevertheless\n";
  return text;
}

/// What the head of the written table has to say.
TableCaution caution_of_written(const Source& source, const SafeTable& safe) {
  std::vector<std::string> words = source.unfit;
  for (const SafetyViolation& violation : safe.report.violations)
    words.push_back("unsafe: " + text_of(violation));
  return {source.disturbances, text::join(words, "; ")};
}

/// A HOAP sequence has no head that the robot's program would skip: what has to be said stands in a
/// file beside it.
std::string note_beside(const std::string& sequence) { return sequence + ".txt"; }

constexpr const char* kNoteHead = "About the joint table beside this file, by ayumi export\n";

std::string note_text(const TableCaution& caution) {
  std::string text = kNoteHead;
  if (!caution.disturbances.empty()) text += "disturbances: " + caution.disturbances + "\n";
  if (!caution.unfit.empty()) text += "unfit: " + caution.unfit + "\n";
  return text;
}

void write_table(const ExportOptions& options, const Context& context, const Source& source,
                 const SafeTable& safe) {
  const TableCaution caution = caution_of_written(source, safe);
  const bool nothing = caution.disturbances.empty() && caution.unfit.empty();
  const std::string note = note_beside(options.output);
  const bool old_note = fs::is_regular_file(note) && read_file(note).starts_with(kNoteHead);
  const bool beside = options.format == "hoap" && !nothing;
  if (beside) refuse_overwriting(context, note);
  write_file(options.output, bytes_of(options.format, source, safe.table, caution, options.safety));
  if (old_note && !beside) fs::remove(note);  // it was about the table that was there before
  if (!beside) return;
  write_file(note, note_text(caution));
  context.print(note + ": what to know before a robot receives it\n");
}

std::string as_json(const ExportOptions& options, const SafeTable& safe,
                    const std::vector<std::string>& sufficient,
                    const std::vector<std::string>& refused) {
  const nlohmann::ordered_json json = {
      {"format", options.format},
      {"output", refused.empty() ? nlohmann::ordered_json(options.output) : nullptr},
      {"refused", refused},
      {"rows", safe.table.rows.size()},
      {"first_row", safe.first},
      {"rate_hz", 1 / safe.table.dt},
      {"joints", safe.table.joints},
      {"profile", options.safety.profile},
      {"sufficient_profiles", sufficient},
      {"safety", nlohmann::ordered_json::parse(safety_json(safe.report))}};
  return json.dump(2);
}

void export_table(ExportOptions options, Context& context) {
  refuse_overwriting(context, options.output);
  if (options.format == "gltf") return export_gltf(options, context);
  const Source source = source_of(options, context);
  // What goes to the robot is judged by its own actuators, not by those a study has assumed.
  if (options.safety.profile.empty())
    options.safety.profile =
        options.format == "hoap" ? source.model.limits().name : source.reference.provenance.profile;
  const SafeTable safe = judged(options, source, options.safety.profile);
  std::vector<std::string> others;
  if (!safe.report.safe) others = sufficient_profiles(options, source);
  const std::vector<std::string> refused = refusals(options, source, safe);
  if (refused.empty()) write_table(options, context, source, safe);
  context.print(in_words(options, source, safe, refused));
  if (!safe.report.safe)
    context.print("  judged by profile " + options.safety.profile + "; " +
                  (others.empty()
                       ? "no other profile has motors that are strong enough"
                       : "the motors of " + text::join(others, ", ") + " are strong enough") +
                  "\n");
  if (options.format == "hoap" && !knows_torque(source))
    context.print(
        "  torque not checked, because a table has no torques; export the RUN to check them\n");
  context.print_json(as_json(options, safe, others, refused));
  context.exit_code = refused.empty() ? 0 : 1;
}

}  // namespace

void add_export(CLI::App& app, Context& context) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command =
      app.add_subcommand("export", "write a joint table of a run or pattern for the robot");
  command->add_option("input", options->input, "Run folder, pattern or reference table.")
      ->required()
      ->type_name("RUN_OR_PATTERN");
  std::vector<std::string> formats = {"csv", "json", "hoap", "gltf"};
  formats.insert(formats.end(), log_formats().begin(), log_formats().end());
  command
      ->add_option(
          "--format", options->format,
          "Format of the file. A joint table: csv, json, hoap or gltf. The log of a run: " +
              text::join(log_formats(), ", ") + ".")
      ->required()
      ->check(CLI::IsMember(formats));
  command->add_option("-o,--out", options->output, "File to write.")->required()->type_name("FILE");
  command
      ->add_option("--ramp", options->safety.ramp, "Shortest approach ramp before the motion [s].")
      ->check(number_within(0.0, 60.0))
      ->capture_default_str();
  command->add_option("--hold", options->safety.hold, "How long the last posture is held [s].")
      ->check(number_within(0.0, 60.0))
      ->capture_default_str();
  command
      ->add_option(
          "--from", options->safety.from,
          "Posture of the robot before the ramp, or 'first' for the first posture of the motion.")
      ->capture_default_str();
  command->add_option("--profile", options->safety.profile,
                      "Actuator profile that the table is judged by (default: for hoap the robot's "
                      "first, else that of the pattern or run).");
  command->add_option("--log", options->log, "Log of the run, for example open_loop.");
  command->add_option("--robot", options->robot,
                      "Robot to use in place of the one that the run names.");
  command->add_option("--set", options->set, "Set a parameter that the pattern declares.")
      ->type_name("NAME=NUMBER")
      ->allow_extra_args(false);
  command->add_flag("--pushed", options->pushed,
                    "Export the table of the run with its disturbances. The table says so.");
  command->add_flag("--force-unsafe", options->force_unsafe,
                    "Write the table although it is unsafe. The table says so.");
  command->footer(
      "Examples:\n"
      "  ayumi export out/ --format hoap -o walk_hoap.csv\n"
      "  ayumi export out/ --format csv --pushed -o pushed.csv\n"
      "  ayumi export out/ --format gltf -o walk.glb\n"
      "  ayumi export out/ --format npz --log open_loop -o fall.npz\n"
      "  ayumi export patterns/hoap1_walk.json --format json --ramp 3 -o walk_table.json");
  command->callback([options, command, &context] {
    if (is_log_format(options->format))
      export_log({options->input, options->format, options->output, options->log, options->robot},
                 *command, context);
    else
      export_table(*options, context);
  });
}

}  // namespace ayumi::app
