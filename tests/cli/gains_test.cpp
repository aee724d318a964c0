// ayumi gains, tune, explain: numbers one can work out by hand, and reasons for refusals.

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

Output run(const std::vector<std::string>& words) {
  const Folder folder;
  return run_program(words, folder.path());
}

TEST(GainsCommand, PolesGiveKAndD) {
  const Output made = run({"gains", "hoap1", "--time-constants", "0.2,0.5", "--absorb", "0.6",
                           "--return-time", "0.1", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Json json = Json::parse(made.out);
  const double w = json["omega_1_s"];
  EXPECT_NEAR(w, std::sqrt(9.80665 / 0.245), 1e-3);
  EXPECT_NEAR(json["K"].get<double>(), 1 + 5.0 * 2.0 / (w * w), 1e-9);
  EXPECT_NEAR(json["D_s"].get<double>(), 7.0 / (w * w), 1e-9);
  EXPECT_NEAR(json["gains"]["ka"].get<double>(), 1.5, 1e-9);
  EXPECT_NEAR(json["gains"]["ks"].get<double>(), 10 / w, 1e-9);
  EXPECT_TRUE(json["stable"].get<bool>());
  EXPECT_GT(json["decay_1_s"].get<double>(), 0);
  // Standing: m omega times the way to the front edge, 49 mm.
  EXPECT_NEAR(json["recoverable"][0]["dcm_m"].get<double>(), 0.049, 2e-4);
  EXPECT_NEAR(json["recoverable"][0]["impulse_Ns"].get<double>(), 6.5 * w * 0.049, 0.01);
}

TEST(GainsCommand, AConjugatePair) {
  const Output made = run({"gains", "hoap1", "--frequency", "1", "--damping", "0.7", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Json json = Json::parse(made.out);
  const double w = json["omega_1_s"], p = 2 * M_PI;
  EXPECT_NEAR(json["K"].get<double>(), 1 + p * p / (w * w), 1e-9);
  EXPECT_NEAR(json["D_s"].get<double>(), 2 * 0.7 * p / (w * w), 1e-9);
}

TEST(GainsCommand, RefusesWithTheReason) {
  const auto refused = [](const std::vector<std::string>& words, const std::string& why) {
    const Output made = run(words);
    EXPECT_EQ(made.exit_code, 2) << made.out;
    EXPECT_NE(made.err.find(why), std::string::npos) << made.err;
  };
  refused({"gains", "hoap1", "--poles", "1,-2"},
          "a pole with the real part 1 is not possible: it must be below 0");
  refused({"gains", "hoap1", "--gain", "k=1", "--gain", "d=1"}, "need K > 1 and D > 0");
  refused({"gains", "hoap1", "--gain", "k=2", "--gain", "d=0"}, "need K > 1 and D > 0");
  refused({"gains", "hoap1", "--absorb", "0.95"}, "the loop is unstable with");
  refused({"gains", "hoap1", "--latency", "0.05"}, "sensors and servos that are 50 ms late");
  refused({"gains", "hoap1", "--absorb", "1"}, "an absorbed share of 1 is not possible");
  refused({"gains", "hoap1", "--poles", "-1,-2", "--time-constants", "1,2"},
          "the poles are given more than once");
}

TEST(GainsCommand, WhatItRefusesIsNotRunUnlessAsked) {
  const std::string walk = AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json";
  for (const char* command : {"simulate", "run", "push"}) {
    const Output made = run({command, walk, "-o", "out", "--gain", "ka=40"});
    EXPECT_EQ(made.exit_code, 3) << command << made.out;
    EXPECT_NE(made.err.find("the loop is unstable with"), std::string::npos) << made.err;
    EXPECT_NE(made.err.find("--allow-unstable"), std::string::npos) << made.err;
  }
  const std::vector<std::string> simulate = {"simulate", walk, "--scenario", "none", "--json"};
  const auto outcome = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = simulate;
    words.insert(words.end(), more.begin(), more.end());
    return Json::parse(run(words).out)["outcome"].get<std::string>();
  };
  EXPECT_FALSE(outcome({"--gain", "ka=40", "--allow-unstable"}).empty());
  EXPECT_EQ(outcome({"--controller", "dtad-literal", "--profile", "hoap1-soft"}),
            "fell");  // a demonstration needs no leave
}

TEST(TuneCommand, BettersItsObjectiveTheSameWayForAnyNumberOfThreads) {
  const Folder folder;
  const auto run_here = [&](std::vector<std::string> words) {
    return run_program(words, folder.path());
  };
  ASSERT_EQ(run_here({"new", "stand", "--duration", "1.2", "-o", "stand.json"}).exit_code, 0);
  std::vector<std::string> command = {
      "tune",    "stand.json", "--times",      "0.3",    "--tune",    "ka,ks",
      "--gain",  "ka=0.3",     "--directions", "2",      "--rounds",  "1",
      "--level", "0.8",        "--quiet",      "--json", "--threads", "1"};
  const Output first = run_here(command);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const Json json = Json::parse(first.out);
  EXPECT_EQ(json["start"]["ka"], 0.3);
  EXPECT_LT(json["after"]["objective"].get<double>(), json["before"]["objective"].get<double>());
  EXPECT_NE(json["gains"], json["start"]);
  command.back() = "2";
  EXPECT_EQ(run_here(command).out, first.out);
  // The text of the author stays; the gains stand in it.
  write(folder / "mine.json", "// Mine.\n" + contents(folder / "stand.json"));
  command[1] = "mine.json";
  command.insert(command.end(), {"-o", "tuned.json"});
  const Output written = run_here(command);
  ASSERT_EQ(written.exit_code, 0) << written.err;
  EXPECT_EQ(Json::parse(written.out)["output"], "tuned.json");
  const std::string text = contents(folder / "tuned.json");
  EXPECT_EQ(text.rfind("// Mine.\n", 0), 0u);
  const Json tuned = Json::parse(text, nullptr, true, true);
  EXPECT_EQ(tuned["controller"]["gains"], Json::parse(written.out)["gains"]);
  EXPECT_EQ(tuned["keyframes"],
            Json::parse(contents(folder / "stand.json"), nullptr, true, true)["keyframes"]);
  EXPECT_EQ(run_here(command).exit_code, 3);  // the file exists
  const Output wrong = run_here({"tune", "stand.json", "--tune", "kb"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("gain 'kb' cannot be tuned"), std::string::npos) << wrong.err;
}

TEST(ExplainCommand, WordsAndTheNumbersOfARun) {
  const Folder folder;
  const auto run_here = [&](std::vector<std::string> words) {
    return run_program(words, folder.path());
  };
  const Output words = run_here({"explain", "(17)"});
  EXPECT_EQ(words.exit_code, 0);
  EXPECT_EQ(words.out.rfind("(17)  w2 = f_z / (m (z_G - z_Z))", 0), 0u) << words.out;
  ASSERT_EQ(run_here({"new", "stand", "--duration", "0.3", "-o", "stand.json"}).exit_code, 0);
  ASSERT_EQ(run_here({"simulate", "stand.json", "-o", "run", "-q"}).exit_code, 0);
  const Output numbers = run_here({"explain", "17", "run@0.2"});
  ASSERT_EQ(numbers.exit_code, 0) << numbers.err;
  // g / z = 9.80665 / 0.245, the reference force being near the weight
  EXPECT_NE(numbers.out.find("(6.50 kg x 245.0 mm) = 40.0"), std::string::npos) << numbers.out;
  for (int n = 1; n <= 29; ++n) {
    const Output each = run_here({"explain", std::to_string(n), "run@0.2", "--json"});
    ASSERT_EQ(each.exit_code, 0) << n << each.err;
    EXPECT_EQ(Json::parse(each.out)["equation"], n);
  }
  const Output late = run_here({"explain", "18", "run@20"});
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_NE(late.err.find("t = 20 s is outside the run"), std::string::npos) << late.err;
  EXPECT_EQ(run_here({"explain", "30"}).exit_code, 2);
  EXPECT_EQ(run_here({"explain", "18", "run"}).exit_code, 2);
}

}  // namespace
}  // namespace ayumi::test
