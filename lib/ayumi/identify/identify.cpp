#include "ayumi/identify/identify.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <optional>

#include "ayumi/base/in_parallel.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/identify/recording_checks.hpp"
#include "ayumi/identify/servo_fit.hpp"
#include "ayumi/identify/standing_stiffness.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// Uncertainty of the torque that loads a joint, and of the law of its servo, as a part of a value.
// Chosen: masses and lengths of a robot are known to about a percent, and intervals cover this.
constexpr double kModelShare = 0.01;

// Share of the load on a leg's own foot above which the leg counts as loaded; it counts as unloaded
// below 1 minus this share. Chosen: single support with noisy load cells.
constexpr double kLoaded = 0.9;

// Correlation of two estimates above which the recording does not distinguish them. Chosen: the
// intervals are then more than twice as wide as they would be if the other estimate were known.
constexpr double kConfounded = 0.9;

// Half width of an interval, as a part of the value, above which the value counts as not
// determined. Chosen: below it, a value and its double can be distinguished. It changes the words
// of a result, and not its numbers.
constexpr double kKnown = 0.5;

// Smallest change of the simulated angles that a constant must cause, relative to the part of the
// residual that is not noise. Below it, the recording does not show this constant. Chosen: if the
// law of the servo is a little wrong, an additional constant always changes the angles a little.
// The recorded walk of a HOAP-3 gives 1.2 for damping, and simulated recordings with a chirp give
// 3.4 or more.
constexpr double kBeyondErrors = 2;

// Uncertainty of the torque that loads a joint, in addition to kModelShare [N m]. Chosen: that of
// cables and bearings of a small joint. A joint that carries much less of a changing load does not
// show its stiffness.
constexpr double kLoadError = 0.01;

// Uncertainty of a rotor's inertia, as a part of this inertia. Chosen: it is calculated from data
// sheets, and gears add to it. The stiffness of a joint that carries little can only be seen
// together with its inertia.
constexpr double kRotorShare = 0.25;

// Compliance below which a joint does not show any compliance [rad/(N m)]. Chosen: far stiffer than
// the servos of small humanoids, which have 1e-4 or more.
constexpr double kLeastCompliance = 1e-6;

// Largest possible lag of a servo: a time [s], and a multiple of the lag that the robot's file
// states; the larger of the two is used. Chosen: soft servos of small humanoids have up to 20 ms. A
// recording with a larger lag counts as shifted in time and is refused. With half of the value,
// recordings of soft servos would be refused.
constexpr double kSlowServo = 0.03, kSlowerThanStated = 2;

// Time by which the lag must exceed that of the robot's file before the recording counts as
// probably shifted [s]. Chosen: loads and friction change the lag of a servo by a few milliseconds.
constexpr double kLikelyShift = 0.007;

// The stiffness of a joint is computed only if its load is known for longer than this [s]. Chosen:
// the single supports of two steps.
constexpr double kLeastKnown = 1;

// Distance by which the robot's file may be wrong about the place of the centre of gravity [m].
// Chosen: that of cables and batteries. The torques of a standing leg are wrong by the weight times
// this lever.
constexpr double kCogError = 0.002;

// Torque that presses a gear onto one of its flanks [N m]. Chosen: the friction of a small gear.
constexpr double kFlankTorque = 0.05;

// Twice the logarithm of the likelihood ratio of two laws of a servo, above which the recording
// shows which of them is the law of the servo. Chosen: five standard deviations, squared.
constexpr double kLawSeen = 25;

// Share of the residual of a law below which the responses of two laws count as equal. Chosen: the
// steps in which a response is integrated change it by up to a tenth. Synthetic servos for which an
// earlier version chose the wrong law had 0.005 to 0.12, others 0.25 or more.
constexpr double kSameAnswer = 0.15;

struct TypeFit {
  ServoFit fit;
  bool delay_takes_damping = false;  // the recording does not distinguish delay and damping
  bool has_backlash = false;
  /// The amount that is subtracted from the delay because the servo may hold each command, and at
  /// the same time the uncertainty of the delay [s]. It is 0 if the recording shows the law.
  double hold = 0;
  /// Whether the servo holds each command, if the recording of these joints shows it.
  std::optional<bool> holds = {};
  /// The additional uncertainty of the damping if the recording neither shows nor excludes the law
  /// CommandLaw::stepped [s].
  double step = 0;
  ServoConstants heavier;  ///< constants with a rotor inertia that is larger by its uncertainty
  StandingCompliance standing;  ///< used if it shows the stiffness better than the motion does
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

// Whether a constant that only `with` has changes the angle by far more than the residual that
// remains in any case, and whether its interval does not contain zero.
bool is_seen(const ServoFit& with, const ServoFit& without, double value, Constant which) {
  return rms_between(with, without) > kBeyondErrors * with.model_error &&
         value > with.t_factor * deviation(with, which);
}

// The standard deviation of the torque that loads a joint, without its own inertia [N m].
double load_change(const JointRecording& recording) {
  const VectorXd load =
      (recording.torque.array() - recording.link_inertia.array() * recording.acceleration.array())
          .matrix()(recording.compared);
  return std::sqrt((load.array() - load.mean()).square().mean());
}

// The uncertainty of the torque of a joint, as a part of the changes of its load.
double load_share_error(const JointRecording& recording) {
  return kModelShare + kLoadError / std::max(load_change(recording), 1e-6);
}

// Half the width of the interval of the compliance of a joint [rad/(N m)].
double compliance_half_width(const TypeFit& type, const JointRecording& recording) {
  if (type.standing.found) return type.standing.half_width + kModelShare * type.standing.value;
  const double s = type.fit.constants[0].compliance,
               heavier = std::max(type.heavier.compliance, 1e-12);
  return type.fit.t_factor * deviation(type.fit, Constant::compliance) +
         load_share_error(recording) * s + std::abs(heavier - s);
}

constexpr std::array<bool, kConstants> holding(bool damping, bool backlash) {
  return {false, false, damping, false, backlash};
}

// The play of a gear is visible only if its load changes from one flank to the other.
bool load_changes_sign(const std::vector<JointRecording>& joints) {
  return std::any_of(joints.begin(), joints.end(), [](const JointRecording& joint) {
    return joint.torque.minCoeff() < -kFlankTorque && joint.torque.maxCoeff() > kFlankTorque;
  });
}

// Whether the recording shows that `a` describes the servo and `b` does not.
bool fits_better(const ServoFit& a, const ServoFit& b) {
  return 2 * a.independent * elementary::log(b.rms / a.rms) > kLawSeen;
}

// The same for two laws of the servo's behaviour between two commands: their responses must differ
// by clearly more than that part of the residual of the better law that is not noise.
bool shows_law(const ServoFit& a, const ServoFit& b) {
  return fits_better(a, b) &&
         rms_between(a, b) > std::max(kBeyondErrors * a.model_error, kSameAnswer * a.rms);
}

// Whether the recording shows inertia and damping.
bool shows_damping(const ServoFit& damped, const ServoFit& simple) {
  return fits_better(damped, simple) && damped.constants[0].compliance > kLeastCompliance &&
         is_seen(damped, simple, damped.constants[0].damping, Constant::damping);
}

void set_law(std::vector<JointRecording>& joints, CommandLaw law, bool at_once) {
  for (JointRecording& joint : joints) joint.law = law, joint.at_once = at_once;
}

// The time by which a servo of this law is behind a servo that moves gradually from one command to
// the next.
double behind(CommandLaw law, const JointRecording& joint) {
  if (law == CommandLaw::linear) return 0;
  return 0.5 * joint.command_dt + (law == CommandLaw::stepped ? 0.5 * joint.dt : 0.0);
}

// The servo with inertia and damping that comes nearest to the recording, by the law of `joints`.
// `simple` is the servo without them that moves gradually from one command to the next.
// The error has many minima over its constants, so that the best point of a grid is the start.
ServoFit damped_fit(const std::vector<JointRecording>& joints, const ServoFit& simple,
                    const std::vector<ServoConstants>& guess, double longest_delay) {
  const double lag = std::max(0.0, simple.constants[0].delay - behind(joints[0].law, joints[0]));
  std::vector<ServoConstants> start = guess, best = guess;
  double least = HUGE_VAL;
  for (const double share : {0.2, 0.5, 0.8})
    for (const double dry : {0.0, 1e-4, 4e-4, 1.5e-3})
      for (const double compliance : {guess[0].compliance, 2e-4, 7e-4, 2e-3, 5e-3}) {
        for (ServoConstants& each : start) {
          each.damping = share * lag, each.delay = lag - each.damping;
          each.dry = dry, each.compliance = compliance;
        }
        const double error = rms_error(joints, start);
        if (error < least) least = error, best = start;
      }
  return fit_servo(joints, best, holding(false, true), longest_delay);
}

// If the weight that a leg carries shows the stiffness better than the motion does, the other
// constants are fitted with this stiffness.
void take_standing_stiffness(const std::vector<JointRecording>& joints, double longest_delay,
                             double load_error, TypeFit& type) {
  const ServoConstants& found = type.fit.constants[0];
  const StandingCompliance standing =
      standing_compliance(joints, found.delay + found.damping, load_error);
  double half = HUGE_VAL;
  for (const JointRecording& joint : joints)
    half = std::min(half, compliance_half_width(type, joint));
  if (!standing.found || standing.half_width * found.compliance >= half * standing.value) return;
  std::array<bool, kConstants> held = holding(type.delay_takes_damping, true);
  held[static_cast<size_t>(Constant::compliance)] = true;
  std::vector<ServoConstants> start = type.fit.constants;
  for (ServoConstants& each : start) each.compliance = standing.value;
  type.fit = fit_servo(joints, start, held, longest_delay);
  const auto at = static_cast<Index>(Constant::compliance);
  const double sigma = standing.half_width / type.fit.t_factor;
  type.fit.covariance(at, at) = sigma * sigma;
  type.heavier = type.fit.constants[0];
  type.standing = standing;
}

// A servo may hold each command until the next one, or move gradually from one command to the next.
// `gradual` says that it moves gradually, because other joints show it. Otherwise, if the recording
// shows the difference, the better law is taken. If it does not, the delay is uncertain, because it
// would be half an interval shorter for a servo that holds. The result is then the mean of both
// delays.
TypeFit fit_type(std::vector<JointRecording> joints, double longest_delay, double weight,
                 bool gradual) {
  const std::vector<ServoConstants> guess = first_guess(joints, longest_delay);
  std::vector<ServoConstants> start = guess;
  for (ServoConstants& each : start) each.damping = 0;
  const double unknown_hold = gradual ? 0 : 0.25 * joints[0].command_dt;
  TypeFit result;
  set_law(joints, CommandLaw::linear, true);
  result.fit = fit_servo(joints, start, holding(true, true), longest_delay);
  const ServoFit simple = result.fit;
  result.hold = unknown_hold;
  result.delay_takes_damping = true;
  CommandLaw law = CommandLaw::linear;
  if (!gradual) {
    set_law(joints, CommandLaw::held, true);
    start = result.fit.constants;
    for (ServoConstants& each : start)
      each.delay = std::max(0.0, each.delay - behind(CommandLaw::held, joints[0]));
    ServoFit held = fit_servo(joints, start, holding(true, true), longest_delay);
    if (shows_law(result.fit, held) || shows_law(held, result.fit)) result.hold = 0;
    if (shows_law(held, result.fit)) result.fit = std::move(held), law = CommandLaw::held;
  }

  std::vector<CommandLaw> laws = {CommandLaw::linear};
  if (!gradual) laws.insert(laws.end(), {CommandLaw::held, CommandLaw::stepped});
  set_law(joints, laws[0], false);
  ServoFit damped = damped_fit(joints, simple, guess, longest_delay);
  CommandLaw damped_law = laws[0];
  double hold = unknown_hold, step = gradual ? 0 : 0.5 * joints[0].dt;
  for (size_t i = 1; i < laws.size(); ++i) {
    const CommandLaw other = laws[i];
    set_law(joints, other, false);
    ServoFit fit = damped_fit(joints, simple, guess, longest_delay);
    const bool better = shows_law(fit, damped);
    if (better || (other == CommandLaw::held && shows_law(damped, fit))) hold = 0;
    if (other == CommandLaw::stepped && (better || shows_law(damped, fit))) step = 0;
    if (better) damped = std::move(fit), damped_law = other;
  }
  if (shows_damping(damped, result.fit)) {
    result.fit = std::move(damped);
    result.hold = hold;
    result.step = step;
    result.delay_takes_damping = false;
    law = damped_law;
  }
  set_law(joints, law, result.delay_takes_damping);
  if (result.hold == 0) result.holds = law != CommandLaw::linear;
  if (load_changes_sign(joints)) {
    start = result.fit.constants;
    for (ServoConstants& each : start) each.backlash = 1e-4;
    ServoFit play =
        fit_servo(joints, start, holding(result.delay_takes_damping, false), longest_delay);
    result.has_backlash = fits_better(play, result.fit) &&
                          is_seen(play, result.fit, play.constants[0].backlash, Constant::backlash);
    if (result.has_backlash) result.fit = std::move(play);
  }
  std::vector<JointRecording> heavy = joints;
  for (JointRecording& joint : heavy)
    joint.inertia += kRotorShare * (joint.inertia - joint.link_inertia);
  result.heavier =
      fit_servo(heavy, result.fit.constants,
                holding(result.delay_takes_damping, !result.has_backlash), longest_delay)
          .constants[0];
  // A weight that changes from one flank of a gear to the other also shows its play.
  if (!result.has_backlash)
    take_standing_stiffness(joints, longest_delay, kCogError * weight, result);
  return result;
}

// Whether the servos of this robot move gradually from one command to the next. At least two joints
// must be in groups that show it, and no group may show the opposite: the motor boards of one robot
// work alike, so the other joints do the same.
bool all_move_gradually(const std::vector<TypeFit>& fits,
                        const std::vector<std::vector<size_t>>& groups) {
  size_t moving = 0;
  for (size_t i = 0; i < fits.size(); ++i) {
    if (!fits[i].holds) continue;
    if (*fits[i].holds) return false;
    moving += groups[i].size();
  }
  return moving > 1;
}

ServoEstimate estimate(double value, double half_width, double least = -HUGE_VAL) {
  return {value, std::max(least, value - half_width), value + half_width,
          half_width <= kKnown * std::abs(value)};
}

// The estimate of a ratio a/s from the covariance of a and s. Half its width grows by `share` of
// the value and by `more`.
ServoEstimate ratio(double a, double s, double var_a, double var_s, double cov, double factor,
                    double share, double more) {
  if (s <= 0) return {};
  const double value = a / s;
  const double variance = (var_a - 2 * value * cov + value * value * var_s) / (s * s);
  return estimate(value, factor * std::sqrt(std::max(0.0, variance)) + share * value + more, 0);
}

class Advice {
 public:
  Advice(const TypeFit& type, const IdentifiedJoint& joint, bool load_known) : fit_(type.fit) {
    if (!load_known) {
      say("both feet are on the ground, so each leg may push against the other through the ground, "
          "and the load of a single leg is not known: record a motion that lifts each foot");
      return;
    }
    if (type.delay_takes_damping)
      say("the effects of delay and damping cannot be distinguished, so only their sum is given, "
          "the lag: record quick steps or a chirp");
    const bool kp = joint.kp.known;
    if (!kp && tied(Constant::compliance, Constant::dry))
      say("the effects of kp and friction cannot be distinguished: record a slow sweep");
    else if (!kp && offset_tied())
      say("the effects of kp and offset cannot be distinguished: record a load that changes, such "
          "as a squat");
    else if (!kp)
      say("the load changes too little to show kp: record a squat or a sway, or find one set of "
          "constants for all servos of this type (--per type)");
    if (kp && !joint.coulomb.known)
      say("Coulomb friction is not determined: record a slow sweep in which the joint reverses its "
          "direction");
    if (kp && !type.delay_takes_damping && !joint.damping.known)
      say("viscous friction and damping are not determined: record steps or a chirp");
    if (type.has_backlash && tied(Constant::backlash, Constant::dry))
      say("the effects of backlash and Coulomb friction cannot be distinguished: record a load "
          "that changes its sign");
    if (type.has_backlash && tied(Constant::backlash, Constant::compliance))
      say("the effects of backlash and kp cannot be distinguished: record a load that changes its "
          "sign and its size");
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

// Rows in the middle of an interval of the length kSettle in which the share of the load on the
// leg's own foot stays above kLoaded, or stays below 1 minus kLoaded. The load of a leg then does
// not depend on how the feet share the weight.
std::vector<Index> settled_rows(const VectorXd& own, double dt) {
  const auto half = static_cast<Index>(std::ceil(0.5 * kSettle / dt));
  const auto kind = [&](Index k) { return own[k] > kLoaded ? 1 : own[k] < 1 - kLoaded ? -1 : 0; };
  std::vector<Index> rows;
  Index since = 0;  // first row of the same kind as the last row
  for (Index k = 0; k < own.size(); ++k) {
    if (k > 0 && kind(k) != kind(k - 1)) since = k;
    if (kind(k) != 0 && k - since >= 2 * half) rows.push_back(k - half);
  }
  return rows;
}

// The share of the load on the foot of the leg to which this joint belongs. It is empty if the
// joint belongs to no leg.
VectorXd own_share(const RobotModel& model, const JointLoads& loads, int dof) {
  if (loads.left_share.size() == 0) return {};
  for (const Side side : {Side::left, Side::right}) {
    const std::vector<int>& leg = model.leg(side);
    if (std::find(leg.begin(), leg.end(), dof) == leg.end()) continue;
    return side == Side::left ? loads.left_share : VectorXd(1 - loads.left_share.array());
  }
  return {};
}

// The change of the measured angle from the unloaded to the loaded foot. Over the rows in which one
// foot carries the robot, the difference between the angle and the delayed command is taken as a
// function of the load share of the leg's own foot. The change is the slope of a straight line
// through it by least squares. The stiffness is not needed.
void find_sag(const JointRecording& recording, IdentifiedJoint& joint) {
  double x = 0, y = 0, xx = 0, xy = 0, n = 0, least = 1, most = 0;
  for (const Index k : recording.settled) {
    const double own = recording.own_share[k];
    const double late =
        command_at(recording, recording.dt * static_cast<double>(k) - joint.lag.value);
    const double distance = recording.measured[k] - late;
    x += own, y += distance, xx += own * own, xy += own * distance, ++n;
    least = std::min(least, own), most = std::max(most, own);
  }
  joint.has_sag = least < 1 - kLoaded && most > kLoaded;
  if (joint.has_sag) joint.sag = (xy - x * y / n) / (xx - x * x / n);
}

// The distance of the unloaded joint from its command if the recording does not determine the
// stiffness. The fit could then explain any offset by a load of the joint, so the stiffness of the
// robot's file is taken. Half the width of the interval is the whole sag by this stiffness.
ServoEstimate offset_at_known_stiffness(const JointRecording& recording, double lag, double kp) {
  double offset = 0, sag = 0;
  for (const Index k : recording.compared) {
    const double late = command_at(recording, recording.dt * static_cast<double>(k) - lag);
    const double own = recording.torque[k] / kp;
    offset += recording.measured[k] - late + own;
    sag += std::abs(own);
  }
  const double count = std::max(1.0, static_cast<double>(recording.compared.size()));
  ServoEstimate result = estimate(offset / count, sag / count);
  result.known = false;
  return result;
}

void describe(const TypeFit& type, size_t i, const JointRecording& recording,
              const ServoDescription& servo, bool own_servo, IdentifiedJoint& joint) {
  const ServoFit& fit = type.fit;
  const ServoConstants& c = fit.constants[i];
  const auto var = [&](Constant a, Constant b) {
    return fit.covariance(static_cast<Index>(a), static_cast<Index>(b));
  };
  const double factor = fit.t_factor;
  const double s = c.compliance, heavier = std::max(type.heavier.compliance, 1e-12),
               load_share = load_share_error(recording),
               half = compliance_half_width(type, recording);
  // The whole lag, delay plus damping, is seen best; an error of the damping by a share of the load
  // changes the delay by the opposite amount.
  joint.delay = estimate(std::max(0.0, c.delay - type.hold),
                         factor * deviation(fit, Constant::delay) + type.hold +
                             load_share * c.damping + std::abs(type.heavier.delay - c.delay),
                         0);
  const double lag = c.delay + c.damping, variance = var(Constant::delay, Constant::delay) +
                                                     2 * var(Constant::delay, Constant::damping) +
                                                     var(Constant::damping, Constant::damping);
  joint.lag = estimate(lag,
                       factor * std::sqrt(std::max(0.0, variance)) +
                           std::abs(type.heavier.delay + type.heavier.damping - lag),
                       0);
  joint.kp = {1 / std::max(s, 1e-12), 1 / (s + half), s > half ? 1 / (s - half) : HUGE_VAL,
              half <= kKnown * s};
  const auto by_stiffness = [&](Constant which, double value, double other, double more) {
    return ratio(value, s, var(which, which), var(Constant::compliance, Constant::compliance),
                 var(which, Constant::compliance), factor, load_share,
                 std::abs(other / heavier - value / std::max(s, 1e-12)) + more);
  };
  joint.damping = by_stiffness(Constant::damping, c.damping, type.heavier.damping,
                               type.step / std::max(s, 1e-12));
  // The parts of the delay are not known separately.
  if (type.delay_takes_damping) {
    joint.delay.lower = 0;
    joint.delay.known = false;
    joint.damping = {0, 0, HUGE_VAL, false};
  }
  joint.coulomb = by_stiffness(Constant::dry, c.dry, type.heavier.dry, 0);
  // The motor's damping and viscous friction have the same effect. The damping that the robot's
  // file states is subtracted, unless the recording contradicts this.
  const double kd = own_servo && servo.kd <= joint.damping.upper ? servo.kd : 0;
  joint.viscous = estimate(std::max(0.0, joint.damping.value - kd),
                           joint.damping.upper - joint.damping.value, 0);
  joint.viscous.known = joint.damping.known;
  joint.backlash = estimate(c.backlash, factor * deviation(fit, Constant::backlash), 0);
  if (!type.has_backlash) joint.backlash = {};
  const auto o = static_cast<Index>(kConstants + i);
  joint.offset = estimate(c.offset, factor * std::sqrt(fit.covariance(o, o)));
  joint.offset.known = true;
  const VectorXd& residual = fit.residual[i];
  Index at = 0;
  joint.largest_error = residual.cwiseAbs().maxCoeff(&at);
  joint.largest_at =
      recording.dt * static_cast<double>(recording.compared[static_cast<size_t>(at)]);
  joint.mean_error = residual.cwiseAbs().mean();
  joint.delay_is_lag = type.delay_takes_damping;
  if (!recording.load_known)
    for (ServoEstimate* each : {&joint.kp, &joint.damping, &joint.viscous, &joint.coulomb})
      *each = {each->value, 0, HUGE_VAL, false};
  if (!joint.kp.known && servo.kp > 0)
    joint.offset = offset_at_known_stiffness(recording, joint.lag.value, servo.kp);
  joint.confounded = Advice(type, joint, recording.load_known).words;
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
  r.rate = loads.rate.col(dof);
  r.own_share = own_share(model, loads, dof);
  r.settled = settled_rows(r.own_share, r.dt);
  r.compared = telling_rows(r, load_known(model, loads, dof, r.dt));
  r.load_known = r.dt * static_cast<double>(r.compared.size()) > kLeastKnown;
  if (!r.load_known)
    r.compared = telling_rows(r, std::vector<char>(static_cast<size_t>(r.measured.size()), 1));
  return r;
}

}  // namespace

double longest_lag(const RobotModel& model) {
  double longest = kSlowServo;
  for (const ServoDescription& servo : model.limits().servo)
    longest = std::max(longest, kSlowerThanStated * servo.lag());
  return longest;
}

// The caution about angles that are far behind their commands, with the lag of the median joint. It
// is empty if there is no reason for a caution.
std::string late_answer(const RobotModel& model, const std::vector<IdentifiedJoint>& joints) {
  std::vector<std::pair<double, double>> lags;  // lag beyond the stated one, and whole lag
  for (const IdentifiedJoint& joint : joints) {
    if (!joint.moved) continue;
    const auto dof = static_cast<size_t>(model.find_dof(joint.joint));
    lags.emplace_back(joint.lag.value - model.limits().servo[dof].lag(), joint.lag.value);
  }
  if (lags.empty()) return "";
  std::sort(lags.begin(), lags.end());
  const auto& [beyond, lag] = lags[lags.size() / 2];
  if (beyond < kLikelyShift) return "";
  return "the angles are " + text::fixed(1000 * lag, 0) +
         " ms behind their command, but the servos in the robot's file have a lag of " +
         text::fixed(1000 * (lag - beyond), 0) +
         " ms. Make sure that both files begin at the same time";
}

// The caution about angles that are ahead of their commands by one or two rows, which
// require_answer() accepts. It is empty for other angles.
std::string early_answer(const RobotModel& model, const RecordedMotion& motion) {
  const double shift = time_shift(model, motion.command, motion.measured, 0);
  if (shift >= 0) return "";
  return "the angles are about " + text::brief(-1000 * shift, 2) +
         " ms ahead of their command, which is impossible for a servo. So every delay in this "
         "result "
         "is too short. Make sure that both files begin at the same time";
}

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
  if (options.longest_lag != 0)
    require_within("the longest lag of a servo", options.longest_lag, IdentifyOptions::kLongestLag);
  require_within("the number of threads", options.threads, kThreadBounds);
  const double longest = options.longest_lag > 0 ? options.longest_lag : longest_lag(model);
  require_within("the rate of the command", rate_of_rows(motion.command.dt), kRecordingRate);
  require_within("the rate of the measured angles", rate_of_rows(motion.measured.dt),
                 kRecordingRate);
  require_answer(model, motion.command, motion.measured, longest, place);
  report(progress, {"computing the loads", 0, ""});
  const JointLoads loads = joint_loads(model, motion, options.stand);
  require_loads(motion.sensors, motion.measured, loads.agreement, options.loads_place);
  const std::vector<std::string> types = motor_types(model);
  Identification result;
  result.seconds = motion.measured.duration();
  result.measured_at = motion.measured.measured_at;
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
  // There is one group of joints for each set of constants.
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
  std::vector<TypeFit> fits(jobs.size());
  const auto fit_job = [&](size_t job, bool gradual) {
    std::vector<JointRecording> joints;
    for (const size_t i : jobs[job]) joints.push_back(recordings[i]);
    fits[job] = fit_type(joints, longest, model.mass() * kGravity, gradual);
  };
  in_parallel(jobs.size(), options.threads, stop, [&](size_t job) { fit_job(job, false); });
  const bool gradual = all_move_gradually(fits, jobs);
  in_parallel(jobs.size(), options.threads, stop, [&](size_t job) {
    if (gradual && !fits[job].holds) fit_job(job, true);
    const TypeFit& fit = fits[job];
    for (size_t n = 0; n < jobs[job].size(); ++n) {
      const size_t i = jobs[job][n];
      describe(fit, n, recordings[i], model.limits().servo[static_cast<size_t>(dofs[i])],
               !model.description().servos_inferred, result.joints[i]);
      find_sag(recordings[i], result.joints[i]);
    }
  });
  result.caution = early_answer(model, motion);
  if (result.caution.empty()) result.caution = late_answer(model, result.joints);
  return result;
}

}  // namespace ayumi
