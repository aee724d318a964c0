// Computes two or four numbers at once, each by the operations of Random::normal() in their order.
#include "ayumi/math/random.hpp"

#include <algorithm>

#include "ayumi/math/elementary_parts.hpp"

namespace ayumi {

namespace {

/// The number of numbers that are drawn at once. Definition: a workspace; results do not depend on
/// it.
constexpr int kMostAtOnce = 32;

typedef double Two __attribute__((vector_size(16)));
typedef long long TwoWhole __attribute__((vector_size(16)));
typedef double Four __attribute__((vector_size(32)));
typedef long long FourWhole __attribute__((vector_size(32)));

/// elementary::log() for 2^-1000 < x < 2^1000.
template <typename Numbers, typename Whole>
[[gnu::always_inline]] inline void log_of(const Numbers& x, Numbers& result) {
  constexpr int kFraction = 52;  // bits of a double behind its exponent
  constexpr long long kHalf = 1022;
  Whole bits;
  __builtin_memcpy(&bits, &x, sizeof bits);
  Whole exponent = (bits >> kFraction) - kHalf;
  const Whole fraction = (bits & ((1ll << kFraction) - 1)) | (kHalf << kFraction);
  Numbers m;
  __builtin_memcpy(&m, &fraction, sizeof m);
  const Whole small = m < elementary::parts::kRootHalf;  // -1 in the lanes in which it is true
  m = small ? 2.0 * m : m;
  exponent += small;
  const Numbers k = __builtin_convertvector(exponent, Numbers);
  const elementary::parts::Pair<Numbers> y = elementary::parts::log_of(m, k);
  result = y.high + y.low;
}

/// elementary::cos() for |x| < 1e9.
template <typename Numbers, typename Whole>
[[gnu::always_inline]] inline void cos_of(const Numbers& x, Numbers& result) {
  const elementary::parts::Reduced<Numbers> r = elementary::parts::reduced(x);
  const Whole odd = (r.quadrant & 1) != 0, negative = ((r.quadrant + 1) & 2) != 0;
  Numbers sine, cosine;
  elementary::parts::sine_of(r.rest, sine);
  elementary::parts::cosine_of(r.rest, cosine);
  const Numbers value = odd ? sine : cosine;
  result = negative ? -value : value;
}

/// Box-Muller: each number in (0, 1] becomes a normal number, with the angle [rad] from the second
/// list. `count` is a multiple of the width.
template <typename Numbers, typename Whole>
[[gnu::always_inline]] inline void turn_normal(double* first, const double* second, int count) {
  constexpr int kWidth = sizeof(Numbers) / sizeof(double);
  for (int i = 0; i < count; i += kWidth) {
    Numbers x, angle, logarithm, cosine;
    __builtin_memcpy(&x, first + i, sizeof x);
    __builtin_memcpy(&angle, second + i, sizeof angle);
    log_of<Numbers, Whole>(x, logarithm);
    cos_of<Numbers, Whole>(angle, cosine);
    const Numbers square = -2.0 * logarithm;
    for (int k = 0; k < kWidth; ++k) x[k] = __builtin_sqrt(square[k]) * cosine[k];
    __builtin_memcpy(first + i, &x, sizeof x);
  }
}

void normals_of_two(double* first, const double* second, int count) {
  turn_normal<Two, TwoWhole>(first, second, count);
}

#ifdef __x86_64__
[[gnu::target("avx2")]] void normals_of_four(double* first, const double* second, int count) {
  turn_normal<Four, FourWhole>(first, second, count);
}
bool has_four() { return __builtin_cpu_supports("avx2"); }
#else
void normals_of_four(double* first, const double* second, int count) {
  turn_normal<Four, FourWhole>(first, second, count);
}
bool has_four() { return true; }
#endif

}  // namespace

void Random::normals(double* out, int count) {
  static const bool four = has_four();
  alignas(32) double first[kMostAtOnce], second[kMostAtOnce];
  for (int begin = 0; begin < count; begin += kMostAtOnce) {
    const int now = std::min(kMostAtOnce, count - begin), filled = (now + 3) / 4 * 4;
    for (int i = 0; i < now; ++i) {
      first[i] = 1.0 - uniform();
      second[i] = 2.0 * M_PI * uniform();
    }
    for (int i = now; i < filled; ++i) first[i] = 1, second[i] = 0;
    (four ? normals_of_four : normals_of_two)(first, second, filled);
    std::copy_n(first, now, out + begin);
  }
}

}  // namespace ayumi
