#pragma once
// Which feet carry in a motion that does not say so.

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "ayumi/author/import/contact_reconstruction.hpp"

namespace ayumi {

using Soles = std::array<std::vector<Eigen::Isometry3d>, 2>;  ///< frames by Side, then row

/// In the world where the motion has a base, else in the base.
Soles soles_of(const RobotModel& model, const RawMotion& motion);

/// By row. Feet that stand do not move against each other; where one takes over from the other at
/// once, both carry as long as they do not part. A contact lasts from where a swing has come to
/// rest to where the next one begins.
std::vector<Support> supports_from(const RobotModel& model, const RawMotion& motion,
                                   const Soles& soles);

/// Rows first..last (inclusive) of one support.
struct Stretch {
  int first = 0, last = 0;
  Support support = Support::both;
};
std::vector<Stretch> stretches(const std::vector<Support>& supports);

}  // namespace ayumi
