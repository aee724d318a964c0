#pragma once
// The formats of motions: how a file is recognized, its reader and its writer, and what the format
// cannot hold. A new format is one pair of files and one line of the table.

#include <string>
#include <vector>

#include "ayumi/io/formats/motion_file.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Parts of a motion beside its joint angles. A format holds some of them.
enum FormatPart : unsigned {
  kJointNames = 1,
  kRate = 2,
  kRoot = 4,
  kZmp = 8,
  kCog = 16,
  kVerticalForce = 32,
  kTorque = 64,
  kContacts = 128
};

struct MotionFormat {
  std::string name;   ///< its name for --format
  std::string words;  ///< name for people, such as "Webots .motion"
  unsigned holds = 0;
  bool played = false;  ///< whether a robot's own program plays such files
  bool binary = false;  ///< whether the content is not text
  /// Says why the content has this format; "" if it does not have it. Null: the format is only
  /// written.
  std::string (*recognize)(const MotionInput&) = nullptr;
  MotionFile (*read)(const MotionInput&) = nullptr;
  /// Writes the files; null: the format is only read.
  std::vector<WrittenFile> (*write)(const RobotModel&, const MotionFile&) = nullptr;
  /// In place of `read`: makes the keys of a pattern, and adds to the notes what was assumed.
  Pattern (*read_keys)(const MotionInput&, std::vector<std::string>& notes) = nullptr;
};

/// All formats, in the order in which content is compared with them.
const std::vector<MotionFormat>& motion_formats();

/// The format with this name; null if there is none.
const MotionFormat* find_motion_format(const std::string& name);

/// The names of the formats that are read, or of those that are written.
std::vector<std::string> read_format_names();
std::vector<std::string> written_format_names();

struct Recognized {
  const MotionFormat* format = nullptr;
  std::string reason;  ///< the reason in words
};
/// Throws Error(bad_file). The message names the formats that are read. If Ayumi knows what the
/// file is but does not read it, the message says so.
Recognized recognize(const MotionInput& source);

/// In words, what the format cannot hold of the motion; empty if nothing is lost.
std::string cannot_hold(const MotionFormat& format, const MotionFile& motion);

}  // namespace ayumi
