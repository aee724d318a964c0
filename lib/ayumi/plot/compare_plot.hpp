#pragma once
// A recording laid over a simulated run: one panel per curve, and the difference of both below it.

#include <filesystem>

#include "ayumi/identify/compare.hpp"
#include "ayumi/plot/drawing.hpp"

namespace ayumi {

/// Joints that move [deg], loads of the feet, their share with the landings, and the IMU. Throws
/// Error(usage) when there is no curve.
Drawing draw_comparison(const Comparison& comparison, const std::string& title);

/// Writes the plot as .svg or .png. Throws as above, and Error(bad_file).
void write_comparison_plot(const Comparison& comparison, const std::string& title,
                           const std::filesystem::path& path);

}  // namespace ayumi
