#pragma once
// The numbers that an author wrote into a pattern, each with its place in the file, and with the
// value that its track would have without it. A pattern in which one number is replaced says what
// that number has brought about.

#include <functional>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

enum class Quantity { length, angle, force, ratio };

/// One number in the pattern.
struct WrittenNumber {
  std::function<double&(Pattern&)> in;
  double value = 0;        ///< [m, rad, N, 1]
  double neutral = 0;      ///< what would be there without it, in the same unit
  std::string place = {};  ///< JSON pointer of its phase or keyframe; "": that of its value
};

/// One value of the author: a number, or a number that is repeated. Keys that hold a value name it
/// twice.
struct WrittenValue {
  std::string place;  ///< JSON pointer of the phase or keyframe where it is first, or of itself
  std::string words;  ///< "the COG height"
  Quantity quantity = Quantity::length;
  bool across = false;        ///< a coordinate whose sign tells left from right
  double begin = 0, end = 0;  ///< the motion depends on it at least between these times [s]
  std::vector<WrittenNumber> numbers = {};  ///< at least one

  /// A large value of its quantity: the length of a leg, a radian, the weight, 1.
  double unit(const RobotModel& model) const;
  /// How far it is from what would be there without it, in such units.
  double suspicion(const RobotModel& model) const;
  /// Whether the same value with the other sign could have been meant.
  bool has_sign() const;
  /// "0.9 m", "30 deg": `value` as the author of this pattern writes it.
  std::string text(const Pattern& pattern, double value) const;
  /// Where its other numbers are, which a change of the value changes too: " here and in
  /// /keyframes/3"; "" where it is one line of the file.
  std::string elsewhere() const;
  /// The share nearest to this one at which pull() leads to a value as text() writes it.
  double written_share(const Pattern& pattern, double share) const;
  /// Multiplies all its numbers.
  void scale(Pattern& pattern, double factor) const;
  /// Gives all its numbers one value, at this share of the way of the first of them from what would
  /// be there without it; at 0, each becomes what would be there without them.
  void pull(Pattern& pattern, double share) const;
};

/// All numbers of phases, keyframes, postures, start and ground that are not times. A pattern whose
/// feet cannot be planned has none of feet and COG.
std::vector<WrittenValue> written_values(const RobotModel& model, const Pattern& pattern);

}  // namespace ayumi
