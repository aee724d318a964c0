// Goals that a robot cannot reach are refused, and the message says what it can reach.
#include "ayumi/control/viip_goals.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "ayumi/check/actuator_need.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using test::hoap1;

Pattern with(const ViipGoal& goal, double until = 5) {
  Pattern p;
  p.phases.push_back({0.5, Support::both, {}, CogGoal{}});
  p.phases.push_back({until, Support::both, {}, goal});
  p.controller.type = ControllerKind::viip;
  return p;
}

std::string refusal(const ViipGoal& goal) {
  const Pattern p = with(goal);
  try {
    require_reachable_goals(hoap1(), sample(hoap1(), p), p.controller);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_pattern);
    return error.what();
  }
  return {};
}

TEST(ViipGoals, DisplacementsBeyondFeetOrLegsAreRefused) {
  struct Case {
    Vector3d displacement;
    const char* words;
  };
  for (const Case& c :
       {Case{{0.2, 0, 0}, "151.0 mm outside the support of the feet"},
        Case{{-0.2, 0, 0}, "outside the support of the feet"},
        Case{{0, 0.06, 0},
             "l_ankle_roll is at its limit there. In this direction, a displacement of 0.0, 51"},
        Case{{0, 0, 0.05}, "the legs bring the COG no closer than 28.1 mm"},
        Case{{0, 0, -0.1},
             "at its limit there. In this direction, a displacement of 0.0, 0.0, -66"},
        Case{{0, 0, -5}, "above the ground"},
        Case{{std::numeric_limits<double>::quiet_NaN(), 0, 0}, "not a finite number"}})
    EXPECT_NE(refusal(CogGoal{c.displacement}).find(c.words), std::string::npos)
        << refusal(CogGoal{c.displacement});
}

// A velocity acts from the place to which the goals before it lead, for the duration of its phase.
// Downwards, the 66.4 mm of a displacement are 14.8 mm/s.
TEST(ViipGoals, VelocitiesThatLeadBeyondFeetOrLegsAreRefused) {
  const double time = 4.5;
  const auto refused = [&](const Vector3d& way) { return refusal(CogVelocityGoal{way / time}); };
  EXPECT_EQ(refused({0.04, 0, 0}), "");
  EXPECT_NE(refused({0.06, 0, 0}).find("after 4.500 s the COG would be"), std::string::npos);
  EXPECT_NE(refused({0, 0, -0.1}).find("0.0, 0.0, -14.8 mm/s is possible"), std::string::npos)
      << refused({0, 0, -0.1});
  Pattern p = with(CogGoal{{0.03, 0, 0}}, 2);
  p.phases.push_back({3, Support::both, {}, CogVelocityGoal{{0.01, 0, 0}}});
  require_reachable_goals(hoap1(), sample(hoap1(), p), p.controller);
  p.phases.push_back({4, Support::both, {}, CogVelocityGoal{{0.02, 0, 0}}});
  EXPECT_THROW(require_reachable_goals(hoap1(), sample(hoap1(), p), p.controller), Error);
  p.phases.back().viip = CogVelocityGoal{{-0.07, 0, 0}};
  require_reachable_goals(hoap1(), sample(hoap1(), p), p.controller);
  // The phase is short, but the goal is too fast to stop before the toes.
  Pattern fast = with(CogVelocityGoal{{0.4, 0, 0}}, 0.55);
  try {
    require_reachable_goals(hoap1(), sample(hoap1(), fast), fast.controller);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("could not stop"), std::string::npos) << error.what();
  }
}

TEST(ViipGoals, StepsBeyondTheLegsAreRefused) {
  StepGoal far{6, {0.5, 0}, 0}, turning{6, {0, 0}, 5}, aside{6, {0, 0.3}, 0};
  EXPECT_NE(refusal(far).find("0.369 m/s"), std::string::npos) << refusal(far);
  EXPECT_NE(refusal(turning).find("60.4 deg/s"), std::string::npos) << refusal(turning);
  EXPECT_NE(refusal(aside).find("out of range"), std::string::npos) << refusal(aside);
}

// A goal that is accepted is reached, even at the edge of what is accepted.
TEST(ViipGoals, WhatIsAcceptedIsReached) {
  for (const Vector3d& way : {Vector3d(0.045, 0, 0), Vector3d(-0.044, 0, 0), Vector3d(0, 0.05, 0),
                              Vector3d(0, 0, 0.019), Vector3d(0, 0, -0.064)}) {
    const Pattern p = with(CogGoal{way}, 3);
    ASSERT_EQ(refusal(CogGoal{way}), "") << way.transpose();
    SimulateOptions options;
    options.controller = p.controller;
    options.profile = "hoap1";
    const SimulationLog log = simulate(hoap1(), sample(hoap1(), p), options);
    const Vector3d end = log.samples.back().cog - log.samples.front().cog;
    EXPECT_LT((end - way).norm(), 2e-3) << way.transpose() << " ends at " << end.transpose();
  }
}

TEST(ViipGoals, StepsAreJudgedByAWalkWithKeys) {
  const Pattern p = with(StepGoal{10, {0.1, 0}, 0}, 6);
  const std::vector<KeyedGoal> goals = keyed_goals(hoap1(), sample(hoap1(), p), p.controller);
  ASSERT_EQ(goals.size(), 1u);
  EXPECT_EQ(goals[0].place, "VIIP steps at 0.50 s");
  CheckOptions options;
  options.profile = "hoap1";
  const ActuatorNeed need = actuator_need(hoap1(), goals, options);
  EXPECT_NE(need.text.find("deg/s at"), std::string::npos) << need.text;
  EXPECT_EQ(need.sufficient, (std::vector<std::string>{"hoap1-strong", "hoap1-strong-soft"}));
  options.profile = "hoap1-strong";
  EXPECT_EQ(actuator_need(hoap1(), goals, options).text, "");
}

}  // namespace
}  // namespace ayumi
