// The commands edit and import, and check with --watch.

#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

class Edit : public testing::Test {
 protected:
  Output ayumi(const std::vector<std::string>& arguments) {
    return run_program(arguments, folder.path());
  }
  Folder folder;
};

TEST_F(Edit, BakedMotionIsTheSameMotion) {
  const Output baked = ayumi({"edit", "bake", kWalk, "-o", "baked.json", "--json"});
  ASSERT_EQ(baked.exit_code, 0) << baked.out << baked.err;
  const Json json = json_of(baked.out);
  EXPECT_EQ(json["check"]["verdict"], "consistent");
  EXPECT_EQ(json["table"], "baked.csv");
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"baked.csv", "baked.json"}));
  const Output again = ayumi({"check", "baked.json", "--json"});
  EXPECT_EQ(again.exit_code, 0) << again.out << again.err;
  // Baking a baked pattern changes nothing, not even a byte.
  ASSERT_EQ(ayumi({"edit", "bake", "baked.json", "-o", "twice.json"}).exit_code, 0);
  EXPECT_EQ(contents(folder / "twice.csv"), contents(folder / "baked.csv"));
  // An existing file is not overwritten.
  EXPECT_EQ(ayumi({"edit", "bake", kWalk, "-o", "baked.json"}).exit_code, 3);
}

// The pattern is named from another folder by a path that goes up: its table is found beside the
// new pattern.
TEST_F(Edit, ATableIsFoundFromWhereverItsPatternWasMade) {
  fs::create_directories(folder / "in");
  fs::create_directories(folder / "out");
  ASSERT_EQ(ayumi({"new", "squat", "-q", "-o", "in/squat.json"}).exit_code, 0);
  const auto beside = [&](const std::vector<std::string>& arguments) {
    return run_program(arguments, folder / "out");
  };
  const Output baked = beside({"edit", "bake", "../in/squat.json", "-o", "baked.json"});
  ASSERT_EQ(baked.exit_code, 0) << baked.err;
  EXPECT_EQ(beside({"check", "baked.json"}).exit_code, 0) << beside({"check", "baked.json"}).err;
  EXPECT_NE(contents(folder / "out/baked.json").find(R"("table": "baked.csv")"), std::string::npos);
  const Output again = beside({"edit", "mirror", "./baked.json", "-o", "../in/mirrored.json"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(ayumi({"check", "in/mirrored.json"}).exit_code, 0);
  EXPECT_NE(contents(folder / "in/mirrored.json").find(R"("table": "mirrored.csv")"),
            std::string::npos);
}

// In an earlier version, the name of a kept sequence was relative to the folder itself, but was
// read relative to the link.
TEST_F(Edit, AKeptSequenceIsFoundThroughALink) {
  fs::create_directories(folder / "in");
  fs::create_directories(folder / "deep/er");
  fs::create_directory_symlink("deep/er", folder / "link");
  ASSERT_EQ(ayumi({"new", "squat", "-q", "-o", "squat.json"}).exit_code, 0);
  ASSERT_EQ(ayumi({"export", "squat.json", "--format", "hoap", "-o", "h.csv"}).exit_code, 0);
  const Output in = ayumi({"import", "h.csv", "--robot", "hoap1", "-o", "in/i.json"});
  ASSERT_EQ(in.exit_code, 0) << in.err;
  ASSERT_EQ(ayumi({"edit", "retime", "in/i.json", "--scale", "1", "-o", "link/m.json"}).exit_code,
            0);
  for (const std::string from : {"link", "deep/er"}) {
    const Output out =
        ayumi({"export", from + "/m.json", "--format", "hoap", "-o", "back.csv", "--force"});
    EXPECT_EQ(out.exit_code, 0) << from << ": " << out.err;
    EXPECT_EQ(contents(folder / "back.csv"), contents(folder / "h.csv")) << from;
  }
}

TEST_F(Edit, MirroredTwiceIsTheSameFile) {
  ASSERT_EQ(ayumi({"edit", "mirror", kWalk, "-o", "a.json"}).exit_code, 0);
  ASSERT_EQ(ayumi({"edit", "mirror", "a.json", "-o", "b.json"}).exit_code, 0);
  ASSERT_EQ(ayumi({"edit", "mirror", "b.json", "-o", "c.json"}).exit_code, 0);
  EXPECT_EQ(contents(folder / "a.json"), contents(folder / "c.json"));
  EXPECT_NE(contents(folder / "a.json"), contents(folder / "b.json"));
}

TEST_F(Edit, RetimeToLimitsIsTheFastestThatPasses) {
  const Output out =
      ayumi({"edit", "retime", kWalk, "--to-limits", "-o", "fast.json", "--json", "-q"});
  ASSERT_EQ(out.exit_code, 0) << out.out << out.err;
  const Json json = json_of(out.out);
  const double scale = json["scale"];
  EXPECT_LT(scale, 1);
  EXPECT_FALSE(json["limited_by"].is_null());
  // The COG keeps its height in this walk, so that the force stays equal to the weight.
  EXPECT_NEAR(double(json["fz_N"]["after"][1]), double(json["fz_N"]["before"][1]), 1e-6);
  EXPECT_LT(double(json["zmp_margin_m"]["after"]), double(json["zmp_margin_m"]["before"]));
  EXPECT_EQ(ayumi({"check", "fast.json"}).exit_code, 0);
  const std::string faster = std::to_string(scale * 0.995);
  const Output broken = ayumi({"edit", "retime", kWalk, "--scale", faster, "-o", "b.json"});
  EXPECT_NE(broken.exit_code, 0);
}

// The motion is only slower where a limit binds: it is quicker than at one pace, and equally good
// for the check.
TEST_F(Edit, RetimeLocallyIsQuicker) {
  const auto retimed = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"edit", "retime", kWalk, "--to-limits", "--json", "-q"});
    const Output out = ayumi(options);
    EXPECT_EQ(out.exit_code, 0) << out.out << out.err;
    return json_of(out.out);
  };
  const Json uniform = retimed({"-o", "uniform.json"});
  const Json local = retimed({"--local", "-o", "local.json"});
  EXPECT_LE(double(local["duration_s"]), 0.9 * double(uniform["duration_s"]));
  EXPECT_EQ(local["check"]["verdict"], "consistent");
  EXPECT_EQ(local["table"], "local.csv");
  double share = 0;
  for (const Json& limit : local["limited_by"]) share += double(limit["share"]);
  EXPECT_NEAR(share, 1, 1e-9);
  EXPECT_EQ(ayumi({"check", "local.json"}).exit_code, 0);
  // The whole support may be used if the author says so.
  const Json bare = retimed({"--local", "--margin", "0", "-o", "bare.json"});
  EXPECT_LT(double(bare["duration_s"]), double(local["duration_s"]));
  EXPECT_LT(double(bare["zmp_margin_m"]["after"]), double(local["zmp_margin_m"]["after"]));

  EXPECT_EQ(ayumi({"edit", "retime", kWalk, "--scale", "2", "--local", "-o", "a.json"}).exit_code,
            2);
  EXPECT_EQ(
      ayumi({"edit", "retime", kWalk, "--to-limits", "--margin", "0", "-o", "a.json"}).exit_code,
      2);
}

// The time in which nothing moves is as long as in the given motion, so that a choreography stays
// in time.
TEST_F(Edit, RetimeKeepsPausesWhereAsked) {
  ASSERT_EQ(ayumi({"new", "bow", "-o", "bow.json", "-q"}).exit_code, 0);
  const auto retimed = [&](const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> words = {
        "edit", "retime", "bow.json", "--to-limits", "--local", "--json", "-q", "-o", out};
    words.insert(words.end(), more.begin(), more.end());
    const Output made = ayumi(words);
    EXPECT_EQ(made.exit_code, 0) << made.out << made.err;
    return json_of(made.out);
  };
  const auto paused = [](const Json& json) {
    double share = 0;
    for (const Json& limit : json["limited_by"])
      if (limit["limit"] == "pause") share += double(limit["share"]);
    return share * double(json["duration_s"]);
  };
  const Json kept = retimed("kept.json", {"--keep-pauses"}), quick = retimed("quick.json", {});
  EXPECT_EQ(paused(quick), 0);
  EXPECT_GT(paused(kept), 0.5);
  // The moving parts are as quick with the pauses as without them.
  EXPECT_NEAR(double(kept["duration_s"]) - paused(kept), double(quick["duration_s"]),
              0.25 * double(quick["duration_s"]));
  EXPECT_EQ(ayumi({"check", "kept.json"}).exit_code, 0);
  // Pauses only concern local timing.
  EXPECT_EQ(ayumi({"edit", "retime", "bow.json", "--to-limits", "--keep-pauses", "-o", "a.json"})
                .exit_code,
            2);
}

// Two steps in the middle of a walk are repeated again and again.
TEST_F(Edit, TheCycleOfAWalkIsRepeated) {
  const auto looped = [&](const std::string& out, std::vector<std::string> more, int exit_code) {
    std::vector<std::string> words = {"edit", "loop", kWalk, "--cycle", "--json", "-q", "-o", out};
    words.insert(words.end(), more.begin(), more.end());
    const Output made = ayumi(words);
    EXPECT_EQ(made.exit_code, exit_code) << made.out << made.err;
    return json_of(made.out);
  };
  const Json whole = json_of(ayumi({"check", kWalk, "--json", "-q"}).out);
  const Json once = looped("once.json", {"--times", "1"}, 0);
  const Json thrice = looped("thrice.json", {"--times", "3"}, 0);
  const double cycle = double(once["cycle_s"][1]) - double(once["cycle_s"][0]);
  EXPECT_NEAR(cycle, 1.1, 1e-9);  // the cycle lasts two periods
  EXPECT_NEAR(double(thrice["duration_s"]), double(once["duration_s"]) + 2 * cycle, 1e-9);
  EXPECT_NEAR(double(once["displacement_m"][0]), 0.06, 1e-6);  // the cycle moves by two strides
  EXPECT_LT(double(once["gap"]["feet_m"]), 1e-6);
  EXPECT_EQ(thrice["check"]["verdict"], "consistent");
  EXPECT_EQ(whole["verdict"], "consistent");
  // The cycle alone begins and ends in the middle of a step, so that its table does not rest there.
  const Json alone = looped("alone.json", {"--times", "2", "--alone"}, 1);
  EXPECT_NEAR(double(alone["duration_s"]), 2 * cycle, 1e-9);
  for (const Json& finding : alone["check"]["findings"]) {
    if (finding["severity"] != "error") continue;
    EXPECT_EQ(finding["kind"], "table_rest");
  }

  // A walk of two steps has no such cycle, and asking for the cycle alone needs one.
  ASSERT_EQ(ayumi({"new", "walk", "--steps", "2", "-o", "short.json", "-q"}).exit_code, 0);
  const Output refused = ayumi({"edit", "loop", "short.json", "--cycle", "-o", "a.json", "-q"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("its end does not meet its beginning"), std::string::npos)
      << refused.err;
  EXPECT_NE(refused.err.find("(limits: feet 1.00 mm, base 0.02 mm"), std::string::npos)
      << refused.err;
  EXPECT_NE(ayumi({"edit", "loop", kWalk, "--alone", "-o", "a.json", "-q"}).exit_code, 0);
}

// The same motion is joined twice, and a squat follows where a walk that turned has ended.
TEST_F(Edit, MotionsJoin) {
  const Output made = ayumi({"new", "walk", "--steps", "2", "--turn", "4", "-o", "walk.json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  ASSERT_EQ(ayumi({"new", "squat", "-o", "squat.json"}).exit_code, 0);
  const Output out =
      ayumi({"edit", "concat", "squat.json", "squat.json", "-o", "two.json", "--json"});
  ASSERT_EQ(out.exit_code, 0) << out.out << out.err;
  const Json json = json_of(out.out);
  EXPECT_EQ(json["check"]["verdict"], "consistent");
  const double once = json["joins_s"][0];
  EXPECT_NEAR(double(json["duration_s"]), 2 * once, 1e-9);
  const Output blended = ayumi(
      {"edit", "blend", "walk.json", "squat.json", "--over", "0.5", "-o", "b.json", "--json"});
  ASSERT_EQ(blended.exit_code, 0) << blended.out << blended.err;
  EXPECT_EQ(json_of(blended.out)["check"]["verdict"], "consistent");
}

// Five times needs joins of one, two and four repetitions.
TEST_F(Edit, ALoopHasTheGivenNumberOfRepetitions) {
  ASSERT_EQ(ayumi({"new", "squat", "--robot", "hoap1", "-o", "squat.json"}).exit_code, 0);
  const auto looped = [&](const std::string& times) {
    const Output out = ayumi({"edit", "loop", "squat.json", "--times", times, "-o", "many.json",
                              "--force", "--json", "-q"});
    EXPECT_EQ(out.exit_code, 0) << out.out << out.err;
    return json_of(out.out);
  };
  const double once = looped("1")["duration_s"];
  for (const int times : {2, 3, 5}) {
    const Json json = looped(std::to_string(times));
    EXPECT_NEAR(double(json["duration_s"]), times * once, 1e-9);
    EXPECT_EQ(json["keys_kept"], true);
  }
}

// A kick has keys of a foot. They are kept, and moved to the places where the feet stand then.
TEST_F(Edit, ALoopKeepsTheKeysOfAFoot) {
  ASSERT_EQ(ayumi({"new", "kick", "--robot", "hoap1", "-o", "kick.json"}).exit_code, 0);
  const Output out =
      ayumi({"edit", "loop", "kick.json", "--times", "2", "-o", "kicks.json", "--json"});
  ASSERT_EQ(out.exit_code, 0) << out.out << out.err;
  const Json json = json_of(out.out);
  EXPECT_EQ(json["keys_kept"], true) << out.out;
  EXPECT_EQ(json["check"]["verdict"], "consistent");
  EXPECT_EQ(json["lost"], Json::array()) << "the comments of the kick stay";
  const std::string text = contents(folder / "kicks.json");
  EXPECT_EQ(text.substr(0, text.find('{')),
            contents(folder / "kick.json").substr(0, text.find('{')));
}

// What is lost is said before the file is written.
TEST_F(Edit, SaysWhatIsLost) {
  ASSERT_EQ(ayumi({"new", "kick", "--robot", "hoap1", "-o", "kick.json"}).exit_code, 0);
  const Output out = ayumi({"edit", "concat", "kick.json", "kick.json", "-o", "two.json"});
  EXPECT_EQ(out.out.find("not kept"), std::string::npos) << out.out;
  ASSERT_EQ(ayumi({"new", "squat", "--robot", "hoap1", "-o", "squat.json"}).exit_code, 0);
  const Output other =
      ayumi({"edit", "blend", "kick.json", "squat.json", "--over", "0.5", "-o", "other.json"});
  EXPECT_EQ(other.out.find("these parts of the text are not kept in other.json: "), 0u)
      << other.out;
  EXPECT_NE(other.out.find(" of squat.json\n"), std::string::npos) << other.out;
  const Output mirrored = ayumi({"edit", "mirror", "kick.json", "-o", "m.json"});
  EXPECT_EQ(mirrored.out.find("not kept"), std::string::npos) << mirrored.out;
}

// Comments are not mirrored, so the answer says which of them name a side.
TEST_F(Edit, SaysWhichWordsAreNotMirrored) {
  write(folder / "lift.json", R"({ "format": "ayumi.pattern/1", "robot": "hoap1",
  "name": "a lift of the right arm", "units": { "angle": "rad" },
  "phases": [{ "until": 2, "support": "both" }],
  "keyframes": [
    { "t": 0.5, "joints": { "r_shoulder_roll": 0 } }, // both arms down
    { "t": 1.5, "joints": { "r_shoulder_roll": -0.3 } } // r_shoulder_roll: out
  ] })");
  const Output said = ayumi({"edit", "mirror", "lift.json", "-o", "m.json"});
  EXPECT_NE(said.out.find(
                "comments and names are not mirrored. They name a side in lines 2, 6 of lift.json"),
            std::string::npos)
      << said.out;
  const auto lines = [&](const std::vector<std::string>& arguments) {
    return json_of(ayumi(arguments).out)["sides_not_mirrored"];
  };
  EXPECT_EQ(
      lines({"edit", "key", "lift.json", "--at", "1.5", "--mirror", "-o", "k.json", "--json"}),
      Json({6}));
  EXPECT_EQ(
      lines({"edit", "key", "lift.json", "--at", "0.5", "--mirror", "-o", "j.json", "--json"}),
      Json::array());
  // One round of a block cannot be mirrored alone, so the comment is lost.
  write(folder / "nods.json", R"({ "format": "ayumi.pattern/1", "robot": "humanoid30",
  "units": { "angle": "deg" }, "phases": [{ "until": 6, "support": "both" }],
  "keyframes": [{ "t": 0.5, "joints": { "head_yaw": 0 } },
    { "repeat": 2, "keyframes": [
      { "after": 1, "joints": { "head_yaw": 20 } }, // look left
      { "after": 1, "joints": { "head_yaw": 0 } }] }] })");
  EXPECT_EQ(
      lines({"edit", "key", "nods.json", "--at", "1.5", "--mirror", "-o", "n.json", "--json"}),
      Json::array());
}

// The text of a pattern from standard input stays like that of a file.
TEST_F(Edit, ThePatternFromStandardInputKeepsItsText) {
  ASSERT_EQ(ayumi({"new", "kick", "--robot", "hoap1", "-o", "kick.json"}).exit_code, 0);
  ASSERT_EQ(ayumi({"edit", "mirror", "kick.json", "-o", "file.json"}).exit_code, 0);
  const std::string command = "cd " + folder.path().string() + " && " + program_under_test() +
                              " edit mirror - -o piped.json <kick.json >/dev/null 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(contents(folder / "piped.json"), contents(folder / "file.json"));
}

TEST_F(Edit, RampsComeFromAPosture) {
  ASSERT_EQ(ayumi({"new", "sway", "-o", "sway.json"}).exit_code, 0);
  const Output out = ayumi({"edit", "ramp", "sway.json", "--in", "0.8", "--back", "0.5",
                            "--posture", "home", "-o", "r.json", "--json"});
  ASSERT_EQ(out.exit_code, 0) << out.out << out.err;
  const Json before = json_of(ayumi({"edit", "bake", "sway.json", "-o", "s.json", "--json"}).out);
  EXPECT_NEAR(double(json_of(out.out)["duration_s"]), double(before["duration_s"]) + 1.3, 1e-9);
}

TEST_F(Edit, WhatDoesNotJoinIsRefused) {
  ASSERT_EQ(ayumi({"new", "squat", "-o", "squat.json"}).exit_code, 0);
  ASSERT_EQ(ayumi({"new", "walk", "--robot", "humanoid30", "-o", "other.json"}).exit_code, 0);
  EXPECT_EQ(ayumi({"edit", "concat", "squat.json", "-o", "a.json"}).exit_code, 2);
  const Output robots = ayumi({"edit", "concat", "squat.json", "other.json", "-o", "a.json"});
  EXPECT_EQ(robots.exit_code, 3);
  EXPECT_NE(robots.err.find("the robot is 'humanoid30', but the robot of squat.json is 'hoap1'"),
            std::string::npos)
      << robots.err;
  EXPECT_EQ(
      ayumi({"edit", "ramp", "squat.json", "--in", "0", "--back", "0", "-o", "a.json"}).exit_code,
      2);
}

TEST_F(Edit, MistakesOfTheCall) {
  EXPECT_EQ(ayumi({"edit", "retime", kWalk, "-o", "a.json"}).exit_code, 2);
  EXPECT_EQ(ayumi({"edit", "retime", kWalk, "--scale", "0", "-o", "a.json"}).exit_code, 2);
  EXPECT_EQ(ayumi({"edit", "bake", kWalk, "-o", "a.csv"}).exit_code, 3);
  EXPECT_EQ(ayumi({"edit", "bake", "missing.json", "-o", "a.json"}).exit_code, 3);
  EXPECT_TRUE(folder.files().empty());
}

// The walk is exported as the robot would play it, and imported again: its steps are found again.
TEST_F(Edit, SequencesComeBack) {
  ASSERT_EQ(ayumi({"export", kWalk, "--format", "hoap", "-o", "walk.csv"}).exit_code, 0);
  const Output out = ayumi({"import", "walk.csv", "--robot", "hoap1", "-o", "back.json", "--json"});
  ASSERT_EQ(out.exit_code, 0) << out.out << out.err;
  const Json json = json_of(out.out);
  EXPECT_EQ(json["format"], "hoap");
  // The contacts are eight steps, a closing step, and the places where both feet stood before.
  EXPECT_EQ(json["contacts"].size(), 11u) << out.out;
  const Json last = json["contacts"].back();
  EXPECT_NEAR(last["position_m"][0], 0.24, 0.004);
  // The table of the new pattern would have the name of the input file, which is not overwritten,
  // not even with --force.
  EXPECT_EQ(ayumi({"import", "walk.csv", "--robot", "hoap1", "-o", "walk.json"}).exit_code, 3);
  const Output own =
      ayumi({"import", "walk.csv", "--robot", "hoap1", "-o", "walk.json", "--force"});
  EXPECT_EQ(own.exit_code, 3);
  EXPECT_NE(own.err.find("the result would overwrite this file"), std::string::npos) << own.err;
  const Output checked = ayumi({"check", "back.json", "--json"});
  EXPECT_TRUE(checked.exit_code == 0 || checked.exit_code == 1) << checked.err;
  const Json summary = json_of(checked.out)["summary"];
  EXPECT_LT(double(summary["max_foot_slip_m"]), 0.004);
  EXPECT_LT(double(summary["max_foot_penetration_m"]), 0.004);
}

// The motion keeps the name that the file gives it, so that the file comes back to the byte.
TEST_F(Edit, TheNameOfAMotionComesBack) {
  ASSERT_EQ(ayumi({"export", kWalk, "--format", "play-motion2", "-o", "first.yaml"}).exit_code, 0);
  const Output read = ayumi({"import", "first.yaml", "--robot", "hoap1", "-o", "back.json"});
  ASSERT_EQ(read.exit_code, 0) << read.err;
  ASSERT_EQ(
      ayumi({"export", "back.json", "--format", "play-motion2", "-o", "again.yaml"}).exit_code, 0);
  EXPECT_EQ(contents(folder / "first.yaml"), contents(folder / "again.yaml"));
}

// Recorded sequences begin with a count per row, which is fast for a robot at rest. They are
// smoothed so that they begin and end at rest, and need no ground force that is impossible there.
TEST_F(Edit, ImportedSequencesBeginAndEndAtRest) {
  std::string rows;
  const int home[20] = {0, 0, 3696,  9537,  -5841, 0, 18810,  -2000, 0, 8800,
                        0, 0, -3696, -9537, 5841,  0, -18810, 2000,  0, -8800};
  for (int k = 0; k < 1000; ++k) {
    rows += "2,2";
    const int turn = k < 500 ? k : 999 - k;  // a count in each row, to and fro
    for (int i = 0; i < 20; ++i)
      rows += "," + std::to_string(home[i] + (i == 2    ? turn
                                              : i == 3  ? 2 * turn
                                              : i == 4  ? -turn
                                              : i == 12 ? -turn
                                              : i == 13 ? -2 * turn
                                              : i == 14 ? turn
                                                        : 0));
    rows += ",R,R,R\n";
  }
  write(folder / "sent.csv", rows);
  const Output out = ayumi({"import", "sent.csv", "--robot", "hoap1", "-o", "bow.json"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const Json check = json_of(ayumi({"check", "bow.json", "--json"}).out);
  for (const Json& f : check["findings"])
    EXPECT_TRUE(f["at_s"] > 0.05 && f["at_s"] < 1.95) << f.dump();
  EXPECT_EQ(check["verdict"], "consistent") << check.dump(1);
}

TEST_F(Edit, ImportReadsStandardInputAndNamesMistakes) {
  write(folder / "bad.csv", "1,2,0,0\n");
  const Output bad = ayumi({"import", "bad.csv", "--robot", "hoap1", "-o", "a.json"});
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_NE(bad.err.find("bad.csv:1: the row has 4 columns"), std::string::npos) << bad.err;
  // Standard input is empty here.
  EXPECT_EQ(ayumi({"import", "-", "--robot", "hoap1", "-o", "a.json"}).exit_code, 3);
  EXPECT_EQ(folder.files(), std::vector<std::string>{"bad.csv"});
}

// Waits until `file` contains `text`, for at most 20 s.
bool appears(const fs::path& file, const std::string& text) {
  for (int i = 0; i < 200; ++i) {
    if (contents(file).find(text) != std::string::npos) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

TEST_F(Edit, WatchChecksAgainUntilStopped) {
  write(folder / "w.json", contents(kWalk));
  const fs::path out = folder / "out";
  const pid_t child = ::fork();
  if (child == 0) {
    const int file = ::open(out.c_str(), O_WRONLY | O_CREAT, 0600);
    if (::chdir(folder.path().c_str()) != 0 || ::dup2(file, 1) < 0) ::_exit(126);
    ::execl(AYUMI_PROGRAM, AYUMI_PROGRAM, "check", "w.json", "--watch", "-q", nullptr);
    ::_exit(127);
  }
  EXPECT_TRUE(appears(out, "w.json: consistent"));
  write(folder / "w.json", "{ half a file");
  EXPECT_TRUE(appears(out, "w.json:1"));
  std::string slippery = contents(kWalk);
  const std::string key = R"("friction": 0.8)";
  slippery.replace(slippery.find(key), key.size(), R"("friction": 0.05)");
  write(folder / "w.json", slippery);
  EXPECT_TRUE(appears(out, "w.json: inconsistent"));
  EXPECT_TRUE(appears(out, "0 errors, now "));
  ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
}

}  // namespace
}  // namespace ayumi::test
