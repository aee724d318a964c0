#pragma once
// Parts that several plots of runs share: styles, legend, title, pushes.

#include <string>
#include <utility>
#include <vector>

#include "ayumi/plot/axes.hpp"
#include "ayumi/plot/com_zmp_plot.hpp"
#include "ayumi/render/log_reading.hpp"

namespace ayumi::plot {

inline constexpr double kLeft = 78, kRight = 18;  ///< margins beside the panels [pixel]
inline const Eigen::Vector4f kPushColor = {0.62f, 0.16f, 0.48f, 1};
inline const LineStyle kCommandStyle = {
    .color = {0.1f, 0.1f, 0.12f, 1}, .width = 1.3, .dashes = {5, 3}};
inline const LineStyle kReferenceStyle = {
    .color = {0.42f, 0.42f, 0.46f, 1}, .width = 1.1, .dashes = {1.5, 2}};

inline const LineStyle kLimitStyle = {
    .color = {0.70f, 0.08f, 0.08f, 1}, .width = 1.1, .dashes = {8, 3, 2, 3}};

/// The style of a run. A single run has the colour that a closed loop has beside an open one.
LineStyle run_style(size_t index, size_t count);

bool has_fallen(const SimulationLog& log);

/// The interval of time that is shown. Throws the same Error(usage) as draw_loci().
Interval time_range(const RobotModel* model, const std::vector<LociRun>& runs,
                    const LociOptions& options);

/// The pushes of all runs in this interval. A push that is the same in several runs is listed once.
std::vector<PushRecord> all_pushes(const std::vector<LociRun>& runs, const Interval& time);

/// Runs with their places in one frame.
struct FramedRuns {
  std::vector<SimulationLog> logs;
  std::vector<LociRun> runs;  ///< the runs with those logs

  /// Without a model, the runs stay as they are. Throws the same errors as in_frame().
  FramedRuns(const RobotModel* model, const std::vector<LociRun>& as_logged, Frame frame);
};

/// The text of a run in the legend, such as "closed loop (stands)".
std::string legend_name(const LociRun& run);

using Legend = std::vector<std::pair<std::string, LineStyle>>;
/// The entries of the legend: the command if it is wanted, the runs, and, with `with_reference`,
/// the reference ZMP.
Legend legend(const std::vector<LociRun>& runs, const std::string& reference,
              bool with_command = true);

/// Draws the entries from left to right, and begins a new line if a line is full. Returns the
/// bottom of the legend [pixel].
double draw_legend(Drawing& drawing, const Legend& entries, double top);

/// A drawing with its title. `what` is the beginning of the description, such as "Loci against
/// time".
Drawing start_drawing(const std::vector<LociRun>& runs, const LociOptions& options,
                      const std::string& what);

}  // namespace ayumi::plot
