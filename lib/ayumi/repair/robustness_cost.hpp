#pragma once
// What a motion lacks of the safety that a repair of another one buys: the ZMP as far inside as it
// is wanted, soles in their places closer than the check asks for, feet off the ground and low
// only over their places, bodies apart, joints within their limits, xi and ZMP where the plan has
// them. By the rows of the repair's own program at its instants, each limit's largest lack in a
// short window at its price.

#include "ayumi/repair/repair.hpp"

namespace ayumi {

/// In the measure of weighted_change() [s], where `after` differs from `before`; 0 for motions of
/// different length. options.safety is a factor on all but the places of the feet; `check` is the
/// report of `before`.
double safety_price(const RobotModel& model, const CommandSeries& before,
                    const CommandSeries& after, const RepairOptions& options,
                    const ConsistencyReport& check);

}  // namespace ayumi
