#pragma once
// ZMP preview control, one of the baselines of DTAD. The jerk of the COG follows from the state of
// the COG, the previous ZMP and the coming planned ZMP. The ZMP follows from the measured state
// with the same gains. After Kajita and others, "Biped walking pattern generation by using preview
// control of zero-moment point" (2003). docs/theory_baselines.md, "Preview control".

#include <Eigen/Core>
#include <memory>

#include "ayumi/control/command_plan.hpp"

namespace ayumi {

/// The gains for the cart-table with the state (x, dx, ddx), where the unit of time is 1/omega:
///   jerk(k) = -integral sum_{i<=k} e(i) - state (x, dx, ddx)(k) - sum_j preview(j) planned
///   ZMP(k+j),
/// where ZMP = x - ddx and e = ZMP - planned ZMP. It minimizes the sum of e^2 + effort / tick^2
/// times the square of the jerk's change.
struct PreviewGains {
  double integral = 0;
  Eigen::RowVector3d state = Eigen::RowVector3d::Zero();
  /// K and D omega with which the ZMP reacts to the COG and its speed after the jerk has followed:
  /// the slower two poles of the closed loop are those of x'' = x - K x - D x'.
  Eigen::Vector2d zmp = Eigen::Vector2d::Zero();
  /// Gains of j = 1, 2, ...; the last one contains those of all later ticks.
  Eigen::VectorXd preview;
  /// The matrices of the Riccati equation that the gains solve, for (e, change of the state): A, B,
  /// Q, R, P.
  Eigen::Matrix4d A, Q, P;
  Eigen::Vector4d B;
  double R = 0;
};

/// `tick` and `horizon` are in units of 1/omega. Throws Error(usage) if no gains can be computed
/// for this effort and tick.
PreviewGains preview_gains(double tick, double effort, double horizon);

/// The horizontal motion of the COG.
struct CogMotion {
  Eigen::Vector2d cog = Eigen::Vector2d::Zero();    ///< place [m]
  Eigen::Vector2d dcog = Eigen::Vector2d::Zero();   ///< velocity [m/s]
  Eigen::Vector2d ddcog = Eigen::Vector2d::Zero();  ///< acceleration [m/s^2]
};

/// The COG that preview control plans, and the ZMP that brings the measured one back to it.
class PreviewControl {
 public:
  /// Previews the ZMP of `plan`. effort and horizon are those of preview_gains(); feedback is the
  /// share of its state feedback that acts on the measured state.
  PreviewControl(const CommandPlan& plan, double effort, double horizon, double feedback);

  /// PreviewGains::zmp times `feedback`.
  Eigen::Vector2d measured_gains() const { return feedback_ * preview_->gains.zmp; }

  /// The wanted ZMP of this tick, for the command `planned` [m].
  Eigen::Vector2d wanted_zmp(const CommandSample& planned, const Estimate& estimate, double omega);

  /// Continues from tick k of the plan. Returns the motion of the COG in this tick.
  CogMotion go_on(long k, double omega);

  /// Must be called when the robot has left the ground: the preview starts again from the plan.
  void restart() { started_ = false; }

 private:
  struct Preview {
    PreviewGains gains;
    Eigen::MatrixXd zmp;  // planned ZMP, ticks x 2 [m]
  };
  std::shared_ptr<const Preview> preview_;
  double tick_, feedback_;  // tick [1/omega]
  bool started_ = false;
  // State of the COG: place, rate / omega, acceleration / omega^2, and the sum of e [m].
  Eigen::Vector2d x_ = Eigen::Vector2d::Zero(), dx_ = Eigen::Vector2d::Zero(),
                  ddx_ = Eigen::Vector2d::Zero(), sum_ = Eigen::Vector2d::Zero();
};

}  // namespace ayumi
