#pragma once
// Study files ("ayumi.study/1"): the uncertainty under which a pattern is certified. The same
// object may stand in a pattern. docs/formats.md is the specification.

#include <filesystem>
#include <string>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/uncertainty.hpp"

namespace ayumi {

struct Study {
  std::string name;
  std::string file;    ///< file from which it was read, for messages
  std::string sha256;  ///< hash of its bytes
  Uncertainty uncertainty;
};

/// Reads strictly, as read_pattern() does. Throws Error(bad_pattern) "file: /json/pointer: what,
/// what to do", and Error(bad_file) if the file cannot be read.
Study read_study(const std::filesystem::path& path);
/// Reads the bytes of a study file in the same way; `path` names it in messages.
Study study_of_text(const std::string& text, const std::filesystem::path& path);

/// The default uncertainty of a robot, the file `uncertainty.json` beside its sidecar; empty if
/// there is none.
std::filesystem::path default_study(const RobotModel& robot);

}  // namespace ayumi
