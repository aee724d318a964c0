#pragma once
// The contact intervals of a planned motion. A foot in contact does not move, so one pose
// represents the whole interval: the planned sole pose at its middle, where neither lift-off nor
// landing disturbs it.

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// The samples first..last (inclusive) during which one foot is planned to be on the ground, or off
/// the ground.
struct ContactInterval {
  int first = 0, last = 0;
  bool contact = false;
  /// Pose at which the foot stands while in contact, in the world.
  Eigen::Isometry3d sole = Eigen::Isometry3d::Identity();
};

/// The whole series cut into alternating intervals, in order of time.
std::vector<ContactInterval> contact_intervals(const CommandSeries& series, Side side);

/// For each sample, the index of its interval in contact_intervals().
std::vector<int> interval_index(const std::vector<ContactInterval>& intervals);

/// The contact intervals of both feet of a series, and the interval of each sample.
struct ContactPlan {
  std::array<std::vector<ContactInterval>, 2> intervals;  ///< contact intervals, by Side
  std::array<std::vector<int>, 2> index;  ///< index of the interval, by Side and then by sample

  const ContactInterval& at(Side side, int sample) const {
    const int s = static_cast<int>(side);
    return intervals[s][index[s][sample]];
  }
  /// The support of a sample, according to its intervals.
  Support support(int sample) const;
};
ContactPlan contact_plan(const CommandSeries& series);

/// The continuation of a swing beyond the beginning or end of a contact: a foot that lands later,
/// or lifts off earlier, than the phases say.
struct RunOn {
  /// Height of the sole's centre over its place at that beginning or end, if the sole is still
  /// moving [m].
  double height = 0;
  int samples = 0;  ///< number of samples until it has practically come to its place
};
/// The continuation at the first sample of a contact (`lands`) or at its last one. The height is
/// zero if the sole is in its place, or if it is at rest above its place (then it is floating and
/// not swinging).
RunOn swing_run_on(const RobotModel& model, const CommandSeries& series, Side side,
                   const ContactInterval& contact, bool lands);

/// Height at which a swing may continue, as a share of the height by which a supporting sole may
/// float. Chosen: with a fifth (0.06 mm), the check finds a contact that begins 60 ms before the
/// end of a slow swing. In generated walks, this height is at most 1e-12 m (docs/attribution.md,
/// "Contacts that begin in the air"). No measured case changes between half and twice the value
/// (constants.md).
inline constexpr double kRunOnShare = 0.2;

/// How long a foot stays in the place of `contact` after the planned end of the contact [samples],
/// or 0 if the foot does not move by 0.08 mm in the following swing. It is computed from the times
/// at which the sole is 0.01 and 0.08 mm off its place, as if its distance grew with the cube of
/// time. Slower starts give a larger number, and quicker ones a smaller one, even below 0.
double samples_after_contact(const RobotModel& model, const CommandSeries& series, Side side,
                             const ContactInterval& contact, const ContactInterval& swing);

/// Whether the differences that give the rates of sample k mix support and flight. There, the
/// acceleration is discontinuous, and the demand on the ground is unknown.
bool at_flight_edge(const CommandSeries& series, int k);

}  // namespace ayumi
