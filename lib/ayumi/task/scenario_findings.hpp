#pragma once
// Says what the check leaves out of the verdict because it is a disturbance, and what the check
// would find with it.

#include <string>
#include <vector>

#include "ayumi/task/task.hpp"

namespace ayumi {

/// A sentence for each change of friction in the scenario. `plain` is the report without them.
std::vector<std::string> findings_under_scenario(const Task& task, const CheckOptions& options,
                                                 const ConsistencyReport& plain);

}  // namespace ayumi
