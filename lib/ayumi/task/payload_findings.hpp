#pragma once
// The effect of the scenario's payloads on the verdict. Unlike a push, a payload is known to the
// author, so the motion has to allow for it: while a payload is carried, the motion is judged for
// the robot with the mass of the payload.

#include <string>
#include <vector>

#include "ayumi/check/likely_mistakes.hpp"
#include "ayumi/task/task.hpp"

namespace ayumi {

/// Adds to the report of the motion alone the errors that come with payloads. Each says in `where`
/// what is carried, and in `hint` how heavy it may be. Returns the payloads that are too heavy,
/// with the same words.
std::vector<Mistake> judge_payloads(const Task& task, const CheckOptions& options,
                                    ConsistencyReport& report);

/// Does the same as judge() of task.hpp. It also returns the payloads that are too heavy, if they
/// are wanted.
Judgement judge(const Task& task, const CheckOptions& options, std::vector<Mistake>* payloads);

}  // namespace ayumi
