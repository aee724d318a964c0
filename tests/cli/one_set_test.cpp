// For the robot's own profile, what `repair` calls repaired, what `check` calls consistent and what
// `export` accepts is one and the same set, on patterns with faults of many kinds.
//
// AYUMI_ONE_SET=FIRST:LAST sets the seeds, and a table of the outcome is printed; the default is a
// few of them. docs/measurements/repair.md has the table of many.

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "ayumi/io/pattern/pattern_table.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/faulty_patterns.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

struct Counts {
  int patterns = 0, faulty = 0, refused = 0, repaired = 0, repaired_accepted = 0;
};

class OneSet : public testing::Test {
 protected:
  Folder folder;

  /// Whether `check` calls the pattern consistent.
  bool consistent(const std::string& file) {
    const Output output = run_program({"check", file, "--json"}, folder.path());
    EXPECT_TRUE(output.exit_code == 0 || output.exit_code == 1) << file << output.err;
    return output.exit_code == 0;
  }

  /// Whether `export` writes the pattern, with the same answer for both forms.
  bool accepted(const std::string& file) {
    std::vector<bool> written;
    for (const char* format : {"hoap", "csv"}) {
      const Output output = run_program(
          {"export", file, "--format", format, "-o", "table.csv", "--force"}, folder.path());
      EXPECT_TRUE(output.exit_code == 0 || output.exit_code == 1) << file << output.err;
      written.push_back(output.exit_code == 0);
      last_words = output.out;
    }
    EXPECT_EQ(written[0], written[1]) << file;
    return written[0];
  }

  void judge(std::uint64_t seed, std::map<std::string, Counts>& table) {
    const FaultyPattern made = faulty_pattern(seed);
    const std::string name = "p" + std::to_string(seed),
                      what = name + ": " + made.motion + ", " + made.fault + ": ";
    Pattern pattern = made.pattern;
    pattern.table->file = name + ".csv";
    write_pattern_and_table(folder / (name + ".json"), pattern);
    Counts& counts = table[made.fault];
    ++counts.patterns;
    const bool good = consistent(name + ".json"), exported = accepted(name + ".json");
    EXPECT_EQ(good, exported) << what << last_words;
    counts.faulty += good ? 0 : 1;
    counts.refused += exported ? 0 : 1;
    std::vector<std::string> words = {"repair",        name + ".json", "-o",
                                      name + "r.json", "--force",      "--json"};
    if (seed % 5 == 1) words.emplace_back("--baked");
    if (seed % 7 == 2) words.insert(words.end(), {"--safety", "0"});
    const Output output = run_program(words, folder.path());
    ASSERT_TRUE(output.exit_code == 0 || output.exit_code == 4) << what << output.err;
    EXPECT_TRUE(output.exit_code == 0 || !good) << what;
    if (good || output.exit_code == 4) return;
    EXPECT_EQ(json_of(output.out).at("status"), "repaired") << what;
    ++counts.repaired;
    const bool still_good = consistent(name + "r.json"), still = accepted(name + "r.json");
    EXPECT_TRUE(still_good) << what;
    EXPECT_TRUE(still) << what << last_words;
    counts.repaired_accepted += still_good && still ? 1 : 0;
  }

  std::string last_words;
};

TEST_F(OneSet, OfRepairedConsistentAndAccepted) {
  std::uint64_t first = 1, last = 12;
  if (const char* seeds = std::getenv("AYUMI_ONE_SET")) {
    const std::string text = seeds;
    first = std::stoull(text);
    last = std::stoull(text.substr(text.find(':') + 1));
  }
  std::map<std::string, Counts> table;
  for (std::uint64_t seed = first; seed <= last; ++seed) judge(seed, table);
  Counts all;
  std::cout << "| fault | patterns | inconsistent | refused by export | repaired | of them "
               "consistent and accepted |\n| --- | --- | --- | --- | --- | --- |\n";
  const auto print = [](const std::string& fault, const Counts& c) {
    std::cout << "| " << fault << " | " << c.patterns << " | " << c.faulty << " | " << c.refused
              << " | " << c.repaired << " | " << c.repaired_accepted << " |\n";
  };
  for (const auto& [fault, c] : table) {
    print(fault, c);
    all.patterns += c.patterns;
    all.faulty += c.faulty;
    all.refused += c.refused;
    all.repaired += c.repaired;
    all.repaired_accepted += c.repaired_accepted;
  }
  print("all", all);
  EXPECT_GT(all.repaired, 0);
  EXPECT_GT(all.faulty, all.repaired / 2);
}

}  // namespace
}  // namespace ayumi::test
