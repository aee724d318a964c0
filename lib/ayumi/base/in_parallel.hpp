#pragma once
// Runs independent jobs on several threads.

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "ayumi/base/bounds.hpp"
#include "ayumi/base/error.hpp"

namespace ayumi {

/// Number of threads that a caller may choose; 0 is one for each processor. Chosen: a larger number
/// is a slip, because so many threads would only wait for each other.
inline constexpr Bounds kThreadBounds = {0, 1024};

/// Runs job(0..count-1) on threads. After an exception, no further jobs are started. Of several
/// exceptions, that of the first job in order is thrown again. All jobs before that job were
/// started, so this exception is the same for any number of threads. The only case in which it can
/// differ is a job that reads `stop` and ends before its own mistake. Such a job throws
/// Interrupted, which is thrown again only if there is no other exception. If the system grants no
/// further thread, the existing threads do the work. Throws Error(usage) for a number of threads
/// beyond kThreadBounds.
template <typename Job>
void in_parallel(size_t count, int threads, std::atomic<bool>& stop, const Job& job) {
  require_within("the number of threads", threads, kThreadBounds);
  std::atomic<size_t> next = 0;
  std::exception_ptr error;
  size_t failed = count;
  bool interrupted = false;
  std::mutex mutex;
  const auto work = [&] {
    while (!stop) {
      const size_t i = next++;  // a job that was taken is run, whatever happens meanwhile
      if (i >= count) return;
      try {
        job(i);
      } catch (const Interrupted&) {
        const std::lock_guard lock(mutex);
        interrupted = true;
        stop = true;
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (i < failed) {
          failed = i;
          error = std::current_exception();
        }
        stop = true;
      }
    }
  };
  const size_t all = threads > 0 ? static_cast<size_t>(threads)
                                 : std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::thread> pool;
  try {
    for (size_t i = 1; i < std::min(all, count); ++i) pool.emplace_back(work);
  } catch (const std::exception&) {  // there are too many threads, or there is no memory for one
  }
  work();
  for (std::thread& thread : pool) thread.join();
  if (error) std::rethrow_exception(error);
  if (interrupted) throw Interrupted();
}

}  // namespace ayumi
