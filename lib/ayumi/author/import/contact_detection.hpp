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

/// Height of the lowest corner of a sole in row k [m]; `foot` is the index of its Side.
double lowest_point(const RobotModel& model, const Soles& soles, int foot, int k);

/// The supporting feet in each row. Feet that stand do not move relative to each other. If the
/// supporting foot changes without a phase in which both feet are at rest, both feet support the
/// robot as long as they do not move apart. Slow ends and starts of swings belong to the support.
std::vector<Support> supports_with_swing_ends(const RobotModel& model, const RawMotion& motion,
                                              const Soles& soles);

/// Takes the slow ends and starts of swings out of `supports`: a contact begins when the foot comes
/// to rest after a swing, and it ends when the next swing of this foot begins.
std::vector<Support> without_swing_ends(const RobotModel& model, const RawMotion& motion,
                                        const Soles& soles, std::vector<Support> supports);

/// Rows first..last (inclusive) with one support.
struct Stretch {
  int first = 0, last = 0;
  Support support = Support::both;
};
std::vector<Stretch> stretches(const std::vector<Support>& supports);

}  // namespace ayumi
