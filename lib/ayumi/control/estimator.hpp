#pragma once
// Estimates what a controller can know: the COG, its rate, the ZMP and the vertical force, from the
// readings of encoders, tilt, gyro and load cells of the feet. All results are in the plan frame,
// in which the stance foot is where the plan has it. So drift of the robot in the world never
// affects the control law.

#include <array>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/math/polygon.hpp"

namespace ayumi {

/// The readings of the load cells of one foot.
struct FootLoad {
  double fz = 0;                                  ///< sum of the cells [N]
  Eigen::Vector2d cop = Eigen::Vector2d::Zero();  ///< centre of pressure in the sole frame [m]
};

/// One frame of sensor data.
struct Measurement {
  /// Angles of the joints and their rates [rad], [rad/s]: readings of the encoders, with the zeros
  /// that the file of the robot states (model/encoder_angles).
  Eigen::VectorXd theta, dtheta;
  /// Attitude of the IMU link in the world.
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
  /// Angular velocity in the axes of the IMU link [rad/s].
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();
  std::array<FootLoad, 2> feet;  ///< loads of the feet, by Side
};

struct Estimate {
  RobotState state;                                ///< state in the plan frame
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();   ///< COG in the plan frame [m]
  Eigen::Vector3d dcog = Eigen::Vector3d::Zero();  ///< rate of the COG [m/s]
  /// The ZMP in the plan frame [m]. In flight it keeps its value.
  Eigen::Vector3d zmp = Eigen::Vector3d::Zero();
  double fz = 0;                           ///< vertical force [N]
  std::array<double, 2> foot_fz = {0, 0};  ///< vertical force of each foot [N]
  bool contact = true;                     ///< whether f_z is at least 5 % of the weight
  Side stance = Side::left;                ///< foot that carries the robot
  /// Tilt of the stance foot relative to the plan, as a rotation vector without yaw [rad]; the tilt
  /// that the load of its sole causes is left out.
  Eigen::Vector3d foot_tilt = Eigen::Vector3d::Zero();
  /// Distance of the stance foot's centre of pressure from the nearest edge of its sole, as a share
  /// of the largest possible distance; 0 at the edge.
  double stance_inside = 1;
};

class Estimator {
 public:
  Estimator(const RobotModel& model, double dt);

  /// `feet` are the planned sole frames. The stance foot is the one that carries more than 60 %.
  /// Its centre of pressure is assumed to be at its planned place on the ground and counts as the
  /// momentary point of support, so a foot that tips over its edge does not disturb the estimate.
  /// The result is valid until the next update.
  const Estimate& update(const Measurement& measurement,
                         const std::array<Eigen::Isometry3d, 2>& feet);

  /// May be called instead of update() if the estimate of this tick is not needed. Computes only
  /// the loads and the ZMP, on which later estimates depend. Later estimates are the same to the
  /// last bit.
  void follow_loads(const Measurement& measurement, const std::array<Eigen::Isometry3d, 2>& feet);

  /// The result of the last update().
  const Estimate& last() const { return last_; }

 private:
  const RobotModel* model_;
  RobotData data_;
  std::array<ConvexPolygon, 2> sole_;
  std::array<double, 2> widest_;  // distance of the middle of each sole from its edge [m]
  // Tilt of each sole per moment, in the sole frame [rad/(N m)].
  std::array<Eigen::Matrix2d, 2> yield_;
  int imu_;                              // index of the IMU's link
  double filter_;                        // share of the new load that is taken over in each tick
  std::array<double, 2> load_ = {0, 0};  // f_z of each foot after a low pass [N]
  bool first_ = true;
  Estimate last_;
};

}  // namespace ayumi
