#pragma once
// The uncertainty of a pattern on the command line. It is the first of these that exists: that of
// --study, that of the pattern, the default one of its robot, the one that is assumed for any
// robot.

#include <string>

#include "ayumi/io/pattern/study_file.hpp"
#include "ayumi/task/task.hpp"

namespace ayumi::app {

/// `file` is the argument of --study, or "" if it was not given. Throws the same errors as
/// read_study(), and Error(bad_pattern) if the file has no uncertainty.
Study load_study(const Task& input, const std::string& file);

/// If the user `stated` quantities that the plant of this name does not use for this robot, throws
/// Error(bad_pattern). Such quantities of a default uncertainty are left out, and the returned line
/// says so; it is empty if nothing is left out.
std::string fit_to_plant(Study& study, const RobotModel& robot, const std::string& plant,
                         bool stated);

}  // namespace ayumi::app
