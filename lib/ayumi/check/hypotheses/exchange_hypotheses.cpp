#include "ayumi/check/hypotheses/exchange_hypotheses.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi::hypotheses {

namespace {

/// Total distance between the successive footholds of each foot [m].
double way_of_feet(const Pattern& pattern) {
  double way = 0;
  std::array<std::optional<Eigen::Vector3d>, 2> at;
  for (const Phase& phase : pattern.phases) {
    if (!phase.swing || phase.swing->step) continue;
    auto& last = at[static_cast<size_t>(index(phase.swing->foot))];
    if (last) way += (phase.swing->to.position - *last).norm();
    last = phase.swing->to.position;
  }
  return way;
}

// Exchanged footholds lead the feet back and forth, so that another exchange shortens their path.
// If the footholds are in good order, an exchange lengthens the path.
bool exchange_shortens_way(const ExaminedPattern& of, size_t one, size_t other) {
  Pattern exchanged = of.pattern;
  std::swap(exchanged.phases[one].swing->to, exchanged.phases[other].swing->to);
  return way_of_feet(exchanged) < way_of_feet(of.pattern) - kNoLength;
}

// Whether the foot that swings in this phase swings in the steps before and after it, too.
bool swings_thrice(const ExaminedPattern& of, size_t phase) {
  const auto foot = [&](size_t i) -> std::optional<Side> {
    if (!of.pattern.phases[i].swing) return std::nullopt;
    return of.pattern.phases[i].swing->foot;
  };
  std::optional<Side> before, after;
  for (size_t i = phase; i-- > 0 && !before;) before = foot(i);
  for (size_t i = phase + 1; i < of.pattern.phases.size() && !after; ++i) after = foot(i);
  return foot(phase) && before == foot(phase) && after == before;
}

// Distance by which a foot lands on its own side of the other foot [m]; negative on the side of the
// other foot.
double outwards(const ExaminedPattern& of, size_t phase) {
  const Swing& swing = *of.pattern.phases[phase].swing;
  const Eigen::Isometry3d stance = of.feet->pose(other(swing.foot), of.pattern.phases[phase].until);
  return (swing.foot == Side::left ? 1 : -1) * (stance.inverse() * swing.to.position).y();
}

Side foot_of(const ExaminedPattern& of, size_t phase) {
  return of.pattern.phases[phase].swing->foot;
}

// Adds the exchange of this foothold with each of the next two.
void add_foothold_exchanges(
    const ExaminedPattern& of, size_t phase, std::vector<Hypothesis>& made,
    const std::function<bool(size_t)>& with = [](size_t) { return true; }) {
  if (!of.has_place(phase)) return;
  int later = 0;
  for (size_t k = phase + 1; k < of.pattern.phases.size() && later < 2; ++k) {
    if (!of.has_place(k)) continue;
    ++later;
    if (!with(k) || !exchange_shortens_way(of, phase, k)) continue;
    made.push_back(
        {Rank::exchange,
         {of.phase_place(phase),
          std::string("the footholds of this phase and of ") + of.phase_place(k) +
              " were perhaps exchanged",
          "with these two footholds exchanged"},
         [phase, k](Pattern& p) { std::swap(p.phases[phase].swing->to, p.phases[k].swing->to); }});
  }
}

}  // namespace

void phase_sides(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  for (size_t i = 0; i < of.pattern.phases.size(); ++i) {
    const Phase& phase = of.pattern.phases[i];
    if (!is_single(phase.support) || !of.reaches(i)) continue;
    const Support meant = opposite(phase.support);
    made.push_back({Rank::exchange,
                    {of.phase_place(i),
                     std::string("the phase has \"support\": \"") + name_of(phase.support) + "\"" +
                         (phase.swing ? std::string(" and a swing of the ") +
                                            name_of(phase.swing->foot) + " foot"
                                      : "") +
                         ". Perhaps left and right were exchanged",
                     std::string("with \"support\": \"") + name_of(meant) + "\"" +
                         (phase.swing ? std::string(" and a swing of the ") +
                                            name_of(other(phase.swing->foot)) + " foot"
                                      : "")},
                    [i, meant](Pattern& p) {
                      p.phases[i].support = meant;
                      if (p.phases[i].swing)
                        p.phases[i].swing->foot = other(p.phases[i].swing->foot);
                    },
                    swings_thrice(of, i) ? -1.0 : 0.0});
    add_foothold_exchanges(of, i, made);
  }
}

void foothold_exchanges(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  for (size_t i = 0; i < of.pattern.phases.size(); ++i)
    if (is_single(of.pattern.phases[i].support) && of.reaches(i))
      add_foothold_exchanges(of, i, made);
}

// If both feet land on the side of the other foot, two footholds were exchanged; this is more
// probable than two wrong signs.
void crossed_footholds(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.feet) return;
  std::vector<Hypothesis> exchanges;
  for (size_t i = 0; i < of.pattern.phases.size(); ++i)
    if (of.has_place(i) && is_single(of.pattern.phases[i].support) && of.reaches(i) &&
        outwards(of, i) < 0)
      add_foothold_exchanges(of, i, exchanges, [&](size_t k) {
        return foot_of(of, k) != foot_of(of, i) && outwards(of, k) < 0;
      });
  for (Hypothesis& exchange : exchanges) {
    exchange.rank = Rank::geometry;
    made.push_back(std::move(exchange));
  }
}

// If most feet land on the other side of the world's x axis than they start, y may have been
// counted to the right, or the words left and right may have been exchanged. Both are tried.
void all_sides(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.feet) return;
  std::vector<size_t> crossed;
  size_t swings = 0;
  for (size_t i = 0; i < of.pattern.phases.size(); ++i) {
    if (!of.has_place(i)) continue;
    ++swings;
    const Swing& swing = *of.pattern.phases[i].swing;
    const double start = of.feet->pose(swing.foot, 0).translation().y();
    if (start * swing.to.position.y() < 0) crossed.push_back(i);
  }
  if (crossed.size() < 2 || 2 * crossed.size() <= swings) return;
  const auto add = [&](const std::string& instead, Mend mend) {
    made.push_back(
        {Rank::geometry,
         {of.phase_place(crossed.front()),
          std::to_string(crossed.size()) + " of " + std::to_string(swings) +
              " footholds lie on the side of the other foot (y is positive to the left). "
              "Perhaps left and right were exchanged",
          instead},
         std::move(mend)});
  };
  add("with the other sign of y in these footholds", [crossed](Pattern& p) {
    for (const size_t i : crossed) p.phases[i].swing->to.position.y() *= -1;
  });
  add("with left and right exchanged in all phases, and in the feet and the ZMP of all keys",
      [](Pattern& p) {
        for (Phase& phase : p.phases) {
          phase.support = opposite(phase.support);
          if (phase.swing) phase.swing->foot = other(phase.swing->foot);
        }
        for (Keyframe& key : p.keyframes) {
          std::swap(key.feet[0], key.feet[1]);
          if (key.zmp) key.zmp->place = opposite(key.zmp->place);
        }
      });
}

// Two numbers in the wrong order: x forward and y to the left.
void swapped_axes(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  const auto add = [&](const std::string& place, const std::string& words,
                       const Eigen::Vector3d& at,
                       const std::function<Eigen::Vector3d&(Pattern&)>& in) {
    if (std::abs(at.x() - at.y()) < kLeastMistake * leg_length(of.model)) return;
    made.push_back(
        {Rank::exchange,
         {place,
          words + " is at x = " + text::brief(at.x()) + " m and y = " + text::brief(at.y()) +
              " m. The x axis points forward, and the y axis points to the left",
          "with the two numbers exchanged"},
         [in](Pattern& p) { std::swap(in(p).x(), in(p).y()); }});
    made.back().only_if_enough = true;
  };
  for (size_t i = 0; i < of.pattern.phases.size(); ++i)
    if (of.has_place(i) && of.reaches(i))
      add(of.phase_place(i),
          std::string("the foothold of the ") + name_of(foot_of(of, i)) + " foot",
          of.pattern.phases[i].swing->to.position,
          [i](Pattern& p) -> Eigen::Vector3d& { return p.phases[i].swing->to.position; });
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i)
    for (const Side side : {Side::left, Side::right})
      if (const auto s = static_cast<size_t>(index(side));
          of.pattern.keyframes[i].feet[s] && of.reaches_key(i))
        add(of.key_place(i), std::string("the ") + name_of(side) + " foot",
            of.pattern.keyframes[i].feet[s]->position,
            [i, s](Pattern& p) -> Eigen::Vector3d& { return p.keyframes[i].feet[s]->position; });
}

void starts(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.pattern.start_feet[0] || !of.pattern.start_feet[1]) return;
  made.push_back({Rank::exchange,
                  {"/start", "the left and the right foot were perhaps exchanged",
                   "with the places of both feet exchanged"},
                  [](Pattern& p) { std::swap(p.start_feet[0], p.start_feet[1]); }});
}

void key_sides(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  std::optional<MirrorMap> map;
  try {
    map = mirror_map(of.model);
  } catch (const Error&) {  // the robot has no mirror image
  }
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i) {
    const Keyframe& key = of.pattern.keyframes[i];
    if (!of.reaches_key(i)) continue;
    for (const Side side : {Side::left, Side::right}) {
      const auto s = static_cast<size_t>(index(side)), o = 1 - s;
      if (!key.feet[s] || key.feet[o] || of.support_at(key.t) != on(side)) continue;
      made.push_back(
          {Rank::exchange,
           {of.key_place(i),
            std::string("the key moves the ") + name_of(side) +
                " foot, which carries the robot. Perhaps left and right were exchanged",
            std::string("with this key for the ") + name_of(other(side)) + " foot"},
           [i, s, o](Pattern& p) { std::swap(p.keyframes[i].feet[s], p.keyframes[i].feet[o]); }});
    }
    if (key.feet[0] && key.feet[1])
      made.push_back(
          {Rank::exchange,
           {of.key_place(i), "the left and the right foot were perhaps exchanged",
            "with the places of both feet exchanged"},
           [i](Pattern& p) { std::swap(p.keyframes[i].feet[0], p.keyframes[i].feet[1]); }});
    if (!map || key.joints.empty()) continue;
    // Whether no other key moves the joints of this key.
    const bool is_alone = std::none_of(
        of.pattern.keyframes.begin(), of.pattern.keyframes.end(), [&](const Keyframe& k) {
          return &k != &key &&
                 std::any_of(key.joints.begin(), key.joints.end(),
                             [&](const auto& e) { return k.joints.contains(e.first); });
        });
    made.push_back(
        {is_alone ? Rank::slip : Rank::sign,
         {of.key_place(i),
          "the key moves " + key.joints.begin()->first +
              (key.joints.size() > 1 ? " and other joints" : "") +
              ". Perhaps left and right were exchanged",
          "with keys for the joints of the other side"},
         [&of, i, map](Pattern& p) {
           std::map<std::string, double> joints;
           for (const auto& [joint, angle] : p.keyframes[i].joints) {
             const int dof = of.model.find_dof(joint);
             joints[dof < 0
                        ? joint
                        : of.model.dofs()[static_cast<size_t>(map->dof[static_cast<size_t>(dof)])]
                              .name] = angle;
           }
           p.keyframes[i].joints = joints;
         }});
  }
}

// Where most joints of the two sides are mirror images of each other, one that is not may be
// wrong. Tries the mirror image of its partner, for each of the two.
void unlike_sides(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  std::optional<MirrorMap> map;
  try {
    map = mirror_map(of.model);
  } catch (const Error&) {  // the robot has no mirror image
    return;
  }
  using Joints = std::map<std::string, double>;
  const auto look = [&](const std::string& place, const Joints& joints,
                        const std::function<Joints&(Pattern&)>& in) {
    struct Pair {
      std::string wrong, partner;
      double angle = 0, meant = 0;
    };
    std::vector<Pair> unlike;
    size_t alike = 0;
    for (const auto& [joint, angle] : joints) {
      const int dof = of.model.find_dof(joint);
      if (dof < 0) continue;
      const auto d = static_cast<size_t>(dof);
      const std::string partner = of.model.dofs()[static_cast<size_t>(map->dof[d])].name;
      const auto found = joints.find(partner);
      if (partner == joint || found == joints.end()) continue;
      const double meant = map->sign[d] * found->second;
      if (std::abs(meant - angle) < kNoAngle)
        ++alike;
      else
        unlike.push_back({joint, partner, angle, meant});
    }
    // Each of the two joints of a pair counts as unlike, so one pair gives two entries.
    if (unlike.size() != 2 || alike < unlike.size()) return;
    for (const Pair& pair : unlike)
      made.push_back({Rank::exchange,
                      {place,
                       pair.wrong + " (" + of.angle(pair.angle) + ") and " + pair.partner + " (" +
                           of.angle(joints.at(pair.partner)) +
                           ") are not mirror images. All other pairs of joints in this posture "
                           "are mirror images",
                       "with " + pair.wrong + " at " + of.angle(pair.meant)},
                      [in, pair](Pattern& p) { in(p).at(pair.wrong) = pair.meant; }});
  };
  for (const auto& [name, joints] : of.pattern.postures)
    look("/postures/" + json_pointer_token(name), joints,
         [name = name](Pattern& p) -> Joints& { return p.postures.at(name); });
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i)
    if (of.reaches_key(i))
      look(of.key_place(i), of.pattern.keyframes[i].joints,
           [i](Pattern& p) -> Joints& { return p.keyframes[i].joints; });
}

}  // namespace ayumi::hypotheses
