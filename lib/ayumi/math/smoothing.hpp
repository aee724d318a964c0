#pragma once
// Smooth curves through rounded samples.

#include <Eigen/Dense>

namespace ayumi {

/// The smoothest samples y within `band` of x: they minimise the sum of (y - x)^2 and of the
/// squared third differences of y, weighted so that components above `cutoff` [cycles per sample]
/// are removed. Rounding disappears, and slow motion keeps its curvature; corners become as round
/// as the band allows, and a step of more than two bands remains a step. Fewer than eight samples,
/// constant samples and samples with a band of zero are returned unchanged.
Eigen::VectorXd smoothed_within(const Eigen::VectorXd& x, double band, double cutoff);

}  // namespace ayumi
