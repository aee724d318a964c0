// The edge of stability by which gains are judged agrees with the robot's simulation.

#include "ayumi/control/stance_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/control/gain_design.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/hoap1_walk.hpp"
#include "tests/support/walk.hpp"

namespace ayumi {
namespace {

using test::hoap1;

struct Case {
  double latency, tau_z, damp;
};

RobotModel robot_with(double sole) {
  RobotDescription description = hoap1().description();
  for (auto& [link, s] : description.soles) s.stiffness = sole;
  return RobotModel(description);
}

// Whether the rocking that a push of 0.005 N s has left on a standing robot grows.
bool grows(const RobotModel& model, const Case& c, double ka) {
  SimulateOptions options;
  options.settle = 0;
  options.controller.gains = {{"ka", ka}, {"tau_z", c.tau_z}, {"damp", c.damp}};
  options.scenario = {
      {.at = 0, .duration = 10, .what = Latency{c.latency}},
      {.at = 0.2,
       .duration = 0.01,
       .what = Push{.magnitude = 0.005, .direction = Eigen::Vector3d(1, 1, 0).normalized()}}};
  const SimulationLog log = simulate(model, test::standing(model, 3.0), options);
  // The rocking over 20 ms, without the slow return of the COG [m].
  const auto rocking = [&](double begin, double end) {
    double sum = 0;
    for (auto k = std::lround(begin / log.dt); k < std::lround(end / log.dt); ++k) {
      const auto at = static_cast<size_t>(k);
      sum += (log.samples[at].zmp - log.samples[at - 20].zmp).head<2>().squaredNorm();
    }
    return std::sqrt(sum * log.dt / (end - begin));
  };
  constexpr double kHammering = 1e-3;  // a tenth of the largest rocking that the push can cause [m]
  const double later = rocking(2.5, 3.0);
  return later > kHammering || later > rocking(1.5, 2.0);
}

// The cases vary ka, latency, tau_z, damp and the stiffness of the soles. Measured: the difference
// is at most 4 %.
TEST(StanceLoop, AgreesWithSimulationOnTheEdgeOfStability) {
  constexpr double kMost = 7;  // the largest ka that is compared
  int edges = 0;
  for (const double sole : {637400.0, 60000.0}) {
    const RobotModel model = robot_with(sole);
    const double height = test::standing(model, 0).samples[0].cog.z();
    std::vector<LoopModel> loops = stance_loops(model, model.limits(), height, 0.001);
    std::erase_if(loops, [](const LoopModel& loop) { return !loop.both_feet; });
    ASSERT_EQ(loops.size(), 2u);
    for (const double latency : {0.0, 0.004, 0.008, 0.012})
      for (const double tau_z : {0.01, 0.04})
        for (const double damp : {0.0, 8.0}) {
          for (LoopModel& loop : loops) loop.delay = latency;
          DtadParams params;
          params.zmp_filter = tau_z;
          params.rocking_damping = damp;
          const double edge = largest_stable_ka(loops, params, kMost);
          double low = 0, high = kMost;
          for (int i = 0; i < 8 && high - low > 0.02 * edge; ++i) {
            const double middle = i == 0 ? 0.9 * edge : i == 1 ? 1.1 * edge : 0.5 * (low + high);
            if (middle >= kMost) break;
            (grows(model, {latency, tau_z, damp}, middle) ? high : low) = middle;
          }
          SCOPED_TRACE(testing::Message() << sole << " N/m, " << latency << " s, tau_z " << tau_z
                                          << ", damp " << damp);
          if (edge < kMost) ++edges;
          EXPECT_GT(low, 0.88 * edge);
          EXPECT_LT(edge < kMost ? high : edge, 1.12 * edge + 1e-9);
        }
  }
  EXPECT_GE(edges, 16);
}

// The sensors are 8 ms late, and a push of 0.3 N s acts sideways: without the damping, the feet
// hammer.
TEST(StanceLoop, FeetThatHammerAreUnsettled) {
  SimulateOptions options;
  options.scenario = {{.at = 0, .duration = 10, .what = Latency{0.008}},
                      {.at = 0.5,
                       .duration = 0.02,
                       .what = Push{.magnitude = 0.3, .direction = Eigen::Vector3d::UnitY()}}};
  const CommandSeries stand = test::standing(hoap1(), 2.0);
  const SimulationResult rests = simulate(hoap1(), stand, options).result;
  EXPECT_EQ(rests.outcome, Outcome::stands);
  EXPECT_LT(rests.zmp_amplitude, 0.0005);
  options.controller.gains = {{"damp", 0}};
  const SimulationResult hammers = simulate(hoap1(), stand, options).result;
  EXPECT_EQ(hammers.outcome, Outcome::unsettled);
  EXPECT_LT(hammers.final_cog_error, 0.005);
  EXPECT_GT(hammers.zmp_amplitude, 0.030);
  EXPECT_GT(hammers.zmp_frequency, 8);
  EXPECT_LT(hammers.zmp_frequency, 20);
}

// The noise of the sensors alone does not make a robot unsettled.
TEST(StanceLoop, NoiseOfTheSensorsIsNoHammering) {
  SimulateOptions options;
  options.sensor_noise = true;
  const SimulationResult r = simulate(hoap1(), test::standing(hoap1(), 2.0), options).result;
  EXPECT_EQ(r.outcome, Outcome::stands);
  EXPECT_LT(r.zmp_amplitude, 0.003);
}

// This is the effect of the IMU's noise on ankles with stiff servos.
TEST(StanceLoop, WalkingWithNoiseStaysWithinTenMillimetres) {
  SimulateOptions options;
  options.sensor_noise = true;
  for (const unsigned seed : {1u, 2u}) {
    options.seed = seed;
    const SimulationResult r = simulate(hoap1(), test::hoap1_walk(), options).result;
    EXPECT_EQ(r.outcome, Outcome::stands);
    EXPECT_LT(r.zmp_tracking_rms, 0.010);
  }
}

}  // namespace
}  // namespace ayumi
