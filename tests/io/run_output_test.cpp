#include "ayumi/io/run/run_output.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <optional>

#include "ayumi/io/run/run_folder.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

class RunOutputTest : public testing::Test {
 protected:
  /// Delivers a run with these files.
  void deliver(const std::vector<std::string>& files, bool replace = false) const {
    RunOutput output(target, replace);
    RunFolder run;
    for (const std::string& name : files) write_file(output.file(name), "of the run");
    run.files = files;
    write_run(output.folder(), run);
    output.deliver();
  }
  std::string refusal(const std::vector<std::string>& files, bool replace = false) const {
    return test::error_message([&] { deliver(files, replace); }, ErrorCode::bad_file);
  }
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(target))
      found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }
  using Names = std::vector<std::string>;

  /// Imitates a process that is killed while it delivers a run of the files a.csv and c.csv: it has
  /// moved the old files `away`, and the new files `in`.
  void killed_delivery(const Names& away, const Names& in) const {
    const pid_t child = ::fork();
    if (child == 0) {
      RunOutput output(target, true);
      RunFolder run;
      run.files = {"a.csv", "c.csv"};
      for (const std::string& name : run.files) write_file(output.file(name), "of the next run");
      write_run(output.folder(), run);
      fs::create_directory(target / ".ayumi_replaced");
      for (const std::string& name : away)
        fs::rename(target / name, target / ".ayumi_replaced" / name);
      for (const std::string& name : in) fs::rename(output.file(name), target / name);
      ::_exit(0);
    }
    int status = 1;
    ::waitpid(child, &status, 0);
    ASSERT_EQ(status, 0);
  }

  test::TemporaryFolder folder;
  fs::path target = folder.path() / "out";
};

TEST_F(RunOutputTest, ShowsNothingBeforeItDelivers) {
  {
    RunOutput output(target, false);
    write_file(output.file("a.csv"), "half");
    EXPECT_FALSE(fs::exists(target / "a.csv"));
    EXPECT_FALSE(is_run_folder(target));
  }
  EXPECT_FALSE(fs::exists(target)) << "an interrupted run leaves nothing";
  deliver({"a.csv"});
  EXPECT_EQ(names(), (Names{"a.csv", "run.json"}));
  verify_run(target);
}

TEST_F(RunOutputTest, IsRefusedWhileAnotherRunIsWrittenThere) {
  const RunOutput first(target, false);
  EXPECT_NE(refusal({}).find("out: another run is being written to this folder"),
            std::string::npos);
  EXPECT_TRUE(fs::is_directory(first.folder())) << "the refused one removes nothing";
}

TEST_F(RunOutputTest, TakesOverWhatAnInterruptedProcessLeft) {
  folder.write("out/.ayumi_part/half.csv", "x");
  folder.write("out/.ayumi_lock", "");
  deliver({"a.csv"});
  EXPECT_EQ(names(), (Names{"a.csv", "run.json"}));
}

// A folder that a stranger has packed may contain such links. In an earlier version, the files
// behind the second link were moved into the folder of the run.
TEST_F(RunOutputTest, LinksInPlaceOfItsHiddenFoldersAreNotFollowed) {
  for (const std::string name : {".ayumi_part", ".ayumi_replaced"}) {
    fs::remove_all(target);
    const fs::path mine = folder.write("mine/a.csv", "mine");
    fs::create_directory(target);
    fs::create_directory_symlink(mine.parent_path(), target / name);
    deliver({"a.csv"});
    EXPECT_EQ(read_file(mine), "mine") << name;
    EXPECT_EQ(names(), (Names{"a.csv", "run.json"}));
    verify_run(target);
  }
}

TEST_F(RunOutputTest, AKilledDeliveryIsUndoneByTheNextStart) {
  for (const bool replaces : {true, false}) {
    fs::remove_all(target);
    if (replaces) deliver({"a.csv", "b.csv"});
    killed_delivery(replaces ? Names{"run.json", "b.csv", "a.csv"} : Names{}, {"a.csv", "c.csv"});
    EXPECT_FALSE(is_run_folder(target));
    folder.write("out/d.csv", "mine");
    EXPECT_NE(refusal({"d.csv"}, true).find("d.csv: this file already exists"), std::string::npos);
    EXPECT_EQ(names(), replaces ? (Names{"a.csv", "b.csv", "d.csv", "run.json"}) : Names{"d.csv"});
    if (replaces) verify_run(target);
    EXPECT_EQ(read_file(target / "d.csv"), "mine");
  }
}

// A file that was moved to its place and changed afterwards belongs to the user.
TEST_F(RunOutputTest, AKilledDeliveryLeavesFilesThatHaveChangedSince) {
  killed_delivery({}, {"a.csv"});
  folder.write("out/a.csv", "mine");
  EXPECT_NE(refusal({"a.csv"}).find("a.csv: this file already exists"), std::string::npos);
  EXPECT_EQ(read_file(target / "a.csv"), "mine");
}

TEST_F(RunOutputTest, ReplacesTheFilesOfTheRunBeforeAndNoOthers) {
  deliver({"a.csv", "b.csv"});
  folder.write("out/notes.txt", "mine");
  EXPECT_NE(refusal({"a.csv"}).find("out: this already exists"), std::string::npos);
  EXPECT_EQ(names(), (Names{"a.csv", "b.csv", "notes.txt", "run.json"}));
  deliver({"a.csv"}, true);
  EXPECT_EQ(names(), (Names{"a.csv", "notes.txt", "run.json"}));
  EXPECT_EQ(read_file(target / "notes.txt"), "mine");
}

TEST_F(RunOutputTest, LeavesAFileOfTheUserAndTheRunBefore) {
  deliver({"a.csv"});
  const std::string before = read_file(target / "run.json");
  folder.write("out/b.csv", "mine");
  EXPECT_NE(
      refusal({"b.csv"}, true).find("b.csv: this file already exists and was not written by a run"),
      std::string::npos);
  EXPECT_EQ(read_file(target / "b.csv"), "mine");
  EXPECT_EQ(read_file(target / "run.json"), before);
  EXPECT_EQ(names(), (Names{"a.csv", "b.csv", "run.json"}));
}

TEST_F(RunOutputTest, LeavesALinkOrAFolderInPlaceOfAFileOfTheRun) {
  const fs::path mine = folder.write("mine", "text");
  deliver({"a.csv"});
  fs::remove(target / "a.csv");
  fs::create_symlink(mine, target / "a.csv");
  EXPECT_NE(refusal({"a.csv"}, true).find("a.csv: this is a symbolic link"), std::string::npos);
  EXPECT_EQ(read_file(mine), "text");
  fs::remove(target / "a.csv");
  folder.write("out/a.csv/inside", "mine");
  EXPECT_NE(refusal({"a.csv"}, true).find("a.csv: this is a folder"), std::string::npos);
  EXPECT_EQ(read_file(target / "a.csv" / "inside"), "mine");
}

// A run.json from elsewhere may name any file. Only those in the folder itself belong to the run.
TEST_F(RunOutputTest, RemovesNothingOutsideItsFolder) {
  folder.write("mine", "text");
  folder.write("out/deeper/mine", "text");
  folder.write("out/run.json",
               R"({"format": "ayumi.run/1", "files": {"../mine": "0", "deeper/mine": "0",
                   "..": "0", "/etc/hostname": "0"}})");
  EXPECT_EQ(run_file_names(target), Names{"run.json"});
  deliver({}, true);
  EXPECT_EQ(read_file(folder.path() / "mine"), "text");
  EXPECT_EQ(read_file(target / "deeper" / "mine"), "text");
}

TEST_F(RunOutputTest, KeepsAFolderWhoseRunCannotBeRead) {
  folder.write("out/run.json", "{ not JSON");
  EXPECT_NE(refusal({}, true), "no error");
  EXPECT_EQ(read_file(target / "run.json"), "{ not JSON");
}

}  // namespace
}  // namespace ayumi
