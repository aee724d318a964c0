#include "ayumi/limits/row_site.hpp"

#include <algorithm>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::VectorXd;

WrenchRows linear_rows(const Eigen::Matrix<double, Eigen::Dynamic, 6>& rows) {
  return {.value = [rows](const Vector6d& wrench) -> VectorXd { return rows * wrench; },
          .gradient = [rows](const Vector6d&) -> Eigen::MatrixXd { return rows; }};
}

std::array<Vector6d, 2> shared_load(const RobotModel& model, const CollocationPoint& point,
                                    const Eigen::Vector3d& base, const Vector6d& wrench) {
  const GroundDemand demand =
      ground_demand(point.plane, plane_wrench(point.plane, base, wrench), contact_threshold(model));
  const Support support = point.contact[0]   ? (point.contact[1] ? Support::both : Support::left)
                          : point.contact[1] ? Support::right
                                             : Support::none;
  return foot_wrenches(model, support, point.ground, point.plane, demand, base, wrench);
}

AngleRange range_with_given(AngleRange kept, const AngleRange& allowed, double given,
                            double tolerance) {
  if (given >= allowed.lower - tolerance) kept.lower = std::min(kept.lower, given);
  if (given <= allowed.upper + tolerance) kept.upper = std::max(kept.upper, given);
  return kept;
}

double RowSite::weight() const { return model.mass() * kGravity; }

std::vector<const CommandSample*> RowSite::watched(int point) const {
  const int k = points[point].sample;
  std::vector<const CommandSample*> samples = {&series.samples[k]};
  for (const CommandSeries* result : seen) samples.push_back(&result->samples[k]);
  return samples;
}

const std::vector<GroundDemand>& RowSite::watched_demand(int point) {
  const auto [found, is_new] = demand_of.try_emplace(point);
  if (!is_new) return found->second;
  const SupportPlane& plane = points[point].plane;
  for (const CommandSample* sample : watched(point)) {
    const Vector6d wrench =
        inverse_dynamics(model, sample->state, sample->acceleration, data).head<6>();
    found->second.push_back(ground_demand(
        plane, plane_wrench(plane, sample->state.base.position, wrench), contact_threshold(model)));
  }
  return found->second;
}

double RowSite::most(int point, const std::function<double(const CommandSample&)>& figure) const {
  double most = 0;
  for (const CommandSample* sample : watched(point)) most = std::max(most, figure(*sample));
  return most;
}

RowBlock& RowSite::add(const RowKind& kind, int point, int item, RowRule rule,
                       const VectorXd& lower, const VectorXd& upper) {
  RowBlock block;
  block.kind = &kind;
  block.point = point;
  block.item = item;
  block.rule = std::move(rule);
  block.lower = lower;
  block.upper = upper;
  return rows.emplace_back(std::move(block));
}

RowBlock& RowSite::add(const RowKind& kind, int point, int item, RowRule rule, int count,
                       double lower, double upper) {
  return add(kind, point, item, std::move(rule), VectorXd::Constant(count, lower),
             VectorXd::Constant(count, upper));
}

void RowSite::add_largest(const RowKind& kind, int point, JointQuantity of, int dof, double watched,
                          double largest, double share, double active) {
  if (!(watched > settings.watched_share * largest)) return;
  add(kind, point, dof, JointRow{of, dof, 1 / largest}, 1, -share, share).active = active;
}

}  // namespace ayumi
