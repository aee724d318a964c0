#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/plot/com_zmp_plot_parts.hpp"
#include "ayumi/render/robot_surface.hpp"
#include "ayumi/sim/has_zmp.hpp"

namespace ayumi {
namespace {

using namespace plot;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct PlacedSole {
  Side side;
  std::vector<Vector2d> corners;  ///< corners of the sole [mm]
  double begin = 0, end = 0;      ///< time while the sole is planned on the ground [s]
};

/// The soles at their planned places, in the middle of each planned contact.
std::vector<PlacedSole> footholds(const RobotModel& model, const SimulationLog& log,
                                  const Interval& time) {
  std::vector<PlacedSole> out;
  if (!model.has_soles() || time.high <= time.low) return out;
  const auto first = static_cast<size_t>(std::max(0.0, std::round(time.low / log.dt)));
  const auto last =
      std::min(log.samples.size(), static_cast<size_t>(std::round(time.high / log.dt)) + 1);
  for (const Side side : {Side::left, Side::right}) {
    const auto planned = [&](size_t k) {
      return log.samples[k].planned_contact[static_cast<size_t>(side)];
    };
    for (size_t begin = first; begin < last;) {
      size_t end = begin + 1;
      while (end < last && planned(end) == planned(begin)) ++end;
      if (planned(begin)) {
        const SimulationSample& middle = log.samples[(begin + end) / 2];
        const Sole& sole = model.sole(side);
        const Eigen::Isometry3d frame =
            body_poses(model, middle.state)[size_t(sole.body)] * sole.frame;
        PlacedSole foothold = {
            side, {}, static_cast<double>(begin) * log.dt, static_cast<double>(end) * log.dt};
        for (const Vector2d& corner : sole.polygon)
          foothold.corners.push_back((frame * Vector3d(corner.x(), corner.y(), 0)).head<2>() /
                                     kMillimetre);
        out.push_back(foothold);
      }
      begin = end;
    }
  }
  // The soles are sorted in the order in which they land.
  std::stable_sort(out.begin(), out.end(),
                   [](const PlacedSole& a, const PlacedSole& b) { return a.begin < b.begin; });
  return out;
}

/// The part of this interval before the robot falls. After that, its soles and its ZMP say nothing
/// about the motion.
Interval before_fall(const SimulationLog& log, Interval time) {
  if (has_fallen(log)) time.high = std::clamp(log.result.fell_at, time.low, time.high);
  return time;
}

std::vector<Vector2d> path_of(const SimulationLog& log, const Interval& time,
                              Vector3d SimulationSample::*quantity) {
  std::vector<Vector2d> points;
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const double t = static_cast<double>(k) * log.dt;
    if (t < time.low - 1e-9 || t > time.high + 1e-9) continue;
    const SimulationSample& s = log.samples[k];
    const bool planned = s.planned_contact[0] || s.planned_contact[1];
    const bool there = quantity == &SimulationSample::zmp             ? has_zmp(s)
                       : quantity == &SimulationSample::reference_zmp ? planned
                                                                      : true;
    const double none = std::nan("");  // value of the ZMP in flight
    points.push_back(there ? Vector2d((s.*quantity).head<2>() / kMillimetre)
                           : Vector2d(none, none));
  }
  return points;
}

/// Both axes have one scale, and show everything that stands on the ground or was planned to stand
/// there.
Axes make_axes(const Drawing& drawing, const std::vector<LociRun>& runs, const Interval& time,
               const std::vector<PlacedSole>& feet, double top) {
  Eigen::AlignedBox2d box;
  for (const PlacedSole& foot : feet)
    for (const Vector2d& corner : foot.corners) box.extend(corner);
  for (const LociRun& run : runs)
    for (const auto quantity : {&SimulationSample::cog, &SimulationSample::zmp})
      if (!has_fallen(*run.log))
        for (const Vector2d& point : path_of(*run.log, time, quantity))
          if (point.allFinite()) box.extend(point);
  for (const Vector2d& point : path_of(*runs.back().log, time, &SimulationSample::command_cog))
    box.extend(point);
  const Vector2d middle = box.center();
  Vector2d half = 0.55 * box.sizes().cwiseMax(100);
  // Distance from the footholds in which their labels are placed [pixel].
  constexpr double kRoom = 26;
  half += Vector2d(kRoom, kRoom) * 2 * half.x() / (drawing.width - kLeft - kRight);
  Axes axes;
  axes.left = kLeft;
  axes.top = top;
  axes.width = drawing.width - kLeft - kRight;
  axes.x = {middle.x() - half.x(), middle.x() + half.x()};
  axes.height = std::clamp(axes.width * half.y() / half.x(), 160.0, axes.width);
  const double reached = axes.height / axes.width * half.x();
  if (reached < half.y()) {
    const double wider = half.y() * axes.width / axes.height;
    axes.x = {middle.x() - wider, middle.x() + wider};
  }
  const double tall = axes.x.span() * axes.height / axes.width / 2;
  axes.y = {middle.y() - tall, middle.y() + tall};
  return axes;
}

Eigen::Vector4f color_of(Side side) {
  return side == Side::left ? Eigen::Vector4f(0.20f, 0.45f, 0.75f, 1)
                            : Eigen::Vector4f(0.72f, 0.42f, 0.05f, 1);
}

void draw_foothold(Drawing& drawing, const Axes& axes, const PlacedSole& foot) {
  DrawnPath outline = {.closed = true, .stroke = color_of(foot.side), .width = 1.2};
  outline.fill = outline.stroke;
  outline.fill[3] = 0.08f;
  for (const Vector2d& corner : foot.corners)
    outline.points.push_back(axes.at(corner.x(), corner.y()));
  drawing.items.push_back(outline);
}

/// Draws labels with the number in the order of landing, the foot and the time, each joined to its
/// foothold by a line. A label stands near its own foothold, where it covers no other label and as
/// few soles as possible.
void label_footholds(Drawing& drawing, const Axes& axes, const std::vector<PlacedSole>& feet) {
  constexpr double kText = 11, kPad = 2, kTurns = 24;
  std::vector<Eigen::AlignedBox2d> taken, soles;
  for (const PlacedSole& foot : feet) {
    Eigen::AlignedBox2d box;
    for (const Vector2d& corner : foot.corners) box.extend(axes.at(corner.x(), corner.y()));
    soles.push_back(box);
  }
  const Eigen::AlignedBox2d frame(Vector2d(axes.left, axes.top),
                                  Vector2d(axes.left + axes.width, axes.top + axes.height));
  for (size_t i = 0; i < feet.size(); ++i) {
    const PlacedSole& foot = feet[i];
    const std::string words = std::to_string(i + 1) + (foot.side == Side::left ? " L " : " R ") +
                              text::fixed(foot.begin, 2) + " s";
    const Vector2d half(0.5 * text_width(words, kText) + kPad, 0.5 * kText + kPad);
    const Vector2d middle = soles[i].center();
    const double outwards =
        foot.side == Side::left ? -M_PI / 2 : M_PI / 2;  // direction in the picture
    double best = INFINITY;
    Eigen::AlignedBox2d place;
    for (double away = 0.5 * soles[i].sizes().minCoeff(); away < axes.width; away += 0.7 * kText) {
      for (int turn = 0; turn < kTurns; ++turn) {
        const double angle = outwards + 2 * M_PI * turn / kTurns;
        const Vector2d at = middle + away * Vector2d(std::cos(angle), std::sin(angle));
        const Eigen::AlignedBox2d box(at - half, at + half);
        if (!frame.contains(box)) continue;
        if (std::any_of(taken.begin(), taken.end(),
                        [&](const auto& other) { return other.intersects(box); }))
          continue;
        const auto covered = std::count_if(soles.begin(), soles.end(),
                                           [&](const auto& sole) { return sole.intersects(box); });
        const double turned = std::abs(std::remainder(angle - outwards, 2 * M_PI));
        const double price = away + 30.0 * static_cast<double>(covered) + 20 * turned;
        if (price < best) {
          best = price;
          place = box;
        }
      }
      if (away > best) break;
    }
    if (!std::isfinite(best)) continue;  // more footholds than the plot has room for
    taken.push_back(place);
    drawing.items.push_back(
        DrawnPath{.points = {middle, place.center()}, .stroke = color_of(foot.side), .width = 0.6});
    drawing.items.push_back(
        DrawnPath{.points = {place.min(), Vector2d(place.max().x(), place.min().y()), place.max(),
                             Vector2d(place.min().x(), place.max().y())},
                  .closed = true,
                  .stroke = color_of(foot.side),
                  .fill = {1, 1, 1, 0.9f},
                  .width = 0.6});
    drawing.items.push_back(DrawnText{.position = place.center() + Vector2d(0, 0.36 * kText),
                                      .text = words,
                                      .size = kText,
                                      .anchor = TextAnchor::center,
                                      .color = color_of(foot.side)});
  }
}

}  // namespace

Drawing draw_support(const RobotModel& model, const std::vector<LociRun>& as_logged,
                     const LociOptions& options) {
  const Interval time = time_range(&model, as_logged, options);
  const FramedRuns framed(&model, as_logged, options.frame);
  const std::vector<LociRun>& runs = framed.runs;
  Drawing drawing = start_drawing(runs, options, "COG and ZMP from above");
  Legend entries;
  for (size_t i = 0; i < runs.size(); ++i) {
    LineStyle style = run_style(i, runs.size());
    entries.emplace_back("COG " + legend_name(runs[i]), style);
    style.width = 0.9;
    style.dashes = {3, 2};
    entries.emplace_back("ZMP " + runs[i].label, style);
  }
  entries.emplace_back("COG command", kCommandStyle);
  entries.emplace_back("reference ZMP", kReferenceStyle);
  const SimulationLog& last = *runs.back().log;
  const std::vector<PlacedSole> feet = footholds(model, last, before_fall(last, time));
  const double top = draw_legend(drawing, entries, 44) + 12;
  const Axes axes = make_axes(drawing, runs, time, feet, top);
  draw_axes(drawing, axes, "y [mm]", true);
  for (const PlacedSole& foot : feet) draw_foothold(drawing, axes, foot);
  for (size_t i = 0; i < runs.size(); ++i) {
    const Interval shown = before_fall(*runs[i].log, time);
    draw_line(drawing, axes, path_of(*runs[i].log, shown, &SimulationSample::zmp),
              entries[2 * i + 1].second);
    draw_line(drawing, axes, path_of(*runs[i].log, shown, &SimulationSample::cog),
              entries[2 * i].second);
  }
  draw_line(drawing, axes, path_of(last, before_fall(last, time), &SimulationSample::reference_zmp),
            kReferenceStyle);
  draw_line(drawing, axes, path_of(last, time, &SimulationSample::command_cog), kCommandStyle);
  label_footholds(drawing, axes, feet);
  drawing.items.push_back(
      DrawnText{.position = {axes.left + axes.width / 2, axes.top + axes.height + 36},
                .text = "x [mm]",
                .size = 13,
                .anchor = TextAnchor::center});
  drawing.height = axes.top + axes.height + 48;
  return drawing;
}

void write_support_plot(const RobotModel& model, const std::vector<LociRun>& runs,
                        const std::filesystem::path& path, const LociOptions& options) {
  write_drawing(path, draw_support(model, runs, options), options.png_scale);
}

}  // namespace ayumi
