// Ctrl-C, and programs that Ayumi starts but that are missing or hang.

#include <chrono>
#include <csignal>
#include <ctime>
#include <thread>

#include "tests/cli/background_program.hpp"

namespace ayumi::test {
namespace {

using Clock = std::chrono::steady_clock;

/// PATH contains only this folder until the end of the test.
class OnlyPath {
 public:
  explicit OnlyPath(const fs::path& folder) : before_(std::getenv("PATH")) {
    ::setenv("PATH", folder.c_str(), 1);
  }
  ~OnlyPath() { ::setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

/// An `ffmpeg` that writes its process id to the file `started` and then hangs for ever.
void write_hanging_ffmpeg(const Folder& folder) {
  write(folder / "bin/ffmpeg", "#!/bin/sh\necho $$ > " + (folder / "pid").string() + "\nmv " +
                                   (folder / "pid").string() + " " + (folder / "started").string() +
                                   "\nexec /bin/sleep 600\n");
  fs::permissions(folder / "bin/ffmpeg", fs::perms::owner_all);
  fs::create_symlink("/bin/mv", folder / "bin/mv");
}

bool is_running(pid_t process) {
  const std::string state = contents("/proc/" + std::to_string(process) + "/stat");
  const size_t name = state.rfind(')');
  return name != std::string::npos && state.substr(name + 2, 1) != "Z";
}

// The second round has a second Ctrl-C, which ends the program at once.
TEST(Stopping, CtrlCEndsARunAndTheFfmpegThatHangs) {
  for (const bool twice : {false, true}) {
    const Folder folder;
    write_hanging_ffmpeg(folder);
    const OnlyPath path(folder / "bin");
    const pid_t run = start({"run", kWalk, "-o", "out"}, folder.path());
    ASSERT_TRUE(holds_within(240, [&] { return fs::exists(folder / "started"); }));
    const pid_t encoder = std::stoi(contents(folder / "started"));
    EXPECT_TRUE(is_running(encoder));
    const auto begin = Clock::now();
    ::kill(run, SIGINT);
    if (twice) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ::kill(run, SIGINT);
    }
    int status = 0;
    ::waitpid(run, &status, 0);
    // A loaded machine may take longer to start threads, but not several times as long.
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - begin).count(), 3.0);
    EXPECT_TRUE((WIFEXITED(status) && WEXITSTATUS(status) == 130) ||
                (twice && WIFSIGNALED(status) && WTERMSIG(status) == SIGINT))
        << status;
    EXPECT_TRUE(holds_within(5, [&] { return !is_running(encoder); }));
    EXPECT_FALSE(fs::exists(folder / "out")) << "the folder was not there before";
  }
}

// The shell and the system both send SIGHUP when a terminal is closed.
class ClosedTerminal : public testing::Test {
 protected:
  /// Starts a simulation that takes many seconds, and waits until it has begun.
  pid_t simulation() {
    write(folder / "p.json", R"({
      "format": "ayumi.pattern/1", "name": "stands for long", "robot": "hoap1",
      "phases": [{ "until": 120, "support": "both" }],
      "keyframes": [{ "t": 0, "posture": "home" }]
    })");
    const pid_t process = start({"simulate", "p.json", "-o", "new/out"}, folder.path());
    EXPECT_TRUE(holds_within(240, [&] { return fs::exists(folder / "new/out/.ayumi_part"); }));
    return process;
  }
  void expect_stopped(pid_t process) {
    int status = 0;
    ::waitpid(process, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 130) << status;
    EXPECT_FALSE(fs::exists(folder / "new")) << "the folders were not there before";
  }
  Folder folder;
};

TEST_F(ClosedTerminal, EndsTheWorkAndLeavesNothing) {
  const pid_t process = simulation();
  for (int i = 0; i < 3; ++i) {
    ::kill(process, SIGHUP);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  expect_stopped(process);
}

// nohup makes the program ignore the signal.
TEST_F(ClosedTerminal, DoesNotEndWhatNohupHasStarted) {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  const pid_t process = simulation();
  std::signal(SIGHUP, before);
  ::kill(process, SIGHUP);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  int status = 0;
  ASSERT_EQ(::waitpid(process, &status, WNOHANG), 0) << status;
  ::kill(process, SIGTERM);
  expect_stopped(process);
}

TEST(Stopping, AMissingFfmpegIsFoundBeforeTheWork) {
  const Folder folder;
  fs::create_directories(folder / "bin");
  const OnlyPath path(folder / "bin");
  const Output run = run_program({"run", kWalk, "-o", "out"}, folder.path());
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run.err,
            "ayumi: the program 'ffmpeg', which makes the clip, is not in any folder of PATH; "
            "install ffmpeg, or do not ask for pictures\n");
  EXPECT_EQ(run.out, "");
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(Stopping, ALogIsDrawnOnlyWithItsOwnRobot) {
  const Folder folder;
  fs::copy(fs::path(AYUMI_SOURCE_DIR) / "robots/hoap1", folder / "mine",
           fs::copy_options::recursive);
  std::string pattern = contents(kWalk);
  const std::string named = R"("robot": "hoap1")";
  pattern.replace(pattern.find(named), named.size(), R"("robot": "mine/robot.json")");
  write(folder / "w.json", pattern);
  ASSERT_EQ(run_program({"simulate", "w.json", "-o", "run", "-q"}, folder.path()).exit_code, 0);
  const std::vector<std::vector<std::string>> commands = {
      {"preview", "run", "-o", "a.png"},
      {"plot", "run", "-o", "a.svg"},
      {"report", "run", "-o", "a.html"},
      {"export", "run", "--format", "npz", "-o", "a.npz"}};
  for (std::vector<std::string> command : commands) {
    command.insert(command.end(), {"--robot", "humanoid30"});
    const Output other = run_program(command, folder.path());
    EXPECT_EQ(other.exit_code, 3) << command[0];
    EXPECT_NE(other.err.find("but the robot 'humanoid30' has the joints "), std::string::npos)
        << command[0] << other.err;
  }
  write(folder / "mine/robot.json", contents(folder / "mine/robot.json") + " ");
  for (const std::vector<std::string>& command : commands) {
    const Output changed = run_program(command, folder.path());
    EXPECT_EQ(changed.exit_code, 3) << command[0];
    EXPECT_NE(changed.err.find("has changed since the run was made"), std::string::npos)
        << command[0] << changed.err;
  }
  for (const std::string& file : folder.files()) EXPECT_FALSE(file.starts_with("a.")) << file;
}

}  // namespace
}  // namespace ayumi::test
