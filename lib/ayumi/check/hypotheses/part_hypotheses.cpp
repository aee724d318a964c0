#include "ayumi/check/hypotheses/part_hypotheses.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "ayumi/base/text.hpp"

namespace ayumi::hypotheses {

namespace {

// Share of a swing that becomes the missing double support. Chosen: the share of the generated
// walks.
constexpr double kDoubleSupport = 0.2;

bool has_foot_key(const ExaminedPattern& of, Side side, double begin, double end) {
  return std::any_of(of.pattern.keyframes.begin(), of.pattern.keyframes.end(),
                     [&](const Keyframe& key) {
                       return key.t >= begin - 1e-9 && key.t <= end + 1e-9 &&
                              key.feet[static_cast<size_t>(index(side))];
                     });
}

}  // namespace

void swings(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.feet) return;
  for (size_t i = 0; i < of.pattern.phases.size(); ++i) {
    const Phase& phase = of.pattern.phases[i];
    if (phase.swing || phase.viip || !is_single(phase.support)) continue;
    const Side idle = other(stance_of(phase.support));
    if (has_foot_key(of, idle, of.begin_of(i), phase.until)) continue;
    // The new foothold is ahead by half the length of the other foot's next step, or beside the
    // other foot if there is no such step.
    RelativeStep step;
    const Eigen::Isometry3d stance = of.feet->pose(other(idle), phase.until);
    for (size_t k = i + 1; k < of.pattern.phases.size(); ++k)
      if (of.pattern.phases[k].swing && of.pattern.phases[k].swing->foot == other(idle)) {
        const Eigen::Vector3d way =
            stance.inverse() * of.feet->pose(other(idle), of.pattern.phases[k].until).translation();
        step.forward = 0.5 * way.x();
        break;
      }
    double lift = Swing{}.lift;
    for (const Phase& like : of.pattern.phases)
      if (like.swing) lift = like.swing->lift;
    made.push_back(
        {Rank::missing,
         {of.phase_place(i),
          std::string("the robot stands on the ") + name_of(other(idle)) + " foot alone, but the " +
              name_of(idle) + " foot stays on the ground. Perhaps a swing of the " + name_of(idle) +
              " foot is missing",
          "with such a swing to a place " + text::brief(step.forward, 3) +
              " m ahead of the other foot"},
         [i, idle, lift, step](Pattern& p) {
           p.phases[i].swing = Swing{.foot = idle, .to = {}, .lift = lift, .step = step};
         }});
  }
}

void double_supports(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  for (size_t i = 1; i < of.pattern.phases.size(); ++i) {
    const Phase &before = of.pattern.phases[i - 1], &phase = of.pattern.phases[i];
    if (!is_single(phase.support) || before.support != opposite(phase.support)) continue;
    if (!of.reaches(i) && !of.reaches(i - 1)) continue;
    double until = before.until + kDoubleSupport * (phase.until - before.until);
    for (const Keyframe& key : of.pattern.keyframes)
      if (key.zmp && key.t > before.until + 1e-9 && key.t < phase.until - 1e-9) {
        until = key.t;
        break;
      }
    made.push_back(
        {Rank::missing,
         {of.phase_place(i),
          std::string("the robot passes from the ") + name_of(before.support) + " foot to the " +
              name_of(phase.support) +
              " foot at once. Perhaps a phase with support \"both\" is missing before this phase",
          "with a phase with support \"both\" until " + seconds(until)},
         [i, until](Pattern& p) {
           Phase both;
           both.until = until;
           p.phases.insert(p.phases.begin() + static_cast<long>(i), both);
         }});
  }
}

void leg_keys(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.model.has_soles()) return;
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i)
    for (const auto& entry : of.pattern.keyframes[i].joints) {
      if (!of.model.is_leg_joint(of.model.find_dof(entry.first))) continue;
      made.push_back(
          {Rank::missing,
           {of.key_place(i),
            entry.first +
                " is a joint of a leg. As soon as one leg joint has a key, all leg joints follow "
                "only their keys, and Ayumi no longer computes them from the feet and the COG",
            "without keys of leg joints (give keys of the COG, the feet or the torso instead),"},
           [&of](Pattern& p) {
             for (Keyframe& key : p.keyframes)
               std::erase_if(key.joints, [&](const auto& e) {
                 return of.model.is_leg_joint(of.model.find_dof(e.first));
               });
           }});
      return;
    }
}

// Keys of one quantity that contradict the others: f_z follows from the COG height, the ZMP from
// the COG, and the COG in a flight from its ends. Tries the pattern without these keys.
void superfluous_keys(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  const auto& keys = of.pattern.keyframes;
  const auto first = [&](const auto& has) {
    return static_cast<size_t>(std::find_if(keys.begin(), keys.end(), has) - keys.begin());
  };
  const auto add = [&](size_t key, const std::string& written, const std::string& instead,
                       Mend mend) {
    // Leaving out a key hides any wrong number in it. So this comes after all corrections of
    // numbers, and before the other changes of Rank::pace.
    made.push_back({Rank::pace, {of.key_place(key), written, instead}, std::move(mend), -1});
    made.back().only_if_enough = true;
  };
  if (const size_t k = first([](const Keyframe& key) { return key.fz.has_value(); });
      k < keys.size())
    add(k,
        "f_z is " + text::brief(*keys[k].fz) +
            " N, but this force follows from the weight and from the movement of the COG",
        "without keys of f_z", [](Pattern& p) {
          for (Keyframe& key : p.keyframes) key.fz.reset();
        });
  const size_t cog = first([](const Keyframe& key) { return key.cog_x || key.cog_y; });
  const size_t zmp = first([](const Keyframe& key) { return key.zmp.has_value(); });
  if (cog < keys.size() && zmp < keys.size()) {
    const std::string both = "both the COG (" + of.key_place(cog) + ") and the ZMP (" +
                             of.key_place(zmp) +
                             ") have keys, but the COG follows from the ZMP, and the ZMP follows "
                             "from the COG";
    add(zmp, both, "without keys of the ZMP", [](Pattern& p) {
      for (Keyframe& key : p.keyframes) key.zmp.reset();
    });
    add(cog, both, "without keys of the COG's x and y", [](Pattern& p) {
      for (Keyframe& key : p.keyframes) {
        key.cog_x.reset();
        key.cog_y.reset();
      }
    });
  }
  const auto is_inside = [&](const Keyframe& key) {
    return (key.cog_x || key.cog_y || key.cog_height) && of.flies(key.t) && !of.is_at_end(key.t);
  };
  if (const size_t k = first(is_inside); k < keys.size())
    add(k,
        "the COG has a key at " + seconds(keys[k].t) +
            ", inside a flight, but in flight the COG can only follow its parabola",
        "without keys of the COG inside the flight", [&of, is_inside](Pattern& p) {
          for (Keyframe& key : p.keyframes)
            if (is_inside(key)) {
              key.cog_x.reset();
              key.cog_y.reset();
              key.cog_height.reset();
            }
        });
}

void interpolations(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  const auto jumps = [](Interpolation i) {
    return i == Interpolation::hold || i == Interpolation::linear;
  };
  const auto add = [&](const std::string& place, Interpolation now, const Mend& mend) {
    made.push_back({Rank::missing,
                    {place,
                     std::string("interpolation \"") + name_of(now) + "\" makes " +
                         (now == Interpolation::hold ? "the angle jump" : "the speed jump"),
                     "with \"minimum_jerk\""},
                    mend});
  };
  if (jumps(of.pattern.interpolation))
    add("/defaults/interpolation", of.pattern.interpolation,
        [](Pattern& p) { p.interpolation = Interpolation::minimum_jerk; });
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i)
    if (const auto& own = of.pattern.keyframes[i].interpolation;
        own && jumps(*own) && of.reaches_key(i))
      add(of.key_place(i), *own,
          [i](Pattern& p) { p.keyframes[i].interpolation = Interpolation::minimum_jerk; });
}

}  // namespace ayumi::hypotheses
