#include "ayumi/render/planar_yuv.hpp"

#include <array>
#include <cstring>
#ifdef __x86_64__
#include <immintrin.h>
#endif

#include "ayumi/base/error.hpp"

// With R, G, B in 0..255:
//   L = 0.2126 R + 0.7152 G + 0.0722 B,
//   Y = 16 + 219/255 L,
//   Cb = 128 + 224/255 (B - L) / 1.8556,
//   Cr = 128 + 224/255 (R - L) / 1.5748.
// Y, Cb and Cr are computed in whole numbers with the unit 2^16; for the sum of four pixels, the
// unit is 2^18.

namespace ayumi {
namespace {

/// Shares of the colours in the luma. Source: ITU-R BT.709.
constexpr double kRed = 0.2126, kGreen = 0.7152, kBlue = 0.0722;

constexpr int unit(double share) {
  return static_cast<int>(share * 65536 + (share < 0 ? -0.5 : 0.5));
}
/// Weights of R, G, B. For grey, the weighted sums of the two colour signals are exactly zero.
constexpr std::array<int, 3> kY = {unit(219.0 / 255 * kRed), unit(219.0 / 255 * kGreen),
                                   unit(219.0 / 255 * kBlue)};
/// Range of the colours over 2 (1 - kBlue) and 2 (1 - kRed). Source: ITU-R BT.709.
constexpr double kCbScale = 224.0 / 255 / 1.8556, kCrScale = 224.0 / 255 / 1.5748;
constexpr std::array<int, 3> kCb = {unit(-kCbScale * kRed), unit(-kCbScale* kGreen),
                                    -unit(-kCbScale* kRed) - unit(-kCbScale* kGreen)};
constexpr std::array<int, 3> kCr = {-unit(-kCrScale * kGreen) - unit(-kCrScale * kBlue),
                                    unit(-kCrScale* kGreen), unit(-kCrScale* kBlue)};

std::uint8_t luma(const std::uint8_t* p) {
  return static_cast<std::uint8_t>(
      (kY[0] * p[0] + kY[1] * p[1] + kY[2] * p[2] + (16 << 16) + (1 << 15)) >> 16);
}

std::uint8_t chroma(const std::array<int, 3>& weight, int r, int g, int b) {
  return static_cast<std::uint8_t>(
      (weight[0] * r + weight[1] * g + weight[2] * b + (128 << 18) + (1 << 17)) >> 18);
}

/// Two rows from pixel `x` on; `cb` and `cr` of the first of those pixels.
struct TwoRows {
  const std::uint8_t *upper, *lower;
  std::uint8_t *y_upper, *y_lower, *cb, *cr;
};

void convert_one_by_one(const TwoRows& rows, size_t x, size_t width) {
  for (size_t i = x; i < width; ++i) rows.y_upper[i] = luma(rows.upper + 3 * i);
  for (size_t i = x; i < width; ++i) rows.y_lower[i] = luma(rows.lower + 3 * i);
  for (size_t i = x; i < width; i += 2) {
    const std::uint8_t *p = rows.upper + 3 * i, *q = rows.lower + 3 * i;
    const int r = p[0] + p[3] + q[0] + q[3], g = p[1] + p[4] + q[1] + q[4];
    const int b = p[2] + p[5] + q[2] + q[5];
    rows.cb[i / 2] = chroma(kCb, r, g, b);
    rows.cr[i / 2] = chroma(kCr, r, g, b);
  }
}

#ifdef __x86_64__

// Computes the same whole numbers for eight pixels at once. A product of pairs takes weights of 16
// bits, so that the weight of green is split in two.
#define AYUMI_AVX2 [[gnu::target("avx2")]]

AYUMI_AVX2 inline __m256i pairs_of_weights(int first, int second) {
  return _mm256_set1_epi32((first & 0xffff) | second << 16);
}

struct EightPixels {
  __m256i red_green, green_blue;  // two numbers of 16 bits in 32 bits
};

AYUMI_AVX2 inline void load(const std::uint8_t* rgb, EightPixels& out) {
  const __m128i first = _mm_loadu_si128(reinterpret_cast<const __m128i*>(rgb));
  const __m128i second = _mm_loadu_si128(reinterpret_cast<const __m128i*>(rgb + 12));
  const __m256i both = _mm256_set_m128i(second, first);
  const char n = -1;
  const __m256i rg = _mm256_setr_epi8(0, n, 1, n, 3, n, 4, n, 6, n, 7, n, 9, n, 10, n,  //
                                      0, n, 1, n, 3, n, 4, n, 6, n, 7, n, 9, n, 10, n);
  const __m256i gb = _mm256_setr_epi8(1, n, 2, n, 4, n, 5, n, 7, n, 8, n, 10, n, 11, n,  //
                                      1, n, 2, n, 4, n, 5, n, 7, n, 8, n, 10, n, 11, n);
  out.red_green = _mm256_shuffle_epi8(both, rg);
  out.green_blue = _mm256_shuffle_epi8(both, gb);
}

AYUMI_AVX2 inline __m256i weighted(const EightPixels& pixels, const __m256i& rg,
                                   const __m256i& gb) {
  return _mm256_add_epi32(_mm256_madd_epi16(pixels.red_green, rg),
                          _mm256_madd_epi16(pixels.green_blue, gb));
}

/// The lowest bytes of eight numbers of 32 bits.
AYUMI_AVX2 inline std::uint64_t bytes_of(const __m256i& numbers) {
  const __m128i low = _mm256_castsi256_si128(numbers), high = _mm256_extracti128_si256(numbers, 1);
  const __m128i words = _mm_packs_epi32(low, high);
  return static_cast<std::uint64_t>(_mm_cvtsi128_si64(_mm_packus_epi16(words, words)));
}

AYUMI_AVX2 inline void store_luma(const EightPixels& pixels, std::uint8_t* out) {
  constexpr int kHalf = kY[1] / 2;
  const __m256i sum =
      weighted(pixels, pairs_of_weights(kY[0], kHalf), pairs_of_weights(kY[1] - kHalf, kY[2]));
  const __m256i all = _mm256_add_epi32(sum, _mm256_set1_epi32((16 << 16) + (1 << 15)));
  const std::uint64_t bytes = bytes_of(_mm256_srai_epi32(all, 16));
  std::memcpy(out, &bytes, 8);
}

AYUMI_AVX2 inline void store_chroma(const EightPixels& pixels, const std::array<int, 3>& weight,
                                    std::uint8_t* out) {
  const __m256i sum =
      weighted(pixels, pairs_of_weights(weight[0], weight[1]), pairs_of_weights(0, weight[2]));
  const __m256i two = _mm256_hadd_epi32(sum, sum);
  const __m256i all = _mm256_add_epi32(two, _mm256_set1_epi32((128 << 18) + (1 << 17)));
  const std::uint64_t bytes = bytes_of(_mm256_srai_epi32(all, 18));
  // Each half of the register holds its two sums twice.
  out[0] = static_cast<std::uint8_t>(bytes);
  out[1] = static_cast<std::uint8_t>(bytes >> 8);
  out[2] = static_cast<std::uint8_t>(bytes >> 32);
  out[3] = static_cast<std::uint8_t>(bytes >> 40);
}

/// Returns the first pixel that is still to be converted, because loads read more than they use.
AYUMI_AVX2 size_t convert_by_eight(const TwoRows& rows, size_t width) {
  size_t x = 0;
  for (; x + 10 <= width; x += 8) {
    EightPixels upper, lower;
    load(rows.upper + 3 * x, upper);
    load(rows.lower + 3 * x, lower);
    store_luma(upper, rows.y_upper + x);
    store_luma(lower, rows.y_lower + x);
    const EightPixels both = {_mm256_add_epi16(upper.red_green, lower.red_green),
                              _mm256_add_epi16(upper.green_blue, lower.green_blue)};
    store_chroma(both, kCb, rows.cb + x / 2);
    store_chroma(both, kCr, rows.cr + x / 2);
  }
  return x;
}

const bool kHasEight = __builtin_cpu_supports("avx2");

#endif

}  // namespace

void to_yuv420(const Image& image, std::vector<std::uint8_t>& planes) {
  const size_t width = static_cast<size_t>(image.width), height = static_cast<size_t>(image.height);
  require(width % 2 == 0 && height % 2 == 0, "video needs an even width and height");
  planes.resize(width * height * 3 / 2);
  std::uint8_t* cb = planes.data() + width * height;
  std::uint8_t* cr = cb + width * height / 4;
  for (size_t y = 0; y < height; y += 2, cb += width / 2, cr += width / 2) {
    const std::uint8_t* upper = &image.rgb[3 * width * y];
    std::uint8_t* out = planes.data() + width * y;
    const TwoRows rows = {upper, upper + 3 * width, out, out + width, cb, cr};
    size_t x = 0;
#ifdef __x86_64__
    if (kHasEight) x = convert_by_eight(rows, width);
#endif
    convert_one_by_one(rows, x, width);
  }
}

}  // namespace ayumi
