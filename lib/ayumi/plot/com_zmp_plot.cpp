#include "ayumi/plot/com_zmp_plot.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/plot/com_zmp_plot_parts.hpp"
#include "ayumi/render/overlay.hpp"
#include "ayumi/render/robot_surface.hpp"

namespace ayumi {
namespace {

using namespace plot;
using Eigen::Vector2d;
using Eigen::Vector4f;
using Value = std::function<double(const SimulationSample&)>;

constexpr double kGap = 12;          // between panels [pixel]
constexpr double kBeforeFall = 0.5;  // so long before a fall it does not show yet [s]

struct PanelPlan {
  std::string name;     ///< with unit
  Value run;            ///< of every run
  Value command;        ///< of the last run; the command is the same for all; empty: none
  Value reference;      ///< of the last run; empty: none
  double least = 0;     ///< span of the axis at least
  bool spikes = false;  ///< landings may exceed the range
  double seen = 0;      ///< runs that differ by less differ in nothing that matters
  std::vector<double> limits = {};  ///< drawn where they are within the range
  bool limits_in_view = false;      ///< the range reaches to the limits
};

constexpr double kDegree = M_PI / 180;

/// Angle or displacement of a joint, with its limits.
PanelPlan joint_panel(const RobotModel& model, int dof) {
  const Dof& d = model.dofs()[static_cast<size_t>(dof)];
  const double unit = d.prismatic ? 1e-3 : kDegree;
  PanelPlan panel;
  panel.name = d.name + (d.prismatic ? " [mm]" : " [deg]");
  panel.run = [dof, unit](const SimulationSample& s) { return s.state.theta[dof] / unit; };
  panel.least = d.prismatic ? 2 : 1;
  const double soft = model.description().soft_limit_margin;
  if (d.limited) panel.limits = {(d.lower + soft) / unit, (d.upper - soft) / unit};
  return panel;
}

PanelPlan speed_panel(const RobotModel& model, const std::string& profile, int dof) {
  const Dof& d = model.dofs()[static_cast<size_t>(dof)];
  const double limit = model.limits(profile).speed[dof];
  PanelPlan panel;
  panel.name = d.name + (d.prismatic ? " [m/s]" : " [rad/s]");
  panel.run = [dof](const SimulationSample& s) { return s.state.dtheta[dof]; };
  panel.least = d.prismatic ? 0.02 : 0.2;
  if (std::isfinite(limit)) panel.limits = {-limit, limit};
  return panel;
}

PanelPlan torque_panel(const RobotModel& model, const std::string& profile, int dof) {
  const Dof& d = model.dofs()[static_cast<size_t>(dof)];
  const double limit = model.limits(profile).peak_torque[dof];
  PanelPlan panel;
  panel.name = d.name + (d.prismatic ? " [N]" : " [N m]");
  panel.run = [dof](const SimulationSample& s) { return s.torque[dof]; };
  panel.least = d.prismatic ? 1 : 0.1;
  if (std::isfinite(limit)) panel.limits = {-limit, limit};
  return panel;
}

Value component(Eigen::Vector3d SimulationSample::*quantity, int index) {
  return [quantity, index](const SimulationSample& s) { return (s.*quantity)[index]; };
}

/// Distance, seen from above, of the ZMP inside the hull of the soles planned down, where they
/// really are; no number in flight.
Value zmp_margin(const RobotModel& model) {
  return [&model](const SimulationSample& s) {
    std::vector<Vector2d> corners;
    for (const Eigen::Vector3d& corner :
         support_corners(model, body_poses(model, s.state), s.planned_contact))
      corners.push_back(corner.head<2>());
    const ConvexPolygon support(std::move(corners));
    return support.empty() ? std::nan("") : support.margin(s.zmp.head<2>());
  };
}

std::vector<PanelPlan> plan_panels(const LociOptions& options) {
  std::vector<PanelPlan> panels;
  using S = SimulationSample;
  const char* axis[] = {"x", "y", "z"};
  if (options.model) {
    for (const int dof : options.joints) panels.push_back(joint_panel(*options.model, dof));
    for (const int dof : options.speeds)
      panels.push_back(speed_panel(*options.model, options.profile, dof));
    for (const int dof : options.torques)
      panels.push_back(torque_panel(*options.model, options.profile, dof));
    for (PanelPlan& panel : panels) panel.limits_in_view = options.limits_in_view;
  }
  if (options.cog)
    for (int i = 0; i < 3; ++i)
      panels.push_back({std::string("COG ") + axis[i] + " [m]",
                        component(&S::cog, i),
                        component(&S::command_cog, i),
                        {},
                        0.01,
                        false,
                        2e-4});
  if (options.zmp)
    for (int i = 0; i < 2; ++i)
      panels.push_back({std::string("ZMP ") + axis[i] + " [m]", component(&S::zmp, i),
                        component(&S::command_zmp, i), component(&S::reference_zmp, i), 0.02, false,
                        5e-4});
  if (options.zmp && options.model && options.model->has_soles())
    panels.push_back({"margin [m]", zmp_margin(*options.model), {}, {}, 0.02, false});
  if (options.fz)
    panels.push_back({"f_z [N]", [](const S& s) { return s.fz; },
                      [](const S& s) { return s.command_fz; },
                      [](const S& s) { return s.reference_fz; }, 10, true, 0.1});
  for (PanelPlan& panel : panels) {
    if (!options.command) panel.command = {};
    if (!options.reference) panel.reference = {};
  }
  return panels;
}

std::vector<Vector2d> series(const SimulationLog& log, const Value& value, const Interval& time) {
  std::vector<Vector2d> points;
  if (!value) return points;
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const double t = static_cast<double>(k) * log.dt;
    if (t >= time.low - 1e-9 && t <= time.high + 1e-9)
      points.emplace_back(t, value(log.samples[k]));
  }
  return points;
}

void extend(std::vector<double>& values, const std::vector<Vector2d>& points) {
  for (const Vector2d& point : points)
    if (std::isfinite(point.y())) values.push_back(point.y());
}

/// What runs that fell had before that, where nothing else says how far a panel has to go.
std::vector<double> values_before_falls(const PanelPlan& panel, const std::vector<LociRun>& runs,
                                        const Interval& time) {
  std::vector<double> values;
  for (const double before : {kBeforeFall, 0.0})
    for (const LociRun& run : runs)
      if (values.empty() || before > 0)
        extend(values, series(*run.log, panel.run,
                              {time.low, std::min(time.high, run.log->result.fell_at - before)}));
  return values;
}

/// Range of the command and the runs that stand, with a margin; a wide one where none stands.
Interval value_range(const PanelPlan& panel, const std::vector<LociRun>& runs,
                     const Interval& time) {
  std::vector<double> values;
  extend(values, series(*runs.back().log, panel.command, time));
  for (const LociRun& run : runs)
    if (!has_fallen(*run.log)) extend(values, series(*run.log, panel.run, time));
  if (panel.reference && !has_fallen(*runs.back().log))
    extend(values, series(*runs.back().log, panel.reference, time));
  if (values.empty()) values = values_before_falls(panel, runs, time);
  if (panel.limits_in_view) values.insert(values.end(), panel.limits.begin(), panel.limits.end());
  if (values.empty()) return {0, panel.least > 0 ? panel.least : 1};
  std::sort(values.begin(), values.end());
  const size_t skip = panel.spikes ? values.size() / 500 : 0;
  Interval range = {values[skip], values[values.size() - 1 - skip]};
  const double missing = std::max(0.0, panel.least - range.span()) / 2;
  const bool standing = std::any_of(runs.begin(), runs.end(),
                                    [](const LociRun& run) { return !has_fallen(*run.log); });
  const double margin = (standing ? 0.1 : 0.5) * std::max(range.span(), panel.least) + missing;
  return {range.low - margin, range.high + margin};
}

// ---- support phases

struct Phase {
  double begin, end;
  std::array<bool, 2> contact;
};

std::vector<Phase> phases(const SimulationLog& log, const Interval& time) {
  std::vector<Phase> out;
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const double t = static_cast<double>(k) * log.dt;
    if (t < time.low - 1e-9 || t > time.high + 1e-9) continue;
    if (out.empty() || out.back().contact != log.samples[k].planned_contact) {
      if (!out.empty()) out.back().end = t;
      out.push_back({t, time.high, log.samples[k].planned_contact});
    }
    out.back().end = std::min(t + log.dt, time.high);
  }
  return out;
}

void draw_phases(Drawing& drawing, const Axes& axes, const std::vector<Phase>& list, bool names) {
  for (const Phase& phase : list) {
    const bool left = phase.contact[0], right = phase.contact[1];
    const double from = axes.px(phase.begin), to = axes.px(phase.end);
    const double bottom = axes.top + axes.height;
    if (left == right)
      drawing.items.push_back(DrawnPath{
          .points = {{from, axes.top}, {to, axes.top}, {to, bottom}, {from, bottom}},
          .closed = true,
          .stroke = {0, 0, 0, 0},
          .fill = left ? Vector4f(0.90f, 0.90f, 0.915f, 1) : Vector4f(0.98f, 0.95f, 0.80f, 1)});
    if (!names) continue;
    const std::vector<std::string> words = left && right ? std::vector<std::string>{"both", ""}
                                           : left        ? std::vector<std::string>{"left", "L", ""}
                                           : right ? std::vector<std::string>{"right", "R", ""}
                                                   : std::vector<std::string>{"flight", "F", ""};
    for (const std::string& word : words) {
      if (text_width(word, 10) + 2 > to - from) continue;
      drawing.items.push_back(DrawnText{.position = {(from + to) / 2, axes.top - 4},
                                        .text = word,
                                        .size = 10,
                                        .anchor = TextAnchor::center,
                                        .color = {0.4f, 0.4f, 0.44f, 1}});
      break;
    }
  }
}

// ---- marks and words

void draw_pushes(Drawing& drawing, const Axes& axes, const std::vector<PushRecord>& list,
                 bool names) {
  for (const PushRecord& push : list) {
    const double x = axes.px(push.begin), bottom = axes.top + axes.height;
    drawing.items.push_back(
        DrawnPath{.points = {{x, axes.top}, {x, bottom}}, .stroke = kPushColor, .width = 1.4});
    if (!names) continue;
    const bool leftward = x > axes.left + 0.8 * axes.width;
    drawing.items.push_back(
        DrawnText{.position = {x + (leftward ? -4 : 4), axes.top - 17},
                  .text = "push " + push_text(push) + " at " + text::brief(push.begin) + " s",
                  .size = 11.5,
                  .anchor = leftward ? TextAnchor::right : TextAnchor::left,
                  .color = kPushColor});
  }
}

/// What the ranges leave out.
std::string range_note(const std::vector<LociRun>& runs) {
  const auto fell = [](const LociRun& run) { return has_fallen(*run.log); };
  if (std::none_of(runs.begin(), runs.end(), fell)) return "";
  return std::string("The axes fit the command and ") +
         (std::all_of(runs.begin(), runs.end(), fell) ? "the time before the fall"
                                                      : "the runs that stand") +
         "; curves of a fall are cut off at their edge. A cross marks the fall.";
}

void draw_panel(Drawing& drawing, const Axes& axes, const PanelPlan& panel,
                const std::vector<LociRun>& runs) {
  const SimulationLog& last = *runs.back().log;
  if (panel.reference)
    draw_line(drawing, axes, series(last, panel.reference, axes.x), kReferenceStyle);
  for (const double limit : panel.limits)
    if (limit > axes.y.low && limit < axes.y.high)
      draw_line(drawing, axes, {{axes.x.low, limit}, {axes.x.high, limit}}, kLimitStyle);
  for (size_t i = 0; i < runs.size(); ++i) {
    const LineStyle style = run_style(i, runs.size());
    draw_line(drawing, axes, series(*runs[i].log, panel.run, axes.x), style);
    const double fell_at = runs[i].log->result.fell_at;
    if (has_fallen(*runs[i].log) && fell_at >= axes.x.low && fell_at <= axes.x.high)
      draw_cross(drawing, axes, {fell_at, panel.run(sample_at(*runs[i].log, fell_at))},
                 style.color);
  }
  draw_line(drawing, axes, series(last, panel.command, axes.x), kCommandStyle);
}

double largest_difference(const PanelPlan& panel, const std::vector<LociRun>& runs,
                          const Interval& time) {
  double most = 0;
  const std::vector<Vector2d> last = series(*runs.back().log, panel.run, time);
  std::vector<std::vector<Vector2d>> all = {series(*runs.back().log, panel.command, time)};
  for (const LociRun& run : runs) all.push_back(series(*run.log, panel.run, time));
  for (const std::vector<Vector2d>& points : all) {
    for (size_t k = 0; k < std::min(points.size(), last.size()); ++k)
      if (std::isfinite(points[k].y()) && std::isfinite(last[k].y()))
        most = std::max(most, std::abs(points[k].y() - last[k].y()));
  }
  return most;
}

/// Removes the panels in which all runs are equal and returns a sentence with their names. All
/// panels are kept where none would be left.
std::string leave_out_equal(std::vector<PanelPlan>& panels, const std::vector<LociRun>& runs,
                            const Interval& time) {
  std::vector<PanelPlan> kept;
  std::vector<std::string> names;
  for (const PanelPlan& panel : panels) {
    if (panel.seen <= 0 || largest_difference(panel, runs, time) > panel.seen)
      kept.push_back(panel);
    else
      names.push_back(panel.name.substr(0, panel.name.find(" [")));
  }
  if (names.empty() || kept.empty()) return "";
  panels = std::move(kept);
  return "The same in all: " + text::join(names, ", ") + ".";
}

}  // namespace

Drawing draw_loci(const std::vector<LociRun>& runs, const LociOptions& options) {
  const Interval time = time_range(runs, options);
  std::vector<PanelPlan> panels = plan_panels(options);
  if (panels.empty()) fail(ErrorCode::usage, "plot: every panel is switched off");
  const std::string same =
      options.only_differences ? leave_out_equal(panels, runs, time) : std::string();
  Drawing drawing = start_drawing(runs, options, "Loci against time");
  const std::vector<PushRecord> pushed = all_pushes(runs, time);
  const std::vector<Phase> supports = phases(*runs.back().log, time);
  std::string reference;
  if (options.reference && options.zmp) reference = "reference ZMP";
  if (options.reference && options.fz)
    reference += reference.empty() ? "reference f_z" : " and f_z";
  Legend entries = legend(runs, reference, options.command);
  if (std::any_of(panels.begin(), panels.end(), [](const auto& p) { return !p.limits.empty(); }))
    entries.emplace_back("limit of a joint", kLimitStyle);
  double top = draw_legend(drawing, entries, 44) + (pushed.empty() ? 20 : 38);
  for (size_t i = 0; i < panels.size(); ++i) {
    const Axes axes = {kLeft,         top,  drawing.width - kLeft - kRight,
                       options.panel, time, value_range(panels[i], runs, time)};
    draw_phases(drawing, axes, supports, i == 0);
    draw_axes(drawing, axes, panels[i].name, i + 1 == panels.size());
    draw_pushes(drawing, axes, pushed, i == 0);
    draw_panel(drawing, axes, panels[i], runs);
    top += options.panel + kGap;
  }
  drawing.items.push_back(DrawnText{.position = {(kLeft + drawing.width - kRight) / 2, top + 22},
                                    .text = "time [s]",
                                    .size = 13,
                                    .anchor = TextAnchor::center});
  drawing.height = top + 34;
  for (const std::string& note : {same, range_note(runs)}) {
    if (note.empty()) continue;
    drawing.items.push_back(DrawnText{.position = {kLeft, drawing.height + 10},
                                      .text = note,
                                      .size = 11,
                                      .color = {0.35f, 0.35f, 0.38f, 1}});
    drawing.height += drawing.height > top + 34 ? 16 : 22;
  }
  return drawing;
}

void write_loci(const std::vector<LociRun>& runs, const std::filesystem::path& path,
                const LociOptions& options) {
  write_drawing(path, draw_loci(runs, options), options.png_scale);
}

std::vector<std::string> loci_series(const LociOptions& options) {
  std::vector<std::string> names;
  for (const PanelPlan& panel : plan_panels(options)) names.push_back(panel.name);
  return names;
}

}  // namespace ayumi
