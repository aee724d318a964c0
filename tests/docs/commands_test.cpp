// Every command in an `sh` block of README.md, CONTRIBUTING.md and docs/*.md can be pasted: a page
// runs from top to bottom in one scratch folder that looks like the project's, with the program on
// the PATH. A comment `# exit code N` marks a command that is meant to fail. Links between pages
// lead to files and headings that exist.

#include <cctype>
#include <regex>
#include <sstream>

#include "tests/cli/program.hpp"

namespace ayumi::test {
namespace {

/// Commands that are not run here, by their beginning, with the reason.
struct NotRun {
  const char* prefix;
  const char* reason;
};
const NotRun kNotRun[] = {
    {"examples/quickstart.sh", "builds the program: .ci/run runs it from a fresh clone"},
    {"tests/run.sh", "builds and runs all tests, this one too"},
    {".ci/", "installs packages, builds and runs all tests"},
    {"cmake ", "builds; the build of this test is the proof"},
    {"cpack ", "makes packages: tests/install"},
    {"ctest ", "runs all tests, this one too"},
    {"build/", "runs a test program of the build folder"},
    {"ayumi selftest", "takes 17 s of processor time: cli.Selftest runs all its jobs"},
    {"valgrind ", "measures the benchmarks, which are built by hand"},
    {"sudo ", "installs packages"},
    {"git ", "needs the network or a repository"},
    {"PYTHONPATH=", "needs the Python module: tests/python"},
    {"python3 examples/python/", "needs the Python module: tests/python runs these examples"},
    {"AYUMI_INSTALLED_PROGRAM=", "runs tests on an installed copy: tests/install"},
    {"PATH=", "the program is on the PATH already"},
};

struct Command {
  int line = 0;           ///< line where it begins, counted from 1
  std::string text;       ///< all its lines, including a here-document
  int exit_code = 0;      ///< exit code with which it must end
  const char* not_run{};  ///< reason why it is not run, or null
};

bool ends_with_backslash(const std::string& line) { return !line.empty() && line.back() == '\\'; }

/// The commands of all `sh` blocks of a page.
std::vector<Command> commands_of(const std::string& page) {
  std::vector<Command> commands;
  std::istringstream lines(page);
  std::string line;
  bool inside = false;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.rfind("```", 0) == 0) {
      inside = !inside && line == "```sh";
      continue;
    }
    const bool comment = line.rfind('#', 0) == 0;
    if (!inside || line.empty() || comment) continue;
    Command command{number, line, 0, nullptr};
    std::smatch match;
    const std::string first = line;
    while (ends_with_backslash(command.text) && std::getline(lines, line)) {
      command.text += "\n" + line;
      ++number;
    }
    if (std::regex_search(first, match, std::regex("<<'?([A-Z]+)'?"))) {
      const std::string end = match[1];
      while (std::getline(lines, line)) {
        command.text += "\n" + line;
        ++number;
        if (line == end) break;
      }
    }
    if (std::regex_search(command.text, match, std::regex("# exit code ([0-9]+)")))
      command.exit_code = std::stoi(match[1]);
    for (const NotRun& entry : kNotRun)
      if (command.text.rfind(entry.prefix, 0) == 0) command.not_run = entry.reason;
    commands.push_back(command);
  }
  return commands;
}

std::vector<std::string> pages() {
  const fs::path root = AYUMI_SOURCE_DIR;
  std::vector<std::string> found = {"README.md", "CONTRIBUTING.md"};
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md")
      found.push_back(fs::relative(entry.path(), root).string());
  std::sort(found.begin(), found.end());
  return found;
}

/// A shell script that runs the commands one after the other and stops at the first that ends with
/// another exit code than the page says.
std::string script_of(const std::string& page, const std::vector<Command>& commands) {
  std::string script;
  for (const Command& command : commands) {
    if (command.not_run) continue;
    const std::string place = page + ":" + std::to_string(command.line);
    script += "echo '== " + place + "' >&2\n" + command.text + "\n";
    script += "code=$?; if [ $code != " + std::to_string(command.exit_code) + " ]; then echo \"" +
              place + ": exit code $code in place of " + std::to_string(command.exit_code) +
              "\" >&2; exit 1; fi\n";
  }
  return script;
}

class Page : public testing::TestWithParam<std::string> {
 protected:
  fs::path page() const { return fs::path(AYUMI_SOURCE_DIR) / GetParam(); }
};

class CommandsOfPage : public Page {};  // this is slow and has a suite of its own
class LinksOfPage : public Page {};

TEST_P(CommandsOfPage, CanBePasted) {
  const std::vector<Command> commands = commands_of(contents(page()));
  const std::string script = script_of(GetParam(), commands);
  if (script.empty()) GTEST_SKIP() << "no command to run";
  const Folder folder;
  for (const char* name : {"robots", "patterns", "docs"})
    fs::create_directory_symlink(fs::path(AYUMI_SOURCE_DIR) / name, folder / name);
  fs::copy(fs::path(AYUMI_SOURCE_DIR) / "examples", folder / "examples",
           fs::copy_options::recursive);
  const std::string path = fs::path(AYUMI_PROGRAM).parent_path().string();
  const Output output = run_program(
      {"-c", "PATH='" + path + "':$PATH; AYUMI='" AYUMI_PROGRAM "'; export AYUMI\n" + script},
      folder.path(), "/bin/bash");
  const size_t last = output.err.rfind("== ");
  EXPECT_EQ(output.exit_code, 0) << output.err.substr(last == std::string::npos ? 0 : last);
}

/// Names by which links can refer to the headings of a page: in lower case, with hyphens for
/// blanks, without punctuation.
std::vector<std::string> anchors_of(const std::string& page) {
  std::vector<std::string> anchors;
  std::istringstream lines(page);
  std::string line;
  while (std::getline(lines, line)) {
    if (line.rfind('#', 0) != 0) continue;
    std::string anchor;
    for (const char c : line.substr(std::min(line.size(), line.find_first_not_of("# ")))) {
      const auto u = static_cast<unsigned char>(c);
      if (c == ' ') anchor += '-';
      if (std::isalnum(u) || c == '-' || c == '_' || u >= 0x80)
        anchor += static_cast<char>(std::tolower(u));
    }
    anchors.push_back(anchor);
  }
  return anchors;
}

TEST_P(LinksOfPage, LeadToFilesAndHeadings) {
  const std::string text = contents(page());
  const std::regex link("\\]\\(([^)#\\s]*)(#([^)]*))?\\)");
  for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it) {
    const std::string target = (*it)[1], anchor = (*it)[3];
    if (target.find("://") != std::string::npos) continue;
    const fs::path file = target.empty() ? page() : page().parent_path() / target;
    ASSERT_TRUE(fs::exists(file)) << GetParam() << ": " << target;
    if (anchor.empty() || file.extension() != ".md") continue;
    const std::vector<std::string> anchors = anchors_of(contents(file));
    EXPECT_NE(std::find(anchors.begin(), anchors.end(), anchor), anchors.end())
        << GetParam() << ": no heading of " << file.filename() << " is named " << anchor;
  }
}

std::string test_name(const testing::TestParamInfo<std::string>& page) {
  std::string name = page.param;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Docs, CommandsOfPage, testing::ValuesIn(pages()), test_name);
INSTANTIATE_TEST_SUITE_P(Docs, LinksOfPage, testing::ValuesIn(pages()), test_name);

// How a page itself is read: continued lines, here-documents, comments and exit codes.
TEST(PageCommands, AreReadAsAShellReadsThem) {
  const std::vector<Command> commands = commands_of(
      "text\n```sh\nayumi check \\\n  a.json  # exit code 3\ncat > b <<'EOF'\nnot a command\nEOF\n"
      "# only a comment\ncmake --build x\n```\n```json\nno\n```\n");
  ASSERT_EQ(commands.size(), 3u);
  EXPECT_EQ(commands[0].line, 3);
  EXPECT_EQ(commands[0].exit_code, 3);
  EXPECT_EQ(commands[1].text, "cat > b <<'EOF'\nnot a command\nEOF");
  EXPECT_NE(commands[2].not_run, nullptr);
}

TEST(PageCommands, AWrongExitCodeIsNoticed) {
  const Folder folder;
  const auto run = [&](const std::string& block) {
    const std::string script = script_of("page", commands_of("```sh\n" + block + "\n```\n"));
    return run_program({"-c", script}, folder.path(), "/bin/bash");
  };
  EXPECT_EQ(run("false # exit code 1").exit_code, 0);
  EXPECT_EQ(run("false").exit_code, 1);
  EXPECT_NE(run("true\nfalse").err.find("page:3: exit code 1"), std::string::npos);
}

}  // namespace
}  // namespace ayumi::test
