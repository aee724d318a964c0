#pragma once
// Patterns with every kind of content, made from a seed.

#include <random>

#include "ayumi/motion/pattern.hpp"
#include "tests/support/degree.hpp"

namespace ayumi::test {

class PatternDice {
 public:
  explicit PatternDice(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
  }
  bool coin() { return engine_() % 2 == 0; }
  int pick(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
  // An angle that the file's unit can hold: any double in rad, or a rounded number in degrees.
  double angle(bool degrees) {
    return degrees ? std::round(uniform(-180, 180) * 1e4) / 1e4 * kDegree : uniform(-3, 3);
  }
  Foothold foothold(bool degrees) {
    Foothold foot;
    foot.position = {uniform(-1, 1), uniform(-1, 1), coin() ? 0 : uniform(-1, 1)};
    if (coin()) foot.rpy.z() = angle(degrees);
    if (coin()) foot.rpy.x() = angle(degrees);
    return foot;
  }

 private:
  std::mt19937 engine_;
};

inline Keyframe random_keyframe(PatternDice& random, bool degrees, double t) {
  Keyframe key;
  key.t = t;
  if (random.coin()) key.interpolation = static_cast<Interpolation>(random.pick(5));
  if (random.coin()) key.posture = "home";
  if (random.coin())
    key.joints = {{"a", random.angle(degrees)}, {"b \"c\"", random.angle(degrees)}};
  if (random.coin()) {
    key.zmp.emplace();
    key.zmp->place = static_cast<ZmpKey::Place>(random.pick(4));
    if (key.zmp->place == ZmpKey::Place::point) key.zmp->point.setConstant(random.uniform(-1, 1));
  }
  if (random.coin()) key.cog_x = random.uniform(-1, 1);
  if (random.coin()) key.cog_height = random.uniform(0, 1);
  if (random.coin()) key.fz = random.uniform(0, 100);
  if (random.coin()) key.torso = Eigen::Vector3d(0, random.angle(degrees), random.angle(degrees));
  if (random.coin()) key.feet[1] = random.foothold(degrees);
  if (random.coin()) key.weights = {{"a", random.uniform(0.1, 9)}};
  return key;
}

inline Push random_push(PatternDice& random) {
  Push push{.kind = static_cast<PushKind>(random.pick(3)), .magnitude = random.uniform(0, 10)};
  push.direction = Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 0.1).normalized();
  push.shape = static_cast<PushShape>(random.pick(2));
  if (random.coin()) {
    push.on = "torso";
    push.frame = PushFrame::link;
    push.point.setConstant(random.uniform(-1, 1));
  }
  return push;
}

inline ViipGoal random_goal(PatternDice& random, bool degrees) {
  switch (random.pick(4)) {
    case 3:
      return CogVelocityGoal{{random.uniform(-1, 1), 0, random.uniform(-1, 1)}};
    case 0:
      return CogGoal{{random.uniform(-1, 1), random.uniform(-1, 1), 0}};
    case 1: {
      StepGoal steps;
      steps.steps = random.pick(3);
      if (random.coin()) steps.velocity = {random.uniform(-1, 1), 0};
      if (random.coin()) steps.turn = random.angle(degrees);
      return steps;
    }
    default: {
      JumpGoal jump{random.uniform(0.01, 1), random.uniform(0.01, 1), 0, 1 + random.pick(3), {}};
      if (random.coin()) jump.forward = random.uniform(-1, 1);
      if (random.coin()) jump.release = JumpGoal::Release::spring;
      return jump;
    }
  }
}

inline Bump random_bump(PatternDice& random) {
  Bump bump{.radius = random.uniform(0.01, 0.1), .height = random.uniform(0, 1)};
  if (random.coin()) bump.foot = Side::right;
  bump.place = {random.uniform(-1, 1), random.uniform(-1, 1)};
  return bump;
}

inline FloorPath random_floor(PatternDice& random, bool degrees) {
  FloorPath path{.shape = static_cast<MotionShape>(random.pick(3))};
  if (path.shape == MotionShape::sine) path.frequency = random.uniform(0.1, 2);
  if (random.coin()) path.tilt.y() = random.angle(degrees) / 4;
  path.shift = {random.uniform(-1, 1), 0, random.uniform(-1, 1)};
  return path;
}

inline Disturbance random_disturbance(PatternDice& random, bool degrees) {
  Disturbance d{.at = random.uniform(0, 3), .duration = random.uniform(0.1, 1)};
  const std::string joint = random.coin() ? "l_knee" : "";
  switch (random.pick(10)) {
    case 0:
      d.what = random_push(random);
      break;
    case 1:
      d.what =
          Payload{"torso", Eigen::Vector3d::Constant(random.uniform(-1, 1)), random.uniform(0, 1)};
      break;
    case 2:
      d.what = random_floor(random, degrees);
      break;
    case 3:
      d.what = FrictionChange{random.uniform(0, 1)};
      break;
    case 4:
      d.what = random_bump(random);
      break;
    case 5:
      d.what = Latency{random.uniform(0, 1)};
      break;
    case 6:
      d.what = SensorBias{
          {random.angle(degrees) / 4, 0}, {0, random.angle(degrees), 0}, random.uniform(0, 1)};
      break;
    case 7:
      d.what = EncoderOffset{joint, random.angle(degrees)};
      break;
    case 8:
      d.what = JointFriction{joint, random.uniform(0, 1), random.uniform(0, 1)};
      break;
    default:
      d.what = GainLoss{joint, random.uniform(0, 1)};
  }
  return d;
}

inline World random_ground(PatternDice& random) {
  World world;
  if (random.coin()) world.height = random.uniform(-0.1, 0.1);
  for (int i = 0; i < random.pick(3); ++i) {
    GroundBlock block;
    block.height = random.uniform(-0.1, 0.1);
    if (random.coin()) {
      block.kind = GroundBlock::Kind::disc;
      block.center = Eigen::Vector2d(random.uniform(-1, 1), random.uniform(-1, 1));
      block.radius = random.uniform(0.01, 1);
    } else {
      block.low = Eigen::Vector2d(random.uniform(-1, 0), random.uniform(-1, 0));
      block.high = Eigen::Vector2d(random.uniform(0.1, 1), random.uniform(0.1, 1));
    }
    world.blocks.push_back(block);
  }
  if (random.coin()) {
    world.patches.push_back({{0, random.uniform(-1, 0)}, {1, 2}, random.uniform(0, 1)});
    world.fields.push_back({{0.1, random.uniform(-1, 1)}, 0.02, Eigen::MatrixXd::Random(3, 2)});
    world.motions.push_back(
        {0.5, 2, {MotionShape::sine, random.uniform(0.1, 1), {0, 0}, {0, 1, 0}}});
  }
  return world;
}

inline Pattern random_pattern(unsigned seed) {
  PatternDice random(seed);
  Pattern p;
  p.degrees = random.coin();
  p.robot = "hoap1";
  if (random.coin()) p.name = "random \xc3\xa9 \\ name";
  if (random.coin()) p.profile = "strong";
  p.interpolation = static_cast<Interpolation>(random.pick(5));
  p.full_model = random.coin();
  if (random.coin()) p.cog_height = random.uniform(0.1, 0.3);
  if (random.coin()) p.start_feet[0] = random.foothold(p.degrees);
  if (random.coin()) p.postures["low"] = {{"l_knee", random.angle(p.degrees)}};
  double t = 0;
  for (int i = 0; i <= random.pick(5); ++i) {
    Phase phase;
    phase.until = t += random.uniform(0.1, 1);
    phase.support = static_cast<Support>(random.pick(4));
    if (random.pick(4) == 0) {
      phase.support = Support::both;
      phase.viip = random_goal(random, p.degrees);
    }
    if (phase.support == Support::left)
      phase.swing = Swing{Side::right, random.foothold(p.degrees), random.uniform(0, 0.1)};
    p.phases.push_back(phase);
  }
  t = 0;
  for (int i = 0; i <= random.pick(8); ++i)
    p.keyframes.push_back(random_keyframe(random, p.degrees, t += random.uniform(0.1, 1)));
  p.world = random_ground(random);
  p.world.friction = random.uniform(0, 2);
  if (random.coin()) p.world.slope.y() = random.angle(p.degrees) / 4;
  if (p.degrees) p.world.slope.y() = std::round(p.world.slope.y() / kDegree) * kDegree;
  if (random.coin()) p.controller.gains = {{"ka", random.uniform(0, 3)}, {"q", 0.25}};
  for (int i = 0; i < random.pick(5); ++i)
    p.scenario.push_back(random_disturbance(random, p.degrees));
  if (random.coin()) p.tolerances["foot_slip"] = random.uniform(0, 1);
  if (random.coin()) {
    p.repair.joints = {"l_knee", "b \"c\""};
    p.repair.feet[1] = random.coin();
    p.repair.keyframes = {random.pick(static_cast<int>(p.keyframes.size()))};
    p.repair.windows = {{0.1, 0.1 + random.uniform(0, 1)}, {0.2, 0.2}};
    p.repair.weights = {{"r_knee", random.uniform(0.1, 20)}};
    if (random.coin()) p.repair.trust = static_cast<Trust>(random.pick(3));
    if (random.coin()) p.repair.margin = random.uniform(0, 0.1);
    if (random.coin()) p.repair.safety = random.uniform(0, 3);
  }
  if (random.coin()) {
    p.correction.emplace();
    p.correction->begin = random.uniform(-1, 1);
    p.correction->spacing = random.uniform(0.01, 0.1);
    p.correction->joints = {"l_knee", "r_knee"};
    p.correction->coefficients.resize(random.pick(4), 8);
    for (double& value : p.correction->coefficients.reshaped()) value = random.uniform(-1, 1);
  }
  return p;
}

}  // namespace ayumi::test
