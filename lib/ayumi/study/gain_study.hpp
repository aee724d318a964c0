#pragma once
// Gains of DTAD for a standing robot: the gains that follow from what the designer asks for, the
// poles of the linear loop with these gains, and the pushes from which the robot recovers without a
// step.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/control/gain_design.hpp"

namespace ayumi {

/// Largest distance of the DCM from the plan, and the impulse that causes it, in one direction.
struct Reach {
  std::string support, direction;
  double dcm = 0;      ///< distance of the DCM [m]
  double impulse = 0;  ///< impulse [N s]
};

struct GainStudy {
  double omega = 0;              ///< omega of the pendulum [1/s]
  std::vector<LoopModel> loops;  ///< loops of the robot that stands, as stance_loops() returns them
  DtadParams params;             ///< the gains
  WeakestLoop weakest;           ///< the loop nearest to its edge of stability with these gains
  /// Largest ka with which all loops are stable; kMostKa if it is that or more.
  double largest_ka = 0;
  std::vector<Reach> reaches;  ///< pushes on both feet, then on the left foot

  /// Largest ka up to which the edge of stability is searched. Chosen: twenty times the default.
  static constexpr double kMostKa = 20;
  /// Largest latency of the sensors [s]. Chosen: with a delay of 0.2 s, an error of the DCM of
  /// HOAP-1 grows to 3.7 times its size before the law sees it. The loop has a state for each tick
  /// of the delay.
  static constexpr double kMostLatency = 0.2;
};

/// Gains by their names in patterns and sidecars.
std::vector<std::pair<std::string, double>> gain_list(const DtadParams& params);

/// `gains` are set first and replace the robot's; then `wishes` change them. `latency` is that of
/// the sensors [s] and replaces the robot's. The study of unstable gains is a result too. Throws
/// Error(usage) in the same cases as design_gains() and for unknown gains, and Error(bad_model) in
/// the same cases as stance_loops().
GainStudy study_gains(const RobotModel& model, const GainWishes& wishes = {},
                      const std::vector<std::pair<std::string, double>>& gains = {},
                      std::optional<double> latency = {});

}  // namespace ayumi
