#include "ayumi/io/run/sample_compression.hpp"

#include <gtest/gtest.h>

#include <array>
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

// A row may contain any pattern of bits: numbers of both signs and of all sizes, zeros of both
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

// The error of predicting a smooth quantity is its fourth difference. For a sine with steps of
// 0.005 rad it is at most 0.005^4, which takes 22 of the 64 bits of a number between 1 and 4,
// including the sign.
TEST(SampleCompression, SmoothColumnsAreSmall) {
  std::vector<double> values;
  for (int k = 0; k < 8000; ++k)
    for (const double phase : {0.1, 0.2, 0.3}) values.push_back(2 + std::sin(0.005 * k + phase));
  const std::string plain = bytes_of(values);
  EXPECT_LT(compress_samples(plain, 3).size(), 22 * plain.size() / 64);
}

// The columns are an angle that a simulator integrates from its rate, a torque that follows from
// both except for a few rows at its peak, and a copy: columns that follow from others take almost
// no space.
struct Servo {
  std::vector<double> values;
  ColumnSources sources = {{1}, {}, {0, 1, 3}, {}, {3}};
  Servo() {
    double angle = 0.1;
    for (int k = 0; k < 6000; ++k) {
      const double rate = 2 * std::sin(0.003 * k) + 1e-3 * std::sin(1e6 * k);
      angle += 0.001 * rate;
      const double target = std::sqrt(2 + std::sin(0.001 * k));
      const double torque = std::min(950.0, 600 * (target - angle) - 12 * rate);
      for (const double value : {angle, rate, torque, target, target}) values.push_back(value);
    }
  }
};

TEST(SampleCompression, RelatedColumnsAreSmallAndExact) {
  const Servo servo;
  const std::string plain = bytes_of(servo.values);
  const std::string alone = compress_samples(plain, 5);
  const std::string related = compress_samples(plain, 5, servo.sources);
  EXPECT_EQ(decompress_samples(related, 5, 6000, "x"), plain);
  EXPECT_EQ(decompress_samples(alone, 5, 6000, "x"), plain);
  // What has to be stored is the rate and the target, and the rounding of the two columns that are
  // integrated or computed: three bits of each sample.
  std::vector<double> two;
  for (size_t i = 0; i < servo.values.size(); i += 5)
    two.insert(two.end(), {servo.values[i + 1], servo.values[i + 3]});
  EXPECT_LT(related.size(), compress_samples(bytes_of(two), 2).size() + 2 * 3 * 6000 / 8);
  EXPECT_LT(related.size(), alone.size());
}

TEST(SampleCompression, RelatedColumnsMayHoldAnyNumber) {
  Servo servo;
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               inf = std::numeric_limits<double>::infinity(),
               most = std::numeric_limits<double>::max();
  for (size_t i = 0; i < servo.values.size(); i += 37)
    servo.values[i] = std::array{nan, inf, -most, -0.0}[i % 4];
  const std::string plain = bytes_of(servo.values);
  EXPECT_EQ(decompress_samples(compress_samples(plain, 5, servo.sources), 5, 6000, "x"), plain);
}

TEST(SampleCompression, ColumnsThatFollowFromEachOtherAreRefused) {
  const std::string plain = bytes_of(Servo().values);
  EXPECT_NE(test::error_message(
                [&] {
                  compress_samples(plain, 5, {{}, {}, {}, {4}, {3}});
                },
                ErrorCode::internal)
                .find("predict each other"),
            std::string::npos);
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
            "x.bin: the file is truncated or damaged, because the samples (zstd) are incomplete");
  EXPECT_EQ(message("", 2, 300),
            "x.bin: the file is truncated or damaged, because the samples (zstd) are incomplete");
  EXPECT_EQ(message(good + "abc", 2, 300),
            "x.bin: the file is damaged: there are 3 bytes after the samples");
  EXPECT_EQ(message(good, 2, 301),
            "x.bin: the file is damaged: the samples are not 301 rows of 2 columns");
  // Any flipped bit is noticed, by zstd or by the checksum of the decompressed bytes.
  for (size_t at = 0; at < good.size(); ++at) {
    std::string flipped = good;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x20);
    EXPECT_NE(message(flipped, 2, 300), "no error") << "byte " << at;
  }
}

}  // namespace
}  // namespace ayumi
