#include "ayumi/control/swing_foot.hpp"

#include "ayumi/model/gravity.hpp"

namespace ayumi {

namespace {

// Smallest share of the weight with which a foot counts as standing on the ground. Chosen: twice
// the 5 % below which there is no ZMP (control/estimator), above the noise of the load cells. With
// half of the value, figures change by less than 5 %; with twice, the torque of the case "pushed
// steps" changes from 0.499 to 0.454.
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
