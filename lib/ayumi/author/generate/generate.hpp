#pragma once
// Generators of patterns, which a person can edit afterwards: `ayumi new walk`, `step`, `stand`,
// `sway`, `squat`, `sit`, `rise`, `bow`, `wave`, `kick`, `march`, `turn`, `jump`, `excite`.

#include "ayumi/motion/pattern.hpp"

namespace ayumi {

struct WalkParameters {
  int steps = 8;                 ///< steps that move the robot; one more brings the feet together
  double stride = 0.03;          ///< forward distance between successive footholds [m]
  double period = 0.55;          ///< duration of one step, single and double support together [s]
  double double_support = 0.18;  ///< double support as a fraction of the period
  double lift = 0.015;           ///< height to which the swing sole is lifted [m]
  /// Height of the COG [m]; 0 for that of the home posture, or less if its legs are straight.
  double cog_height = 0;
  double turn = 0;  ///< yaw change per step, left positive [rad]
  double side = 0;  ///< sideways distance per pair of steps, left positive [m]
  /// Height of a stair [m]; if it is not 0, every stride leads to the next stair, the other foot
  /// follows onto the same stair, and the pattern's world contains the stairs.
  double rise = 0;
  /// Distance by which the ZMP is moved from the middle of the standing sole towards the other
  /// foot, so that the COG sways less [m].
  double zmp_inwards = 0;
  Side first_swing = Side::right;
};

/// The walk of HOAP-1 scaled to a robot: lengths by the ratio of the home COG heights, times by the
/// root of this ratio.
WalkParameters walk_defaults(const RobotModel& model);

/// The shortest period [s] and the lowest lift [m] that walk_pattern() accepts for a robot.
struct WalkLimits {
  double period = 0, lift = 0;
};
WalkLimits walk_limits(const RobotModel& model);

/// Defaults for a staircase with stairs of the height `rise` [m]: stairs slightly longer than the
/// sole, a lower COG, slower and higher steps.
WalkParameters stair_defaults(const RobotModel& model, double rise);

/// Phases, ZMP keys and swing targets of a straight or turning walk that starts and ends at rest.
/// Throws Error(usage) that names the parameter out of range.
Pattern walk_pattern(const RobotModel& model, const WalkParameters& parameters);

/// Both feet are on the ground in the home posture for `duration` [s]. If `cog_height` is 0,
/// starting_height() is used [m].
Pattern stand_pattern(const RobotModel& model, double duration, double cog_height = 0);

/// The COG moves from side to side, or forward and back, over both feet; every part starts and ends
/// at rest.
struct SwayParameters {
  double side = 0.02;   ///< distance to either side of the middle [m]
  double forward = 0;   ///< distance to the front and back of the middle [m]
  double period = 2.0;  ///< duration of one movement there and back [s]
  int cycles = 2;
  double cog_height = 0;  ///< height of the COG; 0 for starting_height() [m]
};
SwayParameters sway_defaults(const RobotModel& model);

/// The pattern has COG keys: the middle, left (front), right (back), the middle. Throws the same
/// errors as walk_pattern.
Pattern sway_pattern(const RobotModel& model, const SwayParameters& parameters);

/// Half of the width of the narrower sole [m].
double half_sole_width(const RobotModel& model);

/// COG height at which generated patterns begin [m]: that of the home posture, or less if its legs
/// are straight.
double starting_height(const RobotModel& model);

/// The COG moves down and up over both feet.
struct SquatParameters {
  double depth = 0.03;  ///< depth below the home posture's COG [m]
  double period = 2.0;  ///< duration of one cycle without the hold [s]
  double hold = 0.3;    ///< time at the lowest point [s]
  int cycles = 2;
  double cog_height = 0;  ///< height of the COG at the top; 0 for starting_height() [m]
};
SquatParameters squat_defaults(const RobotModel& model);

/// The pattern has keys of the COG height; the horizontal COG is solved. Throws the same errors as
/// walk_pattern.
Pattern squat_pattern(const RobotModel& model, const SquatParameters& parameters);

/// The COG goes down as if to sit on a seat and stays there, or comes up from there. The trunk
/// leans forward and comes back during this time.
struct SeatParameters {
  double depth = 0.05;    ///< depth below the standing COG [m]
  double lean = 0.35;     ///< lean of the trunk half-way [rad]
  double period = 1.5;    ///< duration of the motion [s]
  double cog_height = 0;  ///< height of the standing COG; 0 for starting_height() [m]
};
SeatParameters seat_defaults(const RobotModel& model);
Pattern sit_pattern(const RobotModel& model, const SeatParameters& parameters);
Pattern rise_pattern(const RobotModel& model, const SeatParameters& parameters);

/// The trunk leans forward and comes back. The COG goes down by as much as it does when only the
/// trunk moves.
struct BowParameters {
  double angle = 0.5;     ///< angle by which the trunk leans [rad]
  double period = 2.4;    ///< duration of both movements without the hold [s]
  double hold = 0.5;      ///< time at the lowest point [s]
  double cog_height = 0;  ///< height of the standing COG; 0 for starting_height() [m]
};
BowParameters bow_defaults(const RobotModel& model);
Pattern bow_pattern(const RobotModel& model, const BowParameters& parameters);

/// A hand is raised beside the head, waves, and comes back.
struct WaveParameters {
  Side side = Side::right;
  int cycles = 3;
  double period = 0.6;    ///< duration of one movement there and back [s]
  double cog_height = 0;  ///< height of the COG; 0 for starting_height() [m]
};
WaveParameters wave_defaults(const RobotModel& model);
/// Throws the same errors as walk_pattern, and also if no arm of three joints reaches beside the
/// head.
Pattern wave_pattern(const RobotModel& model, const WaveParameters& parameters);

/// While the robot stands on one foot, the other foot goes back, kicks forward and comes back to
/// its place.
struct KickParameters {
  Side side = Side::right;
  double length = 0.04;   ///< distance of the kick ahead of the foot's place [m]
  double height = 0.03;   ///< height of the foot above the ground when it kicks [m]
  double period = 1.6;    ///< duration of the swing [s]
  double cog_height = 0;  ///< height of the COG; 0 for kick_cog_height() [m]
};
KickParameters kick_defaults(const RobotModel& model);
/// The COG height with which a kick to this height of the foot begins, if none is given [m]. It is
/// below starting_height(), because the COG rises by half of the foot's height.
double kick_cog_height(const RobotModel& model, double height);
Pattern kick_pattern(const RobotModel& model, const KickParameters& parameters);

/// Parts of an excitation. In all parts but the last, the robot stands on one foot and then on the
/// other; in the last, it stands on both feet and moves the joints outside the legs.
enum class ExcitePart { squat, sway_ahead, sway_aside, swing_ahead, swing_aside, other_joints };
const std::vector<ExcitePart>& excite_parts();  ///< all parts, in the order of the motion
const char* name_of(ExcitePart part);           ///< such as "the squat on one foot"

/// Slow sweeps, chirps and steps of every joint within its limits, from which `identify` can
/// distinguish the constants of the servos. `scale` is a factor on all amplitudes, `stature` a
/// factor on the COG height. Throws the same errors as walk_pattern.
Pattern excite_pattern(const RobotModel& model, double scale = 1, double stature = 1,
                       const std::vector<ExcitePart>& parts = excite_parts());

/// A jump has a stoop, lift-off, flight, touchdown and settling; with `times` jumps there is no
/// rest between them.
struct JumpParameters {
  double height = 0.03;  ///< rise of the COG above ref z_G, its height at lift-off and landing [m]
  double stoop = 0.03;   ///< depth of the COG below ref z_G before and after a flight [m]
  double cog_height = 0.22;  ///< ref z_G above the soles [m]
  double forward = 0;        ///< length of each jump [m]
  int times = 1;
};
JumpParameters jump_defaults(const RobotModel& model);

/// The pattern has keys of the COG height at the lowest points, at lift-off and at touchdown, and
/// foot keys for a jump forward; the flight is the parabola. Throws the same errors as
/// walk_pattern, and also if no push within the stoop reaches the height.
Pattern jump_pattern(const RobotModel& model, const JumpParameters& parameters);

}  // namespace ayumi
