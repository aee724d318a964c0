// Compares a simulated run with recordings of the robot.

#include "ayumi/identify/compare.hpp"

#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/table/recording.hpp"
#include "ayumi/plot/compare_plot.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "report_input.hpp"
#include "run_robot.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kComparedDegree = M_PI / 180;

struct CompareCommand {
  std::string run, robot, log, loads, plot, report, at = "encoder";
  std::vector<std::string> measured;
  std::optional<double> shift;
  std::vector<double> window;
  RecordingOptions reading;
};

// The recordings that are given.
struct Recordings {
  std::optional<AngleTable> angles;
  SensorTable sensors;
  std::string names;
};

Recordings read_recordings(const CompareCommand& options, const RobotModel& model) {
  Recordings all;
  const auto add = [&](const std::string& file, bool sensors) {
    all.names += (all.names.empty() ? "" : ", ") + file;
    const std::string bytes = read_input(file);
    if (sensors || holds_sensors(bytes, file, model)) {
      add_sensors(read_sensors_table(bytes, file, model, options.reading), all.sensors, file);
      return;
    }
    if (all.angles)
      fail(ErrorCode::usage, {file},
           "another file already contains joint angles. Give only one such file");
    all.angles = read_angles(bytes, file, model, options.reading);
  };
  for (const std::string& file : options.measured) add(file, false);
  if (!options.loads.empty()) add(options.loads, true);
  if (all.names.empty())
    fail(ErrorCode::usage,
         "compare: no recording is given. Name a recording of joint angles or of sensors");
  return all;
}

std::string curve_words(const ComparedCurve& curve, double unit, const std::string& name) {
  std::string words = "  " + curve.name + ": " + text::brief(curve.mean / unit, 3) + name +
                      " on average, at most " + text::brief(curve.largest / unit, 3) + name +
                      " at " + text::fixed(curve.largest_at, 3) + " s";
  if (std::abs(curve.lag) >= 0.00005)  // a lag that would be printed as 0.0 ms is left out
    words += ". The recording is " + text::fixed(1000 * std::abs(curve.lag), 1) +
             (curve.lag > 0 ? " ms behind the run" : " ms ahead of the run");
  if (curve.unit != "rad" && curve.correlation != 0)
    words += ". The correlation is " + text::fixed(curve.correlation, 3);
  return words + "\n";
}

Json json_of(const ComparedCurve& curve) {
  return {{"name", curve.name},
          {"unit", curve.unit},
          {"mean", curve.mean},
          {"max", curve.largest},
          {"max_at_s", curve.largest_at},
          {"lag_s", curve.lag},
          {"correlation", curve.correlation}};
}

Json json_of(const std::vector<ComparedCurve>& curves) {
  Json list = Json::array();
  for (const ComparedCurve& curve : curves) list.push_back(json_of(curve));
  return list;
}

double largest_landing(const Comparison& found) {
  double largest = 0;
  for (const ComparedLanding& landing : found.landings)
    largest = std::max(largest, std::abs(landing.measured - landing.simulated));
  return largest;
}

std::string comparison_words(const Comparison& found, const Recordings& recordings) {
  std::string words =
      recordings.names + ": the recording begins " + text::fixed(std::abs(found.shift), 4) + " s " +
      (found.shift < 0 ? "before" : "after") +
      " the beginning of the run. Both are compared from " + text::fixed(found.begin, 3) + " to " +
      text::fixed(found.end, 3) + " s of the run\n";
  for (const std::string& note : found.notes) words += "  " + note + "\n";
  if (!found.joints.empty())
    words += "differences of the joints: " + text::fixed(found.mean_joint() / kComparedDegree, 4) +
             " deg on average, at most " + text::fixed(found.largest_joint() / kComparedDegree, 3) +
             " deg\n";
  for (const ComparedCurve& joint : found.joints)
    words += joint.unit == "rad" ? curve_words(joint, kComparedDegree, " deg")
                                 : curve_words(joint, 1, " m");
  if (!found.loads.empty()) words += "differences of the loads of the feet:\n";
  for (const ComparedCurve& load : found.loads)
    words += curve_words(load, 1, load.unit.empty() ? "" : " " + load.unit);
  if (!found.loads.empty()) {
    words += "landings: " + std::to_string(found.landings.size()) +
             " are in both the run and the recording, and their times differ by at most " +
             text::fixed(1000 * largest_landing(found), 0) + " ms. " +
             std::to_string(found.lone_landings.size()) +
             (found.lone_landings.size() == 1 ? " is" : " are") +
             " only in the run or only in the recording\n";
    for (const ComparedLanding& landing : found.landings) {
      const double later = landing.measured - landing.simulated;
      words += std::string("  ") + name_of(landing.foot) + " foot at " +
               text::fixed(landing.simulated, 3) + " s of the run, " +
               text::fixed(1000 * std::abs(later), 0) + (later < 0 ? " ms earlier" : " ms later") +
               " in the recording\n";
    }
    for (const LoneLanding& landing : found.lone_landings)
      words += std::string("  ") + name_of(landing.foot) + " foot at " + text::fixed(landing.t, 3) +
               " s of the run, only in the " + (landing.measured ? "recording" : "run") + "\n";
  }
  if (!found.imu.empty()) words += "differences of the IMU:\n";
  for (const ComparedCurve& curve : found.imu) words += curve_words(curve, 1, " " + curve.unit);
  return words;
}

Json comparison_json(const Comparison& found) {
  Json landings = Json::array();
  for (const ComparedLanding& landing : found.landings)
    landings.push_back({{"foot", name_of(landing.foot)},
                        {"simulated_s", landing.simulated},
                        {"measured_s", landing.measured}});
  Json alone = Json::array();
  for (const LoneLanding& landing : found.lone_landings)
    alone.push_back({{"foot", name_of(landing.foot)},
                     {landing.measured ? "measured_s" : "simulated_s", landing.t}});
  return {{"shift_s", found.shift},
          {"begin_s", found.begin},
          {"end_s", found.end},
          {"joint_mean_rad", found.mean_joint()},
          {"joint_max_rad", found.largest_joint()},
          {"joints", json_of(found.joints)},
          {"loads", json_of(found.loads)},
          {"landings", landings},
          {"landing_max_s", largest_landing(found)},
          {"landings_unmatched", found.lone_landings.size()},
          {"landings_alone", alone},
          {"imu", json_of(found.imu)},
          {"notes", found.notes}};
}

void write_comparison_report(const Context& context, const CompareCommand& options,
                             const RobotModel& model, const Comparison& found,
                             const Recordings& recordings, const SimulationLog& log) {
  const RunFolder run = read_run(options.run);
  ReportInput input = report_input(run, options.run);
  input.comparison = &found;
  // The page shows the recording as a ghost beside the run with which it was compared.
  SimulationLog measured;
  if (recordings.angles) {
    measured = measured_log(log, *recordings.angles, found.shift);
    input.runs.insert(input.runs.end() - 1, {"measured", &measured, true});
  }
  const Report made = make_report(model, input, {}, context.progress());
  write_file(options.report, made.html);
}

void compare_run(const Context& context, const CompareCommand& options) {
  for (const std::string& file : {options.plot, options.report})
    if (!file.empty()) refuse_overwriting(context, file);
  if (!options.report.empty() && !is_run_folder(options.run))
    fail(ErrorCode::usage, "--report needs a folder of `ayumi run` or `ayumi simulate`");
  const SimulationLog log = read_run_log(options.run, options.log);
  const RobotModel model =
      robot_of_log(context, options.robot, log, options.run, {.meshes = !options.report.empty()});
  const Recordings recordings = read_recordings(options, model);
  CompareOptions how;
  how.shift = options.shift;
  if (!options.window.empty()) {
    if (options.window.size() != 2 || !(options.window[1] > options.window[0]))
      fail(ErrorCode::usage, "--window: give two times, the second after the first");
    how.begin = options.window[0];
    how.end = options.window[1];
  }
  const Comparison found =
      compare(model, log, recordings.angles, recordings.sensors, how, recordings.names);
  if (!options.plot.empty())
    write_comparison_plot(found,
                          fs::path(recordings.names).filename().string() + " and " +
                              fs::path(options.run).filename().string(),
                          options.plot);
  if (!options.report.empty())
    write_comparison_report(context, options, model, found, recordings, log);
  context.print(comparison_words(found, recordings));
  context.print_json(comparison_json(found).dump(2));
}

}  // namespace

void add_compare(Command& app, Context& context) {
  Command* command =
      app.add_subcommand("compare", "compare recordings of the robot with a simulated run");
  command->footer(
      "Examples:\n  ayumi compare out/ encoders.csv\n"
      "  ayumi compare out/ encoders.csv sensors.csv --window 9,17 --plot both.svg --json");
  static CompareCommand options;
  static std::string unit = "rad";
  command->add_option("RUN", options.run, "Folder that `run` or `simulate` wrote, or a log file.")
      ->required();
  command
      ->add_option("MEASURED", options.measured,
                   "Recordings of joint angles (HOAP counts, or columns with names), of load cells "
                   "and of the IMU.")
      ->type_name("F");
  command
      ->add_option("--loads", options.loads,
                   "Recording of the load cells and the IMU. Use this option if Ayumi does not "
                   "recognize the file as such a recording.")
      ->type_name("F");
  command
      ->add_option("--log", options.log,
                   "Log of the run: open_loop, closed_loop, undisturbed (default: closed_loop, or "
                   "the only log of the run).")
      ->type_name("NAME");
  command->add_option("--robot", options.robot,
                      "Robot to use in place of the robot that the run names.");
  command
      ->add_option("--shift", options.shift,
                   "Time of the run at which the recording begins [s] (default: found from the "
                   "joint angles).")
      ->type_name("S");
  command->add_option("--window", options.window, "Compare only from T1 to T2 of the run [s].")
      ->delimiter(',')
      ->type_name("T1,T2");
  command
      ->add_option("--plot", options.plot,
                   "Draw the run and the recordings over time (.svg or .png).")
      ->type_name("F");
  command
      ->add_option("--report", options.report,
                   "Write a report of the run that shows this comparison, with the recording as a "
                   "ghost (.html).")
      ->type_name("F");
  command
      ->add_option(
          "--measured-at", options.at,
          "What measured the angles. encoder: the encoders of the servos. Ayumi adds to their "
          "readings the offsets that the robot's file states. joint: instruments at the joints.")
      ->check(one_of({"encoder", "joint"}))
      ->capture_default_str();
  command->add_option("--unit", unit, "Unit of the joint columns whose names do not state a unit.")
      ->check(one_of({"rad", "deg"}))
      ->capture_default_str();
  command
      ->add_option("--rate", options.reading.rate,
                   "Rows per second of a recording without a time column [1/s] (default: 1000).")
      ->check(number_within(kRecordingRate))
      ->type_name("HZ");
  command->callback([&context] {
    options.reading.degrees = unit == "deg";
    options.reading.measured_at = measured_at(options.at);
    compare_run(context, options);
  });
}

}  // namespace ayumi::app
