// Once an inner loop has solved its largest problem, it allocates no more memory. Every call of
// malloc in this program is counted; operator new and Eigen also call malloc.

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "ayumi/control/estimator.hpp"
#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/tree_dynamics.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "ayumi/sim/sensors.hpp"
#include "ayumi/sim/simulator.hpp"
#include "tests/support/one_joint.hpp"
#include "tests/support/random_robot.hpp"

namespace {
bool counting = false;
long allocations = 0;
}  // namespace

// The address sanitizer has a malloc of its own, which must not be replaced.
#ifndef __SANITIZE_ADDRESS__
extern "C" void* __libc_malloc(size_t);
extern "C" void* __libc_realloc(void*, size_t);

extern "C" void* malloc(size_t size) {
  if (counting) ++allocations;
  return __libc_malloc(size);
}
extern "C" void* realloc(void* p, size_t size) {
  if (counting) ++allocations;
  return __libc_realloc(p, size);
}
#endif

namespace ayumi {
namespace {

using Eigen::VectorXd;

class Allocations : public testing::Test {
#ifdef __SANITIZE_ADDRESS__
  void SetUp() override { GTEST_SKIP() << "allocations cannot be counted under this sanitizer"; }
#endif
};

/// The number of allocations during a call; operator new goes through malloc as well.
template <typename Call>
long allocations_of(const Call& call) {
  allocations = 0;
  counting = true;
  call();
  counting = false;
  return allocations;
}

TEST_F(Allocations, AreCounted) {
  EXPECT_GE(allocations_of([] { VectorXd::Zero(100).eval(); }), 1);
  EXPECT_GE(allocations_of([] { ::operator delete(::operator new(100)); }), 1);
}

TEST_F(Allocations, PlantSensorsAndEstimatorHaveNoneAfterTheFirstSteps) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  CommandSeries series = sample(model, read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json"));
  series.samples.resize(3000);
  const CommandSample& first = series.samples.front();
  Plant plant(model, model.limits(), World{});
  Sensors sensors(model, model.limits(), series.dt, true, 1);
  Estimator estimator(model, series.dt);
  plant.set_state(first.state);
  const StepInput push = {{-1, {}, {1, 0, 0}, {}}};
  const auto step = [&](const CommandSample& s) {
    const StepReport& report = plant.step(s.state.theta, push, series.dt);
    estimator.update(sensors.read(plant.state(), plant.data(), report), s.feet);
  };
  for (const CommandSample& s : series.samples) step(s);
  plant.set_state(first.state);
  EXPECT_EQ(allocations_of([&] {
              for (const CommandSample& s : series.samples) step(s);
            }),
            0);
}

TEST_F(Allocations, AStepWithEveryFormOfServoHasNoneAfterTheFirstSteps) {
  RobotDescription d = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1").description();
  for (auto& [joint, servo] : d.servos) servo = test::servo_forms().back().servo;
  const RobotModel model(d);
  const RobotState start = model.rest_state();
  Plant plant(model, model.limits(), World{});
  plant.set_state(start);
  const StepInput nothing;
  VectorXd target = start.theta;
  const auto steps = [&] {
    for (int k = 0; k < 1000; ++k) {
      target[0] = start.theta[0] + test::sine(1e-3 * k);
      plant.step(target, nothing, 1e-3);
    }
  };
  steps();
  plant.set_state(start);
  EXPECT_EQ(allocations_of(steps), 0);
}

TEST_F(Allocations, ATickOfTheClosedLoopHasNoneAfterTheFirstSteps) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  const Pattern pattern = read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json");
  const CommandSeries series = sample(model, pattern);
  for (const ControllerKind controller : {ControllerKind::dtad, ControllerKind::none}) {
    SimulateOptions options;
    options.controller.type = controller;
    options.sensor_noise = true;
    Simulator simulator(model, series, options);
    simulator.keep_samples(false);  // the log itself grows
    simulator.advance(2000);        // after two steps, both kinds of support have occurred
    for (int i = 0; i < 10; ++i)
      EXPECT_EQ(allocations_of([&] { simulator.advance(200); }), 0)
          << name_of(controller) << " from " << simulator.time() - 0.2 << " s";
    simulator.gather_verdict_only();
    EXPECT_EQ(allocations_of([&] { simulator.advance(200); }), 0) << name_of(controller);
  }
}

// Footholds move from 3 s on, under the pattern's push and further pushes.
TEST_F(Allocations, ATickThatMovesFootholdsHasNoneAfterTheFirstSteps) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  const Pattern pattern = read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json");
  const CommandSeries series = sample(model, pattern);
  SimulateOptions options;
  options.controller = {ControllerKind::dtad, {{"step", 1}}};
  options.profile = "hoap1-strong";
  options.scenario = pattern.scenario;
  options.scenario.front().what = Push{.magnitude = 2.8, .direction = {1, 0, 0}};
  Simulator simulator(model, series, options);
  simulator.keep_samples(false);
  simulator.advance(3700);  // joints at their limits have been logged
  EXPECT_EQ(allocations_of([&] { simulator.advance(900); }), 0);
  EXPECT_FALSE(simulator.fell());
  EXPECT_GT((simulator.plan().feet[0].translation() - simulator.command(4600).feet[0].translation())
                .norm(),
            0.01);
}

TEST_F(Allocations, DynamicsHaveNoneWithTheirWorkspace) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  RobotData data(model);
  const RobotState state = model.rest_state();
  const VectorXd zero = VectorXd::Zero(model.velocity_count());
  VectorXd force = zero;
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(zero.size(), zero.size());
  TreeCholesky factor(model);
  EXPECT_EQ(allocations_of([&] {
              update_velocities(model, state, data);
              newton_euler(model, state, zero, data, force);
              mass_matrix(model, data, M);
              factor.factor(M);
              factor.solve(force);
            }),
            0);
}

TEST_F(Allocations, ForwardDynamicsAndDerivativesHaveNoneAfterTheFirstCall) {
  for (const bool mimic : {false, true}) {
    const RobotModel model(test::random_tree(3, 16, mimic));
    ASSERT_EQ(mimic, static_cast<int>(model.bodies().size()) != model.dof_count() + 1);
    RobotData data(model);
    const RobotState state = model.rest_state();
    const JointDrive drive = joint_drive(model.limits());
    const VectorXd force = VectorXd::Ones(model.velocity_count());
    VectorXd acceleration;
    InverseDynamicsDerivatives inverse;
    ForwardDynamicsDerivatives forward;
    Eigen::MatrixXd J;
    Eigen::MatrixXd M;
    TreeDynamics fast(model);
    const auto work = [&] {
      fast.inverse(state, force, acceleration);
      fast.forward(state, force, acceleration, &drive);
      fast.mass_matrix(state, M);
      fast.inverse_derivatives(state, acceleration, inverse);
      fast.forward_derivatives(state, force, forward, &drive);
      update_positions(model, state, data);
      held_base_cog_jacobian(model, data, J);
    };
    work();
    EXPECT_EQ(allocations_of(work), 0);
  }
}

}  // namespace
}  // namespace ayumi
