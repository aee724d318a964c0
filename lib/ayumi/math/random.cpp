// Two numbers at once, each by the operations of Random::normal() in their order.
#include "ayumi/math/random.hpp"

#include <algorithm>
#include <bit>

#include "ayumi/math/elementary_parts.hpp"

namespace ayumi {

namespace {

typedef double Two __attribute__((vector_size(16)));
typedef long long TwoWhole __attribute__((vector_size(16)));

/// elementary::log() for 2^-1000 < x < 2^1000.
Two log_of_two(Two x) {
  constexpr int kFraction = 52;  // bits of a double behind its exponent
  constexpr long long kHalf = 1022;
  const auto bits = std::bit_cast<TwoWhole>(x);
  TwoWhole exponent = (bits >> kFraction) - kHalf;
  Two m = std::bit_cast<Two>((bits & ((1ll << kFraction) - 1)) | (kHalf << kFraction));
  const TwoWhole small = m < elementary::parts::kRootHalf;  // -1: yes
  m = small ? 2.0 * m : m;
  exponent += small;
  const Two k = {static_cast<double>(exponent[0]), static_cast<double>(exponent[1])};
  const elementary::parts::Pair<Two> y = elementary::parts::log_of(m, k);
  return y.high + y.low;
}

/// elementary::cos() for |x| < 1e9.
Two cos_of_two(Two x) {
  const elementary::parts::Reduced<Two> r = elementary::parts::reduced(x);
  const TwoWhole odd = (r.quadrant & 1) != 0, negative = ((r.quadrant + 1) & 2) != 0;
  const Two value = odd ? elementary::parts::sine_of(r.rest) : elementary::parts::cosine_of(r.rest);
  return negative ? -value : value;
}

}  // namespace

void Random::normals(double* out, int count) {
  for (int i = 0; i < count; i += 2) {
    const int pair = std::min(2, count - i);
    Two first = {1, 1}, second = {};
    for (int k = 0; k < pair; ++k) {
      first[k] = 1.0 - uniform();
      second[k] = 2.0 * M_PI * uniform();
    }
    const Two square = -2.0 * log_of_two(first), cosine = cos_of_two(second);
    for (int k = 0; k < pair; ++k) out[i + k] = std::sqrt(square[k]) * cosine[k];
  }
}

}  // namespace ayumi
