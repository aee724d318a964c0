#pragma once
// `ayumi export` for people who study a run: it writes the whole log as a file that other programs
// open.

#include "commands.hpp"

namespace ayumi::app {

struct LogExport {
  std::string input;   ///< run folder or log file
  std::string format;  ///< one of log_formats()
  std::string output;
  std::string log;    ///< name of the log; "" for closed_loop, or for the only log
  std::string robot;  ///< the robot; "" for the one that the run names
};

/// The formats: "csv-log", "npz", "mcap".
const std::vector<std::string>& log_formats();
bool is_log_format(const std::string& format);

/// Throws Error(usage) if `command` was given an option about joint tables, or if the output does
/// not have the extension of its format. Throws Error(bad_file) if the input is not a run or a log.
void export_log(const LogExport& options, const Command& command, Context& context);

/// Throws Error(bad_file) if a joint table is requested and `input` is a log file.
void refuse_log_file(const std::string& input);

}  // namespace ayumi::app
