#pragma once
// The input and the report of one step of a plant, the same for every plant.

#include <Eigen/Dense>
#include <array>
#include <optional>
#include <vector>

#include "ayumi/motion/ground_world.hpp"
#include "ayumi/sim/energy_balance.hpp"

namespace ayumi {

/// A force or couple from outside during one step.
struct ExternalWrench {
  int body = -1;  ///< -1: through the whole-body COG, on the trunk
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< world [m]; unused for body -1
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< world [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< world [N m]
};

/// A point mass that a link carries.
struct CarriedMass {
  int link = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< link frame [m]
  double mass = 0;                                  ///< [kg]
  bool operator==(const CarriedMass&) const = default;
};

/// A disc that rises from the ground.
struct RisingDisc {
  GroundBlock block;
  double rate = 0;  ///< of its height [m/s]
};

/// Changes of the servo and the friction of one joint during a step.
struct JointFault {
  double gain = 1;                  ///< factor on kp and kd
  double coulomb = 0, viscous = 0;  ///< added friction [N m, N m s/rad or N, N s/m]
  double encoder = 0;               ///< error of the encoder's reading [rad, m]
};

/// Pose of the floor at the start of a step, and its velocity during the step.
struct FloorPose {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();      ///< ground's frame in the world
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< of the frame's origin [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]
};

/// What acts on the robot from outside during one step.
struct StepInput {
  std::vector<ExternalWrench> wrenches;
  std::vector<CarriedMass> payloads;
  std::vector<JointFault> joints;  ///< by dof; empty: no faults
  std::optional<FloorPose> floor;  ///< empty: the world's slope at rest
  std::optional<double> friction;  ///< of the whole ground, in place of the world's
  std::vector<RisingDisc> bumps;   ///< in addition to the world's blocks

  StepInput() = default;
  StepInput(std::vector<ExternalWrench> w) : wrenches(std::move(w)) {}
  StepInput(std::initializer_list<ExternalWrench> w) : wrenches(w) {}
};

/// Ground force at one vertex of a sole, where a load cell is. A force between the vertices is
/// distributed over them so that the total and the centre of pressure are right.
struct SoleForce {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< world [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< on the robot, world [N]
  double gap = 0;                                      ///< to the ground, negative inside [m]
};

/// Forces and events of a step; forces are means over its duration.
struct StepReport {
  Eigen::VectorXd torque;  ///< of the servos [N m]
  /// Angle and rate of the motors, where their encoders are [rad, rad/s]; those of the joints where
  /// the gears have neither backlash nor stiffness. Empty before the first step.
  Eigen::VectorXd motor, motor_rate;
  std::array<std::vector<SoleForce>, 2> soles;  ///< by Side, in the order of the sole's polygon
  bool body_contact = false;                    ///< a body that is no sole touches the ground
  int touching_body = -1;                       ///< the first such body; -1: none, or not known
  std::vector<int> saturated;                   ///< dofs whose torque is at its limit
  int contact_iterations = 0;
  double contact_residual = 0;  ///< [m/s]
  double max_penetration = 0;   ///< of a sole vertex [m]
  EnergyBalance work;           ///< done in the step
  /// Bodies of the robot that touch each other, the first such pair; -1: none.
  std::array<int, 2> self_contact = {-1, -1};
};

}  // namespace ayumi
