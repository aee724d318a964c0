#include "sweep/slurm.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <thread>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/processor_time.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/json/json_depth.hpp"
#include "ayumi/io/run/sha256.hpp"

extern char** environ;

namespace ayumi::app {

namespace fs = std::filesystem;
using SlurmJson = nlohmann::ordered_json;

namespace {

using Clock = std::chrono::steady_clock;

/// Share of a task that its start may take. Chosen: together with the writing of results, it stays
/// below the 5 % that a case may cost in addition to its simulation; with half, the shortest task
/// is twice as long.
constexpr double kSetupShare = 0.02;
/// Smallest number of tasks of a study, unless they become too short. Chosen: four for each of four
/// nodes, so that nodes of different speed end at about the same time.
constexpr long kFewestTasks = 16;
/// Largest number of cases of one task. Chosen: its file has some MB.
constexpr long kMostCasesOfTask = 20000;
/// Largest number of ranges of numbers in the list of one task. Chosen: the list is one word of a
/// command, which may have 128 kB.
constexpr size_t kMostRanges = 5000;
/// Number of tasks of an array if Slurm does not state it. Source: the default of MaxArraySize is
/// 1001.
constexpr long kDefaultArray = 1000;
/// Time without an answer of Slurm after which the engine gives up [s]. Chosen: a restart of a
/// controller takes less than a minute.
constexpr double kLongestSilence = 600;
/// Shortest and longest time between two queries of the queue [s]. Chosen: a query costs the
/// controller a few ms.
constexpr double kShortestPoll = 0.5, kLongestPoll = 10;
/// Time between two attempts to submit tasks that Slurm has refused while it has other tasks [s].
/// Chosen: the number of jobs that a limit allows changes when tasks end, which takes minutes.
constexpr double kBetweenRefusals = 30;
/// Number of queries of the queue without a task after which the task counts as lost. Chosen: a
/// query may come after the submission but before the task is in the queue.
constexpr int kLooksUntilLost = 3;
/// Time for which the file of a task that has ended well may be invisible [s]. Source: nfs(5); a
/// folder is read again after acdirmax = 60 s at the latest; half of this is added for slow disks.
constexpr double kUnseenFile = 90;
/// Share of the time limit that a task should take. Chosen: the slowest case of a task may take
/// twice as long as that of the pilot run.
constexpr double kShareOfLimit = 0.5;

struct CommandResult {
  int exit_code = -1;  ///< -1 if the command could not be started
  std::string out, err;
};

/// Runs a program and waits for it.
CommandResult run_command(const std::vector<std::string>& words) {
  CommandResult result;
  std::array<int, 2> out{}, err{};
  if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(err.data(), O_CLOEXEC) != 0) {
    result.err = std::strerror(errno);
    return result;
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out[1], 1);
  posix_spawn_file_actions_adddup2(&actions, err[1], 2);
  std::vector<std::string> copy = words;
  std::vector<char*> argv;
  for (std::string& word : copy) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  const int failed = ::posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(out[1]);
  ::close(err[1]);
  if (failed != 0) {
    result.err = std::strerror(failed);
  } else {
    std::array<pollfd, 2> streams = {pollfd{out[0], POLLIN, 0}, pollfd{err[0], POLLIN, 0}};
    std::array<std::string*, 2> texts = {&result.out, &result.err};
    for (int open = 2; open > 0;) {
      if (::poll(streams.data(), streams.size(), -1) < 0) {
        if (errno == EINTR) continue;
        break;
      }
      for (size_t i = 0; i < 2; ++i) {
        if (streams[i].fd < 0 || streams[i].revents == 0) continue;
        char buffer[4096];
        const ssize_t read = ::read(streams[i].fd, buffer, sizeof buffer);
        if (read > 0) {
          texts[i]->append(buffer, static_cast<size_t>(read));
        } else if (read == 0 || errno != EINTR) {
          streams[i].fd = -1;
          --open;
        }
      }
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  ::close(out[0]);
  ::close(err[0]);
  return result;
}

/// The message of a program as one line.
std::string one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    if (c == '\n' || c == '\r')
      line += line.empty() || line.ends_with("; ") ? "" : "; ";
    else
      line += c;
  }
  while (line.ends_with("; ")) line.resize(line.size() - 2);
  return line;
}

/// A text in single quotes for a shell.
std::string shell_word(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// A path for sbatch, for which % begins a field.
std::string sbatch_path(const fs::path& path) {
  std::string text;
  for (const char c : path.string()) text += c == '%' ? std::string("%%") : std::string(1, c);
  return text;
}

using TaskNumber = std::pair<long, long>;  // number of the array, and of the task in it (from 1)

/// A submitted array whose results may still arrive.
struct SubmittedArray {
  long number = 0;
  std::string job;
};

struct State {
  std::string name;  ///< name of all jobs of these results
  std::vector<SubmittedArray> arrays;
};

fs::path array_file(const fs::path& folder, long array, const char* type) {
  return folder / ("array-" + std::to_string(array) + type);
}

State read_state(const fs::path& folder) {
  State state;
  const fs::path file = folder / "state.json";
  if (!fs::exists(file)) return state;
  try {
    const auto json = shallow_json<SlurmJson>(read_file(file));
    state.name = json.at("name");
    for (const SlurmJson& array : json.at("arrays"))
      state.arrays.push_back({array.at("number"), array.at("job")});
  } catch (const SlurmJson::exception&) {
    fail(ErrorCode::bad_file, {file.string()},
         "this file does not contain the state of a sweep on Slurm, so the sweep cannot continue. "
         "Cancel the jobs of the sweep that still run, and remove the folder of this file");
  }
  return state;
}

void write_state(const fs::path& folder, const State& state) {
  SlurmJson arrays = SlurmJson::array();
  for (const SubmittedArray& array : state.arrays)
    arrays.push_back({{"number", array.number}, {"job", array.job}});
  write_file(folder / "state.json",
             SlurmJson({{"name", state.name}, {"arrays", arrays}}).dump(1) + "\n");
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// State of a task as Slurm reports it.
struct QueuedTask {
  std::string state, reason;
  bool running() const {
    return state == "RUNNING" || state == "COMPLETING" || state == "CONFIGURING";
  }
  /// Whether the task has ended without success; its file exists already or will never exist.
  bool failed() const {
    constexpr const char* kFailed[] = {"BOOT_FAIL", "CANCELLED", "DEADLINE",
                                       "FAILED",    "NODE_FAIL", "OUT_OF_MEMORY",
                                       "PREEMPTED", "REVOKED",   "TIMEOUT"};
    return std::any_of(std::begin(kFailed), std::end(kFailed),
                       [&](const char* each) { return state == each; });
  }
  bool completed() const { return state == "COMPLETED"; }
};
using Queue = std::map<std::pair<std::string, long>, QueuedTask>;  // tasks by job and number

/// The tasks that Slurm knows, including those that ended a short time ago. Returns nothing if
/// Slurm did not answer.
std::optional<Queue> look(const std::string& name, std::string& trouble) {
  const CommandResult found = run_command({"squeue", "--noheader", "--array", "--states=all",
                                           "--name=" + name, "--format=%F %K %T %r"});
  if (found.exit_code != 0) {
    trouble = found.exit_code < 0 ? "squeue cannot be started: " + found.err : one_line(found.err);
    return {};
  }
  trouble.clear();
  Queue queue;
  for (const std::string& line : lines_of(found.out)) {
    std::istringstream words(line);
    std::string job, task;
    QueuedTask found_task;
    words >> job >> task >> found_task.state;
    std::getline(words >> std::ws, found_task.reason);
    if (!found_task.state.empty()) queue[{job, std::atol(task.c_str())}] = found_task;
  }
  return queue;
}

/// The files of tasks that have ended.
std::vector<fs::path> arrived(const fs::path& folder) {
  std::vector<fs::path> parts;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name.starts_with("part-") && name.ends_with(".db")) parts.push_back(entry.path());
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

/// The largest number of tasks in one array.
size_t most_tasks() {
  const CommandResult found = run_command({"scontrol", "show", "config"});
  for (const std::string& line : lines_of(found.out))
    if (line.starts_with("MaxArraySize")) {
      const size_t equals = line.find('=');
      const long size = equals == std::string::npos ? 0 : std::atol(line.c_str() + equals + 1);
      if (size > 1) return static_cast<size_t>(size - 1);
    }
  return static_cast<size_t>(kDefaultArray);
}

/// The script of an array. Each task computes in the temporary folder of its node. Its file appears
/// as a whole or not at all. A task that receives the signal to stop delivers the rows that it has
/// so far.
std::string script_of(const Context& context, const CaseRunner& runner, const fs::path& folder,
                      const std::string& name, long array, size_t tasks) {
  const fs::path here = fs::absolute(folder);
  std::string text = "#!/bin/sh\n#SBATCH --job-name=" + name + "\n#SBATCH --array=1-" +
                     std::to_string(tasks) + "\n#SBATCH --no-requeue\n";
  text +=
      "work=$(mktemp -d \"${SLURM_TMPDIR:-${TMPDIR:-/tmp}}/ayumi.XXXXXX\") || exit 3\n"
      "trap 'rm -rf \"$work\"' EXIT\n"
      "trap : TERM\n";
  text += "cases=$(sed -n \"${SLURM_ARRAY_TASK_ID}p\" " +
          shell_word(array_file(here, array, ".txt")) + ")\n[ -n \"$cases\" ] || exit 3\n";
  std::error_code ignored;
  text += shell_word(fs::read_symlink("/proc/self/exe", ignored)) + " sweep " +
          shell_word(fs::absolute(runner.study().file())) + " -o \"$work/part.db\" --cases " +
          "\"$cases\" --threads \"${SLURM_CPUS_PER_TASK:-1}\" --quiet --seed " +
          std::to_string(context.seed);
  if (runner.case_seconds() > 0) text += " --case-limit " + text::exact(runner.case_seconds());
  for (const std::string& robots : context.robot_path)
    text += " --robot-path " + shell_word(fs::absolute(robots));
  for (const std::string& packages : context.package_path)
    text += " --package-path " + shell_word(fs::absolute(packages));
  const std::string part = "part-" + std::to_string(array) + "-${SLURM_ARRAY_TASK_ID}";
  text += "\ncode=$?\n[ -s \"$work/part.db\" ] && [ ! -s \"$work/part.db-wal\" ] || exit 3\n";
  text += "cd " + shell_word(here) + " && cp \"$work/part.db\" \"." + part + ".tmp\" && mv \"." +
          part + ".tmp\" \"" + part + ".db\" || exit 3\n";
  text += "[ $code -le 1 ] || exit $code\nrm -f \"log-" + std::to_string(array) +
          "-${SLURM_ARRAY_TASK_ID}.txt\"\n";
  return text;
}

/// Divides cases into tasks of at most `chunk` cases.
std::deque<CaseRanges> tasks_of(const std::vector<bool>& cases, long chunk) {
  std::deque<CaseRanges> tasks;
  long in_task = chunk;
  for (long i = 0; i < static_cast<long>(cases.size()); ++i) {
    if (!cases[static_cast<size_t>(i)]) continue;
    const bool follows = !tasks.empty() && tasks.back().back().second == i - 1;
    if (in_task >= chunk || (!follows && tasks.back().size() >= kMostRanges)) {
      tasks.emplace_back();
      in_task = 0;
    }
    if (follows && in_task > 0)
      tasks.back().back().second = i;
    else
      tasks.back().emplace_back(i, i);
    ++in_task;
  }
  return tasks;
}

template <typename Visit>
void for_each_case(const CaseRanges& ranges, const Visit& visit) {
  for (const auto& [first, last] : ranges)
    for (long number = first; number <= last; ++number) visit(static_cast<size_t>(number));
}

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// One run of this engine.
class Engine {
 public:
  Engine(const Context& context, const CaseRunner& runner, ResultsDatabase& results,
         const SlurmOptions& options, const Progress& progress)
      : context_(context),
        runner_(runner),
        results_(results),
        options_(options),
        progress_(progress),
        folder_(slurm_folder(results.file())) {}

  RunCost run(const std::vector<bool>& missing) {
    require_slurm();
    fs::create_directories(folder_);
    wanted_ = missing;
    done_ = results_.done();
    tries_.assign(wanted_.size(), 0);
    total_ = std::count(wanted_.begin(), wanted_.end(), true);
    state_ = read_state(folder_);
    const std::string name =
        "ayumi-" + sha256(fs::absolute(results_.file()).string() + results_.head().fingerprint())
                       .substr(0, 12);
    if (state_.name != name) state_ = {name, {}};
    for (const auto& entry : fs::directory_iterator(folder_)) {
      long array = 0;
      if (std::sscanf(entry.path().filename().c_str(), "array-%ld.", &array) == 1)
        next_array_ = std::max(next_array_, array + 1);
    }
    for (const SubmittedArray& array : state_.arrays) take_up(array);
    collect();
    std::vector<bool> to_submit = left();
    for (const auto& [task, cases] : out_)
      for_each_case(cases, [&](size_t number) { to_submit[number] = false; });
    chunk_ = options_.chunk;
    if (chunk_ == 0 && std::count(to_submit.begin(), to_submit.end(), true) > 0) pilot(to_submit);
    pending_ = tasks_of(to_submit, chunk_);
    try {
      wait();
    } catch (const Interrupted&) {
      if (!out_.empty())
        context_.print("  " + text::counted(static_cast<long>(out_.size()), "task") +
                       " of Slurm still run. Run the same command again to collect their results, "
                       "or end these tasks with: scancel --name=" +
                       state_.name + "\n");
      throw;
    }
    const std::vector<bool> lost = left();
    const auto first = std::find(lost.begin(), lost.end(), true);
    if (first != lost.end())
      fail(ErrorCode::bad_file,
           "--engine slurm: the tasks of " +
               text::counted(static_cast<long>(std::count(first, lost.end(), true)), "case") +
               " (the first is case " + std::to_string(first - lost.begin()) + ") were lost " +
               text::counted(static_cast<long>(options_.attempts), "time") +
               (why_lost_.empty() ? "" : " (" + why_lost_ + ")") +
               ". All other results are kept. The output of the tasks is in " + folder_.string() +
               ". Run the same command again to continue");
    // Copies of tasks that counted as lost are no longer needed.
    run_command({"scancel", "--name=" + state_.name});
    fs::remove_all(folder_);
    cost_.cases = total_;
    return cost_;
  }

 private:
  void take_up(const SubmittedArray& array) {
    const std::vector<std::string> lines =
        lines_of(read_file(array_file(folder_, array.number, ".txt")));
    for (size_t i = 0; i < lines.size(); ++i)
      out_[{array.number, static_cast<long>(i) + 1}] =
          read_case_ranges(lines[i], results_.head().cases);
  }

  std::vector<bool> left() const {
    std::vector<bool> cases = wanted_;
    for (size_t i = 0; i < cases.size(); ++i) cases[i] = cases[i] && !done_[i];
    return cases;
  }

  /// Runs some cases from all parts of the study here, and removes them from `cases`.
  void pilot(std::vector<bool>& cases) {
    const long all = std::count(cases.begin(), cases.end(), true);
    const long count = std::min<long>(all, options_.pilot);
    std::vector<bool> chosen(cases.size());
    for (long i = 0, seen = 0, taken = 0; taken < count; ++i)
      if (cases[static_cast<size_t>(i)] && seen++ == taken * all / count) {
        chosen[static_cast<size_t>(i)] = true;
        ++taken;
      }
    const RunCost pilot = run_cases(runner_, results_, chosen, context_.threads, progress_);
    add_work({pilot.seconds + runner_.setup_seconds(), pilot.useful});
    for (size_t i = 0; i < cases.size(); ++i)
      if (chosen[i]) {
        cases[i] = false;
        done_[i] = true;
      }
    const double each = double(std::max(1L, pilot.cases));
    // Each task reads the inputs once and computes the data that its cases share once.
    const double setup = runner_.setup_seconds() + pilot.seconds - pilot.useful;
    const double limit = kShareOfLimit * slurm_seconds(options_.time);
    chunk_ = chunk_size(pilot.useful / each, setup, all - count,
                        limit > 0 ? std::min(limit, options_.task_seconds) : options_.task_seconds);
    context_.print("  pilot run: " + text::brief(pilot.useful / each, 3) +
                   " s of simulation for a case, " + text::brief(setup, 3) +
                   " s for the start of a task. Each task gets " + text::counted(chunk_, "case") +
                   "\n");
  }

  /// Submits the pending tasks. If Slurm refuses an array, smaller arrays are tried. If Slurm also
  /// refuses these, they stay pending while other tasks are queued or running, because most limits
  /// concern the number of tasks.
  void submit() {
    if (pending_.empty()) return;
    if (refused_ && !out_.empty() && seconds_since(*refused_) < kBetweenRefusals) return;
    if (most_ == 0) most_ = most_tasks();
    size_t count = std::min(most_, pending_.size());
    while (!pending_.empty()) {
      count = std::min(count, pending_.size());
      const std::string why = submit_array(count);
      if (why.empty()) {
        refused_.reset();
        refused_since_.reset();
        continue;
      }
      // One smaller array is enough to distinguish a limit of size from a general refusal.
      if (count > 1) {
        count = (count + 7) / 8;
        continue;
      }
      refusal_ = why;
      refused_ = Clock::now();
      if (!refused_since_) refused_since_ = refused_;
      // A limit, or a restart of the controller, may be temporary. But at the very first
      // submission, the user waits for an answer.
      if (out_.empty() && (!submitted_ || seconds_since(*refused_since_) > kLongestSilence))
        fail(ErrorCode::bad_file, "--engine slurm: sbatch refused the job: " + why +
                                      ". The results so far are kept in " +
                                      results_.file().string());
      return;
    }
  }

  /// Submits the first `count` pending tasks as one array. Returns why Slurm refused it.
  std::string submit_array(size_t count) {
    const long array = next_array_++;
    std::string lists;
    for (size_t i = 0; i < count; ++i) lists += text_of(pending_[i]) + "\n";
    const fs::path list = array_file(folder_, array, ".txt");
    const fs::path script = array_file(folder_, array, ".sh");
    write_file(list, lists);
    write_file(script, script_of(context_, runner_, folder_, state_.name, array, count));
    std::vector<std::string> words = {"sbatch", "--parsable",
                                      "--output=" + sbatch_path(fs::absolute(folder_)) + "/log-" +
                                          std::to_string(array) + "-%a.txt",
                                      "--chdir=" + fs::current_path().string()};
    if (!options_.partition.empty()) words.push_back("--partition=" + options_.partition);
    if (!options_.time.empty()) words.push_back("--time=" + options_.time);
    if (!options_.memory.empty()) words.push_back("--mem=" + options_.memory);
    words.insert(words.end(), options_.further.begin(), options_.further.end());
    words.push_back(script.string());
    const CommandResult sent = run_command(words);
    // The answer is "12" or "12;cluster".
    long job = 0;
    const auto read = std::from_chars(sent.out.data(), sent.out.data() + sent.out.size(), job);
    if (sent.exit_code != 0 || read.ec != std::errc() || job <= 0) {
      // If a job was accepted although the answer was lost, it finds no list and ends.
      fs::remove(list);
      fs::remove(script);
      const std::string why = one_line(sent.err.empty() ? sent.out : sent.err);
      return why.empty() ? "exit code " + std::to_string(sent.exit_code) : why;
    }
    submitted_ = true;
    answered_ = Clock::now();
    state_.arrays.push_back({array, std::to_string(job)});
    write_state(folder_, state_);
    for (size_t i = 0; i < count; ++i) {
      for_each_case(pending_.front(), [&](size_t number) { ++tries_[number]; });
      out_[{array, static_cast<long>(i) + 1}] = std::move(pending_.front());
      pending_.pop_front();
    }
    return "";
  }

  void add_work(const SweepWork& more) {
    results_.add_work(more);
    cost_.seconds += more.seconds;
    cost_.useful += more.useful;
  }

  /// Merges the files that have arrived. A file that is damaged or was made from other inputs is
  /// not used, and its task counts as lost.
  void collect() {
    for (const fs::path& part : arrived(folder_)) {
      const double begin = thread_seconds();
      long array = 0, task = 0;
      std::sscanf(part.filename().c_str(), "part-%ld-%ld.db", &array, &task);
      std::unique_ptr<ResultsDatabase> rows;
      try {
        rows = std::make_unique<ResultsDatabase>(part, ResultsDatabase::Mode::read);
        rows->require_study(results_.head());
        rows->require_unchanged();
      } catch (const Error& error) {
        rows.reset();
        why_lost_ = one_line(error.what());
      }
      const bool good = rows != nullptr;
      if (good) {
        results_.merge(part);
        rows->mark_done(done_);
        const SweepWork work = rows->work();
        add_work({work.seconds + thread_seconds() - begin, work.useful});
        rows.reset();
      }
      for (const char* rest : {"", "-wal", "-shm"}) {
        std::error_code ignored;
        fs::remove(part.string() + rest, ignored);
      }
      const auto at = out_.find({array, task});
      if (at == out_.end()) continue;
      if (good) why_lost_ = "a task was stopped" + words_of(at->first);
      give_back(at);
    }
  }

  /// After a task has ended, the cases that it did not run are pending again.
  std::map<TaskNumber, CaseRanges>::iterator give_back(
      std::map<TaskNumber, CaseRanges>::iterator task) {
    std::vector<bool>& again = again_;
    again.resize(done_.size());
    for_each_case(task->second, [&](size_t number) {
      if (wanted_[number] && !done_[number] && tries_[number] < options_.attempts) {
        again[number] = true;
        ++lost_;
      }
    });
    unseen_.erase(task->first);
    return out_.erase(task);
  }

  std::string job_of(long array) const {
    for (const SubmittedArray& each : state_.arrays)
      if (each.number == array) return each.job;
    return "";
  }

  /// The last line of a task's output.
  std::string words_of(const TaskNumber& task) const {
    const fs::path log = folder_ / ("log-" + std::to_string(task.first) + "-" +
                                    std::to_string(task.second) + ".txt");
    std::error_code ignored;
    if (!fs::exists(log, ignored)) return "";
    const std::vector<std::string> lines = lines_of(read_file(log));
    return lines.empty() ? "" : ": " + text::printable(lines.back());
  }

  /// Finds the tasks that ended without a result file, so that their cases are submitted again.
  void find_lost(const Queue& queue) {
    for (auto at = out_.begin(); at != out_.end();) {
      const auto known = queue.find({job_of(at->first.first), at->first.second});
      const bool alive =
          known != queue.end() && !known->second.failed() && !known->second.completed();
      if (alive) {
        unseen_.erase(at->first);
        ++at;
        continue;
      }
      auto& [looks, since] = unseen_.try_emplace(at->first, 0, Clock::now()).first->second;
      ++looks;
      const bool ended_well = known != queue.end() && known->second.completed();
      if (ended_well ? seconds_since(since) < kUnseenFile
                     : known == queue.end() && looks < kLooksUntilLost) {
        ++at;
        continue;
      }
      why_lost_ = (known == queue.end() ? "a task has disappeared from the queue"
                                        : "a task ended in the state " + known->second.state) +
                  words_of(at->first);
      at = give_back(at);
    }
  }

  /// Makes pending tasks of the cases of lost tasks.
  void take_lost() {
    if (lost_ == 0) return;
    context_.print("  " + text::counted(lost_, "case") + " of lost tasks " +
                   (lost_ == 1 ? "is" : "are") + " submitted again (" + why_lost_ + ")\n");
    for (CaseRanges& task : tasks_of(again_, chunk_ > 0 ? chunk_ : kMostCasesOfTask))
      pending_.push_back(std::move(task));
    again_.clear();
    lost_ = 0;
  }

  void pause(double seconds, const ProgressEvent& event) const {
    const auto until = Clock::now() + std::chrono::duration<double>(seconds);
    while (Clock::now() < until) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      report(progress_, event);
    }
  }

  void wait() {
    const Clock::time_point begin = Clock::now();
    answered_ = begin;
    submit();
    while (!out_.empty() || !pending_.empty()) {
      std::string trouble;
      const std::optional<Queue> queue = look(state_.name, trouble);
      // A file that arrived after the query of the queue is there now; the file of a task that
      // ended before the query has arrived.
      collect();
      long running = 0;
      std::string reason;
      if (queue) {
        answered_ = Clock::now();
        for (const auto& [task, found] : *queue) {
          running += found.running();
          if (found.state == "PENDING" && reason.empty()) reason = found.reason;
        }
        find_lost(*queue);
        take_lost();
        submit();
      } else if (seconds_since(answered_) > kLongestSilence) {
        fail(ErrorCode::bad_file,
             "--engine slurm: Slurm does not answer (" + trouble +
                 "). The results that arrived are kept. Run the same command again to continue");
      }
      if (out_.empty() && pending_.empty()) break;
      const std::vector<bool> missing = left();
      const long waiting = std::count(missing.begin(), missing.end(), true);
      std::string words =
          std::to_string(total_ - waiting) + " of " + text::counted(total_, "case") + ", " +
          text::counted(running, "task") + " running, " +
          std::to_string(static_cast<long>(out_.size() + pending_.size()) - running) + " waiting";
      if (running == 0 && !reason.empty() && reason != "None") words += " (" + reason + ")";
      if (refused_) words += ". Answer of sbatch: " + refusal_;
      if (!trouble.empty()) words += ". " + trouble;
      pause(std::clamp(seconds_since(begin) / 20, kShortestPoll, kLongestPoll),
            {"slurm", double(total_ - waiting) / double(std::max(1L, total_)), words});
    }
  }

  const Context& context_;
  const CaseRunner& runner_;
  ResultsDatabase& results_;
  const SlurmOptions& options_;
  const Progress& progress_;
  fs::path folder_;
  State state_;
  std::vector<bool> wanted_, done_;       // by case: whether it is wanted, and whether it is done
  std::vector<unsigned char> tries_;      // by case: number of tries in this run of the engine
  std::map<TaskNumber, CaseRanges> out_;  // tasks that have not arrived, with their cases
  // Number of queries without the task, and the time of the first.
  std::map<TaskNumber, std::pair<int, Clock::time_point>> unseen_;
  std::deque<CaseRanges> pending_;  // tasks to be submitted
  std::vector<bool> again_;         // by case: whether it belongs to a lost task
  long lost_ = 0;                   // number of these cases
  std::string why_lost_, refusal_;
  // Times of the last and of the first refusal.
  std::optional<Clock::time_point> refused_, refused_since_;
  Clock::time_point answered_ = Clock::now();
  bool submitted_ = false;
  size_t most_ = 0;
  long next_array_ = 1, chunk_ = 0, total_ = 0;
  RunCost cost_;
};

}  // namespace

fs::path slurm_folder(const fs::path& results) { return results.string() + ".slurm"; }

CaseRanges read_case_ranges(const std::string& text, long count) {
  CaseRanges ranges;
  const auto refuse = [&] {
    fail(ErrorCode::usage, "--cases: '" + text::printable(text.substr(0, 60)) +
                               "' is not a list of cases. Write numbers from 0 to " +
                               std::to_string(count - 1) + " in rising order, such as 0-99,120");
  };
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    long first = 0;
    auto read = std::from_chars(at, end, first);
    if (read.ec != std::errc()) refuse();
    long last = first;
    at = read.ptr;
    if (at != end && *at == '-') {
      read = std::from_chars(at + 1, end, last);
      if (read.ec != std::errc()) refuse();
      at = read.ptr;
    }
    if (first < 0 || last < first || last >= count ||
        (!ranges.empty() && first <= ranges.back().second))
      refuse();
    ranges.emplace_back(first, last);
    if (at == end) return ranges;
    if (*at++ != ',') refuse();
  }
}

std::string text_of(const CaseRanges& ranges) {
  std::string text;
  for (const auto& [first, last] : ranges)
    text += (text.empty() ? "" : ",") + std::to_string(first) +
            (last > first ? "-" + std::to_string(last) : "");
  return text;
}

long chunk_size(double seconds, double setup, long cases, double task_seconds) {
  const double each = std::max(seconds, 1e-6);
  const auto of_time = [&](double time) {
    return static_cast<long>(std::ceil(std::min(time / each, 1e9)));
  };
  const long fewest = std::max(1L, of_time(setup / kSetupShare));
  long chunk = std::max(1L, of_time(task_seconds));
  // The tasks of short studies are spread over the nodes.
  chunk = std::min(chunk, std::max(fewest, (cases + kFewestTasks - 1) / kFewestTasks));
  return std::clamp(chunk, 1L, kMostCasesOfTask);
}

double slurm_seconds(const std::string& time) {
  long days = 0;
  std::string rest = time;
  const size_t dash = time.find('-');
  if (dash != std::string::npos) {
    days = std::atol(time.c_str());
    rest = time.substr(dash + 1);
  }
  std::vector<long> parts;
  std::istringstream stream(rest);
  for (std::string part; std::getline(stream, part, ':');) {
    long value = 0;
    const auto read = std::from_chars(part.data(), part.data() + part.size(), value);
    if (read.ec != std::errc() || read.ptr != part.data() + part.size() || value < 0) return 0;
    parts.push_back(value);
  }
  if (parts.empty() || parts.size() > 3) return 0;
  // The time is "minutes[:seconds]" or "hours:minutes:seconds"; with days, it is
  // "hours[:minutes[:seconds]]".
  if (dash == std::string::npos && parts.size() < 3) parts.insert(parts.begin(), 0);
  parts.resize(3);
  return double(((days * 24 + parts[0]) * 60 + parts[1]) * 60 + parts[2]);
}

void require_slurm() {
  const CommandResult found = run_command({"sbatch", "--version"});
  if (found.exit_code == 0) return;
  if (found.exit_code < 0)
    fail(ErrorCode::bad_file, "--engine slurm: the program sbatch cannot be started (" + found.err +
                                  "). Install slurm-client on this machine, or leave --engine out");
  fail(ErrorCode::bad_file,
       "--engine slurm: sbatch fails on this machine (" +
           (found.err.empty() ? "exit code " + std::to_string(found.exit_code)
                              : one_line(found.err)) +
           "). Correct the configuration of Slurm (slurm.conf, or the variable SLURM_CONF), or "
           "leave --engine out");
}

RunCost run_on_slurm(const Context& context, const CaseRunner& runner, ResultsDatabase& results,
                     const std::vector<bool>& missing, const SlurmOptions& options,
                     const Progress& progress) {
  if (std::find(missing.begin(), missing.end(), true) == missing.end()) return {};
  return Engine(context, runner, results, options, progress).run(missing);
}

SlurmStatus slurm_status(const fs::path& results) {
  SlurmStatus status;
  const fs::path folder = slurm_folder(results);
  if (!fs::exists(folder / "state.json")) return status;
  const State state = read_state(folder);
  status.exists = true;
  status.name = state.name;
  status.arrived = static_cast<long>(arrived(folder).size());
  if (const auto queue = look(state.name, status.trouble))
    for (const auto& [task, found] : *queue) {
      if (found.running()) ++status.running;
      if (found.state != "PENDING") continue;
      ++status.waiting;
      status.reason = found.reason;
    }
  return status;
}

}  // namespace ayumi::app
