// Texts for people use the unit of the pattern's angles, for angles and for their rates.

#include <gtest/gtest.h>

#include "ayumi/check/actuator_need.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/limits/table_safety.hpp"
#include "tests/support/planted.hpp"

namespace ayumi::test {
namespace {

using namespace planted;

// A walk in which one joint turns by an angle much faster than its motor can.
CommandSeries too_fast(double angle) {
  CommandSeries series = sample(hoap1(), walk());
  const int dof = hoap1().find_dof("l_elbow");
  const double rise = angle / 30;  // time at 30 rad/s [s]
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const double t = static_cast<double>(k) * series.dt;
    CommandSample& s = series.samples[k];
    s.state.theta[dof] += angle * std::min(1.0, t / rise);
    if (t < rise) s.state.dtheta[dof] += angle / rise;
  }
  return series;
}

std::string words_of(const ConsistencyReport& report) {
  std::string words;
  for (const Finding& f : report.findings) words += amount_text(f) + "; " + f.hint + "\n";
  return words;
}

TEST(UnitsInWords, AreThoseOfThePattern) {
  const CommandSeries series = too_fast(3);  // this is also beyond its range
  CheckOptions options;
  const ConsistencyReport in_degrees = check_consistency(hoap1(), series, options);
  options.degrees = false;
  const ConsistencyReport in_radians = check_consistency(hoap1(), series, options);
  ASSERT_EQ(in_degrees.findings.size(), in_radians.findings.size());

  const std::string degrees = words_of(in_degrees), radians = words_of(in_radians);
  EXPECT_EQ(degrees.find("rad"), std::string::npos) << degrees;
  EXPECT_NE(degrees.find("deg/s, limit 272.7 deg/s"), std::string::npos) << degrees;
  EXPECT_NE(degrees.find("move l_elbow back by "), std::string::npos) << degrees;
  EXPECT_EQ(radians.find("deg"), std::string::npos) << radians;
  EXPECT_NE(radians.find("rad/s, limit 4.76 rad/s"), std::string::npos) << radians;

  const CommandSeries within = too_fast(0.3);
  const auto need = [&](bool degrees) {
    options.degrees = degrees;
    return actuator_need(hoap1(), within, options, check_consistency(hoap1(), within, options))
        .text;
  };
  EXPECT_NE(need(true).find(" deg/s at l_elbow"), std::string::npos) << need(true);
  EXPECT_NE(need(false).find(" rad/s at l_elbow"), std::string::npos) << need(false);
}

// A large number has three digits and no exponent, unless the limit then reads the same.
TEST(UnitsInWords, LargeNumbersHaveNoExponent) {
  Finding finding;
  finding.kind = FindingKind::joint_acceleration;
  finding.unit = "rad/s^2";
  finding.in_degrees = true;
  finding.worst = 1993.4;
  finding.limit = 500;
  EXPECT_EQ(amount_text(finding), "114000 deg/s^2, limit 28600 deg/s^2");
  finding.worst = 500.01;
  EXPECT_EQ(amount_text(finding), "28648.5 deg/s^2, limit 28647.9 deg/s^2");
}

TEST(UnitsInWords, OfARefusedTableToo) {
  SafetyViolation violation;
  violation.joint = "l_elbow";
  violation.kind = TableLimit::end_speed;
  violation.unit = "rad/s";
  violation.value = 5;
  violation.limit = 4.76;
  EXPECT_NE(text_of(violation).find("speed at the end 286.479 deg/s, limit 272.728 deg/s"),
            std::string::npos)
      << text_of(violation);
  EXPECT_NE(text_of(violation, false).find("speed at the end 5 rad/s, limit 4.76 rad/s"),
            std::string::npos)
      << text_of(violation, false);
}

// Values of results and JSON do not depend on that unit.
TEST(UnitsInWords, ValuesStayInSiUnits) {
  const CommandSeries series = too_fast(3);
  CheckOptions options;
  const ConsistencyReport in_degrees = check_consistency(hoap1(), series, options);
  options.degrees = false;
  const ConsistencyReport in_radians = check_consistency(hoap1(), series, options);
  for (size_t i = 0; i < in_degrees.findings.size(); ++i) {
    EXPECT_EQ(in_degrees.findings[i].unit, in_radians.findings[i].unit);
    EXPECT_EQ(in_degrees.findings[i].worst, in_radians.findings[i].worst);
  }
}

}  // namespace
}  // namespace ayumi::test
