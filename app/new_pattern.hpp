#pragma once
// Writes a generated pattern. Every generator of `ayumi new` ends with this.

#include "pattern_input.hpp"

namespace ayumi::app {

/// The options that all generators share.
struct NewFile {
  std::string robot = "hoap1", out;
  bool allow_inconsistent = false;  ///< whether a pattern with errors is written
};

/// Adds --robot, --out and --allow-inconsistent.
void add_new_file(Command& command, NewFile& file);

/// Samples and checks the motion, and then writes it, so that no unusable file is made. If the
/// check finds errors, prints them, writes nothing and sets the exit code 1, unless the user allows
/// an inconsistent pattern. Returns whether the check finds the pattern consistent.
bool write_new_pattern(Context& context, const RobotModel& model, Pattern pattern,
                       const NewFile& file, const std::vector<std::string>& comments);

/// The subcommand `jump` of `ayumi new`.
void add_new_jump(Command& command, Context& context);

}  // namespace ayumi::app
