// `ayumi new jump`: a jump as keys, and the highest jump that a profile's actuators allow.

#include <algorithm>
#include <cmath>
#include <memory>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/repair/infeasibility_report.hpp"
#include "ayumi/task/task.hpp"
#include "new_pattern.hpp"

namespace ayumi::app {

namespace {

struct JumpOptions {
  NewFile file;
  std::string profile;
  // Values that are not given are those of HOAP-1, scaled to the robot.
  std::optional<double> height, stoop, cog_height;
  double forward = 0;
  int times = 1;
  bool highest = false;
};

// What stands in the way of a jump: its worst error, or why the jump cannot be computed.
struct Obstacle {
  std::string text;  // empty if the jump passes
  double severity = 0;
};

Obstacle obstacle(const RobotModel& model, const JumpParameters& p, const std::string& profile) {
  try {
    const CommandSeries series = sample_at_servo_period(model, jump_pattern(model, p));
    CheckOptions options;
    options.profile = profile;
    const ConsistencyReport report = check_consistency(model, series, options);
    Obstacle worst;
    for (const Finding& finding : report.findings) {
      if (finding.severity != Severity::error) continue;
      const double severity = severity_of(finding);
      if (!worst.text.empty() && severity <= worst.severity) continue;
      worst = {kind_place_and_time(finding) + ": " + amount_text(finding), severity};
    }
    return worst;
  } catch (const Error& error) {
    // The jump is out of the legs' reach, or there is no push of this shape.
    if (error.code() == ErrorCode::bad_pattern || error.code() == ErrorCode::usage)
      return {error.what(), HUGE_VAL};
    throw;
  }
}

bool passes(const RobotModel& model, const JumpParameters& p, const std::string& profile) {
  return obstacle(model, p, profile).text.empty();
}

// The jump of lowest height that comes nearest to passing, among those that were tried.
struct Nearest {
  JumpParameters jump;
  std::string profile;
  Obstacle obstacle;
};

// The first profile with which the check finds no error; empty if no profile is enough.
std::string sufficient_profile(const RobotModel& model, const JumpParameters& p) {
  for (const std::string& name : model.profile_names())
    if (passes(model, p, name)) return name;
  return {};
}

// If the stoop is not given, it is the default, or the nearest stoop that some profile can carry
// out.
std::string choose_profile(const RobotModel& model, JumpParameters& p, bool stoop_open) {
  const double stoop = p.stoop;
  for (const double share : {1.0, 0.9, 1.1, 0.8, 1.2, 0.7, 1.35, 1.5}) {
    p.stoop = share * stoop;
    const std::string profile = sufficient_profile(model, p);
    if (!profile.empty()) return profile;
    if (!stoop_open) break;
  }
  p.stoop = stoop;
  return {};
}

// If no profile can carry out the default jump, searches for a lower one. The search runs over a
// grid of shares of the jump height, the stoop and the COG height, and takes the first jump that
// passes. A value that the user has given is not changed. The jump height varies first. If no jump
// passes, returns "" and leaves the values unchanged.
std::string lower_jump(const RobotModel& model, JumpParameters& p, const JumpOptions& options,
                       const Progress& progress) {
  // Shares of the height that are tried. Chosen: half the height needs 0.7 of the speed, and a jump
  // of less than a tenth is hardly a jump.
  const std::vector<double> lower = {0.75, 0.5, 0.3, 0.2, 0.1}, same = {1.0};
  const JumpParameters asked = p;
  int done = 0;
  for (const double stature : options.cog_height ? same : std::vector{1.0, 0.9})
    for (const double stoop : options.stoop ? same : std::vector{1.0, 0.4})
      for (const double height : options.height ? same : lower) {
        report(progress, {"looking for a lower jump", done++ / 20.0, ""});
        p.height = 1e-4 * std::round(1e4 * height * asked.height);
        p.cog_height = 1e-4 * std::round(1e4 * stature * asked.cog_height);
        p.stoop = 1e-4 * std::round(1e4 * stoop * asked.stoop);
        const std::string profile = sufficient_profile(model, p);
        if (!profile.empty()) return profile;
      }
  p = asked;
  return {};
}

// Resolution of the search for the highest jump [m]. Chosen: 1 % of the default height (30 mm).
constexpr double kStep = 2.5e-4;
// Height of the lowest jump that is tried [m]. Chosen: the feet leave the ground for 0.03 s.
constexpr double kLowest = 1e-3;

// The greatest height that passes, over a grid of lift-off heights and stoops as shares of the
// defaults. At each point of the grid, the search starts above the best height so far, doubles it
// while it passes, and then bisects. `nearest` becomes the lowest jump that comes nearest to
// passing.
JumpParameters highest_jump(const RobotModel& model, JumpParameters p, const std::string& profile,
                            const Progress& progress, std::optional<Nearest>& nearest) {
  const JumpParameters scaled = jump_defaults(model);
  JumpParameters best = p;
  best.height = 0;
  const std::vector<double> heights = {1.1, 1.05, 1, 0.95, 0.9, 0.86};
  const std::vector<double> stoops = {1.2, 0.9, 0.6, 0.4, 0.25, 0.15};
  int done = 0;
  for (const double share : heights)
    for (const double depth : stoops) {
      report(progress, {"looking for the highest jump", done++ / 36.0,
                        text::brief(1e3 * best.height, 3) + " mm"});
      p.cog_height = share * scaled.cog_height;
      p.stoop = depth * scaled.stoop;
      const auto good = [&](double height) {
        p.height = height;
        return passes(model, p, profile);
      };
      double low = std::max(kLowest, best.height + kStep), high = low;
      p.height = low;
      const Obstacle found = obstacle(model, p, profile);
      if (!found.text.empty()) {
        if (best.height == 0 && (!nearest || found.severity < nearest->obstacle.severity))
          nearest = Nearest{p, profile, found};
        continue;
      }
      while (high < scaled.cog_height && good(2 * high)) high = low = 2 * high;
      high = 2 * low;
      while (high - low > kStep) {
        const double middle = 0.5 * (low + high);
        (good(middle) ? low : high) = middle;
      }
      best = p;
      best.height = low;
    }
  return best;
}

// The highest jump of the first profile that has one, if no value is given. If there is none,
// returns "" and leaves the values unchanged.
std::string any_jump(const RobotModel& model, JumpParameters& p, const JumpOptions& options,
                     const Progress& progress, std::optional<Nearest>& nearest) {
  if (options.height || options.stoop || options.cog_height) return {};
  for (const std::string& name : model.profile_names()) {
    const JumpParameters best = highest_jump(model, p, name, progress, nearest);
    if (best.height <= 0) continue;
    p = best;
    return name;
  }
  return {};
}

std::string limit_text(const std::optional<Nearest>& nearest) {
  if (!nearest) return {};
  const JumpParameters& jump = nearest->jump;
  return "The jump that comes nearest rises by " + text::brief(1e3 * jump.height, 2) +
         " mm from a COG height of " + text::brief(jump.cog_height, 3) + " m with a stoop of " +
         text::brief(1e3 * jump.stoop, 2) + " mm" +
         (nearest->profile.empty() ? "" : ", with the actuators " + nearest->profile) +
         ". Its limit is " + nearest->obstacle.text;
}

std::vector<std::string> comments_of(const JumpParameters& p) {
  const std::string way = p.forward == 0 ? "in place" : text::brief(p.forward) + " m forward each";
  return {
      "Jumps " + std::to_string(p.times) + (p.times == 1 ? " time " : " times ") + way +
          ". The COG rises " + text::brief(p.height) + " m above " + text::brief(p.cog_height) +
          " m and stoops " + text::brief(p.stoop) + " m before and after.",
      "Keys: stand, stoop, lift-off, touchdown, stoop, stand. In the flight (support none) the "
      "COG follows the",
      "parabola through the keys at both ends of the flight. A longer flight is a higher jump."};
}

void new_jump(Context& context, JumpOptions options) {
  const RobotModel model = load_robot(options.file.robot, robot_search(context));
  JumpParameters p = jump_defaults(model);
  p.height = options.height.value_or(p.height);
  p.stoop = options.stoop.value_or(p.stoop);
  p.cog_height = options.cog_height.value_or(p.cog_height);
  p.forward = options.forward;
  p.times = options.times;
  std::optional<Nearest> nearest;
  if (options.highest) {
    options.profile = model.limits(options.profile).name;
    p = highest_jump(model, p, options.profile, context.progress(), nearest);
    if (p.height <= 0) {
      context.print("profile " + options.profile +
                    ": no jump of 1 mm or more passes the check, so nothing is written. " +
                    limit_text(nearest) + "\n");
      context.print_json("{\"pattern\": null}");
      context.exit_code = 1;
      return;
    }
    context.print("highest jump with profile " + options.profile + ": " +
                  text::fixed(1e3 * p.height, 1) + " mm, from a COG height of " +
                  text::fixed(p.cog_height, 3) + " m, stoop " + text::fixed(1e3 * p.stoop, 1) +
                  " mm\n");
  }
  if (options.profile.empty()) {
    options.profile = choose_profile(model, p, !options.stoop);
    jump_pattern(model, p);  // throws if values are out of range
    if (options.profile.empty()) {
      context.print("no actuator profile of " + model.name() + " is strong enough for a jump of " +
                    text::brief(p.height) + " m with a stoop of " + text::brief(p.stoop) +
                    " m and a COG height (ref z_G) of " + text::brief(p.cog_height) + " m. ");
      options.profile = lower_jump(model, p, options, context.progress());
      if (options.profile.empty())
        options.profile = any_jump(model, p, options, context.progress(), nearest);
      if (options.profile.empty())
        context.print(
            options.height || options.stoop || options.cog_height
                ? "No lower jump with the given options was found either. Choose a lower --height, "
                  "another --stoop or another --cog-height. `ayumi check` names the limits that "
                  "the jump exceeds\n"
                : "No jump of 1 mm or more passes the check, from any COG height and with "
                  "any stoop that was tried. " +
                      limit_text(nearest) + "\n");
      else
        context.print("These values were found: --height " + text::brief(p.height) +
                      " m, --stoop " + text::brief(p.stoop) + " m, --cog-height " +
                      text::brief(p.cog_height) +
                      " m. `ayumi new jump --highest` looks for the highest jump\n");
    }
  }
  Pattern pattern = jump_pattern(model, p);
  pattern.profile = options.profile;
  write_new_pattern(context, model, pattern, options.file, comments_of(p));
}

}  // namespace

void add_new_jump(Command& parent, Context& context) {
  auto shared = std::make_shared<JumpOptions>();
  JumpOptions& options = *shared;
  Command* command =
      parent.add_subcommand("jump", "jump: stoop, lift off, fly, touch down and come to rest");
  command->footer(
      "Examples:\n  ayumi new jump --height 0.02 -o jump.json\n"
      "  ayumi new jump --times 3 -o hop.json\n"
      "  ayumi new jump --forward 0.02 -o forward.json\n"
      "  ayumi new jump --highest --profile hoap1 -o highest.json");
  add_new_file(*command, options.file);
  const auto scaled = [](double hoap1) {
    return " (default: the value for HOAP-1, scaled to the size of the robot; for hoap1 " +
           text::brief(hoap1) + ").";
  };
  command
      ->add_option("--height", options.height,
                   "Height of the jump: rise of the COG after lift-off [m]" +
                       scaled(JumpParameters().height))
      ->type_name("M");
  command
      ->add_option(
          "--stoop", options.stoop,
          "Stoop: how far the COG is lowered before the jump, below its height at lift-off [m]" +
              scaled(JumpParameters().stoop))
      ->type_name("M");
  command
      ->add_option("--cog-height", options.cog_height,
                   "COG height at lift-off and touchdown (the symbol ref z_G of the paper) [m]" +
                       scaled(JumpParameters().cog_height))
      ->type_name("M");
  command->add_option("--forward", options.forward, "Distance of each jump forward [m].")
      ->capture_default_str()
      ->type_name("M");
  command->add_option("--times", options.times, "Number of jumps in a row.")
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option("--profile", options.profile,
                   "Actuator profile to write into the pattern (default: the first profile that is "
                   "strong enough).")
      ->type_name("NAME");
  command->add_flag(
      "--highest", options.highest,
      "Search for the --height, --stoop and --cog-height of the highest jump that the profile "
      "allows.");
  command->callback([shared, &context] { new_jump(context, *shared); });
}

}  // namespace ayumi::app
