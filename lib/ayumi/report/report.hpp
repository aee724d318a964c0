#pragma once
// One HTML page of a run that needs no other files: verdict, replay, plots, findings, pictures,
// push thresholds, provenance. Without JavaScript, the replay is a picture and everything else is
// the same.

#include <memory>
#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/identify/compare.hpp"
#include "ayumi/io/run/run_results.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/render/frames.hpp"
#include "ayumi/render/image.hpp"
#include "ayumi/render/robot_look.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

struct ReportRun {
  std::string name;          ///< name, such as "open loop" or "closed loop"
  const SimulationLog* log;  ///< log of the run; must outlive the call
  /// Only the joints were measured: the recording appears as a ghost in the replay, without an
  /// outcome and without curves.
  bool recorded = false;
};

struct ReportInput {
  std::string title;            ///< title of the pattern
  std::vector<ReportRun> runs;  ///< at least one run; the last one is judged and replayed
  RunResults results;
  std::vector<PushThreshold> thresholds;   ///< push thresholds; empty if there is no study
  const Comparison* comparison = nullptr;  ///< comparison with a recording; must outlive the call
  std::string libraries = {};  ///< libraries of the program with their versions; may be empty
};

struct ReportOptions {
  std::shared_ptr<const RobotLook> look = {};  ///< look of the robot; if null, its robot_look()
  /// snapshots_of_run() of the last run; if null, they are drawn.
  const PngPicture* snapshots = nullptr;
  size_t max_bytes = 8'000'000;   ///< size of the page; replay and pictures are reduced to keep it
  double rate = 50;               ///< rate of the replay [Hz]
  size_t max_triangles = 60'000;  ///< triangles of the robot in the replay
  bool replay = true;
  Frame frame = Frame::world;  ///< frame of all places
};

struct Report {
  std::string html;
  /// Parts that were reduced or left out, and the reasons, in words.
  std::vector<std::string> caps;
};

/// Whether this program was built with the replay.
bool has_replay();

/// The same input gives the same bytes. Throws Error(usage) if there is no run or an empty one, and
/// the same errors as ClipRenderer.
Report make_report(const RobotModel& model, const ReportInput& input,
                   const ReportOptions& options = {}, const Progress& progress = {});

}  // namespace ayumi
