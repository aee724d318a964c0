#pragma once
// Contact intervals of a planned motion. A foot in contact does not move, so one pose stands for
// the whole interval: the planned sole pose at its middle, where neither lift-off nor landing blurs
// it.

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "ayumi/motion/command_series.hpp"

namespace ayumi {

/// Samples first..last (inclusive) during which one foot is planned on, or off, the ground.
struct ContactInterval {
  int first = 0, last = 0;
  bool contact = false;
  Eigen::Isometry3d sole =
      Eigen::Isometry3d::Identity();  ///< pose at which the foot stands while in contact, world
};

/// The whole series cut into alternating intervals, in order of time.
std::vector<ContactInterval> contact_intervals(const CommandSeries& series, Side side);

/// By sample: index of its interval in contact_intervals().
std::vector<int> interval_index(const std::vector<ContactInterval>& intervals);

/// Contact intervals of both feet of a series, by sample.
struct ContactPlan {
  std::array<std::vector<ContactInterval>, 2> intervals;  ///< by Side
  std::array<std::vector<int>, 2> index;                  ///< by Side, then sample

  const ContactInterval& at(Side side, int sample) const {
    const int s = static_cast<int>(side);
    return intervals[s][index[s][sample]];
  }
  /// The support of a sample, according to its intervals.
  Support support(int sample) const;
};
ContactPlan contact_plan(const CommandSeries& series);

/// How the swing goes on beyond the edge of a contact: a foot that lands later, or lifts off
/// earlier, than the phases say.
struct RunOn {
  double height = 0;  ///< of the sole's centre over its place at the edge, if it is on its way [m]
  int samples = 0;    ///< from the edge until it has as good as come to its place
};
/// At the first sample of a contact (`lands`) or at its last one. Zero height: the sole is in its
/// place, or hangs still (which is floating, not a swing).
RunOn swing_run_on(const RobotModel& model, const CommandSeries& series, Side side,
                   const ContactInterval& contact, bool lands);

/// What a swing may run on, as a share of the height by which a supporting sole may float. Chosen:
/// a fifth finds 60 ms of a slow swing (0.06 mm), and generated walks have 1e-12 m
/// (docs/attribution.md, "Contacts that begin in the air"). No measured case changes from half to
/// twice (constants.md).
inline constexpr double kRunOnShare = 0.2;

/// How long a foot stays in the place of `contact` after that is said to end [samples], when the
/// swing that follows does begin: by the instants when the sole is 0.01 and 0.08 mm off its place,
/// as if it left it with the cube of time. Slower starts give more, quicker ones less, even below
/// 0.
double samples_after_contact(const RobotModel& model, const CommandSeries& series, Side side,
                             const ContactInterval& contact, const ContactInterval& swing);

/// Whether the differences that make the rates of sample k mix support and flight: acceleration
/// jumps there, and what it needs of the ground is not known.
bool at_flight_edge(const CommandSeries& series, int k);

}  // namespace ayumi
