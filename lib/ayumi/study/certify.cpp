#include "ayumi/study/certify.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <numeric>

#include "ayumi/base/error.hpp"
#include "ayumi/base/in_parallel.hpp"

namespace ayumi {

namespace {

/// Number of cases between two examinations by the test. Chosen: enough for many threads. At most
/// that many cases are run without need. The results do not depend on it.
constexpr long kBatch = 64;
/// Largest number of runs, as a multiple of the number without a failure. Chosen: a robot that
/// fails with a fifth of the permitted probability is then certified with a probability of 96 % (p0
/// = 0.01, confidence 0.95); five times gives 90 %, twenty times 98 %.
constexpr long kMostRuns = 10;

std::vector<bool> failures_in_order(const KnownResults& results) {
  std::vector<bool> failed;
  for (const auto& result : results) {
    if (!result) break;
    failed.push_back(result->failed());
  }
  return failed;
}

SequentialTest test_of(const CertifyOptions& options) {
  return {options.failure, options.confidence, most_cases(options)};
}

double bound_of(const KnownResults& results, long runs, long rank, double CaseResult::*figure) {
  std::vector<double> values;
  for (long i = 0; i < runs; ++i) {
    const CaseResult& result = *results[static_cast<size_t>(i)];
    const bool fell = result.outcome == Outcome::fell;
    values.push_back(fell ? std::numeric_limits<double>::infinity() : result.*figure);
  }
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(rank - 1)];
}

}  // namespace

long most_cases(const CertifyOptions& options) {
  if (options.most > 0) return options.most;
  return kMostRuns * failure_free_runs(options.failure, options.confidence);
}

void run_numbers(const UncertainTask& task, const std::vector<long>& numbers,
                 const CertifyOptions& options, KnownResults& results, const ResultsKnown& save,
                 const Progress& progress) {
  std::atomic<bool> stop = false;
  std::mutex mutex;
  in_parallel(numbers.size(), options.threads, stop, [&](size_t i) {
    const long number = numbers[i];
    const CaseResult result = task.run(task.numbers(options.seed, number));
    const std::lock_guard lock(mutex);
    results[static_cast<size_t>(number)] = result;
    report(progress,
           {"certifying", static_cast<double>(number) / static_cast<double>(results.size()),
            "case " + std::to_string(number)});
  });
  if (save && !numbers.empty()) save(results);
}

KnownResults run_cases(const UncertainTask& task, const CertifyOptions& options,
                       const KnownResults& known, const ResultsKnown& save,
                       const Progress& progress) {
  const SequentialTest test = test_of(options);
  const long most = most_cases(options);
  KnownResults results = known;
  results.resize(static_cast<size_t>(most));
  for (long i = 0; i < most; ++i)
    task.check(task.draw(task.numbers(options.seed, i)), "case " + std::to_string(i));
  const bool whole = options.all || options.shards > 1;
  long failures = 0;
  for (long begin = 0; begin < most;) {
    long end = std::min(most, begin + kBatch * options.shards);
    // Without another failure the test stops there, and later cases would be run without need.
    if (!whole && failures < static_cast<long>(test.plan().size()))
      end = std::min(end, std::max(begin + 1, test.plan()[static_cast<size_t>(failures)]));
    std::vector<long> wanted;
    for (long i = begin; i < end; ++i)
      if (i % options.shards == options.shard && !results[static_cast<size_t>(i)])
        wanted.push_back(i);
    run_numbers(task, wanted, options, results, {}, progress);
    begin = end;
    bool stopped = false;
    if (!whole) {
      const SequentialOutcome outcome = test.outcome(failures_in_order(results));
      failures = outcome.failures;
      stopped = outcome.stopped;
      if (stopped) std::fill(results.begin() + outcome.runs, results.end(), std::nullopt);
    }
    // Only cases that the test uses are saved, so that a program that is killed here leaves no
    // others.
    if (save && !wanted.empty()) save(results);
    if (stopped) break;
  }
  return results;
}

Certificate certificate(const CertifyOptions& options, const KnownResults& results) {
  const SequentialTest test = test_of(options);
  Certificate c;
  c.outcome = test.outcome(failures_in_order(results));
  c.upper = test.upper_bound(c.outcome);
  c.lower = test.lower_bound(c.outcome);
  for (long i = 0; i < c.outcome.runs; ++i) {
    c.falls += results[static_cast<size_t>(i)]->outcome == Outcome::fell;
    c.unsettled += results[static_cast<size_t>(i)]->outcome == Outcome::unsettled;
  }
  const long first = failure_free_runs(options.failure, options.confidence);
  if (c.outcome.runs < first) return c;
  const long rank = quantile_bound_rank(first, 1 - options.failure, options.confidence);
  if (rank == 0) return c;
  c.largest = {.cog_error = bound_of(results, first, rank, &CaseResult::cog_error),
               .torque = bound_of(results, first, rank, &CaseResult::torque),
               .foot_tilt = bound_of(results, first, rank, &CaseResult::foot_tilt),
               .runs = first};
  return c;
}

PairedComparison compare(const KnownResults& first, const KnownResults& second, double confidence) {
  PairedComparison c;
  for (size_t i = 0; i < std::min(first.size(), second.size()); ++i) {
    if (!first[i] || !second[i]) continue;
    ++c.pairs;
    c.both += first[i]->failed() && second[i]->failed();
    c.only_first += first[i]->failed() && !second[i]->failed();
    c.only_second += !first[i]->failed() && second[i]->failed();
  }
  c.p_value = mcnemar(c.only_first, c.only_second);
  c.difference = paired_difference(c.only_first, c.only_second, c.pairs, confidence);
  return c;
}

std::vector<ValueInfluence> influences(const UncertainTask& task, const CertifyOptions& options,
                                       const KnownResults& results) {
  std::vector<ValueInfluence> found(task.values().size());
  std::vector<std::vector<double>> drawn(found.size());
  std::vector<double> severities;
  for (size_t number = 0; number < results.size(); ++number) {
    if (!results[number]) continue;
    const CaseNumbers numbers = task.numbers(options.seed, static_cast<long>(number));
    const std::vector<double> shares = task.shares(numbers), values = task.draw(numbers);
    severities.push_back(severity(*results[number]));
    for (size_t i = 0; i < found.size(); ++i) {
      drawn[i].push_back(values[i]);
      const size_t half = shares[i] < 0.5 ? 0 : 1;
      ++found[i].runs[half];
      found[i].failures[half] += results[number]->failed();
    }
  }
  for (size_t i = 0; i < found.size(); ++i) {
    found[i].name = task.values()[i].name;
    found[i].correlation = rank_correlation(drawn[i], severities);
    for (size_t half = 0; half < 2; ++half)
      found[i].rate[half] =
          clopper_pearson(found[i].failures[half], found[i].runs[half], options.confidence);
  }
  // A value that is the same in all runs, such as a fixed size of a push, shows no influence.
  std::vector<ValueInfluence> varying;
  for (size_t i = 0; i < found.size(); ++i)
    if (std::adjacent_find(drawn[i].begin(), drawn[i].end(), std::not_equal_to<>()) !=
        drawn[i].end())
      varying.push_back(found[i]);
  return varying;
}

std::vector<long> worst_cases(const KnownResults& results, size_t count) {
  std::vector<long> numbers;
  for (size_t i = 0; i < results.size(); ++i)
    if (results[i]) numbers.push_back(static_cast<long>(i));
  std::stable_sort(numbers.begin(), numbers.end(), [&](long a, long b) {
    return severity(*results[static_cast<size_t>(a)]) > severity(*results[static_cast<size_t>(b)]);
  });
  numbers.resize(std::min(numbers.size(), count));
  return numbers;
}

}  // namespace ayumi
