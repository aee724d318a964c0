#pragma once
// The sections of a report that consist of text and tables.

#include <string>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/report/report.hpp"

namespace ayumi::html {

std::string verdict_section(const ReportInput& input);
/// The findings of the check; empty if there is no check.
std::string findings_section(const RobotModel& model, const ReportInput& input);
std::string thresholds_section(const ReportInput& input);  ///< empty if there is no study
std::string comparison_section(const ReportInput& input);  ///< empty if there is no recording
std::string events_section(const ReportInput& input);
std::string provenance_section(const RobotModel& model, const ReportInput& input,
                               const std::vector<std::string>& caps);

/// The name of a run with its controller, such as "closed loop (dtad)".
std::string name_of(const ReportRun& run);

}  // namespace ayumi::html
