#pragma once
// The input of a report from the folder of a run.

#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/report/report.hpp"

namespace ayumi::app {

/// The logs of the run, open loop first, and the verdicts of `run`. `run` must outlive the result.
/// Throws Error(bad_file) that names `file` if the run has no log.
ReportInput report_input(const RunFolder& run, const std::string& file);

}  // namespace ayumi::app
