#include "ayumi/math/elementary.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "ayumi/math/elementary_parts.hpp"

namespace ayumi::elementary {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
using parts::kLog2;
using parts::kLog2Low;
using parts::kRound;
using parts::product;
using parts::quick_sum;
using parts::sum;
using Pair = parts::Pair<double>;

parts::Reduced<double> reduced(double x) {
  constexpr double kLeast = 0.78, kMost = 1e9;
  // Below pi/4, where no multiple of pi/2 is subtracted.
  if (std::abs(x) < kLeast) return {{x, 0}, 0};
  // Angles this large have no meaning. They are reduced by the double nearest to 2 pi, exactly and
  // with the same result on every machine.
  if (std::abs(x) > kMost) x = std::fmod(x, 6.283185307179586);
  return parts::reduced(x);
}

// exp(r.high + r.low) on |r| <= log(2)/2.
double exp_of(const Pair& r) {
  const double x = r.high;
  double s = 1.0 / 6227020800.0 + x * (1.0 / 87178291200.0);
  for (const double inverse :
       {1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0,
        1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0})
    s = inverse + x * s;
  const double most = 0.5 * x * x + x * x * x * s;
  const Pair one = quick_sum(1.0, x);
  return one.high + (one.low + (most + r.low * (1 + x + most)));
}

double exp_of_pair(const Pair& x) {
  if (x.high > 709.79) return kInfinity;
  if (x.high < -745.2) return 0;
  const double k = x.high * 1.4426950408889634 + kRound - kRound;
  const Pair a = sum(x.high - k * kLog2, -k * kLog2Low);
  const auto exponent = static_cast<int>(k);
  // The factor is applied in two steps, so that it does not overflow if the result is finite.
  return std::ldexp(std::ldexp(exp_of({a.high, a.low + x.low}), exponent / 2),
                    exponent - exponent / 2);
}

// log x as a pair, for finite x > 0.
Pair log_pair(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // in [1/2, 1)
  if (m < parts::kRootHalf) {
    m *= 2;
    --exponent;
  }
  return parts::log_of(m, static_cast<double>(exponent));
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
  const parts::Reduced<double> r = reduced(x);
  double value = 0;
  r.quadrant % 2 ? parts::cosine_of(r.rest, value) : parts::sine_of(r.rest, value);
  return r.quadrant >= 2 ? -value : value;
}

double cos(double x) {
  if (!std::isfinite(x)) return kNan;
  const parts::Reduced<double> r = reduced(x);
  double value = 0;
  r.quadrant % 2 ? parts::sine_of(r.rest, value) : parts::cosine_of(r.rest, value);
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
  const Pair u = sum(1.0, x);
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
  // Moves the numbers into the middle of the range, where products neither overflow nor lose bits.
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

Eigen::Matrix2d turn_in_plane(double angle) {
  const double s = sin(angle), c = cos(angle);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
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
