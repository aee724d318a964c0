#pragma once
// The posture that the author wants at a time, as edits of the pattern's text. Joints are set by
// sliders, or a foot, a hand, the trunk or the COG is dragged in the picture. The motion is sampled
// again with the edits. So the soles stay in place, the balance is solved, and the page shows what
// the pattern becomes.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "author/author_motion.hpp"
#include "ayumi/io/pattern/pattern_edit.hpp"

namespace ayumi::app {

struct PoseWish {
  double time = 0;                       ///< time of the change [s]
  std::map<std::string, double> joints;  ///< joint positions by name [rad, m]
  std::string drag;                      ///< name of the dragged handle; empty if there is none
  std::string target;                    ///< pointer of the AuthorTarget at `time` that is dragged
  /// Place to which the point is dragged, in the world [m].
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  /// Place that the point had in the picture, in the world [m].
  std::optional<Eigen::Vector3d> from;
};

struct PoseAnswer {
  std::string row;                 ///< row of the page's table at that time; empty if there is none
  std::vector<PatternEdit> edits;  ///< edits that make the motion so; empty if it is not possible
  std::string message;             ///< what the author has to know; may be empty
};

/// `text` is that of the motion.
PoseAnswer posed(const AuthorMotion& motion, const std::string& text, const AuthorSetting& setting,
                 const PoseWish& wish);

/// All joints at a time as a posture of the pattern with this name, either as they are or mirrored.
/// If a run is shown, `angles` replace those of the motion [rad, m]. Throws Error(usage) for an
/// empty name, and Error(bad_model) if the robot has no mirror image.
std::vector<PatternEdit> captured(const AuthorMotion& motion, double time, const std::string& name,
                                  bool mirror, const std::map<std::string, double>& angles = {});

struct MirroredKeyframe {
  /// The edits that exchange left and right; only values that change are written. Empty if the
  /// keyframe is its own mirror image.
  std::vector<PatternEdit> edits;
  /// The whole text with this change in the author's own words: expressions, comments and spacing
  /// inside the keyframe stay. Empty if the text cannot express this.
  std::optional<std::string> text = {};
};

/// Exchanges left and right in the keyframe at this pointer. `text` is that of the motion. Throws
/// Error(usage) for a pointer without a keyframe, and the same errors as captured().
MirroredKeyframe mirrored_keyframe(const AuthorMotion& motion, const std::string& text,
                                   const AuthorSetting& setting, const std::string& pointer);

}  // namespace ayumi::app
