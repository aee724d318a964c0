#pragma once
// What a bare URDF does not say: soles, home posture, servo constants. Each guess is added to
// `assumptions`. Included by io/*.cpp only.

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// Fills soles, home posture and servos of `robot` where they are empty. Soles are the undersides
/// of the lowest body left and the lowest body right of the middle with every joint at 0 (x
/// forward, z up in the root link): the bounding rectangle of what lies within 5 mm of the lowest
/// point. Servo constants scale with mass m and COG height z: kp = 40 m g z, kd = 0.13 sqrt(z/g)
/// kp, rotor inertia 0.009 m z^2.
void infer_missing(RobotDescription& robot);

}  // namespace ayumi
