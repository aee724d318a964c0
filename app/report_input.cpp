#include "report_input.hpp"

#include <algorithm>
#include <filesystem>

#include "ayumi/base/error.hpp"
#include "libraries.hpp"

namespace ayumi::app {

ReportInput report_input(const RunFolder& run, const std::string& file) {
  ReportInput input;
  input.title = std::filesystem::path(run.provenance.pattern).stem().string();
  for (const auto& [name, log] : run.logs) {
    if (name == "undisturbed") continue;  // the page only shows the runs under the scenario
    std::string label = name;
    std::replace(label.begin(), label.end(), '_', ' ');
    input.runs.push_back({label, &log});
  }
  if (input.runs.empty()) fail(ErrorCode::bad_file, {file}, "the run contains no simulation log");
  std::stable_partition(input.runs.begin(), input.runs.end(), [](const ReportRun& entry) {
    return entry.log->controller == ControllerKind::none;
  });
  input.libraries = library_versions();
  input.results = read_results(run, file);
  return input;
}

}  // namespace ayumi::app
