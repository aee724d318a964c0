#include "ayumi/repair/point_states.hpp"

namespace ayumi {

using Eigen::MatrixXd;

namespace {

// Number of parts into which the points are divided for the threads, and the smallest number of
// points in a part. Chosen: enough parts for the cores of a workstation; a part of fewer points
// takes less time than starting a thread. Neither changes a result.
constexpr size_t kMostParts = 16, kFewestPoints = 8;

}  // namespace

PointStates::PointStates(const RobotModel& model, const ActuatorLimits& actuators,
                         const CommandSeries& motion, const std::vector<CollocationPoint>& points,
                         int threads)
    : model_(model),
      actuators_(actuators),
      motion_(motion),
      points_(points),
      threads_(threads),
      states_(points.size(), PointState(RobotData(model))),
      filled_(points.size(), Filled::nothing),
      workspaces_(std::clamp<size_t>(points.size() / kFewestPoints, 1, kMostParts)) {
  for (auto& workspace : workspaces_) workspace = std::make_unique<DerivativeWorkspace>(model);
}

void PointStates::start(const MatrixXd& coefficients) {
  if (coefficients.rows() == coefficients_.rows() && coefficients == coefficients_) return;
  coefficients_ = coefficients;
  std::fill(filled_.begin(), filled_.end(), Filled::nothing);
}

void PointStates::complete(size_t i, bool derivatives, DerivativeWorkspace& workspace) {
  const CollocationPoint& point = points_[i];
  const CommandSample& sample = motion_.samples[static_cast<size_t>(point.sample)];
  if (filled_[i] == Filled::nothing) {
    fill_values(model_, actuators_, sample, point, coefficients_, states_[i]);
    filled_[i] = Filled::values;
  }
  if (!derivatives || filled_[i] == Filled::derivatives) return;
  fill_derivatives(model_, actuators_, sample, point, workspace, states_[i]);
  filled_[i] = Filled::derivatives;
}

}  // namespace ayumi
