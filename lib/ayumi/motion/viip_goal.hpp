#pragma once
// What a VIIP phase asks for in place of keys: the controller places the COG, the footholds and the
// jump itself. Plain data; docs/formats.md tells how it is written.

#include <Eigen/Core>
#include <variant>

namespace ayumi {

/// Both feet stay; the COG goes to this displacement from where the command holds it [m], in the
/// axes of the feet (x forward).
struct CogGoal {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
};

/// Steps at a commanded COG velocity, footholds placed by the controller; in place when it is zero.
/// The robot stands before and after them.
struct StepGoal {
  int steps = 0;  ///< swings; 0: as many as the phase has time for, the last one closing
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< forward, left [m/s]
  double turn = 0;                                     ///< to the left [rad/s]
};

/// Stoop, lift-off, flight, touchdown, settle, as often as asked.
struct JumpGoal {
  /// Where the spring of (26) lets go: passing ref z_G, or held until f_z is zero.
  enum class Release { ref_z, spring };
  double height = 0.03;  ///< z_H, planned apex above ref z_G [m]
  double stoop = 0.03;   ///< z_d, below ref z_G [m]
  double forward = 0;    ///< way of each jump [m]
  int times = 1;
  Release release = Release::ref_z;
};

using ViipGoal = std::variant<CogGoal, StepGoal, JumpGoal>;

}  // namespace ayumi
