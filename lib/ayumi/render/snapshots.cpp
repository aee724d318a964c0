#include "ayumi/render/snapshots.hpp"

#include <algorithm>

#include "ayumi/base/error.hpp"
#include "ayumi/render/log_reading.hpp"

namespace ayumi {

namespace {

void paste(const Image& tile, Image& sheet, int left, int top) {
  for (int y = 0; y < tile.height; ++y)
    std::copy_n(tile.pixel(0, y), 3 * tile.width, sheet.pixel(left, top + y));
}

}  // namespace

Image draw_sheet(const std::vector<Image>& tiles, int columns) {
  const int count = static_cast<int>(tiles.size());
  const int across = std::clamp(columns, 1, std::max(1, count));
  const int down = (count + across - 1) / across;
  Image sheet;
  sheet.width = tiles.empty() ? 0 : tiles.front().width * across;
  sheet.height = tiles.empty() ? 0 : tiles.front().height * down;
  if (tiles.empty() || sheet.width > 16384 || sheet.height > 16384)
    fail(ErrorCode::usage, "a strip needs at least one snapshot and at most 16384 pixels a side");
  sheet.rgb.assign(3 * static_cast<size_t>(sheet.width) * static_cast<size_t>(sheet.height), 255);
  for (int i = 0; i < count; ++i) {
    const Image& tile = tiles[static_cast<size_t>(i)];
    paste(tile, sheet, i % across * tile.width, i / across * tile.height);
  }
  return sheet;
}

Image draw_strip(const RobotModel& model, const SimulationLog& log, const StripOptions& options) {
  const double last = duration(log);
  std::vector<double> times =
      options.times.empty() ? telling_instants(log, options.count) : options.times;
  for (double& t : times) t = std::clamp(t, 0.0, last);
  ClipOptions clip = options.clip;
  if (options.one_picture) {
    clip.camera.mode = CameraMode::fixed;
    return ClipRenderer(model, log, clip).exposures(times);
  }
  ClipRenderer renderer(model, log, clip);
  std::vector<Image> tiles;
  for (const double t : times) tiles.push_back(renderer.frame(t));
  return draw_sheet(tiles, options.columns);
}

void write_strip(const RobotModel& model, const SimulationLog& log,
                 const std::filesystem::path& path, const StripOptions& options) {
  write_png(path, draw_strip(model, log, options));
}

}  // namespace ayumi
