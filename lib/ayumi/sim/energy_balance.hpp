#pragma once
// The work that changes the energy of a robot, by its source.

namespace ayumi {

/// Work done on the robot [J]. The sum of the four is the change of the robot's energy, up to an
/// error of the integrator of first order in the step.
struct EnergyBalance {
  double servos = 0;    ///< work of the servos
  double contacts = 0;  ///< work of the ground, also when it moves, and of contacts between links
  double outside = 0;   ///< work of pushes
  double joints = 0;    ///< work of friction and end stops of the joints

  EnergyBalance& operator+=(const EnergyBalance& other) {
    servos += other.servos;
    contacts += other.contacts;
    outside += other.outside;
    joints += other.joints;
    return *this;
  }
};

}  // namespace ayumi
