#pragma once
// Edits of patterns: each function returns a new pattern and reads or writes no file.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// The motion as a table with the file name `table`: theta, base, commanded COG, ZMP and f_z of
/// every sample. Phases with footholds, world, controller, scenario and tolerances stay; keys are
/// removed except weights and foot poses. `series` is the sampled pattern. Throws
/// Error(bad_pattern) for a phase with a goal, which has no sampled motion.
Pattern baked(const RobotModel& model, const Pattern& pattern, const CommandSeries& series,
              const std::string& table);

/// Map of a robot to its mirror image about its x z plane.
struct MirrorMap {
  std::vector<int> dof;   ///< by dof: its counterpart; a dof in the middle has itself
  std::vector<int> sign;  ///< by dof: factor on theta in the image, +1 or -1
  std::vector<int> link;  ///< by link: its counterpart
};
/// Throws Error(bad_model) with the name of the joint if no joint has its axis within 5 mm of the
/// mirror image of this joint's axis.
MirrorMap mirror_map(const RobotModel& model);

/// The mirror image of a pattern: left and right are exchanged in feet, joints, y coordinates,
/// pushes, table and correction. A pattern that is mirrored twice is unchanged. Throws the same
/// errors as mirror_map(), and Error(bad_pattern) for an unknown joint.
Pattern mirrored(const RobotModel& model, const Pattern& pattern);

/// The pattern with all times multiplied by `scale`. f_z keys get the vertical acceleration of the
/// new times; ZMP and f_z columns of a table are no longer valid and come from the full model. A
/// push keeps its duration. Throws Error(usage) unless 0.01 <= scale <= 100, and the same errors as
/// baked().
Pattern retimed(const RobotModel& model, const Pattern& pattern, double scale);

/// The pattern with the time from `begin` to `end` [s] multiplied by `factor` and the rest shifted;
/// keys, phases and f_z keys change as in retimed(). Throws Error(usage) for a factor or window out
/// of range, Error(bad_pattern) for a table or a correction, and the same errors as retimed().
Pattern stretched(const RobotModel& model, const Pattern& pattern, double begin, double end,
                  double factor);

/// A new timing of a motion: the robot takes the same postures in the same order, but at other
/// times.
struct TimeCourse {
  double dt = 0.001;       ///< sampling step of the new motion [s]
  std::vector<double> at;  ///< for each sample of the new motion, the time of the given motion [s];
                           ///< increases up to its end

  double duration() const { return dt * static_cast<double>(at.size() - 1); }
  /// The new time of a time of the given motion [s].
  double time_of(double given) const;
};

/// The motion with another timing, as a table of posture and base (COG, ZMP and f_z are those of
/// the full model). `series` holds the samples of the pattern, between which the postures follow
/// their rates and accelerations. The times of phases, pushes, weights and windows change with the
/// motion. The paths of the feet are planned as the joint angles give them, because a planned swing
/// would have a timing of its own. Throws the same errors as baked().
Pattern with_course(const RobotModel& model, const Pattern& pattern, const CommandSeries& series,
                    const TimeCourse& course, const std::string& table);

/// A single keyframe that is copied, moved or mirrored.
struct KeyEdit {
  double at = 0;                  ///< time of the keyframe, within 0.5 ms [s]
  std::optional<double> to = {};  ///< its new time [s]; without it, the time stays
  bool copy = false;              ///< the keyframe also stays at its old time
  bool mirror = false;            ///< left and right are exchanged at the new time
};
/// The pattern after the edit. A keyframe that is moved to the time of another keyframe is merged
/// with it. If both have a value for the same track, the value of the moved keyframe is kept.
/// Throws Error(usage) if there is no keyframe at the time, or if the new time is beyond the phases
/// or inside a VIIP phase, and the same errors as mirror_map().
Pattern with_key_edited(const RobotModel& model, const Pattern& pattern, const KeyEdit& edit);

/// The pattern and its mirror image alternately, `times` parts in total, so that one step becomes a
/// walk. Each part begins with the feet in the places in which the previous part ends. Swings
/// become steps relative to the other foot. If `close` is true, the last step brings the feet
/// beside each other. Points on the ground move with the foot that carries the robot in the first
/// swing. Throws Error(bad_pattern) for a pattern with a table, a correction, VIIP phases or foot
/// keys, or without a swing, Error(usage) unless `times` is 2 to 1000, and the same errors as
/// mirror_map().
Pattern alternated(const RobotModel& model, const Pattern& pattern, int times, bool close = true);

/// A pattern and its samples.
struct MotionPart {
  const Pattern& pattern;
  const CommandSeries& series;
};

/// Two motions in sequence as a table of posture and base (COG, ZMP and f_z are those of the full
/// model). The second motion is moved over the ground and turned so that it begins where the feet
/// of the first one stand, with its footholds, keys and scenario. `over` [s] is the time of a
/// transition from rest to rest with both feet still; with 0 there is none, and the postures have
/// to agree within 2e-4 rad. World and controller are those of the first motion. Throws
/// Error(bad_pattern) if a foot is in the air at the join, the feet stand differently (1 mm, 0.01
/// rad) or the legs do not reach the soles, and the same errors as baked().
Pattern joined(const RobotModel& model, const MotionPart& first, const MotionPart& second,
               double over, const std::string& table);

/// Two patterns in sequence as a pattern with keys, while joined() makes a table of samples. Keys,
/// phases and scenario of the second pattern are moved in place and time. At the join, each track
/// of either pattern gets a key with its value. Throws the same errors as joined(), and
/// Error(bad_pattern) with the reason if keys cannot express the joined motion. Such reasons are a
/// table, a correction, VIIP phases, legs that follow keys of joints, a foot that has keys in one
/// pattern and swings in the other, and tracks of COG or ZMP that only one of the patterns has.
Pattern chained(const RobotModel& model, const MotionPart& first, const MotionPart& second,
                double over);

/// Differences between the end of a motion and its beginning, after the beginning has been moved
/// over the ground to the feet.
struct LoopGap {
  double feet = 0;     ///< largest distance of a sole from its place at the beginning [m]
  double posture = 0;  ///< largest difference of a joint [rad, m]
  double base = 0;     ///< difference of the base's place [m]
  double rate = 0;     ///< largest difference of a joint's rate [rad/s, m/s]
  std::string joint;   ///< name of the joint that differs most
  bool closed = false;
};
/// Throws Error(bad_pattern) if a foot is in the air at the beginning or at the end.
LoopGap loop_gap(const RobotModel& model, const MotionPart& motion);
/// The bounds of a closed motion: each of its differences is below the value here, and its soles
/// turn by less than 0.01 rad. `joint` is empty.
LoopGap largest_loop_gap();

struct Ramps {
  /// Duration of the transition at the beginning and at the end [s]; 0 for no transition.
  double in = 1, out = 1;
  std::string posture = "home";
};
/// The motion with transitions from a named posture to its first posture and back at the end, as a
/// table. The feet stay in their places, and the named posture has its COG above their middle.
/// Throws the same errors as joined().
Pattern ramped(const RobotModel& model, const MotionPart& motion, const Ramps& ramps,
               const std::string& table);

}  // namespace ayumi
