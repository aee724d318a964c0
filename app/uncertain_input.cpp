#include "uncertain_input.hpp"

#include "ayumi/base/error.hpp"
#include "ayumi/io/pattern/assumed_study.hpp"

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
  if (standard.empty()) return assumed_study(input.robot);
  return read_study(standard);
}

}  // namespace ayumi::app
