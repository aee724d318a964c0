#pragma once
// Bundled robots that walk two steps or jump. Properties of any robot and motion are tested on
// each.

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi::test {

struct RobotMotion {
  std::string robot, motion;
};

inline auto robot_motions() {
  return testing::Values(RobotMotion{"hoap1", "walk"}, RobotMotion{"humanoid30", "walk"},
                         RobotMotion{"hoap1", "jump"}, RobotMotion{"humanoid30", "jump"});
}

inline std::string name_of_case(const testing::TestParamInfo<RobotMotion>& info) {
  return info.param.robot + "_" + info.param.motion;
}

/// A bundled robot, which is read once.
inline const RobotModel& bundled_robot(const std::string& name) {
  static std::map<std::string, RobotModel> robots;
  const auto found = robots.find(name);
  if (found != robots.end()) return found->second;
  return robots.emplace(name, load_robot(AYUMI_SOURCE_DIR "/robots/" + name)).first->second;
}

inline Pattern pattern_of(const RobotMotion& wanted) {
  const RobotModel& model = bundled_robot(wanted.robot);
  if (wanted.motion == "jump") return jump_pattern(model, jump_defaults(model));
  WalkParameters steps = walk_defaults(model);
  steps.steps = 2;
  return walk_pattern(model, steps);
}

}  // namespace ayumi::test
