#pragma once
// Loci of runs against time: COG x, y, z with the command, ZMP x, y with the reference ZMP, and
// f_z, several runs of one pattern together (open loop and closed loop); if the robot is known,
// also the distance of the ZMP from the edge of the soles that are planned on the ground. Also a
// view from above.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/plot/drawing.hpp"
#include "ayumi/render/frames.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

struct LociRun {
  std::string label;         ///< as the legend names it
  const SimulationLog* log;  ///< must outlive the call
};

struct LociOptions {
  std::string title = {};                  ///< empty: the pattern's name
  bool cog = true, zmp = true, fz = true;  ///< panels
  const RobotModel* model = nullptr;       ///< of the runs; with it a panel of the ZMP margin
  std::vector<int> joints = {};            ///< dofs with a panel of their angle; needs the model
  std::vector<int> speeds = {};            ///< dofs with a panel of their speed; needs the model
  std::vector<int> torques = {};           ///< dofs with a panel of their torque; needs the model
  std::string profile = {};                ///< whose limits are drawn; empty: the default
  bool limits_in_view = false;             ///< panels of joints reach to the limits of the joint
  Frame frame = Frame::world;              ///< of places, where the robot is known
  bool command = true, reference = true;   ///< what is commanded; the reference ZMP
  /// Leave out panels in which the difference between the runs is too small to be seen, and name
  /// these panels below.
  bool only_differences = false;
  double width = 1000;     ///< [pixel]
  double panel = 132;      ///< height of one panel [pixel]
  double begin = 0;        ///< first time shown [s]
  double end = -1;         ///< last; negative: of the longest run [s]
  double png_scale = 1.5;  ///< picture pixels per pixel of the drawing
};

/// Stacked panels against time. Support phases shaded after the plan of the last run, pushes
/// marked, a fall marked by a cross. Ranges follow the command and the runs that do not fall; a
/// fallen run that leaves them is cut off, and the plot says so. Throws Error(usage) when there is
/// no run, a run has no samples, more than six runs, or nothing to show between begin and end.
Drawing draw_loci(const std::vector<LociRun>& runs, const LociOptions& options);

/// The ground from above: COG and ZMP paths, reference ZMP, and the soles where the last run
/// planned them down.
Drawing draw_support(const RobotModel& model, const std::vector<LociRun>& runs,
                     const LociOptions& options);

/// As .svg or .png, whole or not at all. Errors as above, and Error(bad_file).
void write_loci(const std::vector<LociRun>& runs, const std::filesystem::path& path,
                const LociOptions& options);
void write_support_plot(const RobotModel& model, const std::vector<LociRun>& runs,
                        const std::filesystem::path& path, const LociOptions& options);

/// Names of the panels that these options show, with units.
std::vector<std::string> loci_series(const LociOptions& options);

}  // namespace ayumi
