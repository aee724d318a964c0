#pragma once
// The states of all collocation points for one set of variables of the program. Rows, Jacobian and
// curvature at the same variables share them. Points do not depend on each other, so several
// threads compute them; the bytes are the same for any number of threads.

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include "ayumi/base/in_parallel.hpp"
#include "ayumi/repair/constraint_rows.hpp"

namespace ayumi {

class PointStates {
 public:
  /// All arguments must outlive this object. With `threads` = 0, all cores work.
  PointStates(const RobotModel& model, const ActuatorLimits& actuators, const CommandSeries& motion,
              const std::vector<CollocationPoint>& points, int threads);

  /// Calls job(point, state, workspace) for every point on several threads. The state is that for
  /// the control points `coefficients`, with or without derivatives. A result that was already
  /// computed for the same control points is not computed again.
  template <class Job>
  void for_each(const Eigen::MatrixXd& coefficients, bool derivatives, const Job& job) {
    start(coefficients);
    const size_t parts = workspaces_.size(), count = points_.size();
    std::atomic<bool> stop = false;
    in_parallel(parts, threads_, stop, [&](size_t part) {
      for (size_t i = part * count / parts; i < (part + 1) * count / parts; ++i) {
        complete(i, derivatives, *workspaces_[part]);
        job(i, states_[i], *workspaces_[part]);
      }
    });
  }

  int threads() const { return threads_; }

 private:
  enum class Filled : char { nothing, values, derivatives };

  void start(const Eigen::MatrixXd& coefficients);
  void complete(size_t i, bool derivatives, DerivativeWorkspace& workspace);

  const RobotModel& model_;
  const ActuatorLimits& actuators_;
  const CommandSeries& motion_;
  const std::vector<CollocationPoint>& points_;
  int threads_;
  Eigen::MatrixXd coefficients_;
  std::vector<PointState> states_;
  std::vector<Filled> filled_;
  std::vector<std::unique_ptr<DerivativeWorkspace>>
      workspaces_;  ///< one for each part of the points
};

}  // namespace ayumi
