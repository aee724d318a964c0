#include "ayumi/model/encoder_angles.hpp"

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd encoder_zeros(const ActuatorLimits& actuators) {
  VectorXd zeros(static_cast<Eigen::Index>(actuators.servo.size()));
  for (Eigen::Index j = 0; j < zeros.size(); ++j)
    zeros[j] = actuators.servo[static_cast<size_t>(j)].offset;
  return zeros;
}

VectorXd encoder_angles(const VectorXd& joints, const VectorXd& zeros) {
  return zeros.isZero(0) ? joints : VectorXd(joints - zeros);
}

VectorXd joint_angles(const VectorXd& encoders, const VectorXd& zeros) {
  return zeros.isZero(0) ? encoders : VectorXd(encoders + zeros);
}

MatrixXd encoder_rows(MatrixXd joints, const VectorXd& zeros) {
  if (!zeros.isZero(0)) joints.rowwise() -= zeros.transpose();
  return joints;
}

MatrixXd joint_rows(MatrixXd encoders, const VectorXd& zeros) {
  if (!zeros.isZero(0)) encoders.rowwise() += zeros.transpose();
  return encoders;
}

}  // namespace ayumi
