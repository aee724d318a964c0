#include "sweep/run_cases.hpp"

#include <algorithm>
#include <chrono>
#include <exception>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/in_parallel.hpp"
#include "ayumi/base/processor_time.hpp"

namespace ayumi::app {

namespace {

/// Time between two commits. Chosen: a killed program loses the rows of this time. A commit of some
/// rows takes about 1 ms, so half of this time costs 0.4 % and twice this time 0.1 %.
constexpr std::chrono::milliseconds kBetweenCommits(500);
/// Largest number of rows that are kept in memory. Chosen: some MB.
constexpr size_t kMostWaiting = 5000;

}  // namespace

RunCost run_cases(const CaseRunner& runner, ResultsDatabase& results,
                  const std::vector<bool>& cases, int threads, const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  std::atomic<bool> stop = false;
  std::mutex mutex;
  std::vector<CaseRow> waiting;
  Clock::time_point committed = Clock::now();
  double writing = 0;
  const auto count = static_cast<size_t>(std::count(cases.begin(), cases.end(), true));
  size_t finished = 0, next = 0;
  bool broken = false;  // whether the file accepts no more rows
  const double before = runner.seconds(), useful = runner.useful_seconds();
  const auto commit = [&] {
    if (broken) return;
    const double begin = thread_seconds();
    broken = true;
    results.add(waiting);
    broken = false;
    waiting.clear();
    committed = Clock::now();
    writing += thread_seconds() - begin;
  };
  const auto state = [&](const std::string& more) {
    return ProgressEvent{
        "sweep", double(finished) / double(count),
        std::to_string(finished) + " of " + text::counted(static_cast<long>(count), "case") + more};
  };
  std::exception_ptr error;
  try {
    in_parallel(count, threads, stop, [&](size_t) {
      long number = 0;
      {
        const std::lock_guard lock(mutex);
        while (!cases[next]) ++next;
        number = static_cast<long>(next++);
      }
      CaseRow row = runner.run(number, [&](const ProgressEvent& event) {
        const std::lock_guard lock(mutex);
        return !progress || progress(state(", case " + std::to_string(number) + ": " + event.stage +
                                           " " + event.detail));
      });
      const std::lock_guard lock(mutex);
      waiting.push_back(std::move(row));
      ++finished;
      if (Clock::now() - committed > kBetweenCommits || waiting.size() >= kMostWaiting) commit();
      report(progress, state(""));
    });
  } catch (...) {
    error = std::current_exception();
  }
  commit();
  if (error) std::rethrow_exception(error);
  return {.cases = static_cast<long>(finished),
          .seconds = runner.seconds() - before + writing,
          .useful = runner.useful_seconds() - useful};
}

}  // namespace ayumi::app
