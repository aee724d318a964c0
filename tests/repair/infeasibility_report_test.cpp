// The reason why no repair was found, in words: each kind of finding has its own unit.

#include "ayumi/repair/infeasibility_report.hpp"

#include <gtest/gtest.h>

#include "ayumi/repair/overlapping_feet.hpp"
#include "tests/support/planted.hpp"

namespace ayumi::test {
namespace {

using namespace planted;

// The contact of a foot ends 60 ms before the foot leaves the ground: the message has milliseconds
// and not millimetres.
TEST(InfeasibilityReport, NamesTheTimeForWhichAFootStandsOn) {
  Pattern pattern = walk();
  pattern.phases[2].until -= 0.060;
  const CommandSeries series = sample(hoap1(), pattern);
  RepairOptions options;
  options.locked_windows = {{0, 10}};
  const ConsistencyReport report = check_consistency(hoap1(), series, options.check);
  const std::vector<InfeasibilityCause> found =
      infeasibility_report(hoap1(), series, report, options);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].finding.kind, FindingKind::contact_ends_early);
  EXPECT_EQ(found[0].finding.unit, "s");
  EXPECT_NEAR(found[0].finding.worst, 0.060, 0.005);
  EXPECT_EQ(found[0].text.find("above the ground"), std::string::npos) << found[0].text;
  EXPECT_EQ(found[0].text.find(" mm"), std::string::npos) << found[0].text;
  EXPECT_NE(found[0].text.find(" ms after its contact has ended"), std::string::npos)
      << found[0].text;
  EXPECT_NE(found[0].text.find("This window is locked. Remove the lock"), std::string::npos)
      << found[0].text;
}

// At every stage, the caller is told what is wrong with the motion, so that it can say this while
// the work continues and when it is stopped.
TEST(InfeasibilityReport, TellsWhatIsLeftWhileItWorks) {
  Pattern pattern = walk();
  pattern.phases[2].until -= 0.060;
  const CommandSeries series = sample(hoap1(), pattern);
  std::vector<std::vector<std::string>> told;
  RepairOptions options;
  options.on_check = [&](const ConsistencyReport& check) {
    told.push_back(remaining_errors(check));
  };
  int calls = 0;
  const Progress stop = [&](const ProgressEvent&) { return ++calls < 3; };
  EXPECT_THROW(repair(hoap1(), series, options, stop), Interrupted);
  ASSERT_FALSE(told.empty());
  ASSERT_FALSE(told.front().empty());
  EXPECT_NE(told.front()[0].find(" ms after its contact has ended at "), std::string::npos)
      << told.front()[0];
  told.clear();
  const RepairResult whole = repair(hoap1(), series, options);
  ASSERT_EQ(whole.status, RepairStatus::repaired);
  EXPECT_FALSE(told.front().empty());
  EXPECT_TRUE(told.back().empty());
}

// A foot is planned to land on the other one: nothing is solved, and the foothold is named.
TEST(InfeasibilityReport, FeetInOnePlaceEndBeforeTheFirstRound) {
  Pattern pattern = walk_pattern(hoap1(), {.steps = 3});
  pattern.robot = "hoap1";
  Phase* landing = nullptr;
  for (Phase& phase : pattern.phases)
    if (phase.swing && !landing) landing = &phase;
  ASSERT_NE(landing, nullptr);
  const Side foot = landing->swing->foot;
  landing->swing->to.position.y() = foot == Side::left ? -0.02 : 0.02;
  const CommandSeries series = sample(hoap1(), pattern);
  const RepairResult r = repair(hoap1(), series);
  EXPECT_EQ(r.status, RepairStatus::infeasible);
  EXPECT_EQ(r.iterations, 0);
  ASSERT_FALSE(r.reasons.empty());
  const std::string start = std::string("the ") + name_of(foot) + " foot is planned to stand on";
  EXPECT_EQ(r.reasons.front().substr(0, start.size()), start) << r.reasons.front();
  EXPECT_FALSE(overlapping_feet(hoap1(), sample(hoap1(), walk()), r.before));
}

// Findings have the bodies, joints and feet that they concern as data, apart from their words.
TEST(InfeasibilityReport, PlacesAreTyped) {
  Finding at_joint, at_bodies;
  at_joint.place = JointPlace{3};
  at_bodies.place = BodyPairPlace{4, 7};
  at_bodies.where = "no - bodies - of this name";
  EXPECT_EQ(dof_of(at_joint), 3);
  EXPECT_EQ(dof_of(at_bodies), -1);
}

}  // namespace
}  // namespace ayumi::test
