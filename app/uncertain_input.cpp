#include "uncertain_input.hpp"

#include "ayumi/base/error.hpp"

namespace ayumi::app {

Study load_study(const Task& input, const std::string& file) {
  if (!file.empty()) {
    Study study = read_study(file);
    if (study.uncertainty.empty())
      fail(ErrorCode::bad_pattern,
           file + ": the study has no uncertainty; add \"uncertainty\" to it");
    return study;
  }
  if (!input.pattern.uncertainty.empty())
    return {.name = input.pattern.name,
            .file = input.pattern.file,
            .sha256 = input.pattern.sha256,
            .uncertainty = input.pattern.uncertainty};
  const std::filesystem::path standard = default_study(input.robot);
  if (standard.empty())
    fail(ErrorCode::bad_pattern,
         input.robot.name() +
             " has no uncertainty.json beside its sidecar, and the pattern has no \"uncertainty\"; "
             "write a study file and name it with --study");
  return read_study(standard);
}

}  // namespace ayumi::app
