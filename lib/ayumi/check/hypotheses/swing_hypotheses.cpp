#include "ayumi/check/hypotheses/swing_hypotheses.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/plan/folded_legs.hpp"

namespace ayumi::hypotheses {

namespace {

// A level foot below a leg that leans by less than this is not named as a reason [rad]. Chosen:
// five degrees, which every ankle can bend.
constexpr double kNotedLean = 0.09;
// Number of further keys of a foot that are named with their turn, and of keys of a swing that are
// named with their place. Chosen: a kick has two or three keys in the air.
constexpr size_t kTurnedKeys = 3, kPlacedKeys = 3;
// Largest lean of a leg with which a foot is turned [rad]. Chosen: beyond it, a foot that is pulled
// up to its hip would be turned upside down.
constexpr double kMostLean = 1.1;

// A key of a foot in the air, and where the foot would be without the keys of this swing.
struct AirKey {
  size_t key = 0;
  Eigen::Vector3d position = {}, neutral = {};
};

/// The keys of a foot while the robot stands on the other one in this phase.
std::vector<AirKey> air_keys(const ExaminedPattern& of, size_t phase) {
  const Side side = other(stance_of(of.pattern.phases[phase].support));
  const auto s = static_cast<size_t>(index(side));
  const double begin = of.begin_of(phase), until = of.pattern.phases[phase].until;
  const Eigen::Vector3d from = of.feet->pose(side, begin).translation(),
                        to = of.feet->pose(side, until).translation();
  std::vector<AirKey> keys;
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i) {
    const Keyframe& key = of.pattern.keyframes[i];
    if (!key.feet[s] || key.t <= begin + 1e-9 || key.t >= until - 1e-9) continue;
    const Eigen::Vector3d neutral = from + (key.t - begin) / (until - begin) * (to - from);
    if (of.is_repeated_key(i)) return {};
    if ((key.feet[s]->position - neutral).norm() > kNoLength)
      keys.push_back({i, key.feet[s]->position, neutral});
  }
  return keys;
}

// A position as a pattern has it [m].
std::string written_position(const Eigen::Vector3d& p) {
  return "[" + text::brief(p.x(), 9) + ", " + text::brief(p.y(), 9) + ", " + text::brief(p.z(), 9) +
         "]";
}

struct SwingWords {
  std::string written;  // how far the foot moves
  std::string lower;    // word for keys that move less up or down
};

Hypothesis smaller_swing(const ExaminedPattern& of, const std::vector<AirKey>& keys, Side side,
                         double away, double up, const SwingWords& words) {
  std::vector<std::pair<size_t, Eigen::Vector3d>> places;
  std::vector<std::string> texts;
  double moved = 0;
  for (const AirKey& key : keys) {
    Eigen::Vector3d place = key.position;
    for (int axis = 0; axis < 3; ++axis)
      if (const double share = axis == 2 ? up : away; share != 1)
        place[axis] =
            std::round(1e4 * (key.neutral[axis] + share * (place[axis] - key.neutral[axis]))) / 1e4;
    moved = std::max(moved, (place - key.position).norm());
    places.emplace_back(key.key, place);
    if (texts.size() < kPlacedKeys)
      texts.push_back("to " + written_position(place) + " in " + of.key_place(key.key));
  }
  const double share = std::min(away, up);
  std::string later;
  if (keys.size() > kPlacedKeys)
    later = std::string(" In the later keys, reduce the ") +
            (away == 1 ? "vertical " : (up == 1 ? "horizontal " : "")) +
            "distance of the foot from the line between its two places on the ground to " +
            text::fixed(100 * share, 0) + " %.";
  const std::string nearer = "nearer to its place on the ground";
  const auto s = static_cast<size_t>(index(side));
  return {Rank::amount,
          {of.key_place(keys.front().key), words.written,
           "move the " + std::string(name_of(side)) + " foot " +
               (away == 1 ? words.lower : (up == 1 ? nearer : nearer + " and " + words.lower)) +
               " in all keys of this swing: " + text::join(texts, ", ") + "." + later +
               " With these changes"},
          [places, s](Pattern& p) {
            for (const auto& [key, place] : places) p.keyframes[key].feet[s]->position = place;
          },
          1 - share,
          moved / leg_length(of.model)};
}

// The foot with its turn as the author can write it: "left": {"position": [0, 0.039, 0.03],
// "rpy": [0, -20, 0]}.
std::string turned_foot(const ExaminedPattern& of, Side side, const Foothold& foot, double roll,
                        double pitch) {
  const double unit = of.pattern.degrees ? std::numbers::pi / 180 : 1;
  return "\"" + std::string(name_of(side)) +
         "\": {\"position\": " + written_position(foot.position) + ", \"rpy\": [" +
         text::brief(roll / unit) + ", " + text::brief(pitch / unit) + ", " +
         text::brief(foot.rpy.z() / unit, 9) + "]}";
}

/// The hip of a leg in the frame of its sole, while the robot stands at the height of the
/// pattern.
Eigen::Vector3d standing_hip(const ExaminedPattern& of, Side side) {
  RobotData data(of.model);
  update_positions(of.model, of.model.rest_state(), data);
  const int body = of.model.dofs()[static_cast<size_t>(of.model.leg(side).front())].body;
  Eigen::Vector3d hip = sole_pose(of.model, data, side).inverse() * data.pose(body).translation();
  hip.z() += default_cog_height(of.model, of.pattern) - home_cog_height(of.model, of.pattern);
  return hip;
}

}  // namespace

// Tries all keys of a foot in the air nearer to its place on the ground, or lower, or both.
void smaller_swings(const ExaminedPattern& of, std::vector<Hypothesis>& made,
                    const std::array<double, 3>& shares) {
  if (!of.feet) return;
  for (size_t phase = 0; phase < of.pattern.phases.size(); ++phase) {
    if (!is_single(of.pattern.phases[phase].support) || of.pattern.phases[phase].swing ||
        !of.reaches(phase))
      continue;
    const std::vector<AirKey> keys = air_keys(of, phase);
    if (keys.size() < 2) continue;  // the numbers of a single key are values of their own
    const Side side = other(stance_of(of.pattern.phases[phase].support));
    double far = 0, up = 0, down = 0;
    for (const AirKey& key : keys) {
      const Eigen::Vector3d way = key.position - key.neutral;
      far = std::max(far, way.head<2>().norm());
      up = std::max(up, way.z());
      down = std::max(down, -way.z());
    }
    const double high = std::max(up, down);
    std::vector<std::string> ways;
    for (const auto& [length, where] :
         {std::pair(far, "away from its place on the ground"), {up, "up"}, {down, "down"}})
      if (length >= kNoLength)
        ways.push_back("up to " + text::fixed(1e3 * length, 0) + " mm " + where);
    const SwingWords words = {
        std::string("the ") + name_of(side) + " foot moves " + text::join(ways, " and "),
        down < kNoLength ? "lower" : (up < kNoLength ? "higher" : "flatter")};
    for (const auto& [nearer, lower] : {std::pair(true, true), {true, false}, {false, true}}) {
      if ((nearer && far < kNoLength) || (lower && high < kNoLength)) continue;
      for (const double share : shares)
        made.push_back(smaller_swing(of, keys, side, nearer ? share : 1, lower ? share : 1, words));
    }
  }
}

// If a foot stays level while its leg leans, the ankle has to compensate for the lean. Tries the
// foot turned with its leg.
void level_feet(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.feet) return;
  for (const Side side : {Side::left, Side::right}) {
    const auto s = static_cast<size_t>(index(side));
    const Eigen::Isometry3d from = of.feet->pose(side, 0);
    const Eigen::Vector3d hip = standing_hip(of, side);
    struct Lean {
      size_t key;
      double roll, pitch;
    };
    std::vector<Lean> leans;
    for (size_t i = 0; i < of.pattern.keyframes.size(); ++i) {
      const auto& foot = of.pattern.keyframes[i].feet[s];
      if (!foot || foot->rpy.head<2>().norm() > kNoAngle) continue;
      if (of.support_at(of.pattern.keyframes[i].t) != on(other(side)) || !of.reaches_key(i))
        continue;
      const Eigen::Vector3d way = from.inverse() * foot->position;
      if (way.z() < kNoLength) continue;
      // The hip moves with the COG, which is above the foot that stands.
      const double t = of.pattern.keyframes[i].t;
      Eigen::Vector3d moved = of.feet->support_center(t) - of.feet->support_center(0);
      if (!of.has_cog_height()) moved.z() += way.z() / 2;
      const Eigen::Vector3d leg = way - hip - from.linear().transpose() * moved;
      const auto lean = [&](double across) {
        return std::clamp(elementary::atan2(across, -leg.z()), -kMostLean, kMostLean);
      };
      leans.push_back({i, lean(leg.y()), -lean(leg.x())});
    }
    if (leans.empty()) continue;
    const auto most = [&](const auto& amount) {
      return *std::max_element(leans.begin(), leans.end(), [&](const Lean& a, const Lean& b) {
        return std::abs(amount(a)) < std::abs(amount(b));
      });
    };
    const Lean widest = most([](const Lean&lean) { return lean.roll; }),
               longest = most([](const Lean&lean) { return lean.pitch; });
    for (const auto& [roll, pitch] : {std::pair(true, false), {false, true}, {true, true}}) {
      if ((roll && std::abs(widest.roll) < kNotedLean) ||
          (pitch && std::abs(longest.pitch) < kNotedLean))
        continue;
      const size_t place = pitch ? longest.key : widest.key;
      const auto size = [](double lean) {
        return text::fixed(std::abs(lean) * 180 / std::numbers::pi, 0) + " deg";
      };
      std::vector<std::string> ways;
      if (roll) ways.push_back(size(widest.roll) + " to the side");
      if (pitch) ways.push_back(size(longest.pitch) + (longest.pitch < 0 ? " ahead" : " back"));
      for (const double share : {1.0, 0.6}) {
        const auto turn = [roll, pitch, share](const Lean& lean) {
          return Eigen::Vector2d(roll ? whole_degrees(share * lean.roll) : 0,
                                 pitch ? whole_degrees(share * lean.pitch) : 0);
        };
        std::string here, others;
        size_t more = 0;
        for (const Lean& lean : leans) {
          const Eigen::Vector2d by = turn(lean);
          const std::string turned =
              turned_foot(of, side, of.pattern.keyframes[lean.key].feet[s].value(), by.x(), by.y());
          if (lean.key == place)
            here = turned;
          else if (!by.isZero() && ++more <= kTurnedKeys)
            others += "; in " + of.key_place(lean.key) + ", " + turned;
        }
        if (more > kTurnedKeys)
          others += "; in the later keys of this foot, turned by the lean of the leg";
        made.push_back(
            {Rank::geometry,
             {of.key_place(place),
              std::string("the ") + name_of(side) + " foot stays level while its leg leans by " +
                  text::join(ways, " and ") + ". The ankle has to bend by the same angle",
              "turn the foot with its leg: " + here + others +
                  (others.empty() ? ". With this change" : ". With these changes")},
             [leans, turn, s](Pattern& p) {
               for (const Lean& lean : leans)
                 p.keyframes[lean.key].feet[s]->rpy.head<2>() = turn(lean);
             },
             roll && pitch ? 1.0 : 0.0});
      }
    }
  }
}

}  // namespace ayumi::hypotheses
