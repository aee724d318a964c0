#pragma once
// The quantities of a sample of a log in file order: names, units and values of their columns.

#include <string>
#include <vector>

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

// Calls visit(name, field) for every field of a sample, in file order. Column names, writing and
// reading all use this list.
template <typename Sample, typename Visit>
void for_each_field(Sample& s, const Visit& visit) {
  visit("base", "m", s.state.base);
  visit("base.v", "m/s", s.state.base_velocity);
  visit("base.w", "rad/s", s.state.base_angular_velocity);
  visit("theta", "rad", s.state.theta);
  visit("dtheta", "rad/s", s.state.dtheta);
  visit("target", "rad", s.target);
  visit("torque", "N m", s.torque);
  visit("ref.base", "m", s.reference_base);
  visit("ref.theta", "rad", s.reference_theta);
  visit("cog", "m", s.cog);
  visit("dcog", "m/s", s.dcog);
  visit("zmp", "m", s.zmp);
  visit("fz", "N", s.fz);
  visit("measured.cog", "m", s.measured_cog);
  visit("measured.zmp", "m", s.measured_zmp);
  visit("measured.fz", "N", s.measured_fz);
  visit("cmd.base", "m", s.command_base);
  visit("cmd.theta", "rad", s.command_theta);
  visit("cmd.cog", "m", s.command_cog);
  visit("cmd.zmp", "m", s.command_zmp);
  visit("cmd.fz", "N", s.command_fz);
  visit("ref.cog", "m", s.reference_cog);
  visit("ref.zmp", "m", s.reference_zmp);
  visit("ref.fz", "N", s.reference_fz);
  visit("measured.dcog", "m/s", s.measured_dcog);
  visit("cmd.dcog", "m/s", s.command_dcog);
  visit("ref.dcog", "m/s", s.reference_dcog);
  visit("ref.ddcog", "m/s^2", s.reference_ddcog);
  visit("ref.dtheta", "rad/s", s.reference_dtheta);
  visit("law.stage", "1", s.law.stage);
  visit("law.planned_zmp", "m", s.law.planned_zmp);
  visit("law.wanted_zmp", "m", s.law.wanted_zmp);
  visit("law.filtered_zmp", "m", s.law.filtered_zmp);
  visit("law.offset", "m", s.law.offset);
  visit("law.K", "1", s.law.K);
  visit("law.D", "s", s.law.D);
  visit("law.height", "m", s.law.height);
  visit("law.omega2", "1/s^2", s.law.omega2);
  visit("law.K_z", "1/s^2", s.law.K_z);
  visit("law.D_z", "1/s", s.law.D_z);
  visit("law.K_Pz", "N/m", s.law.K_Pz);
  visit("law.K_Dz", "N s/m", s.law.K_Dz);
  visit("law.spring_goal", "m", s.law.spring_goal);
  visit("law.spring_height", "m", s.law.spring_height);
  visit("law.spring_rate", "m/s", s.law.spring_rate);
  visit("law.motion", "m/s^2", s.law.motion);
  visit("law.short_term", "m/s^2", s.law.short_term);
  visit("law.pull", "m/s^2", s.law.pull);
  visit("law.rocking", "m/s^2", s.law.rocking);
  visit("residual.cog", "m/s", s.residuals.cog);
  visit("residual.foot", "m/s", s.residuals.foot);
  visit("residual.foot_turn", "rad/s", s.residuals.foot_turn);
  visit("residual.trunk", "rad/s", s.residuals.trunk);
  visit("weight", "1", s.weight);
  for (size_t side = 0; side < 2; ++side) {
    const std::string foot = side == 0 ? "left" : "right";
    visit(foot + ".force", "N", s.foot_force[side]);
    visit(foot + ".cop", "m", s.foot_cop[side]);
    visit(foot + ".planned_contact", "1", s.planned_contact[side]);
  }
  visit("push.force", "N", s.push_force);
  visit("push.point", "m", s.push_point);
  visit("contact.residual", "m/s", s.contact_residual);
  visit("contact.iterations", "1", s.contact_iterations);
  visit("energy", "J", s.energy);
  visit("work.servos", "J", s.work.servos);
  visit("work.contacts", "J", s.work.contacts);
  visit("work.outside", "J", s.work.outside);
  visit("work.joints", "J", s.work.joints);
}

/// One quantity of a log: a number, or several numbers of one kind.
struct LogQuantity {
  std::string name;  ///< name such as "theta", "cog" or "fz"
  /// Name of each part: "x", "qw", a joint; empty for a number.
  std::vector<std::string> parts = {};
  std::vector<std::string> units = {};  ///< unit of each column; "1" if it has none

  size_t columns() const { return units.size(); }
  /// Name of a column, such as "cog.x[m]" or "left.planned_contact".
  std::string column(size_t index) const;
};

/// The quantities of a sample of a robot with these joints.
std::vector<LogQuantity> log_quantities(const std::vector<std::string>& joints);

/// For each column, the columns from which it nearly follows in the same row: angles follow from
/// rates, torques from targets and angles, and equal values from each other. The compression of the
/// log uses them.
std::vector<std::vector<size_t>> log_sources(const std::vector<std::string>& joints);

/// Appends the values of all columns to `bytes`, 8 bytes each. Throws Error(internal) if a joint
/// vector has another size.
void append_values(const SimulationSample& sample, size_t joints, std::string& bytes);

}  // namespace ayumi
