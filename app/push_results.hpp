#pragma once
// Push thresholds as JSON: the output of --json, and the results file with which a stopped study is
// continued.

#include <filesystem>
#include <nlohmann/json.hpp>

#include "ayumi/study/push.hpp"

namespace ayumi::app {

/// The thresholds, one for each case and controller, in the order of the cases.
nlohmann::ordered_json thresholds_json(const std::vector<PushCase>& cases,
                                       const std::vector<ControllerSpec>& controllers);

/// Figures by controller, for walking and standing.
nlohmann::ordered_json summaries_json(const std::vector<PushCase>& cases,
                                      const PushOptions& options);

/// The finished cases of a study. `study` describes the task; a study can only be continued with
/// the same task.
std::string results_text(const nlohmann::ordered_json& study, const KnownCases& cases);

/// The cases of an earlier file; empty if there is none. Throws Error(bad_file) if the file is not
/// a results file or belongs to another study.
KnownCases read_results(const std::filesystem::path& file, const nlohmann::ordered_json& study,
                        size_t count);

}  // namespace ayumi::app
