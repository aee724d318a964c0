#include "ayumi/io/formats/npz_archive.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"

namespace ayumi::test {
namespace {

TEST(NpzArchive, HoldsWhatWasWritten) {
  const std::string bytes = zip_of(
      {{"angles.npy", npy_numbers({1, 2.5, -3, 4e-300, 5, 6}, {2, 3})}, {"about.txt", "words"}});
  const auto arrays = read_npz(bytes, "a.npz");
  ASSERT_EQ(arrays.size(), 1u);
  EXPECT_EQ(arrays.at("angles").shape, (std::vector<size_t>{2, 3}));
  EXPECT_EQ(arrays.at("angles").numbers, (std::vector<double>{1, 2.5, -3, 4e-300, 5, 6}));
}

// The checksum of the archive covers every bit of the numbers.
TEST(NpzArchive, AChangedBitIsNoticed) {
  const std::string numbers(6 * sizeof(double), '\0'),
      whole = zip_of({{"angles.npy", npy_bytes("<f8", {6}, numbers)}});
  const size_t begin = whole.find(numbers);
  ASSERT_NE(begin, std::string::npos);
  for (size_t i = 0; i < numbers.size(); ++i) {
    std::string bytes = whole;
    bytes[begin + i] = static_cast<char>(1 << (i % 8));
    try {
      read_npz(bytes, "a.npz");
      ADD_FAILURE() << "byte " << i;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_file);
      EXPECT_STREQ(error.what(),
                   "a.npz: angles: the array cannot be unpacked; the file may be damaged");
    }
  }
}

}  // namespace
}  // namespace ayumi::test
