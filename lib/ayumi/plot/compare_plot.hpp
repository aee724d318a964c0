#pragma once
// A recording drawn over a simulated run: one panel per curve, and below it the difference of the
// two.

#include <filesystem>

#include "ayumi/identify/compare.hpp"
#include "ayumi/plot/drawing.hpp"

namespace ayumi {

/// Draws joints that move [deg], loads of the feet, their share with the landings, and the IMU.
/// Throws Error(usage) if there is no curve.
Drawing draw_comparison(const Comparison& comparison, const std::string& title);

/// Writes the plot as .svg or .png. Throws the errors above, and Error(bad_file).
void write_comparison_plot(const Comparison& comparison, const std::string& title,
                           const std::filesystem::path& path);

}  // namespace ayumi
