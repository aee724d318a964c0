#pragma once
// The posture that the author wants at a time, as edits of the pattern's text: joints on sliders,
// or a foot, a hand, the trunk or the COG dragged in the picture. The motion is sampled again with
// the edits, so that the soles stay, the balance is solved, and what is shown is what the pattern
// then is.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "author/author_motion.hpp"
#include "ayumi/io/pattern/pattern_edit.hpp"

namespace ayumi::app {

struct PoseWish {
  double time = 0;                               ///< [s]
  std::map<std::string, double> joints;          ///< [rad, m]
  std::string drag;                              ///< name of a handle; empty: none
  std::string target;                            ///< pointer of an AuthorTarget at `time`
  Eigen::Vector3d to = Eigen::Vector3d::Zero();  ///< where its point shall be, world [m]
  std::optional<Eigen::Vector3d> from;           ///< where the picture had it, world [m]
};

struct PoseAnswer {
  std::string row;                 ///< of the page's table at that time; empty: there is none
  std::vector<PatternEdit> edits;  ///< that make the motion so; none where nothing can
  std::string message;             ///< what the author has to know, may be empty
};

/// `text` is that of the motion.
PoseAnswer posed(const AuthorMotion& motion, const std::string& text, const AuthorSetting& setting,
                 const PoseWish& wish);

/// All joints at a time as a posture of the pattern under this name, as it is or mirrored; with
/// angles in place of those of the motion where a run is shown [rad, m]. Throws Error(usage) for an
/// empty name, and Error(bad_model) where the robot has no mirror image.
std::vector<PatternEdit> captured(const AuthorMotion& motion, double time, const std::string& name,
                                  bool mirror, const std::map<std::string, double>& angles = {});

/// The keyframe at this pointer with left and right exchanged: only values that change are written.
/// Throws Error(usage) for a pointer without a keyframe, and Error(bad_model) as captured().
std::vector<PatternEdit> mirrored_keyframe(const AuthorMotion& motion, const std::string& pointer);

}  // namespace ayumi::app
