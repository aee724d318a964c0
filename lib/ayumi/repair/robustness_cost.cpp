#include "ayumi/repair/robustness_cost.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "ayumi/math/windows.hpp"
#include "ayumi/repair/constraint_relaxation.hpp"
#include "ayumi/repair/repair_setup.hpp"

namespace ayumi {

using Eigen::VectorXd;

namespace {

bool differ(const RobotState& a, const RobotState& b) {
  return a.theta != b.theta || a.base.position != b.base.position ||
         a.base.attitude.coeffs() != b.base.attitude.coeffs();
}

// Where `after` is another motion, wide enough for the control points that act there.
std::vector<std::pair<double, double>> windows_of(const CommandSeries& before,
                                                  const CommandSeries& after, double spacing) {
  const double pad = 4 * spacing;
  std::vector<std::pair<double, double>> windows;
  for (size_t k = 0; k < before.samples.size(); ++k) {
    if (!differ(before.samples[k].state, after.samples[k].state)) continue;
    const double t = before.dt * static_cast<double>(k);
    windows.emplace_back(t - pad, t + pad);
  }
  return merged(std::move(windows));
}

// What the check asks for as well is no matter of safety: a motion that breaks it does not pass.
bool is_bought(ConstraintGroup group) {
  switch (group) {
    case ConstraintGroup::support:
    case ConstraintGroup::unilateral:
    case ConstraintGroup::stance:
    case ConstraintGroup::swing:
    case ConstraintGroup::landing:
    case ConstraintGroup::foot_clearance:
    case ConstraintGroup::position:
    case ConstraintGroup::clearance:
    case ConstraintGroup::capture:
      return true;
    default:
      return false;
  }
}

// Feet stay in their places whatever safety is worth.
double factor_of(ConstraintGroup group, double safety) {
  const bool foot = group == ConstraintGroup::stance || group == ConstraintGroup::swing;
  return foot ? 1 : safety;
}

double lack(const CorrectionProblem& problem, const ConstraintBlock& block, const VectorXd& g) {
  constexpr double kMet = 1e-6;  // of its unit: the solver's tolerance
  double most = 0;
  for (int i = block.row; i < block.row + block.rows; ++i)
    most = std::max({most, problem.lower()[i] - g[i], g[i] - problem.upper()[i]});
  most /= price_of(block.group).unit;
  return most > kMet ? most : 0;
}

}  // namespace

double safety_price(const RobotModel& model, const CommandSeries& before,
                    const CommandSeries& after, const RepairOptions& options,
                    const ConsistencyReport& check) {
  if (before.samples.size() != after.samples.size()) return 0;
  CorrectionSpec spec = repair_spec(model, before, options);
  spec.windows = windows_of(before, after, spec.spacing);
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
  std::map<std::tuple<int, int, long>, double> lacks;  // by limit and window
  double sum = 0;
  for (const ConstraintBlock& block : problem.blocks()) {
    const int k = problem.instants()[static_cast<size_t>(block.instant)].sample;
    const auto sample = static_cast<size_t>(k);
    if (!is_bought(block.group) ||
        !differ(before.samples[sample].state, after.samples[sample].state))
      continue;
    const Price price = price_of(block.group);
    const std::tuple key(static_cast<int>(block.group), block.item,
                         std::lround(k * before.dt / price.window));
    double& most = lacks[key];
    const double here = lack(problem, block, g);
    sum += factor_of(block.group, options.safety) * std::max(0.0, here - most) * price.change;
    most = std::max(most, here);
  }
  return sum;
}

}  // namespace ayumi
