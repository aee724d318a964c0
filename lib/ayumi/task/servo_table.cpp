#include "ayumi/task/servo_table.hpp"

#include <algorithm>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/torque_feedforward.hpp"
#include "ayumi/motion/servo_feedforward.hpp"
#include "ayumi/sim/simulate.hpp"

namespace ayumi {

namespace {

// One number where all joints have the same, else one per joint.
template <class Value>
std::string list_of(const ActuatorLimits& limits, const Value& value) {
  std::vector<std::string> texts;
  for (const ServoDescription& servo : limits.servo) texts.push_back(text::brief(value(servo), 6));
  const bool equal = std::all_of(texts.begin(), texts.end(),
                                 [&](const std::string& text) { return text == texts.front(); });
  return equal && !texts.empty() ? texts.front() : text::join(texts, " ");
}

}  // namespace

std::string name_of(ServoContent content) {
  return content == ServoContent::ideal  ? "ideal"
         : content == ServoContent::lead ? "lead"
                                         : "lead+sag";
}

ServoContent servo_content(const std::string& name) {
  for (const ServoContent content :
       {ServoContent::ideal, ServoContent::lead, ServoContent::lead_and_sag})
    if (name_of(content) == name) return content;
  fail(ErrorCode::usage, "unknown servo '" + name + "' (known: ideal, lead, lead+sag)");
}

TableServo table_servo(const RobotModel& model, const std::string& profile, ServoContent content) {
  const ActuatorLimits& limits = model.limits(profile);
  return {name_of(content), limits.name,
          list_of(limits, [](const ServoDescription& servo) { return servo.delay; }),
          list_of(limits,
                  [](const ServoDescription& servo) { return servo.kp > 0 ? servo.lag() : 0.0; })};
}

ReferenceTrajectory table_of_series(const RobotModel& model, const std::string& profile,
                                    const CommandSeries& series, ServoContent content) {
  const ActuatorLimits& limits = model.limits(profile);
  Eigen::VectorXd lead = velocity_lead(limits);
  if (content == ServoContent::ideal) lead.setZero();
  ReferenceTrajectory reference = leading_targets(model, series, lead);
  reference.servo = table_servo(model, profile, content);
  if (content != ServoContent::lead_and_sag) return reference;
  const Eigen::MatrixXd sag = torque_feedforward(model, limits, series);
  for (size_t k = 0; k < reference.rows.size(); ++k)
    reference.rows[k].theta += lead_at(sag, static_cast<long>(k));
  return reference;
}

ReferenceTrajectory table_of_log(const RobotModel& model, const std::string& profile,
                                 const SimulationLog& log, ServoContent content) {
  ReferenceTrajectory table = extract_reference(model, log);
  table.servo = table_servo(model, profile, content);
  const ActuatorLimits& limits = model.limits(profile);
  const ActuatorLimits& own = model.limits(log.provenance.profile);
  const bool same = limits.name == own.name;
  if (content == ServoContent::lead_and_sag && same) return table;
  const Eigen::VectorXd lead = velocity_lead(limits), own_lead = velocity_lead(own);
  const size_t last = log.samples.empty() ? 0 : log.samples.size() - 1;
  // A law that measures sends the posture that it has moved to in the tick, the next row's.
  const size_t ahead = log.controller && log.controller->kind != ControllerKind::none ? 1 : 0;
  const auto sent = [&](size_t k) -> const Eigen::VectorXd& {
    return log.samples[std::min(k + ahead, last)].reference_theta;
  };
  for (size_t k = 0; k <= last && k < table.rows.size(); ++k) {
    Eigen::VectorXd& target = table.rows[k].theta;
    if (content == ServoContent::ideal) {
      target = log.samples[k].reference_theta;
      continue;
    }
    const Eigen::VectorXd& theta = sent(k);
    const size_t before = k > 0 ? k - 1 : 0, after = std::min(k + 1, last);
    Eigen::VectorXd rate = Eigen::VectorXd::Zero(theta.size());
    if (after > before)
      rate = (sent(after) - sent(before)) / (static_cast<double>(after - before) * log.dt);
    Eigen::VectorXd sag = Eigen::VectorXd::Zero(theta.size());
    if (content == ServoContent::lead_and_sag)
      for (Eigen::Index j = 0; j < sag.size(); ++j) {
        const double kp = limits.servo[static_cast<size_t>(j)].kp;
        if (kp > 0)
          sag[j] = (target[j] - theta[j] - own_lead[j] * rate[j]) *
                   own.servo[static_cast<size_t>(j)].kp / kp;
      }
    target = theta + lead.cwiseProduct(rate) + sag;
  }
  return table;
}

}  // namespace ayumi
