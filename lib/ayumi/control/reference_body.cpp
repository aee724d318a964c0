#include "ayumi/control/reference_body.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kSpeedLimit = 0.8;        // of the reference COG, times omega z
constexpr double kAccelerationLimit = 4;   // of the reference COG, times g
constexpr double kLies = 0.15;             // of the way from the edge of the sole to its middle
constexpr char kTooFast = 1, kTooFar = 2;  // what a servo target was held to, as bits

}  // namespace

ReferenceBody::ReferenceBody(const RobotModel& model, const ActuatorLimits& limits, double dt,
                             const RobotState& start, const VectorXd& target,
                             const ResolverOptions& options)
    : model_(&model),
      limits_(limits),
      options_(options),
      dt_(dt),
      data_(model),
      weight_(model.joint_weight()),
      lead_(servo_lead(model)),
      previous_target_(target),
      told_(static_cast<size_t>(model.dof_count())),
      reference_(start) {}

void ReferenceBody::take_over(const Handover& handover) {
  reference_ = handover.reference;
  dcog_ = handover.dcog;
  previous_target_ = handover.target;
}

void ReferenceBody::anchor(Side side, const Eigen::Isometry3d& sole) {
  anchor_ = side;
  anchor_base(*model_, side, sole, reference_, data_);
}

// A foot that has tipped is turned back flat. A tilt that lasts is the ground's (or the sensor's)
// and is forgotten like a lasting offset of the ZMP: levelling a foot that lies flat on a slope
// would lean the body downhill. A foot that tips carries on an edge of its sole; one that carries
// inside of it lies, on a bump or a stone, and its tilt is soon taken for the ground's. The body
// above need not lean with one foot: the ankle gives in.
const VectorXd& ReferenceBody::ankle_offsets(const Estimate& estimate, const AnkleLaw& law) {
  const bool lies = law.lie > 0 && estimate.stance_inside > kLies;
  const auto share_of = [&](double time) { return time > 0 ? std::min(1.0, dt_ / time) : 0.0; };
  Vector3d& under = slope_[static_cast<int>(estimate.stance)];
  Vector3d& swing = slope_[static_cast<int>(other(estimate.stance))];
  under += share_of(lies ? law.lie : law.forget) * (estimate.foot_tilt - under);
  ground_ += share_of(law.forget) * (under - ground_);
  if (law.lie > 0)
    swing += share_of(law.lie) * (ground_ - swing);
  else
    swing = under;
  offsets_.setZero(model_->dof_count());
  for (Side side : {Side::left, Side::right}) {
    Vector3d turn = law.conform * (slope_[static_cast<int>(side)] - ground_);
    if (side == estimate.stance) turn -= law.share * (estimate.foot_tilt - under);
    const std::vector<int>& leg = model_->leg(side);
    for (size_t i = leg.size() >= 2 ? leg.size() - 2 : 0; i < leg.size(); ++i)
      offsets_[leg[i]] = data_.axis[model_->dofs()[leg[i]].body].dot(turn);
  }
  return offsets_;
}

void ReferenceBody::advance(const CogReference& wanted, double z, const CommandSample& command,
                            const CommandSample& next, const VectorXd& offsets,
                            ControlOutput& out) {
  out.cog_reference = wanted;
  CogReference& ref = out.cog_reference;
  const double w = std::sqrt(kGravity / z);
  const double limit = kAccelerationLimit * kGravity;
  if (ref.ddcog.norm() > limit) ref.ddcog *= limit / ref.ddcog.norm();
  dcog_ += dt_ * ref.ddcog;
  const double speed = kSpeedLimit * w * z;
  if (dcog_.norm() > speed) dcog_ *= speed / dcog_.norm();
  ref.dcog = dcog_;

  resolve(*model_, limits_, reference_, data_, anchor_, dcog_, command, next, dt_, weight_,
          options_, work_, resolution_);
  if (resolution_.limiting_dof >= 0 || !resolution_.held.empty())
    for (const std::string& note : limit_notes(*model_, resolution_)) out.notes.push_back(note);

  reference_.dtheta = resolution_.dtheta;
  reference_.theta += dt_ * resolution_.dtheta;
  out.reference = reference_;
  out.target = reference_.theta + lead_.cwiseProduct(resolution_.dtheta) + offsets;
  bound_target(out);
}

// The lead and the ankles may ask for more than the resolution did. Each joint is told once.
void ReferenceBody::bound_target(ControlOutput& out) {
  const auto hold = [&](int j, double low, double high, char what, const char* text) {
    double& target = out.target[j];
    if (target >= low && target <= high) return;
    target = std::clamp(target, low, high);
    if (told_[static_cast<size_t>(j)] & what) return;
    told_[static_cast<size_t>(j)] |= what;
    out.notes.push_back("servo target of " + model_->dofs()[j].name + " held to its " + text);
  };
  for (int j = 0; j < out.target.size(); ++j) {
    const Dof& dof = model_->dofs()[j];
    const double step = limits_.speed[j] * dt_, before = previous_target_[j];
    hold(j, before - step, before + step, kTooFast, "speed limit");
    if (dof.limited) hold(j, dof.lower, dof.upper, kTooFar, "position limit");
  }
  previous_target_ = out.target;
}

}  // namespace ayumi
