// `ayumi gaits` makes a library of walks with index, map, tables and archives. Cells that cannot be
// made are named; a library that was stopped is continued; the bytes are the same for any number of
// threads.

#include <csignal>

#include "tests/cli/background_program.hpp"
#include "tests/support/json.hpp"
#include "tests/support/json_schema.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

const std::vector<std::string> kTwoCells = {"gaits",      "hoap1", "--forward", "0.03,0.05",
                                            "--sideways", "0",     "--turn",    "0",
                                            "--failure",  "0.5",   "--quiet"};

std::vector<std::string> with(std::vector<std::string> words,
                              const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Json index_of(const fs::path& library) { return json_of(contents(library / "index.json")); }

/// Every file below a folder, with its bytes.
std::map<std::string, std::string> tree(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[fs::relative(entry.path(), folder).string()] = contents(entry.path());
  return files;
}

TEST(Gaits, ALibraryOfTwoCellsHasAllItsParts) {
  const Folder folder;
  const Output made = run_program(with(kTwoCells, {"-o", "lib", "--threads", "1"}), folder.path());
  ASSERT_EQ(made.exit_code, 0) << made.err << made.out;
  EXPECT_NE(made.out.find("2 cells: 2 made, 0 missing"), std::string::npos) << made.out;
  EXPECT_NE(made.out.find("2 transitions: 2 made, 0 missing"), std::string::npos) << made.out;
  const Json index = index_of(folder / "lib");
  const JsonSchema schema(json_of(contents(AYUMI_SOURCE_DIR "/docs/schemas/gaits-1.schema.json")));
  EXPECT_TRUE(schema.accepts(index));
  ASSERT_EQ(index["cells"].size(), 2u);
  for (const Json& cell : index["cells"]) {
    EXPECT_EQ(cell["status"], "certified");
    EXPECT_TRUE(cell["certificate"]["certified"].get<bool>());
    EXPECT_GE(double(cell["certificate"]["runs"]), 5);
    EXPECT_GT(double(cell["zmp_margin_m"]), 0.002);
    const Json& cycle = cell["cycle"];
    // There are two steps of the speed that was asked for.
    const double period = cell["period_s"];
    EXPECT_NEAR(cycle["duration_s"], 2 * period, 1e-9);
    EXPECT_NEAR(cycle["displacement_m"][0], 2 * period * cell["forward_m_s"].get<double>(), 2e-4);
    EXPECT_NEAR(cycle["displacement_m"][1], 0, 2e-4);
    EXPECT_LT(double(cycle["gap"]["posture_rad"]), 2e-4);
    EXPECT_LT(double(cycle["gap"]["rate_rad_per_s"]), 0.2);
    EXPECT_EQ(cycle["rows"], std::lround(2 * period * 50));
    const std::string npz = contents(folder / "lib" / cycle["npz"].get<std::string>());
    for (const char* name : {"fps.npy", "joint_names.npy", "body_names.npy", "joint_vel.npy"})
      EXPECT_NE(npz.find(name), std::string::npos) << name;
    std::string knee;  // each character takes four bytes
    for (const char c : std::string("l_knee")) knee += std::string{c, 0, 0, 0};
    EXPECT_NE(npz.find(knee), std::string::npos);
    const Output checked =
        run_program({"check", "lib/" + cell["pattern"].get<std::string>()}, folder.path());
    EXPECT_EQ(checked.exit_code, 0) << checked.out;
    EXPECT_EQ(run_program({"edit", "loop", "lib/" + cell["pattern"].get<std::string>(), "--times",
                           "2", "-o", cell["name"].get<std::string>() + ".json"},
                          folder.path())
                  .exit_code,
              0);
  }
  for (const Json& change : index["transitions"]) {
    EXPECT_EQ(change["status"], "stands");
    EXPECT_EQ(run_program({"check", "lib/" + change["pattern"].get<std::string>()}, folder.path())
                  .exit_code,
              0);
  }
  EXPECT_EQ(index["files"].size(), 2u + 2 * 5 + 2);
  for (const Json& file : index["files"])
    EXPECT_TRUE(fs::is_regular_file(folder / "lib" / file.get<std::string>())) << file;
  EXPECT_EQ(tree(folder / "lib").size(), index["files"].size() + 1) << "nothing else is there";
  EXPECT_NE(contents(folder / "lib/map.svg").find("<svg"), std::string::npos);

  const Output again = run_program(with(kTwoCells, {"-o", "lib"}), folder.path());
  EXPECT_EQ(again.exit_code, 3) << "a finished library is not overwritten";
  const auto before = tree(folder / "lib");
  ASSERT_EQ(run_program(with(kTwoCells, {"-o", "lib", "--force", "--threads", "2"}), folder.path())
                .exit_code,
            0);
  auto after = tree(folder / "lib");
  EXPECT_TRUE(before == after) << "the same bytes for any number of threads";
}

TEST(Gaits, CellsThatCannotBeMadeAreNamed) {
  const Folder folder;
  const Output made = run_program({"gaits", "hoap1", "--forward", "0,0.9", "--sideways", "0,0.3",
                                   "--turn", "0", "--uncertified", "-o", "lib", "--quiet"},
                                  folder.path());
  EXPECT_EQ(made.exit_code, 1) << made.err;
  EXPECT_NE(made.out.find("4 cells: 1 made, 3 missing"), std::string::npos) << made.out;
  const Json index = index_of(folder / "lib");
  EXPECT_TRUE(JsonSchema(json_of(contents(AYUMI_SOURCE_DIR "/docs/schemas/gaits-1.schema.json")))
                  .accepts(index));
  int missing = 0;
  for (const Json& cell : index["cells"]) {
    if (cell["status"] == "stands") continue;
    EXPECT_EQ(cell["status"], "missing");
    EXPECT_FALSE(cell["reason"].get<std::string>().empty());
    EXPECT_FALSE(cell.contains("pattern"));
    ++missing;
  }
  EXPECT_EQ(missing, 3);
  ASSERT_EQ(index["transitions"].size(), 8u);
  for (const Json& change : index["transitions"]) {
    EXPECT_EQ(change["status"], "missing");
    EXPECT_EQ(change["stage"], "neighbour");
  }
}

TEST(Gaits, AKilledLibraryGoesOn) {
  const Folder folder;
  const std::vector<std::string> words = with(kTwoCells, {"--uncertified", "--threads", "1"});
  ASSERT_EQ(run_program(with(words, {"-o", "whole"}), folder.path()).exit_code, 0);
  const pid_t child = start(with(words, {"-o", "lib"}), folder.path());
  const fs::path part = folder / "lib/.ayumi_part/done";
  const bool begun = holds_within(240, [&] { return fs::exists(part) && !fs::is_empty(part); });
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ASSERT_TRUE(begun);
  if (!fs::exists(folder / "lib/index.json")) {  // otherwise the machine was too fast
    const Output other =
        run_program(with(kTwoCells, {"--uncertified", "--rate", "25", "-o", "lib"}), folder.path());
    EXPECT_EQ(other.exit_code, 3);
    EXPECT_NE(other.err.find("unfinished library"), std::string::npos) << other.err;
    EXPECT_EQ(run_program(with(words, {"-o", "lib"}), folder.path()).exit_code, 0);
  }
  auto whole = tree(folder / "whole"), lib = tree(folder / "lib");
  EXPECT_TRUE(whole == lib);
}

TEST(Gaits, BadInputIsOneLineAndWritesNothing) {
  const Folder folder;
  const auto refused = [&](const std::vector<std::string>& more, int code,
                           const std::string& message) {
    const Output output = run_program(with({"gaits", "hoap1", "-o", "lib"}, more), folder.path());
    EXPECT_EQ(output.exit_code, code) << output.err;
    EXPECT_NE(output.err.find(message), std::string::npos) << output.err;
    EXPECT_FALSE(fs::exists(folder / "lib"));
  };
  refused({"--forward", "0.1,0.05"}, 2, "--forward: the values must ascend by more than");
  refused({"--forward", "0:0.1"}, 2, "FROM:TO:COUNT");
  refused({"--turn", "0:10:2.5"}, 2, "whole number");
  refused({"--sideways", "left"}, 2, "'left' is not a number");
  refused({"--period", "0"}, 2, "above 0 s");
  refused({"--runs", "3"}, 2, "3 runs cannot show");
  refused({"--study", "none.json"}, 3, "none.json");
  refused({"--profile", "none"}, 3, "none");
  write(folder / "full/patterns/mine.json", "{}");
  const Output theirs = run_program({"gaits", "hoap1", "-o", "full"}, folder.path());
  EXPECT_EQ(theirs.exit_code, 3);
  EXPECT_NE(theirs.err.find("is not a part of a library"), std::string::npos) << theirs.err;
}

}  // namespace
}  // namespace ayumi::test
