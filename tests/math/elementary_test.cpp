#include "ayumi/math/elementary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ayumi/math/random.hpp"

namespace ayumi {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The distance of `value` from `exact` in units of the last place of a double.
double units_off(double value, long double exact) {
  const double nearest = static_cast<double>(exact);
  const double unit = std::max(std::abs(nearest - std::nextafter(nearest, 0.0)),
                               std::numeric_limits<double>::denorm_min());
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact) / unit);
}

struct Sampling {
  const char* name;
  double (*own)(double);
  long double (*exact)(long double);
  double from, to;
  double most;  ///< largest error, in units of the last place
};
std::ostream& operator<<(std::ostream& out, const Sampling& s) { return out << s.name; }

class Elementary : public testing::TestWithParam<Sampling> {};

// The results are compared with the C library's functions with more digits.
TEST_P(Elementary, IsRightToTheLastPlace) {
  const Sampling& s = GetParam();
  Random random(1);
  double worst = 0, at = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double x = s.from + (s.to - s.from) * random.uniform();
    const double off = units_off(s.own(x), s.exact(static_cast<long double>(x)));
    if (off > worst) worst = off, at = x;
  }
  EXPECT_LE(worst, s.most) << s.name << " at " << at;
}

using Long = long double;
INSTANTIATE_TEST_SUITE_P(
    Functions, Elementary,
    testing::Values(
        Sampling{"sin_small", elementary::sin, [](Long x) { return std::sin(x); }, -0.8, 0.8, 1},
        Sampling{"sin", elementary::sin, [](Long x) { return std::sin(x); }, -1e3, 1e3, 1},
        Sampling{"sin_far", elementary::sin, [](Long x) { return std::sin(x); }, -1e9, 1e9, 1},
        Sampling{"cos", elementary::cos, [](Long x) { return std::cos(x); }, -1e3, 1e3, 1},
        Sampling{"cos_far", elementary::cos, [](Long x) { return std::cos(x); }, -1e9, 1e9, 1},
        Sampling{"tan", elementary::tan, [](Long x) { return std::tan(x); }, -1.5, 1.5, 3},
        Sampling{"exp", elementary::exp, [](Long x) { return std::exp(x); }, -5, 5, 1},
        Sampling{"exp_wide", elementary::exp, [](Long x) { return std::exp(x); }, -745, 709, 1},
        Sampling{"log_near_1", elementary::log, [](Long x) { return std::log(x); }, 0.5, 2, 1},
        Sampling{"log", elementary::log, [](Long x) { return std::log(x); }, 0, 1e6, 1},
        Sampling{"log10", elementary::log10, [](Long x) { return std::log10(x); }, 0, 1e6, 2},
        Sampling{"log1p", elementary::log1p, [](Long x) { return std::log1p(x); }, -0.9, 1, 2},
        Sampling{"log1p_small", elementary::log1p, [](Long x) { return std::log1p(x); }, -1e-9,
                 1e-9, 2},
        Sampling{"asin", elementary::asin, [](Long x) { return std::asin(x); }, -1, 1, 2},
        Sampling{"acos", elementary::acos, [](Long x) { return std::acos(x); }, -1, 1, 2}),
    [](const auto& info) { return info.param.name; });

TEST(ElementaryPairs, AtanAndHypot) {
  Random random(2);
  double atan = 0, hypot = 0;
  for (int i = 0; i < 200'000; ++i) {
    const double scale = std::ldexp(1.0, static_cast<int>(40 * random.uniform()) - 20);
    const double y = random.normal() * scale, x = random.normal();
    atan = std::max(atan, units_off(elementary::atan2(y, x), std::atan2(Long(y), Long(x))));
    hypot = std::max(hypot, units_off(elementary::hypot(y, x), std::hypot(Long(y), Long(x))));
  }
  EXPECT_LE(atan, 1);
  EXPECT_LE(hypot, 2);
}

TEST(ElementaryPairs, Power) {
  Random random(3);
  double worst = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double x = 10 * random.uniform() + 1e-3, y = 60 * random.uniform() - 30;
    worst = std::max(worst, units_off(elementary::power(x, y), std::pow(Long(x), Long(y))));
  }
  EXPECT_LE(worst, 2);
  EXPECT_EQ(elementary::power<3>(0.5), 0.125);
  EXPECT_EQ(elementary::power<0>(7.0), 1);
}

TEST(ElementaryPairs, Corners) {
  using namespace elementary;
  for (const double y : {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, 1e-310, 1e308})
    for (const double x : {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, 1e-310, 1e308}) {
      EXPECT_EQ(elementary::atan2(y, x), std::atan2(y, x)) << y << " " << x;
      EXPECT_EQ(std::signbit(elementary::atan2(y, x)), std::signbit(std::atan2(y, x)));
      EXPECT_DOUBLE_EQ(elementary::hypot(y, x), std::hypot(y, x)) << y << " " << x;
    }
  EXPECT_EQ(elementary::exp(0.0), 1);
  EXPECT_EQ(elementary::exp(800.0), kInfinity);
  EXPECT_EQ(elementary::exp(-800.0), 0);
  EXPECT_EQ(elementary::log(1.0), 0);
  EXPECT_EQ(elementary::log(0.0), -kInfinity);
  EXPECT_EQ(elementary::log(5e-324), std::log(5e-324));
  EXPECT_TRUE(std::isnan(elementary::log(-1.0)));
  EXPECT_TRUE(std::isnan(elementary::sin(kInfinity)));
  EXPECT_TRUE(std::isnan(elementary::acos(2.0)));
  EXPECT_EQ(elementary::cos(0.0), 1);
  EXPECT_TRUE(std::signbit(elementary::sin(-0.0)));
  EXPECT_EQ(elementary::power(0, 2), 0);
  EXPECT_EQ(elementary::power(0, -2), kInfinity);
  EXPECT_EQ(elementary::power(0, 0), 1);
  for (const double x : {1e10, 1e15, 1e300}) EXPECT_LE(std::abs(elementary::sin(x)), 1);
}

TEST(ElementaryPairs, RotationsAreThoseOfEigen) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d axis =
        Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    const double angle = 8 * random.uniform() - 4, share = random.uniform();
    const Eigen::Quaterniond a(Eigen::AngleAxisd(angle, axis)),
        b = elementary::turn_quaternion(3 * share, axis.cross(a * axis).normalized()) * a;
    EXPECT_LE((elementary::turn_matrix(angle, axis) - a.toRotationMatrix()).norm(), 4e-15);
    EXPECT_LE(
        (elementary::turn_in_plane(angle) - Eigen::Rotation2Dd(angle).toRotationMatrix()).norm(),
        4e-15);
    EXPECT_LE((elementary::turn_quaternion(angle, axis).coeffs() - a.coeffs()).norm(), 1e-15);
    EXPECT_LE((elementary::between(a, b, share).coeffs() - a.slerp(share, b).coeffs()).norm(),
              1e-14);
    EXPECT_NEAR(elementary::angle_between(a, b), a.angularDistance(b), 1e-14);
  }
}

}  // namespace
}  // namespace ayumi
