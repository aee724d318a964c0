// When another law has controlled the robot before, the COG has an offset p from the plan. The
// offset is reduced to zero along a minimum-jerk blend b(t/T):
//   cog (1 - b) p,  dcog -b'/T p,  ddcog -b''/T^2 p,  zmp (1 - b + b''/(T^2 omega^2)) p,
// which obeys (14)(15).
#include "ayumi/control/command_plan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ayumi/math/rotation.hpp"
#include "ayumi/math/track.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

// Time over which an offset of the COG is reduced to zero [s]. Chosen: five time constants 1/omega
// of HOAP-1, so the ZMP moves by little more than the offset itself; a shorter blend moves it more.
// Its effect is in constants.md.
constexpr double kCogBlend = 0.8;

// Time in the air over which a foot returns to its command [s]. Chosen: less than half of a swing
// of the bundled walks (0.45 s), so a foot is back on its command before it lands. No measured case
// changes between half and twice the value (constants.md).
constexpr double kFootBlend = 0.2;

}  // namespace

CommandPlan::CommandPlan(const CommandSeries& series)
    : series_(&series), rest_(series.samples.back()), now_(series.samples.front()), next_(now_) {
  if (rest_.support != Support::none) rest_plan(rest_);
}

const CommandSample& CommandPlan::sampled(long k) const {
  const std::vector<CommandSample>& samples = series_->samples;
  const auto sample = static_cast<size_t>(k);
  return sample < samples.size() ? samples[sample] : rest_;
}

CommandSample CommandPlan::at(long k) const {
  CommandSample plan = sampled(k);
  if (!placement_.moved) return plan;
  const Placement& p = placement_;
  turn_plan(p.turn, plan);
  const TrackPoint blend = minimum_jerk(static_cast<double>(k - p.since) * dt() / kCogBlend);
  const double w2 = kGravity / (plan.cog.z() - plan.zmp.z());
  PlanShift shift;
  shift.cog = (1 - blend.value) * p.cog;
  shift.dcog = -blend.rate / kCogBlend * p.cog;
  shift.ddcog = -blend.acceleration / (kCogBlend * kCogBlend) * p.cog;
  shift.zmp =
      ((1 - blend.value) + blend.acceleration / (kCogBlend * kCogBlend) / w2) * p.cog.head<2>();
  for (size_t i = 0; i < 2; ++i) {
    const Vector3d offset = p.share[i] * p.rest[i].translation();
    shift.foot[i] = plan.feet[i].linear() * offset;
    shift.foot_turn[i] =
        p.share[i] * log_rotation(Eigen::Quaterniond(Eigen::Matrix3d(p.rest[i].linear())));
  }
  shift_plan(shift, plan);
  return plan;
}

long CommandPlan::sample() const { return footholds_ ? std::lround(footholds_->phase()) : tick_; }

void CommandPlan::go_on_from(const CommandSample& from, long k) {
  const CommandSample& command = sampled(k);
  Placement p;
  p.turn = pose_between(from.feet) * pose_between(command.feet).inverse();
  for (size_t i = 0; i < 2; ++i) p.rest[i] = (p.turn * command.feet[i]).inverse() * from.feet[i];
  p.cog = from.cog - p.turn * command.cog;
  p.since = k;
  p.moved = true;
  placement_ = p;
  tick_ = k;
  now_ = at(k);
}

void CommandPlan::move_footholds(const RobotModel& model, const FootholdParams& params) {
  footholds_.emplace(model, *series_, params);
}

const CommandSample& CommandPlan::look_ahead(const Estimate& estimate) {
  if (is_sampled()) return sampled(tick_ + 1);
  if (footholds_) {
    if (footholds_->advance(estimate)) now_.feet = footholds_->plan().feet;
    next_ = footholds_->plan();
  } else {
    for (Side side : {Side::left, Side::right})
      if (!supports(sampled(tick_ + 1).support, side)) {
        double& share = placement_.share[static_cast<size_t>(side)];
        share = std::max(0.0, share - dt() / kFootBlend);
      }
    next_ = at(tick_ + 1);
  }
  return next_;
}

void CommandPlan::advance() {
  if (!is_sampled()) std::swap(now_, next_);
  ++tick_;
}

}  // namespace ayumi
