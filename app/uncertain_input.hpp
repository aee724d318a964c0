#pragma once
// The uncertainty of a pattern on the command line: that of --study, else that of the pattern, else
// the default one of its robot, else the one that is assumed of any robot.

#include <string>

#include "ayumi/io/pattern/study_file.hpp"
#include "ayumi/task/task.hpp"

namespace ayumi::app {

/// `file` is the argument of --study, "" where it was not given. Throws as read_study(), and
/// Error(bad_pattern) where the file has no uncertainty.
Study load_study(const Task& input, const std::string& file);

/// Quantities that the plant of that name does not use are an error where the user `stated` them:
/// Error(bad_pattern). Of a default uncertainty they are left out, and the answer says so in one
/// line; it is empty where nothing is left out.
std::string fit_to_plant(Study& study, const std::string& plant, bool stated);

}  // namespace ayumi::app
