#include "ayumi/base/in_parallel.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "ayumi/base/error.hpp"
#include "tests/support/error_message.hpp"

namespace ayumi {
namespace {

TEST(InParallel, RunsEveryJobOnce) {
  for (const int threads : {0, 1, 3, 50}) {
    std::vector<std::atomic<int>> runs(40);
    std::atomic<bool> stop = false;
    in_parallel(runs.size(), threads, stop, [&](size_t i) { ++runs[i]; });
    for (const std::atomic<int>& run : runs) EXPECT_EQ(run, 1);
  }
}

// Job 1 sleeps, so it fails later than all other jobs. Its error is thrown nevertheless, because it
// is the first in the order of the jobs.
TEST(InParallel, ThrowsTheErrorOfTheFirstJobThatFails) {
  for (const int threads : {1, 4}) {
    std::atomic<bool> stop = false;
    std::atomic<int> runs = 0;
    const auto job = [&](size_t i) {
      ++runs;
      if (i == 1) std::this_thread::sleep_for(std::chrono::milliseconds(50));
      if (i > 0) fail(ErrorCode::usage, "job " + std::to_string(i));
    };
    const std::string message =
        test::error_message([&] { in_parallel(1000, threads, stop, job); }, ErrorCode::usage);
    EXPECT_NE(message.find("job 1"), std::string::npos) << message;
    EXPECT_EQ(message.find("job 1") + 5, message.size()) << message;
    EXPECT_TRUE(stop);
    EXPECT_LT(runs, 1000);
  }
}

// A job that asks whether it has to stop, and is before the one that failed, would hide the error.
TEST(InParallel, AnErrorIsNotHiddenByAJobThatStopsBecauseOfIt) {
  std::atomic<bool> stop = false, begun = false;
  EXPECT_EQ(test::error_message(
                [&] {
                  in_parallel(2, 2, stop, [&](size_t i) {
                    if (i == 1) {
                      while (!begun) std::this_thread::yield();
                      fail(ErrorCode::bad_file, "the disk is full");
                    }
                    begun = true;
                    while (!stop) std::this_thread::yield();
                    throw Interrupted();
                  });
                },
                ErrorCode::bad_file),
            "the disk is full");
  stop = false;
  EXPECT_THROW(in_parallel(2, 2, stop, [](size_t) { throw Interrupted(); }), Interrupted);
}

TEST(InParallel, RefusesANumberOfThreadsThatIsNone) {
  for (const int threads : {-5, 1025}) {
    std::atomic<bool> stop = false;
    EXPECT_EQ(
        test::error_message([&] { in_parallel(1, threads, stop, [](size_t) {}); },
                            ErrorCode::usage),
        "the number of threads is " + std::to_string(threads) + "; it must be from 0 to 1024");
  }
}

}  // namespace
}  // namespace ayumi
