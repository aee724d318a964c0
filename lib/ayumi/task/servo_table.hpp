#pragma once
// Tables of servo targets, made for the servos of a profile. A table has one of three contents: the
// plain posture, the posture ahead by the lag of the servo (motion/servo_feedforward), or this
// posture with an additional offset that compensates for the servo's sag under the torque of the
// motion (control/torque_feedforward).

#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/motion/reference_trajectory.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

enum class ServoContent { ideal, lead, lead_and_sag };
/// The name of the content: "ideal", "lead" or "lead+sag".
std::string name_of(ServoContent content);
/// The content with this name. Throws Error(usage) for an unknown name.
ServoContent servo_content(const std::string& name);

/// What a table says about the servo that it was made for.
TableServo table_servo(const RobotModel& model, const std::string& profile, ServoContent content);

/// The pattern as it is, one row per sample.
ReferenceTrajectory table_of_series(const RobotModel& model, const std::string& profile,
                                    const CommandSeries& series, ServoContent content);

/// Appends the row of one sample for table_of_postures(). Until then, the row has the reference
/// posture in place of the target.
void append_posture(const SimulationSample& sample, ReferenceTrajectory& postures);

/// The table of the postures of a run, ahead by the lag of the servos of the profile, as
/// table_of_log() with `lead` makes it. `about` is the log of the run, whose samples are not
/// needed.
ReferenceTrajectory table_of_postures(const RobotModel& model, const std::string& profile,
                                      const SimulationLog& about, ReferenceTrajectory postures);

/// The table of the reference posture of a run. Its rates are differences of neighbouring samples.
/// With the sag and the profile of the run, these are the targets that the servos received in the
/// run.
ReferenceTrajectory table_of_log(const RobotModel& model, const std::string& profile,
                                 const SimulationLog& log, ServoContent content);

}  // namespace ayumi
