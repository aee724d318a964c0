// Hands, links and the gaze are where the keys say, legs and balance stay, and for places that
// cannot be reached the missing distance is reported.
#include "ayumi/plan/link_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <sstream>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/reach.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::hoap1;

const RobotModel& humanoid30() {
  static const RobotModel model = load_robot("humanoid30", {{AYUMI_SOURCE_DIR "/robots"}});
  return model;
}

Pattern standing(double until) {
  Pattern pattern;
  pattern.phases = {{until, Support::both, {}}};
  return pattern;
}

Keyframe& at(Pattern& pattern, double t) {
  for (Keyframe& key : pattern.keyframes)
    if (key.t == t) return key;
  Keyframe key;
  key.t = t;
  key.place.inside = "/keyframes/" + std::to_string(pattern.keyframes.size());
  pattern.keyframes.push_back(key);
  return pattern.keyframes.back();
}

LinkTarget place(const Vector3d& position, LinkTarget::Frame frame = LinkTarget::Frame::world) {
  LinkTarget target;
  target.position = position;
  target.frame = frame;
  return target;
}

const LinkTarget kFree;

struct Hand {
  Vector3d end, along;      // vectors in the world
  Vector3d in_trunk, aims;  // the same vectors in the frame of the trunk
};

Hand hand_at(const RobotModel& model, const RobotState& state, int body) {
  RobotData data(model);
  update_positions(model, state, data);
  const Vector3d point = limb_point(model, body);
  const Eigen::Isometry3d trunk = data.pose(model.trunk_body());
  Hand hand;
  hand.end = data.pose(body) * point;
  hand.along = (data.rotation[static_cast<size_t>(body)] * point).normalized();
  hand.in_trunk = trunk.inverse() * hand.end;
  hand.aims = trunk.linear().transpose() * hand.along;
  return hand;
}

const CommandSample& sample_at(const CommandSeries& series, double t) {
  return series.samples[static_cast<size_t>(std::lround(t / series.dt))];
}

// The hand of a random posture of the arm at some distance from home, with joints well inside their
// limits.
RobotState random_arm(const RobotModel& model, int body, std::mt19937& random, double off = 0.35) {
  RobotState state = model.rest_state();
  std::uniform_real_distribution<double> share(0.5 - off, 0.5 + off);
  for (const int dof : limb_dofs(model, body)) {
    const Dof& joint = model.dofs()[static_cast<size_t>(dof)];
    const double low = std::max(joint.lower, state.theta[dof] - 1),
                 high = std::min(joint.upper, state.theta[dof] + 1);
    state.theta[dof] = low + share(random) * (high - low);
  }
  return state;
}

TEST(LinkPlan, AHandHeldInTheWorldStaysWhileTheBodySways) {
  const RobotModel& model = hoap1();
  const int body = hand_body(model, Side::left);
  std::mt19937 random(7);
  const Vector3d goal = hand_at(model, random_arm(model, body, random, 0.1), body).in_trunk;
  RobotState rest = sample(model,
                           [] {
                             Pattern pattern = standing(1);
                             at(pattern, 0).zmp = ZmpKey{ZmpKey::Place::center};
                             return pattern;
                           }())
                        .samples.front()
                        .state;
  RobotData data(model);
  update_positions(model, rest, data);
  const Vector3d held = data.pose(model.trunk_body()) * goal;

  Pattern pattern = standing(4);
  at(pattern, 0.5).zmp = ZmpKey{ZmpKey::Place::center};
  at(pattern, 1.0).hands["left"] = place(held);
  at(pattern, 1.6).zmp = ZmpKey{ZmpKey::Place::point, {data.cog.x(), 0.010}};
  at(pattern, 2.2).zmp = ZmpKey{ZmpKey::Place::point, {data.cog.x(), -0.010}};
  at(pattern, 2.8).zmp = ZmpKey{ZmpKey::Place::center};
  at(pattern, 3.0).hands["left"] = place(held);
  at(pattern, 3.6).hands["left"] = kFree;
  const CommandSeries series = sample(model, pattern);
  double sway = 0, off = 0, sole = 0, cog = 0, speed = 0, jump = 0;
  const Vector3d trunk = sample_at(series, 1).state.base.position;
  for (size_t k = 1000; k <= 3000; ++k) {
    const RobotState& state = series.samples[k].state;
    off = std::max(off, (hand_at(model, state, body).end - held).norm());
    sway = std::max(sway, (state.base.position - trunk).norm());
  }
  EXPECT_GT(sway, 0.005) << "the test needs a trunk that moves";
  EXPECT_LT(off, 1e-6);
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const CommandSample& now = series.samples[k];
    update_positions(model, now.state, data);
    cog = std::max(cog, (data.cog - now.cog).norm());
    for (const Side side : {Side::left, Side::right})
      sole = std::max(sole, (sole_pose(model, data, side).translation() -
                             now.feet[static_cast<size_t>(side)].translation())
                                .norm());
    speed = std::max(speed, now.acceleration.tail(model.dof_count()).cwiseAbs().maxCoeff());
    if (k > 0)
      jump = std::max(jump, (now.acceleration - series.samples[k - 1].acceleration)
                                .tail(model.dof_count())
                                .cwiseAbs()
                                .maxCoeff());
  }
  EXPECT_LT(sole, 1e-11);
  EXPECT_LT(cog, 1e-11);
  // The motion is smooth where targets take over and end: accelerations are as for minimum jerk
  // over half a second.
  EXPECT_LT(speed, 80);
  EXPECT_LT(jump, 2);
  // Before the hand is led by a target, and after that, the joints have their own angles.
  for (const double t : {0.0, 3.7, 4.0})
    for (const int dof : limb_dofs(model, body))
      EXPECT_NEAR(sample_at(series, t).state.theta[dof], model.rest_state().theta[dof], 1e-12);
}

TEST(LinkPlan, RandomPlacesAndDirectionsAreMet) {
  const RobotModel& model = humanoid30();
  std::mt19937 random(3);
  for (int round = 0; round < 12; ++round) {
    const Side side = round % 2 == 0 ? Side::left : Side::right;
    const int body = hand_body(model, side);
    ASSERT_GE(body, 0);
    const Hand goal = hand_at(model, random_arm(model, body, random), body);
    Pattern pattern = standing(1.6);
    LinkTarget target = place(goal.in_trunk, LinkTarget::Frame::trunk);
    target.direction = goal.aims;
    at(pattern, 0).zmp = ZmpKey{ZmpKey::Place::center};
    at(pattern, 1).hands[name_of(side)] = target;
    const CommandSeries series = sample(model, pattern, {.dt = 0.005});
    const Hand reached = hand_at(model, sample_at(series, 1).state, body);
    EXPECT_LT((reached.in_trunk - goal.in_trunk).norm(), 1e-6);
    EXPECT_LT(std::acos(std::min(1.0, reached.aims.dot(goal.aims))), 1e-3);
  }
}

// Among the nearby postures that put the hand at its target, none is nearer to the keys: every
// motion towards the keys moves the hand.
TEST(LinkPlan, TheElbowGoesWhereTheKeysAskFor) {
  const RobotModel& model = humanoid30();
  const int body = hand_body(model, Side::right);
  std::mt19937 random(11);
  const Hand goal = hand_at(model, random_arm(model, body, random), body);
  Pattern pattern = standing(1.6);
  at(pattern, 0).zmp = ZmpKey{ZmpKey::Place::center};
  at(pattern, 1).hands["right"] = place(goal.in_trunk, LinkTarget::Frame::trunk);
  const RobotState state = sample_at(sample(model, pattern, {.dt = 0.005}), 1).state;
  RobotData data(model);
  update_positions(model, state, data);
  const Vector3d end = data.pose(body) * limb_point(model, body);
  const std::vector<int> dofs = limb_dofs(model, body);
  Eigen::MatrixXd jacobian(3, static_cast<Eigen::Index>(dofs.size()));
  VectorXd way(static_cast<Eigen::Index>(dofs.size()));
  const Eigen::MatrixXd whole = body_jacobian(model, data, body, end);
  for (size_t i = 0; i < dofs.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    jacobian.col(column) = whole.block<3, 1>(0, 6 + dofs[i]);
    way[column] = model.rest_state().theta[dofs[i]] - state.theta[dofs[i]];
  }
  const VectorXd along = test::solve_dense(jacobian * jacobian.transpose(), jacobian * way);
  const VectorXd still = way - jacobian.transpose() * along;
  EXPECT_GT(way.norm(), 0.1);
  EXPECT_LT(still.norm(), 1e-5 * way.norm());
}

TEST(LinkPlan, TheHeadLooksAtThePoint) {
  const RobotModel& model = humanoid30();
  const int head = head_body(model);
  ASSERT_GE(head, 0);
  const Vector3d seen(2, 0.6, 0.7);
  Pattern pattern = standing(1.6);
  at(pattern, 0).zmp = ZmpKey{ZmpKey::Place::center};
  at(pattern, 1).gaze = place(seen);
  const CommandSeries series = sample(model, pattern, {.dt = 0.005});
  RobotData data(model);
  for (const double t : {1.0, 1.6}) {
    update_positions(model, sample_at(series, t).state, data);
    const Vector3d eye = data.pose(head) * model.bodies()[static_cast<size_t>(head)].inertia.com;
    EXPECT_GT(data.rotation[static_cast<size_t>(head)].col(0).dot((seen - eye).normalized()),
              1 - 1e-9);
  }
  pattern.keyframes.back().gaze = place({-2, 0.8, 0.6});
  EXPECT_NE(test::error_message([&] { sample(model, pattern); }, ErrorCode::bad_pattern)
                .find("the gaze misses its point by "),
            std::string::npos);
  pattern.keyframes.back().gaze = place(seen);
  EXPECT_NE(test::error_message([&] { sample(hoap1(), pattern); }, ErrorCode::bad_pattern)
                .find("has no neck"),
            std::string::npos);
}

TEST(LinkPlan, APlaceInMillimetresIsNamed) {
  for (const auto& [factor, words] :
       {std::pair(1e3, "these numbers in mm are [0.1500, 0.2000, 0.3000] m"),
        std::pair(1e2, "these numbers in cm are [0.1500, 0.2000, 0.3000] m"), std::pair(3.0, "")}) {
    Pattern pattern = standing(2);
    at(pattern, 0).zmp = ZmpKey{ZmpKey::Place::center};
    at(pattern, 1).hands["left"] = place(factor * Vector3d(0.15, 0.2, 0.3));
    const std::string message =
        test::error_message([&] { sample(hoap1(), pattern); }, ErrorCode::bad_pattern);
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_EQ(message.find("in metres") != std::string::npos, factor > 10) << message;
  }
}

// One wrong number among three in metres says nothing about the unit.
TEST(LinkPlan, APlaceWithOneSlipIsInMetres) {
  Pattern pattern = standing(2);
  at(pattern, 0).zmp = ZmpKey{ZmpKey::Place::center};
  at(pattern, 1).hands["left"] = place({0.15, 20, 0.3});
  const std::string message =
      test::error_message([&] { sample(hoap1(), pattern); }, ErrorCode::bad_pattern);
  EXPECT_EQ(message.find("in metres"), std::string::npos) << message;
}

TEST(LinkPlan, SaysByHowMuchAHandIsOutOfReach) {
  const RobotModel& model = hoap1();
  const int body = hand_body(model, Side::left);
  // The target is 100 mm beyond the end of the stretched arm, in its direction. Of all places that
  // the hand reaches, this end is the nearest one.
  RobotState state = model.rest_state();
  for (const int dof : limb_dofs(model, body)) state.theta[dof] = 0;
  const Hand straight = hand_at(model, state, body);
  RobotData data(model);
  update_positions(model, state, data);
  const int shoulder = model.dofs()[static_cast<size_t>(limb_dofs(model, body).back())].body;
  const Vector3d socket = data.pose(model.trunk_body()).inverse() *
                          (data.base_position + data.position[static_cast<size_t>(shoulder)]);
  const Vector3d far = straight.in_trunk + 0.1 * (straight.in_trunk - socket).normalized();
  Pattern pattern = standing(2);
  at(pattern, 0).zmp = ZmpKey{ZmpKey::Place::center};
  at(pattern, 1).hands["left"] = place(far, LinkTarget::Frame::trunk);
  const std::string message =
      test::error_message([&] { sample(model, pattern); }, ErrorCode::bad_pattern);
  EXPECT_NE(message.find("keyframes/1/hands/left: t = 1.000 s: the left hand is out of reach by "),
            std::string::npos)
      << message;
  const size_t at_mm = message.find("reach by ") + 9;
  const double missing = std::stod(message.substr(at_mm));
  EXPECT_NEAR(missing, 100, 12) << message;
  EXPECT_NE(message.find("in the frame of the trunk. Move the target"), std::string::npos);
}

// Places around the trunk that the arm cannot reach, with joints at their limits. A random search
// among the postures of the arm finds none that puts the hand nearer than the message says.
TEST(LinkPlan, AHandComesAsNearToAPlaceOutOfReachAsItsJointsAllow) {
  const RobotModel& model = hoap1();
  const int body = hand_body(model, Side::left);
  const std::vector<int> dofs = limb_dofs(model, body);
  std::mt19937 random(23);
  int out_of_reach = 0;
  for (int round = 0; round < 24; ++round) {
    std::uniform_real_distribution<double> forward(-0.1, 0.2), left(-0.15, 0.25), up(-0.1, 0.25);
    const Vector3d goal{forward(random), left(random), up(random)};
    Pattern pattern = standing(2);
    at(pattern, 0).zmp = ZmpKey{ZmpKey::Place::center};
    at(pattern, 1).hands["left"] = place(goal, LinkTarget::Frame::trunk);
    std::string message;
    try {
      sample(model, pattern, {.dt = 0.01});
    } catch (const Error& error) {
      message = error.what();
    }
    const size_t found = message.find("t = 1.000 s: the left hand is out of reach by ");
    if (found == std::string::npos) continue;
    ++out_of_reach;
    const double said = 1e-3 * std::stod(message.substr(message.find("reach by ", found) + 9));
    Vector3d there;
    ASSERT_EQ(std::sscanf(message.c_str() + message.find("reaches only "),
                          "reaches only [%lf, %lf, %lf] m", &there.x(), &there.y(), &there.z()),
              3);
    EXPECT_NEAR((there - goal).norm(), said, 2e-4) << message;
    double nearest = 1;
    for (int start = 0; start < 4; ++start) {
      RobotState best = random_arm(model, body, random, 0.5);
      double distance = (hand_at(model, best, body).in_trunk - goal).norm();
      std::normal_distribution<double> change(0, 1);
      for (double width = 0.6; width > 1e-3; width *= 0.97)
        for (int trial = 0; trial < 4; ++trial) {
          RobotState tried = best;
          for (const int dof : dofs) {
            const Dof& joint = model.dofs()[static_cast<size_t>(dof)];
            tried.theta[dof] =
                std::clamp(tried.theta[dof] + width * change(random), joint.lower, joint.upper);
          }
          const double there = (hand_at(model, tried, body).in_trunk - goal).norm();
          if (there < distance) {
            distance = there;
            best = tried;
          }
        }
      nearest = std::min(nearest, distance);
    }
    EXPECT_LT(said, nearest + 1e-3) << "a random search comes nearer: " << message;
  }
  EXPECT_GT(out_of_reach, 8);
}

// The arm is in a posture from which it does not get behind the shoulder. With keys as the message
// says, it does.
TEST(LinkPlan, APostureThatReachesAPlaceIsNamed) {
  const RobotModel& model = hoap1();
  for (const Vector3d& goal :
       {Vector3d(-0.0616955, 0.172911, 0.0458812), Vector3d(-0.0647665, 0.153419, 0.0372672),
        Vector3d(-0.125848, 0.190526, 0.0537284)}) {
    Pattern pattern = standing(2);
    at(pattern, 0).zmp = ZmpKey{ZmpKey::Place::center};
    at(pattern, 1).hands["left"] = place(goal, LinkTarget::Frame::trunk);
    const std::string message =
        test::error_message([&] { sample(model, pattern, {.dt = 0.01}); }, ErrorCode::bad_pattern);
    const std::string words =
        "the left hand cannot reach this place from the posture before this time."
        " These angles reach the place: ";
    const size_t found = message.find(words), time = message.find("t = ");
    ASSERT_NE(found, std::string::npos) << message;
    Keyframe& key = at(pattern, std::stod(message.substr(time + 4)));
    std::istringstream angles(message.substr(found + words.size()));
    std::string joint, unit;
    double angle = 0;
    do {
      ASSERT_TRUE(angles >> joint >> angle >> unit) << message;
      key.joints[joint] = angle * M_PI / 180;
    } while (unit == "deg,");
    std::swap(pattern.keyframes[1], pattern.keyframes[2]);
    EXPECT_NO_THROW(sample(model, pattern, {.dt = 0.01})) << message;
  }
}

// On the way to a key in the world, the trunk may be elsewhere than at the time of the key. A
// target that is only within reach of the bent trunk is not reported as far out of reach.
TEST(LinkPlan, DoesNotMeasureTheReachOfATrunkThatIsOnItsWay) {
  const auto bow = [](double bent, double set_out) {
    Pattern pattern = standing(4);
    at(pattern, 0).torso = Vector3d::Zero();
    at(pattern, 0).zmp = ZmpKey{ZmpKey::Place::center};
    at(pattern, bent).torso = Vector3d(0, 35 * M_PI / 180, 0);
    if (set_out > 0) at(pattern, set_out).hands["right"] = LinkTarget{};
    at(pattern, 3).torso = Vector3d(0, 35 * M_PI / 180, 0);
    return pattern;
  };
  // This is the place of the hand when the arm hangs from the bent trunk.
  Pattern hangs = bow(2, 0);
  at(hangs, 2).joints = {{"r_shoulder_pitch", 0.96}, {"r_elbow", -0.1}};
  at(hangs, 3).joints = {{"r_shoulder_pitch", 0.96}, {"r_elbow", -0.1}};
  const auto in_order = [](Pattern pattern) {
    std::sort(pattern.keyframes.begin(), pattern.keyframes.end(),
              [](const Keyframe& a, const Keyframe& b) { return a.t < b.t; });
    return pattern;
  };
  const CommandSeries bent = sample(hoap1(), in_order(hangs));
  const int body = hand_body(hoap1(), Side::right);
  // A quick bow moves the trunk by a few millimetres more.
  const Vector3d end =
      hand_at(hoap1(), sample_at(bent, 2.5).state, body).end + Vector3d(-0.005, 0, 0.005);
  const auto error_of = [&](const Pattern& pattern) {
    return test::error_message([&] { sample(hoap1(), in_order(pattern)); }, ErrorCode::bad_pattern);
  };
  // The hand is near its target before the trunk bends. The pattern is refused only because the
  // hand cannot follow its path before the key.
  Pattern early = bow(2.9, 0);
  at(early, 2.2).torso = Vector3d::Zero();
  at(early, 0.2).hands["right"] = LinkTarget{};
  Pattern too_early = early;
  at(early, 3).hands["right"] = place(end);
  const std::string message = error_of(early);
  EXPECT_NE(message.find("on the way to this key: the right hand is out of reach by "),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("The trunk also moves at this time"), std::string::npos) << message;
  // The hand should be there before the trunk bends: the place is out of reach at the key itself.
  at(too_early, 1.5).hands["right"] = place(end);
  const std::string at_key = error_of(too_early);
  EXPECT_NE(at_key.find("/hands/right: t = 1.500 s: the right hand is out of reach by "),
            std::string::npos)
      << at_key;
  EXPECT_NE(at_key.find(". Move the target, or move or tilt the trunk"), std::string::npos)
      << at_key;
  // If the trunk is bent first, the same place is reached.
  Pattern late = bow(1.5, 1.5);
  at(late, 3).hands["right"] = place(end);
  EXPECT_NO_THROW(sample(hoap1(), in_order(late)));
}

TEST(LinkPlan, RefusesLinksThatItCannotMove) {
  const RobotModel& model = hoap1();
  const auto said = [&](const std::string& link) {
    Pattern pattern = standing(2);
    at(pattern, 1).hands[link] = place({0.1, 0.1, 0.3});
    return test::error_message([&] { sample(model, pattern); }, ErrorCode::bad_pattern);
  };
  EXPECT_NE(said("l_shank").find("the legs move this link"), std::string::npos);
  EXPECT_NE(said("torso").find("no joint moves this link alone"), std::string::npos);
  EXPECT_NE(said("l_forarm").find("did you mean 'l_forearm'?"), std::string::npos);
}

TEST(LinkPlan, MirroredTargetsMoveTheMirroredArm) {
  const RobotModel& model = hoap1();
  std::mt19937 random(5);
  const int left = hand_body(model, Side::left), right = hand_body(model, Side::right);
  const Vector3d goal = hand_at(model, random_arm(model, left, random), left).in_trunk;
  Pattern pattern = standing(2);
  at(pattern, 0).zmp = ZmpKey{ZmpKey::Place::center};
  at(pattern, 1).hands["l_forearm"] = place(goal, LinkTarget::Frame::trunk);
  const CommandSeries one = sample(model, pattern, {.dt = 0.005}),
                      other = sample(model, mirrored(model, pattern), {.dt = 0.005});
  for (size_t k = 0; k < one.samples.size(); k += 20) {
    const Vector3d a = hand_at(model, one.samples[k].state, left).end,
                   b = hand_at(model, other.samples[k].state, right).end;
    EXPECT_LT((a - Vector3d(b.x(), -b.y(), b.z())).norm(), 1e-6);
  }
}

// After a hand was released, its joints follow their keys in each pass that solves the COG for the
// ZMP: the ZMP of the full model is the commanded one.
TEST(LinkPlan, TheZmpIsCommandedBesideAHandThatIsReleased) {
  const RobotModel& model = humanoid30();
  Pattern pattern = standing(6);
  at(pattern, 0).posture = "home";
  at(pattern, 1).hands["left"] = kFree;
  at(pattern, 2).hands["left"] = place({0.28, 0.25, 0.7});
  at(pattern, 3).hands["left"] = place({0.3, 0.2, 0.75});
  at(pattern, 3.5).hands["left"] = kFree;
  const CommandSeries series = sample(model, pattern);
  RobotData data(model);
  double off = 0;
  for (const CommandSample& now : series.samples)
    off = std::max(off, (full_model_reaction(model, now, data).zmp - now.zmp).norm());
  EXPECT_LT(off, 5e-4);
}

// Keys of the legs move the base, and the hand is held nevertheless.
TEST(LinkPlan, AHandIsHeldWhileKeysMoveTheLegs) {
  const RobotModel& model = hoap1();
  const int body = hand_body(model, Side::right);
  std::mt19937 random(9);
  Pattern pattern = standing(2);
  at(pattern, 0).joints["l_knee"] = model.rest_state().theta[model.find_dof("l_knee")];
  const RobotState rest = sample(model, pattern).samples.front().state;
  RobotState arm = random_arm(model, body, random);
  arm.base = rest.base;
  const Vector3d held = hand_at(model, arm, body).end;
  at(pattern, 0.5).hands["right"] = place(held);
  for (const char* const leg : {"l_", "r_"}) {
    const std::string side = leg;
    at(pattern, 1).joints[side + "ankle_pitch"] =
        model.rest_state().theta[model.find_dof(side + "ankle_pitch")] + 0.03;
  }
  const CommandSeries series = sample(model, pattern);
  EXPECT_GT((series.samples.back().state.base.position - rest.base.position).norm(), 1e-3);
  for (size_t k = 500; k < series.samples.size(); k += 50)
    EXPECT_LT((hand_at(model, series.samples[k].state, body).end - held).norm(), 1e-6);
}

}  // namespace
}  // namespace ayumi
