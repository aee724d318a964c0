// The rules of attribution are data; their documentation is made from them.

#include "ayumi/check/attribution.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace ayumi::test {
namespace {

std::string page(const std::string& file) {
  std::ifstream stream(std::filesystem::path(AYUMI_SOURCE_DIR) / file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(Attribution, TheTableOfThePageIsThatOfTheProgram) {
  std::string table =
      "| cause | follows from it | where | condition |\n| --- | --- | --- | --- |\n";
  for (const auto& row : attribution_table())
    table += "| " + row[0] + " | " + row[1] + " | " + row[2] + " | " + row[3] + " |\n";
  EXPECT_NE(page("docs/attribution.md").find(table + "\n"), std::string::npos)
      << "docs/attribution.md should contain:\n"
      << table;
}

}  // namespace
}  // namespace ayumi::test
