#include "ayumi/base/file_lock.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

TEST(FileLock, IsHeldByOneAtATimeAndNamesTheFile) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "results.db";
  const auto error = [&] {
    return test::error_message([&] { const FileLock lock(file); }, ErrorCode::bad_file);
  };
  {
    const FileLock lock(file);
    EXPECT_EQ(error(), file.string() +
                           ": another command is writing to this file; wait until it has ended, or "
                           "choose another name");
  }
  EXPECT_EQ(error(), "no error");
  EXPECT_TRUE(fs::is_empty(folder.path())) << "the lock leaves nothing";
}

TEST(FileLock, SaysThatItsLockCannotBeMade) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "results.db";
  folder.write("results.db.lock", "text");
  EXPECT_EQ(test::error_message([&] { const FileLock lock(file); }, ErrorCode::bad_file)
                .find(file.string() + ": the lock folder " + file.string() + ".lock cannot be "),
            0u);
  EXPECT_TRUE(fs::is_regular_file(folder.path() / "results.db.lock"));
}

}  // namespace
}  // namespace ayumi
