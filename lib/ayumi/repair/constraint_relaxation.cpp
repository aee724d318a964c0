#include "ayumi/repair/constraint_relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>

namespace ayumi {

namespace policy = repair_policy;

using Eigen::VectorXd;

namespace {

// Rows of the relaxed program: first the old rows, then the upper bounds of relaxed rows that have
// two bounds.
struct RelaxedLayout {
  std::vector<int> twice;  ///< old rows that appear a second time
};

RelaxedLayout layout_of(const Nlp& nlp, const std::vector<int>& group) {
  RelaxedLayout layout;
  for (int i = 0; i < static_cast<int>(group.size()); ++i)
    if (group[i] >= 0 && nlp.constraint_lower[i] > -kNoBound && nlp.constraint_upper[i] < kNoBound)
      layout.twice.push_back(i);
  return layout;
}

// The violation at the start for each slack, as a multiple of the slack's unit.
VectorXd start_violations(const Nlp& nlp, const Slacks& slacks) {
  VectorXd g(nlp.constraint_lower.size()), violation = VectorXd::Zero(slacks.price.size());
  nlp.constraints(nlp.start, g);
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    const int k = slacks.group[static_cast<size_t>(i)];
    if (k < 0) continue;
    const double off = std::max(nlp.constraint_lower[i] - g[i], g[i] - nlp.constraint_upper[i]);
    violation[k] = std::max(violation[k], off / slacks.unit[k]);
  }
  return violation;
}

}  // namespace

Nlp relaxed(const Nlp& nlp, const Slacks& relaxation) {
  const std::vector<int>& group = relaxation.group;
  const VectorXd price = relaxation.price;
  const auto layout = std::make_shared<RelaxedLayout>(layout_of(nlp, group));
  const auto n = nlp.start.size(), slacks = price.size();
  const auto m = nlp.constraint_lower.size();
  const auto extra = static_cast<Eigen::Index>(layout->twice.size());
  Nlp soft;
  soft.start.resize(n + slacks);
  soft.start << nlp.start, start_violations(nlp, relaxation).array() + relaxation.start;
  soft.lower.resize(n + slacks);
  soft.lower << nlp.lower, VectorXd::Zero(slacks);
  soft.upper.resize(n + slacks);
  soft.upper << nlp.upper,
      relaxation.most.size() > 0 ? relaxation.most : VectorXd::Constant(slacks, kNoBound);
  soft.start = soft.start.cwiseMin(policy::solver::kSlackShare * soft.upper);
  soft.constraint_lower.resize(m + extra);
  soft.constraint_upper.resize(m + extra);
  soft.constraint_lower << nlp.constraint_lower, VectorXd::Constant(extra, -kNoBound);
  soft.constraint_upper << nlp.constraint_upper, VectorXd::Zero(extra);

  if (nlp.start_multipliers.size() > 0) {
    soft.start_multipliers.resize(m + extra);
    soft.start_multipliers << nlp.start_multipliers, VectorXd::Zero(extra);
    // Multipliers of lower bounds are below 0, and those of upper bounds are above 0.
    for (Eigen::Index i = 0; i < extra; ++i) {
      double& first = soft.start_multipliers[layout->twice[i]];
      soft.start_multipliers[m + i] = std::max(0.0, first);
      first = std::min(0.0, first);
    }
  }

  // The nonzeros have this order: first the old ones, then those of the second rows (at the columns
  // of the old rows), then those of the slacks.
  soft.jacobian = nlp.jacobian;
  std::vector<int> second(static_cast<size_t>(m), -1);
  for (Eigen::Index i = 0; i < extra; ++i) {
    const int row = layout->twice[i];
    second[row] = static_cast<int>(m + i);
    soft.constraint_upper[m + i] = nlp.constraint_upper[row];
    soft.constraint_upper[row] = kNoBound;
  }
  auto repeated = std::make_shared<std::vector<int>>();
  for (int k = 0; k < nlp.jacobian.size(); ++k) {
    if (second[nlp.jacobian.rows[k]] < 0) continue;
    repeated->push_back(k);
    soft.jacobian.add(second[nlp.jacobian.rows[k]], nlp.jacobian.columns[k]);
  }
  auto sign =
      std::make_shared<std::vector<std::pair<int, int>>>();  // row and slack of each nonzero
  auto value = std::make_shared<std::vector<double>>();
  auto add_slack = [&](int row, int slack, double s) {
    soft.jacobian.add(row, static_cast<int>(n) + slack);
    sign->emplace_back(row, slack);
    value->push_back(s * relaxation.unit[slack]);
  };
  for (int i = 0; i < static_cast<int>(m); ++i) {
    if (group[i] < 0) continue;
    add_slack(i, group[i], nlp.constraint_lower[i] > -kNoBound ? 1 : -1);
    if (second[i] >= 0) add_slack(second[i], group[i], -1);
  }
  soft.hessian = nlp.hessian;

  soft.objective = [&nlp, n, price](const VectorXd& x) {
    return nlp.objective(x.head(n)) + price.dot(x.tail(price.size()));
  };
  soft.gradient = [&nlp, n, price](const VectorXd& x, VectorXd& g) {
    VectorXd inner = VectorXd::Zero(n);
    nlp.gradient(x.head(n), inner);
    g << inner, price;
  };
  soft.constraints = [&nlp, n, m, layout, sign, value](const VectorXd& x, VectorXd& g) {
    VectorXd inner(m);
    nlp.constraints(x.head(n), inner);
    g.head(m) = inner;
    for (size_t i = 0; i < layout->twice.size(); ++i)
      g[m + static_cast<Eigen::Index>(i)] = inner[layout->twice[i]];
    for (size_t i = 0; i < sign->size(); ++i)
      g[(*sign)[i].first] += (*value)[i] * x[n + (*sign)[i].second];
  };
  const auto count = nlp.jacobian.size();
  soft.jacobian_values = [&nlp, n, count, repeated, value](const VectorXd& x, VectorXd& values) {
    VectorXd inner = VectorXd::Zero(count);
    nlp.jacobian_values(x.head(n), inner);
    values.head(count) = inner;
    Eigen::Index next = count;
    for (const int k : *repeated) values[next++] = inner[k];
    for (const double v : *value) values[next++] = v;
  };
  soft.hessian_values = [&nlp, n, m, layout](const VectorXd& x, double scale,
                                             const VectorXd& multipliers, VectorXd& values) {
    VectorXd inner = multipliers.head(m);
    for (size_t i = 0; i < layout->twice.size(); ++i)
      inner[layout->twice[i]] += multipliers[m + static_cast<Eigen::Index>(i)];
    nlp.hessian_values(x.head(n), scale, inner, values);
  };
  return soft;
}

VectorXd unrelaxed_multipliers(const Nlp& nlp, const Slacks& slacks, const VectorXd& multipliers) {
  const std::vector<int> twice = layout_of(nlp, slacks.group).twice;
  const auto m = nlp.constraint_lower.size();
  VectorXd result = multipliers.head(m);
  for (size_t i = 0; i < twice.size(); ++i)
    result[twice[i]] += multipliers[m + static_cast<Eigen::Index>(i)];
  return result;
}

ViolationPrice price_of(const RowKind& kind) {
  // Unit of the change. Derived: the weighted change that costs 1 in the objective.
  constexpr double kChange = 2 / policy::change_weight::kObjectiveScale;
  const RowPrices prices = row_prices();
  if (kind.soft_goal)
    return {prices.*kind.unit, kChange * prices.*kind.soft_goal, policy::prices::kSoftGoalWindow};
  return {prices.*kind.unit, kChange * prices.limit, policy::prices::kLimitWindow};
}

namespace {

// Collects the slacks: one for each limit (kind and item) and window of time.
class SlackCollector {
 public:
  SlackCollector(const CorrectionProblem& problem, double dt, double window)
      : problem_(problem), dt_(dt), window_(window) {
    slacks_.group.assign(static_cast<size_t>(problem.constraint_count()), -1);
  }

  // If blocks share a slack, the smallest `most` of these blocks applies to the slack.
  void add(const RowBlock& block, double unit, double price, double most) {
    const double t = problem_.points()[block.point].sample * dt_;
    const std::tuple key(block.kind, block.item, std::lround(t / window_));
    const auto [found, is_new] = index_.try_emplace(key, static_cast<int>(unit_.size()));
    if (is_new) {
      unit_.push_back(unit);
      price_.push_back(price);
      most_.push_back(most);
    }
    double& bound = most_[static_cast<size_t>(found->second)];
    bound = std::min(bound, most);
    for (int i = 0; i < block.rows(); ++i) slacks_.group[block.row + i] = found->second;
  }

  Slacks collected() {
    slacks_.unit = vector_of(unit_);
    slacks_.price = vector_of(price_);
    slacks_.most = vector_of(most_);
    return slacks_;
  }

 private:
  static VectorXd vector_of(const std::vector<double>& values) {
    return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }

  const CorrectionProblem& problem_;
  double dt_, window_;
  Slacks slacks_;
  std::map<std::tuple<const RowKind*, int, long>, int> index_;
  std::vector<double> unit_, price_, most_;
};

}  // namespace

Slacks soft_goal_slacks(const CorrectionProblem& problem, double dt, double robustness,
                        double barrier) {
  SlackCollector collector(problem, dt, policy::prices::kSoftGoalWindow);
  const RowPrices prices = row_prices();
  for (const RowBlock& block : problem.blocks()) {
    const RowKind& kind = *block.kind;
    if (!kind.soft_goal) continue;
    const double unit = prices.*kind.unit;
    const double most = std::min(block.most_violation / unit, kNoBound);
    if (most > 0) collector.add(block, unit, robustness * prices.*kind.soft_goal, most);
  }
  Slacks slacks = collector.collected();
  slacks.start = barrier / policy::prices::kZmpMargin;
  return slacks;
}

Nlp with_all_limits_relaxed(const CorrectionProblem& problem, const Nlp& nlp, double dt) {
  SlackCollector collector(problem, dt, policy::prices::kLimitWindow);
  const RowPrices prices = row_prices();
  for (const RowBlock& block : problem.blocks()) {
    const RowKind& kind = *block.kind;
    if (kind.relaxed) collector.add(block, prices.*kind.unit, prices.*kind.relaxed, kNoBound);
  }
  return relaxed(nlp, collector.collected());
}

}  // namespace ayumi
