// Counts are encoder angles [deg] x counts_per_degree. For a real step s <= cap there is always a
// choice of neighbours whose whole step is <= cap: upwards floor(x + s) - floor(x) <= cap, and
// downwards the same with ceilings. So rounding never violates a limit that the motion keeps.
#include "ayumi/limits/table_safety.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/model/encoder_angles.hpp"

namespace ayumi {

namespace {

constexpr double kDegreesPerRadian = 180 / EIGEN_PI;  // Definition
// Number of counts by which a limit may be exceeded. Chosen: the rounding of degrees and radians in
// double precision is far smaller, and a servo only gets whole counts. No measured case changes
// between half and twice the value (constants.md).
constexpr double kCountSlack = 1e-6;
// Definition: tolerance for the rounding of a step over its limit.
constexpr double kStepSlack = 1e-9;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Time over which the speed at both ends of a table of whole counts is judged [s]. Chosen: one
// count in this time is 0.004 rad/s, far below the limit of 0.1 rad/s; from row to row, one count
// is 0.08 rad/s. With half and with twice the value, the recorded HOAP-3 motions also begin and end
// at rest.
constexpr double kRestWindow = 0.02;
// Longest ramp that is judged and written [s]. Chosen: as long as a motion may be. Even a motor of
// 1 rad/s turns its joint by 960 rad in this time; with half, it is 480 rad, with twice, 1920 rad.
constexpr double kLongestRamp = 3600;
constexpr int kLargestCount = 32767;  // Source: docs/formats.md, signed numbers of 16 bits

double counts_per_radian(const Dof& dof) {
  return dof.encoder.device > 0 ? dof.encoder.counts_per_degree * kDegreesPerRadian : 0;
}

TargetRange soft_limits(const RobotModel& model, const Dof& dof, double zero) {
  return target_range(dof, zero, model.description().soft_limit_margin);
}

TargetRange count_limits(const RobotModel& model, const Dof& dof, double zero) {
  const TargetRange soft = soft_limits(model, dof, zero);
  const double scale = counts_per_radian(dof);
  const double a = (soft.lower - zero) * scale, b = (soft.upper - zero) * scale;
  return {std::ceil(std::min(a, b) - kCountSlack), std::floor(std::max(a, b) + kCountSlack)};
}

// The columns of a table with these joints and this number of rows, in the robot's joint order.
std::vector<Eigen::Index> columns_of(const RobotModel& model,
                                     const std::vector<std::string>& joints, size_t rows) {
  if (rows == 0) fail(ErrorCode::bad_pattern, "the joint table has no rows");
  const std::vector<std::string> names = model.dof_names();
  std::vector<Eigen::Index> columns;
  for (const std::string& name : names) {
    const auto found = std::find(joints.begin(), joints.end(), name);
    if (found == joints.end())
      fail(ErrorCode::bad_pattern, "the joint table has no column for joint '" + name +
                                       "' of robot '" + model.name() + "'");
    columns.push_back(found - joints.begin());
  }
  if (joints.size() != names.size())
    fail(ErrorCode::bad_pattern, "the joint table has " + std::to_string(joints.size()) +
                                     " joints, but the robot '" + model.name() + "' has " +
                                     std::to_string(names.size()));
  return columns;
}

// The whole number nearest to x that is inside `range` and within `step` of `previous`, among the
// two neighbours of x; the nearest one if neither is.
int nearest_count(double x, const TargetRange& range, double previous, double step) {
  const double nearest = std::round(x);
  const double neighbour = nearest > x ? nearest - 1 : nearest + 1;
  for (const double candidate : {nearest, neighbour})
    if (candidate >= range.lower && candidate <= range.upper &&
        std::abs(candidate - previous) <= step && std::abs(candidate - x) < 1)
      return static_cast<int>(candidate);
  return static_cast<int>(std::clamp(nearest, -1e9, 1e9));
}

// Computes the encoder counts of one joint, row after row.
class CountRounder {
 public:
  CountRounder(const RobotModel& model, const Dof& dof, double zero, double step)
      : scale_(counts_per_radian(dof)),
        zero_(zero),
        range_(count_limits(model, dof, zero)),
        step_(step) {}
  /// `theta` is the angle of the joint.
  int next(double theta) {
    const double x = (theta - zero_) * scale_;
    const double previous = first_ ? x : previous_;
    previous_ = nearest_count(x, range_, previous, first_ ? kInfinity : step_);
    first_ = false;
    return previous_;
  }

 private:
  double scale_;  // counts per rad
  double zero_;   // angle of the joint while its encoder reads 0
  TargetRange range_;
  double step_;  // the largest step in counts
  int previous_ = 0;
  bool first_ = true;
};

// Keeps the worst violation of each kind and joint, and a list of all violations.
class Violations {
 public:
  void add(const SafetyViolation& found) {
    every_.push_back(found);
    every_.back().rows = 1;
    for (SafetyViolation& known : list_) {
      if (known.kind != found.kind || known.joint != found.joint) continue;
      const int rows = known.rows + 1;
      if (std::abs(found.value - found.limit) > std::abs(known.value - known.limit)) known = found;
      known.rows = rows;
      return;
    }
    list_.push_back(found);
    list_.back().rows = 1;
  }
  /// Adds the violations of another joint.
  void append(const Violations& other) {
    list_.insert(list_.end(), other.list_.begin(), other.list_.end());
    every_.insert(every_.end(), other.every_.begin(), other.every_.end());
  }
  const std::vector<SafetyViolation>& list() const { return list_; }
  const std::vector<SafetyViolation>& every() const { return every_; }

 private:
  std::vector<SafetyViolation> list_, every_;
};

// Judges one joint of a table, row after row.
class JointJudge {
 public:
  JointJudge(const RobotModel& model, int dof, const SafetyOptions& options, double dt)
      : dof_(model.dofs()[static_cast<size_t>(dof)]),
        soft_(soft_limits(model, dof_, encoder_zeros(model)[dof])),
        scale_(std::abs(counts_per_radian(dof_))),
        beyond_(options.beyond_range),
        share_(options.step_share),
        step_(scale_ > 0 ? count_step_limits(model, dt, options)[dof]
                         : largest_steps(model, dt, options)[dof]),
        rounder_(model, dof_, encoder_zeros(model)[dof], step_) {}

  void next(double theta, double t) {
    position(theta, t);
    // If the joint has an encoder, its steps are whole counts.
    const double target = scale_ > 0 ? rounder_.next(theta) : theta;
    if (scale_ > 0) range(static_cast<int>(target), t);
    if (!first_) step(target - before_, t);
    before_ = target;
    first_ = false;
  }

  /// Adds the results of this joint to those of the joints before it.
  void add_to(SafetyReport& report, Violations& violations) const {
    if (margin_ < report.min_limit_margin) {
      report.min_limit_margin = margin_;
      report.margin_joint = dof_.name;
    }
    if (ratio_ > report.max_step_ratio) {
      report.max_step_ratio = ratio_;
      report.worst_joint = dof_.name;
      report.worst_at = ratio_at_;
    }
    violations.append(violations_);
  }

 private:
  void position(double theta, double t) {
    const double margin = std::min(theta - soft_.lower, soft_.upper - theta);
    margin_ = std::min(margin_, margin);
    const double limit = theta < soft_.lower ? soft_.lower : soft_.upper;
    if (margin < -beyond_)
      violations_.add({TableLimit::position, dof_.name, t, theta, limit, "rad", 0});
  }

  // `change` in counts if the joint has an encoder, otherwise in rad.
  void step(double change, double t) {
    const double ratio = std::abs(change) / step_;
    if (ratio > ratio_) {
      ratio_ = ratio;
      ratio_at_ = t;
    }
    if (ratio > share_ + kStepSlack)
      violations_.add({TableLimit::step, dof_.name, t, std::abs(change), share_ * step_,
                       scale_ > 0 ? "counts" : "rad", 0});
  }

  void range(int count, double t) {
    if (std::abs(count) > kLargestCount)
      violations_.add({TableLimit::range, dof_.name, t, static_cast<double>(count), kLargestCount,
                       "counts", 0});
  }

  const Dof& dof_;
  TargetRange soft_;
  double scale_;   // counts per rad; 0 without an encoder
  double beyond_;  // allowed distance beyond the soft limits [rad]
  double share_;   // share of the largest step that may be used
  double step_;    // largest step in a tick, in counts or rad
  CountRounder rounder_;
  Violations violations_;
  bool first_ = true;
  double before_ = 0;          // target of the previous row, in counts or rad
  double margin_ = kInfinity;  // smallest margin so far [rad]
  double ratio_ = 0;           // largest share of step_ so far
  double ratio_at_ = 0;        // its time [s]
};

// A motion with a ramp before and a hold after it.
struct LaidMotion {
  size_t ramp = 0, motion = 0, hold = 0;  // numbers of rows
  Eigen::VectorXd from, target;           // ends of the ramp for each column of the table
  double duration = 0;                    // duration that the ramp needs [s]

  size_t count() const { return ramp + motion + hold; }
};

// Judges the two ends of the motion between ramp and hold.
void judge_ends(const TargetRows& motion, const SafetyOptions& options, SafetyReport& report,
                Violations& violations) {
  const size_t last = motion.count - 1;
  if (last == 0) return;
  const auto window = static_cast<size_t>(std::lround(options.rest_window / motion.dt));
  const size_t span = std::clamp<size_t>(window, 1, last);
  const double time = static_cast<double>(span) * motion.dt;
  const auto at = [&](size_t k) {
    Eigen::VectorXd theta;
    motion.row(k, theta);
    return theta;
  };
  const Eigen::VectorXd first = at(0), after = at(span), before = at(last - span),
                        end_at = at(last);
  for (size_t j = 0; j < motion.joints.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    const double start = std::abs(after[i] - first[i]) / time;
    const double end = std::abs(end_at[i] - before[i]) / time;
    report.start_speed = std::max(report.start_speed, start);
    report.end_speed = std::max(report.end_speed, end);
    if (start > options.rest_speed)
      violations.add({TableLimit::start_speed, motion.joints[j], report.ramp, start,
                      options.rest_speed, "rad/s", 0});
    if (end > options.rest_speed)
      violations.add({TableLimit::end_speed, motion.joints[j],
                      report.ramp + static_cast<double>(last) * motion.dt, end, options.rest_speed,
                      "rad/s", 0});
  }
}

double ramp_share(double s) { return s * s * s * (10 + s * (6 * s - 15)); }

// A duration for which the peak speed of the minimum jerk curve, 1.875 distance / duration, stays
// below half the speed that any joint may have [s].
double ramp_duration(const Eigen::VectorXd& distance, const Eigen::VectorXd& speed,
                     const SafetyOptions& options) {
  if (options.ramp <= 0) return 0;
  double duration = options.ramp;
  for (Eigen::Index j = 0; j < distance.size(); ++j)
    duration = std::max(duration, 1.875 * std::abs(distance[j]) / (0.5 * speed[j]));
  return duration;
}

bool is_too_long(double ramp, const SafetyOptions& options) {
  return !(ramp <= std::max(options.ramp, kLongestRamp));
}

// The largest speed of each joint, by column of the table: that of the profile, or the limit of the
// motor boards.
Eigen::VectorXd speed_limits(const RobotModel& model, const std::vector<Eigen::Index>& columns,
                             const SafetyOptions& options) {
  Eigen::VectorXd speed(static_cast<Eigen::Index>(columns.size()));
  for (int dof = 0; dof < model.dof_count(); ++dof) {
    double limit = model.limits(options.profile).speed[dof];
    const double scale = std::abs(counts_per_radian(model.dofs()[static_cast<size_t>(dof)]));
    if (scale > 0) limit = std::min(limit, options.counts_per_ms * 1000 / scale);
    speed[columns[static_cast<size_t>(dof)]] = limit;
  }
  return speed;
}

void add_to_report(SafetyReport& report, const std::vector<SafetyViolation>& violations) {
  for (const SafetyViolation& violation : violations) {
    report.violations.push_back(violation);
    report.violations.back().begin = report.ramp;
    report.violations.back().end = report.ramp + report.motion;
  }
  report.safe = report.violations.empty();
}

// The ramp and the hold that the options require. A ramp that is too long is replaced by a ramp of
// the smallest duration (SafetyOptions::ramp), whose steps are then violations.
LaidMotion laid(const RobotModel& model, const TargetRows& targets, const SafetyOptions& options) {
  require_within("the ramp of the table", options.ramp, SafetyOptions::kRest);
  require_within("the hold of the table", options.hold, SafetyOptions::kRest);
  const std::vector<Eigen::Index> columns = columns_of(model, targets.joints, targets.count);
  LaidMotion plan;
  targets.row(0, plan.target);
  plan.from = plan.target;
  if (options.from != "first") {
    // Where the posture is at a limit, the encoder of a unit with a zero may not reach it. The
    // robot then stands at the limit of its motor board.
    const Eigen::VectorXd posture = model.posture(options.from), zeros = encoder_zeros(model);
    for (int dof = 0; dof < model.dof_count(); ++dof) {
      const Dof& joint = model.dofs()[static_cast<size_t>(dof)];
      const TargetRange range = target_range(joint, zeros[dof], 0);
      const bool reaches = !joint.limited || range.lower > range.upper;
      plan.from[columns[static_cast<size_t>(dof)]] =
          reaches ? posture[dof] : std::clamp(posture[dof], range.lower, range.upper);
    }
  }
  plan.duration =
      ramp_duration(plan.target - plan.from, speed_limits(model, columns, options), options);
  const double judged = is_too_long(plan.duration, options) ? options.ramp : plan.duration;
  plan.ramp = static_cast<size_t>(std::ceil(judged / targets.dt - 1e-9));
  plan.motion = targets.count;
  plan.hold = static_cast<size_t>(std::ceil(std::max(0.0, options.hold) / targets.dt - 1e-9));
  return plan;
}

// Row k of the ramp.
Eigen::VectorXd ramp_at(const LaidMotion& plan, size_t k) {
  const double s = static_cast<double>(k) / static_cast<double>(plan.ramp);
  return plan.from + ramp_share(s) * (plan.target - plan.from);
}

SafetyReport report_on(const RobotModel& model, const TargetRows& targets, const LaidMotion& plan,
                       const SafetyOptions& options) {
  const std::vector<Eigen::Index> columns = columns_of(model, targets.joints, targets.count);
  SafetyReport report;
  report.ramp = static_cast<double>(plan.ramp) * targets.dt;
  report.hold = static_cast<double>(plan.hold) * targets.dt;
  report.motion = static_cast<double>(plan.motion - 1) * targets.dt;
  std::vector<JointJudge> judges;
  for (int dof = 0; dof < model.dof_count(); ++dof)
    judges.emplace_back(model, dof, options, targets.dt);
  Eigen::VectorXd theta;
  for (size_t k = 0; k < plan.count(); ++k) {
    if (k < plan.ramp)
      theta = ramp_at(plan, k);
    else if (k < plan.ramp + plan.motion)  // after these rows, the last row is held
      targets.row(k - plan.ramp, theta);
    if (!theta.allFinite())
      fail(ErrorCode::bad_pattern, "the joint table contains an angle that is not a finite number");
    const double t = static_cast<double>(k) * targets.dt;
    for (size_t dof = 0; dof < judges.size(); ++dof) judges[dof].next(theta[columns[dof]], t);
  }
  report.min_limit_margin = kInfinity;
  Violations violations;
  for (const JointJudge& judge : judges) judge.add_to(report, violations);
  judge_ends(targets, options, report, violations);
  add_to_report(report, violations.list());
  report.rows = violations.every();
  return report;
}

// The quantity that a limit concerns, for people.
std::string quantity_of(TableLimit limit) {
  switch (limit) {
    case TableLimit::range:
      return "encoder position";
    case TableLimit::start_speed:
      return "speed at the start";
    case TableLimit::end_speed:
      return "speed at the end";
    case TableLimit::position:
    case TableLimit::step:
    case TableLimit::torque:
      break;
  }
  return name_of(limit);
}

}  // namespace

const char* name_of(TableLimit limit) {
  switch (limit) {
    case TableLimit::position:
      return "position";
    case TableLimit::step:
      return "step";
    case TableLimit::range:
      return "range";
    case TableLimit::torque:
      return "torque";
    case TableLimit::start_speed:
      return "start_speed";
    case TableLimit::end_speed:
      return "end_speed";
  }
  return "";
}

SafetyOptions as_it_is(SafetyOptions options) {
  options.ramp = options.hold = 0;
  options.rest_window = kRestWindow;
  return options;
}

std::string on_both_clocks(double t, double begin, double end) {
  // Definition: tolerance for the rounding of whole multiples of a tick [s].
  constexpr double kSlack = 1e-9;
  const std::string pattern = t < begin - kSlack ? "in the ramp"
                              : t > end + kSlack ? "in the hold"
                                                 : text::fixed(t - begin, 3) + " s of the pattern";
  return text::fixed(t, 3) + " s (" + pattern + ")";
}

std::string text_of(const SafetyViolation& v, bool degrees) {
  const ShownUnit unit = shown_unit(v.unit, degrees);
  const auto quantity = [&](double value) {
    return text::brief(value * unit.scale, 6) + " " + unit.name;
  };
  return v.joint + " at " + on_both_clocks(v.t, v.begin, v.end) + ": " + quantity_of(v.kind) + " " +
         quantity(v.value) + ", limit " + quantity(v.limit) + " (in " +
         text::counted(v.rows, "row") + ")";
}

std::vector<SafetyViolation> torque_violations(const RobotModel& model,
                                               const Eigen::MatrixXd& torque, double dt,
                                               double begin, const std::string& profile) {
  const Eigen::VectorXd& peak = model.limits(profile).peak_torque;
  Violations violations;
  for (int dof = 0; dof < model.dof_count(); ++dof)
    for (Eigen::Index k = 0; k < torque.rows(); ++k) {
      const double value = std::abs(torque(k, dof));
      if (value > peak[dof] * (1 + 1e-6))
        violations.add({TableLimit::torque, model.dofs()[static_cast<size_t>(dof)].name,
                        begin + static_cast<double>(k) * dt, value, peak[dof], "N m", 0});
    }
  return violations.list();
}

TargetRange target_range(const Dof& dof, double zero, double margin) {
  if (!dof.limited) return {};
  return {dof.lower + std::max(zero, 0.0) + margin, dof.upper + std::min(zero, 0.0) - margin};
}

Eigen::VectorXd count_step_limits(const RobotModel& model, double dt,
                                  const SafetyOptions& options) {
  Eigen::VectorXd limits(model.dof_count());
  for (int dof = 0; dof < model.dof_count(); ++dof) {
    const double scale = std::abs(counts_per_radian(model.dofs()[static_cast<size_t>(dof)]));
    const double by_speed = model.limits(options.profile).speed[dof] * scale * dt;
    const double cap = std::min(options.counts_per_ms * dt * 1000, by_speed);
    limits[dof] = scale > 0 ? std::floor(cap + 1e-3) : kInfinity;
  }
  return limits;
}

Eigen::VectorXd largest_steps(const RobotModel& model, double dt, const SafetyOptions& options) {
  const Eigen::VectorXd counts = count_step_limits(model, dt, options);
  Eigen::VectorXd steps = dt * model.limits(options.profile).speed;
  for (int dof = 0; dof < model.dof_count(); ++dof) {
    const double scale = std::abs(counts_per_radian(model.dofs()[static_cast<size_t>(dof)]));
    if (scale > 0) steps[dof] = counts[dof] / scale;
  }
  return steps;
}

Eigen::MatrixXi encoder_counts(const RobotModel& model, const ReferenceTrajectory& table,
                               const SafetyOptions& options) {
  const Eigen::VectorXd step_limits = count_step_limits(model, table.dt, options),
                        zeros = encoder_zeros(model);
  const std::vector<Eigen::Index> columns = columns_of(model, table.joints, table.rows.size());
  Eigen::MatrixXi counts =
      Eigen::MatrixXi::Zero(static_cast<Eigen::Index>(table.rows.size()), model.dof_count());
  for (int dof = 0; dof < model.dof_count(); ++dof) {
    const Dof& joint = model.dofs()[static_cast<size_t>(dof)];
    if (counts_per_radian(joint) == 0) continue;
    CountRounder rounder(model, joint, zeros[dof], step_limits[dof]);
    const Eigen::Index column = columns[static_cast<size_t>(dof)];
    for (Eigen::Index k = 0; k < counts.rows(); ++k)
      counts(k, dof) = rounder.next(table.rows[static_cast<size_t>(k)].theta[column]);
  }
  return counts;
}

SafetyReport safety_of_targets(const RobotModel& model, const TargetRows& targets,
                               const SafetyOptions& options) {
  return report_on(model, targets, laid(model, targets, options), options);
}

SafeTable make_safe(const RobotModel& model, ReferenceTrajectory reference,
                    const SafetyOptions& options) {
  const TargetRows targets = {
      reference.dt, reference.joints, reference.rows.size(),
      [&](size_t k, Eigen::VectorXd& theta) { theta = reference.rows[k].theta; }};
  const LaidMotion plan = laid(model, targets, options);
  if (is_too_long(plan.duration, options))
    fail(ErrorCode::bad_pattern,
         "the joint table begins so far from posture '" + options.from +
             "' that the ramp to its first row would take " + text::brief(plan.duration) +
             " s. At most " + text::brief(kLongestRamp) +
             " s are allowed. Correct the angles of the first row. Perhaps their unit is wrong");
  SafeTable result;
  result.first = plan.ramp;
  result.report = report_on(model, targets, plan, options);
  // The rows of a long motion take much memory, so each row only exists once.
  std::vector<ReferenceRow> motion = std::move(reference.rows);
  result.table = std::move(reference);
  std::vector<ReferenceRow>& rows = result.table.rows;
  rows.clear();
  rows.reserve(plan.count());
  for (size_t k = 0; k < plan.ramp; ++k) {
    rows.push_back(motion.front());
    rows.back().theta = ramp_at(plan, k);
  }
  std::move(motion.begin(), motion.end(), std::back_inserter(rows));
  for (size_t k = 0; k < plan.hold; ++k) rows.push_back(ReferenceRow(rows.back()));
  return result;
}

void add_violations(SafeTable& safe, const std::vector<SafetyViolation>& violations) {
  add_to_report(safe.report, violations);
}

SafeTable make_safe_run(const RobotModel& model, const ReferenceTrajectory& reference,
                        const Eigen::MatrixXd& torque, const SafetyOptions& options) {
  SafeTable safe = make_safe(model, reference, options);
  add_violations(safe,
                 torque_violations(model, torque, reference.dt, safe.report.ramp, options.profile));
  return safe;
}

}  // namespace ayumi
