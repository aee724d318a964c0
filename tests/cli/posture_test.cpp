// The command posture writes what patterns can include.

#include <sys/resource.h>

#include <cmath>

#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

class PostureCommand : public testing::Test {
 protected:
  Output ayumi(const std::vector<std::string>& arguments) {
    return run_program(arguments, folder.path());
  }
  Json postures(const std::string& source) {
    const Output output = ayumi({"posture", "list", source, "--json"});
    EXPECT_EQ(output.exit_code, 0) << output.err;
    return json_of(output.out)["postures_rad"];
  }
  Output adjust(const std::string& value, const std::string& name) {
    return ayumi(
        {"posture", "adjust", "hoap1", "home", "--joint", value, "--as", name, "-o", "mine.json"});
  }

  Folder folder;
};

TEST_F(PostureCommand, AdjustedPosturesKeepTheOtherJoints) {
  const Output made = adjust("l_elbow=-60", "ready");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Json home = postures("hoap1")["home"], ready = postures("mine.json")["ready"];
  for (const auto& [joint, angle] : home.items())
    EXPECT_NEAR(ready[joint].get<double>(), joint == "l_elbow" ? -M_PI / 3 : angle.get<double>(),
                1e-8)
        << joint;
}

TEST_F(PostureCommand, MirroredTwiceAPostureIsUnchanged) {
  ASSERT_EQ(adjust("l_hip_roll=12", "lean").exit_code, 0);
  const auto mirror = [&](const std::string& from, const std::string& to) {
    const Output made =
        ayumi({"posture", "mirror", "mine.json", from, "--as", to, "-o", "mine.json"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
  };
  mirror("lean", "image");
  mirror("image", "again");
  const Json all = postures("mine.json");
  EXPECT_EQ(all["again"], all["lean"]);
  // Both roll axes of HOAP-1 point ahead, so that the mirror image turns the other way.
  EXPECT_NEAR(all["image"]["r_hip_roll"].get<double>(), -12 * M_PI / 180, 1e-8);
  EXPECT_EQ(all["image"].value("l_hip_roll", 0.0), 0.0);
}

// The processor time of the programs that have ended [s].
double time_of_children() {
  rusage used{};
  ::getrusage(RUSAGE_CHILDREN, &used);
  return static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * used.ru_utime.tv_usec;
}

TEST_F(PostureCommand, ListsPosturesInTimeThatIsLinearInTheirNumber) {
  std::string text = R"({"format": "ayumi.postures/1", "units": {"angle": "rad"}, "postures": {)";
  for (int i = 0; i < 80'000; ++i)
    text += (i ? ", \"p" : "\"p") + std::to_string(i) + R"(": {"l_elbow": 1})";
  write(folder.path() / "many.json", text + "}}");
  const double begin = time_of_children();
  const Json all = postures("many.json");
  EXPECT_LT(time_of_children() - begin, 5.0);
  EXPECT_EQ(all.size(), 80'000u);
  EXPECT_EQ(all["p79999"]["l_elbow"], 1);
  // The message about an unknown posture does not list all postures, either.
  const Output wrong = ayumi({"posture", "adjust", "many.json", "q", "--joint", "l_elbow=1", "--as",
                              "r", "-o", "mine.json"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_LT(wrong.err.size(), 400u) << wrong.err.substr(0, 1000);
}

TEST_F(PostureCommand, TheTextOfALibraryStaysAndAPatternCanIncludeIt) {
  const std::string before =
      "// Of me.\n{\n  \"format\": \"ayumi.postures/1\",\n  \"units\": {\"angle\": \"rad\"},\n"
      "  \"postures\": {\n    \"flat\": {\"l_elbow\": 0}  // arms\n  }\n}\n";
  write(folder / "mine.json", before);
  ASSERT_EQ(adjust("r_elbow=-90", "bent").exit_code, 0);
  const std::string after = contents(folder / "mine.json");
  EXPECT_EQ(after.rfind("// Of me.\n", 0), 0u);
  EXPECT_NE(after.find("\"flat\": {\"l_elbow\": 0}"), std::string::npos) << after;
  EXPECT_NE(after.find("// arms"), std::string::npos) << after;
  EXPECT_NEAR(postures("mine.json")["bent"]["r_elbow"].get<double>(), -M_PI / 2, 1e-6);
  write(folder / "p.json",
        R"({"format": "ayumi.pattern/1", "name": "p", "robot": "hoap1", "include": "mine.json",
            "phases": [{"until": 1, "support": "both"}],
            "keyframes": [{"t": 0, "posture": "bent"}]})");
  EXPECT_EQ(ayumi({"check", "p.json", "-q"}).exit_code, 0);
}

TEST_F(PostureCommand, CapturesWhatTheMotionHasAtThatTime) {
  ASSERT_EQ(ayumi({"export", kWalk, "-o", "walk.csv", "--format", "csv", "--servo", "ideal", "-q"})
                .exit_code,
            0);
  for (const std::string& source : {kWalk, std::string("walk.csv")}) {
    const Output made = ayumi({"posture", "capture", source, "--at", "0", "--as", "start", "-o",
                               "mine.json", "-q", "--force"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const Json start = postures("mine.json")["start"], home = postures("hoap1")["home"];
    EXPECT_EQ(start.size(), 20u);
    EXPECT_NEAR(start["l_elbow"].get<double>(), home["l_elbow"].get<double>(), 1e-6);
  }
  const Output late =
      ayumi({"posture", "capture", kWalk, "--at", "70", "--as", "late", "-o", "mine.json", "-q"});
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_NE(late.err.find("lasts from 0 to 7.091 s"), std::string::npos) << late.err;
}

TEST_F(PostureCommand, ShellsProposeThePosturesOfALibrary) {
  ASSERT_EQ(adjust("l_elbow=-60", "ready").exit_code, 0);
  EXPECT_EQ(ayumi({"--names", "postures", "posture", "draw", "mine.json"}).out, "ready\n");
}

// Servos leave an angle of a ten-thousandth of a degree on joints that nothing moves.
TEST_F(PostureCommand, AJointThatRestsAtZeroIsCapturedAtZero) {
  ASSERT_EQ(ayumi({"new", "bow", "-o", "bow.json", "-q"}).exit_code, 0);
  ASSERT_EQ(ayumi({"simulate", "bow.json", "-o", "run", "-q"}).exit_code, 0);
  const Output made =
      ayumi({"posture", "capture", "run", "--at", "2", "--as", "bowed", "-o", "mine.json", "-q"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(made.out.find("e-0"), std::string::npos) << made.out;
  for (const auto& [joint, angle] : postures("mine.json")["bowed"].items())
    EXPECT_TRUE(angle == 0 || std::abs(angle.get<double>()) > 9e-6) << joint << " " << angle;
}

TEST_F(PostureCommand, BadInputIsRefusedAndNothingIsWritten) {
  ASSERT_EQ(adjust("l_elbow=-60", "ready").exit_code, 0);
  const std::string before = contents(folder / "mine.json");
  const auto refused = [&](const std::vector<std::string>& words, int code,
                           const std::string& says) {
    const Output output = ayumi(words);
    EXPECT_EQ(output.exit_code, code) << output.err;
    EXPECT_NE(output.err.find(says), std::string::npos) << output.err;
    EXPECT_EQ(contents(folder / "mine.json"), before);
  };
  const std::vector<std::string> save = {"--as", "x", "-o", "mine.json"};
  const auto with_save = [&](std::vector<std::string> words) {
    words.insert(words.end(), save.begin(), save.end());
    return words;
  };
  refused({"posture", "adjust", "hoap1", "home", "--joint", "l_elbow=1", "--as", "ready", "-o",
           "mine.json"},
          3, "already has a posture 'ready'");
  refused(with_save({"posture", "mirror", "mine.json", "redy"}), 2, "did you mean 'ready'?");
  refused(with_save({"posture", "adjust", "hoap1", "home", "--joint", "l_elbo=1"}), 2,
          "did you mean 'l_elbow'?");
  refused(with_save({"posture", "adjust", "hoap1", "home", "--joint", "l_elbow=1e308"}), 2,
          "'l_elbow=1e308' is out of range");
  refused(with_save({"posture", "adjust", "hoap1", "home", "--joint", "l_elbow="}), 2,
          "does not have the form NAME=NUMBER");
  refused(with_save({"posture", "list"}), 2, "");
  refused({"posture", "draw", "mine.json", "ready", "-o", "ready.jpg"}, 2, ".png");
  refused({"posture", "adjust", "hoap1", "home", "--joint", "l_elbow=1", "--as", "x", "-o",
           "/dev/null"},
          3, "/dev/null");
  const Output wide = adjust("l_elbow=-300", "wide");
  EXPECT_EQ(wide.exit_code, 0);
  EXPECT_NE(wide.out.find("beyond their limits: l_elbow ("), std::string::npos) << wide.out;
}

TEST_F(PostureCommand, DrawsAPicture) {
  const Output made = ayumi({"posture", "draw", "hoap1", "home", "-o", "home.png", "-q"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(contents(folder / "home.png").substr(1, 3), "PNG");
  EXPECT_EQ(ayumi({"posture", "draw", "hoap1", "zero", "-o", "zero.png", "-q"}).exit_code, 0);
  EXPECT_TRUE(contents(folder / "home.png") != contents(folder / "zero.png"));
}

}  // namespace
}  // namespace ayumi::test
