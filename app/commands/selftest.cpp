// Compares the results of this machine, bit for bit, with those that every machine should give. If
// a change is meant to change numbers, tests/update_selftest.sh writes the new hashes.

#include <array>
#include <nlohmann/json.hpp>

#include "ayumi/base/counted.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "ayumi/repair/repair_pattern.hpp"
#include "ayumi/study/push.hpp"
#include "pattern_input.hpp"
#include "push_results.hpp"

namespace ayumi::app {

namespace {

using Json = nlohmann::ordered_json;

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

const std::array<Job, 5> kJobs = {{
    {"walk", "a walk with a push and DTAD", walk_text,
     "765f4dd12c70ca7772c3d3e405eb1c98eec50d5aa8ac71df575b03c731f07041"},
    {"jump", "a jump", jump_text,
     "418a63c346d3a1c34f23c2cfad2461c15fd69eaecf6c88a64168d34972fd7abd"},
    {"viip", "a walk by VIIP", viip_text,
     "c492255c974be159c378dbffdcf0bc8729e07b029930dbad87b7a5cad4e3dc02"},
    {"repair", "a repaired walk", repair_text,
     "16a496a391adf500cd5316e5b640ab9626fce3f2cea47a77d8aa2ad8a57cf4d8"},
    {"push", "limits of pushes", push_text,
     "0bcf10d7962e156ad391cb66afce103f989daec720ee909b72e3ec6195b0f6a7"},
}};

void compare(Context& context) {
  Json results = Json::array();
  std::string table;
  int different = 0;
  for (const Job& job : kJobs) {
    const std::string found = sha256(job.text(context));
    const bool same = found == job.sha256;
    different += !same;
    results.push_back(
        {{"job", job.name}, {"same", same}, {"sha256", found}, {"expected_sha256", job.sha256}});
    table += std::string(same ? "same       " : "different  ") + job.words + "\n";
    if (!same) table += "           SHA-256 " + found + ", expected " + job.sha256 + "\n";
  }
  table += different == 0
               ? "All results are the same as the published ones, bit for bit.\n"
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
      "selftest", "compare the results of this machine with the published ones, bit for bit");
  command->footer("Examples:\n  ayumi selftest\n  ayumi selftest --json");
  command->callback([&context] { compare(context); });
}

}  // namespace ayumi::app
