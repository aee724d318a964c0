// A robot receives a table of servo targets, theta + L dtheta with the lag L of the servo
// (motion/servo_feedforward). It has one row for each sample, in whole encoder counts if the joint
// has an encoder. If the motion is an unchanged imported sequence, the robot receives the rows of
// this sequence. `export` refuses a table whose targets step too far from row to row, leave the
// soft limits of the joint, or do not begin and end at rest. This limit adds the same ramp and hold
// to the same table and calls the same function (limits/table_safety), so that the table of a
// motion without a finding is accepted. For another profile than the robot's own, it only warns,
// because such a profile is for studies. A motion with goals of VIIP has no table before it is
// simulated.
//
// The rows of a repair keep, at every point,
//   |dtheta + L ddtheta| <= largest step / dt   and   lower + m <= theta + L dtheta <= upper - m
// with the limits of both the joint and its encoder (target_range).
#include <algorithm>

#include "ayumi/base/significant.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"
#include "ayumi/limits/table_safety.hpp"
#include "ayumi/model/encoder_angles.hpp"
#include "ayumi/motion/servo_feedforward.hpp"

namespace ayumi {

namespace {

// Definition: the tolerances are those of `export`, so that a larger tolerance has no effect.
const SafetyOptions kExport;

// Definition: details of a violation, which determine the unit of its value.
constexpr int kInCounts = 1, kInJointUnit = 0;

FindingKind kind_of(const SafetyViolation& violation) {
  if (violation.kind == "step") return FindingKind::table_step;
  if (violation.kind == "position" || violation.kind == "range") return FindingKind::table_position;
  return FindingKind::table_rest;
}

void make_table(JudgedMotion& motion) {
  if (!motion.series.viip.empty()) return;
  const auto least = [&](FindingKind kind, double of_export) {
    return std::min(motion.tolerance(kind), of_export);
  };
  SafetyOptions options;
  options.profile = motion.limits.name;
  options.step_share = least(FindingKind::table_step, kExport.step_share);
  options.beyond_range = least(FindingKind::table_position, kExport.beyond_range);
  options.rest_speed = least(FindingKind::table_rest, kExport.rest_speed);
  const std::optional<ReferenceTrajectory>& kept = motion.series.kept;
  // The table is as long as the motion, so it is judged without being stored.
  const Eigen::VectorXd lead = velocity_lead(motion.limits);
  TargetRows targets;
  if (kept) {
    targets = {kept->dt, kept->joints, kept->rows.size(),
               [&](size_t k, Eigen::VectorXd& theta) { theta = kept->rows[k].theta; }};
    options = as_it_is(options);
  } else {
    targets = {motion.series.dt, motion.model.dof_names(), motion.series.samples.size(),
               [&](size_t k, Eigen::VectorXd& theta) {
                 theta = leading_target(motion.series.samples[k], lead);
               }};
  }
  motion.safety = safety_of_targets(motion.model, targets, options);
}

void judge_table(JudgedMotion& motion) {
  if (!motion.safety) return;
  const auto sample_at = [&](double t) {
    const long row = std::lround((t - motion.safety->ramp) / motion.series.dt);
    return static_cast<int>(std::clamp<long>(row, 0, motion.count() - 1));
  };
  const SafetyReport& safety = *motion.safety;
  if (safety.max_step_ratio > 0)
    motion.raise(FindingKind::table_step, safety.max_step_ratio, sample_at(safety.worst_at),
                 motion.model.find_dof(safety.worst_joint));
  const bool own = motion.limits.name == motion.model.limits().name;
  for (const SafetyViolation& v : motion.safety->rows) {
    motion.table.add({kind_of(v), motion.model.find_dof(v.joint), sample_at(v.t),
                      own ? Severity::error : Severity::warning, v.value, v.limit,
                      std::abs(v.value - v.limit), v.unit == "counts" ? kInCounts : kInJointUnit});
  }
}

const RowKind kStepRows = {.name = "table_step", .order = {3, 4}};
const RowKind kTargetRows = {
    .name = "table_position", .unit = &RowPrices::angle, .beyond_check = true, .order = {3, 5}};

// The row of a step has the rate of the target at one sample, but the table has differences of two
// samples, which are larger at a peak with a kink. The latest motion shows by how much, as a rate.
double step_beyond_rate(const RowSite& site, int point, int dof, double lead) {
  const CommandSeries& motion = site.seen.empty() ? site.series : *site.seen.back();
  const auto count = static_cast<int>(motion.samples.size());
  const int k = site.points[static_cast<size_t>(point)].sample;
  const auto target = [&](int i) {
    const RobotState& state = motion.samples[static_cast<size_t>(i)].state;
    return state.theta[dof] + lead * state.dtheta[dof];
  };
  const CommandSample& here = motion.samples[static_cast<size_t>(k)];
  double largest = 0;
  for (const int i : {k, k + 1})
    if (i > 0 && i < count)
      largest = std::max(largest, std::abs(target(i) - target(i - 1)) / motion.dt);
  const double rate = std::abs(here.state.dtheta[dof] + lead * here.acceleration[6 + dof]);
  return std::max(0.0, largest - rate);
}

void place_step_rows(RowSite& site, int dof, double lead, double largest) {
  const RowSettings& settings = site.settings;
  for (int point = 0; point < site.count(); ++point) {
    const double used = site.most(point, [&](const CommandSample& s) {
      return std::abs(s.state.dtheta[dof] + lead * s.acceleration[6 + dof]) / largest;
    });
    if (used <= settings.watched_share) continue;
    const double beyond = step_beyond_rate(site, point, dof, lead) / largest;
    const double most =
        settings.limit_share - std::min(beyond, settings.exported_table.most_beyond);
    site.add(kStepRows, point, dof, JointRow{JointQuantity::speed, dof, 1 / largest, lead}, 1,
             -most, most)
        .active = settings.active;
  }
}

void place_target_rows(RowSite& site, int dof, double lead, double zero) {
  const Dof& joint = site.model.dofs()[dof];
  const RowSettings& settings = site.settings;
  // A tolerance below 0 requires a margin.
  const double tolerance =
      std::min(site.tolerance(FindingKind::table_position), kExport.beyond_range);
  const double margin = site.model.description().soft_limit_margin;
  const TargetRange allowed = target_range(joint, zero, margin);
  const TargetRange kept =
      target_range(joint, zero, margin + std::max({settings.joint_margin, 0.0, -tolerance}));
  const double middle = 0.5 * (kept.lower + kept.upper), half = 0.5 * (kept.upper - kept.lower);
  if (!joint.limited || !(half > 0)) return;
  for (int point = 0; point < site.count(); ++point) {
    const double used = site.most(point, [&](const CommandSample& s) {
      return std::abs(s.state.theta[dof] + lead * s.state.dtheta[dof] - middle) / half;
    });
    if (used <= settings.watched_share) continue;
    const RobotState& given = site.given(point).state;
    const auto [lower, upper] =
        range_with_given({kept.lower, kept.upper}, {allowed.lower, allowed.upper},
                         given.theta[dof] + lead * given.dtheta[dof], tolerance);
    site.add(kTargetRows, point, dof, JointRow{JointQuantity::angle, dof, 1, lead}, 1, lower, upper)
        .active = settings.active;
  }
}

void place_table_rows(RowSite& site) {
  if (site.actuators.name != site.model.limits().name || !site.series.viip.empty()) return;
  const Eigen::VectorXd lead = velocity_lead(site.actuators), zeros = encoder_zeros(site.model);
  SafetyOptions options;
  options.profile = site.actuators.name;
  const Eigen::VectorXd largest = largest_steps(site.model, site.series.dt, options);
  const double share = std::min(site.tolerance(FindingKind::table_step), kExport.step_share);
  for (int i = 0; i < site.model.dof_count(); ++i) {
    if (site.is_locked(i)) continue;
    if (std::isfinite(largest[i]))
      place_step_rows(site, i, lead[i], share * largest[i] / site.series.dt);
    // Without lead and zero, the rows of the joint's own position are the same.
    if (lead[i] > 0 || zeros[i] != 0) place_target_rows(site, i, lead[i], zeros[i]);
  }
}

bool step_holds(JudgedMotion&, const Violation& v, double pace) {
  return std::abs(v.value) * pace <= std::abs(v.limit);
}

const char* table_unit(const JudgedMotion& motion, const Violation& v) {
  return v.detail == kInCounts ? "counts" : joint_unit(motion, v, "rad", "m");
}

const char* rest_unit(const JudgedMotion& motion, const Violation& v) {
  return joint_unit(motion, v, "rad/s", "m/s");
}

/// The text of a refusal, such as "`export` refuses the table, because the servo target of l_knee,
/// which leads the posture by ...".
std::string refused_text(const JudgedMotion& motion, const Violation& v) {
  const double lag = velocity_lead(motion.limits)[v.item];
  return "`export` refuses the table, because the servo target of " +
         motion.model.dofs()[v.item].name +
         (lag > 0 ? ", which leads the posture by " + text::brief(1e3 * lag, 3) + " ms," : "");
}

Advice target_step_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  return {refused_text(motion, v) + " moves " +
              text::fixed(100 * (std::abs(v.value / v.limit) - 1), 1) + " % further in " +
              text::brief(1e3 * motion.series.dt, 3) + " ms than the motor can follow",
          "move " + motion.model.dofs()[v.item].name +
              " more slowly, or accelerate this joint more gently here",
          kOrRepair};
}

Advice table_position_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  const Dof& dof = motion.model.dofs()[v.item];
  const double beyond = std::abs(v.value - v.limit);
  const std::string amount = v.detail == kInCounts ? text::fixed(beyond, 0) + " counts"
                             : dof.prismatic       ? text::brief(1e3 * beyond, 3) + " mm"
                                                   : angle_size(beyond, motion.degrees, 3);
  return {refused_text(motion, v) + " is " + amount + " beyond its range",
          "move " + dof.name +
              " back by this amount, or let the joint reverse its direction more gently",
          kOrRepair};
}

Advice rest_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  return {refused_text(motion, v) + " moves at the " + (window.first == 0 ? "beginning" : "end") +
              " of the table",
          motion.model.dofs()[v.item].name + " has to " + (window.first == 0 ? "start" : "stop") +
              " gently and at rest, for example with a segment of minimum_jerk",
          ""};
}

std::string target_step_infeasibility(const Finding& f, double violation) {
  return "the servo target of " + f.where + " changes by " + ratio_text(violation) +
         " times the step that `export` accepts";
}

std::string table_position_infeasibility(const Finding& f, double) {
  const ShownUnit unit = shown_unit(f.unit, f.in_degrees);
  return "the servo target of " + f.where + " reaches " + text::brief(f.worst * unit.scale, 6) +
         " " + unit.name + ", but `export` accepts only " + text::brief(f.limit * unit.scale, 6) +
         " " + unit.name;
}

std::string rest_infeasibility(const Finding& f, double) {
  const ShownUnit unit = shown_unit(f.unit, f.in_degrees);
  return "the servo target of " + f.where + " has " + text::significant(f.worst * unit.scale, 3) +
         " " + unit.name + " at an end of the motion, but `export` accepts at most " +
         text::significant(f.limit * unit.scale, 3) + " " + unit.name;
}

}  // namespace

const Limit& exported_table_limit() {
  static const Limit limit = {
      .findings =
          {{.kind = FindingKind::table_step,
            .limit_class = LimitClass::rate,
            .unit = "1",
            .tolerance = kExport.step_share,
            .meaning =
                "step of the servo target from row to row of the table, divided by "
                "the step that `export` accepts; a tolerance above the default has no effect",
            .figure = {.key = "max_table_step_ratio",
                       .label = "largest step of the exported table",
                       .unit = "% of the step that `export` accepts",
                       .scale = 100,
                       .line = 22},
            .repair = {.is_of_one_joint = true},
            .finding_unit = table_unit,
            .place = joint_place,
            .advice = target_step_advice,
            .infeasibility = target_step_infeasibility,
            .holds_at = step_holds},
           {.kind = FindingKind::table_position,
            .limit_class = LimitClass::rate,
            .unit = "rad",
            .tolerance = kExport.beyond_range,
            .meaning = "servo target beyond the range of the joint, which `export` "
                       "refuses; a tolerance above the default has no effect",
            .repair = {.is_of_one_joint = true},
            .finding_unit = table_unit,
            .place = joint_place,
            .advice = table_position_advice,
            .infeasibility = table_position_infeasibility},
           {.kind = FindingKind::table_rest,
            .limit_class = LimitClass::rate,
            .unit = "rad/s",
            .tolerance = kExport.rest_speed,
            .meaning = "speed of the servo target at the ends of the table, which has to "
                       "begin and end at rest; a tolerance above the default has no effect",
            .repair = {.is_of_one_joint = true},
            .finding_unit = rest_unit,
            .place = joint_place,
            .advice = rest_advice,
            .infeasibility = rest_infeasibility}},
      .look_ahead = make_table,
      .judge_motion = judge_table,
      .place_rows = place_table_rows};
  return limit;
}

}  // namespace ayumi
