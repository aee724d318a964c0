// Load cells with dead zone, hysteresis, gain, saturation and a running mean, and sensors of
// different ages, compared with closed forms.

#include "ayumi/sim/load_cell.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/sim/sensors.hpp"
#include "tests/support/biped.hpp"

namespace ayumi {
namespace {

constexpr double kReading = 1e-3;

TEST(LoadCell, IsExactWithoutStatedErrors) {
  LoadCell cell({}, 1);
  for (const double f : {0.0, 3.7, 120.25, 0.1, 64.0}) {
    EXPECT_EQ(cell.felt(f), f);
    EXPECT_EQ(cell.reported(f), f);
  }
}

TEST(LoadCell, FeelsWhatExceedsItsDeadZoneTimesItsGain) {
  LoadCell cell({.dead_zone = 1.5, .gain = 1.2}, 1);
  EXPECT_EQ(cell.felt(0), 0);
  EXPECT_EQ(cell.felt(1.5), 0);
  EXPECT_NEAR(cell.felt(11.5), 12, 1e-12);
  EXPECT_EQ(cell.felt(1), 0);
}

// A cycle between 0 and A encloses h (A - h); the branches are x - h/2 and x + h/2.
TEST(LoadCell, HysteresisLosesTheAreaOfItsLoop) {
  const double h = 2, most = 50, step = 1e-3;
  LoadCell cell({.hysteresis = h}, 1);
  const int count = static_cast<int>(std::lround(most / step));
  double area = 0, last = 0;
  const auto visit = [&](int i, bool counts) {
    const double x = i * step, y = cell.felt(x);
    if (counts) area += x * (y - last);  // the integral of x dy around the loop is its area
    last = y;
    return y;
  };
  for (int i = 0; i <= count; ++i) visit(i, false);
  for (int i = count; i >= 0; --i) visit(i, false);
  EXPECT_NEAR(last, h / 2, 1e-9);  // this remains without load
  for (int i = 0; i <= count; ++i) {
    const double y = visit(i, true);
    if (i * step > h) {
      ASSERT_NEAR(y, i * step - h / 2, 1e-9);
    }
  }
  for (int i = count; i >= 0; --i) {
    const double y = visit(i, true);
    if (i * step < most - h) {
      ASSERT_NEAR(y, i * step + h / 2, 1e-9);
    }
  }
  EXPECT_NEAR(area, h * (most - h), most * step);
}

// Where the load turns back, it must change by the whole hysteresis before the reading changes.
TEST(LoadCell, ChangesWithinTheHysteresisHaveNoEffect) {
  LoadCell cell({.hysteresis = 2}, 1);
  const double first = cell.felt(30);
  for (const double f : {28.1, 29.8, 29.0, 30.0, 28.5}) EXPECT_EQ(cell.felt(f), first);
  EXPECT_NEAR(cell.felt(27.5), first - 0.5, 1e-12);
  EXPECT_NEAR(cell.felt(31.0), first + 1.0, 1e-12);
}

TEST(LoadCell, SaturatesBeforeItsMean) {
  LoadCell cell({.saturation = 80}, 2);
  EXPECT_EQ(cell.reported(40), 40);
  EXPECT_EQ(cell.reported(1000), 60);
  EXPECT_EQ(cell.reported(1000), 80);
}

TEST(LoadCell, MeanOfEightFollowsARiseThreeAndAHalfTicksLate) {
  LoadCell cell({}, 8);
  EXPECT_EQ(cell.reported(0), 0);  // the mean of the only reading
  for (int k = 1; k < 100; ++k) {
    const double mean = cell.reported(2.0 * k);
    if (k >= 7) {
      ASSERT_NEAR(mean, 2.0 * (k - 3.5), 1e-12);
    }
  }
}

// The frequency response of a mean of N: |sin(N w/2) / (N sin(w/2))|.
TEST(LoadCell, MeanOfEightHasItsFrequencyResponse) {
  for (const double hertz : {5.0, 30.0, 60.0, 125.0}) {
    LoadCell cell({}, 8);
    const double w = 2 * M_PI * hertz * kReading;
    double sine = 0, cosine = 0;
    const int period =
        static_cast<int>(std::lround(1 / (hertz * kReading) * 6));  // six periods in whole ticks
    for (int k = 0; k < 20 + period; ++k) {
      const double mean = cell.reported(std::sin(w * k));
      if (k < 20) continue;
      sine += 2 * mean * std::sin(w * k) / period;
      cosine += 2 * mean * std::cos(w * k) / period;
    }
    EXPECT_NEAR(std::hypot(sine, cosine), std::abs(std::sin(4 * w) / (8 * std::sin(w / 2))), 1e-9)
        << hertz;
  }
}

/// The biped at rest with these sensors. Each of its eight cells carries the same force [N].
struct StandingRobot {
  explicit StandingRobot(const SensorDescription& s, std::uint64_t seed = 1)
      : model([&] {
          RobotDescription d = test::biped_description();
          d.sensors = s;
          return d;
        }()),
        sensors(model, model.limits(), kReading, true, seed),
        data(model),
        state(model.rest_state()) {
    update_velocities(model, state, data);
    for (const Side side : {Side::left, Side::right}) {
      std::vector<SoleForce>& soles = report.soles[static_cast<size_t>(side)];
      soles.resize(model.sole(side).polygon.size());
      up[static_cast<size_t>(side)] = sole_pose(model, data, side).linear().col(2);
    }
  }
  const Measurement& read(double force) {
    for (size_t side = 0; side < 2; ++side)
      for (SoleForce& cell : report.soles[side]) cell.force = force * up[side];
    return sensors.read(state, data, report);
  }
  RobotModel model;
  Sensors sensors;
  RobotData data;
  RobotState state;
  StepReport report;
  std::array<Eigen::Vector3d, 2> up;
};

TEST(LoadCells, StatedExactCellsChangeNoBit) {
  SensorDescription plain;
  plain.latency = 0.003;
  plain.force_noise = 1;
  plain.force_resolution = 0.1;
  SensorDescription stated = plain;
  stated.encoder_latency = stated.imu_latency = stated.force_latency = 0.003;
  stated.force_cells = {{"left", {{}}}, {"right", {{}, {}, {}, {}}}};
  StandingRobot a(plain), b(stated);
  for (int k = 0; k < 200; ++k) {
    const double force = 10 + 10 * std::sin(0.1 * k);
    const Measurement x = a.read(force), y = b.read(force);
    for (size_t side = 0; side < 2; ++side) {
      ASSERT_EQ(x.feet[side].fz, y.feet[side].fz) << k;
      ASSERT_EQ(x.feet[side].cop, y.feet[side].cop) << k;
    }
    ASSERT_EQ(x.theta, y.theta);
  }
}

// One of four equal cells reads 1 + e times its force: the centre of pressure moves by e/(4 + e) of
// the distance to its corner.
TEST(LoadCells, AGainOfOneCellMovesTheCentreOfPressure) {
  const double e = 0.2;
  SensorDescription s;
  s.force_cells["left"] = {{.gain = 1 + e}, {}, {}, {}};
  StandingRobot standing(s);
  const Measurement& m = standing.read(20);
  EXPECT_NEAR(m.feet[0].fz, 80 + 20 * e, 1e-9);
  EXPECT_NEAR(m.feet[1].fz, 80, 1e-9);
  const std::vector<Eigen::Vector2d>& corners = standing.model.sole(Side::left).polygon;
  const Eigen::Vector2d middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  EXPECT_LT((m.feet[0].cop - middle - e / (4 + e) * (corners[0] - middle)).norm(), 1e-12);
}

TEST(LoadCells, AMeanOfEightDividesTheNoiseByTheRootOfEight) {
  const auto deviation = [](int readings) {
    SensorDescription s;
    s.force_noise = 1;
    s.force_readings = readings;
    StandingRobot standing(s);
    double squares = 0;
    const int count = 8000;
    for (int k = 0; k < 8; ++k) standing.read(50);
    for (int k = 0; k < count; ++k) squares += std::pow(standing.read(50).feet[0].fz - 200, 2);
    return std::sqrt(squares / count);
  };
  EXPECT_NEAR(deviation(1), 2, 0.1);  // there are four cells
  EXPECT_NEAR(deviation(8), 2 / std::sqrt(8.0), 0.05);
}

TEST(LoadCells, EachKindOfSensorIsAsLateAsItsOwnLatency) {
  SensorDescription s;
  s.latency = 0.002;
  s.encoder_latency = 0.001;
  s.force_latency = 0.005;
  EXPECT_NEAR(s.oldest(kReading), 0.005, 1e-15);
  StandingRobot standing(s);
  for (int k = 0; k < 30; ++k) {
    standing.state.theta[0] = 0.01 * k;
    standing.state.base_angular_velocity = {0.1 * k, 0, 0};
    update_velocities(standing.model, standing.state, standing.data);
    const Measurement& m = standing.read(10 + k);
    EXPECT_NEAR(m.theta[0], 0.01 * std::max(k - 1, 0), 1e-12) << k;
    EXPECT_NEAR(m.gyro.norm(), 0.1 * std::max(k - 2, 0), 1e-12) << k;
    EXPECT_NEAR(m.feet[1].fz, 4.0 * (10 + std::max(k - 5, 0)), 1e-9) << k;
  }
  s.force_readings = 8;
  EXPECT_NEAR(s.oldest(kReading), 0.0085, 1e-15);
  s.set_latency(0.001);
  EXPECT_NEAR(s.oldest(kReading), 0.0045, 1e-15);
}

// A scenario's latency is added to each.
TEST(LoadCells, AddedLatencyCountsForEverySensor) {
  SensorDescription s;
  s.force_latency = 0.004;
  StandingRobot standing(s);
  standing.sensors.reach_back(0.003);
  SensorFault late;
  late.latency = 0.003;
  for (int k = 0; k < 30; ++k) {
    standing.state.theta[0] = 0.01 * k;
    update_velocities(standing.model, standing.state, standing.data);
    for (size_t side = 0; side < 2; ++side)
      for (SoleForce& cell : standing.report.soles[side]) cell.force = k * standing.up[side];
    const Measurement& m =
        standing.sensors.read(standing.state, standing.data, standing.report, late);
    EXPECT_NEAR(m.theta[0], 0.01 * std::max(k - 3, 0), 1e-12) << k;
    EXPECT_NEAR(m.feet[0].fz, 4.0 * std::max(k - 7, 0), 1e-9) << k;
  }
}

}  // namespace
}  // namespace ayumi
