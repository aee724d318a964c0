#pragma once
// Makes a pattern from a motion of another program or robot. The file is read. If the caller asks
// for it, the ends of the motion are ramped, the soles are put on the ground, and contacts are
// found.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/author/import/contact_reconstruction.hpp"
#include "ayumi/io/table/motion_import.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Largest number of bytes of a motion file. Chosen: an hour of 50 joints at 30 rows per second; a
/// file and its copy stay within 200 MB.
inline constexpr size_t kLargestMotionFile = 64'000'000;

struct PatternImport {
  /// Bounds of the ramp, where it is not 0. Chosen: rows of most recordings are 20 ms apart, and a
  /// robot that speeds up for 10 s does another motion.
  static constexpr Bounds kRamp = {0.02, 10, "s"};

  ImportOptions reading = {};
  ContactThresholds contact = {};  ///< settings for the detection of contacts
  bool ground = false;             ///< the soles that carry the robot are put on the ground
  double ramp = 0;                 ///< time from rest to the speed of a recording that was cut [s]
};

struct ImportedPattern {
  Pattern pattern;             ///< the pattern without a robot; it has keys, or phases with a table
  std::string format, reason;  ///< format and its reason, as in ImportedMotion
  int rows = 0;                ///< number of data rows or key poses of the file
  std::vector<FootContact> contacts;  ///< contacts of a table
  std::vector<std::string> filled;    ///< what was assumed, left out or changed, in words
  TableCaution caution = {};          ///< caution of the run from which a table comes
  std::string sequence = {};  ///< bytes that are kept beside the pattern; "" if there are none
};

/// Whether the bytes of a file that should hold a motion or a table are those of a pattern.
bool is_pattern_text(const std::string& bytes);

/// `bytes` are the content of `file`. Throws Error(bad_file) that names file, place and remedy,
/// and Error(usage) for options out of bounds.
ImportedPattern import_pattern(const std::string& bytes, const std::string& file,
                               const RobotModel& model, const PatternImport& options = {});

/// The bytes of the file of `format` from which the table was imported, if the table still has the
/// angles of this import and was read with the encoders of `model`. Returns nothing for another
/// format. Throws the same errors as kept_sequence().
std::optional<std::string> kept_file(const DenseTable& table, const std::string& format,
                                     const RobotModel& model);

/// The place where write_imported() keeps the copy of a file of this format.
std::filesystem::path copy_beside(const std::filesystem::path& path, const std::string& format);

/// The files that write_imported() may write.
std::vector<std::filesystem::path> files_of_import(const std::filesystem::path& path);

/// Writes the pattern, its table beside it, and the kept copy of the file. Either all of them are
/// written or none. Adds the place of the copy to `filled`.
void write_imported(const std::filesystem::path& path, ImportedPattern& imported);

}  // namespace ayumi
