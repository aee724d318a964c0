// Compares the results of this machine, bit for bit, with those that every machine should give. If
// a change is meant to change numbers, tests/update_selftest.sh writes the new hashes.

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/counted.hpp"
#include "ayumi/check/likely_mistakes.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "ayumi/repair/repair_pattern.hpp"
#include "ayumi/study/push.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "push_results.hpp"

namespace ayumi::app {

namespace {

using Json = nlohmann::ordered_json;

/// The options of the command.
struct SelftestCommand {
  std::vector<std::string> jobs;  ///< names of the jobs that run; empty for all
};

struct Job {
  const char* name;
  const char* words;
  std::string (*text)(const Context&);  ///< makes the text that is hashed
  const char* sha256;                   ///< SHA-256 of the text on every machine
};

Task bundled_task(const Context& context, const char* name) {
  PatternOptions options;
  Task task = load_pattern(context, data_folder("patterns") / name, options);
  task.threads = context.threads;
  return task;
}

/// Everything that a run of the pattern computes, without names of files.
std::string run_text(const Context& context, const char* name) {
  const Task task = bundled_task(context, name);
  SimulationLog log = simulate(task, simulate_options(task), context.progress());
  log.provenance = {};
  return plain_log_bytes(log);
}

std::string walk_text(const Context& context) { return run_text(context, "hoap1_walk.json"); }
std::string jump_text(const Context& context) { return run_text(context, "hoap1_jump.json"); }
std::string viip_text(const Context& context) { return run_text(context, "hoap1_viip_walk.json"); }

/// The other bundled patterns: hops, steps and displacements by goals of VIIP, and another robot.
std::string patterns_text(const Context& context) {
  std::string text;
  for (const char* name :
       {"hoap1_hop3.json", "hoap1_jump_forward.json", "hoap1_viip_shift.json",
        "hoap1_viip_step.json", "humanoid30_walk.json", "humanoid30_viip_shift.json",
        "humanoid30_viip_step.json", "humanoid30_viip_walk.json"})
    text += run_text(context, name);
  return text;
}

/// Four steps of a walk that turns, with a push, under a law and with noise of the sensors.
std::string pushed_text(const Context& context, const ControllerSpec& law) {
  const RobotModel robot = bundled_task(context, "hoap1_walk.json").robot;
  WalkParameters walk = walk_defaults(robot);
  walk.steps = 4;
  walk.turn = 0.1;
  Pattern pattern = walk_pattern(robot, walk);
  pattern.controller = law;
  Push push;
  push.kind = PushKind::impulse;
  push.magnitude = 1.5;
  push.direction = {0.6, -0.8, 0};
  pattern.scenario = {{.at = 1.4, .duration = 0.05, .what = push}};
  const Task task = make_task(pattern, robot, "", context.progress(), context.threads);
  SimulateOptions options = simulate_options(task);
  options.sensor_noise = true;
  return plain_log_bytes(simulate(task, options, context.progress()));
}

/// DTAD with footholds that move, and the baselines.
std::string laws_text(const Context& context) {
  std::string text = pushed_text(context, {ControllerKind::dtad, {{"step", 1.0}}});
  for (const ControllerKind law :
       {ControllerKind::preview, ControllerKind::foot_guided, ControllerKind::dcm_step})
    text += pushed_text(context, {law, {}});
  return text;
}

// The patterns of the check: short, so that the searches for causes take little time.
Pattern two_steps(const RobotModel& robot) {
  WalkParameters walk = walk_defaults(robot);
  walk.steps = 2;
  walk.cog_height = 0.23;
  return walk_pattern(robot, walk);
}
Pattern kick(const RobotModel& robot) { return kick_pattern(robot, kick_defaults(robot)); }
Pattern squat(const RobotModel& robot) { return squat_pattern(robot, squat_defaults(robot)); }
Pattern sway(const RobotModel& robot) { return sway_pattern(robot, sway_defaults(robot)); }
Pattern bow(const RobotModel& robot) { return bow_pattern(robot, bow_defaults(robot)); }
Pattern wave(const RobotModel& robot) { return wave_pattern(robot, wave_defaults(robot)); }
Pattern rise(const RobotModel& robot) { return rise_pattern(robot, seat_defaults(robot)); }
Pattern hop(const RobotModel& robot) {
  JumpParameters jump = jump_defaults(robot);
  jump.forward = 0.04;
  return jump_pattern(robot, jump);
}

// Changes of these patterns, as authors make them by mistake.
void none(Pattern&) {}
void land_too_far(Pattern& p) { p.phases[3].swing->to.position.x() += 0.1; }
void land_on_the_wrong_side(Pattern& p) { p.phases[3].swing->to.position.y() *= -1; }
void land_inside(Pattern& p) { p.phases[3].swing->to.position.y() *= 0.2; }
void lift_too_high(Pattern& p) { p.phases[1].swing->lift *= 10; }
void forget_a_swing(Pattern& p) { p.phases[3].swing.reset(); }
void stand_on_the_wrong_foot(Pattern& p) { p.phases[3].support = opposite(p.phases[3].support); }
void stand_too_high(Pattern& p) { p.cog_height *= 1.1; }
void hurry(Pattern& p) {
  for (Phase& phase : p.phases) phase.until /= 2;
  for (Keyframe& key : p.keyframes) key.t /= 2;
}
void put_the_zmp_under_the_other_foot(Pattern& p) {
  for (Keyframe& key : p.keyframes)
    if (key.t > p.phases[2].until && key.zmp && key.zmp->place != ZmpKey::Place::center) {
      key.zmp->place = opposite(key.zmp->place);
      key.zmp->point.y() *= -1;
      return;
    }
}
void bend_the_trunk_by_degrees(Pattern& p) { p.keyframes.back().torso = Eigen::Vector3d(0, 10, 0); }
void delay_a_key(Pattern& p) { p.keyframes[p.keyframes.size() / 2].t += 0.3; }
void lower_a_key(Pattern& p) {
  for (Keyframe& key : p.keyframes)
    if (key.cog_height) *key.cog_height -= 0.04;
}
void lift_a_foot_key(Pattern& p) {
  for (Keyframe& key : p.keyframes)
    for (auto& foot : key.feet)
      if (foot && foot->position.z() > 0) foot->position.z() *= 3;
}
void bend_a_joint(Pattern& p) {
  for (Keyframe& key : p.keyframes)
    for (auto& joint : key.joints) joint.second *= 2;
}

struct Checked {
  Pattern (*make)(const RobotModel&);
  void (*slip)(Pattern&);
};
const Checked kChecked[] = {{two_steps, none},
                            {two_steps, land_too_far},
                            {two_steps, land_on_the_wrong_side},
                            {two_steps, land_inside},
                            {two_steps, lift_too_high},
                            {two_steps, forget_a_swing},
                            {two_steps, stand_on_the_wrong_foot},
                            {two_steps, stand_too_high},
                            {two_steps, hurry},
                            {two_steps, put_the_zmp_under_the_other_foot},
                            {two_steps, bend_the_trunk_by_degrees},
                            {kick, none},
                            {kick, lift_a_foot_key},
                            {kick, hurry},
                            {squat, none},

                            {squat, delay_a_key},
                            {sway, none},

                            {bow, none},
                            {bow, delay_a_key},
                            {wave, none},
                            {wave, bend_a_joint},
                            {rise, none},
                            {rise, hurry},
                            {hop, none},
                            {hop, lower_a_key},
                            {hop, hurry}};

/// The findings of short patterns with and without mistakes, and their likely causes.
std::string check_text(const Context& context) {
  const RobotModel robot = bundled_task(context, "hoap1_walk.json").robot;
  std::string text;
  for (const Checked& checked : kChecked) {
    Pattern pattern = checked.make(robot);
    checked.slip(pattern);
    CheckOptions options;
    options.threads = context.threads;
    try {
      const Task task = make_task(pattern, robot, "", context.progress(), context.threads);
      options = check_options(task);
      const ConsistencyReport report = judge(task, options).report;
      text += check_json(report) + "\n";
      if (report.consistent) continue;
    } catch (const Error& error) {
      text += std::string(error.what()) + "\n";
    }
    for (const Mistake& mistake : likely_mistakes(robot, pattern, options, context.progress()))
      text += mistake.text() + "\n";
  }
  return text;
}

/// The correction of the walk after its ZMP was moved 36 mm outwards in the fifth step.
std::string repair_text(const Context& context) {
  Task task = bundled_task(context, "hoap1_walk.json");
  Pattern pattern = task.pattern;
  pattern.scenario.clear();
  for (Keyframe& key : pattern.keyframes)
    if (std::abs(key.t - 3.32) < 1e-9)
      key.zmp = ZmpKey{ZmpKey::Place::point, Eigen::Vector2d(0.12, 0.075)};
  task = make_task(pattern, task.robot, "", context.progress(), context.threads);
  RepairOptions options = preferred_options(pattern);
  options.check = check_options(task);
  const RepairResult result = repair(task.robot, pattern, task.series, options, context.progress());
  return std::string(name_of(result.status)) + "\n" + correction_text(result.correction);
}

/// The largest impulses after which the walk does not fall, standing and in a single support, from
/// two directions.
std::string push_text(const Context& context) {
  const Task task = bundled_task(context, "hoap1_walk.json");
  PushOptions push;
  push.threads = context.threads;
  push.simulate.profile = task.profile;
  push.simulate.world = task.pattern.world;
  push.controllers = {task.pattern.controller};
  push.phases = {{"standing", 0.3, true}, {"single support", 2.9, false}};
  push.directions = 2;
  push.replicas = 1;
  const std::vector<PushCase> cases =
      push_limits(task.robot, task.series, push, {}, {}, context.progress());
  return thresholds_json(cases, push.controllers).dump();
}

const std::array<Job, 8> kJobs = {{
    {"walk", "a walk with a push and DTAD", walk_text,
     "765f4dd12c70ca7772c3d3e405eb1c98eec50d5aa8ac71df575b03c731f07041"},
    {"jump", "a jump", jump_text,
     "418a63c346d3a1c34f23c2cfad2461c15fd69eaecf6c88a64168d34972fd7abd"},
    {"viip", "a walk by VIIP", viip_text,
     "fa52493fe95693c853767974824c21c30b02442dca80705bc441350188633dae"},
    {"patterns", "the other bundled patterns", patterns_text,
     "323bb4e42556ec843e7028157758c1d0364f62d716c70644e652a58b2fdb7bfe"},
    {"laws", "other control laws, with a push and noise", laws_text,
     "f6b184faadf56210c25f6de3264aea62f94b519634437e5907fea53849e40f12"},
    {"check", "findings and likely causes of patterns with mistakes", check_text,
     "b888490c81b6265e25d4cffd6123ed58dd2b740fb4f0ab6d1942dcd8f63aadf3"},
    {"repair", "a repaired walk", repair_text,
     "1fc3abdbbca1ba9965f8162b7812820465c6c5e4e11cb991a59f00eb1a1f8b86"},
    {"push", "limits of pushes", push_text,
     "f92ef0c7236b3bc0d650cdbc1efe91882256146b603508fde3cc6b4e67e704c3"},
}};

void compare(Context& context, const SelftestCommand& options) {
  Json results = Json::array();
  std::string table;
  int different = 0;
  for (const Job& job : kJobs) {
    if (!options.jobs.empty() &&
        std::find(options.jobs.begin(), options.jobs.end(), job.name) == options.jobs.end())
      continue;
    const std::string found = sha256(job.text(context));
    const bool same = found == job.sha256;
    different += !same;
    results.push_back(
        {{"job", job.name}, {"same", same}, {"sha256", found}, {"expected_sha256", job.sha256}});
    table += std::string(same ? "same       " : "different  ") + job.name + ": " + job.words + "\n";
    if (!same) table += "           SHA-256 " + found + ", expected " + job.sha256 + "\n";
  }
  table += different == 0
               ? "All results are the same as the published results, bit for bit.\n"
               : text::counted(different, "result") + (different == 1 ? " differs" : " differ") +
                     " from what was published. If the tests pass on this machine, the verdicts of "
                     "this program are still right, but its tables differ in some bytes from "
                     "the published tables. "
                     "Possible causes: the robot or the patterns belong to another version, or the "
                     "compiler or a library rounds differently. Please report this difference "
                     "together with the output of `ayumi --version`.\n";
  context.print(table);
  context.print_json(Json{{"same", different == 0}, {"results", results}}.dump(2));
  context.exit_code = different == 0 ? 0 : 1;
}

}  // namespace

void add_selftest(Command& app, Context& context) {
  Command* command = app.add_subcommand(
      "selftest", "compare the results of this machine with the published results, bit for bit");
  auto options = std::make_shared<SelftestCommand>();
  std::vector<std::string> names;
  for (const Job& job : kJobs) names.push_back(job.name);
  command->add_option("JOB", options->jobs, "Names of the jobs to run (default: all).")
      ->check(one_of(names));
  command->footer(
      "Examples:\n  ayumi selftest\n  ayumi selftest walk jump\n  ayumi selftest --json");
  command->callback([&context, options] { compare(context, *options); });
}

}  // namespace ayumi::app
