#pragma once
// The goal of VIIP that moves the COG at a velocity while both feet stay, ref v_G of section 4.1 of
// the paper: a StepGoal without steps.

#include "ayumi/motion/viip_goal.hpp"

namespace ayumi {

/// StepGoal::steps of a goal without steps. Definition: no count of steps is negative.
inline constexpr int kNoSteps = -1;

/// Whether both feet stay. The COG starts from the place that the goals before ask for, and stops
/// where the phase ends; `turn` is not used.
inline bool feet_stay(const StepGoal& goal) { return goal.steps == kNoSteps; }

}  // namespace ayumi
