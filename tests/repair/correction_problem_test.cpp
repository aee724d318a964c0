#include "ayumi/repair/correction_problem.hpp"

#include <gtest/gtest.h>

#include <map>

#include "ayumi/check/consistency.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "tests/support/limited_biped.hpp"
#include "tests/support/random_robot.hpp"
#include "tests/support/walk.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

CommandSample random_sample(Random& random) {
  CommandSample s;
  s.state = random_state(limited_biped(), random);
  s.acceleration = random.vector(limited_biped().velocity_count(), 3);
  return s;
}

WalkShape short_walk() {
  WalkShape w;
  w.steps = 2;
  return w;
}

// Compares the Jacobian with central differences, which are extrapolated from two step widths. The
// largest error of each kind of rows is tested; it is relative where the derivative is above one.
void expect_jacobian(const CorrectionProblem& problem, const VectorXd& x, double tolerance) {
  const Nlp nlp = problem.nlp();
  VectorXd values(nlp.jacobian.size());
  nlp.jacobian_values(x, values);
  MatrixXd J = MatrixXd::Zero(problem.constraint_count(), problem.variable_count());
  for (int i = 0; i < nlp.jacobian.size(); ++i)
    J(nlp.jacobian.rows[i], nlp.jacobian.columns[i]) += values[i];
  std::map<std::string, double> worst;
  std::map<std::string, int> rows;
  for (int v = 0; v < problem.variable_count(); ++v) {
    auto difference = [&](double h) {
      const VectorXd direction = h * VectorXd::Unit(x.size(), v);
      return VectorXd((problem.constraints(x + direction) - problem.constraints(x - direction)) /
                      (2 * h));
    };
    const VectorXd slope = (4 * difference(1e-6) - difference(2e-6)) / 3;
    const VectorXd off =
        (slope - J.col(v)).cwiseAbs().cwiseQuotient(J.col(v).cwiseAbs().cwiseMax(1));
    for (const RowBlock& b : problem.blocks()) {
      double& w = worst[b.kind->name];
      w = std::max(w, off.segment(b.row, b.rows()).maxCoeff());
    }
  }
  for (const RowBlock& b : problem.blocks()) rows[b.kind->name] += b.rows();
  for (const auto& [group, difference] : worst)
    EXPECT_LT(difference, tolerance) << group << ", " << rows[group] << " rows";
}

CorrectedMotion corrected_motion(const CommandSample& sample, const VectorXd& value,
                                 const VectorXd& rate, const VectorXd& second) {
  CorrectedMotion motion;
  fill_motion(sample, value, rate, second, motion);
  fill_motion_derivatives(sample, value, rate, second, motion);
  return motion;
}

}  // namespace

// The correction at one sample is that of apply_correction().
TEST(CorrectedMotion, AgreesWithApplyCorrection) {
  Random random(1);
  CommandSeries series;
  series.dt = 0.01;
  for (int k = 0; k <= 100; ++k) series.samples.push_back(random_sample(random));
  const int n = limited_biped().velocity_count();
  CorrectionTrack track;
  track.spacing = 0.1;
  track.joints = limited_biped().dof_names();
  track.coefficients.resize(13, n);
  for (int i = 0; i < 13; ++i) track.coefficients.row(i) = random.vector(n, 1);
  const CommandSeries corrected = apply_correction(limited_biped(), series, track);
  for (int k = 0; k <= 100; ++k) {
    const SplineWeights w = correction_weights(track, k * series.dt);
    const auto rows = track.coefficients.middleRows<4>(w.first);
    const CorrectedMotion m =
        corrected_motion(series.samples[k], rows.transpose() * w.value, rows.transpose() * w.rate,
                         rows.transpose() * w.acceleration);
    const CommandSample& s = corrected.samples[k];
    EXPECT_LT((m.state.velocity() - s.state.velocity()).norm(), 1e-10);
    EXPECT_LT((m.acceleration - s.acceleration).norm(), 1e-8);
    EXPECT_LT(m.state.base.attitude.angularDistance(s.state.base.attitude), 1e-7);
    EXPECT_LT((m.state.base.position - s.state.base.position).norm(), 1e-14);
    EXPECT_LT((m.state.theta - s.state.theta).norm(), 1e-14);
  }
}

TEST(CorrectedMotion, DerivativesAgainstDifferences) {
  Random random(2);
  const int n = limited_biped().velocity_count();
  const CommandSample sample = random_sample(random);
  for (const double size : {0.0, 0.3, 1.5}) {
    const VectorXd value = random.vector(n, size), rate = random.vector(n, 2),
                   acceleration = random.vector(n, 5);
    const CorrectedMotion m = corrected_motion(sample, value, rate, acceleration);
    const double h = 1e-6;
    auto difference = [&](const VectorXd& dv, const VectorXd& dr, const VectorXd& da) {
      const CorrectedMotion up = corrected_motion(sample, value + dv, rate + dr, acceleration + da);
      const CorrectedMotion down =
          corrected_motion(sample, value - dv, rate - dr, acceleration - da);
      Eigen::Matrix<double, 9, 1> d;
      d << log_rotation(up.state.base.attitude * down.state.base.attitude.conjugate()),
          up.state.base_angular_velocity - down.state.base_angular_velocity,
          (up.acceleration - down.acceleration).segment<3>(3);
      return Eigen::Matrix<double, 9, 1>(d / (2 * h));
    };
    const VectorXd none = VectorXd::Zero(n);
    for (int i = 0; i < 3; ++i) {
      const VectorXd e = h * VectorXd::Unit(n, 3 + i);
      const auto by_value = difference(e, none, none), by_rate = difference(none, e, none),
                 by_acceleration = difference(none, none, e);
      EXPECT_LT((by_value.segment<3>(0) - m.tangent.col(i)).norm(), 1e-7);
      EXPECT_LT((by_value.segment<3>(3) - m.w_value.col(i)).norm(), 1e-7);
      EXPECT_LT((by_value.segment<3>(6) - m.dw_value.col(i)).norm(), 1e-6);
      EXPECT_LT((by_rate.segment<3>(3) - m.w_rate.col(i)).norm(), 1e-7);
      EXPECT_LT((by_rate.segment<3>(6) - m.dw_rate.col(i)).norm(), 1e-6);
      EXPECT_LT((by_acceleration.segment<3>(6) - m.dw_acceleration.col(i)).norm(), 1e-6);
    }
  }
}

TEST(CorrectionProblem, JacobianAgainstDifferences) {
  const CommandSeries series = walk(limited_biped(), short_walk());
  CorrectionSpec spec;
  spec.windows = {{0.75, 1.35}};
  spec.watched_share = 0;
  spec.friction = 0.1;
  const CorrectionProblem problem(limited_biped(), series, spec);
  for (const std::string kind : {"support", "friction", "torsional_friction", "stance", "swing",
                                 "landing", "position", "speed"})
    EXPECT_TRUE(std::any_of(problem.blocks().begin(), problem.blocks().end(),
                            [&](const RowBlock& b) { return b.kind->name == kind; }))
        << kind;
  ASSERT_GT(problem.variable_count(), 100);
  Random random(3);
  // The motion is as planned, where the ZMP rests in a sole's centre and the other foot begins to
  // bear.
  expect_jacobian(problem, VectorXd::Zero(problem.variable_count()), 1e-6);
  expect_jacobian(problem, random.vector(problem.variable_count(), 0.05), 1e-6);
}

// These are rows of torques and accelerations, with quantities that are trusted or locked.
TEST(CorrectionProblem, JacobianOfTorquesAndCommands) {
  const CommandSeries series = walk(limited_biped(), short_walk());
  for (const Trust trust : {Trust::cog, Trust::zmp}) {
    CorrectionSpec spec;
    spec.windows = {{0.7, 1.2}};
    spec.watched_share = 0;
    spec.trust = trust;
    spec.locked_feet = {true, false};
    const CorrectionProblem problem(limited_biped(), series, spec);
    for (const std::string kind :
         {"torque", "acceleration", "path", trust == Trust::cog ? "cog" : "zmp"})
      EXPECT_TRUE(std::any_of(problem.blocks().begin(), problem.blocks().end(),
                              [&](const RowBlock& b) { return b.kind->name == kind; }))
          << kind;
    Random random(7);
    expect_jacobian(problem, random.vector(problem.variable_count(), 0.003), 1e-6);
  }
}

// The shapes pass each other: they are apart, near and overlapping.
TEST(CorrectionProblem, JacobianOfClearances) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  const CollisionModel collisions(model);
  CommandSeries series = standing(model, 0.6, 0.005);
  Random random(8);
  for (CommandSample& s : series.samples)
    for (const char* joint : {"l_shoulder_roll", "l_elbow", "r_shoulder_pitch"})
      s.state.theta[model.find_dof(joint)] = random.uniform(-0.6, 0.6);
  CorrectionSpec spec;
  spec.windows = {{0, 0.6}};
  spec.collisions = &collisions;
  for (int i = 0; i < static_cast<int>(collisions.pairs().size()); ++i)
    spec.near_pairs.push_back(i);
  const CorrectionProblem problem(model, series, spec);
  int rows = 0, deep = 0;
  const VectorXd x = random.vector(problem.variable_count(), 0.01);
  const VectorXd g = problem.constraints(x);
  const Nlp nlp = problem.nlp();
  VectorXd values(nlp.jacobian.size());
  nlp.jacobian_values(x, values);
  MatrixXd J = MatrixXd::Zero(problem.constraint_count(), problem.variable_count());
  for (int i = 0; i < nlp.jacobian.size(); ++i)
    J(nlp.jacobian.rows[i], nlp.jacobian.columns[i]) += values[i];
  const VectorXd direction = random.vector(problem.variable_count(), 1);
  const double h = 1e-6;
  const VectorXd slope =
      (problem.constraints(x + h * direction) - problem.constraints(x - h * direction)) / (2 * h);
  for (const RowBlock& b : problem.blocks()) {
    if (std::string_view(b.kind->name) != "clearance") continue;
    ++rows;
    if (g[b.row] < 0) ++deep;
    EXPECT_NEAR(slope[b.row], J.row(b.row).dot(direction), 1e-5) << g[b.row];
  }
  EXPECT_GT(rows, 10);
  EXPECT_GT(deep, 2);
}

// The values that the program constrains are those that the check prints: torques, speeds,
// clearances, COG.
TEST(CorrectionProblem, RowsAreTheFiguresOfTheCheck) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  const CollisionModel collisions(model);
  WalkShape shape = short_walk();
  CommandSeries series = walk(model, shape);
  for (CommandSample& s : series.samples) s.cog.x() += 0.003;
  CorrectionSpec spec;
  spec.windows = {{0, 10}};
  spec.free_ends = {true, true};
  spec.watched_share = 0;
  spec.points_per_knot = 50;  // limits are kept at every sample
  spec.trust = Trust::cog;
  spec.collisions = &collisions;
  const CorrectionProblem problem(model, series, spec);
  const VectorXd g = problem.constraints(VectorXd::Zero(problem.variable_count()));
  double torque = 0, speed = 0, cog = 0;
  for (const RowBlock& b : problem.blocks()) {
    const double size = g.segment(b.row, b.rows()).norm();
    if (std::string_view(b.kind->name) == "torque") torque = std::max(torque, size);
    if (std::string_view(b.kind->name) == "speed") speed = std::max(speed, size);
    if (std::string_view(b.kind->name) == "cog") cog = std::max(cog, size);
  }
  const CheckSummary summary = check_consistency(model, series).summary;
  EXPECT_NEAR(torque, summary[FindingKind::joint_torque], 1e-9);
  EXPECT_NEAR(speed, summary[FindingKind::joint_speed], 1e-9);
  EXPECT_NEAR(cog, summary[FindingKind::cog_residual], 1e-9);
}

TEST(CorrectionProblem, JacobianInFlightAndOnASlope) {
  CommandSeries series = walk(limited_biped(), short_walk());
  for (size_t k = 0; k < series.samples.size(); ++k) {
    if (k > 900 && k < 1100) series.samples[k].support = Support::none;
    for (auto& foot : series.samples[k].feet)
      foot.linear() = exp_rotation({0.1, -0.05, 0.2}).toRotationMatrix();
  }
  CorrectionSpec spec;
  spec.windows = {{0.75, 1.25}};
  spec.friction = 0.01;
  const CorrectionProblem problem(limited_biped(), series, spec);
  Random random(4);
  expect_jacobian(problem, random.vector(problem.variable_count(), 0.02), 1e-6);
}

// The constrained support rows are the margin that the check prints.
TEST(CorrectionProblem, SupportRowsAreTheMarginOfTheCheck) {
  const CommandSeries series = walk(limited_biped(), short_walk());
  CorrectionSpec spec;
  spec.windows = {{0, 10}};
  spec.zmp_margin = 0;
  const CorrectionProblem problem(limited_biped(), series, spec);
  const VectorXd g = problem.constraints(VectorXd::Zero(problem.variable_count()));
  for (const RowBlock& b : problem.blocks()) {
    if (std::string_view(b.kind->name) != "support") continue;
    const CollocationPoint& point = problem.points()[b.point];
    const CommandSample& s = series.samples[point.sample];
    const Vector3d zmp = point.plane.frame.inverse() * s.zmp;
    const double margin = point.plane.polygon.margin(zmp.head<2>());
    const double share = s.fz / (limited_biped().mass() * kGravity);
    EXPECT_NEAR(g.segment(b.row, b.rows()).minCoeff(), share * margin, 1e-12);
  }
}

// The objective is compared with the integral, computed as a fine sum over the track itself.
TEST(CorrectionProblem, ObjectiveIsTheIntegral) {
  const CommandSeries series = walk(limited_biped(), short_walk());
  CorrectionSpec spec;
  spec.windows = {{0.5, 1.5}};
  const CorrectionProblem problem(limited_biped(), series, spec);
  Random random(5);
  const VectorXd x = random.vector(problem.variable_count(), 0.1);
  const CorrectionTrack track = problem.track(x);
  const int n = limited_biped().velocity_count();
  VectorXd weight = VectorXd::Ones(n);
  weight.head<3>().setConstant(1000);
  weight.segment<3>(3).setConstant(4);
  double sum = 0;
  const double dt = 1e-4;
  for (double t = 0.5 * dt; t < series.duration(); t += dt) {
    const SplineWeights w = correction_weights(track, t);
    const auto rows = track.coefficients.middleRows<4>(w.first);
    const VectorXd d = rows.transpose() * w.value, dd = rows.transpose() * w.acceleration;
    sum += dt * weight.dot(VectorXd(d.cwiseAbs2() + std::pow(0.1, 4) * dd.cwiseAbs2()));
  }
  const Nlp nlp = problem.nlp();
  EXPECT_NEAR(nlp.objective(x), 0.5 * 100 * sum, 1e-4 * nlp.objective(x));
  VectorXd gradient(x.size());
  nlp.gradient(x, gradient);
  const VectorXd e = random.vector(static_cast<int>(x.size()), 1e-3);
  EXPECT_NEAR(gradient.dot(e), (nlp.objective(x + e) - nlp.objective(x - e)) / 2, 1e-10);
}

// The results do not depend on the number of threads, nor on earlier evaluations.
TEST(CorrectionProblem, FunctionsGiveTheSameBytesForAnyNumberOfThreads) {
  const CommandSeries series = walk(limited_biped(), short_walk());
  CorrectionSpec spec;
  spec.windows = {{0.3, 1.6}};
  spec.watched_share = 0;
  spec.friction = 0.05;
  const auto functions = [&](int threads) {
    spec.threads = threads;
    const CorrectionProblem problem(limited_biped(), series, spec);
    const Nlp nlp = problem.nlp();
    Random random(6);
    std::vector<VectorXd> all;
    for (int i = 0; i < 3; ++i) {
      const VectorXd x = random.vector(problem.variable_count(), 0.02),
                     multipliers = random.vector(problem.constraint_count(), 1);
      VectorXd g(problem.constraint_count()), J(nlp.jacobian.size()), H(nlp.hessian.size());
      if (i != 1) nlp.constraints(x, g);
      nlp.jacobian_values(x, J);
      nlp.hessian_values(x, 1, multipliers, H);
      nlp.constraints(x, g);
      all.insert(all.end(), {g, J, H});
    }
    return all;
  };
  const std::vector<VectorXd> one = functions(1);
  EXPECT_GT(one[2].cwiseAbs().maxCoeff(), 0);
  for (const int threads : {2, 7}) EXPECT_EQ(functions(threads), one) << threads;
}
