// The same command gives the same bytes in every written file and on stdout, for any number of
// threads.

#include "tests/cli/program.hpp"

namespace ayumi::test {
namespace {

struct Result {
  Output output;
  std::vector<std::pair<std::string, std::string>> files;  ///< name and bytes, sorted
};

Result result_of(const std::vector<std::string>& command) {
  const Folder folder;
  Result result;
  result.output = run_program(command, folder.path());
  for (const std::string& file : folder.files())
    if (fs::is_regular_file(folder / file))
      result.files.emplace_back(file, contents(folder / file));
  return result;
}

TEST(Repeat, ASimulationGivesTheSameBytes) {
  const std::string pattern = AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json";
  std::vector<std::string> command = {"simulate", pattern,     "-o", "out",
                                      "--quiet",  "--threads", "1"};
  const Result first = result_of(command);
  ASSERT_LE(first.output.exit_code, 1) << first.output.err;
  EXPECT_GE(first.files.size(), 3u);
  command.back() = "2";
  for (int i = 0; i < 2; ++i) {
    const Result again = result_of(command);
    EXPECT_EQ(again.output.exit_code, first.output.exit_code);
    EXPECT_EQ(again.output.out, first.output.out);
    ASSERT_EQ(again.files.size(), first.files.size());
    for (size_t k = 0; k < first.files.size(); ++k) {
      EXPECT_EQ(again.files[k].first, first.files[k].first);
      EXPECT_TRUE(again.files[k].second == first.files[k].second) << first.files[k].first;
    }
  }
}

}  // namespace
}  // namespace ayumi::test
