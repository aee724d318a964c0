// Joint tables for a robot or another program: the reference of a run, or of a pattern that is
// replayed open loop, with a ramp and a hold around it. Unsafe tables are refused.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/laws/dtad.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/formats/motion_formats.hpp"
#include "ayumi/io/formats/sign_test.hpp"
#include "ayumi/io/formats/table_motion.hpp"
#include "ayumi/io/import_pattern.hpp"
#include "ayumi/io/kept_rows.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/table/csv_dialect.hpp"
#include "ayumi/io/table/table.hpp"
#include "ayumi/io/table/table_note.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/limits/table_safety.hpp"
#include "ayumi/model/encoder_angles.hpp"
#include "ayumi/render/gltf.hpp"
#include "ayumi/sim/simulate.hpp"
#include "ayumi/task/servo_table.hpp"
#include "commands.hpp"
#include "log_export.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "run_robot.hpp"
#include "sign_test_sheet.hpp"
#include "simulation.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  std::string input, format, output, robot, log, layout;
  std::string servo;  ///< option as given; "" for the usual content of the format
  std::vector<std::string> set;
  SafetyOptions safety;
  std::optional<double> ramp, hold;  ///< options as given [s]
  std::optional<double> interval;    ///< time between two rows, as given [ms]
  std::optional<double> rate;        ///< rate as given [1/s]
  bool pushed = false, force_unsafe = false, sign_test = false;
  bool posture_given = false;  ///< --posture was given
};

struct Source {
  RobotModel model;
  ReferenceTrajectory reference;
  /// Disturbances of the run from which the table comes; empty if there is none.
  std::string disturbances;
  Eigen::MatrixXd torque;          ///< torque of a run's motors, rows x dof; empty if unknown
  std::optional<Task> plan;        ///< task of a pattern; the check can then say what it needs
  std::vector<std::string> unfit;  ///< reasons why no robot should receive the table
  std::optional<KeptRows> kept = {};
  /// Bytes of the imported file, if the format is the same.
  std::optional<std::string> original = {};
  /// Time between two rows of the imported file [s]; 0 if no file was imported.
  double interval = 0;
};

/// The unit of angles in texts: that of the pattern, if there is one.
bool angles_in_degrees(const Source& source) {
  return !source.plan || source.plan->pattern.degrees;
}

/// The format in which a motion is written; null for the joint tables of this program.
const MotionFormat* motion_format(const ExportOptions& options) {
  const MotionFormat* format = find_motion_format(options.format);
  return format && format->write ? format : nullptr;
}

/// Whether the program of a robot plays the file as it is. Then the file must be safe.
bool plays(const ExportOptions& options) {
  const MotionFormat* format = motion_format(options);
  return !format || format->played;
}

/// Takes the unchanged rows of an imported sequence, unless the motion was changed.
void take_kept_rows(const Task& task, const ExportOptions& options, Source& source) {
  if (!task.pattern.table) return;
  source.interval = 0.001 * task.pattern.table->interval_ms;
  if (!options.servo.empty()) return;
  if (motion_format(options)) {
    source.interval = task.pattern.table->dt;
    const auto rows = rows_of_table(task, source.reference);
    if (!rows) return;
    source.reference.rows = rows->rows;
    source.reference.dt = rows->dt;
    const bool as_it_was = !options.interval && !options.rate && options.ramp.value_or(0) == 0 &&
                           options.hold.value_or(0) == 0 && options.robot.empty();
    if (as_it_was) source.original = kept_file(*task.pattern.table, options.format, task.robot);
    return;
  }
  source.kept = kept_rows(task);
  if (!source.kept) return;
  ReferenceTrajectory targets = source.kept->targets;
  const ReferenceTrajectory planned = resampled(source.reference, targets.dt);
  for (size_t k = 0; k < targets.rows.size(); ++k) {
    Eigen::VectorXd theta = std::move(targets.rows[k].theta);
    targets.rows[k] = planned.rows[std::min(k, planned.rows.size() - 1)];
    targets.rows[k].theta = std::move(theta);
  }
  targets.provenance = source.reference.provenance;  // nothing is known about the servo
  source.reference = std::move(targets);
}

/// A table for the robot is made for the robot's own actuators and judged by them. Actuators that a
/// study assumes are not used.
std::string profile_of(const ExportOptions& options, const RobotModel& model,
                       const std::string& recorded) {
  if (!options.safety.profile.empty()) return options.safety.profile;
  return options.format == "hoap" ? model.limits().name : recorded;
}

ServoContent content_of(const ExportOptions& options) {
  const char* const usual = motion_format(options) ? "ideal" : "lead";
  return servo_content(options.servo.empty() ? usual : options.servo);
}

bool draws(const ExportOptions& options) { return options.format == "gltf"; }

/// The robot of the option, or else `recorded`; with meshes if they are drawn.
RobotModel robot_named(const ExportOptions& options, const std::string& recorded,
                       const Context& context) {
  return robot_of_run(context, options.robot, recorded, {.meshes = draws(options)});
}

Source source_of_pattern(const ExportOptions& options, const Context& context) {
  Task input =
      load_pattern(context, options.input,
                   {.set = options.set, .profile = {}, .robot = options.robot}, draws(options));
  if (!input.series.viip.empty())
    fail(ErrorCode::bad_pattern, {options.input, "/phases"}, refusal_of_goals());
  Source source{input.robot,
                table_of_series(input.robot, profile_of(options, input.robot, input.profile),
                                input.series, content_of(options)),
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
  take_kept_rows(input, options, source);
  source.plan = std::move(input);
  return source;
}

double asked_period(const ExportOptions& options, const Source& source) {
  if (options.interval) return 0.001 * *options.interval;
  if (options.rate) return 1 / *options.rate;
  return source.interval > 0 ? source.interval : source.reference.dt;
}

/// Samples the rows at the requested interval, or else at that of the imported file. Some robots
/// only accept certain intervals.
void set_rate(const ExportOptions& options, Source& source) {
  const double period = asked_period(options, source);
  const double before = source.reference.dt;
  source.reference = resampled(source.reference, period);
  if (source.reference.dt != before) {
    source.kept.reset();
    source.torque.resize(0, 0);  // the torques were for the rows at the old rate
  }
  if (source.kept && !options.layout.empty() && options.layout != source.kept->file.layout.name)
    source.kept.reset();
  if (options.format != "hoap" || source.kept) return;
  const std::string refusal = refusal_of_interval(
      source.model, written_layout(source.model, options.layout), source.reference.dt);
  if (!refusal.empty())
    fail(ErrorCode::bad_file, {options.output},
         refusal + ". Choose one of these intervals with --interval");
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
  // The rows are angles of joints, and the file is for this unit, whatever the head says.
  source.reference.servo.zeros = encoder_zeros(source.model);
  if (!made.robot_sha256.empty() && made.robot_sha256 != source.model.description().sha256)
    fail(ErrorCode::bad_file, {options.input},
         "robot '" + source.model.name() +
             "' has changed since this table was made. Run the pattern again");
  if (!caution.unfit.empty()) source.unfit.push_back(caution.unfit);
  return source;
}

// Throws Error(bad_file) unless the table of a run is the one that its log gives. Hashes alone do
// not show that the two belong together, because run.json could have been written anew.
void require_table_of_log(const ReferenceTrajectory& table, const ReferenceTrajectory& of_log,
                          const std::string& file) {
  // Largest difference [rad, m, m, N]. Derived: the file has every digit, and the zeros of encoders
  // are added and subtracted, which rounds by less than 1e-14.
  constexpr double kRounding = 1e-9;
  const auto refuse = [&](const std::string& what) {
    fail(ErrorCode::bad_file, {file},
         what + ". The table or the log has changed. Make the run again");
  };
  if (table.dt != of_log.dt)
    refuse("the table has a row every " + text::brief(1000 * table.dt) +
           " ms, but the log of the run has a row every " + text::brief(1000 * of_log.dt) + " ms");
  if (table.rows.size() != of_log.rows.size())
    refuse("the table has " + text::counted(table.rows.size(), "row") +
           ", but the log of the run has " + std::to_string(of_log.rows.size()));
  if (table.joints != of_log.joints) refuse("the table has other joints than the log of the run");
  for (size_t k = 0; k < table.rows.size(); ++k) {
    const ReferenceRow &a = table.rows[k], &b = of_log.rows[k];
    const bool same = (a.theta - b.theta).cwiseAbs().maxCoeff() <= kRounding &&
                      (a.base.position - b.base.position).norm() <= kRounding &&
                      (a.cog - b.cog).norm() <= kRounding && (a.zmp - b.zmp).norm() <= kRounding &&
                      std::abs(a.fz - b.fz) <= kRounding && a.contact == b.contact;
    if (!same)
      refuse("row " + std::to_string(k + 1) + " of the table differs from the log of the run");
  }
}

constexpr const char* kTable = "reference.csv";
constexpr const char* kPushedTable = "reference_pushed.csv";

struct CautiousTable {
  ReferenceTrajectory reference;
  TableCaution caution;
};

// The requested table of a run; `log` is the log from which it comes.
CautiousTable table_of_run(const ExportOptions& options, const RunFolder& run,
                           const SimulationLog& log, const RobotModel& model) {
  const ServoContent content = content_of(options);
  const std::string profile = profile_of(options, model, log.provenance.profile);
  const auto made = [&](const SimulationLog& from) {
    return table_of_log(model, profile, from, content);
  };
  const bool disturbed = !log.scenario.empty();
  if (!options.log.empty()) {
    // The motion that was played may itself contain the reactions to disturbances.
    TableCaution caution = caution_of(log);
    const TableCaution& of_run = disturbed ? run.pushed_caution : run.reference_caution;
    if (!of_run.disturbances.empty()) caution.disturbances = of_run.disturbances;
    return {made(log), caution};
  }
  const bool reacts = !run.reference_caution.disturbances.empty();
  if (options.pushed && !reacts && !(run.light ? disturbed : run.pushed.has_value()))
    fail(ErrorCode::usage, {options.input},
         "--pushed needs a run with disturbances, and this run has none. Leave "
         "--pushed out");
  if (run.light) return {made(log), disturbed ? run.pushed_caution : run.reference_caution};
  const bool pushed = (options.pushed && run.pushed) || !run.reference;
  const TableCaution& caution = !pushed      ? run.reference_caution
                                : run.pushed ? run.pushed_caution
                                             : caution_of(log);
  const auto& table = pushed ? run.pushed : run.reference;
  if (!table) return {made(log), caution};
  const TableServo wanted = table_servo(model, profile, content);
  const bool as_wanted = table->servo.content == wanted.content &&
                         table->servo.delay == wanted.delay && table->servo.lag == wanted.lag;
  if (!as_wanted) return {made(log), caution};
  require_table_of_log(*table, made(log),
                       (fs::path(options.input) / (pushed ? kPushedTable : kTable)).string());
  return {*table, caution};
}

std::string log_of_table(const ExportOptions& options, const RunFolder& run) {
  if (!options.log.empty()) return options.log;
  return !options.pushed && run.logs.contains("undisturbed") ? "undisturbed" : "";
}

// Throws Error(bad_file) if the tick of the log is not the servo period with which the recorded
// robot is simulated. Otherwise the speeds and torques of the table would be judged at another
// rate. A log of `replay` has the tick of the motor boards.
void require_tick_of(const RobotModel& model, const ExportOptions& options, const RunFolder& run,
                     const SimulationLog& log) {
  const double period = model.description().servo_period;
  const bool replayed = std::any_of(run.sections.begin(), run.sections.end(),
                                    [](const auto& section) { return section.first == "replay"; });
  if (replayed || !options.robot.empty() || log.dt == period) return;
  fail(ErrorCode::bad_file, {options.input},
       "the log has a row every " + text::brief(1000 * log.dt) +
           " ms, but the servo period of robot '" + model.name() + "' is " +
           text::brief(1000 * period) + " ms. The log has changed. Make the run again");
}

// Every file of the folder is first compared with its hash in run.json.
Source source_of_run(const ExportOptions& options, const Context& context) {
  const RunFolder run = read_run(options.input, ComparedFiles::all);
  const SimulationLog& log = log_of_run(run, options.input, log_of_table(options, run));
  const RobotModel model = robot_of_log(context, options.robot, log, options.input);
  require_tick_of(model, options, run, log);
  const CautiousTable table = table_of_run(options, run, log, model);
  Source source = source_of_table(options, context, table.reference, table.caution);
  if (log.samples.size() == source.reference.rows.size()) source.torque = torques_of(log);
  source.unfit = run.unfit;
  // The cautions of the run and, if the open loop is asked for, of this log.
  const std::string& own = table.caution.unfit;
  if (!own.empty() && text::join(run.unfit, "; ").find(own) == std::string::npos)
    source.unfit.push_back(own);
  return source;
}

// Whether the file is a CSV table, or a JSON table, which says so at its head.
bool is_reference_table(const std::string& path) {
  return path.ends_with(".csv") || (path != "-" && read_file(path).substr(0, 200).find(
                                                       "\"ayumi.reference/") != std::string::npos);
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// The text of a table. If it belongs to a run, the whole run must be as it was written.
std::string text_of_table(const fs::path& table) {
  const fs::path folder = folder_of(table);
  const std::string name = table.filename().string();
  if (is_run_folder(folder)) {
    const std::vector<std::string> names = run_file_names(folder);
    if (std::find(names.begin(), names.end(), name) != names.end())
      if (auto text = verify_run(folder, name)) return *std::move(text);
  }
  return read_file(table);
}

// If a table in a run folder has the name of the run's own table, it must be the table that the log
// gives; otherwise Error(bad_file) is thrown. Other files in such a folder belong to the user.
void require_table_of_run(const ReferenceTrajectory& table, ExportOptions options,
                          const Context& context) {
  const fs::path path = options.input;
  const fs::path folder = folder_of(path);
  const bool pushed = path.stem() == fs::path(kPushedTable).stem();
  if ((!pushed && path.stem() != fs::path(kTable).stem()) || !is_run_folder(folder)) return;
  const RunFolder run = read_run(folder);
  if (pushed ? !run.pushed : !run.reference) return;  // a light run beside a table of the user
  options.pushed = pushed;
  options.log.clear();
  const SimulationLog& log = log_of_run(run, folder, log_of_table(options, run));
  const RobotModel model = robot_of_log(context, options.robot, log, folder.string());
  const std::string& content = table.servo.content;
  const std::string& profile =
      table.servo.profile.empty() ? log.provenance.profile : table.servo.profile;
  const ReferenceTrajectory of_log = table_of_log(
      model, profile, log, content.empty() ? ServoContent::lead : servo_content(content));
  // A robot with other servos (--robot) would have got another table.
  if (!options.robot.empty() && of_log.servo.lag != table.servo.lag) return;
  require_table_of_log(table, of_log, options.input);
}

Source source_of(const ExportOptions& options, const Context& context) {
  if (fs::is_directory(options.input)) return source_of_run(options, context);
  refuse_log_file(options.input);
  if (!is_reference_table(options.input)) return source_of_pattern(options, context);
  const std::string text = text_of_table(options.input);
  if (!options.servo.empty())
    fail(ErrorCode::usage, {options.input},
         "--servo cannot change the content of a table that exists. To "
         "choose the content, export the pattern or the run");
  const ReferenceTrajectory table = parse_reference(text, options.input);
  require_table_of_run(table, options, context);
  return source_of_table(options, context, table, parse_table_caution(text, options.input));
}

constexpr double kGltfRate = 60;  // rate of an animation's keys [Hz]; viewers interpolate linearly

/// Writes the table as an animation of the robot. It is only for viewing, so it is neither ramped
/// nor judged.
void export_gltf(const ExportOptions& options, Context& context) {
  if (fs::path(options.output).extension() != ".glb")
    fail(ErrorCode::usage, {options.output}, "--format gltf needs a file name that ends in .glb");
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

/// The table as a motion of any format.
MotionFile motion_file_of(const MotionFormat& format, const Source& source,
                          const ReferenceTrajectory& table) {
  MotionFile motion = motion_of_table(table);
  // What a robot plays are angles of its encoders.
  if (format.played) motion.values = encoder_rows(std::move(motion.values), table.servo.zeros);
  if (source.torque.rows() == motion.rows()) motion.torque = source.torque;
  return motion;
}

std::string bytes_of(const std::string& format, const Source& source,
                     const ReferenceTrajectory& table, const TableCaution& caution,
                     const ExportOptions& options, size_t first) {
  const SafetyOptions& safety = options.safety;
  if (format == "hoap" && source.kept)
    return hoap_csv_around(source.model, table, first, source.reference.rows.size(), safety,
                           source.kept->file, source.kept->bytes);
  if (format == "hoap")
    return hoap_csv(source.model, table, safety, written_layout(source.model, options.layout));
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
      found.push_back({TableLimit::torque, f.where, begin + f.at, std::abs(f.worst),
                       std::abs(f.limit), f.unit,
                       static_cast<int>(std::lround((f.end - f.begin) / safe.table.dt)) + 1});
  return found;
}

/// Adds ramp and hold, and judges the table. For a table that a robot is to receive, the torque is
/// judged, too.
SafeTable judged(const ExportOptions& options, const Source& source, const std::string& profile) {
  SafetyOptions safety = options.safety;
  safety.profile = profile;
  SafeTable safe = make_safe(source.model, source.reference, safety);
  if (plays(options) && options.format != "csv" && options.format != "json" && knows_torque(source))
    add_violations(safe, torque_violations_of(source, safe, profile));
  return safe;
}

/// The other profiles of the robot with which its motors could carry out a table that is unsafe
/// with the chosen profile. The motor board's own limit of counts per ms is ignored.
std::vector<std::string> sufficient_profiles(ExportOptions options, const Source& source) {
  const std::string profile = options.safety.profile;
  options.safety.counts_per_ms = 1e9;
  std::vector<std::string> names;
  for (const std::string& name : source.model.profile_names())
    if (name != profile && judged(options, source, name).report.safe) names.push_back(name);
  return names;
}

/// The reasons why the table is not written, those of its run or pattern first; empty if it is
/// written.
std::vector<std::string> refusals(const ExportOptions& options, const Source& source,
                                  const SafeTable& safe) {
  std::vector<std::string> reasons;
  if (!plays(options)) return reasons;
  const std::string& disturbances = source.disturbances;
  if (!options.force_unsafe) reasons = source.unfit;
  if (!disturbances.empty() && !options.pushed)
    reasons.push_back(refusal_of_disturbances(disturbances));
  if (!safe.report.safe && !options.force_unsafe)
    reasons.emplace_back("the table is unsafe for a robot");
  return reasons;
}

std::string words_of(const TableServo& servo) {
  if (servo.content == "ideal")
    return "as with --servo ideal, the table contains joint angles and no servo targets. It was "
           "judged by the limits of profile " +
           servo.profile;
  const bool one = servo.lag.find(' ') == std::string::npos;
  return "made for the servos of profile " + servo.profile +
         ": the targets are ahead of the posture by the lag of the servos" +
         (one ? " (" + text::brief(1000 * std::atof(servo.lag.c_str()), 3) + " ms)" : "") +
         (servo.content == "lead" ? "" : ", and they also compensate for the sag");
}

/// Whether the file holds angles of encoders: a robot plays it.
bool holds_zeros(const ExportOptions& options, const ReferenceTrajectory& table) {
  return plays(options) && !table.servo.zeros.isZero(0);
}

/// A line about the offsets of this robot's encoders; empty if there are none.
std::string words_on_zeros(const ExportOptions& options, const ReferenceTrajectory& table) {
  if (table.servo.zeros.isZero(0)) return "";
  if (!plays(options))
    return "  the table contains joint angles. The offsets of this robot's encoders are not "
           "subtracted, because no robot plays this format\n";
  std::vector<std::string> joints;
  for (size_t j = 0; j < table.joints.size(); ++j)
    if (const double zero = table.servo.zeros[static_cast<Eigen::Index>(j)]; zero != 0)
      joints.push_back(table.joints[j] + " " + text::fixed(zero * 180 / EIGEN_PI, 3));
  return "  the table is for this robot alone, because the offsets of its encoders are subtracted "
         "(" +
         text::join(joints, ", ") + " deg)\n";
}

/// The content of the table that the format cannot hold, in words; empty if there is none.
std::string lost_content(const ExportOptions& options, const Source& source,
                         const SafeTable& safe) {
  const MotionFormat* const format = motion_format(options);
  return format ? cannot_hold(*format, motion_file_of(*format, source, safe.table)) : "";
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
    for (const std::string& reason : source.unfit)
      text +=
          (plays(options) ? "  written although " : "  the table is not for a robot, because ") +
          reason + "\n";
  if (const std::string lost = lost_content(options, source, safe); !lost.empty())
    text += "  the format cannot store " + lost + "\n";
  const TableServo& servo = safe.table.servo;
  if (!servo.content.empty()) text += "  " + words_of(servo) + "\n";
  text += words_on_zeros(options, safe.table);
  text += (report.ramp > 0 ? "  a ramp of " + text::brief(report.ramp) + " s before the motion, "
                           : "  no ramp before the motion, ") +
          std::string(report.hold > 0 ? "and the last posture is held for " +
                                            text::brief(report.hold) + " s after it"
                                      : "and the last posture is not held after it") +
          ". The pattern begins at " + text::brief(report.ramp) + " s of the table\n";
  if (!report.worst_joint.empty())
    text += "  the largest step from row to row is that of " + report.worst_joint + " at " +
            on_both_clocks(report.worst_at, report.ramp, report.ramp + report.motion) + ": " +
            text::fixed(100 * report.max_step_ratio, 1) + " % of the limit\n";
  const ShownUnit margin = shown_unit("rad", angles_in_degrees(source));
  if (!report.margin_joint.empty())
    text += (report.min_limit_margin < 0 ? "  the joint farthest beyond its position limit is "
                                         : "  the joint nearest to its position limit is ") +
            report.margin_joint + ", " +
            text::brief(std::abs(report.min_limit_margin) * margin.scale, 3) + " " + margin.name +
            (report.min_limit_margin < 0 ? " beyond this limit\n" : " from this limit\n");
  for (const SafetyViolation& violation : report.violations)
    text += "  unsafe: " + text_of(violation, angles_in_degrees(source)) + "\n";
  if (!options.force_unsafe && plays(options) && (!source.unfit.empty() || !report.safe))
    text += "  --force-unsafe writes the table nevertheless\n";
  return text;
}

/// Messages about an imported sequence.
std::string words_on_sequence(const Source& source, const SafeTable& safe) {
  if (!source.plan || !source.plan->pattern.table || !source.plan->pattern.table->sequence)
    return "";
  if (!source.kept)
    return "  the motion or the encoders of the robot have changed, so the rows are computed again "
           "and differ from the imported sequence\n";
  const HoapFile& file = source.kept->file;
  std::string text = "  the rows of the motion are the unchanged rows of the imported sequence";
  if (safe.report.ramp == 0 && safe.report.hold == 0)
    text += ". --ramp S adds rows before them, and --hold S adds rows after them";
  text += "\n";
  if (file.general_commands > 0)
    text += "  these rows contain " + text::counted(file.general_commands, "command") +
            " to single devices. The robot will carry out these commands\n";
  const std::vector<SequenceLayout> layouts = sequence_layouts(source.model);
  if (file.layout.name != layouts.front().name)
    text += "  the columns of these rows follow the layout " + file.layout.name + "; --layout " +
            layouts.front().name + " writes the columns of this robot\n";
  return text;
}

/// The caution for the head of the written table.
TableCaution caution_of_written(const Source& source, const SafeTable& safe) {
  std::vector<std::string> words = source.unfit;
  for (const SafetyViolation& violation : safe.report.violations)
    words.push_back("unsafe: " + text_of(violation, angles_in_degrees(source)));
  return {source.disturbances, text::join(words, "; ")};
}

/// The file name that shows that a table is not for a robot: walk.UNSAFE.csv.
std::string unsafe_name(const std::string& output) {
  if (fs::path(output).stem().extension() == ".UNSAFE") return output;
  const fs::path path = output;
  return (path.parent_path() / (path.stem().string() + ".UNSAFE" + path.extension().string()))
      .string();
}

/// Whether the format is played by a robot but has no head in which a caution could stand.
bool needs_note(const ExportOptions& options) {
  return options.format == "hoap" || (motion_format(options) && plays(options));
}

/// Writes all files of the format, or none if one of them exists.
void write_motion(const MotionFormat& format, const ExportOptions& options, const Context& context,
                  const Source& source, const SafeTable& safe) {
  std::vector<std::pair<fs::path, std::string>> files;
  if (source.original) files.emplace_back(options.output, *source.original);
  for (WrittenFile& file :
       source.original ? std::vector<WrittenFile>()
                       : format.write(source.model, motion_file_of(format, source, safe.table))) {
    fs::path path = options.output;
    if (!file.extension.empty()) path.replace_extension(file.extension);
    refuse_overwriting(context, path);
    files.emplace_back(std::move(path), std::move(file.bytes));
  }
  for (const auto& [path, bytes] : files) write_file(path, bytes);
}

void write_table(const ExportOptions& options, const Context& context, const Source& source,
                 const SafeTable& safe) {
  const TableCaution caution = caution_of_written(source, safe);
  const bool nothing = caution.disturbances.empty() && caution.unfit.empty();
  const std::string note = note_beside(options.output).string();
  const bool old_note = has_table_note(options.output);
  const bool beside = needs_note(options) && !nothing;
  std::optional<std::string> before;
  if (beside) {  // first, because no table may be without its note
    refuse_overwriting(context, note);
    if (fs::is_regular_file(note)) before = read_file(note);
    write_file(note, table_note(caution));
  }
  try {
    if (const MotionFormat* format = motion_format(options))
      write_motion(*format, options, context, source, safe);
    else
      write_file(options.output,
                 bytes_of(options.format, source, safe.table, caution, options, safe.first));
  } catch (...) {
    if (before)
      write_file(note, *before);
    else if (beside)
      fs::remove(note);
    throw;
  }
  if (old_note && !beside) fs::remove(note);  // it was about the previous table
  if (!beside) return;
  context.print(note + ": read this note before you send the table to a robot\n");
}

std::string as_json(const ExportOptions& options, const Source& source, const SafeTable& safe,
                    const std::vector<std::string>& sufficient,
                    const std::vector<std::string>& refused) {
  const nlohmann::ordered_json json = {
      {"format", options.format},
      {"output", refused.empty() ? nlohmann::ordered_json(options.output) : nullptr},
      {"refused", refused},
      {"rows", safe.table.rows.size()},
      {"first_row", safe.first},
      {"rate_hz", 1 / safe.table.dt},
      {"interval_ms", 1000 * safe.table.dt},
      {"servo", safe.table.servo.content.empty()
                    ? nlohmann::ordered_json(nullptr)
                    : nlohmann::ordered_json(safe.table.servo.content)},
      {"offsets_rad", holds_zeros(options, safe.table)
                          ? nlohmann::ordered_json(std::vector<double>(
                                safe.table.servo.zeros.begin(), safe.table.servo.zeros.end()))
                          : nlohmann::ordered_json(nullptr)},
      {"imported_rows_unchanged", source.kept.has_value() || source.original.has_value()},
      {"joints", safe.table.joints},
      {"cannot_hold", lost_content(options, source, safe)},
      {"profile", options.safety.profile},
      {"sufficient_profiles", sufficient},
      {"safety", nlohmann::ordered_json::parse(safety_json(safe.report))}};
  return json.dump(2);
}

/// Writes one file for each joint, and the sheet. The folder is made if necessary; nothing in it is
/// replaced without --force.
void export_sign_test(const ExportOptions& options, Context& context) {
  if (options.format == "gltf")
    fail(ErrorCode::usage, "--sign-test: --format must be hoap, csv or json");
  const std::string name = options.robot.empty() ? options.input : options.robot;
  if (name.empty())
    fail(ErrorCode::usage, "--sign-test needs a robot: ayumi export ROBOT --sign-test -o DIR");
  const RobotModel model = load_robot(name, robot_search(context), {.meshes = true});
  Source source{model, {}, {}, {}, {}, {}};
  source.reference.dt = model.description().servo_period;
  const double dt = asked_period(options, source);
  const SequenceLayout layout =
      options.format == "hoap" ? written_layout(model, options.layout) : SequenceLayout{};
  SafetyOptions safety = options.safety;
  safety.ramp = 0;  // each test begins and ends in the same posture
  safety.hold = options.hold.value_or(0);
  safety.profile = profile_of(options, model, "");
  const Eigen::VectorXd start = options.posture_given && safety.from != "first"
                                    ? model.posture(safety.from)
                                    : sign_test_start(model);
  safety.from = "first";
  const std::vector<SignTest> tests = sign_tests(model, start, dt);
  const std::string extension = options.format == "json" ? ".json" : ".csv";
  const fs::path folder = options.output;
  std::vector<std::pair<fs::path, std::string>> files;
  nlohmann::ordered_json joints = nlohmann::ordered_json::array();
  for (const SignTest& test : tests) {
    SafeTable safe = make_safe(model, test.table, safety);
    const std::string& joint = model.dofs()[static_cast<size_t>(test.dof)].name;
    if (!safe.report.safe)
      fail(ErrorCode::bad_model,
           "sign test of " + joint + ": " + text_of(safe.report.violations.front()) +
               ". Correct the limits of the robot, or the posture in which the test begins");
    safe.table.provenance.robot = name;
    safe.table.provenance.robot_sha256 = model.description().sha256;
    safe.table.provenance.pattern = "sign test of " + joint;
    safe.table.provenance.profile = safety.profile;
    safe.table.servo = table_servo(model, safety.profile, ServoContent::ideal);
    files.emplace_back(folder / (test.name + extension),
                       options.format == "hoap"   ? hoap_csv(model, safe.table, safety, layout)
                       : options.format == "json" ? reference_json(safe.table)
                                                  : reference_csv(safe.table));
    joints.push_back({{"joint", joint},
                      {"file", test.name + extension},
                      {"picture", test.name + ".png"},
                      {"seen_from", sign_test_view(model, test)},
                      {"from_rad", test.from},
                      {"to_rad", test.to}});
  }
  for (const SignTest& test : tests)
    files.emplace_back(folder / (test.name + ".png"), encode_png(sign_test_picture(model, test)));
  files.emplace_back(folder / "sheet.html", sign_test_page(model, tests, extension));
  if (fs::exists(folder) && !fs::is_directory(folder))
    fail(ErrorCode::bad_file, {options.output}, "this is not a folder");
  if (fs::exists(folder))
    for (const auto& [path, bytes] : files) refuse_overwriting(context, path);
  fs::create_directories(folder);
  for (const auto& [path, bytes] : files) write_file(path, bytes);
  context.print(options.output + ": the folder holds one slow motion for each of " +
                std::to_string(tests.size()) + " joints (" + options.format +
                "), and sheet.html with a picture of each motion\n" +
                "  Hang the robot up before you play the motions. " +
                sign_test_words(model, tests) + "\n");
  context.print_json(nlohmann::ordered_json{
      {"format", options.format},
      {"output", options.output},
      {"sheet", "sheet.html"},
      {"tests", joints}}.dump(2));
}

void export_table(ExportOptions options, Context& context) {
  if (options.sign_test) return export_sign_test(options, context);
  refuse_overwriting(context, options.output);
  if (options.format == "gltf") return export_gltf(options, context);
  Source source = source_of(options, context);
  set_rate(options, source);
  if (source.kept || motion_format(options)) options.safety = as_it_is(options.safety);
  if (options.ramp) options.safety.ramp = *options.ramp;
  if (options.hold) options.safety.hold = *options.hold;
  options.safety.profile = profile_of(options, source.model, source.reference.provenance.profile);
  const SafeTable safe = judged(options, source, options.safety.profile);
  std::vector<std::string> others;
  if (!safe.report.safe) others = sufficient_profiles(options, source);
  const std::vector<std::string> refused = refusals(options, source, safe);
  if (plays(options) && refused.empty() && (!safe.report.safe || !source.unfit.empty())) {
    options.output = unsafe_name(options.output);
    refuse_overwriting(context, options.output);
  }
  if (refused.empty()) write_table(options, context, source, safe);
  context.print(in_words(options, source, safe, refused) +
                (source.original          ? "  the file is the imported file, byte for byte\n"
                 : motion_format(options) ? ""
                                          : words_on_sequence(source, safe)));
  if (!safe.report.safe)
    context.print(
        "  the table is judged by the limits of the profile " + options.safety.profile + "; " +
        (others.empty() ? "no other profile has motors that are strong enough"
                        : "the motors of " + text::join(others, ", ") + " are strong enough") +
        "\n");
  if (options.format == "hoap" && !knows_torque(source))
    context.print(
        "  the torques are not checked, because a table contains no torques. Export the RUN folder "
        "to check the torques\n");
  context.print_json(as_json(options, source, safe, others, refused));
  context.exit_code = refused.empty() ? 0 : 1;
}

}  // namespace

void add_export(Command& app, Context& context) {
  auto options = std::make_shared<ExportOptions>();
  Command* command =
      app.add_subcommand("export", "write a joint table of a run or pattern for the robot");
  command
      ->add_option("input", options->input,
                   "Run folder, pattern, or reference table (such as reference.csv of a run); with "
                   "--sign-test a robot.")
      ->type_name("RUN_OR_PATTERN");
  std::vector<std::string> formats = {"csv", "json", "hoap", "gltf"};
  const std::vector<std::string> motions = written_format_names();
  formats.insert(formats.end(), motions.begin(), motions.end());
  formats.insert(formats.end(), log_formats().begin(), log_formats().end());
  command
      ->add_option("--format", options->format,
                   "Format of the file. A joint table: csv, json, hoap or gltf. A motion for "
                   "another program: " +
                       text::join(motions, ", ") +
                       ". The log of a run: " + text::join(log_formats(), ", ") + ".")
      ->required()
      ->check(one_of(formats));
  command->add_option("-o,--out", options->output, "File to write; with --sign-test a folder.")
      ->required()
      ->type_name("FILE");
  command->add_flag("--sign-test", options->sign_test,
                    "Write one slow, small motion for each joint, and a sheet with a picture of "
                    "each motion. The picture shows the direction in which the joint has to move.");
  command
      ->add_option("--ramp", options->ramp,
                   "Shortest duration of the ramp before the motion [s]; 0 = no ramp (default: 2, "
                   "or 0 if the pattern is an imported sequence whose motion is unchanged). On the "
                   "ramp, the robot moves from its home posture to the first posture of the "
                   "motion. If a joint is too slow for this duration, the ramp takes longer.")
      ->check(number_within(SafetyOptions::kRest));
  command
      ->add_option("--hold", options->hold,
                   "Time for which the last posture is held [s] (default: 0.5, or 0 if the pattern "
                   "is an imported sequence whose motion is unchanged).")
      ->check(number_within(SafetyOptions::kRest));
  Option* interval =
      command
          ->add_option(
              "--interval", options->interval,
              "Time from row to row [ms] (default: the interval of the imported sequence, or the "
              "servo period of the robot for other motions). HOAP robots accept 1, 2 or 10 ms.")
          ->check(number_within(0.1, 1000.0))
          ->type_name("MS");
  command->add_option("--rate", options->rate, "Rows per second [1/s], in place of --interval.")
      ->check(number_within(1.0, 10000.0))
      ->type_name("HZ")
      ->excludes(interval);
  command->add_option("--layout", options->layout,
                      "Name of the column layout for --format hoap, one of \"layouts\" in the "
                      "sidecar (default: the first layout whose rows begin with the time to the "
                      "next row). Ayumi can write only layouts whose rows begin with this time.");
  Option* posture =
      command
          ->add_option("--posture", options->safety.from,
                       "Posture of the robot before the ramp. The name 'first' selects the first "
                       "posture of the motion. With --sign-test: posture in which each test begins "
                       "(default: all joints at 0).")
          ->type_name("NAME")
          ->capture_default_str();
  command->add_option("--profile", options->safety.profile,
                      "Actuator profile by which the table is judged (default: for hoap the first "
                      "profile of the robot, otherwise the profile of the pattern or run).");
  command->add_option("--log", options->log, "Log of the run, for example open_loop.");
  command->add_option("--robot", options->robot,
                      "Robot to use in place of the robot that the run names.");
  command->add_option("--set", options->set, "Set a parameter that the pattern declares.")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command->add_flag("--pushed", options->pushed,
                    "Export the table of the disturbed run. The head of the table then says that "
                    "the table contains the reactions to disturbances.");
  command->add_flag("--force-unsafe", options->force_unsafe,
                    "Write the table even if it is unsafe, or if its run is not fit for a robot, "
                    "for example because the robot fell in the run. The head and the name of the "
                    "table then state this, for example walk.UNSAFE.csv.");
  command
      ->add_option(
          "--servo", options->servo,
          "Content of the targets. ideal: the joint angles. lead: the targets are ahead of the "
          "posture by the lag of the profile's servos. lead+sag: as lead, and the targets also "
          "compensate for the sag of the joints under load. The default is lead for csv, json, "
          "hoap and gltf, and ideal for the formats of other programs.")
      ->check(one_of({"ideal", "lead", "lead+sag"}));
  command->footer(
      "Examples:\n"
      "  ayumi export out/ --format hoap -o walk_hoap.csv\n"
      "  ayumi export out/ --format csv --pushed -o pushed.csv\n"
      "  ayumi export out/ --format gltf -o walk.glb\n"
      "  ayumi export out/ --format npz --log open_loop -o fall.npz\n"
      "  ayumi export hoap1 --sign-test --format hoap -o signs/\n"
      "  ayumi export patterns/hoap1_walk.json --format json --ramp 3 -o walk_table.json");
  command->callback([options, command, posture, &context] {
    options->posture_given = posture->count() > 0;
    if (options->input.empty() && !options->sign_test)
      fail(ErrorCode::usage, "RUN_OR_PATTERN is missing; see ayumi export --help");
    if (is_log_format(options->format))
      export_log({options->input, options->format, options->output, options->log, options->robot},
                 *command, context);
    else
      export_table(*options, context);
  });
}

}  // namespace ayumi::app
