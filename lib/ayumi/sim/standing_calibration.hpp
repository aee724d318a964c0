#pragma once
// Offsets of the ankles' encoders, estimated while the robot stands before its motion. A sole whose
// ankle encoder has an offset stands on an edge, because a stiff servo holds the angle that its
// encoder reads. The ankles then turn until every sole carries its load inside its edges and,
// according to the IMU, the soles are level. The angle by which an ankle has turned is the offset
// of its encoder. docs/theory_plant.md, "Encoders with an offset".

#include <array>

#include "ayumi/control/estimator.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

class StandingCalibration {
 public:
  /// The model must outlive this object. `dt` is the time of one update [s].
  StandingCalibration(const RobotModel& model, double dt);

  /// Whether a sole carries load on an edge, or no load at all, although the posture of the plan
  /// puts both soles flat on the ground and its ZMP well inside their hull.
  bool needed(const Measurement& measurement, const CommandSample& plan);

  /// One tick of rest on both feet, in which the offsets change. `measurement` has readings that
  /// are already corrected by offsets(), and `estimate` is computed from it. `feet` are the planned
  /// sole frames.
  void update(const Measurement& measurement, const Estimate& estimate,
              const std::array<Eigen::Isometry3d, 2>& feet);

  /// Whether the two feet have turned by different angles. If they have turned by the same angle,
  /// the ground may slope.
  bool found() const;

  /// Whether every sole has been level and has carried its load inside its edges for some time.
  bool done() const;

  /// The offset of each encoder, its reading minus the true angle [rad], by dof. It is zero for all
  /// joints except the ankles.
  const Eigen::VectorXd& offsets() const { return offsets_; }

  /// One line for each ankle whose offset is large enough to be reported.
  std::vector<std::string> lines() const;

 private:
  double inside(Side side, const FootLoad& load) const;

  const RobotModel* model_;
  double dt_;
  RobotData data_;
  std::array<ConvexPolygon, 2> sole_;
  std::array<double, 2> widest_;  // distance of the middle of each sole from its edge [m]
  Eigen::VectorXd offsets_;
  std::array<Eigen::Vector3d, 2> turn_;  // turn of each sole up to now [rad]
  std::array<Eigen::Vector2d, 2>
      cop_;  // centre of pressure relative to the middle of the sole, after a low pass [m]
  Eigen::Vector3d tilt_ = Eigen::Vector3d::Zero();  // tilt of both soles, after a low pass [rad]
  double at_rest_ = 0;                              // time for which nothing had to be turned [s]
};

}  // namespace ayumi
