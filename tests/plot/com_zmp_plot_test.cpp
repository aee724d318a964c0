#include "ayumi/plot/com_zmp_plot.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "tests/render/box_robot.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

/// The made-up run, and the same run as if the robot fell at 0.6 s.
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

/// The texts of a drawing, in order.
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

/// The largest number of the axis with this name; 0 if it has fewer than two numbers.
double largest_number_of(const Drawing& drawing, const std::string& axis) {
  const std::vector<std::string> all = texts(drawing);
  const auto name = std::find(all.begin(), all.end(), axis);
  if (name == all.end()) {
    ADD_FAILURE() << "no axis " << axis;
    return 0;
  }
  // The numbers of an axis are drawn before its name, and the texts of the panel below are drawn
  // later.
  double most = 0;
  int numbers = 0;
  for (auto text = name; text-- > all.begin(); ++numbers) {
    char* end = nullptr;
    const double value = std::strtod(text->c_str(), &end);
    if (end == text->c_str() || *end != 0) break;
    most = std::max(most, std::abs(value));
  }
  EXPECT_GE(numbers, 2) << axis;
  return most;
}

TEST(Loci, NamesWhatItShows) {
  const TwoRuns runs;
  const Drawing drawing = draw_loci(runs.both(), {});
  for (const char* wanted :
       {"sway", "command", "open loop (fell at 0.60 s)", "DTAD (stands)",
        "reference ZMP and f_z of DTAD", "COG x [mm]", "COG y [mm]", "COG z [mm]", "ZMP x [mm]",
        "ZMP y [mm]", "f_z [N]", "time [s]", "push 0.4 N s at 0.3 s", "both", "left"})
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
  EXPECT_EQ(lines(with), lines(without) + 2);  // one in the panel and one in the legend
  EXPECT_TRUE(has(draw_loci(runs.both(), with), "reference f_z of DTAD"));
}

// A change is drawn by the panels in which it is visible; the other panels are named.
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
  EXPECT_TRUE(has(drawing, "COG x [mm]"));
  EXPECT_FALSE(has(drawing, "COG y [mm]"));
  EXPECT_FALSE(has(drawing, "command"));
  EXPECT_TRUE(has(drawing, "These values are equal in all runs: COG y, COG z, ZMP x, ZMP y, f_z."))
      << [&] {
           std::string all;
           for (const std::string& t : texts(drawing)) all += t + " | ";
           return all;
         }();
}

TEST(Loci, AFallenRunIsCutOffAndItIsSaid) {
  const TwoRuns runs;
  const Drawing drawing = draw_loci(runs.both(), {});
  EXPECT_TRUE(has(drawing,
                  "The axes fit the command and the runs that stand. The curves of a run that "
                  "falls end at the edge of the axes. A cross marks the fall."));
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

// No foot carries a robot that falls in the air, so that there is no ZMP.
TEST(Loci, AFallInTheAirHasNoMarkOfTheZmp) {
  TwoRuns runs;
  for (size_t k = 250; k < runs.falling.samples.size(); ++k)
    runs.falling.samples[k].zmp.setConstant(NAN);
  const Drawing drawing = draw_loci({{"open loop", &runs.falling}}, {});
  for (const auto& item : drawing.items)
    if (const auto* path = std::get_if<DrawnPath>(&item)) {
      for (const Eigen::Vector2d& p : path->points) EXPECT_TRUE(p.allFinite());
    }
}

// No run stands, and the margin has no command: the axis of the margin fits the time before the
// fall, and does not extend to a metre.
TEST(Loci, TheMarginOfAFallenRunIsThatBeforeItsFall) {
  const TwoRuns runs;
  LociOptions options;
  options.model = &runs.model;
  const Drawing drawing = draw_loci({{"open loop", &runs.falling}}, options);
  EXPECT_LT(largest_number_of(drawing, "margin [mm]"), 200);
  EXPECT_TRUE(has(drawing,
                  "The axes fit the command and the time before the fall. The curves of a run that "
                  "falls end at the edge of the axes. A cross marks the fall."));
}

// In this run, the COG is 180 mm beside its command 0.05 s before the fall, and 320 mm at the fall.
TEST(Loci, TheAxesOfRunsThatAllFallFitTheTimeBeforeTheFalls) {
  const TwoRuns runs;
  const double fallen =
      largest_number_of(draw_loci({{"a", &runs.falling}, {"b", &runs.falling}}, {}), "COG y [mm]");
  EXPECT_GE(fallen, 150);
  EXPECT_LT(fallen, 245);
  EXPECT_LT(largest_number_of(draw_loci(runs.both(), {}), "COG y [mm]"), 150)
      << "a run that stands decides the axes";
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
  EXPECT_TRUE(has(drawing, "1 L 0.00 s"));
  EXPECT_TRUE(has(drawing, "2 R 0.00 s"));
  EXPECT_TRUE(has(drawing, "x [mm]"));
  // A sole is 0.09 x 0.05 m.
  for (const auto& item : drawing.items)
    if (const auto* path = std::get_if<DrawnPath>(&item))
      if (path->closed && path->fill[3] > 0 && path->fill[3] < 0.5 && path->points.size() == 4) {
        const Eigen::Vector2d size = (path->points[2] - path->points[0]).cwiseAbs();
        EXPECT_NEAR(size.x() / size.y(), 1.8, 1e-6);
      }
}

Eigen::AlignedBox2d box_of(const DrawnText& text) {
  const double wide = text_width(text.text, text.size, text.bold);
  const double left = text.position.x() - (text.anchor == TextAnchor::left     ? 0
                                           : text.anchor == TextAnchor::center ? 0.5 * wide
                                                                               : wide);
  return {Eigen::Vector2d(left, text.position.y() - 0.75 * text.size),
          Eigen::Vector2d(left + wide, text.position.y())};
}

/// The first two words, read from left to right, that overlap, if there are any.
std::string words_over_each_other(const Drawing& drawing) {
  std::vector<DrawnText> all;
  for (const auto& item : drawing.items)
    if (const auto* text = std::get_if<DrawnText>(&item); text && !text->upwards)
      all.push_back(*text);
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (box_of(all[i]).intersects(box_of(all[j]))) return all[j].text + " | " + all[i].text;
  return "";
}

// Steps overlap, on the spot and in a circle: every foothold has its number and time, and the
// labels do not touch.
TEST(Loci, FootholdsAreNumberedAndTheirLabelsStandApart) {
  TwoRuns runs;
  for (const double stride : {0.0, 0.03, -0.2}) {
    SimulationLog log = runs.standing;
    for (size_t k = 0; k < log.samples.size(); ++k) {
      const size_t step = k / 50;
      log.samples[k].planned_contact = {step % 2 == 0, step % 2 == 1};
      log.samples[k].state.base.position = {stride * double(step), 0.02, 0.3};
      log.samples[k].state.theta.setZero();
    }
    const Drawing drawing = draw_support(runs.model, {{"DTAD", &log}}, {});
    for (int n = 1; n <= 10; ++n)
      EXPECT_TRUE(has(drawing, std::to_string(n) + (n % 2 == 1 ? " L " : " R ") +
                                   std::to_string((n - 1) / 10) + "." +
                                   std::to_string((n - 1) % 10) + "0 s"))
          << n << " " << stride;
    EXPECT_EQ(words_over_each_other(drawing), "") << stride;
    // A foot that lands after a fall makes no foothold.
    log.result.outcome = Outcome::fell;
    log.result.fell_at = 0.45;
    const Drawing fallen = draw_support(runs.model, {{"DTAD", &log}}, {});
    EXPECT_TRUE(has(fallen, "5 L 0.40 s")) << stride;
    EXPECT_FALSE(has(fallen, "6 R 0.50 s")) << stride;
  }
}

// A motion of the joints alone leaves COG and ZMP in their places: only the joints show it.
TEST(Loci, ShowWhatMovesMost) {
  TwoRuns runs;
  SimulationLog log = runs.standing;
  for (size_t k = 0; k < log.samples.size(); ++k) {
    SimulationSample& s = log.samples[k];
    s.state.theta.setZero();
    s.state.theta[1] = 0.6 * std::sin(0.01 * double(k));
    s.state.theta[2] = 0.2 * std::cos(0.02 * double(k));
    s.state.theta[4] = 0.6 * std::sin(0.01 * double(k)) + 0.001;  // it moves like the first one
    s.state.theta[3] = 0.01 * std::sin(0.3 * double(k));          // it moves too little
  }
  LociOptions options;
  options.model = &runs.model;
  const Drawing drawing = draw_loci({{"DTAD", &log}}, options);
  const std::vector<Dof>& dofs = runs.model.dofs();
  EXPECT_TRUE(has(drawing, "moves most [deg]"));
  EXPECT_TRUE(has(drawing, dofs[1].name + ", " + dofs[4].name) ||
              has(drawing, dofs[4].name + ", " + dofs[1].name));
  EXPECT_TRUE(has(drawing, dofs[2].name));
  EXPECT_FALSE(has(drawing, dofs[3].name));
  EXPECT_EQ(loci_series(options).front(), "moves most [deg]");
  for (SimulationSample& s : log.samples)
    s.state.base.attitude = Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitX());
  log.samples.front().state.base.attitude.setIdentity();
  EXPECT_TRUE(has(draw_loci({{"DTAD", &log}}, options), "trunk roll"));
}

/// The points of a drawing's lines with that width of the stroke.
std::vector<Eigen::Vector2d> points_of(const Drawing& drawing, double width) {
  std::vector<Eigen::Vector2d> points;
  for (const auto& item : drawing.items)
    if (const auto* path = std::get_if<DrawnPath>(&item); path && path->width == width)
      points.insert(points.end(), path->points.begin(), path->points.end());
  return points;
}

// However short a landing is, its force is drawn up to the top, with its value.
TEST(Loci, LandingForcesAreDrawnToTheirTop) {
  TwoRuns runs;
  for (const double force : {300.0, 5000.0}) {
    SimulationLog log = runs.standing;
    log.samples[200].fz = force;
    log.samples[400].fz = 0.9 * force;
    const Drawing drawing =
        draw_loci({{"DTAD", &log}}, {.cog = false, .zmp = false, .command = false});
    EXPECT_TRUE(has(drawing, std::to_string(int(force)) + " N"));
    EXPECT_TRUE(has(drawing, std::to_string(int(std::lround(0.9 * force))) + " N"));
    double top = INFINITY, frame = INFINITY;
    for (const Eigen::Vector2d& p : points_of(drawing, 1.6)) top = std::min(top, p.y());
    for (const auto& item : drawing.items)
      if (const auto* path = std::get_if<DrawnPath>(&item); path && path->closed)
        for (const Eigen::Vector2d& p : path->points) frame = std::min(frame, p.y());
    EXPECT_GT(top, frame + 2) << "not cut off at the frame";
  }
  for (const std::string& text : texts(draw_loci({{"DTAD", &runs.standing}}, {})))
    EXPECT_FALSE(text.ends_with(" N")) << text << ": nothing lands";
}

// A landing soon follows a lift-off. In an earlier version, the value of the lift-off was drawn
// under that of the landing.
TEST(Loci, ValuesOfForcesStandBesideTheCurves) {
  TwoRuns runs;
  SimulationLog log = runs.standing;
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const auto top = [k](double at) {
      return std::max(0.0, 1 - std::abs(static_cast<double>(k) - at) / 10);
    };
    log.samples[k].fz = 60 + 240 * std::max(top(200), 0.99 * top(215));
  }
  const Drawing drawing =
      draw_loci({{"DTAD", &log}}, {.cog = false, .zmp = false, .command = false});
  int values = 0;
  for (const auto& item : drawing.items) {
    const auto* text = std::get_if<DrawnText>(&item);
    if (!text || !text->text.ends_with(" N")) continue;
    ++values;
    const Eigen::AlignedBox2d box(
        text->position - Eigen::Vector2d(0, text->size),
        text->position + Eigen::Vector2d(text_width(text->text, text->size), 0));
    for (const Eigen::Vector2d& p : points_of(drawing, 1.6))
      EXPECT_FALSE(box.contains(p)) << text->text << " at " << p.transpose();
  }
  EXPECT_GT(values, 0);
}

TEST(Loci, ThereIsNoZmpInFlight) {
  TwoRuns runs;
  SimulationLog log = runs.standing;
  for (size_t k = 200; k < 300; ++k) {
    log.samples[k].fz = 0;
    log.samples[k].planned_contact = {false, false};
  }
  LociOptions options{.cog = false, .fz = false};
  const Drawing drawing = draw_loci({{"DTAD", &log}}, options);
  const double left = 78, right = options.width - 18;                       // edges of the panels
  const auto time = [&](double x) { return (x - left) / (right - left); };  // place of one second
  for (const double width : {1.6, 1.3, 1.1})
    for (const Eigen::Vector2d& p : points_of(drawing, width))
      EXPECT_FALSE(p.y() > 60 && time(p.x()) > 0.401 && time(p.x()) < 0.597)
          << width << ", below the legend";
}

// A telephone is 360 pixels wide: everything is inside, nothing touches, and no letter is smaller
// than 11.
TEST(Loci, NarrowDrawingsCanBeRead) {
  TwoRuns runs;
  runs.standing.provenance.pattern = "a_walk_with_a_rather_long_name_of_its_file.json";
  LociOptions options;
  options.model = &runs.model;
  for (const double width : {340.0, 358.0, 600.0}) {
    options.width = width;
    for (const Drawing& drawing :
         {draw_loci(runs.both(), options), draw_support(runs.model, runs.both(), options)}) {
      EXPECT_EQ(words_over_each_other(drawing), "") << width;
      for (const auto& item : drawing.items)
        if (const auto* text = std::get_if<DrawnText>(&item)) {
          EXPECT_GE(text->size, 11) << text->text;
          if (text->upwards) continue;
          EXPECT_GE(box_of(*text).min().x(), 0) << text->text;
          EXPECT_LE(box_of(*text).max().x(), width) << text->text;
        }
    }
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
  EXPECT_EQ(message_of({}, {}), "plot: there is no run to draw");
  EXPECT_NE(message_of(std::vector<LociRun>(7, {"a", &runs.standing}), {}).find("at most 6"),
            std::string::npos);
  EXPECT_EQ(
      message_of(runs.both(), {.begin = 3}),
      "plot: the times from 3 s to 1 s are outside the runs, because the longest run lasts 1 s");
  EXPECT_NE(message_of(runs.both(), {.width = 10}).find("300"), std::string::npos);
  EXPECT_NE(message_of(runs.both(), {.cog = false, .zmp = false, .fz = false}).find("every panel"),
            std::string::npos);
  const LociOptions with_model = {.model = &runs.model};
  SimulationLog foreign = runs.standing;
  foreign.joints.front() = "other";
  EXPECT_NE(message_of({{"A", &runs.standing}, {"B", &foreign}}, with_model)
                .find("run 'B' has " + std::to_string(foreign.joints.size()) +
                      " joints, but the robot '"),
            std::string::npos);
  const SimulationLog empty;
  EXPECT_NE(message_of({{"a", &empty}}, {}).find("no samples"), std::string::npos);
}

}  // namespace
}  // namespace ayumi
