#include "ayumi/dynamics/kinematics.hpp"

#include <array>

#include "ayumi/math/rotation.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

void update_positions(const RobotModel& model, const RobotState& state, RobotData& data) {
  const kernels::Job job = {.attitude = state.base.attitude.coeffs().data(),
                            .theta = state.theta.data()};
  Vector3d moment;
  data.kernels->positions(data.tree(), job, data.bodies(), moment.data());
  data.base_position = state.base.position;
  data.cog_offset = moment / model.mass();
  data.cog = data.base_position + data.cog_offset;
}

void carry_velocities(const RobotModel& model, const RobotState& state, RobotData& data) {
  const kernels::Job job = {.angular_velocity = state.base_angular_velocity.data(),
                            .dtheta = state.dtheta.data(),
                            .velocity = state.base_velocity.data()};
  Vector3d momentum;
  data.kernels->velocities(data.tree(), job, data.bodies(), momentum.data());
  data.dcog = momentum / model.mass();
}

void update_velocities(const RobotModel& model, const RobotState& state, RobotData& data) {
  update_positions(model, state, data);
  carry_velocities(model, state, data);
}

void move_base(const BasePose& base, RobotData& data) {
  const Matrix3d attitude = base.attitude.toRotationMatrix();
  const Matrix3d turn = attitude * data.rotation[0].transpose();
  data.rotation[0] = attitude;
  data.com[0] = turn * data.com[0];
  for (size_t i = 1; i < data.rotation.size(); ++i) {
    data.rotation[i] = (turn * data.rotation[i]).eval();
    data.position[i] = (turn * data.position[i]).eval();
    data.axis[i] = (turn * data.axis[i]).eval();
    data.com[i] = (turn * data.com[i]).eval();
  }
  data.base_position = base.position;
  data.cog_offset = (turn * data.cog_offset).eval();
  data.cog = data.base_position + data.cog_offset;
}

Isometry3d link_pose(const RobotModel& model, const RobotData& data, int link) {
  const Link& l = model.links()[link];
  return data.pose(l.body) * l.pose;
}

Isometry3d sole_pose(const RobotModel& model, const RobotData& data, Side side) {
  const Sole& sole = model.sole(side);
  return data.pose(sole.body) * sole.frame;
}

Vector3d point_velocity(const RobotData& data, int body, const Vector3d& point) {
  return data.velocity[body] +
         data.angular_velocity[body].cross(point - data.base_position - data.position[body]);
}

MatrixXd body_jacobian(const RobotModel& model, const RobotData& data, int body,
                       const Vector3d& point) {
  MatrixXd J = MatrixXd::Zero(6, model.velocity_count());
  const Vector3d p = point - data.base_position;
  J.block<3, 3>(0, 0).setIdentity();
  J.block<3, 3>(0, 3) = -skew(p);
  J.block<3, 3>(3, 3).setIdentity();
  for (int i = body; i > 0; i = model.bodies()[i].parent) {
    const Body& b = model.bodies()[i];
    const Vector3d a = b.ratio * data.axis[i];
    if (b.prismatic) {
      J.block<3, 1>(0, 6 + b.dof) += a;
    } else {
      J.block<3, 1>(0, 6 + b.dof) += a.cross(p - data.position[i]);
      J.block<3, 1>(3, 6 + b.dof) += a;
    }
  }
  return J;
}

namespace {

/// Largest number of joints whose angles go through the kernel at once. Definition: the size of a
/// workspace, which limits nothing.
constexpr size_t kJointsAtOnce = 8;

/// The attitude (in link axes) and origin of a body in the base frame, from its own chain of joints
/// alone.
void carry_to(const RobotState& state, const RobotData& data, int body, Matrix3d& R, Vector3d& p) {
  std::array<int, kJointsAtOnce> chain;  // the last joints, from the body inwards
  std::array<double, kJointsAtOnce> q, s, c;
  size_t count = 0;
  for (; body > 0 && count < kJointsAtOnce; ++count) {
    const kernels::Link& link = data.links[static_cast<size_t>(body)];
    chain[count] = body;
    q[count] = link.ratio * state.theta[link.dof] + link.offset;
    body = link.parent;
  }
  data.kernels->sine_cosine(q.data(), s.data(), c.data(), static_cast<int>(count));
  if (body > 0) {
    carry_to(state, data, body, R, p);
  } else {
    R.setIdentity();
    p.setZero();
  }
  while (count-- > 0) {
    const kernels::Link& link = data.links[static_cast<size_t>(chain[count])];
    p += R * Eigen::Map<const Vector3d>(link.r);
    if (link.turned)
      R = (R * Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(link.E)).eval();
    if (link.prismatic) {
      p += q[count] * R.col(link.axis);
      continue;
    }
    const int a = (link.axis + 1) % 3, b = (link.axis + 2) % 3;
    const Vector3d x = R.col(a), y = R.col(b);
    R.col(a) = c[count] * x + s[count] * y;
    R.col(b) = c[count] * y - s[count] * x;
  }
}

}  // namespace

void anchor_base(const RobotModel& model, Side support, const Isometry3d& sole, RobotState& state,
                 RobotData& data) {
  const Sole& own = model.sole(support);
  Isometry3d body = Isometry3d::Identity();
  Matrix3d R;
  Vector3d p;
  carry_to(state, data, own.body, R, p);
  const kernels::Link& link = data.links[static_cast<size_t>(own.body)];
  if (link.skewed)
    R = (R * Eigen::Map<const Matrix3d>(link.C))
            .eval();  // the matrix is transposed, because it is stored by rows
  body.linear() = R;
  body.translation() = p;
  const Isometry3d base = sole * (body * own.frame).inverse();
  state.base.position = base.translation();
  state.base.attitude = Eigen::Quaterniond(base.linear()).normalized();
  update_positions(model, state, data);
}

}  // namespace ayumi
