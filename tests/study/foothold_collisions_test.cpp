// A collision of the two feet is reported for the step that brings them together.
#include "ayumi/task/foothold_collisions.hpp"

#include <gtest/gtest.h>

#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"

namespace ayumi {
namespace {

// The text of two steps to the left, of `turn` deg each; the second foot lands beside the right
// foot.
std::string turning_text(const std::string& unit, const std::string& turn) {
  return R"({"format": "ayumi.pattern/1", "robot": "hoap1", "units": {"angle": ")" + unit + R"("},
  "defaults": {"cog_height": 0.235},
  "phases": [
    {"until": 1.1, "support": "both"},
    {"until": 1.6, "support": "right", "swing": {"foot": "left", "step": {"side": 0.01, "turn": )" +
         turn + R"(}, "lift": 0.015}},
    {"until": 1.9, "support": "both"},
    {"until": 2.4, "support": "left", "swing": {"foot": "right", "step": {}, "lift": 0.015}},
    {"until": 2.7, "support": "both"},
    {"until": 3.2, "support": "right", "swing": {"foot": "left", "step": {"turn": )" +
         turn +
         R"(}, "lift": 0.015}},
    {"until": 3.5, "support": "both"},
    {"until": 4.0, "support": "left", "swing": {"foot": "right", "step": {}, "lift": 0.015}},
    {"until": 5.2, "support": "both"}],
  "keyframes": [{"t": 0.6, "zmp": "center"}, {"t": 1.1, "zmp": "right"}, {"t": 1.6, "zmp": "right"},
    {"t": 1.9, "zmp": "left"}, {"t": 2.4, "zmp": "left"}, {"t": 2.7, "zmp": "right"},
    {"t": 3.2, "zmp": "right"}, {"t": 3.5, "zmp": "left"}, {"t": 4.0, "zmp": "left"},
    {"t": 4.6, "zmp": "center"}]})";
}

Task task_of(const std::string& text) {
  return make_task(pattern_of_text(text, "turn.json", {}),
                   load_robot(AYUMI_SOURCE_DIR "/robots/hoap1"), "");
}

std::vector<Mistake> found_in(const Task& task) {
  const CheckOptions options = check_options(task);
  return foothold_collisions(task, options, check_consistency(task.robot, task.series, options));
}

TEST(FootholdCollisions, NameTheStepAndValuesThatAreConsistent) {
  const std::vector<Mistake> found = found_in(task_of(turning_text("deg", "30")));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].place, "/phases/5/swing");
  EXPECT_NE(found[0].words.find("the left foot lands 1.8 mm inside the right foot. With side = "),
            std::string::npos)
      << found[0].words;
  EXPECT_NE(found[0].words.find(" deg, no error would remain"), std::string::npos)
      << found[0].words;
}

// Feet that are exchanged overlap by much more, and this is reported as another mistake.
TEST(FootholdCollisions, LeaveExchangedSidesToTheSearch) {
  Pattern pattern = task_of(turning_text("deg", "5")).pattern;
  pattern.phases[5].swing->step->side = -0.07;
  const Task task = make_task(pattern, load_robot(AYUMI_SOURCE_DIR "/robots/hoap1"), "");
  EXPECT_TRUE(found_in(task).empty());
}

// The same angle in another unit gives the same words, except for the unit of the turn.
TEST(FootholdCollisions, AreInTheUnitOfThePattern) {
  const std::vector<Mistake> found = found_in(task_of(turning_text("rad", "0.523599")));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].words.find("turn = 0."), std::string::npos) << found[0].words;
  EXPECT_EQ(found[0].words.find("deg"), std::string::npos) << found[0].words;
}

// The named values are the smallest ones: with the next smaller change, the feet are too near.
TEST(FootholdCollisions, NameTheLeastChange) {
  const Task task = task_of(turning_text("deg", "30"));
  const std::string words = found_in(task).at(0).words;
  const auto number_after = [&](const std::string& name) {
    return std::stod(words.substr(words.find(name) + name.size()));
  };
  const auto warned = [&](double side, double turn) {
    Pattern pattern = task.pattern;
    pattern.phases[5].swing->step->side = side;
    pattern.phases[5].swing->step->turn = turn * M_PI / 180;
    const Task other = make_task(pattern, task.robot, "");
    for (const Finding& f :
         check_consistency(other.robot, other.series, check_options(other)).findings)
      if (f.kind == FindingKind::self_collision) return true;
    return false;
  };
  const double side = number_after("side = "), turn = number_after("turn = ");
  EXPECT_FALSE(warned(side, 30));
  EXPECT_TRUE(warned(side - 0.001, 30));
  EXPECT_FALSE(warned(0, turn));
  EXPECT_TRUE(warned(0, turn + 1));
}

TEST(FootholdCollisions, AreNotFoundWhereTheFeetStandApart) {
  EXPECT_TRUE(found_in(task_of(turning_text("deg", "10"))).empty());
}

}  // namespace
}  // namespace ayumi
