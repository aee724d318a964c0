#pragma once
// A task from files: the pattern by its file, and the robot that the pattern names.

#include <filesystem>
#include <map>
#include <string>

#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/task/task.hpp"

namespace ayumi {

struct TaskOptions {
  std::map<std::string, double> set = {};  ///< values of parameters that the pattern declares
  std::string profile = {};                ///< actuator profile; "" for that of the pattern
  std::string robot = {};                  ///< replaces the robot that the pattern names
  RobotSearch robots = {};                 ///< folders in which robots are searched by name
  bool meshes = false;                     ///< whether to load what only pictures need
  int threads = 0;  ///< number of threads for sampling and the check; 0 for all cores
};

/// Throws the same errors as read_pattern(), load_robot() and make_task().
Task load_task(const std::filesystem::path& pattern, const TaskOptions& options = {},
               const Progress& progress = {});

/// Makes the task of a pattern that has been read already.
Task load_task(Pattern pattern, const TaskOptions& options = {}, const Progress& progress = {});

/// A robot with the name by which it was loaded.
struct NamedRobot {
  RobotModel model;
  std::string name;
};

/// Makes the task with a robot that has been loaded already, whatever robot the pattern names.
Task load_task(Pattern pattern, NamedRobot robot, const std::string& profile,
               const Progress& progress = {}, int threads = 0);

}  // namespace ayumi
