#pragma once
// The kinds of rows in the program of a repair.

namespace ayumi {

/// What a row of the program bounds. Forces are divided by the weight m g, moments too, so that
/// they are lengths; "a place" is where the plan of contacts has a sole.
enum class ConstraintGroup {
  support,             ///< f_n (ZMP inside each edge - margin) / (m g) [m], at least 0
  normal_force,        ///< f_n / (m g), at least a share of the weight
  friction,            ///< (mu f_n - f_t) / (m g), at least 0; f_t is rounded at 0
  flight,              ///< ground force and moment about the planned COG in flight, over m g
  zmp,                 ///< f_n (ZMP - commanded ZMP) / (m g) [m], in a band
  torsional_friction,  ///< (arm f_n -+ yaw moment about the ZMP) / (m g) [m], at least 0
  stance,              ///< pose of a standing sole against its place [m], [rad], in a band
  path,                ///< pose of a locked sole against the given motion [m], [rad], in a band
  swing,               ///< heights of a swinging sole's corners over the ground [m], at least 0
  landing,             ///< factor h^2 - offset of a low sole at height h from its place [m]
  foot_clearance,      ///< heights of the corners in the middle of a swing [m], a soft goal
  position,            ///< joint angle [rad], within its limits
  speed,               ///< joint speed / limit, at most 1 either way
  acceleration,        ///< joint acceleration / limit, at most 1 either way
  torque,              ///< motor torque / limit, at most 1 either way
  clearance,           ///< distances of two shapes (clearance_rows.hpp) [m], at least a band
  cog,                 ///< COG - commanded COG [m], in a band
  pose,                ///< the correction itself [m], [rad], 0 where the posture is locked
  dcm                  ///< DCM - planned DCM along the ground [m], then as zmp, a soft goal
};
inline constexpr int kConstraintGroupCount = 19;  ///< Definition

const char* name_of(ConstraintGroup group);

}  // namespace ayumi
