#include "ayumi/io/pattern/pattern_file.hpp"

#include "ayumi/motion/pattern_context.hpp"
#include "tests/io/pattern_texts.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

class PatternFile : public PatternFolder {};

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
  EXPECT_TRUE(text_of(p.keyframes[4].place).ends_with("p.json: /keyframes/4"));
  EXPECT_EQ(p.world.friction, 0.7);
  EXPECT_DOUBLE_EQ(p.world.slope.y(), 2 * kDegree);
  EXPECT_EQ(p.controller.gains.at(0).first, "q");
  EXPECT_EQ(std::get<Push>(p.scenario.at(0).what).direction, -Eigen::Vector3d::UnitY());
  EXPECT_EQ(std::get<Push>(p.scenario.at(0).what).magnitude, 1.1);
  EXPECT_EQ(p.duration(), 3.0);
  EXPECT_EQ(p.sha256.size(), 64u);
}

TEST_F(PatternFile, ParametersCanBeSet) {
  EXPECT_EQ(read(kTwoSteps, {{"stride", 0.05}}).phases[1].swing->to.position.x(), 0.05);
  EXPECT_NE(message(kTwoSteps, {{"strid", 0.05}}).find("did you mean 'stride'?"),
            std::string::npos);
  EXPECT_NE(message(kTwoSteps, {{"stride", INFINITY}}).find("numbers must be from -1e6 to 1e6"),
            std::string::npos);
}

TEST_F(PatternFile, SmallPatternIsReadable) { EXPECT_EQ(read(with("name", "\"x\"")).name, "x"); }

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
  EXPECT_NE(message("{\n \"a\": 1,\n}").find("p.json:2:8: this comma"), std::string::npos);
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
  EXPECT_EQ(p.posture_files.at("crouch"), (folder_ / "lib.json").string());
  EXPECT_FALSE(p.posture_files.contains("stretch"));
  // A joint that the robot does not have is a mistake of the included file.
  put("lib.json", R"({"format": "ayumi.postures/1", "units": {"angle": "rad"},
                      "postures": {"crouch": {"l_kne": 1.5}}})");
  const Pattern misspelt = read(with("postures", own));
  EXPECT_TRUE(error_message([&] {
                posture_joints(hoap1(), misspelt, "crouch", {});
              }).starts_with((folder_ / "lib.json").string() + ": /postures/crouch/l_kne: "));
  put("lib.json", R"({"format": "ayumi.postures/1", "units": {"angle": "rad"},
                      "postures": {"crouch": {"l_knee": 1.5}}})");
  const std::string twice = R"({"crouch": {"l_knee": 10}}, "include": ["lib.json"])";
  EXPECT_NE(message(with("postures", twice))
                .find("/postures/crouch: another included file already has a posture"),
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
  // In another folder, the path is rewritten so that it still leads to the table.
  fs::create_directories(folder_ / "sub");
  write_pattern(folder_ / "sub" / "q.json", p);
  EXPECT_EQ(read_pattern(folder_ / "sub" / "q.json").table->theta, p.table->theta);
}

}  // namespace
}  // namespace ayumi::test
