#pragma once
// A model's bodies as the kernels take them.

#include <vector>

#include "ayumi/dynamics/kernels/tree_kernels.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// One per body, parents first.
std::vector<kernels::Link> tree_links(const RobotModel& model);

}  // namespace ayumi
