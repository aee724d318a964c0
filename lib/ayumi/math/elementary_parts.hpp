#pragma once
// The series behind the elementary functions, for one number T or for several numbers side by side
// (a vector type of the compiler). In both cases, the same operations are done in the same order,
// so that they give the same bits. All functions are inlined into their callers, which may be
// compiled for wider registers than others.

#include <bit>
#include <cstdint>

namespace ayumi::elementary::parts {

// Adding and subtracting this number rounds to a whole number: it is 1.5 * 2^52, whose last bit has
// the value 1.
constexpr double kRound = 6755399441055744.0;

// A number as the sum of two numbers, of which the second is far smaller.
template <typename T>
struct Pair {
  T high{}, low{};
};
template <typename T>
[[gnu::always_inline]] inline Pair<T> sum(const T& a, const T& b) {  // the sum is exact
  const T s = a + b, part = s - a;
  return {s, (a - (s - part)) + (b - part)};
}
// The sum is exact if |a| >= |b|.
template <typename T>
[[gnu::always_inline]] inline Pair<T> quick_sum(const T& a, const T& b) {
  const T s = a + b;
  return {s, b - (s - a)};
}
template <typename T>
[[gnu::always_inline]] inline Pair<T> split(const T& a) {
  const T c = 134217729.0 * a;  // the factor is 2^27 + 1
  const T high = c - (c - a);
  return {high, a - high};
}
template <typename T, typename U>
[[gnu::always_inline]] inline Pair<T> product(const T& a,
                                              const U& b) {  // the product is exact (Dekker)
  const T p = a * b;
  const Pair<T> x = split(a);
  const Pair<U> y = split(b);
  return {p, ((x.high * y.high - p) + x.high * y.low + x.low * y.high) + x.low * y.low};
}

// x - k pi/2 with a magnitude of at most pi/4, and k mod 4, from the bits of a sum with kRound.
template <typename T>
struct Reduced {
  Pair<T> rest;
  decltype(T{} < T{}) quadrant{};
};
template <>
struct Reduced<double> {
  Pair<double> rest;
  int quadrant = 0;
};
inline void low_bits(double x, int& bits) {
  bits = static_cast<int>(std::bit_cast<std::int64_t>(x) & 3);
}
template <typename T, typename Bits>
[[gnu::always_inline]] inline void low_bits(const T& x, Bits& bits) {
  __builtin_memcpy(&bits, &x, sizeof bits);
  bits &= 3;
}
template <typename T>
[[gnu::always_inline]] inline Reduced<T> reduced(const T& x) {
  // pi/2 in three parts. The first two have 33 bits, so that their products with k up to 2^20 are
  // exact.
  constexpr double kFirst = 0x1.921fb544p0, kSecond = 0x1.0b4611a6p-34,
                   kThird = 0x1.3198a2e037073p-69;
  const T shifted = x * 0.63661977236758134308 + kRound;
  const T k = shifted - kRound;
  const Pair<T> first = product(k, kFirst), second = product(k, kSecond);
  // For k up to 2^30, the products are exact as pairs.
  const Pair<T> a = sum<T>(x - first.high, -first.low);
  const Pair<T> b = sum<T>(a.high, -second.high);
  const T low = a.low + b.low - second.low - k * kThird;
  Reduced<T> result{quick_sum(b.high, low)};
  low_bits(shifted, result.quadrant);
  return result;
}

// Taylor's series for |x| <= pi/4, where the argument has a small rest.
template <typename T>
[[gnu::always_inline]] inline void sine_of(const Pair<T>& r, T& sine) {
  const T x = r.high, z = x * x;
  T s = -1.0 / 1307674368000.0 + z * (1.0 / 355687428096000.0);
  s = 1.0 / 6227020800.0 + z * s;
  s = -1.0 / 39916800.0 + z * s;
  s = 1.0 / 362880.0 + z * s;
  s = -1.0 / 5040.0 + z * s;
  s = 1.0 / 120.0 + z * s;
  s = -1.0 / 6.0 + z * s;
  sine = x + (x * z * s + r.low * (1.0 - 0.5 * z));
}
template <typename T>
[[gnu::always_inline]] inline void cosine_of(const Pair<T>& r, T& cosine) {
  const T x = r.high, z = x * x;
  T c = 1.0 / 20922789888000.0 - z * (1.0 / 6402373705728000.0);
  c = -1.0 / 87178291200.0 + z * c;
  c = 1.0 / 479001600.0 + z * c;
  c = -1.0 / 3628800.0 + z * c;
  c = 1.0 / 40320.0 + z * c;
  c = -1.0 / 720.0 + z * c;
  c = 1.0 / 24.0 + z * c;
  const T half = 0.5 * z, most = 1.0 - half;
  cosine = most + (((1.0 - most) - half) + (z * z * c - x * r.low));
}

// log 2 in two parts; the first has 33 bits.
constexpr double kLog2 = 0x1.62e42feep-1, kLog2Low = 0x1.a39ef35793c76p-33;
constexpr double kRootHalf = 0.70710678118654752;

// log(m 2^k) as a pair, for m from the root of 1/2 to that of 2.
template <typename T>
[[gnu::always_inline]] inline Pair<T> log_of(const T& m, const T& k) {
  // log m = 2 atanh(s), s = f / (2 + f), with f = m - 1 exact.
  const T f = m - 1.0, below = 2.0 + f;
  const T s = f / below;
  // The remainder of the division, f - s (2 + f), in which 2 + f is itself rounded.
  const Pair<T> back = product(s, below);
  const T rest = (((f - back.high) - back.low) - s * (f - (below - 2.0))) / below;
  const T z = s * s;
  T t = 2.0 / 21 + z * (2.0 / 23);
  for (const double term :
       {2.0 / 19, 2.0 / 17, 2.0 / 15, 2.0 / 13, 2.0 / 11, 2.0 / 9, 2.0 / 7, 2.0 / 5, 2.0 / 3})
    t = term + z * t;
  const Pair<T> a = sum<T>(k * kLog2, 2.0 * s);
  return quick_sum<T>(a.high, a.low + (s * z * t + (2.0 * rest + k * kLog2Low)));
}

}  // namespace ayumi::elementary::parts
