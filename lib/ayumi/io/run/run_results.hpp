#pragma once
// Verdicts that are read back from the files that commands wrote: the sections of a run's run.json,
// and the results file of a push study.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/check/consistency.hpp"
#include "ayumi/io/run/run_folder.hpp"

namespace ayumi {

/// The result of `repair`.
struct RepairNote {
  std::string status;           ///< "repaired", "infeasible", ...
  double max_joint_change = 0;  ///< largest change of a joint [rad]
  double max_cog_change = 0;    ///< largest change of the COG [m]
  int iterations = 0;
  std::vector<std::string> reasons;
  struct Moved {
    std::string joint;
    /// Largest change [rad], for sliding joints [m], its time, and the beginning and end of the
    /// change [s].
    double most = 0, at = 0, begin = 0, end = 0;
  };
  std::vector<Moved> joints = {};              ///< joints, the largest change first
  double margin_before = 0, margin_after = 0;  ///< smallest margin of the ZMP [m]
};

/// Whether the joint table may go to a robot.
struct ExportNote {
  bool safe = false;
  /// Largest step from row to row as a share of the step that one tick allows, and its joint.
  double max_step_ratio = 0;
  std::string worst_joint;
  std::vector<std::string> violations;  ///< violations in words
};

struct RunResults {
  std::optional<ConsistencyReport> check;
  std::optional<RepairNote> repair;
  std::optional<ExportNote> safety;
};

/// Reads the sections "check", "repair" and "export" of a run; `file` names it in errors. Throws
/// Error(bad_file).
RunResults read_results(const RunFolder& run, const std::string& file);

/// Largest survivable impulse at one phase from one direction under one controller.
struct PushThreshold {
  std::string phase, controller;
  double at = 0;                                 ///< time [s]
  double direction = 0;                          ///< direction from x about the world's z [rad]
  double impulse = 0, open_loop = 0, bound = 0;  ///< impulses [N s]
  bool capped = false;                           ///< the study's largest push was survived
};

/// The thresholds in a file that `ayumi push -o` wrote ("ayumi.push/1"), in the order of the file.
/// Throws Error(bad_file).
std::vector<PushThreshold> read_push_thresholds(const std::filesystem::path& file);

}  // namespace ayumi
