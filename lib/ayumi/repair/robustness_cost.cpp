#include "ayumi/repair/robustness_cost.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "ayumi/math/windows.hpp"
#include "ayumi/repair/constraint_relaxation.hpp"
#include "ayumi/repair/repair_setup.hpp"

namespace ayumi {

namespace policy = repair_policy;

using Eigen::VectorXd;

namespace {

bool differ(const RobotState& a, const RobotState& b) {
  return a.theta != b.theta || a.base.position != b.base.position ||
         a.base.attitude.coeffs() != b.base.attitude.coeffs();
}

// The times at which the motions differ, extended by the reach of the control points that act
// there.
std::vector<TimeWindow> windows_of_change(const CommandSeries& before, const CommandSeries& after,
                                          double spacing) {
  const double pad = 4 * spacing;  // a cubic spline has four control points at each time
  std::vector<TimeWindow> windows;
  for (size_t k = 0; k < before.samples.size(); ++k) {
    if (!differ(before.samples[k].state, after.samples[k].state)) continue;
    const double t = before.dt * static_cast<double>(k);
    windows.emplace_back(t - pad, t + pad);
  }
  return merged(std::move(windows));
}

// The price of the places of the feet does not depend on the robustness factor `safety`.
double price_factor(const RowKind& kind, double safety) {
  return kind.relaxed == &RowPrices::foot ? 1 : safety;
}

double violation_of(const CorrectionProblem& problem, const RowBlock& block, const VectorXd& g) {
  double most = 0;
  for (int i = block.row; i < block.row + block.rows(); ++i)
    most = std::max({most, problem.lower()[i] - g[i], g[i] - problem.upper()[i]});
  most /= price_of(*block.kind).unit;
  return most > policy::prices::kMet ? most : 0;
}

}  // namespace

double robustness_cost(const RobotModel& model, const CommandSeries& before,
                       const CommandSeries& after, const RepairOptions& options,
                       const ConsistencyReport& check) {
  if (before.samples.size() != after.samples.size()) return 0;
  CorrectionSpec spec = repair_spec(model, before, options);
  spec.windows = windows_of_change(before, after, spec.spacing);
  if (spec.windows.empty()) return 0;
  spec.wrong_plan = wrong_plan(check);
  const CollisionModel collisions(model);
  spec.collisions = &collisions;
  for (const CommandSeries* series : {&before, &after})
    add_near_pairs(model, *series, collisions, spec.near_pairs);
  spec.seen = {&after};
  spec.joint_margin = 0;
  const CorrectionProblem problem(model, before, spec);
  const VectorXd g = problem.constraints_of(after);
  // Violations by limit and window.
  std::map<std::tuple<const RowKind*, int, long>, double> violations;
  double sum = 0;
  for (const RowBlock& block : problem.blocks()) {
    const int k = problem.points()[static_cast<size_t>(block.point)].sample;
    const auto sample = static_cast<size_t>(k);
    if (!block.kind->beyond_check ||
        !differ(before.samples[sample].state, after.samples[sample].state))
      continue;
    const ViolationPrice price = price_of(*block.kind);
    const std::tuple key(block.kind, block.item, std::lround(k * before.dt / price.window));
    double& most = violations[key];
    const double here = violation_of(problem, block, g);
    sum += price_factor(*block.kind, options.safety) * std::max(0.0, here - most) * price.change;
    most = std::max(most, here);
  }
  return sum;
}

}  // namespace ayumi
