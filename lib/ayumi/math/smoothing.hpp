#pragma once
// Smooth curves through rounded samples.

#include <Eigen/Dense>

namespace ayumi {

/// The samples y that stay within `band` of x and are smoothest: least sum of (y - x)^2 + third
/// differences of y squared, weighed so that what is quicker than `cutoff` [cycles per sample]
/// gives way. Rounding goes, slow movement and its curvature stay; corners become as round as the
/// band lets them, and a jump of more than two bands stays a jump. Fewer than eight samples, a band
/// of zero or constant samples come back as they are.
Eigen::VectorXd smoothed_within(const Eigen::VectorXd& x, double band, double cutoff);

}  // namespace ayumi
