// The nearest consistent pattern by Ipopt, written as the author's file with a correction track.

#include "ayumi/optimize/repair.hpp"

#include <chrono>
#include <nlohmann/json.hpp>

#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern_file.hpp"
#include "ayumi/io/results_json.hpp"
#include "ayumi/pattern/sample.hpp"
#include "check_table.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

struct Options {
  std::string pattern, out;
  std::vector<std::string> locked, tolerances;
  PatternOptions input;
  RepairOptions repair;
};

// Relative names in the file hold only from the folder they were written for.
bool same_folder(const fs::path& a, const fs::path& b) {
  return fs::absolute(a).lexically_normal().parent_path() ==
         fs::absolute(b).lexically_normal().parent_path();
}

bool names_files(const Pattern& pattern) {
  return pattern.table || pattern.robot.find('/') != std::string::npos;
}

// The author's text as it is but for the correction; parameters given on the command line, or
// relative names that would break in another folder, make it a text of our own.
void write_repaired(const Options& options, const Pattern& pattern, const RepairResult& result) {
  Pattern corrected = pattern;
  if (result.status == RepairStatus::repaired) corrected.correction = result.correction;
  const bool keeps_text = options.input.set.empty() &&
                          (same_folder(options.pattern, options.out) || !names_files(pattern));
  if (!keeps_text) {
    write_pattern(options.out, corrected);
    return;
  }
  const std::string text = read_file(options.pattern);
  write_file(options.out, result.status == RepairStatus::repaired
                              ? with_correction(text, result.correction)
                              : text);
}

std::string in_words(const Options& options, const RepairResult& result, double wall) {
  std::string out = options.pattern + ": " + name_of(result.status) + "\n";
  if (result.status == RepairStatus::already_consistent)
    return out + "  nothing changed; " + options.out + " is the pattern as it was\n";
  out += "  moved at most " + text::fixed(result.max_joint_change * 180 / EIGEN_PI, 2) + " deg (" +
         result.where + " at " + text::fixed(result.at, 3) + " s), COG " +
         text::fixed(1000 * result.max_cog_change, 1) + " mm\n";
  out += "  " + std::to_string(result.variables) + " variables, " +
         std::to_string(result.constraints) + " constraints, " + std::to_string(result.iterations) +
         " iterations, " + text::fixed(wall, 2) + " s\n";
  for (const std::string& reason : result.reasons) out += "  because " + reason + "\n";
  if (result.status == RepairStatus::repaired)
    out += check_table(result.check) + "  written to " + options.out + "\n";
  else
    out += "  nothing written\n";
  return out;
}

void repair_pattern(Context& context, Options options) {
  refuse_overwriting(context, options.out);
  PatternInput input = load_pattern(context, options.pattern, options.input);
  options.repair.check = check_options(input, options.tolerances);
  options.repair.locked_joints = options.locked;
  const auto begin = std::chrono::steady_clock::now();
  RepairResult result = repair(input.model, input.series, options.repair, context.progress());
  if (result.status != RepairStatus::already_consistent && input.pattern.correction) {
    // An older correction did not do: the least change is from what the author wrote.
    Pattern plain = input.pattern;
    plain.correction.reset();
    result =
        repair(input.model, sample(input.model, plain, {.dt = input.series.dt}, context.progress()),
               options.repair, context.progress());
  }
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const bool good =
      result.status == RepairStatus::repaired || result.status == RepairStatus::already_consistent;
  if (good) write_repaired(options, input.pattern, result);
  context.print(in_words(options, result, wall));
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(repair_json(result));
  json["variables"] = result.variables;
  json["constraints"] = result.constraints;
  json["wall_s"] = wall;
  json["output"] = good ? nlohmann::ordered_json(options.out) : nullptr;
  context.print_json(json.dump(2));
  context.exit_code = good ? 0 : 4;
}

}  // namespace

void add_repair(CLI::App& app, Context& context) {
  CLI::App* command =
      app.add_subcommand("repair", "the nearest consistent pattern, by least change");
  command->footer(
      "Examples:\n  ayumi repair walk.json -o repaired.json\n"
      "  ayumi repair walk.json -o repaired.json --lock l_elbow --lock r_elbow\n"
      "  ayumi repair walk.json -o repaired.json --margin 0.005 --json");
  static Options options;
  command->add_option("PATTERN", options.pattern, "pattern file")->required();
  command->add_option("-o,--out", options.out, "pattern file to write")->required()->type_name("F");
  command->add_option("--lock", options.locked, "a joint that must not change")
      ->type_name("JOINT")
      ->allow_extra_args(false);
  command->add_option("--margin", options.repair.zmp_margin, "of the ZMP inside the support [m]")
      ->check(CLI::Range(0.0, 0.1))
      ->type_name("M")
      ->capture_default_str();
  command->add_option("--knots", options.repair.knot_spacing, "spacing of the correction [s]")
      ->check(CLI::Range(0.005, 1.0))
      ->type_name("S")
      ->capture_default_str();
  command->add_option("--max-iterations", options.repair.max_iterations, "of Ipopt in each round")
      ->check(CLI::Range(1, 10000))
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--tolerance", options.tolerances, "of one kind of finding, over the pattern's")
      ->type_name("KIND=VALUE")
      ->allow_extra_args(false);
  add_pattern_options(*command, options.input);
  command->callback([&context] { repair_pattern(context, options); });
}

}  // namespace ayumi::app
