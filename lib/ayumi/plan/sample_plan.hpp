#pragma once
// What a pattern plans, without the motion that follows the plan.

#include "ayumi/plan/sample.hpp"

namespace ayumi {

/// The plan of a pattern alone: its contacts, the planned feet, COG, ZMP and f_z, by the pendulum
/// law where no keys give the COG. The legs keep the default posture, which is carried along with
/// the COG, even if the feet should be elsewhere. A motion that has to be generated can start from
/// this plan. Keys and table columns of leg joints are left out. Throws as sample(), but never
/// because a foot is out of reach.
CommandSeries sample_plan(const RobotModel& model, const Pattern& pattern,
                          const SampleOptions& options = {}, const Progress& progress = {});

}  // namespace ayumi
