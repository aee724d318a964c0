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
  std::string robot_name;     ///< as the user names it: bundled, or a path from the working folder
  std::string profile;        ///< name of the actuator profile
  double tick = 0.001;        ///< servo period of the robot [s]
  CommandSeries series;       ///< the pattern, sampled at `tick`
  TableCaution caution = {};  ///< of the run that the pattern's own table is from
  int threads = 0;            ///< of sampling and of the check; 0: all cores
};

/// The pattern at the servo period of the robot. Throws as sample().
CommandSeries sample_at_servo_period(const RobotModel& robot, const Pattern& pattern,
                                     const Progress& progress = {}, int threads = 0);

/// Samples the pattern at the servo period of the robot. `profile` empty: that of the pattern, else
/// the robot's default. Throws Error(bad_pattern), naming file and place, for a disturbance on a
/// link or joint that the robot does not have, for an unknown gain or tolerance, and as sample();
/// Error(bad_model) for an unknown profile.
Task make_task(Pattern pattern, RobotModel robot, const std::string& profile = "",
               const Progress& progress = {}, int threads = 0);

/// Friction and tolerances of the pattern, the profile and the threads of the task.
CheckOptions check_options(const Task& task);

/// Controller, world and disturbances of the pattern, the profile of the task.
SimulateOptions simulate_options(const Task& task);

/// The profile of the task, an approach ramp and a hold of default length.
SafetyOptions safety_options(const Task& task);

/// Robot, pattern and profile with their SHA-256, for the head of all results of the task.
/// `controller` is the name of the control law.
Provenance provenance(const Task& task, const std::string& controller,
                      const std::string& command_line = "");

/// The verdict on the pattern: that of check_consistency(), and whether the actuators suffice for
/// the goals of VIIP as well.
Judgement judge(const Task& task, const CheckOptions& options);
Judgement judge(const Task& task);

/// Runs the task; the log names robot, pattern and controller. Throws as the other simulate().
SimulationLog simulate(const Task& task, const SimulateOptions& options,
                       const Progress& progress = {}, const std::string& command_line = "");

/// Why a table of a run is not for a robot: the pattern is inconsistent (`inconsistent` says why
/// and is empty otherwise), or the run fell or did not settle. Where the run was disturbed,
/// `undisturbed` may be the same run without disturbances; the reasons then name the run that they
/// are from. Empty if there is no such reason.
std::vector<std::string> unfit_reasons(const std::string& inconsistent, const SimulationLog& log,
                                       const SimulationLog* undisturbed = nullptr);
std::vector<std::string> unfit_reasons(const Judgement& judgement, const SimulationLog& log);

/// Why the table of a pattern with goals of VIIP, or with a table from a run with disturbances, is
/// refused by `export`, in the words of its messages.
std::string refusal_of_goals();
std::string refusal_of_disturbances(const std::string& disturbances);

/// Why `export` refuses the pattern's own table for the profile of the task: it is inconsistent
/// (`judgement` is its own), or it is from a run that no robot should repeat, or has no table yet.
/// Empty: the table is accepted.
std::vector<std::string> export_refusals(const Task& task, const Judgement& judgement);

}  // namespace ayumi
