#include "ayumi/io/run/sha256.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/io/run/sha256_stream.hpp"

namespace ayumi {
namespace {

// The examples published with the standard (FIPS 180-4).
TEST(Sha256, MatchesThePublishedExamples) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, OfAFileIsThatOfItsBytes) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "sha256_of_file";
  for (const size_t size : {size_t{0}, size_t{1}, size_t{1} << 20, (size_t{1} << 20) + 7}) {
    std::string bytes(size, 'a');
    for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * i % 251);
    write_file(file, bytes);
    EXPECT_EQ(sha256_of_file(file, size), sha256(bytes)) << size;
    EXPECT_EQ(read_file(file, size), bytes) << size;
  }
  EXPECT_THROW(sha256_of_file(file, size_t{1} << 20), Error);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace ayumi
