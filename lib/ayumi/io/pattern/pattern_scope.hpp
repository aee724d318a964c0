#pragma once
// Functions for the sources that read pattern files: values that may be expressions, and angles in
// the file's unit.

#include <optional>
#include <set>

#include "ayumi/base/largest_number.hpp"
#include "ayumi/io/degrees.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"

namespace ayumi {

/// Longest pattern [s]. Source: docs/formats.md.
inline constexpr double kLongestPattern = 3600;

/// The context that is needed to read the values of one file.
struct PatternScope {
  std::map<std::string, double> parameters;
  std::set<std::string> used;              ///< names of parameters in expressions
  std::optional<double> radians_per_unit;  ///< angle unit; empty if the file names none
};

/// Whether a pattern's "robot" is a path and not a bundled name.
bool names_a_path(const std::string& robot);

/// A relative path of files in `from`, changed so that it is right for files in `to`.
std::string rebased(const std::string& name, const std::filesystem::path& from,
                    const std::filesystem::path& to);
/// The pattern with relative paths of robot, table and schema that are right in the folder `to`.
Pattern moved_to_folder(const Pattern& pattern, const std::filesystem::path& to);

/// Throws an error for a key that pattern_keys() does not list for `kind`.
void only_pattern_keys(const JsonNode& node, const std::string& kind);

/// Reads a number or an expression such as "${name}"; it must be finite, and at most kLargestNumber
/// in size.
double read_number(const JsonNode& node, PatternScope& scope);
double read_number(const JsonNode& node, PatternScope& scope, double lower, double upper);
/// As read_number(), but in the file's angle unit; the result is in rad.
double read_angle(const JsonNode& node, PatternScope& scope);
double read_time(const JsonNode& node, PatternScope& scope);
/// Reads an array of `least` to `most` numbers; `form` says how the array is written.
std::vector<double> read_numbers(const JsonNode& node, PatternScope& scope, size_t least,
                                 size_t most, const std::string& form);
Eigen::Vector3d read_vector3(const JsonNode& node, PatternScope& scope);
/// Reads [x, y], [x, y, z], [x, y, z, yaw] or {"position": [x, y, z], "rpy": [r, p, y]}.
Foothold read_foothold(const JsonNode& node, PatternScope& scope);
/// Reads {"joint": angle, ...}.
std::map<std::string, double> read_joint_angles(const JsonNode& node, PatternScope& scope);
Interpolation read_interpolation(const JsonNode& node);

/// Reads {"units": {...}} of a pattern or posture library into the scope.
void read_units(const JsonNode& root, PatternScope& scope);

ViipGoal read_viip_goal(const JsonNode& node, PatternScope& scope);
/// Reads a phase or a keyframe after one that ends at `before` [s].
Phase read_phase(const JsonNode& node, double before, PatternScope& scope);
Keyframe read_keyframe(const JsonNode& node, double before, PatternScope& scope);
World read_world(const JsonNode& node, PatternScope& scope);
ControllerSpec read_controller(const JsonNode& node, PatternScope& scope);
Disturbance read_disturbance(const JsonNode& node, PatternScope& scope);
CorrectionTrack read_correction(const JsonNode& node);
Uncertainty read_uncertainty(const JsonNode& node, PatternScope& scope);
/// `keyframes` is the number of keyframes of the pattern.
RepairPreferences read_repair(const JsonNode& node, int keyframes, PatternScope& scope);

}  // namespace ayumi
