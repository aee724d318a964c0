#pragma once
// The quantities of a control law in one tick, as plain numbers: the terms of its reference by the
// paper's equations, and the residuals of its tasks after (22) or (28) has been solved.

#include <Eigen/Core>

namespace ayumi {

/// The activity of a law in one tick.
enum class LawStage {
  replay,          ///< open loop
  follow,          ///< DTAD on the ground
  follow_flight,   ///< DTAD off the ground: the posture returns to the command
  stand,           ///< VIIP on both feet
  weight_shift,    ///< VIIP on both feet before its first step
  single_support,  ///< VIIP on one foot
  double_support,  ///< VIIP on both feet between steps
  stoop,           ///< VIIP's jump goes down: (24)(25)
  push,            ///< VIIP's jump pushes off: (26)
  flight,          ///< in flight, without ground force
  landing,         ///< VIIP's jump lands: (27)
  settle           ///< VIIP's jump settles: (24)(25)
};

/// The terms from which a law computed its reference in one tick, for the log. Terms that a law
/// does not use are 0. Places are in the plan frame [m]; accelerations are in m/s^2.
struct LawTerms {
  LawStage stage = LawStage::replay;
  /// `planned_zmp` is the planned ZMP, inside the support. `wanted_zmp` is the result of (18)(19),
  /// before it is moved to the nearest point of the support.
  Eigen::Vector3d planned_zmp = Eigen::Vector3d::Zero(), wanted_zmp = Eigen::Vector3d::Zero();
  /// Gains of (18)(19) [1], [s]. For VIIP: the derivative of the wanted ZMP by the DCM, and this
  /// derivative divided by omega.
  double K = 0, D = 0;
  /// Measured ZMP after its low-pass filter.
  Eigen::Vector3d filtered_zmp = Eigen::Vector3d::Zero();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< offset of the ZMP that is accepted
  /// Height z_G - z_Z of the pendulum [m], and its omega^2 of (17) [1/s^2].
  double height = 0, omega2 = 0;
  double K_z = 0, D_z = 0;    ///< gains of (20) [1/s^2], [1/s]
  double K_Pz = 0, K_Dz = 0;  ///< gains of (24) to (27) [N/m], [N s/m]
  double spring_goal = 0;     ///< ref z_G of (24) above the ground [m]
  double spring_height = 0;   ///< z_G above the ground [m]
  double spring_rate = 0;     ///< rate of z_G minus that of ref z_G [m/s]
  /// Terms of the acceleration of the reference. `motion` is the commanded motion in DTAD, and (14)
  /// to (17) of the reference pendulum in VIIP. `short_term` is the short-term absorption, `pull`
  /// the pull to the command (DTAD) or to the measured state (VIIP), and `rocking` the damping of
  /// the rocking.
  Eigen::Vector3d motion = Eigen::Vector3d::Zero(), short_term = Eigen::Vector3d::Zero(),
                  pull = Eigen::Vector3d::Zero(), rocking = Eigen::Vector3d::Zero();
};

/// The residuals of the tasks of (22) or (28), as |J_U ref dtheta - u|.
struct TaskResiduals {
  double cog = 0;        ///< residual of the COG [m/s]
  double foot = 0;       ///< residual of the other foot's position [m/s]
  double foot_turn = 0;  ///< residual of the other foot's turn [rad/s]
  double trunk = 0;      ///< residual of the trunk's attitude [rad/s]
};

}  // namespace ayumi
