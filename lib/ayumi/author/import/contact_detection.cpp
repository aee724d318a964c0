// Supports from the motion of the feet relative to each other, or over the ground.
#include "ayumi/author/import/contact_detection.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

// Thresholds of the detection, between the speeds and heights of standing feet and those of swings.

/// Largest relative speed of standing feet [m/s]. Chosen: a seventh of the mean speed of a swing of
/// the generated walk (60 mm in 0.45 s). With half of the value, contact 3 of the imported walk
/// begins at 1.553 s instead of 1.543 s; with twice, at 1.527 s.
constexpr double kRestSpeed = 0.020;
/// Lever with which a rotation is added to a displacement: it counts as the movement of a point at
/// this distance [m]. Derived: half the length of HOAP-1's sole (98 mm).
constexpr double kLever = 0.05;
/// Largest difference in height of standing feet [m]. Chosen: a fifth of the lift of the generated
/// walk (15 mm). No measured case changes between half and twice the value (constants.md).
constexpr double kLevel = 0.003;
/// At an immediate change of the supporting foot: largest speed of the feet along the ground [m/s].
/// Chosen: twice kRestSpeed, because recorded commands compensate the compliance of loaded legs. No
/// measured case changes between half and twice the value (constants.md).
constexpr double kHandoverSpeed = 0.04;
/// At such a change: time before and after it in which both feet may support [s]. Chosen: about
/// half a step of the generated walk (0.55 s). No measured case changes between half and twice the
/// value (constants.md).
constexpr double kHandoverTime = 0.3;
/// At such a change: largest difference in height [m]. Chosen: two thirds of the lift of the
/// generated walk (15 mm). No measured case changes between half and twice the value
/// (constants.md).
constexpr double kHandoverHeight = 0.01;
/// Speeds are differences over twice this time [s]. Derived: one count of a HOAP servo (8e-5 rad)
/// at 0.3 m is then 1 mm/s, small against kRestSpeed.
constexpr double kLook = 0.010;
/// Shortest time with one support [s]. Chosen: a fifth of the double support of the generated walk
/// (0.1 s). No measured case changes between half and twice the value (constants.md).
constexpr double kShortestSupport = 0.02;

double speed_between(const Isometry3d& from, const Isometry3d& to, double time) {
  const Vector3d turn = log_rotation(Quaterniond(from.linear().transpose() * to.linear()));
  return ((to.translation() - from.translation()).norm() + kLever * turn.norm()) / time;
}

// The label of each row: +1 if only the left foot supports, -1 if only the right foot supports, 0
// if both support, and 2 if it is undecided because a foot moves at too low a height.
std::vector<int> relative_labels(const RobotModel& model, const Soles& soles, double dt) {
  const int n = static_cast<int>(soles[0].size());
  const int look = std::max(1, static_cast<int>(std::lround(kLook / dt)));
  const auto relative = [&](int k) { return soles[0][k].inverse() * soles[1][k]; };
  const auto center = [&](Side side) {
    const Eigen::Vector2d& c = model.sole(side).center;
    return Vector3d(c.x(), c.y(), 0);
  };
  std::vector<int> labels(n);
  for (int k = 0; k < n; ++k) {
    const int a = std::max(0, k - look), b = std::min(n - 1, k + look);
    const double speed = speed_between(relative(a), relative(b), (b - a) * dt);
    const double right_up = (relative(k) * center(Side::right)).z();
    const double left_up = (relative(k).inverse() * center(Side::left)).z();
    const double height = 0.5 * (right_up - left_up);
    labels[k] = speed < kRestSpeed && std::abs(height) < kLevel ? 0
                : std::abs(height) < kLevel / 2                 ? 2
                : height > 0                                    ? 1
                                                                : -1;
  }
  return labels;
}

// Undecided rows join the nearest decided row that is not double support.
void tell_low_swings(std::vector<int>& labels) {
  const int n = static_cast<int>(labels.size());
  for (int k = 0; k < n;) {
    int last = k;
    while (last + 1 < n && labels[last + 1] == labels[k]) ++last;
    if (labels[k] == 2) {
      const int before = k > 0 ? labels[k - 1] : 0, after = last + 1 < n ? labels[last + 1] : 0;
      for (int i = k; i <= last; ++i)
        labels[i] = before == 0 || before == 2 ? after
                    : after == 0               ? before
                    : i - k < last - i         ? before
                                               : after;
    }
    k = last + 1;
  }
}

// Recorded commands of real robots compensate the compliance under load. In such commands, the
// soles never rest relative to each other at the same height. At an immediate change of the
// supporting foot both feet support as long as they do not move apart along the ground and have
// nearly the same height.
void add_handovers(const Soles& soles, double dt, std::vector<int>& labels) {
  const int n = static_cast<int>(labels.size());
  const int look = std::max(1, static_cast<int>(std::lround(kLook / dt)));
  const auto ground_normal = [&](int k) {
    return Vector3d((soles[0][k].linear().col(2) + soles[1][k].linear().col(2)).normalized());
  };
  // Computed in the axes of the left foot, which hardly moves at these times.
  const auto between = [&](int k) -> Vector3d {
    return soles[0][k].linear().transpose() *
           (soles[1][k].translation() - soles[0][k].translation());
  };
  const auto stands = [&](int k) {
    const int a = std::max(0, k - look), b = std::min(n - 1, k + look);
    const Vector3d up = soles[0][k].linear().transpose() * ground_normal(k);
    const Vector3d speed = (between(b) - between(a)) / ((b - a) * dt);
    return (speed - up.dot(speed) * up).norm() < kHandoverSpeed &&
           std::abs(up.dot(between(k))) < kHandoverHeight;
  };
  const int near = static_cast<int>(std::lround(kHandoverTime / dt));
  const std::vector<int> given = labels;
  for (int k = 1; k < n; ++k) {
    if (given[k] == 0 || given[k - 1] == 0 || given[k] == given[k - 1]) continue;
    for (int i = std::max(0, k - near); i < std::min(n, k + near); ++i)
      if (stands(i)) labels[i] = 0;
  }
}

// Vertical force that the motion of the COG needs in each row, as a multiple of the weight.
std::vector<double> loads_of(const RobotModel& model, const RawMotion& motion) {
  const int n = static_cast<int>(motion.theta.rows());
  // Half of the time over which the acceleration is a mean [s]. Chosen: long against the rows of a
  // recording (33 ms), short against a flight (0.2 s and more).
  constexpr double kMean = 0.07;
  const int w = std::max(1, static_cast<int>(std::lround(kMean / motion.dt)));
  RobotData data(model);
  std::vector<double> height;
  for (int k = 0; k < n; ++k) {
    RobotState state = model.rest_state();
    state.theta = motion.theta.row(k).transpose();
    state.base = motion.base[static_cast<size_t>(k)];
    update_positions(model, state, data);
    height.push_back(data.cog.z());
  }
  std::vector<double> loads(static_cast<size_t>(n), 1);
  for (int k = 0; k < n; ++k) {
    const int c = std::clamp(k, w, std::max(w, n - 1 - w));
    if (c + w >= n) continue;
    const double time = w * motion.dt;
    loads[static_cast<size_t>(k)] =
        1 + (height[static_cast<size_t>(c + w)] - 2 * height[static_cast<size_t>(c)] +
             height[static_cast<size_t>(c - w)]) /
                (time * time * kGravity);
  }
  return loads;
}

// In rows in which no sole rests although the robot does not fall, a foot supports the robot if it
// is slow enough and near the lowest height around this row.
void carry_loaded_rows(const RobotModel& model, const RawMotion& motion, const Soles& soles,
                       std::vector<Support>& supports) {
  if (std::find(supports.begin(), supports.end(), Support::none) == supports.end()) return;
  const int n = static_cast<int>(supports.size());
  const std::vector<double> loads = loads_of(model, motion);
  std::array<std::vector<double>, 2> low;
  for (int s : {0, 1})
    for (int k = 0; k < n; ++k) low[s].push_back(lowest_point(model, soles, s, k));
  // Half of the time in which the lowest height of a sole is searched [s]. Chosen: a step.
  constexpr double kWindow = 0.5;
  const int window = std::max(1, static_cast<int>(std::lround(kWindow / motion.dt)));
  const int look = std::max(1, static_cast<int>(std::lround(kLook / motion.dt)));
  for (int k = 0; k < n; ++k) {
    if (supports[k] != Support::none || loads[static_cast<size_t>(k)] < motion.contact.load)
      continue;
    double ground = 1e300;
    for (int i = std::max(0, k - window); i <= std::min(n - 1, k + window); ++i)
      ground = std::min({ground, low[0][i], low[1][i]});
    const int a = std::max(0, k - look), b = std::min(n - 1, k + look);
    std::array<bool, 2> down;
    for (int s : {0, 1})
      down[s] = low[s][k] - ground < motion.contact.height &&
                speed_between(soles[s][a], soles[s][b], (b - a) * motion.dt) < motion.contact.speed;
    supports[k] = down[0] && down[1] ? Support::both
                  : down[0]          ? Support::left
                  : down[1]          ? Support::right
                                     : Support::none;
  }
}

std::vector<Support> supports_with_base(const RobotModel& model, const Soles& soles, double dt) {
  const int n = static_cast<int>(soles[0].size());
  const int look = std::max(1, static_cast<int>(std::lround(kLook / dt)));
  const auto lowest = [&](int s, int k) { return lowest_point(model, soles, s, k); };
  double ground = 1e300;
  for (int k = 0; k < n; ++k) ground = std::min({ground, lowest(0, k), lowest(1, k)});
  std::vector<Support> result(n);
  for (int k = 0; k < n; ++k) {
    std::array<bool, 2> down;
    for (int s : {0, 1}) {
      const int a = std::max(0, k - look), b = std::min(n - 1, k + look);
      down[s] = lowest(s, k) - ground < kLevel &&
                speed_between(soles[s][a], soles[s][b], (b - a) * dt) < kRestSpeed;
    }
    result[k] = down[0] && down[1] ? Support::both
                : down[0]          ? Support::left
                : down[1]          ? Support::right
                                   : Support::none;
  }
  return result;
}

// The shortest interval below the limit is joined with its longer neighbour, until no such interval
// is left.
std::vector<Support> without_blinks(std::vector<Support> supports, double dt) {
  const int least = static_cast<int>(std::lround(kShortestSupport / dt));
  while (true) {
    const std::vector<Stretch> all = stretches(supports);
    const auto length = [&](size_t i) { return all[i].last - all[i].first + 1; };
    size_t shortest = all.size();
    for (size_t i = 0; i < all.size(); ++i)
      if (length(i) < least && (shortest == all.size() || length(i) < length(shortest)))
        shortest = i;
    if (shortest == all.size() || all.size() == 1) return supports;
    const bool back = shortest + 1 == all.size() ||
                      (shortest > 0 && length(shortest - 1) >= length(shortest + 1));
    const Support joined = all[back ? shortest - 1 : shortest + 1].support;
    std::fill(supports.begin() + all[shortest].first, supports.begin() + all[shortest].last + 1,
              joined);
  }
}

// Distance of the COG from a sole in row k, seen from above the sole; below 0 if the COG is inside.
double cog_outside(const RobotModel& model, const RawMotion& motion, const Soles& soles, int foot,
                   int k) {
  RobotState state = model.rest_state();
  state.theta = motion.theta.row(k).transpose();
  if (!motion.base.empty()) state.base = motion.base[static_cast<size_t>(k)];
  RobotData data(model);
  update_positions(model, state, data);
  const Vector3d cog = soles[foot][k].inverse() * data.cog;
  return -ConvexPolygon(model.sole(static_cast<Side>(foot)).polygon).margin(cog.head<2>());
}

// One foot alone can carry the robot for a short time only if the COG is near this foot; otherwise
// the ZMP would be far outside of the sole. A short support by one foot for which this does not
// hold is added to the adjacent double support, or otherwise to the longer one of its neighbours.
std::vector<Support> without_doubtful_moments(const RobotModel& model, const RawMotion& motion,
                                              const Soles& soles, std::vector<Support> supports) {
  // Duration up to which a support by one foot is doubtful [s]. Chosen: a quarter of the single
  // support of the generated walk (0.45 s), and longer than a landing in which one foot touches
  // first.
  constexpr double kMoment = 0.1;
  const std::vector<Stretch> all = stretches(supports);
  for (size_t i = 0; i < all.size() && all.size() > 1; ++i) {
    const Stretch& run = all[i];
    const int rows = run.last - run.first + 1;
    if (run.support == Support::both || run.support == Support::none || rows * motion.dt > kMoment)
      continue;
    const int foot = run.support == Support::left ? 0 : 1;
    // If the COG is farther than this outside the sole, one foot alone cannot carry the robot [m].
    // Chosen: half the width of the sole.
    Eigen::AlignedBox2d sole;
    for (const Eigen::Vector2d& corner : model.sole(static_cast<Side>(foot)).polygon)
      sole.extend(corner);
    const double aside = 0.5 * sole.sizes().minCoeff();
    if (cog_outside(model, motion, soles, foot, (run.first + run.last) / 2) < aside) continue;
    const auto length = [&](size_t n) { return all[n].last - all[n].first; };
    const bool before = i > 0, after = i + 1 < all.size();
    const bool back =
        before && (!after || all[i - 1].support == Support::both ||
                   (all[i + 1].support != Support::both && length(i - 1) >= length(i + 1)));
    std::fill(supports.begin() + run.first, supports.begin() + run.last + 1,
              all[back ? i - 1 : i + 1].support);
  }
  return supports;
}

// Height of a sole's centre over the other sole, or over the ground if the motion has a base.
double height_of(const RobotModel& model, const RawMotion& motion, const Soles& soles, int foot,
                 int k) {
  const Eigen::Vector2d& c = model.sole(static_cast<Side>(foot)).center;
  const Vector3d center = soles[foot][k] * Vector3d(c.x(), c.y(), 0);
  return motion.base.empty() ? (soles[1 - foot][k].inverse() * center).z() : center.z();
}

RobotState state_of(const RobotModel& model, const RawMotion& motion, Eigen::Index k) {
  RobotState state = model.rest_state();
  state.theta = motion.theta.row(k).transpose();
  if (!motion.base.empty()) state.base = motion.base[static_cast<size_t>(k)];
  return state;
}

}  // namespace

double lowest_point(const RobotModel& model, const Soles& soles, int foot, int k) {
  double low = 1e300;
  for (const Eigen::Vector2d& v : model.sole(static_cast<Side>(foot)).polygon)
    low = std::min(low, (soles[foot][k] * Vector3d(v.x(), v.y(), 0)).z());
  return low;
}

Soles soles_of(const RobotModel& model, const RawMotion& motion) {
  RobotData data(model);
  Soles soles;
  for (Eigen::Index k = 0; k < motion.theta.rows(); ++k) {
    update_positions(model, state_of(model, motion, k), data);
    for (const Side side : {Side::left, Side::right})
      soles[static_cast<size_t>(side)].push_back(sole_pose(model, data, side));
  }
  return soles;
}

std::vector<Stretch> stretches(const std::vector<Support>& supports) {
  std::vector<Stretch> result;
  for (int k = 0; k < static_cast<int>(supports.size()); ++k) {
    if (result.empty() || result.back().support != supports[k])
      result.push_back({k, k, supports[k]});
    result.back().last = k;
  }
  return result;
}

std::vector<Support> supports_with_swing_ends(const RobotModel& model, const RawMotion& motion,
                                              const Soles& soles) {
  if (!motion.base.empty()) {
    std::vector<Support> result = supports_with_base(model, soles, motion.dt);
    carry_loaded_rows(model, motion, soles, result);
    result = without_blinks(std::move(result), motion.dt);
    return without_doubtful_moments(model, motion, soles, std::move(result));
  }
  std::vector<int> labels = relative_labels(model, soles, motion.dt);
  tell_low_swings(labels);
  add_handovers(soles, motion.dt, labels);
  std::vector<Support> result;
  for (const int label : labels)
    result.push_back(label == 1 ? Support::left : label == -1 ? Support::right : Support::both);
  result = without_blinks(std::move(result), motion.dt);
  return without_doubtful_moments(model, motion, soles, std::move(result));
}

// The detection returns `both` during the slow end or start of a swing. Where the sole comes to
// rest before the middle of this interval, the contact begins (or ends) at the rest.
std::vector<Support> without_swing_ends(const RobotModel& model, const RawMotion& motion,
                                        const Soles& soles, std::vector<Support> supports) {
  // A foot this much above its place at rest has left it [m]. Chosen: above the rounding of tables.
  // With half of the value, contact 1 of the imported walk ends at 1.678 s instead of 1.681 s; with
  // twice, at 1.683 s.
  constexpr double kAtRest = 1e-5;
  // A sole that sinks down to kAtRest for more than this share of the time from the edge to the
  // middle takes up load and does not end its swing. Chosen: a half, between the slow end of a
  // swing and a sole that sinks as long as it carries the robot.
  constexpr double kSinking = 0.5;
  for (const Stretch& run : stretches(supports)) {
    if (run.support != Support::both) continue;
    for (const int step : {1, -1}) {
      const int edge = step > 0 ? run.first : run.last, outside = edge - step;
      if (outside < 0 || outside >= static_cast<int>(supports.size())) continue;
      if (supports[outside] == Support::none) continue;
      const int foot = supports[outside] == Support::left ? 1 : 0;
      const auto height = [&](int k) { return height_of(model, motion, soles, foot, k); };
      const int middle = (run.first + run.last) / 2;
      int least = edge;
      while (least != middle && height(least + step) < height(least)) least += step;
      const double place = height(least);
      int rest = edge;
      while (rest != least && height(rest) > place + kAtRest) rest += step;
      if (least == middle && std::abs(rest - edge) > kSinking * std::abs(middle - edge)) continue;
      for (int k = edge; k != rest; k += step) supports[k] = supports[outside];
    }
  }
  return supports;
}

}  // namespace ayumi
