#pragma once
// Writes a generated pattern. Every generator of `ayumi new` ends with this.

#include "pattern_input.hpp"

namespace ayumi::app {

/// Samples the motion, and then writes it as `out`, so that no unusable file is made. Returns
/// whether the check finds the pattern consistent, and prints its findings.
bool write_new_pattern(const Context& context, const RobotModel& model, Pattern pattern,
                       const std::string& robot, const std::string& out,
                       const std::vector<std::string>& comments);

/// The subcommand `jump` of `ayumi new`.
void add_new_jump(Command& command, Context& context);

}  // namespace ayumi::app
