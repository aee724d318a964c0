// Sole frames F (world) and S_k (in the base, row k): a foot that stands at F puts the base at
// F S_k^-1. The next foothold of a foot B that lands beside A is F_A times the relative pose
// S_A^-1 S_B while both carry, made level.
#include "ayumi/pattern/grounded_motion.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/math/track.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr double kRest = 0.020;           // relative speed of feet that stand [m/s]
constexpr double kLever = 0.05;           // a turn counts as the speed of a point this far [m]
constexpr double kLevel = 0.003;          // difference of heights of feet that stand [m]
constexpr double kHandoverSpeed = 0.04;   // of feet along the ground as one takes over [m/s]
constexpr double kHandoverTime = 0.3;     // within which one takes over [s]
constexpr double kHandoverHeight = 0.01;  // between them [m]
constexpr double kLook = 0.010;           // speeds are differences over twice this [s]
constexpr double kShortest = 0.02;        // stretch of one support [s]

using Soles = std::array<std::vector<Isometry3d>, 2>;  // by Side, then row

RobotState state_of(const RobotModel& model, const RawMotion& motion, Eigen::Index k) {
  RobotState state = model.rest_state();
  state.theta = motion.theta.row(k).transpose();
  if (!motion.base.empty()) state.base = motion.base[static_cast<size_t>(k)];
  return state;
}

// In the world where the motion has a base, else in the base.
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

double speed_between(const Isometry3d& from, const Isometry3d& to, double time) {
  const Vector3d turn = log_rotation(Quaterniond(from.linear().transpose() * to.linear()));
  return ((to.translation() - from.translation()).norm() + kLever * turn.norm()) / time;
}

// +1: only the left carries, -1: only the right, 0: both, 2: moving too low to tell.
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
    labels[k] = speed < kRest && std::abs(height) < kLevel ? 0
                : std::abs(height) < kLevel / 2            ? 2
                : height > 0                               ? 1
                                                           : -1;
  }
  return labels;
}

// Rows that cannot be told join the nearer told row beside them that is not double support.
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

// Real robots are told angles that make up for what gives way under load, so that their soles never
// rest against each other at one height. Where one foot takes over from the other at once, both
// carry as long as they do not part along the ground, and are not far from one height.
void add_handovers(const Soles& soles, double dt, std::vector<int>& labels) {
  const int n = static_cast<int>(labels.size());
  const int look = std::max(1, static_cast<int>(std::lround(kLook / dt)));
  const auto ground_normal = [&](int k) {
    return Vector3d((soles[0][k].linear().col(2) + soles[1][k].linear().col(2)).normalized());
  };
  // In the axes of the left foot, which is as good as still at those times.
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

std::vector<Support> supports_with_base(const RobotModel& model, const Soles& soles, double dt) {
  const int n = static_cast<int>(soles[0].size());
  const int look = std::max(1, static_cast<int>(std::lround(kLook / dt)));
  const auto lowest = [&](int s, int k) {
    double low = 1e300;
    for (const Eigen::Vector2d& v : model.sole(static_cast<Side>(s)).polygon)
      low = std::min(low, (soles[s][k] * Vector3d(v.x(), v.y(), 0)).z());
    return low;
  };
  double ground = 1e300;
  for (int k = 0; k < n; ++k) ground = std::min({ground, lowest(0, k), lowest(1, k)});
  std::vector<Support> result(n);
  for (int k = 0; k < n; ++k) {
    std::array<bool, 2> down;
    for (int s : {0, 1}) {
      const int a = std::max(0, k - look), b = std::min(n - 1, k + look);
      down[s] = lowest(s, k) - ground < kLevel &&
                speed_between(soles[s][a], soles[s][b], (b - a) * dt) < kRest;
    }
    result[k] = down[0] && down[1] ? Support::both
                : down[0]          ? Support::left
                : down[1]          ? Support::right
                                   : Support::none;
  }
  return result;
}

struct Stretch {
  int first = 0, last = 0;
  Support support = Support::both;
};

std::vector<Stretch> stretches(const std::vector<Support>& supports) {
  std::vector<Stretch> result;
  for (int k = 0; k < static_cast<int>(supports.size()); ++k) {
    if (result.empty() || result.back().support != supports[k])
      result.push_back({k, k, supports[k]});
    result.back().last = k;
  }
  return result;
}

// The shortest stretch below the limit goes to its longer neighbour, until there is none.
std::vector<Support> without_blinks(std::vector<Support> supports, double dt) {
  const int least = static_cast<int>(std::lround(kShortest / dt));
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

std::vector<Support> supports_from(const RobotModel& model, const RawMotion& motion,
                                   const Soles& soles) {
  if (!motion.base.empty())
    return without_blinks(supports_with_base(model, soles, motion.dt), motion.dt);
  std::vector<int> labels = relative_labels(model, soles, motion.dt);
  tell_low_swings(labels);
  add_handovers(soles, motion.dt, labels);
  std::vector<Support> result;
  for (const int label : labels)
    result.push_back(label == 1 ? Support::left : label == -1 ? Support::right : Support::both);
  return without_blinks(std::move(result), motion.dt);
}

Isometry3d level(const Isometry3d& pose) {
  Isometry3d flat = Isometry3d::Identity();
  flat.translation() << pose.translation().x(), pose.translation().y(), 0;
  flat.linear() = rpy_to_matrix({0, 0, matrix_to_rpy(pose.linear()).z()});
  return flat;
}

Foothold foothold_of(const Isometry3d& pose) {
  return {pose.translation(), {0, 0, matrix_to_rpy(pose.linear()).z()}};
}

class Grounding {
 public:
  Grounding(const RobotModel& model, const RawMotion& motion)
      : model_(model),
        motion_(motion),
        soles_(soles_of(model, motion)),
        supports_(motion.support.empty() ? supports_from(model, motion, soles_) : motion.support),
        runs_(stretches(supports_)),
        place_(runs_.size()) {}

  GroundedMotion whole(const std::string& table) {
    if (motion_.base.empty())
      place_feet();
    else
      read_feet();
    GroundedMotion result;
    fill_phases(result);
    fill_table(result.pattern, table);
    return result;
  }

 private:
  int middle(size_t run) const { return (runs_[run].first + runs_[run].last) / 2; }
  bool carries(size_t run, int foot) const {
    return supports(runs_[run].support, static_cast<Side>(foot));
  }

  // Both feet at first, as they are to each other; then each new contact beside the other foot.
  void place_feet() {
    const int k = middle(0);
    const Isometry3d right = soles_[0][k].inverse() * soles_[1][k];
    std::array<Isometry3d, 2> now = {Isometry3d::Identity(), level(right)};
    const Isometry3d center = center_of(now);
    for (Isometry3d& foot : now) foot = center.inverse() * foot;
    for (size_t r = 0; r < runs_.size(); ++r) {
      for (int foot : {0, 1}) {
        const bool lands = r > 0 && carries(r, foot) && !carries(r - 1, foot);
        if (lands) {
          const int at = carries(r, 1 - foot) ? middle(r) : runs_[r].first;
          now[foot] = level(now[1 - foot] * soles_[1 - foot][at].inverse() * soles_[foot][at]);
        }
      }
      place_[r] = now;
    }
  }

  static Isometry3d center_of(const std::array<Isometry3d, 2>& feet) {
    Isometry3d center = Isometry3d::Identity();
    center.translation() = 0.5 * (feet[0].translation() + feet[1].translation());
    const Vector3d heading = feet[0].linear().col(0) + feet[1].linear().col(0);
    center.linear() = rpy_to_matrix({0, 0, std::atan2(heading.y(), heading.x())});
    return center;
  }

  void read_feet() {
    for (size_t r = 0; r < runs_.size(); ++r)
      for (int foot : {0, 1})
        place_[r][foot] = r > 0 && carries(r, foot) && carries(r - 1, foot)
                              ? place_[r - 1][foot]
                              : level(soles_[foot][middle(r)]);
  }

  double time(int k) const { return k * motion_.dt; }

  double lift_of(size_t run, int foot) const {
    double highest = 0;
    for (int k = runs_[run].first; k <= runs_[run].last; ++k) {
      const Isometry3d relative = soles_[1 - foot][k].inverse() * soles_[foot][k];
      highest = std::max(highest, relative.translation().z());
    }
    return highest;
  }

  void fill_phases(GroundedMotion& result) const {
    Pattern& pattern = result.pattern;
    const bool flies = std::any_of(runs_.begin(), runs_.end(),
                                   [](const Stretch& run) { return run.support == Support::none; });
    for (int foot : {0, 1}) pattern.start_feet[foot] = foothold_of(place_[0][foot]);
    for (size_t r = 0; r < runs_.size(); ++r) {
      Phase phase;
      phase.support = runs_[r].support;
      phase.until = time(runs_[r].last + (r + 1 < runs_.size() ? 1 : 0));
      if (!flies && phase.support != Support::both && r + 1 < runs_.size()) {
        const int foot = phase.support == Support::left ? 1 : 0;
        phase.swing =
            Swing{static_cast<Side>(foot), foothold_of(place_[r + 1][foot]), lift_of(r, foot)};
      }
      pattern.phases.push_back(phase);
    }
    for (int foot : {0, 1}) add_contacts(foot, result.contacts);
    std::stable_sort(result.contacts.begin(), result.contacts.end(),
                     [](const FootContact& a, const FootContact& b) { return a.begin < b.begin; });
  }

  void add_contacts(int foot, std::vector<FootContact>& contacts) const {
    for (size_t r = 0; r < runs_.size(); ++r) {
      if (!carries(r, foot)) continue;
      const bool goes_on = r > 0 && carries(r - 1, foot);
      if (!goes_on)
        contacts.push_back(
            {static_cast<Side>(foot), time(runs_[r].first), 0, foothold_of(place_[r][foot])});
      contacts.back().end = time(runs_[r].last + (r + 1 < runs_.size() ? 1 : 0));
    }
  }

  // Share of the right foot in carrying the base.
  double share(size_t run, int k) const {
    const auto single = [&](size_t r) { return runs_[r].support == Support::right ? 1.0 : 0.0; };
    const bool before = run > 0, after = run + 1 < runs_.size();
    if (runs_[run].support != Support::both) return single(run);
    const double from = before ? single(run - 1) : 0.5, to = after ? single(run + 1) : 0.5;
    const double u =
        static_cast<double>(k - runs_[run].first + 1) / (runs_[run].last - runs_[run].first + 2);
    return from + (to - from) * minimum_jerk(u).value;
  }

  BasePose base_at(size_t run, int k) const {
    const double right = share(run, k);
    const Isometry3d by_left = place_[run][0] * soles_[0][k].inverse();
    const Isometry3d by_right = place_[run][1] * soles_[1][k].inverse();
    BasePose base;
    base.position = (1 - right) * by_left.translation() + right * by_right.translation();
    base.attitude = Quaterniond(by_left.linear()).slerp(right, Quaterniond(by_right.linear()));
    return base;
  }

  void fill_table(Pattern& pattern, const std::string& table) const {
    DenseTable dense;
    dense.file = table;
    dense.dt = motion_.dt;
    dense.joints = model_.dof_names();
    dense.theta = motion_.theta;
    dense.base = motion_.base;
    dense.cog = motion_.cog;
    dense.zmp = motion_.zmp;
    dense.fz = motion_.fz;
    if (motion_.base.empty())
      for (size_t r = 0; r < runs_.size(); ++r)
        for (int k = runs_[r].first; k <= runs_[r].last; ++k) dense.base.push_back(base_at(r, k));
    pattern.table = std::move(dense);
  }

  const RobotModel& model_;
  const RawMotion& motion_;
  const Soles soles_;
  const std::vector<Support> supports_;
  const std::vector<Stretch> runs_;
  std::vector<std::array<Isometry3d, 2>> place_;  // by run, then Side
};

void require_motion(const RobotModel& model, const RawMotion& motion) {
  if (!model.has_soles())
    fail(ErrorCode::bad_model, model.name() + ": the robot has no soles; name both in its sidecar");
  if (motion.theta.rows() < 6)
    fail(ErrorCode::bad_pattern,
         "a motion of " + std::to_string(motion.theta.rows()) + " rows; at least 6 are needed");
}

}  // namespace

std::vector<Support> detect_supports(const RobotModel& model, const RawMotion& motion) {
  require_motion(model, motion);
  return supports_from(model, motion, soles_of(model, motion));
}

GroundedMotion grounded(const RobotModel& model, const RawMotion& motion,
                        const std::string& table) {
  require_motion(model, motion);
  return Grounding(model, motion).whole(table);
}

}  // namespace ayumi
