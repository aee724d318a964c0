#include "ayumi/control/controller.hpp"

#include <cmath>
#include <utility>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/torque_feedforward.hpp"

namespace ayumi {

void check_controller(const RobotModel& model, const ControllerSpec& spec) {
  if (has_dtad_gains(spec.type.kind)) dtad_params(model, spec);
  viip_params(model, spec);
}

std::vector<std::pair<std::string, double>> gains_in_use(const RobotModel& model,
                                                         const ControllerSpec& spec) {
  if (has_dtad_gains(spec.type.kind)) return gains_of(dtad_params(model, spec));
  if (spec.type.kind == ControllerKind::viip) return gains_of(viip_params(model, spec));
  return {};
}

Controller::Controller(const RobotModel& model, const ActuatorLimits& limits,
                       const CommandSeries& series, const ControllerSpec& spec)
    : model_(&model),
      limits_(limits),
      series_(&series),
      spec_(spec),
      start_(series.samples.front().state),
      target_(start_.theta),
      law_(first_law()) {
  enter(0);
}

// Checks gains and goals, and computes the torques that the servos receive in addition to the
// command.
Controller::Law Controller::first_law() {
  check_controller(*model_, spec_);
  if (spec_.type.kind == ControllerKind::viip && series_->viip.empty())
    fail(ErrorCode::bad_pattern, "controller " + name_of(spec_.type) +
                                     ": the pattern has no phase with \"viip\" goals. Add such a "
                                     "phase, or use the controller 'dtad'");
  Eigen::MatrixXd lead;
  const bool as_they_are = spec_.type == ControllerKind::none && series_->targets.cols() > 0;
  if (as_they_are) target_ = start_.theta = series_->targets.col(0);
  if (series_->viip.empty() && !as_they_are) lead = torque_feedforward(*model_, limits_, *series_);
  const bool in_command = series_->servo_commands;
  if (lead.size() > 0 && in_command) start_.theta -= lead.col(0);
  if (lead.size() == 0 || in_command) lead.setZero(model_->dof_count(), 1);
  target_ += lead.col(0);
  torque_lead_ = std::make_shared<const Eigen::MatrixXd>(std::move(lead));
  const CommandPlan command(*series_);
  const CommandSample& plan = command.now();
  return law_of_command({plan.state, plan.dcog, target_, plan, command});
}

// Makes DTAD or open loop, which continues from the plan of the handover.
Controller::Law Controller::law_of_command(Handover from) const {
  const bool own_gains = has_dtad_gains(spec_.type.kind);
  if (!own_gains && spec_.type != ControllerKind::viip)
    return OpenLoop(limits_, from.command, torque_lead_, from.target, series_->targets);
  const DtadParams params =
      dtad_params(*model_, own_gains ? spec_ : ControllerSpec{ControllerKind::dtad, {}});
  if (params.moves_footholds() && series_->viip.empty())
    from.command.move_footholds(*model_, params.footholds());
  Dtad law(*model_, limits_, params, from.command, torque_lead_, from.target);
  if (tick_ > 0) law.take_over(from);
  return law;
}

// The span at tick k. The last span continues after the end of the series.
const ViipSpan* Controller::span_at(long k) const {
  if (spec_.type == ControllerKind::none) return nullptr;
  const long last = static_cast<long>(series_->samples.size()) - 1;
  for (const ViipSpan& span : series_->viip)
    if (k >= span.begin && (k < span.end || span.end >= last)) return &span;
  return nullptr;
}

// Before tick k, changes the law and the goal of VIIP where a span begins or ends.
void Controller::enter(long k) {
  const ViipSpan* span = span_at(k);
  if (span == span_) return;
  span_ = span;
  if (span) return start_viip(*span, k);
  Handover from = std::visit([](const auto& law) { return law.handover(); }, law_);
  from.command.go_on_from(from.plan, k);
  law_ = law_of_command(std::move(from));
}

void Controller::start_viip(const ViipSpan& span, long k) {
  const auto* jump = std::get_if<JumpGoal>(&span.goal);
  if (jump || !std::holds_alternative<Viip>(law_)) {
    const Handover from = std::visit([](const auto& law) { return law.handover(); }, law_);
    const CommandSample held = from.command.at(k);
    const ViipParams params = viip_params(*model_, spec_);
    if (jump)
      law_ = ViipJump(*model_, limits_, params, series_->dt, from, held, *jump);
    else
      law_ = Viip(*model_, limits_, params, series_->dt, from, held);
  }
  if (!jump) set_goal(span, k);
}

// Successive phases with steps and without a gap between them have a common end.
void Controller::set_goal(const ViipSpan& span, long k) {
  long end = span.end;
  for (const ViipSpan& next : series_->viip)
    if (next.begin == end && std::holds_alternative<StepGoal>(span.goal) &&
        std::holds_alternative<StepGoal>(next.goal))
      end = next.end;
  Viip& viip = std::get<Viip>(law_);
  if (const auto* steps = std::get_if<StepGoal>(&span.goal)) {
    const double time = static_cast<double>(end - k) * series_->dt;
    const double needed = stepping_time(viip_params(*model_, spec_), viip.omega(), steps->steps);
    if (steps->steps > 0 && needed > time)
      fail(ErrorCode::bad_pattern,
           "phase at " + text::fixed(static_cast<double>(k) * series_->dt, 3) +
               " s: " + std::to_string(steps->steps) + " steps take " + text::fixed(needed, 2) +
               " s from standing to standing, but the phase lasts " + text::fixed(time, 2) +
               " s. Make the phase longer, or take fewer steps");
  }
  viip.set_goal(span.goal, end - k);
}

const ControlOutput& Controller::update(const Estimate& estimate) {
  out_.notes.clear();
  // Only the laws of VIIP need the weights here. The plans of the other laws contain them.
  if (const Eigen::VectorXd* weight = series_->joint_weight_at(tick_)) {
    if (Viip* viip = std::get_if<Viip>(&law_)) viip->weigh(*weight);
    if (ViipJump* jump = std::get_if<ViipJump>(&law_)) jump->weigh(*weight);
  }
  std::visit([&](auto& law) { law.update(estimate, out_); }, law_);
  target_ = out_.target;
  ++tick_;
  enter(tick_);
  return out_;
}

}  // namespace ayumi
