// Properties of patterns and of the check that hold for motions of every kind, tested on motions
// that are made from a seed. An accepted pattern can be sampled or is refused with its place; files
// keep what was written; left and right are only names; the check does not depend on the world's
// origin; and it obeys the laws of time scaling.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <regex>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/generate/generate.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Json = nlohmann::json;

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
  }
  int pick(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
  bool coin() { return engine_() % 2 == 0; }

 private:
  std::mt19937 engine_;
};

/// A walk with arms and trunk that move.
Pattern random_walk(Dice& dice) {
  Pattern p = walk_pattern(hoap1(), {.steps = 1 + dice.pick(3),
                                     .stride = dice.uniform(0, 0.04),
                                     .lift = dice.uniform(0.005, 0.02),
                                     .turn = dice.uniform(-0.1, 0.1),
                                     .side = dice.uniform(-0.01, 0.01)});
  p.robot = "hoap1";
  for (Keyframe& key : p.keyframes) {
    if (dice.coin())
      for (const char* joint : {"l_elbow", "r_shoulder_pitch", "r_elbow"})
        key.joints[joint] = joint[2] == 'e' ? dice.uniform(-0.8, -0.1) : dice.uniform(-0.4, 0.4);
    if (dice.coin()) key.torso = Vector3d(dice.uniform(-0.03, 0.03), dice.uniform(-0.05, 0.05), 0);
  }
  return p;
}

// ---- every number is finite

void expect_finite(const CommandSeries& series, const std::string& what) {
  for (const CommandSample& s : series.samples) {
    bool finite = s.state.theta.allFinite() && s.state.dtheta.allFinite() &&
                  s.acceleration.allFinite() && s.cog.allFinite() && s.dcog.allFinite() &&
                  s.ddcog.allFinite() && s.zmp.allFinite() && std::isfinite(s.fz) &&
                  s.state.base.position.allFinite() && s.state.base.attitude.coeffs().allFinite();
    for (const Eigen::Isometry3d& foot : s.feet) finite = finite && foot.matrix().allFinite();
    ASSERT_TRUE(finite) << what;
  }
}

// ---- what is accepted can be sampled, or the refusal names the place

void each_value(Json& value, std::vector<Json*>& found) {
  if (value.is_structured())
    for (Json& child : value) each_value(child, found);
  if (!value.is_structured() || value.empty() || value.size() < 4) found.push_back(&value);
}

double hostile_number(Dice& dice, double now) {
  switch (dice.pick(8)) {
    case 0:
      return 0;
    case 1:
      return -now;
    case 2:
      return now * dice.uniform(0.5, 2);
    case 3:
      return now * 1e3;
    case 4:
      return now + dice.uniform(-0.01, 0.01);
    case 5:
      return 1e300;
    case 6:
      return 5e-324;
    default:
      return dice.uniform(-10, 10);
  }
}

std::string mutated(const std::string& text, Dice& dice) {
  Json pattern = json_of(text, true);
  for (int changes = 1 + dice.pick(3); changes > 0; --changes) {
    std::vector<Json*> values;
    for (const char* key : {"keyframes", "phases", "world", "defaults"})
      if (pattern.contains(key)) each_value(pattern[key], values);
    Json& value = *values[static_cast<size_t>(dice.pick(static_cast<int>(values.size())))];
    if (value.is_number())
      value = hostile_number(dice, value.get<double>());
    else if (value.is_array() && !value.empty())
      value.erase(value.size() - 1);
    else if (value.is_string())
      value = dice.coin() ? "left" : "right";
    else if (value.is_object() && !value.empty() && dice.coin())
      value.erase(value.begin());
  }
  return pattern.dump();
}

TEST(Properties, AnAcceptedPatternIsSampledOrRefusedWithItsPlace) {
  const std::string walk = pattern_text(walk_pattern(hoap1(), {.steps = 2}));
  int accepted = 0, sampled = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    Dice dice(seed);
    const std::string text = mutated(walk, dice);
    Pattern pattern;
    try {
      pattern = pattern_of_text(text, "p.json");
    } catch (const Error& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("p.json: /")) << seed << error.what();
      continue;
    }
    ++accepted;
    try {
      const CommandSeries series = sample(hoap1(), pattern);
      expect_finite(series, "seed " + std::to_string(seed));
      ++sampled;
      // Every figure is a number. A finding that is a cause follows from nothing.
      const std::string report =
          std::regex_replace(check_json(check_consistency(hoap1(), series)),
                             std::regex("\"(follows_from|cause)\": null"), "");
      EXPECT_EQ(report.find("null"), std::string::npos) << seed << report;
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_NE(error.code(), ErrorCode::internal) << seed << message;
      // The message names a key, a phase or the defaults, or a time.
      EXPECT_TRUE(message.starts_with("p.json: /") || message.find(" s") != std::string::npos)
          << seed << message;
    }
  }
  EXPECT_GT(accepted, 40);
  EXPECT_GT(sampled, 10);
}

// ---- files and sides

TEST(Properties, WritingAndReadingAMotionIsTheIdentity) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Dice dice(seed);
    const Pattern pattern = random_walk(dice);
    const std::string text = pattern_text(pattern);
    const Pattern back = pattern_of_text(text, "p.json");
    EXPECT_EQ(pattern_text(back), text) << seed;
    if (seed >= 4) continue;
    const CommandSeries a = sample(hoap1(), pattern), b = sample(hoap1(), back);
    ASSERT_EQ(a.samples.size(), b.samples.size());
    for (size_t k = 0; k < a.samples.size(); k += 50)
      EXPECT_LT((a.samples[k].state.theta - b.samples[k].state.theta).norm(), 1e-9) << seed;
  }
}

TEST(Properties, MirroredTwiceIsTheIdentityAndMirroredOnceIsAsConsistent) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Dice dice(100 + seed);
    const Pattern pattern = random_walk(dice), image = mirrored(hoap1(), pattern);
    EXPECT_EQ(pattern_text(mirrored(hoap1(), image)), pattern_text(pattern)) << seed;
    if (seed >= 3) continue;
    const ConsistencyReport a = check_consistency(hoap1(), sample(hoap1(), pattern));
    const ConsistencyReport b = check_consistency(hoap1(), sample(hoap1(), image));
    EXPECT_EQ(a.consistent, b.consistent) << seed;
    ASSERT_EQ(a.findings.size(), b.findings.size()) << seed;
    // Sampled alone, the COG of the image agrees within 1e-5 m, as in the test of the mirror. The
    // largest effect is on the share of friction, 7e-4.
    for (const FindingKind kind : {FindingKind::joint_speed, FindingKind::joint_torque,
                                   FindingKind::support_margin, FindingKind::friction})
      EXPECT_NEAR(a.summary[kind], b.summary[kind], 2e-3) << seed << name_of(kind);
  }
}

// ---- the check

/// The same motion as seen from another origin.
CommandSeries moved(CommandSeries series, double yaw, const Vector3d& by) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear() = turn.toRotationMatrix();
  frame.translation() = by;
  for (CommandSample& s : series.samples) {
    s.state.base.position = frame * s.state.base.position;
    s.state.base.attitude = turn * s.state.base.attitude;
    s.state.base_velocity = turn * s.state.base_velocity;
    s.state.base_angular_velocity = turn * s.state.base_angular_velocity;
    s.acceleration.head<3>() = turn * Vector3d(s.acceleration.head<3>());
    s.acceleration.segment<3>(3) = turn * Vector3d(s.acceleration.segment<3>(3));
    s.cog = frame * s.cog;
    s.zmp = frame * s.zmp;
    s.dcog = turn * s.dcog;
    s.ddcog = turn * s.ddcog;
    for (Eigen::Isometry3d& foot : s.feet) foot = frame * foot;
  }
  return series;
}

TEST(Properties, TheCheckDoesNotDependOnTheOrigin) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    Dice dice(200 + seed);
    const CommandSeries here = sample(hoap1(), random_walk(dice));
    const CommandSeries there =
        moved(here, dice.uniform(-3, 3), {dice.uniform(-5, 5), dice.uniform(-5, 5), 0});
    const ConsistencyReport a = check_consistency(hoap1(), here);
    const ConsistencyReport b = check_consistency(hoap1(), there);
    EXPECT_EQ(a.consistent, b.consistent) << seed;
    ASSERT_EQ(a.findings.size(), b.findings.size()) << seed;
    for (size_t i = 0; i < a.findings.size(); ++i) {
      EXPECT_EQ(a.findings[i].kind, b.findings[i].kind) << seed;
      EXPECT_NEAR(a.findings[i].at, b.findings[i].at, 1e-9) << seed;
    }
    for (const std::string& name : finding_kind_names()) {
      const FindingKind kind = *finding_kind(name);
      // Figures of the agreement of commands are those of the worst axis of the world, which turns.
      if (name.ends_with("residual") || name.ends_with("gap") || name == "angular_momentum")
        continue;
      EXPECT_NEAR(a.summary[kind], b.summary[kind], 1e-6 * (1 + std::abs(a.summary[kind])))
          << seed << name;
    }
  }
}

/// The same path, `slower` times as slow. COG, ZMP and f_z are those of the full model.
CommandSeries retimed(CommandSeries series, double slower) {
  series.dt *= slower;
  RobotData data(hoap1());
  for (CommandSample& s : series.samples) {
    s.state.dtheta /= slower;
    s.state.base_velocity /= slower;
    s.state.base_angular_velocity /= slower;
    s.acceleration /= slower * slower;
    s.dcog /= slower;
    s.ddcog /= slower * slower;
    const auto reaction = full_model_reaction(hoap1(), s, data);
    s.zmp = reaction.zmp;
    s.fz = reaction.force.z();
  }
  return series;
}

// With the same path, speeds change with 1 / s. The ground carries gravity and inertia, and the
// latter changes with 1 / s^2: so the differences of the ZMP between three paces have a known
// ratio.
TEST(Properties, TheCheckObeysTimeScaling) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    Dice dice(300 + seed);
    const CommandSeries series = sample(hoap1(), random_walk(dice));
    const ConsistencyReport once = check_consistency(hoap1(), retimed(series, 1));
    for (const double slower : {2.0, 4.0}) {
      const ConsistencyReport slow = check_consistency(hoap1(), retimed(series, slower));
      EXPECT_NEAR(slow.summary[FindingKind::joint_speed] * slower,
                  once.summary[FindingKind::joint_speed], 1e-6)
          << seed;
      EXPECT_NEAR(slow.summary[FindingKind::joint_position],
                  once.summary[FindingKind::joint_position], 1e-9)
          << seed;
    }
    for (size_t k = 0; k < series.samples.size(); k += 97) {
      CommandSeries one;
      one.dt = series.dt;
      one.samples = {series.samples[k]};
      const auto zmp_force = [&](double slower) {
        const CommandSample s = retimed(one, slower).samples.front();
        return Vector3d(s.zmp * s.fz);  // the moment about the origin, which can be added
      };
      const Vector3d fast = zmp_force(1) - zmp_force(2), slow = zmp_force(2) - zmp_force(4);
      EXPECT_LT((fast - 4 * slow).head<2>().norm(), 1e-6) << seed << " " << k;
    }
  }
}

}  // namespace
}  // namespace ayumi::test
