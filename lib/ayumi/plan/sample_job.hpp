#pragma once
// Data and functions that the parts of sample() share: the pattern as tracks, and postures from
// them.

#include "ayumi/base/progress.hpp"
#include "ayumi/dynamics/inverse_kinematics.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/plan/tracks.hpp"

namespace ayumi {

struct SampleJob {
  const RobotModel& model;
  const Pattern& pattern;
  const FootPlan& feet;
  const InverseKinematics& ik;
  const PatternTracks& tracks;
  double dt = 0.001;  ///< [s]
  int count = 0;      ///< of samples
  const Progress& progress;
};

/// theta of every joint track at t [rad].
Eigen::VectorXd keyed_joints(const SampleJob& job, double t);

/// Commanded trunk attitude: torso keys, else level with the mean heading of the planned feet.
Eigen::Matrix3d trunk_attitude(const SampleJob& job, double t);

/// Turn of the trunk from this attitude around flights (flight.hpp): a rotation vector over time,
/// world axes, left-multiplied [rad].
using TrunkTurn = std::array<Track, 3>;

/// Solves base and legs at time t for sample.cog with the initial guess sample.state; fills feet
/// and support. Throws Error(bad_pattern) that names phase, time, foot and missing millimetres.
PostureSolution solve_posture(const SampleJob& job, double t, const Eigen::Matrix3d& trunk,
                              CommandSample& sample, RobotData& data);

/// True when a phase has no support.
bool flies(const SampleJob& job);

/// Fraction of the weight below which the ground force is too small for a ZMP to correct, (17).
/// Chosen: 5 %, as in motion/differentiate. No measured case changes from half to twice
/// (constants.md).
inline constexpr double kZmpShare = 0.05;

/// COG and ZMP of a motion driven by the body's tracks.
struct CogPlan {
  std::array<Track, 3> cog;                     ///< world [m]
  std::array<Track, 3> zmp;                     ///< as keyed [m]
  std::array<bool, 2> solved = {false, false};  ///< axes solved from the ZMP
  std::array<Eigen::Vector2d, 2> bump = {Eigen::Vector2d::Zero(),
                                         Eigen::Vector2d::Zero()};  ///< [begin, end](axis) [m]
  std::array<double, 2> omega = {1, 1};                             ///< at begin and end [1/s]
  TrunkTurn turn;
  double duration = 0;  ///< [s]

  /// Commanded ZMP: the keys with the bumps that a start from rest needs.
  Eigen::Vector3d zmp_at(double t) const;
  Eigen::Matrix3d trunk_at(const SampleJob& job, double t) const;
};

/// COG keys where given, other axes from the ZMP by (14)(15), corrected for the full model.
CogPlan plan_cog(const SampleJob& job);

/// The motion when base and legs follow COG and feet.
CommandSeries sample_body_driven(const SampleJob& job);

/// The motion when keys or a table drive the legs.
CommandSeries sample_joint_driven(const SampleJob& job);

/// "0.42 mm"
std::string millimetres(double metres);

}  // namespace ayumi
