#pragma once
// Where a robot's energy comes from and goes to.

namespace ayumi {

/// Work done on the robot [J]. Their sum is the change of its energy, up to what the integrator
/// loses or makes, which falls with the step.
struct Work {
  double servos = 0;
  double contacts = 0;  ///< by the ground, a moving one too, and where links touch each other
  double outside = 0;   ///< by pushes
  double joints = 0;    ///< by friction and end stops of the joints

  Work& operator+=(const Work& other) {
    servos += other.servos;
    contacts += other.contacts;
    outside += other.outside;
    joints += other.joints;
    return *this;
  }
};

}  // namespace ayumi
