// --describe: the manual page and the completion of shells contain every command and its options.

#include <regex>
#include <set>
#include <sstream>

#include "tests/cli/program.hpp"

namespace ayumi::test {
namespace {

/// The long options in the help of a command.
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
  // The name of a baseline's gain.
  EXPECT_NE(names({"gains"}).find("\nsoonest\n"), std::string::npos);
  EXPECT_NE(names({"controllers"}).find("\nfoot-guided\n"), std::string::npos);
  EXPECT_NE(names({"postures", "posture", "draw", "hoap1"}).find("\nhome\n"), std::string::npos);
  // A posture belongs to a robot, whose name comes before it.
  const std::string first = names({"robots,postures", "posture", "draw"});
  EXPECT_NE(first.find("\nhoap1\n"), std::string::npos) << first;
  EXPECT_EQ(first.find("\nhome\n"), std::string::npos) << first;
  const std::string second = names({"robots,postures", "posture", "draw", "hoap1"});
  EXPECT_EQ(second.find("\nhoap1\n"), std::string::npos) << second;
  EXPECT_NE(second.find("\nhome\n"), std::string::npos) << second;
  const std::string tall = names({"joints", "new", "walk", "--robot", "humanoid30"});
  EXPECT_NE(tall.find("\nneck"), std::string::npos) << tall;
  EXPECT_EQ(names({"joints", "new", "walk"}).find("\nneck"), std::string::npos);
  const std::string profiles = names({"profiles", "check", "patterns/hoap1_walk.json"});
  EXPECT_NE(profiles.find("\nhoap1-strong\n"), std::string::npos) << profiles;
  // A shell that completes a word must not get a message.
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
  EXPECT_NE(zsh.find(": _ayumi_names joints'"), std::string::npos);
  EXPECT_NE(zsh.find(": _ayumi_names robots'"), std::string::npos);
  EXPECT_NE(fish.find("-l profile -x -a '(ayumi --names profiles "), std::string::npos);
  EXPECT_NE(bash.find("' check --tolerance') kind=findings"), std::string::npos);
  EXPECT_NE(bash.find("' preview --view') kind= names='front side "), std::string::npos);
  EXPECT_NE(bash.find("*' --describe') kind= names='man bash zsh fish'"), std::string::npos);
  EXPECT_NE(bash.find("' identify --unit') kind= names='rad deg'"), std::string::npos);
  EXPECT_NE(names({"controllers"}).find("\ndtad\n"), std::string::npos);
  EXPECT_NE(names({"plants"}).find("\nayumi\n"), std::string::npos);
  EXPECT_NE(names({"equations"}).find("\n22\n"), std::string::npos);
}

/// Command lines, each with a word that completes it and one that must not.
struct Completed {
  std::string line, word, other;
};
const std::vector<Completed> kCompleted = {
    {"ayumi che", "check", "repair"},
    {"ayumi repair w.json --lock l_kn", "l_knee", "r_knee"},
    {"ayumi simulate w.json --controller d", "dtad", "viip"},
    {"ayumi identify hoap1 --unit d", "deg", "rad"},
    {"ayumi preview w.json --view ortho-s", "ortho-side", "front"},
    {"ayumi check w.json --tolerance joint_s", "joint_speed", "joint_torque"},
    {"ayumi edit mir", "mirror", "loop"},
    {"ayumi help rep", "repair", "check"},
    {"ayumi posture draw --robot huma", "humanoid30", "hoap1"},
    {"ayumi posture draw hoap1 ", "home", "w.json"},
    {"ayumi posture draw ", "hoap1", "home"},
    {"ayumi check w", "w.json", "other.csv"}};

/// Fills the folder with w.json, which is a walk, and the completion for a shell.
void prepare(const Folder& folder, const std::string& shell, const std::string& file) {
  write(folder / file, described(shell));
  write(folder / "w.json", contents(kWalk));
  write(folder / "other.csv", "t\n");
}
/// The output of a shell in the folder. The shell finds the program, and no settings of a user.
Output in_shell(const Folder& folder, const std::vector<std::string>& words) {
  const std::string programs = fs::path(program_under_test()).parent_path().string();
  std::vector<std::string> all = {"HOME=" + folder.path().string(),
                                  "PATH=" + programs + ":/usr/bin:/bin"};
  all.insert(all.end(), words.begin(), words.end());
  return run_program(all, folder.path(), "/usr/bin/env");
}
Output completed_by_fish(const Folder& folder, const std::string& line) {
  return in_shell(folder, {"fish", "-c", "source ayumi.fish; complete -C '" + line + "'"});
}
bool installed(const std::string& shell) {
  return std::system((shell + " -c true > /dev/null 2>&1").c_str()) == 0;
}

TEST(Names, CompleteInFish) {
  if (!installed("fish")) GTEST_SKIP() << "fish is not installed";
  const Folder folder;
  prepare(folder, "fish", "ayumi.fish");
  for (const Completed& each : kCompleted) {
    const Output output = completed_by_fish(folder, each.line);
    const std::string lines = "\n" + output.out;
    EXPECT_NE(lines.find("\n" + each.word), std::string::npos) << each.line << lines << output.err;
    EXPECT_EQ(lines.find("\n" + each.other), std::string::npos) << each.line << lines;
  }
  // A command that is already chosen is not offered again.
  const Output chosen = completed_by_fish(folder, "ayumi new walk ");
  EXPECT_EQ(chosen.out.find("squat"), std::string::npos) << chosen.out;
  EXPECT_EQ(completed_by_fish(folder, "ayumi --describe z").out, "zsh\n");
  // The help of an option is shown beside the option, not beside each of its values. For a value
  // that is no file, no files are offered.
  const std::string joints = completed_by_fish(folder, "ayumi repair w.json --lock ").out;
  EXPECT_NE(("\n" + joints).find("\nl_knee\n"), std::string::npos) << joints;
  EXPECT_EQ(joints.find("w.json"), std::string::npos) << joints;
  const std::string views = completed_by_fish(folder, "ayumi preview w.json --view ").out;
  EXPECT_NE(("\n" + views).find("\nfront\n"), std::string::npos) << views;
  EXPECT_NE(completed_by_fish(folder, "ayumi repair w.json --loc").out.find("--lock\t"),
            std::string::npos);
  const std::string numbers = "\n" + completed_by_fish(folder, "ayumi explain ").out;
  EXPECT_NE(numbers.find("\n22\n"), std::string::npos) << numbers;
}

TEST(Names, CompleteInZsh) {
  if (!installed("zsh")) GTEST_SKIP() << "zsh is not installed";
  const Folder folder;
  prepare(folder, "zsh", "_ayumi");
  // zsh only completes at a terminal, so that a second zsh provides one to the first.
  write(folder / "terminal.zsh", R"(
    zmodload zsh/zpty
    zpty shell 'zsh -f -i'
    zpty -w shell "PS1=; fpath=($PWD \$fpath); autoload -U compinit; compinit -u -d $PWD/dump; bindkey '^I' complete-word; print re''ady"
    until zpty -r shell line '*ready*'; do :; done
    zpty -n -w shell "$1"$'\t'
    out=; repeat 100; do while zpty -rt shell more; do out+=$more; done; [[ $out == *$2* ]] && break; sleep 0.1; done
    print -r -- "$out"
  )");
  for (const Completed& each : kCompleted) {
    const Output output = in_shell(folder, {"zsh", "-f", "terminal.zsh", each.line, each.word});
    EXPECT_NE(output.out.find(each.word), std::string::npos)
        << each.line << output.out << output.err;
  }
}

TEST(Names, CompleteInBash) {
  const Folder folder;
  write(folder / "complete.sh", described("bash") +
                                    "COMP_WORDS=(ayumi repair w.json --lock l_k); COMP_CWORD=4\n"
                                    "_ayumi; echo \"${COMPREPLY[@]}\"\n"
                                    // A robot may be a file, but its postures are not.
                                    "touch a.json; for robot in '' hoap1; do\n"
                                    "COMP_WORDS=(ayumi posture draw $robot ''); COMPREPLY=()\n"
                                    "COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _ayumi\n"
                                    "[[ \" ${COMPREPLY[*]} \" == *' a.json '* ]] && echo file\n"
                                    "echo ${COMPREPLY[0]}; done\n");
  const fs::path program = program_under_test();
  const std::string command = "cd '" + folder.path().string() +
                              "' && PATH=" + program.parent_path().string() + ":$PATH bash '" +
                              (folder / "complete.sh").string() + "' > '" +
                              (folder / "out").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(contents(folder / "out"), "l_knee\nfile\nhoap1\nhome\n");
}

// OSMesa brings a compiler, which takes longer to load than all other libraries together.
TEST(Start, TheProgramLoadsNoOsmesa) {
  // With this setting, the loader prints the libraries and stops.
  ::setenv("LD_TRACE_LOADED_OBJECTS", "1", 1);
  const Output output = run_program({}, testing::TempDir());
  ::unsetenv("LD_TRACE_LOADED_OBJECTS");
  EXPECT_NE(output.out.find("libstdc++"), std::string::npos) << output.out;
  EXPECT_EQ(output.out.find("libOSMesa"), std::string::npos) << output.out;
}

TEST(BundledFiles, APatternIsFoundByItsNameWhereverTheProgramIsStarted) {
  const Folder folder;
  EXPECT_EQ(run_program({"check", "patterns/hoap1_walk.json"}, folder.path()).exit_code, 0);
  EXPECT_EQ(run_program({"check", "examples/motions/bow.json"}, folder.path()).exit_code, 0);
  // A file of the same name in the working folder has priority.
  write(folder / "patterns/hoap1_walk.json", "{");
  EXPECT_EQ(run_program({"check", "patterns/hoap1_walk.json"}, folder.path()).exit_code, 3);
}

}  // namespace
}  // namespace ayumi::test
