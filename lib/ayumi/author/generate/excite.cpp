// Motions that tell the constants of servos apart. Both feet stay, so the trunk moves the legs: up
// and down (hip pitch, knee, ankle pitch), to the sides (hip roll, ankle roll), ahead and back, and
// about the vertical (hip yaw). Other joints move alone. Each motion is a slow sweep, whose turns
// show friction and whose load shows the stiffness, a chirp and quick steps, which tell delay from
// damping.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Time of the slow sweep to one side and of a pause [s]. Chosen: slow enough that nothing but
// friction and weight loads the joint.
constexpr double kSweepTime = 1.0;
constexpr double kPause = 0.3;
// Half periods of the chirp [s] and the time of a step. Chosen: up to 3 Hz, and steps as quick as a
// minimum-jerk curve of some degrees within the speed of small servos allows.
constexpr std::array<double, 6> kChirp = {0.45, 0.35, 0.28, 0.22, 0.18, 0.15};
constexpr double kStepTime = 0.12;
// Amplitudes of the chirp and of the steps in that of the sweep. Chosen: the chirp's acceleration
// then stays about the same at all its frequencies.
constexpr double kStepShare = 0.4;
// Largest angle of joints that move alone, of the trunk's turn [rad], and what is kept from the
// limits of a joint [rad]. Chosen: some thousand counts, without reaching for other links.
constexpr double kJointAngle = 0.25;
constexpr double kTurn = 0.12;
constexpr double kLimitMargin = 0.05;

// Adds the keys of one motion: set(key, share) writes the share -1..1 of its amplitude.
void add_motion(PatternBuilder& writer, double& t,
                const std::function<void(Keyframe&, double)>& set) {
  const auto at = [&](double step, double share) {
    Keyframe key;
    set(key, share);
    writer.add(t += step, key);
  };
  at(kPause, 0);
  at(kSweepTime, 1);
  at(2 * kSweepTime, -1);
  at(kSweepTime, 0);
  double side = 1;
  for (const double half : kChirp) {
    at(half, side * std::pow(half / kChirp[0], 2));
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

// Place of each joint that is not of a leg in its own chain: joints of one place move together.
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

Pattern excite_pattern(const RobotModel& model, double scale) {
  require_range("excite", "scale", scale, 0.01, 2, "");
  Pattern pattern;
  pattern.name = "excitation of every joint";
  pattern.robot = model.name();
  PatternBuilder writer{pattern};
  double t = 0;
  if (model.has_soles()) {
    pattern.cog_height = bent_height(model);
    Pattern standing;
    standing.phases.push_back({1, Support::both, {}});
    const Vector2d middle = FootPlan(model, standing).support_center(0).head<2>();
    const double height = default_cog_height(model, pattern);
    const double depth = scale * squat_defaults(model).depth,
                 side = scale * sway_defaults(model).side;
    Keyframe first;
    first.cog_x = middle.x();
    first.cog_y = middle.y();
    first.cog_height = height;
    first.torso = Vector3d::Zero();
    writer.add(0, first);
    // Down only: the legs may be nearly straight.
    add_motion(writer, t, [&](Keyframe& key, double u) {
      key.cog_height = height - 0.5 * depth * (1 - std::cos(M_PI * std::abs(u)));
    });
    add_motion(writer, t, [&](Keyframe& key, double u) { key.cog_y = middle.y() + side * u; });
    add_motion(writer, t,
               [&](Keyframe& key, double u) { key.cog_x = middle.x() + 0.5 * side * u; });
    add_motion(writer, t,
               [&](Keyframe& key, double u) { key.torso = Vector3d(0, 0, scale * kTurn * u); });
  }
  const Eigen::VectorXd home = model.posture();
  const double margin = kLimitMargin + model.description().soft_limit_margin;
  for (const auto& [place, joints] : other_joints(model)) {
    struct Range {
      std::string joint;
      double center, half;
    };
    std::vector<Range> ranges;
    for (const int j : joints) {
      const Dof& dof = model.dofs()[static_cast<size_t>(j)];
      double half = scale * (dof.prismatic ? 0.01 : kJointAngle), center = home[j];
      if (dof.limited) {
        const double room = 0.5 * (dof.upper - dof.lower) - margin;
        if (room <= 0) continue;
        half = std::min(half, room);
        center = std::clamp(center, dof.lower + margin + half, dof.upper - margin - half);
      }
      ranges.push_back({dof.name, center, half});
    }
    const auto back = [&](double step) {
      Keyframe key;
      for (const Range& r : ranges) key.joints[r.joint] = home[model.find_dof(r.joint)];
      writer.add(t += step, key);
    };
    back(kPause);
    t += kPause;
    add_motion(writer, t, [&](Keyframe& key, double u) {
      for (const Range& r : ranges) key.joints[r.joint] = r.center + r.half * u;
    });
    back(kSweepTime);
  }
  writer.phase(t + kPause, Support::both);
  return pattern;
}

}  // namespace ayumi
