#include "ayumi/base/unfinished_files.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <thread>
#include <vector>

#include "ayumi/base/file.hpp"
#include "ayumi/base/file_lock.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

class UnfinishedFiles : public testing::Test {
 protected:
  UnfinishedFiles() {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  ~UnfinishedFiles() override { fs::remove_all(folder); }
  fs::path file(const std::string& name) const {
    fs::create_directories((folder / name).parent_path());
    std::ofstream(folder / name) << "x";
    return folder / name;
  }
  /// Does this in a process that then ends as after Ctrl-C without an answer.
  static void in_stopped_process(const std::function<void()>& work) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      work();
      ::_exit(1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  }
  static void stop() {
    remove_unfinished();
    ::_exit(0);
  }
  const fs::path folder = fs::path(testing::TempDir()) / "ayumi_unfinished_files";
};

TEST_F(UnfinishedFiles, AreRemovedWithWhatIsInThem) {
  for (const char* const name : {"part/a", "part/b/c", "part/b/d/e", "other", "kept", "mine/f"})
    file(name);
  fs::create_directory_symlink(folder / "mine", folder / "part/link");
  in_stopped_process([&] {
    const UnfinishedPath part(folder / "part", UnfinishedPath::Kind::folder);
    const UnfinishedPath other(folder / "other"), none(folder / "none"), as_file(folder / "mine");
    UnfinishedPath kept(folder / "kept");
    kept.release();
    stop();
  });
  EXPECT_FALSE(fs::exists(folder / "part"));
  EXPECT_FALSE(fs::exists(folder / "other"));
  EXPECT_TRUE(fs::exists(folder / "kept"));
  EXPECT_TRUE(fs::exists(folder / "mine/f")) << "behind a symbolic link";
}

// Many files need several reads of the folder.
TEST_F(UnfinishedFiles, AFolderMayHaveThousandsOfFiles) {
  for (int i = 0; i < 3000; ++i) file("part/frame_" + std::to_string(i));
  in_stopped_process([&] {
    const UnfinishedPath part(folder / "part", UnfinishedPath::Kind::folder);
    stop();
  });
  EXPECT_FALSE(fs::exists(folder / "part"));
}

TEST_F(UnfinishedFiles, LocksAndFoldersThatTheyHaveMade) {
  file("mine/f");
  in_stopped_process([&] {
    const FolderLock made(folder / "a/b"), around(folder / "mine");
    const FileLock lock(folder / "r.db");
    stop();
  });
  EXPECT_FALSE(fs::exists(folder / "a"));
  EXPECT_FALSE(fs::exists(folder / "r.db.lock"));
  EXPECT_FALSE(fs::exists(folder / "mine/.ayumi_lock"));
  EXPECT_TRUE(fs::exists(folder / "mine/f"));
}

TEST_F(UnfinishedFiles, AHalfWrittenFile) {
  in_stopped_process([&] {
    write_file_with(folder / "a.bin", [&](const fs::path& temporary) {
      std::ofstream(temporary) << "half";
      stop();
    });
  });
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(UnfinishedFiles, MoreThanThereIsRoomForStay) {
  file("last");
  in_stopped_process([&] {
    std::vector<UnfinishedPath> many;
    for (int i = 0; i < 64; ++i) many.emplace_back(folder / ("none" + std::to_string(i)));
    const UnfinishedPath last(folder / "last"), too_long(std::string(5000, 'x'));
    many.clear();
    stop();
  });
  EXPECT_TRUE(fs::exists(folder / "last"));
}

// Work that goes on in another thread does not get past the end of its file's registration, because
// what it does next may need the file.
TEST_F(UnfinishedFiles, AreNotReleasedWhileTheyAreRemoved) {
  for (int i = 0; i < 3000; ++i) file("part/frame_" + std::to_string(i));
  in_stopped_process([&] {
    UnfinishedPath part(folder / "part", UnfinishedPath::Kind::folder);
    std::thread work([&] {
      while (fs::exists(folder / "part/frame_0") && fs::exists(folder / "part/frame_2999")) {
      }
      part.release();
      file("went_on");
    });
    remove_unfinished();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ::_exit(0);
  });
  EXPECT_FALSE(fs::exists(folder / "part"));
  EXPECT_FALSE(fs::exists(folder / "went_on"));
}

}  // namespace
}  // namespace ayumi
