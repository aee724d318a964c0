#pragma once
// Snapshot strips: several instants of one run side by side in one picture, as the paper's Fig. 3.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/render/clip.hpp"

namespace ayumi {

struct StripOptions {
  ClipOptions clip;           ///< picture size is that of one snapshot
  std::vector<double> times;  ///< [s]; empty: `count` telling_instants()
  int count = 8;
  int columns = 4;
  bool one_picture = false;  ///< all instants in one picture, the earlier the lighter
};

/// Pictures of one size in reading order. Throws Error(usage) for none or beyond 16384 pixels.
Image draw_sheet(const std::vector<Image>& tiles, int columns);

/// All snapshots in reading order, or over each other seen by a camera that stands still. Throws as
/// ClipRenderer; Error(usage) for no snapshots or a picture beyond 16384 pixels; Interrupted when
/// `progress` says stop. `notes`: where ClipRenderer::notes() go.
Image draw_strip(const RobotModel& model, const SimulationLog& log, const StripOptions& options,
                 const Progress& progress = {}, std::vector<std::string>* notes = nullptr);

/// The same as a PNG file, whole or not at all. Throws as draw_strip and write_png.
void write_strip(const RobotModel& model, const SimulationLog& log,
                 const std::filesystem::path& path, const StripOptions& options);

}  // namespace ayumi
