#include "ayumi/check/hypotheses/foothold_hypotheses.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/raised_feet.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi::hypotheses {

namespace {

// Number of feet above the ground or in it that are tried one by one. Chosen: a wrong height of one
// step also raises the steps after it, and the correction of this step corrects them all.
constexpr size_t kRaisedAlone = 4;
// A turn of a foot relative to the other foot below this is ignored [rad]. Chosen: ten degrees.
constexpr double kNotedTurn = 0.17;

bool has_later_place(const ExaminedPattern& of, size_t phase) {
  for (size_t k = phase + 1; k < of.pattern.phases.size(); ++k)
    if (of.has_place(k)) return true;
  return false;
}

}  // namespace

// The value "turn" of a step is relative to the heading of the other foot. If both feet have the
// same turn, the robot turns twice as far, and every second foot is turned inwards.
void turns(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  const auto turn_of = [&](const Phase& phase) {
    return phase.swing && phase.swing->step ? phase.swing->step->turn : 0.0;
  };
  size_t first = 0;
  while (first < of.pattern.phases.size() && std::abs(turn_of(of.pattern.phases[first])) < kNoAngle)
    ++first;
  if (first == of.pattern.phases.size()) return;
  const double turn = turn_of(of.pattern.phases[first]);
  const Side leading = of.pattern.phases[first].swing->foot;
  double sum = 0;
  std::vector<size_t> second;
  for (size_t i = first; i < of.pattern.phases.size(); ++i) {
    const double here = turn_of(of.pattern.phases[i]);
    sum += here;
    if (here * turn > 0 && of.pattern.phases[i].swing->foot != leading) second.push_back(i);
  }
  if (second.empty()) return;
  const std::string foot = name_of(other(leading)), ahead = name_of(leading);
  const size_t n = second.size();
  made.push_back(
      {Rank::geometry,
       {of.phase_place(second.front()),
        "the " + foot + " foot's step turns by " + of.angle(turn_of(of.pattern.phases[second[0]])) +
            " after the " + ahead + " foot has turned by " + of.angle(turn) +
            ". \"turn\" is the angle to the other foot, so all steps together turn the robot by " +
            of.angle(sum),
        "with \"turn\" 0 in " + (n > 1 ? "the " + std::to_string(n) + " steps" : "the step") +
            " of the " + foot + " foot, which then " + (n > 1 ? "land" : "lands") +
            " parallel to the " + ahead + " foot,"},
       [second](Pattern& p) {
         for (const size_t i : second) p.phases[i].swing->step->turn = 0;
       }});
}

// A foothold is moved nearer to the place beside the other foot, and all later footholds are
// moved with it.
void near_footholds(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.feet) return;
  for (size_t i = 0; i < of.pattern.phases.size(); ++i) {
    if (!of.has_place(i) || !of.reaches(i)) continue;
    const Swing& swing = *of.pattern.phases[i].swing;
    const Side side = swing.foot;
    const Eigen::Isometry3d stance = of.feet->pose(other(side), of.pattern.phases[i].until);
    const double apart =
        (of.feet->pose(other(side), 0).inverse() * of.feet->pose(side, 0).translation()).y();
    const Eigen::Vector3d from_stance = stance.inverse() * swing.to.position;
    const Eigen::Vector3d away(from_stance.x(), from_stance.y() - apart, 0);
    if (away.norm() < kLeastMistake * leg_length(of.model)) continue;
    for (const double share : {0.8, 0.6, 0.4, 0.2, 0.0}) {
      const auto grid = [](double metres) { return std::round(1e4 * metres) / 1e4; };
      Eigen::Vector3d place = swing.to.position + (share - 1) * (stance.linear() * away);
      place = {grid(place.x()), grid(place.y()), swing.to.position.z()};
      const Eigen::Vector3d moved = place - swing.to.position;
      made.push_back(
          {Rank::amount,
           {of.phase_place(i),
            std::string("the ") + name_of(side) + " foot lands " +
                text::fixed(1e3 * from_stance.head<2>().norm(), 0) + " mm from the " +
                name_of(other(side)) + " foot. At the beginning of the motion, the feet are " +
                text::fixed(1e3 * std::abs(apart), 0) + " mm apart",
            "with \"to\" = [" + text::brief(place.x()) + ", " + text::brief(place.y()) + ", ...]" +
                (has_later_place(of, i)
                     ? ", and with all later footholds moved by [" + text::brief(moved.x(), 3) +
                           ", " + text::brief(moved.y(), 3) + "] m,"
                     : "")},
           [i, moved](Pattern& p) {
             for (size_t k = i; k < p.phases.size(); ++k)
               if (p.phases[k].swing && !p.phases[k].swing->step)
                 p.phases[k].swing->to.position += moved;
           },
           1 - share,
           moved.norm() / leg_length(of.model)});
    }
  }
}

// A foot turns less relative to the other foot, and the later footholds turn with it.
void lesser_turns(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.feet) return;
  for (size_t i = 0; i < of.pattern.phases.size(); ++i) {
    if (!of.has_place(i) || !of.reaches(i)) continue;
    const Swing& swing = *of.pattern.phases[i].swing;
    const Eigen::Matrix3d turned =
        (of.feet->pose(other(swing.foot), of.pattern.phases[i].until).inverse() * pose_of(swing.to))
            .linear();
    const double turn = elementary::atan2(turned(1, 0), turned(0, 0));
    if (std::abs(turn) < kNotedTurn) continue;
    for (const double share : {0.75, 0.5}) {
      const double less = whole_degrees((share - 1) * turn);
      made.push_back(
          {Rank::amount,
           {of.phase_place(i),
            std::string("the ") + name_of(swing.foot) + " foot turns by " + of.angle(turn) +
                " relative to the " + name_of(other(swing.foot)) + " foot",
            "with a yaw of " + of.angle(swing.to.rpy.z() + less) +
                (has_later_place(of, i) ? ", and with all later footholds turned about this "
                                          "foothold by " +
                                              of.angle(less) + " (then the turn takes more steps),"
                                        : "")},
           [i, less](Pattern& p) {
             const Eigen::Vector3d about = p.phases[i].swing->to.position;
             const Eigen::Quaterniond by = exp_rotation({0, 0, less});
             for (size_t k = i; k < p.phases.size(); ++k) {
               if (!p.phases[k].swing || p.phases[k].swing->step) continue;
               Foothold& to = p.phases[k].swing->to;
               to.position = about + by * (to.position - about);
               to.rpy.z() += less;
             }
           },
           1 - share,
           std::abs(less)});
    }
  }
}

// Feet that stand above the ground or in it. Tries the height of the ground for the first ones
// that may cause the errors, and for all of them together: stairs that the world does not declare
// raise the foot of each step.
void ground_heights(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.feet) return;
  const std::vector<RaisedFoot> raised = raised_feet(of.model, of.pattern, *of.feet);
  size_t alone = 0;
  for (const RaisedFoot& foot : raised)
    if (alone < kRaisedAlone && of.reaches(static_cast<size_t>(of.feet->phase(foot.begin)))) {
      made.push_back({Rank::geometry, {foot.place, foot.words, foot.instead}, foot.mend});
      ++alone;
    }
  const auto is_relative = [](const RaisedFoot& foot) { return foot.relative; };
  if (alone == 0 || raised.size() == 1 || std::any_of(raised.begin(), raised.end(), is_relative))
    return;
  made.push_back({Rank::geometry,
                  {raised.front().place,
                   raised.front().words + ". This is the first of " +
                       std::to_string(raised.size()) + " heights that differ from the ground",
                   "with all these heights on the declared ground"},
                  [raised](Pattern& p) {
                    for (const RaisedFoot& foot : raised) foot.mend(p);
                  }});
}

}  // namespace ayumi::hypotheses
