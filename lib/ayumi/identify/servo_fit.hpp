#pragma once
// Least squares of the constants of one servo, or of one type of servo, with their covariance.

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "ayumi/identify/servo_response.hpp"

namespace ayumi {

/// The constants that joints of one type share, by their place in a fit.
enum class Constant { delay, compliance, damping, dry, backlash };
inline constexpr int kConstants = 5;

struct ServoFit {
  std::vector<ServoConstants> constants;  ///< by joint; only the offsets differ
  /// Of delay, compliance, damping, dry, backlash, then of the joints' offsets. A constant that was
  /// held has variance 0.
  Eigen::MatrixXd covariance;
  double t_factor = 1.96;                 ///< half width of a 95 % interval, in standard deviations
  std::vector<Eigen::VectorXd> residual;  ///< measured - simulated by joint and compared row [rad]
  double rms = 0;                         ///< [rad]
  double independent = 0;                 ///< residuals that are independent of each other
  double model_error = 0;                 ///< part of the residuals that is not noise, rms [rad]
};

/// Covariance of parameters from the Jacobian of `residuals`, joint after joint, and the factor of
/// a 95 % interval in standard deviations. Residuals may be correlated in time: their scores are
/// summed over blocks longer than that correlation.
Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& jacobian,
                              const std::vector<Eigen::VectorXd>& residuals, double& factor);

/// Rows that a fit can compare: those where `known` holds and has held for the time that a servo
/// needs to settle, and will hold for as long. The joint starts where the recording does, but not
/// with its torque. Where the joint rests for longer than this, it stands where friction and the
/// creep of its gear have left it, which shows no constant: such rows are left out. Empty when none
/// is left.
std::vector<Eigen::Index> telling_rows(const JointRecording& joint, const std::vector<char>& known);

/// Root of the mean squared error of these constants at the compared rows [rad].
double rms_error(const std::vector<JointRecording>& joints,
                 const std::vector<ServoConstants>& constants);

/// Fits from `start`; constants in `held` keep the value of the start. The covariance holds for
/// residuals that are correlated in time: their scores are summed over blocks longer than that
/// correlation.
ServoFit fit_servo(const std::vector<JointRecording>& joints,
                   const std::vector<ServoConstants>& start,
                   const std::array<bool, kConstants>& held, double longest_delay);

/// A start: the best of the delays up to the longest, with the other constants by linear least
/// squares of the motion at each of them.
std::vector<ServoConstants> first_guess(const std::vector<JointRecording>& joints,
                                        double longest_delay);

}  // namespace ayumi
