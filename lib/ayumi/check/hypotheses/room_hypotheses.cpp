#include "ayumi/check/hypotheses/room_hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/generate/generate.hpp"
#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi::hypotheses {

namespace {

// Angles by which the arms are held farther outwards [deg]. Chosen: an elbow at a length of 0.1 m
// then moves by 17 to 70 mm, from a narrow gap to an arm that is clear of every thigh.
constexpr double kAside[] = {10, 20, 30, 45};
// Angle with which the joint that moves an arm outwards is found [rad]. Chosen: small enough for
// the direction at home, and large against rounding.
constexpr double kProbe = 0.05;
// Shares of half the width of a sole by which the ZMP moves towards the other foot. Chosen: the
// last one leaves a tenth of this half as the margin of the ZMP.
constexpr double kNearer[] = {0.25, 0.5, 0.7, 0.9};

/// A joint and its mirror image, and the angles at which the arms are farther outwards by one
/// radian, as differences from home.
struct Shoulders {
  int left = -1, right = -1;
  double left_sign = 0, right_sign = 0;
};

/// Distance of the bodies that a joint carries from the plane between left and right, weighted by
/// their masses [kg m].
double spread(const RobotModel& model, int dof, const RobotState& state, RobotData& data) {
  update_positions(model, state, data);
  double sum = 0;
  for (int body = 0; body < static_cast<int>(model.bodies().size()); ++body) {
    int above = body;
    while (above >= 0 && model.bodies()[static_cast<size_t>(above)].dof != dof)
      above = model.bodies()[static_cast<size_t>(above)].parent;
    if (above >= 0)
      sum += model.bodies()[static_cast<size_t>(body)].inertia.mass *
             std::abs(data.com[static_cast<size_t>(body)].y());
  }
  return sum;
}

/// The pair of joints that moves the arms outwards most. Nothing (left is -1) if there is none.
Shoulders shoulders_of(const RobotModel& model) {
  Shoulders found;
  MirrorMap map;
  try {
    map = mirror_map(model);
  } catch (const Error&) {  // the robot has no mirror image
    return found;
  }
  RobotData data(model);
  RobotState state = model.rest_state();
  double most = 0;
  for (int dof = 0; dof < model.dof_count(); ++dof) {
    const int image = map.dof[static_cast<size_t>(dof)];
    if (image <= dof || model.is_leg_joint(dof) || model.dofs()[static_cast<size_t>(dof)].prismatic)
      continue;
    const double home = state.theta[dof], before = spread(model, dof, state, data);
    for (const double sign : {1.0, -1.0}) {
      state.theta[dof] = home + sign * kProbe;
      const double gain = spread(model, dof, state, data) - before;
      if (gain <= most) continue;
      most = gain;
      found = {dof, image, sign, sign * map.sign[static_cast<size_t>(dof)]};
    }
    state.theta[dof] = home;
  }
  return found;
}

bool moves_arms(const Pattern& pattern, const std::string& left, const std::string& right) {
  return std::any_of(pattern.keyframes.begin(), pattern.keyframes.end(), [&](const Keyframe& key) {
    return key.posture || !key.hands.empty() || key.joints.count(left) > 0 ||
           key.joints.count(right) > 0;
  });
}

// A length that is not finer than a tenth of a millimetre [m].
double rounded(double length) { return std::round(1e4 * length) / 1e4; }

}  // namespace

void arms_aside(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (of.pattern.keyframes.empty() || of.is_repeated_key(0)) return;
  const Shoulders joints = shoulders_of(of.model);
  if (joints.left < 0) return;
  const Dof& left = of.model.dofs()[static_cast<size_t>(joints.left)];
  const Dof& right = of.model.dofs()[static_cast<size_t>(joints.right)];
  if (moves_arms(of.pattern, left.name, right.name)) return;
  const Eigen::VectorXd home = of.model.posture();
  for (const double degrees : kAside) {
    const double angle = degrees * std::numbers::pi / 180;
    // Whole degrees are what an author types.
    const double at_left = whole_degrees(home[joints.left] + joints.left_sign * angle);
    const double at_right = whole_degrees(home[joints.right] + joints.right_sign * angle);
    if (at_left < left.lower || at_left > left.upper || at_right < right.lower ||
        at_right > right.upper)
      return;
    made.push_back(
        {Rank::amount,
         {of.key_place(0), "bodies meet while the arms hang in the home posture",
          "with the arms farther outwards (\"joints\": {\"" + left.name +
              "\": " + text::brief(at_left / (of.pattern.degrees ? std::numbers::pi / 180 : 1), 5) +
              ", \"" + right.name + "\": " +
              text::brief(at_right / (of.pattern.degrees ? std::numbers::pi / 180 : 1), 5) +
              "} in this key),"},
         [l = left.name, r = right.name, at_left, at_right](Pattern& p) {
           p.keyframes.front().joints[l] = at_left;
           p.keyframes.front().joints[r] = at_right;
         },
         degrees / 90,
         angle});
  }
}

void lesser_shifts(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.feet) return;
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
    // A place in the world cannot be the same in all rounds of a block.
    if (of.is_repeated_key(i)) return;
    const Side side = key.zmp->place == ZmpKey::Place::left ? Side::left : Side::right;
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
    std::vector<std::pair<std::string, std::vector<std::string>>> keys_at;  // by written place
    for (const Shift& shift : shifts) {
      const Eigen::Vector2d exact = shift.at + by * shift.towards;
      const Eigen::Vector2d place(rounded(exact.x()), rounded(exact.y()));
      places.emplace_back(shift.key, place);
      const std::string written =
          "[" + text::brief(place.x(), 9) + ", " + text::brief(place.y(), 9) + "]";
      const auto same = std::find_if(keys_at.begin(), keys_at.end(),
                                     [&](const auto& at) { return at.first == written; });
      if (same == keys_at.end())
        keys_at.push_back({written, {of.key_place(shift.key)}});
      else
        same->second.push_back(of.key_place(shift.key));
    }
    std::vector<std::string> texts;
    for (const auto& [written, keys] : keys_at)
      texts.push_back("\"zmp\": " + written + " in " + text::join(keys, " and "));
    made.push_back(
        {Rank::amount,
         {of.key_place(shifts.front().key),
          "the keys put the ZMP in the middle of one sole, so the legs lean far to the side",
          "with the ZMP " + text::fixed(1e3 * by, 1) + " mm nearer to the other foot (" +
              text::join(texts, "; ") + "),"},
         [places](Pattern& p) {
           for (const auto& [key, place] : places)
             p.keyframes[key].zmp = ZmpKey{ZmpKey::Place::point, place};
         },
         share,
         by / leg_length(of.model)});
  }
}

}  // namespace ayumi::hypotheses
