#pragma once
// Reads and writes pattern files ("ayumi.pattern/1"). docs/formats.md is their specification;
// docs/schemas/pattern-1.schema.json is the same specification for editors.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Largest size of a pattern, and of a file that it includes [bytes]. Source: docs/formats.md.
inline constexpr size_t kLargestPattern = size_t{64} << 20;

/// Reads a pattern, its posture libraries and its table. `set_parameters` replaces the defaults of
/// declared parameters. The reader is strict. It throws Error(bad_pattern) "file: /json/pointer:
/// what, limit, what to do" for unknown keys, wrong types or units, times that do not increase,
/// empty lists, and numbers that are not finite or beyond 1e6; Error(bad_file) if a file cannot be
/// read; and Error(usage) for a parameter that the pattern does not declare or use.
Pattern read_pattern(const std::filesystem::path& path,
                     const std::map<std::string, double>& set_parameters = {});

/// Reads the bytes of a pattern file in the same way. `path` names it in messages, and the files
/// that it includes are searched beside it. If a `table` is given, it stands for the file that the
/// text names as its table, which then need not exist.
Pattern pattern_of_text(const std::string& text, const std::filesystem::path& path,
                        const std::map<std::string, double>& set_parameters = {},
                        const DenseTable* table = nullptr);

/// A posture library ("ayumi.postures/1"), which patterns can include.
struct PostureLibrary {
  std::string robot;    ///< the robot's name as its author wrote it, as a note; "" if there is none
  bool degrees = true;  ///< angle unit of the file
  /// Angles by posture name and joint [rad], [m].
  std::map<std::string, std::map<std::string, double>> postures;
};
/// Throws the same errors as read_pattern().
PostureLibrary read_posture_library(const std::filesystem::path& path);

/// The robot to load: a bundled name as it is written, or a path that is valid from the working
/// folder.
std::string robot_of(const Pattern& pattern);

/// The text of the file. It is short, its keys have a fixed order, each phase or keyframe has one
/// line, and `comments` are lines above. Numbers are the shortest texts that give the same double
/// again; angles are in the pattern's unit. Expressions are written as their values, and the
/// parameters become a comment.
std::string pattern_text(const Pattern& pattern, const std::vector<std::string>& comments = {});

/// Writes pattern_text(). A relative path of a robot or table is changed so that it is valid from
/// the folder of `path`. The data of the table are not copied.
void write_pattern(const std::filesystem::path& path, const Pattern& pattern,
                   const std::vector<std::string>& comments = {});

/// The value of the key "correction" as text.
std::string correction_text(const CorrectionTrack& track);

/// The text of a pattern file with its correction replaced or added. Every other byte, comments and
/// expressions included, stays as the author wrote it. `text` must be a pattern that can be read.
std::string with_correction(const std::string& text, const CorrectionTrack& track);

/// The known keys of every kind of object in a pattern file, by the name that the schema uses
/// ("pattern", "phase", "keyframe", ...). The reader accepts exactly these keys.
const std::map<std::string, std::vector<std::string>>& pattern_keys();

}  // namespace ayumi
