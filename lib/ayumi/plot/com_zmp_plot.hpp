#pragma once
// Plots quantities of runs against time: COG x, y, z with the command, ZMP x, y with the reference
// ZMP, and f_z, for several runs of one pattern together (open loop and closed loop). If the robot
// is known, the plot also has the distance of the ZMP from the edge of the soles that are planned
// on the ground. There is also a view from above.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/plot/drawing.hpp"
#include "ayumi/render/frames.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

struct LociRun {
  std::string label;         ///< name of the run in the legend
  const SimulationLog* log;  ///< log of the run, which must outlive the call
};

struct LociOptions {
  std::string title = {};                  ///< title; if empty, the pattern's name
  bool cog = true, zmp = true, fz = true;  ///< panels that are drawn
  /// Model of the runs; with it, there is a panel of the ZMP margin.
  const RobotModel* model = nullptr;
  std::vector<int> joints = {};           ///< dofs with a panel of their angle; needs the model
  std::vector<int> speeds = {};           ///< dofs with a panel of their speed; needs the model
  std::vector<int> torques = {};          ///< dofs with a panel of their torque; needs the model
  std::string profile = {};               ///< profile whose limits are drawn; if empty, the default
  bool limits_in_view = false;            ///< panels of joints extend to the limits of the joint
  Frame frame = Frame::world;             ///< frame of places, if the robot is known
  bool command = true, reference = true;  ///< the command and the reference ZMP are drawn
  /// Whether panels are left out in which the difference between the runs is too small to be seen.
  /// Their names are then written below.
  bool only_differences = false;
  double width = 1000;     ///< width of the drawing [pixel]
  double panel = 132;      ///< height of one panel [pixel]
  double begin = 0;        ///< first time shown [s]
  double end = -1;         ///< last time shown [s]; if negative, the end of the longest run
  double png_scale = 1.5;  ///< picture pixels per pixel of the drawing
};

/// Panels against time, one above the other. Support phases are shaded after the plan of the last
/// run, pushes are marked, and a fall is marked by a cross. Ranges follow the command and the runs
/// in which the robot does not fall. A run with a fall that leaves these ranges is cut off, and the
/// plot says so. Throws Error(usage) if there is no run, if a run has no samples or is of another
/// robot, if there are more than six runs, or if there is nothing to show between begin and end.
Drawing draw_loci(const std::vector<LociRun>& runs, const LociOptions& options);

/// The ground seen from above: paths of COG and ZMP, the reference ZMP, and the soles where the
/// last run planned them on the ground.
Drawing draw_support(const RobotModel& model, const std::vector<LociRun>& runs,
                     const LociOptions& options);

/// Writes the plot as .svg or .png, whole or not at all. Throws the errors above, and
/// Error(bad_file).
void write_loci(const std::vector<LociRun>& runs, const std::filesystem::path& path,
                const LociOptions& options);
void write_support_plot(const RobotModel& model, const std::vector<LociRun>& runs,
                        const std::filesystem::path& path, const LociOptions& options);

/// The names of the panels that these options show, with units.
std::vector<std::string> loci_series(const LociOptions& options);

}  // namespace ayumi
