// `ayumi push` gives the same for any number of threads, continues where it was stopped, and draws
// its map.

#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"
#include "tests/support/resealed.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

struct Study {
  Folder folder;
  std::vector<std::string> command = {"push",
                                      "stand.json",
                                      "--quiet",
                                      "--controller",
                                      "dtad",
                                      "--times",
                                      "0.5",
                                      "--directions",
                                      "2",
                                      "--replicas",
                                      "0",
                                      "--step",
                                      "0.3",
                                      "--cap",
                                      "1.5",
                                      "-o",
                                      "results.json",
                                      "--threads",
                                      "1"};
  Study() {
    const Output made = run({"new", "stand", "--duration", "1.5", "-o", "stand.json"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
  }
  Output run(std::vector<std::string> words, const std::vector<std::string>& more = {}) const {
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words, folder.path());
  }
};

TEST(PushCommand, GoesOnFromItsResultsForAnyNumberOfThreads) {
  const Study study;
  const Output first = study.run(study.command);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find("pushes during the motion, dtad: smallest push limit"),
            std::string::npos)
      << first.out;
  const std::string whole = contents(study.folder / "results.json");
  Json partly = json_of(whole);
  ASSERT_EQ(partly["cases"].size(), 2u);
  for (const Json& c : partly["cases"]) {
    EXPECT_GT(c["bound_Ns"].get<double>(), 1.5);
    EXPECT_GT(c["limits"][0]["impulse_Ns"].get<double>(), 0.8 * c["bound_Ns"].get<double>());
  }
  partly["cases"].erase(0);
  partly["cases"][0]["open_loop"]["runs"] = 1234;  // this result is kept and not computed again
  write(study.folder / "results.json", resealed(partly));
  std::vector<std::string> again = study.command;
  again.back() = "2";
  ASSERT_EQ(study.run(again).exit_code, 0);
  Json joined = json_of(contents(study.folder / "results.json"));
  EXPECT_EQ(joined["cases"][1]["open_loop"]["runs"], 1234);
  joined["cases"][1]["open_loop"]["runs"] = json_of(whole)["cases"][1]["open_loop"]["runs"];
  EXPECT_EQ(resealed(joined), resealed(json_of(whole)));

  const Output other = study.run(study.command, {"--gain", "ka=1"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_NE(
      other.err.find("results.json: this file contains the results of a study with other settings"),
      std::string::npos)
      << other.err;

  for (const auto& [place, value] :
       {std::pair("/cases/0/mass_kg", -0.0), std::pair("/cases/0/bound_Ns", 1e308),
        std::pair("/cases/0/direction_rad", 1e308),
        std::pair("/cases/0/open_loop/impulse_Ns", -1.0),
        std::pair("/cases/0/limits/0/impulse_Ns", 1e308)}) {
    Json edited = json_of(whole);
    edited[Json::json_pointer(place)] = value;
    write(study.folder / "results.json", resealed(edited));
    const Output refused = study.run(study.command);
    EXPECT_EQ(refused.exit_code, 3) << place << refused.out;
    EXPECT_NE(refused.err.find("this file contains numbers that are not possible for a push"),
              std::string::npos)
        << place << refused.err;
  }
}

// An edited limit would be believed when the study is continued.
TEST(PushCommand, RefusesResultsThatWereEdited) {
  const Study study;
  ASSERT_EQ(study.run(study.command).exit_code, 0);
  const std::string whole = contents(study.folder / "results.json");
  EXPECT_TRUE(is_sealed(whole));
  Json older = json_of(whole);
  older.erase(kSealKey);
  std::string edited = whole;
  edited.replace(edited.find("\"capped\": false"), 15, "\"capped\": true ");
  for (const auto& [text, why] :
       {std::pair(edited, "the file has changed since Ayumi wrote it"),
        std::pair(older.dump(1),
                  "older version of Ayumi wrote the file, or the file was changed")}) {
    write(study.folder / "results.json", text);
    const Output refused = study.run(study.command);
    EXPECT_EQ(refused.exit_code, 3) << refused.out;
    EXPECT_NE(refused.err.find(why), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("replace the file with --force"), std::string::npos) << refused.err;
    EXPECT_EQ(contents(study.folder / "results.json"), text);
  }
}

// In an earlier version, the comparison with the program's own study descended into these results
// by recursion, and the program crashed.
TEST(PushCommand, RefusesResultsThatAreNestedDeeply) {
  const Study study;
  const std::string deep = std::string(300'000, '[') + std::string(300'000, ']');
  write(study.folder / "results.json",
        R"({"format": "ayumi.push/1", "study": {"a": )" + deep + R"(}, "cases": []})");
  const Output refused = study.run(study.command);
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("results.json: this file does not contain results of ayumi push"),
            std::string::npos)
      << refused.err;
}

TEST(PushCommand, DrawsItsMapAndPrintsJson) {
  const Study study;
  const Output bad = study.run(study.command, {"--map", "map.jpg"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_NE(bad.err.find("map.jpg: the name must end in .svg or .png"), std::string::npos);
  EXPECT_FALSE(fs::exists(study.folder / "results.json")) << "told before the work";
  const Output good = study.run(study.command, {"--map", "map.svg", "--json"});
  ASSERT_EQ(good.exit_code, 0) << good.err;
  const Json json = json_of(good.out);
  EXPECT_EQ(json["thresholds"].size(), 2u);
  EXPECT_GT(json["worst_ratio"].get<double>(), 0.8);
  // J/m and J/(m sqrt(g z)) follow from the robot's mass and the height of its COG.
  const Json stored = json_of(contents(study.folder / "results.json"))["cases"][0];
  const double mass = stored["mass_kg"], height = stored["height_m"];
  EXPECT_NEAR(mass, 6, 1);
  EXPECT_NEAR(height, 0.245, 0.005);
  for (const Json& t : json["thresholds"]) {
    const double impulse = t["impulse_Ns"], speed = impulse / mass;
    EXPECT_NEAR(t["J_per_m_m_per_s"].get<double>(), speed, 1e-12);
    EXPECT_NEAR(t["J_per_m_sqrt_gz"].get<double>(), speed / std::sqrt(9.80665 * height), 1e-12);
    EXPECT_LE(json["summary"][0]["walking"]["worst_J_per_m_m_per_s"].get<double>(), speed + 1e-12);
  }
  const std::string map = contents(study.folder / "map.svg");
  EXPECT_NE(map.find("capture bound B"), std::string::npos);
  EXPECT_NE(map.find("t = 0.500 s"), std::string::npos);
  EXPECT_EQ(study.run(study.command, {"--map", "map.svg"}).exit_code, 3) << "not overwritten";
}

TEST(PushCommand, NamesWhatIsWrong) {
  const Study study;
  const Output gain = study.run(study.command, {"--gain", "kaa=1"});
  EXPECT_EQ(gain.exit_code, 2);
  EXPECT_NE(gain.err.find("dtad has no gain 'kaa'"), std::string::npos) << gain.err;
  const Output k = study.run(study.command, {"--gain", "k=0.9", "--gain", "d=1"});
  EXPECT_EQ(k.exit_code, 2);
  EXPECT_NE(k.err.find("need K > 1 and D > 0"), std::string::npos) << k.err;
}

}  // namespace
}  // namespace ayumi::test
