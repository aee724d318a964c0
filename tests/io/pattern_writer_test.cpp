#include "tests/io/pattern_texts.hpp"
#include "tests/support/random_pattern.hpp"

namespace ayumi::test {
namespace {

class PatternWriter : public PatternFolder {};

void expect_same(const std::optional<Foothold>& a, const std::optional<Foothold>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  EXPECT_EQ(a->position, b->position);
  EXPECT_EQ(a->rpy, b->rpy);
}

void expect_same(const Keyframe& a, const Keyframe& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.interpolation, b.interpolation);
  EXPECT_EQ(a.posture, b.posture);
  EXPECT_EQ(a.joints, b.joints);
  ASSERT_EQ(a.zmp.has_value(), b.zmp.has_value());
  if (a.zmp) {
    EXPECT_EQ(a.zmp->place, b.zmp->place);
    EXPECT_EQ(a.zmp->point, b.zmp->point);
  }
  EXPECT_EQ(a.cog_x, b.cog_x);
  EXPECT_EQ(a.cog_y, b.cog_y);
  EXPECT_EQ(a.cog_height, b.cog_height);
  EXPECT_EQ(a.fz, b.fz);
  EXPECT_EQ(a.torso, b.torso);
  expect_same(a.feet[0], b.feet[0]);
  expect_same(a.feet[1], b.feet[1]);
  EXPECT_EQ(a.weights, b.weights);
}

void expect_same(const FloorPath& a, const FloorPath& b) {
  EXPECT_EQ(a.shape, b.shape);
  EXPECT_EQ(a.frequency, b.frequency);
  EXPECT_EQ(a.tilt, b.tilt);
  EXPECT_EQ(a.shift, b.shift);
}

void expect_same(const FloorMotion& a, const FloorMotion& b) {
  EXPECT_EQ(a.at, b.at);
  EXPECT_EQ(a.duration, b.duration);
  expect_same(a.path, b.path);
}

void expect_same(const Push& a, const Push& b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.magnitude, b.magnitude);
  EXPECT_EQ(a.on, b.on);
  EXPECT_EQ(a.point, b.point);
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(a.direction, b.direction);
  EXPECT_EQ(a.shape, b.shape);
}

void expect_same(const Payload& a, const Payload& b) {
  EXPECT_EQ(a.on, b.on);
  EXPECT_EQ(a.point, b.point);
  EXPECT_EQ(a.mass, b.mass);
}

void expect_same(const FrictionChange& a, const FrictionChange& b) {
  EXPECT_EQ(a.friction, b.friction);
}

void expect_same(const Bump& a, const Bump& b) {
  EXPECT_EQ(a.foot, b.foot);
  EXPECT_EQ(a.place, b.place);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.height, b.height);
}

void expect_same(const Latency& a, const Latency& b) { EXPECT_EQ(a.latency, b.latency); }

void expect_same(const SensorBias& a, const SensorBias& b) {
  EXPECT_EQ(a.tilt, b.tilt);
  EXPECT_EQ(a.gyro, b.gyro);
  EXPECT_EQ(a.load, b.load);
}

void expect_same(const EncoderOffset& a, const EncoderOffset& b) {
  EXPECT_EQ(a.joint, b.joint);
  EXPECT_EQ(a.offset, b.offset);
}

void expect_same(const JointFriction& a, const JointFriction& b) {
  EXPECT_EQ(a.joint, b.joint);
  EXPECT_EQ(a.coulomb, b.coulomb);
  EXPECT_EQ(a.viscous, b.viscous);
}

void expect_same(const GainLoss& a, const GainLoss& b) {
  EXPECT_EQ(a.joint, b.joint);
  EXPECT_EQ(a.share, b.share);
}

void expect_same(const Disturbance& a, const Disturbance& b) {
  EXPECT_EQ(a.at, b.at);
  EXPECT_EQ(a.duration, b.duration);
  ASSERT_EQ(a.what.index(), b.what.index());
  std::visit(
      [&](const auto& what) { expect_same(what, std::get<std::decay_t<decltype(what)>>(b.what)); },
      a.what);
}

void expect_same(const World& a, const World& b) {
  EXPECT_EQ(a.friction, b.friction);
  EXPECT_EQ(a.slope, b.slope);
  EXPECT_EQ(a.height, b.height);
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (size_t i = 0; i < a.blocks.size(); ++i) {
    EXPECT_EQ(a.blocks[i].kind, b.blocks[i].kind);
    EXPECT_EQ(a.blocks[i].low, b.blocks[i].low);
    EXPECT_EQ(a.blocks[i].high, b.blocks[i].high);
    EXPECT_EQ(a.blocks[i].center, b.blocks[i].center);
    EXPECT_EQ(a.blocks[i].radius, b.blocks[i].radius);
    EXPECT_EQ(a.blocks[i].height, b.blocks[i].height);
  }
  ASSERT_EQ(a.patches.size(), b.patches.size());
  for (size_t i = 0; i < a.patches.size(); ++i) {
    EXPECT_EQ(a.patches[i].low, b.patches[i].low);
    EXPECT_EQ(a.patches[i].high, b.patches[i].high);
    EXPECT_EQ(a.patches[i].friction, b.patches[i].friction);
  }
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (size_t i = 0; i < a.fields.size(); ++i) {
    EXPECT_EQ(a.fields[i].origin, b.fields[i].origin);
    EXPECT_EQ(a.fields[i].spacing, b.fields[i].spacing);
    EXPECT_EQ(a.fields[i].heights, b.fields[i].heights);
  }
  ASSERT_EQ(a.motions.size(), b.motions.size());
  for (size_t i = 0; i < a.motions.size(); ++i) expect_same(a.motions[i], b.motions[i]);
}

void expect_same(const ViipGoal& a, const ViipGoal& b) {
  ASSERT_EQ(a.index(), b.index());
  if (const auto* cog = std::get_if<CogGoal>(&a)) {
    EXPECT_EQ(cog->displacement, std::get<CogGoal>(b).displacement);
  } else if (const auto* moving = std::get_if<CogVelocityGoal>(&a)) {
    EXPECT_EQ(moving->velocity, std::get<CogVelocityGoal>(b).velocity);
  } else if (const auto* steps = std::get_if<StepGoal>(&a)) {
    EXPECT_EQ(steps->steps, std::get<StepGoal>(b).steps);
    EXPECT_EQ(steps->velocity, std::get<StepGoal>(b).velocity);
    EXPECT_EQ(steps->turn, std::get<StepGoal>(b).turn);
  } else {
    const JumpGoal &x = std::get<JumpGoal>(a), &y = std::get<JumpGoal>(b);
    EXPECT_EQ(x.height, y.height);
    EXPECT_EQ(x.stoop, y.stoop);
    EXPECT_EQ(x.forward, y.forward);
    EXPECT_EQ(x.times, y.times);
    EXPECT_EQ(x.release, y.release);
  }
}

void expect_same(const Pattern& a, const Pattern& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.robot, b.robot);
  EXPECT_EQ(a.profile, b.profile);
  EXPECT_EQ(a.degrees, b.degrees);
  EXPECT_EQ(a.interpolation, b.interpolation);
  EXPECT_EQ(a.default_posture, b.default_posture);
  EXPECT_EQ(a.full_model, b.full_model);
  EXPECT_EQ(a.cog_height, b.cog_height);
  expect_same(a.start_feet[0], b.start_feet[0]);
  expect_same(a.start_feet[1], b.start_feet[1]);
  EXPECT_EQ(a.postures, b.postures);
  ASSERT_EQ(a.phases.size(), b.phases.size());
  for (size_t i = 0; i < a.phases.size(); ++i) {
    EXPECT_EQ(a.phases[i].until, b.phases[i].until);
    EXPECT_EQ(a.phases[i].support, b.phases[i].support);
    ASSERT_EQ(a.phases[i].viip.has_value(), b.phases[i].viip.has_value());
    if (a.phases[i].viip) expect_same(*a.phases[i].viip, *b.phases[i].viip);
    ASSERT_EQ(a.phases[i].swing.has_value(), b.phases[i].swing.has_value());
    if (!a.phases[i].swing) continue;
    EXPECT_EQ(a.phases[i].swing->foot, b.phases[i].swing->foot);
    expect_same(a.phases[i].swing->to, b.phases[i].swing->to);
    EXPECT_EQ(a.phases[i].swing->lift, b.phases[i].swing->lift);
  }
  ASSERT_EQ(a.keyframes.size(), b.keyframes.size());
  for (size_t i = 0; i < a.keyframes.size(); ++i) expect_same(a.keyframes[i], b.keyframes[i]);
  expect_same(a.world, b.world);
  EXPECT_EQ(a.controller.type, b.controller.type);
  EXPECT_EQ(a.controller.gains, b.controller.gains);
  ASSERT_EQ(a.scenario.size(), b.scenario.size());
  for (size_t i = 0; i < a.scenario.size(); ++i) expect_same(a.scenario[i], b.scenario[i]);
  EXPECT_EQ(a.tolerances, b.tolerances);
  EXPECT_EQ(a.repair.joints, b.repair.joints);
  EXPECT_EQ(a.repair.feet, b.repair.feet);
  EXPECT_EQ(a.repair.keyframes, b.repair.keyframes);
  EXPECT_EQ(a.repair.windows, b.repair.windows);
  EXPECT_EQ(a.repair.weights, b.repair.weights);
  EXPECT_EQ(a.repair.trust, b.repair.trust);
  EXPECT_EQ(a.repair.margin, b.repair.margin);
  EXPECT_EQ(a.repair.safety, b.repair.safety);
  ASSERT_EQ(a.correction.has_value(), b.correction.has_value());
  if (!a.correction) return;
  EXPECT_EQ(a.correction->begin, b.correction->begin);
  EXPECT_EQ(a.correction->spacing, b.correction->spacing);
  EXPECT_EQ(a.correction->joints, b.correction->joints);
  EXPECT_EQ(a.correction->coefficients, b.correction->coefficients);
}

TEST_F(PatternWriter, WritingAndReadingIsTheIdentity) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    const Pattern pattern = random_pattern(seed);
    const std::string text = pattern_text(pattern, {"made at random"});
    const Pattern back = read(text);
    expect_same(pattern, back);
    EXPECT_EQ(pattern_text(back, {"made at random"}), text);
    if (HasFailure()) break;
  }
}

// The robot's folder is the folder of the pattern, or beside or below it: its name alone would mean
// a bundled robot.
TEST_F(PatternWriter, TheFolderOfARobotStaysAPath) {
  fs::create_directories(folder_ / "robots" / "mine");
  Pattern pattern = read(kTwoSteps);
  pattern.robot = "./robots/mine";
  for (const fs::path& file : {folder_ / "robots" / "mine" / "p.json",
                               folder_ / "robots" / "p.json", folder_ / "q.json"}) {
    write_pattern(file, pattern);
    const Pattern moved = read_pattern(file);
    EXPECT_TRUE(fs::equivalent(robot_of(moved), folder_ / "robots" / "mine"))
        << file << ": " << moved.robot;
    EXPECT_NE(moved.robot.find('/'), std::string::npos);
  }
}

TEST_F(PatternWriter, WritesWhatAPersonReads) {
  Pattern p = read(kTwoSteps);
  const std::string text = pattern_text(p, {"Two steps."});
  EXPECT_TRUE(
      text.starts_with("// Two steps.\n// Written with the parameters stride = 0.04.\n{\n"
                       "  \"format\": \"ayumi.pattern/1\",\n"))
      << text;
  EXPECT_NE(text.find("    { \"until\": 0.8, \"support\": \"both\" },\n"
                      "    { \"until\": 1.25, \"support\": \"left\", \"swing\": { \"foot\": "
                      "\"right\", \"to\": [0.04, -0.039], \"lift\": 0.01 } },\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("{ \"t\": 1.5, \"posture\": { \"l_shoulder_pitch\": 70 }"),
            std::string::npos);
}

}  // namespace
}  // namespace ayumi::test
