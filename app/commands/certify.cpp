// Robustness under a declared uncertainty: a sequential test with exact bounds, the influence of
// each quantity, the worst cases, a paired comparison, and rare failures.

#include "ayumi/study/certify.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/file_lock.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/plot/influence_plot.hpp"
#include "ayumi/study/subset_simulation.hpp"
#include "certify_results.hpp"
#include "option_checks.hpp"
#include "output_files.hpp"
#include "pattern_input.hpp"
#include "shard.hpp"
#include "simulation.hpp"
#include "uncertain_input.hpp"

namespace ayumi::app {

namespace {

using Json = nlohmann::ordered_json;

/// Number of cases that are listed as the worst. Definition.
constexpr size_t kWorst = 10;
/// Number of values whose influence is printed; the JSON and the picture have all of them. Chosen:
/// one screen.
constexpr size_t kShownInfluences = 8;

struct CertifyCommand {
  std::string pattern, study, out, table, map, shard, against, against_controller;
  std::vector<std::string> merge;
  PatternOptions input;
  SimulationChoice choice;
  CertifyOptions certify;
  bool rare = false;
  SubsetOptions subset;
};

/// Everything that determines the result of a case.
Json study_json(const Context& context, const Task& input, const Study& study,
                const SimulateOptions& simulate) {
  Json gains = Json::object();
  for (const auto& [name, value] : simulate.controller.gains) gains[name] = value;
  return {{"version", version()},
          {"pattern_sha256", input.pattern.sha256},
          {"parameters", input.pattern.parameters},
          {"robot_sha256", input.robot.description().sha256},
          {"study_sha256", study.sha256},
          {"profile", input.profile},
          {"controller", {{"type", name_of(simulate.controller.type)}, {"gains", gains}}},
          {"scenario", words_of(simulate.scenario)},
          {"substeps", simulate.substeps},
          {"true_state", simulate.true_state},
          {"plant", simulate.plant.name},
          {"seed", context.seed}};
}

std::string in_percent(double share) { return text::brief(100 * share, 3) + " %"; }

std::string counts_text(const Certificate& c) {
  std::string text =
      text::counted(c.outcome.runs, "run") + ", " + std::to_string(c.outcome.failures) + " failed";
  if (c.outcome.failures > 0)
    text += " (" + text::counted(c.falls, "fall") + ", " + std::to_string(c.unsettled) +
            " did not settle)";
  return text;
}

/// An angle in words, such as "2.3 deg", in the unit of the pattern's angles.
std::string angle_words(double angle, bool degrees, int digits) {
  const ShownUnit unit = shown_unit("rad", degrees);
  // In rad, the same accuracy needs two more digits.
  return text::fixed(angle * unit.scale, unit.scale == 1 ? digits + 2 : digits) + " " + unit.name;
}

void print_certificate(const Context& context, bool degrees, const Certificate& c,
                       const KnownResults& results, const CertifyOptions& options) {
  const std::string confidence = in_percent(options.confidence) + " confidence";
  std::string text = c.outcome.certified ? "certified: " : "not certified: ";
  text += counts_text(c);
  if (c.outcome.certified)
    text += ". The robot fails with a probability of at most " + in_percent(c.upper) + ", with " +
            confidence;
  else if (c.outcome.stopped)
    text += ". A failure probability of " + in_percent(options.failure) +
            " or less can no longer be " + "shown within " +
            text::counted(most_cases(options), "run");
  else
    text += ". More runs are needed";
  context.print(text + "\n");
  if (c.outcome.stopped)
    context.print("  failure probability: at least " + in_percent(c.lower) + " and at most " +
                  in_percent(c.upper) + ", each with " + confidence + "\n");
  const auto done =
      std::count_if(results.begin(), results.end(), [](const auto& r) { return r.has_value(); });
  if (options.all && done > c.outcome.runs) {
    const auto failed = std::count_if(results.begin(), results.end(),
                                      [](const auto& r) { return r && r->failed(); });
    context.print("  all " + text::counted(done, "run") + ": " + std::to_string(failed) +
                  " failed. The failure probability is at least " +
                  in_percent(lower_bound(failed, done, options.confidence)) + " and at most " +
                  in_percent(upper_bound(failed, done, options.confidence)) + ", each with " +
                  confidence + "\n");
  }
  if (c.largest.runs > 0) {
    const ShownUnit tilt = shown_unit("rad", degrees);
    const auto figure = [](double value, double factor, const std::string& unit) {
      return std::isfinite(value) ? text::brief(factor * value, 3) + unit
                                  : std::string("no bound (the robot fell in a run)");
    };
    context.print("  " + in_percent(1 - options.failure) +
                  " of all runs stay within each of these bounds, with " + confidence +
                  ": COG error " + figure(c.largest.cog_error, 1e3, " mm") + ", torque " +
                  figure(c.largest.torque, 100, " % of the limit") + ", foot tilt " +
                  figure(c.largest.foot_tilt, tilt.scale, " " + tilt.name) + "\n");
  }
}

void print_influences(const Context& context, std::vector<ValueInfluence> influences) {
  std::stable_sort(influences.begin(), influences.end(),
                   [](const ValueInfluence& a, const ValueInfluence& b) {
                     return std::abs(a.correlation) > std::abs(b.correlation);
                   });
  context.print(
      "  influence of each uncertain value. The correlation (-1 to 1) is the rank correlation of "
      "the value with how badly a run ends. The halves are the halves of the range of the value\n");
  for (size_t i = 0; i < std::min(influences.size(), kShownInfluences); ++i) {
    const ValueInfluence& each = influences[i];
    context.print("    " + each.name + ": correlation " + text::fixed(each.correlation, 2) +
                  ", failed " + std::to_string(each.failures[0]) + " of " +
                  text::counted(each.runs[0], "run") + " in the lower half and " +
                  std::to_string(each.failures[1]) + " of " + text::counted(each.runs[1], "run") +
                  " in the upper half\n");
  }
}

void print_worst(const Context& context, bool degrees, const KnownResults& results,
                 const std::vector<long>& numbers) {
  context.print("  worst cases (`ayumi simulate --case N` shows case N):\n");
  for (const long number : numbers) {
    const CaseResult& r = *results[static_cast<size_t>(number)];
    context.print("    case " + std::to_string(number) + ": " + name_of(r.outcome) +
                  (r.fell_at >= 0 ? " at " + text::fixed(r.fell_at, 2) + " s" : "") +
                  ", COG error " + text::fixed(1e3 * r.cog_error, 1) + " mm, torque " +
                  text::fixed(100 * r.torque, 0) + " % of the limit, foot tilt " +
                  angle_words(r.foot_tilt, degrees, 1) + "\n");
  }
}

/// Prints the sources of the numbers of the uncertainty, and returns them as JSON.
Json print_sources(const Context& context, const Study& study) {
  Json all = Json::array();
  std::vector<std::string> assumed;
  const auto add = [&](const UncertainQuantity& q) {
    if (q.source.empty()) return;  // the number is not drawn
    all.push_back({{"name", q.name}, {"source", q.source}, {"assumed", is_assumed(q.source)}});
    if (is_assumed(q.source)) assumed.push_back(q.name);
  };
  for (const UncertainQuantity& q : study.uncertainty.quantities) add(q);
  for (const UncertainPush& push : study.uncertainty.pushes)
    for (const UncertainQuantity* q : {&push.size, &push.direction, &push.time, &push.link})
      add(*q);
  context.print(
      "  uncertainty of " + study.file + ": " + text::counted(all.size(), "distribution") + ". " +
      (assumed.empty() ? "None of them is assumed"
                       : "The numbers of " + std::to_string(assumed.size()) +
                             (assumed.size() == 1 ? " distribution are" : " distributions are") +
                             " assumed: " + text::join(assumed, ", ")) +
      "\n");
  return {{"file", study.file}, {"distributions", all}};
}

/// The cases of the merged files. Every case that the verdict needs must be present.
KnownResults merged(const CertifyCommand& options, const Json& study) {
  FileCases cases;
  std::vector<std::string> shards;
  for (const std::string& file : options.merge) {
    const std::string theirs = add_case_results(file, study, true, cases);
    if (!theirs.empty()) shards.push_back(theirs);
  }
  KnownResults results = first_cases(cases, most_cases(options.certify));
  const Certificate c = certificate(options.certify, results);
  const auto first = std::find(results.begin(), results.end(), std::nullopt);
  const bool complete = first == results.end();
  if (!complete && (!c.outcome.stopped || options.certify.all)) {
    const long number = first - results.begin();
    fail(ErrorCode::bad_file, "--merge: case " + std::to_string(number) +
                                  " is in none of the files" + missing_shard(shards, number));
  }
  if (!options.certify.all)
    std::fill(results.begin() + c.outcome.runs, results.end(), std::nullopt);
  return results;
}

/// `input` and `law` are the certified motion and the name of its controller.
Json compare_with(Context& context, const CertifyCommand& options, const Study& study,
                  const Task& input, const UncertainTask& first, const std::string& law,
                  const KnownResults& known) {
  SimulationChoice choice = options.choice;
  if (!options.against_controller.empty()) choice.controller = options.against_controller;
  const std::string file = options.against.empty() ? options.pattern : options.against;
  const Task other = load_pattern(context, file, options.input);
  if (other.robot.description().sha256 != input.robot.description().sha256)
    fail(ErrorCode::bad_pattern,
         "--against: " + file + " is for the robot " + other.robot.name() + ", but " +
             options.pattern + " is for the robot " + input.robot.name() +
             ". A comparison needs two patterns for the same robot, so give a pattern for " +
             input.robot.name());
  const SimulateOptions second_loop = simulation_options(context, other, choice);
  const UncertainTask second(other.robot, other.series, study.uncertainty, second_loop);
  CertifyOptions pairs = options.certify;
  pairs.all = true;
  if (pairs.most == 0) pairs.most = failure_free_runs(pairs.failure, pairs.confidence);
  KnownResults start = known;
  start.resize(static_cast<size_t>(pairs.most));
  const KnownResults a = run_cases(first, pairs, start, {}, context.progress());
  const KnownResults b = run_cases(second, pairs, {}, {}, context.progress());
  const PairedComparison c = compare(a, b, pairs.confidence);
  const std::string other_law = name_of(second_loop.controller.type);
  std::string name = other_law, own = law;
  if (!options.against.empty()) {
    const bool laws = other_law != law;
    name = file + (laws ? ", " + other_law : "");
    own = options.pattern + (laws ? ", " + law : "");
  }
  const auto quoted = [](const std::string& word) { return "'" + word + "'"; };
  context.print("  compared with " + quoted(name) + " in the same " +
                text::counted(c.pairs, "case") + ": " + std::to_string(c.both + c.only_first) +
                " failed with " + quoted(own) + " (" + std::to_string(c.only_first) +
                " of them only with " + quoted(own) + "), and " +
                std::to_string(c.both + c.only_second) + " with " + quoted(name) + " (" +
                std::to_string(c.only_second) + " of them only with " + quoted(name) + ")\n");
  context.print("  failure probability with " + quoted(own) + " minus failure probability with " +
                quoted(name) + ": " + in_percent(c.difference.low) + " to " +
                in_percent(c.difference.high) + " with " + in_percent(pairs.confidence) +
                " confidence. McNemar's exact test gives p = " + text::brief(c.p_value, 3) + "\n");
  return {{"with", name},
          {"pairs", c.pairs},
          {"both_failed", c.both},
          {"only_first_failed", c.only_first},
          {"only_second_failed", c.only_second},
          {"mcnemar_p", c.p_value},
          {"difference_low", c.difference.low},
          {"difference_high", c.difference.high}};
}

Json rare_failures(Context& context, const CertifyCommand& options, const UncertainTask& task) {
  SubsetOptions subset = options.subset;
  subset.seed = context.seed;
  subset.threads = context.threads;
  const SubsetResult r = subset_simulation(
      task.dimension(),
      [&](const CaseNumbers& numbers) {
        task.check(task.draw(numbers), "a sample of the rare failures");
        return severity(task.run(numbers));
      },
      kFailedSeverity, options.certify.confidence, subset, context.progress());
  if (r.reached)
    context.print("  rare failures: the probability is " + text::brief(r.probability, 3) +
                  ", between about " + text::brief(r.interval.low, 2) + " and " +
                  text::brief(r.interval.high, 2) + " (subset simulation, " +
                  text::counted(r.levels.size(), "level") + ", " + text::counted(r.runs, "run") +
                  "). This interval is approximate\n");
  else
    context.print("  rare failures: none found in " + text::counted(r.levels.size(), "level") +
                  ". The probability is about " + text::brief(r.probability, 2) + " or less\n");
  return {{"probability", r.probability}, {"variation", r.variation}, {"low", r.interval.low},
          {"high", r.interval.high},      {"levels", r.levels},       {"runs", r.runs},
          {"reached", r.reached}};
}

void refuse_targets(const Context& context, const CertifyCommand& options) {
  if (!options.map.empty()) {
    const std::string type = std::filesystem::path(options.map).extension().string();
    if (type != ".svg" && type != ".png")
      fail(ErrorCode::usage, "--map " + options.map + ": the name must end in .svg or .png");
    refuse_overwriting(context, options.map);
  }
  if (!options.table.empty()) refuse_overwriting(context, options.table);
  if (!options.out.empty()) require_file_target(options.out);
  if (!options.out.empty() && !options.merge.empty()) refuse_overwriting(context, options.out);
  refuse_same_files({{"--out", options.out}, {"--table", options.table}, {"--map", options.map}});
  if (options.certify.shards > 1 && options.out.empty())
    fail(ErrorCode::usage,
         "--shard needs -o, the file that receives the results of this shard. --merge puts such "
         "files together");
  if (options.rare && options.subset.runs % 10 != 0)
    fail(ErrorCode::usage,
         "--rare-runs " + std::to_string(options.subset.runs) +
             ": the number must be a multiple of 10, because a tenth of the runs of a "
             "level starts the chains of the next level");
  if (options.certify.shards > 1 && !options.merge.empty())
    fail(ErrorCode::usage, "--shard and --merge cannot be given together. Leave one of them out");
}

void certify_pattern(Context& context, CertifyCommand& options) {
  const Shard part = read_shard(options.shard);
  options.certify.shard = part.index;
  options.certify.shards = part.count;
  options.certify.seed = context.seed;
  options.certify.threads = context.threads;
  refuse_targets(context, options);
  plant_of(options.choice.plant);
  const Task input = load_pattern(context, options.pattern, options.input);
  Study study = load_study(input, options.study);
  const bool stated = !options.study.empty() || !input.pattern.uncertainty.empty();
  const std::string left_out = fit_to_plant(study, input.robot, options.choice.plant, stated);
  SimulateOptions simulate = simulation_options(context, input, options.choice);
  const UncertainTask task(input.robot, input.series, study.uncertainty, simulate);
  if (!study.uncertainty.pushes.empty()) simulate.scenario.clear();
  const Json asked = study_json(context, input, study, simulate);
  const std::string shard = options.certify.shards > 1 ? options.shard : "";
  // If two programs wrote the same file, each would lose cases that the other one has added.
  std::optional<FileLock> lock;
  if (!options.out.empty()) lock.emplace(options.out);
  KnownResults results;
  FileCases in_file;
  // Cases that an earlier command has run stay in the file, even if this command needs fewer.
  const auto save = [&](const KnownResults& all) {
    if (options.out.empty()) return;
    FileCases cases = in_file;
    add_cases(all, cases);
    write_file(options.out, case_results_text(asked, shard, cases));
  };
  if (!options.merge.empty()) {
    results = merged(options, asked);
  } else {
    if (!options.out.empty() && !context.force)
      add_case_results(options.out, asked, false, in_file);
    const KnownResults known = first_cases(in_file, most_cases(options.certify));
    results = run_cases(task, options.certify, known, save, context.progress());
  }
  save(results);
  if (!options.table.empty()) write_file(options.table, case_table(task, context.seed, results));
  if (options.certify.shards > 1) {
    const auto cases = std::count_if(results.begin(), results.end(),
                                     [](const auto& result) { return result.has_value(); });
    context.print("shard " + shard + ": " + text::counted(cases, "case") + " written to " +
                  options.out + "\n");
    context.print_json(Json({{"shard", shard}, {"cases", cases}}).dump(2));
    return;
  }
  const Certificate found = certificate(options.certify, results);
  const std::vector<ValueInfluence> influence = influences(task, options.certify, results);
  const std::vector<long> worst = worst_cases(results, kWorst);
  const std::string law = name_of(simulate.controller.type);
  context.print(options.pattern + ", " + input.robot.name() + ", " + law + "\n");
  const bool degrees = input.pattern.degrees;
  print_certificate(context, degrees, found, results, options.certify);
  const Json sources = print_sources(context, study);
  context.print(left_out);
  if (!influence.empty()) print_influences(context, influence);
  print_worst(context, degrees, results, worst);
  Json json = {{"study", asked},
               {"certificate", certificate_json(found, options.certify)},
               {"uncertainty", sources},
               {"influences", influences_json(influence)},
               {"worst_cases", worst_cases_json(task, context.seed, results, worst)}};
  if (!options.against.empty() || !options.against_controller.empty())
    json["comparison"] = compare_with(context, options, study, input, task, law, results);
  if (options.rare) json["rare_failures"] = rare_failures(context, options, task);
  if (!options.map.empty()) {
    // The table has all known runs, like the picture. With --all, these are more than the test
    // needs.
    const auto is_known = [](const auto& r) { return r.has_value(); };
    const auto has_failed = [](const auto& r) { return r && r->failed(); };
    const std::string runs =
        text::counted(std::count_if(results.begin(), results.end(), is_known), "run") + ", " +
        std::to_string(std::count_if(results.begin(), results.end(), has_failed)) + " failed";
    write_drawing(
        options.map,
        draw_influences(input.pattern.name + ", " + input.robot.name() + ", " + law + ": " + runs,
                        influence),
        2);
    context.print("  drawn in " + options.map + "\n");
  }
  for (const std::string& file : {options.out, options.table})
    if (!file.empty()) context.print("  written to " + file + "\n");
  context.print_json(json.dump(2));
  context.exit_code = found.outcome.certified ? 0 : 1;
}

}  // namespace

void add_certify(Command& app, Context& context) {
  Command* command = app.add_subcommand(
      "certify",
      "test whether the failure probability of the robot is at most a given value, under declared "
      "uncertainty");
  command->footer(
      "Examples:\n  ayumi certify patterns/hoap1_walk.json --failure 0.01 --confidence 0.95\n"
      "  ayumi certify walk.json --study study.json -o out/cases.json --map out/matters.svg\n"
      "  ayumi certify walk.json --against-controller none --runs 299\n"
      "certify always simulates noise, bias and latency of the sensors. Run the command again with "
      "the same -o to continue. Exit code 0: certified. Exit code 1: not certified.");
  auto options = std::make_shared<CertifyCommand>();
  CertifyOptions& certify = options->certify;
  command->add_option("PATTERN", options->pattern, "Pattern file.")->required();
  command
      ->add_option("--study", options->study,
                   "Study file with the uncertainty (default: the uncertainty of the pattern, or "
                   "of the robot if the pattern has none).")
      ->type_name("F");
  command
      ->add_option("--failure", certify.failure,
                   "Largest failure probability with which the robot is certified.")
      ->check(number_within(1e-6, 0.5).description(""))
      ->type_name("P")
      ->capture_default_str();
  command
      ->add_option("--confidence", certify.confidence,
                   "Confidence level of the certificate and of every interval in the results.")
      ->check(number_within(0.5, 0.999999).description(""))
      ->type_name("P")
      ->capture_default_str();
  command
      ->add_option(
          "--runs", certify.most,
          "Largest number of runs (default: 10 times as many as a certificate needs when no "
          "run fails).")
      ->check(whole_number_within(1, 100000000).description(""))
      ->type_name("N");
  command->add_flag("--all", certify.all,
                    "Do not stop when the verdict is known, but do all runs. More runs show more "
                    "clearly which uncertain values matter.");
  command
      ->add_option(
          "-o,--out", options->out,
          "File for the results, as JSON. Run the command again with the same file to continue.")
      ->type_name("F");
  command
      ->add_option("--table", options->table,
                   "Write all cases with the values that were chosen at random, as CSV.")
      ->type_name("F");
  command
      ->add_option("--map", options->map,
                   "Draw the influence of each uncertain value (.svg or .png).")
      ->type_name("F");
  command
      ->add_option("--against", options->against, "Compare with another pattern in the same cases.")
      ->type_name("F");
  command
      ->add_option("--against-controller", options->against_controller,
                   "Compare with another controller in the same cases.")
      ->type_name("NAME");
  command->add_flag("--rare", options->rare,
                    "Also estimate the failure probability by subset simulation, which needs fewer "
                    "runs for rare failures.");
  command
      ->add_option(
          "--rare-runs", options->subset.runs,
          "Number of runs in each level of the subset simulation (--rare), a multiple of 10.")
      ->check(whole_number_within(10, 1000000).description(""))
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--shard", options->shard,
                   "Run only part I of N parts of the cases (one shard), for example 1/4.")
      ->type_name("I/N");
  command
      ->add_option(
          "--merge", options->merge,
          "Take the results from the files of all shards, without a simulation. May be repeated.")
      ->type_name("F")
      ->allow_extra_args(false);
  add_pattern_options(*command, options->input);
  add_simulation_options(*command, options->choice);
  command->callback([options, &context] { certify_pattern(context, *options); });
}

}  // namespace ayumi::app
