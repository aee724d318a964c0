// `ayumi gains`, `tune` and `explain`: numbers that can be computed by hand, and reasons for
// refusals.

#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "ayumi/base/text.hpp"
#include "ayumi/io/run/log_fields.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

Output run(const std::vector<std::string>& words) {
  const Folder folder;
  return run_program(words, folder.path());
}

// An empty number, or one that no double can hold, is no number. A gain has the limits that it has
// in a pattern.
TEST(GainsCommand, ValuesOutOfRangeAreRefused) {
  const std::pair<std::string, std::string> cases[] = {
      {"ka=", "'ka=' does not have the form NAME=NUMBER"},
      {"ka=1x", "'ka=1x' does not have the form NAME=NUMBER"},
      {"=1", "'=1' does not have the form NAME=NUMBER"},
      {"ka=1e999", "the number of 'ka=1e999' is too large or too near to 0"},
      {"ka=1e-400", "the number of 'ka=1e-400' is too large or too near to 0"},
      {"q=1e160", "'q=1e160' is out of range. The number must be from -1e6 to 1e6"},
      {"q=nan", "'q=nan' is out of range"}};
  for (const auto& [word, message] : cases) {
    const Output output = run({"gains", "hoap1", "--gain", word});
    EXPECT_EQ(output.exit_code, 2) << word;
    EXPECT_NE(output.err.find(message), std::string::npos) << output.err;
  }
  const Output output = run({"gains", "hoap1", "--return-time", "1e-300"});
  EXPECT_EQ(output.exit_code, 2);
  EXPECT_NE(output.err.find("a gain must be from 0 to 1e+06"), std::string::npos) << output.err;
  // The largest gains have poles, too, and are called unstable.
  const Output large = run({"gains", "hoap1", "--gain", "q=1000000", "--gain", "ks=1000000"});
  EXPECT_NE(large.exit_code, 0) << large.out;
  EXPECT_NE(large.exit_code, 5) << large.err;
}

TEST(GainsCommand, PolesGiveKAndD) {
  const Output made = run({"gains", "hoap1", "--time-constants", "0.2,0.5", "--absorb", "0.6",
                           "--return-time", "0.1", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Json json = json_of(made.out);
  const double w = json["omega_1_s"];
  EXPECT_NEAR(w, std::sqrt(9.80665 / 0.245), 1e-3);
  EXPECT_NEAR(json["K"].get<double>(), 1 + 5.0 * 2.0 / (w * w), 1e-9);
  EXPECT_NEAR(json["D_s"].get<double>(), 7.0 / (w * w), 1e-9);
  EXPECT_NEAR(json["gains"]["ka"].get<double>(), 1.5, 1e-9);
  EXPECT_NEAR(json["gains"]["ks"].get<double>(), 10 / w, 1e-9);
  EXPECT_TRUE(json["stable"].get<bool>());
  EXPECT_GT(json["decay_1_s"].get<double>(), 0);
  // The impulse of a standing robot is m omega times the distance to the front edge, 49 mm.
  EXPECT_NEAR(json["recoverable"][0]["dcm_m"].get<double>(), 0.049, 2e-4);
  EXPECT_NEAR(json["recoverable"][0]["impulse_Ns"].get<double>(), 6.5 * w * 0.049, 0.01);
}

TEST(GainsCommand, AConjugatePair) {
  const Output made = run({"gains", "hoap1", "--frequency", "1", "--damping", "0.7", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Json json = json_of(made.out);
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
          "a pole with the real part 1 is not possible: the real part must be below 0");
  refused({"gains", "hoap1", "--gain", "k=1", "--gain", "d=1"}, "need K > 1 and D > 0");
  refused({"gains", "hoap1", "--gain", "k=2", "--gain", "d=0"}, "need K > 1 and D > 0");
  refused({"gains", "hoap1", "--absorb", "0.95"}, "the loop is unstable with");
  refused({"gains", "hoap1", "--latency", "0.05"}, "sensors and servos that are 50 ms late");
  refused({"gains", "hoap1", "--absorb", "1"}, "a short-term absorption of 1 is not possible");
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
    return json_of(run(words).out)["outcome"].get<std::string>();
  };
  EXPECT_FALSE(outcome({"--gain", "ka=40", "--allow-unstable"}).empty());
  EXPECT_EQ(outcome({"--controller", "dtad-literal", "--profile", "hoap1-soft"}),
            "fell");  // demonstrations need no --allow-unstable
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
  const Json json = json_of(first.out);
  EXPECT_EQ(json["start"]["ka"], 0.3);
  EXPECT_LT(json["after"]["objective"].get<double>(), json["before"]["objective"].get<double>());
  EXPECT_NE(json["gains"], json["start"]);
  command.back() = "2";
  EXPECT_EQ(run_here(command).out, first.out);
  // The text of the author stays, with the gains added to it.
  write(folder / "mine.json", "// Mine.\n" + contents(folder / "stand.json"));
  command[1] = "mine.json";
  command.insert(command.end(), {"-o", "tuned.json"});
  const Output written = run_here(command);
  ASSERT_EQ(written.exit_code, 0) << written.err;
  EXPECT_EQ(json_of(written.out)["output"], "tuned.json");
  const std::string text = contents(folder / "tuned.json");
  EXPECT_EQ(text.rfind("// Mine.\n", 0), 0u);
  const Json tuned = json_of(text, true);
  EXPECT_EQ(tuned["controller"]["gains"], json_of(written.out)["gains"]);
  EXPECT_EQ(tuned["keyframes"], json_of(contents(folder / "stand.json"), true)["keyframes"]);
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
  std::set<std::string> formulas;
  for (int n = 1; n <= 29; ++n) {
    const Output each = run_here({"explain", std::to_string(n), "run@0.2", "--json"});
    ASSERT_EQ(each.exit_code, 0) << n << each.err;
    EXPECT_EQ(json_of(each.out)["equation"], n);
    formulas.insert(json_of(each.out)["formula"]);
  }
  EXPECT_EQ(formulas.size(), 29u);
  EXPECT_EQ(
      run_here({"explain", "22"}).out.rfind("(22)  minimise 1/2 (cmd dtheta - ref dtheta)'", 0),
      0u);
  const Output late = run_here({"explain", "18", "run@20"});
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_NE(late.err.find("t = 20 s is outside the run"), std::string::npos) << late.err;
  EXPECT_EQ(run_here({"explain", "30"}).exit_code, 2);
  EXPECT_EQ(run_here({"explain", "18", "run"}).exit_code, 2);
}

/// Writes the samples before, at and after k as a log of their own, in which they are 0, 1 and 2,
/// because reading the whole log takes a third of a second. Events keep their distance from the
/// sample.
void write_instant(const SimulationLog& log, size_t k, const fs::path& file) {
  SimulationLog instant = log;
  const size_t first = k > 0 ? k - 1 : 0;
  instant.samples = {log.samples.at(first), log.samples.at(k),
                     log.samples.at(std::min(k + 1, log.samples.size() - 1))};
  for (SimulationEvent& event : instant.events) event.t -= log.dt * (static_cast<double>(k) - 1);
  write_log(file, instant);
}

/// The text that `explain` prints about the sample that write_instant() puts in the middle.
Output explained(int equation, const Folder& folder, double dt, bool json) {
  std::vector<std::string> words = {"explain", std::to_string(equation),
                                    "instant.bin@" + text::exact(dt)};
  if (json) words.push_back("--json");
  return run_program(words, folder.path());
}

/// Every column of a log's sample, by its name.
std::map<std::string, double> columns_of(const SimulationLog& log, size_t k) {
  std::string bytes;
  append_values(log.samples.at(k), log.joints.size(), bytes);
  std::map<std::string, double> columns;
  size_t at = 0;
  for (const LogQuantity& quantity : log_quantities(log.joints))
    for (size_t c = 0; c < quantity.columns(); ++c, at += sizeof(double))
      std::memcpy(&columns[quantity.column(c)], bytes.data() + at, sizeof(double));
  EXPECT_EQ(at, bytes.size());
  return columns;
}

struct Explained {
  const char *name, *pattern;
  std::vector<std::string> options;
  std::vector<double> times;
  bool all = false;
};

// All equations under open loop, DTAD, the literal law, VIIP's steps under a push and its jump:
// stance, swing, push, flight and landing. `value` is the log's own number, and `computed` is what
// the equation makes of the other numbers.
TEST(ExplainCommand, EveryNumberIsTheLogsOwn) {
  const std::string patterns = AYUMI_SOURCE_DIR "/patterns/";
  const Explained runs[] = {
      {"open", "hoap1_walk", {"--controller", "none", "--scenario", "none"}, {3.005}},
      {"dtad", "hoap1_walk", {}, {3.005, 0, 3.35}, true},
      {"gains", "hoap1_walk", {"--gain", "ka=0.7", "--gain", "q=0.5"}, {3.05}},
      {"literal", "hoap1_walk", {"--controller", "dtad-literal"}, {0.4}},
      {"preview", "hoap1_walk", {"--controller", "preview"}, {3.05, 3.3}},
      {"guided", "hoap1_walk", {"--controller", "foot-guided"}, {3.05, 3.3}},
      {"steps", "hoap1_walk", {"--controller", "dcm-step"}, {3.05, 3.3}},
      {"viip", "hoap1_viip_step", {}, {2.21, 0.2, 2.6}, true},
      {"jump", "hoap1_jump", {}, {1.32, 0.5, 1.45, 1.55, 2.4}, true},
  };
  const std::set<int> groups = {5, 14, 16, 17, 18, 20, 21, 22, 24};
  for (const Explained& run : runs) {
    const Folder folder;
    std::vector<std::string> words = {"simulate", patterns + run.pattern + ".json", "-o", "run",
                                      "-q"};
    words.insert(words.end(), run.options.begin(), run.options.end());
    run_program(words, folder.path());
    const SimulationLog log = read_run_log(folder / "run");
    size_t computed = 0;
    for (const double t : run.times) {
      const auto k = static_cast<size_t>(std::lround(t / log.dt));
      const std::map<std::string, double> columns = columns_of(log, k);
      write_instant(log, k, folder / "instant.bin");
      size_t values = 0;
      for (int n = 1; n <= 29; ++n) {
        // For DTAD, VIIP and its jump, all equations are tested once; otherwise one of each group.
        if (!(run.all && t == run.times[0]) && !groups.contains(n)) continue;
        SCOPED_TRACE(std::string(run.name) + " (" + std::to_string(n) + ") at " +
                     std::to_string(t));
        // Equation (14) is explained from the log of the whole run, in which the row of the time
        // has to be found.
        const Output each =
            n == 14
                ? run_program({"explain", "14", "run@" + text::exact(t), "--json"}, folder.path())
                : explained(n, folder, log.dt, true);
        ASSERT_EQ(each.exit_code, 0) << each.err;
        const Json json = json_of(each.out);
        for (const Json& value : json.at("values")) {
          ++values;
          const std::string name = value.at("name");
          ASSERT_TRUE(columns.contains(name)) << name;
          const double own = columns.at(name), scale = std::max(1.0, std::abs(own));
          EXPECT_NEAR(value.at("value").get<double>(), own, 1e-9 * scale) << name;
          if (!value.contains("computed")) continue;
          ++computed;
          EXPECT_NEAR(value.at("computed").get<double>(), own, 1e-9 * scale) << name;
        }
      }
      EXPECT_GT(values, 30u) << run.name << " at " << t;
    }
    if (std::string(run.name) != "open") {
      EXPECT_GT(computed, 3u) << run.name;
    }
  }
}

// A baseline is named, and the text does not say that its ZMP follows from an equation of the
// paper.
TEST(ExplainCommand, NamesTheBaselineThatChoseTheZmp) {
  for (const auto& [name, words] : {std::pair{"preview", "is the ZMP of the previewed COG"},
                                    std::pair{"foot-guided", "times the error of the DCM"}}) {
    const Folder folder;
    ASSERT_EQ(
        run_program({"new", "stand", "--duration", "0.3", "-o", "stand.json", "--force", "-q"},
                    folder.path())
            .exit_code,
        0);
    ASSERT_EQ(run_program({"simulate", "stand.json", "--controller", name, "-o", "run", "-q"},
                          folder.path())
                  .exit_code,
              0);
    const std::string said = run_program({"explain", "18", "run@0.2"}, folder.path()).out;
    EXPECT_NE(
        said.find("the controller " + std::string(name) + " chooses the ZMP in place of (18)(19)"),
        std::string::npos)
        << said;
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_EQ(said.find("K = "), std::string::npos) << said;
  }
}

// The text says that a ZMP is moved into the support exactly where this happened in the log.
TEST(ExplainCommand, SaysCutOnlyWhereSomethingWasCut) {
  const Folder folder;
  std::string pattern = contents(kWalk);  // the pattern has a push that moves the ZMP to the edge
  const std::string gentle = "\"impulse\": 1.1", hard = "\"impulse\": 1.5";
  ASSERT_NE(pattern.find(gentle), std::string::npos);
  pattern.replace(pattern.find(gentle), gentle.size(), hard);
  write(folder / "hard.json", pattern);
  ASSERT_EQ(run_program({"simulate", "hard.json", "-o", "run", "-q"}, folder.path()).exit_code, 0);
  const SimulationLog log = read_run_log(folder / "run");
  int cut = 0, whole = 0;
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const SimulationSample& s = log.samples[k];
    const bool moved = (s.reference_zmp - s.law.wanted_zmp).head<2>().norm() > 1e-12;
    // Four samples of each kind are enough.
    int& count = moved ? cut : whole;
    if (count == 4 || (count > 0 && k % 50 != 0)) continue;
    ++count;
    write_instant(log, k, folder / "instant.bin");
    const std::string words = explained(18, folder, log.dt, false).out;
    EXPECT_EQ(words.find("nearest point of the support of") != std::string::npos, moved) << words;
    EXPECT_EQ(words.find("inside the support of") != std::string::npos, !moved) << words;
  }
  EXPECT_GT(cut, 0);
  EXPECT_GT(whole, 0);
}

}  // namespace
}  // namespace ayumi::test
