// Generators write a keyframed pattern, which a person can then edit.

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/actuator_need.hpp"
#include "ayumi/control/laws/viip.hpp"
#include "ayumi/control/viip_goals.hpp"
#include "ayumi/dynamics/inverse_kinematics.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/task/task.hpp"
#include "motion_search.hpp"
#include "new_pattern.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "terminal.hpp"
#include "walk_that_fits.hpp"

namespace ayumi::app {

namespace {

struct NewOptions {
  NewFile file;
  WalkParameters walk;
  SwayParameters sway;
  SquatParameters squat;
  double turn_deg = 0;
  std::string first = "right";
  double duration = 3.0;
  double stand_height = 0;  // COG height [m]; 0 for that of the home posture
  double scale = 1;         // factor on the amplitudes of an excitation
  double low = 0;           // COG height of an excitation [m]; 0 if it is not given
  std::vector<double> cog, velocity, cog_velocity;  // goals of VIIP
  double moving = 1;                                // duration of a COG velocity [s]
  int viip_steps = 0;
  // Values that are not given get the values for HOAP-1, scaled to the robot.
  std::optional<double> stride, period, lift, side, depth, hold, length, height;
  std::optional<double> angle_deg;
  // The options --double-support and --zmp-inwards of each subcommand that makes a walk.
  // is_given() says whether one of them was given.
  std::vector<const Option*> double_support, zmp_inwards;

  static bool is_given(const std::vector<const Option*>& options) {
    return std::any_of(options.begin(), options.end(),
                       [](const Option* option) { return option->count() > 0; });
  }
  SeatParameters seat;
  BowParameters bow;
  WaveParameters wave;
  KickParameters kick;
  std::string which = "right";  // hand or foot
  double rise = 0;
};

double rounded(double value, double unit) { return unit * std::round(value / unit); }

// The largest movement of the ZMP inwards, as a share of half the width of a sole. Chosen: the ZMP
// then stays on the sole.
constexpr double kMostInwards = 0.9;
// The smallest value of a dial that is tried outside its list, as a share of the smallest value in
// the list. Chosen: with a smaller value, it is hardly the motion that was asked for.
constexpr double kLeastShare = 0.6;

Dial dial(const char* name, const char* unit, double value, double step, bool open,
          const std::vector<double>& shares) {
  Dial result{name, unit, {value}};
  for (const double share : shares) {
    const double other = rounded(share * value, step);
    if (open && value != 0 && other != result.values.back()) result.values.push_back(other);
  }
  if (result.values.size() > 1) {
    const auto [least, most] = std::minmax_element(result.values.begin(), result.values.end());
    result.least = rounded(kLeastShare * *least, step);
    result.most = *most;
    result.step = step;
  }
  return result;
}

// Shares of the generator's own COG height that are tried.
const std::vector<double> kHeightShares = {0.97, 1.02, 0.94, 0.91, 0.88};

// A dial for COG heights around `own`, the generator's own height, which is written as 0.
Dial height_dial(double own, double given, const std::vector<double>& shares) {
  Dial result = dial("--cog-height", "m", own, 1e-3, given == 0, shares);
  if (result.most > 0) result.least = *std::min_element(result.values.begin(), result.values.end());
  result.stands_for = own;
  result.values.front() = given;
  result.posture = true;
  return result;
}

Dial height_dial(const RobotModel& model, double given,
                 const std::vector<double>& shares = kHeightShares) {
  return height_dial(starting_height(model), given, shares);
}

// The values of a finished search, or the defaults if there are none. Prints what was changed and
// what limits the robot.
std::vector<double> values_of(const Context& context, const RobotModel& model,
                              const std::vector<Dial>& dials, const SearchResult& result,
                              const UsedValues& used = std::identity()) {
  if (result.limit.empty()) {
    std::vector<double> defaults;
    for (const Dial& each : dials) defaults.push_back(each.values.front());
    return defaults;
  }
  const std::string changed = changed_values(dials, used(result.values));
  if (!result.falls.empty())
    context.print("the check accepts this motion" + (changed.empty() ? "" : " with " + changed) +
                  ", but the robot falls in a simulation: " + result.falls + ". In " +
                  std::to_string(result.tried) +
                  " trials, no values were found with which the robot stands\n");
  else if (result.found)
    context.print(model.name() +
                  " cannot do this motion with the default values. First error: " + result.limit +
                  "\n"
                  "  after " +
                  std::to_string(result.tried) + " trials, these values were found: " + changed +
                  "\n");
  else if (result.tried > 1 && (!result.nearest.empty() || !result.refused)) {
    context.print("none of " + std::to_string(result.tried) +
                  " combinations of values passes the check. ");
    if (!result.refused)  // otherwise, the error says it
      context.print("First error with the default values: " + result.limit + "\n");
    if (!result.nearest.empty()) {
      const std::string nearest = changed_values(dials, used(result.nearest_values));
      context.print("The combination that comes nearest has " +
                    (nearest.empty() ? "the default values" : nearest) + ". Its limit is " +
                    result.nearest + "\n");
    }
  }
  return result.values;
}

// The values of the dials with which the robot can do the motion, or the defaults if there are
// none.
std::vector<double> values_that_pass(const Context& context, const RobotModel& model,
                                     const std::vector<Dial>& dials,
                                     const std::function<Pattern(const std::vector<double>&)>& make,
                                     bool simulated = false,
                                     const UsedValues& used = std::identity()) {
  SearchResult result;
  if (model.has_soles())
    result = search_motion(model, dials, make, context.progress(), simulated, used);
  return values_of(context, model, dials, result, used);
}

// A dial of a walk, and the parameter that it sets.
struct WalkDial {
  Dial dial;
  std::function<void(WalkParameters&, double)> set;
};

// Finds the values that are not given for a walk in place, a walk forward or a turn. `length` is
// the dial that makes its steps longer. With `lifts`, the lift of the feet may be reduced, because
// the user has not given it.
void fit_steps(const Context& context, const RobotModel& model, const NewOptions& options,
               WalkParameters& w, const WalkDial& length, bool lifts = false) {
  // Legs without the roll of the ankle can carry the COG only a few millimetres aside, so they have
  // to step quickly and close to the other foot. With a lower COG, their knees need less torque for
  // this.
  const bool lacking = InverseKinematics(model, model.posture()).lacks_joints();
  Dial inwards{"--zmp-inwards", "m", {w.zmp_inwards}};
  if (!NewOptions::is_given(options.zmp_inwards)) {
    inwards.most = rounded(kMostInwards * half_sole_width(model), 1e-3);
    inwards.step = 1e-3;
    if (lacking) inwards.values = {0, inwards.most, rounded(0.7 * half_sole_width(model), 1e-3)};
  }
  Dial height = height_dial(model, w.cog_height);
  if (lacking) {
    height = height_dial(model, w.cog_height, {0.91, 0.88});
    height.posture = false;  // with a lower COG, their knees need less torque
  }
  const std::vector<double> paces =
      lacking ? std::vector{0.34, 0.55, 0.42, 0.75} : std::vector{1.25, 1.6, 0.8, 2.2};
  const WalkDial stature{height, [](WalkParameters&p, double v) { p.cog_height = v; }},
      pace{dial("--period", "s", w.period, 0.01, !options.period, paces),
           [](WalkParameters&p, double v) { p.period = v; }},
      shift{inwards, [](WalkParameters&p, double v) { p.zmp_inwards = v; }},
      rise{dial("--lift", "m", w.lift, 1e-3, !options.lift, {0.75, 0.5}),
           [](WalkParameters&p, double v) { p.lift = v; }},
      both{dial("--double-support", "", w.double_support, 0.01,
                !NewOptions::is_given(options.double_support), {1.7, 0.6}),
           [](WalkParameters&p, double v) { p.double_support = v; }};
  // Among trials with equally large changes, those that change the last dials come first.
  std::vector<WalkDial> turned = lacking ? std::vector{length, pace, shift, stature}
                                         : std::vector{stature, length, pace, shift};
  const bool lists_lift = lifts && !lacking;
  if (lists_lift) turned.insert(turned.begin() + 1, rise);
  // The lists of the other dials contain only the default, so their values change only if no value
  // in the lists is enough.
  std::vector<WalkDial> others = {both};
  if (!lists_lift) others.push_back(rise);
  for (WalkDial& each : others) {
    each.dial.values.resize(1);
    each.dial.step /= 2;
    turned.push_back(each);
  }
  // Rotors that weigh much beside their legs need most of their torque for the lift, so the search
  // may lower it as far as the generator allows, in the steps of the lift in a pattern.
  const WalkLimits limits = walk_limits(model);
  for (WalkDial& each : turned) {
    if (each.dial.most <= each.dial.least) continue;
    if (each.dial.name == "--period") each.dial.least = std::max(each.dial.least, limits.period);
    if (each.dial.name != "--lift") continue;
    each.dial.step = 1e-4;
    each.dial.least = each.dial.step * std::ceil(limits.lift / each.dial.step);
  }
  std::vector<Dial> dials;
  for (const WalkDial& each : turned) dials.push_back(each.dial);
  const auto with = [&](const std::vector<double>& values) {
    WalkParameters walk = w;
    for (size_t i = 0; i < turned.size(); ++i) turned[i].set(walk, values[i]);
    // Quick steps are low, because the acceleration of the foot for the same lift grows with 1/T^2.
    if (lacking && !options.lift)
      walk.lift = std::min(walk.lift, rounded(w.lift * walk.period / w.period, 5e-4));
    return walk;
  };
  const auto lift_dial = std::find_if(dials.begin(), dials.end(),
                                      [](const Dial& each) { return each.name == "--lift"; }) -
                         dials.begin();
  w = with(values_that_pass(
      context, model, dials,
      [&](const std::vector<double>& values) { return walk_pattern(model, with(values)); }, true,
      [&](std::vector<double> values) {
        values[static_cast<size_t>(lift_dial)] = with(values).lift;
        return values;
      }));
}

// Shares of the default length of a step. For legs without the roll of the ankle, shorter steps are
// tried at once.
std::vector<double> step_shares(const RobotModel& model) {
  return InverseKinematics(model, model.posture()).lacks_joints() ? std::vector{0.5, 0.25}
                                                                  : std::vector{0.75, 0.5, 0.25};
}

void fit_walk(const Context& context, const RobotModel& model, const NewOptions& options,
              WalkParameters& w, bool lifts = false) {
  if (!model.has_soles() || w.turn != 0 || w.side != 0 || w.rise != 0) return;
  const WalkDial stride{dial("--stride", "m", w.stride, 1e-3, !options.stride, step_shares(model)),
                        [](WalkParameters& p, double v) { p.stride = v; }};
  fit_steps(context, model, options, w, stride, lifts);
}

// Motions that a robot can do if it cannot walk, as commands; "" if none was found.
std::string what_it_can_do(const RobotModel& model, const std::string& robot) {
  struct Other {
    std::string command;
    std::function<Pattern(double share)> make;
    std::function<std::string(double share)> option;
  };
  const double depth = squat_defaults(model).depth, side = sway_defaults(model).side;
  const auto length = [](double value) { return text::brief(rounded(value, 1e-3)); };
  const std::vector<Other> others = {
      {"stand", [&](double) { return stand_pattern(model, 3); }, [](double) { return ""; }},
      {"squat",
       [&](double share) {
         SquatParameters p = squat_defaults(model);
         p.depth = rounded(share * depth, 1e-3);
         return squat_pattern(model, p);
       },
       [&](double share) { return share == 1 ? "" : " --depth " + length(share * depth); }},
      {"sway",
       [&](double share) {
         SwayParameters p = sway_defaults(model);
         p.side = rounded(share * side, 1e-3);
         return sway_pattern(model, p);
       },
       [&](double share) { return share == 1 ? "" : " --side " + length(share * side); }}};
  std::vector<std::string> commands;
  for (const Other& other : others)
    for (const double share : {1.0, 0.5, 0.25}) {
      if (!postures_pass(model, [&] { return other.make(share); })) continue;
      commands.push_back("`ayumi new " + other.command + " --robot " + robot + other.option(share) +
                         " -o " + other.command + ".json`");
      break;
    }
  return commands.empty()
             ? ""
             : ". No walk was found, but these commands make motions that the robot can do: " +
                   text::join(commands, ", ");
}

void new_walk(Context& context, NewOptions options) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  const bool climbs = options.rise != 0;
  const WalkParameters scaled = climbs ? stair_defaults(model, options.rise) : walk_defaults(model);
  WalkParameters& w = options.walk;
  w.rise = options.rise;
  if (climbs && w.cog_height == 0) w.cog_height = scaled.cog_height;
  w.stride = options.stride.value_or(scaled.stride);
  w.period = options.period.value_or(scaled.period);
  w.lift = options.lift.value_or(scaled.lift);
  w.turn = options.turn_deg * std::numbers::pi / 180;
  w.first_swing = options.first == "left" ? Side::left : Side::right;
  fit_walk(context, model, options, w);
  const std::vector<std::string> comments = {
      "Walk of " + std::to_string(w.steps) + " steps: stride " + text::brief(w.stride) +
          " m, period " + text::brief(w.period) + " s, double support " +
          text::brief(100 * w.double_support) + " %, lift " + text::brief(w.lift) + " m",
      "The pattern has no keys of the COG. Ayumi computes the COG from the ZMP keys with the full "
      "model of the robot."};
  try {
    if (write_new_pattern(context, model, walk_pattern(model, w), options.file, comments)) return;
  } catch (const Error& error) {
    const std::string fits = error.code() == ErrorCode::bad_pattern ? what_fits(model, w) : "";
    if (error.code() != ErrorCode::bad_pattern) throw;
    throw_with_more(error, fits.empty() ? what_it_can_do(model, options.file.robot) : ". " + fits);
  }
  const std::string fits = what_fits(model, w);
  if (!fits.empty()) context.print("  " + fits + "\n");
}

void new_step(Context& context, NewOptions options) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  const WalkParameters scaled = walk_defaults(model);
  WalkParameters& w = options.walk;
  w.stride = options.stride.value_or(0);
  w.period = options.period.value_or(scaled.period);
  w.lift = options.lift.value_or(scaled.lift);
  w.first_swing = options.first == "left" ? Side::left : Side::right;
  fit_walk(context, model, options, w);
  const std::string where =
      w.stride == 0 ? "in place" : "of " + text::brief(w.stride) + " m forward";
  write_new_pattern(
      context, model, walk_pattern(model, w), options.file,
      {std::to_string(w.steps) + (w.steps == 1 ? " step " : " steps ") + where +
           ", and one more step that brings the feet together. Period " + text::brief(w.period) +
           " s, lift " + text::brief(w.lift) + " m",
       "For a longer step, change \"to\" of the swings. The COG is computed from the ZMP keys."});
}

void new_sway(Context& context, NewOptions options) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  const SwayParameters scaled = sway_defaults(model);
  SwayParameters& p = options.sway;
  p.side = options.side.value_or(p.forward != 0 ? 0 : scaled.side);
  p.period = options.period.value_or(scaled.period);
  const std::vector<Dial> dials = {
      height_dial(model, p.cog_height),
      dial("--side", "m", p.side, 1e-3, !options.side, {0.75, 0.5, 0.25, 0.1}),
      dial("--period", "s", p.period, 0.01, !options.period, {1.25, 1.6})};
  const auto with = [&](const std::vector<double>& values) {
    SwayParameters sway = p;
    sway.cog_height = values[0];
    sway.side = values[1];
    sway.period = values[2];
    return sway;
  };
  p = with(values_that_pass(context, model, dials, [&](const std::vector<double>& values) {
    return sway_pattern(model, with(values));
  }));
  write_new_pattern(
      context, model, sway_pattern(model, p), options.file,
      {"The COG sways " + std::to_string(p.cycles) + " times, " + text::brief(p.side) +
           " m to either side and " + text::brief(p.forward) + " m ahead and back, over both feet.",
       "The COG is at rest at every key. The ZMP is computed from the motion of the whole robot."});
}

void new_squat(Context& context, NewOptions options) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  const SquatParameters scaled = squat_defaults(model);
  SquatParameters& p = options.squat;
  p.depth = options.depth.value_or(scaled.depth);
  p.period = options.period.value_or(scaled.period);
  p.hold = options.hold.value_or(scaled.hold);
  const std::vector<Dial> dials = {
      dial("--depth", "m", p.depth, 1e-3, !options.depth, {0.75, 0.5, 0.3, 0.15}),
      height_dial(model, p.cog_height),
      dial("--period", "s", p.period, 0.01, !options.period, {1.4, 2})};
  const auto with = [&](const std::vector<double>& values) {
    SquatParameters squat = p;
    squat.depth = values[0];
    squat.cog_height = values[1];
    squat.period = values[2];
    return squat;
  };
  p = with(values_that_pass(context, model, dials, [&](const std::vector<double>& values) {
    return squat_pattern(model, with(values));
  }));
  write_new_pattern(
      context, model, squat_pattern(model, p), options.file,
      {"Squats " + std::to_string(p.cycles) + " times by " + text::brief(p.depth) +
           " m. The keys give the COG height.",
       "The horizontal position of the COG is solved so that the ZMP stays in the middle of "
       "the feet."});
}

void new_seat(Context& context, NewOptions options, bool down) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  const SeatParameters scaled = seat_defaults(model);
  SeatParameters& p = options.seat;
  p.depth = options.depth.value_or(scaled.depth);
  p.period = options.period.value_or(scaled.period);
  if (options.angle_deg) p.lean = *options.angle_deg * std::numbers::pi / 180;
  const std::vector<Dial> dials = {
      height_dial(model, p.cog_height),
      dial("--depth", "m", p.depth, 1e-3, !options.depth, {0.75, 0.5, 0.25}),
      dial("--period", "s", p.period, 0.01, !options.period, {1.25, 1.6})};
  const auto make = [&](const std::vector<double>& values) {
    p.cog_height = values[0];
    p.depth = values[1];
    p.period = values[2];
    return down ? sit_pattern(model, p) : rise_pattern(model, p);
  };
  const Pattern pattern = make(values_that_pass(context, model, dials, make));
  write_new_pattern(
      context, model, pattern, options.file,
      {std::string(down ? "Goes down by " : "Comes up by ") + text::brief(p.depth) +
           " m, with the trunk leaning forward in the middle of the motion.",
       "There is no seat in the world of the pattern: the feet alone carry the robot."});
}

void new_bow(Context& context, NewOptions options) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  const BowParameters scaled = bow_defaults(model);
  BowParameters& p = options.bow;
  p.period = options.period.value_or(scaled.period);
  p.hold = options.hold.value_or(scaled.hold);
  const double degree = std::numbers::pi / 180;
  const double angle = options.angle_deg.value_or(rounded(scaled.angle / degree, 1));
  const std::vector<Dial> dials = {
      height_dial(model, p.cog_height),
      dial("--angle", "deg", angle, 1, !options.angle_deg, {0.8, 0.6, 0.4, 0.2}),
      dial("--period", "s", p.period, 0.01, !options.period, {1.25, 1.6})};
  const auto make = [&](const std::vector<double>& values) {
    p.cog_height = values[0];
    p.angle = values[1] * degree;
    p.period = values[2];
    return bow_pattern(model, p);
  };
  const Pattern pattern = make(values_that_pass(context, model, dials, make));
  write_new_pattern(
      context, model, pattern, options.file,
      {"Bows by " + text::brief(p.angle / degree) +
           " deg. The keys give the attitude of the trunk and the COG height.",
       "The horizontal position of the COG is solved so that the ZMP stays in the middle of "
       "the feet."});
}

void new_wave(Context& context, NewOptions options) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  WaveParameters& p = options.wave;
  p.side = options.which == "left" ? Side::left : Side::right;
  p.period = options.period.value_or(wave_defaults(model).period);
  const std::vector<Dial> dials = {
      height_dial(model, p.cog_height),
      dial("--period", "s", p.period, 0.01, !options.period, {1.25, 1.6, 2.2})};
  const auto make = [&](const std::vector<double>& values) {
    p.cog_height = values[0];
    p.period = values[1];
    return wave_pattern(model, p);
  };
  const Pattern pattern = make(values_that_pass(context, model, dials, make));
  write_new_pattern(context, model, pattern, options.file,
                    {"Waves the " + options.which + " hand " + std::to_string(p.cycles) +
                         " times. The keys give the joints of the arm.",
                     "The COG is solved so that the ZMP stays in the middle of the feet."});
}

void new_kick(Context& context, NewOptions options) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  const KickParameters scaled = kick_defaults(model);
  KickParameters& p = options.kick;
  p.side = options.which == "left" ? Side::left : Side::right;
  p.length = options.length.value_or(scaled.length);
  p.height = options.height.value_or(scaled.height);
  p.period = options.period.value_or(scaled.period);
  const std::vector<Dial> dials = {
      height_dial(kick_cog_height(model, p.height), p.cog_height, kHeightShares),
      dial("--length", "m", p.length, 1e-3, !options.length, {0.75, 0.5, 0.25}),
      dial("--period", "s", p.period, 0.01, !options.period, {1.25, 1.6, 2.2}),
      dial("--height", "m", p.height, 1e-3, !options.height, {0.6, 0.4})};
  const auto make = [&](const std::vector<double>& values) {
    p.cog_height = values[0];
    p.length = values[1];
    p.period = values[2];
    p.height = values[3];
    return kick_pattern(model, p);
  };
  const Pattern pattern = make(values_that_pass(context, model, dials, make));
  write_new_pattern(context, model, pattern, options.file,
                    {"Kicks " + text::brief(p.length) + " m ahead with the " + options.which +
                         " foot. This foot has keys while it is free.",
                     "Ayumi computes the COG from the ZMP keys with the full model of the robot."});
}

// Turn per step if only the whole angle is given [deg]. Chosen: the feet of HOAP-1 then stay 5 mm
// apart.
constexpr double kTurnPerStep = 10;

void new_turn(Context& context, NewOptions options) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  const WalkParameters scaled = walk_defaults(model);
  const double angle = options.angle_deg.value_or(90);
  if (!(std::abs(angle) >= 1 && std::abs(angle) <= 3600))
    fail(ErrorCode::usage, "turn: angle " + text::brief(angle) +
                               " deg is out of range. Give 1 to 3600 deg to either side");
  WalkParameters& w = options.walk;
  w.stride = 0;
  w.period = options.period.value_or(scaled.period);
  w.lift = options.lift.value_or(scaled.lift);
  // The foot on the side to which the robot turns goes first, away from the other one.
  w.first_swing = angle > 0 ? Side::left : Side::right;
  const auto in_steps_of = [angle](WalkParameters& p, double most) {
    p.steps = static_cast<int>(std::ceil(std::abs(angle) / most - 1e-9));
    p.turn = angle / p.steps * std::numbers::pi / 180;
  };
  const double most =
      std::max(1.0, std::abs(options.turn_deg == 0 ? kTurnPerStep : options.turn_deg));
  in_steps_of(w, most);
  if (model.has_soles())
    fit_steps(context, model, options, w,
              {dial("--per-step", "deg", most, 1, options.turn_deg == 0, step_shares(model)),
               in_steps_of},
              true);
  write_new_pattern(
      context, model, walk_pattern(model, w), options.file,
      {"Turns by " + text::brief(angle) + " deg in place, in " + std::to_string(w.steps) +
           " steps and one more step that brings the feet together.",
       "The pattern has no keys of the COG. Ayumi computes the COG from the ZMP keys with the full "
       "model of the robot."});
}

void new_march(Context& context, NewOptions options) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  const WalkParameters scaled = walk_defaults(model);
  WalkParameters& w = options.walk;
  w.stride = 0;
  // High steps take more time.
  w.period = options.period.value_or(rounded(1.1 * scaled.period, 0.01));
  w.lift = options.lift.value_or(rounded(1.6 * scaled.lift, 1e-3));
  w.first_swing = options.first == "left" ? Side::left : Side::right;
  options.stride = 0;
  fit_walk(context, model, options, w, true);
  write_new_pattern(
      context, model, walk_pattern(model, w), options.file,
      {"Marches in place with " + std::to_string(w.steps) + " steps. Lift " + text::brief(w.lift) +
           " m, period " + text::brief(w.period) + " s.",
       "The pattern has no keys of the COG. Ayumi computes the COG from the ZMP keys with the full "
       "model of the robot."});
}

// Time of standing before a goal of VIIP [s]. Chosen: 3/omega of HOAP-1.
constexpr double kStandFirst = 0.5;
// Time for a displacement, and time for the return [s]. Chosen: 16/omega of HOAP-1, three times the
// time for which VIIP stands after its steps (control/laws/viip.cpp).
constexpr double kDisplaced = 2.5;

// The first profile that can carry out the goals in their keyed form; "" if there is none.
std::string profile_for(const Context& context, const RobotModel& model,
                        const std::vector<KeyedGoal>& goals) {
  std::string need;
  for (const std::string& name : model.profile_names()) {
    CheckOptions options;
    options.profile = name;
    const ActuatorNeed missing = actuator_need(model, goals, options);
    if (missing.text.empty()) return name;
    if (need.empty()) need = missing.text;
  }
  context.print(need + "\n");
  return {};
}

// COG height at which the legs reach the footholds: 0 for the height of the home posture or, for
// long steps, a lower height.
double height_for_steps(const RobotModel& model, Pattern pattern) {
  const double home = default_cog_height(model, pattern);
  for (const double share : {1.0, 0.97, 0.94, 0.91, 0.88, 0.85}) {
    pattern.cog_height = share == 1 ? 0 : std::round(1e3 * share * home) / 1e3;
    try {
      require_reachable_goals(model, sample_at_servo_period(model, pattern), pattern.controller);
      return pattern.cog_height;
    } catch (const Error& error) {
      if (error.code() == ErrorCode::internal) throw;
    }
  }
  return 0;
}

// The robot stands, reaches the goal, and stands.
void new_viip(Context& context, const NewOptions& options) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  const bool steps = options.viip_steps > 0;
  if (steps + !options.cog.empty() + !options.cog_velocity.empty() != 1)
    fail(ErrorCode::usage,
         "viip: give exactly one of --cog DX,DY,DZ, --cog-velocity VX,VY,VZ and --steps N. You can "
         "add --velocity and --turn to --steps, and --duration to --cog-velocity");
  if (!steps && (!options.velocity.empty() || options.turn_deg != 0))
    fail(ErrorCode::usage,
         "viip: --velocity and --turn work only together with --steps N. Add --steps");
  const auto moves = [](double v) { return v != 0; };
  if (options.viip_steps == 1 &&
      (options.turn_deg != 0 ||
       std::any_of(options.velocity.begin(), options.velocity.end(), moves)))
    fail(ErrorCode::usage,
         "viip: the last step brings the feet together, so one step cannot go forward. Give "
         "--steps 2 or more");
  Pattern pattern;
  pattern.robot = options.file.robot;
  pattern.controller.type = ControllerKind::viip;
  for (const std::vector<double>& values :
       {options.cog, options.cog_velocity, options.velocity, {options.turn_deg}})
    for (const double value : values)
      if (!std::isfinite(value))
        fail(ErrorCode::usage,
             "viip: a value of --cog, --cog-velocity, --velocity or --turn is not a finite number");
  double t = kStandFirst;
  const auto phase = [&](double length, const ViipGoal& goal) {
    t += length;
    pattern.phases.push_back({0.001 * std::ceil(1e3 * t - 1e-6), Support::both, {}, goal});
  };
  phase(0, CogGoal{});
  std::vector<std::string> comments;
  if (steps) {
    StepGoal goal;
    goal.steps = options.viip_steps;
    for (size_t i = 0; i < options.velocity.size(); ++i)
      goal.velocity[static_cast<Eigen::Index>(i)] = options.velocity[i];
    goal.turn = options.turn_deg * std::numbers::pi / 180;
    pattern.phases.push_back({kStandFirst + 10.0 * goal.steps, Support::both, {}, goal});
    pattern.cog_height = height_for_steps(model, pattern);
    pattern.phases.pop_back();
    const double omega = std::sqrt(kGravity / default_cog_height(model, pattern));
    phase(stepping_time(viip_params(model, pattern.controller), omega, goal.steps) + 0.05, goal);
    comments = {std::to_string(goal.steps) +
                    " steps. The last step brings the feet together. VIIP chooses the footholds.",
                "The duration of the phase is the time of all steps, from standing to standing."};
  } else if (!options.cog_velocity.empty()) {
    const std::vector<double>& v = options.cog_velocity;
    phase(options.moving, CogVelocityGoal{{v[0], v[1], v[2]}});
    phase(kDisplaced, CogVelocityGoal{});
    phase(kDisplaced, CogGoal{});
    comments = {
        "The robot stands on both feet. The COG moves at a velocity, stops, and goes back."};
  } else {
    const Eigen::Vector3d displacement(options.cog[0], options.cog[1], options.cog[2]);
    phase(kDisplaced, CogGoal{displacement});
    phase(kDisplaced, CogGoal{});
    comments = {"The robot stands on both feet. The COG moves by a displacement, and goes back."};
  }
  const CommandSeries series = sample_at_servo_period(model, pattern);
  require_reachable_goals(model, series, pattern.controller);
  pattern.profile = profile_for(context, model, keyed_goals(model, series, pattern.controller));
  write_new_pattern(context, model, pattern, options.file, comments);
}

void new_stand(Context& context, const NewOptions& options) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  const std::vector<Dial> dials = {height_dial(model, options.stand_height)};
  const auto make = [&](const std::vector<double>& values) {
    return stand_pattern(model, options.duration, values[0]);
  };
  const Pattern pattern = make(values_that_pass(context, model, dials, make));
  write_new_pattern(
      context, model, pattern, options.file,
      {pattern.cog_height == 0
           ? "The robot stands on both feet in the home posture."
           : "The robot stands on both feet with bent knees, lower than in the home posture."});
}

bool passes(const SearchResult& result) { return result.found || result.limit.empty(); }

// Reduces the amplitudes, and bends the knees of the robot more, until the check finds the pattern
// consistent. If no values pass, leaves out the parts of the motion that the robot cannot do even
// alone.
void new_excite(Context& context, const NewOptions& options) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  const double given = rounded(100 * options.scale, 1e-3);  // the scale as the value of a dial [%]
  const Dial amplitudes =
      dial("amplitudes of", "%", given, 0.1, true, {0.8, 0.64, 0.512, 0.41, 0.328, 0.262});
  const double usual = default_cog_height(model, excite_pattern(model, options.scale));
  const Dial height{
      "a COG height of", "of the usual one",
      options.low > 0 ? std::vector{options.low / usual} : std::vector{1.0, 0.96, 0.92}, true};
  const std::vector<Dial> dials = {height, amplitudes};
  const auto make = [&](const std::vector<double>& values, const std::vector<ExcitePart>& parts) {
    return excite_pattern(model, 0.01 * values[1], values[0], parts);
  };
  const auto search = [&](const std::vector<ExcitePart>& parts) {
    const auto of_parts = [&](const std::vector<double>& values) { return make(values, parts); };
    return model.has_soles() ? search_motion(model, dials, of_parts, context.progress())
                             : SearchResult{};
  };
  std::vector<ExcitePart> parts = excite_parts();
  SearchResult result = search(parts);
  std::string left_out;
  if (!passes(result) && !options.file.allow_inconsistent) {
    std::vector<ExcitePart> possible;
    for (const ExcitePart part : parts) {
      const SearchResult alone = search({part});
      if (passes(alone)) {
        possible.push_back(part);
        continue;
      }
      const std::string limit = alone.nearest.empty() ? alone.limit : alone.nearest;
      left_out += "  " + std::string(name_of(part)) +
                  ": this part is left out, because the robot cannot make this movement with any "
                  "of the values that were tried. Its limit is " +
                  limit + "\n";
    }
    SearchResult rest;
    rest.limit = result.limit;
    if (!possible.empty() && possible != parts) rest = search(possible);
    if (passes(rest)) {
      parts = possible;
      result = rest;
    } else {
      left_out.clear();
    }
  }
  const std::vector<double> values = values_of(context, model, dials, result);
  context.print(left_out);
  std::vector<std::string> comments = {
      "Slow sweeps, chirps and steps of every joint, for `ayumi identify`. Joints of a leg "
      "are moved while the robot stands on one foot.",
      "The amplitudes are " + text::brief(values[1], 3) + " % of the usual ones."};
  for (const ExcitePart part : excite_parts())
    if (std::find(parts.begin(), parts.end(), part) == parts.end())
      comments.push_back(
          "Left out, because this robot cannot do it: " + std::string(name_of(part)) + ".");
  write_new_pattern(context, model, make(values, parts), options.file, comments);
}

// Adds an option that several generators share.
void add_scaled(Command& command, const char* name, std::optional<double>& value,
                const std::string& text, double hoap1, const char* type) {
  command
      .add_option(
          name, value,
          text + " (default: the value for HOAP-1, scaled to the size of the robot; for hoap1 " +
              ayumi::text::brief(hoap1) + ").")
      ->type_name(type);
}

// `zero` says which height the value 0 stands for.
void add_height(Command& command, double& height,
                const std::string& zero =
                    "the height in the home posture, or a lower height if the "
                    "legs are straight in the home posture") {
  command.add_option("--cog-height", height, "COG height [m]; 0 = " + zero + ".")
      ->capture_default_str()
      ->type_name("M");
}

void add_gait(Command& command, NewOptions& options) {
  command
      .add_option("--steps", options.walk.steps,
                  "Number of steps. After these steps, one more step brings the feet together.")
      ->capture_default_str()
      ->type_name("N");
  add_scaled(command, "--period", options.period, "Time of one step [s]", WalkParameters().period,
             "S");
  add_scaled(command, "--lift", options.lift, "Height of the swinging sole [m]",
             WalkParameters().lift, "M");
  options.double_support.push_back(
      command
          .add_option("--double-support", options.walk.double_support,
                      "Share of the period in which both feet are on the ground.")
          ->capture_default_str()
          ->type_name("SHARE"));
  add_height(command, options.walk.cog_height);
  options.zmp_inwards.push_back(
      command
          .add_option(
              "--zmp-inwards", options.walk.zmp_inwards,
              "Distance by which the ZMP is moved from the middle of the standing sole towards "
              "the other foot [m]. With a larger distance the COG sways less.")
          ->capture_default_str()
          ->type_name("M"));
  command.add_option("--first", options.first, "Foot that swings first.")
      ->check(one_of({"left", "right"}))
      ->capture_default_str();
}

void add_walk(Command& command, NewOptions& options) {
  command.footer(
      "Examples:\n  ayumi new walk --steps 10 --stride 0.025 --period 0.6 -o walk.json\n"
      "  ayumi new walk --rise 0.01 --steps 3 -o stairs.json");
  add_new_file(command, options.file);
  add_gait(command, options);
  add_scaled(command, "--stride", options.stride,
             "Distance between successive footholds [m], backwards if negative",
             WalkParameters().stride, "M");
  command
      .add_option("--turn", options.turn_deg, "Angle by which each step turns to the left [deg].")
      ->capture_default_str()
      ->type_name("DEG");
  command
      .add_option(
          "--rise", options.rise,
          "Height of a stair [m]. One step leads onto each stair, and the other foot "
          "follows onto the same stair. --steps is then the number of stairs. The stairs are "
          "added to the world of the pattern.")
      ->type_name("M");
  command.add_option("--side", options.walk.side, "Distance to the left per pair of steps [m].")
      ->capture_default_str()
      ->type_name("M");
}

void add_step(Command& command, NewOptions& options) {
  command.footer(
      "Examples:\n  ayumi new step -o in_place.json\n"
      "  ayumi new step --steps 1 --length 0.03 -o one_step.json");
  add_new_file(command, options.file);
  add_gait(command, options);
  command
      .add_option("--length", options.stride,
                  "Length of each step forward [m] (default: the robot steps in place).")
      ->type_name("M");
}

void add_sway(Command& command, NewOptions& options) {
  command.footer("Examples:\n  ayumi new sway --side 0 --forward 0.015 --cycles 3 -o sway.json");
  add_new_file(command, options.file);
  add_scaled(command, "--side", options.side, "Largest displacement to either side [m]",
             SwayParameters().side, "M");
  command
      .add_option("--forward", options.sway.forward,
                  "Largest displacement forwards and backwards [m].")
      ->capture_default_str()
      ->type_name("M");
  add_scaled(command, "--period", options.period, "Time of one cycle [s]", SwayParameters().period,
             "S");
  add_height(command, options.sway.cog_height);
  command.add_option("--cycles", options.sway.cycles, "Number of cycles.")
      ->capture_default_str()
      ->type_name("N");
}

void add_viip(Command& command, NewOptions& options) {
  command.footer(
      "Examples:\n  ayumi new viip --cog 0.02,0,0 -o shift.json\n"
      "  ayumi new viip --cog-velocity 0.03,0,0 --duration 1 -o moving.json\n"
      "  ayumi new viip --steps 8 -o in_place.json\n"
      "  ayumi new viip --steps 14 --velocity 0.1 -o walk.json\n"
      "  ayumi new viip --steps 14 --velocity 0.05,0.01 --turn 15 -o turn.json");
  add_new_file(command, options.file);
  command
      .add_option("--cog", options.cog,
                  "Displacement of the COG while both feet stay in place [m]: forward, left, up.")
      ->delimiter(',')
      ->expected(3)
      ->type_name("DX,DY,DZ");
  command
      .add_option("--cog-velocity", options.cog_velocity,
                  "Velocity of the COG while both feet stay in place [m/s]: forward, left, up.")
      ->delimiter(',')
      ->expected(3)
      ->type_name("VX,VY,VZ");
  command.add_option("--duration", options.moving, "Time for which --cog-velocity acts [s].")
      ->check(number_within(0.001, 600))
      ->capture_default_str()
      ->type_name("S");
  command
      .add_option("--steps", options.viip_steps,
                  "Number of steps. The last step brings the feet together. Without --velocity, "
                  "the robot steps in place.")
      ->check(whole_number_within(1, 10000).description(""))
      ->type_name("N");
  command
      .add_option("--velocity", options.velocity, "Velocity of the COG [m/s]: forward and left.")
      ->delimiter(',')
      ->expected(1, 2)
      ->type_name("VX,VY");
  command.add_option("--turn", options.turn_deg, "Turning rate to the left [deg/s].")
      ->type_name("W");
}

void add_squat(Command& command, NewOptions& options) {
  command.footer("Examples:\n  ayumi new squat --depth 0.04 --hold 1 --cycles 1 -o squat.json");
  add_new_file(command, options.file);
  add_scaled(command, "--depth", options.depth, "How far the COG goes down [m]",
             SquatParameters().depth, "M");
  add_scaled(command, "--period", options.period, "Time of one cycle [s]", SquatParameters().period,
             "S");
  add_scaled(command, "--hold", options.hold, "Time at the lowest point [s]",
             SquatParameters().hold, "S");
  add_height(command, options.squat.cog_height);
  command.add_option("--cycles", options.squat.cycles, "Number of cycles.")
      ->capture_default_str()
      ->type_name("N");
}

void add_which(Command& command, const char* name, const char* what, NewOptions& options) {
  command.add_option(name, options.which, std::string(what) + ".")
      ->check(one_of({"left", "right"}))
      ->capture_default_str();
}

void add_seat(Command& command, NewOptions& options) {
  add_new_file(command, options.file);
  add_scaled(command, "--depth", options.depth,
             "Difference of the COG height between standing and sitting [m]",
             SeatParameters().depth, "M");
  command
      .add_option("--lean", options.angle_deg,
                  "Lean of the trunk in the middle of the motion [deg] (default: 20).")
      ->type_name("DEG");
  add_scaled(command, "--period", options.period, "Time of the motion [s]", SeatParameters().period,
             "S");
  add_height(command, options.seat.cog_height);
}

void add_bow(Command& command, NewOptions& options) {
  command.footer("Examples:\n  ayumi new bow --angle 20 --hold 1 -o bow.json");
  add_new_file(command, options.file);
  command.add_option("--angle", options.angle_deg, "Lean of the trunk [deg] (default: 29).")
      ->type_name("DEG");
  add_scaled(command, "--period", options.period,
             "Time of the motion down and up, without the hold [s]", BowParameters().period, "S");
  add_scaled(command, "--hold", options.hold, "Time at the lowest point [s]", BowParameters().hold,
             "S");
  add_height(command, options.bow.cog_height);
}

void add_wave(Command& command, NewOptions& options) {
  command.footer("Examples:\n  ayumi new wave --hand left --cycles 5 -o wave.json");
  add_new_file(command, options.file);
  add_which(command, "--hand", "Hand that waves", options);
  command.add_option("--cycles", options.wave.cycles, "Number of waves.")
      ->capture_default_str()
      ->type_name("N");
  add_scaled(command, "--period", options.period, "Time of one wave [s]", WaveParameters().period,
             "S");
  add_height(command, options.wave.cog_height);
}

void add_kick(Command& command, NewOptions& options) {
  command.footer("Examples:\n  ayumi new kick --foot left --length 0.05 -o kick.json");
  add_new_file(command, options.file);
  add_which(command, "--foot", "Foot that kicks", options);
  add_scaled(command, "--length", options.length, "Distance that the foot moves forward [m]",
             KickParameters().length, "M");
  add_scaled(command, "--height", options.height, "Height of the foot when it kicks [m]",
             KickParameters().height, "M");
  add_scaled(command, "--period", options.period, "Time of the swing [s]", KickParameters().period,
             "S");
  add_height(command, options.kick.cog_height,
             "lower than in the home posture by a quarter of --height, or still lower if the legs "
             "are straight in the home posture");
}

void add_turn(Command& command, NewOptions& options) {
  command.footer("Examples:\n  ayumi new turn --angle -90 -o turn_right.json");
  add_new_file(command, options.file);
  command.add_option("--angle", options.angle_deg, "Turn to the left [deg] (default: 90).")
      ->type_name("DEG");
  command.add_option("--per-step", options.turn_deg, "Largest turn of a step [deg] (default: 10).")
      ->check(number_within(1.0, 34.0))
      ->type_name("DEG");
  add_scaled(command, "--period", options.period, "Time of one step [s]", WalkParameters().period,
             "S");
  add_scaled(command, "--lift", options.lift, "Height of the swinging sole [m]",
             WalkParameters().lift, "M");
  add_height(command, options.walk.cog_height);
}

// Prints one line for each kind of motion.
void list_kinds(const Context& context, const Command& command) {
  size_t width = 0;
  const auto kinds = command.all_subcommands();
  for (const auto& [name, what] : kinds) width = std::max(width, name.size());
  for (const auto& [name, what] : kinds)
    context.print(broken_at(name + std::string(width + 2 - name.size(), ' ') + what + "\n",
                            terminal_columns()));
}

}  // namespace

void add_new(Command& app, Context& context) {
  Command* command = app.add_subcommand(
      "new",
      "write a pattern to edit: walk, step, march, turn, stand, sway, squat, sit, rise, bow, wave, "
      "kick, jump, viip, excite");
  command->require_subcommand(1);
  command
      ->add_flag_callback(
          "--list",
          [command, &context] {
            list_kinds(context, *command);
            end_with_success();
          },
          "Print one line for each kind of motion.")
      ->trigger_on_parse();
  command->footer(
      "Examples:\n  ayumi new walk -o walk.json\n"
      "  ayumi new walk --steps 12 --stride 0.02 --turn 5 -o turn.json\n"
      "  ayumi new step --robot humanoid30 --steps 4 -o step.json\n"
      "  ayumi new sway --side 0.03 -o sway.json\n"
      "  ayumi new squat --depth 0.04 --cycles 3 -o squat.json\n"
      "  ayumi new jump --height 0.02 -o jump.json\n"
      "  ayumi new viip --steps 14 --velocity 0.1 -o viip_walk.json\n"
      "  ayumi new stand --duration 4 -o stand.json\n"
      "  ayumi new --list");
  auto shared = std::make_shared<NewOptions>();
  NewOptions& options = *shared;

  Command* walk = command->add_subcommand("walk", "walk from rest to rest");
  add_walk(*walk, options);
  walk->callback([shared, &context] { new_walk(context, *shared); });
  Command* step = command->add_subcommand("step", "step in place, or forward with --length");
  add_step(*step, options);
  step->callback([shared, &context] { new_step(context, *shared); });
  Command* march = command->add_subcommand("march", "step in place with high steps");
  march->footer("Examples:\n  ayumi new march --steps 6 --lift 0.03 -o march.json");
  add_new_file(*march, options.file);
  add_gait(*march, options);
  march->callback([shared, &context] { new_march(context, *shared); });
  Command* turn = command->add_subcommand("turn", "turn in place by an angle");
  add_turn(*turn, options);
  turn->callback([shared, &context] { new_turn(context, *shared); });
  Command* sway = command->add_subcommand("sway", "move the COG to and fro over both feet");
  add_sway(*sway, options);
  sway->callback([shared, &context] { new_sway(context, *shared); });
  Command* squat = command->add_subcommand("squat", "move the COG down and up over both feet");
  add_squat(*squat, options);
  squat->callback([shared, &context] { new_squat(context, *shared); });

  Command* sit = command->add_subcommand("sit", "go down as if to sit on a seat");
  sit->footer("Examples:\n  ayumi new sit --depth 0.06 -o sit.json");
  add_seat(*sit, options);
  sit->callback([shared, &context] { new_seat(context, *shared, true); });
  Command* rise = command->add_subcommand("rise", "stand up as if from a seat");
  rise->footer("Examples:\n  ayumi new rise --depth 0.06 -o rise.json");
  add_seat(*rise, options);
  rise->callback([shared, &context] { new_seat(context, *shared, false); });
  Command* bow = command->add_subcommand("bow", "lean the trunk forward and come back");
  add_bow(*bow, options);
  bow->callback([shared, &context] { new_bow(context, *shared); });
  Command* wave = command->add_subcommand("wave", "wave a hand");
  add_wave(*wave, options);
  wave->callback([shared, &context] { new_wave(context, *shared); });
  Command* kick = command->add_subcommand("kick", "kick forward with a foot");
  add_kick(*kick, options);
  kick->callback([shared, &context] { new_kick(context, *shared); });

  Command* viip = command->add_subcommand(
      "viip", "reach goals by VIIP: COG displacement, COG velocity, steps or a walk at a velocity");
  add_viip(*viip, options);
  viip->callback([shared, &context] { new_viip(context, *shared); });
  add_new_jump(*command, context);
  Command* stand = command->add_subcommand("stand", "stand on both feet");
  stand->footer("Examples:\n  ayumi new stand --duration 4 -o stand.json");
  add_new_file(*stand, options.file);
  add_height(*stand, options.stand_height);
  stand->add_option("--duration", options.duration, "Duration of the pattern [s].")
      ->capture_default_str()
      ->type_name("S");
  stand->callback([shared, &context] { new_stand(context, *shared); });
  Command* excite = command->add_subcommand(
      "excite",
      "move every joint in slow sweeps, chirps and steps; a recording of this motion is the input "
      "of ayumi identify");
  excite->footer("Examples:\n  ayumi new excite hoap1 -o excite.json");
  add_new_file(*excite, options.file);
  excite->add_option("ROBOT", options.file.robot,
                     "Robot that performs the motion. Instead, --robot can name the robot.");
  excite->add_option("--scale", options.scale, "Factor on the amplitudes of all movements.")
      ->check(number_within(0.05, 2.0))
      ->capture_default_str();
  excite
      ->add_option("--cog-height", options.low,
                   "COG height [m]; 0 = the height that Ayumi chooses for the robot.")
      ->check(number_within(0.0, 100.0))
      ->capture_default_str()
      ->type_name("M");
  excite->callback([shared, &context] { new_excite(context, *shared); });
}

}  // namespace ayumi::app
