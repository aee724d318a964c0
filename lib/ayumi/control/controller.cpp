#include "ayumi/control/controller.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/feedforward.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/math/track.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr double kBlend = 0.8;      // over which an offset of the COG is taken back [s]
constexpr double kFootBlend = 0.2;  // of a swing, over which a foot returns to its command [s]

/// Level pose between both soles.
Isometry3d between(const std::array<Isometry3d, 2>& feet) {
  const double left = matrix_to_rpy(feet[0].linear()).z();
  const double turn = std::remainder(matrix_to_rpy(feet[1].linear()).z() - left, 2 * M_PI);
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = rpy_to_matrix({0, 0, left + 0.5 * turn});
  pose.translation() = 0.5 * (feet[0].translation() + feet[1].translation());
  return pose;
}

CommandSample moved(const CommandSample& command, const Isometry3d& turn) {
  CommandSample s = command;
  s.state.base.position = turn * s.state.base.position;
  s.state.base.attitude = Eigen::Quaterniond(turn.linear()) * s.state.base.attitude;
  s.state.base_velocity = turn.linear() * s.state.base_velocity;
  s.state.base_angular_velocity = turn.linear() * s.state.base_angular_velocity;
  s.cog = turn * s.cog;
  s.dcog = turn.linear() * s.dcog;
  s.ddcog = turn.linear() * s.ddcog;
  s.zmp = turn * s.zmp;
  for (Isometry3d& foot : s.feet) foot = turn * foot;
  return s;
}

}  // namespace

void check_controller(const RobotModel& model, const ControllerSpec& spec) {
  if (spec.type.kind == ControllerKind::dtad) dtad_params(model, spec);
  viip_params(model, spec);
}

Controller::Controller(const RobotModel& model, const ActuatorLimits& limits,
                       const CommandSeries& series, const ControllerSpec& spec)
    : model_(&model),
      limits_(limits),
      series_(&series),
      spec_(spec),
      law_(OpenLoop{servo_lead(model)}),
      plan_(series.samples.front()),
      start_(plan_.state),
      target_(series.samples.front().state.theta) {
  check_controller(model, spec);
  if (spec.type.kind == ControllerKind::viip && series.viip.empty())
    fail(ErrorCode::bad_pattern,
         "controller " + name_of(spec.type) +
             ": the pattern has no phase with \"viip\" goals; add one or use dtad");
  if (series.viip.empty()) sag_ = servo_sag(model, limits, series);
  const bool told = sag_.size() > 0 && !series.servo_commands;
  if (sag_.size() > 0 && !told) start_.theta -= sag_.col(0);
  if (!told) sag_.setZero(model.dof_count(), 1);
  target_ += sag_.col(0);
  start_law(nullptr);
  enter(0);
}

const CommandSample& Controller::command(long k) const {
  const std::vector<CommandSample>& samples = series_->samples;
  return samples[std::min<size_t>(static_cast<size_t>(k), samples.size() - 1)];
}

// The last phase goes on after the end of the series.
const ViipSpan* Controller::span_at(long k) const {
  if (spec_.type == ControllerKind::none) return nullptr;
  const long last = static_cast<long>(series_->samples.size()) - 1;
  for (const ViipSpan& span : series_->viip)
    if (k >= span.begin && (k < span.end || span.end >= last)) return &span;
  return nullptr;
}

Handover Controller::handover() const {
  Handover result{plan_.state, plan_.dcog, target_, plan_};
  const auto take = [&](const ReferenceBody& body) {
    result.reference = body.state();
    result.dcog = body.dcog();
    result.target = body.target();
  };
  if (const auto* dtad = std::get_if<Dtad>(&law_)) take(dtad->body());
  if (const auto* viip = std::get_if<Viip>(&law_)) take(viip->body());
  if (const auto* jump = std::get_if<ViipJump>(&law_)) return jump->handover();
  return result;
}

// The command goes on where VIIP has put the feet; a foot that is not quite where the command has
// it stays until it next swings, a displaced COG is brought back slowly.
void Controller::place(const CommandSample& from) {
  const CommandSample& cmd = command(tick_);
  Placement p;
  p.turn = between(from.feet) * between(cmd.feet).inverse();
  for (int i = 0; i < 2; ++i) p.rest[i] = (p.turn * cmd.feet[i]).inverse() * from.feet[i];
  p.cog = from.cog - p.turn * cmd.cog;
  p.since = tick_;
  p.moved = true;
  placement_ = p;
}

CommandSample Controller::placed(long k) const {
  if (!placement_.moved) return command(k);
  const Placement& p = placement_;
  CommandSample s = moved(command(k), p.turn);
  for (int i = 0; i < 2; ++i) {
    Isometry3d rest = p.rest[i];
    rest.translation() *= p.share[i];
    rest.linear() = exp_rotation(p.share[i] * log_rotation(Eigen::Quaterniond(rest.linear())))
                        .toRotationMatrix();
    s.feet[i] = s.feet[i] * rest;
  }
  const TrackPoint blend = minimum_jerk(static_cast<double>(k - p.since) * series_->dt / kBlend);
  const double w2 = kGravity / (s.cog.z() - s.zmp.z());
  s.cog += (1 - blend.value) * p.cog;
  s.dcog -= blend.rate / kBlend * p.cog;
  s.ddcog -= blend.acceleration / (kBlend * kBlend) * p.cog;
  s.zmp.head<2>() +=
      ((1 - blend.value) + blend.acceleration / (kBlend * kBlend) / w2) * p.cog.head<2>();
  return s;
}

void Controller::start_law(const ViipSpan* span) {
  if (span) {
    const Handover from = handover();
    const ViipParams params = viip_params(*model_, spec_);
    if (const auto* jump = std::get_if<JumpGoal>(&span->goal))
      law_ = ViipJump(*model_, limits_, params, series_->dt, from, placed(tick_), *jump);
    else
      law_ = Viip(*model_, limits_, params, series_->dt, from, placed(tick_));
  } else if (spec_.type.kind == ControllerKind::dtad || spec_.type == ControllerKind::viip) {
    ControllerSpec spec = spec_;
    if (spec.type == ControllerKind::viip) spec = {ControllerKind::dtad, {}};
    const Handover from = handover();
    const DtadParams params = dtad_params(*model_, spec);
    Dtad dtad(*model_, limits_, params, series_->dt, plan_, target_);
    if (tick_ > 0) dtad.take_over(from, plan_);
    law_ = dtad;
    if (params.step > 0 && !params.literal && series_->viip.empty())
      footholds_.emplace(*model_, *series_, FootholdParams{params.step, params.hurry});
  } else {
    law_ = OpenLoop{servo_lead(*model_)};
  }
}

// Laws change, and the goal of VIIP, before tick k.
void Controller::enter(long k) {
  const ViipSpan* span = span_at(k);
  if (span == span_) return;
  if (!span) place(plan_);
  if (!span) plan_ = placed(k);
  const bool jumps = span && std::holds_alternative<JumpGoal>(span->goal);
  if (!span || jumps || !std::holds_alternative<Viip>(law_)) start_law(span);
  span_ = span;
  if (!span) return;
  if (jumps) {
    plan_ = std::get<ViipJump>(law_).plan();
    return;
  }
  // Steps go on into following phases of steps.
  long end = span->end;
  for (const ViipSpan& next : series_->viip)
    if (next.begin == end && std::holds_alternative<StepGoal>(span->goal) &&
        std::holds_alternative<StepGoal>(next.goal))
      end = next.end;
  Viip& viip = std::get<Viip>(law_);
  if (const auto* steps = std::get_if<StepGoal>(&span->goal)) {
    const double time = static_cast<double>(end - k) * series_->dt;
    const double needed = stepping_time(viip_params(*model_, spec_), viip.omega(), steps->steps);
    if (steps->steps > 0 && needed > time)
      fail(ErrorCode::bad_pattern,
           "phase at " + text::fixed(static_cast<double>(k) * series_->dt, 3) +
               " s: " + std::to_string(steps->steps) + " steps take " + text::fixed(needed, 2) +
               " s from standing to standing, the phase " + "has " + text::fixed(time, 2) +
               " s; make it longer or the steps fewer");
  }
  viip.set_goal(span->goal, end - k);
  plan_ = viip.plan();
}

const ControlOutput& Controller::update(const Estimate& estimate) {
  ControlOutput& out = out_;
  out.notes.clear();
  const long next = tick_ + 1;
  const auto sag = sag_.col(std::min<Eigen::Index>(
      footholds_ ? std::lround(footholds_->place()) : tick_, sag_.cols() - 1));
  if (auto* viip = std::get_if<Viip>(&law_)) {
    out = viip->update(estimate);
    plan_ = viip->plan();
  } else if (auto* jump = std::get_if<ViipJump>(&law_)) {
    out = jump->update(estimate);
    plan_ = jump->plan();
  } else {
    if (placement_.moved)
      for (Side side : {Side::left, Side::right})
        if (!supports(command(next).support, side)) {
          double& share = placement_.share[static_cast<int>(side)];
          share = std::max(0.0, share - series_->dt / kFootBlend);
        }
    if (placement_.moved) following_ = placed(next);
    if (footholds_ && footholds_->advance(estimate)) plan_.feet = footholds_->plan().feet;
    const CommandSample& following = footholds_         ? footholds_->plan()
                                     : placement_.moved ? following_
                                                        : command(next);
    if (auto* dtad = std::get_if<Dtad>(&law_)) {
      dtad->update(plan_, following, estimate, sag, out);
    } else {
      out.reference = plan_.state;
      out.target =
          plan_.state.theta + std::get<OpenLoop>(law_).lead.cwiseProduct(plan_.state.dtheta) + sag;
      out.cog = plan_.cog;
      out.cog_reference = {plan_.zmp, plan_.fz, Vector3d::Zero(), plan_.dcog};
    }
    plan_ = following;
  }
  target_ = out.target;
  tick_ = next;
  enter(next);
  return out;
}

}  // namespace ayumi
