#pragma once
// The data of the pattern in which likely causes are searched: what is written, where the feet are
// planned, and which parts may cause an error.

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/check/mistake_trials.hpp"
#include "ayumi/check/written_values.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

// Two times that differ by less than this are the same instant [s]. Chosen: times are written in
// milliseconds, and each of the two is rounded.
inline constexpr double kSameInstant = 0.002;
// A length below this counts as zero [m]. Definition: rounding errors are smaller.
inline constexpr double kNoLength = 1e-4;
// An angle below this counts as zero [rad]. Definition: rounding errors are smaller.
inline constexpr double kNoAngle = 1e-6;

struct ExaminedPattern {
  const RobotModel& model;
  const Pattern& pattern;
  const TrialOutcome& found;         ///< what the check has found
  std::vector<WrittenValue> values;  ///< the numbers of the pattern
  /// The planned feet; nothing if the phases themselves are wrong.
  std::optional<FootPlan> feet = {};
  std::vector<double> ends = {};      ///< ends of the phases, sorted [s]
  std::vector<double> contacts = {};  ///< times of the keys for which is_of_contact(), sorted [s]

  /// The references must outlive the object.
  ExaminedPattern(const RobotModel& model, const Pattern& pattern, const TrialOutcome& found);
  ExaminedPattern(const ExaminedPattern&) = delete;

  double begin_of(size_t phase) const;          ///< beginning of a phase [s]
  std::string phase_place(size_t phase) const;  ///< JSON pointer of a phase
  std::string key_place(size_t key) const;      ///< JSON pointer of a keyframe
  /// Whether this phase may cause an error: there is an error between the beginning of the phase
  /// and the end of the fourth phase after it.
  bool reaches(size_t phase) const;
  /// Whether this keyframe may cause an error: there is one between its neighbours.
  bool reaches_key(size_t key) const;
  /// Whether the key belongs to a block that repeats. Such a key has no time of its own in the
  /// file.
  bool is_repeated_key(size_t key) const;
  /// Whether a time [s] is within a flight; the ends of a flight do not belong to it.
  bool flies(double t) const;
  /// Whether a phase ends at this time [s].
  bool is_at_end(double t) const;
  /// Whether a keyframe for which is_of_contact() is at this time [s].
  bool has_key_of_contact(double t) const;
  /// An angle [rad] in words, in the unit of the pattern.
  std::string angle(double radians) const;
  /// Whether a foot swings in this phase to a place that is stated in the world.
  bool has_place(size_t phase) const;
  /// Whether a keyframe states the height of the COG.
  bool has_cog_height() const;
  Support support_at(double t) const;  ///< planned support at this time [s]
};

namespace hypotheses {

/// Whether a key states the place of a foot, or a place of the ZMP other than "center".
bool is_of_contact(const Keyframe& key);
/// The keyframe at this time [s], which is added if there is none.
Keyframe& keyframe_at(Pattern& pattern, double t);
/// The nearest angle in whole degrees [rad].
double whole_degrees(double radians);
/// A time in words.
std::string seconds(double t);
/// Whether the robot stands on one foot.
bool is_single(Support support);
/// The foot that stands in a single support.
Side stance_of(Support support);
/// Whether `same` is true for one of the two neighbours of `t` in a sorted list of times.
template <class Same>
bool has_beside(const std::vector<double>& times, double t, const Same& same) {
  const auto after = std::lower_bound(times.begin(), times.end(), t);
  return (after != times.end() && same(*after)) ||
         (after != times.begin() && same(*std::prev(after)));
}

}  // namespace hypotheses

}  // namespace ayumi
