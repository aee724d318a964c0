// The rotation part is written once for any scalar: numbers for the motion, dual numbers for its
// derivatives by r, r', r''. The factors of the exponential are power series in |r|^2, without a
// branch: 15 terms are exact to rounding for |r| <= pi.
#include "ayumi/repair/corrected_motion.hpp"

#include <unsupported/Eigen/AutoDiff>

#include "ayumi/math/rotation.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 9, 1>>;
template <class Scalar>
using Vector = Eigen::Matrix<Scalar, 3, 1>;

// The sum over k of (-s)^k / (2k + offset)!, and its derivative with respect to s.
template <class Scalar>
struct Series {
  Scalar value, slope;
};

template <class Scalar>
Series<Scalar> series(const Scalar& s, int offset) {
  double factor = 1;
  for (int i = 2; i <= offset; ++i) factor /= i;
  Series<Scalar> sum{Scalar(factor), Scalar(0.0)};
  Scalar power(1.0);  // s^(k-1)
  for (int k = 1; k <= 15; ++k) {
    factor /= -static_cast<double>((2 * k + offset) * (2 * k + offset - 1));
    sum.slope = sum.slope + Scalar(k * factor) * power;
    power = power * s;
    sum.value = sum.value + Scalar(factor) * power;
  }
  return sum;
}

template <class Scalar>
Vector<Scalar> cross(const Vector<Scalar>& a, const Vector<Scalar>& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(),
          a.x() * b.y() - a.y() * b.x()};
}

template <class Scalar>
Scalar dot(const Vector<Scalar>& a, const Vector<Scalar>& b) {
  return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
}

template <class Scalar>
struct AngularMotion {
  Vector<Scalar> w, dw;
};

template <class Scalar>
AngularMotion<Scalar> angular_motion(const Vector<Scalar>& r, const Vector<Scalar>& dr,
                                     const Vector<Scalar>& ddr, const Vector3d& w0,
                                     const Vector3d& dw0) {
  const Scalar s = dot(r, r);
  const Scalar ds = Scalar(2.0) * dot(r, dr);
  // The series of (1-cos f)/f^2 and (f-sin f)/f^3.
  const Series<Scalar> a = series(s, 2), b = series(s, 3);
  const Scalar sinc = series(s, 1).value;
  const Scalar da = a.slope * ds, db = b.slope * ds;
  const Vector<Scalar> r_dr = cross(r, dr), r_ddr = cross(r, ddr);
  const Vector<Scalar> turn = dr + a.value * r_dr + b.value * cross(r, r_dr);
  const Vector<Scalar> dturn = ddr + da * r_dr + a.value * r_ddr + db * cross(r, r_dr) +
                               b.value * (cross(dr, r_dr) + cross(r, r_ddr));
  auto rotated = [&](const Vector3d& v) {
    const Vector<Scalar> u(Scalar(v.x()), Scalar(v.y()), Scalar(v.z()));
    const Vector<Scalar> ru = cross(r, u);
    return Vector<Scalar>(u + sinc * ru + a.value * cross(r, ru));
  };
  const Vector<Scalar> carried = rotated(w0);
  return {turn + carried, dturn + cross(turn, carried) + rotated(dw0)};
}

Vector<Dual> variables(const Vector3d& v, int first) {
  return {Dual(v.x(), 9, first), Dual(v.y(), 9, first + 1), Dual(v.z(), 9, first + 2)};
}

Matrix3d block(const Vector<Dual>& v, int first) {
  Matrix3d m;
  for (int i = 0; i < 3; ++i) m.row(i) = v[i].derivatives().segment<3>(first).transpose();
  return m;
}

}  // namespace

void fill_motion(const CommandSample& sample, const VectorXd& value, const VectorXd& rate,
                 const VectorXd& second, CorrectedMotion& m) {
  const auto dof = sample.state.theta.size();
  m.state = sample.state;
  m.acceleration = sample.acceleration + second;
  m.state.base.position += value.head<3>();
  m.state.base_velocity += rate.head<3>();
  m.state.theta += value.tail(dof);
  m.state.dtheta += rate.tail(dof);
  const Vector3d r = value.segment<3>(3);
  m.state.base.attitude = (exp_rotation(r) * sample.state.base.attitude).normalized();
  const AngularMotion<double> angular =
      angular_motion<double>(r, rate.segment<3>(3), second.segment<3>(3),
                             sample.state.base_angular_velocity, sample.acceleration.segment<3>(3));
  m.state.base_angular_velocity = angular.w;
  m.acceleration.segment<3>(3) = angular.dw;
}

void fill_motion_derivatives(const CommandSample& sample, const VectorXd& value,
                             const VectorXd& rate, const VectorXd& second, CorrectedMotion& m) {
  const AngularMotion<Dual> angular =
      angular_motion<Dual>(variables(value.segment<3>(3), 0), variables(rate.segment<3>(3), 3),
                           variables(second.segment<3>(3), 6), sample.state.base_angular_velocity,
                           sample.acceleration.segment<3>(3));
  m.w_value = block(angular.w, 0);
  m.w_rate = block(angular.w, 3);
  m.dw_value = block(angular.dw, 0);
  m.dw_rate = block(angular.dw, 3);
  m.dw_acceleration = block(angular.dw, 6);
  m.tangent = m.w_rate;  // w is linear in r', with the factor J(r)
}

}  // namespace ayumi
