#include "ayumi/plot/push_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/plot/axes.hpp"

namespace ayumi {
namespace {

using Eigen::Vector2d;
using Eigen::Vector4f;

constexpr double kPanel = 300,
                 kRadius = 108;  // width of one panel, and radius of its largest ring [pixel]
constexpr double kHead = 74, kSide = 14;         // space above and beside the panels [pixel]
constexpr double kPhaseName = 26, kRemark = 20;  // heights of lines of text [pixel]
constexpr double kLegendLine = 18;               // the same for a legend of several lines
constexpr size_t kColumns = 3, kMostLaws = 4;    // columns of panels; as many laws as colours
constexpr int kCircleSteps = 72;                 // corners of a ring, one every 5 degrees

constexpr double kSmall = 11;                 // size of the smallest letters [pixel]
constexpr double kDot = 2.6, kDotLine = 1.2;  // radius and line of a value's dot [pixel]
// Space between the largest ring and the name of a direction, so that a dot on the ring does not
// touch the name.
constexpr double kNameGap = kDot + kDotLine / 2 + 4;

const Vector4f kMapGrid = {0.86f, 0.87f, 0.89f, 1}, kQuiet = {0.42f, 0.44f, 0.48f, 1};
const Vector4f kBound = {0.35f, 0.37f, 0.42f, 1}, kBoundFill = {0.35f, 0.37f, 0.42f, 0.08f};
const Vector4f kOpen = {0.86f, 0.45f, 0.10f, 1};
const Vector4f kLaws[kMostLaws] = {{0.08f, 0.33f, 0.68f, 1},
                                   {0.62f, 0.12f, 0.24f, 1},
                                   {0.10f, 0.50f, 0.32f, 1},
                                   {0.45f, 0.25f, 0.60f, 1}};

struct Panel {
  Vector2d center;
  double most;  // impulse at the largest ring [N s]

  /// The place of a value. Forward is up, and left is left.
  Vector2d at(double direction, double impulse) const {
    const double r = kRadius * impulse / most;
    return center + r * Vector2d(-std::sin(direction), -std::cos(direction));
  }
};

DrawnPath circle(const Vector2d& center, double radius, int steps) {
  DrawnPath path;
  path.closed = true;
  for (int i = 0; i < steps; ++i) {
    const double a = 2 * M_PI * i / steps;
    path.points.push_back(center + radius * Vector2d(std::cos(a), std::sin(a)));
  }
  return path;
}

void draw_grid(Drawing& drawing, const Panel& panel, const PushMapPhase& phase,
               const std::vector<double>& rings) {
  const int digits = tick_digits(rings);
  for (const double ring : rings) {
    if (ring <= 0) continue;
    DrawnPath path = circle(panel.center, kRadius * ring / panel.most, kCircleSteps);
    path.stroke = kMapGrid;
    drawing.items.push_back(path);
  }
  for (const double direction : phase.direction) {
    DrawnPath path;
    path.points = {panel.center, panel.at(direction, panel.most)};
    path.stroke = kMapGrid;
    drawing.items.push_back(path);
  }
  // A direction between the last and the first one, where there is no line and no value of a curve.
  // With few directions, it is between "forward" and "right".
  double beside = -M_PI / 4;
  if (phase.direction.size() > 2) {
    const auto [first, last] = std::minmax_element(phase.direction.begin(), phase.direction.end());
    beside = 0.5 * (*first + *last) - M_PI;
  }
  for (const double ring : rings)
    if (ring > 0)
      drawing.items.push_back(DrawnText{.position = panel.at(beside, ring) + Vector2d(0, 4),
                                        .text = text::fixed(ring, digits),
                                        .size = kSmall,
                                        .anchor = TextAnchor::center,
                                        .color = kQuiet});
  const auto name = [&](const Vector2d& at, const char* word, TextAnchor anchor) {
    drawing.items.push_back(DrawnText{.position = panel.center + at,
                                      .text = word,
                                      .size = kSmall,
                                      .anchor = anchor,
                                      .color = kQuiet});
  };
  name({0, -kRadius - kNameGap - 1}, "forward", TextAnchor::center);
  name({0, kRadius + kNameGap + 8}, "back", TextAnchor::center);
  name({-kRadius - kNameGap, 3}, "left", TextAnchor::right);
  name({kRadius + kNameGap, 3}, "right", TextAnchor::left);
}

void draw_curve(Drawing& drawing, const Panel& panel, const std::vector<double>& direction,
                const PushMapCurve& curve, const Vector4f& color) {
  DrawnPath path;
  path.closed = true;
  path.stroke = color;
  path.width = 1.8;
  for (size_t i = 0; i < direction.size(); ++i)
    path.points.push_back(panel.at(direction[i], curve.impulse[i]));
  drawing.items.push_back(path);
  for (size_t i = 0; i < direction.size(); ++i) {
    DrawnPath dot = circle(path.points[i], kDot, 12);
    dot.stroke = color;
    dot.width = kDotLine;
    dot.fill = i < curve.capped.size() && curve.capped[i] ? Vector4f(1, 1, 1, 1) : color;
    drawing.items.push_back(dot);
  }
}

void draw_panel(Drawing& drawing, const Panel& panel, const PushMapPhase& phase,
                const std::vector<double>& rings) {
  drawing.items.push_back(DrawnText{.position = panel.center - Vector2d(0, kRadius + kPhaseName),
                                    .text = phase.name,
                                    .size = 12,
                                    .anchor = TextAnchor::center,
                                    .bold = true});
  DrawnPath bound;
  bound.closed = true;
  bound.stroke = kBound;
  bound.fill = kBoundFill;
  bound.width = 1.3;
  bound.dashes = {5, 3};
  for (size_t i = 0; i < phase.direction.size(); ++i)
    bound.points.push_back(panel.at(phase.direction[i], std::max(0.0, phase.bound[i])));
  draw_grid(drawing, panel, phase, rings);
  drawing.items.push_back(bound);
  for (size_t c = 0; c < phase.curves.size(); ++c)
    draw_curve(drawing, panel, phase.direction, phase.curves[c], c == 0 ? kOpen : kLaws[c - 1]);
}

/// The words of a text, divided into lines of at most this width [pixel].
std::vector<std::string> wrapped(const std::string& words, double width) {
  std::vector<std::string> lines(1);
  std::istringstream in(words);
  for (std::string word; in >> word;) {
    const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
    if (!lines.back().empty() && text_width(longer, kSmall) > width)
      lines.push_back(word);
    else
      lines.back() = longer;
  }
  return lines;
}

// Draws as many lines as the width requires. Returns the height of the lines below the first one.
double draw_legend(Drawing& drawing, const PushMap& map, bool capped) {
  double x = kSide, y = kHead - 24;
  const auto make_room = [&](double width) {
    if (x == kSide || x + width <= drawing.width - kSide) return;
    x = kSide;
    y += kLegendLine;
  };
  const auto entry = [&](const std::string& name, const Vector4f& color, bool dashed) {
    make_room(27 + text_width(name, kSmall));
    DrawnPath line;
    line.points = {{x, y - 4}, {x + 22, y - 4}};
    line.stroke = color;
    line.width = 2;
    if (dashed) line.dashes = {5, 3};
    drawing.items.push_back(line);
    drawing.items.push_back(DrawnText{.position = {x + 27, y}, .text = name, .size = kSmall});
    x += 27 + text_width(name, kSmall) + 18;
  };
  entry("capture bound B", kBound, true);
  entry(map.baseline, kOpen, false);
  for (size_t i = 0; i < map.laws.size(); ++i) entry(map.laws[i], kLaws[i], false);
  std::string unit = "N s, through the COG";
  if (capped) unit += "; hollow point: the robot survives even the largest push that was tried";
  make_room(text_width(unit, kSmall));
  for (const std::string& line : wrapped(unit, drawing.width - kSide - x)) {
    drawing.items.push_back(
        DrawnText{.position = {x, y}, .text = line, .size = kSmall, .color = kQuiet});
    y += kLegendLine;
  }
  return y - kLegendLine - (kHead - 24);
}

void check(const PushMap& map) {
  const auto refuse = [](const std::string& why) { fail(ErrorCode::usage, "push map: " + why); };
  if (map.phases.empty()) refuse("there is no phase to draw");
  if (map.laws.size() > kMostLaws) refuse("more than four controllers cannot be told apart");
  for (const PushMapPhase& phase : map.phases) {
    if (phase.curves.size() != map.laws.size() + 1 || phase.bound.size() != phase.direction.size())
      refuse(phase.name + ": a curve is missing");
    for (const PushMapCurve& curve : phase.curves)
      if (curve.impulse.size() != phase.direction.size())
        refuse(phase.name + ": the number of values of a curve is not the number of directions");
  }
}

}  // namespace

Drawing draw_push_map(const PushMap& map, PushMapLayout layout) {
  check(map);
  double most = 0;
  bool capped = false;
  for (const PushMapPhase& phase : map.phases) {
    for (const double bound : phase.bound) most = std::max(most, bound);
    for (const PushMapCurve& curve : phase.curves) {
      for (const double impulse : curve.impulse) most = std::max(most, impulse);
      for (const bool c : curve.capped) capped = capped || c;
    }
  }
  if (!(most > 0)) most = 1;
  const std::vector<double> rings = nice_ticks({0, most}, 5);
  most = std::max(most, rings.back());

  const bool narrow = layout == PushMapLayout::narrow;
  const size_t columns = narrow ? 1 : std::min(kColumns, map.phases.size());
  const size_t rows = (map.phases.size() + columns - 1) / columns;
  Drawing drawing;
  drawing.width = 2 * kSide + kPanel * static_cast<double>(columns);
  std::vector<std::string> remarks = map.remarks;
  if (narrow) {
    remarks.clear();
    for (const std::string& remark : map.remarks)
      for (const std::string& line : wrapped(remark, drawing.width - 2 * kSide))
        remarks.push_back(line);
  } else {
    drawing.width = std::max(drawing.width, 620.0);
    for (const std::string& remark : remarks)
      drawing.width = std::max(drawing.width, 2 * kSide + text_width(remark, kSmall));
    drawing.width = std::max(drawing.width, 2 * kSide + text_width(map.title, 15, true));
  }
  drawing.title = map.title;
  drawing.description = "largest survivable impulse by direction and gait phase";
  if (!narrow)  // the page that contains it has a heading
    drawing.items.push_back(
        DrawnText{.position = {kSide, 26}, .text = map.title, .size = 15, .bold = true});
  const double head = kHead + draw_legend(drawing, map, capped);
  drawing.height = head + kPanel * static_cast<double>(rows) +
                   kRemark * static_cast<double>(remarks.size()) + kSide;
  for (size_t i = 0; i < map.phases.size(); ++i) {
    const Vector2d corner(kSide + kPanel * static_cast<double>(i % columns),
                          head + kPanel * static_cast<double>(i / columns));
    draw_panel(drawing, {corner + Vector2d(kPanel / 2, kPanel / 2 + 8), most}, map.phases[i],
               rings);
  }
  double y = head + kPanel * static_cast<double>(rows) + 10;
  for (const std::string& remark : remarks) {
    drawing.items.push_back(DrawnText{.position = {kSide, y}, .text = remark, .size = kSmall});
    y += kRemark;
  }
  return drawing;
}

void write_push_map(const PushMap& map, const std::filesystem::path& path) {
  write_drawing(path, draw_push_map(map), 2);
}

namespace {

/// A foot makes a step if it lands at least this far from where it left the ground [m], or turned
/// at least this much [rad]. Chosen: above the slip that the check allows, and below the steps of
/// small robots.
constexpr double kStepDistance = 5e-3, kStepTurn = 0.02;

/// The motion of the robot in the phases in which it does not stand in the first posture. A robot
/// walks if a foot lands at another place than before. A foot that comes back, as after a kick, is
/// no step.
std::string motion_of(const CommandSeries& series) {
  const auto steps = [](const ViipSpan& s) { return std::holds_alternative<StepGoal>(s.goal); };
  if (std::any_of(series.viip.begin(), series.viip.end(), steps)) return "walking";
  std::array<bool, 2> lifted = {false, false};
  for (const Side side : {Side::left, Side::right}) {
    const auto foot = static_cast<size_t>(side);
    const CommandSample* stood = nullptr;  // the last sample in which this foot stood
    bool flown = false;                    // both feet were in the air since then
    for (const CommandSample& sample : series.samples) {
      if (!supports(sample.support, side)) {
        flown = flown || sample.support == Support::none;
        continue;
      }
      if (stood && stood + 1 != &sample && !flown) {
        lifted[foot] = true;
        const Eigen::Isometry3d step = stood->feet[foot].inverse() * sample.feet[foot];
        if (step.translation().norm() > kStepDistance ||
            elementary::angle_between(Eigen::Quaterniond(step.linear()),
                                      Eigen::Quaterniond::Identity()) > kStepTurn)
          return "pushes while walking";
      }
      stood = &sample;
      flown = false;
    }
  }
  return lifted[0] && lifted[1] ? "pushes while stepping in place" : "pushes during the motion";
}

}  // namespace

std::string push_baseline(const CommandSeries& series) {
  return series.viip.empty() ? "open loop" : "no feedback";
}

std::vector<std::string> push_summary_lines(const std::vector<PushCase>& cases,
                                            const PushOptions& push, const CommandSeries& series) {
  const std::string open = push_baseline(series), motion = motion_of(series);
  std::vector<std::string> lines;
  for (size_t k = 0; k < push.controllers.size(); ++k)
    for (const bool standing : {false, true}) {
      const PushSummary s = summarize(cases, k, standing, push.step);
      if (s.cases == 0) continue;
      const std::string when = standing ? "pushes while standing" : motion,
                        law = name_of(push.controllers[k].type);
      lines.push_back(when + ", " + law + ": smallest push limit " + text::fixed(s.worst, 2) +
                      " B (J/m " + text::fixed(s.worst_speed, 2) + " m/s, J/mv " +
                      text::fixed(s.worst_froude, 3) + "), mean push limit " +
                      text::fixed(s.mean, 2) + " B (J/m " + text::fixed(s.mean_speed, 2) +
                      " m/s, J/mv " + text::fixed(s.mean_froude, 3) + ")");
      lines.push_back(when + ", " + open + ": smallest push limit " + text::fixed(s.open_worst, 2) +
                      " B, mean push limit " + text::fixed(s.open_mean, 2) +
                      " B. The push limit of " + law + " is smaller than the push limit of " +
                      open + " in " + std::to_string(s.below_open) + " of " +
                      text::counted(s.cases, "case"));
    }
  return lines;
}

std::string push_map_title(const std::string& pattern, const std::string& robot,
                           const std::string& profile, const PushOptions& push) {
  return pattern + ", " + robot + (profile.empty() ? "" : ", actuators " + profile) +
         ": pushes of " + text::fixed(1e3 * push.duration, 0) + " ms";
}

PushMap push_map(const std::string& title, const std::vector<PushCase>& cases,
                 const PushOptions& push, const CommandSeries& series) {
  PushMap map;
  map.title = title;
  for (const ControllerSpec& c : push.controllers) map.laws.push_back(name_of(c.type));
  map.baseline = push_baseline(series);
  map.remarks = push_summary_lines(cases, push, series);
  const size_t directions = static_cast<size_t>(push.directions);
  for (size_t p = 0; p < cases.size(); p += directions) {
    PushMapPhase phase;
    phase.name = cases[p].phase.name;
    phase.curves.resize(push.controllers.size() + 1);
    for (size_t i = p; i < p + directions; ++i) {
      const PushCase& c = cases[i];
      phase.direction.push_back(c.direction);
      phase.bound.push_back(c.bound);
      for (size_t k = 0; k < phase.curves.size(); ++k) {
        const PushLimit& limit = k == 0 ? c.open_loop : c.limits[k - 1];
        phase.curves[k].impulse.push_back(limit.impulse);
        phase.curves[k].capped.push_back(limit.capped);
      }
    }
    map.phases.push_back(phase);
  }
  return map;
}

}  // namespace ayumi
