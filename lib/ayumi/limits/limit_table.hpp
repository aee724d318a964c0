#pragma once
// The table of limits. It has one line for every kind of finding, in the order in which people read
// them (`check --tolerances`, docs/cli.md). A line has the name of the kind in JSON files, option
// values and texts, and the limit that defines it in the file limits/LIMIT.cpp. A new limit is such
// a file and its line here: the enum FindingKind, the names, and all visitors (check, repair,
// report, export) follow.

// clang-format off
#define AYUMI_FINDING_KINDS(line)               \
  line(cog_residual, command_agreement)         \
  line(zmp_residual, command_agreement)         \
  line(fz_residual, command_agreement)          \
  line(point_mass_gap, command_agreement)       \
  line(support_margin, support)                 \
  line(friction, friction)                      \
  line(unilateral, normal_force)                \
  line(yaw_moment, torsion)                     \
  line(ballistic, free_fall)                    \
  line(angular_momentum, angular_momentum)      \
  line(foot_slip, stance)                       \
  line(foot_penetration, stance)                \
  line(foot_float, stance)                      \
  line(foot_scrape, foot_scrape)                \
  line(contact_ends_early, contact_timing)      \
  line(joint_position, joint_position)          \
  line(joint_speed, joint_speed)                \
  line(joint_acceleration, joint_acceleration)  \
  line(motor_acceleration, motor_acceleration)  \
  line(joint_torque, joint_torque)              \
  line(continuous_torque, heat)                 \
  line(servo_step, servo_step)                  \
  line(table_step, exported_table)              \
  line(table_position, exported_table)          \
  line(table_rest, exported_table)              \
  line(self_collision, clearance)               \
  line(landing_speed, swing_foot)
// clang-format on
