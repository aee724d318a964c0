#include "ayumi/check/hypotheses/room_hypotheses.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/generate/generate.hpp"
#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/motion/pattern_context.hpp"

namespace ayumi::hypotheses {

namespace {

constexpr double kDegree = EIGEN_PI / 180;  // Definition: one degree [rad]
// Angles by which the arms are held farther outwards [rad]. Chosen: an elbow at a length of 0.1 m
// then moves by 17 to 70 mm, from a narrow gap to an arm that is clear of every thigh.
constexpr double kAside[] = {10 * kDegree, 20 * kDegree, 30 * kDegree, 45 * kDegree};
// Angle with which the joint that moves an arm outwards is found [rad]. Chosen: small enough for
// the direction in the given posture, and large against rounding.
constexpr double kProbe = 0.05;
// Shares of half the width of a sole by which the ZMP moves towards the other foot. Chosen: the
// last one leaves a tenth of this half as the margin of the ZMP.
constexpr double kNearer[] = {0.25, 0.5, 0.7, 0.9};
// Number of keys that a message lists. Chosen: more would hide the values.
constexpr size_t kListed = 3;

/// A joint and its mirror image, and the signs of the turns that move the arms outwards.
struct ArmPair {
  int first = -1, second = -1;
  double first_sign = 0, second_sign = 0;
};

/// Whether a body is moved by one of these joints.
bool is_carried(const RobotModel& model, int body, int first, int second) {
  for (; body >= 0; body = model.bodies()[static_cast<size_t>(body)].parent) {
    const int dof = model.bodies()[static_cast<size_t>(body)].dof;
    if (dof >= 0 && (dof == first || dof == second)) return true;
  }
  return false;
}

/// Distance of the bodies that a joint carries from the plane between left and right, weighted by
/// their masses [kg m].
double spread(const RobotModel& model, int dof, const RobotState& state, RobotData& data) {
  update_positions(model, state, data);
  double sum = 0;
  for (int body = 0; body < static_cast<int>(model.bodies().size()); ++body)
    if (is_carried(model, body, dof, dof))
      sum += model.bodies()[static_cast<size_t>(body)].inertia.mass *
             std::abs(data.com[static_cast<size_t>(body)].y());
  return sum;
}

/// The pair of joints that moves the arms outwards most from this posture; `first` is -1 if there
/// is none.
ArmPair arm_pair(const RobotModel& model, const Eigen::VectorXd& posture) {
  ArmPair found;
  MirrorMap map;
  try {
    map = mirror_map(model);
  } catch (const Error&) {  // the robot has no mirror image
    return found;
  }
  RobotData data(model);
  RobotState state = model.rest_state();
  state.theta = posture;
  double most = 0;
  for (int dof = 0; dof < model.dof_count(); ++dof) {
    const auto i = static_cast<size_t>(dof);
    const int image = map.dof[i];
    if (image <= dof || model.is_leg_joint(dof) || model.dofs()[i].prismatic) continue;
    const double before = spread(model, dof, state, data);
    for (const double sign : {1.0, -1.0}) {
      state.theta[dof] = posture[dof] + sign * kProbe;
      const double gain = spread(model, dof, state, data) - before;
      if (gain <= most) continue;
      most = gain;
      found = {dof, image, sign, sign * map.sign[i]};
    }
    state.theta[dof] = posture[dof];
  }
  return found;
}

/// Whether one of the bodies that meet fulfils a condition.
template <class Condition>
bool meets(const TrialOutcome& found, const Condition& is_part) {
  return std::any_of(found.meeting.begin(), found.meeting.end(),
                     [&](const auto& pair) { return is_part(pair.first) || is_part(pair.second); });
}

/// Whether a key moves a joint whose body these two joints carry.
bool has_keys(const ExaminedPattern& of, const ArmPair& arms) {
  const auto moves = [&](const auto& joints) {
    return std::any_of(joints.begin(), joints.end(), [&](const auto& joint) {
      const int dof = of.model.find_dof(joint.first);
      return dof >= 0 && is_carried(of.model, of.model.dofs()[static_cast<size_t>(dof)].body,
                                    arms.first, arms.second);
    });
  };
  return std::any_of(
      of.pattern.keyframes.begin(), of.pattern.keyframes.end(), [&](const auto& key) {
        return !key.hands.empty() || moves(key.joints) ||
               (key.posture &&
                moves(posture_joints(of.model, of.pattern, *key.posture, key.place)));
      });
}

// A length in tenths of a millimetre [m].
double rounded(double length) { return std::round(1e4 * length) / 1e4; }

}  // namespace

void arms_aside(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (of.pattern.keyframes.empty() || of.is_repeated_key(0)) return;
  const Eigen::VectorXd posture = default_posture(of.model, of.pattern);
  const ArmPair arms = arm_pair(of.model, posture);
  if (arms.first < 0 || has_keys(of, arms)) return;
  if (!meets(of.found,
             [&](int body) { return is_carried(of.model, body, arms.first, arms.second); }))
    return;
  const Dof& first = of.model.dofs()[static_cast<size_t>(arms.first)];
  const Dof& second = of.model.dofs()[static_cast<size_t>(arms.second)];
  for (const double angle : kAside) {
    // Whole degrees are what an author types.
    const double a = whole_degrees(posture[arms.first] + arms.first_sign * angle);
    const double b = whole_degrees(posture[arms.second] + arms.second_sign * angle);
    // With less room on one side, no larger angle is possible either.
    if (a < first.lower || a > first.upper || b < second.lower || b > second.upper) return;
    const auto number = [&](double radians) {
      return text::brief(of.pattern.degrees ? radians / kDegree : radians, 5);
    };
    made.push_back({Rank::amount,
                    {of.key_place(0),
                     "bodies meet while the arms are held as in the posture '" +
                         of.pattern.default_posture + "'",
                     "with the arms farther outwards (\"joints\": {\"" + first.name + "\": " +
                         number(a) + ", \"" + second.name + "\": " + number(b) + "} in this key),"},
                    [names = std::pair(first.name, second.name), a, b](Pattern& p) {
                      p.keyframes.front().joints[names.first] = a;
                      p.keyframes.front().joints[names.second] = b;
                    }});
  }
}

// Keys that repeat have one place in the file, and their place in the world differs from round to
// round, so nothing is proposed for them.
void lesser_shifts(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.feet) return;
  const auto is_of_leg = [&](int body) {
    const int dof = of.model.bodies()[static_cast<size_t>(body)].dof;
    return dof >= 0 && of.model.is_leg_joint(dof);
  };
  if (!meets(of.found, is_of_leg)) return;
  struct Shift {
    size_t key;
    Eigen::Vector2d at, towards;  // place in the middle of the sole, and unit vector
  };
  std::vector<Shift> shifts;
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i) {
    const Keyframe& key = of.pattern.keyframes[i];
    if (!key.zmp ||
        (key.zmp->place != ZmpKey::Place::left && key.zmp->place != ZmpKey::Place::right))
      continue;
    const Side side = key.zmp->place == ZmpKey::Place::left ? Side::left : Side::right;
    if (!supports(of.support_at(key.t), side)) continue;
    if (of.is_repeated_key(i)) return;
    const Eigen::Isometry3d here = of.feet->pose(side, key.t);
    const Eigen::Vector2d& center = of.model.sole(side).center;
    const Eigen::Vector3d middle = here * Eigen::Vector3d(center.x(), center.y(), 0);
    const double inwards = side == Side::left ? -1 : 1;
    shifts.push_back({i, middle.head<2>(), inwards * here.linear().col(1).head<2>()});
  }
  if (shifts.empty()) return;
  for (const double share : kNearer) {
    const double by = rounded(share * half_sole_width(of.model));
    std::vector<std::pair<size_t, Eigen::Vector2d>> places;
    std::vector<std::string> listed;
    for (const Shift& shift : shifts) {
      const Eigen::Vector2d exact = shift.at + by * shift.towards;
      const Eigen::Vector2d place(rounded(exact.x()), rounded(exact.y()));
      places.emplace_back(shift.key, place);
      if (listed.size() < kListed)
        listed.push_back("\"zmp\": [" + text::brief(place.x(), 9) + ", " +
                         text::brief(place.y(), 9) + "] in " + of.key_place(shift.key));
    }
    const size_t more = shifts.size() - listed.size();
    made.push_back({Rank::amount,
                    {of.key_place(shifts.front().key),
                     "bodies meet while the ZMP is in the middle of one sole",
                     "with the ZMP " + text::fixed(1e3 * by, 1) + " mm nearer to the other foot (" +
                         text::join(listed, ", ") +
                         (more > 0 ? ", and the same distance in " +
                                         text::counted(more, "more key", "more keys")
                                   : "") +
                         "),"},
                    [places](Pattern& p) {
                      for (const auto& [key, place] : places)
                        p.keyframes[key].zmp = ZmpKey{ZmpKey::Place::point, place};
                    }});
  }
}

}  // namespace ayumi::hypotheses
