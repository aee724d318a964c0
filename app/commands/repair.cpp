// Finds the nearest consistent pattern by Ipopt. It is written as the author's file with a
// correction track.

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/likely_mistakes.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/plan/sample_plan.hpp"
#include "ayumi/repair/repair_pattern.hpp"
#include "ayumi/repair/weighted_change.hpp"
#include "ayumi/task/foothold_collisions.hpp"
#include "check_table.hpp"
#include "load_or_explain.hpp"
#include "motion_words.hpp"
#include "option_checks.hpp"
#include "parameter_search.hpp"
#include "repairing.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

struct RepairCommand {
  std::string pattern, out, trust, plot;
  std::vector<std::string> locked, weights, tolerances;
  bool baked = false, from_scratch = false;
  PatternOptions input;
  std::optional<double> margin, safety;
  RepairOptions repair;  // options that only the command line has
};

// Number of missed places of the COG in the output. Chosen: they fit on two lines.
constexpr size_t kMissedListed = 4;

constexpr const char* kPartialMark =
    "PARTIAL: the repair was stopped before its end. This pattern is not consistent.";
constexpr const char* kStoppedMark =
    "PARTIAL: the repair was stopped before its end. This pattern passes the check, but a smaller "
    "change may be enough.";

std::vector<std::string> marks(const RepairResult& result) {
  if (!result.check.consistent) return {kPartialMark};
  if (result.partial) return {kStoppedMark};
  return {};
}

// The author's text with only the correction changed. If the command line gives parameters, or if
// relative names would not be valid in another folder, a new text is written.
void write_repaired(const Context& context, const RepairCommand& options, const Task& input,
                    const RepairResult& result) {
  Pattern corrected = input.pattern;
  const bool unchanged = result.status == RepairStatus::already_consistent;
  if (!unchanged) corrected.correction = result.correction;
  if (options.baked || options.from_scratch) {
    const fs::path table = table_beside(options.out);
    refuse_overwriting(context, table);
    write_pattern_and_table(options.out,
                            baked(input.robot, corrected, result.series, table.filename().string()),
                            marks(result), input.caution);
    return;
  }
  const std::string text = read_file(options.pattern);
  std::string mark;
  for (const std::string& each : marks(result)) mark += "// " + each + "\n";
  const std::string changed = unchanged ? text : mark + with_correction(text, result.correction);
  if (options.input.set.empty() &&
      write_with_companions(context, options.pattern, options.out, changed))
    return;
  write_pattern(options.out, corrected, marks(result));
}

// The pattern's own locks in the form of --lock.
std::vector<std::string> file_locks(const RepairPreferences& wishes) {
  std::vector<std::string> words = wishes.joints;
  for (const Side side : {Side::left, Side::right})
    if (wishes.feet[static_cast<size_t>(side)])
      words.push_back(std::string("foot:") + name_of(side));
  for (const int key : wishes.keyframes) words.push_back("keyframe:" + std::to_string(key));
  for (const auto& [begin, end] : wishes.windows)
    words.push_back(text::exact(begin) + ".." + text::exact(end));
  return words;
}

std::string steering_words(const RepairCommand& options, const Pattern& pattern) {
  std::string out;
  std::vector<std::string> kept = file_locks(pattern.repair);
  kept.insert(kept.end(), options.locked.begin(), options.locked.end());
  if (!kept.empty()) out += "  locked: " + text::join(kept, ", ") + "\n";
  if (options.repair.trust != Trust::posture)
    out += std::string("  trusted quantity: ") + name_of(options.repair.trust) + "\n";
  return out;
}

const char* words_of(RepairStatus status) {
  if (status == RepairStatus::already_consistent) return "already consistent";
  return status == RepairStatus::not_converged ? "no repair was found" : name_of(status);
}

std::string smooth_words(const RepairResult& result) {
  std::vector<std::string> windows;
  for (const SmoothWindow& w : result.correction.smooth)
    windows.push_back(text::fixed(w.begin, 2) + "-" + text::fixed(w.end, 2) + " s");
  if (windows.empty()) return "";
  return "  smooth curves replace jumps and noise of the motion at " + text::join(windows, ", ") +
         "\n";
}

// Says from which start a motion was made from scratch, and which keys of the COG it misses.
std::string start_words(const Pattern& pattern, const GeneratedMotion& made) {
  std::string out = "  the motion was made from postures with the planned feet and ";
  out += made.least_sway ? "a COG that sways as little as the supports allow"
         : made.cog == PlannedCog::zmp
             ? "a COG that follows the ZMP. Only the first and the last key of the COG are used"
             : "the planned COG";
  if (made.lowered > 0)
    out += ". The COG is " + text::fixed(1e3 * made.lowered, 1) + " mm lower than " +
           (pattern.cog_height > 0 ? "\"cog_height\" of the \"defaults\" in the pattern"
                                   : "the default COG height");
  if (made.repair.iterations == 0) out += ". Nothing had to be corrected";
  out += "\n";
  const size_t named = std::min(made.missed.size(), kMissedListed);
  std::vector<std::string> places;
  for (size_t i = 0; i < named; ++i)
    places.push_back(text::fixed(1e3 * made.missed[i].off, 1) + " mm at " +
                     text::fixed(made.missed[i].t, 3) + " s");
  if (places.empty()) return out;
  out +=
      "  the COG is not at its place in the pattern: the distance is " + text::join(places, ", ");
  if (made.missed.size() > named)
    out += " and at " + text::counted(static_cast<long>(made.missed.size() - named), "more key");
  return out + ". No motion through these places was found\n";
}

std::string in_words(const RepairCommand& options, const Task& input, const GeneratedMotion& made,
                     const std::vector<Mistake>& mistakes, double wall) {
  const RobotModel& model = input.robot;
  const RepairResult& result = made.repair;
  std::string out = options.pattern + ": " +
                    (result.partial ? "stopped. The result is partial" : words_of(result.status)) +
                    "\n";
  if (result.status == RepairStatus::already_consistent)
    return out + "  nothing had to change, so " + options.out + " is a copy of the pattern\n";
  out += steering_words(options, input.pattern);
  const bool written = result.status == RepairStatus::repaired || options.repair.keep_partial;
  if (!written && result.moved.joint.size > 1e-4)
    out += "  the motion with the smallest violation is not written (--keep-partial writes it)\n";
  if (options.from_scratch) out += start_words(input.pattern, made);
  out += smooth_words(result);
  if (written)
    out += motion_words(model, result.moved, result.before, result.check) +
           cost_words(result.change) + "; ";
  else
    out += "  ";
  out += std::to_string(result.variables) + " variables, " + std::to_string(result.constraints) +
         " constraints, " + std::to_string(result.iterations) + " iterations, " +
         text::fixed(wall, 2) + " s\n";
  for (const std::string& reason : result.reasons) out += "  reason: " + reason + "\n";
  std::vector<AnswerPart> parts = {{Worth::verdict, {out}}};
  append(parts, mistake_parts(mistakes, false));
  append(parts, search_parts(mistakes));
  if (result.status == RepairStatus::repaired) append(parts, check_parts(result.check, model));
  return fitted(
      parts, room_of(kRowsWhenBad),
      "  this answer is shortened. `ayumi check --all` prints all findings of the pattern\n");
}

std::string in_words(const std::vector<PassingValues>& all) {
  std::string out;
  for (const PassingValues& values : all) {
    std::vector<std::string> words;
    for (const PassingValue& v : values)
      words.push_back(v.parameter + " = " + text::exact(v.passing) + " instead of " +
                      text::exact(v.given));
    out +=
        "  the pattern passes the check without a repair if " + text::join(words, " and ") + "\n";
  }
  return out;
}

std::string in_words(const PassingPace& pace) {
  std::string out;
  if (pace.factor > 0) {
    std::vector<std::string> windows;
    for (const auto& [begin, end] : pace.windows)
      windows.push_back(text::fixed(begin, 3) + "-" + text::fixed(end, 3) + " s");
    out += std::string("  the pattern passes the check without a repair if ") +
           (windows.size() == 1 ? "this time window lasts " : "each of these time windows lasts ") +
           text::exact(pace.factor) + " times as long: " + text::join(windows, ", ") + "\n";
  }
  if (pace.tried > 0 && pace.factor == 0 && pace.whole == 0)
    out +=
        "  more time alone is not enough: the pattern fails the check even if the keys are played "
        "up to " +
        text::brief(pace.tried) + " times more slowly\n";
  if (pace.whole > 0)
    out += "  the pattern passes the check without a repair if the whole motion lasts " +
           text::exact(pace.whole) + " times as long (`ayumi edit retime --scale " +
           text::exact(pace.whole) + "`)\n";
  return out;
}

nlohmann::ordered_json in_json(const PassingValues& values) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const PassingValue& v : values)
    json.push_back({{"name", v.parameter}, {"given", v.given}, {"passes", v.passing}});
  return json;
}

nlohmann::ordered_json in_json(const PassingPace& pace) {
  nlohmann::ordered_json json, windows = nlohmann::ordered_json::array();
  for (const auto& [begin, end] : pace.windows)
    if (pace.factor > 0) windows.push_back({begin, end});
  json["windows_s"] = windows;
  json["factor"] = pace.factor > 0 ? nlohmann::ordered_json(pace.factor) : nullptr;
  json["whole"] = pace.whole > 0 ? nlohmann::ordered_json(pace.whole) : nullptr;
  return json;
}

nlohmann::ordered_json start_json(const GeneratedMotion& made) {
  nlohmann::ordered_json missed = nlohmann::ordered_json::array();
  for (const MissedCog& place : made.missed)
    missed.push_back({{"at_s", place.t}, {"off_m", place.off}});
  return {{"cog", made.cog == PlannedCog::zmp ? "zmp" : "keys"},
          {"least_sway", made.least_sway},
          {"lowered_m", made.lowered},
          {"missed_cog", missed}};
}

// The commands that show the changes.
std::string see_words(const RepairCommand& options, const RepairResult& result) {
  if (result.status == RepairStatus::already_consistent || options.baked || options.from_scratch)
    return "";
  return "  to see the change: ayumi diff " + options.pattern + " " + options.out +
         " --plot moved.svg; ayumi preview " + options.out + " --ghost " + options.pattern +
         " -o moved.mp4\n";
}

// Loads the pattern. If it cannot even be sampled, other values of its parameters may help.
Task load(const Context& context, const RepairCommand& options) {
  try {
    return load_or_explain(context, options.pattern, options.input, options.tolerances);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_pattern) throw;
    std::vector<PassingValues> values;
    try {
      values = passing_parameters(context, options.pattern, options.input, options.tolerances);
    } catch (const Interrupted&) {
      throw;
    } catch (const Error&) {  // the file itself is at fault, as the first error says
    }
    if (values.empty()) throw;
    throw_with_more(error, "\n" + in_words(values));
  }
}

// The plan of the pattern instead of a motion, because the repair has to find out whether the legs
// can follow it.
Task load_plan(const Context& context, const RepairCommand& options) {
  Pattern pattern = read_pattern(options.pattern, read_pairs(options.input.set, "--set"));
  const std::string name = robot_of(pattern);
  RobotModel robot = load_robot(name, robot_search(context));
  const std::string& profile =
      options.input.profile.empty() ? pattern.profile : options.input.profile;
  const double tick = robot.description().servo_period;
  CommandSeries plan =
      sample_plan(robot, pattern, {.dt = tick, .threads = context.threads}, context.progress());
  std::string profile_name = robot.limits(profile).name;
  return {.pattern = std::move(pattern),
          .robot = std::move(robot),
          .robot_name = name,
          .profile = std::move(profile_name),
          .tick = tick,
          .series = std::move(plan),
          .threads = context.threads};
}

Trust trust_of(const std::string& word) {
  return word == "cog" ? Trust::cog : word == "zmp" ? Trust::zmp : Trust::posture;
}

// The pattern's preferences. The command line adds its locks to them, and its other options replace
// them.
RepairOptions repair_options(const RepairCommand& options, const Task& input) {
  RepairOptions repair = preferred_options(input.pattern);
  repair.check = check_options(input, options.tolerances);
  if (!options.trust.empty()) repair.trust = trust_of(options.trust);
  if (options.margin) repair.zmp_margin = options.margin;
  if (options.safety) repair.safety = *options.safety;
  for (const auto& [joint, factor] : read_pairs(options.weights, "--weight"))
    repair.joint_weights[joint] = factor;
  read_locks(options.locked, input.pattern, input.series.duration(), repair);
  repair.keep_partial = options.repair.keep_partial;
  repair.knot_spacing = options.repair.knot_spacing;
  repair.max_iterations = options.repair.max_iterations;
  return repair;
}

// Errors of the command line itself are refused before the pattern is sampled.
void refuse_wrong_wishes(const Context& context, const RepairCommand& options) {
  refuse_unknown_tolerances(options.tolerances);
  if (options.locked.empty() && options.weights.empty()) return;
  const Pattern pattern = read_pattern(options.pattern, read_pairs(options.input.set, "--set"));
  RepairOptions wishes;
  read_locks(options.locked, pattern, std::numeric_limits<double>::infinity(), wishes);
  const RobotModel model = load_robot(robot_of(pattern), robot_search(context));
  weight_factors(model, read_pairs(options.weights, "--weight"));
  for (const std::string& joint : wishes.locked_joints)
    if (model.find_dof(joint) < 0)
      fail(ErrorCode::usage, "--lock '" + joint + "': the robot '" + model.name() +
                                 "' has no such joint" +
                                 text::suggestion(joint, model.dof_names()));
}

int exit_code_of(const RepairResult& result) {
  if (result.partial) return 130;
  return result.status == RepairStatus::repaired ||
                 result.status == RepairStatus::already_consistent
             ? 0
             : 4;
}

// Tells a waiting user what a repair works on: after a few seconds, again when another step takes
// long, and when the repair is stopped. This is not progress, so it is also printed with -q.
class StruggleTeller {
 public:
  // Time after which the first message comes [s]. Chosen: a usual repair ends before that, and a
  // user who waits longer wants to know the reason.
  static constexpr double kSilence = 5;
  // Number of findings in a message. Chosen: one or two lines of a terminal.
  static constexpr size_t kMostNamed = 3;

  void note(const ConsistencyReport& check) {
    left_ = remaining_errors(check);
    checked_ = true;
  }

  Progress around(Progress progress) {
    return [this, progress = std::move(progress)](const ProgressEvent& event) {
      speak_up(event.stage);
      return progress(event);
    };
  }

  void say_what_is_left() const {
    say("the repair was stopped." +
        left_words("The motion already passes the check, but a smaller change may be enough"));
  }

 private:
  using Clock = std::chrono::steady_clock;

  void speak_up(const std::string& stage) {
    const Clock::time_point now = Clock::now();
    if (stage == told_stage_ || std::chrono::duration<double>(now - told_).count() < kSilence)
      return;
    told_stage_ = stage;
    told_ = now;
    say("the step '" + stage + "' takes a while." +
        left_words(
            "The motion already passes the check, and the search looks for a smaller change") +
        " Ctrl-C stops the repair");
  }

  // The findings of the last check in words; "" before the first check, and `nothing` if no error
  // is left.
  std::string left_words(const std::string& nothing) const {
    if (!checked_) return "";
    return " " + (left_.empty() ? nothing : "These errors are left: " + words()) + ".";
  }

  std::string words() const {
    const size_t named = std::min(left_.size(), kMostNamed);
    std::string out = text::join({left_.begin(), left_.begin() + static_cast<long>(named)}, "; ");
    if (left_.size() > named)
      out += " (and " + text::counted(static_cast<long>(left_.size() - named), "more error") + ")";
    return out;
  }

  static void say(const std::string& words) {
    const char* clear = isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "";
    std::fprintf(stderr, "%sayumi: %s\n", clear, text::printable(words).c_str());
  }

  std::vector<std::string> left_;
  bool checked_ = false;
  std::string told_stage_;
  Clock::time_point told_ = Clock::now();
};

// A motion that is not made from scratch has itself as the start.
GeneratedMotion repair_telling(const Task& input, const RepairOptions& wishes, bool from_scratch,
                               const Progress& progress) {
  StruggleTeller teller;
  RepairOptions options = wishes;
  options.on_check = [&teller](const ConsistencyReport& check) { teller.note(check); };
  try {
    GeneratedMotion made;
    if (from_scratch) {
      made = generate(input.robot, input.pattern, input.series, options, teller.around(progress));
    } else {
      made.repair = repair_task(input, options, teller.around(progress));
      made.start = input.series;
    }
    if (made.repair.partial) {
      teller.note(made.repair.check);
      teller.say_what_is_left();
    }
    return made;
  } catch (const Interrupted&) {
    teller.say_what_is_left();
    throw;
  }
}

void repair_pattern(Context& context, RepairCommand options) {
  if (options.pattern == "-")
    fail(ErrorCode::usage,
         "repair adds a correction to the text of the pattern, so it needs a file. Name the file "
         "of the pattern in place of -");
  refuse_overwriting(context, options.out);
  if (!options.plot.empty()) refuse_overwriting(context, options.plot);
  refuse_wrong_wishes(context, options);
  if (options.from_scratch && !options.locked.empty())
    fail(ErrorCode::usage,
         "--from-scratch makes a new motion, so there is nothing to lock. Leave --from-scratch or "
         "--lock out");
  const Task input = options.from_scratch ? load_plan(context, options) : load(context, options);
  options.repair = repair_options(options, input);
  const auto begin = std::chrono::steady_clock::now();
  const GeneratedMotion made =
      repair_telling(input, options.repair, options.from_scratch, context.progress());
  const RepairResult& result = made.repair;
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  context.exit_code = exit_code_of(result);
  const bool written = context.exit_code == 0 || options.repair.keep_partial;
  if (written) write_repaired(context, options, input, result);
  // With --from-scratch, the pattern contains only the plan of the motion, so it cannot be sampled.
  std::vector<Mistake> mistakes;
  if (context.exit_code == 4)
    mistakes = options.from_scratch ? impossible_values(input.robot, input.pattern)
                                    : likely_causes(input, check_options(input, options.tolerances),
                                                    result.before, context.progress());
  std::vector<PassingValues> values;
  // True for changes of an existing motion.
  const bool changes = context.exit_code == 4 && !options.from_scratch;
  if (changes && !input.pattern.parameters.empty())
    values = passing_parameters(context, options.pattern, options.input, options.tolerances);
  PassingPace pace;
  if (changes) pace = passing_pace(context, input, result.before, options.tolerances);
  if (!options.plot.empty() && !result.series.samples.empty())
    plot_motions(input.robot, made.start, result.series,
                 {fs::path(options.pattern).stem().string() + ", before and after its repair",
                  input.profile},
                 options.plot);
  context.print(in_words(options, input, made, mistakes, wall) + in_words(values) + in_words(pace) +
                (written ? "  written to " + options.out + "\n" + see_words(options, result)
                         : "  nothing written\n"));
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(repair_json(result));
  const bool alone = values.empty() || values.front().size() == 1;
  PassingValues singles;
  for (const PassingValues& one : values)
    if (alone) singles.insert(singles.end(), one.begin(), one.end());
  json["parameters"] = in_json(singles);
  json["parameters_together"] = in_json(alone ? PassingValues() : values.front());
  json["slower"] = in_json(pace);
  json["likely_mistakes"] = cause_texts(mistakes);
  if (options.from_scratch) json["start"] = start_json(made);
  json["wall_s"] = wall;
  json["output"] = written ? nlohmann::ordered_json(options.out) : nullptr;
  context.print_json(json.dump(2));
}

}  // namespace

void add_repair(Command& app, Context& context) {
  Command* command = app.add_subcommand("repair", "find the nearest consistent pattern");
  command->footer(
      "Examples:\n  ayumi repair walk.json -o repaired.json\n"
      "  ayumi repair walk.json -o repaired.json --lock l_elbow --lock foot:left --lock 1.2..1.8\n"
      "  ayumi repair walk.json -o repaired.json --weight r_hip_roll=10 --plot moved.svg\n"
      "  ayumi repair dense.json -o repaired.json --trust cog --baked\n"
      "To see what moved:\n"
      "  ayumi diff walk.json repaired.json --plot moved.svg\n"
      "  ayumi preview repaired.json --ghost walk.json -o moved.mp4");
  static RepairCommand options;
  command->add_option("PATTERN", options.pattern, "Pattern file.")->required();
  command->add_option("-o,--out", options.out, "Pattern file to write.")
      ->required()
      ->type_name("F");
  command
      ->add_option("--lock", options.locked,
                   "What must not change: a joint, foot:left, foot:right, keyframe:N (the first is "
                   "0), or a time window BEGIN..END [s]. May be repeated.")
      ->type_name("WHAT")
      ->allow_extra_args(false);
  command
      ->add_option("--weight", options.weights,
                   "Weight of this joint: factor on the cost of moving the joint. With 10, the "
                   "repair avoids moving the joint (default: the weight in the pattern; 1 if the "
                   "pattern has none).")
      ->type_name("JOINT=FACTOR")
      ->allow_extra_args(false);
  command
      ->add_option("--trust", options.trust,
                   "Quantity that is kept where posture, COG and ZMP disagree. The repair adapts "
                   "the other two quantities to this quantity (default: the choice in the pattern; "
                   "posture if the pattern has none).")
      ->check(one_of({"posture", "cog", "zmp"}))
      ->type_name("QUANTITY");
  command->add_flag("--baked", options.baked,
                    "Write the result as a dense table. Without this option, a correction is added "
                    "to the pattern.");
  command->add_flag(
      "--from-scratch", options.from_scratch,
      "Make a new motion from the phases, footholds, COG and ZMP of the pattern "
      "alone. The search starts from postures that inverse kinematics finds for feet and "
      "COG, and the motion is written as a dense table.");
  command->add_flag("--keep-partial", options.repair.keep_partial,
                    "After Ctrl-C or a failure, write the motion with the smallest violation.");
  command
      ->add_option("--plot", options.plot,
                   "Draw joints, COG and ZMP before and after the repair (.svg or .png).")
      ->type_name("F");
  command
      ->add_option("--margin", options.margin,
                   "Wanted distance from the ZMP to the edge of the support [m]. Where the "
                   "original motion has a smaller distance, the repair tries to reach the wanted "
                   "distance (default: 0.9 x the radius of the largest circle inside the sole).")
      ->check(number_within(RepairOptions::kZmpMargin))
      ->type_name("M");
  command
      ->add_option(
          "--safety", options.safety,
          "Weight of safety (distance from the limits) against the size of the change. With a "
          "larger weight, the repair changes more to gain safety. 0 gives the smallest change that "
          "passes the check (default: the weight in the pattern; 1 if the pattern has none).")
      ->check(number_within(RepairOptions::kSafety))
      ->type_name("FACTOR");
  command
      ->add_option("--knots", options.repair.knot_spacing,
                   "Time between the knots of the spline that describes the correction [s].")
      ->check(number_within(0.005, 1.0))
      ->type_name("S")
      ->capture_default_str();
  command
      ->add_option(
          "--max-iterations", options.repair.max_iterations,
          "Largest number of iterations in each run of the solver Ipopt. A repair runs Ipopt "
          "several times.")
      ->check(whole_number_within(RepairOptions::kMaxIterations))
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--tolerance", options.tolerances,
                   "Tolerance of one kind of finding. `ayumi check --tolerances` lists the kinds.")
      ->type_name("KIND=VALUE")
      ->allow_extra_args(false);
  add_pattern_options(*command, options.input);
  command->callback([&context] { repair_pattern(context, options); });
}

}  // namespace ayumi::app
