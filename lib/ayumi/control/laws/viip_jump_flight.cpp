// Between release and touchdown no foot is anchored: momentum gives the base velocity,
//   V_b = M_bb^-1 ([m v; L_B] - M_bq dtheta),  L_B = L + (p_G - p_B) x m v,
// its attitude is the IMU's, and its place puts the COG on the parabola.
#include <Eigen/LU>

#include "ayumi/control/laws/jump_parts.hpp"
#include "ayumi/control/laws/viip_jump.hpp"
#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/weighted_solve.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using namespace jump;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kRunOn = 0.030;       // time constant of the legs running on after release [s]
constexpr double kRetract = 0.050;     // before touchdown: legs give way to the ground [s]
constexpr double kRetractShare = 0.6;  // of the falling speed, at touchdown
constexpr double kBlind = 0.040;       // after release: forces are not a touchdown yet [s]
constexpr double kTouchShare = 0.1;    // of the weight: touchdown when it lasts,
constexpr double kTouchTime = 0.003;   // as long as this [s],
constexpr double kHardTouch = 0.4;     // or at once from this share on
constexpr double kFootRate = 40;       // correction of feet in flight [1/s]
constexpr double kPostureRate = 2;     // pull towards the held posture [1/s]
constexpr double kDamping = 1e-5;      // of the flight's solve
constexpr double kLength = 0.2;        // that makes its angular rows comparable [m]

}  // namespace

// The flight begins at the posture the joints have just been moved to.
void ViipJump::release() {
  const VectorXd rates = anchored_velocity_map(*model_, data_, anchor_) * reference_.dtheta;
  MatrixXd M;
  mass_matrix(*model_, data_, M);
  flight_.momentum = angular_momentum_rows(data_, M) * rates;
  flight_.velocity = M.topRows<3>() * rates / model_->mass();
  anchor_base(*model_, anchor_, plan_.feet[static_cast<size_t>(anchor_)], reference_, data_);
  flight_.cog = data_.cog;
  const double v = flight_.velocity.z(), ground = ground_of(plan_.feet);
  const double fall = std::max(0.0, flight_.cog.z() - ground - height_);
  const double down = std::sqrt(v * v + 2 * kGravity * fall);
  flight_.duration = (v + down) / kGravity;
  flight_.retraction = kRetractShare * down * std::min(kRetract, 0.4 * flight_.duration) / 2;

  const double yaw = heading_of(plan_.feet);
  const Vector3d way = goal_.forward * Vector3d(std::cos(yaw), std::sin(yaw), 0);
  Vector3d landing = flight_.cog + flight_.duration * flight_.velocity;
  landing.z() = ground + height_ + flight_.retraction;
  for (const Side side : {Side::left, Side::right}) {
    const auto s = static_cast<size_t>(side);
    flight_.feet[s] = plan_.feet[s].translation() - flight_.cog;
    plan_.feet[s].translation() += way;
    flight_.landing[s] = plan_.feet[s].translation() - landing;
  }
  enter(Stage::flight);
}

// Of a sole from the COG, t after release. The legs run on with the speed they had, swing to where
// they land, and begin to give way shortly before that.
Vector3d ViipJump::foot_place(int side, double t) const {
  const Flight& f = flight_;
  const auto s = static_cast<size_t>(side);
  const double T = f.duration;
  Vector3d place = f.feet[s] + smooth((t / T - 0.05) / 0.75) * (f.landing[s] - f.feet[s]) -
                   f.velocity * t * std::exp(-t / kRunOn);
  const double last = std::min(kRetract, 0.4 * T), u = (t - (T - last)) / last;
  if (u > 0) place.z() += f.retraction * (u < 1 ? u * u : 2 * u - 1);
  return place;
}

void ViipJump::fly(const Estimate& e, ControlOutput& out) {
  const double t = elapsed_;
  const Vector3d fall(0, 0, -kGravity);
  const Vector3d cog = flight_.cog + t * flight_.velocity + 0.5 * t * t * fall;
  dcog_ = flight_.velocity + t * fall;
  reference_.base.attitude = e.state.base.attitude;
  reference_.base.position.setZero();
  update_positions(*model_, reference_, data_);
  reference_.base.position = cog - data_.cog;
  move_base(reference_.base, data_);
  out.cog = cog;
  out.cog_reference = {Vector3d(zmp_.x(), zmp_.y(), ground_of(plan_.feet)), 0, fall, dcog_};

  MatrixXd M;
  mass_matrix(*model_, data_, M);
  const int n = model_->dof_count();
  Eigen::Matrix<double, 6, 1> momentum;  // about the base origin
  momentum << model_->mass() * dcog_,
      flight_.momentum + data_.cog_offset.cross(model_->mass() * dcog_);
  const Eigen::PartialPivLU<MatrixXd> base_inertia(MatrixXd(M.topLeftCorner<6, 6>()));
  const MatrixXd base_map = -base_inertia.solve(M.topRightCorner(6, n));
  const VectorXd base_drift = base_inertia.solve(momentum);

  MatrixXd J(12, n);
  VectorXd u(12);
  for (const Side side : {Side::left, Side::right}) {
    const int s = static_cast<int>(side);
    const Isometry3d sole = sole_pose(*model_, data_, side);
    const MatrixXd rows =
        body_jacobian(*model_, data_, model_->sole(side).body, sole.translation());
    Eigen::Matrix<double, 6, 1> wanted;
    const Vector3d now = foot_place(s, t), next = foot_place(s, t + dt_);
    wanted.head<3>() = (next - now) / dt_ + dcog_ + kFootRate * (cog + now - sole.translation());
    wanted.tail<3>() =
        kFootRate * log_rotation(Eigen::Quaterniond(Matrix3d(
                        plan_.feet[static_cast<size_t>(s)].linear() * sole.linear().transpose())));
    J.middleRows<6>(6 * s) = rows.rightCols(n) + rows.leftCols<6>() * base_map;
    u.segment<6>(6 * s) = wanted - rows.leftCols<6>() * base_drift;
    J.middleRows<3>(6 * s + 3) *= kLength;
    u.segment<3>(6 * s + 3) *= kLength;
  }
  const VectorXd bias = kPostureRate * (held_.state.theta - reference_.theta);
  VectorXd dtheta = weighted_least_norm(J, u, weight_, bias, kDamping);
  for (int j = 0; j < n; ++j) {
    const Dof& dof = model_->dofs()[j];
    dtheta[j] = std::clamp(dtheta[j], -limits_.speed[j], limits_.speed[j]);
    if (dof.limited)
      dtheta[j] = std::clamp(dtheta[j], (dof.lower - reference_.theta[j]) / dt_,
                             (dof.upper - reference_.theta[j]) / dt_);
  }
  VectorXd velocity(6 + n);
  velocity << base_map * dtheta + base_drift, dtheta;
  move_joints(velocity, out);
  elapsed_ += dt_;
  const double load = e.fz / (model_->mass() * kGravity);
  loaded_ = load > kTouchShare ? loaded_ + dt_ : 0;
  const bool touched = elapsed_ > kBlind && (loaded_ >= kTouchTime || load > kHardTouch);
  if (touched || elapsed_ > flight_.duration + 0.15) touch_down(e);
}

// The reference goes on from the posture and speed of the landing.
void ViipJump::touch_down(const Estimate& e) {
  momentum_rate_.setZero();
  velocity_.resize(0);
  zmp_filtered_ = zmp_ = e.zmp.head<2>();
  const auto a = static_cast<size_t>(anchor_), f = static_cast<size_t>(other(anchor_));
  anchor_base(*model_, anchor_, plan_.feet[a], reference_, data_);
  // The other foot stays where it has come down.
  const Isometry3d sole = sole_pose(*model_, data_, other(anchor_));
  const double height = plan_.feet[f].translation().z();
  plan_.feet[f].translation() << sole.translation().head<2>(), height;
  plan_.feet[f].linear() = rpy_to_matrix({0, 0, matrix_to_rpy(sole.linear()).z()});
  enter(Stage::absorb);
}

}  // namespace ayumi
