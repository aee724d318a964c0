#include "ayumi/plot/com_zmp_plot_parts.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ayumi/base/error.hpp"
#include "ayumi/base/shortened_text.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi::plot {
namespace {

constexpr double kLegend = 12.5;  // font size [pixel]

// Colours that can also be distinguished without colour vision: vermilion, blue, green, purple, sky
// blue and yellow.
const Eigen::Vector4f kRunColors[] = {{0.84f, 0.37f, 0.00f, 1}, {0.00f, 0.45f, 0.70f, 1},
                                      {0.00f, 0.62f, 0.45f, 1}, {0.80f, 0.47f, 0.65f, 1},
                                      {0.34f, 0.71f, 0.91f, 1}, {0.72f, 0.66f, 0.05f, 1}};
constexpr size_t kMostRuns = 6;  // the number of colours

std::string title_of(const std::vector<LociRun>& runs, const LociOptions& options) {
  if (!options.title.empty()) return options.title;
  const Provenance& from = runs.back().log->provenance;
  const std::string pattern = std::filesystem::path(from.pattern).stem().string();
  const std::string robot = std::filesystem::path(from.robot).stem().string();
  return pattern.empty() ? "Loci" : pattern + (robot.empty() ? "" : " (" + robot + ")");
}

}  // namespace

LineStyle run_style(size_t index, size_t count) {
  return {.color = kRunColors[count == 1 ? 1 : index], .width = 1.6};
}

bool has_fallen(const SimulationLog& log) { return log.result.outcome == Outcome::fell; }

Interval time_range(const RobotModel* model, const std::vector<LociRun>& runs,
                    const LociOptions& options) {
  if (runs.empty()) fail(ErrorCode::usage, "plot: there is no run to draw");
  if (runs.size() > kMostRuns)
    fail(ErrorCode::usage, "plot: " + std::to_string(runs.size()) + " runs are too many; at most " +
                               std::to_string(kMostRuns) + " can be told apart in one plot");
  for (const LociRun& run : runs)
    if (model && run.log->joints != model->dof_names())
      fail(ErrorCode::usage, "plot: run '" + run.label + "' has " +
                                 std::to_string(run.log->joints.size()) +
                                 " joints, but the robot '" + model->name() + "' has " +
                                 std::to_string(model->dof_count()) +
                                 " joints or joints with other names; give runs of this robot");
  double last = 0;
  for (const LociRun& run : runs) last = std::max(last, duration(*run.log));
  const double end = options.end < 0 ? last : std::min(options.end, last);
  if (!(end > options.begin))
    fail(ErrorCode::usage, "plot: the times from " + text::brief(options.begin) + " s to " +
                               text::brief(options.end < 0 ? last : options.end) +
                               " s are outside the runs, because the longest run lasts " +
                               text::brief(last) + " s");
  return {options.begin, end};
}

std::vector<PushRecord> all_pushes(const std::vector<LociRun>& runs, const Interval& time) {
  std::vector<PushRecord> out;
  for (const LociRun& run : runs)
    for (const PushRecord& push : pushes(*run.log)) {
      const bool known = std::any_of(out.begin(), out.end(), [&](const PushRecord& other) {
        return std::abs(other.begin - push.begin) < 1e-6;
      });
      if (!known && push.begin >= time.low && push.begin <= time.high) out.push_back(push);
    }
  return out;
}

std::string legend_name(const LociRun& run) {
  if (!run.log->controller) return run.label;  // a plan, which has no outcome
  const SimulationResult& result = run.log->result;
  return run.label +
         (has_fallen(*run.log)
              ? " (fell at " + text::fixed(result.fell_at, 2) + " s)"
              : std::string(result.outcome == Outcome::stands ? " (stands)" : " (unsettled)"));
}

FramedRuns::FramedRuns(const RobotModel* model, const std::vector<LociRun>& as_logged,
                       Frame frame) {
  logs.reserve(as_logged.size());
  for (const LociRun& run : as_logged) {
    logs.push_back(model && run.log->joints == model->dof_names()
                       ? in_frame(*model, *run.log, frame)
                       : *run.log);
    runs.push_back({run.label, &logs.back()});
  }
}

double draw_legend(Drawing& drawing, const Legend& entries, double top) {
  const auto width_of = [](const std::string& name) { return 34 + text_width(name, kLegend) + 22; };
  // Entries below each other begin at the same place.
  const bool too_wide = std::any_of(entries.begin(), entries.end(), [&](const auto& entry) {
    return kLeft + width_of(entry.first) > drawing.width;
  });
  const double left = too_wide ? 8.0 : kLeft;
  double x = left, y = top;
  for (const auto& [name, style] : entries) {
    const double wide = width_of(name);
    if (x > left && x + wide - 22 > drawing.width - 8) {
      x = left;
      y += 1.6 * kLegend;
    }
    drawing.items.push_back(DrawnPath{.points = {{x, y}, {x + 28, y}},
                                      .stroke = style.color,
                                      .width = style.width + 0.4,
                                      .dashes = style.dashes});
    drawing.items.push_back(
        DrawnText{.position = {x + 34, y + 0.36 * kLegend}, .text = name, .size = kLegend});
    x += wide;
  }
  return y + 0.8 * kLegend;
}

Legend legend(const std::vector<LociRun>& runs, const std::string& reference, bool with_command) {
  Legend entries;
  if (with_command) entries.emplace_back("command", kCommandStyle);
  for (size_t i = 0; i < runs.size(); ++i)
    entries.emplace_back(legend_name(runs[i]), run_style(i, runs.size()));
  if (!reference.empty())
    entries.emplace_back(reference + (runs.size() > 1 ? " of " + runs.back().label : std::string()),
                         kReferenceStyle);
  return entries;
}

Drawing start_drawing(const std::vector<LociRun>& runs, const LociOptions& options,
                      const std::string& what) {
  if (!(options.width >= 300 && options.width <= 8192))
    fail(ErrorCode::usage,
         "plot: width " + text::brief(options.width) + " is not between 300 and 8192 pixels");
  Drawing drawing;
  drawing.width = options.width;
  drawing.title = title_of(runs, options);
  drawing.description = what + ":";
  for (const LociRun& run : runs)
    drawing.description.append(" ").append(legend_name(run)).append(";");
  drawing.description.back() = '.';
  // A long title begins at the edge, and it is written in smaller letters if that is not enough.
  const double wide = text_width(drawing.title, 16, true);
  const double left = kLeft + wide > drawing.width - kRight ? 8.0 : kLeft;
  const double room = drawing.width - left - 8;
  const double size = std::clamp(16 * room / std::max(1.0, wide), 11.0, 16.0);
  const auto fits = [&](const std::string& text) { return text_width(text, size, true) <= room; };
  const std::string shown = text::shortened(drawing.title, fits);
  drawing.items.push_back(
      DrawnText{.position = {left, 24}, .text = shown, .size = size, .bold = true});
  return drawing;
}

}  // namespace ayumi::plot
