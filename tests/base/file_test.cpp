#include "ayumi/base/file.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <optional>

#include "ayumi/base/file_lock.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

std::string lock_error(const fs::path& folder) {
  return test::error_message([&] { FolderLock lock(folder); }, ErrorCode::bad_file);
}

size_t file_count(const fs::path& folder) {
  return static_cast<size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(WriteFile, WritesTheWholeFileOrLeavesTheOlderOne) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.write("a.txt", "older");
  const auto fails = [&](const fs::path& temporary) {
    write_file(temporary, "half of it");
    fail(ErrorCode::bad_file, "stopped");
  };
  EXPECT_EQ(test::error_message([&] { write_file_with(file, fails); }), "stopped");
  EXPECT_EQ(read_file(file), "older");
  EXPECT_EQ(file_count(folder.path()), 1u) << "no temporary file stays";
  write_file(file, "newer");
  EXPECT_EQ(read_file(file), "newer");
  EXPECT_EQ(file_count(folder.path()), 1u);
}

TEST(ReadFile, OpensRegularFilesOnlyAndNeverWaits) {
  const test::TemporaryFolder folder;
  const auto error = [](const fs::path& path, size_t most = 100) {
    return test::error_message([&] { read_file(path, most); }, ErrorCode::bad_file);
  };
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(error(pipe),
            pipe.string() + ": this is a device or a named pipe, but a regular file is needed");
  EXPECT_EQ(error("/dev/zero"),
            "/dev/zero: this is a device or a named pipe, but a regular file is needed");
  EXPECT_EQ(error(folder.path()),
            folder.path().string() + ": this is a folder, but a file is needed");
  const fs::path file = folder.write("a.txt", "12345");
  EXPECT_EQ(read_file(file, 5), "12345");
  EXPECT_EQ(error(file, 4),
            file.string() + ": the file has 5 bytes; a file of this kind may have at most 4");
  EXPECT_EQ(read_file(folder.write("empty.txt", "")), "");
  EXPECT_FALSE(read_file("/proc/self/status").empty()) << "a file that states no size";
  EXPECT_EQ(error("/proc/self/maps", 64).find("/proc/self/maps: "), 0u);
}

TEST(FolderLock, IsHeldByOneAtATime) {
  const test::TemporaryFolder folder;
  {
    const FolderLock lock(folder.path());
    EXPECT_EQ(lock_error(folder.path()), folder.path().string() +
                                             ": another run is being written to this folder; wait "
                                             "until it has ended, or choose another folder");
  }
  EXPECT_EQ(lock_error(folder.path()), "no error");
  EXPECT_EQ(file_count(folder.path()), 0u) << "the file of the lock goes with it";
}

TEST(FolderLock, RemovesTheFolderThatItMadeWhereItIsEmpty) {
  const test::TemporaryFolder folder;
  const fs::path made = folder.path() / "a" / "b";
  for (const fs::path& name : {made, made / ""}) {
    { const FolderLock lock(name); }
    EXPECT_FALSE(fs::exists(made.parent_path())) << "the folder around it was made, too";
  }
  {
    const FolderLock lock(made);
    write_file(made / "result", "x");
  }
  EXPECT_TRUE(fs::exists(made / "result"));
  fs::remove(made / "result");
  { const FolderLock lock(made); }
  EXPECT_TRUE(fs::exists(made)) << "the folder was there before the lock";
}

/// A child process that holds the lock of a folder until it is killed.
class Holder {
 public:
  explicit Holder(const fs::path& folder) {
    int ready[2];
    if (::pipe(ready) != 0) return;
    child_ = ::fork();
    if (child_ == 0) {
      const FolderLock lock(folder);
      if (::write(ready[1], "x", 1) == 1) ::pause();
      ::_exit(0);
    }
    char byte = 0;
    locked = ::read(ready[0], &byte, 1) == 1;
    ::close(ready[0]);
    ::close(ready[1]);
  }
  ~Holder() { kill(); }
  void kill() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    child_ = -1;
  }
  bool locked = false;

 private:
  pid_t child_ = -1;
};

TEST(FolderLock, HoldsBetweenProcessesAndEndsWithItsProcess) {
  const test::TemporaryFolder folder;
  Holder holder(folder.path());
  ASSERT_TRUE(holder.locked);
  EXPECT_NE(lock_error(folder.path()).find("another run is being written to this folder"),
            std::string::npos);
  EXPECT_TRUE(fs::exists(folder.path() / ".ayumi_lock")) << "a refused lock removes nothing";
  holder.kill();
  EXPECT_TRUE(fs::exists(folder.path() / ".ayumi_lock")) << "the killed process left its file";
  EXPECT_EQ(lock_error(folder.path()), "no error");
  EXPECT_FALSE(fs::exists(folder.path() / ".ayumi_lock"));
}

TEST(FolderLock, DoesNotFollowALink) {
  const test::TemporaryFolder folder;
  const fs::path mine = folder.write("mine", "text");
  const fs::path target = folder.path() / "out";
  fs::create_directory(target);
  fs::create_symlink(mine, target / ".ayumi_lock");
  EXPECT_NE(lock_error(target).find("cannot be written"), std::string::npos);
  EXPECT_EQ(read_file(mine), "text");
  EXPECT_TRUE(fs::is_symlink(target / ".ayumi_lock"));
}

TEST(FolderLock, NamesAFolderThatCannotBeMade) {
  const test::TemporaryFolder folder;
  folder.write("file", "text");
  EXPECT_NE(lock_error(folder.path() / "file" / "out").find("out: the folder cannot be made"),
            std::string::npos);
}

}  // namespace
}  // namespace ayumi
