#pragma once
// A motion of another program or robot as a pattern: the file is read, its ends are ramped, its
// soles are put on the ground and its contacts found, as far as the caller asks for this.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/author/import/contact_reconstruction.hpp"
#include "ayumi/io/table/motion_import.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Bytes of a motion file. Chosen: an hour of 50 joints at 30 rows per second; a file and its copy
/// stay within 200 MB.
inline constexpr size_t kLargestMotionFile = 64'000'000;

struct PatternImport {
  ImportOptions reading = {};
  ContactThresholds contact = {};  ///< where contacts are detected
  bool ground = false;             ///< the soles that carry the robot are put on the ground
  double ramp = 0;                 ///< time from rest to the speed of a recording that was cut [s]
};

struct ImportedPattern {
  Pattern pattern;                    ///< without robot; keys, or phases with a table
  std::string format, reason;         ///< as in ImportedMotion
  int rows = 0;                       ///< data rows or key poses of the file
  std::vector<FootContact> contacts;  ///< of a table
  std::vector<std::string> filled;    ///< what was assumed, left out or changed, in words
  TableCaution caution = {};          ///< of the run that a table is from
  std::string sequence = {};          ///< bytes to be kept beside the pattern; "": none
};

/// `bytes` are the content of `file`. Throws Error(bad_file) that names file, place and remedy.
ImportedPattern import_pattern(const std::string& bytes, const std::string& file,
                               const RobotModel& model, const PatternImport& options = {});

/// The bytes of the file of `format` from which the table was imported, where the table has the
/// angles of that import; nothing for another format. Throws as kept_sequence().
std::optional<std::string> kept_file(const DenseTable& table, const std::string& format);

/// Where write_imported() keeps the copy of a file of this format.
std::filesystem::path copy_beside(const std::filesystem::path& path, const std::string& format);

/// The files that write_imported() may write.
std::vector<std::filesystem::path> files_of_import(const std::filesystem::path& path);

/// Writes the pattern, its table beside it, and the copy that is kept of the file; all of them or
/// none. Adds to `filled` where the copy is.
void write_imported(const std::filesystem::path& path, ImportedPattern& imported);

}  // namespace ayumi
