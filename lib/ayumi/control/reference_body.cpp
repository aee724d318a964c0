#include "ayumi/control/reference_body.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/version.hpp"
#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kSpeedLimit = 0.8;       // of the reference COG, times omega z
constexpr double kAccelerationLimit = 4;  // of the reference COG, times g

}  // namespace

VectorXd servo_lead(const RobotModel& model) {
  VectorXd lead(model.dof_count());
  for (int j = 0; j < model.dof_count(); ++j) {
    const ServoDescription& servo = model.dofs()[j].servo;
    lead[j] = servo.kp > 0 ? servo.kd / servo.kp : 0.0;
  }
  return lead;
}

ReferenceBody::ReferenceBody(const RobotModel& model, const ActuatorLimits& limits, double dt,
                             const RobotState& start, const ResolverOptions& options)
    : model_(&model),
      limits_(limits),
      options_(options),
      dt_(dt),
      data_(model),
      weight_(model.joint_weight()),
      lead_(servo_lead(model)),
      previous_target_(start.theta),
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
// would lean the body downhill.
const VectorXd& ReferenceBody::ankle_offsets(const Estimate& estimate, double share,
                                             double forget) {
  if (forget > 0) slope_ += std::min(1.0, dt_ / forget) * (estimate.foot_tilt - slope_);
  const Vector3d tilt = estimate.foot_tilt - slope_;
  offsets_.setZero(model_->dof_count());
  const std::vector<int>& leg = model_->leg(estimate.stance);
  for (size_t i = leg.size() >= 2 ? leg.size() - 2 : 0; i < leg.size(); ++i) {
    const int body = model_->dofs()[leg[i]].body;
    offsets_[leg[i]] = -share * data_.axis[body].dot(tilt);
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
  for (int j = 0; j < out.target.size(); ++j) {
    const Dof& dof = model_->dofs()[j];
    const double step = limits_.speed[j] * dt_;
    out.target[j] =
        std::clamp(out.target[j], previous_target_[j] - step, previous_target_[j] + step);
    if (dof.limited) out.target[j] = std::clamp(out.target[j], dof.lower, dof.upper);
  }
  previous_target_ = out.target;
}

}  // namespace ayumi
