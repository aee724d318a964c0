#include "ayumi/identify/compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/identify/joint_loads.hpp"
#include "ayumi/identify/lost_rows.hpp"
#include "ayumi/identify/recording_checks.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Longest shift that the search allows [s]. Chosen: recorders are started by hand.
constexpr double kReach = 10;

// Cut-off frequency of the low pass of loads and IMU readings before they are compared [Hz]. It is
// the same for measured and simulated values. Chosen: weight goes from foot to foot in 0.1 s or
// more.
constexpr double kLoadBand = 15;

// Share of the load at which a foot has landed, the share below which it was in the air, and the
// shortest time for which it must have been in the air [s]. Chosen: beyond the noise of load cells.
constexpr double kLanded = 0.15, kInAir = 0.05, kAirTime = 0.05;

// Largest distance of landings that count as the same [s]. Chosen: a third of a quick step.
constexpr double kSameLanding = 0.15;

// Largest share of the load of both feet that counts as the zero error of the load cells of one
// foot, and the smallest share that is named. Chosen: the cells of a HOAP-3 read -11 % in the air,
// and cells that read more than a fifth carry the robot; a hundredth is below the noise of cells.
constexpr double kMostZero = 0.2, kNamedZero = 0.01;

// Factor by which the sizes of measured and simulated values may differ before the recording counts
// as one in another unit. Chosen: load cells of real robots lose a third of the weight; kilograms
// differ by a factor of 9.8, and degrees by one of 57.
constexpr double kOtherUnit = 4;

// Correlation below which a curve counts as one of the opposite sign, or of the other foot. Chosen:
// noise and an impact that comes later make a correlation small, but not as negative as this.
constexpr double kOpposite = -0.5;

// Smallest range of the simulated share of the left foot at which exchanged feet are looked for.
// Chosen: a step takes the share from 0 to 1; while a robot stands or squats, noise and small
// errors of the posture decide how the share varies.
constexpr double kShareRange = 0.5;

// Smallest root mean square of a simulated angular velocity at which its unit and sign are judged
// [rad/s]. Chosen: a robot that stands shows neither.
constexpr double kTurning = 0.05;

// Largest lag of a curve that is looked for, and the step of the search [s]. Chosen: a cell or a
// network that is later is noticed without a comparison. With half of the value, lags of 0.2 s are
// not found; with twice, the next step of a quick walk can be taken for this one.
constexpr double kLargestLag = 0.25, kLagStep = 0.01;

// Rounds of Gauss-Newton after this search. Chosen: curves of one form need at most five, others
// some more; a lag that is not at rest after them is not stated.
constexpr int kLagRounds = 30;

// Change of the lag at which it is at rest [s]. Chosen: a tenth of the 0.1 ms that are printed.
constexpr double kLagAtRest = 1e-5;

AngleTable angles_of(const RobotModel& model, const SimulationLog& log) {
  AngleTable table;
  table.dt = log.dt;
  table.theta.resize(static_cast<Index>(log.samples.size()), model.dof_count());
  for (size_t k = 0; k < log.samples.size(); ++k)
    table.theta.row(static_cast<Index>(k)) = log.samples[k].state.theta.transpose();
  table.has.assign(static_cast<size_t>(model.dof_count()), 1);
  table.resolution = VectorXd::Zero(model.dof_count());
  return table;
}

AngleTable rows_until(const AngleTable& table, double end) {
  AngleTable first = table;
  const auto rows = static_cast<Index>(end / table.dt) + 1;
  if (rows < table.theta.rows()) first.theta = table.theta.topRows(std::max<Index>(2, rows));
  return first;
}

/// How a measured curve that is moved by `lag` agrees with the simulated one.
struct Agreement {
  double correlation = -1;  ///< of the two curves
  /// Change of the lag that brings the measured curve, with the best amplitude and mean, nearest to
  /// the simulated one (Gauss-Newton) [s].
  double step = 0;
};

Agreement agreement(const ComparedCurve& curve, double dt, double lag) {
  const auto n = static_cast<Index>(curve.measured.size());
  const Eigen::Map<const VectorXd> measured(curve.measured.data(), n);
  Vector3d sum = Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  double count = 0;
  for (Index k = 1; k + 1 < n; ++k) {
    const double t = dt * static_cast<double>(k) + lag;
    if (t < dt || t > dt * static_cast<double>(n - 2)) continue;
    const auto i = static_cast<size_t>(k);
    const Vector3d row(
        interpolated(measured, dt, t), curve.simulated[i],
        (interpolated(measured, dt, t + dt) - interpolated(measured, dt, t - dt)) / (2 * dt));
    sum += row;
    products += row * row.transpose();
    ++count;
  }
  if (count < 3) return {};
  const Eigen::Matrix3d c = products / count - sum * sum.transpose() / (count * count);
  if (!(c(0, 0) * c(1, 1) > 0)) return {};
  const double amplitude = c(0, 1) / c(0, 0);
  // What the rate has in common with the curve itself is an amplitude and no lag.
  const double rate = c(2, 2) - c(0, 2) * c(0, 2) / c(0, 0);
  const double step =
      amplitude * rate != 0 ? (c(2, 1) - amplitude * c(0, 2)) / (amplitude * rate) : 0;
  return {c(0, 1) / std::sqrt(c(0, 0) * c(1, 1)), step};
}

/// The lag at which the measured curve agrees best with the simulated one, whatever its amplitude
/// and its mean: their correlation has its maximum there [s]. It is 0 if no lag up to kLargestLag
/// is such a maximum, or if the curves never have the same direction. `times` are at a constant
/// rate.
double lag_of(const ComparedCurve& curve, const std::vector<double>& times) {
  const double dt = times[1] - times[0];
  double start = 0, best = agreement(curve, dt, 0).correlation;
  for (double size = kLagStep; size < kLargestLag + kLagStep / 2; size += kLagStep)
    for (const double lag : {size, -size})
      if (const double now = agreement(curve, dt, lag).correlation; now > best) {
        best = now;
        start = lag;
      }
  double lag = start;
  for (int round = 0; round < kLagRounds; ++round) {
    const Agreement now = agreement(curve, dt, lag);
    if (!(now.correlation > 0)) return 0;
    const double step = std::clamp(now.step, -kLagStep, kLagStep);
    lag += step;
    if (std::abs(lag - start) > 2 * kLagStep) return 0;
    if (std::abs(step) < kLagAtRest) return lag;
  }
  return 0;
}

void summarize(ComparedCurve& curve, const std::vector<double>& times) {
  const size_t n = times.size();
  double sum = 0, m = 0, s = 0, mm = 0, ss = 0, ms = 0;
  for (size_t k = 0; k < n; ++k) {
    const double a = curve.measured[k], b = curve.simulated[k], e = a - b;
    sum += std::abs(e);
    if (std::abs(e) > curve.largest) curve.largest = std::abs(e), curve.largest_at = times[k];
    m += a, s += b, mm += a * a, ss += b * b, ms += a * b;
  }
  curve.mean = sum / static_cast<double>(n);
  const auto count = static_cast<double>(n);
  const double va = mm - m * m / count, vb = ss - s * s / count;
  const double range = *std::max_element(curve.simulated.begin(), curve.simulated.end()) -
                       *std::min_element(curve.simulated.begin(), curve.simulated.end());
  if (va > 0 && vb > 0) curve.correlation = (ms - m * s / count) / std::sqrt(va * vb);
  if (range > least_motion()) curve.lag = lag_of(curve, times);
}

ComparedCurve curve_of(const std::string& name, const std::string& unit, const VectorXd& measured,
                       double measured_dt, const VectorXd& simulated, double dt,
                       const Comparison& at, double shift) {
  ComparedCurve curve{name, unit, {}, {}};
  for (const double t : at.times) {
    curve.measured.push_back(interpolated(measured, measured_dt, t - shift));
    curve.simulated.push_back(interpolated(simulated, dt, t));
  }
  summarize(curve, at.times);
  return curve;
}

// The times at which a foot takes up load after it was in the air.
std::vector<double> landings_of(const VectorXd& share, double dt) {
  std::vector<double> found;
  double air = 0;
  bool flying = false;
  for (Index k = 0; k < share.size(); ++k) {
    air = share[k] < kInAir ? air + dt : 0;
    if (air >= kAirTime) flying = true;
    if (!flying || share[k] < kLanded) continue;
    found.push_back(dt * static_cast<double>(k));
    flying = false;
  }
  return found;
}

void match_landings(Side foot, const std::vector<double>& measured,
                    const std::vector<double>& simulated, double shift, Comparison& result) {
  const auto within = [&](double t) { return t >= result.begin && t <= result.end; };
  std::vector<char> used(simulated.size(), 0);
  for (const double row : measured) {
    const double t = row + shift;
    if (!within(t)) continue;
    size_t best = simulated.size();
    for (size_t i = 0; i < simulated.size(); ++i)
      if (!used[i] && std::abs(simulated[i] - t) < kSameLanding &&
          (best == simulated.size() || std::abs(simulated[i] - t) < std::abs(simulated[best] - t)))
        best = i;
    if (best == simulated.size()) {
      result.lone_landings.push_back({foot, true, t});
      continue;
    }
    used[best] = 1;
    result.landings.push_back({foot, t, simulated[best]});
  }
  for (size_t i = 0; i < simulated.size(); ++i)
    if (!used[i] && within(simulated[i]))
      result.lone_landings.push_back({foot, false, simulated[i]});
}

VectorXd share_of(const VectorXd& left, const VectorXd& right) {
  VectorXd share(left.size());
  const double least = 0.1 * std::max(0.0, (left + right).mean());
  for (Index k = 0; k < left.size(); ++k) {
    const double sum = left[k] + right[k];
    share[k] = sum > least ? std::clamp(left[k] / sum, 0.0, 1.0) : 0.5;
  }
  return share;
}

/// The reading of the load cells of a foot while it is in the air [N]: the median over the rows in
/// which the simulated foot has no load, from kAirTime before until kAirTime after them. It is 0 if
/// there are no such rows.
double reading_in_air(const SimulationLog& log, size_t foot, const VectorXd& measured, double dt,
                      double shift) {
  const auto count = static_cast<Index>(log.samples.size());
  const auto margin = static_cast<Index>(std::lround(kAirTime / log.dt));
  std::vector<double> readings;
  Index since = 0;  // the simulated foot has been in the air from this sample on
  for (Index k = 0; k < count; ++k) {
    if (log.samples[static_cast<size_t>(k)].foot_force[foot].z() > 0) since = k + 1;
    const Index middle = k - margin;
    if (middle - margin < since) continue;
    const double row = (log.dt * static_cast<double>(middle) - shift) / dt;
    if (row >= 0 && row < static_cast<double>(measured.size()))
      readings.push_back(measured[static_cast<Index>(row)]);
  }
  if (readings.empty()) return 0;
  const auto half = readings.begin() + static_cast<std::ptrdiff_t>(readings.size() / 2);
  std::nth_element(readings.begin(), half, readings.end());
  return *half;
}

/// Subtracts from the loads of each foot what its cells read while the foot is in the air.
void tare(const SimulationLog& log, double dt, double shift, std::array<VectorXd, 2>& measured,
          Comparison& result) {
  const double load = measured[0].mean() + measured[1].mean();
  for (const size_t foot : {0u, 1u}) {
    const double zero = reading_in_air(log, foot, measured[foot], dt, shift);
    if (!(std::abs(zero) < kMostZero * load)) continue;
    measured[foot].array() -= zero;
    if (std::abs(zero) > kNamedZero * load)
      result.notes.push_back("sensors: the load cells of the " +
                             std::string(foot == 0 ? "left" : "right") + " foot read " +
                             text::brief(zero, 2) +
                             " N while the foot is in the air; this value is subtracted from all "
                             "readings of the foot");
  }
}

/// `shift` is the time of the run at which the sensors begin [s].
void compare_loads(const SimulationLog& log, const SensorTable& sensors, double shift,
                   Comparison& result) {
  const auto count = static_cast<Index>(log.samples.size());
  std::array<VectorXd, 2> simulated = {VectorXd(count), VectorXd(count)}, measured;
  for (Index k = 0; k < count; ++k)
    for (const size_t foot : {0u, 1u})
      simulated[foot][k] = log.samples[static_cast<size_t>(k)].foot_force[foot].z();
  for (const size_t foot : {0u, 1u}) {
    simulated[foot] = low_pass(simulated[foot], log.dt, kLoadBand);
    measured[foot] =
        low_pass(sensors.foot_load.col(static_cast<Index>(foot)), sensors.dt, kLoadBand);
  }
  tare(log, sensors.dt, shift, measured, result);
  for (const size_t foot : {0u, 1u})
    result.loads.push_back(curve_of(foot == 0 ? "left" : "right", "N", measured[foot], sensors.dt,
                                    simulated[foot], log.dt, result, shift));
  const VectorXd measured_share = share_of(measured[0], measured[1]),
                 simulated_share = share_of(simulated[0], simulated[1]);
  result.loads.push_back(curve_of("left share", "", measured_share, sensors.dt, simulated_share,
                                  log.dt, result, shift));
  for (const Side foot : {Side::left, Side::right}) {
    const auto share = [&](const VectorXd& left) {
      return foot == Side::left ? left : VectorXd(1 - left.array());
    };
    match_landings(foot, landings_of(share(measured_share), sensors.dt),
                   landings_of(share(simulated_share), log.dt), shift, result);
  }
  std::sort(result.landings.begin(), result.landings.end(),
            [](const auto& a, const auto& b) { return a.simulated < b.simulated; });
  std::sort(result.lone_landings.begin(), result.lone_landings.end(),
            [](const auto& a, const auto& b) { return a.t < b.t; });
}

void compare_imu(const RobotModel& model, const SimulationLog& log, const SensorTable& sensors,
                 double shift, Comparison& result) {
  const SensorDescription& description = model.description().sensors;
  const int link = description.imu_link.empty() ? 0 : model.find_link(description.imu_link);
  const auto count = static_cast<Index>(log.samples.size());
  MatrixXd velocity(count, 3), gyro(count, 3), acceleration(count, 3);
  std::vector<Eigen::Matrix3d> rotation;
  RobotData data(model);
  for (Index k = 0; k < count; ++k) {
    const RobotState& state = log.samples[static_cast<size_t>(k)].state;
    update_velocities(model, state, data);
    const Eigen::Isometry3d pose = link_pose(model, data, link);
    const int body = model.links()[static_cast<size_t>(link)].body;
    velocity.row(k) = point_velocity(data, body, pose * description.imu_position).transpose();
    gyro.row(k) =
        (pose.linear().transpose() * data.angular_velocity[static_cast<size_t>(body)]).transpose();
    rotation.push_back(pose.linear());
  }
  for (Index k = 0; k < count; ++k) {
    const Index a = std::max<Index>(0, k - 1), b = std::min(count - 1, k + 1);
    const Vector3d change = (velocity.row(b) - velocity.row(a)).transpose() /
                            (log.dt * static_cast<double>(std::max<Index>(1, b - a)));
    acceleration.row(k) =
        (rotation[static_cast<size_t>(k)].transpose() * (change + Vector3d(0, 0, kGravity)))
            .transpose();
  }
  const auto add = [&](const char* name, const char* unit, const MatrixXd& measured,
                       const MatrixXd& simulated) {
    if (measured.size() == 0) return;
    for (Index i = 0; i < 3; ++i)
      result.imu.push_back(curve_of(std::string(name) + "." + "xyz"[i], unit,
                                    low_pass(measured.col(i), sensors.dt, kLoadBand), sensors.dt,
                                    low_pass(simulated.col(i), log.dt, kLoadBand), log.dt, result,
                                    shift));
  };
  add("acc", "m/s^2", sensors.acceleration, acceleration);
  add("gyro", "rad/s", sensors.gyro, gyro);
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double rms_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// A line for values that are far larger or smaller than those of the run; empty for others.
std::string unit_complaint(const std::string& what, double measured, double simulated,
                           const std::string& unit) {
  if (measured < kOtherUnit * simulated && simulated < kOtherUnit * measured) return "";
  return what + (measured < simulated ? "much smaller" : "much larger") +
         " than in the run: " + text::brief(measured, 3) + " in the recording, but " +
         text::brief(simulated, 3) + " " + unit + " in the run. Are the readings in " + unit + "?";
}

/// Lines about units and signs of the loads of the feet, and about feet that are exchanged.
std::vector<std::string> load_complaints(const std::vector<ComparedCurve>& loads) {
  const double measured = mean_of(loads[0].measured) + mean_of(loads[1].measured),
               simulated = mean_of(loads[0].simulated) + mean_of(loads[1].simulated);
  if (measured < 0)
    return {"the loads of the feet are negative; change the sign of their readings"};
  std::vector<std::string> lines;
  const std::string unit = unit_complaint("the loads of the feet are ", measured, simulated, "N");
  if (!unit.empty()) lines.push_back(unit);
  const auto [least, most] =
      std::minmax_element(loads[2].simulated.begin(), loads[2].simulated.end());
  if (loads[2].correlation<kOpposite&& * most - *least> kShareRange)
    lines.emplace_back(
        "in the recording, the left foot carries the robot when the right foot carries it in the "
        "run, "
        "and the other way round; exchange the readings of the left and the right foot");
  return lines;
}

/// Lines about units and signs of the IMU.
std::vector<std::string> imu_complaints(const std::vector<ComparedCurve>& imu) {
  std::vector<std::string> lines;
  Vector3d measured = Vector3d::Zero(), simulated = Vector3d::Zero();
  double turns_measured = 0, turns_simulated = 0;
  std::string opposite;
  for (size_t i = 0; i < imu.size(); ++i) {
    const ComparedCurve& curve = imu[i];
    const auto axis = static_cast<Index>(i % 3);
    if (curve.name.starts_with("acc")) {
      measured[axis] = mean_of(curve.measured), simulated[axis] = mean_of(curve.simulated);
      continue;
    }
    const double rms = rms_of(curve.simulated);
    turns_measured += rms_of(curve.measured), turns_simulated += rms;
    if (rms > kTurning && curve.correlation < kOpposite)
      opposite += (opposite.empty() ? "" : ", ") + curve.name;
  }
  if (simulated.norm() > 0) {
    const std::string unit =
        unit_complaint("the acceleration is ", measured.norm(), simulated.norm(), "m/s^2");
    if (!unit.empty()) lines.push_back(unit);
    if (measured.dot(simulated) < kOpposite * measured.norm() * simulated.norm())
      lines.emplace_back(
          "the acceleration points down, but an accelerometer at rest reads an acceleration of g "
          "upward; change the sign of the readings");
  }
  if (turns_simulated > kTurning) {
    const std::string unit =
        unit_complaint("the angular velocity is ", turns_measured, turns_simulated, "rad/s");
    if (!unit.empty()) lines.push_back(unit);
  }
  if (!opposite.empty())
    lines.push_back("the readings of " + opposite +
                    " have the opposite sign of the angular velocity in the run; change the sign "
                    "of these readings");
  return lines;
}

}  // namespace

Comparison compare(const RobotModel& model, const SimulationLog& log,
                   const std::optional<AngleTable>& measured, const SensorTable& sensors,
                   const CompareOptions& options, const std::string& file) {
  const AngleTable simulated = angles_of(model, log);
  Comparison result;
  double lasts = 0, interval = log.dt;
  if (measured) {
    lasts = measured->duration();
    interval = std::max(interval, measured->dt);
    result.shift =
        options.shift ? *options.shift : -time_shift(model, simulated, *measured, kReach);
    if (std::abs(measured->dt - log.dt) > 1e-6)
      result.notes.push_back("the recording has " + text::brief(1 / measured->dt) +
                             " rows per second, and the run has " + text::brief(1 / log.dt) +
                             ". Both are compared at the lower of these rates");
  } else {
    result.shift = options.shift.value_or(0);
    if (!options.shift)
      result.notes.push_back(
          "without joint angles, the time shift between recording and run cannot be found. Ayumi "
          "assumes that the recording begins at 0 s of the run; --shift sets another time");
  }
  const double sensors_begin = result.shift + (measured ? first_row_after(*measured, sensors) : 0);
  if (!measured) lasts = sensors.duration();
  result.begin = std::max({0.0, result.shift, options.begin});
  result.end = std::min({simulated.duration(), lasts + result.shift, options.end});
  if (measured && sensors.timed) {  // rows that are missing elsewhere are named below
    result.begin = std::max(result.begin, sensors_begin);
    result.end = std::min(result.end, sensors_begin + sensors.duration());
  }
  const double fell = log.result.fell_at;
  if (fell >= 0 && fell < result.end) {
    result.notes.push_back("the simulated robot fell at " + text::fixed(fell, 3) +
                           " s; later times are not compared");
    result.end = fell;
  }
  if (result.end - result.begin < 10 * interval)
    fail(ErrorCode::bad_file, {file},
         "the recording lasts from " + text::fixed(result.shift, 3) + " to " +
             text::fixed(result.shift + lasts, 3) +
             " s in the time of the run, and the run lasts " +
             text::fixed(simulated.duration(), 3) + " s. The time that can be compared is " +
             text::fixed(std::max(0.0, result.end - result.begin), 3) + " s, but at least " +
             text::fixed(10 * interval, 3) + " s are needed");
  for (Index k = 0;; ++k) {
    const double t = result.begin + interval * static_cast<double>(k);
    if (t > result.end) break;
    result.times.push_back(t);
  }
  if (measured) {
    const size_t before = result.notes.size();
    for (const std::string& line :
         motion_complaints(model, simulated, *measured, -result.shift, result.begin, result.end))
      result.notes.push_back(line);
    if (result.notes.size() == before) {
      const AngleTable run = rows_until(simulated, result.end),
                       recorded = rows_until(*measured, result.end - result.shift);
      const std::string lost = lost_rows_words(
          lost_rows(run, recorded, moving_joints(run, recorded), -result.shift), *measured);
      if (!lost.empty()) result.notes.push_back("the recording: " + lost);
    }
    if (const std::string wrong = loads_rows_complaint(sensors, *measured); !wrong.empty())
      result.notes.push_back("sensors: " + wrong);
    std::string missing;
    for (int j = 0; j < model.dof_count(); ++j) {
      const std::string& name = model.dofs()[static_cast<size_t>(j)].name;
      if (!measured->has[static_cast<size_t>(j)]) {
        missing += (missing.empty() ? "" : ", ") + name;
        continue;
      }
      result.joints.push_back(curve_of(name,
                                       model.dofs()[static_cast<size_t>(j)].prismatic ? "m" : "rad",
                                       measured->theta.col(j), measured->dt, simulated.theta.col(j),
                                       log.dt, result, result.shift));
    }
    if (!missing.empty()) result.notes.push_back("the recording has no angles of " + missing);
  }
  if (sensors.foot_load.rows() > 0 && model.has_soles())
    compare_loads(log, sensors, sensors_begin, result);
  if (sensors.acceleration.rows() > 0 || sensors.gyro.rows() > 0)
    compare_imu(model, log, sensors, sensors_begin, result);
  for (const std::vector<std::string>& lines :
       {result.loads.empty() ? std::vector<std::string>() : load_complaints(result.loads),
        imu_complaints(result.imu)})
    for (const std::string& line : lines) result.notes.push_back("sensors: " + line);
  return result;
}

SimulationLog measured_log(const SimulationLog& log, const AngleTable& measured, double shift) {
  SimulationLog result = log;
  for (size_t k = 0; k < result.samples.size(); ++k) {
    const double t = log.dt * static_cast<double>(k) - shift;
    if (t < 0 || t > measured.duration()) continue;
    for (Index j = 0; j < measured.theta.cols(); ++j)
      if (measured.has[static_cast<size_t>(j)])
        result.samples[k].state.theta[j] = interpolated(measured.theta.col(j), measured.dt, t);
  }
  return result;
}

}  // namespace ayumi
