#pragma once
// Motions of other programs and robots, in the formats of io/formats/motion_formats.hpp, adapted to
// a robot. Notes in words say what was understood, assumed, filled in or left out.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/author/import/contact_reconstruction.hpp"
#include "ayumi/base/bounds.hpp"
#include "ayumi/model/encoder_angles.hpp"
#include "ayumi/motion/table_caution.hpp"

namespace ayumi {

struct ImportOptions {
  /// Bounds of rate, where it is not 0, and of smooth. Chosen: rows more than a second apart show
  /// no motion, rows less than 0.01 ms apart are nearer to each other than the ticks of any servo,
  /// and a change of more than 5 degrees makes another motion.
  static constexpr Bounds kRate = {1, 1e5, "1/s"}, kSmooth = {0, 5, "deg"};

  std::string format{};   ///< name of motion_formats(); "" if the content decides
  bool degrees = false;   ///< unit of angles if the format does not define it
  double rate = 0;        ///< rate of rows without times [1/s]
  bool commands = false;  ///< angles are servo targets, as in Ayumi's reference tables
  /// Where the angles were measured. Without a value, the format decides: formats that a robot
  /// plays or records (such as HOAP sequences) and servo targets (`commands`) have angles of the
  /// encoders; all others have angles of the joints. A table that Ayumi has written states the
  /// offsets of the encoders in its head.
  std::optional<MeasuredAt> measured_at{};
  /// The values are sent to this robot as they are. So they are angles of its own encoders, even if
  /// the head of a table states the offsets of another robot.
  bool sent = false;
  /// Rows of radians have the signs of the encoders and not of the joints.
  bool encoder_signs = true;
  /// Largest change of an angle [deg]. If there is no value, it is 0.1 for counts and 0 for angles.
  std::optional<double> smooth{};
  bool by_order = false;              ///< columns are the robot's joints in the robot's order
  std::vector<std::string> joints{};  ///< joint names of the columns, in the order of the file
  std::string motion{};  ///< name or number of the motion in a file with several; "" for the first
};

struct ImportedMotion {
  RawMotion motion;
  std::string format;     ///< name of motion_formats()
  std::string reason;     ///< reason why the content has this format; "" if the format was stated
  std::string name = {};  ///< name of the motion; "" if the file has none
  int rows = 0;           ///< number of data rows of the file
  bool commands = false;  ///< motion.theta are servo targets
  TableCaution caution = {};  ///< caution of the run from which the table comes
  std::string sequence = {};  ///< bytes of a HOAP sequence, which are kept for an unchanged export
  std::vector<std::string> filled;  ///< assumptions, and other content of the file, in words
};

/// A file of key poses as a pattern.
struct ImportedKeys {
  Pattern pattern;                       ///< the pattern without robot and name
  std::string format;                    ///< name of motion_formats()
  std::string reason;                    ///< the reason, as ImportedMotion::reason
  std::vector<std::string> filled = {};  ///< what was assumed or left out
};

/// The keys of a file of key poses; nothing for a file of any other format. Throws the same errors
/// as read_motion_rows().
std::optional<ImportedKeys> read_key_poses(const std::string& bytes, const std::string& file,
                                           const RobotModel& model,
                                           const ImportOptions& options = {});

/// The rows of a file as they are, evenly spaced, with the columns of the robot's joints. Joints
/// are mapped by their names or the robot's aliases, or by their order if the options say so.
/// Values that are not set, and rows between key postures, are interpolated. Throws Error(bad_file)
/// that names the format, the place and the remedy, and Error(usage) for options out of bounds.
ImportedMotion read_motion_rows(const std::string& bytes, const std::string& file,
                                const RobotModel& model, const ImportOptions& options = {});

/// The rows of read_motion_rows() as postures: if the file holds commands, the servos' lead is
/// removed. Then angles are smoothed within the limit of ImportOptions::smooth.
ImportedMotion read_motion(const std::string& bytes, const std::string& file,
                           const RobotModel& model, const ImportOptions& options = {});

}  // namespace ayumi
