#pragma once
// Measures how long work takes.

#include <ctime>

namespace ayumi {

/// The processor time that this thread has used [s]. Unlike the time of a wall clock, it does not
/// grow while other programs have the processor.
inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace ayumi
