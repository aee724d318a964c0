#pragma once
// A task is one pattern for one robot, with the actuator profile that it is judged by. The options
// of the check, of the simulation and of the export of a table follow from the task in one place,
// so that every program judges a pattern by the same friction, tolerances, profile and servo
// period.

#include <map>
#include <string>

#include "ayumi/base/progress.hpp"
#include "ayumi/check/judge.hpp"
#include "ayumi/limits/table_safety.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/motion/pattern.hpp"
#include "ayumi/motion/table_caution.hpp"
#include "ayumi/sim/simulate.hpp"

namespace ayumi {

struct Task {
  Pattern pattern;
  RobotModel robot;
  /// Name that the user gave: a bundled robot, or a path from the working folder.
  std::string robot_name;
  std::string profile;        ///< name of the actuator profile
  double tick = 0.001;        ///< servo period of the robot [s]
  CommandSeries series;       ///< the pattern, sampled at `tick`
  TableCaution caution = {};  ///< warnings about the run that the pattern's own table is from
  int threads = 0;            ///< number of threads for sampling and for the check; 0 for all cores
};

/// Samples the pattern at the servo period of the robot. Throws the same errors as sample().
CommandSeries sample_at_servo_period(const RobotModel& robot, const Pattern& pattern,
                                     const Progress& progress = {}, int threads = 0);

/// Samples the pattern at the servo period of the robot. If `profile` is empty, the profile is that
/// of the pattern, or else the robot's default. Throws Error(bad_pattern) with file and place for a
/// disturbance on a link or joint that the robot does not have, for an unknown gain or tolerance,
/// and in the same cases as sample(); throws Error(bad_model) for an unknown profile.
Task make_task(Pattern pattern, RobotModel robot, const std::string& profile = "",
               const Progress& progress = {}, int threads = 0);

/// The options with friction and tolerances of the pattern, and with the profile and the threads of
/// the task.
CheckOptions check_options(const Task& task);

/// The options with controller, world and disturbances of the pattern, and with the profile of the
/// task.
SimulateOptions simulate_options(const Task& task);

/// The options with the profile of the task, an approach ramp, and a hold of default length.
SafetyOptions safety_options(const Task& task);

/// Robot, pattern and profile with their SHA-256, for the head of all results of the task.
/// `controller` is the name of the control law.
Provenance provenance(const Task& task, const std::string& controller,
                      const std::string& command_line = "");

/// The verdict on the pattern: that of check_consistency(), and whether the actuators suffice for
/// the goals of VIIP as well. `observe` is called with the samples of the task.
Judgement judge(const Task& task, const CheckOptions& options, const SampleObserver& observe = {});
Judgement judge(const Task& task);

/// Runs the task. The log names robot, pattern and controller. Throws the same errors as the other
/// simulate().
SimulationLog simulate(const Task& task, const SimulateOptions& options,
                       const Progress& progress = {}, const std::string& command_line = "");

/// The reasons why no robot should receive the table of a run: the pattern is inconsistent
/// (`inconsistent` says why and is empty otherwise), or the run fell or did not settle. If the run
/// was disturbed, `undisturbed` may be the same run without disturbances; the reasons then say
/// which of the two runs they are from. The list is empty if there is no such reason.
std::vector<std::string> unfit_reasons(const std::string& inconsistent, const SimulationLog& log,
                                       const SimulationLog* undisturbed = nullptr);
std::vector<std::string> unfit_reasons(const Judgement& judgement, const SimulationLog& log);

/// The reason why `export` refuses the table of a pattern with goals of VIIP, or with a table from
/// a run with disturbances, in the words of its messages.
std::string refusal_of_goals();
std::string refusal_of_disturbances(const std::string& disturbances);

/// The reasons why `export` refuses the pattern's own table for the profile of the task: the
/// pattern is inconsistent (`judgement` is its verdict), or the table is from a run that no robot
/// should repeat, or there is no table yet. If the list is empty, the table is accepted.
std::vector<std::string> export_refusals(const Task& task, const Judgement& judgement);

}  // namespace ayumi
