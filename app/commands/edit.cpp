// Edits of whole patterns: bake, mirror, retime, concat, blend, ramp, loop, alternate, key. The
// result is sampled and checked before it is written.

#include "ayumi/author/edit/edit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "ayumi/author/edit/gait_cycle.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/json/json_text.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/pattern/pattern_rewrite.hpp"
#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/study/local_retime.hpp"
#include "ayumi/study/retime.hpp"
#include "check_table.hpp"
#include "loop_words.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

namespace {

using Json = nlohmann::ordered_json;

struct EditCommand {
  std::string pattern, out;
  std::vector<std::string> patterns;  // patterns for concat and blend
  double over = 0;                    // duration of the transition [s]
  Ramps ramps;
  std::vector<std::string> tolerances;
  PatternOptions input;
  double scale = 0;
  bool to_limits = false;
  bool local = false;  // for retime, whether there is no single factor
  bool keep_pauses = false;
  double margin = -1;     // margin for retime [m]; below 0 if none was given
  bool as_table = false;  // for concat, blend and loop, whether the result is a table
  int times = 1;          // number of repetitions for loop and alternate
  bool cycle = false;     // for loop, whether two steps are cut from a walk
  bool alone = false;     // for loop, whether the beginning and end of the walk are left out
  bool open_end = false;  // for alternate, whether the end stays open
  KeyEdit key;
  double key_to = -1, key_by = 0;  // new time of a key, or its change [s]
};

// Time for which the beginning is held at the end of a loop with a transition [s]. Chosen: the
// shortest motion that can be sampled has a few ticks.
constexpr double kRest = 0.02;

struct ForceRange {
  double least = 0, most = 0;  // smallest and largest force [N]
};

ForceRange force_range(const CommandSeries& series) {
  const auto [least, most] =
      std::minmax_element(series.samples.begin(), series.samples.end(),
                          [](const auto& a, const auto& b) { return a.fz < b.fz; });
  return {least->fz, most->fz};
}

// A pattern that was read, with the text of its author.
struct Given {
  Task task;
  std::string text;
};

// An edited pattern. `text` is the text of the author with the changes; it is empty if the pattern
// is written anew.
struct Edited {
  Pattern pattern;
  std::string text;
  std::vector<std::string> lost;  ///< what of the author's text is lost, such as "3 comments"
};

// Writes the edit into the text of the pattern that was read, if this is possible. `others` are
// further patterns of which the result has values only.
Edited in_own_text(const EditCommand& options, const Given& given, const Pattern& edited,
                   double time_scale = 1, const std::vector<Given>& others = {}) {
  Edited result{edited, "", {}};
  RewriteOptions rewrite;
  rewrite.out = options.out;
  rewrite.set = read_pairs(options.input.set, "--set");
  rewrite.time_scale = time_scale;
  if (auto own = rewritten(given.text, given.task.pattern, edited, rewrite))
    result = {std::move(own->pattern), std::move(own->text), {}};
  if (result.text.empty()) {
    for (Phase& phase : result.pattern.phases) phase.pointer.clear();
    for (Keyframe& key : result.pattern.keyframes) key.pointer.clear();
  }
  const auto add_lost = [&](const Given& from, const std::string& kept) {
    for (const std::string& mark : lost_marks(from.text, kept))
      result.lost.push_back(mark + " of " + from.task.pattern.file);
  };
  add_lost(given, result.text.empty() ? pattern_text(edited) : result.text);
  // Two patterns with the same text lose the same, so it is listed once.
  std::set<std::string> told = {given.text};
  for (const Given& other : others)
    if (told.insert(other.text).second) add_lost(other, "{}");
  return result;
}

// The edited pattern, sampled and checked, then written with its table.
struct Result {
  CommandSeries series;
  ConsistencyReport report;
  std::vector<AnswerPart> check;  ///< the report of the check for people
  TableCaution caution;           ///< caution of the tables from which the result was made
};

Result check_edited(const Context& context, const EditCommand& options, const Task& input,
                    const Edited& edited) {
  Result result;
  result.caution = input.caution;
  result.series = sample(input.robot, edited.pattern, {.dt = input.series.dt}, context.progress());
  result.report =
      check_consistency(input.robot, result.series, check_options(input, options.tolerances));
  result.check = check_parts(result.report, input.robot);
  return result;
}

void write_edited(Context& context, const EditCommand& options, const Edited& edited,
                  const Result& result, const std::string& words, Json json) {
  const Pattern& pattern = edited.pattern;
  refuse_overwriting(context, options.out);
  if (pattern.table) refuse_overwriting(context, table_beside(options.out));
  if (!edited.lost.empty())
    context.print("these parts of the text are not kept in " + options.out + ": " +
                  text::join(edited.lost, ", ") + "\n");
  write_pattern_and_table(options.out, pattern, {}, result.caution, {}, edited.text);
  std::vector<AnswerPart> parts = {{Worth::verdict,
                                    {options.out + ": " + painted_verdict(result.report) + ", " +
                                     text::fixed(result.series.duration(), 2) + " s\n" + words}}};
  append(parts, result.check);
  context.print(fitted(parts, room_of(rows_for(result.report)), where_more_is(result.report)));
  json["output"] = options.out;
  json["text_kept"] = !edited.text.empty();
  json["lost"] = edited.lost;
  json["table"] = pattern.table ? Json(table_beside(options.out).string()) : Json(nullptr);
  json["duration_s"] = result.series.duration();
  json["check"] = Json::parse(check_json(result.report));
  context.print_json(json.dump(2));
  context.exit_code = result.report.consistent ? 0 : 1;
}

Given load_text(const Context& context, const EditCommand& options, const std::string& file) {
  std::string text;
  Task task = load_pattern(context, file, options.input, false, &text);
  return {std::move(task), std::move(text)};
}

Given load(const Context& context, const EditCommand& options) {
  refuse_unknown_tolerances(options.tolerances);
  refuse_overwriting(context, options.out);
  return load_text(context, options, options.pattern);
}

void bake(Context& context, const EditCommand& options) {
  const Given given = load(context, options);
  const Task& input = given.task;
  const Edited edited = in_own_text(
      options, given,
      baked(input.robot, input.pattern, input.series, table_beside(options.out).string()));
  write_edited(context, options, edited, check_edited(context, options, input, edited), "",
               Json{{"rows", input.series.samples.size()}});
}

// The lines of a pattern's text that name a side by words that no edit changes, from line `first`
// to line `last`.
std::vector<int> unchanged_sides(const RobotModel& robot, const std::string& text, int first = 1,
                                 int last = std::numeric_limits<int>::max()) {
  const MirrorMap map = mirror_map(robot);
  std::set<std::string> sided;
  for (size_t dof = 0; dof < map.dof.size(); ++dof)
    if (map.dof[dof] != static_cast<int>(dof)) sided.insert(robot.dofs()[dof].name);
  std::vector<int> lines = lines_with_sides(text, sided);
  std::erase_if(lines, [&](int line) { return line < first || line > last; });
  return lines;
}

std::string sides_in_words(const std::string& file, const std::vector<int>& lines) {
  if (lines.empty()) return "";
  std::vector<std::string> numbers;
  for (const int line : lines) numbers.push_back(std::to_string(line));
  return std::string("  comments and names are not mirrored. They name a side in line") +
         (lines.size() == 1 ? " " : "s ") + text::join(numbers, ", ") + " of " + file + "\n";
}

void mirror(Context& context, const EditCommand& options) {
  const Given given = load(context, options);
  const Task& input = given.task;
  const Edited edited = in_own_text(options, given, mirrored(input.robot, input.pattern));
  // A pattern that is written anew has only its names, and no comments.
  const bool kept = !edited.text.empty();
  const std::vector<int> sides =
      unchanged_sides(input.robot, kept ? given.text : pattern_text(edited.pattern));
  write_edited(context, options, edited, check_edited(context, options, input, edited),
               sides_in_words(kept ? input.pattern.file : options.out, sides),
               Json{{"sides_not_mirrored", sides}});
}

std::string in_words(double scale, const ConsistencyReport& before, const ForceRange& force_before,
                     const Result& after, const FastestPace* pace) {
  const ForceRange force = force_range(after.series);
  const auto mm = [](double metres) { return text::fixed(1e3 * metres, 1); };
  const auto newtons = [](const ForceRange& f) {
    return text::fixed(f.least, 1) + " to " + text::fixed(f.most, 1) + " N";
  };
  std::string out = "  the motion takes " + text::brief(scale) + " times its original time\n";
  if (pace)
    out += pace->bounded ? "  a faster pace fails: " + pace->limited_by + "\n"
                         : "  even the fastest pace that was tried passes the check\n";
  return out + "  ZMP margin " + mm(before.summary[FindingKind::support_margin]) + " mm before, " +
         mm(after.report.summary[FindingKind::support_margin]) +
         " mm after\n  range of f_z: " + newtons(force_before) + " before, " + newtons(force) +
         " after\n";
}

Json in_json(double scale, const ConsistencyReport& before, const ForceRange& force_before,
             const Result& after, const FastestPace* pace) {
  const ForceRange force = force_range(after.series);
  Json json = {{"scale", scale}};
  if (pace) json["limited_by"] = pace->bounded ? Json(pace->limited_by) : Json(nullptr);
  json["zmp_margin_m"] = {{"before", before.summary[FindingKind::support_margin]},
                          {"after", after.report.summary[FindingKind::support_margin]}};
  json["fz_N"] = {{"before", {force_before.least, force_before.most}},
                  {"after", {force.least, force.most}}};
  return json;
}

FastestPace limits_of(const Context& context, const EditCommand& options, const Task& input) {
  RetimeOptions retime;
  retime.check = check_options(input, options.tolerances);
  retime.dt = input.series.dt;
  FastestPace pace = fastest_pace(input.robot, input.pattern, retime, context.progress());
  if (pace.by_posture)
    fail(ErrorCode::solver, {options.pattern},
         "the check fails at every pace. First error: " + pace.limited_by +
             ". Another pace cannot help, because a posture of the table is wrong. Try "
             "`ayumi repair`");
  if (!pace.found)
    fail(ErrorCode::solver, {options.pattern},
         "no time scale up to " + text::brief(retime.slowest) + " passes the check. First error: " +
             pace.limited_by + ". More time alone is not enough. Try `ayumi repair`");
  return pace;
}

// The limits of a pace in words for people: "support 61 %, speed 20 %".
std::string in_words(const std::vector<BindingLimit>& limits) {
  std::string out;
  for (const BindingLimit& limit : limits) {
    const std::string percent = text::fixed(100 * limit.share, 0);
    if (percent == "0") continue;
    const std::string name = limit.limit.empty()      ? "no limit"
                             : limit.limit == "pace"  ? "largest pace"
                             : limit.limit == "pause" ? "kept pause"
                                                      : limit.limit;
    out += (out.empty() ? "" : ", ") + name + " " + percent + " %";
  }
  return out;
}

// The timing of a local retime in words for people.
std::string in_words(const LocalPace& pace, bool pauses_kept) {
  std::string out = "  the motion takes " + text::brief(pace.scale) + " times its original time\n";
  if (pace.uniform)
    out += std::string("  the result has a uniform pace") +
           (pauses_kept ? ", and its pauses keep their length. Reason: " : ", because ") +
           "the robot falls in open loop with the local timings that were tried\n";
  else
    out += "  share of the time in which each limit decides the pace: " + in_words(pace.binding) +
           "\n";
  if (!pace.stands.value_or(true))
    out +=
        "  caution: in open loop, the robot falls with this timing. It stands with the uniform "
        "pace, but the motion with the uniform pace does not pass the check\n";
  if (!pace.not_simulated.empty())
    out +=
        "  caution: this timing was not simulated, so it is not known whether the robot stands. "
        "Reason: " +
        pace.not_simulated + "\n";
  return out;
}

void retime_locally(Context& context, const EditCommand& options, const Given& given) {
  const Task& input = given.task;
  LocalRetimeOptions local;
  local.path.check = check_options(input, options.tolerances);
  // A margin that the user chose is kept, so the motion is not simulated.
  if (options.margin >= 0)
    local.path.most_margin = options.margin;
  else
    local.world = input.pattern.world;
  local.keep_pauses = options.keep_pauses;
  local.dt = input.series.dt;
  const LocalPace pace = fastest_local_pace(
      input.robot, input.pattern, table_beside(options.out).string(), local, context.progress());
  if (!pace.found)
    fail(ErrorCode::solver, {options.pattern},
         "the check fails with every timing of this motion. First error: " + pace.limited_by +
             (pace.by_posture ? ". Another timing cannot help, because a posture is wrong"
                              : ". More time alone is not enough") +
             ". Try `ayumi repair`");
  const Edited edited =
      in_own_text(options, given, pace.pattern, pace.uniform ? pace.path_scale : 1);
  const Result result = check_edited(context, options, input, edited);
  const ForceRange force = force_range(result.series);
  Json limits = Json::array();
  for (const BindingLimit& limit : pace.binding)
    limits.push_back({{"limit", limit.limit.empty() ? Json(nullptr) : Json(limit.limit)},
                      {"share", limit.share}});
  write_edited(
      context, options, edited, result, in_words(pace, options.keep_pauses),
      Json{{"scale", pace.scale},
           {"path_scale", pace.path_scale},
           {"rounds", pace.rounds},
           {"limited_by", limits},
           {"uniform", pace.uniform},
           {"stands_as_uniform", pace.stands ? Json(*pace.stands) : Json(nullptr)},
           {"zmp_margin_m", {{"after", result.report.summary[FindingKind::support_margin]}}},
           {"fz_N", {{"after", {force.least, force.most}}}}});
}

void retime(Context& context, const EditCommand& options) {
  if (options.to_limits == (options.scale != 0))
    fail(ErrorCode::usage, "edit retime: give either --scale S or --to-limits");
  if (options.local && !options.to_limits)
    fail(ErrorCode::usage,
         "edit retime: --local works only together with --to-limits. Add --to-limits, or leave "
         "--local out");
  if (options.margin >= 0 && !options.local)
    fail(ErrorCode::usage,
         "edit retime: --margin works only together with --to-limits --local. Add both, or leave "
         "--margin out");
  if (options.keep_pauses && !options.local)
    fail(ErrorCode::usage,
         "edit retime: --keep-pauses works only together with --to-limits --local. Add both, or "
         "leave --keep-pauses out");
  const Given given = load(context, options);
  const Task& input = given.task;
  if (options.local) return retime_locally(context, options, given);
  const ConsistencyReport before =
      check_consistency(input.robot, input.series, check_options(input, options.tolerances));
  FastestPace pace;
  if (options.to_limits) pace = limits_of(context, options, input);
  const double scale = options.to_limits ? pace.scale : options.scale;
  const Edited edited =
      in_own_text(options, given, retimed(input.robot, input.pattern, scale), scale);
  const Result result = check_edited(context, options, input, edited);
  const ForceRange force = force_range(input.series);
  const FastestPace* const found = options.to_limits ? &pace : nullptr;
  write_edited(context, options, edited, result, in_words(scale, before, force, result, found),
               in_json(scale, before, force, result, found));
}

// A pattern and its samples.
struct Sampled {
  Pattern pattern;
  CommandSeries series;

  MotionPart part() const { return {pattern, series}; }
};

Sampled sampled(const Context& context, const Task& task, Pattern pattern) {
  CommandSeries series = sample(task.robot, pattern, {.dt = task.series.dt}, context.progress());
  return {std::move(pattern), std::move(series)};
}

// Two motions in sequence. The result has keys if keys can express the motion and it is as
// consistent with them; otherwise it is a table. `reason` receives the reason for a table. Robot
// and tolerances are those of `task`.
Sampled joined_motion(const Context& context, const EditCommand& options, const Task& task,
                      const MotionPart& first, const MotionPart& second, double over,
                      std::string& reason) {
  const auto with_table = [&] {
    return sampled(context, task,
                   joined(task.robot, first, second, over, table_beside(options.out).string()));
  };
  if (options.as_table) return with_table();
  try {
    Sampled keyed = sampled(context, task, chained(task.robot, first, second, over));
    const CheckOptions check = check_options(task, options.tolerances);
    if (check_consistency(task.robot, keyed.series, check).consistent) return keyed;
    Sampled tabled = with_table();
    if (!check_consistency(task.robot, tabled.series, check).consistent) return keyed;
    reason = "the joined motion passes the check as a table, but would fail the check with keys";
    return tabled;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_pattern) throw;
    Sampled tabled = with_table();  // throws the reason if samples cannot be joined either
    reason = error.what();
    return tabled;
  }
}

void replace_motion(Task& task, Sampled motion) {
  task.pattern = std::move(motion.pattern);
  task.series = std::move(motion.series);
}

// The motion `times` times. join(a, b) is b after a. Each join samples the whole motion, so the
// motion is doubled again and again: then the time is proportional to the length of the result.
template <typename Join>
Sampled repeated(Sampled power, int times, const Join& join) {
  std::optional<Sampled> result;
  for (int left = times;; power = join(power, power)) {
    if (left % 2 == 1) result = result ? join(*result, power) : power;
    left /= 2;
    if (left == 0) return *std::move(result);
  }
}

std::string kept_words(const Pattern& pattern, const std::string& reason) {
  if (!pattern.table) return "  the result keeps the keyframes of the joined motions\n";
  return reason.empty() ? "" : "  written as a table, because " + reason + "\n";
}

// Joins patterns one after the other. The table of the part that is already joined is only in
// memory.
void join(Context& context, const EditCommand& options) {
  if (options.patterns.size() < 2)
    fail(ErrorCode::usage,
         "edit concat, edit blend: give at least two patterns, in the order in which they are "
         "played");
  refuse_overwriting(context, options.out);
  const Given given = load_text(context, options, options.patterns.front());
  Task input = given.task;
  std::vector<Given> others;
  Json joins = Json::array();
  std::string reason;
  for (size_t i = 1; i < options.patterns.size(); ++i) {
    const Task& next = others.emplace_back(load_text(context, options, options.patterns[i])).task;
    if (next.robot.description().sha256 != input.robot.description().sha256)
      fail(ErrorCode::bad_pattern, {options.patterns[i], "/robot"},
           "the robot is '" + next.pattern.robot + "', but the robot of " +
               options.patterns.front() + " is '" + input.pattern.robot +
               "'. Give patterns of the same robot");
    joins.push_back(input.series.duration());
    add_caution(input.caution, next.caution);
    replace_motion(input, joined_motion(context, options, input, {input.pattern, input.series},
                                        {next.pattern, next.series}, options.over, reason));
  }
  const Edited edited = in_own_text(options, given, input.pattern, 1, others);
  write_edited(context, options, edited, check_edited(context, options, input, edited),
               kept_words(input.pattern, reason),
               Json{{"joins_s", joins}, {"keys_kept", !input.pattern.table}});
}

// Among all cycles of two steps of a walk, the one whose end fits its beginning best.
GaitCycle best_cycle(const RobotModel& robot, const MotionPart& walk) {
  GaitCycle best = gait_cycle(robot, walk, 0);  // throws if there is none
  const auto swings = std::count_if(walk.pattern.phases.begin(), walk.pattern.phases.end(),
                                    [](const Phase& phase) { return phase.swing.has_value(); });
  const auto open = [](const LoopGap& gap) {
    return std::max({gap.feet, gap.base, gap.posture, gap.rate});
  };
  for (int swing = 1; swing + 3 <= swings; ++swing) {
    const GaitCycle cycle = gait_cycle(robot, walk, swing);
    if (open(cycle.gap) < open(best.gap)) best = cycle;
  }
  return best;
}

// Repeats two steps from the middle of a walk. With `alone`, the motion begins and ends while the
// robot walks.
void loop_cycle(Context& context, const EditCommand& options) {
  if (options.over > 0)
    fail(ErrorCode::usage,
         "edit loop: --cycle repeats steps without a stop, so there is no transition. Leave --over "
         "out");
  const Given given = load(context, options);
  const Task& input = given.task;
  const MotionPart walk{input.pattern, input.series};
  const GaitCycle cycle = best_cycle(input.robot, walk);
  if (!cycle.gap.closed)
    fail(ErrorCode::bad_pattern, {options.pattern},
         "the best cycle of two steps begins at " +
             text::fixed(static_cast<double>(cycle.begin) * input.series.dt, 3) +
             " s, and its end does not meet its beginning. The differences are: " +
             gap_and_limits(cycle.gap) +
             ". Take a walk that has more steps, all of the same length and period");
  const std::string table = table_beside(options.out).string();
  const CommandSeries closed = with_closed_cycle(input.series, cycle);
  const auto part = [&](long first, long last) {
    return cut(input.robot, {input.pattern, closed}, first, last, table);
  };
  const auto join = [&](const Sampled& a, const Sampled& b) {
    return sampled(context, input, joined(input.robot, a.part(), b.part(), 0, table));
  };
  Sampled motion =
      repeated(sampled(context, input, part(cycle.begin, cycle.end)), options.times, join);
  if (!options.alone) {
    const long last = static_cast<long>(input.series.samples.size()) - 1;
    motion = join(sampled(context, input, part(0, cycle.begin)), motion);
    motion = join(motion, sampled(context, input, part(cycle.end, last)));
  }
  const double dt = input.series.dt;
  const double begin = static_cast<double>(cycle.begin) * dt;
  const double end = static_cast<double>(cycle.end) * dt;
  const Edited edited = in_own_text(options, given, motion.pattern);
  write_edited(
      context, options, edited, check_edited(context, options, input, edited),
      "  the cycle is from " + text::fixed(begin, 3) + " to " + text::fixed(end, 3) +
          " s of the walk, and the " + name_of(cycle.first) +
          " foot swings first. Differences between the end and the beginning of the cycle: " +
          gap_words(cycle.gap) + "\n" +
          (!options.alone ? "" : "  the motion begins and ends while the robot walks\n"),
      Json{{"times", options.times},
           {"cycle_s", {begin, end}},
           {"first_swing", name_of(cycle.first)},
           {"displacement_m", {cycle.displacement.x(), cycle.displacement.y()}},
           {"turn_rad", cycle.turn},
           {"gap", gap_json(cycle.gap)},
           {"keys_kept", false}});
}

// Makes the end equal to the beginning, by a transition if they differ, and repeats the motion.
void loop(Context& context, const EditCommand& options) {
  if (options.alone && !options.cycle)
    fail(ErrorCode::usage,
         "edit loop: --alone works only together with --cycle. Add --cycle, or leave --alone out");
  if (options.cycle) return loop_cycle(context, options);
  const Given given = load(context, options);
  Task input = given.task;
  const LoopGap before = loop_gap(input.robot, {input.pattern, input.series});
  std::string reason;
  const Pattern once = input.pattern;
  const CommandSeries samples = input.series;
  if (!before.closed) {
    if (options.over <= 0)
      fail(ErrorCode::bad_pattern, {options.pattern},
           "the end of the motion differs from its beginning: " + gap_and_limits(before) +
               ". --over S adds a transition of S seconds from the end to the beginning");
    // The first samples again, at rest: the beginning is held for a moment.
    Pattern still = once;
    still.phases = {Phase{kRest, Support::both, {}, {}, {}}};
    Keyframe begin;
    begin.place.inside = "start";
    for (const Keyframe& key : once.keyframes) {
      if (key.t == 0) begin = key;
      // Tracks that only have later keys begin with the value that they have without a key.
      if (key.zmp && !begin.zmp) begin.zmp = ZmpKey{ZmpKey::Place::center, {}};
      if (key.cog_x && !begin.cog_x) begin.cog_x = samples.samples.front().cog.x();
      if (key.cog_y && !begin.cog_y) begin.cog_y = samples.samples.front().cog.y();
      if (key.torso && !begin.torso) begin.torso = Eigen::Vector3d::Zero();
    }
    still.keyframes = {begin};
    still.scenario.clear();
    CommandSeries held = samples;
    held.samples.assign(static_cast<size_t>(std::lround(kRest / samples.dt)) + 1,
                        samples.samples.front());
    held.viip.clear();
    if (samples.samples.front().state.dtheta.cwiseAbs().maxCoeff() > 1e-9)
      fail(ErrorCode::bad_pattern, {options.pattern},
           "joints move when the motion begins, so no transition can lead to its beginning. "
           "Let the motion begin at rest (edit ramp --in)");
    replace_motion(input, joined_motion(context, options, input, {input.pattern, input.series},
                                        {still, held}, options.over, reason));
  }
  const LoopGap closed = loop_gap(input.robot, {input.pattern, input.series});
  if (!closed.closed)
    fail(ErrorCode::bad_pattern, {options.pattern},
         "the end of the motion still differs from its beginning: " + gap_and_limits(closed) +
             ". `ayumi edit bake` and `ayumi edit ramp` can bring both ends to rest in one "
             "posture");
  const auto join = [&](const Sampled& a, const Sampled& b) {
    return joined_motion(context, options, input, a.part(), b.part(), 0, reason);
  };
  replace_motion(input, repeated({input.pattern, input.series}, options.times, join));
  const Edited edited = in_own_text(options, given, input.pattern);
  write_edited(context, options, edited, check_edited(context, options, input, edited),
               std::string("  the motion ends as it begins") +
                   (before.closed ? "" : ", because a transition was added") +
                   ". Remaining differences: " + gap_words(closed) + "\n" +
                   (options.times > 1 || !before.closed ? kept_words(input.pattern, reason) : ""),
               Json{{"times", options.times},
                    {"closed_by_transition", !before.closed},
                    {"before", gap_json(before)},
                    {"gap", gap_json(closed)},
                    {"keys_kept", !input.pattern.table}});
}

void alternate(Context& context, const EditCommand& options) {
  const Given given = load(context, options);
  const Task& input = given.task;
  const Edited edited = in_own_text(
      options, given, alternated(input.robot, input.pattern, options.times, !options.open_end));
  write_edited(context, options, edited, check_edited(context, options, input, edited), "",
               Json{{"times", options.times}});
}

void edit_key(Context& context, const EditCommand& options) {
  KeyEdit key = options.key;
  if (options.key_to >= 0 && options.key_by != 0)
    fail(ErrorCode::usage, "edit key: give either --to T or --by S");
  if (options.key_to >= 0) key.to = options.key_to;
  if (options.key_by != 0) key.to = key.at + options.key_by;
  if (!key.to && !key.mirror)
    fail(ErrorCode::usage,
         "edit key: no change of the keyframe is given. Move the keyframe with --to T or --by S. "
         "Add --copy to move a copy of the keyframe. --mirror exchanges left and right");
  if (key.copy && !key.to)
    fail(ErrorCode::usage, "edit key: --copy needs the time of the copy. Give --to T or --by S");
  const Given given = load(context, options);
  const Task& input = given.task;
  const Edited edited =
      in_own_text(options, given, with_key_edited(input.robot, input.pattern, key));
  // A copy, and a pattern that is written anew, have no comments.
  std::vector<int> sides;
  if (key.mirror && !key.copy && !edited.text.empty()) {
    const auto moved =
        std::min_element(input.pattern.keyframes.begin(), input.pattern.keyframes.end(),
                         [&](const Keyframe& a, const Keyframe& b) {
                           return std::abs(a.t - key.at) < std::abs(b.t - key.at);
                         });
    if (const auto at = find_value(given.text, moved->pointer))
      sides = unchanged_sides(input.robot, given.text, line_at(given.text, at->begin),
                              line_at(given.text, at->end));
  }
  write_edited(context, options, edited, check_edited(context, options, input, edited),
               sides_in_words(input.pattern.file, sides),
               Json{{"at_s", key.at},
                    {"to_s", key.to ? Json(*key.to) : Json(nullptr)},
                    {"copy", key.copy},
                    {"mirror", key.mirror},
                    {"sides_not_mirrored", sides}});
}

void ramp(Context& context, const EditCommand& options) {
  if (options.ramps.in <= 0 && options.ramps.out <= 0)
    fail(ErrorCode::usage,
         "edit ramp: both --in and --back are 0. Set at least one of them above 0 s");
  const Given given = load(context, options);
  const Task& input = given.task;
  const Edited edited = in_own_text(options, given,
                                    ramped(input.robot, {input.pattern, input.series},
                                           options.ramps, table_beside(options.out).string()));
  write_edited(context, options, edited, check_edited(context, options, input, edited), "",
               Json{{"in_s", options.ramps.in}, {"out_s", options.ramps.out}});
}

void add_edit_options(Command& command, EditCommand& options) {
  command.add_option("-o,--out", options.out, "Pattern file to write.")->required()->type_name("F");
  command
      .add_option("--tolerance", options.tolerances,
                  "Tolerance of one kind of finding. `ayumi check --tolerances` lists the kinds.")
      ->type_name("KIND=VALUE")
      ->allow_extra_args(false);
  add_pattern_options(command, options.input);
}

Command& add_join_of(Command& parent, const std::string& name, const std::string& what,
                     EditCommand& options) {
  Command* command = parent.add_subcommand(name, what);
  command->add_option("PATTERN", options.patterns, "Pattern files, in their order.")->required();
  add_edit_options(*command, options);
  return *command;
}

Command& add_edit_of(Command& parent, const std::string& name, const std::string& what,
                     EditCommand& options) {
  Command* command = parent.add_subcommand(name, what);
  command->add_option("PATTERN", options.pattern, "Pattern file.")->required();
  add_edit_options(*command, options);
  return *command;
}

}  // namespace

void add_edit(Command& app, Context& context) {
  Command* command = app.add_subcommand(
      "edit",
      "change a whole pattern and check the result: bake, mirror, retime, concat, blend, "
      "ramp, loop, alternate, key");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n  ayumi edit mirror walk.json -o mirrored.json\n"
      "  ayumi edit retime walk.json --scale 1.25 -o slower.json\n"
      "  ayumi edit retime walk.json --to-limits -o fastest.json\n"
      "  ayumi edit retime walk.json --to-limits --local -o quicker.json\n"
      "  ayumi edit bake walk.json -o baked.json\n"
      "  ayumi edit concat step.json walk.json -o both.json\n"
      "  ayumi edit blend squat.json sway.json --over 0.8 -o both.json\n"
      "  ayumi edit ramp imported.json --in 1.5 --back 1.5 -o from_home.json\n"
      "  ayumi edit loop squat.json --times 3 -o squats.json\n"
      "  ayumi edit loop walk.json --cycle --times 4 -o longer_walk.json\n"
      "  ayumi edit alternate step.json --times 6 -o walk.json\n"
      "  ayumi edit key wave.json --at 1.5 --to 3.5 --copy --mirror -o both_arms.json");
  static EditCommand options;
  add_edit_of(*command, "bake",
              "write the motion as a dense table of joint angles, COG, ZMP, f_z and base", options)
      .callback([&context] { bake(context, options); });
  add_edit_of(*command, "mirror", "exchange left and right", options).callback([&context] {
    mirror(context, options);
  });
  const auto add_table_flag = [](Command& of) {
    of.add_flag("--table", options.as_table,
                "Write the result as a table of samples, even if the keys of the patterns could be "
                "kept.");
  };
  Command& concat_command =
      add_join_of(*command, "concat", "play one pattern after the other, without a pause", options);
  add_table_flag(concat_command);
  concat_command.callback([&context] { join(context, options); });
  Command& blend_command =
      add_join_of(*command, "blend",
                  "play one pattern after the other, with a transition between them", options);
  blend_command.add_option("--over", options.over, "Duration of the transition [s].")
      ->required()
      ->check(number_within(0.02, 60.0))
      ->type_name("S");
  add_table_flag(blend_command);
  blend_command.callback([&context] { join(context, options); });
  Command& ramp_command = add_edit_of(
      *command, "ramp", "add a move from a posture to the motion, and a move back after the motion",
      options);
  ramp_command
      .add_option("--in", options.ramps.in,
                  "Time to move from the posture to the motion [s]; 0 = none.")
      ->check(number_within(0.0, 60.0))
      ->type_name("S")
      ->capture_default_str();
  ramp_command
      .add_option("--back", options.ramps.out, "Time to move back to the posture [s]; 0 = none.")
      ->check(number_within(0.0, 60.0))
      ->type_name("S")
      ->capture_default_str();
  ramp_command
      .add_option(
          "--posture", options.ramps.posture,
          "Posture at the beginning and at the end: a posture of the pattern or of the robot.")
      ->type_name("NAME")
      ->capture_default_str();
  ramp_command.callback([&context] { ramp(context, options); });
  Command& retime_command =
      add_edit_of(*command, "retime", "play the same motion faster or more slowly", options);
  retime_command
      .add_option("--scale", options.scale, "Factor on the time: 0.8 is faster, 1.25 is slower.")
      ->check(number_within(0.01, 100.0))
      ->type_name("S");
  retime_command.add_flag("--to-limits", options.to_limits,
                          "Find the smallest scale (the fastest motion) that passes the check.");
  retime_command.add_flag("--local", options.local,
                          "With --to-limits: play each part of the motion as fast as the limits "
                          "allow there, in place of one scale for the whole motion.");
  retime_command
      .add_option(
          "--margin", options.margin,
          "With --local: largest distance that the ZMP must keep from the edge of the support [m]. "
          "A smaller value allows a faster motion. Without this option, the ZMP keeps at each "
          "place of the motion the larger of two distances: an eighth of the sole's width, and 80 "
          "% of the distance at this place in the motion that --to-limits finds without --local.")
      ->check(number_within(LocalRetimeOptions::kMostMargin))
      ->type_name("M");
  retime_command.add_flag("--keep-pauses", options.keep_pauses,
                          "With --local: time spans in which nothing moves keep their duration.");
  retime_command.callback([&context] { retime(context, options); });
  Command& loop_command =
      add_edit_of(*command, "loop", "repeat a motion that ends as it begins", options);
  loop_command
      .add_option(
          "--times", options.times,
          "How many times the motion is played. With --cycle: how many times the two steps come.")
      ->check(whole_number_within(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  loop_command
      .add_option("--over", options.over,
                  "Duration of a transition from the end to the beginning [s]. The transition is "
                  "added only if the motion does not end in the posture in which it begins.")
      ->check(number_within(0.02, 60.0))
      ->type_name("S");
  loop_command.add_flag("--cycle", options.cycle,
                        "Repeat two steps in the middle of a walk, without a stop.");
  loop_command.add_flag(
      "--alone", options.alone,
      "With --cycle: write the repeated steps only, without the beginning and the end of "
      "the walk.");
  add_table_flag(loop_command);
  loop_command.callback([&context] { loop(context, options); });
  Command& alternate_command =
      add_edit_of(*command, "alternate", "make a walk from one step and its mirror image", options);
  alternate_command.add_option("--times", options.times, "Total number of steps.")
      ->required()
      ->check(whole_number_within(2, 1000))
      ->type_name("N");
  alternate_command.add_flag(
      "--open", options.open_end,
      "Let the last step be as long as the others, so that the feet do not end side by side.");
  alternate_command.callback([&context] { alternate(context, options); });
  Command& key_command =
      add_edit_of(*command, "key", "copy, move or mirror a single keyframe", options);
  key_command.add_option("--at", options.key.at, "Time of the keyframe [s].")
      ->required()
      ->check(number_within(0.0, 1e6))
      ->type_name("T");
  key_command.add_option("--to", options.key_to, "New time of the keyframe [s].")
      ->check(number_within(0.0, 1e6))
      ->type_name("T");
  key_command
      .add_option("--by", options.key_by,
                  "Time by which the keyframe is moved [s]. A negative value moves the keyframe to "
                  "an earlier time.")
      ->check(number_within(-1e6, 1e6))
      ->type_name("S");
  key_command.add_flag("--copy", options.key.copy,
                       "Keep the keyframe at its old time, and move a copy of the keyframe.");
  key_command.add_flag("--mirror", options.key.mirror,
                       "Exchange left and right in the keyframe at its new time.");
  key_command.callback([&context] { edit_key(context, options); });
}

}  // namespace ayumi::app
