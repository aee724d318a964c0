#include "ayumi/study/runs.hpp"

#include <cmath>

#include "ayumi/model/gravity.hpp"

namespace ayumi {

CommandSeries standing_series(const CommandSeries& series) {
  CommandSeries stand;
  stand.dt = series.dt;
  if (const Eigen::VectorXd* weight = series.joint_weight_at(0))
    stand.joint_weight = {{0, *weight}};
  const double duration = kStandingPush + kStandingAfter;
  stand.samples.assign(static_cast<size_t>(std::lround(duration / series.dt)) + 1,
                       series.samples.front());
  if (!series.viip.empty())
    stand.viip = {{0, static_cast<long>(stand.samples.size()) - 1, CogGoal{}}};
  return stand;
}

double divergence(const Simulator& run) {
  const CommandSample& cmd = run.plan();
  const Estimate& e = run.last_estimate();
  const double w = std::sqrt(kGravity / (cmd.cog.z() - cmd.zmp.z()));
  return ((e.cog - cmd.cog) + (e.dcog - cmd.dcog) / w).head<2>().norm();
}

}  // namespace ayumi
