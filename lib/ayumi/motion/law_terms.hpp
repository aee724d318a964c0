#pragma once
// The quantities of a control law in one tick, as plain numbers: the terms of its reference by the
// paper's equations, and what the resolution of (22) or (28) left of its tasks.

#include <Eigen/Core>

namespace ayumi {

/// The activity of a law in one tick.
enum class LawStage {
  replay,          ///< open loop
  follow,          ///< DTAD on the ground
  follow_flight,   ///< DTAD off the ground: the posture returns to the command
  stand,           ///< VIIP on both feet
  weight_shift,    ///< VIIP before its first step
  single_support,  ///< VIIP
  double_support,  ///< VIIP
  stoop,           ///< VIIP's jump: (24)(25)
  push,            ///< (26)
  flight,          ///< no force
  landing,         ///< (27)
  settle           ///< (24)(25)
};

/// The terms from which a law computed its reference in one tick, for the log. Terms that a law
/// does not use are 0. Places in the plan frame [m], accelerations [m/s^2].
struct LawTerms {
  LawStage stage = LawStage::replay;
  /// (18)(19): the ZMP that is planned, within the support; the one wanted, before the nearest
  /// point of the support is taken.
  Eigen::Vector3d planned_zmp = Eigen::Vector3d::Zero(), wanted_zmp = Eigen::Vector3d::Zero();
  double K = 0, D = 0;  ///< of (18)(19) [1], [s]; VIIP: d wanted ZMP / d DCM, and this / omega
  Eigen::Vector3d filtered_zmp = Eigen::Vector3d::Zero();  ///< measured, behind its low pass
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();        ///< of the ZMP that is accepted
  double height = 0, omega2 = 0;  ///< of the pendulum: z_G - z_Z [m], (17) [1/s^2]
  double K_z = 0, D_z = 0;        ///< of (20) [1/s^2], [1/s]
  double K_Pz = 0, K_Dz = 0;      ///< of (24) to (27) [N/m], [N s/m]
  double spring_goal = 0;         ///< ref z_G of (24) above the ground [m]
  double spring_height = 0;       ///< z_G there [m]
  double spring_rate = 0;         ///< rate of z_G less that of ref z_G [m/s]
  /// Terms of the acceleration of the reference: the motion itself (commanded under DTAD, (14) to
  /// (17) of the reference pendulum under VIIP); the short-term absorption; the pull to the command
  /// (DTAD) or to the measured state (VIIP); the damping of the rocking.
  Eigen::Vector3d motion = Eigen::Vector3d::Zero(), short_term = Eigen::Vector3d::Zero(),
                  pull = Eigen::Vector3d::Zero(), rocking = Eigen::Vector3d::Zero();
};

/// Residuals of the tasks of (22) or (28), as |J_U ref dtheta - u|.
struct TaskResiduals {
  double cog = 0;        ///< [m/s]
  double foot = 0;       ///< of the other foot [m/s]
  double foot_turn = 0;  ///< [rad/s]
  double trunk = 0;      ///< [rad/s]
};

}  // namespace ayumi
