#pragma once
// Detection of the supporting feet in a motion without contact information.

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "ayumi/author/import/contact_reconstruction.hpp"

namespace ayumi {

using Soles = std::array<std::vector<Eigen::Isometry3d>, 2>;  ///< sole frames by Side, then by row

/// Sole frames in the world if the motion has a base, otherwise in the base.
Soles soles_of(const RobotModel& model, const RawMotion& motion);

/// Height of the lowest corner of a sole in row k; `foot` is the index of its Side.
double lowest_point(const RobotModel& model, const Soles& soles, int foot, int k);

/// Support by row. Standing feet do not move relative to each other; at an immediate change of the
/// supporting foot both support as long as they do not move apart. A contact lasts from the rest
/// after a swing to the beginning of the next swing.
std::vector<Support> supports_from(const RobotModel& model, const RawMotion& motion,
                                   const Soles& soles);

/// Rows first..last (inclusive) with one support.
struct Stretch {
  int first = 0, last = 0;
  Support support = Support::both;
};
std::vector<Stretch> stretches(const std::vector<Support>& supports);

}  // namespace ayumi
