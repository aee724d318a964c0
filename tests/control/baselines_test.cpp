// The baselines that DTAD is compared with: preview gains, foot-guided control and the program of
// steps, each compared with a closed form or with another computation.
#include <gtest/gtest.h>

#include <limits>

#include "ayumi/base/error.hpp"
#include "ayumi/control/controller.hpp"
#include "ayumi/control/foot_guided.hpp"
#include "ayumi/control/preview_control.hpp"
#include "ayumi/control/step_program.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/dense.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

const CommandSeries& bundled_walk() {
  static const CommandSeries series =
      sample(load_robot(AYUMI_SOURCE_DIR "/robots/hoap1"),
             read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json"));
  return series;
}

// ---- Preview ----

TEST(PreviewControl, GainsSolveTheRiccatiEquation) {
  for (const double tick : {0.004, 0.017})
    for (const double effort : {1e-8, 5e-7, 1e-3}) {
      const PreviewGains g = preview_gains(tick, effort, 6);
      const Eigen::Vector4d PB = g.P * g.B;
      const double size = g.R + g.B.dot(PB);
      const Eigen::Matrix4d residual = g.A.transpose() * g.P * g.A -
                                       g.A.transpose() * PB * PB.transpose() * g.A / size + g.Q -
                                       g.P;
      EXPECT_LT(residual.norm(), 1e-8 * g.P.norm()) << tick << " " << effort;
      // The preview gains sum to the negative gain of the present place, so a shift of all places
      // has no effect.
      EXPECT_NEAR(g.preview.sum(), -g.state[0], 1e-9 * std::abs(g.state[0]));
      EXPECT_NEAR(g.preview[0], -g.integral, 1e-9 * std::abs(g.integral));
    }
}

// If the jerk costs nothing, the regulator mirrors the pendulum's pole at +1, so that the poles are
// -1 and -1.
TEST(PreviewControl, ZmpAnswersTheMeasuredCogAsTheSlowPolesSay) {
  const PreviewGains cheap = preview_gains(1e-3, 1e-9, 5);
  EXPECT_NEAR(cheap.zmp[0], 2, 0.03);
  EXPECT_NEAR(cheap.zmp[1], 2, 0.03);
  // With these gains, the pendulum moves as the regulated table does, after its fast poles have
  // decayed.
  const double tick = 0.005;
  const PreviewGains g = preview_gains(tick, 5e-7, 5);
  Eigen::Vector4d table(0, 1, 0, 0);  // (e, change of the state)
  const Eigen::RowVector4d K = g.B.transpose() * g.P * g.A / (g.R + g.B.dot(g.P * g.B));
  for (int k = 0; k < 200; ++k) table = ((g.A - g.B * K) * table).eval();
  double x = table[1], dx = table[2];
  for (int k = 0; k < 200; ++k) {
    table = ((g.A - g.B * K) * table).eval();
    const double ddx = x - g.zmp[0] * x - g.zmp[1] * dx;
    x += tick * dx;
    dx += tick * ddx;
  }
  EXPECT_NEAR(x, table[1], 0.02 * std::abs(table[1]));
}

// Without an end of the horizon, the last gain contains nothing from beyond it.
TEST(PreviewControl, GainsBeyondTheHorizonVanish) {
  const PreviewGains g = preview_gains(0.01, 5e-7, 30);
  EXPECT_LT(std::abs(g.preview[g.preview.size() - 1]), 1e-9 * g.preview.cwiseAbs().maxCoeff());
}

// Kajita's own values are T = 5 ms, z = 0.814 m, Q = 1, R = 1e-6. The default effort is theirs.
TEST(PreviewControl, DefaultEffortIsTheirsWithoutDimension) {
  const double omega = std::sqrt(kGravity / 0.814), tick = 0.005 * omega;
  EXPECT_NEAR(DtadParams().preview_effort, 1e-6 * elementary::power<6>(omega) * tick * tick, 5e-8);
  EXPECT_NEAR(DtadParams().preview_horizon, 1.6 * omega, 0.1);
}

// The optimal inputs for a step of the ZMP are computed again by least squares over all inputs.
TEST(PreviewControl, FollowsAStepAsTheBestInputsDo) {
  const double tick = 0.1, effort = 1e-3;
  const int steps = 220, step_at = 110;
  const PreviewGains g = preview_gains(tick, effort, 20);
  const auto reference = [&](int k) { return k >= step_at ? 1.0 : 0.0; };
  const auto next = [&](const Vector3d& x, double u) {
    return Vector3d(x[0] + tick * x[1] + 0.5 * tick * tick * x[2] + tick * tick * tick / 6 * u,
                    x[1] + tick * x[2] + 0.5 * tick * tick * u, x[2] + tick * u);
  };
  // The ZMP errors and the weighted changes of the input, whose squares are the cost, are linear in
  // the changes of the input.
  Eigen::MatrixXd response = Eigen::MatrixXd::Zero(2 * steps, steps);
  VectorXd free = VectorXd::Zero(2 * steps);
  for (int k = 1; k <= steps; ++k) free[k - 1] = -reference(k);
  for (int j = 0; j < steps; ++j) {
    Vector3d x = Vector3d::Zero();
    for (int k = 1; k <= steps; ++k) {
      x = next(x, k - 1 >= j ? 1 : 0);
      response(k - 1, j) = x[0] - x[2];
    }
    response(steps + j, j) = std::sqrt(effort) / tick;
  }
  const VectorXd best =
      test::solve_dense(response.transpose() * response, -response.transpose() * free);

  Vector3d x = Vector3d::Zero();
  double sum = 0, u_best = 0, most = 0;
  for (int k = 0; k < 140; ++k) {
    sum += x[0] - x[2] - reference(k);
    double u = -g.integral * sum - g.state.dot(x);
    for (int j = 1; j <= g.preview.size(); ++j) u -= g.preview[j - 1] * reference(k + j);
    u_best += best[k];
    most = std::max(most, std::abs(u));
    // The law would have begun to respond to the step before the first input, so the first ten
    // inputs are not compared.
    if (k >= 10) {
      EXPECT_NEAR(u, u_best, 1e-4) << k;
    }
    x = next(x, u);
  }
  EXPECT_GT(most, 0.1);
}

// ---- Foot-guided ----

TEST(FootGuided, BringsTheDcmBackInExactlyTheTime) {
  const double omega = 6.6, time = 0.4, dt = 1e-5;
  double error = 0.02, least = 1;
  for (int k = 0; k < 40000; ++k) {
    const double left = time - k * dt;
    error += dt * omega * (error - foot_guided_gain(omega, left) * error);
    if (k == 39000) least = error;
  }
  EXPECT_LT(std::abs(least), 1e-3);
  EXPECT_LT(std::abs(error), 1e-6);
}

// Until the DCM has arrived, the ZMP decays as exp(-omega t), the path with the smallest integral
// of its square: no other path that brings the DCM back costs less.
TEST(FootGuided, CostsLeast) {
  const double omega = 6.6, time = 0.4, dt = 1e-4;
  const int n = 4000;
  VectorXd zmp(n);
  double error = 0.02;
  for (int k = 0; k < n; ++k) {
    zmp[k] = foot_guided_gain(omega, time - k * dt) * error;
    error += dt * omega * (error - zmp[k]);
  }
  EXPECT_NEAR(zmp[n / 2] / zmp[0], elementary::exp(-omega * time / 2), 1e-2);
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    VectorXd other(n);
    double effect = 0, weight = 0;
    for (int k = 0; k < n; ++k) {
      other[k] = 0.005 * elementary::sin((trial + 1) * k * dt / time + random.uniform());
      const double w = elementary::exp(-omega * k * dt);
      effect += w * other[k];
      weight += w * w;
    }
    for (int k = 0; k < n; ++k) other[k] -= effect / weight * elementary::exp(-omega * k * dt);
    EXPECT_GT((zmp + other).squaredNorm(), zmp.squaredNorm() * (1 + 1e-6)) << trial;
  }
}

TEST(FootGuided, TimeIsThatToTheNextSupport) {
  const FootGuided guide(bundled_walk(), 1);
  EXPECT_NEAR(guide.time_to_support(0), 1.571, 1e-9);
  EXPECT_NEAR(guide.time_to_support(1120), 0.451, 1e-9);
  EXPECT_NEAR(guide.time_to_support(1570), 0.001, 1e-9);
  EXPECT_GT(guide.time_to_support(1571), 0.4);
  EXPECT_EQ(guide.time_to_support(100000), std::numeric_limits<double>::infinity());
  EXPECT_EQ(guide.gain(100000, 6.6), 2);
  EXPECT_NEAR(guide.gain(1570, 6.6), foot_guided_gain(6.6, 1 / 6.6), 1e-12);  // it is not infinite
}

// ---- Steps ----

StepProblem on_one_foot(const Vector2d& error, double growth) {
  StepProblem p;
  p.error = error;
  p.dcm = {0.06, -0.09};
  p.growth = growth;
  p.share = 0.8;
  p.low = {-0.3, -0.4};
  p.high = {0.3, 0.1};
  p.least_growth = elementary::power(growth, 1 / 2.5);
  p.most_growth = elementary::power(growth, 1 / 0.8);
  set_support(p,
              ConvexPolygon(std::vector<Vector2d>{
                  {-0.04, -0.03}, {0.06, -0.03}, {0.06, 0.03}, {-0.04, 0.03}}),
              0, 0.225, 0.8);
  return p;
}

double cost_of(const StepProblem& p, const StepWeights& w, const Vector2d& move, double growth,
               const Vector2d& taken) {
  const Vector2d offset = growth * (p.error + p.dcm / p.growth) - p.dcm - p.share * move - taken;
  const double time = growth / p.growth - 1;
  return w.place * move.squaredNorm() + w.time * time * time + w.offset * offset.squaredNorm() +
         w.zmp * taken.squaredNorm();
}

bool allowed(const StepProblem& p, const Vector2d& move, double growth, const Vector2d& taken) {
  const double slack = 1e-9;
  if ((move - p.high).maxCoeff() > slack || (p.low - move).maxCoeff() > slack) return false;
  if (growth > p.most_growth + slack || growth < p.least_growth - slack) return false;
  for (int i = 0; i < p.edges; ++i)
    if (p.normal[static_cast<size_t>(i)].dot(taken) >
        (growth - 1) * p.distance[static_cast<size_t>(i)] + slack)
      return false;
  return true;
}

TEST(StepProgram, NothingIsChangedWithoutAnError) {
  const StepChoice c = choose_step(on_one_foot({0, 0}, 8), {});
  EXPECT_LT(c.move.norm(), 1e-12);
  EXPECT_LT(c.taken.norm(), 1e-12);
  EXPECT_NEAR(c.growth, 8, 1e-10);
}

// The equation holds, the chosen values are allowed, and no allowed values near them cost less.
TEST(StepProgram, IsTheBestOfWhatIsAllowed) {
  Random random(5);
  const StepWeights w;
  int limited = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const auto number = [&](double size) { return size * (2 * random.uniform() - 1); };
    const StepProblem p = on_one_foot({number(0.12), number(0.12)}, 1.5 + 10 * random.uniform());
    const StepChoice c = choose_step(p, w);
    EXPECT_TRUE(allowed(p, c.move, c.growth, c.taken)) << trial;
    const Vector2d left =
        c.growth * (p.error + p.dcm / p.growth) - p.dcm - p.share * c.move - c.taken - c.offset;
    EXPECT_LT(left.norm(), 1e-12);
    const double least = cost_of(p, w, c.move, c.growth, c.taken);
    int tried = 0;
    for (int i = 0; i < 2000; ++i) {
      const double size = i % 2 ? 1e-3 : 0.1;
      const Vector2d move = c.move + Vector2d(number(size), number(size));
      const Vector2d taken = c.taken + Vector2d(number(size), number(size));
      const double growth = c.growth * (1 + number(size));
      if (!allowed(p, move, growth, taken)) continue;
      ++tried;
      EXPECT_GE(cost_of(p, w, move, growth, taken), least - 1e-10) << trial;
    }
    EXPECT_GT(tried, 5);
    limited += !allowed(p, 1.001 * c.move, c.growth, 1.001 * c.taken);
  }
  EXPECT_GT(limited, 10);
}

// A push outwards leads to a longer time or a wider step, and a push towards the next foot to a
// shorter step.
TEST(StepProgram, ThePushDecidesPlaceAndTime) {
  const StepChoice towards = choose_step(on_one_foot({0, -0.06}, 6), {});
  EXPECT_LT(towards.growth, 6);
  EXPECT_LT(towards.move.y(), -0.01);
  const StepChoice forward = choose_step(on_one_foot({0.06, 0}, 6), {});
  EXPECT_GT(forward.move.x(), 0.01);
  EXPECT_LT(forward.growth, 6);
}

// ---- Gains ----

TEST(Baselines, RefuseGainsThatTheyDoNotHave) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  const auto message = [&](ControllerKind kind, const char* gain, double value) -> std::string {
    try {
      check_controller(model, {kind, {{gain, value}}});
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(message(ControllerKind::preview, "q", 1).find("preview has no gain 'q'"),
            std::string::npos);
  EXPECT_NE(message(ControllerKind::foot_guided, "k", 2).find("foot-guided has no gain 'k'"),
            std::string::npos);
  EXPECT_NE(message(ControllerKind::dtad, "effort", 1).find("dtad has no gain 'effort'"),
            std::string::npos);
  EXPECT_NE(
      message(ControllerKind::preview, "effort", 0).find("effort is 0; it must be from 1e-9 to 1"),
      std::string::npos);
  EXPECT_NE(message(ControllerKind::dcm_step, "slowest", 2)
                .find("slowest is 2; it must be from 0.1 to 1"),
            std::string::npos);
  EXPECT_EQ(message(ControllerKind::dcm_step, "hurry", 2), "");
  EXPECT_EQ(message(ControllerKind::foot_guided, "soonest", 0.5), "");
}

}  // namespace
}  // namespace ayumi
