#include "ayumi/io/pattern_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "tests/support/json_schema.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

constexpr double kDegree = EIGEN_PI / 180;

class PatternFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(::testing::TempDir()) /
        ("ayumi_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  Pattern read(const std::string& text, const std::map<std::string, double>& set = {}) const {
    return read_pattern(put("p.json", text), set);
  }
  std::string message(const std::string& text,
                      const std::map<std::string, double>& set = {}) const {
    try {
      read(text, set);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  fs::path folder_;
};

const char* const kTwoSteps = R"({
  // comments are welcome
  "format": "ayumi.pattern/1",
  "name": "two steps forward, pushed from the left",
  "robot": "hoap1",
  "units": { "angle": "deg" },
  "parameters": { "stride": 0.04 },
  "defaults": { "interpolation": "cubic", "posture": "home", "cog_height": 0.24, "cog_model": "point_mass" },
  "start": { "left": [0, 0.039], "right": [0.01, -0.039, 0, 5] },
  "phases": [
    { "until": 0.80, "support": "both" },
    { "until": 1.25, "support": "left", "swing": { "foot": "right", "to": ["${stride}", -0.039], "lift": 0.01 } },
    { "until": 3.00, "support": "both" }
  ],
  "keyframes": [
    { "t": 0, "zmp": "center" },
    { "t": 0.80, "zmp": "left", "interpolation": "linear" },
    { "t": 1.50, "posture": { "l_shoulder_pitch": 70 }, "torso": { "pitch": 3 } },
    { "t": 2.40, "zmp": ["(${stride} + 0.02)/2", 0], "cog": { "height": 0.235 }, "fz": 60 },
    { "t": 3.00, "posture": "home", "joints": { "l_knee": 90 }, "weights": { "l_knee": 2 },
      "feet": { "left": { "position": [0, 0.04, 0.01], "rpy": [0, -10, 0] } } }
  ],
  "world": { "friction": 0.7, "ground": { "pitch": 2 } },
  "controller": { "type": "dtad", "gains": { "q": 0.25 } },
  "scenario": [
    { "type": "impulse", "at": 1.55, "duration": 0.020, "on": "cog", "direction": [0, -2, 0], "impulse": 1.1 }
  ],
  "tolerances": { "foot_slip": 0.002 }
})";

TEST_F(PatternFile, SaysWhatTheAuthorWrote) {
  const Pattern p = read(kTwoSteps);
  EXPECT_EQ(p.name, "two steps forward, pushed from the left");
  EXPECT_EQ(p.robot, "hoap1");
  EXPECT_EQ(p.interpolation, Interpolation::cubic);
  EXPECT_FALSE(p.full_model);
  EXPECT_EQ(p.cog_height, 0.24);
  EXPECT_DOUBLE_EQ(p.start_feet[1]->rpy.z(), 5 * kDegree);
  ASSERT_EQ(p.phases.size(), 3u);
  EXPECT_EQ(p.phases[1].support, Support::left);
  EXPECT_EQ(p.phases[1].swing->to.position, Eigen::Vector3d(0.04, -0.039, 0));
  EXPECT_EQ(p.phases[1].swing->lift, 0.01);
  ASSERT_EQ(p.keyframes.size(), 5u);
  EXPECT_EQ(p.keyframes[1].zmp->place, ZmpKey::Place::left);
  EXPECT_EQ(p.keyframes[1].interpolation, Interpolation::linear);
  EXPECT_DOUBLE_EQ(p.keyframes[2].joints.at("l_shoulder_pitch"), 70 * kDegree);
  EXPECT_DOUBLE_EQ(p.keyframes[2].torso->y(), 3 * kDegree);
  EXPECT_DOUBLE_EQ(p.keyframes[3].zmp->point.x(), 0.03);
  EXPECT_EQ(p.keyframes[3].cog_height, 0.235);
  EXPECT_FALSE(p.keyframes[3].cog_x);
  EXPECT_EQ(p.keyframes[4].posture, "home");
  EXPECT_DOUBLE_EQ(p.keyframes[4].joints.at("l_knee"), EIGEN_PI / 2);
  EXPECT_DOUBLE_EQ(p.keyframes[4].feet[0]->rpy.y(), -10 * kDegree);
  EXPECT_NE(p.keyframes[4].place.find("p.json: /keyframes/4"), std::string::npos);
  EXPECT_EQ(p.world.friction, 0.7);
  EXPECT_DOUBLE_EQ(p.world.slope.y(), 2 * kDegree);
  EXPECT_EQ(p.controller.gains.at(0).first, "q");
  EXPECT_EQ(p.scenario.at(0).direction, -Eigen::Vector3d::UnitY());
  EXPECT_EQ(p.scenario.at(0).magnitude, 1.1);
  EXPECT_EQ(p.duration(), 3.0);
  EXPECT_EQ(p.sha256.size(), 64u);
}

TEST_F(PatternFile, ParametersCanBeSet) {
  EXPECT_EQ(read(kTwoSteps, {{"stride", 0.05}}).phases[1].swing->to.position.x(), 0.05);
  EXPECT_NE(message(kTwoSteps, {{"strid", 0.05}}).find("did you mean 'stride'?"),
            std::string::npos);
  EXPECT_NE(message(kTwoSteps, {{"stride", INFINITY}}).find("not a sensible number"),
            std::string::npos);
}

// Small pattern with one piece replaced.
std::string with(const std::string& key, const std::string& value) {
  const std::map<std::string, std::string> parts = {
      {"format", "\"ayumi.pattern/1\""},
      {"robot", "\"hoap1\""},
      {"units", R"({"angle": "deg"})"},
      {"phases", R"([{"until": 1, "support": "both"}])"},
      {"keyframes", R"([{"t": 0, "posture": "home"}])"}};
  std::string text = "{\n";
  for (const auto& [name, standard] : parts) {
    const std::string& piece = name == key ? value : standard;
    if (!piece.empty()) text += "\"" + name + "\": " + piece + ",\n";
  }
  if (!parts.contains(key)) text += "\"" + key + "\": " + value + ",\n";
  text.erase(text.size() - 2);
  return text + "}\n";
}

struct Broken {
  const char *key, *value, *message;
};

TEST_F(PatternFile, SmallPatternIsReadable) { EXPECT_EQ(read(with("name", "\"x\"")).name, "x"); }

const std::vector<Broken>& mistakes() {
  static const std::vector<Broken> cases = {
      {"format", "\"ayumi.pattern/2\"", "/format: 'ayumi.pattern/2' is not readable here"},
      {"format", "", "the key 'format' is missing"},
      {"robot", "", "the key 'robot' is missing"},
      {"robot", "\"\"", "/robot: is empty"},
      {"robot", "3", "/robot: expected a string, found the number 3"},
      {"phases", "", "the key 'phases' is missing"},
      {"phases", "[]", "/phases: is empty"},
      {"phases", "{}", "/phases: expected an array"},
      {"keyframes", "", "the key 'keyframes' is missing"},
      {"keyframes", "[]", "/keyframes: is empty"},
      {"keyframes", "[3]", "/keyframes/0: expected an object"},
      {"keyframe", "[]", "/keyframe: unknown key; did you mean 'keyframes'?"},
      {"phases", R"([{"until": 1, "suport": "both"}])",
       "/phases/0/suport: unknown key; did you mean"},
      {"phases", R"([{"until": 1, "support": "bth"}])", "/phases/0/support: 'bth' is not one of"},
      {"phases", R"([{"until": 0, "support": "both"}])",
       "/phases/0/until: 0 s does not come after 0 s"},
      {"phases", R"([{"until": 2, "support": "both"}, {"until": 1, "support": "both"}])",
       "/phases/1/until: 1 s does not come after 2 s; times must increase"},
      {"phases", R"([{"until": -1, "support": "both"}])", "-1 is below the least allowed, 0"},
      {"phases", R"([{"until": 5000, "support": "both"}])",
       "5000 is above the largest allowed, 3600"},
      {"phases", R"([{"until": 1, "support": "left", "swing": {"foot": "left", "to": [0,0]}}])",
       "/phases/0/swing/foot: the left foot carries the robot"},
      {"phases", R"([{"until": 1, "support": "left", "swing": {"foot": "right", "to": [0]}}])",
       "/phases/0/swing/to: expected [x, y], [x, y, z] or [x, y, z, yaw], found an array of 1"},
      {"keyframes", R"([{"t": 1, "zmp": "left"}, {"t": 1, "zmp": "left"}])",
       "/keyframes/1/t: 1 s does not come after 1 s"},
      {"keyframes", R"([{"t": "nan"}])", "expected a number (or an expression"},
      {"keyframes", R"([{"t": "1 s"}])", "/keyframes/0/t: expected a number"},
      {"keyframes", R"([{"t": null}])", "/keyframes/0/t: expected a number, found null"},
      {"keyframes", R"([{"t": true}])", "/keyframes/0/t: expected a number, found true"},
      {"keyframes", R"([{"t": 1e999}])", "p.json"},
      {"keyframes", R"([{"t": NaN}])", "p.json:3:"},
      {"keyframes", R"([{"t": 1, "fz": 1e7}])", "is beyond any sensible value"},
      {"keyframes", R"([{"t": 1, "fz": -1}])", "/keyframes/0/fz: -1 is below the least allowed, 0"},
      {"keyframes", R"([{"t": 1, "zmp": "middle"}])", "'middle' is not one of left, right, center"},
      {"keyframes", R"([{"t": 1, "zmp": [1]}])",
       "/keyframes/0/zmp: expected [x, y], found an array of 1"},
      {"keyframes", R"([{"t": 1, "zmp": 3}])",
       "expected \"left\", \"right\", \"center\" or [x, y]"},
      {"keyframes", R"([{"t": 1, "cog": {"z": 1}}])", "/keyframes/0/cog/z: unknown key"},
      {"keyframes", R"([{"t": 1, "cog": {}}])", "/keyframes/0/cog: no coordinate is named"},
      {"keyframes", R"([{"t": 1, "torso": {}}])", "/keyframes/0/torso: no angle is named"},
      {"keyframes", R"([{"t": 1, "posture": 3}])", "expected the name of a posture"},
      {"keyframes", R"([{"t": 1, "posture": {"l_knee": "9O"}}])",
       "/keyframes/0/posture/l_knee: expected a number"},
      {"keyframes", R"([{"t": 1, "posture": {"l_knee": 1}, "joints": {"l_knee": 2}}])",
       "/keyframes/0/joints/l_knee: the joint is already set"},
      {"keyframes", R"([{"t": 1, "interpolation": "minimum jerk"}])",
       "did you mean 'minimum_jerk'?"},
      {"keyframes", R"([{"t": 1, "weights": {"l_knee": 0}}])", "a weight must be above 0"},
      {"keyframes", R"([{"t": 1, "t": 2}])", "'t' appears twice"},
      {"units", R"({"angle": "grad"})", "/units/angle: 'grad' is not one of deg, rad"},
      {"units", R"({"angle": "deg", "length": "mm"})", "/units/length: 'mm' is not one of m"},
      {"start", R"({"middle": [0, 0]})", "/start/middle: unknown key"},
      {"defaults", R"({"cog_height": 0})", "/defaults/cog_height: must be above 0"},
      {"defaults", R"({"cog_model": "point"})",
       "/defaults/cog_model: 'point' is not one of full, point_mass"},
      {"world", R"({"friction": -0.1})", "/world/friction: -0.1 is below"},
      {"world", R"({"ground": "hilly"})", "/world/ground: 'hilly' is not one of flat"},
      {"controller", R"({"type": "pid"})",
       "/controller/type: 'pid' is not one of none, dtad, dtad-literal"},
      {"controller", R"({"type": "dtad", "gains": {"q": 1, "k": 2, "d": 1}})", "q sets k and d"},
      {"controller", R"({"type": "dtad", "gains": {"k": 2}})", "k and d go together"},
      {"scenario", R"([{"type": "kick"}])",
       "/scenario/0/type: 'kick' is not one of impulse, force, torque"},
      {"scenario",
       R"([{"type": "force", "at": 1, "duration": 1, "direction": [1,0,0], "impulse": 1}])",
       "/scenario/0/impulse: the type is \"force\""},
      {"scenario", R"([{"type": "force", "at": 1, "duration": 1, "direction": [1,0,0]}])",
       "/scenario/0: the key 'force' is missing"},
      {"scenario",
       R"([{"type": "force", "at": 1, "duration": 1, "direction": [0,0,0], "force": 1}])",
       "/scenario/0/direction: the direction is zero"},
      {"scenario",
       R"([{"type": "force", "at": 1, "duration": -1, "direction": [1,0,0], "force": 1}])",
       "/scenario/0/duration: -1 is below"},
      {"scenario",
       R"([{"type": "force", "at": 1, "duration": 1, "direction": [1,0,0], "force": 1, "point": [0,0,0]}])",
       "/scenario/0/point: a point needs a link"},
      {"parameters", R"({"a": "1"})", "/parameters/a: expected a number"},
      {"tolerances", R"({"foot_slip": -1})", "/tolerances/foot_slip: -1 is below"},
      {"keyframes", R"([{"t": "${a}"}])", "unknown parameter 'a'"},
      {"keyframes", R"([{"t": "${a"}])",
       "/keyframes/0/t: expression \"${a\": a parameter is written ${name}"},
      {"table", "\"absent.csv\"", "absent.csv: no such file"},
      {"include", "\"absent.json\"", "absent.json: no such file"},
      {"correction", R"({"begin": 0, "spacing": 0, "columns": [], "coefficients": []})",
       "/correction/spacing: must be above 0"},
      {"correction", R"({"begin": 0, "spacing": 1, "columns": ["base.x[m]"], "coefficients": []})",
       "/correction/columns: the column 'base.y[m]' is missing"},
  };
  return cases;
}

TEST_F(PatternFile, EveryMistakeGetsOneClearMessage) {
  for (const Broken& each : mistakes()) {
    const std::string text = message(with(each.key, each.value));
    EXPECT_NE(text.find(each.message), std::string::npos)
        << each.key << ": " << each.value << "\n  gave: " << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
}

TEST_F(PatternFile, AnglesNeedTheirUnit) {
  const std::string text = R"({"format": "ayumi.pattern/1", "robot": "hoap1",
    "phases": [{"until": 1, "support": "both"}], "keyframes": [{"t": 0, "joints": {"l_knee": 1}}]})";
  EXPECT_NE(message(text).find("/keyframes/0/joints/l_knee: an angle needs its unit"),
            std::string::npos);
}

TEST_F(PatternFile, FilesThatAreNoPatterns) {
  EXPECT_NE(message("").find("the file is empty"), std::string::npos);
  EXPECT_NE(message("[1]").find("expected an object"), std::string::npos);
  EXPECT_NE(message("{\"format\": ").find("p.json:1:"), std::string::npos);
  EXPECT_NE(message("{\n \"a\": 1,\n}").find("p.json:3:"), std::string::npos);
  EXPECT_NE(message(std::string("\x7f"
                                "ELF\x02\x01\0\0\xff",
                                9))
                .find("p.json:1:1"),
            std::string::npos);
  EXPECT_NE(message(std::string(200000, '[')).find("p.json:1:"), std::string::npos);
  EXPECT_THROW(read_pattern(folder_), Error);
  try {
    read_pattern(folder_ / "absent.json");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_file);
    EXPECT_NE(std::string(error.what()).find("no such file"), std::string::npos);
  }
}

TEST_F(PatternFile, PosturesOfTheFileAndOfIncludedFiles) {
  put("lib.json", R"({"format": "ayumi.postures/1", "units": {"angle": "rad"},
                      "postures": {"crouch": {"l_knee": 1.5}}})");
  const std::string own = R"({"stretch": {"l_knee": 10}}, "include": "lib.json")";
  const Pattern p = read(with("postures", own));
  EXPECT_EQ(p.postures.at("crouch").at("l_knee"), 1.5);
  EXPECT_DOUBLE_EQ(p.postures.at("stretch").at("l_knee"), 10 * kDegree);
  const std::string twice = R"({"crouch": {"l_knee": 10}}, "include": ["lib.json"])";
  EXPECT_NE(message(with("postures", twice)).find("/postures/crouch: a posture of this name"),
            std::string::npos);
  put("lib.json", R"({"format": "ayumi.pattern/1"})");
  EXPECT_NE(message(with("postures", own)).find("lib.json: /format"), std::string::npos);
}

TEST_F(PatternFile, TableBesideThePattern) {
  put("m.csv", "t[s],theta.l_knee[rad],fz[N]\n0,1,60\n0.005,1.25,61\n0.01,1.5,62\n");
  const Pattern p = read(with("table", "\"m.csv\""));
  EXPECT_EQ(p.table->file, "m.csv");
  EXPECT_EQ(p.table->dt, 0.005);
  EXPECT_EQ(p.table->joints, std::vector<std::string>{"l_knee"});
  EXPECT_EQ(p.table->theta(2, 0), 1.5);
  EXPECT_EQ(p.table->fz.at(1), 61);
  // Elsewhere, the path is rewritten so that it still leads to the table.
  fs::create_directories(folder_ / "sub");
  write_pattern(folder_ / "sub" / "q.json", p);
  EXPECT_EQ(read_pattern(folder_ / "sub" / "q.json").table->theta, p.table->theta);
}

// ------------------------------------------------------------------- writing

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
  }
  bool coin() { return engine_() % 2 == 0; }
  int pick(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
  // An angle the file's unit can hold: any double in rad, a rounded number in degrees.
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

Keyframe random_keyframe(Random& random, bool degrees, double t) {
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

Disturbance random_push(Random& random) {
  Disturbance push;
  push.type = static_cast<DisturbanceType>(random.pick(3));
  push.at = random.uniform(0, 3);
  push.duration = random.uniform(0, 1);
  push.direction = Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 0.1).normalized();
  push.magnitude = random.uniform(0, 10);
  push.shape = static_cast<DisturbanceShape>(random.pick(2));
  if (random.coin()) {
    push.on = "torso";
    push.frame = DisturbanceFrame::link;
    push.point.setConstant(random.uniform(-1, 1));
  }
  return push;
}

Pattern random_pattern(unsigned seed) {
  Random random(seed);
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
    if (phase.support == Support::left)
      phase.swing = Swing{Side::right, random.foothold(p.degrees), random.uniform(0, 0.1)};
    p.phases.push_back(phase);
  }
  t = 0;
  for (int i = 0; i <= random.pick(8); ++i)
    p.keyframes.push_back(random_keyframe(random, p.degrees, t += random.uniform(0.1, 1)));
  p.world.friction = random.uniform(0, 2);
  if (random.coin()) p.world.slope.y() = random.angle(p.degrees) / 4;
  if (p.degrees) p.world.slope.y() = std::round(p.world.slope.y() / kDegree) * kDegree;
  if (random.coin()) p.controller.gains = {{"ka", random.uniform(0, 3)}, {"q", 0.25}};
  for (int i = 0; i < random.pick(3); ++i) p.scenario.push_back(random_push(random));
  if (random.coin()) p.tolerances["foot_slip"] = random.uniform(0, 1);
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

void expect_same(const Disturbance& a, const Disturbance& b) {
  EXPECT_EQ(a.type, b.type);
  EXPECT_EQ(a.at, b.at);
  EXPECT_EQ(a.duration, b.duration);
  EXPECT_EQ(a.on, b.on);
  EXPECT_EQ(a.point, b.point);
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(a.direction, b.direction);
  EXPECT_EQ(a.magnitude, b.magnitude);
  EXPECT_EQ(a.shape, b.shape);
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
    ASSERT_EQ(a.phases[i].swing.has_value(), b.phases[i].swing.has_value());
    if (!a.phases[i].swing) continue;
    EXPECT_EQ(a.phases[i].swing->foot, b.phases[i].swing->foot);
    expect_same(a.phases[i].swing->to, b.phases[i].swing->to);
    EXPECT_EQ(a.phases[i].swing->lift, b.phases[i].swing->lift);
  }
  ASSERT_EQ(a.keyframes.size(), b.keyframes.size());
  for (size_t i = 0; i < a.keyframes.size(); ++i) expect_same(a.keyframes[i], b.keyframes[i]);
  EXPECT_EQ(a.world.friction, b.world.friction);
  EXPECT_EQ(a.world.slope, b.world.slope);
  EXPECT_EQ(a.controller.type, b.controller.type);
  EXPECT_EQ(a.controller.gains, b.controller.gains);
  ASSERT_EQ(a.scenario.size(), b.scenario.size());
  for (size_t i = 0; i < a.scenario.size(); ++i) expect_same(a.scenario[i], b.scenario[i]);
  EXPECT_EQ(a.tolerances, b.tolerances);
  ASSERT_EQ(a.correction.has_value(), b.correction.has_value());
  if (!a.correction) return;
  EXPECT_EQ(a.correction->begin, b.correction->begin);
  EXPECT_EQ(a.correction->spacing, b.correction->spacing);
  EXPECT_EQ(a.correction->joints, b.correction->joints);
  EXPECT_EQ(a.correction->coefficients, b.correction->coefficients);
}

TEST_F(PatternFile, WritingAndReadingIsTheIdentity) {
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

TEST_F(PatternFile, WritesWhatAPersonReads) {
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

// ------------------------------------------------------------------- schema

std::vector<std::string> keys_of(const nlohmann::json& schema) {
  std::vector<std::string> keys;
  for (const auto& entry : schema.at("properties").items()) keys.push_back(entry.key());
  return keys;
}

TEST(PatternSchema, KnowsExactlyTheKeysOfTheReader) {
  const std::string folder = AYUMI_SOURCE_DIR "/docs/schemas/";
  const auto pattern = nlohmann::json::parse(read_file(folder + "pattern-1.schema.json"));
  const auto postures = nlohmann::json::parse(read_file(folder + "postures-1.schema.json"));
  for (const auto& [kind, keys] : pattern_keys()) {
    SCOPED_TRACE(kind);
    const nlohmann::json& schema = kind == "pattern"         ? pattern
                                   : kind == "postures_file" ? postures
                                                             : pattern.at("$defs").at(kind);
    std::vector<std::string> sorted = keys;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(keys_of(schema), sorted);
    EXPECT_EQ(schema.at("additionalProperties"), false);
  }
  for (const auto& [name, schema] : pattern.at("$defs").items())
    if (schema.contains("properties")) {
      EXPECT_TRUE(pattern_keys().contains(name)) << name;
    }
  EXPECT_EQ(postures.at("$defs").at("units").at("properties"),
            pattern.at("$defs").at("units").at("properties"));
}

// Every value of an enumeration in the schema is accepted by the reader, and nothing near it.
TEST_F(PatternFile, SchemaEnumerationsAreTheReaders) {
  const auto schema =
      nlohmann::json::parse(read_file(AYUMI_SOURCE_DIR "/docs/schemas/pattern-1.schema.json"));
  const auto& defs = schema.at("$defs");
  const auto expect_accepted = [&](const nlohmann::json& values, const std::string& key,
                                   const std::string& before, const std::string& after) {
    for (const auto& value : values)
      EXPECT_EQ(message(with(key, before + value.dump() + after)), "no error") << value;
  };
  expect_accepted(defs.at("interpolation").at("enum"), "keyframes",
                  R"([{"t": 1, "interpolation": )", "}]");
  expect_accepted(defs.at("phase").at("properties").at("support").at("enum"), "phases",
                  R"([{"until": 1, "support": )", "}]");
  expect_accepted(defs.at("controller").at("properties").at("type").at("enum"), "controller",
                  R"({"type": )", "}");
  expect_accepted(defs.at("units").at("properties").at("angle").at("enum"), "units",
                  R"({"angle": )", "}");
  expect_accepted(defs.at("defaults").at("properties").at("cog_model").at("enum"), "defaults",
                  R"({"cog_model": )", "}");
}

nlohmann::json with_comments(const std::string& text) {
  return nlohmann::json::parse(text, nullptr, true, true);
}

// Schema and reader agree: what is written fits, what the reader refuses for its form does not.
TEST_F(PatternFile, SchemaAndReaderAgree) {
  const test::JsonSchema schema(
      nlohmann::json::parse(read_file(AYUMI_SOURCE_DIR "/docs/schemas/pattern-1.schema.json")));
  EXPECT_TRUE(schema.accepts(with_comments(kTwoSteps)));
  for (unsigned seed = 0; seed < 60; ++seed)
    EXPECT_TRUE(schema.accepts(with_comments(pattern_text(random_pattern(seed))))) << seed;
  // Beyond a schema: order of times, meaning of names and expressions, other files, zero vectors.
  const std::vector<std::string> beyond = {
      "does not come after",  "carries the robot",     "is already set", "appears twice",
      "unknown parameter",    "a parameter is",        "no such file",   "the direction is zero",
      "a point needs a link", "'base.y[m]' is missing"};
  int judged = 0;
  for (const Broken& each : mistakes()) {
    const std::string reason = message(with(each.key, each.value));
    const auto part_of_reason = [&](const std::string& part) {
      return reason.find(part) != std::string::npos;
    };
    if (std::any_of(beyond.begin(), beyond.end(), part_of_reason)) continue;
    const auto document = nlohmann::json::parse(with(each.key, each.value), nullptr, false, true);
    if (document.is_discarded()) continue;  // not even JSON
    EXPECT_FALSE(schema.accepts(document)) << each.key << ": " << each.value;
    ++judged;
  }
  EXPECT_GT(judged, 40);
}

TEST_F(PatternFile, BundledPatternsFitTheSchema) {
  const test::JsonSchema schema(
      nlohmann::json::parse(read_file(AYUMI_SOURCE_DIR "/docs/schemas/pattern-1.schema.json")));
  const fs::path folder = AYUMI_SOURCE_DIR "/patterns";
  if (!fs::exists(folder)) GTEST_SKIP() << "no patterns yet";
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".json") {
      EXPECT_TRUE(schema.accepts(with_comments(read_file(entry.path())))) << entry.path();
      EXPECT_NO_THROW(read_pattern(entry.path())) << entry.path();
    }
}

TEST_F(PatternFile, ExampleOfTheDocumentationIsReadable) {
  const std::string page = read_file(AYUMI_SOURCE_DIR "/docs/formats.md");
  const size_t begin = page.find("```jsonc\n") + 9;
  const Pattern p = read(page.substr(begin, page.find("```", begin) - begin));
  EXPECT_EQ(p.phases.size(), 3u);
  EXPECT_EQ(p.scenario.size(), 1u);
  // Every key of the format is named on the page.
  for (const auto& [kind, keys] : pattern_keys())
    for (const std::string& key : keys)
      EXPECT_NE(page.find(key), std::string::npos) << kind << "." << key;
}

}  // namespace
}  // namespace ayumi
