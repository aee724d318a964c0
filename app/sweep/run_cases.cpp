#include "sweep/run_cases.hpp"

#include <chrono>
#include <exception>

#include "ayumi/base/error.hpp"
#include "ayumi/base/in_parallel.hpp"

namespace ayumi::app {

namespace {

/// Time between two commits. Chosen: a killed program loses so much; a commit of some rows takes
/// about 1 ms, so half of it costs 0.4 % and twice of it 0.1 %.
constexpr std::chrono::milliseconds kBetweenCommits(500);
/// Rows that are kept in memory at most. Chosen: some MB.
constexpr size_t kMostWaiting = 5000;

}  // namespace

RunCost run_cases(const CaseRunner& runner, ResultsDatabase& results,
                  const std::vector<long>& numbers, int threads, const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  std::atomic<bool> stop = false;
  std::mutex mutex;
  std::vector<CaseRow> waiting;
  Clock::time_point committed = Clock::now();
  double writing = 0;
  size_t finished = 0;
  bool broken = false;  // the file takes no more
  const double before = runner.seconds(), useful = runner.useful_seconds();
  const auto commit = [&] {
    if (broken) return;
    const Clock::time_point begin = Clock::now();
    broken = true;
    results.add(waiting);
    broken = false;
    waiting.clear();
    committed = Clock::now();
    writing += std::chrono::duration<double>(committed - begin).count();
  };
  std::exception_ptr error;
  try {
    in_parallel(numbers.size(), threads, stop, [&](size_t i) {
      CaseRow row = runner.run(numbers[i]);
      const std::lock_guard lock(mutex);
      waiting.push_back(std::move(row));
      ++finished;
      if (Clock::now() - committed > kBetweenCommits || waiting.size() >= kMostWaiting) commit();
      report(progress,
             {"sweep", double(finished) / double(numbers.size()),
              std::to_string(finished) + " of " + std::to_string(numbers.size()) + " cases"});
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
