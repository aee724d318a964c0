#pragma once
// The bodies of a model in the form that the kernels take.

#include <vector>

#include "ayumi/dynamics/kernels/tree_kernels.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// One link per body, parents first.
std::vector<kernels::Link> tree_links(const RobotModel& model);

}  // namespace ayumi
