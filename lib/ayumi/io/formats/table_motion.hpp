#pragma once
// Tables with a head row. They have a time t[s] (or t, time, time_ms), joints as theta.<joint>[rad]
// or by their names (with or without a unit, as in r_knee[deg]), and whole groups of cog, zmp, fz,
// base and contact columns, as Ayumi's own tables have. The same content may be JSON with "columns"
// and "data".

#include "ayumi/io/formats/motion_file.hpp"
#include "ayumi/motion/reference_trajectory.hpp"

namespace ayumi {

std::string recognize_csv_table(const MotionInput& source);
MotionFile read_csv_table(const MotionInput& source);
std::string recognize_json_table(const MotionInput& source);
MotionFile read_json_table(const MotionInput& source);

/// The rows of a joint table, with the times that they have there.
MotionFile motion_of_table(const ReferenceTrajectory& table);

}  // namespace ayumi
