#pragma once
// Writing a generated pattern: what every generator of `ayumi new` ends with.

#include "pattern_input.hpp"

namespace ayumi::app {

/// Samples the motion, then writes it as `out`: a file that cannot be used is not made. Returns
/// whether the check finds the pattern consistent, and prints what it finds.
bool write_new_pattern(const Context& context, const RobotModel& model, Pattern pattern,
                       const std::string& robot, const std::string& out,
                       const std::vector<std::string>& comments);

/// The subcommand `jump` of `ayumi new`.
void add_new_jump(Command& command, Context& context);

}  // namespace ayumi::app
