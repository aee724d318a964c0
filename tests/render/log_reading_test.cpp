#include "ayumi/render/log_reading.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ayumi/base/error.hpp"
#include "ayumi/render/frames.hpp"
#include "ayumi/render/overlay.hpp"
#include "ayumi/render/robot_surface.hpp"
#include "tests/render/box_robot.hpp"

namespace ayumi {
namespace {

TEST(LogReading, SamplesAreInterpolatedAndHeld) {
  const RobotModel model = test::box_robot();
  const SimulationLog log = test::box_run(model);
  EXPECT_DOUBLE_EQ(duration(log), 1.0);
  EXPECT_NEAR(sample_at(log, 0.333).cog.x(), 0.0333, 1e-12) << "between two ticks of 2 ms";
  EXPECT_EQ(sample_at(log, 0.334).cog, log.samples[167].cog) << "at a tick, the tick itself";
  EXPECT_EQ(sample_at(log, -1).cog, log.samples.front().cog);
  EXPECT_EQ(sample_at(log, 9).cog, log.samples.back().cog);
  EXPECT_TRUE(sample_at(log, 0.599).planned_contact[1]) << "contacts of the tick before";
}

TEST(LogReading, APushIsFoundWithItsValue) {
  const RobotModel model = test::box_robot();
  SimulationLog log = test::box_run(model);
  ASSERT_EQ(pushes(log).size(), 1u);
  const PushRecord push = pushes(log)[0];
  EXPECT_NEAR(push.begin, 0.3, 1e-12);
  EXPECT_NEAR(push.end, 0.32, 1e-12);
  EXPECT_NEAR(push.impulse.y(), 0.4, 1e-12);
  EXPECT_EQ(push_text(push), "0.4 N s");
  for (int k = 400; k < 600 && k <= 500; ++k) log.samples[size_t(k)].push_force = {3, 0, 0};
  for (int k = 200; k < 400; ++k) log.samples[size_t(k)].push_force = {0, 0, 0};
  for (int k = 250; k < 380; ++k) log.samples[size_t(k)].push_force = {3, 4, 0};
  ASSERT_EQ(pushes(log).size(), 3u);
  EXPECT_EQ(push_text(pushes(log)[1]), "5 N") << "a long one by its force";
}

TEST(LogReading, ThePushOrTheFallIsWorthShowing) {
  SimulationLog log = test::box_run(test::box_robot());
  log.result.outcome = Outcome::fell;
  log.result.fell_at = 0.8;
  EXPECT_NEAR(telling_instant(log), 0.55, 1e-12);
  for (SimulationSample& sample : log.samples) sample.push_force.setZero();
  EXPECT_NEAR(telling_instant(log), 0.8, 1e-12);
  log.result.outcome = Outcome::stands;
  EXPECT_NEAR(telling_instant(log), 0.262, 1e-12) << "the neck's first end";
  const std::vector<double> times = telling_instants(log, 3);
  ASSERT_EQ(times.size(), 3u);
  EXPECT_EQ(times.front(), 0);
  EXPECT_EQ(times.back(), 1);
}

// A bow while the robot moves forward: at its end the robot stands in the same posture as at its
// start, but at another place.
TEST(LogReading, ThePostureFarthestFromTheStartIsWorthShowing) {
  SimulationLog log = test::box_run(test::box_robot());
  for (size_t k = 0; k < log.samples.size(); ++k) {
    SimulationSample& sample = log.samples[k];
    const double t = k * log.dt;
    sample.push_force.setZero();
    sample.cog.x() += t;
    sample.state.theta =
        Eigen::Vector2d(0.3, t < 0.2 || t > 0.4 ? 0 : std::min(0.25, t - 0.2) * -2.0);
  }
  EXPECT_NEAR(telling_instant(log), 0.4, 1e-12);
  for (SimulationSample& sample : log.samples)
    sample.state.theta[1] = std::max(-0.3, sample.state.theta[1]);
  EXPECT_NEAR(telling_instant(log), 0.35, 1e-12) << "held from here on";
  for (SimulationSample& sample : log.samples) sample.state.theta[1] *= 0.1;
  EXPECT_NEAR(telling_instant(log), 0.5, 1e-12) << "hardly moves";
}

TEST(LogReading, FlightsAreWorthShowing) {
  SimulationLog log = test::box_run(test::box_robot());
  for (SimulationSample& sample : log.samples) sample.push_force.setZero();
  for (size_t k = 0; k < log.samples.size(); ++k)
    if (const double t = k * log.dt; t > 0.5999 && t < 0.6999)
      log.samples[k].planned_contact = {false, false};
  ASSERT_EQ(flights(log).size(), 1u);
  EXPECT_NEAR(flights(log)[0].begin, 0.6, 1e-12);
  EXPECT_NEAR(flights(log)[0].end, 0.7, 1e-12);
  EXPECT_NEAR(telling_instant(log), 0.65, 1e-12);
  const std::vector<double> times = telling_instants(log, 4);
  ASSERT_EQ(times.size(), 4u);
  EXPECT_NEAR(times[0], 0.35, 1e-12) << "a little before";
  EXPECT_NEAR(times[3], 1, 1e-12) << "within the run";
  EXPECT_EQ(
      std::count_if(times.begin(), times.end(), [](double t) { return std::abs(t - 0.65) < 1e-9; }),
      1)
      << "the flight itself";
  EXPECT_EQ(instant_text(log, 0.65), "apex");
  EXPECT_EQ(instant_text(log, 0.61), "");
  // The COG is highest a fifth of the flight after lift-off.
  for (size_t k = 0; k < log.samples.size(); ++k)
    log.samples[k].cog.z() -= 4.905 * std::pow(k * log.dt - 0.62, 2);
  std::string all;
  for (const double t : telling_instants(log, 4)) all += std::to_string(t) + " ";
  EXPECT_NE(all.find("0.62"), std::string::npos) << all;
}

// After a flight, the knee is bent most a few milliseconds before the COG is lowest. These are not
// two pictures.
TEST(LogReading, ALandingIsShownOnce) {
  SimulationLog log = test::box_run(test::box_robot());
  for (size_t k = 0; k < log.samples.size(); ++k) {
    SimulationSample& s = log.samples[k];
    const double t = static_cast<double>(k) * log.dt;
    const auto bump = [&](double at) { return std::exp(-std::pow((t - at) / 0.03, 2)); };
    s.push_force.setZero();
    if (t > 0.5999 && t < 0.6999) s.planned_contact = {false, false};
    s.state.theta[1] = 1.2 * bump(0.745);
    s.cog.z() += 0.02 * bump(0.65) - 0.4 * s.cog.z() * bump(0.755);
  }
  for (const int count : {4, 5, 6, 8}) {
    const std::vector<double> times = telling_instants(log, count);
    for (size_t i = 1; i < times.size(); ++i)
      EXPECT_GT(times[i] - times[i - 1], 0.015) << count << " pictures, after " << times[i - 1];
  }
}

// Nearer than 50 ms to the most bent knee, the lowest COG is not worth a picture.
TEST(LogReading, ALandingIsShownBesideAPostureThatIsFarEnoughAway) {
  for (const double apart : {0.035, 0.045, 0.055, 0.065}) {
    SimulationLog log = test::box_run(test::box_robot());
    size_t lowest = 0;
    for (size_t k = 0; k < log.samples.size(); ++k) {
      SimulationSample& s = log.samples[k];
      const double t = static_cast<double>(k) * log.dt;
      const auto bump = [&](double at) { return std::exp(-std::pow((t - at) / 0.02, 2)); };
      s.push_force.setZero();
      if (t > 0.5999 && t < 0.6999) s.planned_contact = {false, false};
      s.state.theta[1] = 1.2 * bump(0.735);
      s.cog.z() += 0.02 * bump(0.65) - 0.3 * s.cog.z() * bump(0.735 + apart);
      if (s.cog.z() < log.samples[lowest].cog.z()) lowest = k;
    }
    const std::vector<double> times = telling_instants(log, 6);
    const bool shown = std::any_of(times.begin(), times.end(), [&](double t) {
      return std::abs(t - static_cast<double>(lowest) * log.dt) < 1e-9;
    });
    EXPECT_EQ(shown, apart > 0.05) << apart << " s";
  }
}

// The made-up push lasts from 0.3 to 0.32 s.
TEST(LogReading, PushesAreWorthShowing) {
  SimulationLog log = test::box_run(test::box_robot());
  std::vector<double> times = telling_instants(log, 5);
  ASSERT_EQ(times.size(), 5u);
  EXPECT_NEAR(times.front(), 0.05, 1e-12) << "a little before";
  EXPECT_TRUE(std::any_of(times.begin(), times.end(), [](double t) {
    return std::abs(t - 0.31) < 1e-9;
  })) << "the push itself";
  EXPECT_EQ(instant_text(log, 0.31), "push 0.4 N s");
  EXPECT_NEAR(times.back(), 1, 1e-12) << "within the run";
  const size_t end = log.samples.size();
  for (size_t k = 0; k < 3 * end; ++k) log.samples.push_back(log.samples[end - 1]);
  EXPECT_NEAR(telling_instants(log, 5).back(), 1.57, 1e-12) << "not the rest of the run";
  log.result.outcome = Outcome::fell;
  log.result.fell_at = 1.9;
  EXPECT_NEAR(telling_instants(log, 5).back(), 3.15, 1e-12) << "after the fall";
}

TEST(LogReading, AWalkIsShownOnBothFeet) {
  SimulationLog log = test::box_run(test::box_robot());
  for (SimulationSample& sample : log.samples) sample.push_force.setZero();
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const bool left = k % 100 < 50;  // 0.1 s on each foot in turn
    log.samples[k].planned_contact = {left, !left};
  }
  // Six evenly spaced instants would all be on the left foot. The chosen instants show both feet.
  const std::vector<double> times = telling_instants(log, 6);
  ASSERT_EQ(times.size(), 6u);
  const auto left = std::count_if(times.begin(), times.end(),
                                  [&](double t) { return sample_at(log, t).planned_contact[0]; });
  EXPECT_GE(left, 2);
  EXPECT_LE(left, 4);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
}

/// A run at rest except for one joint, which moves to `angle` and back around `at`, half a second
/// each.
SimulationLog nod(double at, double angle, double length) {
  SimulationLog log = test::box_run(test::box_robot());
  for (SimulationSample& s : log.samples) {
    s = log.samples.front();
    s.push_force.setZero();
    s.planned_contact = {true, true};
    s.state.base.position = {0, 0, 0.3};
    s.state.theta.setZero();
    s.cog = {0, 0, 0.28};
  }
  log.samples.resize(static_cast<size_t>(std::lround(length / log.dt)) + 1, log.samples.back());
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const double away = std::min(1.0, std::abs(double(k) * log.dt - at) / 0.5);
    log.samples[k].state.theta[2] = angle * 0.5 * (1 + std::cos(M_PI * away));
  }
  return log;
}

bool shows(const std::vector<double>& times, double t, double near) {
  return std::any_of(times.begin(), times.end(),
                     [&](double shown) { return std::abs(shown - t) <= near; });
}

// In an earlier version, the stoop and the landing of a jump looked alike, and only the stoop was
// shown.
TEST(LogReading, TheLandingOfAJumpIsWorthShowing) {
  SimulationLog log = nod(1.2, 1.2, 6);
  const double home = log.samples.front().cog.z();
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const double t = static_cast<double>(k) * log.dt;
    const bool flies = t > 3.1 && t < 3.3;
    if (flies) log.samples[k].planned_contact = {false, false};
    // The robot is low from 2 to 3 s and from 3.4 to 4.4 s, and as high as at rest in between.
    const double away = std::min(std::abs(t - 2.5), std::abs(t - 3.9));
    const double depth = std::clamp((0.7 - away) / 0.2, 0.0, 1.0);
    log.samples[k].cog.z() = home * (1 - 0.2 * depth);
    log.samples[k].state.theta[1] = depth;
  }
  for (const int count : {6, 8}) {
    const std::vector<double> times = telling_instants(log, count);
    EXPECT_TRUE(shows(times, 3.4, 0.02)) << count;
    EXPECT_TRUE(shows(times, 2.5, 0.55)) << count;
  }
}

// Extremes are shown wherever in a run a joint turns back, and however long the run is.
TEST(LogReading, ExtremesAreWorthShowing) {
  for (const double length : {4.0, 20.0})
    for (const double at : {0.7, 1.9, 3.3})
      for (const double angle : {0.4, -1.5}) {
        const SimulationLog log = nod(at, angle, length);
        for (const int count : {2, 3, 5, 8, 12})
          EXPECT_TRUE(shows(telling_instants(log, count), at, 0.06))
              << length << " " << at << " " << angle << " " << count;
      }
}

// Near its extreme a joint is slow: it has made 98 % of its move a tenth of a second before.
TEST(LogReading, TheExtremeItselfIsShown) {
  const SimulationLog log = nod(1.9, -1.5, 4);
  EXPECT_TRUE(shows(telling_instants(log, 5), 1.9, 0.01));
}

// In a run with one short move, all pictures between the first and the last one are taken during
// the move, so no two pictures show the same posture.
TEST(LogReading, NoPostureIsShownTwice) {
  const SimulationLog log = nod(1.2, 1.2, 10);
  const std::vector<double> times = telling_instants(log, 6);
  ASSERT_EQ(times.size(), 6u);
  for (size_t i = 1; i + 1 < times.size(); ++i)
    for (size_t k = 0; k < times.size(); ++k)
      if (i != k) {
        EXPECT_GE(std::abs(sample_at(log, times[i]).state.theta[2] -
                           sample_at(log, times[k]).state.theta[2]),
                  0.05)
            << times[i] << " " << times[k];
      }
}

// A push is in one part and a kick in another: both are shown.
TEST(LogReading, AKickAndAPushAreWorthShowing) {
  SimulationLog log = nod(1.2, 1.2, 10);
  for (size_t k = 3500; k < 3510; ++k) {
    log.samples[k].push_force = {0, 20, 0};
    log.samples[k].push_point = log.samples[k].cog;
  }
  const std::vector<double> times = telling_instants(log, 8);
  EXPECT_TRUE(shows(times, 1.2, 0.06));
  EXPECT_TRUE(shows(times, 7.01, 1e-9));
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
}

// A push acts while the leg of a kick comes back: the kick itself is shown, too.
TEST(LogReading, AKickInWhichThePushFallsIsWorthShowing) {
  SimulationLog log = nod(1.2, 1.2, 4);
  for (size_t k = 350; k < 900; ++k) log.samples[k].planned_contact = {true, false};
  for (size_t k = 770; k < 780; ++k) {
    log.samples[k].push_force = {0, 20, 0};
    log.samples[k].push_point = log.samples[k].cog;
  }
  const std::vector<double> times = telling_instants(log, 6);
  EXPECT_TRUE(shows(times, 1.2, 0.06)) << times.front();
  EXPECT_TRUE(shows(times, 1.55, 0.01));
}

TEST(LogReading, AVerdictHoldsFromWhenItIsSo) {
  SimulationLog log = nod(1.2, 1.2, 4);
  EXPECT_NEAR(verdict_instant(log), 1.7, 0.06) << "at rest again";
  log.samples[1500].push_force = {0, 20, 0};
  EXPECT_NEAR(verdict_instant(log), 3.002, 1e-9) << "not before the last push";
  log.result.outcome = Outcome::unsettled;
  EXPECT_NEAR(verdict_instant(log), 4, 1e-9);
  log.result.outcome = Outcome::fell;
  log.result.fell_at = 0.9;
  EXPECT_NEAR(verdict_instant(log), 0.9, 1e-12);
}

TEST(LogReading, TheGroundIsTheSlopeWithEveryMotionOfTheFloor) {
  SimulationLog log = test::box_run(test::box_robot());
  log.world.slope = {0.1, 0};
  log.world.height = -0.02;
  EXPECT_FALSE(floor_moves(log));
  const Eigen::Vector3d n = ground_at(log, 0.4).linear().col(2);
  EXPECT_NEAR(n.y(), -std::sin(0.1), 1e-12);
  EXPECT_NEAR(n.z(), std::cos(0.1), 1e-12);
  EXPECT_TRUE(ground_at(log, 0.4).translation().isApprox(-0.02 * n, 1e-12));
  // The world shifts the ground there and back, and the scenario adds a tilt that stays.
  log.world.motions = {
      {.at = 0, .duration = 0.8, .path = {.shape = MotionShape::half_sine, .shift = {0, 0.05, 0}}}};
  log.scenario = {{.at = 0.2, .duration = 0.2, .what = FloorPath{.tilt = {0.05, 0}}}};
  EXPECT_TRUE(floor_moves(log));
  EXPECT_NEAR(floor_at(log, 0.4).translation().y(), 0.05, 1e-12);
  EXPECT_NEAR(floor_at(log, 0.9).translation().y(), 0, 1e-12);
  EXPECT_NEAR(floor_at(log, 0.1).linear()(2, 1), std::sin(0.1), 1e-12);
  EXPECT_NEAR(floor_at(log, 0.3).linear()(2, 1), std::sin(0.125), 1e-12) << "half way";
  EXPECT_NEAR(floor_at(log, 0.9).linear()(2, 1), std::sin(0.15), 1e-12);
}

TEST(LogReading, MarksLieOnTheHigherSupportingFoot) {
  SimulationLog log = test::box_run(test::box_robot());
  SimulationSample sample = log.samples[0];
  EXPECT_EQ(marked_ground(log, 0, sample).translation().z(), 0) << "on the plane";
  sample.foot_cop[0].z() = 0.012;
  EXPECT_NEAR(marked_ground(log, 0, sample).translation().z(), 0.012, 1e-15);
  sample.foot_force[0].setZero();
  EXPECT_EQ(marked_ground(log, 0, sample).translation().z(), 0) << "nothing carries there";
}

TEST(Overlay, SupportPolygonIsTheHullOfThePlannedSoles) {
  const RobotModel model = test::box_robot();
  RobotState state = model.rest_state();
  state.base.position.z() = 0.30;
  const auto poses = body_poses(model, state);
  const auto area = [](const std::vector<Eigen::Vector3d>& p) {
    double sum = 0;
    for (size_t i = 0; i < p.size(); ++i) sum += p[i].cross(p[(i + 1) % p.size()]).z() / 2;
    return sum;
  };
  EXPECT_NEAR(area(support_corners(model, poses, {true, false})), 0.09 * 0.05, 1e-12);
  EXPECT_NEAR(area(support_corners(model, poses, {true, true})), 0.09 * 0.13, 1e-12);
  EXPECT_TRUE(support_corners(model, poses, {false, false}).empty());
  Eigen::Isometry3d tilted = Eigen::Isometry3d::Identity();
  tilted.rotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d(0.6, 0.8, 0)));
  for (const Eigen::Vector3d& corner : support_corners(model, poses, {true, true}, tilted))
    EXPECT_NEAR(tilted.linear().col(2).dot(corner), 0, 1e-12);
}

/// A run that follows its plan exactly, at a place and in a direction of its own, which change
/// while the robot is in the air.
SimulationLog displaced(const RobotModel& model, const std::array<Eigen::Isometry3d, 2>& by) {
  SimulationLog log = test::box_run(model);
  for (size_t k = 0; k < log.samples.size(); ++k) {
    SimulationSample& s = log.samples[k];
    const Eigen::Isometry3d& moved = by[k < 300 ? 0 : 1];
    s.planned_contact = {k < 250 || k >= 300, k < 100};
    s.reference_base = s.command_base = s.state.base;
    s.reference_theta = s.command_theta = s.state.theta;
    s.command_cog = s.reference_cog = s.cog;
    s.command_zmp = s.reference_zmp = s.zmp;
    s.state.base.position = moved * s.state.base.position;
    s.state.base.attitude = Eigen::Quaterniond(moved.linear()) * s.state.base.attitude;
    s.cog = moved * s.cog;
    s.zmp = moved * s.zmp;
  }
  return log;
}

Eigen::Isometry3d turned(double x, double y, double yaw) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, 0);
  pose.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  return pose;
}

// Wherever the robot is, plan and run coincide in one frame; in the frame of the foot, nothing
// depends on the place of the run.
TEST(Frames, PlanAndRunAreInOneFrame) {
  const RobotModel model = test::box_robot();
  const SimulationLog here =
      in_frame(model, displaced(model, {turned(0, 0, 0), turned(0, 0, 0)}), Frame::foot);
  for (const auto& by : {std::array{turned(0.3, -0.2, 0.4), turned(0.32, -0.2, 0.4)},
                         std::array{turned(-1, 2, 3), turned(-1, 2.1, -2)}}) {
    const SimulationLog log = displaced(model, by);
    const SimulationLog world = in_frame(model, log, Frame::world);
    const SimulationLog foot = in_frame(model, log, Frame::foot);
    double apart = 0;
    for (size_t k = 0; k < log.samples.size(); ++k) {
      const SimulationSample &as_logged = log.samples[k], &w = world.samples[k];
      const SimulationSample &f = foot.samples[k], &h = here.samples[k];
      EXPECT_EQ(w.cog, as_logged.cog) << "the world is as it was";
      for (const auto& [a, b] : {std::pair{&w, &w}, {&f, &f}, {&h, &f}}) {
        apart = std::max(apart, (a->command_cog - b->cog).norm());
        apart = std::max(apart, (a->reference_zmp - b->zmp).norm());
        apart = std::max(apart, (a->command_base.position - b->state.base.position).norm());
        apart = std::max(apart, a->command_base.attitude.angularDistance(b->state.base.attitude));
      }
    }
    EXPECT_LT(apart, 1e-7);
  }
}

TEST(Frames, WhatCannotBeShownIsSaid) {
  EXPECT_EQ(frame_of("foot"), Frame::foot);
  EXPECT_THROW(frame_of("feet"), Error);
  SimulationLog log = test::box_run(test::box_robot());
  require_level_ground(log, Frame::foot);
  log.world.slope = {0.1, 0};
  require_level_ground(log, Frame::world);
  EXPECT_THROW(require_level_ground(log, Frame::foot), Error);
}

// The log keeps the last ZMP while the robot flies, but no picture shows it.
TEST(Overlay, ThereIsNoZmpInFlight) {
  const RobotModel model = test::box_robot();
  SimulationLog log = test::box_run(model);
  for (SimulationSample& s : log.samples) {
    s.fz = 0;
    s.planned_contact = {false, false};
    s.foot_force = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  }
  const SimulationSample sample = sample_at(log, 0.5);
  const auto poses = body_poses(model, sample.state);
  OverlayOptions all, none;
  all.cog = none.cog = false;
  none.zmp = none.reference_zmp = false;
  EXPECT_EQ(make_overlay(model, log, {}, 0.5, sample, poses, 0.48, all).triangles.indices.size(),
            make_overlay(model, log, {}, 0.5, sample, poses, 0.48, none).triangles.indices.size());
}

TEST(Overlay, EveryMarkCanBeSwitchedOff) {
  const RobotModel model = test::box_robot();
  const SimulationLog log = test::box_run(model);
  const SimulationSample sample = sample_at(log, 0.31);
  const auto poses = body_poses(model, sample.state);
  const auto count = [&](const OverlayOptions& options) {
    return make_overlay(model, log, pushes(log), 0.31, sample, poses, 0.48, options)
        .triangles.indices.size();
  };
  const size_t all = count({});
  for (bool OverlayOptions::*flag :
       {&OverlayOptions::cog, &OverlayOptions::zmp, &OverlayOptions::reference_zmp,
        &OverlayOptions::support, &OverlayOptions::forces, &OverlayOptions::push,
        &OverlayOptions::trails}) {
    OverlayOptions options;
    options.*flag = false;
    EXPECT_LT(count(options), all);
  }
}

}  // namespace
}  // namespace ayumi
