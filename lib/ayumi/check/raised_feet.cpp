#include "ayumi/check/raised_feet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "ayumi/base/text.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/motion/pattern_context.hpp"

namespace ayumi {

namespace {

// A sole that is nearer to the ground than this stands on it [m]. Chosen: soft soles and the servos
// of a leg yield by about this distance.
constexpr double kStands = 1e-3;
// Two times nearer than this are the same [s]. Definition: rounding of sums of written times.
constexpr double kRoundedTime = 1e-9;

bool is_on(const GroundBlock& block, const Eigen::Vector2d& p) {
  std::array<Eigen::Vector2d, 8> corners;
  const int n = block_corners(block, corners);
  return ConvexPolygon(std::vector<Eigen::Vector2d>(corners.begin(), corners.begin() + n))
             .margin(p) >= 0;
}

double ground_at(const World& world, const Eigen::Vector2d& p) {
  double height = world.height;
  for (const GroundBlock& block : world.blocks)
    if (is_on(block, p)) height = std::max(height, block.height);
  return height;
}

class RaisedFeet {
 public:
  RaisedFeet(const Pattern& pattern, const FootPlan& feet) : pattern_(pattern), feet_(feet) {}

  std::vector<RaisedFoot> found() {
    landings();
    standing_keys();
    keys_in_the_air();
    return std::move(found_);
  }

 private:
  double height(Side side, double t) const { return feet_.pose(side, t).translation().z(); }
  double ground(Side side, double t) const {
    return ground_at(pattern_.world, feet_.sole_center(side, t).head<2>());
  }
  bool stands(Side side, double t) const {
    return std::abs(height(side, t) - ground(side, t)) <= kStands;
  }
  std::string words(Side side, double t) const {
    return std::string("the ") + name_of(side) + " foot's z is " + text::brief(height(side, t)) +
           " m, but the ground there is at z = " + text::brief(ground(side, t)) + " m";
  }

  // Reports the foot if it is not on the ground at t; `written` is the number that states its
  // height.
  void look(const std::string& place, Side side, double t,
            const std::function<double&(Pattern&)>& written, int phase, bool relative) {
    if (stands(side, t)) return;
    found_.push_back(
        {place, words(side, t), "with a height of " + text::brief(ground(side, t)) + " m",
         [written, by = ground(side, t) - height(side, t)](Pattern& p) { written(p) += by; },
         feet_.begin(phase), relative});
  }

  void landings() {
    for (size_t i = 0; i < pattern_.phases.size(); ++i)
      if (const auto& swing = pattern_.phases[i].swing; swing && !pattern_.phases[i].viip)
        look(
            pointer_of_phase(pattern_, i), swing->foot, pattern_.phases[i].until,
            [i](Pattern& p) -> double& {
              Swing& to = *p.phases[i].swing;
              return to.step ? to.step->up : to.to.position.z();
            },
            static_cast<int>(i), swing->step.has_value());
  }

  void standing_keys() {
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i)
      for (const Side side : {Side::left, Side::right}) {
        const auto s = static_cast<size_t>(index(side));
        const double t = pattern_.keyframes[i].t;
        if (pattern_.keyframes[i].feet[s] && supports(feet_.support(t), side))
          look(
              pointer_of_keyframe(pattern_, i), side, t,
              [i, s](Pattern& p) -> double& { return p.keyframes[i].feet[s]->position.z(); },
              std::max(0, feet_.phase(t) - 1), false);
      }
  }

  // The foot carries the robot again, but its last key leaves it in the air.
  void keys_in_the_air() {
    for (size_t i = 1; i < pattern_.phases.size(); ++i)
      for (const Side side : {Side::left, Side::right}) {
        const Phase& before = pattern_.phases[i - 1];
        const double t = before.until;
        if (!supports(pattern_.phases[i].support, side) || supports(before.support, side) ||
            before.swing || before.viip || stands(side, t))
          continue;
        const auto s = static_cast<size_t>(index(side));
        std::optional<size_t> last;
        for (size_t k = 0; k < pattern_.keyframes.size(); ++k)
          if (pattern_.keyframes[k].feet[s] && pattern_.keyframes[k].t <= t + kRoundedTime)
            last = k;
        if (!last || pattern_.keyframes[*last].t >= t - kRoundedTime) continue;
        Foothold old = *pattern_.keyframes[*last].feet[s];
        old.position = feet_.pose(side, feet_.begin(static_cast<int>(i) - 1)).translation();
        found_.push_back(
            {pointer_of_keyframe(pattern_, *last),
             std::string("the ") + name_of(side) + " foot carries the robot from " +
                 text::brief(t) + " s on, but its last key before this time puts the foot " +
                 "at z = " + text::brief(height(side, t)) +
                 " m. The ground there is at z = " + text::brief(ground(side, t)) + " m",
             "with one more key at " + text::brief(t) +
                 " s that puts the foot back to its old place",
             [t, s, old](Pattern& p) { add_key(p, t, s, old); },
             feet_.begin(static_cast<int>(i) - 1)});
      }
  }

  static void add_key(Pattern& pattern, double t, size_t foot, const Foothold& place) {
    auto& keys = pattern.keyframes;
    auto at = std::find_if(keys.begin(), keys.end(),
                           [&](const Keyframe& key) { return key.t > t - kRoundedTime; });
    if (at == keys.end() || at->t > t + kRoundedTime) {
      at = keys.insert(at, Keyframe{});
      at->t = t;
    }
    at->feet[foot] = place;
  }

  const Pattern& pattern_;
  const FootPlan& feet_;
  std::vector<RaisedFoot> found_;
};

}  // namespace

std::vector<RaisedFoot> raised_feet(const RobotModel& model, const Pattern& pattern,
                                    const FootPlan& feet) {
  const World& world = pattern.world;
  if (!model.has_soles() || !world.slope.isZero(0) || !world.fields.empty() ||
      !world.motions.empty())
    return {};
  return RaisedFeet(pattern, feet).found();
}

}  // namespace ayumi
