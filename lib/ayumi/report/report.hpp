#pragma once
// One HTML page of a run, complete in itself: verdict, replay, loci, findings, pictures, push
// thresholds, provenance. It loads no other files. Without JavaScript, the replay is a picture and
// everything else is the same.

#include <memory>
#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/identify/compare.hpp"
#include "ayumi/io/run/run_results.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/render/frames.hpp"
#include "ayumi/render/robot_look.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

struct ReportRun {
  std::string name;          ///< "open loop", "closed loop"
  const SimulationLog* log;  ///< must outlive the call
  /// Only the joints were measured: the recording appears as a ghost in the replay, without an
  /// outcome and without curves.
  bool recorded = false;
};

struct ReportInput {
  std::string title;            ///< of the pattern
  std::vector<ReportRun> runs;  ///< at least one; the last is judged and replayed
  RunResults results;
  std::vector<PushThreshold> thresholds;   ///< empty: no study
  const Comparison* comparison = nullptr;  ///< with a recording; must outlive the call
  std::string libraries = {};              ///< of the program, with their versions; may be empty
};

struct ReportOptions {
  std::shared_ptr<const RobotLook> look = {};  ///< of the robot; null: robot_look() of it
  size_t max_bytes = 8'000'000;   ///< of the page; replay and pictures are reduced to keep it
  double rate = 50;               ///< of the replay [Hz]
  size_t max_triangles = 60'000;  ///< of the robot in the replay
  bool replay = true;
  Frame frame = Frame::world;  ///< of all places
};

struct Report {
  std::string html;
  std::vector<std::string> caps;  ///< what was reduced or left out, and why, in words
};

/// Whether this program was built with the replay.
bool has_replay();

/// The same input gives the same bytes. Throws Error(usage) for no runs or an empty one, and as
/// ClipRenderer does.
Report make_report(const RobotModel& model, const ReportInput& input,
                   const ReportOptions& options = {}, const Progress& progress = {});

}  // namespace ayumi
