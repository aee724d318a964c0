#pragma once
// Compares a simulated run with a recording of the robot: joint angles, loads of the feet and their
// share, landings and the IMU. The time shift between both is found first.

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/identify/recorded_motion.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// Two curves at the same times.
struct ComparedCurve {
  std::string name, unit;
  std::vector<double> measured, simulated;  ///< values at Comparison::times
  double mean = 0;                          ///< mean of |measured - simulated|
  double largest = 0, largest_at = 0;       ///< largest difference, and its time in the run [s]
  double lag = 0;          ///< time by which the measured curve is behind [s]; 0 if nothing moves
  double correlation = 0;  ///< correlation; 0 if one of them does not change
};

struct ComparedLanding {
  Side foot = Side::left;
  double measured = 0, simulated = 0;  ///< times in the run's time [s]
};

/// A landing that only the recording or only the run has.
struct LoneLanding {
  Side foot = Side::left;
  bool measured = false;  ///< true if only the recording has it
  double t = 0;           ///< time in the run's time [s]
};

struct Comparison {
  double shift = 0;                   ///< time in the run of the recording's first row [s]
  double begin = 0, end = 0;          ///< compared interval in the run's time [s]
  std::vector<double> times;          ///< times of the curves [s]
  std::vector<ComparedCurve> joints;  ///< joint positions [rad, m] in the robot's order
  /// Left and right load [N] and left share [1]; empty if none were recorded.
  std::vector<ComparedCurve> loads;
  /// Acceleration [m/s^2] and angular velocity [rad/s] by axis; empty if none were recorded.
  std::vector<ComparedCurve> imu;
  std::vector<ComparedLanding> landings;   ///< landings that both have
  std::vector<LoneLanding> lone_landings;  ///< the other landings, in order of time
  /// Notes of one line each, such as joints without a column, or another rate.
  std::vector<std::string> notes;

  double mean_joint() const {  ///< The mean over all joints [rad].
    double sum = 0;
    for (const ComparedCurve& joint : joints) sum += joint.mean;
    return joints.empty() ? 0 : sum / static_cast<double>(joints.size());
  }
  double largest_joint() const {  ///< The largest difference of a joint [rad].
    double largest = 0;
    for (const ComparedCurve& joint : joints) largest = std::max(largest, joint.largest);
    return largest;
  }
};

struct CompareOptions {
  std::optional<double> shift;  ///< shift of the recording [s]; if it is left out, it is found
  double begin = 0, end = 1e9;  ///< interval of the run's time [s]
};

/// Throws Error(bad_file) "`file`: what" if the recording and the run have no time in common.
/// Joints and sensors whose sign or unit differs, feet whose loads are exchanged, and joints that
/// do not follow are noted.
Comparison compare(const RobotModel& model, const SimulationLog& log,
                   const std::optional<AngleTable>& measured, const SensorTable& sensors,
                   const CompareOptions& options, const std::string& file);

/// The run with the measured joint angles instead of the simulated ones, to be drawn beside it.
SimulationLog measured_log(const SimulationLog& log, const AngleTable& measured, double shift);

}  // namespace ayumi
