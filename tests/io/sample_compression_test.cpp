#include "ayumi/io/run/sample_compression.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "ayumi/base/error.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

std::string bytes_of(const std::vector<double>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)};
}

// Every pair of bits may stand in a row: numbers of both signs and of all sizes, zeros of both
// signs, infinities, and NaN with its payload.
TEST(SampleCompression, NoBitIsLost) {
  test::Random random(1);
  std::vector<double> values = {0.0,
                                -0.0,
                                std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::quiet_NaN(),
                                -std::nan("77"),
                                std::numeric_limits<double>::denorm_min(),
                                -std::numeric_limits<double>::max(),
                                std::numeric_limits<double>::max()};
  for (int k = 0; k < 3000; ++k) {
    values.push_back(std::ldexp(random.uniform(), static_cast<int>(random.uniform(-1000, 1000))));
    values.push_back(values[static_cast<size_t>(random.uniform(0, 9))]);
    values.push_back(std::sin(0.01 * k));
  }
  for (const size_t columns : {size_t{1}, size_t{3}, size_t{9}}) {
    values.resize(values.size() / columns * columns);
    const size_t rows = values.size() / columns;
    const std::string plain = bytes_of(values);
    EXPECT_EQ(decompress_samples(compress_samples(plain, columns), columns, rows, "x"), plain);
  }
  EXPECT_EQ(decompress_samples(compress_samples("", 5), 5, 0, "x"), "");
}

// The prediction of a smooth quantity misses by its fourth difference. That of a sine with steps of
// 0.005 rad is at most 0.005^4, which has 22 of the 64 bits of a number between 1 and 4, the sign
// included.
TEST(SampleCompression, SmoothColumnsAreSmall) {
  std::vector<double> values;
  for (int k = 0; k < 8000; ++k)
    for (const double phase : {0.1, 0.2, 0.3}) values.push_back(2 + std::sin(0.005 * k + phase));
  const std::string plain = bytes_of(values);
  EXPECT_LT(compress_samples(plain, 3).size(), 22 * plain.size() / 64);
}

TEST(SampleCompression, DamageGetsOneMessage) {
  std::vector<double> values(600);
  for (size_t k = 0; k < values.size(); ++k) values[k] = std::sqrt(static_cast<double>(k));
  const std::string good = compress_samples(bytes_of(values), 2);
  const auto message = [](const std::string& bytes, size_t columns, size_t rows) {
    return test::error_message([&] { decompress_samples(bytes, columns, rows, "x.bin"); },
                               ErrorCode::bad_file);
  };
  EXPECT_EQ(message(good, 2, 300), "no error");
  EXPECT_EQ(message(good.substr(0, good.size() / 2), 2, 300),
            "x.bin: truncated or damaged: the samples (zstd) are incomplete");
  EXPECT_EQ(message("", 2, 300), "x.bin: truncated or damaged: the samples (zstd) are incomplete");
  EXPECT_EQ(message(good + "abc", 2, 300), "x.bin: damaged: 3 bytes after the samples");
  EXPECT_EQ(message(good, 2, 301), "x.bin: damaged: the samples are not 301 rows of 2 columns");
  // Any flipped bit is seen: by zstd, or by the checksum of what it decompresses.
  for (size_t at = 0; at < good.size(); ++at) {
    std::string flipped = good;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x20);
    EXPECT_NE(message(flipped, 2, 300), "no error") << "byte " << at;
  }
}

}  // namespace
}  // namespace ayumi
