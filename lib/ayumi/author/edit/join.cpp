// Motions in sequence. The second motion is moved over the ground by T = (yaw, x, y), so that its
// first footholds are the last ones of the first motion. A transition between two postures at rest
// keeps both soles in place: COG, trunk and the joints outside the legs follow s = 10 u^3 - 15 u^4
// + 6 u^5, and the legs follow by inverse kinematics.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/edit/move_key.hpp"
#include "ayumi/author/edit/round_time.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/inverse_kinematics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/merge_keyframes.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "ayumi/plan/tracks.hpp"
#include "ayumi/plan/viip_phases.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

using Feet = std::array<Isometry3d, 2>;

/// Largest difference of place [m] and angle [rad] with which two pairs of soles count as standing
/// in the same way. Chosen: below what the check's tolerances for slip and sink allow at the join.
constexpr double kSamePlace = 1e-3;
constexpr double kSameAngle = 0.01;
/// Largest difference of the base [m] and of the joints [rad] at a join without a transition.
/// Chosen: a step of 2e-4 rad in 1 ms is 0.2 rad/s, far below the speed limits of servos.
constexpr double kSameBase = 2e-5;
constexpr double kSameJoint = 2e-4;
/// Largest difference of a joint's rate that counts as zero [rad/s]. Chosen: the rate of a joint
/// that moves by kSameJoint in a millisecond.
constexpr double kSameRate = 1e3 * kSameJoint;
/// Time within which such a difference fades after the join [s]. Chosen: the acceleration is then
/// at most 0.12 rad/s^2. Within one tick of 1 ms, it would be 200 rad/s^2, and even a difference of
/// 1e-5 rad in the legs would move the ZMP out of the soles.
constexpr double kFade = 0.1;
/// A smaller difference is rounding and does not fade. Chosen: in one tick it means 1e-3 rad/s^2.
constexpr double kRoundingOfAJoin = 1e-9;

Feet soles_of(const RobotModel& model, const RobotState& state) {
  RobotData data(model);
  update_positions(model, state, data);
  return {sole_pose(model, data, Side::left), sole_pose(model, data, Side::right)};
}

// Pose on the line between the feet: its middle and its heading.
Isometry3d stand(const Feet& feet) {
  const Vector3d across = feet[0].translation() - feet[1].translation();
  Isometry3d frame = Isometry3d::Identity();
  frame.translation() = 0.5 * (feet[0].translation() + feet[1].translation());
  frame.translation().z() = 0;
  frame.linear() =
      elementary::turn_matrix(elementary::atan2(-across.x(), across.y()), Vector3d::UnitZ());
  return frame;
}

void require_stand(const Pattern& pattern, const CommandSample& sample, const char* when) {
  if (sample.support != Support::both)
    fail(ErrorCode::bad_pattern, in_file(pattern, std::string(when)),
         "a foot is in the air here, but motions can be joined only where both feet stand on "
         "the ground. Let both feet stand here");
}

RobotState moved(const Isometry3d& shift, const RobotState& state) {
  RobotState result = state;
  result.base.position = shift * state.base.position;
  result.base.attitude = (Eigen::Quaterniond(shift.linear()) * state.base.attitude).normalized();
  return result;
}

void move_foothold(const Isometry3d& shift, Foothold& foothold) {
  foothold.position = shift * foothold.position;
  foothold.rpy = matrix_to_rpy(shift.linear() * rpy_to_matrix(foothold.rpy));
}

// Moves footholds, the keys that a table keeps, and the scenario, in place and time.
void move_plan(const Isometry3d& shift, double later, Pattern& pattern) {
  for (Phase& phase : pattern.phases) {
    phase.until += later;
    if (phase.swing) move_foothold(shift, phase.swing->to);
  }
  for (Keyframe& key : pattern.keyframes) {
    key.t += later;
    for (auto& foot : key.feet)
      if (foot) move_foothold(shift, *foot);
  }
  for (Disturbance& d : pattern.scenario) {
    d.at += later;
    if (auto* push = std::get_if<Push>(&d.what); push && push->frame == PushFrame::world)
      push->direction = shift.linear() * push->direction;
    if (auto* bump = std::get_if<Bump>(&d.what); bump && !bump->foot)
      bump->place = (shift * Vector3d(bump->place.x(), bump->place.y(), 0)).head<2>();
  }
}

void add_row(DenseTable& table, const RobotState& state) {
  table.base.push_back(state.base);
  table.theta.row(static_cast<Eigen::Index>(table.base.size()) - 1) = state.theta.transpose();
}

Phase both_feet_until(double time) {
  Phase phase;
  phase.until = time;
  return phase;
}

double rest_to_rest(double u) { return u * u * u * (10 - 15 * u + 6 * u * u); }

int ticks_of(double time, double dt) { return static_cast<int>(std::lround(time / dt)); }

// The difference between the posture at the end of a motion and the one at the beginning of the
// next motion. It fades within some ticks.
class PostureFade {
 public:
  PostureFade(const RobotState& end, const RobotState& begin, int ticks)
      : position_(end.base.position - begin.base.position),
        turn_((end.base.attitude * begin.base.attitude.conjugate()).normalized()),
        theta_(end.theta - begin.theta),
        ticks_(ticks) {
    const double turn = elementary::angle_between(end.base.attitude, begin.base.attitude);
    if (std::max({position_.norm(), turn, theta_.cwiseAbs().maxCoeff()}) < kRoundingOfAJoin)
      ticks_ = 0;
  }

  // The posture of the next motion, `tick` ticks after its beginning.
  RobotState applied(RobotState state, int tick) const {
    if (tick >= ticks_) return state;
    const double left = 1 - rest_to_rest(static_cast<double>(tick) / ticks_);
    state.base.position += left * position_;
    state.base.attitude =
        (elementary::between(Eigen::Quaterniond::Identity(), turn_, left) * state.base.attitude)
            .normalized();
    state.theta += left * theta_;
    return state;
  }

 private:
  Vector3d position_;
  Eigen::Quaterniond turn_;
  Eigen::VectorXd theta_;
  int ticks_;
};

// The samples between two postures on the same soles; the two postures themselves are not included.
std::vector<RobotState> transition(const RobotModel& model, const RobotState& from,
                                   const RobotState& to, int ticks) {
  RobotData data(model);
  const auto target_of = [&](const RobotState& state) {
    PostureTarget target;
    update_positions(model, state, data);
    target.feet = {sole_pose(model, data, Side::left), sole_pose(model, data, Side::right)};
    target.cog = data.cog;
    target.trunk = data.rotation[model.trunk_body()];
    return target;
  };
  const PostureTarget a = target_of(from), b = target_of(to);
  const InverseKinematics legs(model, from.theta);
  std::vector<RobotState> states;
  RobotState state = from;
  for (int k = 1; k < ticks; ++k) {
    const double s = rest_to_rest(static_cast<double>(k) / ticks);
    PostureTarget target;
    target.cog = (1 - s) * a.cog + s * b.cog;
    target.trunk = elementary::between(Eigen::Quaterniond(a.trunk), Eigen::Quaterniond(b.trunk), s);
    for (size_t i = 0; i < 2; ++i) {
      target.feet[i].translation() =
          (1 - s) * a.feet[i].translation() + s * b.feet[i].translation();
      target.feet[i].linear() = elementary::between(Eigen::Quaterniond(a.feet[i].linear()),
                                                    Eigen::Quaterniond(b.feet[i].linear()), s)
                                    .toRotationMatrix();
    }
    for (int i = 0; i < model.dof_count(); ++i)
      if (!legs.solves(i)) state.theta[i] = (1 - s) * from.theta[i] + s * to.theta[i];
    if (!legs.solve(target, state, data).reached)
      fail(ErrorCode::bad_pattern,
           "no transition is possible, because the legs cannot go from one posture to the other "
           "while both feet stay in place. Choose postures that are closer to each other");
    states.push_back(state);
  }
  return states;
}

// The pattern as a table of posture and base; its COG, ZMP and f_z come from the full model.
Pattern plain(const RobotModel& model, const Pattern& pattern, const CommandSeries& series,
              const std::string& table, size_t rows) {
  Pattern result = baked(model, pattern, series, table);
  result.repair = {};  // preferences for joints and times of another motion are not valid
  DenseTable& dense = *result.table;
  dense.cog.clear();
  dense.zmp.clear();
  dense.fz.clear();
  dense.theta.conservativeResize(static_cast<Eigen::Index>(rows), Eigen::NoChange);
  if (result.phases.empty()) result.phases.emplace_back();
  result.phases.back().until = series.duration();
  return result;
}

bool same_time(const Keyframe& a, const Keyframe& b) {
  // Times closer than this are equal [s]. Chosen: above rounding.
  constexpr double kSame = 1e-9;
  return std::abs(a.t - b.t) < kSame;
}

void add_key(std::vector<Keyframe>& keys, const Keyframe& key) {
  if (!keys.empty() && same_time(keys.back(), key))
    merge(keys.back(), key);
  else
    keys.push_back(key);
}

bool has_keys(const Pattern& pattern, Side side) {
  return std::any_of(pattern.keyframes.begin(), pattern.keyframes.end(), [&](const Keyframe& key) {
    return key.feet[static_cast<size_t>(side)].has_value();
  });
}

// A foot has keys or swings, but not both. If one of the two parts has keys of a foot, the swings
// of this foot in the other part become keys along the same path. The posture stays that of the
// table.
void write_swings_as_keys(const RobotModel& model, Side side, Pattern& pattern) {
  // Number of keys of one swing. Chosen: between the keys, the curve differs by less than 0.1 mm.
  constexpr int kKeys = 16;
  const FootPlan feet(model, pattern);
  std::vector<Keyframe> keys = std::move(pattern.keyframes);
  double begin = 0;
  for (Phase& phase : pattern.phases) {
    if (phase.swing && phase.swing->foot == side) {
      for (int i = 0; i <= kKeys; ++i) {
        Keyframe key;
        key.t = begin + (phase.until - begin) * i / kKeys;
        const Isometry3d pose = feet.pose(side, i < kKeys ? key.t : phase.until);
        key.feet[static_cast<size_t>(side)] =
            Foothold{pose.translation(), matrix_to_rpy(pose.linear())};
        key.interpolation = i == 0 ? Interpolation::hold : Interpolation::spline;
        keys.push_back(std::move(key));
      }
      phase.swing.reset();
    }
    begin = phase.until;
  }
  std::stable_sort(keys.begin(), keys.end(),
                   [](const Keyframe& a, const Keyframe& b) { return a.t < b.t; });
  pattern.keyframes.clear();
  for (const Keyframe& key : keys) add_key(pattern.keyframes, key);
}

double angle_between(const Matrix3d& a, const Matrix3d& b) {
  return elementary::angle_between(Eigen::Quaterniond(a), Eigen::Quaterniond(b));
}

void require_same_stand(const Pattern& second, const Feet& last, const Feet& first) {
  for (size_t i = 0; i < 2; ++i) {
    const double distance = (last[i].translation() - first[i].translation()).norm();
    const double turn = angle_between(last[i].linear(), first[i].linear());
    if (distance < kSamePlace && turn < kSameAngle) continue;
    fail(ErrorCode::bad_pattern, in_file(second, "/start"),
         std::string("the ") + (i == 0 ? "left" : "right") + " foot is " +
             text::fixed(1000 * distance, 1) + " mm and " + text::fixed(turn * 180 / M_PI, 1) +
             " deg away from its place at the end of the first motion (limits " +
             text::fixed(1000 * kSamePlace, 1) + " mm and " +
             text::fixed(kSameAngle * 180 / M_PI, 1) +
             " deg). Let the first motion end in the stance in which the second motion begins");
  }
}

void require_same_posture(const RobotModel& model, const Pattern& second, const RobotState& last,
                          const RobotState& first) {
  int worst = 0;
  const double most = (last.theta - first.theta).cwiseAbs().maxCoeff(&worst);
  const double distance = (last.base.position - first.base.position).norm();
  const double turn = elementary::angle_between(last.base.attitude, first.base.attitude);
  if (distance > kSameBase || turn > kSameJoint)
    fail(ErrorCode::bad_pattern, in_file(second, "/start"),
         "the base is " + text::fixed(1000 * distance, 2) + " mm and " +
             text::fixed(turn * 180 / M_PI, 2) +
             " deg away from its place at the end of the first motion (limits " +
             text::fixed(1000 * kSameBase, 2) + " mm and " +
             text::fixed(kSameJoint * 180 / M_PI, 2) +
             " deg). Join the motions with `ayumi edit blend --over S`");
  if (most < kSameJoint) return;
  fail(ErrorCode::bad_pattern, in_file(second, "/start"),
       model.dofs()[worst].name + " is " + text::fixed(most * 180 / M_PI, 2) +
           " deg away from its angle at the end of the first motion (limit " +
           text::fixed(kSameJoint * 180 / M_PI, 2) +
           " deg). Join the motions with `ayumi edit blend --over S`");
}

}  // namespace

Pattern joined(const RobotModel& model, const MotionPart& first, const MotionPart& second,
               double over, const std::string& table) {
  const CommandSeries &a = first.series, &b = second.series;
  if (std::abs(a.dt - b.dt) > 1e-12)
    fail(ErrorCode::usage, "motions with sampling steps of " + text::exact(a.dt) + " and " +
                               text::exact(b.dt) +
                               " s cannot be joined. Sample both motions with the same step");
  require_stand(first.pattern, a.samples.back(), "end");
  require_stand(second.pattern, b.samples.front(), "start");
  const Feet last = soles_of(model, a.samples.back().state);
  const Isometry3d shift = stand(last) * stand(soles_of(model, b.samples.front().state)).inverse();
  const RobotState from = a.samples.back().state, to = moved(shift, b.samples.front().state);
  require_same_stand(second.pattern, last, soles_of(model, to));
  if (over <= 0) require_same_posture(model, second.pattern, from, to);

  const int ticks = ticks_of(over, a.dt);
  const auto between = ticks > 0 ? transition(model, from, to, ticks) : std::vector<RobotState>();
  // Without a transition the first sample of the second motion is the last of the first.
  const size_t skip = ticks > 0 ? 0 : 1;
  const size_t rows = a.samples.size() + between.size() + b.samples.size() - skip;
  Pattern result = plain(model, first.pattern, a, table, rows);
  Pattern rest = plain(model, second.pattern, b, table, b.samples.size());
  for (Phase& phase : rest.phases) phase.pointer.clear();
  for (Keyframe& key : rest.keyframes) key.pointer.clear();
  for (const Side side : {Side::left, Side::right})
    if (has_keys(result, side) != has_keys(rest, side))
      write_swings_as_keys(model, side, has_keys(result, side) ? rest : result);
  for (const RobotState& state : between) add_row(*result.table, state);
  const PostureFade fade(from, to, ticks > 0 ? 0 : ticks_of(std::min(kFade, b.duration()), a.dt));
  for (size_t k = skip; k < b.samples.size(); ++k)
    add_row(*result.table, fade.applied(moved(shift, b.samples[k].state), static_cast<int>(k)));

  const double later = a.duration() + ticks * a.dt;
  if (ticks > 0) result.phases.push_back(both_feet_until(later));
  move_plan(shift, later, rest);
  result.phases.insert(result.phases.end(), rest.phases.begin(), rest.phases.end());
  result.keyframes.insert(result.keyframes.end(), rest.keyframes.begin(), rest.keyframes.end());
  result.scenario.insert(result.scenario.end(), rest.scenario.begin(), rest.scenario.end());
  return result;
}

namespace {

// The tracks that have keys in a pattern, and their values over time.
struct KeyedTracks {
  KeyedTracks(const RobotModel& model, const Pattern& of)
      : pattern(of),
        feet(model, of),
        legs(model, default_posture(model, of)),
        tracks(read_tracks(model, of, feet, solved(model, legs))) {
    for (const Keyframe& key : of.keyframes) {
      for (const auto& [joint, angle] : key.joints) joints.insert(joint);
      if (key.posture)
        for (const auto& [joint, angle] : posture_joints(model, of, *key.posture, key.place))
          joints.insert(joint);
      for (const auto& [link, target] : key.hands) hands[link] = target.position.has_value();
      if (key.gaze) gaze = key.gaze->position.has_value();
      for (const auto& [joint, weight] : key.weights) weights.insert(joint);
    }
  }
  static std::vector<bool> solved(const RobotModel& model, const InverseKinematics& legs) {
    std::vector<bool> result;
    for (int dof = 0; dof < model.dof_count(); ++dof) result.push_back(legs.solves(dof));
    return result;
  }
  bool turns() const {
    return std::any_of(feet.phases().begin(), feet.phases().end(), [&](const Phase& phase) {
      return phase.swing &&
             std::abs(std::remainder(
                 matrix_to_rpy(feet.pose(phase.swing->foot, phase.until).linear()).z() -
                     matrix_to_rpy(feet.pose(phase.swing->foot, 0).linear()).z(),
                 2 * M_PI)) > kSameAngle;
    });
  }

  const Pattern& pattern;
  FootPlan feet;
  InverseKinematics legs;
  PatternTracks tracks;
  std::set<std::string> joints, weights;
  std::map<std::string, bool> hands;  ///< for each hand, true if a target leads the link at the end
  std::optional<bool> gaze;
};

// The keys that keep every track of `all` at the value that this track has in `of` at time t.
Keyframe keys_at(const RobotModel& model, const KeyedTracks& of, double t, const KeyedTracks& all) {
  Keyframe key;
  key.t = t;
  const auto& tracks = of.tracks;
  for (const KeyedTracks* const part : {&of, &all})
    for (const std::string& joint : part->joints) {
      const int dof = model.find_dof(joint);
      if (dof >= 0 && !of.legs.solves(dof)) key.joints[joint] = tracks.joints[dof].at(t).value;
    }
  if (tracks.zmp) {
    ZmpKey zmp;
    zmp.point = {(*tracks.zmp)[0].at(t).value, (*tracks.zmp)[1].at(t).value};
    // This tolerance [m] covers rounding only.
    if ((zmp.point - of.feet.support_center(t).head<2>()).norm() < 1e-9)
      zmp.place = ZmpKey::Place::center;
    key.zmp = zmp;
  }
  if (tracks.cog[0]) key.cog_x = tracks.cog[0]->at(t).value;
  if (tracks.cog[1]) key.cog_y = tracks.cog[1]->at(t).value;
  if (all.tracks.cog[2] || tracks.cog[2] ||
      default_cog_height(model, of.pattern) != default_cog_height(model, all.pattern))
    key.cog_height = tracks.cog[2] ? tracks.cog[2]->at(t).value
                                   : default_cog_height(model, of.pattern) + of.feet.ground(t);
  if (all.tracks.fz || tracks.fz)
    key.fz = tracks.fz ? tracks.fz->at(t).value : model.mass() * kGravity;
  if (tracks.torso)
    key.torso = Vector3d((*tracks.torso)[0].at(t).value, (*tracks.torso)[1].at(t).value,
                         (*tracks.torso)[2].at(t).value);
  else if (all.tracks.torso)
    key.torso = Vector3d(0, 0, matrix_to_rpy(of.feet.pose(Side::left, t).linear()).z());
  for (const Side side : {Side::left, Side::right}) {
    if (!has_keys(of.pattern, side) && !has_keys(all.pattern, side)) continue;
    const Isometry3d pose = of.feet.pose(side, t);
    key.feet[static_cast<size_t>(side)] =
        Foothold{pose.translation(), matrix_to_rpy(pose.linear())};
  }
  return key;
}

bool has_swings(const Pattern& pattern, Side side) {
  return std::any_of(pattern.phases.begin(), pattern.phases.end(),
                     [&](const Phase& phase) { return phase.swing && phase.swing->foot == side; });
}

void require_keys(const KeyedTracks& part) {
  const Pattern& pattern = part.pattern;
  const auto stop = [&](const SourcePlace& place, const std::string& why) {
    fail(ErrorCode::bad_pattern, place,
         why + ", so this motion cannot be joined to another motion by keys");
  };
  if (part.tracks.joint_driven)
    stop(in_file(pattern, "/keyframes"), "the joints of the legs follow " + part.tracks.driver);
  for (const auto& [link, led] : part.hands)
    if (led)
      stop(in_file(pattern, "/keyframes"),
           "the target of " + link + " is kept until the end of the motion");
  if (part.gaze.value_or(false))
    stop(in_file(pattern, "/keyframes"),
         "the target of the gaze is kept until the end of the motion");
}

void require_same_tracks(const KeyedTracks& a, const KeyedTracks& b) {
  const auto stop = [&](const std::string& what) {
    fail(ErrorCode::bad_pattern, in_file(b.pattern, "/keyframes"),
         "only one of the two motions has " + what +
             ", so the keys cannot be kept. Both motions must be alike in this respect");
  };
  if (a.tracks.zmp.has_value() != b.tracks.zmp.has_value()) stop("keys of the ZMP");
  for (const Side side : {Side::left, Side::right})
    if ((has_keys(a.pattern, side) && has_swings(b.pattern, side)) ||
        (has_keys(b.pattern, side) && has_swings(a.pattern, side)))
      fail(
          ErrorCode::bad_pattern, in_file(b.pattern, "/keyframes"),
          std::string("the ") + name_of(side) +
              " foot has keys in one motion and swings in the other motion, so the keys of the two "
              "motions cannot be joined");
  for (const size_t axis : {0, 1})
    if (a.tracks.cog[axis].has_value() != b.tracks.cog[axis].has_value())
      stop("keys of the COG position");
  if (a.pattern.full_model != b.pattern.full_model) stop("\"cog_model\": \"point_mass\"");
  if (a.tracks.torso.has_value() != b.tracks.torso.has_value() && (a.turns() || b.turns()))
    stop("keys of the trunk (and the feet turn)");
}

// Keyframes of the second pattern in the form that they have in the first one.
Keyframe translated(const RobotModel& model, const Pattern& from, const Pattern& to, Keyframe key) {
  key.pointer.clear();
  if (!key.interpolation && from.interpolation != to.interpolation)
    key.interpolation = from.interpolation;
  if (key.posture) {
    const auto angles = posture_joints(model, from, *key.posture, key.place);
    const bool known = to.postures.contains(*key.posture) || model.has_posture(*key.posture);
    if (!known || posture_joints(model, to, *key.posture, key.place) != angles) {
      for (const auto& [joint, angle] : angles) key.joints.emplace(joint, angle);
      key.posture.reset();
    }
  }
  return key;
}

}  // namespace

Pattern chained(const RobotModel& model, const MotionPart& first, const MotionPart& second,
                double over) {
  for (const Pattern* pattern : {&first.pattern, &second.pattern}) {
    refuse_viip_phases(*pattern, "joined");
    if (pattern->table || pattern->correction)
      fail(ErrorCode::bad_pattern, in_file(*pattern, pattern->table ? "/table" : "/correction"),
           "a pattern with a table or a correction has no keys that can be kept");
  }
  const CommandSeries &a = first.series, &b = second.series;
  require_stand(first.pattern, a.samples.back(), "end");
  require_stand(second.pattern, b.samples.front(), "start");
  const KeyedTracks one(model, first.pattern), two(model, second.pattern);
  require_keys(one);
  require_keys(two);
  require_same_tracks(one, two);
  const Feet last = soles_of(model, a.samples.back().state);
  Isometry3d shift = stand(last) * stand(soles_of(model, b.samples.front().state)).inverse();
  const RobotState to = moved(shift, b.samples.front().state);
  require_same_stand(second.pattern, last, soles_of(model, to));
  if (over <= 0) require_same_posture(model, second.pattern, a.samples.back().state, to);
  require_moved_together(shift, second.pattern);

  Pattern result = first.pattern;
  result.repair = {};
  result.parameters.clear();
  const double end = first.pattern.phases.back().until, later = end + over;
  Keyframe at_end = keys_at(model, one, end, two);
  // A spline through equal values does not rest between them, but a segment with minimum jerk does.
  // If the author wrote a key at the end of the first pattern, this key keeps its interpolation. In
  // this case, a foot without a value in the key gets none before the start of the second pattern.
  const bool curved = first.pattern.interpolation == Interpolation::spline ||
                      first.pattern.interpolation == Interpolation::cubic;
  const Keyframe* const written =
      !result.keyframes.empty() && same_time(result.keyframes.back(), at_end)
          ? &result.keyframes.back()
          : nullptr;
  if (curved && !written) at_end.interpolation = Interpolation::minimum_jerk;
  for (const size_t foot : {0, 1})
    if (curved && written && !written->feet[foot] && over > 0) at_end.feet[foot].reset();
  add_key(result.keyframes, at_end);
  if (over > 0) result.phases.push_back(both_feet_until(later));
  Keyframe at_start = keys_at(model, two, 0, one);
  for (const std::string& joint : one.weights)
    at_start.weights[joint] = model.joint_weight()[find_joint(model, joint, {"", "/weights"})];
  for (const auto& [link, led] : two.hands) at_start.hands[link] = {};
  if (two.gaze) at_start.gaze = LinkTarget{};
  const auto move = [&](Keyframe& key) {
    // Moved places are rounded to this number of parts of a metre or a radian, so that they are
    // printed as an author would write them.
    constexpr double kParts = 1e9;
    move_key(shift, key);
    for (auto& foot : key.feet) {
      if (!foot) continue;
      move_foothold(shift, *foot);
      foot->position = ((kParts * foot->position).array().round() / kParts + 0.0).matrix();
      foot->rpy = ((kParts * foot->rpy).array().round() / kParts + 0.0).matrix();
    }
  };
  move(at_start);
  at_start.t = later;
  if (curved) at_start.interpolation = Interpolation::minimum_jerk;
  if (over > 0)
    add_key(result.keyframes, at_start);
  else
    result.keyframes.back().hands = at_start.hands, result.keyframes.back().gaze = at_start.gaze;
  for (Phase phase : two.feet.phases()) {
    phase.pointer.clear();
    phase.until = round_time(phase.until + later);
    if (phase.swing) move_foothold(shift, phase.swing->to);
    result.phases.push_back(phase);
  }
  for (const Keyframe& each : second.pattern.keyframes) {
    Keyframe key = translated(model, second.pattern, first.pattern, each);
    if (key.t == 0) key.interpolation.reset();  // no segment ended here; now the transition does
    move(key);
    key.t = round_time(key.t + later);
    add_key(result.keyframes, key);
  }
  Pattern pushes = second.pattern;
  pushes.phases.clear();
  pushes.keyframes.clear();
  move_plan(shift, later, pushes);
  result.scenario.insert(result.scenario.end(), pushes.scenario.begin(), pushes.scenario.end());
  return result;
}

LoopGap largest_loop_gap() {
  LoopGap gap;
  gap.feet = kSamePlace;
  gap.posture = kSameJoint;
  gap.base = kSameBase;
  gap.rate = kSameRate;
  return gap;
}

LoopGap loop_gap(const RobotModel& model, const MotionPart& motion) {
  const CommandSample &begin = motion.series.samples.front(), &end = motion.series.samples.back();
  require_stand(motion.pattern, begin, "start");
  require_stand(motion.pattern, end, "end");
  const Feet last = soles_of(model, end.state);
  const Isometry3d shift = stand(last) * stand(soles_of(model, begin.state)).inverse();
  const RobotState again = moved(shift, begin.state);
  const Feet first = soles_of(model, again);
  LoopGap gap;
  double turn = 0;
  for (size_t i = 0; i < 2; ++i) {
    gap.feet = std::max(gap.feet, (last[i].translation() - first[i].translation()).norm());
    turn = std::max(turn, angle_between(last[i].linear(), first[i].linear()));
  }
  int worst = 0;
  gap.posture = (end.state.theta - again.theta).cwiseAbs().maxCoeff(&worst);
  gap.joint = model.dofs()[worst].name;
  gap.base = (end.state.base.position - again.base.position).norm();
  gap.rate =
      (end.state.velocity() - begin.state.velocity()).tail(model.dof_count()).cwiseAbs().maxCoeff();
  gap.closed = gap.feet < kSamePlace && turn < kSameAngle && gap.posture < kSameJoint &&
               gap.base < kSameBase && gap.rate < kSameRate;
  return gap;
}

namespace {

// The robot in this posture, with its COG between the present places of the feet.
RobotState standing_at(const RobotModel& model, const Pattern& pattern, const std::string& posture,
                       const RobotState& near) {
  RobotState state = near;
  for (const auto& [joint, angle] :
       posture_joints(model, pattern, posture, in_file(pattern, "ramp")))
    state.theta[find_joint(model, joint, in_file(pattern, "ramp"))] = angle;
  RobotState home = model.rest_state();
  home.theta = state.theta;
  RobotData data(model);
  update_positions(model, home, data);
  const double height =
      data.cog.z() - 0.5 * (sole_pose(model, data, Side::left).translation().z() +
                            sole_pose(model, data, Side::right).translation().z());
  PostureTarget target;
  target.feet = soles_of(model, near);
  const Isometry3d frame = stand(target.feet);
  const double ground = 0.5 * (target.feet[0].translation().z() + target.feet[1].translation().z());
  target.cog = frame.translation() + Vector3d(0, 0, ground + height);
  target.trunk = frame.linear();
  state.theta = near.theta;
  const InverseKinematics legs(model, near.theta);
  for (int i = 0; i < model.dof_count(); ++i)
    if (!legs.solves(i)) state.theta[i] = home.theta[i];
  // The COG is above the middle of the sole polygons, not of the sole frames.
  Vector3d middle = Vector3d::Zero();
  for (size_t i = 0; i < 2; ++i) {
    const ConvexPolygon sole(model.sole(static_cast<Side>(i)).polygon);
    middle += 0.5 * (target.feet[i] * Vector3d(sole.centroid().x(), sole.centroid().y(), 0));
  }
  target.cog.head<2>() = middle.head<2>();
  if (!legs.solve(target, state, data).reached)
    fail(ErrorCode::bad_pattern, in_file(pattern, "ramp"),
         "posture '" + posture +
             "' cannot be reached while the feet stay at their places in the motion. Choose "
             "another posture");
  return state;
}

}  // namespace

Pattern ramped(const RobotModel& model, const MotionPart& motion, const Ramps& ramps,
               const std::string& table) {
  const CommandSeries& series = motion.series;
  const int in = ticks_of(ramps.in, series.dt), out = ticks_of(ramps.out, series.dt);
  std::vector<RobotState> before, after;
  if (in > 0) {
    require_stand(motion.pattern, series.samples.front(), "start");
    const RobotState& first = series.samples.front().state;
    before.push_back(standing_at(model, motion.pattern, ramps.posture, first));
    const auto path = transition(model, before.front(), first, in);
    before.insert(before.end(), path.begin(), path.end());
  }
  if (out > 0) {
    require_stand(motion.pattern, series.samples.back(), "end");
    const RobotState& last = series.samples.back().state;
    const RobotState end = standing_at(model, motion.pattern, ramps.posture, last);
    after = transition(model, last, end, out);
    after.push_back(end);
  }
  const size_t rows = before.size() + series.samples.size() + after.size();
  Pattern result = plain(model, motion.pattern, series, table, series.samples.size());
  move_plan(Isometry3d::Identity(), in * series.dt, result);
  result.table->base.clear();
  result.table->theta.resize(static_cast<Eigen::Index>(rows), model.dof_count());
  for (const RobotState& state : before) add_row(*result.table, state);
  for (const CommandSample& sample : series.samples) add_row(*result.table, sample.state);
  for (const RobotState& state : after) add_row(*result.table, state);
  if (in > 0) result.phases.insert(result.phases.begin(), both_feet_until(in * series.dt));
  if (out > 0) result.phases.push_back(both_feet_until(static_cast<double>(rows - 1) * series.dt));
  return result;
}

}  // namespace ayumi
