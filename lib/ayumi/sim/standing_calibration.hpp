#pragma once
// Offsets of the ankles' encoders, estimated while the robot stands before its motion. A sole whose
// ankle reads wrongly stands on an edge, because stiff servos hold what is read. The ankles then
// turn until every sole bears inside and the soles are level by the IMU; what they have turned is
// what their encoders read in excess. docs/theory_plant.md, "Encoders that are off".

#include <array>

#include "ayumi/control/estimator.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

class StandingCalibration {
 public:
  /// The model must outlive this object. `dt`: of one update [s].
  StandingCalibration(const RobotModel& model, double dt);

  /// Whether a sole bears on an edge, or does not bear at all, although the posture of the plan
  /// puts both soles flat on the ground and its ZMP well inside their hull.
  bool needed(const Measurement& measurement, const CommandSample& plan);

  /// One tick at rest on both feet: the offsets change. `measurement` has readings that are already
  /// corrected by offsets(), and `estimate` is of it; `feet`: planned sole frames.
  void update(const Measurement& measurement, const Estimate& estimate,
              const std::array<Eigen::Isometry3d, 2>& feet);

  /// Whether the two feet have turned differently. Otherwise the ground may as well slope.
  bool found() const;

  /// Every sole has borne inside, and level, for some time.
  bool done() const;

  /// By how much the encoders read too much [rad], by dof; zero but at the ankles.
  const Eigen::VectorXd& offsets() const { return offsets_; }

  /// One line for each ankle whose offset is worth a word.
  std::vector<std::string> lines() const;

 private:
  double inside(Side side, const FootLoad& load) const;

  const RobotModel* model_;
  double dt_;
  RobotData data_;
  std::array<ConvexPolygon, 2> sole_;
  std::array<double, 2> widest_;  // distance of the middle of each sole from its edge [m]
  Eigen::VectorXd offsets_;
  std::array<Eigen::Vector3d, 2> turn_;             // of each sole up to now [rad]
  std::array<Eigen::Vector2d, 2> cop_;              // from the middle of the sole, low pass [m]
  Eigen::Vector3d tilt_ = Eigen::Vector3d::Zero();  // of both soles, low pass [rad]
  double at_rest_ = 0;                              // time for which there was nothing to turn [s]
};

}  // namespace ayumi
