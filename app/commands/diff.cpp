// The differences between two patterns: joints, COG, ZMP, f_z, contacts, verdicts.

#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/repair/robustness_cost.hpp"
#include "motion_words.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "repairing.hpp"

namespace ayumi::app {

namespace {

using Json = nlohmann::ordered_json;

struct DiffCommand {
  std::string a, b, plot;
  std::vector<std::string> weights;
  std::optional<double> safety;
  PatternOptions input;
};

// The first time at which the two motions have different feet on the ground; negative if there is
// none.
double contacts_differ_at(const CommandSeries& a, const CommandSeries& b) {
  const size_t count = std::min(a.samples.size(), b.samples.size());
  for (size_t k = 0; k < count; ++k)
    if (a.samples[k].support != b.samples[k].support) return a.dt * static_cast<double>(k);
  return -1;
}

Json side_json(const std::string& file, const Task& input, const ConsistencyReport& report) {
  return {{"pattern", file},
          {"duration_s", input.series.duration()},
          {"verdict", verdict_of(report)},
          {"min_zmp_margin_m", report.summary[FindingKind::support_margin]}};
}

std::string side_words(const std::string& file, const Task& input,
                       const ConsistencyReport& report) {
  return file + ": " + verdict_of(report) + ", " + text::fixed(input.series.duration(), 2) + " s\n";
}

// The change, weighted as in a repair of A.
WeightedChange weighted(const DiffCommand& options, const Task& a, const Task& b,
                        const ConsistencyReport& check_a) {
  RepairOptions repair = preferred_options(a.pattern);
  repair.check = check_options(a);
  for (const auto& [joint, factor] : read_pairs(options.weights, "--weight"))
    repair.joint_weights[joint] = factor;
  if (options.safety) repair.safety = *options.safety;
  WeightedChange change =
      weighted_change(a.robot, a.series, b.series, weight_factors(a.robot, repair.joint_weights));
  change.safety = robustness_cost(a.robot, a.series, b.series, repair, check_a);
  return change;
}

std::string label_of(const std::string& file) {
  return std::filesystem::path(file).stem().string();
}

void diff(Context& context, const DiffCommand& options) {
  if (!options.plot.empty()) refuse_overwriting(context, options.plot);
  read_pairs(options.weights, "--weight");
  const Task a = load_pattern(context, options.a, options.input);
  const Task b = load_pattern(context, options.b, options.input);
  if (a.robot.dof_names() != b.robot.dof_names())
    fail(ErrorCode::bad_pattern, {options.b},
         "the robot is '" + b.robot.name() + "', but the robot of " + options.a + " is '" +
             a.robot.name() + "'. Only patterns of the same robot can be compared");
  const ConsistencyReport check_a = check_consistency(a.robot, a.series, check_options(a));
  const ConsistencyReport check_b = check_consistency(b.robot, b.series, check_options(b));
  const MotionChange change = motion_change(a.robot, a.series, b.series);
  const WeightedChange cost = weighted(options, a, b, check_a);
  const double contacts = contacts_differ_at(a.series, b.series);
  const bool same_length = a.series.samples.size() == b.series.samples.size();
  const bool same =
      same_length && contacts < 0 && change.joints.empty() &&
      std::max({change.cog.size, change.zmp.size, change.fz.size, change.foot.size}) < 1e-9;
  std::string words = side_words(options.a, a, check_a) + side_words(options.b, b, check_b);
  if (same)
    words += "  both patterns have the same motion and the same commands\n";
  else
    words += motion_words(a.robot, change, check_a, check_b, {options.a, options.b}) +
             cost_words(cost) + "\n";
  if (!same_length)
    words += "  the patterns differ in duration, so only the first " +
             text::fixed(change.compared, 3) + " s are compared\n";
  if (contacts >= 0)
    words += "  the contacts of the feet differ for the first time at " + text::fixed(contacts, 3) +
             " s\n";
  if (!options.plot.empty()) {
    plot_motions(a.robot, a.series, b.series,
                 {label_of(options.a) + " and " + label_of(options.b), a.profile,
                  label_of(options.a), label_of(options.b)},
                 options.plot);
    words += "  drawn in " + options.plot + "\n";
  }
  context.print(words);
  Json json = {{"same", same},
               {"a", side_json(options.a, a, check_a)},
               {"b", side_json(options.b, b, check_b)},
               {"compared_s", change.compared},
               {"contacts_differ_at_s", contacts >= 0 ? Json(contacts) : Json(nullptr)},
               {"max",
                {{"joint_rad", change.joint.size},
                 {"cog_m", change.cog.size},
                 {"zmp_m", change.zmp.size},
                 {"fz_N", change.fz.size},
                 {"foot_m", change.foot.size}}},
               {"moved", Json::parse(motion_change_json(change))},
               {"weighted_change", Json::parse(weighted_change_json(cost))}};
  context.print_json(json.dump(2));
}

}  // namespace

void add_diff(Command& app, Context& context) {
  Command* command = app.add_subcommand("diff", "say how the motions of two patterns differ");
  command->footer(
      "Examples:\n  ayumi diff walk.json repaired.json\n"
      "  ayumi diff walk.json repaired.json --plot moved.svg --json");
  static DiffCommand options;
  command->add_option("A", options.a, "Pattern file.")->required();
  command->add_option("B", options.b, "Pattern file that is compared with A.")->required();
  command->add_option("--plot", options.plot, "Draw both patterns over time (.svg or .png).")
      ->type_name("F");
  command
      ->add_option("--weight", options.weights,
                   "Weight of this joint in the weighted change that diff prints (default: the "
                   "weight in A; 1 if A has none). repair has the same option.")
      ->type_name("JOINT=FACTOR")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--safety", options.safety,
          "Factor on the cost of missing safety (default: the factor in A; 1 if A has none). "
          "repair has the same option. The cost says by how much the motion of B misses the safe "
          "distances that a repair of A aims at, for example that of the ZMP from the edge of the "
          "support. diff prints the cost if it is not negligible.")
      ->check(number_within(0.0, 1e6))
      ->type_name("FACTOR");
  add_pattern_options(*command, options.input);
  command->callback([&context] { diff(context, options); });
}

}  // namespace ayumi::app
