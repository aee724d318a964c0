// With sole frames F (world) and S_k (in the base, row k), a foot that stands at F gives the base
// the pose F S_k^-1. The next foothold of a foot B that lands beside A is F_A times the relative
// pose S_A^-1 S_B while both support, made level. Feet that are not exactly level give the base two
// poses while both support, and the base moves from one to the other.
// No step looks at the ZMP, because a base that is placed by the ZMP hides errors of the motion.
#include "ayumi/author/import/contact_reconstruction.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/author/import/contact_detection.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/math/track.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

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
  Grounding(const RobotModel& model, const RawMotion& motion, const Soles& soles,
            const std::vector<Support>& supports)
      : model_(model),
        motion_(motion),
        soles_(soles),
        runs_(with_last_row(stretches(supports))),
        place_(runs_.size()) {
    if (motion_.base.empty())
      place_feet();
    else
      read_feet();
    if (!motion_.base.empty()) return;
    find_disagreement();
    levels_both_ = disagreement_.length > kLevelFeet && soles_stay_parallel();
  }

  GroundedMotion whole(const std::string& table) const {
    GroundedMotion result;
    fill_phases(result);
    result.notes = motion_.base.empty() ? notes_of_disagreement() : notes();
    fill_table(result.pattern, table);
    return result;
  }

  // The track of the base of a motion that has none.
  std::vector<BasePose> base_by_feet() const {
    std::vector<BasePose> track;
    for (size_t r = 0; r < runs_.size(); ++r)
      for (int k = runs_[r].first; k <= runs_[r].last; ++k) track.push_back(base_at(r, k));
    return track;
  }

 private:
  // How much the feet differ about the place of the base while both support [m].
  struct Disagreement {
    double length = 0;  // between the two places
    double zmp = 0;     // by which the ZMP moves because the base moves from one to the other
  };

  // The last row has no time of its own, so a change in it belongs to the rows before.
  static std::vector<Stretch> with_last_row(std::vector<Stretch> runs) {
    if (runs.size() < 2 || runs.back().first < runs.back().last) return runs;
    runs[runs.size() - 2].last = runs.back().last;
    runs.pop_back();
    return runs;
  }

  std::string millimetres(double length) const { return text::brief(1000 * length, 3) + " mm"; }

  std::vector<std::string> notes() const {
    // Lengths below these are not reported [m]. Chosen: the compliance of a sole hides them.
    constexpr double kSaid = 0.001;
    double floats = 0, sinks = 0, slides = 0, flight = 0;
    std::vector<std::string> flights;
    for (size_t r = 0; r < runs_.size(); ++r) {
      if (runs_[r].support == Support::none) {
        flights.push_back(text::brief(time(runs_[r].first), 5) + " to " +
                          text::brief(time(runs_[r].last), 5) + " s");
        flight += time(runs_[r].last - runs_[r].first + 1);
      }
      for (int foot : {0, 1}) {
        if (!carries(r, foot)) continue;
        for (int k = runs_[r].first; k <= runs_[r].last; ++k) {
          const double low = lowest_point(model_, soles_, foot, k);
          floats = std::max(floats, low);
          sinks = std::max(sinks, -low);
          slides = std::max(
              slides, (soles_[foot][k].translation() - soles_[foot][runs_[r].first].translation())
                          .head<2>()
                          .norm());
        }
      }
    }
    std::vector<std::string> result;
    std::vector<std::string> ways;
    if (floats > kSaid) ways.push_back("up to " + millimetres(floats) + " above the ground");
    if (sinks > kSaid) ways.push_back("up to " + millimetres(sinks) + " below the ground");
    if (!ways.empty())
      result.push_back(
          "supporting soles are " + text::join(ways, " and ") +
          " (--ground moves the robot up or down until the supporting soles touch the ground)");
    if (slides > kSaid) result.push_back("supporting soles slide by up to " + millimetres(slides));
    constexpr size_t kMost = 6;  // flights in a line. Chosen: a person can still read the line
    if (flight > 0)
      result.push_back("no sole rests on the ground for " + text::brief(flight, 3) + " s (" +
                       text::join_first(flights, kMost) +
                       "). Ayumi takes this time as flight. --contact-height and --contact-speed "
                       "decide when a sole counts as resting on the ground");
    return result;
  }

  // Feet that differ by less are taken as level [m]. Chosen: rounded angles give this difference.
  static constexpr double kLevelFeet = 0.0001;

  void find_disagreement() {
    for (size_t r = 0; r < runs_.size(); ++r) {
      if (runs_[r].support != Support::both) continue;
      double length = 0;
      for (int k = runs_[r].first; k <= runs_[r].last; ++k)
        length = std::max(length,
                          (base_by(r, 0, k).translation() - base_by(r, 1, k).translation()).norm());
      disagreement_.length = std::max(disagreement_.length, length);
      disagreement_.zmp = std::max(disagreement_.zmp, moved_zmp(r, length));
    }
  }

  // How far the ZMP moves [m] because the base moves by `length` from one foot to the other: h/g
  // times the peak acceleration of minimum jerk, which is 10/sqrt(3) for a unit path in a unit
  // time.
  double moved_zmp(size_t run, double length) const {
    const auto [from, to] = shares_at_ends(run);
    const double duration = time(runs_[run].last - runs_[run].first + 2);
    RobotState state = model_.rest_state();
    state.theta = motion_.theta.row(middle(run)).transpose();
    RobotData data(model_);
    update_positions(model_, state, data);
    const double height = (soles_[0][middle(run)].inverse() * data.cog).z();
    return height * std::abs(to - from) * length * 10 / std::sqrt(3.0) / (duration * duration) /
           kGravity;
  }

  // Whether the soles are parallel in all rows, in swings too. Then the motion was made for level
  // soles, and if the legs cannot keep them level, both soles are tilted.
  bool soles_stay_parallel() const {
    // Largest angle between the soles [rad]. Chosen: the error of legs of five joints in a walk is
    // below 1 mrad; feet that roll over heel or toes turn by more than 10 mrad.
    constexpr double kParallel = 0.003;
    for (size_t k = 0; k < soles_[0].size(); ++k)
      if (soles_[0][k].linear().col(2).cross(soles_[1][k].linear().col(2)).norm() > kParallel)
        return false;
    return true;
  }

  std::vector<std::string> notes_of_disagreement() const {
    if (disagreement_.length < kLevelFeet) return {};
    return {
        "the soles are not exactly level: while both stand, the places that they give the base "
        "differ by up to " +
        millimetres(disagreement_.length) +
        ". The base moves from one place to the other, which alone moves the ZMP by up to " +
        millimetres(disagreement_.zmp) +
        ", so the ZMP that `check` judges is uncertain by this length or more. A file that also "
        "has "
        "the track of the root has no such error"};
  }

  int middle(size_t run) const { return (runs_[run].first + runs_[run].last) / 2; }
  bool carries(size_t run, int foot) const {
    return supports(runs_[run].support, static_cast<Side>(foot));
  }

  // Places both feet first, by their relative pose, and then each new contact relative to the other
  // foot.
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
    center.linear() = rpy_to_matrix({0, 0, elementary::atan2(heading.y(), heading.x())});
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

  // Shares of the right foot in the base's pose at both ends of a run, from 0 to 1.
  std::array<double, 2> shares_at_ends(size_t run) const {
    const auto single = [&](size_t r) { return runs_[r].support == Support::right ? 1.0 : 0.0; };
    if (runs_[run].support != Support::both) return {single(run), single(run)};
    return {run > 0 ? single(run - 1) : 0.5, run + 1 < runs_.size() ? single(run + 1) : 0.5};
  }

  // This share in row k.
  double share(size_t run, int k) const {
    const auto [from, to] = shares_at_ends(run);
    const double u =
        static_cast<double>(k - runs_[run].first + 1) / (runs_[run].last - runs_[run].first + 2);
    return from + (to - from) * minimum_jerk(u).value;
  }

  // The pose of the base if this foot is in its place.
  Isometry3d base_by(size_t run, int foot, int k) const {
    return place_[run][foot] * soles_[foot][k].inverse();
  }

  BasePose base_at(size_t run, int k) const {
    const double right = share(run, k);
    const Isometry3d by_left = base_by(run, 0, k), by_right = base_by(run, 1, k);
    BasePose base;
    base.position = (1 - right) * by_left.translation() + right * by_right.translation();
    base.attitude =
        elementary::between(Quaterniond(by_left.linear()), Quaterniond(by_right.linear()), right);
    if (!levels_both_) return base;
    // The mean of both tilts is level.
    const Vector3d normals =
        base.attitude * (soles_[0][k].linear().col(2) + soles_[1][k].linear().col(2));
    base.attitude = exp_rotation(0.5 * normals.cross(Vector3d::UnitZ())) * base.attitude;
    const auto position_by = [&](int foot) -> Vector3d {
      return place_[run][foot].translation() - base.attitude * soles_[foot][k].translation();
    };
    base.position = (1 - right) * position_by(0) + right * position_by(1);
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
    if (motion_.base.empty()) dense.base = base_by_feet();
    pattern.table = std::move(dense);
  }

  const RobotModel& model_;
  const RawMotion& motion_;
  const Soles& soles_;
  const std::vector<Stretch> runs_;
  Disagreement disagreement_;
  bool levels_both_ = false;  // both soles are leveled, not only those that stand
  std::vector<std::array<Isometry3d, 2>> place_;  // places of the feet, by run, then by Side
};

// The supports of a motion that does not state them. Without a base, heights are first known above
// the other sole only. Where this sole is not exactly level, the times of contacts are wrong, so
// they are found again with the base that follows.
std::vector<Support> found_supports(const RobotModel& model, const RawMotion& motion,
                                    const Soles& soles) {
  const std::vector<Support> supports = supports_with_swing_ends(model, motion, soles);
  const std::vector<Support> first = without_swing_ends(model, motion, soles, supports);
  if (!motion.base.empty()) return first;
  RawMotion placed;
  placed.dt = motion.dt;
  placed.theta = motion.theta;
  placed.base = Grounding(model, motion, soles, first).base_by_feet();
  return without_swing_ends(model, placed, soles_of(model, placed), supports);
}

std::vector<Support> supports_of(const RobotModel& model, const RawMotion& motion,
                                 const Soles& soles) {
  return motion.support.empty() ? found_supports(model, motion, soles) : motion.support;
}

void require_motion(const RobotModel& model, const RawMotion& motion) {
  if (!model.has_soles())
    fail(ErrorCode::bad_model, model.name() +
                                   ": the robot has no soles. Add the left and the right sole to "
                                   "\"soles\" in its sidecar");
  if (motion.theta.rows() < 6)
    fail(ErrorCode::bad_pattern, "a motion of " + std::to_string(motion.theta.rows()) +
                                     " rows is too short. At least 6 rows are needed");
}

// ---- Ends that were cut

/// Speeds that count as rest [rad/s, m/s]. Chosen: the speed with which a table for a robot may
/// begin (limits/table_safety.hpp), and half of the speed with which a sole that carries the robot
/// may slide.
constexpr double kRestRate = 0.1, kRestSlide = 0.05;

// The fastest joint from row `k` to the next row and its speed, or the root and its speed, in
// words. Empty if the motion is at rest.
std::string movement_at(const RobotModel& model, const RawMotion& motion, Eigen::Index k) {
  Eigen::Index joint = 0;
  const double rate =
      (motion.theta.row(k + 1) - motion.theta.row(k)).cwiseAbs().maxCoeff(&joint) / motion.dt;
  const bool slides = model.dofs()[static_cast<size_t>(joint)].prismatic;
  if (rate > kRestRate)
    return model.dof_names()[static_cast<size_t>(joint)] + " at " +
           text::brief(slides ? rate : rate * 180 / EIGEN_PI, 3) + (slides ? " m/s" : " deg/s");
  if (motion.base.empty()) return "";
  const auto at = static_cast<size_t>(k);
  const double speed = (motion.base[at + 1].position - motion.base[at].position).norm() / motion.dt;
  return speed > kRestSlide ? "the root at " + text::brief(speed, 3) + " m/s" : "";
}

// The rows of a motion with slow ends, and the values of the given motion between its rows.
class Slowed {
 public:
  Slowed(int rows, const CutEnds& cut, int ramp)
      : rows_(rows), ramp_(ramp), begin_(cut.begin ? ramp : 0), end_(cut.end ? ramp : 0) {}

  int count() const { return rows_ + (begin_ + end_) / 2; }
  // The position in the rows of the given motion that belongs to row k of the slowed motion; it is
  // a whole number between the slow ends.
  double at(int k) const {
    if (k < begin_) return ramp_ * advance(static_cast<double>(k) / ramp_);
    const int left = count() - 1 - k;
    if (left < end_) return rows_ - 1 - ramp_ * advance(static_cast<double>(left) / ramp_);
    return k - begin_ / 2;
  }

 private:
  // Integral of minimum jerk from 0 to u; it is 0.5 at u = 1.
  static double advance(double u) { return u * u * u * u * (2.5 - 3 * u + u * u); }

  int rows_, ramp_, begin_, end_;
};

// Cubic through the rows around place x (Catmull and Rom).
template <typename ValueAt>
auto between_rows(double x, int rows, const ValueAt& value_at) {
  const int i = std::clamp(static_cast<int>(x), 0, rows - 2);
  const double u = x - i;
  const auto p1 = value_at(i), p2 = value_at(i + 1);
  decltype(value_at(i)) p0 = 2 * p1 - p2, p3 = 2 * p2 - p1;  // straight line beyond the ends
  if (i > 0) p0 = value_at(i - 1);
  if (i + 2 < rows) p3 = value_at(i + 2);
  return (p1 +
          0.5 * u *
              ((p2 - p0) + u * ((2 * p0 - 5 * p1 + 4 * p2 - p3) + u * (3 * (p1 - p2) + p3 - p0))))
      .eval();
}

}  // namespace

std::vector<Support> detect_supports(const RobotModel& model, const RawMotion& motion) {
  require_motion(model, motion);
  return found_supports(model, motion, soles_of(model, motion));
}

GroundedMotion grounded(const RobotModel& model, const RawMotion& motion,
                        const std::string& table) {
  require_motion(model, motion);
  const Soles soles = soles_of(model, motion);
  return Grounding(model, motion, soles, supports_of(model, motion, soles)).whole(table);
}

RawMotion put_on_ground(const RobotModel& model, RawMotion motion) {
  require_motion(model, motion);
  if (motion.base.empty()) return motion;
  const Soles soles = soles_of(model, motion);
  motion.support = supports_of(model, motion, soles);
  const int n = static_cast<int>(motion.support.size());
  std::vector<int> known;
  std::vector<double> height(static_cast<size_t>(n));
  for (int k = 0; k < n; ++k) {
    double low = 1e300;
    for (int foot : {0, 1})
      if (supports(motion.support[static_cast<size_t>(k)], static_cast<Side>(foot)))
        low = std::min(low, lowest_point(model, soles, foot, k));
    if (low > 1e299) continue;
    known.push_back(k);
    height[static_cast<size_t>(k)] = low;
  }
  if (known.empty()) return motion;
  for (int k = 0; k < n; ++k) {
    const auto after = std::lower_bound(known.begin(), known.end(), k);
    double shift = 0;
    if (after == known.end()) {
      shift = height[static_cast<size_t>(known.back())];
    } else if (*after == k || after == known.begin()) {
      shift = height[static_cast<size_t>(*after)];
    } else {
      const int a = *(after - 1), b = *after;
      const double u = static_cast<double>(k - a) / (b - a);
      shift = (1 - u) * height[static_cast<size_t>(a)] + u * height[static_cast<size_t>(b)];
    }
    motion.base[static_cast<size_t>(k)].position.z() -= shift;
    if (!motion.cog.empty()) motion.cog[static_cast<size_t>(k)].z() -= shift;
  }
  return motion;
}

CutEnds cut_ends(const RobotModel& model, const RawMotion& motion) {
  CutEnds cut;
  const Eigen::Index rows = motion.theta.rows();
  if (rows < 2) return cut;
  const std::string first = movement_at(model, motion, 0),
                    last = movement_at(model, motion, rows - 2);
  cut.begin = !first.empty();
  cut.end = !last.empty();
  const std::string peak =
      ", so the torques have a peak at this time. --ramp S (for example --ramp 0.5) lets the "
      "motion ";
  if (cut.begin)
    cut.words.push_back("the recording begins while the robot moves (" + first +
                        "). A robot that plays the recording starts from rest" + peak +
                        "begin slowly");
  if (cut.end)
    cut.words.push_back("the recording ends while the robot moves (" + last +
                        "). A robot that plays the recording stops at once" + peak + "end slowly");
  return cut;
}

RawMotion with_ramps(const RobotModel& model, RawMotion motion, double seconds) {
  require_motion(model, motion);
  const CutEnds cut = cut_ends(model, motion);
  if (!cut.begin && !cut.end) return motion;
  const int rows = static_cast<int>(motion.theta.rows());
  const int ramp = 2 * std::max(1, static_cast<int>(std::lround(seconds / (2 * motion.dt))));
  if (ramp / 2 * (cut.begin + cut.end) >= rows)
    fail(ErrorCode::bad_pattern, "a ramp of " + text::brief(seconds) +
                                     " s is too long for a motion of " +
                                     text::brief((rows - 1) * motion.dt) + " s. Choose less than " +
                                     text::brief((rows - 1) * motion.dt) + " s");
  // Soles that move slowly look as if they carried the robot, so the contacts are those of the
  // original motion.
  if (motion.support.empty()) motion.support = detect_supports(model, motion);
  for (size_t k = 1; k < motion.base.size(); ++k)
    if (motion.base[k].attitude.dot(motion.base[k - 1].attitude) < 0)
      motion.base[k].attitude.coeffs() *= -1;
  const Slowed slowed(rows, cut, ramp);
  RawMotion result;
  result.dt = motion.dt;
  result.contact = motion.contact;
  result.theta.resize(slowed.count(), motion.theta.cols());
  for (int k = 0; k < slowed.count(); ++k) {
    const double x = slowed.at(k);
    const auto nearest = static_cast<size_t>(std::lround(x));
    const bool whole = x == std::floor(x);
    result.support.push_back(motion.support[nearest]);
    result.theta.row(k) =
        whole
            ? Eigen::RowVectorXd(motion.theta.row(static_cast<Eigen::Index>(nearest)))
            : between_rows(x, rows, [&](int i) { return Eigen::RowVectorXd(motion.theta.row(i)); });
    if (!motion.base.empty()) {
      BasePose base = motion.base[nearest];
      if (!whole) {
        base.position = between_rows(
            x, rows, [&](int i) { return motion.base[static_cast<size_t>(i)].position; });
        const Eigen::Vector4d q = between_rows(x, rows, [&](int i) {
          return Eigen::Vector4d(motion.base[static_cast<size_t>(i)].attitude.coeffs());
        });
        base.attitude.coeffs() = q.normalized();
      }
      result.base.push_back(base);
    }
    if (!motion.cog.empty())
      result.cog.push_back(whole ? motion.cog[nearest] : Vector3d(between_rows(x, rows, [&](int i) {
        return motion.cog[static_cast<size_t>(i)];
      })));
  }
  return result;
}

}  // namespace ayumi
