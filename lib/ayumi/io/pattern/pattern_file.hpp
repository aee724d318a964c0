#pragma once
// Pattern <-> pattern file ("ayumi.pattern/1"). docs/formats.md is the specification,
// docs/schemas/pattern-1.schema.json the same for editors.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Largest pattern, and largest file that it includes [bytes]. Source: docs/formats.md.
inline constexpr size_t kLargestPattern = size_t{64} << 20;

/// Reads a pattern, its posture libraries and its table. `set_parameters` replaces defaults of
/// declared parameters. Strict: throws Error(bad_pattern) "file: /json/pointer: what, limit, what
/// to do" for unknown keys, wrong types or units, times that do not increase, empty lists, numbers
/// that are not finite or beyond 1e6; Error(bad_file) when a file cannot be read; Error(usage) for
/// a parameter the pattern does not declare or use.
Pattern read_pattern(const std::filesystem::path& path,
                     const std::map<std::string, double>& set_parameters = {});

/// The same of the bytes of a pattern file; `path` names it in messages, and what it includes is
/// looked for beside it.
Pattern pattern_of_text(const std::string& text, const std::filesystem::path& path,
                        const std::map<std::string, double>& set_parameters = {});

/// A posture library ("ayumi.postures/1"): what patterns include.
struct PostureLibrary {
  std::string robot;    ///< as its author wrote it, a note; "" where there is none
  bool degrees = true;  ///< angle unit of the file
  std::map<std::string, std::map<std::string, double>> postures;  ///< by name and joint [rad], [m]
};
/// Throws as read_pattern().
PostureLibrary read_posture_library(const std::filesystem::path& path);

/// The robot to load: the bundled name as written, or the path as it holds from here.
std::string robot_of(const Pattern& pattern);

/// The file's text: short, keys in a fixed order, one phase or keyframe per line, `comments` as
/// lines above. Numbers are the shortest that read back to the same double; angles in the pattern's
/// unit. Expressions are written as their values (the parameters then become a comment).
std::string pattern_text(const Pattern& pattern, const std::vector<std::string>& comments = {});

/// Writes pattern_text. A relative robot or table path is rewritten to hold from `path`'s folder;
/// the table's own data are not copied.
void write_pattern(const std::filesystem::path& path, const Pattern& pattern,
                   const std::vector<std::string>& comments = {});

/// The value of the key "correction" as text.
std::string correction_text(const CorrectionTrack& track);

/// The text of a pattern file with its correction replaced or added; every other byte, comments and
/// expressions included, stays as the author wrote it. `text` must be a pattern that reads.
std::string with_correction(const std::string& text, const CorrectionTrack& track);

/// Known keys of every kind of object in a pattern file, by the name the schema uses ("pattern",
/// "phase", "keyframe", ...). The reader accepts exactly these.
const std::map<std::string, std::vector<std::string>>& pattern_keys();

}  // namespace ayumi
