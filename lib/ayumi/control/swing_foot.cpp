#include "ayumi/control/swing_foot.hpp"

#include "ayumi/model/gravity.hpp"

namespace ayumi {

namespace {

// Smallest share of the weight with which a foot counts as standing on the ground. Chosen: twice
// the 5 % below which there is no ZMP (control/estimator), above the noise of the load cells. Half
// or twice the value changes measured cases by 5 % or more (constants.md).
constexpr double kBearingShare = 0.1;

}  // namespace

double sole_half_width(const RobotModel& model) {
  double low = 1e9, high = -1e9;
  for (const Eigen::Vector2d& p : model.sole(Side::left).polygon) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  return 0.5 * (high - low);
}

bool bears(const RobotModel& model, const Estimate& estimate, Side side) {
  return estimate.foot_fz[static_cast<size_t>(side)] > kBearingShare * model.mass() * kGravity;
}

}  // namespace ayumi
