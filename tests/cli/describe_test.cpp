// --describe: the manual page and the completion of shells have every command and its options.

#include <regex>
#include <set>
#include <sstream>

#include "tests/cli/program.hpp"

namespace ayumi::test {
namespace {

/// Long options in the help of a command.
std::set<std::string> options_in_help(const std::vector<std::string>& command) {
  std::vector<std::string> words = command;
  words.emplace_back("--help");
  const std::string help = run_program(words, testing::TempDir()).out;
  std::set<std::string> options;
  std::istringstream lines(help.substr(help.find("\nOptions:")));
  static const std::regex option("^ *(?:-\\w,)?(--[a-z-]+)");
  std::smatch match;
  for (std::string line; std::getline(lines, line);)
    if (std::regex_search(line, match, option)) options.insert(match[1]);
  return options;
}

std::string described(const std::string& kind) {
  const Output output = run_program({"--describe", kind}, testing::TempDir());
  EXPECT_EQ(output.exit_code, 0) << output.err;
  return output.out;
}

TEST(Describe, EveryKindHasTheOptionsOfTheHelp) {
  std::set<std::string> options = options_in_help({"run"});
  options.merge(options_in_help({"new", "walk"}));
  ASSERT_GE(options.size(), 20u);
  const std::string bash = described("bash"), zsh = described("zsh"), fish = described("fish");
  std::string manual = described("man");
  for (size_t at; (at = manual.find("\\-")) != std::string::npos;) manual.erase(at, 1);
  for (const std::string& option : options) {
    EXPECT_NE(manual.find(option), std::string::npos) << option;
    EXPECT_NE(bash.find(option), std::string::npos) << option;
    EXPECT_NE(zsh.find("*" + option + "["), std::string::npos) << option;
    EXPECT_NE(fish.find(" -l " + option.substr(2) + " "), std::string::npos) << option;
  }
}

TEST(Describe, EveryCommandIsThere) {
  const std::string manual = described("man");
  for (const char* command : {"check", "run", "new walk", "edit retime", "identify"})
    EXPECT_NE(manual.find(std::string(".SS ayumi ") + command + "\n"), std::string::npos)
        << command;
}

TEST(Describe, AnUnknownKindIsRefused) {
  const Output output = run_program({"--describe", "powershell"}, testing::TempDir());
  EXPECT_EQ(output.exit_code, 2);
  EXPECT_NE(output.err.find("known: man, bash, zsh, fish"), std::string::npos) << output.err;
}

std::string names(std::vector<std::string> words) {
  words.insert(words.begin(), "--names");
  const Output output = run_program(words, testing::TempDir());
  EXPECT_EQ(output.exit_code, 0) << output.err;
  return "\n" + output.out;
}

TEST(Names, AreThoseOfTheRobotOnTheCommandLine) {
  EXPECT_NE(names({"robots"}).find("\nhoap1\n"), std::string::npos);
  EXPECT_NE(names({"gains"}).find("\nka\n"), std::string::npos);
  EXPECT_NE(names({"gains"}).find("\nsoonest\n"), std::string::npos);  // of a baseline
  EXPECT_NE(names({"controllers"}).find("\nfoot-guided\n"), std::string::npos);
  EXPECT_NE(names({"postures", "posture", "draw", "hoap1"}).find("\nhome\n"), std::string::npos);
  const std::string tall = names({"joints", "new", "walk", "--robot", "humanoid30"});
  EXPECT_NE(tall.find("\nneck"), std::string::npos) << tall;
  EXPECT_EQ(names({"joints", "new", "walk"}).find("\nneck"), std::string::npos);
  const std::string profiles = names({"profiles", "check", "patterns/hoap1_walk.json"});
  EXPECT_NE(profiles.find("\nhoap1-strong\n"), std::string::npos) << profiles;
  // A shell that completes wants no message.
  const Output broken = run_program({"--names", "joints", "no/such.json"}, testing::TempDir());
  EXPECT_EQ(broken.exit_code, 0);
  EXPECT_EQ(broken.err, "");
}

TEST(Names, AreAskedForByEveryCompletion) {
  const std::string bash = described("bash"), zsh = described("zsh"), fish = described("fish");
  EXPECT_NE(bash.find("' repair --lock') kind=joints"), std::string::npos);
  EXPECT_NE(bash.find("' run --gain') kind=gains"), std::string::npos);
  EXPECT_NE(bash.find("' run --controller') kind=controllers"), std::string::npos);
  EXPECT_NE(bash.find("' edit ramp --posture') kind=postures"), std::string::npos);
  EXPECT_NE(zsh.find(":_ayumi_names joints'"), std::string::npos);
  EXPECT_NE(zsh.find(":_ayumi_names robots'"), std::string::npos);
  EXPECT_NE(fish.find("-l profile -r -a '(ayumi --names profiles "), std::string::npos);
}

TEST(Names, CompleteInBash) {
  const Folder folder;
  write(folder / "complete.sh", described("bash") +
                                    "COMP_WORDS=(ayumi repair w.json --lock l_k); COMP_CWORD=4\n"
                                    "_ayumi; echo \"${COMPREPLY[@]}\"\n");
  const fs::path program = program_under_test();
  const std::string command = "PATH=" + program.parent_path().string() + ":$PATH bash '" +
                              (folder / "complete.sh").string() + "' > '" +
                              (folder / "out").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(contents(folder / "out"), "l_knee\n");
}

// OSMesa brings a compiler, which takes longer to load than all other libraries together.
TEST(Start, TheProgramLoadsNoOsmesa) {
  ::setenv("LD_TRACE_LOADED_OBJECTS", "1", 1);  // the loader prints the libraries and stops
  const Output output = run_program({}, testing::TempDir());
  ::unsetenv("LD_TRACE_LOADED_OBJECTS");
  EXPECT_NE(output.out.find("libstdc++"), std::string::npos) << output.out;
  EXPECT_EQ(output.out.find("libOSMesa"), std::string::npos) << output.out;
}

TEST(BundledFiles, APatternIsFoundByItsNameWhereverTheProgramIsStarted) {
  const Folder folder;
  EXPECT_EQ(run_program({"check", "patterns/hoap1_walk.json"}, folder.path()).exit_code, 0);
  EXPECT_EQ(run_program({"check", "examples/motions/bow.json"}, folder.path()).exit_code, 0);
  // A file of the same name in the working folder goes first.
  write(folder / "patterns/hoap1_walk.json", "{");
  EXPECT_EQ(run_program({"check", "patterns/hoap1_walk.json"}, folder.path()).exit_code, 3);
}

}  // namespace
}  // namespace ayumi::test
