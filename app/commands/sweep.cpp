// Many cases of one study, on this machine, in shards or on a cluster. The results have one row for
// each case.

#include <algorithm>
#include <functional>
#include <memory>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/file_lock.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/unfinished_files.hpp"
#include "option_checks.hpp"
#include "output_files.hpp"
#include "pattern_input.hpp"
#include "shard.hpp"
#include "sweep/expectations.hpp"
#include "sweep/run_cases.hpp"
#include "sweep/slurm.hpp"
#include "sweep/study_page.hpp"

namespace ayumi::app {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Files and judgements that are made from the results.
struct SweepOutputs {
  std::string csv, page, junit;
  std::vector<std::string> expect;
  int replays = 3;
};

struct SweepCommand {
  std::string study, out, shard, cases, engine = "local";
  bool retry = false;
  double case_limit = 0;  ///< largest processor time of a case [s]; 0 for no limit
  SlurmOptions slurm;
  SweepOutputs outputs;
};

struct MergeCommand {
  std::vector<std::string> files;
  std::string out;
  bool partial = false;
};

void refuse_bad_names(const Context& context, const SweepOutputs& outputs) {
  for (const std::string& file : {outputs.csv, outputs.page, outputs.junit})
    if (!file.empty()) refuse_overwriting(context, file);
}

std::string counts_words(const SweepCounts& c) {
  std::string text = std::to_string(c.done) + " of " + text::counted(c.cases, "case") + ": " +
                     std::to_string(c.stands) + " stand, " + std::to_string(c.falls) + " fell, " +
                     std::to_string(c.unsettled) + " did not settle";
  if (c.inconsistent > 0) text += ", " + std::to_string(c.inconsistent) + " inconsistent";
  return text + ", " + std::to_string(c.errors) + " could not be run";
}

std::string first_errors(const ResultsDatabase& results) {
  std::string text;
  for (const auto& row : results.query(
           "SELECT \"case\", error FROM cases WHERE error IS NOT NULL ORDER BY \"case\" LIMIT 3"))
    text += "  case " + row[0] + " could not be run: " + row[1] + "\n";
  return text;
}

/// Prints, writes and judges the present results.
void conclude(Context& context, const ResultsDatabase& results, const SweepOutputs& outputs,
              const CaseRunner* runner, Json json = Json::object()) {
  const std::vector<Expectation> expectations = judge_expectations(results, outputs.expect);
  if (!outputs.csv.empty())
    write_file_with(outputs.csv, [&](const fs::path& file) { results.write_csv(file); });
  if (!outputs.junit.empty()) write_file(outputs.junit, junit_text(results, expectations));
  if (!outputs.page.empty())
    write_file(outputs.page,
               study_page(results, expectations, runner, outputs.replays, context.progress()));
  context.print(results.head().name + ", " + counts_words(results.counts()) + "\n" +
                first_errors(results));
  bool all = true;
  for (const Expectation& e : expectations) {
    if (!e.met || !outputs.expect.empty())
      context.print("  expectation " + std::string(e.met ? "met" : "not met") + ": " + e.text +
                    (e.met ? "" : " (" + e.found + ")") + "\n");
    all = all && e.met;
  }
  for (const std::string& file : {outputs.csv, outputs.junit, outputs.page})
    if (!file.empty()) context.print("  written to " + file + "\n");
  if (context.json) {
    Json found = results_json(results, expectations);
    for (const auto& [key, value] : json.items()) found[key] = value;
    context.print_json(found.dump(2, ' ', false, Json::error_handler_t::replace));
  }
  context.exit_code = all ? 0 : 1;
}

/// Removes the files that SQLite keeps beside a database that is in use.
void remove_companions(const fs::path& file) {
  std::error_code ignored;
  for (const char* part : {"-wal", "-shm", "-journal"}) fs::remove(file.string() + part, ignored);
}

/// Calls `work`. In the message of its error, the name of the file replaces that of the temporary
/// file.
void with_name_of(const fs::path& file, const fs::path& temporary,
                  const std::function<void()>& work) {
  const std::string name = temporary.string();
  const UnfinishedPath log(name + "-wal"), index(name + "-shm"), journal(name + "-journal");
  try {
    work();
  } catch (const Error& error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    remove_companions(temporary);
    std::string words = error.what();
    if (const size_t at = words.find(temporary.string()); at != std::string::npos)
      words.replace(at, temporary.string().size(), file.string());
    fail(error.code(), words);
  }
}

/// Makes a file that appears as a whole or not at all, even if the program is killed in between. It
/// replaces an older file only after the expectations have been understood.
void create_results(const fs::path& file, const SweepHead& head,
                    const std::vector<std::string>& expect) {
  write_file_with(file, [&](const fs::path& temporary) {
    with_name_of(file, temporary, [&] {
      ResultsDatabase results(temporary, head);
      judge_expectations(results, expect);
      results.close();
      remove_companions(file);
    });
  });
}

/// The cases that belong to both the shard and the list.
std::vector<bool> asked_cases(const SweepCommand& options, const Shard& shard, long count) {
  std::vector<bool> asked(static_cast<size_t>(count), options.cases.empty());
  if (!options.cases.empty())
    for (const auto& [first, last] : read_case_ranges(options.cases, count))
      std::fill(asked.begin() + first, asked.begin() + last + 1, true);
  for (long i = 0; i < count && !shard.whole(); ++i)
    if (!shard.has(i)) asked[static_cast<size_t>(i)] = false;
  return asked;
}

void run_sweep(Context& context, const SweepCommand& options) {
  if (options.study.empty())
    fail(ErrorCode::usage,
         "the argument STUDY is missing. Give a study file, or one of the subcommands merge and "
         "status");
  if (options.out.empty())
    fail(ErrorCode::usage,
         "the option --out is missing. Name the file of the results, for example "
         "results.db");
  const Shard shard = read_shard(options.shard);
  refuse_bad_names(context, options.outputs);
  require_file_target(options.out);
  refuse_same_files({{"--out", options.out},
                     {"--csv", options.outputs.csv},
                     {"--junit", options.outputs.junit},
                     {"--page", options.outputs.page}});
  const SweepStudy study(read_file(options.study), options.study);
  CaseRunner runner(context, study);
  runner.limit_case(options.case_limit);
  const std::vector<bool> asked = asked_cases(options, shard, study.size());
  const SweepHead head = head_of(runner, context.seed);
  const FileLock lock(options.out);
  if (context.force || !fs::exists(options.out)) {
    if (options.engine == "slurm") require_slurm();  // before an empty file of results is made
    create_results(options.out, head, options.outputs.expect);
  }
  const auto results = std::make_unique<ResultsDatabase>(options.out, ResultsDatabase::Mode::write);
  results->require_study(head);
  results->require_unchanged();
  // A wrong expectation is refused before the work.
  judge_expectations(*results, options.outputs.expect);
  if (!shard.whole()) results->add_shards({shard.word()});
  if (options.retry)
    context.print("  " + text::counted(results->forget_errors(asked), "case") +
                  " that could not be run will be run again\n");
  std::vector<bool> missing = results->done();
  for (size_t i = 0; i < missing.size(); ++i) missing[i] = asked[i] && !missing[i];
  RunCost cost;
  const bool local = options.engine == "local";
  const auto note_work = [&](double seconds, double useful) {
    if (local) results->add_work({seconds + runner.setup_seconds(), useful});
  };
  try {
    cost =
        local ? run_cases(runner, *results, missing, context.threads, context.progress())
              : run_on_slurm(context, runner, *results, missing, options.slurm, context.progress());
  } catch (const Interrupted&) {
    note_work(runner.seconds(), runner.useful_seconds());
    throw;
  }
  note_work(cost.seconds, cost.useful);
  if (cost.cases > 0)
    context.print("  " + text::counted(cost.cases, "case") + (cost.cases == 1 ? " was" : " were") +
                  " run. A case took " + text::brief(cost.seconds / double(cost.cases), 3) +
                  " s of processor time on average, and " +
                  text::fixed(100 * (1 - cost.useful / std::max(1e-9, cost.seconds)), 2) +
                  " % of this time was not spent on the simulation\n");
  conclude(context, *results, options.outputs, &runner,
           {{"run_now", cost.cases}, {"seconds", cost.seconds}, {"useful_seconds", cost.useful}});
  results->close();
}

/// Throws if a case is in none of the files.
void refuse_missing(const std::vector<std::unique_ptr<ResultsDatabase>>& files, long cases) {
  std::vector<bool> have(static_cast<size_t>(cases));
  std::vector<std::string> shards;
  for (const auto& file : files) {
    const std::vector<bool> theirs = file->done();
    for (size_t i = 0; i < have.size(); ++i) have[i] = have[i] || theirs[i];
    const std::vector<std::string> more = file->shards();
    shards.insert(shards.end(), more.begin(), more.end());
  }
  const auto first = std::find(have.begin(), have.end(), false);
  if (first == have.end()) return;
  const long number = first - have.begin();
  fail(ErrorCode::bad_file,
       "merge: case " + std::to_string(number) + " is in none of the files" +
           missing_shard(shards, number) +
           ". Nothing was merged. --partial merges the cases that the files have");
}

void merge_results(Context& context, const MergeCommand& options) {
  const std::string out = options.out.empty() ? options.files.front() : options.out;
  require_file_target(out);
  if (!options.out.empty()) refuse_overwriting(context, out);
  std::vector<std::unique_ptr<ResultsDatabase>> files;
  for (const std::string& file : options.files) {
    files.push_back(std::make_unique<ResultsDatabase>(file, ResultsDatabase::Mode::read));
    files.back()->require_study(files.front()->head());
    files.back()->require_unchanged();
  }
  if (!options.partial) refuse_missing(files, files.front()->head().cases);
  const SweepHead head = files.front()->head();
  files.clear();
  const FileLock lock(out);
  long added = 0;
  const auto merge_into = [&](ResultsDatabase& results) {
    for (const std::string& file : options.files)
      if (file != out) added += results.merge(file);
  };
  if (options.out.empty()) {
    ResultsDatabase results(out, ResultsDatabase::Mode::write);
    merge_into(results);
    results.close();
  } else {
    write_file_with(out, [&](const fs::path& temporary) {
      with_name_of(out, temporary, [&] {
        ResultsDatabase results(temporary, head);
        merge_into(results);
        results.close();
      });
    });
  }
  const ResultsDatabase results(out, ResultsDatabase::Mode::read);
  context.print("  " + text::counted(added, "case") + " added to " + out + "\n");
  conclude(context, results, {}, nullptr);
}

std::string slurm_words(const SlurmStatus& slurm) {
  if (!slurm.exists) return "";
  const std::string name = "  Slurm, jobs " + slurm.name + ": ";
  if (!slurm.trouble.empty()) return name + slurm.trouble + "\n";
  std::string words = name + text::counted(slurm.running, "task") + " running, " +
                      std::to_string(slurm.waiting) + " waiting" +
                      (slurm.waiting > 0 && slurm.running == 0 ? " (" + slurm.reason + ")" : "");
  if (slurm.arrived > 0)
    words += ", " + text::counted(slurm.arrived, "task") +
             (slurm.arrived == 1 ? " ended, but its rows are not collected yet"
                                 : " ended, but their rows are not collected yet");
  return words + "\n";
}

void show_status(Context& context, const std::string& file) {
  const ResultsDatabase results(file, ResultsDatabase::Mode::read);
  results.require_unchanged();
  const SweepCounts counts = results.counts();
  const std::vector<std::string> shards = results.shards();
  const SlurmStatus slurm = slurm_status(file);
  context.print(
      file + ": " + results.head().name + ", " + counts_words(counts) + "; " +
      std::to_string(counts.cases - counts.done) + " are missing" +
      (shards.empty() ? "" : ". The file contains the shards " + text::join(shards, ", ")) + "\n" +
      first_errors(results) + slurm_words(slurm));
  Json json = Json({{"study", results.head().name},
                    {"cases", counts.cases},
                    {"done", counts.done},
                    {"missing", counts.cases - counts.done},
                    {"errors", counts.errors},
                    {"stands", counts.stands},
                    {"falls", counts.falls},
                    {"unsettled", counts.unsettled},
                    {"shards", shards}});
  if (slurm.exists)
    json["slurm"] = {{"job_name", slurm.name},   {"running", slurm.running},
                     {"waiting", slurm.waiting}, {"reason", slurm.reason},
                     {"arrived", slurm.arrived}, {"trouble", slurm.trouble}};
  context.print_json(json.dump(2, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

void add_sweep(Command& app, Context& context) {
  Command* command =
      app.add_subcommand("sweep", "run every case of a study: patterns, robots, gains, pushes");
  command->footer(
      "Examples:\n  ayumi sweep examples/sweep/friction.json -o out/results.db --page "
      "out/page.html\n"
      "  ayumi sweep study.json -o a.db --shard 1/2\n  ayumi sweep merge a.db b.db -o all.db\n"
      "  ayumi sweep status results.db\n"
      "  ayumi sweep study.json -o results.db --expect 'falls == 0' --junit results.xml\n"
      "Run the command again with the same -o to continue. Only the cases without a result are "
      "then run. Exit code 1: an expectation is not met, or a case could not be run.");
  auto options = std::make_shared<SweepCommand>();
  command->add_option("STUDY", options->study, "Study file that has the key \"sweep\".")
      ->check(file_or_subcommand({"merge", "status"}));
  command->add_option("-o,--out", options->out, "File for the results (SQLite).")
      ->type_name("F.db");
  command
      ->add_option("--shard", options->shard,
                   "Run only part I of N parts of the cases (one shard), for example 1/4.")
      ->type_name("I/N");
  command->add_option("--cases", options->cases, "Run only these cases, for example 0-99,120.")
      ->type_name("LIST");
  command
      ->add_option("--case-limit", options->case_limit,
                   "Largest processor time of a case [s]. A case that takes longer is recorded as "
                   "a case that could not be run.")
      ->check(number_within(0.01, 1e6).description(""))
      ->type_name("S");
  command
      ->add_option("--engine", options->engine,
                   "Where the cases run: local (this machine) or slurm (a cluster).")
      ->check(one_of({"local", "slurm"}).description(""))
      ->type_name("NAME")
      ->capture_default_str();
  std::vector<Option*> slurm_options;
  const auto for_slurm = [&](Option* option, const std::string& type) {
    slurm_options.push_back(option->type_name(type)->group("With --engine slurm"));
  };
  SlurmOptions& slurm = options->slurm;
  for_slurm(command->add_option("--partition", slurm.partition,
                                "Partition of Slurm, passed on to sbatch."),
            "NAME");
  for_slurm(command->add_option("--time", slurm.time,
                                "Time limit of a task, passed on to sbatch. Tasks are planned to "
                                "take at most half of this time."),
            "TIME");
  for_slurm(command->add_option("--memory", slurm.memory,
                                "Memory of a task, passed on to sbatch as --mem."),
            "SIZE");
  for_slurm(
      command
          ->add_option(
              "--sbatch", slurm.further,
              "Further option for sbatch, for example --sbatch=--account=lab. May be repeated.")
          ->allow_extra_args(false),
      "OPTION");
  for_slurm(
      command
          ->add_option("--chunk", slurm.chunk,
                       "Number of cases in a task (default: chosen so that a task takes "
                       "--task-seconds). For this choice, Ayumi first measures how long a few "
                       "cases take.")
          ->check(whole_number_within(1, 1000000).description("")),
      "N");
  for_slurm(
      command->add_option("--task-seconds", slurm.task_seconds, "Wanted duration of a task [s].")
          ->check(number_within(0.1, 1e6).description(""))
          ->capture_default_str(),
      "S");
  for_slurm(command
                ->add_option("--pilot", slurm.pilot,
                             "Number of cases that Ayumi runs first to measure how "
                             "long a case takes (see --chunk).")
                ->check(whole_number_within(1, 1000).description(""))
                ->capture_default_str(),
            "N");
  for_slurm(command
                ->add_option("--attempts", slurm.attempts,
                             "Largest number of times that a case is submitted. A case whose task "
                             "is lost is submitted again.")
                ->check(whole_number_within(1, 100).description(""))
                ->capture_default_str(),
            "N");
  command->add_flag("--retry", options->retry, "Run again the cases that could not be run before.");
  SweepOutputs& outputs = options->outputs;
  command
      ->add_option(
          "--expect", outputs.expect,
          "Condition that the results must meet, for example 'falls == 0'. May be repeated.")
      ->type_name("TEXT")
      ->allow_extra_args(false);
  command->add_option("--csv", outputs.csv, "Write all cases as CSV.")->type_name("F");
  command->add_option("--junit", outputs.junit, "Write the expectations as JUnit XML.")
      ->type_name("F");
  command
      ->add_option("--page", outputs.page,
                   "Write a page with failure rates, maps and replays (.html).")
      ->type_name("F");
  command->add_option("--replays", outputs.replays, "Number of worst cases that the page replays.")
      ->check(whole_number_within(0, 20).description(""))
      ->type_name("N")
      ->capture_default_str();

  Command* merge = command->add_subcommand("merge", "merge the results of shards into one file");
  auto merging = std::make_shared<MergeCommand>();
  merge->add_option("FILES", merging->files, "Results files of one study.")->required();
  merge
      ->add_option("-o,--out", merging->out,
                   "New file for the merged results (default: no new file; the first of the FILES "
                   "receives the results of the others).")
      ->type_name("F.db");
  merge->add_flag("--partial", merging->partial, "Merge even if cases are missing.");
  merge->callback([merging, &context] { merge_results(context, *merging); });

  Command* status = command->add_subcommand("status", "say how many cases of a sweep are done");
  auto file = std::make_shared<std::string>();
  status->add_option("FILE", *file, "File of the results.")->required();
  status->callback([file, &context] { show_status(context, *file); });

  command->callback([command, options, slurm_options, &context] {
    if (!command->given_subcommands().empty()) return;
    for (const Option* option : slurm_options)
      if (option->count() > 0 && options->engine != "slurm")
        fail(ErrorCode::usage, option->get_name() +
                                   " works only together with --engine slurm. Add --engine slurm, "
                                   "or leave this option out");
    run_sweep(context, *options);
  });
}

}  // namespace ayumi::app
