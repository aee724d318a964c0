#include "ayumi/base/scratch_file.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "tests/support/error_message.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

TEST(ScratchFile, GivesBackWhatItReceivedAndLeavesNothing) {
  const fs::path folder = fs::path(::testing::TempDir()) / "ayumi_scratch_file";
  fs::remove_all(folder);
  fs::create_directories(folder);
  ScratchFile file(folder), other(folder);
  EXPECT_TRUE(fs::is_empty(folder));
  std::string all;
  for (int i = 0; i < 1000; ++i) {
    const std::string piece(static_cast<size_t>(i), static_cast<char>('a' + i % 26));
    file.append(piece);
    all += piece;
  }
  other.append("other");
  EXPECT_EQ(file.size(), all.size());
  EXPECT_EQ(file.read(0, all.size()), all);
  EXPECT_EQ(file.read(12345, 678), all.substr(12345, 678));
  EXPECT_EQ(other.read(0, 5), "other");
  EXPECT_EQ(test::error_message([&] { other.read(3, 3); }, ErrorCode::bad_file),
            folder.string() +
                ": the samples cannot be read back from a file in this folder (Input/output "
                "error)");
}

TEST(ScratchFile, WhatIsNoFolderIsRefused) {
  EXPECT_EQ(test::error_message([] { ScratchFile("/dev/full"); }, ErrorCode::bad_file),
            "/dev/full: no file can be made in this folder (Not a directory)");
}

}  // namespace
}  // namespace ayumi
