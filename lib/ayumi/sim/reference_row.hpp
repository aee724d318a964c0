#pragma once
// The reference of a sample of a run as a row of a table.

#include "ayumi/motion/reference_trajectory.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// The reference of the sample, with its posture as the targets.
inline ReferenceRow reference_row(const SimulationSample& sample) {
  ReferenceRow row;
  row.theta = sample.reference_theta;
  row.base = sample.reference_base;
  row.cog = sample.reference_cog;
  row.zmp = sample.reference_zmp;
  row.fz = sample.reference_fz;
  row.contact = sample.planned_contact;
  return row;
}

}  // namespace ayumi
