#include "ayumi/task/servo_table.hpp"

#include <algorithm>
#include <utility>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/torque_feedforward.hpp"
#include "ayumi/model/encoder_angles.hpp"
#include "ayumi/motion/servo_feedforward.hpp"
#include "ayumi/sim/reference_row.hpp"
#include "ayumi/sim/simulate.hpp"

namespace ayumi {

namespace {

// One number if all joints have the same value, otherwise one number for each joint.
template <class Value>
std::string list_of(const ActuatorLimits& limits, const Value& value) {
  std::vector<std::string> texts;
  for (const ServoDescription& servo : limits.servo) texts.push_back(text::brief(value(servo), 6));
  const bool equal = std::all_of(texts.begin(), texts.end(),
                                 [&](const std::string& text) { return text == texts.front(); });
  return equal && !texts.empty() ? texts.front() : text::join(texts, " ");
}

// A law that uses measurements sends the posture to which it has moved in the tick. This is the
// posture of the next row.
size_t rows_ahead(const SimulationLog& log) {
  return log.controller && log.controller->kind != ControllerKind::none ? 1 : 0;
}

// The rate of the posture sent(k), computed from the neighbouring postures.
template <class Sent>
Eigen::VectorXd sent_rate(const Sent& sent, size_t k, size_t last, double dt) {
  const size_t before = k > 0 ? k - 1 : 0, after = std::min(k + 1, last);
  if (after == before) return Eigen::VectorXd::Zero(sent(k).size());
  return (sent(after) - sent(before)) / (static_cast<double>(after - before) * dt);
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
                  [](const ServoDescription& servo) { return servo.kp > 0 ? servo.lag() : 0.0; }),
          encoder_zeros(model)};
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

void append_posture(const SimulationSample& sample, ReferenceTrajectory& postures) {
  postures.rows.push_back(reference_row(sample));
}

ReferenceTrajectory table_of_postures(const RobotModel& model, const std::string& profile,
                                      const SimulationLog& about, ReferenceTrajectory postures) {
  ReferenceTrajectory table = std::move(postures);
  table.dt = about.dt;
  table.joints = model.dof_names();
  table.provenance = about.provenance;
  table.servo = table_servo(model, profile, ServoContent::lead);
  const Eigen::VectorXd lead = velocity_lead(model.limits(profile));
  std::vector<ReferenceRow>& rows = table.rows;
  const size_t ahead = rows_ahead(about), last = rows.empty() ? 0 : rows.size() - 1;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(lead.size());
  Eigen::VectorXd before, here;  // postures of the rows k - 1 and k, for which targets are computed
  for (size_t k = 0; k < rows.size(); ++k) {
    before = std::exchange(here, rows[k].theta);
    const auto posture = [&](size_t i) -> const Eigen::VectorXd& {
      return i == k ? here : i < k ? before : rows[i].theta;
    };
    const auto sent = [&](size_t i) -> const Eigen::VectorXd& {
      return posture(std::min(i + ahead, last));
    };
    // Adding 0 turns a target of -0 into 0, as a sag of 0 does.
    rows[k].theta = sent(k) + lead.cwiseProduct(sent_rate(sent, k, last, about.dt)) + zero;
  }
  return table;
}

ReferenceTrajectory table_of_log(const RobotModel& model, const std::string& profile,
                                 const SimulationLog& log, ServoContent content) {
  for (size_t j = 0; j < log.joints.size() || j < model.dofs().size(); ++j)
    if (j >= log.joints.size() || j >= model.dofs().size() || log.joints[j] != model.dofs()[j].name)
      fail(ErrorCode::usage,
           "the run has other joints than robot '" + model.name() + "' (" +
               (j < log.joints.size()
                    ? "joint " + std::to_string(j + 1) + " of the run is " + log.joints[j]
                    : "the run has only " + std::to_string(j) + " joints") +
               "). Give the robot of the run");
  if (content == ServoContent::lead) {
    ReferenceTrajectory postures;
    for (const SimulationSample& sample : log.samples) append_posture(sample, postures);
    return table_of_postures(model, profile, log, std::move(postures));
  }
  ReferenceTrajectory table = extract_reference(model, log);
  table.servo = table_servo(model, profile, content);
  const ActuatorLimits& limits = model.limits(profile);
  const ActuatorLimits& own = model.limits(log.provenance.profile);
  const bool same = limits.name == own.name;
  if (content == ServoContent::lead_and_sag && same) return table;
  const Eigen::VectorXd lead = velocity_lead(limits), own_lead = velocity_lead(own);
  const size_t last = log.samples.empty() ? 0 : log.samples.size() - 1;
  const size_t ahead = rows_ahead(log);
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
    const Eigen::VectorXd rate = sent_rate(sent, k, last, log.dt);
    Eigen::VectorXd sag = Eigen::VectorXd::Zero(theta.size());
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
