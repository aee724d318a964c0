// Per axis x (y alike), hats measured, Delta = cmd - measured (21):
//   Z*    = cmdZ - K Dx - D Ddx                                    (18)(19), sign of D corrected
//   refZ  = nearest point of the shrunk support polygon to Z*
//   reffz = max(fmin, cmdfz + m (Kz Dz + Dz Ddz))                  (20)
//   w2    = reffz / (m (zG - zZ))                                  (17)
//   ddx   = cmdddx + ka w2 (zhat - refZ - zd) + ks^2 w^2 (cmdx - xref) + 2 kd w (cmddx - dxref)
//   zd'   = (zhat - refZ - zd) / Tw                                washout
//   dxref += dt ddx; theta from (22)(23); xref is read back from the posture.
// The term with ka is what the reference lacks of (14): w2 (x - refZ) is asked, w2 (x - zhat) is
// what the ground gives. It is zero when the ZMP is where it should be: short-term absorption.
#include "ayumi/control/laws/dtad.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kMinForceShare = 0.1;  // of the weight: f_min of the projection of f_z
constexpr double kOffsetLimit = 0.09;   // of the washed-out offset, times z
constexpr double kLeanBack = 0.7;       // rate at which the trunk turns back, times omega
constexpr double kMostLean = 0.35;      // of the trunk [rad]
constexpr double kLieTime = 0.33;  // after which a foot that lies has the ground's tilt, / omega

}  // namespace

DtadParams dtad_params(const RobotModel& model, const ControllerSpec& spec) {
  DtadParams p;
  const std::map<std::string, double*> fields = {{"q", &p.q},
                                                 {"ka", &p.ka},
                                                 {"ks", &p.ks},
                                                 {"kd", &p.kd},
                                                 {"tau_z", &p.tau_z},
                                                 {"margin", &p.margin},
                                                 {"kz", &p.kz},
                                                 {"dz", &p.dz},
                                                 {"kaz", &p.kaz},
                                                 {"washout", &p.washout},
                                                 {"ankle", &p.ankle},
                                                 {"conform", &p.conform},
                                                 {"trunk", &p.trunk},
                                                 {"step", &p.step},
                                                 {"hurry", &p.hurry},
                                                 {"long", &p.long_term},
                                                 {"as_printed", &p.as_printed}};
  std::vector<std::string> names = {"k", "d"};
  for (const auto& [name, field] : fields) names.push_back(name);
  auto set = [&](const std::string& name, double value, const std::string& where) {
    if (!std::isfinite(value) || value < 0)
      fail(ErrorCode::usage, where + ": gain " + name + " is " + text::brief(value) +
                                 "; gains are finite and not negative");
    if (name == "k")
      p.k = value;
    else if (name == "d")
      p.d = value;
    else if (const auto found = fields.find(name); found != fields.end())
      *found->second = value;
    else
      fail(ErrorCode::usage, where + ": dtad has no gain '" + name + "'" +
                                 text::suggestion(name, names) +
                                 " (known: " + text::join(names, ", ") + ")");
  };
  for (const auto& [name, value] : model.description().control.dtad)
    set(name, value, model.name() + " sidecar");
  bool q_given = false;
  for (const auto& [name, value] : spec.gains) {
    set(name, value, "controller gains");
    q_given |= name == "q";
  }
  if (p.k.has_value() != p.d.has_value())
    fail(ErrorCode::usage, "controller gains: k and d are given together or not at all");
  if (p.k && q_given)
    fail(ErrorCode::usage, "controller gains: q sets K and D; give q, or k and d, not both");
  if (p.k && (*p.k <= 1 || *p.d <= 0))
    fail(ErrorCode::usage, "controller gains: k = " + text::brief(*p.k) +
                               ", d = " + text::brief(*p.d) +
                               " never bring the COG back; (18)(19) need K > 1 and D > 0");
  if (!p.k && p.q <= 0)
    fail(ErrorCode::usage, "controller gains: q must be positive (K = 1 + q must exceed 1)");
  if (p.tau_z <= 0) fail(ErrorCode::usage, "controller gains: tau_z must be positive");
  if (p.as_printed != 0 && p.as_printed != 1)
    fail(ErrorCode::usage, "controller gains: as_printed is 0 or 1");
  if (p.step > 1)
    fail(ErrorCode::usage,
         "controller gains: step is a share, 0 to 1, of what footholds take; it is " +
             text::brief(p.step));
  if (p.hurry < 1)
    fail(ErrorCode::usage,
         "controller gains: hurry is the fastest clock of the pattern, at least 1; it is " +
             text::brief(p.hurry));
  p.literal = spec.type.demonstration == Demonstration::literal;
  return p;
}

double long_term_k(const DtadParams& p) { return p.long_term * (p.k ? *p.k : 1 + p.q); }

double long_term_d(const DtadParams& p) {
  return (p.as_printed == 1 ? -1 : 1) * p.long_term * (p.d ? *p.d : 1 + p.q);
}

Dtad::Dtad(const RobotModel& model, const ActuatorLimits& limits, const DtadParams& params,
           double dt, const CommandSample& first, const VectorXd& target)
    : model_(&model),
      params_(params),
      dt_(dt),
      body_(model, limits, dt, first.state, target),
      zmp_filtered_(first.zmp.head<2>()),
      fz_filtered_(first.fz) {
  if (first.support == Support::right) anchor_ = Side::right;
}

void Dtad::take_over(const Handover& handover, const CommandSample& plan) {
  body_.take_over(handover);
  zmp_filtered_ = plan.zmp.head<2>();
  fz_filtered_ = plan.fz;
  offset_.setZero();
  first_ = false;
}

CogReference Dtad::cog_reference(const CommandSample& command, const Estimate& estimate) {
  const DtadParams& p = params_;
  const double m = model_->mass(), weight = m * kGravity;
  const double z = command.cog.z() - command.zmp.z();
  const double w = std::sqrt(kGravity / z);
  const double K = long_term_k(p), D = long_term_d(p) / w;

  const Vector3d e = command.cog - estimate.cog;
  const Vector3d de = command.dcog - estimate.dcog;
  CogReference ref;
  const ConvexPolygon& polygon =
      region_.update(*model_, command.feet, command.support, p.margin * z);
  const Vector2d wanted = command.zmp.head<2>() - K * e.head<2>() - D * de.head<2>();
  ref.zmp = command.zmp;
  ref.zmp.head<2>() = polygon.empty() ? wanted : polygon.project(wanted);
  outside_ = wanted - ref.zmp.head<2>();
  ref.fz = std::max(kMinForceShare * weight,
                    command.fz + m * (p.kz * w * w * e.z() + p.dz * w * de.z()));

  // At rest the ZMP is under the COG. What it is then off the one asked for is an offset already:
  // servos that sag, a floor that slopes.
  if (first_ && p.washout > 0 && !polygon.empty())
    offset_ = -e.head<2>() -
              (polygon.project(command.zmp.head<2>() - K * e.head<2>()) - command.zmp.head<2>());
  first_ = false;

  const double filter = 1.0 - std::exp(-dt_ * w / p.tau_z);
  if (estimate.contact) {
    zmp_filtered_ += filter * (estimate.zmp.head<2>() - zmp_filtered_);
    fz_filtered_ += filter * (estimate.fz - fz_filtered_);
  }
  const double w2 = omega_squared(ref.fz, m, z);

  if (p.literal) {
    ref.ddcog.head<2>() = w2 * (estimate.cog - ref.zmp).head<2>();
    ref.ddcog.z() = ref.fz / m - kGravity;
    return ref;
  }
  Vector2d gap = Vector2d::Zero();
  if (estimate.contact && command.support != Support::none) {
    gap = zmp_filtered_ - ref.zmp.head<2>() - offset_;
    if (p.washout > 0) {
      offset_ += dt_ * w / p.washout * gap;
      const double limit = kOffsetLimit * z;
      if (offset_.norm() > limit) offset_ *= limit / offset_.norm();
    }
  }
  const Vector3d pull = p.ks * p.ks * w * w * (command.cog - body_.cog()) +
                        2 * p.kd * w * (command.dcog - body_.dcog());
  ref.ddcog = command.ddcog + pull;
  ref.ddcog.head<2>() += p.ka * w2 * gap;
  if (estimate.contact) ref.ddcog.z() += p.kaz * (ref.fz - fz_filtered_) / m;
  return ref;
}

// A moment about the COG moves the point through which the ground force acts on it, and so does
// what the ZMP cannot: L' / (m g) = z x (Z* - refZ) needs L' about the trunk. It turns back by
// itself.
void Dtad::lean_trunk(double w, double z) {
  const Vector3d push = Vector3d(-outside_.y(), outside_.x(), 0) / z;
  const Vector3d rate = params_.trunk * w * w * push - kLeanBack * kLeanBack * w * w * lean_ -
                        2 * kLeanBack * w * lean_rate_;
  lean_rate_ += dt_ * rate;
  lean_ += dt_ * lean_rate_;
  if (lean_.norm() > kMostLean) lean_ *= kMostLean / lean_.norm(), lean_rate_.setZero();
  body_.lean(lean_, lean_rate_);
}

void Dtad::update(const CommandSample& command, const CommandSample& next, const Estimate& estimate,
                  const Eigen::Ref<const VectorXd>& sag, ControlOutput& out) {
  if (command.support == Support::left) anchor_ = Side::left;
  if (command.support == Support::right) anchor_ = Side::right;
  body_.anchor(anchor_, command.feet[static_cast<int>(anchor_)]);
  out.cog = body_.cog();
  const CogReference wanted = cog_reference(command, estimate);
  const double z = command.cog.z() - command.zmp.z();
  const double forget = params_.washout / std::sqrt(kGravity / z);
  const double lie = params_.washout > 0 ? kLieTime / std::sqrt(kGravity / z) : 0;
  offsets_ = sag + body_.ankle_offsets(estimate, {params_.ankle, params_.conform, forget, lie});
  if (params_.trunk > 0) lean_trunk(std::sqrt(kGravity / z), z);
  body_.advance(wanted, z, command, next, offsets_, out);
}

}  // namespace ayumi
