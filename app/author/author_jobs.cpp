#include "author/author_jobs.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <map>
#include <optional>
#include <utility>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/plot/push_map.hpp"
#include "ayumi/report/replay.hpp"
#include "ayumi/study/push.hpp"
#include "ayumi/task/foothold_collisions.hpp"
#include "ayumi/task/plan_log.hpp"
#include "ayumi/task/run_stability.hpp"
#include "check_table.hpp"
#include "motion_words.hpp"
#include "repairing.hpp"
#include "simulation.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

// The lines of a text as JSON, without the spaces at their beginnings.
OrderedJson json_lines_of(const std::string& text) {
  OrderedJson lines = OrderedJson::array();
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const size_t words = text.find_first_not_of(' ', begin);
    if (words < end) lines.push_back(text.substr(words, end - words));
    begin = end + 1;
  }
  return lines;
}

OrderedJson result_json(const std::string& kind, const std::string& verdict, bool good,
                        const OrderedJson& lines) {
  return {{"kind", kind},
          {"verdict", verdict},
          {"good", good},
          {"lines", lines},
          {"marks", OrderedJson::array()},
          {"files", OrderedJson::array()}};
}

std::string counted_findings(const Judgement& judgement) {
  std::map<Severity, int> count;
  for (const Finding& f : judgement.report.findings) ++count[f.severity];
  return text::counted(count[Severity::error], "error") + ", " +
         text::counted(count[Severity::warning], "warning") + ", " +
         text::counted(count[Severity::info], "info", "info");
}

AuthorResult check_job(const AuthorMotion& motion, const Progress& progress) {
  const Judgement& judgement = motion.judgement;
  const Task& task = motion.task;
  OrderedJson lines = OrderedJson::array();
  std::vector<Mistake> mistakes;
  if (!judgement.good())
    mistakes = likely_causes(task, check_options(task), judgement.report, progress);
  for (const std::string& cause : cause_texts(mistakes)) lines.push_back("Likely cause: " + cause);
  const std::string& need = judgement.need().text;
  if (!need.empty()) lines.push_back(need);
  for (const std::string& reason : export_refusals(task, judgement))
    if (reason != judgement.reason())
      lines.push_back("`ayumi export` would refuse the table of this pattern: " + reason);
  lines.push_back(counted_findings(judgement) + ", profile " + task.profile);
  lines.push_back("Share of the limits: " + shares_of_limits(judgement.report, task.robot));
  for (const Mistake& mistake : mistakes)
    if (!mistake.is_cause) lines.push_back("Note: " + mistake.words);
  return {result_json("check", judgement.good() ? "The pattern is consistent." : judgement.reason(),
                      judgement.good(), lines),
          {}};
}

AuthorResult repair_job(const AuthorMotion& motion, const std::string& text,
                        const Progress& progress) {
  const Task& task = motion.task;
  RepairOptions options = preferred_options(task.pattern);
  options.check = check_options(task);
  const RepairResult result = repair_task(task, options, progress);
  if (result.status == RepairStatus::already_consistent)
    return {result_json("repair", "The pattern is consistent, so nothing has to change.", true,
                        OrderedJson::array()),
            {}};
  const bool repaired = result.status == RepairStatus::repaired;
  OrderedJson lines =
      json_lines_of(motion_words(task.robot, result.moved, result.before, result.check));
  for (const std::string& reason : result.reasons) lines.push_back("Reason: " + reason);
  AuthorResult out = {
      result_json("repair",
                  repaired ? "The pattern can be repaired. The ghost shows the repaired motion."
                           : "No repair was found.",
                  repaired, lines),
      {}};
  if (!repaired) return out;
  out.shown["text"] = with_correction(text, result.correction);
  const int stride = std::max(1, static_cast<int>(std::lround(1 / kPageRate / result.series.dt)));
  out.series["repair"] = live_series(
      plan_log(task.robot, task.robot.limits(task.profile), result.series, result.series, stride),
      kPageRate);
  out.strips["repair"] =
      author_strip(task, stability_series(task.robot, result.series, options.check));
  return out;
}

// The law of the pattern; a pattern without a law is tried with DTAD.
ControllerSpec law_of(const Task& task) {
  if (task.pattern.controller.type != ControllerKind::none) return task.pattern.controller;
  return {ControllerKind::dtad, {}};
}

AuthorResult simulate_job(const OrderedJson& asked, const Context& context,
                          const AuthorMotion& motion, const Progress& progress) {
  const Task& task = motion.task;
  const std::string law = asked.value("law", "both");
  if (law != "none" && law != "closed" && law != "both")
    fail(ErrorCode::usage, "law '" + law + "' is not one of 'none', 'closed' and 'both'");
  struct Run {
    const char* name;
    ControllerSpec spec;
  };
  std::vector<Run> runs;
  if (law != "closed") runs.push_back({"open_loop", {ControllerKind::none, {}}});
  if (law != "none") runs.push_back({"closed_loop", law_of(task)});
  OrderedJson lines = OrderedJson::array(), marks = OrderedJson::array();
  AuthorResult out;
  std::string verdict;
  bool good = false;
  std::optional<SimulationLog> open_run;
  for (const Run& run : runs) {
    SimulateOptions options = simulate_options(task);
    options.controller = run.spec;
    options.seed = context.seed;
    if (run.spec.type != ControllerKind::none) refuse_unstable_gains(task, run.spec, false);
    SimulationLog log = simulate(task, options, progress);
    const std::string who = run.spec.type == ControllerKind::none
                                ? "in open loop"
                                : std::string("with ") + name_of(run.spec.type);
    lines.push_back(outcome_text(log));
    if (open_run)
      if (const auto worse = worse_than_open_loop(*open_run, log); !worse.empty())
        lines.push_back(std::string(kWorseWithControl) + ": " + text::join(worse, "; "));
    good = log.result.outcome == Outcome::stands;
    verdict = log.result.outcome == Outcome::stands ? "The robot stands " + who + "."
              : log.result.outcome == Outcome::fell
                  ? "The robot falls " + who + " at " + text::fixed(log.result.fell_at, 2) + " s."
                  : "The robot does not settle " + who + ".";
    // The pushes are the same in each run, but the falls are not.
    for (const SimulationEvent& event : log.events)
      if (event.kind == EventKind::fell)
        marks.push_back({{"time", event.t}, {"text", who + ": fell, " + event.text}});
      else if (event.kind == EventKind::push && out.series.empty())
        marks.push_back({{"time", event.t}, {"text", "push, " + event.text}});
    out.series[run.name] = live_series(log, kPageRate);
    out.strips[run.name] =
        author_strip(task, run_stability(task.robot, task.robot.limits(task.profile), log));
    if (run.spec.type == ControllerKind::none) open_run = std::move(log);
  }
  out.shown = result_json("simulate", verdict, good, lines);
  out.shown["marks"] = marks;
  return out;
}

AuthorResult push_job(const Context& context, const AuthorMotion& motion,
                      const Progress& progress) {
  const Task& task = motion.task;
  PushOptions options;
  options.threads = context.threads;
  options.simulate.profile = task.profile;
  options.simulate.world = task.pattern.world;
  options.simulate.seed = context.seed;
  options.controllers = {law_of(task)};
  refuse_unstable_gains(task, options.controllers.front(), false);
  SimulateOptions gait = options.simulate;
  gait.controller = options.controllers.front();
  options.phases = default_push_phases(task.robot, task.series, gait);
  const std::vector<PushCase> cases =
      push_limits(task.robot, task.series, options, {}, {}, progress);
  OrderedJson lines = OrderedJson::array(), marks = OrderedJson::array();
  for (const std::string& line : push_summary_lines(cases, options, task.series))
    lines.push_back(line);
  lines.push_back(kPushBoundLegend);
  double least = 0;
  const PushCase* weakest = nullptr;
  for (size_t i = 0; i < cases.size(); ++i) {
    const PushCase& one = cases[i];
    const double impulse = one.limits.front().impulse;
    if (!weakest || impulse < least) {
      weakest = &one;
      least = impulse;
    }
    if (i % static_cast<size_t>(options.directions) != 0) continue;
    double lowest = impulse;
    for (size_t k = 1; k < static_cast<size_t>(options.directions) && i + k < cases.size(); ++k)
      lowest = std::min(lowest, cases[i + k].limits.front().impulse);
    marks.push_back({{"time", one.phase.at},
                     {"text", one.phase.name + ": the robot survives " + text::fixed(lowest, 2) +
                                  " N s in every direction"}});
  }
  const std::string verdict =
      weakest ? "The robot survives " + text::fixed(least, 2) +
                    " N s at every time and in every direction. The smallest push limit is at " +
                    text::fixed(weakest->phase.at, 2) + " s, for a push in the direction of " +
                    text::fixed(weakest->direction * 180 / M_PI, 0) +
                    " degrees (0 is forward, 90 is to the left)."
              : "There was no push to try.";
  AuthorResult out = {result_json("push", verdict, weakest && least > 0, lines), {}};
  out.shown["marks"] = marks;
  return out;
}

// ---- export: the command itself runs as a child process, so that only its rules apply

struct Said {
  int exit_code = 0;
  std::string out, err;
};

Said run_command(const std::vector<std::string>& arguments, const fs::path& folder,
                 const Progress& progress) {
  std::array<int, 2> out{}, err{};
  if (::pipe(out.data()) != 0 || ::pipe(err.data()) != 0)
    fail(ErrorCode::bad_file,
         "the export cannot be started, because the system allows no more pipes. Close other "
         "programs and try again");
  std::vector<char*> words;
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const std::string where = folder.string();
  const pid_t child = ::fork();
  if (child < 0)
    fail(ErrorCode::bad_file,
         "the export cannot be started, because the system allows no more processes. Close other "
         "programs and try again");
  if (child == 0) {
    ::dup2(out[1], STDOUT_FILENO);
    ::dup2(err[1], STDERR_FILENO);
    for (const int pipe : {out[0], out[1], err[0], err[1]}) ::close(pipe);
    if (::chdir(where.c_str()) == 0) ::execv("/proc/self/exe", words.data());
    ::_exit(127);
  }
  ::close(out[1]);
  ::close(err[1]);
  Said said;
  std::array<pollfd, 2> pipes = {pollfd{out[0], POLLIN, 0}, pollfd{err[0], POLLIN, 0}};
  std::array<std::string*, 2> into = {&said.out, &said.err};
  bool stopped = false;
  for (int open = 2; open > 0;) {
    // [ms] time between two queries of the progress, which may stop the work.
    constexpr int kLook = 50;
    ::poll(pipes.data(), pipes.size(), kLook);
    if (!stopped && progress && !progress({"exporting", -1, ""})) {
      stopped = true;
      ::kill(child, SIGTERM);
    }
    for (size_t i = 0; i < pipes.size(); ++i) {
      if (pipes[i].fd < 0 || (pipes[i].revents & (POLLIN | POLLHUP)) == 0) continue;
      char buffer[4096];
      const ssize_t got = ::read(pipes[i].fd, buffer, sizeof buffer);
      if (got < 0 && errno == EINTR) continue;
      if (got > 0) {
        into[i]->append(buffer, static_cast<size_t>(got));
        continue;
      }
      ::close(pipes[i].fd);
      pipes[i].fd = -1;
      --open;
    }
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (stopped) throw Interrupted();
  said.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 5;
  return said;
}

// The first of the names walk_hoap.csv, walk_hoap_2.csv, ... that is free.
fs::path free_name(const fs::path& pattern, const std::string& ending) {
  for (int i = 1;; ++i) {
    const std::string number = i == 1 ? "" : "_" + std::to_string(i);
    const fs::path name =
        pattern.parent_path() / (pattern.stem().string() + "_" + ending + number + ".csv");
    std::error_code ignored;
    if (!fs::exists(fs::symlink_status(name, ignored))) return name;
  }
}

AuthorResult export_job(const Context& context, const AuthorMotion& motion,
                        const AuthorSetting& setting, const Progress& progress) {
  const auto& dofs = motion.task.robot.dofs();
  const bool hoap =
      std::any_of(dofs.begin(), dofs.end(), [](const Dof& dof) { return dof.encoder.device > 0; });
  const std::string format = hoap ? "hoap" : "csv";
  const fs::path file = free_name(setting.file, hoap ? "hoap" : "table");
  std::vector<std::string> arguments = {"ayumi",       "export", setting.file.string(),
                                        "--format",    format,   "-o",
                                        file.string(), "--json", "--quiet"};
  for (const std::string& folder : context.robot_path) {
    arguments.push_back("--robot-path");
    arguments.push_back(fs::absolute(folder).string());
  }
  for (const auto& [name, value] : setting.set) {
    arguments.push_back("--set");
    arguments.push_back(name + "=" + text::exact(value));
  }
  const Said said = run_command(arguments, setting.file.parent_path(), progress);
  const OrderedJson json = OrderedJson::parse(said.out, nullptr, false);
  if (said.exit_code > 1 || json.is_discarded())
    fail(ErrorCode::bad_file, said.err.empty() ? "the export failed" : said.err);
  OrderedJson lines = OrderedJson::array();
  if (json.contains("refused"))
    for (const auto& reason : json["refused"]) lines.push_back(reason);
  AuthorResult out = {
      result_json("export",
                  said.exit_code == 0 ? "The table is written."
                                      : "The table is refused, so nothing is written.",
                  said.exit_code == 0, lines),
      {}};
  if (said.exit_code == 0) out.shown["files"] = {file.filename().string()};
  return out;
}

}  // namespace

const std::vector<std::string>& author_job_kinds() {
  static const std::vector<std::string> kinds = {"check", "repair", "simulate", "push", "export"};
  return kinds;
}

AuthorResult author_job(const std::string& kind, const OrderedJson& options, const Context& context,
                        const AuthorMotion& motion, const std::string& text,
                        const AuthorSetting& setting, const Progress& progress) {
  if (kind == "check") return check_job(motion, progress);
  if (kind == "repair") return repair_job(motion, text, progress);
  if (kind == "simulate") return simulate_job(options, context, motion, progress);
  if (kind == "push") return push_job(context, motion, progress);
  if (kind == "export") return export_job(context, motion, setting, progress);
  fail(ErrorCode::usage, "there is no job '" + kind + "'");
}

}  // namespace ayumi::app
