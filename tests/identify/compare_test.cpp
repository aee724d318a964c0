// A recording made from a run by known changes: compare finds these changes and nothing else.

#include "ayumi/identify/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/identify/exchanged_joints.hpp"
#include "ayumi/io/table/recording.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/hoap1_walk.hpp"

namespace ayumi::test {
namespace {

using Eigen::Index;

constexpr double kDegree = M_PI / 180;

const SimulationLog& walk_log() {
  static const SimulationLog log = [] {
    SimulateOptions options;
    options.controller.type = ControllerKind::none;
    return simulate(hoap1(), hoap1_walk(), options);
  }();
  return log;
}

Index rows_of(const SimulationLog& log) { return static_cast<Index>(log.samples.size()); }

/// The angles of the run from its row `first` on, each delayed by `late` rows.
AngleTable angles_from(Index first, Index late = 0) {
  const SimulationLog& log = walk_log();
  AngleTable table;
  table.dt = log.dt;
  table.theta.resize(rows_of(log) - first, hoap1().dof_count());
  for (Index k = 0; k < table.theta.rows(); ++k)
    table.theta.row(k) = log.samples[static_cast<size_t>(std::max<Index>(0, first + k - late))]
                             .state.theta.transpose();
  table.has.assign(static_cast<size_t>(hoap1().dof_count()), 1);
  table.resolution = Eigen::VectorXd::Zero(hoap1().dof_count());
  return table;
}

/// The loads of the feet from row `first` on, each delayed by `late` rows.
SensorTable loads_from(Index first, Index late) {
  const SimulationLog& log = walk_log();
  SensorTable table;
  table.dt = log.dt;
  table.foot_load.resize(rows_of(log) - first, 2);
  for (Index k = 0; k < table.foot_load.rows(); ++k)
    for (const size_t foot : {0u, 1u})
      table.foot_load(k, static_cast<Index>(foot)) =
          log.samples[static_cast<size_t>(std::max<Index>(0, first + k - late))]
              .foot_force[foot]
              .z();
  return table;
}

Comparison compared(const AngleTable& measured, const SensorTable& sensors = {},
                    const CompareOptions& options = {}) {
  return compare(hoap1(), walk_log(), measured, sensors, options, "m.csv");
}

bool notes_hold(const Comparison& found, const std::string& words) {
  for (const std::string& note : found.notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

std::string all_notes(const Comparison& found) {
  std::string all;
  for (const std::string& note : found.notes) all += note + "\n";
  return all;
}

TEST(Compare, FindsWhenTheRecordingBegan) {
  const Comparison found = compared(angles_from(730));
  EXPECT_NEAR(found.shift, 0.730, 2e-4);
  EXPECT_NEAR(found.begin, 0.730, 2e-3);
  EXPECT_LT(found.largest_joint(), 0.01 * kDegree);
  EXPECT_TRUE(found.notes.empty()) << all_notes(found);
}

TEST(Compare, NamesSizeTimeAndLagOfADifference) {
  AngleTable measured = angles_from(0, 6);
  const int knee = hoap1().find_dof("l_knee"), elbow = hoap1().find_dof("r_elbow");
  measured.theta(3000, knee) += 2 * kDegree;
  measured.theta.col(elbow).array() += 0.5 * kDegree;
  const Comparison found = compared(measured, {}, {.shift = 0});
  ASSERT_EQ(found.joints.size(), static_cast<size_t>(hoap1().dof_count()));
  const ComparedCurve& bent = found.joints[static_cast<size_t>(knee)];
  EXPECT_EQ(bent.name, "l_knee");
  EXPECT_NEAR(bent.lag, 0.006, 5e-4);
  EXPECT_NEAR(bent.largest_at, 3.0, 1e-9);
  EXPECT_NEAR(bent.largest, 2 * kDegree, 1 * kDegree);
  EXPECT_NEAR(found.joints[static_cast<size_t>(elbow)].mean, 0.5 * kDegree, 0.01 * kDegree);
}

// In an earlier version, the lag was right only for curves of the same amplitude: 100 ms at twice
// the amplitude became 142 ms, and at five times 0 ms.
TEST(Compare, TheLagDoesNotDependOnTheAmplitude) {
  for (const double amplitude : {0.5, 1.0, 3.0})
    for (const Index late : {20, 100, 200}) {
      SensorTable loads = loads_from(0, late);
      loads.foot_load *= amplitude;
      const Comparison found = compared(angles_from(0), loads, {.shift = 0});
      for (const size_t foot : {0u, 1u})
        EXPECT_NEAR(found.loads[foot].lag, 1e-3 * static_cast<double>(late), 1e-3)
            << found.loads[foot].name << " times " << amplitude;
    }
}

TEST(Compare, LandingsAndLoadsOfTheFeetComeLate) {
  const Comparison found = compared(angles_from(0), loads_from(0, 9), {.shift = 0});
  ASSERT_EQ(found.loads.size(), 3u);
  EXPECT_EQ(found.loads[2].name, "left share");
  EXPECT_GT(found.loads[2].correlation, 0.9);
  EXPECT_LT(found.loads[2].correlation, 0.9999);
  ASSERT_GE(found.landings.size(), 8u);
  EXPECT_TRUE(found.lone_landings.empty());
  for (const ComparedLanding& landing : found.landings)
    EXPECT_NEAR(landing.measured - landing.simulated, 0.009, 0.0011);
  const Comparison same = compared(angles_from(0), loads_from(0, 0), {.shift = 0});
  EXPECT_NEAR(same.loads[2].correlation, 1, 1e-9);
}

// The loads have a time column of the clock that timed the angles: the times count, and not the
// numbers of the rows.
TEST(Compare, LoadsAreComparedAtTheirOwnTimes) {
  AngleTable angles = angles_from(0);
  SensorTable loads = loads_from(0, 0);
  angles.timed = loads.timed = true;
  angles.clock_start = 100;
  loads.clock_start = 100.020;
  const Comparison late = compared(angles, loads);
  EXPECT_NEAR(late.begin, 0.020, 2e-3);
  for (const ComparedCurve& load : late.loads) EXPECT_NEAR(load.lag, 0.020, 5e-4) << load.name;
  ASSERT_GE(late.landings.size(), 8u);
  for (const ComparedLanding& landing : late.landings)
    EXPECT_NEAR(landing.measured - landing.simulated, 0.020, 0.0011);
  // Clocks that have no time in common say nothing.
  loads.clock_start = 0;
  const Comparison apart = compared(angles, loads);
  for (const ComparedCurve& load : apart.loads) EXPECT_NEAR(load.lag, 0, 5e-4) << load.name;
}

// Two files of sensors that have other rates are read at the times of the first one.
TEST(Compare, FilesOfSensorsAreBroughtToOneClock) {
  SensorTable loads, turns, all;
  loads.dt = 0.001;
  loads.foot_load = Eigen::MatrixXd::Constant(1001, 2, 20);
  loads.clock_start = 5;
  turns.dt = 0.01;
  turns.gyro.resize(101, 3);
  for (Index k = 0; k < 101; ++k) turns.gyro.row(k).setConstant(5.1 + 0.01 * double(k));
  turns.clock_start = 5.1;
  add_sensors(loads, all, "loads.csv");
  add_sensors(turns, all, "gyro.csv");
  ASSERT_EQ(all.gyro.rows(), 1001);
  EXPECT_NEAR(all.gyro(50, 0), 5.1, 1e-12);
  EXPECT_NEAR(all.gyro(505, 1), 5.505, 1e-12);
  EXPECT_NEAR(all.foot_load(505, 1), 20, 1e-12);
  EXPECT_EQ(error_message([&] { add_sensors(turns, all, "b.csv"); }, ErrorCode::usage),
            "b.csv: another file already holds angular velocities; give only one such file");
}

// Load cells of a real robot do not read 0 in the air. What they read there is subtracted, so that
// the load, its share and the landings are those of the ground.
TEST(Compare, WhatLoadCellsReadInTheAirIsSubtracted) {
  SensorTable sensors = loads_from(0, 0);
  const Comparison exact = compared(angles_from(0), sensors, {.shift = 0});
  EXPECT_FALSE(notes_hold(exact, "load cells")) << all_notes(exact);
  sensors.foot_load.col(0).array() -= 6;
  sensors.foot_load.col(1).array() += 5;
  const Comparison found = compared(angles_from(0), sensors, {.shift = 0});
  EXPECT_TRUE(notes_hold(found, "the load cells of the left foot read -6 N while the foot is in"))
      << all_notes(found);
  EXPECT_TRUE(notes_hold(found, "the load cells of the right foot read 5 N")) << all_notes(found);
  for (const size_t i : {0u, 1u}) EXPECT_NEAR(found.loads[i].mean, exact.loads[i].mean, 1e-6);
  EXPECT_NEAR(found.loads[2].correlation, 1, 1e-6);
  ASSERT_EQ(found.landings.size(), exact.landings.size());
  for (size_t i = 0; i < exact.landings.size(); ++i)
    EXPECT_NEAR(found.landings[i].measured, exact.landings[i].measured, 1e-9);
  // Cells that read more than a fifth of the load in the air carry the robot there.
  sensors.foot_load.col(0).array() += 60;
  EXPECT_FALSE(
      notes_hold(compared(angles_from(0), sensors, {.shift = 0}), "of the left foot read"));
}

TEST(Compare, TheImuOfARobotThatStandsFeelsItsWeight) {
  SensorTable sensors;
  sensors.dt = walk_log().dt;
  sensors.acceleration = Eigen::MatrixXd::Zero(rows_of(walk_log()), 3);
  sensors.acceleration.col(2).setConstant(9.80665);
  sensors.gyro = Eigen::MatrixXd::Zero(rows_of(walk_log()), 3);
  const Comparison found =
      compared(angles_from(0), sensors, {.shift = 0, .begin = 0.1, .end = 0.6});
  ASSERT_EQ(found.imu.size(), 6u);
  EXPECT_EQ(found.imu[2].name, "acc.z");
  EXPECT_LT(found.imu[2].mean, 0.05);  // it stands upright in this time
  EXPECT_LT(found.imu[3].mean, 0.01);
}

TEST(Compare, SaysInOneLineWhatIsNotAsItShouldBe) {
  const int knee = hoap1().find_dof("l_knee");
  AngleTable turned = angles_from(0);
  turned.theta.col(knee) *= -1;
  EXPECT_TRUE(notes_hold(compared(turned, {}, {.shift = 0}), "l_knee"));
  AngleTable degrees = angles_from(0);
  degrees.theta.col(knee) /= kDegree;
  EXPECT_TRUE(notes_hold(compared(degrees, {}, {.shift = 0}), "l_knee"));
  AngleTable without = angles_from(0);
  without.has[static_cast<size_t>(knee)] = 0;
  const Comparison found = compared(without, {}, {.shift = 0});
  EXPECT_TRUE(notes_hold(found, "l_knee"));
  EXPECT_EQ(found.joints.size(), static_cast<size_t>(hoap1().dof_count()) - 1);
  AngleTable slow = angles_from(0);
  slow.dt = 0.002;
  Eigen::MatrixXd every_other((slow.theta.rows() + 1) / 2, slow.theta.cols());
  for (Index k = 0; k < every_other.rows(); ++k) every_other.row(k) = slow.theta.row(2 * k);
  slow.theta = every_other;
  const Comparison at_half = compared(slow, {}, {.shift = 0});
  EXPECT_TRUE(notes_hold(at_half, "500 rows per second")) << all_notes(at_half);
  EXPECT_LT(at_half.largest_joint(), 0.05 * kDegree);
}

TEST(Compare, SaysInOneLineWhatIsWrongWithTheLoads) {
  const auto notes_with = [&](const auto& change) {
    SensorTable loads = loads_from(0, 0);
    change(loads.foot_load);
    return compared(angles_from(0), loads, {.shift = 0}).notes;
  };
  const auto expect_line = [](const std::vector<std::string>& notes, const std::string& words) {
    ASSERT_EQ(notes.size(), 1u) << words;
    EXPECT_NE(notes[0].find(words), std::string::npos) << notes[0];
  };
  EXPECT_TRUE(notes_with([](Eigen::MatrixXd& load) { load *= 0.6; }).empty());
  expect_line(notes_with([](Eigen::MatrixXd& load) { load /= 9.80665; }), "much smaller");
  expect_line(notes_with([](Eigen::MatrixXd& load) { load *= 101.97; }), "much larger");
  expect_line(notes_with([](Eigen::MatrixXd& load) { load *= -1; }), "are negative");
  expect_line(notes_with([](Eigen::MatrixXd& load) { load.col(0).swap(load.col(1)); }),
              "exchange the readings");
}

// While a robot stands, noise and its posture decide how the load is shared.
TEST(Compare, FeetOfARobotThatStandsAreNotExchanged) {
  SensorTable loads = loads_from(0, 0);
  loads.foot_load.col(0).swap(loads.foot_load.col(1));
  const Comparison standing = compared(angles_from(0), loads, {.shift = 0, .begin = 0, .end = 0.3});
  EXPECT_LT(standing.loads[2].correlation, -0.5);
  EXPECT_TRUE(standing.notes.empty()) << all_notes(standing);
}

TEST(Compare, SaysInOneLineWhatIsWrongWithTheImu) {
  // The trunk of this robot turns by half a radian and back.
  SimulationLog log = walk_log();
  const Index rows = rows_of(log);
  SensorTable right;
  right.dt = log.dt;
  right.acceleration = Eigen::MatrixXd::Zero(rows, 3);
  right.gyro = Eigen::MatrixXd::Zero(rows, 3);
  for (Index k = 0; k < rows; ++k) {
    SimulationSample& s = log.samples[static_cast<size_t>(k)];
    const double t = log.dt * static_cast<double>(k), rate = std::cos(2 * t);
    s.state.base.attitude =
        Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::sin(2 * t), Eigen::Vector3d::UnitZ()));
    s.state.base_velocity.setZero();
    s.state.base_angular_velocity = {0, 0, rate};
    s.state.dtheta.setZero();
    right.gyro(k, 2) = rate;
    right.acceleration(k, 2) = 9.80665;
  }
  const auto notes_of = [&](const SensorTable& sensors) {
    return compare(hoap1(), log, angles_from(0), sensors, {.shift = 0}, "m.csv").notes;
  };
  const auto expect_line = [](const std::vector<std::string>& notes, const std::string& words) {
    ASSERT_EQ(notes.size(), 1u) << words;
    EXPECT_NE(notes[0].find(words), std::string::npos) << notes[0];
  };
  EXPECT_TRUE(notes_of(right).empty());
  SensorTable wrong = right;
  wrong.acceleration /= 9.80665;
  expect_line(notes_of(wrong), "acceleration is much smaller");
  wrong = right;
  wrong.acceleration *= -1;
  expect_line(notes_of(wrong), "acceleration points down");
  wrong = right;
  wrong.gyro /= kDegree;
  expect_line(notes_of(wrong), "angular velocity is much larger");
  wrong = right;
  wrong.gyro *= -1;
  expect_line(notes_of(wrong), "gyro.z");
}

TEST(Compare, ARecordingOfAnotherTimeIsRefused) {
  try {
    compared(angles_from(0), {}, {.shift = 100});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_file);
    EXPECT_NE(std::string(error.what()).find("The time that can be compared is 0.000 s"),
              std::string::npos)
        << error.what();
  }
}

TEST(Compare, TheGhostMovesAsMeasured) {
  AngleTable measured = angles_from(1000);
  const int knee = hoap1().find_dof("l_knee");
  measured.theta.col(knee).array() += 0.1;
  const SimulationLog ghost = measured_log(walk_log(), measured, 1.0);
  EXPECT_EQ(ghost.samples[500].state.theta, walk_log().samples[500].state.theta);
  EXPECT_NEAR(ghost.samples[2000].state.theta[knee],
              walk_log().samples[2000].state.theta[knee] + 0.1, 1e-12);
}

// A joint stands beyond what its encoder reads by the zero offset of this robot unit. Recordings
// are readings, unless instruments at the joints measured them.
TEST(Compare, ReadingsOfEncodersBecomeAnglesOfJoints) {
  RobotDescription unit = hoap1().description();
  unit.servos["l_elbow"].offset = 0.02;
  const RobotModel model(unit);
  const std::string text = "t[s],l_elbow[rad],r_elbow[rad]\n0,-0.5,-0.4\n0.001,-0.5,-0.4\n";
  const AngleTable read = read_angles(text, "m.csv", model);
  EXPECT_NEAR(read.theta(1, model.find_dof("l_elbow")), -0.48, 1e-15);
  EXPECT_EQ(read.theta(1, model.find_dof("r_elbow")), -0.4);
  const AngleTable at_joints =
      read_angles(text, "m.csv", model, {.measured_at = MeasuredAt::joint});
  EXPECT_EQ(at_joints.theta(1, model.find_dof("l_elbow")), -0.5);
}

/// The walk with the columns of these joints in each other's place: each column gets the angles of
/// the next joint in the list.
AngleTable exchanged(const std::vector<std::string>& joints) {
  AngleTable table = angles_from(0, 4);
  const Eigen::MatrixXd theta = table.theta;
  for (size_t i = 0; i < joints.size(); ++i)
    table.theta.col(hoap1().find_dof(joints[i])) =
        theta.col(hoap1().find_dof(joints[(i + 1) % joints.size()]));
  return table;
}

TEST(Compare, NamesJointsThatAreExchanged) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"l_elbow", "l_knee"}, "l_knee and l_elbow seem to be exchanged"},
      {{"r_knee", "l_knee"}, "r_knee and l_knee seem to be exchanged"},
      {{"r_hip_pitch", "r_ankle_pitch"}, "r_hip_pitch and r_ankle_pitch seem to be exchanged"},
      {{"r_hip_pitch", "r_knee", "r_ankle_pitch"},
       "r_hip_pitch, r_knee, r_ankle_pitch seem to be exchanged"}};
  for (const auto& [joints, words] : cases) {
    const Comparison found = compared(exchanged(joints), {}, {.shift = 0});
    ASSERT_EQ(found.notes.size(), 1u) << words << all_notes(found);
    EXPECT_NE(found.notes[0].find(words), std::string::npos) << found.notes[0];
    EXPECT_EQ(found.notes[0].find('\n'), std::string::npos);
  }
}

// The two hip rolls of a walk move nearly alike, and in a squat both legs do. Servos that are late,
// and offsets, do not make another command fit better.
TEST(Compare, JointsThatMoveAlikeAreNotCalledExchanged) {
  for (const Index late : {0, 4, 12, 25}) {
    AngleTable measured = angles_from(0, late);
    measured.theta.col(hoap1().find_dof("l_hip_roll")).array() += 0.02;
    EXPECT_TRUE(compared(measured, {}, {.shift = 0}).notes.empty()) << late;
  }
  const AngleTable walk = angles_from(0);
  AngleTable squat = walk;
  for (const char* joint : {"hip_pitch", "knee", "ankle_pitch", "hip_roll", "ankle_roll"})
    squat.theta.col(hoap1().find_dof(std::string("l_") + joint)) =
        walk.theta.col(hoap1().find_dof(std::string("r_") + joint));
  for (const Index late : {0, 10, 25}) {
    AngleTable measured = squat;
    for (Index k = 0; k < measured.theta.rows(); ++k)
      measured.theta.row(k) = squat.theta.row(std::max<Index>(0, k - late));
    measured.theta.col(hoap1().find_dof("l_knee")).array() += 0.01;
    EXPECT_TRUE(exchanged_joints(hoap1(), squat, measured, 0, 0.03, 0, squat.duration()).empty())
        << late;
  }
}

TEST(Compare, ALandingOfOnlyOneIsListedWithItsTime) {
  SensorTable sensors = loads_from(0, 0);
  const Comparison whole = compared(angles_from(0), sensors, {.shift = 0});
  ASSERT_GE(whole.landings.size(), 2u);
  // One swing stays on the ground: the recording lacks this landing.
  const ComparedLanding& lost = whole.landings[1];
  const auto k = static_cast<Index>(std::lround(lost.measured / sensors.dt));
  const Index foot = lost.foot == Side::left ? 0 : 1;
  for (Index i = std::max<Index>(0, k - 900); i < k + 50; ++i)
    sensors.foot_load(i, foot) = std::max(20.0, sensors.foot_load(i, foot));
  const Comparison found = compared(angles_from(0), sensors, {.shift = 0});
  ASSERT_EQ(found.lone_landings.size(), 1u);
  EXPECT_EQ(found.lone_landings[0].foot, lost.foot);
  EXPECT_FALSE(found.lone_landings[0].measured);
  EXPECT_NEAR(found.lone_landings[0].t, lost.simulated, 1e-9);
}

// A run that fell is compared until its fall, and the recording is not taken for that of another
// robot.
TEST(Compare, EndsWhereTheRunFell) {
  SimulationLog fallen = walk_log();
  fallen.result.outcome = Outcome::fell;
  fallen.result.fell_at = 3;
  for (size_t k = 3200; k < fallen.samples.size(); ++k)
    fallen.samples[k].state.theta.setConstant(1);
  const Comparison found = compare(hoap1(), fallen, angles_from(0), {}, {.shift = 0.0}, "m.csv");
  EXPECT_NEAR(found.end, 3, 1e-9);
  EXPECT_LT(found.largest_joint(), 1e-9);
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_NE(found.notes[0].find("the simulated robot fell at 3.000 s"), std::string::npos);
}

}  // namespace
}  // namespace ayumi::test
