// With 1/omega as the unit of time, the cart-table is x''' = u, ZMP = x - x''. With X = (e, change
// of x),
//   X+ = [1 CA; 0 A] X + [CB; B] du - [1; 0] change of the planned ZMP,
// the smallest cost is reached by du = -K X - sum_j F(j) change of the planned ZMP(k + j) with P of
// the Riccati equation,
//   K = (R + B'PB)^-1 B'PA,   F(j) = -(R + B'PB)^-1 B' (Ac')^(j-1) P (1, 0),   Ac = A - B K,
// and the jerk is the sum of du over time (Katayama and others 1985). Shifting all places by a
// length changes nothing: F(1) + F(2) + ... = -(gain of x). The gains beyond the horizon are added
// to the last one, so that this holds exactly.
#include "ayumi/control/preview_control.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <utility>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/eigenvalues.hpp"
#include "ayumi/math/riccati.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

PreviewGains preview_gains(double tick, double effort, double horizon) {
  const double t = tick;
  Eigen::Matrix3d a;
  a << 1, t, 0.5 * t * t, 0, 1, t, 0, 0, 1;
  const Vector3d b(t * t * t / 6, 0.5 * t * t, t);
  const Eigen::RowVector3d c(1, 0, -1);
  PreviewGains g;
  g.A << 1, c * a, Vector3d::Zero(), a;
  g.B << c * b, b;
  g.Q.setZero();
  g.Q(0, 0) = 1;
  g.R = effort / (t * t);
  const Eigen::MatrixXd R = Eigen::MatrixXd::Constant(1, 1, g.R);
  g.P = solve_riccati(g.A, g.B, g.Q, R);
  const Eigen::RowVector4d K = regulator_gain(g.A, g.B, R, g.P);
  g.integral = K[0];
  g.state = K.tail<3>();

  // In continuous time, two poles are near -1 (in units of omega); the other two are much faster.
  const std::optional<Eigen::VectorXcd> found = eigenvalues(g.A - g.B * K);
  if (!found)
    fail(ErrorCode::usage, "preview control: no gains can be computed for the effort " +
                               text::brief(effort) + " and the tick " + text::brief(tick) +
                               ". Choose an effort nearer to the default");
  Eigen::VectorXcd poles = *found;
  std::sort(poles.begin(), poles.end(),
            [](const auto& a, const auto& b) { return std::norm(a) > std::norm(b); });
  const double sum = (poles[0] + poles[1]).real(), product = (poles[0] * poles[1]).real();
  g.zmp << 1 + (1 - sum + product) / (t * t), (2 - sum) / t;

  const auto count = static_cast<Eigen::Index>(std::max(1.0, std::ceil(horizon / t)));
  g.preview.resize(count);
  const Eigen::Matrix4d closed = (g.A - g.B * K).transpose();
  const double size = g.R + g.B.dot(g.P * g.B);
  Vector4d cost = g.P.col(0);
  for (Eigen::Index j = 0; j < count; ++j) {
    g.preview[j] = -g.B.dot(cost) / size;
    cost = (closed * cost).eval();
  }
  g.preview[count - 1] += -g.state[0] - g.preview.sum();
  return g;
}

PreviewControl::PreviewControl(const CommandPlan& plan, double effort, double horizon,
                               double feedback)
    : feedback_(feedback) {
  const CommandSample& now = plan.now();
  const double omega = std::sqrt(kGravity / (now.cog.z() - now.zmp.z()));
  tick_ = plan.dt() * omega;
  Preview preview{preview_gains(tick_, effort, horizon), {}};
  const auto samples = static_cast<Eigen::Index>(plan.series().samples.size());
  preview.zmp.resize(samples + 1, 2);
  for (Eigen::Index k = 0; k <= samples; ++k)
    preview.zmp.row(k) = plan.at(static_cast<long>(k)).zmp.head<2>().transpose();
  preview_ = std::make_shared<const Preview>(std::move(preview));
}

Vector2d PreviewControl::wanted_zmp(const CommandSample& planned, const Estimate& estimate,
                                    double omega) {
  if (!started_) {
    x_ = planned.cog.head<2>();
    dx_ = planned.dcog.head<2>() / omega;
    ddx_ = planned.ddcog.head<2>() / (omega * omega);
    sum_.setZero();
    started_ = true;
  }
  const Vector2d gains = measured_gains();
  return x_ - ddx_ + gains[0] * (estimate.cog.head<2>() - x_) +
         gains[1] * (estimate.dcog.head<2>() / omega - dx_);
}

CogMotion PreviewControl::go_on(long k, double omega) {
  const PreviewGains& g = preview_->gains;
  const Eigen::MatrixXd& planned = preview_->zmp;
  const Eigen::Index last = planned.rows() - 1, now = std::min<Eigen::Index>(k, last);
  const Eigen::Index ahead = std::min(g.preview.size(), last - now);
  const double beyond = g.preview.tail(g.preview.size() - ahead).sum();
  sum_ += x_ - ddx_ - planned.row(now).transpose();
  Vector2d jerk = -g.integral * sum_ - g.state[0] * x_ - g.state[1] * dx_ - g.state[2] * ddx_;
  for (int axis = 0; axis < 2; ++axis)
    jerk[axis] -= g.preview.head(ahead).dot(planned.col(axis).segment(now + 1, ahead)) +
                  beyond * planned(last, axis);

  const CogMotion motion{x_, omega * dx_, omega * omega * ddx_};
  x_ += tick_ * dx_ + 0.5 * tick_ * tick_ * ddx_ + tick_ * tick_ * tick_ / 6 * jerk;
  dx_ += tick_ * ddx_ + 0.5 * tick_ * tick_ * jerk;
  ddx_ += tick_ * jerk;
  return motion;
}

}  // namespace ayumi
