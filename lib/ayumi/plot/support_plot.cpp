#include <algorithm>
#include <cmath>

#include "ayumi/plot/com_zmp_plot_parts.hpp"
#include "ayumi/render/robot_surface.hpp"

namespace ayumi {
namespace {

using namespace plot;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct PlacedSole {
  Side side;
  std::vector<Vector2d> corners;
};

/// The soles where the plan puts them down, at the middle of each planned contact.
std::vector<PlacedSole> footholds(const RobotModel& model, const SimulationLog& log,
                                  const Interval& time) {
  std::vector<PlacedSole> out;
  if (!model.has_soles()) return out;
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
        PlacedSole foothold = {side, {}};
        for (const Vector2d& corner : sole.polygon)
          foothold.corners.push_back((frame * Vector3d(corner.x(), corner.y(), 0)).head<2>());
        out.push_back(foothold);
      }
      begin = end;
    }
  }
  return out;
}

std::vector<Vector2d> path_of(const SimulationLog& log, const Interval& time,
                              Vector3d SimulationSample::*quantity) {
  std::vector<Vector2d> points;
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const double t = static_cast<double>(k) * log.dt;
    if (t >= time.low - 1e-9 && t <= time.high + 1e-9)
      points.push_back((log.samples[k].*quantity).head<2>());
  }
  return points;
}

/// Both axes to one scale, around everything that stands or was planned.
Axes make_axes(const Drawing& drawing, const std::vector<LociRun>& runs, const Interval& time,
               const std::vector<PlacedSole>& feet, double top) {
  Eigen::AlignedBox2d box;
  for (const PlacedSole& foot : feet)
    for (const Vector2d& corner : foot.corners) box.extend(corner);
  for (const LociRun& run : runs)
    for (const auto quantity : {&SimulationSample::cog, &SimulationSample::zmp})
      if (!has_fallen(*run.log))
        for (const Vector2d& point : path_of(*run.log, time, quantity)) box.extend(point);
  for (const Vector2d& point : path_of(*runs.back().log, time, &SimulationSample::command_cog))
    box.extend(point);
  const Vector2d middle = box.center();
  const Vector2d half = 0.55 * box.sizes().cwiseMax(0.1);
  Axes axes;
  axes.left = kLeft;
  axes.top = top;
  axes.width = drawing.width - kLeft - kRight;
  axes.x = {middle.x() - half.x(), middle.x() + half.x()};
  axes.height = std::clamp(axes.width * half.y() / half.x(), 160.0, axes.width);
  const double metres = axes.height / axes.width * half.x();
  if (metres < half.y()) {
    const double wider = half.y() * axes.width / axes.height;
    axes.x = {middle.x() - wider, middle.x() + wider};
  }
  const double tall = axes.x.span() * axes.height / axes.width / 2;
  axes.y = {middle.y() - tall, middle.y() + tall};
  return axes;
}

void draw_foothold(Drawing& drawing, const Axes& axes, const PlacedSole& foot) {
  const Eigen::Vector4f color = foot.side == Side::left ? Eigen::Vector4f(0.20f, 0.45f, 0.75f, 1)
                                                        : Eigen::Vector4f(0.80f, 0.50f, 0.10f, 1);
  DrawnPath outline = {.closed = true, .stroke = color, .fill = color, .width = 1.2};
  outline.fill[3] = 0.08f;
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& corner : foot.corners) {
    outline.points.push_back(axes.at(corner.x(), corner.y()));
    middle += outline.points.back() / static_cast<double>(foot.corners.size());
  }
  drawing.items.push_back(outline);
  // In the outer corner of the toes, away from the loci.
  const double outwards = foot.side == Side::left ? -1 : 1;
  const Vector2d corner = *std::max_element(
      outline.points.begin(), outline.points.end(), [&](const Vector2d& a, const Vector2d& b) {
        return a.x() + outwards * a.y() < b.x() + outwards * b.y();
      });
  drawing.items.push_back(DrawnText{.position = corner + 0.13 * (middle - corner) + Vector2d(0, 4),
                                    .text = foot.side == Side::left ? "L" : "R",
                                    .size = 12,
                                    .anchor = TextAnchor::center,
                                    .bold = true,
                                    .color = color});
}

}  // namespace

Drawing draw_support(const RobotModel& model, const std::vector<LociRun>& runs,
                     const LociOptions& options) {
  const Interval time = time_range(runs, options);
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
  const std::vector<PlacedSole> feet = footholds(model, last, time);
  const double top = draw_legend(drawing, entries, 44) + 12;
  const Axes axes = make_axes(drawing, runs, time, feet, top);
  draw_axes(drawing, axes, "y [m]", true);
  for (const PlacedSole& foot : feet) draw_foothold(drawing, axes, foot);
  for (size_t i = 0; i < runs.size(); ++i) {
    draw_line(drawing, axes, path_of(*runs[i].log, time, &SimulationSample::zmp),
              entries[2 * i + 1].second);
    draw_line(drawing, axes, path_of(*runs[i].log, time, &SimulationSample::cog),
              entries[2 * i].second);
  }
  draw_line(drawing, axes, path_of(last, time, &SimulationSample::reference_zmp), kReferenceStyle);
  draw_line(drawing, axes, path_of(last, time, &SimulationSample::command_cog), kCommandStyle);
  drawing.items.push_back(
      DrawnText{.position = {axes.left + axes.width / 2, axes.top + axes.height + 36},
                .text = "x [m]",
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
