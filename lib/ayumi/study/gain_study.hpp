#pragma once
// Gains of DTAD for a standing robot: the gains that follow from the wishes of a designer, the
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
  double dcm = 0;      ///< [m]
  double impulse = 0;  ///< [N s]
};

struct GainStudy {
  double omega = 0;              ///< of the pendulum [1/s]
  std::vector<LoopModel> loops;  ///< of the robot that stands, as stance_loops() has them
  DtadParams params;             ///< the gains
  WeakestLoop weakest;           ///< the loop nearest to its edge of stability with these gains
  double largest_ka = 0;         ///< with which all loops are stable; kMostKa: at least
  std::vector<Reach> reaches;    ///< on both feet, then on the left foot

  /// Largest ka up to which the edge of stability is searched. Chosen: twenty times the default.
  static constexpr double kMostKa = 20;
};

/// Gains by their names in patterns and sidecars.
std::vector<std::pair<std::string, double>> gain_list(const DtadParams& params);

/// `gains` are set first, in place of the robot's; then `wishes` change them. `latency`: of the
/// sensors [s], in place of the robot's. The study of unstable gains is a result too. Throws
/// Error(usage) as design_gains() and for unknown gains, Error(bad_model) as stance_loops().
GainStudy study_gains(const RobotModel& model, const GainWishes& wishes = {},
                      const std::vector<std::pair<std::string, double>>& gains = {},
                      std::optional<double> latency = {});

}  // namespace ayumi
