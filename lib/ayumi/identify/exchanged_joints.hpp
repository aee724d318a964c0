#pragma once
// Finds joints whose measured angles are in each other's columns.

#include <string>
#include <vector>

#include "ayumi/identify/recorded_motion.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Groups of joints whose measured angles are exchanged: the measured angle of each joint follows
/// the command of the next one in the group (the last one follows the first) far better than its
/// own command. The zero and the sign of an angle do not count when it is compared with its own
/// command, but they do when it is compared with another one. So an exchange is not seen if two
/// joints have nearly the same command, or if the zero of one of them is far off. `measured`
/// is behind `command` by some time between `soonest` and `latest` [s]; only times of the command
/// from `begin` to `end` count.
std::vector<std::vector<Eigen::Index>> exchanged_joints(const RobotModel& model,
                                                        const AngleTable& command,
                                                        const AngleTable& measured, double soonest,
                                                        double latest, double begin, double end);

/// The group in words: one line.
std::string exchange_words(const RobotModel& model, const std::vector<Eigen::Index>& group);

}  // namespace ayumi
