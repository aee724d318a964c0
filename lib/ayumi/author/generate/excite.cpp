// Motions from which the constants of servos can be identified separately. The robot stands on one
// foot, because two feet may press against each other with forces that no sensor measures. The
// supporting leg carries the weight in slow sweeps: up and down, to the sides, forward and back.
// The other leg moves its foot in the air: slow sweeps, whose turning points show friction, then a
// chirp and quick steps, which distinguish delay from damping. Joints that do not belong to a leg
// make such motions separately, while the robot stands on both feet.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Time of the slow sweep to one side and of a pause [s]. Chosen: slow enough that nothing but
// friction and weight loads the joint.
constexpr double kSweepTime = 0.7;
constexpr double kPause = 0.2;
// Time in which the weight moves from both feet to one foot, and in which a foot is lifted [s].
// Chosen: as in a slow walk.
constexpr double kShiftTime = 1.2, kLiftTime = 0.5;
// Rest on both feet between two times on one foot [s]. Chosen: the motors then stay within the
// torque that they can hold for a long time.
constexpr double kRestTime = 2.2;
// Half periods of the chirp [s] and the time of a step. Chosen: the chirp goes up to 6 Hz, and a
// step is as quick as the speed of small servos allows for a minimum-jerk curve of a few degrees.
constexpr std::array<double, 8> kChirp = {0.45, 0.35, 0.28, 0.22, 0.18, 0.15, 0.11, 0.08};
constexpr double kStepTime = 0.07;
// Amplitude of the steps as a share of the amplitude of the sweep. Chosen: a joint then reaches
// half of the speed of small servos. The chirp has about the same acceleration at all its
// frequencies.
constexpr double kStepShare = 0.33;
// Largest angle of joints outside the legs, and largest angle of the foot in the air about each
// axis [rad]. Chosen: a few thousand counts, without reaching other links.
constexpr double kJointAngle = 0.25;
constexpr double kFootAngle = 0.1;
// Roll of the foot in the air while its leg leans, with the outer edge up [rad], and the distance
// that joints keep from their limits [rad]. Chosen: the roll is half of the lean that puts the
// weight of the robot on one foot, so that the ankle stays within its range.
constexpr double kFootLean = 0.17;
constexpr double kLimitMargin = 0.05;
// Distances by which the foot in the air moves forward, sideways and up, and the height to which it
// is lifted, for HOAP-1 [m]. Chosen: it does not touch the other leg or the ground.
constexpr double kAhead = 0.02, kAside = 0.012, kUp = 0.012, kLift = 0.03;
// Share of the sole over which the ZMP sweeps, and depth of the squat on one leg as a share of the
// depth of a squat on both. Chosen: about half, because the other half is needed against
// disturbances.
constexpr double kSoleShare = 0.4, kDepthShare = 0.5;

using SetKey = std::function<void(Keyframe&, double)>;

// Writes keys one after the other: set(key, share) writes the share -1..1 of an amplitude.
class Motion {
 public:
  Motion(PatternBuilder& writer, double& t, SetKey set)
      : writer_(writer), t_(t), set_(std::move(set)) {}
  void at(double step, double share) {
    Keyframe key;
    set_(key, share);
    writer_.add(t_ += step, key);
  }
  void sweep() {
    at(kPause, 0);
    at(kSweepTime, 1);
    at(2 * kSweepTime, -1);
    at(kSweepTime, 0);
  }
  void chirp_and_steps() {
    double side = 1;
    for (const double half : kChirp) {
      at(half, side * elementary::power<2>(half / kChirp[0]));
      side = -side;
    }
    at(kChirp.back(), 0);
    double last = 0;
    for (const double share : {kStepShare, 0.0, -kStepShare, 0.0}) {
      at(kPause, last);
      at(kStepTime, share);
      last = share;
    }
    at(kPause, 0);
  }

 private:
  PatternBuilder& writer_;
  double& t_;
  SetKey set_;
};

// The robot stands on the foot `side`, and then on both feet again. While the supporting leg makes
// slow sweeps, the foot in the air makes slow sweeps, too; only this foot makes chirps and steps.
// Each of these motions is short, so that no motor gets hot.
void add_stand_on(const RobotModel& model, PatternBuilder& writer, double& t, Side side,
                  ExcitePart what, double height, double scale) {
  Pattern standing;
  standing.phases.push_back({1, Support::both, {}});
  const FootPlan feet(model, standing);
  const Side other = side == Side::left ? Side::right : Side::left;
  const Eigen::Isometry3d pose = feet.pose(other, 0);
  const double yaw = matrix_to_rpy(pose.linear()).z();
  const Vector2d center = feet.sole_center(side, 0).head<2>();
  const auto foot = [&](Keyframe& key, const Vector3d& moved, const Vector3d& turned) {
    key.feet[static_cast<size_t>(other)] =
        Foothold{pose.translation() + moved, Vector3d(0, 0, yaw) + turned};
  };
  const auto zmp = [](Keyframe& key, const Vector2d& point) {
    key.zmp = ZmpKey{ZmpKey::Place::point, point};
  };
  const double size = size_beside_hoap1(model), out = other == Side::left ? 1 : -1;
  const Vector3d lifted(0, 0, size * kLift), none = Vector3d::Zero(), lean(out * kFootLean, 0, 0);
  Keyframe first;
  zmp(first, feet.support_center(0).head<2>());
  foot(first, none, none);
  first.cog_height = height;
  first.torso = Vector3d::Zero();
  writer.add(t > 0 ? t += kRestTime : t, first);
  Keyframe over = first;
  zmp(over, center);
  writer.add(t += kShiftTime, over);
  writer.phase(t - writer.t, Support::both);
  Keyframe up = over;
  foot(up, lifted, lean);
  writer.add(t += kLiftTime, up);

  Vector2d half = Vector2d::Constant(HUGE_VAL);
  for (const Vector2d& corner : model.sole(side).polygon)
    half = half.cwiseMin((corner - model.sole(side).center).cwiseAbs());
  const double depth = kDepthShare * scale * squat_defaults(model).depth,
               angle = scale * kFootAngle;
  const bool ahead = what == ExcitePart::squat || what == ExcitePart::swing_ahead;
  const Vector3d moved = scale * size * (ahead ? Vector3d(kAhead, 0, kUp) : Vector3d(0, kAside, 0)),
                 turned = angle * (ahead ? Vector3d(0, 1, 0) : Vector3d(1, 0, 1));
  Motion motion(writer, t, [&](Keyframe& key, double u) {
    foot(key, lifted + u * moved, lean + u * turned);
    Vector2d point = center;
    if (what == ExcitePart::sway_ahead) point.x() += kSoleShare * scale * half.x() * u;
    if (what == ExcitePart::sway_aside) point.y() += kSoleShare * scale * half.y() * u;
    zmp(key, point);
    // The squat goes only downwards, because the legs may be nearly straight.
    const double down =
        what == ExcitePart::squat ? 0.5 * (1 - elementary::cos(M_PI * std::abs(u))) : 0.0;
    key.cog_height = height - depth * down;
  });
  if (what == ExcitePart::swing_ahead || what == ExcitePart::swing_aside)
    motion.chirp_and_steps();
  else
    motion.sweep();
  writer.add(t += kLiftTime, over);
  writer.phase(t - writer.t, side == Side::left ? Support::left : Support::right);
  writer.add(t += kShiftTime, first);
}

// The joints that do not belong to a leg, sorted by the number of joints from the root to them.
// Joints with the same number move together.
std::map<int, std::vector<int>> other_joints(const RobotModel& model) {
  std::map<int, std::vector<int>> by_place;
  for (int j = 0; j < model.dof_count(); ++j) {
    if (model.has_soles()) {
      const auto& left = model.leg(Side::left);
      const auto& right = model.leg(Side::right);
      if (std::find(left.begin(), left.end(), j) != left.end() ||
          std::find(right.begin(), right.end(), j) != right.end())
        continue;
    }
    int place = 0;
    for (int body = model.dofs()[static_cast<size_t>(j)].body; body > 0;
         body = model.bodies()[static_cast<size_t>(body)].parent)
      ++place;
    by_place[place].push_back(j);
  }
  return by_place;
}

}  // namespace

const std::vector<ExcitePart>& excite_parts() {
  static const std::vector<ExcitePart> all = {ExcitePart::squat,       ExcitePart::sway_ahead,
                                              ExcitePart::sway_aside,  ExcitePart::swing_ahead,
                                              ExcitePart::swing_aside, ExcitePart::other_joints};
  return all;
}

const char* name_of(ExcitePart part) {
  switch (part) {
    case ExcitePart::squat:
      return "the squat on one foot";
    case ExcitePart::sway_ahead:
      return "the sway forward and back on one foot";
    case ExcitePart::sway_aside:
      return "the sway to the sides on one foot";
    case ExcitePart::swing_ahead:
      return "the swing of a leg forward and back";
    case ExcitePart::swing_aside:
      return "the swing of a leg to the sides";
    case ExcitePart::other_joints:
      break;
  }
  return "the motion of the joints outside the legs";
}

Pattern excite_pattern(const RobotModel& model, double scale, double stature,
                       const std::vector<ExcitePart>& parts) {
  require_range("excite", "scale", scale, 0.01, 2, "");
  Pattern pattern;
  pattern.name = "excitation of every joint";
  pattern.robot = model.name();
  PatternBuilder writer{pattern};
  double t = 0;
  if (model.has_soles()) {
    pattern.cog_height = bent_height(model);
    if (stature != 1)
      pattern.cog_height = to_tenth_millimetre(stature * default_cog_height(model, pattern));
    const double height = default_cog_height(model, pattern);
    for (const ExcitePart part : parts)
      for (const Side side : {Side::left, Side::right})
        if (part != ExcitePart::other_joints)
          add_stand_on(model, writer, t, side, part, height, scale);
  }
  const Eigen::VectorXd home = model.posture();
  const double margin = kLimitMargin + model.description().soft_limit_margin;
  std::map<int, std::vector<int>> others;
  if (std::find(parts.begin(), parts.end(), ExcitePart::other_joints) != parts.end())
    others = other_joints(model);
  for (const auto& [place, joints] : others) {
    struct Range {
      std::string joint;
      double center, half, rest;
    };
    std::vector<Range> ranges;
    for (const int j : joints) {
      const Dof& dof = model.dofs()[static_cast<size_t>(j)];
      double half = scale * (dof.prismatic ? 0.01 : kJointAngle), center = home[j], rest = home[j];
      if (dof.limited) {
        const double room = 0.5 * (dof.upper - dof.lower) - margin;
        if (room <= 0) continue;
        half = std::min(half, room);
        center = std::clamp(center, dof.lower + margin + half, dof.upper - margin - half);
      }
      // A joint that comes back to its limit would need a servo target beyond this limit.
      if (dof.limited) rest = std::clamp(rest, dof.lower + margin, dof.upper - margin);
      ranges.push_back({dof.name, center, half, rest});
    }
    const auto back = [&](double step) {
      Keyframe key;
      for (const Range& r : ranges) key.joints[r.joint] = r.rest;
      writer.add(t += step, key);
    };
    back(kPause);
    t += kPause;
    Motion motion(writer, t, [&](Keyframe& key, double u) {
      for (const Range& r : ranges) key.joints[r.joint] = r.center + r.half * u;
    });
    motion.sweep();
    motion.chirp_and_steps();
    back(kSweepTime);
  }
  writer.phase(t + kPause - writer.t, Support::both);
  return pattern;
}

}  // namespace ayumi
