#pragma once
// `ayumi export` for people who study a run: its whole log as a file that other programs open.

#include "commands.hpp"

namespace ayumi::app {

struct LogExport {
  std::string input;   ///< run folder or log file
  std::string format;  ///< one of log_formats()
  std::string output;
  std::string log;    ///< "" = closed_loop, or the only one
  std::string robot;  ///< "" = the one that the run names
};

/// "csv-log", "npz", "mcap"
const std::vector<std::string>& log_formats();
bool is_log_format(const std::string& format);

/// Throws Error(usage) where `command` was given an option that is about joint tables, or the
/// output has another extension than that of its format; Error(bad_file) for anything but a run or
/// a log.
void export_log(const LogExport& options, const Command& command, Context& context);

/// Throws Error(bad_file) where a joint table is asked for and `input` is a log file.
void refuse_log_file(const std::string& input);

}  // namespace ayumi::app
