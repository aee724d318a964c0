// Joint tables for a robot or another program: the reference of a run, or of a pattern replayed
// open loop, with ramp and hold around it. Unsafe tables are refused.

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/check/table_safety.hpp"
#include "ayumi/control/laws/dtad.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/table/table.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/render/gltf.hpp"
#include "ayumi/sim/simulate.hpp"
#include "commands.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "run_robot.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  std::string input, format, output, robot, log;
  std::vector<std::string> set;
  SafetyOptions safety;
  bool force_unsafe = false;
};

struct Source {
  RobotModel model;
  ReferenceTrajectory reference;
  Eigen::MatrixXd torque;             ///< of a run's motors, rows x dof; empty where not known
  std::optional<CommandSeries> plan;  ///< of a pattern: the check knows what it needs
};

// What the servos receive when a pattern is replayed as it is.
ReferenceTrajectory open_loop_reference(const RobotModel& model, const CommandSeries& series) {
  const Eigen::VectorXd lead = servo_lead(model);
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

/// The robot asked for, else `recorded`; with meshes where they are drawn.
RobotModel robot_named(const ExportOptions& options, const std::string& recorded,
                       const Context& context) {
  return robot_of_run(context, options.robot, recorded, {.meshes = options.format == "gltf"});
}

Source source_of_pattern(const ExportOptions& options, const Context& context) {
  const Pattern pattern = read_given_pattern(options.input, read_pairs(options.set, "--set"));
  Source source{load_robot(options.robot.empty() ? robot_of(pattern) : options.robot,
                           robot_search(context), {.meshes = options.format == "gltf"}),
                {},
                {},
                {}};
  check_against_robot(pattern, source.model);
  const CommandSeries series = sample(source.model, pattern, {}, context.progress());
  if (!series.viip.empty())
    fail(ErrorCode::bad_pattern, options.input +
                                     ": phases: the pattern has VIIP goals, which it holds still "
                                     "for: run it (ayumi run), then export the RUN");
  source.reference = open_loop_reference(source.model, series);
  source.reference.provenance = {
      source.model.name(), source.model.description().sha256,         pattern.name,
      pattern.sha256,      source.model.limits(pattern.profile).name, "none",
      context.command_line};
  source.plan = series;
  return source;
}

Source source_of_table(const ExportOptions& options, const Context& context,
                       ReferenceTrajectory reference) {
  const Provenance& made = reference.provenance;
  Source source{robot_named(options, made.robot, context), std::move(reference), {}, {}};
  require_joints(source.reference, source.model.dof_names(), options.input);
  if (!made.robot_sha256.empty() && made.robot_sha256 != source.model.description().sha256)
    fail(ErrorCode::bad_file, options.input + ": robot '" + source.model.name() +
                                  "' has changed since this was made; run the pattern again");
  return source;
}

ReferenceTrajectory reference_of_run(const ExportOptions& options, const Context& context) {
  if (options.log.empty() && fs::exists(fs::path(options.input) / "reference.csv"))
    return read_reference(fs::path(options.input) / "reference.csv");
  const SimulationLog log = read_run_log(options.input, options.log);
  const RobotModel model = robot_of_run(context, options.robot, log.provenance.robot);
  return extract_reference(model, log);
}

// A CSV, or JSON that says so at its head.
bool is_reference_table(const std::string& path) {
  return path.ends_with(".csv") ||
         read_file(path).substr(0, 200).find("\"ayumi.reference/") != std::string::npos;
}

// What the motors gave in the run. A folder that holds tables alone knows of none.
Eigen::MatrixXd torque_of_run(const ExportOptions& options, const Source& source) {
  const SimulationLog log = read_run_log(options.input, options.log);
  if (log.samples.size() != source.reference.rows.size()) return {};
  Eigen::MatrixXd torque(static_cast<Eigen::Index>(log.samples.size()), source.model.dof_count());
  for (Eigen::Index k = 0; k < torque.rows(); ++k)
    torque.row(k) = log.samples[static_cast<size_t>(k)].torque.transpose();
  return torque;
}

Source source_of(const ExportOptions& options, const Context& context) {
  if (fs::is_directory(options.input)) {
    Source source = source_of_table(options, context, reference_of_run(options, context));
    if (options.format == "hoap") source.torque = torque_of_run(options, source);
    return source;
  }
  if (is_reference_table(options.input))
    return source_of_table(options, context, read_reference(options.input));
  return source_of_pattern(options, context);
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
                     const ReferenceTrajectory& table, const SafetyOptions& safety) {
  if (format == "hoap") return hoap_csv(source.model, table, safety);
  return format == "json" ? reference_json(table) : reference_csv(table);
}

bool knows_torque(const Source& source) { return source.plan || source.torque.size() > 0; }

std::vector<SafetyViolation> torque_violations_of(const Source& source, const SafeTable& safe,
                                                  const std::string& profile) {
  const double begin = static_cast<double>(safe.first) * safe.table.dt;
  if (!source.plan)
    return torque_violations(source.model, source.torque, safe.table.dt, begin, profile);
  CheckOptions check;
  check.profile = profile;
  std::vector<SafetyViolation> found;
  for (const Finding& f : check_consistency(source.model, *source.plan, check).findings)
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
  if (options.format != "hoap" || !knows_torque(source)) return safe;
  for (const SafetyViolation& found : torque_violations_of(source, safe, profile)) {
    safe.report.violations.push_back(found);
    safe.report.safe = false;
  }
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

std::string in_words(const ExportOptions& options, const SafeTable& safe, bool written) {
  const SafetyReport& report = safe.report;
  std::string text = written ? options.output + ": " + std::to_string(safe.table.rows.size()) +
                                   " rows at " + text::brief(1 / safe.table.dt) + " Hz, " +
                                   std::to_string(safe.table.joints.size()) + " joints (" +
                                   options.format + ")\n"
                             : options.output + ": not written, the table is unsafe\n";
  text += "  ramp " + text::brief(report.ramp) + " s, hold " + text::brief(report.hold) + " s";
  if (!report.worst_joint.empty())
    text += "; largest step " + text::fixed(100 * report.max_step_ratio, 1) + " % of the limit (" +
            report.worst_joint + " at " + text::fixed(report.worst_at, 3) + " s)";
  if (!report.margin_joint.empty())
    text += "; " + text::brief(report.min_limit_margin * 180 / EIGEN_PI, 3) +
            " deg inside the position limits (" + report.margin_joint + ")";
  text += "\n";
  for (const SafetyViolation& violation : report.violations)
    text += "  unsafe: " + text_of(violation) + "\n";
  if (!written) text += "  --force-unsafe writes it all the same\n";
  return text;
}

std::string as_json(const ExportOptions& options, const SafeTable& safe,
                    const std::vector<std::string>& sufficient, bool written) {
  const nlohmann::ordered_json json = {
      {"format", options.format},
      {"output", written ? nlohmann::ordered_json(options.output) : nullptr},
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
  if (fs::exists(options.output) && !fs::is_directory(options.output) && !context.force)
    fail(ErrorCode::usage, options.output + ": exists already; --force overwrites it");
  if (options.format == "gltf") return export_gltf(options, context);
  const Source source = source_of(options, context);
  // What goes to the robot is judged by its own actuators, not by those a study has assumed.
  if (options.safety.profile.empty())
    options.safety.profile =
        options.format == "hoap" ? source.model.limits().name : source.reference.provenance.profile;
  const SafeTable safe = judged(options, source, options.safety.profile);
  std::vector<std::string> others;
  if (!safe.report.safe) others = sufficient_profiles(options, source);
  const bool write = safe.report.safe || options.force_unsafe;
  if (write)
    write_file(options.output, bytes_of(options.format, source, safe.table, options.safety));
  context.print(in_words(options, safe, write));
  if (!safe.report.safe)
    context.print("  judged by profile " + options.safety.profile + "; " +
                  (others.empty() ? "the motors of no other profile would do"
                                  : "the motors of " + text::join(others, ", ") + " would do") +
                  "\n");
  if (options.format == "hoap" && !knows_torque(source))
    context.print("  torque not judged: a table alone does not tell it; export the RUN\n");
  context.print_json(as_json(options, safe, others, write));
  context.exit_code = write ? 0 : 1;
}

}  // namespace

void add_export(CLI::App& app, Context& context) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand("export", "joint tables of a run or pattern for replay");
  command->add_option("input", options->input, "a RUN folder, a pattern, or a reference table")
      ->required()
      ->type_name("RUN_OR_PATTERN");
  command->add_option("--format", options->format, "csv, json, hoap or gltf")
      ->required()
      ->check(CLI::IsMember({"csv", "json", "hoap", "gltf"}));
  command->add_option("-o,--out", options->output, "file to write")->required()->type_name("FILE");
  command->add_option("--ramp", options->safety.ramp, "approach ramp, at least this long [s]")
      ->check(number_within(0.0, 60.0))
      ->capture_default_str();
  command->add_option("--hold", options->safety.hold, "hold the end this long [s]")
      ->check(number_within(0.0, 60.0))
      ->capture_default_str();
  command
      ->add_option("--from", options->safety.from,
                   "posture the robot stands in before the ramp, or 'first'")
      ->capture_default_str();
  command->add_option("--profile", options->safety.profile, "actuator profile of the speed limits");
  command->add_option("--log", options->log, "which log of the RUN, e.g. open_loop");
  command->add_option("--robot", options->robot, "robot, where it is not the recorded one");
  command->add_option("--set", options->set, "parameter of the pattern")
      ->type_name("NAME=NUMBER")
      ->allow_extra_args(false);
  command->add_flag("--force-unsafe", options->force_unsafe, "write even an unsafe table");
  command->footer(
      "Examples:\n"
      "  ayumi export out/ --format hoap -o walk_hoap.csv\n"
      "  ayumi export out/ --format csv --log open_loop -o open_loop.csv\n"
      "  ayumi export out/ --format gltf -o walk.glb\n"
      "  ayumi export patterns/hoap1_walk.json --format json --ramp 3 -o walk_table.json");
  command->callback([options, &context] { export_table(*options, context); });
}

}  // namespace ayumi::app
