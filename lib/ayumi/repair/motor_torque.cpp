// The wrench (f, n) of a foot about the base origin adds -ratio (a . n - a . (p x f)) to the torque
// of a joint between base and sole, with a the joint's axis and p its position from that origin.
// With m = n - p x f, a small rotation w of everything below the joint, about a point from which p
// is at r, changes the product a . m by
//   w . (a x m - (a . r) f + (r . f) a),
// and a . f of a sliding joint by w . (a x f). The sharing of the wrench between two feet depends
// on the ZMP alone and is piecewise smooth; its slope is taken by differences within a piece.
#include "ayumi/repair/motor_torque.hpp"

#include "ayumi/repair/policy.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

using FootWrenches = std::array<Vector6d, 2>;

// The derivatives of the foot wrenches by base position and wrench, 6 x 9, by Side.
std::array<Eigen::Matrix<double, 6, 9>, 2> sharing_slope(const RobotModel& model,
                                                         const CollocationPoint& point,
                                                         const Vector3d& base,
                                                         const Vector6d& wrench) {
  std::array<Eigen::Matrix<double, 6, 9>, 2> slope;
  for (auto& s : slope) s.setZero();
  if (!(point.contact[0] && point.contact[1])) {
    for (int s = 0; s < 2; ++s)
      if (point.contact[s]) slope[s].rightCols<6>().setIdentity();
    return slope;
  }
  for (int i = 0; i < 9; ++i) {
    const double h = i < 3 ? repair_policy::solver::kBaseStep : repair_policy::solver::kWrenchStep;
    Vector3d base_up = base, base_down = base;
    Vector6d up = wrench, down = wrench;
    if (i < 3) {
      base_up[i] += h;
      base_down[i] -= h;
    } else {
      up[i - 3] += h;
      down[i - 3] -= h;
    }
    const FootWrenches a = shared_load(model, point, base_up, up);
    const FootWrenches b = shared_load(model, point, base_down, down);
    for (int s = 0; s < 2; ++s) slope[s].col(i) = (a[s] - b[s]) / (2 * h);
  }
  return slope;
}

// The gradient of the moment `m` or, for a sliding joint, of the force `f` along the joint's axis
// with respect to a small rotation about a point; `r` is the place of the joint relative to this
// point.
Vector3d by_rotation(const Body& body, const Vector3d& axis, const Vector3d& r, const Vector3d& m,
                     const Vector3d& f) {
  if (body.prismatic) return axis.cross(f);
  return axis.cross(m) - axis.dot(r) * f + r.dot(f) * axis;
}

// Adds the contribution of one foot's wrench to the torques: derivatives by the wrench, and by the
// configuration at a constant wrench.
void add_foot(const RobotModel& model, Side side, const Vector6d& wrench, const RobotData& data,
              const Matrix3d& tangent, MatrixXd& by_wrench, MatrixXd& by_value) {
  const Vector3d f = wrench.head<3>();
  for (int i = model.sole(side).body; i > 0; i = model.bodies()[i].parent) {
    const Body& body = model.bodies()[i];
    const Vector3d &axis = data.axis[i], &p = data.position[i];
    const Vector3d m = wrench.tail<3>() - p.cross(f);
    Eigen::Matrix<double, 1, 6> row = Eigen::Matrix<double, 1, 6>::Zero();
    if (body.prismatic)
      row.head<3>() = axis.transpose();
    else
      row << -axis.cross(p).transpose(), axis.transpose();
    by_wrench.row(body.dof) -= body.ratio * row;
    by_value.row(body.dof).segment<3>(3) -=
        body.ratio * by_rotation(body, axis, p, m, f).transpose() * tangent;
    for (int j = body.parent; j > 0; j = model.bodies()[j].parent) {
      const Body& above = model.bodies()[j];
      double slope = 0;
      if (!above.prismatic)
        slope = data.axis[j].dot(by_rotation(body, axis, p - data.position[j], m, f));
      else if (!body.prismatic)
        slope = -axis.dot(data.axis[j].cross(f));
      by_value(body.dof, 6 + above.dof) -= body.ratio * above.ratio * slope;
    }
  }
}

}  // namespace

void fill_motor_torques(const RobotModel& model, const ActuatorLimits& actuators,
                        const CollocationPoint& point, PointState& state) {
  const CorrectedMotion& m = state.motion;
  const FootWrenches wrench = shared_load(model, point, m.state.base.position, state.wrench);
  state.torque =
      motor_torques(model, actuators, m.state, m.acceleration, state.force, wrench, state.data);
}

void fill_motor_torque_derivatives(const RobotModel& model, const ActuatorLimits& actuators,
                                   const CollocationPoint& point,
                                   const InverseDynamicsDerivatives& force_by, PointState& state) {
  const CorrectedMotion& m = state.motion;
  const Vector3d& base = m.state.base.position;
  const FootWrenches wrench = shared_load(model, point, base, state.wrench);
  const int dof = model.dof_count();
  state.torque_by[0] = force_by.configuration.bottomRows(dof);
  state.torque_by[1] = force_by.velocity.bottomRows(dof);
  state.torque_by[2] = force_by.acceleration.bottomRows(dof);
  const auto slope = sharing_slope(model, point, base, state.wrench);
  for (Side side : {Side::left, Side::right}) {
    const int s = static_cast<int>(side);
    if (!point.contact[s]) continue;
    MatrixXd by_wrench = MatrixXd::Zero(dof, 6);
    add_foot(model, side, wrench[s], state.data, m.tangent, by_wrench, state.torque_by[0]);
    for (int k = 0; k < 3; ++k)
      state.torque_by[k] += by_wrench * slope[s].rightCols<6>() * state.wrench_by[k];
    state.torque_by[0].leftCols<3>() += by_wrench * slope[s].leftCols<3>();
  }
  // The rotor inertia, viscous friction, and Coulomb friction within the ramp of its sign.
  for (int i = 0; i < dof; ++i) {
    const ServoDescription& servo = actuators.servo[static_cast<size_t>(i)];
    state.torque_by[2](i, 6 + i) += servo.rotor_inertia;
    state.torque_by[1](i, 6 + i) += servo.viscous;
    if (std::abs(m.state.dtheta[i]) < kCoulombRate)
      state.torque_by[1](i, 6 + i) += servo.coulomb / kCoulombRate;
  }
}

}  // namespace ayumi
