#pragma once
// What studies of many runs share.

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "ayumi/sim/simulator.hpp"

namespace ayumi {

inline constexpr double kStandingPush = 0.5;   ///< [s] into the standing series
inline constexpr double kStandingAfter = 2.5;  ///< of standing after the push [s]

/// The first posture of the pattern, held; by VIIP if the pattern has goals.
CommandSeries standing_series(const CommandSeries& series);

/// How far the estimated xi = x + dx/omega of the last tick is from the commanded one [m].
double divergence(const Simulator& run);

/// Runs job(0..count-1) on threads; the first exception stops all and is thrown on.
template <typename Job>
void in_parallel(size_t count, int threads, std::atomic<bool>& stop, const Job& job) {
  std::atomic<size_t> next = 0;
  std::exception_ptr error;
  std::mutex mutex;
  const auto work = [&] {
    for (size_t i = next++; i < count && !stop; i = next++) {
      try {
        job(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!error) error = std::current_exception();
        stop = true;
      }
    }
  };
  const size_t all = threads > 0 ? static_cast<size_t>(threads)
                                 : std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::thread> pool;
  for (size_t i = 1; i < std::min(all, count); ++i) pool.emplace_back(work);
  work();
  for (std::thread& thread : pool) thread.join();
  if (error) std::rethrow_exception(error);
}

}  // namespace ayumi
