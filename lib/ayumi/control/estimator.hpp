#pragma once
// What a controller can know: encoders, tilt, gyro and foot load cells turned into COG, its rate,
// ZMP and vertical force, all in the plan frame (the frame in which the stance foot is where the
// plan says). World drift of the robot therefore never enters the control law.

#include <array>

#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/math/polygon.hpp"

namespace ayumi {

/// Load cells of one foot.
struct FootLoad {
  double fz = 0;                                  ///< sum of the cells [N]
  Eigen::Vector2d cop = Eigen::Vector2d::Zero();  ///< centre of pressure, sole frame [m]
};

/// One frame of sensor data.
struct Measurement {
  Eigen::VectorXd theta, dtheta;                                 ///< encoders [rad], [rad/s]
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< of the IMU link, world
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();                ///< IMU link axes [rad/s]
  std::array<FootLoad, 2> feet;                                  ///< by Side
};

struct Estimate {
  RobotState state;                                     ///< plan frame
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();        ///< plan frame [m]
  Eigen::Vector3d dcog = Eigen::Vector3d::Zero();       ///< [m/s]
  Eigen::Vector3d zmp = Eigen::Vector3d::Zero();        ///< plan frame, held in flight [m]
  double fz = 0;                                        ///< [N]
  std::array<double, 2> foot_fz = {0, 0};               ///< of each foot [N]
  bool contact = true;                                  ///< f_z at least 5 % of the weight
  Side stance = Side::left;                             ///< foot that carries the robot
  Eigen::Vector3d foot_tilt = Eigen::Vector3d::Zero();  ///< of the stance foot against the plan, as
                                                        ///< a rotation vector without yaw [rad];
                                                        ///< without what its sole yields
  double stance_inside = 1;  ///< distance of the stance foot's centre of pressure from the nearest
                             ///< edge of its sole, as a share of the largest: 0 at the edge
};

class Estimator {
 public:
  Estimator(const RobotModel& model, double dt);

  /// `feet`: planned sole frames. The stance foot is the one that carries more than 60 %; its
  /// centre of pressure is put at its planned place on the ground and taken as the momentary point
  /// of support, so a foot that tips on its edge does not disturb the estimate. Holds until the
  /// next update.
  const Estimate& update(const Measurement& measurement,
                         const std::array<Eigen::Isometry3d, 2>& feet);

  /// In place of update() if the estimate of this tick is not needed: computes only the quantities
  /// on which later estimates depend, the loads and the ZMP. Later estimates are the same to the
  /// last bit.
  void follow_loads(const Measurement& measurement, const std::array<Eigen::Isometry3d, 2>& feet);

  /// Of the last update().
  const Estimate& last() const { return last_; }

 private:
  const RobotModel* model_;
  RobotData data_;
  std::array<ConvexPolygon, 2> sole_;
  std::array<double, 2> widest_;          // distance of the middle of each sole from its edge [m]
  std::array<Eigen::Matrix2d, 2> yield_;  // tilt of each sole per moment, sole frame [rad/(N m)]
  int imu_;                               // link
  double filter_;                         // share of the new load taken per tick
  std::array<double, 2> load_ = {0, 0};   // low-passed f_z of each foot [N]
  bool first_ = true;
  Estimate last_;
};

}  // namespace ayumi
