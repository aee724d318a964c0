#pragma once
// The motion that is judged, with its demands, its limits, and the violations that are found.

#include <cmath>
#include <optional>

#include "ayumi/demand/motion_demand.hpp"
#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/limits/flight_moment.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/limits/table_safety.hpp"
#include "ayumi/limits/violation.hpp"

namespace ayumi {

/// Because of rounding, a length that is kept exactly deviates by at most this [m]. Chosen: a
/// thousandth of the smallest tolerance of a length, and far above the rounding of coordinates of
/// metres (1e-15). No measured case changes between half and twice the value (constants.md).
inline constexpr double kRounding = 1e-7;

/// Violations of one kind and item that are nearer to each other than this are one finding [s].
/// Chosen: 20 samples at 1 kHz, so that a figure that oscillates about its limit is one finding,
/// and two steps are two. With half of the value, the check of the case "jolt" finds 3 warnings of
/// yaw_moment instead of 2; with twice, the check of the case "arm" finds 1 error of joint_speed
/// instead of 2.
inline constexpr double kWindowGap = 0.020;

/// The values that the limit of motor heat keeps from sample to sample.
struct Heat {
  struct Largest {
    double share = 0;  ///< largest share of the limit
    int sample = -1;   ///< sample of this value; -1 if there is none yet
  };
  /// Sums of the squared torques before a sample, by dof, in a ring as long as the thermal window.
  Eigen::MatrixXd square_sum = {};
  std::vector<Largest> largest = {};  ///< largest values, by dof
};

struct JudgedMotion {
  JudgedMotion(const RobotModel& model, const CommandSeries& series, const CheckOptions& options);
  JudgedMotion(const JudgedMotion&) = delete;
  JudgedMotion& operator=(const JudgedMotion&) = delete;

  int count() const { return static_cast<int>(series.samples.size()); }
  double tolerance(FindingKind kind) const { return tolerance_of[kind]; }
  /// The place of sample k in swing_poses; null while this foot is in contact.
  Eigen::Isometry3d* pose_in_swing(Side side, int k);
  bool flies(int k) const {
    return k >= 0 && k < count() && series.samples[k].support == Support::none;
  }
  /// Whether the sample is in flight and so far from its beginning and end that its rates do not
  /// mix flight and support.
  bool flies_freely(int k) const { return ayumi::flies_freely(series, k); }
  /// See at_flight_edge() of demand/contact_plan.hpp.
  bool at_flight_edge(int k) const { return ayumi::at_flight_edge(series, k); }

  /// Records a violation. `size` orders the samples of a finding, and `detail` is stored with it.
  void add(FindingKind kind, int item, int sample, double value, double limit, double size,
           int detail = 0, Severity severity = Severity::error) {
    windows.add({kind, item, sample, severity, value, limit, size, detail});
  }
  /// Records a value of a figure of the summary; only the largest (or smallest) is kept. `item` and
  /// `detail` are those of a violation there.
  void raise(FindingKind kind, double value, int sample, int item = 0, int detail = 0) {
    if (value > summary[kind]) note(kind, value, sample, item, detail);
  }
  void lower(FindingKind kind, double value, int sample, int item = 0, int detail = 0) {
    if (value < summary[kind]) note(kind, value, sample, item, detail);
  }
  /// The place of the figure's value. Its sample is -1 if no value was recorded.
  const Violation& extreme(FindingKind kind) const { return extremes_[kind]; }

  const RobotModel& model;
  const CommandSeries& series;
  const Tolerances tolerance_of;
  const double friction;  ///< coefficient of friction
  const bool degrees;     ///< whether texts have angles in degrees
  const ActuatorLimits& limits;
  const ContactPlan plan;
  const CollisionModel collisions;
  MotionDynamics dynamics;
  const double weight;  ///< weight of the robot [N]

  FindingWindows windows;
  FindingWindows table;  ///< violations of the table that a robot would receive
  CheckSummary summary;

  // Demands of the samples, if limits of the whole motion or attribution need them.
  Heat heat;
  /// Moment about the COG, by sample; 0 on the ground [N m].
  std::vector<Eigen::Vector3d> flight_moment;
  std::vector<Eigen::Vector3d> cog;  ///< COG of the posture, by sample [m]
  /// Distance of the posture's COG from the command, by sample [m].
  std::vector<double> cog_deviation;
  /// Errors by Side and sample; a swing only has the depth.
  std::array<std::vector<SoleError>, 2> soles;
  /// Poses of the swinging soles in the world, by Side, contact interval and sample of the
  /// interval; none for intervals in contact.
  std::array<std::vector<std::vector<Eigen::Isometry3d>>, 2> swing_poses;
  std::vector<char> rough;  ///< whether a joint accelerates beyond the tolerance, by sample

  // Filled by look_ahead of the limit that uses it.
  std::optional<SafetyReport> safety;  ///< report on the table that a robot would receive
  struct Clearance {
    int pair, sample;
    double value;  ///< clearance [m]
  };
  std::vector<Clearance> clearances;

 private:
  void note(FindingKind kind, double value, int sample, int item, int detail) {
    summary[kind] = value;
    extremes_[kind] = {kind, item, sample, Severity::info, value, 0, 0, detail};
  }
  ByFindingKind<Violation> extremes_;
};

/// One sample of the motion.
struct JudgedSample {
  int k = 0;
  const CommandSample& command;
  const SampleDynamics& demand;
  const SupportPlane& plane;  ///< empty in flight
  /// False next to the beginning or end of a flight, where accelerations mix support and flight, so
  /// that forces have no meaning.
  bool known = true;

  bool flies() const { return plane.empty(); }  ///< whether no foot supports
  bool stands() const { return known && !flies(); }
  bool has_zmp() const { return stands() && demand.use.has_zmp; }
};

/// The axis along which a vector is largest.
int largest_axis(const Eigen::Vector3d& v);

/// Records the size of a difference that should vanish as a figure. If the size exceeds `allowance`
/// times the tolerance, it also adds a violation. The detail of both is the axis with the largest
/// component.
void judge_difference(JudgedMotion& motion, FindingKind kind, int sample,
                      const Eigen::Vector3d& difference, Severity severity = Severity::error,
                      int item = 0, double allowance = 1);

/// Whether the whole flight is free within `limit` [m/s^2] if it is played at this pace. A flight
/// is only free at one pace. So several samples are tested: the acceleration of a single sample can
/// always be scaled to gravity.
bool flight_is_free(JudgedMotion& motion, int sample, double pace, double limit);

// The following functions name places that several limits use.

/// The axis or the support that the detail of the violation names.
Place axis_place(const JudgedMotion&, const Violation&);
Place support_place(const JudgedMotion&, const Violation&);
/// The foot or the joint that the item of the violation names.
Place foot_place(const JudgedMotion&, const Violation&);
Place joint_place(const JudgedMotion&, const Violation&);
std::string where_text(const RobotModel& model, const Place& place);
const char* axis_name(int axis);
/// The unit `rotary`, or the other unit if the joint (the item) is prismatic.
const char* joint_unit(const JudgedMotion&, const Violation&, const char* rotary,
                       const char* prismatic);
std::string in_mm(double metres);  ///< a length without its sign, such as "12.0 mm"
/// An angle without its sign, such as "3.08 deg"; in rad, it has two more digits.
std::string angle_size(double radians, bool degrees, int digits = 2);
std::string ratio_text(double ratio);  ///< a ratio rounded up to 0.01, such as "1.04"
/// Advice such as "stretch the window around the worst time to 1.04 times its length".
std::string slow_down_text(double factor);
/// The example ", for example by straightening the leg" for joints whose load it reduces: the
/// joints of a leg that turn about the lateral axis in the rest posture; empty for other joints.
std::string straighter_leg(const RobotModel& model, int dof);
inline constexpr const char* kOrRepair = ", or use `ayumi repair`";

}  // namespace ayumi
