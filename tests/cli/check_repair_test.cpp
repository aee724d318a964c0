// The commands check and repair on the HOAP-1 walk, whole and with faults put into its file.

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

const std::string kWalk = AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json";

class CheckRepair : public testing::Test {
 protected:
  Output ayumi(const std::vector<std::string>& arguments) {
    return run_program(arguments, folder.path());
  }

  /// The walk with `from` replaced by `to`, as a file of the scratch folder.
  void plant(const std::string& name, const std::string& from, const std::string& to) {
    std::string text = contents(kWalk);
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(folder / name, text.replace(at, from.size(), to));
  }

  // The ZMP of the second step on the left foot, 10 mm beyond its outer edge.
  void plant_zmp_outside(const std::string& name) {
    const std::string key = R"("zmp": "left" },
    { "t": 2.671, "zmp": "left" })";
    plant(name, key, R"("zmp": [0.067, 0.0805] },
    { "t": 2.671, "zmp": [0.067, 0.0805] })");
  }

  Folder folder;
};

TEST_F(CheckRepair, TheWalkIsConsistent) {
  const Output people = ayumi({"check", kWalk});
  EXPECT_EQ(people.exit_code, 0) << people.out << people.err;
  EXPECT_NE(people.out.find(": consistent"), std::string::npos);
  const Output script = ayumi({"check", kWalk, "--json", "--quiet"});
  EXPECT_EQ(script.exit_code, 0);
  const Json json = Json::parse(script.out);
  EXPECT_EQ(json["verdict"], "consistent");
  for (const Json& finding : json["findings"]) EXPECT_EQ(finding["severity"], "info");
  EXPECT_GT(json["summary"]["min_zmp_margin_m"], 0.01);
  EXPECT_GT(json["wall_s"], 0);
  EXPECT_TRUE(folder.files().empty());
}

TEST_F(CheckRepair, TolerancesAreListedAndSet) {
  const Output people = ayumi({"check", "--tolerances"});
  EXPECT_EQ(people.exit_code, 0);
  EXPECT_EQ(line_count(people.out), 21);
  EXPECT_EQ(Json::parse(ayumi({"check", "--tolerances", "--json"}).out)["tolerances"].size(), 21u);
  const Output strict = ayumi({"check", kWalk, "--tolerance", "joint_speed=0.5", "--json"});
  EXPECT_EQ(strict.exit_code, 1);
  EXPECT_EQ(Json::parse(strict.out)["findings"][0]["kind"], "joint_speed");
  const Output wrong = ayumi({"check", kWalk, "--tolerance", "joint_sped=0.5"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("did you mean 'joint_speed'?"), std::string::npos) << wrong.err;
  EXPECT_EQ(ayumi({"check"}).exit_code, 2);
}

TEST_F(CheckRepair, SeveralInputsGiveOneObject) {
  const Output two = ayumi({"check", kWalk, kWalk, "--json"});
  EXPECT_EQ(two.exit_code, 0) << two.err;
  EXPECT_EQ(Json::parse(two.out)["checks"].size(), 2u);
}

TEST_F(CheckRepair, AZmpOutsideIsFoundAndRepaired) {
  plant_zmp_outside("outside.json");
  const Output found = ayumi({"check", "outside.json", "--json"});
  EXPECT_EQ(found.exit_code, 1);
  EXPECT_EQ(Json::parse(found.out)["verdict"], "inconsistent");

  const Output repaired = ayumi({"repair", "outside.json", "-o", "good.json", "--json"});
  ASSERT_EQ(repaired.exit_code, 0) << repaired.out << repaired.err;
  const Json json = Json::parse(repaired.out);
  EXPECT_EQ(json["status"], "repaired");
  EXPECT_EQ(json["check"]["verdict"], "consistent");
  EXPECT_LE(json["constraint_violation"], 1e-6);
  EXPECT_GT(json["moved"]["max_cog_m"], 0.005);

  // The author's text with one member more; it passes the check as a file.
  const std::string before = contents(folder / "outside.json"),
                    after = contents(folder / "good.json");
  const size_t end = before.rfind(']');
  EXPECT_EQ(after.substr(0, end), before.substr(0, end));
  EXPECT_EQ(ayumi({"check", "good.json"}).exit_code, 0);

  // Once more changes nothing, byte for byte.
  const Output again = ayumi({"repair", "good.json", "-o", "again.json", "--json"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(Json::parse(again.out)["status"], "already_consistent");
  EXPECT_EQ(contents(folder / "again.json"), after);
}

TEST_F(CheckRepair, WhatCannotBeRepairedWritesNothing) {
  // The first posture itself is out of limits, and the joint may not move.
  plant("bad.json", R"({ "t": 0, "zmp": "center" })",
        R"({ "t": 0, "zmp": "center", "posture": { "l_elbow": -95 } })");
  const Output failed =
      ayumi({"repair", "bad.json", "-o", "out.json", "--lock", "l_elbow", "--json"});
  EXPECT_EQ(failed.exit_code, 4) << failed.out << failed.err;
  const Json json = Json::parse(failed.out);
  EXPECT_NE(json["status"], "repaired");
  ASSERT_FALSE(json["reasons"].empty());
  EXPECT_NE(std::string(json["reasons"][0]).find("l_elbow"), std::string::npos);
  EXPECT_EQ(folder.files(), std::vector<std::string>{"bad.json"});
}

TEST_F(CheckRepair, MistakesOfTheCall) {
  const Output joint = ayumi({"repair", kWalk, "-o", "out.json", "--lock", "l_kne"});
  EXPECT_EQ(joint.exit_code, 2) << joint.out << joint.err;
  EXPECT_NE(joint.err.find("did you mean 'l_knee'?"), std::string::npos) << joint.err;
  EXPECT_EQ(ayumi({"repair", kWalk}).exit_code, 2);
  EXPECT_EQ(ayumi({"check", "missing.json"}).exit_code, 3);
  write(folder / "there.json", "{}");
  EXPECT_EQ(ayumi({"repair", kWalk, "-o", "there.json"}).exit_code, 3);
  EXPECT_EQ(contents(folder / "there.json"), "{}");
}

}  // namespace
}  // namespace ayumi::test
