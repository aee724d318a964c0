#include "ayumi/study/subset_simulation.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>

#include "ayumi/base/error.hpp"
#include "ayumi/base/in_parallel.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/random.hpp"

namespace ayumi {

namespace {

/// Correlation of a proposed sample with the one before. Chosen: between a third and a half of the
/// proposals are then accepted at a share of 0.1. The value affects the variance of the estimate
/// but not its mean.
constexpr double kStay = 0.8;
/// Probability that a proposal has another noise of the sensors. Chosen: noise and values then both
/// move. The value affects the variance of the estimate but not its mean.
constexpr double kNewNoise = 0.5;

struct Sample {
  CaseNumbers numbers;
  double severity = 0;
};

Random chain_random(std::uint64_t seed, int level, size_t chain) {
  const std::uint64_t mixed =
      Random(Random(seed).bits() ^ (0x5bd1e995u + static_cast<std::uint64_t>(level))).bits();
  return Random(Random(mixed).bits() + chain);
}

/// One step of a chain whose stationary distribution is the standard normal one above the level.
Sample proposal(const Sample& from, Random& random) {
  Sample next = from;
  for (double& z : next.numbers.normal)
    z = kStay * z + std::sqrt(1 - kStay * kStay) * random.normal();
  const std::uint64_t noise = random.bits();
  if (random.uniform() < kNewNoise) next.numbers.noise = noise;
  return next;
}

/// Factor 1 + gamma by which the correlation within the chains of `length` samples increases the
/// variance of the share of `above`.
double chain_factor(const std::vector<bool>& above, size_t length) {
  const size_t n = above.size(), chains = n / length;
  const double p =
      static_cast<double>(std::count(above.begin(), above.end(), true)) / static_cast<double>(n);
  const double variance = p * (1 - p);
  if (length < 2 || !(variance > 0)) return 1;
  double gamma = 0;
  for (size_t lag = 1; lag < length; ++lag) {
    double product = 0;
    for (size_t c = 0; c < chains; ++c)
      for (size_t i = 0; i + lag < length; ++i)
        product += above[c * length + i] && above[c * length + i + lag];
    product /= static_cast<double>(chains * (length - lag));
    const double weight = 1 - static_cast<double>(lag) / static_cast<double>(length);
    gamma += 2 * weight * (product - p * p) / variance;
  }
  return std::max(1.0, 1 + gamma);
}

}  // namespace

SubsetResult subset_simulation(size_t dimension,
                               const std::function<double(const CaseNumbers&)>& severity,
                               double threshold, double confidence, const SubsetOptions& options,
                               const Progress& progress) {
  const auto kept =
      static_cast<size_t>(std::lround(options.share * static_cast<double>(options.runs)));
  const auto length = static_cast<size_t>(std::lround(1 / options.share));
  if (options.runs < 1 || kept * length != static_cast<size_t>(options.runs))
    fail(ErrorCode::usage,
         "the number of runs of a level must be a multiple of " + std::to_string(length));
  std::vector<Sample> samples(static_cast<size_t>(options.runs));
  std::atomic<bool> stop = false;
  std::mutex mutex;
  SubsetResult result;
  long done = 0;
  const auto note_run = [&] {
    const std::lock_guard lock(mutex);
    ++done;
    report(progress, {"searching for rare failures",
                      static_cast<double>(done % options.runs) / static_cast<double>(options.runs),
                      "level " + std::to_string(result.levels.size() + 1)});
  };
  in_parallel(samples.size(), options.threads, stop, [&](size_t i) {
    Random random = chain_random(options.seed, 0, i);
    for (size_t k = 0; k < dimension; ++k) samples[i].numbers.normal.push_back(random.normal());
    samples[i].numbers.noise = random.bits();
    samples[i].severity = severity(samples[i].numbers);
    note_run();
  });
  double probability = 1, variance = 0;
  for (int level = 0;; ++level) {
    std::vector<size_t> order(samples.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return samples[a].severity > samples[b].severity; });
    const double next = std::min(threshold, samples[order[kept - 1]].severity);
    std::vector<bool> above;
    for (const Sample& sample : samples) above.push_back(sample.severity >= next);
    const auto count = static_cast<size_t>(std::count(above.begin(), above.end(), true));
    const double p = static_cast<double>(count) / static_cast<double>(samples.size());
    probability *= p;
    variance += (1 - p) / (p * static_cast<double>(samples.size())) *
                (level == 0 ? 1.0 : chain_factor(above, length));
    result.levels.push_back(next);
    result.reached = next >= threshold;
    if (result.reached || level + 1 >= options.levels) break;
    // Samples above the level start the chains. If equal severities give more of these samples than
    // are needed, samples at equal intervals are taken, so that the choice does not depend on the
    // severity. The chains have such lengths that the number of samples is kept.
    std::vector<size_t> starts;
    for (size_t i = 0; i < samples.size(); ++i)
      if (above[i]) starts.push_back(i);
    std::vector<Sample> chains(samples.size());
    in_parallel(kept, options.threads, stop, [&](size_t c) {
      Random random = chain_random(options.seed, level + 1, c);
      Sample state = samples[starts[c * starts.size() / kept]];
      for (size_t i = 0; i < length; ++i) {
        Sample other = proposal(state, random);
        other.severity = severity(other.numbers);
        if (other.severity >= next) state = other;
        chains[c * length + i] = state;
        note_run();
      }
    });
    samples = std::move(chains);
  }
  result.probability = probability;
  result.variation = std::sqrt(variance);
  const double spread =
      normal_quantile(0.5 * (1 + confidence)) * std::sqrt(elementary::log1p(variance));
  result.interval = {probability * elementary::exp(-spread),
                     std::min(1.0, probability * elementary::exp(spread))};
  result.runs = done;
  return result;
}

}  // namespace ayumi
