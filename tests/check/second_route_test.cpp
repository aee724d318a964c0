// Every figure of the check is computed again by other means: plain sums over the links with
// fourth-order differences of their poses in time (plain_motion.hpp), virtual work for torques, and
// corners of soles by homogeneous matrices. Motions are disturbed by waves in all joints, so that
// no figure is zero.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "ayumi/check/consistency.hpp"
#include "ayumi/check/stability_series.hpp"
#include "ayumi/demand/contact_plan.hpp"
#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/demand/motion_demand.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "tests/support/plain_motion.hpp"
#include "tests/support/random_robot.hpp"
#include "tests/support/robot_motions.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kFriction = 0.3;

// Adds smooth waves to every joint and to the base, from rest to rest, and makes the commands
// wrong.
void disturb(const RobotModel& model, CommandSeries& series, double size, unsigned seed) {
  Random random(seed);
  const VectorXd share = random.vector(model.dof_count() + 6, size);
  const VectorXd tempo = random.vector(model.dof_count() + 6, 1).array() + 3;
  const double duration = series.duration();
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const double t = static_cast<double>(k) * series.dt;
    const double rest = std::pow(std::sin(M_PI * t / duration), 4);
    const VectorXd wave = (share.array() * (tempo.array() * t).sin() * rest).matrix();
    CommandSample& s = series.samples[k];
    s.state.theta += wave.tail(model.dof_count());
    s.state.base.position += 0.1 * wave.head<3>();
    s.state.base.attitude = exp_rotation(Vector3d(wave.segment<3>(3))) * s.state.base.attitude;
    s.cog += Vector3d(0.001, -0.002, 0.0005);
    s.zmp.head<2>() += Vector2d(0.002, 0.001);
    s.fz *= 1.01;
  }
  fill_rates(series.samples, series.dt, true);
}

class SecondRoute : public testing::TestWithParam<RobotMotion> {
 protected:
  const RobotModel& model = bundled_robot(GetParam().robot);
  CommandSeries series = [this] {
    CommandSeries result = sample(model, pattern_of(GetParam()));
    disturb(model, result, 0.004, 3);
    return result;
  }();
  ContactPlan plan = contact_plan(series);
  ConsistencyReport report = check_consistency(model, series, {"", kFriction, {}});

  // Calls `use` for samples away from the ends, whose differences do not mix support and flight.
  template <class Use>
  void each_known(const Use& use) const {
    for (int k = 2; k + 2 < static_cast<int>(series.samples.size()); ++k)
      if (!at_flight_edge(series, k)) use(k, plain_ground(plain_links(model, series, k)));
  }

  // The corners of the soles that are planned on the ground at sample k.
  std::vector<Vector3d> support(int k) const {
    std::vector<Vector3d> corners;
    for (const Side side : {Side::left, Side::right}) {
      if (!supports(series.samples[static_cast<size_t>(k)].support, side)) continue;
      for (const Vector2d& v : model.sole(side).polygon)
        corners.push_back(at_pose(plan.at(side, k).sole.matrix(), {v.x(), v.y(), 0}));
    }
    return corners;
  }
  double weight() const { return model.mass() * kGravity; }
};

}  // namespace

// Force, moment and COG acceleration follow from the poses of the links alone.
TEST_P(SecondRoute, GroundFiguresByPlainSums) {
  double margin = 1e9, zmp = 0, fz = 0, friction = 0, yaw = 0, gap = 0, ballistic = 0;
  std::vector<Vector3d> turning(series.samples.size(), Vector3d::Zero());
  std::vector<char> flies(series.samples.size(), 0);
  each_known([&](int k, const PlainGround& ground) {
    const CommandSample& s = series.samples[static_cast<size_t>(k)];
    const Vector3d f = ground.force;
    const std::vector<Vector3d> corners = support(k);
    fz = std::max(fz, std::abs((corners.empty() ? 0 : f.z()) - s.fz));
    if (corners.empty()) {
      const Vector3d cog = plain_cog(model, plain_poses(model, s.state));
      ballistic = std::max(ballistic, f.norm() / model.mass());
      turning[static_cast<size_t>(k)] = ground.moment - cog.cross(f);
      flies[static_cast<size_t>(k)] = 1;
      return;
    }
    if (f.z() < 0.02 * weight()) return;
    // M = Z x f + (0, 0, yaw) at the height of the soles.
    const double height = corners.front().z();
    const Vector3d at(-(ground.moment.y() - height * f.x()) / f.z(),
                      (ground.moment.x() + height * f.y()) / f.z(), height);
    zmp = std::max(zmp, (at - s.zmp).norm());
    const double inside = plain_margin(corners, at.head<2>());
    margin = std::min(margin, inside);
    friction = std::max(friction, f.head<2>().norm() / (kFriction * f.z()));
    const Vector3d a = f / model.mass() - Vector3d(0, 0, kGravity);
    const Vector3d cog = plain_cog(model, plain_poses(model, s.state));
    const Vector2d pendulum =
        cog.head<2>() - (cog.z() - s.zmp.z()) / (a.z() + kGravity) * a.head<2>();
    gap = std::max(gap, (pendulum - s.zmp.head<2>()).norm());
    if (inside <= 0.002 || f.head<2>().norm() > kFriction * f.z()) return;
    std::vector<Vector2d> hull;
    for (const Vector3d& c : corners) hull.push_back(c.head<2>());
    const double lever = torsional_friction_arm(ConvexPolygon(hull), at.head<2>());
    const double moment = (ground.moment - at.cross(f)).z();
    yaw = std::max(yaw, std::abs(moment) / (kFriction * f.z() * lever));
  });
  const CheckSummary& is = report.summary;
  ASSERT_GT(margin, 0.004);
  EXPECT_NEAR(is[FindingKind::support_margin], margin, 2e-6);
  EXPECT_NEAR(is[FindingKind::zmp_residual], zmp, 1e-4 * zmp);
  EXPECT_NEAR(is[FindingKind::fz_residual], fz, 1e-5 * weight());
  EXPECT_NEAR(is[FindingKind::friction], friction, 1e-4 * friction);
  EXPECT_NEAR(is[FindingKind::yaw_moment], yaw, 1e-3 * yaw);
  EXPECT_NEAR(is[FindingKind::point_mass_gap], gap, 1e-4 * gap);
  EXPECT_GT(zmp, 0.001);
  EXPECT_GT(yaw, 0.001);
  if (GetParam().motion != "jump") return;

  double turned = 0;
  for (size_t k = 2; k + 2 < flies.size(); ++k) {
    if (!flies[k]) continue;
    Vector3d sum = Vector3d::Zero();
    int count = 0;
    for (size_t i = k - 2; i <= k + 2; ++i)
      if (flies[i]) sum += turning[i], ++count;
    turned = std::max(turned, sum.norm() / count);
  }
  // The commanded COG has an acceleration of its own, which may be the larger or the smaller one
  // here.
  for (size_t k = 2; k + 2 < flies.size(); ++k) {
    if (!flies[k]) continue;
    const auto c = [&](size_t i) { return series.samples[i].cog; };
    const Vector3d a = (-c(k - 2) + 16 * c(k - 1) - 30 * c(k) + 16 * c(k + 1) - c(k + 2)) /
                       (12 * series.dt * series.dt);
    ballistic = std::max(ballistic, (a + Vector3d(0, 0, kGravity)).norm());
  }
  EXPECT_NEAR(is[FindingKind::ballistic], ballistic, 2e-5 * kGravity);
  EXPECT_NEAR(is[FindingKind::angular_momentum], turned, 1e-3 * turned + 1e-6);
  EXPECT_GT(turned, 1e-3);
}

TEST_P(SecondRoute, CogAndSolesByHomogeneousMatrices) {
  double cog = 0, slip = 0, deep = 0, high = 0, landing = 0;
  for (int k = 0; k < static_cast<int>(series.samples.size()); ++k) {
    const CommandSample& s = series.samples[static_cast<size_t>(k)];
    const auto poses = plain_poses(model, s.state);
    cog = std::max(cog, (plain_cog(model, poses) - s.cog).norm());
    for (const Side side : {Side::left, Side::right}) {
      const ContactInterval& stands = plan.at(side, k);
      const auto corners = plain_sole(model, poses, side);
      if (!stands.contact) {  // the ground is level
        double low = 1e9, ground = 1e9;
        for (const Vector3d& c : corners) low = std::min(low, c.z());
        for (const ContactInterval& other : plan.intervals[static_cast<size_t>(side)])
          if (other.contact) ground = std::min(ground, other.sole.translation().z());
        deep = std::max(deep, ground - low);
        continue;
      }
      double gap = 0, lowest = 1e9, way = 0;
      for (size_t i = 0; i < corners.size(); ++i) {
        const Vector2d& v = model.sole(side).polygon[i];
        const Vector3d planned = at_pose(stands.sole.matrix(), {v.x(), v.y(), 0});
        const Vector3d normal = stands.sole.matrix().block<3, 1>(0, 2);
        const Vector3d off = corners[i] - planned;
        const double height = normal.dot(corners[i] - stands.sole.translation());
        gap = std::max(gap, height);
        lowest = std::min(lowest, height);
        way = std::max(way, (off - normal.dot(off) * normal).norm());
      }
      high = std::max(high, gap);
      deep = std::max(deep, -lowest);
      if (lowest <= 0.0003) slip = std::max(slip, way);
      if (k == stands.first && k > 0) {
        const auto before = plain_poses(model, series.samples[static_cast<size_t>(k - 1)].state);
        const Sole& sole = model.sole(side);
        const auto origin = [&](const std::vector<Eigen::Matrix4d>& p) {
          return at_pose(p[static_cast<size_t>(sole.body)] * sole.frame.matrix(), Vector3d::Zero());
        };
        landing = std::max(landing, (origin(before) - origin(poses)).z() / series.dt);
      }
    }
  }
  const CheckSummary& is = report.summary;
  EXPECT_NEAR(is[FindingKind::cog_residual], cog, 1e-9);
  EXPECT_NEAR(is[FindingKind::foot_slip], slip, 1e-9);
  EXPECT_NEAR(is[FindingKind::foot_penetration], deep, 1e-9);
  EXPECT_NEAR(is[FindingKind::foot_float], high, 1e-9);
  EXPECT_NEAR(is[FindingKind::landing_speed], landing, 1e-7);
  EXPECT_GT(std::min({slip, deep, high}), 1e-4);
}

TEST_P(SecondRoute, JointFiguresByDifferences) {
  const ActuatorLimits& limits = model.limits();
  const auto theta = [&](int k, int i) {
    const int last = static_cast<int>(series.samples.size()) - 1;
    return series.samples[static_cast<size_t>(std::clamp(k, 0, last))].state.theta[i];
  };
  const double h = series.dt, soft = model.description().soft_limit_margin;
  double position = 0, speed = 0, acceleration = 0, step = 0;
  const int tick = std::max(1, static_cast<int>(std::lround(model.description().servo_period / h)));
  for (int i = 0; i < model.dof_count(); ++i)
    for (int k = 0; k < static_cast<int>(series.samples.size()); ++k) {
      const Dof& dof = model.dofs()[static_cast<size_t>(i)];
      const double rate =
          (theta(k - 2, i) - 8 * theta(k - 1, i) + 8 * theta(k + 1, i) - theta(k + 2, i)) /
          (12 * h);
      const double second = (-theta(k - 2, i) + 16 * theta(k - 1, i) - 30 * theta(k, i) +
                             16 * theta(k + 1, i) - theta(k + 2, i)) /
                            (12 * h * h);
      const double middle = 0.5 * (dof.lower + dof.upper);
      const double half = 0.5 * (dof.upper - dof.lower) - soft;
      if (dof.limited) position = std::max(position, std::abs(theta(k, i) - middle) / half);
      speed = std::max(speed, std::abs(rate) / limits.speed[i]);
      acceleration = std::max(acceleration, std::abs(second));
      if (k >= tick)
        step = std::max(step,
                        std::abs(theta(k, i) - theta(k - tick, i)) / (limits.speed[i] * tick * h));
    }
  const CheckSummary& is = report.summary;
  EXPECT_NEAR(is[FindingKind::joint_position], position, 1e-12);
  EXPECT_NEAR(is[FindingKind::joint_speed], speed, 1e-9);
  EXPECT_NEAR(is[FindingKind::joint_acceleration], acceleration, 1e-6 * acceleration);
  EXPECT_NEAR(is[FindingKind::servo_step], step, 1e-12);
}

// If one joint alone moves a little, the total work of all links, the ground and the motors is
// zero. This is tested for every joint with one foot on the ground, and otherwise for those that
// carry no foot on the ground.
TEST_P(SecondRoute, TorquesByVirtualWork) {
  MotionDynamics motion(model, model.limits(), series, plan);
  int told = 0;
  for (int k = 10; k + 10 < static_cast<int>(series.samples.size()); k += 37) {
    if (at_flight_edge(series, k)) continue;
    const CommandSample& s = series.samples[static_cast<size_t>(k)];
    const auto links = plain_links(model, series, k);
    const PlainGround ground = plain_ground(links);
    const VectorXd torque = motion.at(k).torque;
    for (int i = 0; i < model.dof_count(); ++i) {
      const auto in_leg = [&](Side side) {
        const auto& leg = model.leg(side);
        return supports(s.support, side) && std::find(leg.begin(), leg.end(), i) != leg.end();
      };
      if (s.support == Support::both && (in_leg(Side::left) || in_leg(Side::right))) continue;
      // The velocities of all bodies by this joint alone, from poses slightly to either side.
      const double e = 1e-6;
      std::array<std::vector<Eigen::Matrix4d>, 2> moved;
      for (int way : {0, 1}) {
        RobotState other = s.state;
        other.theta[i] += way == 0 ? -e : e;
        moved[static_cast<size_t>(way)] = plain_poses(model, other);
      }
      const auto poses = plain_poses(model, s.state);
      const auto spin_of = [&](int body) {
        const auto b = static_cast<size_t>(body);
        const Eigen::Matrix3d W = (moved[1][b] - moved[0][b]).topLeftCorner<3, 3>() / (2 * e) *
                                  poses[b].topLeftCorner<3, 3>().transpose();
        return Vector3d(W(2, 1), W(0, 2), W(1, 0));
      };
      // Velocity of a point that is there now.
      const auto rate_of = [&](int body, const Vector3d& point) {
        const auto b = static_cast<size_t>(body);
        const Eigen::Vector4d local = poses[b].inverse() * point.homogeneous();
        return Vector3d(((moved[1][b] - moved[0][b]) * local).head<3>() / (2 * e));
      };
      double work = 0;
      for (size_t l = 0; l < links.size(); ++l) {
        const PlainLink& p = links[l];
        const int body = model.links()[l].body;
        work += p.mass * (p.acceleration + Vector3d(0, 0, kGravity)).dot(rate_of(body, p.com)) +
                p.spin_rate.dot(spin_of(body));
      }
      for (const Side side : {Side::left, Side::right}) {
        if (!in_leg(side)) continue;
        const int body = model.sole(side).body;
        work -=
            ground.force.dot(rate_of(body, Vector3d::Zero())) + ground.moment.dot(spin_of(body));
      }
      const ServoDescription& servo = model.limits().servo[static_cast<size_t>(i)];
      const double rate = s.state.dtheta[i];
      work += servo.rotor_inertia * s.acceleration[6 + i] + servo.viscous * rate +
              servo.coulomb * std::clamp(rate / kCoulombRate, -1.0, 1.0);
      EXPECT_NEAR(torque[i], work, 2e-5 * (1 + std::abs(work)))
          << model.dofs()[static_cast<size_t>(i)].name << " at sample " << k;
      ++told;
    }
  }
  EXPECT_GT(told, 300);
}

// The RMS of the torques above, sample by sample, and the largest of them.
TEST_P(SecondRoute, TorqueFiguresByLoops) {
  MotionDynamics motion(model, model.limits(), series, plan);
  const ActuatorLimits& limits = model.limits();
  const int count = static_cast<int>(series.samples.size());
  Eigen::MatrixXd torque = Eigen::MatrixXd::Zero(model.dof_count(), count);
  for (int k = 0; k < count; ++k)
    if (!at_flight_edge(series, k)) torque.col(k) = motion.at(k).torque;
  double peak = 0, lasting = 0;
  const int window =
      std::min(count, static_cast<int>(std::lround(limits.thermal_window / series.dt)));
  for (int i = 0; i < model.dof_count(); ++i) {
    peak = std::max(peak, torque.row(i).cwiseAbs().maxCoeff() / limits.peak_torque[i]);
    for (int begin = 0; begin + window <= count; ++begin) {
      const auto part =
          torque.row(i).segment(begin, window).cwiseAbs().cwiseMin(limits.peak_torque[i]);
      lasting =
          std::max(lasting, std::sqrt(part.squaredNorm() / window) / limits.continuous_torque[i]);
    }
  }
  EXPECT_NEAR(report.summary[FindingKind::joint_torque], peak, 1e-9);
  EXPECT_NEAR(report.summary[FindingKind::continuous_torque], lasting, 1e-9);
}

// The strip that is noted while the motion is judged, on any number of threads, is that of a pass
// of its own, and the report does not depend on the threads.
TEST_P(SecondRoute, SeriesNotedByTheJudge) {
  CheckOptions options{"", kFriction, {}};
  const StabilitySeries alone = stability_series(model, series, options);
  std::string first;
  for (const int threads : {1, 2, 5}) {
    options.threads = threads;
    StabilityNotes notes(model, series, options);
    const ConsistencyReport report = check_consistency(
        model, series, options,
        [&](const JudgedSample& s, const RobotData& data) { notes.note(s, data); });
    const std::string text = check_json(report);
    if (first.empty()) first = text;
    EXPECT_EQ(text, first) << threads;
    EXPECT_EQ(text, check_json(check_consistency(model, series, options))) << threads;
    const StabilitySeries noted = notes.series();
    EXPECT_EQ(noted.speed_dof, alone.speed_dof) << threads;
    EXPECT_EQ(noted.torque_dof, alone.torque_dof) << threads;
    for (const auto member : {&StabilitySeries::zmp_margin, &StabilitySeries::dcm_margin,
                              &StabilitySeries::normal_force, &StabilitySeries::friction,
                              &StabilitySeries::speed, &StabilitySeries::torque}) {
      const std::vector<double>&a = noted.*member, &b = alone.*member;
      ASSERT_EQ(a.size(), b.size());
      EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0) << threads;
    }
  }
}

// Each stretch of the series holds the worst of its samples.
TEST_P(SecondRoute, SeriesByPlainSums) {
  constexpr size_t kStretch = 10;
  const StabilitySeries shown =
      stability_series(model, series, {"", kFriction, {}}, kStretch * series.dt);
  const size_t count = series.samples.size();
  ASSERT_EQ(shown.speed.size(), (count + kStretch - 1) / kStretch);
  EXPECT_DOUBLE_EQ(shown.dt, kStretch * series.dt);
  struct Stretch {
    double margin = 1e9, dcm = 1e9, fz = 1e9, friction = 0;
    size_t samples = 0;  // number of samples with a ZMP inside the support
  };
  std::vector<Stretch> wanted(shown.speed.size());
  const auto cog = [&](int k) {
    return plain_cog(model, plain_poses(model, series.samples[static_cast<size_t>(k)].state));
  };
  each_known([&](int k, const PlainGround& ground) {
    const Vector3d f = ground.force;
    std::vector<Vector3d> corners = support(k);
    if (corners.empty() || f.z() < 0.1 * weight()) return;
    const double height = corners.front().z();
    const Vector2d zmp(-(ground.moment.y() - height * f.x()) / f.z(),
                       (ground.moment.x() + height * f.y()) / f.z());
    const double margin = plain_margin(corners, zmp);
    if (margin < 0) return;
    Stretch& stretch = wanted[static_cast<size_t>(k) / kStretch];
    ++stretch.samples;
    stretch.margin = std::min(stretch.margin, margin);
    stretch.fz = std::min(stretch.fz, f.z());
    stretch.friction = std::max(stretch.friction, f.head<2>().norm() / (kFriction * f.z()));
    int next = k;
    while (next < static_cast<int>(count) && series.samples[static_cast<size_t>(next)].support ==
                                                 series.samples[static_cast<size_t>(k)].support)
      ++next;
    for (const Vector3d& corner : next < static_cast<int>(count) ? support(next) : corners)
      corners.push_back(corner);
    const Vector3d rate =
        (cog(k - 2) - 8 * cog(k - 1) + 8 * cog(k + 1) - cog(k + 2)) / (12 * series.dt);
    const Vector3d dcm = cog(k) + rate / std::sqrt(kGravity / (cog(k).z() - height));
    stretch.dcm = std::min(stretch.dcm, plain_margin(corners, dcm.head<2>()));
  });
  int compared = 0, insides = 0;
  for (size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i].samples < kStretch) continue;
    ++compared;
    EXPECT_NEAR(shown.zmp_margin[i], wanted[i].margin, 2e-6) << i;
    EXPECT_NEAR(shown.normal_force[i], wanted[i].fz, 1e-5 * weight()) << i;
    EXPECT_NEAR(shown.friction[i], wanted[i].friction, 1e-4) << i;
    if (wanted[i].dcm < 0) {
      EXPECT_LT(shown.dcm_margin[i], 1e-6) << i;
      continue;
    }
    ++insides;
    EXPECT_NEAR(shown.dcm_margin[i], wanted[i].dcm, 1e-5) << i;
  }
  EXPECT_GT(compared, 20);
  EXPECT_GT(insides, 10);
}

TEST_P(SecondRoute, SeriesNamesTheWorstJoint) {
  const StabilitySeries shown =
      stability_series(model, series, {"", kFriction, {}}, 10 * series.dt);
  MotionDynamics motion(model, model.limits(), series, plan);
  const ActuatorLimits& limits = model.limits();
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const size_t i = k / 10;
    const bool edge = at_flight_edge(series, static_cast<int>(k));
    const VectorXd torque =
        edge ? VectorXd::Zero(model.dof_count()) : motion.at(static_cast<int>(k)).torque;
    for (int j = 0; j < model.dof_count(); ++j) {
      EXPECT_LE(std::abs(series.samples[k].state.dtheta[j]) / limits.speed[j],
                shown.speed[i] + 1e-12);
      EXPECT_TRUE(edge || std::abs(torque[j]) / limits.peak_torque[j] <= shown.torque[i] + 1e-9);
    }
  }
  EXPECT_NEAR(*std::max_element(shown.speed.begin(), shown.speed.end()),
              report.summary[FindingKind::joint_speed], 1e-9);
  for (size_t i = 0; i < shown.speed.size(); ++i) {
    ASSERT_GE(shown.speed_dof[i], 0);
    double largest = 0;
    for (size_t k = 10 * i; k < std::min(10 * i + 10, series.samples.size()); ++k)
      largest = std::max(largest, std::abs(series.samples[k].state.dtheta[shown.speed_dof[i]]) /
                                      limits.speed[shown.speed_dof[i]]);
    EXPECT_NEAR(largest, shown.speed[i], 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Motions, SecondRoute, robot_motions(), name_of_case);
