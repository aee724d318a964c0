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

/// A sheet of pictures below one title and above one legend.
Image with_lines(const Image& tiled, int tile_height, const ClipRenderer& renderer, double end) {
  const double size = std::clamp(tile_height / 22.0, 10.0, 54.0);
  Image blank{tiled.width, static_cast<int>(3 * size), {}};
  blank.rgb.assign(3 * static_cast<size_t>(blank.width) * static_cast<size_t>(blank.height), 255);
  const int head = static_cast<int>(std::ceil(renderer.write_title(blank, 0, size, end)));
  const double legend = renderer.write_legend(nullptr, tiled.width, 0, 0.85 * size);
  Image sheet{tiled.width, head + tiled.height, {}};
  if (legend > 0) sheet.height += static_cast<int>(std::ceil(legend + 0.6 * size));
  sheet.rgb.assign(3 * static_cast<size_t>(sheet.width) * static_cast<size_t>(sheet.height), 255);
  renderer.write_title(sheet, 0, size, end);
  paste(tiled, sheet, 0, head);
  renderer.write_legend(&sheet, sheet.width, head + tiled.height + 0.3 * size, 0.85 * size);
  return sheet;
}

// Throws Error(usage) if a sheet of `count` pictures of this size [pixel] cannot be made. This is
// tested before the pictures are drawn, which takes long.
void require_sheet(long count, int columns, long width, long height) {
  // Largest width and height of a sheet [pixel]. Chosen: 0.8 GB of memory for a square sheet.
  constexpr long kLargestSide = 16384;
  const long across = std::clamp<long>(columns, 1, std::max(1L, count));
  const long down = (count + across - 1) / across;
  if (count < 1 || width * across > kLargestSide || height * down > kLargestSide)
    fail(ErrorCode::usage, "a sheet of " + std::to_string(count) + " pictures would have " +
                               std::to_string(width * across) + " x " +
                               std::to_string(height * down) +
                               " pixels; a sheet must have at least one picture, and at most 16384 "
                               "pixels on each side");
}

}  // namespace

Image draw_sheet(const std::vector<Image>& tiles, int columns) {
  const int count = static_cast<int>(tiles.size());
  const int width = tiles.empty() ? 0 : tiles.front().width;
  const int height = tiles.empty() ? 0 : tiles.front().height;
  const int across = std::clamp(columns, 1, std::max(1, count));
  require_sheet(count, columns, width, height);
  Image sheet;
  sheet.width = width * across;
  sheet.height = height * ((count + across - 1) / across);
  sheet.rgb.assign(3 * static_cast<size_t>(sheet.width) * static_cast<size_t>(sheet.height), 255);
  for (int i = 0; i < count; ++i) {
    const Image& tile = tiles[static_cast<size_t>(i)];
    paste(tile, sheet, i % across * tile.width, i / across * tile.height);
  }
  return sheet;
}

Image draw_strip(const RobotModel& model, const SimulationLog& log, const StripOptions& options,
                 const Progress& progress, std::vector<std::string>* notes) {
  const double last = duration(log);
  require_within(options.one_picture ? "the number of postures" : "the number of snapshots",
                 options.times.empty() ? options.count : static_cast<double>(options.times.size()),
                 options.one_picture ? StripOptions::kExposures : StripOptions::kCount);
  require_within("the number of columns", options.columns, StripOptions::kColumns);
  std::vector<double> times =
      options.times.empty() ? telling_instants(log, options.count) : options.times;
  for (double& t : times) t = std::clamp(t, 0.0, last);
  ClipOptions clip = options.clip;
  if (options.one_picture) {
    clip.camera.mode = CameraMode::fixed;
    ClipRenderer renderer(model, log, clip);
    if (notes) *notes = renderer.notes();
    return renderer.exposures(times);
  }
  clip.camera.smoothing = 0;  // every picture has the robot in its middle
  // If the robot fills a portrait picture, half of the picture's width is this share of the robot's
  // height.
  clip.overlay.push_length = std::min(clip.overlay.push_length, 0.34);
  const auto alive = [&](const ProgressEvent&) {
    report(progress, {"drawing the snapshots", 0, ""});
    return true;
  };
  require_sheet(static_cast<long>(times.size()), options.columns, clip.picture.width,
                clip.picture.height);
  ClipRenderer renderer(model, log, clip, clip_shape(model, log, clip, false, alive));
  if (notes) *notes = renderer.notes();
  renderer.frame_robot(times);
  std::vector<Image> tiles;
  for (const double t : times) {
    report(progress, {"drawing the snapshots", double(tiles.size()) / double(times.size()), ""});
    tiles.push_back(renderer.tile(t));
  }
  const Image tiled = draw_sheet(tiles, options.columns);
  return clip.overlay.caption ? with_lines(tiled, tiles.front().height, renderer, last) : tiled;
}

PngPicture snapshots_of_run(const RobotModel& model, const SimulationLog& log, ClipOptions clip) {
  StripOptions options;
  options.clip = std::move(clip);
  options.clip.picture.width = 400;
  options.clip.picture.height = 600;
  const Image strip = draw_strip(model, log, options);
  return {strip.width, strip.height, encode_png(strip)};
}

}  // namespace ayumi
