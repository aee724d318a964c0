#include "ayumi/identify/servo_fit.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "ayumi/base/error.hpp"
#include "ayumi/math/linear_solve.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Rate of the command below which a joint rests [rad/s], and half of the time over which the rate
// is computed [s]. Chosen: far below the rates of a motion, and above a step of one count.
constexpr double kRestRate = 0.01, kRateTime = 0.01;

// Units of the constants in a fit, so that the numbers of the search are near 1: ms, 0.1 mrad/(N
// m), ms, and 0.1 mrad for the last three.
constexpr std::array<double, kConstants + 1> kUnit = {1e-3, 1e-4, 1e-3, 1e-4, 1e-4, 1e-4};

// Size of the differences for the derivatives, in these units. Chosen: it changes the angle by a
// thousandth of a count.
constexpr double kStep = 0.005;

// Time between two residuals of a joint [s] that do not contain the same noise of a reading.
// Chosen: five rows of a HOAP.
constexpr double kNoiseTime = 0.005;

// Correlation below which residuals count as independent. Chosen: the usual value for block sums.
constexpr double kIndependent = 0.1;

ServoConstants constants_of(const double* shared, double offset) {
  return {shared[0] * kUnit[0], shared[1] * kUnit[1], shared[2] * kUnit[2],
          shared[3] * kUnit[3], shared[4] * kUnit[4], offset * kUnit[5]};
}

// The measured minus the simulated angle of one joint, in the unit of offsets. Derivatives by
// constants that are held are zero.
class JointError final : public ceres::CostFunction {
 public:
  JointError(const JointRecording& joint, const std::array<bool, kConstants>& held)
      : joint_(joint), held_(held) {
    mutable_parameter_block_sizes()->assign({kConstants, 1});
    set_num_residuals(static_cast<int>(joint.compared.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    std::array<double, kConstants + 1> x;
    std::copy_n(parameters[0], kConstants, x.begin());
    x[kConstants] = parameters[1][0];
    std::vector<ServoConstants> servos = {constants_of(x.data(), x[kConstants])};
    std::vector<int> moved;
    for (int i = 0; i <= kConstants && jacobians; ++i) {
      const bool wanted =
          i < kConstants ? jacobians[0] && !held_[static_cast<size_t>(i)] : jacobians[1] != nullptr;
      if (!wanted) continue;
      auto ahead = x;
      ahead[static_cast<size_t>(i)] += kStep;
      servos.push_back(constants_of(ahead.data(), ahead[kConstants]));
      moved.push_back(i);
    }
    MatrixXd theta;
    servo_responses(joint_, servos, theta);
    const auto error = [&](Index servo) -> VectorXd {
      return (joint_.measured - theta.col(servo))(joint_.compared) / kUnit[5];
    };
    const Index count = num_residuals();
    const VectorXd at = error(0);
    Eigen::Map<VectorXd>(residuals, count) = at;
    if (!jacobians) return true;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    if (jacobians[0]) Eigen::Map<RowMajor>(jacobians[0], count, kConstants).setZero();
    for (size_t m = 0; m < moved.size(); ++m) {
      const bool shared = moved[m] < kConstants;
      Eigen::Map<RowMajor> jacobian(jacobians[shared ? 0 : 1], count, shared ? kConstants : 1);
      jacobian.col(shared ? moved[m] : 0) = (error(static_cast<Index>(m) + 1) - at) / kStep;
    }
    return true;
  }

 private:
  const JointRecording& joint_;
  const std::array<bool, kConstants> held_;
};

// The number of rows after which the residuals are independent.
Index correlation_length(const std::vector<VectorXd>& residuals) {
  Index longest = 1;
  for (const VectorXd& r : residuals) {
    const double variance = r.squaredNorm();
    if (variance <= 0) continue;
    for (Index lag = 1; lag < r.size() / 8; lag += std::max<Index>(1, lag / 8)) {
      const double c = r.head(r.size() - lag).dot(r.tail(r.size() - lag)) / variance;
      if (c < kIndependent) break;
      longest = std::max(longest, lag + 1);
    }
  }
  return longest;
}

// The covariance of the scores, summed over blocks.
struct ScoreCovariance {
  MatrixXd value;
  Index blocks = 0;
};
ScoreCovariance block_sums(const MatrixXd& scores, const std::vector<Index>& sizes, Index length) {
  ScoreCovariance sum{MatrixXd::Zero(scores.cols(), scores.cols()), 0};
  Index begin = 0;
  for (const Index size : sizes) {
    for (Index at = 0; at < size; at += length) {
      const Index rows = std::min(length, size - at);
      const VectorXd block = scores.middleRows(begin + at, rows).colwise().sum().transpose();
      sum.value += block * block.transpose();
      ++sum.blocks;
    }
    begin += size;
  }
  return sum;
}

double model_error(const std::vector<JointRecording>& joints,
                   const std::vector<VectorXd>& residuals) {
  double sum = 0, variance = 0, count = 0;
  for (size_t j = 0; j < joints.size(); ++j) {
    const VectorXd& r = residuals[j];
    const Index lag = std::max<Index>(1, std::lround(kNoiseTime / joints[j].dt));
    if (r.size() <= lag) continue;
    sum += r.head(r.size() - lag).dot(r.tail(r.size() - lag));
    variance += r.squaredNorm();
    count += static_cast<double>(r.size());
  }
  if (count == 0) return 0;
  // The value that uncorrelated residuals give by chance is subtracted.
  return std::sqrt(std::max(0.0, sum / count - 2 * variance / count / std::sqrt(count)));
}

}  // namespace

MatrixXd covariance_of(const MatrixXd& jacobian, const std::vector<VectorXd>& residuals,
                       double& factor) {
  const Index n = jacobian.rows(), p = jacobian.cols();
  VectorXd all(n);
  std::vector<Index> sizes;
  Index at = 0;
  for (const VectorXd& r : residuals) {
    all.segment(at, r.size()) = r;
    at += r.size();
    sizes.push_back(r.size());
  }
  const MatrixXd scores = all.asDiagonal() * jacobian;
  const MatrixXd normal = jacobian.transpose() * jacobian;
  const MatrixXd inverse = solve_least_norm(normal, MatrixXd::Identity(p, p));
  const double noise = all.squaredNorm() / static_cast<double>(std::max<Index>(1, n - p));
  MatrixXd covariance = noise * inverse;
  const Index length = correlation_length(residuals);
  // Blocks of a few correlation lengths, but at least thirty of them.
  const Index block = std::clamp<Index>(4 * length, 1, std::max<Index>(1, n / 30));
  const ScoreCovariance sum = block_sums(scores, sizes, block);
  const double count = static_cast<double>(sum.blocks), free = std::max(2.0, count - p);
  const MatrixXd robust = count / free * (inverse * sum.value * inverse);
  // The larger of both variances is taken; scaling keeps the correlations of the parameters.
  VectorXd scale(p);
  for (Index i = 0; i < p; ++i)
    scale[i] =
        covariance(i, i) > 0 ? std::sqrt(std::max(1.0, robust(i, i) / covariance(i, i))) : 1.0;
  covariance = scale.asDiagonal() * covariance * scale.asDiagonal();
  // An approximation of Student's t for 95 %, to better than 1 % from 5 degrees of freedom on.
  factor = 1.96 + 2.4 / free + 3.0 / (free * free);
  return covariance;
}

std::vector<Index> telling_rows(const JointRecording& joint, const std::vector<char>& known) {
  const Index rows = joint.measured.size();
  const auto wait = static_cast<Index>(std::ceil(kSettle / joint.dt));
  std::vector<Index> telling;
  Index held = 0, rested = wait;
  for (Index k = 0; k < rows; ++k) {
    held = known[static_cast<size_t>(k)] ? held + 1 : 0;
    const double t = joint.dt * static_cast<double>(k);
    const double change = command_at(joint, t + kRateTime) - command_at(joint, t - kRateTime);
    rested = std::abs(change) > 2 * kRateTime * kRestRate ? 0 : rested + 1;
    // The end of the recording does not count as a change of the load.
    bool holds = held > wait;
    for (Index ahead = k + 1; holds && ahead < std::min(rows, k + wait); ++ahead)
      holds = known[static_cast<size_t>(ahead)];
    if (holds && rested < wait) telling.push_back(k);
  }
  return telling;
}

namespace {

/// The sum of the squared errors of one joint with each of these servos [rad^2].
VectorXd squared_errors(const JointRecording& joint, const std::vector<ServoConstants>& servos) {
  MatrixXd theta;
  servo_responses(joint, servos, theta);
  theta.colwise() -= joint.measured;
  return theta(joint.compared, Eigen::all).colwise().squaredNorm().transpose();
}

}  // namespace

double rms_error(const std::vector<JointRecording>& joints,
                 const std::vector<ServoConstants>& constants) {
  double sum = 0, count = 0;
  for (size_t j = 0; j < joints.size(); ++j) {
    sum += squared_errors(joints[j], {constants[j]})[0];
    count += static_cast<double>(joints[j].compared.size());
  }
  return std::sqrt(sum / count);
}

ServoFit fit_servo(const std::vector<JointRecording>& joints,
                   const std::vector<ServoConstants>& start,
                   const std::array<bool, kConstants>& held, double longest_delay) {
  const auto joint_count = static_cast<Index>(joints.size());
  std::array<double, kConstants> shared = {
      start[0].delay / kUnit[0], start[0].compliance / kUnit[1], start[0].damping / kUnit[2],
      start[0].dry / kUnit[3], start[0].backlash / kUnit[4]};
  std::vector<double> offsets;
  for (const ServoConstants& each : start) offsets.push_back(each.offset / kUnit[5]);
  ceres::Problem problem;
  for (size_t j = 0; j < joints.size(); ++j)
    problem.AddResidualBlock(new JointError(joints[j], held), nullptr, shared.data(), &offsets[j]);
  for (int i = 0; i < kConstants; ++i) problem.SetParameterLowerBound(shared.data(), i, 0);
  problem.SetParameterUpperBound(shared.data(), 0, longest_delay / kUnit[0]);
  std::vector<int> constant;
  for (int i = 0; i < kConstants; ++i)
    if (held[static_cast<size_t>(i)]) constant.push_back(i);
  if (!constant.empty())
    problem.SetManifold(shared.data(), new ceres::SubsetManifold(kConstants, constant));
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 60;
  options.function_tolerance = 1e-9;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-7;
  // After each step, Ceres looks along it for a smaller error, because the constants have bounds.
  // With the default, a cubic interpolation, this search computes all derivatives at every point;
  // with a quadratic one, it computes only the errors.
  options.line_search_interpolation_type = ceres::QUADRATIC;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  // The place where the joint comes to rest changes suddenly when its friction changes, so the
  // error has more than one minimum over the friction. Therefore, other values of the friction are
  // tried.
  constexpr int kDry = static_cast<int>(Constant::dry);
  constexpr std::array<double, 9> kOtherFriction = {0.3, 0.5, 0.7, 0.85, 1.15, 1.4, 1.8, 2.5, 4};
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable())
      fail(ErrorCode::solver, "the constants of a servo were not found: " + summary.message);
    const double found = shared[kDry];
    std::vector<double> tried = {found};
    for (const double factor : kOtherFriction) tried.push_back(factor * std::max(found, 0.1));
    VectorXd squares = VectorXd::Zero(static_cast<Index>(tried.size()));
    for (size_t j = 0; j < joints.size(); ++j) {
      std::vector<ServoConstants> servos;
      for (const double dry : tried) {
        shared[kDry] = dry;
        servos.push_back(constants_of(shared.data(), offsets[j]));
      }
      squares += squared_errors(joints[j], servos);
    }
    Index best = 0;  // the first of equal values
    squares.minCoeff(&best);
    shared[kDry] = tried[static_cast<size_t>(best)];
    if (best == 0) break;
  }

  ServoFit fit;
  std::vector<double> residuals;
  problem.Evaluate({}, nullptr, &residuals, nullptr, nullptr);
  Index at = 0;
  for (size_t j = 0; j < joints.size(); ++j) {
    fit.constants.push_back(constants_of(shared.data(), offsets[j]));
    const auto count = static_cast<Index>(joints[j].compared.size());
    fit.residual.push_back(kUnit[5] * Eigen::Map<const VectorXd>(residuals.data() + at, count));
    at += count;
  }
  fit.rms = kUnit[5] * std::sqrt(Eigen::Map<const VectorXd>(residuals.data(), at).squaredNorm() /
                                 static_cast<double>(at));
  fit.model_error = model_error(joints, fit.residual);
  fit.independent = static_cast<double>(at) / static_cast<double>(correlation_length(fit.residual));
  // The Jacobian by all constants that were free and may move, and by the offsets.
  std::vector<Index> free;
  for (int i = 0; i < kConstants; ++i)
    if (!held[static_cast<size_t>(i)]) free.push_back(i);
  for (Index j = 0; j < joint_count; ++j) free.push_back(kConstants + j);
  MatrixXd jacobian = MatrixXd::Zero(at, static_cast<Index>(free.size()));
  at = 0;
  for (size_t j = 0; j < joints.size(); ++j) {
    const JointError error(joints[j], held);
    const Index count = error.num_residuals();
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by_shared(count,
                                                                                     kConstants),
        by_offset(count, 1);
    VectorXd r(count);
    const double* parameters[2] = {shared.data(), &offsets[j]};
    double* jacobians[2] = {by_shared.data(), by_offset.data()};
    error.Evaluate(parameters, r.data(), jacobians);
    for (size_t i = 0; i < free.size(); ++i) {
      if (free[i] < kConstants)
        jacobian.block(at, static_cast<Index>(i), count, 1) = by_shared.col(free[i]);
      else if (free[i] == kConstants + static_cast<Index>(j))
        jacobian.block(at, static_cast<Index>(i), count, 1) = by_offset;
    }
    at += count;
  }
  std::vector<VectorXd> scaled;
  for (const VectorXd& r : fit.residual) scaled.push_back(r / kUnit[5]);
  const MatrixXd covariance = covariance_of(jacobian, scaled, fit.t_factor);
  fit.covariance = MatrixXd::Zero(kConstants + joint_count, kConstants + joint_count);
  const auto unit = [&](Index i) { return kUnit[static_cast<size_t>(std::min<Index>(i, 5))]; };
  for (size_t i = 0; i < free.size(); ++i)
    for (size_t k = 0; k < free.size(); ++k)
      fit.covariance(free[i], free[k]) =
          covariance(static_cast<Index>(i), static_cast<Index>(k)) * unit(free[i]) * unit(free[k]);
  return fit;
}

std::vector<ServoConstants> first_guess(const std::vector<JointRecording>& joints,
                                        double longest_delay) {
  // Every delay is tried in steps of half a millisecond, up to the longest one.
  constexpr double kDelayStep = 0.0005;
  const auto joint_count = static_cast<Index>(joints.size());
  double best = std::numeric_limits<double>::infinity();
  std::vector<ServoConstants> found(joints.size());
  for (double delay = 0; delay <= longest_delay + 1e-9; delay += kDelayStep) {
    // The unknowns are compliance, dry friction, and an offset for each joint. Damping starts
    // small, since a delay has nearly the same effect.
    MatrixXd normal = MatrixXd::Zero(2 + joint_count, 2 + joint_count);
    VectorXd right = VectorXd::Zero(2 + joint_count);
    double square = 0;
    for (size_t j = 0; j < joints.size(); ++j) {
      const JointRecording& joint = joints[j];
      double last = command_at(joint, -delay), direction = 0;
      auto next = joint.compared.begin();
      for (Index k = 0; k < joint.measured.size() && next != joint.compared.end(); ++k) {
        const double target = command_at(joint, joint.dt * static_cast<double>(k) - delay);
        if (target != last) direction = target > last ? 1 : -1;
        last = target;
        if (k != *next) continue;
        ++next;
        VectorXd row = VectorXd::Zero(2 + joint_count);
        row[0] = -joint.torque[k] * 1e-4;
        row[1] = -direction * 1e-4;
        row[2 + static_cast<Index>(j)] = 1;
        const double value = joint.measured[k] - target;
        normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
        right += value * row;
        square += value * value;
      }
    }
    const MatrixXd full = normal.selfadjointView<Eigen::Lower>();
    const VectorXd x = solve_least_norm(full, right);
    const double left = square - x.dot(right);
    if (!(left < best)) continue;
    best = left;
    for (size_t j = 0; j < joints.size(); ++j) {
      found[j] = {};
      found[j].delay = delay;
      found[j].compliance = std::clamp(1e-4 * x[0], 2e-5, 1e-2);
      found[j].damping = 5e-4;
      found[j].dry = std::clamp(1e-4 * x[1], 2e-5, 1e-2);
      found[j].offset = x[2 + static_cast<Index>(j)];
    }
  }
  return found;
}

}  // namespace ayumi
