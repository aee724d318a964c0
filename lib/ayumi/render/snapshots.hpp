#pragma once
// Snapshot strips: several instants of one run side by side in one picture, as in Fig. 3 of the
// paper.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/base/bounds.hpp"
#include "ayumi/render/clip.hpp"

namespace ayumi {

struct StripOptions {
  /// Bounds of the numbers of snapshots, of columns, and of postures in one picture. Chosen: in the
  /// largest sheet, 100 columns are 164 pixels wide, and 20 x 20 snapshots are already more than
  /// anybody compares. 100 postures cover each other.
  static constexpr Bounds kCount = {1, 400}, kColumns = {1, 100}, kExposures = {1, 100};

  ClipOptions clip;           ///< options of the pictures; their size is that of one snapshot
  std::vector<double> times;  ///< instants [s]; if empty, `count` telling_instants()
  int count = 8;              ///< number of snapshots if `times` is empty
  int columns = 4;            ///< largest number of snapshots in a row
  /// All instants are drawn in one picture, and earlier ones are lighter.
  bool one_picture = false;
};

/// A sheet of pictures of one size in reading order. Throws Error(usage) if there are none or the
/// sheet exceeds 16384 pixels.
Image draw_sheet(const std::vector<Image>& tiles, int columns);

/// All snapshots in reading order, or drawn over each other as seen by a camera that stands still.
/// Throws the same errors as ClipRenderer, Error(usage) for options out of bounds or a picture
/// beyond 16384 pixels, and Interrupted if `progress` says stop. `notes` receives
/// ClipRenderer::notes().
Image draw_strip(const RobotModel& model, const SimulationLog& log, const StripOptions& options,
                 const Progress& progress = {}, std::vector<std::string>* notes = nullptr);

/// The eight snapshots that go with a run, for its folder and its report. Throws the same errors as
/// draw_strip() and encode_png().
PngPicture snapshots_of_run(const RobotModel& model, const SimulationLog& log, ClipOptions clip);

}  // namespace ayumi
