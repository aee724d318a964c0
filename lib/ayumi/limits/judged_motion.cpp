#include "ayumi/limits/judged_motion.hpp"

#include <limits>

#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector3d;

JudgedMotion::JudgedMotion(const RobotModel& model, const CommandSeries& series,
                           const CheckOptions& options)
    : model(model),
      series(series),
      tolerance_of(tolerances(options, model, series)),
      friction(options.friction),
      degrees(options.degrees),
      limits(model.limits(options.profile)),
      plan(contact_plan(series)),
      collisions(model),
      dynamics(model, limits, series, plan),
      weight(model.mass() * kGravity),
      windows(static_cast<int>(std::lround(kWindowGap / series.dt))),
      table(static_cast<int>(std::lround(kWindowGap / series.dt))),
      flight_moment(count(), Vector3d::Zero()),
      cog(count(), Vector3d::Zero()),
      cog_deviation(count(), 0.0),
      soles{std::vector<SoleError>(count()), std::vector<SoleError>(count())},
      rough(count(), 0) {
  for (int foot = 0; foot < 2; ++foot)
    for (const ContactInterval& interval : plan.intervals[foot])
      swing_poses[foot].emplace_back(interval.contact ? 0 : interval.last - interval.first + 1);
  for (Violation& extreme : extremes_) extreme.sample = -1;
  for (const FindingSpec* spec : summary_figures())
    if (spec->figure.least) summary[spec->kind] = std::numeric_limits<double>::infinity();
}

Eigen::Isometry3d* JudgedMotion::pose_in_swing(Side side, int k) {
  const int foot = static_cast<int>(side), i = plan.index[foot][k];
  if (plan.intervals[foot][i].contact) return nullptr;
  return &swing_poses[foot][i][k - plan.intervals[foot][i].first];
}

int largest_axis(const Vector3d& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return axis;
}

void judge_difference(JudgedMotion& motion, FindingKind kind, int sample,
                      const Vector3d& difference, Severity severity, int item, double allowance) {
  const double size = difference.norm();
  motion.raise(kind, size, sample, item, largest_axis(difference));
  const double limit = allowance * motion.tolerance(kind);
  if (size > limit)
    motion.add(kind, item, sample, size, limit, size, largest_axis(difference), severity);
}

bool flight_is_free(JudgedMotion& motion, int sample, double pace, double limit) {
  // Number of samples that are tested in addition. Chosen: both ends and three between them. No
  // measured case changes between half and twice the value (constants.md).
  constexpr int kLooks = 5;
  int first = sample, last = sample;
  while (motion.flies_freely(first - 1)) --first;
  while (motion.flies_freely(last + 1)) ++last;
  for (int n = 0; n <= kLooks; ++n) {
    const int k = n == kLooks ? sample : first + n * (last - first) / (kLooks - 1);
    const Vector3d ddcog = motion.dynamics.at(k, pace).ddcog;
    if ((ddcog + Vector3d(0, 0, kGravity)).norm() > limit) return false;
  }
  return true;
}

Place axis_place(const JudgedMotion&, const Violation& v) { return AxisPlace{v.detail}; }
Place support_place(const JudgedMotion&, const Violation& v) {
  return SupportPlace{static_cast<Support>(v.detail)};
}
Place foot_place(const JudgedMotion&, const Violation& v) { return FootPlace{foot_of(v)}; }
Place joint_place(const JudgedMotion&, const Violation& v) { return JointPlace{v.item}; }

std::string where_text(const RobotModel& model, const Place& place) {
  struct Words {
    const RobotModel& model;
    std::string operator()(std::monostate) const { return ""; }
    std::string operator()(const JointPlace& p) const { return model.dofs()[p.dof].name; }
    std::string operator()(const FootPlace& p) const { return name_of(p.side); }
    std::string operator()(const AxisPlace& p) const { return axis_name(p.axis); }
    std::string operator()(const SupportPlace& p) const { return name_of(p.support); }
    std::string operator()(const BodyPairPlace& p) const {
      return model.bodies()[p.a].name + " - " + model.bodies()[p.b].name;
    }
  };
  return std::visit(Words{model}, place);
}

const char* axis_name(int axis) { return axis == 0 ? "x" : axis == 1 ? "y" : "z"; }

const char* joint_unit(const JudgedMotion& motion, const Violation& v, const char* rotary,
                       const char* prismatic) {
  return motion.model.dofs()[v.item].prismatic ? prismatic : rotary;
}

std::string in_mm(double metres) { return text::fixed(1000 * std::abs(metres), 1) + " mm"; }

std::string angle_size(double radians, bool degrees, int digits) {
  const double size = std::abs(radians);
  return degrees ? text::fixed(size * 180 / EIGEN_PI, digits) + " deg"
                 : text::fixed(size, digits + 2) + " rad";
}

std::string ratio_text(double ratio) { return text::fixed(std::ceil(100 * ratio - 1e-9) / 100, 2); }

std::string slow_down_text(double factor) {
  return "stretch the window around the worst time to " +
         text::fixed(std::ceil(100 * factor) / 100, 2) + " times its length";
}

std::string straighter_leg(const RobotModel& model, int dof) {
  if (model.dofs()[dof].prismatic || !model.is_leg_joint(dof)) return "";
  RobotData data(model);
  update_positions(model, model.rest_state(), data);
  int direction = 0;
  data.axis[model.dofs()[dof].body].cwiseAbs().maxCoeff(&direction);
  return direction == 1 ? ", for example by straightening the leg" : "";
}

}  // namespace ayumi
