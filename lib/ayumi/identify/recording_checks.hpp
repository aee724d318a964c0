#pragma once
// Checks whether a recording can be the response to a command.

#include <string>
#include <vector>

#include "ayumi/identify/recorded_motion.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// Range of a command below which its joint stands still [rad, m].
double least_motion();

/// The joints of both tables whose command moves; those that move most come first.
std::vector<Eigen::Index> moving_joints(const AngleTable& command, const AngleTable& measured);

/// The time by which `measured` is behind `command` [s], from the joints that move most, within
/// -`reach`..`reach`, in steps of the slower of both.
double time_shift(const RobotModel& model, const AngleTable& command, const AngleTable& measured,
                  double reach);

/// Complaints about the joints of `measured`, which is `shift` [s] behind, from `begin` to `end` of
/// the command's time: joints that are exchanged, another sign or unit, or a joint that does not
/// follow. Each complaint is one line.
std::vector<std::string> motion_complaints(const RobotModel& model, const AngleTable& command,
                                           const AngleTable& measured, double shift, double begin,
                                           double end);

/// Throws Error(bad_file) "`file`: what" for the first of these complaints. It also throws if the
/// length of `measured` is not that of the command, or if `measured` comes earlier or later than
/// `longest_lag` [s], has lost or repeated rows (lost_rows()), or has no joint that moves.
void require_answer(const RobotModel& model, const AngleTable& command, const AngleTable& measured,
                    double longest_lag, const std::string& file);

/// Throws Error(bad_file) "`file`: what" for load cells that were not recorded with `measured`: the
/// number of rows is different, or a foot that stands by the angles does not carry the robot.
/// `agreement` is that of JointLoads.
void require_loads(const SensorTable& loads, const AngleTable& measured, double agreement,
                   const std::string& file);

}  // namespace ayumi
