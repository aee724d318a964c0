#pragma once
// Least squares for the constants of one servo, or of one type of servo, with their covariance.

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "ayumi/identify/servo_response.hpp"

namespace ayumi {

/// The constants that joints of one type share, by their place in a fit.
enum class Constant { delay, compliance, damping, dry, backlash };
inline constexpr int kConstants = 5;

struct ServoFit {
  std::vector<ServoConstants> constants;  ///< constants by joint, of which only the offsets differ
  /// The covariance of delay, compliance, damping, dry and backlash, and then of the joints'
  /// offsets. A constant that was held has variance 0.
  Eigen::MatrixXd covariance;
  double t_factor = 1.96;  ///< half the width of a 95 % interval, in standard deviations
  /// Measured minus simulated angle, by joint and compared row [rad].
  std::vector<Eigen::VectorXd> residual;
  double rms = 0;          ///< root of the mean squared residual [rad]
  double independent = 0;  ///< number of residuals that are independent of each other
  double model_error = 0;  ///< part of the residuals that is not noise, rms [rad]
};

/// The covariance of parameters from the Jacobian of `residuals`, joint after joint, and the factor
/// of a 95 % interval in standard deviations. Residuals may be correlated in time: their scores are
/// summed over blocks longer than that correlation.
Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& jacobian,
                              const std::vector<Eigen::VectorXd>& residuals, double& factor);

/// The rows that a fit can compare: those in which `known` is true, has been true for the time that
/// a servo needs to settle, and stays true for as long. The simulated joint starts at the recorded
/// angle, but not with the recorded torque. A joint that rests for longer than this time stands
/// where friction and the creep of its gear have left it, which shows no constant; such rows are
/// left out. The result is empty if none is left.
std::vector<Eigen::Index> telling_rows(const JointRecording& joint, const std::vector<char>& known);

/// The root of the mean squared error of these constants at the compared rows [rad].
double rms_error(const std::vector<JointRecording>& joints,
                 const std::vector<ServoConstants>& constants);

/// Fits the constants, beginning at `start`; those in `held` keep the value of the start. The
/// covariance is also valid for residuals that are correlated in time: their scores are summed over
/// blocks longer than that correlation.
ServoFit fit_servo(const std::vector<JointRecording>& joints,
                   const std::vector<ServoConstants>& start,
                   const std::array<bool, kConstants>& held, double longest_delay);

/// Start values: the best of the delays up to the longest, with the other constants by linear least
/// squares of the motion at each delay.
std::vector<ServoConstants> first_guess(const std::vector<JointRecording>& joints,
                                        double longest_delay);

}  // namespace ayumi
