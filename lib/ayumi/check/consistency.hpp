#pragma once
// Is a command series physically consistent? The posture, COG, ZMP and f_z are judged against each
// other and against every limit of the robot (limits/). Findings say what is wrong, where, when and
// by how much, and what to do about it.

#include <functional>
#include <string>
#include <vector>

#include "ayumi/limits/limit.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

struct ConsistencyReport {
  bool consistent = false;        ///< no finding of severity error
  std::vector<Finding> findings;  ///< errors first, then by time
  CheckSummary summary;
  FigurePlaces summary_at;  ///< the place at which each figure of the summary has its value
  std::string profile;      ///< the actuator profile by which the motion was judged
};

/// "consistent" or "inconsistent", in outputs, files and pages.
const char* verdict_of(bool consistent);
inline const char* verdict_of(const ConsistencyReport& report) {
  return verdict_of(report.consistent);
}

/// Is called for each sample that is judged, with the positions and rates of the bodies. Several
/// threads may call it at the same time, for different samples and in any order.
using SampleObserver = std::function<void(const JudgedSample&, const RobotData&)>;

/// Throws Error(usage) for an unknown tolerance, a tolerance out of range or a time step that is
/// not above 0, Error(bad_model) for a robot without soles or an unknown profile, and
/// Error(bad_pattern) for a series without samples.
ConsistencyReport check_consistency(const RobotModel& model, const CommandSeries& series,
                                    const CheckOptions& options = {},
                                    const SampleObserver& observe = {});

/// False if the robot's profile states no limit of this kind for any motor; otherwise true.
bool has_limit(const RobotModel& model, FindingKind kind);

}  // namespace ayumi
