#include "ayumi/optimize/repair_spec.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"

namespace ayumi {

using Eigen::VectorXd;

namespace {

constexpr double kMarginBetween = 5e-4;  // of the ZMP, for what happens between constraints [m]
constexpr double kKnotsOfFlight = 8;

int find_joint(const RobotModel& model, const std::string& name, const char* use) {
  const int dof = model.find_dof(name);
  if (dof < 0)
    fail(ErrorCode::usage, std::string(use) + " joint '" + name + "': the robot '" + model.name() +
                               "' has no such joint" + text::suggestion(name, model.dof_names()));
  return dof;
}

std::vector<bool> locked_dofs(const RobotModel& model, const std::vector<std::string>& names) {
  std::vector<bool> locked(model.dof_count(), false);
  for (const std::string& name : names) locked[find_joint(model, name, "locked")] = true;
  return locked;
}

VectorXd weight_factors(const RobotModel& model, const std::map<std::string, double>& weights) {
  VectorXd factors = VectorXd::Ones(model.dof_count());
  for (const auto& [joint, factor] : weights) {
    const int dof = find_joint(model, joint, "weighted");
    if (!(factor > 0) || !std::isfinite(factor))
      fail(ErrorCode::usage, "weight of joint '" + joint + "': " + text::exact(factor) +
                                 " must be above 0 (lock the joint to keep it still)");
    factors[dof] = factor;
  }
  return factors;
}

void require_windows(const std::vector<std::pair<double, double>>& windows) {
  for (const auto& [begin, end] : windows)
    if (!(begin <= end) || !std::isfinite(begin) || !std::isfinite(end))
      fail(ErrorCode::usage, "locked window " + text::exact(begin) + ".." + text::exact(end) +
                                 " s: the end must not come before the beginning");
}

}  // namespace

double safe_margin(const RobotModel& model) {
  double least = kNoBound;
  for (Side side : {Side::left, Side::right}) {
    const ConvexPolygon polygon(model.sole(side).polygon);
    least = std::min(least, polygon.margin(polygon.centroid()));
  }
  return 0.9 * least;
}

double shortest_flight(const CommandSeries& series) {
  double shortest = kNoBound;
  size_t first = 0;
  for (size_t k = 0; k <= series.samples.size(); ++k) {
    if (k < series.samples.size() && series.samples[k].support == Support::none) continue;
    if (k > first) shortest = std::min(shortest, static_cast<double>(k - first) * series.dt);
    first = k + 1;
  }
  return shortest;
}

CorrectionSpec repair_spec(const RobotModel& model, const CommandSeries& series,
                           const RepairOptions& options) {
  require_windows(options.locked_windows);
  CorrectionSpec spec;
  spec.spacing = std::min(options.knot_spacing, shortest_flight(series) / kKnotsOfFlight);
  spec.locked = locked_dofs(model, options.locked_joints);
  spec.locked_feet = options.locked_feet;
  spec.locked_windows = options.locked_windows;
  spec.weights = weight_factors(model, options.joint_weights);
  spec.trust = options.trust;
  spec.tolerance = tolerances(options.check, model, series);
  spec.profile = options.check.profile;
  spec.friction = options.check.friction;
  const double least = tolerances(options.check)[static_cast<int>(Kind::support_margin)];
  const double safe = options.trust == Trust::zmp ? least : safe_margin(model);
  spec.safe_margin = options.zmp_margin.value_or(safe) + kMarginBetween;
  spec.zmp_margin = std::min(spec.safe_margin, least + kMarginBetween);
  return spec;
}

}  // namespace ayumi
