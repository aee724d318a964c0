#include "ayumi/plot/com_zmp_plot.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "tests/render/box_robot.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

/// The made-up run, and the same as if it fell over at 0.6 s.
struct TwoRuns {
  RobotModel model = test::box_robot();
  SimulationLog standing = test::box_run(model);
  SimulationLog falling = standing;
  TwoRuns() {
    falling.controller = ControllerKind::none;
    falling.result.outcome = Outcome::fell;
    falling.result.fell_at = 0.6;
    for (size_t k = 200; k < falling.samples.size(); ++k) {
      const double s = 0.002 * double(k - 200);
      falling.samples[k].cog += Eigen::Vector3d(0, 8 * s * s, -3 * s * s);
      falling.samples[k].zmp += Eigen::Vector3d(0, 8 * s * s, 0);
    }
  }
  std::vector<LociRun> both() const { return {{"open loop", &falling}, {"DTAD", &standing}}; }
};

/// Texts of a drawing, in order.
std::vector<std::string> texts(const Drawing& drawing) {
  std::vector<std::string> out;
  for (const auto& item : drawing.items)
    if (const auto* text = std::get_if<DrawnText>(&item)) out.push_back(text->text);
  return out;
}

bool has(const Drawing& drawing, const std::string& wanted) {
  const std::vector<std::string> all = texts(drawing);
  return std::find(all.begin(), all.end(), wanted) != all.end();
}

TEST(Loci, NamesWhatItShows) {
  const TwoRuns runs;
  const Drawing drawing = draw_loci(runs.both(), {});
  for (const char* wanted :
       {"sway", "command", "open loop (fell at 0.60 s)", "DTAD (stands)",
        "reference ZMP and f_z of DTAD", "COG x [m]", "COG y [m]", "COG z [m]", "ZMP x [m]",
        "ZMP y [m]", "f_z [N]", "time [s]", "push 0.4 N s at 0.3 s", "both", "left"})
    EXPECT_TRUE(has(drawing, wanted)) << wanted;
  EXPECT_EQ(loci_series({}).size(), 6u);
  EXPECT_EQ(loci_series({.cog = false}).size(), 3u);
}

// (26) and (27) are references of f_z: the last panel shows them beside the force.
TEST(Loci, ThePanelOfTheForceHasItsReference) {
  TwoRuns runs;
  for (SimulationSample& s : runs.standing.samples) s.reference_fz = s.fz;
  const auto lines = [&](const LociOptions& options) {
    const Drawing drawing = draw_loci({{"DTAD", &runs.standing}}, options);
    return std::count_if(drawing.items.begin(), drawing.items.end(),
                         [](const auto& item) { return std::holds_alternative<DrawnPath>(item); });
  };
  const LociOptions with{.cog = false, .zmp = false};
  const LociOptions without{.cog = false, .zmp = false, .reference = false};
  EXPECT_EQ(lines(with), lines(without) + 2);  // in the panel and in the legend
  EXPECT_TRUE(has(draw_loci(runs.both(), with), "reference f_z of DTAD"));
}

// A change is drawn by what it changed; the rest is named.
TEST(Loci, OnlyWhatDiffersIsDrawnWithJointsAndLimits) {
  TwoRuns runs;
  SimulationLog moved = runs.standing;
  for (SimulationSample& s : moved.samples) {
    s.state.theta[0] += 0.1;
    s.cog.x() += 0.002;
  }
  LociOptions options;
  options.model = &runs.model;
  options.joints = {0};
  options.command = options.reference = false;
  options.only_differences = true;
  const Drawing drawing = draw_loci({{"before", &runs.standing}, {"after", &moved}}, options);
  EXPECT_TRUE(has(drawing, runs.model.dofs()[0].name + " [deg]") ||
              has(drawing, runs.model.dofs()[0].name + " [mm]"));
  EXPECT_TRUE(has(drawing, "COG x [m]"));
  EXPECT_FALSE(has(drawing, "COG y [m]"));
  EXPECT_FALSE(has(drawing, "command"));
  EXPECT_TRUE(has(drawing, "The same in all: COG y, COG z, ZMP x, ZMP y, f_z.")) << [&] {
    std::string all;
    for (const std::string& t : texts(drawing)) all += t + " | ";
    return all;
  }();
}

TEST(Loci, AFallenRunIsCutOffAndItIsSaid) {
  const TwoRuns runs;
  const Drawing drawing = draw_loci(runs.both(), {});
  EXPECT_TRUE(has(
      drawing,
      "The axes fit the command and the runs that stand; the curves of a fall end at the edge of "
      "the axes. A cross marks the fall."));
  for (const auto& item : drawing.items)
    if (const auto* path = std::get_if<DrawnPath>(&item)) {
      for (const Eigen::Vector2d& p : path->points)
        EXPECT_TRUE(p.x() >= 0 && p.x() <= drawing.width && p.y() >= 0 && p.y() <= drawing.height)
            << p.transpose();
    }
  const Drawing alone = draw_loci({{"DTAD", &runs.standing}}, {});
  for (const std::string& text : texts(alone))
    EXPECT_EQ(text.find("edge of the axes"), std::string::npos) << "no curve ends there";
}

// Nothing stands and the margin has no command: its range is what it was before the fall, and not
// a metre.
TEST(Loci, TheMarginOfAFallenRunIsThatBeforeItsFall) {
  const TwoRuns runs;
  LociOptions options;
  options.model = &runs.model;
  const Drawing drawing = draw_loci({{"open loop", &runs.falling}}, options);
  const std::vector<std::string> all = texts(drawing);
  const auto margin = std::find(all.begin(), all.end(), "margin [m]");
  ASSERT_NE(margin, all.end());
  // The numbers of an axis come before its name or after it, those of the panel below further on.
  double most = 0;
  int numbers = 0;
  for (auto text = margin - 1; text >= all.begin(); --text, ++numbers) {
    char* end = nullptr;
    const double value = std::strtod(text->c_str(), &end);
    if (end == text->c_str() || *end != 0) break;
    most = std::max(most, std::abs(value));
  }
  EXPECT_GE(numbers, 2) << *(margin - 1);
  EXPECT_LT(most, 0.2);
  EXPECT_TRUE(
      has(drawing,
          "The axes fit the command and the time before the fall; the curves of a fall end at the "
          "edge of the axes. A cross marks the fall."));
}

TEST(Loci, TheLineGoesThroughTheSamples) {
  // COG x of the standing run rises by 0.1 m in 1 s: its line ends at the frame's right edge, as
  // high above its beginning as the command's.
  const TwoRuns runs;
  LociOptions options;
  options.zmp = options.fz = false;
  const Drawing drawing = draw_loci({{"DTAD", &runs.standing}}, options);
  std::vector<DrawnPath> lines;
  for (const auto& item : drawing.items)
    if (const auto* path = std::get_if<DrawnPath>(&item))
      if (path->width == 1.6 || path->width == 1.3) lines.push_back(*path);
  ASSERT_EQ(lines.size(), 6u) << "run and command in three panels";
  const auto rise = [](const DrawnPath& p) { return p.points.front().y() - p.points.back().y(); };
  EXPECT_NEAR(rise(lines[0]), rise(lines[1]), 1e-6);
  EXPECT_NEAR(rise(lines[0]), options.panel * 0.1 / 0.12, 0.5);
  EXPECT_EQ(lines[0].points.size(), 2u) << "a straight line needs no more";
  EXPECT_GT(lines[2].points.size(), 20u) << "a sway does";
  EXPECT_NEAR(lines[0].points.back().x(), options.width - 18, 1e-6);
}

TEST(Loci, FilesAreTheSameEveryTimeAndValid) {
  const TwoRuns runs;
  const fs::path folder = fs::temp_directory_path() / ("ayumi_loci_" + std::to_string(getpid()));
  fs::create_directories(folder);
  for (const std::string name : {"a.svg", "a.png"}) {
    write_loci(runs.both(), folder / name, {.png_scale = 0.5});
    const std::string first = read_file(folder / name);
    write_loci(runs.both(), folder / name, {.png_scale = 0.5});
    EXPECT_EQ(read_file(folder / name), first);
    EXPECT_LT(first.size(), 500000u);
  }
  write_support_plot(runs.model, runs.both(), folder / "b.svg", {});
  if (std::system("command -v xmllint > /dev/null") == 0) {
    for (const char* name : {"a.svg", "b.svg"})
      EXPECT_EQ(std::system(("xmllint --noout " + (folder / name).string()).c_str()), 0) << name;
  }
  EXPECT_EQ(read_file(folder / "a.svg").find(folder.string()), std::string::npos);
  fs::remove_all(folder);
}

TEST(Loci, SupportPlotHasOneScaleAndBothFeet) {
  const TwoRuns runs;
  const Drawing drawing = draw_support(runs.model, runs.both(), {});
  EXPECT_TRUE(has(drawing, "L"));
  EXPECT_TRUE(has(drawing, "R"));
  EXPECT_TRUE(has(drawing, "x [m]"));
  // A sole is 0.09 x 0.05 m.
  for (const auto& item : drawing.items)
    if (const auto* path = std::get_if<DrawnPath>(&item))
      if (path->closed && path->fill[3] > 0 && path->points.size() == 4) {
        const Eigen::Vector2d size = (path->points[2] - path->points[0]).cwiseAbs();
        EXPECT_NEAR(size.x() / size.y(), 1.8, 1e-6);
      }
}

std::string message_of(const std::vector<LociRun>& runs, const LociOptions& options) {
  try {
    draw_loci(runs, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    return error.what();
  }
  return "";
}

TEST(Loci, ErrorsSayWhatIsWrong) {
  const TwoRuns runs;
  EXPECT_EQ(message_of({}, {}), "plot: no run to draw");
  EXPECT_NE(message_of(std::vector<LociRun>(7, {"a", &runs.standing}), {}).find("at most 6"),
            std::string::npos);
  EXPECT_EQ(message_of(runs.both(), {.begin = 3}),
            "plot: the times from 3 s to 1 s contain nothing of the runs, which last 1 s");
  EXPECT_NE(message_of(runs.both(), {.width = 10}).find("300"), std::string::npos);
  EXPECT_NE(message_of(runs.both(), {.cog = false, .zmp = false, .fz = false}).find("every panel"),
            std::string::npos);
  const SimulationLog empty;
  EXPECT_NE(message_of({{"a", &empty}}, {}).find("no samples"), std::string::npos);
}

}  // namespace
}  // namespace ayumi
