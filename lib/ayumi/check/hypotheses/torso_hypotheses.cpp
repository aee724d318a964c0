#include "ayumi/check/hypotheses/torso_hypotheses.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "ayumi/base/counted.hpp"
#include "ayumi/math/elementary.hpp"

namespace ayumi::hypotheses {

namespace {

// A turn of the feet by less than this does not contradict a trunk that looks straight ahead
// [rad]. Chosen: ten degrees, which hips can usually turn in both directions.
constexpr double kNotedHeading = 0.17;

// Mean heading of both feet at this time, in whole degrees [rad].
double heading_of_feet(const ExaminedPattern& of, double t) {
  const Eigen::Vector3d ahead =
      of.feet->pose(Side::left, t).linear().col(0) + of.feet->pose(Side::right, t).linear().col(0);
  return whole_degrees(elementary::atan2(ahead.y(), ahead.x()));
}

}  // namespace

// The yaw of the trunk is an angle in the world, and a key of the trunk without a yaw has the yaw
// 0. After a turn, such a key turns the trunk back. Keys that repeat are left out, because the
// heading of the feet differs from round to round.
void trunk_headings(const ExaminedPattern& of, std::vector<Hypothesis>& made) {
  if (!of.feet) return;
  struct Turned {
    size_t key;
    double heading;
  };
  std::vector<Turned> turned;
  for (size_t i = 0; i < of.pattern.keyframes.size(); ++i) {
    const Keyframe& key = of.pattern.keyframes[i];
    if (!key.torso || std::abs(key.torso->z()) > kNoAngle || of.is_repeated_key(i)) continue;
    const double heading = heading_of_feet(of, key.t);
    if (std::abs(heading) > kNotedHeading) turned.push_back({i, heading});
  }
  if (turned.empty()) return;
  const Turned& first = turned.front();
  const size_t more = turned.size() - 1;
  made.push_back({Rank::geometry,
                  {of.key_place(first.key),
                   "\"torso\" has the yaw 0 here, which is an angle in the world, but the feet "
                   "have turned by " +
                       of.angle(first.heading),
                   "with \"yaw\": " + of.angle(first.heading) +
                       (more == 0 ? ""
                                  : ", and the heading of the feet also in " +
                                        text::counted(more, "later key") + " of the trunk,")},
                  [turned](Pattern& p) {
                    for (const Turned& one : turned) p.keyframes[one.key].torso->z() = one.heading;
                  }});
}

}  // namespace ayumi::hypotheses
