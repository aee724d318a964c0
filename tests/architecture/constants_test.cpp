// Every named number of the rooms that judge, repair, control and search says where it comes from:
// the comment above it or beside it has one of the words below. Constants that stand directly below
// each other may share a comment. A value that is made of other constants alone needs no comment.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>

#include "tests/architecture/layers.hpp"

namespace ayumi::test {
namespace {

const std::vector<std::string> kSteeringRooms = {"limits",  "check", "demand", "repair",
                                                 "control", "sim",   "study",  "plan"};
const std::regex kSourceWord("Source|Derived|Measured|Chosen|Definition");
const std::regex kDeclaration(
    "^\\s*(static |inline )*constexpr (double|float|int|long|size_t|[A-Z]\\w*) k[A-Z]\\w*(\\[\\])? "
    "?=.*");
const std::regex kComment("^\\s*//.*");

/// Lists "file:line: constant" for each constant without a source.
std::string constants_without_source(const fs::path& root, const std::string& shown) {
  std::ifstream stream(root / shown);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  std::string found;
  for (size_t i = 0; i < lines.size(); ++i) {
    if (!std::regex_match(lines[i], kDeclaration)) continue;
    std::string statement = lines[i];
    for (size_t k = i; lines[k].find(';') == std::string::npos && k + 1 < lines.size(); ++k)
      statement += lines[k + 1];
    std::string words = statement;
    for (size_t k = i; k > 0 && (std::regex_match(lines[k - 1], kComment) ||
                                 std::regex_match(lines[k - 1], kDeclaration));
         --k)
      words += lines[k - 1];
    const std::string value = statement.substr(statement.find('='));
    const bool has_number = std::regex_search(value, std::regex("[^A-Za-z_]\\d"));
    if (has_number && !std::regex_search(words, kSourceWord))
      found += shown + ":" + std::to_string(i + 1) + ": " + statement + "\n";
  }
  return found;
}

std::string all_constants_without_source(const fs::path& root) {
  std::string found;
  for (const std::string& room : kSteeringRooms) {
    const fs::path folder = root / "lib/ayumi" / room;
    if (!fs::exists(folder)) continue;
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".hpp")
        files.push_back(fs::relative(entry.path(), root).string());
    std::sort(files.begin(), files.end());
    for (const std::string& file : files) found += constants_without_source(root, file);
  }
  return found;
}

/// The constants that are found in a tree whose only file, lib/ayumi/check/a.cpp, has this content.
std::string found_in(const std::string& content) {
  const fs::path root =
      fs::path(testing::TempDir()) / ("ayumi_constants_" + std::to_string(::getpid()));
  fs::create_directories(root / "lib/ayumi/check");
  std::ofstream(root / "lib/ayumi/check/a.cpp") << content;
  const std::string found = all_constants_without_source(root);
  fs::remove_all(root);
  return found;
}

TEST(Constants, OfSteeringRoomsHaveASource) {
  const fs::path root = AYUMI_SOURCE_DIR;
  ASSERT_TRUE(fs::exists(root / "lib/ayumi/limits"));
  EXPECT_EQ(all_constants_without_source(root), "");
}

TEST(Constants, WithoutASourceAreFound) {
  EXPECT_EQ(found_in("constexpr double kGap = 0.02;\n"),
            "lib/ayumi/check/a.cpp:1: constexpr double kGap = 0.02;\n");
  EXPECT_EQ(found_in("// Widest gap [s].\ninline constexpr int kMost = 3;  // steps\n"),
            "lib/ayumi/check/a.cpp:2: inline constexpr int kMost = 3;  // steps\n");
  EXPECT_EQ(
      found_in("// Chosen: two samples.\nconstexpr double kA = 2;\n\nconstexpr double kB = 3;\n"),
      "lib/ayumi/check/a.cpp:4: constexpr double kB = 3;\n");
  EXPECT_EQ(found_in("constexpr Backoff kFirst = {1e-4, 0.998};\n"),
            "lib/ayumi/check/a.cpp:1: constexpr Backoff kFirst = {1e-4, 0.998};\n");
}

TEST(Constants, WithASourceAreNot) {
  EXPECT_EQ(found_in("// Widest gap [s]. Chosen: two steps.\nconstexpr double kGap = 0.02;\n"), "");
  EXPECT_EQ(found_in("constexpr int kReach = 2;  // Derived: as fill_rates()\n"), "");
  EXPECT_EQ(found_in("// Measured: both.\nconstexpr double kA = 2;\nconstexpr double kB = 3;\n"),
            "");
  EXPECT_EQ(found_in("constexpr double kBand = policy::stance::kPosition;\n"), "");
  EXPECT_EQ(found_in("constexpr const char* kName = \"7\";\n"), "");
}

}  // namespace
}  // namespace ayumi::test
