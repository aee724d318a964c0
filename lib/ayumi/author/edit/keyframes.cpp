// Edits of keyframes, and a step that alternates with its mirror image. Each repetition begins
// where the supporting foot stands at that time. S is the pose of this foot at the beginning of the
// pattern (or of its mirror image), and S_k its pose at the beginning of repetition k. Points move
// by S_k S^-1.
#include <algorithm>
#include <cmath>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/edit/move_key.hpp"
#include "ayumi/author/edit/round_time.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/motion/merge_keyframes.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "ayumi/plan/viip_phases.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

// Times closer than this name the same keyframe [s]. Chosen: half of the millisecond to which
// times are written.
constexpr double kSameKey = 5e-4;

std::vector<Keyframe>::iterator key_near(std::vector<Keyframe>& keys, double t) {
  return std::find_if(keys.begin(), keys.end(),
                      [t](const Keyframe& key) { return std::abs(key.t - t) < kSameKey; });
}

// Inserts a keyframe at its time, or merges it with the one that is there.
void put_key(std::vector<Keyframe>& keys, const Keyframe& key) {
  if (const auto there = key_near(keys, key.t); there != keys.end()) {
    const double t = there->t;
    merge(*there, key);
    there->t = t;
    return;
  }
  keys.insert(
      std::find_if(keys.begin(), keys.end(), [&](const Keyframe& each) { return each.t > key.t; }),
      key);
}

// Whether a posture of this name is the same in two patterns for one robot.
bool has_same_posture(const Pattern& a, const Pattern& b, const std::string& name) {
  const auto in_a = a.postures.find(name), in_b = b.postures.find(name);
  if (in_a == a.postures.end() || in_b == b.postures.end())
    return in_a == a.postures.end() && in_b == b.postures.end();
  return in_a->second == in_b->second;
}

}  // namespace

Pattern with_key_edited(const RobotModel& model, const Pattern& pattern, const KeyEdit& edit) {
  Pattern result = pattern;
  const auto found = key_near(result.keyframes, edit.at);
  if (found == result.keyframes.end()) {
    std::vector<std::string> times;
    for (const Keyframe& key : pattern.keyframes) times.push_back(text::exact(key.t));
    fail(ErrorCode::usage, in_file(pattern, "/keyframes"),
         "there is no keyframe at " + text::exact(edit.at) + " s. The times of the keyframes are " +
             text::join(times, ", ") + " s");
  }
  Keyframe key = *found;
  if (edit.mirror) {
    Pattern alone = pattern;
    alone.keyframes = {key};
    alone = mirrored(model, alone);
    key = alone.keyframes.front();
    // The mirror image of a posture that is not symmetric is not the posture of this name, so its
    // angles are written instead.
    if (key.posture && !has_same_posture(alone, pattern, *key.posture)) {
      const auto angles = posture_joints(model, alone, *key.posture, key.place);
      key.posture.reset();
      for (const auto& [joint, angle] : angles) key.joints.emplace(joint, angle);
    }
  }
  if (edit.to) {
    const double end = pattern.phases.empty() ? pattern.duration() : pattern.phases.back().until;
    if (!(*edit.to >= 0 && *edit.to <= end))
      fail(ErrorCode::usage, in_file(pattern, "/keyframes"),
           "the keyframe would be at " + text::exact(*edit.to) +
               " s, but the motion lasts from 0 to " + text::exact(end) + " s");
    double begin = 0;
    for (size_t i = 0; i < pattern.phases.size(); begin = pattern.phases[i++].until)
      if (pattern.phases[i].viip && *edit.to > begin && *edit.to < pattern.phases[i].until)
        fail(ErrorCode::usage, place_of_phase(pattern, i),
             "the keyframe would be at " + text::exact(*edit.to) +
                 " s, inside the VIIP phase from " + text::exact(begin) + " to " +
                 text::exact(pattern.phases[i].until) +
                 " s, but in such a phase goals replace keys. Choose a time outside this phase");
    if (!edit.copy) result.keyframes.erase(found);
    key.t = *edit.to;
    put_key(result.keyframes, key);
  } else {
    *found = key;
  }
  return result;
}

namespace {

// The landing place of the swinging foot relative to the other foot, in a plan that has both.
RelativeStep step_seen(const FootPlan& plan, const Phase& phase, const Isometry3d& beside) {
  const Swing& swing = *phase.swing;
  const Isometry3d seen = plan.pose(other(swing.foot), phase.until).inverse() * pose_of(swing.to);
  RelativeStep step;
  step.forward = seen.translation().x();
  step.side = seen.translation().y() - beside.translation().y();
  step.up = seen.translation().z();
  step.turn = std::remainder(matrix_to_rpy(seen.linear()).z() - matrix_to_rpy(beside.linear()).z(),
                             2 * M_PI);
  // Rounds the step as it is written: to a hundredth of a millimetre and a thousandth of a degree.
  const auto rounded = [](double value, double unit) { return unit * std::round(value / unit); };
  step.forward = rounded(step.forward, 1e-5);
  step.side = rounded(step.side, 1e-5);
  step.up = rounded(step.up, 1e-5);
  step.turn = rounded(step.turn, 1e-5);
  return step;
}

// A pose on the ground: place and heading.
Isometry3d on_level_ground(const Isometry3d& pose) {
  Isometry3d result = Isometry3d::Identity();
  result.translation() = pose.translation();
  result.linear() = rpy_to_matrix({0, 0, matrix_to_rpy(pose.linear()).z()});
  return result;
}

}  // namespace

void move_key(const Isometry3d& shift, Keyframe& key) {
  const double yaw = matrix_to_rpy(shift.linear()).z();
  if (key.zmp && key.zmp->place == ZmpKey::Place::point)
    key.zmp->point = (shift * Vector3d(key.zmp->point.x(), key.zmp->point.y(), 0)).head<2>();
  if (key.cog_x && key.cog_y) {
    const Vector3d cog = shift * Vector3d(*key.cog_x, *key.cog_y, 0);
    key.cog_x = cog.x();
    key.cog_y = cog.y();
  } else {
    if (key.cog_x) *key.cog_x += shift.translation().x();
    if (key.cog_y) *key.cog_y += shift.translation().y();
  }
  if (key.cog_height) *key.cog_height += shift.translation().z();
  if (key.torso) key.torso->z() += yaw;
  const auto move_target = [&](LinkTarget& target) {
    if (target.frame != LinkTarget::Frame::world) return;
    if (target.position) target.position = shift * *target.position;
    if (target.direction) target.direction = shift.linear() * *target.direction;
  };
  for (auto& [link, target] : key.hands) move_target(target);
  if (key.gaze) move_target(*key.gaze);
}

void require_moved_together(const Isometry3d& shift, const Pattern& pattern) {
  const double yaw = matrix_to_rpy(shift.linear()).z();
  for (const Keyframe& key : pattern.keyframes)
    if (std::abs(yaw) > 1e-9 && key.cog_x.has_value() != key.cog_y.has_value())
      fail(ErrorCode::bad_pattern, key.place,
           "in a motion that turns, a key of the COG must have both x and y. Give both");
}

Pattern alternated(const RobotModel& model, const Pattern& pattern, int times, bool close) {
  if (times < 2 || times > 1000)
    fail(ErrorCode::usage,
         "the pattern and its mirror image can follow each other 2 to 1000 times, not " +
             std::to_string(times) + " times");
  refuse_viip_phases(pattern, "alternated with its mirror image");
  if (pattern.table || pattern.correction)
    fail(ErrorCode::bad_pattern, in_file(pattern, pattern.table ? "/table" : "/correction"),
         "a pattern with a table or a correction cannot alternate with its mirror image. "
         "Each step has to begin where the last one has ended, and a table or a correction "
         "cannot be moved to that place");
  const bool foot_keys =
      std::any_of(pattern.keyframes.begin(), pattern.keyframes.end(),
                  [](const Keyframe& key) { return key.feet[0] || key.feet[1]; });
  if (foot_keys)
    fail(ErrorCode::bad_pattern, in_file(pattern, "/keyframes"),
         "the feet have keys, but only swings can be repeated. Give swings in the phases. A swing "
         "can be a step relative to the other foot");
  const FootPlan plan(model, pattern);
  const auto first_swing = std::find_if(plan.phases().begin(), plan.phases().end(),
                                        [](const Phase& phase) { return phase.swing.has_value(); });
  if (first_swing == plan.phases().end())
    fail(ErrorCode::bad_pattern, in_file(pattern, "/phases"),
         "no foot swings, so there is no step to repeat");
  const std::array<Isometry3d, 2> start = start_feet(model, pattern);
  Pattern relative = pattern;
  for (size_t i = 0; i < relative.phases.size(); ++i) {
    Phase& phase = relative.phases[i];
    if (!phase.swing) continue;
    const auto foot = static_cast<size_t>(index(phase.swing->foot));
    phase.swing->step = step_seen(plan, plan.phases()[i], start[1 - foot].inverse() * start[foot]);
    phase.swing->to = {};
  }
  relative.repair = {};
  const Pattern image = mirrored(model, relative);
  const double length = pattern.phases.back().until;
  const Side carries = other(first_swing->swing->foot);
  Pattern result = relative;
  for (int k = 1; k < times; ++k) {
    const bool odd = k % 2 == 1;
    const Pattern& next = odd ? image : relative;
    const Side side = odd ? other(carries) : carries;
    const FootPlan so_far(model, result);
    const double begin = result.phases.back().until;
    const std::array<Isometry3d, 2> then = start_feet(model, next);
    const Isometry3d shift = on_level_ground(so_far.pose(side, begin)) *
                             on_level_ground(then[static_cast<size_t>(index(side))]).inverse();
    require_moved_together(shift, next);
    for (Phase phase : next.phases) {
      phase.pointer.clear();
      phase.until = round_time(phase.until + k * length);
      result.phases.push_back(phase);
    }
    for (Keyframe key : next.keyframes) {
      key.pointer.clear();
      key.t = round_time(key.t + k * length);
      if (key.posture && odd && !has_same_posture(image, relative, *key.posture)) {
        for (const auto& [joint, angle] : posture_joints(model, image, *key.posture, key.place))
          key.joints.emplace(joint, angle);
        key.posture.reset();
      }
      move_key(shift, key);
      put_key(result.keyframes, key);
    }
  }
  if (close)
    for (auto phase = result.phases.rbegin(); phase != result.phases.rend(); ++phase)
      if (phase->swing) {
        phase->swing->step = RelativeStep{};
        break;
      }
  return result;
}

}  // namespace ayumi
