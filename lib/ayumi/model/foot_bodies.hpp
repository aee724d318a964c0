#pragma once
// Which bodies of a robot belong to its feet.

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Whether a body is a foot, or is carried by one, like a toe. The sole stands for the contacts of
/// all these bodies with the ground. If a foot is the root link, the links that it carries do not
/// belong to it.
bool is_of_foot(const RobotModel& model, int body);

}  // namespace ayumi
