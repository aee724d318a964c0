// In the table of limits, every kind is defined once, and each limit has its name, its file and its
// tolerance.

#include "ayumi/limits/limit_table.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "ayumi/limits/limit.hpp"

namespace ayumi::test {
namespace {

TEST(LimitTable, EveryKindIsDefinedOnceWithItsName) {
  std::set<std::string> names;
  int kinds = 0;
  for (const Limit* limit : limits()) kinds += static_cast<int>(limit->findings.size());
  EXPECT_EQ(kinds, kFindingKindCount);
  for (int i = 0; i < kFindingKindCount; ++i) {
    const auto kind = static_cast<FindingKind>(i);
    const FindingSpec& spec = spec_of(kind);
    EXPECT_EQ(spec.kind, kind);
    EXPECT_EQ(finding_kind(name_of(kind)), kind);
    EXPECT_TRUE(names.insert(name_of(kind)).second) << name_of(kind);
    EXPECT_NE(spec.place, nullptr) << name_of(kind);
    EXPECT_NE(spec.advice, nullptr) << name_of(kind);
    EXPECT_STRNE(spec.meaning, "") << name_of(kind);
    EXPECT_GT(spec.tolerance, 0) << name_of(kind);
  }
  EXPECT_FALSE(finding_kind("no_such_kind"));
}

TEST(LimitTable, FiguresHaveKeysLabelsAndDistinctLines) {
  std::set<int> lines;
  std::set<std::string> keys;
  for (const FindingSpec* spec : summary_figures()) {
    EXPECT_TRUE(lines.insert(spec->figure.line).second) << spec->figure.key;
    EXPECT_TRUE(keys.insert(spec->figure.key).second) << spec->figure.key;
    EXPECT_NE(spec->figure.label, nullptr) << spec->figure.key;
  }
  EXPECT_STREQ(summary_figures().front()->figure.key, "min_zmp_margin_m");
}

/// Every line of the table names a file of this room.
TEST(LimitTable, EveryLimitHasItsFile) {
  const std::filesystem::path room = std::filesystem::path(AYUMI_SOURCE_DIR) / "lib/ayumi/limits";
#define AYUMI_EXPECT_FILE(kind, limit) \
  EXPECT_TRUE(std::filesystem::exists(room / (std::string(#limit) + ".cpp"))) << #limit;
  AYUMI_FINDING_KINDS(AYUMI_EXPECT_FILE)
#undef AYUMI_EXPECT_FILE
}

/// The reasons why there is no repair are parts of a sentence. A kind without words of its own gets
/// general ones.
TEST(LimitTable, ReasonsWithoutARepairAreWords) {
  int ratios = 0;
  for (const FindingSpec* spec : finding_specs()) {
    if (!spec->infeasibility) continue;
    Finding finding;
    finding.kind = spec->kind;
    finding.where = "left";
    finding.unit = spec->unit;
    finding.worst = 1.234567;
    finding.limit = 1;
    const std::string words = spec->infeasibility(finding, 1.234567);
    SCOPED_TRACE(std::string(name_of(spec->kind)) + ": " + words);
    EXPECT_FALSE(words.empty());
    EXPECT_EQ(words.find('\n'), std::string::npos);
    EXPECT_NE(words.back(), '.');
    // A ratio is rounded up, so that the words never name less than what is missing.
    if (spec->is_ratio() && words.find("times") != std::string::npos) {
      EXPECT_NE(words.find("1.24 times"), std::string::npos);
      ++ratios;
    }
  }
  EXPECT_GT(ratios, 0);
}

TEST(LimitTable, TolerancesAreSetByName) {
  CheckOptions options;
  options.tolerances = {{"friction", 0.5}};
  EXPECT_EQ(tolerances(options)[FindingKind::friction], 0.5);
  EXPECT_EQ(tolerances(options)[FindingKind::foot_slip], 0.002);
  options.tolerances = {{"fricton", 0.5}};
  EXPECT_ANY_THROW(tolerances(options));
}

}  // namespace
}  // namespace ayumi::test
