#include "ayumi/identify/identify.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <optional>

#include "ayumi/identify/recording_checks.hpp"
#include "ayumi/identify/servo_fit.hpp"
#include "ayumi/study/in_parallel.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// Uncertainty of the torque that loads a joint, and of the law of its servo, in parts of a value.
// Chosen: masses and lengths of a robot are known to about a percent, and intervals cover this.
constexpr double kModelShare = 0.01;

// Share of the load on the own foot above which a leg counts as loaded; as unloaded below the rest.
// Chosen: single support with noisy load cells.
constexpr double kLoaded = 0.9;

// Correlation of two estimates above which the recording does not tell them apart. Chosen: the
// intervals are then more than twice as wide as they would be if the other one were known.
constexpr double kConfounded = 0.9;

// Half width of an interval in values above which a value counts as not determined. Chosen: a
// value and its double are then apart. It changes the words of a result, and not its numbers.
constexpr double kKnown = 0.5;

// What a law with inertia and damping has to leave of the error of a mere delay, before the
// recording is said to show them. Chosen: a wrong law bends every constant a little, and more
// constants always fit better. A recording with steps or a chirp leaves less than a tenth.
constexpr double kClearlyLess = 0.6;

// Torque that puts a gear on one of its flanks [N m]. Chosen: the friction of a small gear.
constexpr double kFlankTorque = 0.05;

// Ratio of what two laws of a servo leave over below which the recording shows which of them holds.
// Chosen: far outside of chance for the thousands of rows of a recording.
constexpr double kHoldSeen = 0.97;

struct TypeFit {
  ServoFit fit;
  bool delay_takes_damping = false;  // the recording does not tell delay and damping apart
  bool has_backlash = false;
  /// What the delay is less, and its uncertainty, for what a servo does between two commands [s].
  double hold = 0;
};

double rms_between(const ServoFit& a, const ServoFit& b) {
  double sum = 0, count = 0;
  for (size_t j = 0; j < a.residual.size(); ++j) {
    sum += (a.residual[j] - b.residual[j]).squaredNorm();
    count += static_cast<double>(a.residual[j].size());
  }
  return std::sqrt(sum / count);
}

double deviation(const ServoFit& fit, Constant which) {
  const auto i = static_cast<Index>(which);
  return std::sqrt(fit.covariance(i, i));
}

// Whether a constant that `with` has and `without` does not changes the angle by more than what the
// servo's law leaves over anyhow, and is not zero within its interval.
bool is_seen(const ServoFit& with, const ServoFit& without, double value, Constant which) {
  return rms_between(with, without) > with.model_error &&
         value > with.t_factor * deviation(with, which);
}

constexpr std::array<bool, kConstants> holding(bool damping, bool backlash) {
  return {false, false, damping, false, backlash};
}

// A gear's play is seen only where its load goes from one flank to the other.
bool load_changes_sign(const std::vector<JointRecording>& joints) {
  return std::any_of(joints.begin(), joints.end(), [](const JointRecording& joint) {
    return joint.torque.minCoeff() < -kFlankTorque && joint.torque.maxCoeff() > kFlankTorque;
  });
}

// Whether the recording shows inertia and damping.
bool shows_damping(const ServoFit& damped, const ServoFit& simple) {
  return damped.rms < kClearlyLess * simple.rms &&
         is_seen(damped, simple, damped.constants[0].damping, Constant::damping);
}

TypeFit fit_with(std::vector<JointRecording> joints, double longest_delay) {
  std::vector<ServoConstants> start = first_guess(joints, longest_delay);
  for (ServoConstants& each : start) each.damping = 0;
  for (JointRecording& joint : joints) joint.at_once = true;
  TypeFit result;
  result.fit = fit_servo(joints, start, holding(true, true), longest_delay);
  start = result.fit.constants;
  for (ServoConstants& each : start) {
    each.damping = 0.5 * std::min(each.delay, 0.002);
    each.delay -= each.damping;
  }
  for (JointRecording& joint : joints) joint.at_once = false;
  ServoFit damped = fit_servo(joints, start, holding(false, true), longest_delay);
  result.delay_takes_damping = !shows_damping(damped, result.fit);
  if (!result.delay_takes_damping) result.fit = std::move(damped);
  if (!load_changes_sign(joints)) return result;
  for (JointRecording& joint : joints) joint.at_once = result.delay_takes_damping;
  start = result.fit.constants;
  for (ServoConstants& each : start) each.backlash = 1e-4;
  ServoFit play =
      fit_servo(joints, start, holding(result.delay_takes_damping, false), longest_delay);
  result.has_backlash = is_seen(play, result.fit, play.constants[0].backlash, Constant::backlash);
  if (result.has_backlash) result.fit = std::move(play);
  return result;
}

// Root of the mean squared error of these constants [rad].
double rms_of(const std::vector<JointRecording>& joints,
              const std::vector<ServoConstants>& constants) {
  double sum = 0, count = 0;
  VectorXd theta;
  for (size_t j = 0; j < joints.size(); ++j) {
    servo_response(joints[j], constants[j], theta);
    const Index rows = theta.size() - first_compared(joints[j]);
    sum += (joints[j].measured - theta).tail(rows).squaredNorm();
    count += static_cast<double>(rows);
  }
  return std::sqrt(sum / count);
}

// A servo may hold each command until the next one, or go from one to the other. Where the
// recording shows the difference, the better is taken. Where it does not, the delay of a servo that
// holds would be half an interval shorter: the delay is given in the middle of both.
TypeFit fit_type(std::vector<JointRecording> joints, double longest_delay) {
  TypeFit linear = fit_with(joints, longest_delay);
  const double interval = joints[0].command_dt;
  for (JointRecording& joint : joints) {
    joint.held = true;
    joint.at_once = linear.delay_takes_damping;
  }
  std::vector<ServoConstants> start = linear.fit.constants;
  for (ServoConstants& each : start) each.delay = std::max(0.0, each.delay - 0.5 * interval);
  linear.hold = 0.25 * interval;
  if (std::abs(rms_of(joints, start) / linear.fit.rms - 1) < 1 - kHoldSeen) return linear;
  TypeFit held = linear;
  held.hold = 0;
  held.fit = fit_servo(joints, start, holding(linear.delay_takes_damping, !linear.has_backlash),
                       longest_delay);
  if (held.fit.rms < kHoldSeen * linear.fit.rms) return held;
  if (linear.fit.rms < kHoldSeen * held.fit.rms) linear.hold = 0;
  return linear;
}

ServoEstimate estimate(double value, double half_width, double least = -HUGE_VAL) {
  return {value, std::max(least, value - half_width), value + half_width,
          half_width <= kKnown * std::abs(value)};
}

// Value and half width of a ratio a/s from the covariance of a and s.
ServoEstimate ratio(double a, double s, double var_a, double var_s, double cov, double factor) {
  if (s <= 0) return {};
  const double value = a / s;
  const double variance = (var_a - 2 * value * cov + value * value * var_s) / (s * s);
  return estimate(value, factor * std::sqrt(std::max(0.0, variance)) + kModelShare * value, 0);
}

class Advice {
 public:
  Advice(const TypeFit& type, const IdentifiedJoint& joint) : fit_(type.fit) {
    if (type.delay_takes_damping)
      say("delay and damping are confounded, and the delay stands for both: record steps or a "
          "chirp");
    const bool kp = joint.kp.known;
    if (!kp && tied(Constant::compliance, Constant::dry))
      say("kp and friction are confounded: record a slow sweep");
    else if (!kp && offset_tied())
      say("kp and offset are confounded: record a load that changes, such as a squat");
    else if (!kp)
      say("the load changes too little to show kp: record a squat or a sway, or use --per type");
    if (kp && !joint.coulomb.known)
      say("Coulomb friction is not determined: record a slow sweep with turns");
    if (kp && !type.delay_takes_damping && !joint.damping.known)
      say("viscous friction and damping are not determined: record steps or a chirp");
    if (type.has_backlash && tied(Constant::backlash, Constant::dry))
      say("backlash and Coulomb friction are confounded: record a load that changes its sign");
    if (type.has_backlash && tied(Constant::backlash, Constant::compliance))
      say("backlash and kp are confounded: record a load that changes its sign and its size");
  }
  std::vector<std::string> words;

 private:
  void say(const std::string& text) { words.push_back(text); }
  bool correlated(Index a, Index b) const {
    const double scale = fit_.covariance(a, a) * fit_.covariance(b, b);
    return scale > 0 && std::abs(fit_.covariance(a, b)) > kConfounded * std::sqrt(scale);
  }
  bool tied(Constant a, Constant b) const {
    return correlated(static_cast<Index>(a), static_cast<Index>(b));
  }
  bool offset_tied() const {
    return correlated(static_cast<Index>(Constant::compliance), kConstants);
  }
  const ServoFit& fit_;
};

// How the measured angle changes from the unloaded to the loaded foot: least squares of its
// distance from the late command by the share of the load on the own foot. It needs no stiffness.
void find_sag(const RobotModel& model, const JointLoads& loads, int dof,
              const JointRecording& recording, IdentifiedJoint& joint) {
  for (const Side side : {Side::left, Side::right}) {
    if (loads.left_share.size() == 0) return;
    const std::vector<int>& leg = model.leg(side);
    if (std::find(leg.begin(), leg.end(), dof) == leg.end()) continue;
    double x = 0, y = 0, xx = 0, xy = 0, least = 1, most = 0;
    const auto n = static_cast<double>(recording.measured.size());
    for (Index k = 0; k < recording.measured.size(); ++k) {
      const double left = loads.left_share[k], own = side == Side::left ? left : 1 - left;
      const double late = command_at(recording, recording.dt * static_cast<double>(k) - joint.lag);
      const double distance = recording.measured[k] - late;
      x += own, y += distance, xx += own * own, xy += own * distance;
      least = std::min(least, own), most = std::max(most, own);
    }
    joint.has_sag = least < 1 - kLoaded && most > kLoaded;
    if (joint.has_sag) joint.sag = (xy - x * y / n) / (xx - x * x / n);
  }
}

void describe(const TypeFit& type, size_t i, const JointRecording& recording,
              const ServoDescription& servo, bool own_servo, IdentifiedJoint& joint) {
  const ServoFit& fit = type.fit;
  const ServoConstants& c = fit.constants[i];
  const auto var = [&](Constant a, Constant b) {
    return fit.covariance(static_cast<Index>(a), static_cast<Index>(b));
  };
  const double factor = fit.t_factor;
  joint.delay = estimate(std::max(0.0, c.delay - type.hold),
                         factor * deviation(fit, Constant::delay) + type.hold, 0);
  joint.lag = c.delay + c.damping;
  const double s = c.compliance,
               half = factor * deviation(fit, Constant::compliance) + kModelShare * s;
  joint.kp = {1 / std::max(s, 1e-12), 1 / (s + half), s > half ? 1 / (s - half) : HUGE_VAL,
              half <= kKnown * s};
  const double var_s = var(Constant::compliance, Constant::compliance);
  joint.damping = ratio(c.damping, s, var(Constant::damping, Constant::damping), var_s,
                        var(Constant::damping, Constant::compliance), factor);
  joint.coulomb = ratio(c.dry, s, var(Constant::dry, Constant::dry), var_s,
                        var(Constant::dry, Constant::compliance), factor);
  // The motor's damping and viscous friction act alike. What the robot's file states of the first
  // is taken off, unless the recording contradicts it.
  const double kd = own_servo && servo.kd <= joint.damping.upper ? servo.kd : 0;
  joint.viscous = estimate(std::max(0.0, joint.damping.value - kd),
                           joint.damping.upper - joint.damping.value, 0);
  joint.viscous.known = joint.damping.known && joint.viscous.known;
  joint.backlash = estimate(c.backlash, factor * deviation(fit, Constant::backlash), 0);
  if (!type.has_backlash) joint.backlash = {};
  const auto o = static_cast<Index>(kConstants + i);
  joint.offset = estimate(c.offset, factor * std::sqrt(fit.covariance(o, o)));
  joint.offset.known = true;
  const VectorXd& residual = fit.residual[i];
  Index at = 0;
  joint.largest_error = residual.cwiseAbs().maxCoeff(&at);
  joint.largest_at = recording.dt * static_cast<double>(at + fit.first);
  joint.mean_error = residual.cwiseAbs().mean();
  joint.confounded = Advice(type, joint).words;
}

JointRecording recording_of(const RobotModel& model, const RecordedMotion& motion,
                            const JointLoads& loads, int dof) {
  JointRecording r;
  r.command_dt = motion.command.dt;
  r.dt = motion.measured.dt;
  r.command = motion.command.theta.col(dof);
  r.measured = motion.measured.theta.col(dof);
  r.torque = loads.torque.col(dof);
  r.link_inertia = loads.inertia.col(dof);
  r.inertia = r.link_inertia.array() + model.limits().servo[static_cast<size_t>(dof)].rotor_inertia;
  r.acceleration = loads.acceleration.col(dof);
  r.start_rate = loads.rate(0, dof);
  return r;
}

}  // namespace

std::vector<std::string> motor_types(const RobotModel& model) {
  const ActuatorLimits& limits = model.limits();
  std::map<std::vector<double>, std::string> names;
  std::vector<std::string> types;
  for (int j = 0; j < model.dof_count(); ++j) {
    const ServoDescription& servo = limits.servo[static_cast<size_t>(j)];
    const std::vector<double> key = {
        limits.peak_torque[j], limits.continuous_torque[j], limits.speed[j], servo.kp, servo.kd,
        servo.rotor_inertia};
    types.push_back(names.emplace(key, model.dofs()[static_cast<size_t>(j)].name).first->second);
  }
  return types;
}

Identification identify(const RobotModel& model, const RecordedMotion& motion,
                        const IdentifyOptions& options, const std::string& place,
                        const Progress& progress) {
  require_answer(model, motion.command, motion.measured, options.longest_delay, place);
  report(progress, {"loads", 0, ""});
  const JointLoads loads = joint_loads(model, motion, options.stand);
  const std::vector<std::string> types = motor_types(model);
  Identification result;
  result.seconds = motion.measured.duration();
  std::vector<JointRecording> recordings;
  std::vector<int> dofs;
  for (int j = 0; j < model.dof_count(); ++j) {
    const auto at = static_cast<size_t>(j);
    if (!motion.command.has[at] || !motion.measured.has[at]) continue;
    IdentifiedJoint joint;
    joint.joint = model.dofs()[at].name;
    joint.type = types[at];
    const JointRecording recording = recording_of(model, motion, loads, j);
    joint.moved = recording.command.maxCoeff() - recording.command.minCoeff() > least_motion();
    result.joints.push_back(joint);
    recordings.push_back(recording);
    dofs.push_back(j);
  }
  // One group of joints for each set of constants.
  std::map<std::string, std::vector<size_t>> groups;
  for (size_t i = 0; i < result.joints.size(); ++i) {
    IdentifiedJoint& joint = result.joints[i];
    const JointRecording& r = recordings[i];
    double error = 0, sum = 0;
    for (Index k = 0; k < r.measured.size(); ++k) {
      const double e = r.measured[k] - command_at(r, r.dt * static_cast<double>(k));
      error += std::abs(e), sum += e;
    }
    joint.command_error = error / static_cast<double>(r.measured.size());
    const double mean = sum / static_cast<double>(r.measured.size());
    if (joint.moved)
      groups[options.per_type ? joint.type : joint.joint].push_back(i);
    else
      joint.offset = {mean, mean, mean, true};
  }
  std::vector<std::vector<size_t>> jobs;
  for (const auto& [name, members] : groups) jobs.push_back(members);
  std::atomic<bool> stop = false;
  in_parallel(jobs.size(), options.threads, stop, [&](size_t job) {
    std::vector<JointRecording> joints;
    for (const size_t i : jobs[job]) joints.push_back(recordings[i]);
    const TypeFit fit = fit_type(joints, options.longest_delay);
    for (size_t n = 0; n < jobs[job].size(); ++n) {
      const size_t i = jobs[job][n];
      describe(fit, n, recordings[i], model.limits().servo[static_cast<size_t>(dofs[i])],
               !model.description().servos_inferred, result.joints[i]);
      find_sag(model, loads, dofs[i], recordings[i], result.joints[i]);
    }
  });
  return result;
}

}  // namespace ayumi
