#include "ayumi/model/encoder_angles.hpp"

#include "ayumi/base/error.hpp"

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MeasuredAt measured_at(const std::string& name) {
  if (name == "encoder") return MeasuredAt::encoder;
  if (name == "joint") return MeasuredAt::joint;
  fail(ErrorCode::usage, "measured_at '" + name + "' is not one of encoder and joint");
}

VectorXd encoder_zeros(const RobotModel& model) {
  const std::vector<ServoDescription>& servos = model.limits().servo;
  VectorXd zeros(static_cast<Eigen::Index>(servos.size()));
  for (Eigen::Index j = 0; j < zeros.size(); ++j) zeros[j] = servos[static_cast<size_t>(j)].offset;
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
