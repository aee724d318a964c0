#include "ayumi/plot/com_zmp_plot.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/plot/com_zmp_plot_parts.hpp"
#include "ayumi/render/overlay.hpp"
#include "ayumi/render/robot_surface.hpp"
#include "ayumi/sim/has_zmp.hpp"

namespace ayumi {
namespace {

using namespace plot;
using Eigen::Vector2d;
using Eigen::Vector4f;
using Value = std::function<double(const SimulationSample&)>;

constexpr double kGap = 12;        // space between panels [pixel]
constexpr double kSmallText = 11;  // the smallest letters that can be read on a screen [pixel]
// The last part of a fall that axes do not fit [s]. Measured in HOAP-1's walk in open loop, which
// falls at 4.51 s: the range of the COG height is 7 mm until 0.05 s before the fall, as in the walk
// itself, and 19 mm until the fall. With half of the value, it is 12 mm. With twice the value, the
// range of the COG to the side, in which the fall can be seen, is 177 mm instead of 198 mm.
constexpr double kTopples = 0.05;

struct PanelPlan {
  std::string name;  ///< name with the unit
  Value run;         ///< curves of every run
  /// Curve of the last run (all runs have the same command); empty if there is none.
  Value command;
  Value reference;                  ///< curve of the last run; empty if there is none
  double least = 0;                 ///< smallest span of the axis
  double seen = 0;                  ///< difference of values below which runs count as equal
  std::vector<double> limits = {};  ///< limits, which are only drawn if they are within the range
  bool limits_in_view = false;      ///< the range extends to the limits
  bool peaks = false;               ///< the peaks of landings get their values
  /// Curves of the last run that are drawn instead of the runs, each with its name.
  std::vector<std::pair<std::string, Value>> named = {};
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
  const double unit = d.prismatic ? 1e-3 : kDegree;
  const double limit = model.limits(profile).speed[dof] / unit;
  PanelPlan panel;
  panel.name = d.name + (d.prismatic ? " [mm/s]" : " [deg/s]");
  panel.run = [dof, unit](const SimulationSample& s) { return s.state.dtheta[dof] / unit; };
  panel.least = d.prismatic ? 20 : 10;
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
  return
      [quantity, index](const SimulationSample& s) { return (s.*quantity)[index] / kMillimetre; };
}

/// The value is not a number where `is_there` is false.
Value where(const std::function<bool(const SimulationSample&)>& is_there, const Value& value) {
  return [=](const SimulationSample& s) { return is_there(s) ? value(s) : std::nan(""); };
}

bool is_supported(const SimulationSample& s) {
  return s.planned_contact[0] || s.planned_contact[1];
}

// ---- what moves most

constexpr size_t kMostMoved = 3;      // number of curves, so that they can be distinguished
constexpr double kLeastMoved = 0.5;   // a joint that moves less than this counts as resting [deg]
constexpr double kMovedShare = 0.25;  // share of the largest move, below which a curve is left out
constexpr double kSameCurve =
    0.03;  // curves that differ by less than this share of their range are joined
const Vector4f kMovedColors[kMostMoved] = {
    {0.42f, 0.20f, 0.60f, 1}, {0.62f, 0.38f, 0.06f, 1}, {0.00f, 0.47f, 0.55f, 1}};

struct MovedCurve {
  std::string name;
  Value value;
  std::vector<double> values = {};
  double low = 0, high = 0;
};

/// Angle of the trunk about x, y or z, if the other two angles are small [deg].
Value trunk_angle(int axis) {
  return [axis](const SimulationSample& s) {
    const Eigen::Matrix3d r = s.state.base.attitude.toRotationMatrix();
    const double angle[] = {std::atan2(r(2, 1), r(2, 2)),
                            std::atan2(-r(2, 0), std::hypot(r(2, 1), r(2, 2))),
                            std::atan2(r(1, 0), r(0, 0))};
    return angle[axis] / kDegree;
  };
}

/// The angles that move most in the shown time of the last run, before a fall. Joints with the same
/// motion share one curve.
PanelPlan moved_panel(const RobotModel& model, const SimulationLog& log, const Interval& time) {
  std::vector<MovedCurve> curves;
  for (const auto& [axis, name] :
       {std::pair{1, "trunk pitch"}, {0, "trunk roll"}, {2, "trunk yaw"}})
    curves.push_back({name, trunk_angle(axis)});
  for (Eigen::Index i = 0; i < model.dof_count(); ++i)
    if (const Dof& dof = model.dofs()[static_cast<size_t>(i)]; !dof.prismatic)
      curves.push_back(
          {dof.name, [i](const SimulationSample& s) { return s.state.theta[i] / kDegree; }});
  const double end = has_fallen(log) ? std::min(time.high, log.result.fell_at) : time.high;
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const double t = static_cast<double>(k) * log.dt;
    if (t >= time.low - 1e-9 && t <= end + 1e-9)
      for (MovedCurve& curve : curves) curve.values.push_back(curve.value(log.samples[k]));
  }
  for (MovedCurve& curve : curves)
    if (!curve.values.empty()) {
      const auto [low, high] = std::minmax_element(curve.values.begin(), curve.values.end());
      curve.low = *low;
      curve.high = *high;
    }
  const auto range = [](const MovedCurve& curve) { return curve.high - curve.low; };
  std::stable_sort(curves.begin(), curves.end(),
                   [&](const MovedCurve& a, const MovedCurve& b) { return range(a) > range(b); });
  std::vector<MovedCurve> shown;
  for (MovedCurve& curve : curves) {
    if (range(curve) < std::max(kLeastMoved, kMovedShare * range(curves.front()))) break;
    const auto twin = std::find_if(shown.begin(), shown.end(), [&](const MovedCurve& other) {
      double most = 0;
      for (size_t k = 0; k < curve.values.size(); ++k)
        most = std::max(most, std::abs(curve.values[k] - other.values[k]));
      return most <= kSameCurve * range(other);
    });
    if (twin != shown.end())
      twin->name += ", " + curve.name;
    else if (shown.size() < kMostMoved)
      shown.push_back(std::move(curve));
  }
  PanelPlan panel;
  panel.name = "moves most [deg]";
  panel.least = 1;
  for (MovedCurve& curve : shown) panel.named.emplace_back(curve.name, curve.value);
  return panel;
}

/// The distance of the ZMP from the edge of the hull of the soles that are planned on the ground,
/// at their true places, seen from above. In flight it is not a number.
Value zmp_margin(const RobotModel& model) {
  const auto data = std::make_shared<RobotData>(model);  // workspace
  return [&model, data](const SimulationSample& s) {
    std::vector<Vector2d> corners;
    for (const Eigen::Vector3d& corner :
         support_corners(model, body_poses(model, s.state, *data), s.planned_contact))
      corners.push_back(corner.head<2>());
    const ConvexPolygon support(std::move(corners));
    return support.empty() || !has_zmp(s) ? std::nan("")
                                          : support.margin(s.zmp.head<2>()) / kMillimetre;
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
      panels.push_back({std::string("COG ") + axis[i] + " [mm]",
                        component(&S::cog, i),
                        component(&S::command_cog, i),
                        {},
                        10,
                        0.2});
  if (options.zmp)
    for (int i = 0; i < 2; ++i)
      panels.push_back({std::string("ZMP ") + axis[i] + " [mm]",
                        where(has_zmp, component(&S::zmp, i)),
                        where(is_supported, component(&S::command_zmp, i)),
                        where(is_supported, component(&S::reference_zmp, i)), 20, 0.5});
  if (options.zmp && options.model && options.model->has_soles())
    panels.push_back({"margin [mm]", zmp_margin(*options.model), {}, {}, 20});
  if (options.fz) {
    panels.push_back({"f_z [N]", [](const S& s) { return s.fz; },
                      [](const S& s) { return s.command_fz; },
                      [](const S& s) { return s.reference_fz; }, 10, 0.1});
    panels.back().peaks = true;
  }
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

/// Adds the values of the runs that fell, from the time before their fall. They belong to the range
/// of a panel if no run stands.
void extend_before_falls(std::vector<double>& values, const PanelPlan& panel,
                         const std::vector<LociRun>& runs, const Interval& time) {
  for (const LociRun& run : runs)
    extend(values, series(*run.log, panel.run,
                          {time.low, std::min(time.high, run.log->result.fell_at - kTopples)}));
}

/// The range of the command and of the runs in which the robot stands, with a margin. If there is
/// no such run, it is the range before the falls.
Interval value_range(const PanelPlan& panel, const std::vector<LociRun>& runs,
                     const Interval& time) {
  std::vector<double> values;
  for (const auto& [name, value] : panel.named)
    extend(values, series(*runs.back().log, value,
                          {time.low, has_fallen(*runs.back().log)
                                         ? std::min(time.high, runs.back().log->result.fell_at)
                                         : time.high}));
  if (!panel.named.empty() && !values.empty()) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double span = std::max(*high - *low, panel.least);
    return {*low - 0.1 * span, *high + 0.35 * span};  // names are at the top
  }
  extend(values, series(*runs.back().log, panel.command, time));
  for (const LociRun& run : runs)
    if (!has_fallen(*run.log)) extend(values, series(*run.log, panel.run, time));
  if (panel.reference && !has_fallen(*runs.back().log))
    extend(values, series(*runs.back().log, panel.reference, time));
  const bool standing = std::any_of(runs.begin(), runs.end(),
                                    [](const LociRun& run) { return !has_fallen(*run.log); });
  if (!standing) extend_before_falls(values, panel, runs, time);
  if (panel.limits_in_view) values.insert(values.end(), panel.limits.begin(), panel.limits.end());
  if (values.empty()) return {0, panel.least > 0 ? panel.least : 1};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  Interval range = {*low, *high};
  const double missing = std::max(0.0, panel.least - range.span()) / 2;
  const double margin = 0.1 * std::max(range.span(), panel.least) + missing;
  return {range.low - margin, range.high + margin};
}

// ---- support phases

struct SupportSpan {
  double begin, end;
  std::array<bool, 2> contact;
};

std::vector<SupportSpan> phases(const SimulationLog& log, const Interval& time) {
  std::vector<SupportSpan> out;
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

void draw_phases(Drawing& drawing, const Axes& axes, const std::vector<SupportSpan>& list,
                 bool names) {
  for (const SupportSpan& phase : list) {
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
      if (text_width(word, kSmallText) + 2 > to - from) continue;
      drawing.items.push_back(DrawnText{.position = {(from + to) / 2, axes.top - 4},
                                        .text = word,
                                        .size = kSmallText,
                                        .anchor = TextAnchor::center,
                                        .color = {0.4f, 0.4f, 0.44f, 1}});
      break;
    }
  }
}

// ---- marks and words

void draw_pushes(Drawing& drawing, const Axes& axes, const std::vector<PushRecord>& list,
                 bool names) {
  double taken = 0;  // end of the last text, counted from the left
  for (const PushRecord& push : list) {
    const double x = axes.px(push.begin), bottom = axes.top + axes.height;
    drawing.items.push_back(
        DrawnPath{.points = {{x, axes.top}, {x, bottom}}, .stroke = kPushColor, .width = 1.4});
    if (!names) continue;
    const std::string words = "push " + push_text(push) + " at " + text::brief(push.begin) + " s";
    const double wide = text_width(words, 11.5);
    const bool leftward = x + 4 + wide > axes.left + axes.width;
    const double from = leftward ? x - 4 - wide : x + 4;
    if (from < taken) continue;  // two texts on top of each other cannot be read
    taken = from + wide + 6;
    drawing.items.push_back(DrawnText{
        .position = {from, axes.top - 17}, .text = words, .size = 11.5, .color = kPushColor});
  }
}

/// A sentence about what the ranges leave out.
std::string range_note(const std::vector<LociRun>& runs) {
  const auto fell = [](const LociRun& run) { return has_fallen(*run.log); };
  if (std::none_of(runs.begin(), runs.end(), fell)) return "";
  return std::string("The axes fit the command and ") +
         (std::all_of(runs.begin(), runs.end(), fell) ? "the time before the fall"
                                                      : "the runs that stand") +
         ". The curves of a run that falls end at the edge of the axes. A cross marks the fall.";
}

void draw_named(Drawing& drawing, const Axes& axes, const PanelPlan& panel,
                const SimulationLog& log) {
  double x = axes.left + 8, y = axes.top + 14;
  for (size_t i = 0; i < panel.named.size(); ++i) {
    const auto& [name, value] = panel.named[i];
    const LineStyle style = {.color = kMovedColors[i], .width = 1.6};
    draw_line(drawing, axes, series(log, value, axes.x), style);
    const double wide = text_width(name, kSmallText);
    if (x > axes.left + 8 && x + wide > axes.left + axes.width) {
      x = axes.left + 8;
      y += 1.3 * kSmallText;
    }
    drawing.items.push_back(
        DrawnText{.position = {x, y}, .text = name, .size = kSmallText, .color = style.color});
    x += wide + 16;
  }
}

/// The peaks of a force that is well above its usual value, the highest first.
std::vector<Vector2d> force_peaks(const std::vector<Vector2d>& force) {
  // Smallest ratio of a peak to the median, the time before and after it for which it must be the
  // highest value [s], and the share of the highest peak below which a value is not a peak. Chosen:
  // a landing is above twice the weight, and a walk below 1.4 times; feet land at least 0.2 s
  // apart.
  constexpr double kHigh = 1.5, kApart = 0.15, kShare = 0.2;
  std::vector<double> values;
  extend(values, force);
  if (values.empty()) return {};
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  const double highest = *std::max_element(values.begin(), values.end());
  const double least = std::max(kHigh * values[values.size() / 2], kShare * highest);
  std::vector<Vector2d> tops;
  for (const Vector2d& point : force)
    if (std::isfinite(point.y()) && point.y() > std::max(least, 1e-9)) tops.push_back(point);
  std::stable_sort(tops.begin(), tops.end(),
                   [](const Vector2d& a, const Vector2d& b) { return a.y() > b.y(); });
  std::vector<Vector2d> kept;
  for (const Vector2d& point : tops)
    if (std::all_of(kept.begin(), kept.end(),
                    [&](const Vector2d& k) { return std::abs(k.x() - point.x()) > kApart; }))
      kept.push_back(point);
  return kept;
}

/// Writes the values at the peaks of the forces beside the curves of runs in which the robot
/// stands, as far as there is room for the text.
void draw_peaks(Drawing& drawing, const Axes& axes, const PanelPlan& panel,
                const std::vector<LociRun>& runs) {
  std::vector<std::vector<Vector2d>> curves;
  for (const LociRun& run : runs) curves.push_back(series(*run.log, panel.run, axes.x));
  const auto crossed = [&](const Eigen::AlignedBox2d& box) {
    return std::any_of(curves.begin(), curves.end(), [&](const std::vector<Vector2d>& curve) {
      return std::any_of(curve.begin(), curve.end(), [&](const Vector2d& point) {
        return box.contains(Vector2d(axes.px(point.x()), axes.py(point.y())));
      });
    });
  };
  std::vector<Eigen::AlignedBox2d> taken;
  for (size_t i = 0; i < runs.size(); ++i) {
    if (has_fallen(*runs[i].log)) continue;
    for (const Vector2d& top : force_peaks(curves[i])) {
      const std::string words = text::fixed(top.y(), 0) + " N";
      const double wide = text_width(words, kSmallText);
      const double y = std::max(axes.py(top.y()) + 4, axes.top + kSmallText + 2);
      const auto box_at = [&](double x) {
        return Eigen::AlignedBox2d(Vector2d(x, y - kSmallText), Vector2d(x + wide, y));
      };
      const Eigen::AlignedBox2d before = box_at(axes.px(top.x()) - 4 - wide),
                                after = box_at(axes.px(top.x()) + 4);
      const bool too_late = after.max().x() > axes.left + axes.width,
                 early_enough = before.min().x() >= axes.left;
      const Eigen::AlignedBox2d& box =
          too_late || (early_enough && crossed(after) && !crossed(before)) ? before : after;
      if (std::any_of(taken.begin(), taken.end(),
                      [&](const auto& other) { return other.intersects(box); }))
        continue;
      taken.push_back(box);
      drawing.items.push_back(DrawnText{.position = {box.min().x(), y},
                                        .text = words,
                                        .size = kSmallText,
                                        .color = run_style(i, runs.size()).color});
    }
  }
}

void draw_panel(Drawing& drawing, const Axes& axes, const PanelPlan& panel,
                const std::vector<LociRun>& runs) {
  const SimulationLog& last = *runs.back().log;
  if (!panel.run) return draw_named(drawing, axes, panel, last);
  if (panel.reference)
    draw_line(drawing, axes, series(last, panel.reference, axes.x), kReferenceStyle);
  for (const double limit : panel.limits)
    if (limit > axes.y.low && limit < axes.y.high)
      draw_line(drawing, axes, {{axes.x.low, limit}, {axes.x.high, limit}}, kLimitStyle);
  for (size_t i = 0; i < runs.size(); ++i) {
    const LineStyle style = run_style(i, runs.size());
    draw_line(drawing, axes, series(*runs[i].log, panel.run, axes.x), style);
    const double fell_at = runs[i].log->result.fell_at;
    if (!has_fallen(*runs[i].log) || fell_at < axes.x.low || fell_at > axes.x.high) continue;
    const double value = panel.run(sample_at(*runs[i].log, fell_at));
    // If no foot carries the robot at the fall, there is no ZMP to mark.
    if (std::isfinite(value)) draw_cross(drawing, axes, {fell_at, value}, style.color);
  }
  draw_line(drawing, axes, series(last, panel.command, axes.x), kCommandStyle);
  if (panel.peaks) draw_peaks(drawing, axes, panel, runs);
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

/// Removes the panels in which all runs are equal, and returns a sentence with their names. If no
/// panel would be left, all are kept.
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
  return "These values are equal in all runs: " + text::join(names, ", ") + ".";
}

/// A sentence, divided into lines of at most this width.
std::vector<std::string> lines_of(const std::string& sentence, double width) {
  std::vector<std::string> lines = {""};
  for (size_t at = 0; at < sentence.size();) {
    const size_t end = std::min(sentence.find(' ', at), sentence.size());
    const std::string word = sentence.substr(at, end - at);
    std::string& line = lines.back();
    if (line.empty())
      line = word;
    else if (text_width(line + " " + word, kSmallText) <= width)
      line += " " + word;
    else
      lines.push_back(word);
    at = end + 1;
  }
  return lines;
}

/// Whether there is a panel of the angles that move most: only if the robot is known and no joint
/// was requested.
bool shows_moved(const LociOptions& options) {
  return options.model && options.joints.empty() && options.speeds.empty() &&
         !options.only_differences;
}

}  // namespace

Drawing draw_loci(const std::vector<LociRun>& as_logged, const LociOptions& options) {
  const Interval time = time_range(options.model, as_logged, options);
  const FramedRuns framed(options.model, as_logged, options.frame);
  const std::vector<LociRun>& runs = framed.runs;
  std::vector<PanelPlan> panels = plan_panels(options);
  if (panels.empty()) fail(ErrorCode::usage, "plot: every panel is switched off");
  if (shows_moved(options))
    panels.insert(panels.begin(), moved_panel(*options.model, *runs.back().log, time));
  const std::string same =
      options.only_differences ? leave_out_equal(panels, runs, time) : std::string();
  Drawing drawing = start_drawing(runs, options, "Loci against time");
  const std::vector<PushRecord> pushed = all_pushes(runs, time);
  const std::vector<SupportSpan> supports = phases(*runs.back().log, time);
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
    for (const std::string& line : lines_of(note, drawing.width - kLeft - kRight)) {
      drawing.items.push_back(DrawnText{.position = {kLeft, drawing.height + 10},
                                        .text = line,
                                        .size = kSmallText,
                                        .color = {0.35f, 0.35f, 0.38f, 1}});
      drawing.height += drawing.height > top + 34 ? 16 : 22;
    }
  }
  return drawing;
}

void write_loci(const std::vector<LociRun>& runs, const std::filesystem::path& path,
                const LociOptions& options) {
  write_drawing(path, draw_loci(runs, options), options.png_scale);
}

std::vector<std::string> loci_series(const LociOptions& options) {
  std::vector<std::string> names;
  if (shows_moved(options)) names.emplace_back("moves most [deg]");
  for (const PanelPlan& panel : plan_panels(options)) names.push_back(panel.name);
  return names;
}

}  // namespace ayumi
