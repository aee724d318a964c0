#pragma once
// HOAP-1 as most tests use it: its file is read once.

#include "ayumi/io/robot/robot_file.hpp"

namespace ayumi::test {

inline const RobotModel& hoap1() {
  static const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  return model;
}

}  // namespace ayumi::test
