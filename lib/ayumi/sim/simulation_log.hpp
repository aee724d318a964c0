#pragma once
// The log of a run with one sample per control tick. It is sufficient to judge, plot, render and
// export the run without another simulation.

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/model/robot_state.hpp"
#include "ayumi/motion/controller_spec.hpp"
#include "ayumi/motion/law_terms.hpp"
#include "ayumi/motion/reference_trajectory.hpp"
#include "ayumi/motion/scenario.hpp"
#include "ayumi/sim/energy_balance.hpp"

namespace ayumi {

struct SimulationSample {
  RobotState state;                 ///< true state of the plant
  Eigen::VectorXd target;           ///< servo targets [rad, m]
  Eigen::VectorXd torque;           ///< applied by the servos [N m]
  BasePose reference_base;          ///< base of the reference posture
  Eigen::VectorXd reference_theta;  ///< reference posture, without the servo lead [rad, m]
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();              ///< true, world [m]
  Eigen::Vector3d dcog = Eigen::Vector3d::Zero();             ///< [m/s]
  Eigen::Vector3d zmp = Eigen::Vector3d::Zero();              ///< true, world; held in flight [m]
  double fz = 0;                                              ///< true vertical ground force [N]
  Eigen::Vector3d measured_cog = Eigen::Vector3d::Zero();     ///< estimated, plan frame [m]
  Eigen::Vector3d measured_zmp = Eigen::Vector3d::Zero();     ///< from load cells, plan frame [m]
  double measured_fz = 0;                                     ///< [N]
  BasePose command_base;                                      ///< base of the commanded posture
  Eigen::VectorXd command_theta;                              ///< cmd theta [rad]
  Eigen::Vector3d command_cog = Eigen::Vector3d::Zero();      ///< cmd p_G [m]
  Eigen::Vector3d command_zmp = Eigen::Vector3d::Zero();      ///< cmd p_Z [m]
  double command_fz = 0;                                      ///< [N]
  Eigen::Vector3d reference_cog = Eigen::Vector3d::Zero();    ///< of the reference posture [m]
  Eigen::Vector3d reference_zmp = Eigen::Vector3d::Zero();    ///< ref p_Z [m]
  double reference_fz = 0;                                    ///< [N]
  Eigen::Vector3d measured_dcog = Eigen::Vector3d::Zero();    ///< estimated [m/s]
  Eigen::Vector3d command_dcog = Eigen::Vector3d::Zero();     ///< [m/s]
  Eigen::Vector3d reference_dcog = Eigen::Vector3d::Zero();   ///< ref dp_G [m/s]
  Eigen::Vector3d reference_ddcog = Eigen::Vector3d::Zero();  ///< ref ddp_G [m/s^2]
  Eigen::VectorXd reference_dtheta;                           ///< ref dtheta of (22), (28) [rad/s]
  LawTerms law;                                               ///< of what the reference was made
  TaskResiduals residuals;                                    ///< of (22), (28)
  Eigen::VectorXd weight;  ///< W of (22), (28), by dof; 0 where nothing was resolved
  std::array<Eigen::Vector3d, 2> foot_force = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::array<Eigen::Vector3d, 2> foot_cop = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::array<bool, 2> planned_contact = {true, true};    ///< left, right
  Eigen::Vector3d push_force = Eigen::Vector3d::Zero();  ///< external force, world [N]
  Eigen::Vector3d push_point = Eigen::Vector3d::Zero();  ///< where it acts, world [m]
  double contact_residual = 0;                           ///< of the contact solve [m/s]
  int contact_iterations = 0;
  double energy = 0;   ///< kinetic (rotors included) and potential over z = 0 [J]
  EnergyBalance work;  ///< done since t = 0
};

struct SimulationEvent {
  double t = 0;      ///< [s]
  std::string kind;  ///< "push", "touchdown", "fell", "saturation", "support", ...
  std::string text;  ///< in words
};

enum class Outcome { stands, unsettled, fell };
const char* name_of(Outcome outcome);

/// The largest share of a limit that a joint takes, and where.
struct JointShare {
  double ratio = 0;  ///< of the limit
  int joint = -1;    ///< its place in SimulationLog::joints; -1: unknown, as in older files
  double at = 0;     ///< [s]
};

/// Verdict and figures of a run, as docs/cli.md defines them.
struct SimulationResult {
  Outcome outcome = Outcome::unsettled;
  double fell_at = -1;              ///< [s]; negative when it did not fall
  double max_tilt = 0;              ///< of the trunk [rad]
  double final_cog_error = 0;       ///< relative to the feet, horizontal [m]
  double final_speed = 0;           ///< of the COG [m/s]
  double zmp_tracking_rms = 0;      ///< measured ZMP against reference ZMP [m]
  double zmp_amplitude = 0;         ///< of the true ZMP's oscillation at the end; 0: none [m]
  double zmp_frequency = 0;         ///< of that oscillation [Hz]
  double flight = 0;                ///< time without ground contact [s]
  double apex = 0;                  ///< of the COG above its command [m]
  int steps = 0;                    ///< touchdowns
  JointShare speed = {};            ///< the largest joint speed / limit
  JointShare torque = {};           ///< the largest applied torque / limit
  double max_penetration = 0;       ///< of a sole vertex [m]
  double max_slip = 0;              ///< of a supporting foot while planned in contact [m]
  double max_contact_residual = 0;  ///< [m/s]
  int max_contact_iterations = 0;
  double mean_contact_iterations = 0;
};

struct SimulationLog {
  double dt = 0.001;                         ///< control tick [s]
  std::optional<ControllerType> controller;  ///< empty for a plan that nothing carried out
  /// Its gains by name, as it used them.
  std::vector<std::pair<std::string, double>> gains;
  std::string plant = "ayumi";  ///< what integrated the motion: "ayumi", "mujoco"
  Provenance provenance;
  World world;
  std::vector<Disturbance> scenario;
  std::vector<std::string> joints;        ///< order of all joint vectors
  std::vector<SimulationSample> samples;  ///< sample k at k dt
  std::vector<SimulationEvent> events;
  SimulationResult result;
};

}  // namespace ayumi
