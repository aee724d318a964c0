// Counts are theta [deg] x counts_per_degree. With a real step s <= cap there is always a choice of
// neighbours whose whole step is <= cap: upwards floor(x + s) - floor(x) <= cap, downwards by
// ceilings; so rounding never breaks a limit that the motion keeps.
#include "ayumi/limits/table_safety.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/limits/amount_text.hpp"

namespace ayumi {

namespace {

constexpr double kDegreesPerRadian = 180 / EIGEN_PI;  // Definition
// Counts by which a limit may be missed. Chosen: the rounding of degrees and radians in double
// precision is far smaller, and a servo sees whole counts only. No measured case changes from half
// to twice (constants.md).
constexpr double kCountSlack = 1e-6;
// Definition: rounding of a step over its limit.
constexpr double kStepSlack = 1e-9;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Time over which the speed at both ends of a table of whole counts is judged [s]. Chosen: one
// count in it is 0.004 rad/s, far below the limit of 0.1 rad/s; from row to row one count is
// 0.08 rad/s. At half and at twice the value the recorded HOAP-3 motions begin and end at rest too.
constexpr double kRestWindow = 0.02;
constexpr int kLargestCount = 32767;  // Source: docs/formats.md, signed numbers of 16 bits

double counts_per_radian(const Dof& dof) {
  return dof.encoder.device > 0 ? dof.encoder.counts_per_degree * kDegreesPerRadian : 0;
}

struct TargetRange {
  double lower = -kInfinity, upper = kInfinity;
};

TargetRange soft_limits(const RobotModel& model, const Dof& dof) {
  const double margin = model.description().soft_limit_margin;
  return dof.limited ? TargetRange{dof.lower + margin, dof.upper - margin} : TargetRange{};
}

TargetRange count_limits(const RobotModel& model, const Dof& dof) {
  const TargetRange soft = soft_limits(model, dof);
  const double scale = counts_per_radian(dof);
  const double a = soft.lower * scale, b = soft.upper * scale;
  return {std::ceil(std::min(a, b) - kCountSlack), std::floor(std::max(a, b) + kCountSlack)};
}

// Columns of the table in the robot's joint order.
std::vector<Eigen::Index> columns_of(const RobotModel& model, const ReferenceTrajectory& table) {
  if (table.rows.empty()) fail(ErrorCode::bad_pattern, "the joint table has no rows");
  const std::vector<std::string> names = model.dof_names();
  std::vector<Eigen::Index> columns;
  for (const std::string& name : names) {
    const auto found = std::find(table.joints.begin(), table.joints.end(), name);
    if (found == table.joints.end())
      fail(ErrorCode::bad_pattern, "the joint table has no column for joint '" + name +
                                       "' of robot '" + model.name() + "'");
    columns.push_back(found - table.joints.begin());
  }
  if (table.joints.size() != names.size())
    fail(ErrorCode::bad_pattern, "the joint table has " + std::to_string(table.joints.size()) +
                                     " joints, but the robot '" + model.name() + "' has " +
                                     std::to_string(names.size()));
  return columns;
}

// The whole number nearest to x inside `range` and within `step` of `previous`, among its two
// neighbours; the nearest when neither will do.
int nearest_count(double x, const TargetRange& range, double previous, double step) {
  const double nearest = std::round(x);
  const double neighbour = nearest > x ? nearest - 1 : nearest + 1;
  for (const double candidate : {nearest, neighbour})
    if (candidate >= range.lower && candidate <= range.upper &&
        std::abs(candidate - previous) <= step && std::abs(candidate - x) < 1)
      return static_cast<int>(candidate);
  return static_cast<int>(std::clamp(nearest, -1e9, 1e9));
}

// Keeps the worst of each kind and joint, and all of them.
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
  const std::vector<SafetyViolation>& list() const { return list_; }
  const std::vector<SafetyViolation>& every() const { return every_; }

 private:
  std::vector<SafetyViolation> list_, every_;
};

// Judges one joint of a finished table.
class JointJudge {
 public:
  JointJudge(const RobotModel& model, int dof, const SafetyOptions& options, double dt)
      : dof_(model.dofs()[static_cast<size_t>(dof)]),
        soft_(soft_limits(model, dof_)),
        scale_(std::abs(counts_per_radian(dof_))),
        beyond_(options.beyond_range),
        share_(options.step_share),
        step_(scale_ > 0 ? count_step_limits(model, dt, options)[dof]
                         : largest_steps(model, dt, options)[dof]) {}

  void position(double theta, double t, SafetyReport& report, Violations& violations) const {
    const double margin = std::min(theta - soft_.lower, soft_.upper - theta);
    if (margin < report.min_limit_margin) {
      report.min_limit_margin = margin;
      report.margin_joint = dof_.name;
    }
    const double limit = theta < soft_.lower ? soft_.lower : soft_.upper;
    if (margin < -beyond_) violations.add({"position", dof_.name, t, theta, limit, "rad", 0});
  }

  /// `change` in counts where the joint has an encoder, else in rad.
  void step(double change, double t, SafetyReport& report, Violations& violations) const {
    const double ratio = std::abs(change) / step_;
    if (ratio > report.max_step_ratio) {
      report.max_step_ratio = ratio;
      report.worst_joint = dof_.name;
      report.worst_at = t;
    }
    if (ratio > share_ + kStepSlack)
      violations.add({"step", dof_.name, t, std::abs(change), share_ * step_,
                      scale_ > 0 ? "counts" : "rad", 0});
  }

  void range(int count, double t, Violations& violations) const {
    if (std::abs(count) > kLargestCount)
      violations.add(
          {"range", dof_.name, t, static_cast<double>(count), kLargestCount, "counts", 0});
  }

  bool has_encoder() const { return scale_ > 0; }
  const std::string& name() const { return dof_.name; }

 private:
  const Dof& dof_;
  TargetRange soft_;
  double scale_;   // counts per rad, 0 without encoder
  double beyond_;  // [rad]
  double share_;   // of step_
  double step_;    // per tick, counts or rad
};

// The motion of `count` rows between ramp and hold.
void judge_ends(const SafeTable& safe, size_t count, const SafetyOptions& options,
                SafetyReport& report, Violations& violations) {
  const ReferenceTrajectory& motion = safe.table;
  const size_t last = count - 1;
  if (last == 0) return;
  const auto window = static_cast<size_t>(std::lround(options.rest_window / motion.dt));
  const size_t span = std::clamp<size_t>(window, 1, last);
  const double time = static_cast<double>(span) * motion.dt;
  for (size_t j = 0; j < motion.joints.size(); ++j) {
    const auto at = [&](size_t k) {
      return motion.rows[safe.first + k].theta[static_cast<Eigen::Index>(j)];
    };
    const double start = std::abs(at(span) - at(0)) / time;
    const double end = std::abs(at(last) - at(last - span)) / time;
    report.start_speed = std::max(report.start_speed, start);
    report.end_speed = std::max(report.end_speed, end);
    if (start > options.rest_speed)
      violations.add(
          {"start_speed", motion.joints[j], report.ramp, start, options.rest_speed, "rad/s", 0});
    if (end > options.rest_speed)
      violations.add({"end_speed", motion.joints[j],
                      report.ramp + static_cast<double>(last) * motion.dt, end, options.rest_speed,
                      "rad/s", 0});
  }
}

void judge_rows(const RobotModel& model, const ReferenceTrajectory& table,
                const SafetyOptions& options, SafetyReport& report, Violations& violations) {
  const std::vector<Eigen::Index> columns = columns_of(model, table);
  const Eigen::MatrixXi counts =
      encoder_counts(model, table, count_step_limits(model, table.dt, options));
  report.min_limit_margin = kInfinity;
  for (int dof = 0; dof < model.dof_count(); ++dof) {
    const JointJudge judge(model, dof, options, table.dt);
    const Eigen::Index column = columns[static_cast<size_t>(dof)];
    for (size_t k = 0; k < table.rows.size(); ++k) {
      const double t = static_cast<double>(k) * table.dt;
      const double theta = table.rows[k].theta[column];
      const auto row = static_cast<Eigen::Index>(k);
      judge.position(theta, t, report, violations);
      if (judge.has_encoder()) judge.range(counts(row, dof), t, violations);
      if (k == 0) continue;
      judge.step(judge.has_encoder() ? counts(row, dof) - counts(row - 1, dof)
                                     : theta - table.rows[k - 1].theta[column],
                 t, report, violations);
    }
  }
}

double ramp_share(double s) { return s * s * s * (10 + s * (6 * s - 15)); }

// Long enough that the peak of the minimum jerk, 1.875 distance / duration, stays below half the
// speed any joint may have.
size_t ramp_rows(const Eigen::VectorXd& distance, const Eigen::VectorXd& speed, double dt,
                 const SafetyOptions& options) {
  if (options.ramp <= 0) return 0;
  double duration = options.ramp;
  for (Eigen::Index j = 0; j < distance.size(); ++j)
    duration = std::max(duration, 1.875 * std::abs(distance[j]) / (0.5 * speed[j]));
  return static_cast<size_t>(std::ceil(duration / dt - 1e-9));
}

// Speed any joint may have, by column of the table: the profile's, or the motor board's cap.
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

}  // namespace

SafetyOptions as_it_is(SafetyOptions options) {
  options.ramp = options.hold = 0;
  options.rest_window = kRestWindow;
  return options;
}

std::string on_both_clocks(double t, double begin, double end) {
  constexpr double kSlack = 1e-9;  // Definition: rounding of whole multiples of a tick [s]
  const std::string pattern = t < begin - kSlack ? "ramp"
                              : t > end + kSlack ? "hold"
                                                 : "pattern " + text::fixed(t - begin, 3) + " s";
  return text::fixed(t, 3) + " s (" + pattern + ")";
}

std::string text_of(const SafetyViolation& v, bool degrees) {
  const ShownUnit unit = shown_unit(v.unit, degrees);
  const auto quantity = [&](double value) {
    return text::brief(value * unit.scale, 6) + " " + unit.name;
  };
  const std::string what = v.kind == "start_speed" ? "speed at the start"
                           : v.kind == "end_speed" ? "speed at the end"
                           : v.kind == "range"     ? "encoder position"
                                                   : v.kind;
  return v.joint + " at " + on_both_clocks(v.t, v.begin, v.end) + ": " + what + " " +
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
        violations.add({"torque", model.dofs()[static_cast<size_t>(dof)].name,
                        begin + static_cast<double>(k) * dt, value, peak[dof], "N m", 0});
    }
  return violations.list();
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
                               const Eigen::VectorXd& step_limits) {
  const std::vector<Eigen::Index> columns = columns_of(model, table);
  Eigen::MatrixXi counts =
      Eigen::MatrixXi::Zero(static_cast<Eigen::Index>(table.rows.size()), model.dof_count());
  for (int dof = 0; dof < model.dof_count(); ++dof) {
    const Dof& joint = model.dofs()[static_cast<size_t>(dof)];
    const double scale = counts_per_radian(joint);
    if (scale == 0) continue;
    const TargetRange range = count_limits(model, joint);
    for (Eigen::Index k = 0; k < counts.rows(); ++k) {
      const double x =
          table.rows[static_cast<size_t>(k)].theta[columns[static_cast<size_t>(dof)]] * scale;
      const double previous = k > 0 ? counts(k - 1, dof) : x;
      counts(k, dof) = nearest_count(x, range, previous, k > 0 ? step_limits[dof] : kInfinity);
    }
  }
  return counts;
}

SafeTable make_safe(const RobotModel& model, ReferenceTrajectory reference,
                    const SafetyOptions& options) {
  const std::vector<Eigen::Index> columns = columns_of(model, reference);
  for (const ReferenceRow& row : reference.rows)
    if (!row.theta.allFinite())
      fail(ErrorCode::bad_pattern, "the joint table contains an angle that is not a finite number");
  const Eigen::VectorXd target = reference.rows.front().theta;
  Eigen::VectorXd from = target;
  if (options.from != "first") {
    const Eigen::VectorXd posture = model.posture(options.from);
    for (int dof = 0; dof < model.dof_count(); ++dof)
      from[columns[static_cast<size_t>(dof)]] = posture[dof];
  }
  SafeTable result;
  result.first =
      ramp_rows(target - from, speed_limits(model, columns, options), reference.dt, options);
  const auto hold =
      static_cast<size_t>(std::ceil(std::max(0.0, options.hold) / reference.dt - 1e-9));
  const size_t count = reference.rows.size();
  {
    // The rows of a long motion take most of the memory of a check, so none is there twice.
    std::vector<ReferenceRow> motion = std::move(reference.rows);
    result.table = std::move(reference);
    std::vector<ReferenceRow>& rows = result.table.rows;
    rows.clear();
    rows.reserve(result.first + count + hold);
    for (size_t k = 0; k < result.first; ++k) {
      const double s = static_cast<double>(k) / static_cast<double>(result.first);
      rows.push_back(motion.front());
      rows.back().theta = from + ramp_share(s) * (target - from);
    }
    std::move(motion.begin(), motion.end(), std::back_inserter(rows));
    for (size_t k = 0; k < hold; ++k) rows.push_back(ReferenceRow(rows.back()));
  }

  SafetyReport& report = result.report;
  report.ramp = static_cast<double>(result.first) * result.table.dt;
  report.hold = static_cast<double>(hold) * result.table.dt;
  report.motion = static_cast<double>(count - 1) * result.table.dt;
  Violations violations;
  judge_rows(model, result.table, options, report, violations);
  judge_ends(result, count, options, report, violations);
  add_violations(result, violations.list());
  report.rows = violations.every();
  return result;
}

void add_violations(SafeTable& safe, const std::vector<SafetyViolation>& violations) {
  std::vector<SafetyViolation>& list = safe.report.violations;
  for (const SafetyViolation& violation : violations) {
    list.push_back(violation);
    list.back().begin = safe.report.ramp;
    list.back().end = safe.report.ramp + safe.report.motion;
  }
  safe.report.safe = list.empty();
}

SafeTable make_safe_run(const RobotModel& model, const ReferenceTrajectory& reference,
                        const Eigen::MatrixXd& torque, const SafetyOptions& options) {
  SafeTable safe = make_safe(model, reference, options);
  add_violations(safe,
                 torque_violations(model, torque, reference.dt, safe.report.ramp, options.profile));
  return safe;
}

}  // namespace ayumi
