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

/// One control tick. Quantities with the prefix command_, reference_ or measured_ are in the plan
/// frame, in which the stance foot is at its planned place. All other places, velocities and forces
/// are true values in the world.
struct SimulationSample {
  RobotState state;                 ///< true state of the plant
  Eigen::VectorXd target;           ///< servo targets as angles of the joints [rad, m]
  Eigen::VectorXd torque;           ///< torque that the servos applied [N m, N]
  BasePose reference_base;          ///< base of the reference posture
  Eigen::VectorXd reference_theta;  ///< reference posture, without the servo lead [rad, m]
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();   ///< true COG in the world [m]
  Eigen::Vector3d dcog = Eigen::Vector3d::Zero();  ///< its rate [m/s]
  /// The true ZMP in the world [m]. In flight it keeps its value.
  Eigen::Vector3d zmp = Eigen::Vector3d::Zero();
  double fz = 0;                                           ///< true vertical ground force [N]
  Eigen::Vector3d measured_cog = Eigen::Vector3d::Zero();  ///< estimated COG in the plan frame [m]
  /// ZMP from load cells, in the plan frame [m].
  Eigen::Vector3d measured_zmp = Eigen::Vector3d::Zero();
  double measured_fz = 0;                                    ///< vertical force from load cells [N]
  BasePose command_base;                                     ///< base of the commanded posture
  Eigen::VectorXd command_theta;                             ///< commanded theta [rad, m]
  Eigen::Vector3d command_cog = Eigen::Vector3d::Zero();     ///< commanded p_G [m]
  Eigen::Vector3d command_zmp = Eigen::Vector3d::Zero();     ///< commanded p_Z [m]
  double command_fz = 0;                                     ///< commanded f_z [N]
  Eigen::Vector3d reference_cog = Eigen::Vector3d::Zero();   ///< COG of the reference posture [m]
  Eigen::Vector3d reference_zmp = Eigen::Vector3d::Zero();   ///< ref p_Z [m]
  double reference_fz = 0;                                   ///< ref f_z [N]
  Eigen::Vector3d measured_dcog = Eigen::Vector3d::Zero();   ///< estimated COG rate [m/s]
  Eigen::Vector3d command_dcog = Eigen::Vector3d::Zero();    ///< commanded COG rate [m/s]
  Eigen::Vector3d reference_dcog = Eigen::Vector3d::Zero();  ///< ref dp_G [m/s]
  Eigen::Vector3d reference_ddcog = Eigen::Vector3d::Zero();  ///< ref ddp_G [m/s^2]
  Eigen::VectorXd reference_dtheta;                           ///< ref dtheta of (22), (28) [rad/s]
  LawTerms law;             ///< terms from which the reference was made
  TaskResiduals residuals;  ///< residuals of (22), (28)
  Eigen::VectorXd weight;   ///< W of (22), (28), by dof; 0 where nothing was resolved
  /// By Side: the force of the ground on the foot [N], and its centre of pressure [m], both in the
  /// world. Without load, the centre of pressure is at the origin of the sole frame.
  std::array<Eigen::Vector3d, 2> foot_force = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::array<Eigen::Vector3d, 2> foot_cop = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  /// Planned contact of the left and the right foot.
  std::array<bool, 2> planned_contact = {true, true};
  Eigen::Vector3d push_force = Eigen::Vector3d::Zero();  ///< external force in the world [N]
  /// Point at which it acts, in the world [m].
  Eigen::Vector3d push_point = Eigen::Vector3d::Zero();
  double contact_residual = 0;  ///< residual of the contact solve [m/s]
  int contact_iterations = 0;
  double energy = 0;   ///< energy: kinetic (rotors included), and potential relative to z = 0 [J]
  EnergyBalance work;  ///< work since t = 0
};

/// What happened in a run.
enum class EventKind {
  study_case,   ///< the run is a case of a study, which changed the robot or the world
  controller,   ///< what controls the robot
  calibration,  ///< what the sensors were found to read without a load
  push,         ///< a push begins
  disturbance,  ///< another disturbance begins or ends
  saturation,   ///< a limit holds back the controller or a motor
  contact,      ///< two bodies of the robot touch
  touchdown,    ///< a foot lands
  fell,         ///< the robot fell
  log,          ///< a note on the log itself; the last kind
};
/// The name of the kind in files: "case", "controller", "push", ...
const char* name_of(EventKind kind);
/// All these names, in the order of the kinds.
const std::vector<std::string>& event_kind_names();

struct SimulationEvent {
  double t = 0;  ///< time [s]
  EventKind kind = EventKind::log;
  std::string text;  ///< the event in words
};

enum class Outcome { stands, unsettled, fell };
const char* name_of(Outcome outcome);

/// The largest share of a limit that a joint uses, with its place.
struct JointShare {
  double ratio = 0;  ///< share of the limit
  /// Index of the joint in SimulationLog::joints; -1 if it is unknown, as in older files.
  int joint = -1;
  double at = 0;  ///< time [s]
};

/// The verdict and the figures of a run, as docs/cli.md defines them.
struct SimulationResult {
  Outcome outcome = Outcome::unsettled;
  double fell_at = -1;  ///< time of the fall [s]; negative if the robot did not fall
  double max_tilt = 0;  ///< largest tilt of the trunk [rad]
  /// Error of the COG at the end relative to the feet, horizontally [m].
  double final_cog_error = 0;
  double final_speed = 0;       ///< speed of the COG at the end [m/s]
  double zmp_tracking_rms = 0;  ///< measured ZMP relative to the reference ZMP [m]
  /// Amplitude of the true ZMP's oscillation at the end [m]; 0 if there is none.
  double zmp_amplitude = 0;
  double zmp_frequency = 0;    ///< frequency of this oscillation [Hz]
  double flight = 0;           ///< time without ground contact [s]
  double apex = 0;             ///< largest height of the COG above its command [m]
  int steps = 0;               ///< number of touchdowns
  JointShare speed = {};       ///< the largest joint speed as a share of its limit
  JointShare torque = {};      ///< the largest applied torque as a share of its limit
  double max_penetration = 0;  ///< largest penetration of a sole vertex [m]
  double max_slip = 0;  ///< largest slip of a supporting foot while it is planned in contact [m]
  double max_contact_residual = 0;  ///< largest residual of the contact solve [m/s]
  /// Largest and mean number of iterations of the contact solver in a tick.
  int max_contact_iterations = 0;
  double mean_contact_iterations = 0;
};

struct SimulationLog {
  double dt = 0.001;                         ///< control tick [s]
  std::optional<ControllerType> controller;  ///< empty for a plan that was not carried out
  /// The gains of the controller by name, as it used them.
  std::vector<std::pair<std::string, double>> gains;
  std::string plant = "ayumi";  ///< what integrated the motion: "ayumi", "mujoco"
  Provenance provenance;
  World world;
  std::vector<Disturbance> scenario;
  std::vector<std::string> joints;        ///< joints in the order of all joint vectors
  std::vector<SimulationSample> samples;  ///< samples; sample k is at the time k dt
  std::vector<SimulationEvent> events;
  SimulationResult result;
};

}  // namespace ayumi
