#include "ayumi/identify/lost_rows.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// Number of rows on each side of a place that are used to find a step. Chosen: noise of an encoder
// of half a count then only hides one lost row if all joints move by less than a fifth of a count
// per row.
constexpr Index kStepRows = 5;

// Number of rows on each side in which lost rows must explain the remaining differences, and the
// part of these differences that may stay. Chosen: a servo settles after a sudden move within these
// rows. One row that is removed from a recorded walk leaves at most 0.69; quick moves of a
// simulated robot without a lost row leave 0.83 and more.
constexpr Index kSurroundingRows = 50;
constexpr double kMostLeft = 0.75;

// Smallest size of a step, in its standard deviations. Chosen: in a recorded walk of 17902 rows
// without a lost row, steps that are near a whole number of rows reach less than half of this size.
constexpr double kClearStep = 5;

// After a lost row, all further rows are too early, so the change of the delay lasts. The constants
// are, in this order: the time on both sides of a step in which the delays are compared [s]; the
// shortest such time [s]; the smallest lasting change [rows]; its largest difference from the step
// [rows]; and this difference as a part of the step. Chosen: recorders record some rows up to 0.45
// rows late and the next rows on time again, and joints may begin to slide within a row. Neither
// change lasts.
constexpr double kLastingTime = 0.75, kLeastLastingTime = 0.3;
constexpr double kLeastStep = 0.6, kStepMargin = 0.35, kStepShare = 0.25;

// Number of the clearest steps that are examined. Chosen: about ten rows belong to each.
constexpr size_t kMostSteps = 60;

// Smallest noise of a joint: in steps of its encoder, and in [rad, m] for values that are not
// rounded. Derived: rounding alone has a standard deviation of 0.29 steps.
constexpr double kLeastNoise = 0.29, kLeastNoiseAngle = 1e-7;

// Length of the windows in which the delay of the response is estimated [s], and a change of the
// delay that only missing or repeated rows explain [s]. Chosen: a motion has all its rates within a
// window, and the change is far beyond the effect of friction and load on the mean of several
// windows.
constexpr double kDelayWindow = 1.5, kDelayJump = 0.003;

// Conditions for a change of the delay: the least information of a window, as a part of the
// information of the best window; the largest spread of the delays of both sides together, as a
// part of the change; and the smallest number of windows on each side. Chosen: a delay needs
// motion, a spread needs two values, and a change that is four times the spread is no drift.
constexpr double kLeastInformation = 0.1, kMostSpread = 0.25;
constexpr int kLeastWindows = 2;

// Smallest change of the delay around a rest that counts as lost rows, as a part of a row. Chosen:
// between a whole row and the delays of a recorded walk, which differ by 0.1 ms between windows.
constexpr double kRestJump = 0.75;

// Least information of a change of delay, as a part of the information on each side. Derived:
// joints that move in the same way on both sides have half; joints that only sway with the motion
// of others have hundredths.
constexpr double kLeastCommon = 0.1;

// Time without motion that counts as a rest [s], and the part of the mean information below which
// nothing moves. Chosen: in such a time, step_in_motion() cannot find a step.
constexpr double kRestTime = 0.05, kRestShare = 0.02;

double middle_of(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The standard deviation of values that are normal except for a few.
double robust_deviation(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return 1.4826 * middle_of(std::move(values));
}

// The difference between a joint and its delayed command, by row of the recording, and the change
// of that difference; both are multiples of the noise.
struct FollowingJoint {
  VectorXd error, per_row;  // the difference, and its change by one lost row
};
FollowingJoint following(const AngleTable& command, const AngleTable& measured, Index dof,
                         double delay) {
  const Index rows = measured.theta.rows();
  const double h = measured.dt;
  FollowingJoint joint{VectorXd(rows), VectorXd(rows)};
  std::vector<double> steps;
  for (Index k = 0; k < rows; ++k) {
    const double t = h * static_cast<double>(k) - delay;
    joint.error[k] = measured.theta(k, dof) - angle_at(command, dof, t);
    joint.per_row[k] = (angle_at(command, dof, t + 5 * h) - angle_at(command, dof, t - 5 * h)) / 10;
    if (k > 0) steps.push_back(joint.error[k] - joint.error[k - 1]);
  }
  const double count = measured.resolution.size() > dof ? measured.resolution[dof] : 0;
  const double noise = std::max(
      {robust_deviation(std::move(steps)) / std::sqrt(2.0), kLeastNoise * count, kLeastNoiseAngle});
  joint.error /= noise;
  joint.per_row /= noise;
  return joint;
}

// The number of lost rows before row k, by least squares, and the standard deviation of this number
// for noise alone. The other unknowns are a constant and a slope of each joint, and one delay of
// all joints. A joint and its twin on the other side may slip, so the other joints must agree:
// `without_clearest` leaves out the two joints that show the step most clearly.
struct RowStep {
  double rows = 0, deviation = HUGE_VAL;
};
RowStep row_step(const std::vector<FollowingJoint>& joints, Index k,
                 bool without_clearest = false) {
  constexpr Index kRows = 2 * kStepRows;
  using Window = Eigen::Matrix<double, kRows, 1>;
  static const Window kSlope = Window::LinSpaced(kRows, -1, 1).normalized();
  const auto without_line = [](Window x) -> Window {
    x.array() -= x.mean();
    return x - x.dot(kSlope) * kSlope;
  };
  using Sums = Eigen::Matrix<double, 5, 1>;
  Sums sums = Sums::Zero(), clearest = Sums::Zero(), second = Sums::Zero();
  for (const FollowingJoint& joint : joints) {
    const Window delay = joint.per_row.segment<kRows>(k - kStepRows);
    Window step = delay;
    step.head<kStepRows>().setZero();
    const Window u = without_line(delay), v = without_line(step),
                 e = without_line(joint.error.segment<kRows>(k - kStepRows));
    const Sums joint_sums = {u.squaredNorm(), u.dot(v), v.squaredNorm(), u.dot(e), v.dot(e)};
    sums += joint_sums;
    if (joint_sums[2] > clearest[2])
      second = clearest, clearest = joint_sums;
    else if (joint_sums[2] > second[2])
      second = joint_sums;
  }
  if (without_clearest) sums -= clearest + second;
  const double b = sums[1], c = sums[2], x = sums[3], y = sums[4];
  // At a constant speed, the data do not determine the delay. The small additional term then keeps
  // the delay near zero.
  const double a = sums[0] + 1e-3 * c;
  const double determinant = a * c - b * b;
  if (!(c > 0) || !(determinant > 0)) return {};
  return {(a * y - b * x) / determinant, std::sqrt(a / determinant)};
}

// A constant, a slope and a delay of each joint are fitted to the differences around row k. Returns
// the part of the residual that is left if `lost` rows are lost as well; the noise is subtracted
// from both residuals. For the response of servos to a sudden move, most of the residual is left.
// Such a response looks like a step for a few rows, and it looks the same for all joints that make
// the move.
double left_around(const std::vector<FollowingJoint>& joints, Index k, double lost) {
  double without = 0, with = 0;
  for (const FollowingJoint& joint : joints) {
    const Index begin = std::max<Index>(0, k - kSurroundingRows),
                rows = std::min(joint.error.size(), k + kSurroundingRows) - begin;
    Eigen::MatrixXd explained(rows, 3);
    explained << VectorXd::Ones(rows), VectorXd::LinSpaced(rows, -1, 1),
        joint.per_row.segment(begin, rows);
    if (explained.col(2).isZero(0)) continue;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(explained);
    const auto rest = [&](const VectorXd& x) -> VectorXd {
      return x - explained * solver.solve(x);
    };
    VectorXd step = joint.per_row.segment(begin, rows);
    step.head(k - begin).setZero();
    const VectorXd error = rest(joint.error.segment(begin, rows));
    const double noise = static_cast<double>(rows - explained.cols());
    without += error.squaredNorm() - noise;
    with += (error - lost * rest(step)).squaredNorm() - noise;
  }
  return without > 0 ? with / without : HUGE_VAL;
}

// The time by which one joint is behind its command from row `begin` on. It follows by least
// squares with the joint's position, the direction of its rate and a constant, which load and
// friction change. `weight` is the information that the window has.
double delay_in_window(const AngleTable& command, const AngleTable& measured, Index dof,
                       Index begin, Index rows, double& weight) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  const double h = measured.dt;
  for (Index k = begin; k < begin + rows; ++k) {
    const double t = h * static_cast<double>(k), c = angle_at(command, dof, t);
    const double rate =
        (angle_at(command, dof, t + 5 * h) - angle_at(command, dof, t - 5 * h)) / (10 * h);
    const Eigen::Vector4d row(rate, c, rate > 0 ? 1 : rate < 0 ? -1 : 0, 1);
    normal += row * row.transpose();
    right += (c - measured.theta(k, dof)) * row;
  }
  weight = 0;
  if (normal(0, 0) <= 0) return 0;
  normal.diagonal().array() += 1e-9 * normal.diagonal().array().maxCoeff();
  const Eigen::Matrix4d inverse = normal.inverse();
  weight = inverse(0, 0) > 0 ? 1 / inverse(0, 0) : 0;
  return (inverse * right)[0];
}

// The delay of one joint in some rows [s], and the information about it in these rows.
struct Delay {
  double value = 0, weight = 0;
};
std::vector<Delay> delays_of_rows(const AngleTable& command, const AngleTable& measured,
                                  const std::vector<Index>& dofs, Index begin, Index rows) {
  std::vector<Delay> delays;
  for (const Index j : dofs) {
    Delay delay;
    delay.value = delay_in_window(command, measured, j, begin, rows, delay.weight);
    delays.push_back(delay);
  }
  return delays;
}

// The difference by which the delays are greater afterwards [s]. Each joint is compared with
// itself, since joints with different servos move one after the other in many motions. Returns
// nothing if the joints that move on both sides have little of the information.
std::optional<double> change_of(const std::vector<Delay>& before, const std::vector<Delay>& after) {
  double sum = 0, total = 0, all_before = 0, all_after = 0;
  for (size_t j = 0; j < before.size(); ++j) {
    all_before += before[j].weight, all_after += after[j].weight;
    if (!(before[j].weight > 0) || !(after[j].weight > 0)) continue;
    // The variance of a difference is the sum of both variances.
    const double weight = 1 / (1 / before[j].weight + 1 / after[j].weight);
    sum += weight * (after[j].value - before[j].value), total += weight;
  }
  if (!(total > kLeastCommon * std::min(all_before, all_after))) return std::nullopt;
  return sum / total;
}

// The number of rows by which the recording is earlier after row k than before it.
std::optional<double> lasting_step(const AngleTable& command, const AngleTable& measured,
                                   const std::vector<Index>& dofs, Index k) {
  const auto rows_of = [&](double time) {
    return static_cast<Index>(std::lround(time / measured.dt));
  };
  const Index before = std::min(k - kStepRows, rows_of(kLastingTime)),
              after = std::min(measured.theta.rows() - k - kStepRows, rows_of(kLastingTime));
  if (std::min(before, after) < rows_of(kLeastLastingTime)) return std::nullopt;
  const auto change =
      change_of(delays_of_rows(command, measured, dofs, k - kStepRows - before, before),
                delays_of_rows(command, measured, dofs, k + kStepRows, after));
  if (!change) return std::nullopt;
  return -*change / measured.dt;
}

LostRows step_in_motion(const AngleTable& command, const AngleTable& measured,
                        const std::vector<Index>& dofs, double delay) {
  std::vector<FollowingJoint> joints;
  for (const Index j : dofs) joints.push_back(following(command, measured, j, delay));
  const Index rows = measured.theta.rows();
  std::vector<RowStep> steps(static_cast<size_t>(rows));
  std::vector<double> ratios;
  for (Index k = kStepRows; k + kStepRows <= rows; ++k) {
    const RowStep step = row_step(joints, k);
    steps[static_cast<size_t>(k)] = step;
    if (std::isfinite(step.deviation)) ratios.push_back(step.rows / step.deviation);
  }
  // The behaviour of a servo apart from its delay is not white noise.
  const double more = std::max(1.0, robust_deviation(ratios));
  std::vector<size_t> clear;
  const auto ratio = [&](size_t k) { return std::abs(steps[k].rows) / steps[k].deviation; };
  for (size_t k = 0; k < steps.size(); ++k)
    if (std::abs(steps[k].rows) >= kLeastStep && ratio(k) > kClearStep * more) clear.push_back(k);
  std::stable_sort(clear.begin(), clear.end(),
                   [&](size_t a, size_t b) { return ratio(a) > ratio(b); });
  if (clear.size() > kMostSteps) clear.resize(kMostSteps);
  LostRows lost;
  double least = HUGE_VAL;
  for (const size_t k : clear) {
    const auto row = static_cast<Index>(k);
    const double step = steps[k].rows;
    const auto lasting = lasting_step(command, measured, dofs, row);
    if (!lasting || std::abs(*lasting) < kLeastStep) continue;
    const auto agrees = [&](double other) {
      return std::abs(*lasting - other) <= kStepMargin + kStepShare * std::abs(other);
    };
    const RowStep others = row_step(joints, row, true);
    if (!agrees(step) || !agrees(others.rows) ||
        std::abs(others.rows) < kClearStep * others.deviation)
      continue;
    const double whole = std::round(*lasting), left = left_around(joints, row, whole);
    if (left > kMostLeft || left >= least) continue;
    least = left;
    lost = {true, true, row, whole};
  }
  return lost;
}

// Whether nothing moves for a while around a row.
bool rests_near(const AngleTable& command, const std::vector<Index>& dofs, double begin,
                double end) {
  const auto information = [&](double t) {
    double sum = 0;
    for (const Index j : dofs) {
      const double d =
          angle_at(command, j, t + kRestTime / 2) - angle_at(command, j, t - kRestTime / 2);
      sum += d * d;
    }
    return sum;
  };
  double mean = 0, least = HUGE_VAL;
  long count = 0;
  for (double t = 0; t <= command.duration(); t += kRestTime, ++count) mean += information(t);
  for (double t = begin; t <= end; t += kRestTime / 2) least = std::min(least, information(t));
  return count > 0 && least < kRestShare * mean / static_cast<double>(count);
}

LostRows change_of_delay(const AngleTable& command, const AngleTable& measured,
                         const std::vector<Index>& dofs) {
  const auto rows = static_cast<Index>(std::lround(kDelayWindow / measured.dt));
  struct Window {
    std::vector<Delay> delays;  // delays of the joints
    double weight = 0, time = 0;
  };
  std::vector<Window> windows;
  double most = 0;
  for (Index begin = 0; begin + rows <= measured.theta.rows(); begin += rows) {
    Window window{delays_of_rows(command, measured, dofs, begin, rows), 0,
                  measured.dt * static_cast<double>(begin)};
    for (const Delay& delay : window.delays) window.weight += delay.weight;
    most = std::max(most, window.weight);
    windows.push_back(std::move(window));
  }
  if (windows.size() < 2 * kLeastWindows) return {};
  // Both sides of a sudden change have delays of their own, which change little.
  struct Side {
    std::vector<Delay> delays;
    double spread = 0;
  };
  const auto side = [&](size_t from, size_t to) -> std::optional<Side> {
    Side result{std::vector<Delay>(dofs.size()), 0};
    int count = 0;
    for (size_t i = from; i < to; ++i) {
      if (windows[i].weight <= kLeastInformation * most) continue;
      ++count;
      for (size_t j = 0; j < dofs.size(); ++j) {
        const Delay& delay = windows[i].delays[j];
        result.delays[j].value += delay.weight * delay.value;
        result.delays[j].weight += delay.weight;
      }
    }
    if (count < kLeastWindows) return std::nullopt;
    for (Delay& delay : result.delays)
      if (delay.weight > 0) delay.value /= delay.weight;
    double square = 0;
    for (size_t i = from; i < to; ++i)
      if (windows[i].weight > kLeastInformation * most) {
        double away = 0;
        for (size_t j = 0; j < dofs.size(); ++j)
          away +=
              windows[i].delays[j].weight * (windows[i].delays[j].value - result.delays[j].value);
        square += (away / windows[i].weight) * (away / windows[i].weight);
      }
    result.spread = std::sqrt(square / count);
    return result;
  };
  LostRows lost;
  double least = HUGE_VAL;
  for (size_t split = 2; split + 2 <= windows.size(); ++split) {
    // The window with the sudden change belongs to neither side.
    const auto before = side(0, split - 1), after = side(split, windows.size());
    if (!before || !after) continue;
    const auto change = change_of(before->delays, after->delays);
    if (!change) continue;
    const double spread = before->spread + after->spread;
    const bool rest = std::abs(*change) >= kRestJump * measured.dt &&
                      rests_near(command, dofs, windows[split - 1].time, windows[split].time);
    if ((std::abs(*change) < kDelayJump && !rest) || spread > kMostSpread * std::abs(*change) ||
        spread >= least)
      continue;
    least = spread;
    lost = {true, false, static_cast<Index>(split - 1) * rows, -*change / measured.dt};
  }
  return lost;
}

}  // namespace

double angle_at(const AngleTable& table, Index dof, double t) {
  const double at = t / table.dt;
  const Index last = table.theta.rows() - 1;
  if (at <= 0) return table.theta(0, dof);
  const auto k = static_cast<Index>(at);
  if (k >= last) return table.theta(last, dof);
  const double u = at - static_cast<double>(k);
  return (1 - u) * table.theta(k, dof) + u * table.theta(k + 1, dof);
}

LostRows lost_rows(const AngleTable& command, const AngleTable& measured,
                   const std::vector<Index>& dofs, double delay) {
  const LostRows lost = step_in_motion(command, measured, dofs, delay);
  return lost.found ? lost : change_of_delay(command, measured, dofs);
}

std::string lost_rows_words(const LostRows& lost, const AngleTable& measured) {
  if (!lost.found) return "";
  const double dt = measured.dt;
  const long count = std::max(1L, std::lround(std::abs(lost.rows)));
  const std::string time = text::fixed(dt * static_cast<double>(lost.row), 3) +
                           " s, one row every " + text::brief(1000 * dt) + " ms",
                    rows = text::counted(count, "row"), are = count == 1 ? " is " : " are ",
                    change = text::brief(1000 * dt * static_cast<double>(count), 3) + " ms " +
                             (lost.rows > 0 ? "earlier" : "later") + " than in the rows before";
  return (lost.exact ? "at data row " : "near data row ") + std::to_string(lost.row + 1) + " (" +
         time + "), " + rows + are + (lost.rows > 0 ? "missing" : "repeated") +
         ". From this row on, the angles come " + change +
         (measured.timed ? ", although the times of the rows have no gap; record again"
                         : "; record again, or give the rows a time column");
}

std::string loads_rows_complaint(const SensorTable& loads, const AngleTable& measured) {
  const Index rows = loads.rows();
  if (loads.timed || rows == 0) return "";
  const double lasts = loads.duration(), asked = measured.duration(),
               row = std::max(loads.dt, measured.dt),
               // Two recorders of different rates may end up to a row apart.
      allowed = std::abs(loads.dt - measured.dt) < 1e-9 ? 0.5 * row : 1.5 * row;
  if (std::abs(lasts - asked) <= allowed) return "";
  const long missing = std::max(1L, std::lround(std::abs(lasts - asked) / loads.dt));
  return "the recording has " + std::to_string(rows) + " rows, one every " +
         text::brief(1000 * loads.dt) + " ms, so it lasts " + text::fixed(lasts, 3) +
         " s, but the measured angles last " + text::fixed(asked, 3) + " s. So " +
         text::counted(missing, "row") + (missing == 1 ? " is " : " are ") +
         (lasts < asked ? "missing" : "too many") +
         ", and the rows have no times. Record both again, or give the rows a time column";
}

}  // namespace ayumi
