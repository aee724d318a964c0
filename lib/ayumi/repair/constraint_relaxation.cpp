#include "ayumi/repair/constraint_relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace ayumi {

using Eigen::VectorXd;

namespace {

constexpr double kWindow = 0.1;      // rows of one limit that share a slack [s]
constexpr double kPrice = 100;       // of one unit of violation; a repair costs about 1
constexpr double kHardFactor = 100;  // feet and flight against the rest

// With a tenth of it walks at 0.65 of their time fall when played open loop, with three times of it
// their repair takes twice the iterations and stands no better.
constexpr double kSafetyPrice = 0.1;    // of a millimetre of the ZMP's safety in one window
constexpr double kLandingPrice = 1;     // of a millimetre a low sole is off its place, or too low
constexpr double kCapturePrice = 0.3;   // of a millimetre of xi or ZMP from where they were planned
constexpr double kSafetyWindow = 0.05;  // [s]
constexpr double kMillimetre = 1e-3;

// What is as bad as a millimetre.
double unit_of(ConstraintGroup group) {
  switch (group) {
    case ConstraintGroup::position:
      return 0.01;  // [rad]
    case ConstraintGroup::speed:
    case ConstraintGroup::torque:
    case ConstraintGroup::acceleration:
    case ConstraintGroup::friction:
    case ConstraintGroup::unilateral:
      return 0.01;  // shares
    default:
      return 1e-3;  // [m]
  }
}

// Wanted of swings beyond what the check asks for.
bool of_swing(ConstraintGroup group) {
  return group == ConstraintGroup::landing || group == ConstraintGroup::foot_clearance;
}

// Wanted beyond the check, and may be missing without end.
bool is_wish(ConstraintGroup group) { return of_swing(group) || group == ConstraintGroup::capture; }

// Of the objective, for a unit.
double wish_price(ConstraintGroup group) {
  return of_swing(group)                     ? kLandingPrice
         : group == ConstraintGroup::capture ? kCapturePrice
                                             : kSafetyPrice;
}

bool is_hard(ConstraintGroup group) {
  return group == ConstraintGroup::stance || group == ConstraintGroup::path ||
         group == ConstraintGroup::flight || group == ConstraintGroup::swing;
}

// Rows of the soft program: the old ones, then the upper bounds of soft rows that have two.
struct Layout {
  std::vector<int> twice;  ///< old rows that appear again
};

Layout layout_of(const Nlp& nlp, const std::vector<int>& group) {
  Layout layout;
  for (int i = 0; i < static_cast<int>(group.size()); ++i)
    if (group[i] >= 0 && nlp.constraint_lower[i] > -kNoBound && nlp.constraint_upper[i] < kNoBound)
      layout.twice.push_back(i);
  return layout;
}

// What the start is short of each group, in its unit.
VectorXd lacks(const Nlp& nlp, const Slacks& soft_rows) {
  VectorXd g(nlp.constraint_lower.size()), lack = VectorXd::Zero(soft_rows.price.size());
  nlp.constraints(nlp.start, g);
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    const int k = soft_rows.group[static_cast<size_t>(i)];
    if (k < 0) continue;
    const double off = std::max(nlp.constraint_lower[i] - g[i], g[i] - nlp.constraint_upper[i]);
    lack[k] = std::max(lack[k], off / soft_rows.unit[k]);
  }
  return lack;
}

}  // namespace

Nlp elastic(const Nlp& nlp, const Slacks& soft_rows) {
  const std::vector<int>& group = soft_rows.group;
  const VectorXd price = soft_rows.price;
  const auto layout = std::make_shared<Layout>(layout_of(nlp, group));
  const auto n = nlp.start.size(), slacks = price.size();
  const auto m = nlp.constraint_lower.size();
  const auto extra = static_cast<Eigen::Index>(layout->twice.size());
  Nlp soft;
  soft.start.resize(n + slacks);
  soft.start << nlp.start, lacks(nlp, soft_rows).array() + soft_rows.start;
  soft.lower.resize(n + slacks);
  soft.lower << nlp.lower, VectorXd::Zero(slacks);
  soft.upper.resize(n + slacks);
  soft.upper << nlp.upper,
      soft_rows.most.size() > 0 ? soft_rows.most : VectorXd::Constant(slacks, kNoBound);
  soft.start = soft.start.cwiseMin(0.5 * soft.upper);
  soft.constraint_lower.resize(m + extra);
  soft.constraint_upper.resize(m + extra);
  soft.constraint_lower << nlp.constraint_lower, VectorXd::Constant(extra, -kNoBound);
  soft.constraint_upper << nlp.constraint_upper, VectorXd::Zero(extra);

  // Old nonzeros, those of the second rows by the old ones' places, then the slacks'.
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
  auto sign = std::make_shared<std::vector<std::pair<int, int>>>();  // row, slack; by nonzero
  auto value = std::make_shared<std::vector<double>>();
  auto add_slack = [&](int row, int slack, double s) {
    soft.jacobian.add(row, static_cast<int>(n) + slack);
    sign->emplace_back(row, slack);
    value->push_back(s * soft_rows.unit[slack]);
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

Price price_of(ConstraintGroup group) {
  constexpr double kChange = 2 / kObjectiveScale;  // of one of the objective
  if (group == ConstraintGroup::support || is_wish(group))
    return {kMillimetre, kChange * wish_price(group), kSafetyWindow};
  return {unit_of(group), kChange * kPrice, kWindow};
}

Nlp with_soft_safety(const CorrectionProblem& problem, const Nlp& nlp, double dt, double factor,
                     double barrier) {
  Slacks slacks;
  slacks.start = barrier / kSafetyPrice;
  slacks.group.assign(static_cast<size_t>(problem.constraint_count()), -1);
  std::map<std::tuple<int, int, long>, int> index;
  std::vector<double> most, price;
  for (const ConstraintBlock& block : problem.blocks()) {
    const bool wish = is_wish(block.group);
    const double spare = wish ? kNoBound : problem.safety(block.instant) / kMillimetre;
    if ((!wish && block.group != ConstraintGroup::support) || spare <= 0) continue;
    const double t = problem.instants()[block.instant].sample * dt;
    const std::tuple key(static_cast<int>(block.group), block.item, std::lround(t / kSafetyWindow));
    const auto found = index.try_emplace(key, static_cast<int>(most.size()));
    if (found.second) {
      most.push_back(spare);
      price.push_back(factor * wish_price(block.group));
    }
    double& all = most[static_cast<size_t>(found.first->second)];
    all = std::min(all, spare);
    for (int i = 0; i < block.rows; ++i) slacks.group[block.row + i] = found.first->second;
  }
  if (most.empty()) return nlp;
  slacks.most = Eigen::Map<VectorXd>(most.data(), static_cast<Eigen::Index>(most.size()));
  slacks.unit = VectorXd::Constant(slacks.most.size(), kMillimetre);
  slacks.price = Eigen::Map<VectorXd>(price.data(), static_cast<Eigen::Index>(price.size()));
  return elastic(nlp, slacks);
}

Nlp elastic(const CorrectionProblem& problem, const Nlp& nlp, double dt) {
  Slacks slacks;
  slacks.group.assign(static_cast<size_t>(problem.constraint_count()), -1);
  std::map<std::tuple<int, int, long>, int> index;
  std::vector<double> unit, price;
  for (const ConstraintBlock& block : problem.blocks()) {
    if (block.group == ConstraintGroup::pose) continue;  // a lock is a lock
    const double t = problem.instants()[block.instant].sample * dt;
    const std::tuple key(static_cast<int>(block.group), block.item, std::lround(t / kWindow));
    const auto found = index.try_emplace(key, static_cast<int>(unit.size()));
    if (found.second) {
      unit.push_back(unit_of(block.group));
      price.push_back(is_wish(block.group)   ? wish_price(block.group)
                      : is_hard(block.group) ? kPrice * kHardFactor
                                             : kPrice);
    }
    for (int i = 0; i < block.rows; ++i) slacks.group[block.row + i] = found.first->second;
  }
  slacks.unit = Eigen::Map<VectorXd>(unit.data(), static_cast<Eigen::Index>(unit.size()));
  slacks.price = Eigen::Map<VectorXd>(price.data(), static_cast<Eigen::Index>(price.size()));
  return elastic(nlp, slacks);
}

}  // namespace ayumi
