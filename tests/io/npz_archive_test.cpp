#include "ayumi/io/formats/npz_archive.hpp"

#include <gtest/gtest.h>

#include <map>

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

// NumPy itself chooses the order of Fortran, for example for root_rot[:, [3, 0, 1, 2]].
TEST(NpzArchive, ReadsArraysInTheOrderOfFortran) {
  // The numbers of [[[1, 2], [3, 4], [5, 6]], [[7, 8], [9, 10], [11, 12]]], column after column.
  std::string cube = npy_numbers({1, 7, 3, 9, 5, 11, 2, 8, 4, 10, 6, 12}, {2, 3, 2});
  std::string words = npy_words({"a", "c", "b", "d"}, {2, 2});
  for (std::string* const array : {&cube, &words}) {
    const size_t at = array->find("False");
    ASSERT_NE(at, std::string::npos);
    array->replace(at, 5, " True");
  }
  const auto arrays = read_npz(zip_of({{"cube.npy", cube}, {"words.npy", words}}), "a.npz");
  EXPECT_EQ(arrays.at("cube").refused, "");
  EXPECT_EQ(arrays.at("cube").numbers,
            (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  EXPECT_EQ(arrays.at("words").words, (std::vector<std::string>{"a", "b", "c", "d"}));
}

TEST(NpzArchive, ReadsWholeNumbersOfEveryWidth) {
  const auto number_of = [](const std::string& type, const std::string& data) {
    return read_npz(zip_of({{"fps.npy", npy_bytes(type, {1}, data)}}), "a.npz").at("fps").numbers;
  };
  for (const auto& [type, data] :
       std::map<std::string, std::string>{{"|u1", "\x32"},
                                          {"|i1", "\x32"},
                                          {"<u2", std::string("\x32\0", 2)},
                                          {"<i2", std::string("\x32\0", 2)},
                                          {"<u4", std::string("\x32\0\0\0", 4)},
                                          {"<i4", std::string("\x32\0\0\0", 4)}})
    EXPECT_EQ(number_of(type, data), std::vector<double>{50}) << type;
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
