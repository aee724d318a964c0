#include "ayumi/io/run/sample_compression.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "ayumi/base/error.hpp"
#include "ayumi/io/compression.hpp"

namespace ayumi {

namespace {

constexpr int kOrders = 5;  // Definition: n is 0 to 4

// The last four values of a column, the last one first; before the first value there are zeros.
using Past = std::array<double, 4>;

double prediction(int order, const Past& past) {
  const auto& [a, b, c, d] = past;
  double value = 0;
  if (order == 1) value = a;
  if (order == 2) value = 2 * a - b;
  if (order == 3) value = 3 * (a - b) + c;
  if (order == 4) value = 4 * (a + c) - 6 * b - d;
  return std::isfinite(value) ? value : 0;
}

void advance(Past& past, double value) { past = {value, past[0], past[1], past[2]}; }

// Floats and these integers are in the same order, from the largest negative one to the largest
// positive one.
constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
std::uint64_t rank_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}
double value_at(std::uint64_t rank) {
  return std::bit_cast<double>((rank & kSign) != 0 ? rank & ~kSign : ~rank);
}

// The sign goes to the last bit, so that small differences of both signs are small numbers.
std::uint64_t folded(std::uint64_t difference) {
  return (difference << 1) ^ (0 - (difference >> 63));
}
std::uint64_t unfolded(std::uint64_t number) { return (number >> 1) ^ (0 - (number & 1)); }

std::uint64_t residual(int order, const Past& past, double value) {
  return folded(rank_of(value) - rank_of(prediction(order, past)));
}

double float_at(std::string_view bytes, size_t index) {
  double value = 0;
  std::memcpy(&value, bytes.data() + index * sizeof value, sizeof value);
  return value;
}

int best_order(const std::vector<double>& column) {
  std::array<std::uint64_t, kOrders> bits = {};
  Past past = {};
  for (const double value : column) {
    for (int order = 0; order < kOrders; ++order)
      bits[static_cast<size_t>(order)] +=
          static_cast<std::uint64_t>(std::bit_width(residual(order, past, value)));
    advance(past, value);
  }
  return static_cast<int>(std::min_element(bits.begin(), bits.end()) - bits.begin());
}

// One byte per column, its order; then the planes.
size_t plain_size(size_t columns, size_t rows) { return columns + columns * rows * sizeof(double); }

// Where byte `plane` (7 is the most significant one) of the first value of a column stands.
size_t plane_begin(size_t plane, size_t column, size_t columns, size_t rows) {
  return columns + ((7 - plane) * columns + column) * rows;
}

}  // namespace

std::string compress_samples(std::string_view rows, size_t columns) {
  const size_t count = columns == 0 ? 0 : rows.size() / (columns * sizeof(double));
  std::string plain(plain_size(columns, count), '\0');
  std::vector<double> column(count);
  for (size_t c = 0; c < columns; ++c) {
    for (size_t k = 0; k < count; ++k) column[k] = float_at(rows, k * columns + c);
    const int order = best_order(column);
    plain[c] = static_cast<char>(order);
    Past past = {};
    for (size_t k = 0; k < count; ++k) {
      const std::uint64_t number = residual(order, past, column[k]);
      for (size_t plane = 0; plane < 8; ++plane)
        plain[plane_begin(plane, c, columns, count) + k] = static_cast<char>(number >> (8 * plane));
      advance(past, column[k]);
    }
  }
  return zstd_frame(plain);
}

std::string decompress_samples(std::string_view bytes, size_t columns, size_t rows,
                               const std::string& file) {
  const size_t whole = ZSTD_findFrameCompressedSize(bytes.data(), bytes.size());
  if (ZSTD_isError(whole) != 0)
    fail(ErrorCode::bad_file, file + ": truncated or damaged: the samples (zstd) are incomplete");
  if (whole != bytes.size())
    fail(ErrorCode::bad_file,
         file + ": damaged: " + std::to_string(bytes.size() - whole) + " bytes after the samples");
  const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  if (size != plain_size(columns, rows))
    fail(ErrorCode::bad_file, file + ": damaged: the samples are not " + std::to_string(rows) +
                                  " rows of " + std::to_string(columns) + " columns");
  std::string plain(size, '\0');
  const size_t got = ZSTD_decompress(plain.data(), plain.size(), bytes.data(), bytes.size());
  if (got != size)
    fail(ErrorCode::bad_file,
         file + ": damaged: the samples do not decompress (" + ZSTD_getErrorName(got) + ")");
  std::string values(columns * rows * sizeof(double), '\0');
  for (size_t c = 0; c < columns; ++c) {
    const int order = plain[c];
    if (order < 0 || order >= kOrders)
      fail(ErrorCode::bad_file,
           file + ": damaged: column " + std::to_string(c) + " of the samples");
    Past past = {};
    for (size_t k = 0; k < rows; ++k) {
      std::uint64_t number = 0;
      for (size_t plane = 0; plane < 8; ++plane)
        number |= std::uint64_t{static_cast<unsigned char>(
                      plain[plane_begin(plane, c, columns, rows) + k])}
                  << (8 * plane);
      const double value = value_at(unfolded(number) + rank_of(prediction(order, past)));
      std::memcpy(values.data() + (k * columns + c) * sizeof value, &value, sizeof value);
      advance(past, value);
    }
  }
  return values;
}

}  // namespace ayumi
