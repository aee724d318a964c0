#pragma once
// The numbers that an author wrote into a pattern, each with its place in the file and with the
// value that its track would have without it. If one number is replaced, the changed pattern shows
// what that number has caused.

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
  double value = 0;    ///< value [m, rad, N, 1]
  double neutral = 0;  ///< the value of the track without this number, in the same unit
  /// JSON pointer of the phase or keyframe of the number; if empty, it is that of the value.
  std::string place = {};
};

/// One value of the author: a number, or a number that is repeated. Two keys between which a value
/// stays constant both contain it.
struct WrittenValue {
  std::string place;  ///< JSON pointer of the first phase or keyframe with the value, or of the
                      ///< value itself
  std::string words;  ///< name of the value: "the COG height"
  Quantity quantity = Quantity::length;
  bool across = false;        ///< whether its sign distinguishes left from right
  double begin = 0, end = 0;  ///< the motion depends on it at least between these times [s]
  std::vector<WrittenNumber> numbers = {};  ///< its numbers, at least one

  /// A large value of this quantity: the length of a leg, a radian, the weight, or 1.
  double unit(const RobotModel& model) const;
  /// Largest distance of one of its numbers from the neutral value, in these units.
  double suspicion(const RobotModel& model) const;
  /// Whether the same value with the other sign could have been meant.
  bool has_sign(const RobotModel& model) const;
  /// "0.9 m", "30 deg": `value` as the author of this pattern writes it.
  std::string text(const Pattern& pattern, double value) const;
  /// A text with the places of the other numbers of this value, because a change of the value
  /// changes them, too: " here and in /keyframes/3". It is empty if the value is on one line of the
  /// file.
  std::string elsewhere() const;
  /// The share nearest to `share` for which pull() gives exactly a value that text() can write (a
  /// rounded value).
  double written_share(const Pattern& pattern, double share) const;
  /// Multiplies all numbers of the value.
  void scale(Pattern& pattern, double factor) const;
  /// Gives all numbers of the value the same new value: neutral + share * (value - neutral) of its
  /// first number.
  void pull(Pattern& pattern, double share) const;
  /// Gives each number its neutral value.
  void leave_out(Pattern& pattern) const;
};

/// All numbers of phases, keyframes, postures, start and ground, except times. If the feet of a
/// pattern cannot be planned, its numbers of feet and COG are left out.
std::vector<WrittenValue> written_values(const RobotModel& model, const Pattern& pattern);

}  // namespace ayumi
