#include "ayumi/preview/strip.hpp"

#include <algorithm>

#include "ayumi/base/error.hpp"

namespace ayumi {

namespace {

void paste(const Image& tile, Image& sheet, int left, int top) {
  for (int y = 0; y < tile.height; ++y)
    std::copy_n(tile.pixel(0, y), 3 * tile.width, sheet.pixel(left, top + y));
}

}  // namespace

Image draw_strip(const RobotModel& model, const SimulationLog& log, const StripOptions& options) {
  std::vector<double> times = options.times;
  const double last = log.dt * static_cast<double>(log.samples.size() - 1);
  if (times.empty())
    for (int i = 0; i < options.count; ++i)
      times.push_back(last * i / std::max(1, options.count - 1));
  const int columns = std::min<int>(std::max(1, options.columns), static_cast<int>(times.size()));
  const int rows = columns ? (static_cast<int>(times.size()) + columns - 1) / columns : 0;
  const int width = options.clip.picture.width * columns;
  const int height = options.clip.picture.height * rows;
  if (times.empty() || width > 16384 || height > 16384)
    fail(ErrorCode::usage, "a strip needs at least one snapshot and at most 16384 pixels a side");
  ClipRenderer renderer(model, log, options.clip);
  Image sheet;
  sheet.width = width;
  sheet.height = height;
  sheet.rgb.assign(3 * static_cast<size_t>(width) * height, 255);
  for (size_t i = 0; i < times.size(); ++i)
    paste(renderer.frame(std::clamp(times[i], 0.0, last)), sheet,
          static_cast<int>(i) % columns * options.clip.picture.width,
          static_cast<int>(i) / columns * options.clip.picture.height);
  return sheet;
}

void write_strip(const RobotModel& model, const SimulationLog& log,
                 const std::filesystem::path& path, const StripOptions& options) {
  write_png(path, draw_strip(model, log, options));
}

}  // namespace ayumi
