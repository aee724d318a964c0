#pragma once
// Contacts of a motion that has joint angles only: the supporting feet over time, their places, and
// from these the place of the robot.

#include <string>
#include <vector>

#include "ayumi/base/bounds.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// If no sole is at rest in a motion with a base, these three thresholds decide whether a foot
/// carries the robot, because recorded soles hover, slide and tilt.
struct ContactThresholds {
  /// Bounds of the thresholds. Chosen: a foot that is 0.2 m high, moves at 5 m/s or carries twice
  /// the weight is in no doubt.
  static constexpr Bounds kHeight = {0, 0.2, "m"}, kSpeed = {0, 5, "m/s"},
                          kLoad = {0, 2, "times the weight"};

  /// Largest height of a sole above the lowest height that any sole has in the half second before
  /// and after [m]. Chosen: soles of retargeted dances hover 4 to 10 mm; swings lift them by more
  /// than 15 mm.
  double height = 0.012;
  /// Largest speed of the sole [m/s]. Chosen: a tenth of the speed of a quick swing (1.5 m/s).
  double speed = 0.15;
  /// Smallest vertical force that the motion of the COG needs, as a multiple of the weight. Chosen:
  /// 0 is flight and 1 is rest; recordings at 30 rows per second give this force with an error of
  /// about 0.2.
  double load = 0.3;
};

/// The content of a file of recorded or commanded angles.
struct RawMotion {
  double dt = 0.001;                      ///< time between rows [s]
  Eigen::MatrixXd theta;                  ///< rows x dof, the robot's order [rad]
  std::vector<BasePose> base;             ///< empty or one for each row
  std::vector<Eigen::Vector3d> cog, zmp;  ///< places in the world [m], one for each row or none
  std::vector<double> fz;                 ///< vertical force, empty or one for each row [N]
  std::vector<Support> support;    ///< support, one for each row; empty if it is to be detected
  ContactThresholds contact = {};  ///< thresholds of the detection
};

/// The supporting feet in each row. Feet on the ground do not move relative to each other. Both
/// feet support the robot while their relative speed is below 2 cm/s and their heights differ by
/// less than 3 mm. Otherwise, only the foot that is lower as seen from the other foot supports it.
/// If the supporting foot changes without a phase in which both are at rest, both support the robot
/// as long as they do not move apart along the ground (4 cm/s) or by more than 1 cm in height. In a
/// motion with a base, a sole supports the robot if it is at rest and at most 3 mm above the lowest
/// height that any sole has. In rows without such a sole, the thresholds of the motion decide by
/// height, speed and load; rows where they find no sole either are flight. Intervals shorter than
/// 20 ms belong to their neighbours. A contact begins when the foot comes to rest after a swing,
/// and it ends when the next swing of this foot begins.
std::vector<Support> detect_supports(const RobotModel& model, const RawMotion& motion);

/// One foot on the ground.
struct FootContact {
  Side foot = Side::left;
  double begin = 0, end = 0;  ///< beginning and end of the contact [s]
  Foothold place;
};

/// The motion as a pattern with a table named `table`: phases, level footholds and swings. If the
/// motion has no base, the base follows from the footholds. In double support, it changes from one
/// foot to the other by minimum jerk. Soles that are not exactly level leave a range for
/// the base; in this range it is where the ZMP leaves the support least. The motion starts with the
/// feet at the origin and the heading along x.
struct GroundedMotion {
  Pattern pattern;
  std::vector<FootContact> contacts;  ///< contacts in the order in which they begin
  /// Remarks in words: how far the soles float, sink and slide, and when the motion flies; without
  /// a base, how far the feet are from level.
  std::vector<std::string> notes = {};
};
/// Throws Error(bad_model) without soles, Error(bad_pattern) for fewer than 6 rows.
GroundedMotion grounded(const RobotModel& model, const RawMotion& motion, const std::string& table);

/// The motion with its base moved up and down, so that the lowest supporting sole is at height 0;
/// between contacts, the shift is interpolated linearly. A motion without a base is returned as it
/// is.
RawMotion put_on_ground(const RobotModel& model, RawMotion motion);

/// Ends at which the motion was cut while the robot moved.
struct CutEnds {
  bool begin = false, end = false;
  std::vector<std::string> words = {};  ///< one line for each end, with the fastest joint
};
CutEnds cut_ends(const RobotModel& model, const RawMotion& motion);

/// The motion, changed so that it begins and ends at rest. If its beginning was cut while the robot
/// moved, it is played slowly at first and reaches its own speed (by minimum jerk) after `seconds`
/// [s]. If its end was cut, it slows down correspondingly. Its path over the ground stays, so that
/// no foot slides; every end takes seconds/2 longer. All other rows keep their bits. ZMP and
/// vertical force are dropped, because they change. Throws Error(bad_pattern) when the motion is
/// too short.
RawMotion with_ramps(const RobotModel& model, RawMotion motion, double seconds);

}  // namespace ayumi
