// For the axis x (and y likewise), with hats for measured values and Delta = cmd - measured (21):
//   Z*    = cmdZ - K Dx - D Ddx                                    (18)(19), sign of D corrected
//   refZ  = nearest point of the shrunk support polygon to Z*
//   reffz = max(fmin, cmdfz + m (Kz Dz + Dz Ddz))                  (20)
//   w2    = reffz / (m (zG - zZ))                                  (17)
//   ddx   = cmdddx + ka w2 (zhat - refZ - zd) + ks^2 w^2 (cmdx - xref) + 2 kd w (cmddx - dxref)
//           + sat(damp w (dxhat - dxref)), less what works against a Z* outside the support
//   zd'   = (zhat - refZ - zd) / Tw                                accepted offset
//   dxref += dt ddx; theta from (22)(23); xref is read back from the posture.
// The term with ka is the part of (14) that the reference lacks. By (14), w2 (x - refZ) is the
// wanted acceleration, and the ground gives w2 (x - zhat). The term is zero if the ZMP is where it
// should be. This is the short-term absorption. The term with damp damps the rocking of the robot
// on soles and servos that yield. The term with ka excites this rocking, because it responds late
// (docs/theory.md, "Late sensors").
#include "ayumi/control/laws/dtad.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/torque_feedforward.hpp"
#include "ayumi/dynamics/inverse_kinematics.hpp"
#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Bound of the accepted offset of the ZMP, as a multiple of z: 20 mm on HOAP-1, the offset of a
// slope of 5 deg. Chosen: it is sufficient for every slope on which the walk does not fall
// (docs/theory.md, "The offset"). Between half and twice the value, figures change by less than 5
// %.
constexpr double kOffsetLimit = 0.09;

// If the planned ZMP is farther than this from the planned COG in a plan at rest, the plan
// contradicts itself. A plan is at rest if its COG moves by less than this within 1/omega. Both
// lengths are multiples of z: 1 mm on HOAP-1. Chosen: above rounding and the noise of sampled
// motions. Half and twice change nothing for a ZMP that is 10 mm off
// (scenarios/imported_motions_test).
constexpr double kContradiction = 0.004;

// Time after which the tilt of a foot that lies on the ground counts as a slope of the ground, in
// 1/omega: 50 ms on HOAP-1. Chosen: docs/theory.md, "A foot on a bump". Its effect is in
// constants.md.
constexpr double kContactTiltTime = 0.33;

using GainFields = std::map<std::string, double*>;

/// Gains of the body, which apply with every method that chooses the ZMP.
GainFields body_gain_fields(DtadParams& p) {
  return {{"ka", &p.zmp_gain},           {"ks", &p.pull_rate},      {"kd", &p.pull_damping},
          {"damp", &p.rocking_damping},  {"tau_z", &p.zmp_filter},  {"margin", &p.margin},
          {"kz", &p.height_stiffness},   {"dz", &p.height_damping}, {"kaz", &p.fz_gain},
          {"washout", &p.offset_time},   {"ankle", &p.ankle_share}, {"conform", &p.compliance},
          {"momentum", &p.momentum_gain}};
}

/// Gains of the method that chooses the ZMP.
GainFields zmp_gain_fields(DtadParams& p) {
  if (p.kind == ControllerKind::preview)
    return {{"effort", &p.preview_effort},
            {"horizon", &p.preview_horizon},
            {"feedback", &p.preview_feedback}};
  if (p.kind == ControllerKind::foot_guided) return {{"soonest", &p.least_guide_time}};
  if (p.kind == ControllerKind::dcm_step)
    return {{"q", &p.pole_ratio},         {"hurry", &p.time_scale_limit}, {"place", &p.steps.place},
            {"time", &p.steps.time},      {"offset", &p.steps.offset},    {"zmp", &p.steps.zmp},
            {"slowest", &p.steps.slowest}};
  return {{"q", &p.pole_ratio},
          {"step", &p.step_share},
          {"hurry", &p.time_scale_limit},
          {"long", &p.long_term},
          {"as_printed", &p.as_printed}};
}

GainFields gain_fields(DtadParams& p) {
  GainFields fields = body_gain_fields(p);
  fields.merge(zmp_gain_fields(p));
  return fields;
}

/// The tilt of the plan's trunk about the world's x and y axes [rad]. `data` belongs to a posture
/// whose waist is that of the plan.
Vector2d planned_tilt(const RobotModel& model, const RobotData& data, const RobotState& plan) {
  const Vector3d in_base = data.rotation[0].transpose() * data.rotation[model.trunk_body()].col(2);
  const Vector3d up = plan.base.attitude * in_base;
  const double sine = elementary::hypot(up.x(), up.y());
  if (sine == 0) return Vector2d::Zero();
  return elementary::atan2(sine, up.z()) / sine * Vector2d(-up.y(), up.x());
}

/// The offset of the ZMP that is accepted, within its bound.
Vector2d bounded_offset(Vector2d offset, double z) {
  const double limit = kOffsetLimit * z;
  if (offset.norm() > limit) offset *= limit / offset.norm();
  return offset;
}

/// The offset without the part that comes from a contradiction of the plan, which is at most
/// -contradiction.
Vector2d without_contradiction(const Vector2d& offset, const Vector2d& contradiction) {
  const double size = contradiction.norm();
  if (size == 0) return offset;
  const Vector2d along = contradiction / size;
  return offset + std::clamp(-offset.dot(along), 0.0, size) * along;
}

/// Mean of the planned ZMP minus the COG over the first or the last period 1/omega of a plan that
/// is at rest there. It is zero if the plan moves there, or if both agree.
Vector2d contradiction(const CommandSeries& series, bool at_end, double w) {
  const std::vector<CommandSample>& samples = series.samples;
  const auto count =
      std::min(samples.size(), static_cast<size_t>(std::lround(1 / (w * series.dt))) + 1);
  const size_t first = at_end ? samples.size() - count : 0, last = first + count - 1;
  const double limit = kContradiction * kGravity / (w * w);
  if ((samples[last].cog - samples[first].cog).norm() > limit) return Vector2d::Zero();
  Vector2d sum = Vector2d::Zero();
  for (size_t k = first; k <= last; ++k) {
    if (samples[k].support == Support::none) return Vector2d::Zero();
    sum += (samples[k].zmp - samples[k].cog).head<2>();
  }
  const Vector2d mean = sum / static_cast<double>(count);
  return mean.norm() > limit ? mean : Vector2d::Zero();
}

/// Throws Error(usage) for a gain of a baseline that is out of range.
void check_baseline(const DtadParams& p) {
  const auto need = [](bool holds, const char* name, double value, const char* what) {
    if (!holds)
      fail(ErrorCode::usage, std::string("controller gains: ") + name + " is " +
                                 text::brief(value) + "; it must be " + what);
  };
  const auto positive = [&](const char* name, double value) {
    need(value > 0, name, value, "positive");
  };
  if (p.kind == ControllerKind::preview) {
    need(p.preview_effort >= 1e-9 && p.preview_effort <= 1, "effort", p.preview_effort,
         "from 1e-9 to 1. This gain is the cost of changing the jerk of the COG");
    need(p.preview_horizon > 0 && p.preview_horizon <= 50, "horizon", p.preview_horizon,
         "above 0 and at most 50. This gain is the time for which the planned ZMP is known in "
         "advance, multiplied by omega");
  }
  if (p.kind == ControllerKind::foot_guided) positive("soonest", p.least_guide_time);
  if (p.kind == ControllerKind::dcm_step) {
    positive("place", p.steps.place);
    positive("time", p.steps.time);
    positive("offset", p.steps.offset);
    positive("zmp", p.steps.zmp);
    need(p.steps.slowest >= 0.1 && p.steps.slowest <= 1, "slowest", p.steps.slowest,
         "from 0.1 to 1. The controller may slow the pattern down to this share of the pattern's "
         "speed");
  }
}

}  // namespace

DtadParams dtad_params(const RobotModel& model, const ControllerSpec& spec) {
  DtadParams p;
  p.kind = spec.type.kind;
  const GainFields fields = gain_fields(p);
  const bool poles = p.kind == ControllerKind::dtad || p.kind == ControllerKind::viip;
  std::vector<std::string> names;
  if (poles) names = {"k", "d"};
  for (const auto& [name, field] : fields) names.push_back(name);
  auto set = [&](const std::string& name, double value, const auto& refuse) {
    if (const std::string reason = gain_out_of_range(name, value); !reason.empty()) refuse(reason);
    if (poles && name == "k")
      p.k = value;
    else if (poles && name == "d")
      p.d = value;
    else if (const auto found = fields.find(name); found != fields.end())
      *found->second = value;
    else
      refuse(name_of(p.kind) + " has no gain '" + name + "'" + text::suggestion(name, names) +
             " (known: " + text::join(names, ", ") + ")");
  };
  // The parameters of the body are the robot's own ones under every law.
  DtadParams dtad;
  GainFields of_dtad = gain_fields(dtad);
  for (const char* name : {"k", "d"}) of_dtad[name] = nullptr;
  for (const auto& [name, value] : model.description().control.dtad)
    if (p.kind == ControllerKind::dtad || !of_dtad.contains(name) || fields.contains(name))
      set(name, value, [&](const std::string& what) {
        fail(ErrorCode::bad_model,
             {model.description().sidecar_file, "/control/dtad/" + json_pointer_token(name)}, what);
      });
  bool q_given = false;
  for (const auto& [name, value] : spec.gains) {
    set(name, value,
        [](const std::string& what) { fail(ErrorCode::usage, "controller gains: " + what); });
    q_given |= name == "q";
  }
  if (p.k.has_value() != p.d.has_value())
    fail(ErrorCode::usage, "controller gains: k and d must be given together");
  if (p.k && q_given)
    fail(ErrorCode::usage,
         "controller gains: q already determines k and d. Give either q, or k and d");
  if (p.k && (*p.k <= 1 || *p.d <= 0))
    fail(ErrorCode::usage,
         "controller gains: k = " + text::brief(*p.k) + ", d = " + text::brief(*p.d) +
             " never bring the COG back. Equations (18)(19) need K > 1 and D > 0");
  check_baseline(p);
  if (!p.k && p.pole_ratio <= 0)
    fail(ErrorCode::usage, "controller gains: q is " + text::brief(p.pole_ratio) +
                               "; it must be above 0, because K = 1 + q must exceed 1");
  if (p.zmp_filter <= 0)
    fail(ErrorCode::usage,
         "controller gains: tau_z is " + text::brief(p.zmp_filter) + "; it must be above 0");
  if (p.as_printed != 0 && p.as_printed != 1)
    fail(ErrorCode::usage,
         "controller gains: as_printed is " + text::brief(p.as_printed) + "; it must be 0 or 1");
  if (p.step_share > 1)
    fail(ErrorCode::usage, "controller gains: step is " + text::brief(p.step_share) +
                               "; it must be from 0 to 1. This gain is the part of an error that "
                               "new footholds absorb");
  if (p.time_scale_limit < 1)
    fail(ErrorCode::usage, "controller gains: hurry is " + text::brief(p.time_scale_limit) +
                               "; it must be at least 1. This gain is the largest factor by which "
                               "the controller may speed "
                               "the pattern up");
  p.literal = spec.type.demonstration == Demonstration::literal;
  return p;
}

std::vector<std::pair<std::string, double>> gains_of(DtadParams p) {
  std::vector<std::pair<std::string, double>> gains;
  if (p.kind == ControllerKind::dtad) gains = {{"k", long_term_k(p)}, {"d", long_term_d(p)}};
  for (const auto& [name, value] : gain_fields(p)) gains.emplace_back(name, *value);
  return gains;
}

double long_term_k(const DtadParams& p) { return p.long_term * (p.k ? *p.k : 1 + p.pole_ratio); }

double long_term_d(const DtadParams& p) {
  return (p.as_printed == 1 ? -1 : 1) * p.long_term * (p.d ? *p.d : 1 + p.pole_ratio);
}

Dtad::Dtad(const RobotModel& model, const ActuatorLimits& limits, const DtadParams& params,
           CommandPlan command, std::shared_ptr<const Eigen::MatrixXd> torque_lead,
           const VectorXd& target)
    : model_(&model),
      params_(params),
      command_(std::move(command)),
      torque_lead_(std::move(torque_lead)),
      body_(model, limits, command_.dt(), plan().state, target),
      momentum_(model, limits),
      filter_(plan().zmp.head<2>(), plan().fz) {
  if (params.kind == ControllerKind::preview)
    preview_.emplace(command_, params.preview_effort, params.preview_horizon,
                     params.preview_feedback);
  if (params.kind == ControllerKind::foot_guided)
    guide_.emplace(command_.series(), params.least_guide_time);
  if (plan().support == Support::right) anchor_ = Side::right;
  // If legs lack joints, the trunk leans as the COG requires, so it cannot turn for the balance.
  if (InverseKinematics(model, model.posture()).lacks_joints()) params_.momentum_gain = 0;
}

void Dtad::take_over(const Handover& handover) {
  body_.take_over(handover);
  offset_.setZero();
  first_ = false;
}

HorizontalGains Dtad::horizontal_gains(double w) const {
  if (preview_) {
    const Vector2d gains = preview_->measured_gains();
    return {gains[0], gains[1] / w};
  }
  if (!guide_) return {long_term_k(params_), long_term_d(params_) / w};
  const double gain = guide_->gain(command_.sample(), w);
  return {gain, gain / w};
}

// (14)-(21), in the order of the derivation above.
CogReference Dtad::cog_reference(const Estimate& estimate, LawTerms& terms) {
  const DtadParams& p = params_;
  const CommandSample& command = plan();
  const double m = model_->mass();
  const double z = command.cog.z() - command.zmp.z();
  const double w = std::sqrt(kGravity / z);
  const auto [K, D] = horizontal_gains(w);

  const CogError error = cog_error(command, estimate);
  CogReference ref;
  const ConvexPolygon& polygon =
      region_.update(*model_, command.feet, command.support, p.margin * z);
  // A planned ZMP outside the support, as in imported motions, is not an error that the law should
  // correct.
  const Vector2d planned =
      polygon.empty() ? Vector2d(command.zmp.head<2>()) : polygon.project(command.zmp.head<2>());
  const Vector2d wanted =
      preview_ ? preview_->wanted_zmp(command, estimate, w) : long_term_zmp(planned, K, D, error);
  ref.zmp = command.zmp;
  ref.zmp.head<2>() = polygon.empty() ? wanted : polygon.project(wanted);
  if (preview_) previewed_ = preview_->go_on(command_.sample(), w);
  outside_ = wanted - ref.zmp.head<2>();
  ref.fz = admissible_force(
      long_term_force(command.fz, m, p.height_stiffness * w * w, p.height_damping * w, error), m);

  // At rest the ZMP is under the COG. Its distance from the wanted ZMP is an offset from the
  // beginning. It comes from servos that sag, from a floor that slopes, or from a plan whose ZMP is
  // not that of its COG. The last of these three parts ends with the plan.
  if (first_ && p.offset_time > 0 && !polygon.empty()) {
    const Vector2d asked = polygon.project(planned - K * error.position.head<2>());
    offset_ = -error.position.head<2>() - (asked - planned);
    offset_ = bounded_offset(offset_ - contradiction(command_.series(), false, w), z);
  }
  first_ = false;
  if (command_.at_rest() && !ended_) {
    ended_ = true;
    const CommandSeries& series = command_.series();
    const Eigen::Matrix3d turn =
        command.feet[0].linear() * series.samples.back().feet[0].linear().transpose();
    offset_ =
        without_contradiction(offset_, turn.topLeftCorner<2, 2>() * contradiction(series, true, w));
  }

  filter_.update(estimate, low_pass_share(command_.dt(), w, p.zmp_filter));
  const double w2 = omega_squared(ref.fz, m, z);
  terms = {.stage = LawStage::follow, .K = K, .D = D, .height = z, .omega2 = w2};
  terms.K_z = p.height_stiffness * w * w;
  terms.D_z = p.height_damping * w;
  const double ground = command.zmp.z();
  terms.planned_zmp << planned, ground;
  terms.wanted_zmp << wanted, ground;
  terms.filtered_zmp << filter_.zmp(), ground;
  terms.offset.head<2>() = offset_;
  if (p.literal) {
    ref.ddcog.head<2>() = horizontal_acceleration(w2, estimate.cog.head<2>(), ref.zmp.head<2>());
    ref.ddcog.z() = vertical_acceleration(ref.fz, m);
    terms.motion = ref.ddcog;
    return ref;
  }
  const bool carries = estimate.contact && command.support != Support::none;
  const Vector2d gap = carries ? zmp_gap(ref.zmp.head<2>(), w, z) : Vector2d(Vector2d::Zero());
  Vector3d cog = command.cog, dcog = command.dcog;
  terms.motion = command.ddcog;
  if (preview_) {
    cog.head<2>() = previewed_.cog;
    dcog.head<2>() = previewed_.dcog;
    terms.motion.head<2>() = previewed_.ddcog;
  }
  const Vector3d pull = p.pull_rate * p.pull_rate * w * w * (cog - body_.cog()) +
                        2 * p.pull_damping * w * (dcog - body_.dcog());
  terms.pull = pull;
  terms.short_term.head<2>() = short_term_acceleration(p.zmp_gain, w2, gap);
  if (carries)
    terms.rocking.head<2>() = without_part_against(
        outside_, rocking_acceleration(p.rocking_damping, w, z, body_.dcog(), estimate), K, w, z);
  if (estimate.contact) terms.short_term.z() = p.fz_gain * (ref.fz - filter_.fz()) / m;
  ref.ddcog = terms.motion + terms.pull;
  ref.ddcog += terms.short_term;
  ref.ddcog += terms.rocking;
  return ref;
}

// The measured ZMP minus ref ZMP and minus the offset, which follows slowly.
Vector2d Dtad::zmp_gap(const Vector2d& ref_zmp, double w, double z) {
  const Vector2d gap = filter_.zmp() - ref_zmp - offset_;
  if (params_.offset_time > 0) {
    offset_ += command_.dt() * w / params_.offset_time * gap;
    offset_ = bounded_offset(offset_, z);
  }
  return gap;
}

// L' = m g e_z x (Z* - ref Z): this moment has the effect on the COG that the ZMP cannot have.
void Dtad::turn_upper_body(double w) {
  const Vector3d moment =
      model_->mass() * kGravity * params_.momentum_gain * Vector3d(-outside_.y(), outside_.x(), 0);
  // While a foot swings, the hip of its leg does not stop the trunk, because the foot leaves its
  // path instead (docs/theory.md, "Angular momentum"). So the turn is bounded on both feet only.
  const bool bounded = plan().support == Support::both;
  const bool turns = !moment.isZero(0) || !momentum_.at_rest();
  const TurnRoom room = bounded && turns ? body_.turn_room() : TurnRoom{};
  body_.turn(momentum_.update(moment, body_.data(), plan().state.theta,
                              planned_tilt(*model_, body_.data(), plan().state), room, w,
                              command_.dt()));
}

// A planned flight lasts until its end is planned and the load cells feel the ground.
bool Dtad::in_flight(const Estimate& estimate) {
  const bool planned = plan().support == Support::none;
  flying_ = planned || (flying_ && !estimate.contact);
  return flying_;
}

// Off the ground, no law can change the path of the COG, and the measured COG depends on the feet
// and not on the place of the robot. So the posture returns to the command, and the legs return to
// the vertical.
void Dtad::fly(const Estimate& e, const CommandSample& next, ControlOutput& out) {
  const CommandSample& command = plan();
  out.terms = {.stage = LawStage::follow_flight};
  out.terms.planned_zmp = out.terms.wanted_zmp = command.zmp;
  out.terms.motion = command.ddcog;
  body_.release(command);
  out.cog = body_.cog();
  out.cog_reference.zmp = command.zmp;
  out.cog_reference.fz = 0;
  out.cog_reference.ddcog = command.ddcog;
  const Eigen::Quaterniond turned = e.state.base.attitude * command.state.base.attitude.conjugate();
  Vector3d tilt = log_rotation(turned);
  tilt.z() = 0;
  outside_.setZero();
  if (preview_) preview_->restart();
  filter_ = ReactionFilter(e.contact ? e.zmp.head<2>() : command.zmp.head<2>(), e.fz);
  body_.fly(tilt, command, next, offsets_, out);
}

void Dtad::update(const Estimate& estimate, ControlOutput& out) {
  const auto torque_lead = lead_at(*torque_lead_, command_.sample());
  const CommandSample& next = command_.look_ahead(estimate);
  const CommandSample& command = plan();
  if (const VectorXd* weight = command_.joint_weight()) {
    body_.weigh(*weight);
    momentum_.weigh(*weight);
  }
  if (in_flight(estimate)) {
    offsets_ = torque_lead;
    fly(estimate, next, out);
    command_.advance();
    return;
  }
  if (command.support == Support::left) anchor_ = Side::left;
  if (command.support == Support::right) anchor_ = Side::right;
  body_.anchor(anchor_, command.feet[static_cast<size_t>(anchor_)]);
  out.cog = body_.cog();
  const CogReference wanted = cog_reference(estimate, out.terms);
  const double z = command.cog.z() - command.zmp.z(), w = std::sqrt(kGravity / z);
  const AnkleLaw ankles = {.share = params_.ankle_share,
                           .compliance = params_.compliance,
                           .slope_time = params_.offset_time / w,
                           .contact_tilt_time = params_.offset_time > 0 ? kContactTiltTime / w : 0};
  offsets_ = torque_lead + body_.ankle_offsets(estimate, ankles);
  if (params_.momentum_gain > 0) turn_upper_body(w);
  body_.advance(wanted, z, command, next, offsets_, out);
  command_.advance();
}

}  // namespace ayumi
