// What all calls of the program have in common: help, version, mistakes and exit codes.

#include <cstdlib>
#include <functional>
#include <map>
#include <regex>
#include <sstream>

#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

class Usage : public testing::Test {
 protected:
  Output ayumi(const std::vector<std::string>& arguments) {
    return run_program(arguments, folder.path());
  }
  void TearDown() override { EXPECT_TRUE(folder.files().empty()) << "left files behind"; }
  Folder folder;
};

TEST_F(Usage, HelpIsOneScreen) {
  const Output help = ayumi({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_LE(line_count(help.out), 50);
  for (const char* word :
       {"inspect", "robots", "--json", "--force", "--describe KIND", "130 stopped by Ctrl-C"})
    EXPECT_NE(help.out.find(word), std::string::npos) << word;
  EXPECT_EQ(help.err, "");
}

TEST_F(Usage, HelpOfACommandBeginsWithExamples) {
  const Output help = ayumi({"inspect", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  const size_t example = help.out.find("ayumi inspect hoap1"), options = help.out.find("--json");
  ASSERT_NE(example, std::string::npos) << help.out;
  EXPECT_LT(example, options);
}

// No line is cut in the middle of a word. Examples stay whole, so that they can be pasted.
TEST_F(Usage, HelpFitsTheTerminal) {
  ::setenv("COLUMNS", "80", 1);
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {}, {"import"}, {"export"}, {"certify"}, {"edit", "loop"}}) {
    std::vector<std::string> arguments = words;
    arguments.push_back("--help");
    std::istringstream lines(ayumi(arguments).out);
    for (std::string line; std::getline(lines, line);)
      EXPECT_TRUE(line.size() <= 80 || line.starts_with("  ayumi ")) << line;
  }
  std::istringstream kinds(ayumi({"check", "--tolerances"}).out);
  for (std::string line; std::getline(kinds, line);) EXPECT_LE(line.size(), 80u) << line;
  ::unsetenv("COLUMNS");
  const std::string whole = ayumi({"import", "--help"}).out;
  EXPECT_NE(whole.find(
                "  --order                     Take the columns as the joints of the robot, in the "
                "order of the robot's file.\n"),
            std::string::npos)
      << whole;
}

TEST_F(Usage, HelpOfASubcommandHasItsOwnExamples) {
  const std::string bake = ayumi({"edit", "bake", "--help"}).out;
  EXPECT_NE(bake.find("Examples:\n  ayumi edit bake walk.json -o baked.json\n\nUsage:"),
            std::string::npos)
      << bake;
}

// Every subcommand, and every subcommand of a subcommand, prints its own help: each page names its
// command in the line of its usage. A word that is no subcommand gets no help of its command.
TEST_F(Usage, EveryCommandPrintsItsOwnHelp) {
  const std::regex listed("\n  ([a-z-]+) +[a-z]");
  int pages = 0;
  const std::function<void(const std::vector<std::string>&)> look =
      [&](const std::vector<std::string>& command) {
        std::vector<std::string> words = command;
        words.push_back("--help");
        const Output help = ayumi(words);
        EXPECT_EQ(help.exit_code, 0) << help.err;
        std::string usage = "\nUsage: ayumi";
        for (const std::string& word : command) usage += " " + word;
        EXPECT_NE(help.out.find(usage + " "), std::string::npos) << help.out;
        ++pages;
        const size_t kinds = command.empty() ? 0 : help.out.find("\nSubcommands:");
        if (kinds == std::string::npos) return;
        for (std::sregex_iterator
                 c(help.out.begin() + static_cast<std::ptrdiff_t>(kinds), help.out.end(), listed),
             end;
             c != end; ++c) {
          std::vector<std::string> inner = command;
          inner.push_back((*c)[1].str());
          look(inner);
        }
      };
  look({});
  EXPECT_GT(pages, 50);
  const Output mistyped = ayumi({"sweep", "report", "--help"});
  EXPECT_EQ(mistyped.exit_code, 2);
  EXPECT_EQ(mistyped.out, "");
  EXPECT_NE(mistyped.err.find("'report' is neither a file nor a subcommand. The subcommands are "
                              "merge, status"),
            std::string::npos)
      << mistyped.err;
}

// An example with an option that no longer exists would be pasted and refused.
TEST_F(Usage, ExamplesOfTheHelpUseOptionsThatExist) {
  const std::string all = ayumi({"--help"}).out;
  std::map<std::vector<std::string>, std::string> helps;
  const auto help_of = [&](const std::vector<std::string>& command) -> const std::string& {
    const auto [found, missing] = helps.try_emplace(command);
    if (!missing) return found->second;
    std::vector<std::string> arguments = command;
    arguments.push_back("--help");
    return found->second = ayumi(arguments).out;
  };
  int options = 0;
  const std::regex listed("\n  ([a-z]+) +[a-z]");
  for (std::sregex_iterator c(all.begin(), all.end(), listed), end; c != end; ++c) {
    const std::string page = help_of({(*c)[1].str()});
    std::istringstream lines(page.substr(0, page.find("Usage:")));
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("  ayumi ")) continue;
      std::istringstream words(line);
      std::string program, command, kind, word;
      words >> program >> command >> kind;
      // The help of a kind does not repeat that of its command, which has the word SUBCOMMAND.
      const bool has_kinds =
          help_of({command}).find("SUBCOMMAND") != std::string::npos &&
          help_of({command, kind}).find("Usage: ayumi " + command + " " + kind) !=
              std::string::npos;
      const std::string& own = has_kinds ? help_of({command, kind}) : help_of({command});
      words.clear();
      words.str(line);
      while (words >> word) {
        if (!word.starts_with("--")) continue;
        const std::string option = word.substr(0, word.find('='));
        ++options;
        EXPECT_TRUE(own.find(option + " ") != std::string::npos ||
                    all.find(option + " ") != std::string::npos)
            << line << ": " << option;
      }
    }
  }
  EXPECT_GT(options, 60);
}

// A switch that turns something off is shown as it is to be typed.
TEST_F(Usage, HelpShowsSwitchesAsTyped) {
  const Output help = ayumi({"run", "--help"});
  EXPECT_NE(help.out.find("--no-pictures "), std::string::npos) << help.out;
  EXPECT_EQ(help.out.find("{false}"), std::string::npos) << help.out;
}

// If the program was built without MuJoCo, help and error say how to get it.
TEST_F(Usage, PlantMujocoIsThereOrHowToGetItIsSaid) {
  for (const char* command : {"run", "simulate", "push"}) {
    const Output help = ayumi({command, "--help"});
    const Output chosen = ayumi({command, "absent.json", "-o", "out", "--plant", "mujoco"});
    // Otherwise the program was built with MuJoCo.
    if (help.out.find("libmujoco-dev") == std::string::npos) {
      EXPECT_EQ(chosen.exit_code, 3) << "absent.json: no such file";
      continue;
    }
    EXPECT_NE(help.out.find("configure"), std::string::npos) << help.out;
    EXPECT_EQ(chosen.exit_code, 2);
    EXPECT_NE(chosen.err.find("sudo apt-get install libmujoco-dev"), std::string::npos)
        << chosen.err;
  }
}

// Both are found before any work starts: an empty name usually comes from a variable without a
// value.
TEST_F(Usage, EmptyNamesAndNamesThatAreNotTextAreRefusedAtOnce) {
  for (const char* command : {"run", "simulate", "check", "repair", "push"}) {
    const Output empty = ayumi({command, kWalk, "-o", ""});
    EXPECT_EQ(empty.exit_code, 2);
    EXPECT_EQ(line_count(empty.err), 1) << empty.err;
    EXPECT_NE(empty.err.find("argument 4, after '-o': an empty text was given"), std::string::npos)
        << empty.err;
  }
  EXPECT_EQ(ayumi({"run", kWalk, "--out="}).exit_code, 2);
  EXPECT_EQ(ayumi({"check", ""}).exit_code, 2);
  const Output latin = ayumi({"run", kWalk, "-o", "caf\xe9", "--json"});
  EXPECT_EQ(latin.exit_code, 2);
  EXPECT_EQ(json_of(latin.out).at("exit_code"), 2);
  EXPECT_NE(latin.err.find("'caf\\xe9' is not UTF-8 text"), std::string::npos) << latin.err;
}

TEST_F(Usage, VersionNamesTheLibraries) {
  const Output version = ayumi({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out.find("ayumi 0."), 0u) << version.out;
  EXPECT_NE(version.out.find("Eigen"), std::string::npos) << version.out;
}

TEST_F(Usage, NewListsItsKinds) {
  const Output list = ayumi({"new", "--list"});
  EXPECT_EQ(list.exit_code, 0);
  for (const char* const kind : {"walk ", "\nbow ", "\nkick ", "\nexcite "})
    EXPECT_NE(list.out.find(kind), std::string::npos) << list.out;
}

TEST_F(Usage, ACommandWithoutItsKindListsTheKinds) {
  EXPECT_NE(ayumi({"new"}).err.find("new: choose one of walk, step, "), std::string::npos);
  const std::string unknown = ayumi({"new", "wlak", "-o", "w.json"}).err;
  EXPECT_NE(unknown.find("new: unknown kind 'wlak'. Choose one of walk, step, "), std::string::npos)
      << unknown;
  EXPECT_NE(unknown.find("did you mean 'walk'?"), std::string::npos) << unknown;
}

// Words that are wrong in themselves are refused before a pattern is sampled, in a short message.
TEST_F(Usage, WrongWordsAreRefusedFirst) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"check", kWalk, "--tolerance", "nix=1"}, "there is no kind of finding 'nix'"},
      {{"repair", kWalk, "-o", "r.json", "--tolerance", "nix=1"}, "no kind of finding 'nix'"},
      {{"repair", kWalk, "-o", "r.json", "--lock", "nix"},
       "--lock 'nix': the robot 'hoap1' has no such joint"},
      {{"repair", kWalk, "-o", "r.json", "--lock", "3..1"}, "the window must end after it begins"},
      {{"repair", kWalk, "-o", "r.json", "--weight", "nix=2"}, "weighted joint 'nix'"},
      {{"repair", kWalk, "-o", "r.json", "--trust", "foo"},
       "'foo' is not one of posture, cog, zmp"},
      {{"simulate", kWalk, "--substeps", "0"}, "'0' is not a whole number from 1 to 100"},
      {{"report", "run", "-o", "x.txt"}, "--out x.txt: the name must end in .html"},
      {{"export", "log_closed_loop.bin", "--format", "csv", "-o", "x.csv"},
       "log_closed_loop.bin: no such file"},
      {{"new", "jump", "--height", "0.5", "-o", "j.json"}, "jump: height 0.5 m is out of range"},
      {{"new", "bow", "--angle", "120", "-o", "b.json"}, "bow: angle 120 deg is out of range"},
      {{"new", "walk", "--cog-height", "0.4", "-o", "w.json"}, "nothing is written"}};
  for (const auto& [words, complaint] : cases) {
    const Output refused = ayumi(words);
    EXPECT_EQ(refused.err.find("sample\n"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find(complaint), std::string::npos) << refused.err;
    EXPECT_EQ(refused.out, "");
    EXPECT_NE(refused.exit_code, 0);
  }
}

TEST_F(Usage, MistypedWordsAreAnsweredWithTheNearest) {
  const Output command = ayumi({"inspct", "hoap1"});
  EXPECT_EQ(command.exit_code, 2);
  EXPECT_EQ(command.out, "");
  EXPECT_NE(command.err.find("did you mean 'inspect'?"), std::string::npos) << command.err;
  const Output option = ayumi({"inspect", "hoap1", "--jsn"});
  EXPECT_EQ(option.exit_code, 2);
  EXPECT_NE(option.err.find("did you mean '--json'?"), std::string::npos) << option.err;
  const Output subcommand = ayumi({"retime", "w.json"});
  EXPECT_NE(subcommand.err.find("did you mean 'edit retime'?"), std::string::npos)
      << subcommand.err;
  const Output abbreviated = ayumi({"check", "w.json", "--tol", "x"});
  EXPECT_NE(abbreviated.err.find("did you mean '--tolerance'?"), std::string::npos)
      << abbreviated.err;
  const Output deeper = ayumi({"new", "squat", "--dept", "0.1", "-o", "a.json"});
  EXPECT_NE(deeper.err.find("did you mean '--depth'?"), std::string::npos) << deeper.err;
}

TEST_F(Usage, MistakesNameTheHelpOfTheirSubcommand) {
  const Output output = ayumi({"new", "squat", "--dept", "0.1", "-o", "a.json"});
  EXPECT_EQ(output.exit_code, 2);
  EXPECT_NE(output.err.find("See ayumi new squat --help"), std::string::npos) << output.err;
}

TEST_F(Usage, MissingWordsAreUsageErrors) {
  EXPECT_EQ(ayumi({"inspect"}).exit_code, 2);
  EXPECT_EQ(ayumi({"--threads", "many", "robots"}).exit_code, 2);
  EXPECT_EQ(ayumi({"robots", "one", "two"}).exit_code, 2);
}

TEST_F(Usage, ValuesThatAreNoNumbersAreUsageErrors) {
  const std::string pattern = AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json";
  const std::vector<std::vector<std::string>> lines = {
      {"repair", "-q", pattern, "-o", "new.json", "--safety", "nan"},
      {"repair", "-q", pattern, "-o", "new.json", "--weight", "l_knee=nan"},
      {"simulate", "-q", pattern, "-o", "new", "--gain", "q=inf"},
      {"edit", "retime", "-q", pattern, "--scale", "NaN", "-o", "new.json"},
      {"check", "-q", pattern, "--tolerance", "friction=nan"},
      {"simulate", "-q", pattern, "--seed", "-1"},
      {"simulate", "-q", pattern, "--seed", "010"},
      {"simulate", "-q", pattern, "--seed", "18446744073709551616"},
      {"push", "-q", pattern, "--times", "nan"},
      {"tune", "-q", pattern, "--times", "nan"},
      {"gains", "hoap1", "--poles", "nan,-2"}};
  for (const std::vector<std::string>& line : lines) {
    const Output output = ayumi(line);
    EXPECT_EQ(output.exit_code, 2) << line[0] << ": " << output.err;
    EXPECT_EQ(output.out, "");
  }
}

// An option without its value would take the next option for its value.
TEST_F(Usage, AnOptionIsNoValue) {
  const std::string pattern = AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json";
  const auto refused = [&](const std::vector<std::string>& words, const std::string& message) {
    const Output output = ayumi(words);
    EXPECT_EQ(output.exit_code, 2) << output.err;
    EXPECT_NE(output.err.find(message), std::string::npos) << output.err;
    EXPECT_EQ(output.out, "");
  };
  for (const std::string option : {"--force", "-q"}) {
    refused({"export", pattern, "-o", option},
            "--out: '" + option +
                "' is an option, but a value is needed. For a file of this name, write ./" +
                option);
    EXPECT_FALSE(fs::exists(folder / option));
  }
  refused({"check", pattern, "--set", "--force"}, "--set: '--force' is an option");
  refused({"simulate", pattern, "--seed", "--quiet"}, "--seed: '--quiet' is an option");
  // Other words may begin with dashes.
  refused({"export", pattern, "-o", "--draft"},
          "--out: '--draft' looks like an option. For a file of this name, write ./--draft");
  fs::copy_file(pattern, folder / "--walk.json");
  EXPECT_EQ(ayumi({"check", "-q", "--", "--walk.json"}).exit_code, 0);
  fs::remove(folder / "--walk.json");
  const Output titled = ayumi({"plot", "no_run", "--title", "--draft--", "-o", "p.svg"});
  EXPECT_NE(titled.err.find("no_run: no such folder"), std::string::npos) << titled.err;
  refused({"simulate", pattern, "-o", "-"},
          "--out: results are written to files only. For a file named '-', write ./-");
}

TEST_F(Usage, StandardInputCannotBeWatched) {
  const Output output = ayumi({"check", "-", "--watch"});
  EXPECT_EQ(output.exit_code, 2);
  EXPECT_NE(output.err.find("Name a file"), std::string::npos) << output.err;
}

TEST_F(Usage, GainsThatCannotWorkAreUsageErrors) {
  const std::string pattern = AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json";
  const Output unknown = ayumi({"simulate", "-q", pattern, "--gain", "qq=1"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("did you mean 'q'?"), std::string::npos) << unknown.err;
  const Output weak = ayumi({"simulate", "-q", pattern, "--gain", "k=0.9", "--gain", "d=1"});
  EXPECT_EQ(weak.exit_code, 2);
  EXPECT_NE(weak.err.find("K > 1 and D > 0"), std::string::npos) << weak.err;
}

TEST_F(Usage, AnUnknownRobotIsBadInput) {
  const Output output = ayumi({"inspect", "hoap7"});
  EXPECT_EQ(output.exit_code, 3);
  EXPECT_EQ(output.out, "");
  EXPECT_NE(output.err.find("hoap7"), std::string::npos) << output.err;
  EXPECT_NE(output.err.find("did you mean 'hoap1'?"), std::string::npos) << output.err;
  EXPECT_EQ(line_count(output.err), 1) << output.err;
}

TEST_F(Usage, JsonIsOneObjectAndNothingElse) {
  const Output output = ayumi({"inspect", "hoap1", "--json"});
  EXPECT_EQ(output.exit_code, 0) << output.err;
  const auto object = json_of(output.out);
  EXPECT_EQ(object.at("robot"), "hoap1");
  EXPECT_EQ(object.at("dof"), 20);
  EXPECT_NEAR(object.at("mass_kg"), 6.5, 1e-6);
  EXPECT_NEAR(object.at("height_m"), 0.48, 0.01);
  EXPECT_EQ(object.at("joints").size(), 20u);
  EXPECT_EQ(object.at("soles").size(), 2u);
}

TEST_F(Usage, OutputThatCannotBeWrittenIsNoSuccess) {
  const auto shell = [&](const std::string& redirection) {
    return run_program({"-c", "'" + program_under_test() + "' robots " + redirection},
                       folder.path(), "/bin/sh");
  };
  EXPECT_EQ(shell("").exit_code, 0);
  const Output full = shell("> /dev/full");
  EXPECT_EQ(full.exit_code, 3);
  EXPECT_EQ(full.err, "ayumi: standard output cannot be written (No space left on device)\n");
  EXPECT_EQ(shell(">&-").exit_code, 3);
  EXPECT_EQ(shell("2>&- <&-").exit_code, 0);
}

// Mesa maps a file of its cache of shaders into memory, and the system ended the program when this
// file did not fit on the disk.
TEST_F(Usage, APictureIsDrawnWhereTheCacheFolderIsOnAFullDisk) {
  const auto shell = [&](const std::string& script) {
    return run_program({"-c", script}, folder.path(), "/bin/sh");
  };
  const std::string mount = "mkdir cache && mount -t tmpfs -o size=64k none cache";
  if (shell("unshare -Urm sh -c '" + mount + "' && rmdir cache").exit_code != 0) {
    fs::remove(folder / "cache");
    GTEST_SKIP() << "a small file system cannot be mounted here";
  }
  const Output drawn =
      shell("unshare -Urm sh -c '" + mount + " && XDG_CACHE_HOME=\"$PWD/cache\" exec \"" +
            program_under_test() + "\" inspect hoap1 -q --picture p.png'");
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_TRUE(fs::remove(folder / "p.png"));
  fs::remove(folder / "cache");
}

}  // namespace
}  // namespace ayumi::test
