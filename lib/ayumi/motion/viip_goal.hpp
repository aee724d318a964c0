#pragma once
// Goals of a VIIP phase, which replace keys: the controller determines the motion of the COG, the
// footholds and the jump. They are plain data; docs/formats.md describes the format.

#include <Eigen/Core>
#include <variant>

namespace ayumi {

/// Both feet stay, and the COG moves by this displacement from its commanded place [m], in the axes
/// of the feet (x forward).
struct CogGoal {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
};

/// Both feet stay, and the COG moves at this velocity [m/s], ref v_G of the paper, in the axes of
/// the feet (x forward, z up). It starts from the place that the previous goals command, and it
/// stops when the phase ends.
struct CogVelocityGoal {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
};

/// Steps with a commanded COG velocity; if it is zero, the robot steps in place. The controller
/// places the footholds. The robot stands before and after the steps.
struct StepGoal {
  /// Number of swings; with 0 as many as fit into the phase, of which the last one closes the feet.
  int steps = 0;
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< velocity forward and to the left [m/s]
  double turn = 0;                                     ///< turn to the left [rad/s]
};

/// A jump that consists of stoop, lift-off, flight, touchdown and settling, repeated `times` times.
struct JumpGoal {
  /// The event that ends the spring of (26): the COG passes ref z_G, or f_z is zero.
  enum class Release { ref_z, spring };
  double height = 0.03;  ///< z_H, the planned apex above ref z_G [m]
  double stoop = 0.03;   ///< z_d, the depth of the stoop below ref z_G [m]
  double forward = 0;    ///< length of each jump [m]
  int times = 1;
  Release release = Release::ref_z;
};

using ViipGoal = std::variant<CogGoal, CogVelocityGoal, StepGoal, JumpGoal>;

}  // namespace ayumi
