#pragma once
// The nearest consistent pattern by Ipopt: smooth corrections (cubic B-splines) to base and joints
// that bring a command series back inside support, joint and contact limits with least change.

#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/pattern/command_series.hpp"

namespace ayumi {

struct RepairOptions {
  CheckOptions check;
  std::vector<std::string> locked_joints;
  double knot_spacing = 0.05;  ///< of the B-splines [s]
  double zmp_margin = 0.002;   ///< to keep inside the support polygon [m]
  int max_iterations = 100;
};

enum class RepairStatus { already_consistent, repaired, infeasible, not_converged };
const char* name_of(RepairStatus status);

struct RepairResult {
  RepairStatus status = RepairStatus::not_converged;
  CorrectionTrack correction;   ///< empty when already consistent
  CommandSeries series;         ///< the repaired command series, full rate
  ConsistencyReport check;      ///< of `series`
  double max_joint_change = 0;  ///< [rad]
  double max_cog_change = 0;    ///< [m]
  std::string where;            ///< joint that moved most
  double at = 0;                ///< when [s]
  int variables = 0, constraints = 0, iterations = 0;
  double constraint_violation = 0;   ///< scaled, of the NLP
  std::vector<std::string> reasons;  ///< when not repaired, in words, ranked
};

RepairResult repair(const RobotModel& model, const CommandSeries& series,
                    const RepairOptions& options = {}, const Progress& progress = {});

}  // namespace ayumi
