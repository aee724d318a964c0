#pragma once
// Comparison of a simulated run with a recording of the robot: joint angles, loads of the feet and
// their share, landings and the IMU, with the time shift between both found first.

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/identify/recorded_motion.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// Two curves over time, with the same times.
struct ComparedCurve {
  std::string name, unit;
  std::vector<double> measured, simulated;  ///< at Comparison::times
  double mean = 0;                          ///< mean |measured - simulated|
  double largest = 0, largest_at = 0;       ///< and its time in the run [s]
  double lag = 0;                           ///< by which measured is behind [s]; 0: not moving
  double correlation = 0;                   ///< 0 where one of them does not change
};

struct ComparedLanding {
  Side foot = Side::left;
  double measured = 0, simulated = 0;  ///< in the run's time [s]
};

/// A landing that only the recording or only the run has.
struct LoneLanding {
  Side foot = Side::left;
  bool measured = false;  ///< in the recording
  double t = 0;           ///< in the run's time [s]
};

struct Comparison {
  double shift = 0;                   ///< time in the run of the recording's first row [s]
  double begin = 0, end = 0;          ///< what was compared, in the run's time [s]
  std::vector<double> times;          ///< [s]
  std::vector<ComparedCurve> joints;  ///< [rad, m], robot's order
  std::vector<ComparedCurve> loads;   ///< left, right [N], left share [1]; empty: none recorded
  std::vector<ComparedCurve> imu;     ///< acc [m/s^2], gyro [rad/s] by axis; empty: none recorded
  std::vector<ComparedLanding> landings;   ///< those that both have
  std::vector<LoneLanding> lone_landings;  ///< the others, in order of time
  std::vector<std::string> notes;  ///< in one line each: joints without a column, another rate, ...

  double mean_joint() const {  ///< over all joints [rad]
    double sum = 0;
    for (const ComparedCurve& joint : joints) sum += joint.mean;
    return joints.empty() ? 0 : sum / static_cast<double>(joints.size());
  }
  double largest_joint() const {  ///< [rad]
    double largest = 0;
    for (const ComparedCurve& joint : joints) largest = std::max(largest, joint.largest);
    return largest;
  }
};

struct CompareOptions {
  std::optional<double> shift;  ///< [s]; left out: found
  double begin = 0, end = 1e9;  ///< of the run's time [s]
};

/// Throws Error(bad_file) "`file`: what" where the recording and the run have no time in common.
/// Joints with another sign or unit, or that do not follow, are noted. The recording holds what the
/// encoders read, so the zero offsets of the run's servos are subtracted from the simulated angles.
Comparison compare(const RobotModel& model, const SimulationLog& log,
                   const std::optional<AngleTable>& measured, const SensorTable& sensors,
                   const CompareOptions& options, const std::string& file);

/// The run with the measured joint angles in place of the simulated ones, for a drawing beside it.
SimulationLog measured_log(const SimulationLog& log, const RobotModel& model,
                           const AngleTable& measured, double shift);

}  // namespace ayumi
