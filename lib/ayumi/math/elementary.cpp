#include "ayumi/math/elementary.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace ayumi::elementary {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// Adding and subtracting it rounds to a whole number: 1.5 * 2^52, whose last bit is worth one.
constexpr double kRound = 6755399441055744.0;

// A number as the sum of two, the second far smaller.
struct Pair {
  double high = 0, low = 0;
};
Pair sum(double a, double b) {  // exact
  const double s = a + b, part = s - a;
  return {s, (a - (s - part)) + (b - part)};
}
Pair quick_sum(double a, double b) {  // exact where |a| >= |b|
  const double s = a + b;
  return {s, b - (s - a)};
}
Pair split(double a) {
  const double c = 134217729.0 * a;  // 2^27 + 1
  const double high = c - (c - a);
  return {high, a - high};
}
Pair product(double a, double b) {  // exact (Dekker)
  const double p = a * b;
  const Pair x = split(a), y = split(b);
  return {p, ((x.high * y.high - p) + x.high * y.low + x.low * y.high) + x.low * y.low};
}

// x - k pi/2 with |.| <= pi/4, and k mod 4.
struct Reduced {
  Pair rest;
  int quadrant = 0;
};
Reduced reduced(double x) {
  // pi/2 in three parts; the first two have 33 bits and so multiply k to 2^20 exactly.
  constexpr double kFirst = 0x1.921fb544p0, kSecond = 0x1.0b4611a6p-34,
                   kThird = 0x1.3198a2e037073p-69;
  constexpr double kMost = 1e9;
  // Angles beyond any meaning: reduced by the double nearest to 2 pi, exactly and everywhere alike.
  if (std::abs(x) > kMost) x = std::fmod(x, 6.283185307179586);
  const double shifted = x * 0.63661977236758134308 + kRound;
  const double k = shifted - kRound;
  const Pair first = product(k, kFirst), second = product(k, kSecond);
  // k to 2^30: the products are exact as pairs.
  const Pair a = sum(x - first.high, -first.low);
  const Pair b = sum(a.high, -second.high);
  const double low = a.low + b.low - second.low - k * kThird;
  const auto whole = static_cast<std::int64_t>(k);
  return {quick_sum(b.high, low), static_cast<int>(whole & 3)};
}

// Taylor's series on |x| <= pi/4, with a small rest of the argument.
double sine_of(const Pair& r) {
  const double x = r.high, z = x * x;
  double s = -1.0 / 1307674368000.0 + z * (1.0 / 355687428096000.0);
  s = 1.0 / 6227020800.0 + z * s;
  s = -1.0 / 39916800.0 + z * s;
  s = 1.0 / 362880.0 + z * s;
  s = -1.0 / 5040.0 + z * s;
  s = 1.0 / 120.0 + z * s;
  s = -1.0 / 6.0 + z * s;
  return x + (x * z * s + r.low * (1 - 0.5 * z));
}
double cosine_of(const Pair& r) {
  const double x = r.high, z = x * x;
  double c = 1.0 / 20922789888000.0 - z * (1.0 / 6402373705728000.0);
  c = -1.0 / 87178291200.0 + z * c;
  c = 1.0 / 479001600.0 + z * c;
  c = -1.0 / 3628800.0 + z * c;
  c = 1.0 / 40320.0 + z * c;
  c = -1.0 / 720.0 + z * c;
  c = 1.0 / 24.0 + z * c;
  const double half = 0.5 * z, most = 1 - half;
  return most + (((1 - most) - half) + (z * z * c - x * r.low));
}

// log 2 in two parts; the first has 33 bits.
constexpr double kLog2 = 0x1.62e42feep-1, kLog2Low = 0x1.a39ef35793c76p-33;

// exp(r.high + r.low) on |r| <= log(2)/2.
double exp_of(const Pair& r) {
  const double x = r.high;
  double s = 1.0 / 6227020800.0 + x * (1.0 / 87178291200.0);
  for (const double inverse :
       {1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0,
        1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0})
    s = inverse + x * s;
  const double most = 0.5 * x * x + x * x * x * s;
  const Pair one = quick_sum(1, x);
  return one.high + (one.low + (most + r.low * (1 + x + most)));
}

double exp_of_pair(const Pair& x) {
  if (x.high > 709.79) return kInfinity;
  if (x.high < -745.2) return 0;
  const double k = x.high * 1.4426950408889634 + kRound - kRound;
  const Pair a = sum(x.high - k * kLog2, -k * kLog2Low);
  const auto exponent = static_cast<int>(k);
  // In two steps, so that the factor stays a number where the result is one.
  return std::ldexp(std::ldexp(exp_of({a.high, a.low + x.low}), exponent / 2),
                    exponent - exponent / 2);
}

// log x as a pair, for finite x > 0.
Pair log_pair(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // in [1/2, 1)
  if (m < 0.70710678118654752) {
    m *= 2;
    --exponent;
  }
  // log m = 2 atanh(s), s = f / (2 + f), with f = m - 1 exact.
  const double f = m - 1, below = 2 + f;
  const double s = f / below;
  // What the division left: f - s (2 + f), of which 2 + f is itself rounded.
  const Pair back = product(s, below);
  const double rest = (((f - back.high) - back.low) - s * (f - (below - 2))) / below;
  const double z = s * s;
  double t = 2.0 / 21 + z * (2.0 / 23);
  for (const double term :
       {2.0 / 19, 2.0 / 17, 2.0 / 15, 2.0 / 13, 2.0 / 11, 2.0 / 9, 2.0 / 7, 2.0 / 5, 2.0 / 3})
    t = term + z * t;
  const double k = exponent;
  const Pair a = sum(k * kLog2, 2 * s);
  return quick_sum(a.high, a.low + (s * z * t + (2 * rest + k * kLog2Low)));
}

// atan(k / 8) for k = 0 to 8.
constexpr std::array<Pair, 9> kArcs = {{{0, 0},
                                        {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                        {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                        {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                        {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                        {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                        {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                        {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                        {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}}};
constexpr Pair kPi = {0x1.921fb54442d18p1, 0x1.1a62633145c07p-53};
constexpr Pair kHalfPi = {0x1.921fb54442d18p0, 0x1.1a62633145c07p-54};

// atan(a / b) for 0 <= a <= b, b > 0, as a pair.
Pair arc(double a, double b) {
  const double q = a / b;
  const double nearest = 8 * q + kRound - kRound;
  const Pair& base = kArcs[static_cast<size_t>(nearest)];
  // tan of the rest: (a - c b) / (b + c a).
  const double c = nearest / 8;
  const Pair cb = product(c, b), ca = product(c, a);
  const double over = (a - cb.high) - cb.low;
  const Pair under = sum(b, ca.high);
  const double under_low = under.low + ca.low;
  const double t = over / under.high;
  const Pair back = product(t, under.high);
  const double rest = (((over - back.high) - back.low) - t * under_low) / under.high;
  const double z = t * t;
  double s = 1.0 / 17 - z * (1.0 / 19);
  for (const double term : {-1.0 / 15, 1.0 / 13, -1.0 / 11, 1.0 / 9, -1.0 / 7, 1.0 / 5, -1.0 / 3})
    s = term + z * s;
  const Pair all = sum(base.high, t);
  return quick_sum(all.high, all.low + (base.low + (t * z * s + rest)));
}

Pair minus(const Pair& a, const Pair& b) {
  const Pair s = sum(a.high, -b.high);
  return quick_sum(s.high, s.low + (a.low - b.low));
}

}  // namespace

double sin(double x) {
  if (!std::isfinite(x)) return kNan;
  if (std::abs(x) < 1e-8) return x;
  const Reduced r = reduced(x);
  const double value = r.quadrant % 2 ? cosine_of(r.rest) : sine_of(r.rest);
  return r.quadrant >= 2 ? -value : value;
}

double cos(double x) {
  if (!std::isfinite(x)) return kNan;
  const Reduced r = reduced(x);
  const double value = r.quadrant % 2 ? sine_of(r.rest) : cosine_of(r.rest);
  return r.quadrant == 1 || r.quadrant == 2 ? -value : value;
}

double tan(double x) { return sin(x) / cos(x); }

double exp(double x) { return std::isnan(x) ? x : exp_of_pair({x, 0}); }

double log(double x) {
  if (std::isnan(x) || x < 0) return kNan;
  if (x == 0) return -kInfinity;
  if (x == kInfinity) return x;
  const Pair y = log_pair(x);
  return y.high + y.low;
}

double log10(double x) {
  if (!(x > 0) || x == kInfinity) return log(x);
  const Pair y = log_pair(x);
  constexpr Pair kTenth = {0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57};  // 1 / log 10
  const Pair p = product(y.high, kTenth.high);
  return p.high + (p.low + (y.high * kTenth.low + y.low * kTenth.high));
}

double log1p(double x) {
  if (!(x > -1) || x == kInfinity) return log(1 + x);
  const Pair u = sum(1, x);
  return log(u.high) + u.low / u.high;
}

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return kNan;
  const double sign = std::copysign(1.0, y);
  if (y == 0) return std::signbit(x) ? sign * kPi.high : y;
  if (std::isinf(x) || std::isinf(y)) {
    if (std::isinf(x) && std::isinf(y)) return sign * (x > 0 ? 0.25 : 0.75) * kPi.high;
    if (std::isinf(y)) return sign * kHalfPi.high;
    return x > 0 ? std::copysign(0.0, y) : sign * kPi.high;
  }
  // Into the middle of the range, where products neither overflow nor lose bits.
  double a = std::abs(y), b = std::abs(x);
  const double most = std::max(a, b);
  if (most > 0x1p500) a *= 0x1p-600, b *= 0x1p-600;
  if (most < 0x1p-400) a *= 0x1p600, b *= 0x1p600;
  Pair angle = a <= b ? arc(a, b) : minus(kHalfPi, arc(b, a));
  if (std::signbit(x)) angle = minus(kPi, angle);
  return sign * (angle.high + angle.low);
}

double asin(double x) { return atan2(x, std::sqrt((1 - x) * (1 + x))); }
double acos(double x) { return atan2(std::sqrt((1 - x) * (1 + x)), x); }

double hypot(double x, double y) {
  const double most = std::max(std::abs(x), std::abs(y)),
               least = std::min(std::abs(x), std::abs(y));
  if (std::isinf(x) || std::isinf(y)) return kInfinity;
  if (most == 0 || std::isnan(x) || std::isnan(y)) return x + y == 0 ? 0 : most + least;
  if (most < 0x1p500 && least > 0x1p-500) return std::sqrt(most * most + least * least);
  const double share = least / most;
  return most * std::sqrt(1 + share * share);
}

double power(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (y == 1) return x >= 0 ? x : kNan;
  if (std::isnan(x) || std::isnan(y) || x < 0) return kNan;
  if (x == 0 || x == kInfinity) return (x == 0) == (y > 0) ? 0 : kInfinity;
  const Pair logarithm = log_pair(x), p = product(y, logarithm.high);
  if (!(std::abs(p.high) < 1e3)) return p.high > 0 ? kInfinity : 0;
  return exp_of_pair({p.high, p.low + y * logarithm.low});
}

Eigen::Matrix3d turn_matrix(double angle, const Eigen::Vector3d& axis) {
  const double s = sin(angle), c = cos(angle);
  const Eigen::Vector3d sines = s * axis, rest = (1 - c) * axis;
  Eigen::Matrix3d m;
  double t = rest.x() * axis.y();
  m(0, 1) = t - sines.z();
  m(1, 0) = t + sines.z();
  t = rest.x() * axis.z();
  m(0, 2) = t + sines.y();
  m(2, 0) = t - sines.y();
  t = rest.y() * axis.z();
  m(1, 2) = t - sines.x();
  m(2, 1) = t + sines.x();
  m.diagonal() = rest.cwiseProduct(axis).array() + c;
  return m;
}

Eigen::Quaterniond turn_quaternion(double angle, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d v = sin(0.5 * angle) * axis;
  return Eigen::Quaterniond(cos(0.5 * angle), v.x(), v.y(), v.z());
}

Eigen::Quaterniond between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, double share) {
  const double d = a.dot(b), cosine = std::abs(d);
  double from = 1 - share, to = share;
  if (cosine < 1 - std::numeric_limits<double>::epsilon()) {
    const double angle = acos(cosine), sine = sin(angle);
    from = sin((1 - share) * angle) / sine;
    to = sin(share * angle) / sine;
  }
  if (d < 0) to = -to;
  return Eigen::Quaterniond(from * a.coeffs() + to * b.coeffs());
}

double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Quaterniond d = a * b.conjugate();
  return 2 * atan2(d.vec().norm(), std::abs(d.w()));
}

}  // namespace ayumi::elementary
