#include "author/author_pose.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/reach.hpp"
#include "ayumi/io/pattern/pattern_edit.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/pattern/pattern_rewrite.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/report/replay.hpp"
#include "ayumi/task/plan_log.hpp"

namespace ayumi::app {

namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// Two times that are written to the millisecond are the same if they differ by less than half a
// millisecond [s].
constexpr double kSameTime = 5e-4;
// A drag by less than this moves nothing [m]. Chosen: lengths are written in tenths of a
// millimetre.
constexpr double kStill = 5e-5;
// If a dragged point ends farther than this from the place to which it was dragged, a message is
// shown [m]. Chosen: a distance that is visible.
constexpr double kWorthSaying = 2e-3;
// Period of the samples while something is dragged [s]. Chosen: differences of the posture are not
// visible, and sampling takes a fifth of the time.
constexpr double kDragTick = 0.005;
// Distance of a dragged ZMP from the edge of the support [m]. Chosen: twice the margin below which
// the check warns, because the motion's own ZMP differs a little from its keys.
constexpr double kInsideSole = 4e-3;
// Number of rounds in which a dragged trunk comes to its place. Chosen: each round covers half of
// the remaining distance or more.
constexpr int kTrunkRounds = 5;
// Distance that a dragged limb keeps from the soft limits of its joints [rad]. Chosen: where a limb
// turns back, the targets of its servos lead by up to 20 ms at 1 rad/s; when both hands of five
// robots were dragged far up and down, no target exceeded a limit.
constexpr double kLimbRoom = 0.02;

// Largest acceleration of a curve over the distance 1 in the time 1 that rests at both ends.
// Derived: 6 for a cubic polynomial, and so for a spline; 10/sqrt(3) = 5.8 for minimum jerk. Where
// the interpolation is linear or holds values, the speed or the place jumps at the keys, however
// far away they are, and the check says so.
constexpr double kPeakAcceleration = 6;
// Share of gravity with which the COG may accelerate where a drag changes its height. Chosen: half
// of the weight stays on the ground.
constexpr double kHeightShare = 0.5;

// The value that is read from its text with this many decimals; zero has no sign.
double rounded(double value, int decimals) { return std::stod(text::fixed(value, decimals)) + 0.0; }
double metres(double value) { return rounded(value, 4); }

// Edits of keyframes by time. All values for one time go into one keyframe.
class KeyEdits {
 public:
  explicit KeyEdits(const AuthorMotion& motion) : motion_(motion) {}

  void set(double time, const std::vector<std::string>& path, const OrderedJson& value) {
    for (auto& [t, members] : times_)
      if (std::abs(t - time) < kSameTime) time = t;
    OrderedJson* place = &times_[time];
    for (const std::string& name : path) place = &(*place)[name];
    *place = value;
  }

  std::vector<PatternEdit> edits() const {
    std::vector<PatternEdit> edits;
    const auto& frames = motion_.task.pattern.keyframes;
    for (const auto& [time, members] : times_) {
      const double t = time;
      const auto there = std::find_if(frames.begin(), frames.end(), [&](const Keyframe& frame) {
        return std::abs(frame.t - t) < kSameTime;
      });
      if (there != frames.end()) {
        const auto i = static_cast<size_t>(there - frames.begin());
        const std::string frame = pointer_of_keyframe(motion_.task.pattern, i);
        set_members(members, frame, edits);
        continue;
      }
      const auto next = std::find_if(frames.begin(), frames.end(),
                                     [&](const Keyframe& frame) { return frame.t > t; });
      OrderedJson frame = {{"t", rounded(time, 3)}};
      for (const auto& [name, value] : members.items()) frame[name] = value;
      const auto i = static_cast<size_t>(next - frames.begin());
      edits.push_back({PatternEdit::Kind::insert, room_before(i, t), frame.dump()});
      // If the time of the next keyframe is relative, it is now relative to the new keyframe.
      if (i == frames.size()) continue;
      const std::string after = pointer_of_keyframe(motion_.task.pattern, i) + "/after";
      if (motion_.document.contains(OrderedJson::json_pointer(after)))
        edits.push_back(
            {PatternEdit::Kind::set, after, OrderedJson(rounded(frames[i].t - t, 3)).dump()});
    }
    return edits;
  }

 private:
  // Pointer of a new keyframe before the i-th one.
  std::string room_before(size_t i, double t) const {
    const Pattern& pattern = motion_.task.pattern;
    if (i == pattern.keyframes.size()) return "/keyframes/-";
    const std::string next = pointer_of_keyframe(pattern, i);
    const bool inside =
        outermost(next) != next &&
        ((i > 0 && outermost(pointer_of_keyframe(pattern, i - 1)) == outermost(next)) ||
         motion_.document.contains(OrderedJson::json_pointer(next + "/after")));
    if (inside)
      fail(ErrorCode::usage,
           "at " + text::exact(t) +
               " s the keyframes come from a repeated block, so no new keyframe "
               "can be written there. Choose the time of a keyframe of the block, "
               "or replace the block by single keyframes");
    return outermost(next);
  }

  // Writes members into an existing value one by one; a missing value is added as a whole.
  void set_members(const OrderedJson& members, const std::string& place,
                   std::vector<PatternEdit>& edits) const {
    for (const auto& [name, value] : members.items()) {
      const std::string pointer = place + "/" + json_pointer_token(name);
      const OrderedJson::json_pointer at(pointer);
      const bool there = motion_.document.contains(at);
      if (value.is_object() && there && motion_.document.at(at).is_object())
        set_members(value, pointer, edits);
      else
        edits.push_back({PatternEdit::Kind::set, pointer, value.dump()});
    }
  }

  const AuthorMotion& motion_;
  std::map<double, OrderedJson> times_;
};

const CommandSample& sample_near(const CommandSeries& series, double time) {
  const auto last = static_cast<double>(series.samples.size() - 1);
  return series.samples[static_cast<size_t>(std::clamp(std::round(time / series.dt), 0.0, last))];
}

double in_unit(const AuthorMotion& motion, const Dof& dof, double value) {
  if (dof.prismatic) return metres(value);
  return motion.task.pattern.degrees ? rounded(value * 180 / M_PI, 2) : rounded(value, 4);
}

double angle_in_unit(const AuthorMotion& motion, double angle) {
  return motion.task.pattern.degrees ? rounded(angle * 180 / M_PI, 2) : rounded(angle, 4);
}

// A track that has no keys yet keeps its present value at the neighbouring keyframes, so that the
// change stays between them. A keyframe nearer than `least` [s] leaves no time for the change, so
// the next one that is farther away is taken, if there is one.
template <typename HasKey, typename Present>
void hold_around(const AuthorMotion& motion, double time, double least, const HasKey& has_key,
                 const Present& set_present) {
  const auto& frames = motion.task.pattern.keyframes;
  const Keyframe *before = nullptr, *after = nullptr;
  bool keyed_before = false, keyed_after = false;
  for (const Keyframe& frame : frames) {
    if (frame.t < time - kSameTime) {
      if (!before || frame.t <= time - least) before = &frame;
      keyed_before = keyed_before || has_key(frame);
    } else if (frame.t > time + kSameTime) {
      if (!after || after->t < time + least) after = &frame;
      keyed_after = keyed_after || has_key(frame);
    }
  }
  if (!keyed_before && before && before->t > 0) set_present(before->t);
  if (!keyed_after && after) set_present(after->t);
}

// A joint's key is in "joints", or in the posture if the keyframe has its posture as angles. Around
// a joint's first key, its motion does not change.
void set_joint(const AuthorMotion& motion, double time, int dof, double value, KeyEdits& keys) {
  const auto& frames = motion.task.pattern.keyframes;
  const Dof& joint = motion.task.robot.dofs()[static_cast<size_t>(dof)];
  const auto set = [&](double t, double angle) {
    std::string list = "joints";
    for (size_t i = 0; i < frames.size(); ++i) {
      const auto& written = motion.document.at(
          OrderedJson::json_pointer(pointer_of_keyframe(motion.task.pattern, i)));
      if (std::abs(frames[i].t - t) < kSameTime && written.contains("posture") &&
          written["posture"].is_object() && written["posture"].contains(joint.name))
        list = "posture";
    }
    keys.set(t, {list, joint.name}, in_unit(motion, joint, angle));
  };
  hold_around(
      motion, time, 0,
      [&](const Keyframe& frame) { return frame.posture || frame.joints.contains(joint.name); },
      [&](double t) { set(t, sample_near(motion.task.series, t).state.theta[dof]); });
  set(time, value);
}

// Places that are typed or drawn have tenths of a millimetre, so a smaller height change counts as
// level.
bool is_level(const Vector3d& change) { return std::abs(change.z()) < 2 * kStill; }
bool is_upright(const Vector3d& change) { return change.head<2>().norm() < 2 * kStill; }

void drag_height(const AuthorMotion& motion, double time, double change, KeyEdits& keys) {
  const auto height = [&](double t) { return sample_near(motion.task.series, t).cog.z(); };
  hold_around(
      motion, time, std::sqrt(kPeakAcceleration * std::abs(change) / (kHeightShare * kGravity)),
      [](const Keyframe& frame) { return frame.cog_height.has_value(); },
      [&](double t) {
        keys.set(t, {"cog", "height"}, metres(height(t)));
      });
  keys.set(time, {"cog", "height"}, metres(height(time) + change));
}

OrderedJson attitude_value(const AuthorMotion& motion, const Matrix3d& attitude) {
  const Vector3d rpy = matrix_to_rpy(attitude);
  OrderedJson value = OrderedJson::object();
  const char* const names[] = {"roll", "pitch", "yaw"};
  for (int i = 0; i < 3; ++i) {
    const double angle = angle_in_unit(motion, rpy[i]);
    if (angle != 0 || i == 1) value[names[i]] = angle;
  }
  return value;
}

Isometry3d body_pose(const AuthorMotion& motion, const CommandSample& sample, int body) {
  RobotData data(motion.task.robot);
  update_positions(motion.task.robot, sample.state, data);
  return data.pose(body);
}

// An attitude with the upright axis of `wanted` and the yaw of `now`.
Matrix3d with_yaw_of(const Matrix3d& now, const Matrix3d& wanted) {
  const double yaw = matrix_to_rpy(now).z();
  const Vector3d up = rpy_to_matrix({0, 0, -yaw}) * wanted.col(2);
  return rpy_to_matrix(
      {-std::asin(std::clamp(up.y(), -1.0, 1.0)), std::atan2(up.x(), up.z()), yaw});
}

// The part of the drag that is perpendicular to the line from the body's origin to the dragged
// point makes the trunk lean; the part along this line raises the COG. A level drag only makes the
// trunk lean, and an upright drag only raises the COG.
void drag_trunk(const AuthorMotion& motion, double time, const AuthorHandle& handle,
                const Vector3d& change, KeyEdits& keys) {
  const auto attitude = [&](double t) {
    return Matrix3d(body_pose(motion, sample_near(motion.task.series, t), handle.body).linear());
  };
  const Matrix3d now = attitude(time);
  const Vector3d arm = now * handle.point;
  if (arm.norm() < 1e-3) return;
  const bool level = is_level(change), upright = is_upright(change);
  const double along = level ? 0 : upright ? change.z() : change.dot(arm.normalized());
  const Vector3d turn = arm.cross(change) / arm.squaredNorm();
  if (!upright && turn.norm() * arm.norm() > kStill) {
    hold_around(
        motion, time, 0, [](const Keyframe& frame) { return frame.torso.has_value(); },
        [&](double t) { keys.set(t, {"torso"}, attitude_value(motion, attitude(t))); });
    const Matrix3d wanted = exp_rotation(turn).toRotationMatrix() * now;
    keys.set(time, {"torso"}, attitude_value(motion, with_yaw_of(now, wanted)));
  }
  if (std::abs(along) > kStill) drag_height(motion, time, along, keys);
}

// The value of a number or expression in the text.
double written_value(const AuthorMotion& motion, const std::string& pointer) {
  return value_in_text(motion.document.dump(), pointer, motion.task.pattern.parameters);
}

// Increases a number or expression of the text by `change`; a missing one counts as 0.
void shift_value(const AuthorMotion& motion, const std::string& pointer, double change,
                 std::vector<PatternEdit>& edits) {
  if (std::abs(change) < kStill) return;
  const OrderedJson::json_pointer at(pointer);
  const double now = motion.document.contains(at) ? written_value(motion, pointer) : 0;
  edits.push_back({PatternEdit::Kind::set, pointer, OrderedJson(metres(now + change)).dump()});
}

// Changes the values of a foothold in the form in which it is written: [x, y], [x, y, z], [x, y, z,
// yaw] or an object.
void move_foothold(const AuthorMotion& motion, const std::string& pointer, const Vector3d& change,
                   std::vector<PatternEdit>& edits) {
  const OrderedJson& written = motion.document.at(OrderedJson::json_pointer(pointer));
  const std::string place = written.is_object() ? pointer + "/position" : pointer;
  const OrderedJson& position = motion.document.at(OrderedJson::json_pointer(place));
  for (int i = 0; i < 3; ++i)
    if (static_cast<size_t>(i) < position.size())  // a foothold without a height gets none
      shift_value(motion, place + "/" + std::to_string(i), change[i], edits);
}

// Moves the place where a swing lands: a foothold, or a step relative to the other foot.
void move_landing(const AuthorMotion& motion, size_t phase, const Vector3d& change,
                  std::vector<PatternEdit>& edits) {
  const std::string swing = pointer_of_phase(motion.task.pattern, phase) + "/swing";
  const std::string step = swing + "/step";
  if (!motion.document.contains(OrderedJson::json_pointer(step)))
    return move_foothold(motion, swing + "/to", change, edits);
  const Swing& plan = *motion.task.pattern.phases[phase].swing;
  const double end = motion.task.pattern.phases[phase].until;
  const auto stands = static_cast<size_t>(other(plan.foot));
  const Vector3d seen =
      sample_near(motion.task.series, end).feet[stands].linear().transpose() * change;
  shift_value(motion, step + "/forward", seen.x(), edits);
  shift_value(motion, step + "/side", seen.y(), edits);
}

OrderedJson foothold_value(const AuthorMotion& motion, const Isometry3d& pose) {
  const Vector3d rpy = matrix_to_rpy(pose.linear()), p = pose.translation();
  OrderedJson value = {metres(p.x()), metres(p.y()), metres(p.z())};
  if (std::abs(rpy.z()) > 1e-4) value.push_back(angle_in_unit(motion, rpy.z()));
  return value;
}

double begin_of(const Pattern& pattern, size_t phase) {
  return phase == 0 ? 0 : pattern.phases[phase - 1].until;
}

size_t phase_at(const Pattern& pattern, double time) {
  for (size_t i = 0; i + 1 < pattern.phases.size(); ++i)
    if (time < pattern.phases[i].until - kSameTime) return i;
  return pattern.phases.size() - 1;
}

// Changes the numbers of a place one by one, so that numbers that do not change stay as they are
// written.
void set_place(const AuthorMotion& motion, const std::string& pointer, const Vector3d& place,
               std::vector<PatternEdit>& edits) {
  for (int i = 0; i < 3; ++i) {
    const std::string number = pointer + "/" + std::to_string(i);
    const double value = metres(place[i]);
    if (std::abs(written_value(motion, number) - value) >= kStill)
      edits.push_back({PatternEdit::Kind::set, number, OrderedJson(value).dump()});
  }
}

// The place of a target, in the frame in which it is written.
void set_target(const AuthorMotion& motion, const std::string& pointer, const Vector3d& place,
                std::vector<PatternEdit>& edits) {
  const bool alone = motion.document.at(OrderedJson::json_pointer(pointer)).is_array();
  set_place(motion, alone ? pointer : pointer + "/position", place, edits);
}

// Moves the place where the foot stood before its first swing. Both feet are written into "start",
// so that only this foot moves.
void drag_start(const AuthorMotion& motion, Side side, const Vector3d& change,
                std::vector<PatternEdit>& edits) {
  const std::string pointer = std::string("/start/") + name_of(side);
  if (motion.document.contains(OrderedJson::json_pointer(pointer))) {
    move_foothold(motion, pointer, change, edits);
    return;
  }
  const auto& feet = motion.task.series.samples.front().feet;
  Isometry3d moved = feet[static_cast<size_t>(side)];
  moved.translation() += change;
  edits.push_back({PatternEdit::Kind::set, pointer, foothold_value(motion, moved).dump()});
  const std::string beside = std::string("/start/") + name_of(other(side));
  if (!motion.document.contains(OrderedJson::json_pointer(beside)))
    edits.push_back({PatternEdit::Kind::set, beside,
                     foothold_value(motion, feet[static_cast<size_t>(other(side))]).dump()});
}

// The swing that brings a foot to its place at a time: the last swing that has begun; -1 if there
// is none.
int swing_before(const Pattern& pattern, Side side, double time) {
  int found = -1;
  for (size_t i = 0; i < pattern.phases.size(); ++i)
    if (begin_of(pattern, i) <= time + kSameTime && pattern.phases[i].swing &&
        pattern.phases[i].swing->foot == side)
      found = static_cast<int>(i);
  return found;
}

// A drag of a foot in the air changes the place where it lands; its part up or down changes the
// lift of the swing.
void drag_swing(const AuthorMotion& motion, size_t phase, double time, const Vector3d& change,
                std::vector<PatternEdit>& edits) {
  const Pattern& pattern = motion.task.pattern;
  const double begin = begin_of(pattern, phase), end = pattern.phases[phase].until;
  const std::string swing = pointer_of_phase(pattern, phase) + "/swing";
  if (time > end - kSameTime) {  // the foot has landed
    move_landing(motion, phase, {change.x(), change.y(), 0}, edits);
    return;
  }
  const auto s = static_cast<size_t>(pattern.phases[phase].swing->foot);
  const Vector3d from = sample_near(motion.task.series, begin).feet[s].translation();
  const Vector3d to = sample_near(motion.task.series, end).feet[s].translation();
  const Vector3d now = sample_near(motion.task.series, time).feet[s].translation();
  // The share of the distance that the foot has covered. The landing place moves by the drag
  // divided by this share, which counts as at least a quarter.
  const double way = (to - from).head<2>().norm();
  const double u = (time - begin) / (end - begin);
  const double done = way > kStill ? (now - from).head<2>().norm() / way : u;
  const double share = std::clamp(done, 0.25, 1.0);
  move_landing(motion, phase, {change.x() / share, change.y() / share, 0}, edits);
  if (std::abs(change.z()) < kStill) return;
  const double lift = pattern.phases[phase].swing->lift;
  const double risen = now.z() - from.z() - done * (to.z() - from.z());
  const double more = risen > 1e-3 ? lift * change.z() / risen : change.z();
  edits.push_back({PatternEdit::Kind::set, swing + "/lift",
                   OrderedJson(metres(std::max(0.0, lift + more))).dump()});
}

// A free foot without swings gets a key at this time. At the beginning and the end of its freedom
// it gets keys with the place that it has there.
void drag_free_foot(const AuthorMotion& motion, Side side, double time, const Vector3d& change,
                    KeyEdits& keys, std::vector<PatternEdit>& edits) {
  const Pattern& pattern = motion.task.pattern;
  const auto s = static_cast<size_t>(side);
  size_t first = phase_at(pattern, time), last = first;
  while (first > 0 && !supports(pattern.phases[first - 1].support, side)) --first;
  while (last + 1 < pattern.phases.size() && !supports(pattern.phases[last + 1].support, side))
    ++last;
  const auto pose = [&](double t) { return sample_near(motion.task.series, t).feet[s]; };
  const std::string foot = name_of(side);
  const auto has_key = [&](double t) {
    return std::any_of(pattern.keyframes.begin(), pattern.keyframes.end(), [&](const Keyframe& k) {
      return std::abs(k.t - t) < kSameTime && k.feet[s].has_value();
    });
  };
  for (const double edge : {begin_of(pattern, first), pattern.phases[last].until})
    if (std::abs(edge - time) > kSameTime && !has_key(edge))
      keys.set(edge, {"feet", foot}, foothold_value(motion, pose(edge)));
  // An existing key keeps its form and its expressions, if it has room for the height.
  for (size_t i = 0; i < pattern.keyframes.size(); ++i) {
    if (std::abs(pattern.keyframes[i].t - time) > kSameTime || !pattern.keyframes[i].feet[s])
      continue;
    const std::string pointer = pointer_of_keyframe(pattern, i) + "/feet/" + foot;
    const OrderedJson& written = motion.document.at(OrderedJson::json_pointer(pointer));
    if (written.size() == 2 && written.is_array() && std::abs(change.z()) > kStill) continue;
    return move_foothold(motion, pointer, change, edits);
  }
  Isometry3d moved = pose(time);
  moved.translation() += change;
  keys.set(time, {"feet", foot}, foothold_value(motion, moved));
}

void drag_foot(const AuthorMotion& motion, double time, Side side, const Vector3d& change,
               KeyEdits& keys, std::vector<PatternEdit>& edits) {
  const Pattern& pattern = motion.task.pattern;
  const Vector3d level(change.x(), change.y(), 0);
  const int swing = swing_before(pattern, side, time);
  const bool swings = std::any_of(pattern.phases.begin(), pattern.phases.end(),
                                  [&](const Phase& p) { return p.swing && p.swing->foot == side; });
  if (swing >= 0)
    drag_swing(motion, static_cast<size_t>(swing), time, change, edits);
  else if (swings || supports(pattern.phases[phase_at(pattern, time)].support, side))
    drag_start(motion, side, level, edits);
  else
    drag_free_foot(motion, side, time, change, keys, edits);
}

// ---- a new sampling of the motion

struct Tried {
  CommandSeries series;
  double time = 0;
};

Tried sampled_with(const AuthorMotion& motion, const std::string& text,
                   const AuthorSetting& setting, const std::vector<PatternEdit>& edits,
                   double time) {
  const Pattern pattern =
      pattern_of_text(edited_text(text, edits, setting.set), setting.file, setting.set);
  const double dt =
      std::max(motion.task.series.dt, std::min(kDragTick, motion.task.series.duration() / 50));
  return {sample(motion.task.robot, pattern, {.dt = dt}), time};
}

Vector3d place_of(const AuthorMotion& motion, const AuthorHandle& handle,
                  const CommandSample& sample) {
  RobotData data(motion.task.robot);
  update_positions(motion.task.robot, sample.state, data);
  return handle.body < 0 ? data.cog : Vector3d(data.pose(handle.body) * handle.point);
}

// The page's row at that time, from the few samples around it.
std::string row_of(const AuthorMotion& motion, const Tried& tried) {
  const CommandSeries& all = tried.series;
  const long at = std::lround(tried.time / all.dt),
             last = static_cast<long>(all.samples.size()) - 1;
  const long first = std::clamp(at - 2, 0L, std::max(0L, last - 5));
  CommandSeries part;
  part.dt = all.dt;
  for (long k = first; k <= std::min(last, first + 5); ++k)
    part.samples.push_back(all.samples[static_cast<size_t>(k)]);
  SimulationLog log =
      plan_log(motion.task.robot, motion.task.robot.limits(motion.task.profile), part, part);
  const long here = std::clamp(at - first, 0L, static_cast<long>(log.samples.size()) - 1);
  log.samples = {log.samples[static_cast<size_t>(here)]};
  std::string row = live_series(log, kPageRate);
  const auto time = static_cast<float>(tried.time);
  std::memcpy(row.data(), &time, sizeof time);  // the first column
  return row;
}

// ---- the dragged part

const AuthorHandle handle_named(const AuthorMotion& motion, const std::string& name) {
  for (const AuthorHandle& handle : handles_of(motion.task.robot))
    if (handle.name == name) return handle;
  fail(ErrorCode::usage, "the robot has no handle '" + name + "'");
}

bool has_cog_key(const Keyframe& key, int axis) {
  return axis == 0 ? key.cog_x.has_value() : key.cog_y.has_value();
}

// The ZMP leads the COG along an axis if the COG has no keys there.
bool zmp_leads(const Pattern& pattern, int axis) {
  return std::none_of(pattern.keyframes.begin(), pattern.keyframes.end(),
                      [&](const Keyframe& key) { return has_cog_key(key, axis); });
}

bool has_zmp_keys(const Pattern& pattern) {
  return std::any_of(pattern.keyframes.begin(), pattern.keyframes.end(),
                     [](const Keyframe& key) { return key.zmp.has_value(); });
}

bool stands_still(const Pattern& pattern) {
  return std::all_of(pattern.phases.begin(), pattern.phases.end(), [](const Phase& phase) {
    return phase.support == Support::both && !phase.swing && !phase.viip;
  });
}

class Drag {
 public:
  Drag(const AuthorMotion& motion, const std::string& text, const AuthorSetting& setting,
       const PoseWish& wish)
      : motion_(motion),
        text_(text),
        setting_(setting),
        wish_(wish),
        handle_(handle_named(motion, wish.drag)),
        now_(sample_near(motion.task.series, wish.time)),
        change_(wish.to - place_of(motion, handle_, now_)) {}

  PoseAnswer answer() {
    PoseAnswer out;
    switch (handle_.kind) {
      case AuthorHandle::Kind::limb: {
        const LinkTarget* const leads = leading_target();
        out.edits = leads ? target(*leads) : limb();
        break;
      }
      case AuthorHandle::Kind::gaze: {
        const LinkTarget* const leads = leading_target();
        out.edits = target(leads ? *leads : LinkTarget{});
        break;
      }
      case AuthorHandle::Kind::cog:
        out.edits = cog();
        break;
      case AuthorHandle::Kind::trunk:
        out.edits = trunk();
        break;
      case AuthorHandle::Kind::foot: {
        KeyEdits keys(motion_);
        drag_foot(motion_, wish_.time, handle_.side, change_, keys, out.edits);
        const std::vector<PatternEdit> keyed = keys.edits();
        out.edits.insert(out.edits.end(), keyed.begin(), keyed.end());
        break;
      }
    }
    const Tried tried = sampled(out.edits);
    out.row = row_of(motion_, tried);
    const double off = missed(tried).norm();
    if (message_.empty() && off > kWorthSaying)
      message_ = "The " + handle_.label + " stays " + text::fixed(1000 * off, 0) +
                 " mm away from the wanted place" + reason();
    out.message = message_;
    return out;
  }

 private:
  Tried sampled(const std::vector<PatternEdit>& edits) const {
    return sampled_with(motion_, text_, setting_, edits, wish_.time);
  }

  Vector3d missed(const Tried& tried) const {
    const CommandSample& sample = sample_near(tried.series, wish_.time);
    Vector3d off = wish_.to - place_of(motion_, handle_, sample);
    if (handle_.kind == AuthorHandle::Kind::gaze) {  // any point on the line of sight is looked at
      const Isometry3d head = body_pose(motion_, sample, handle_.body);
      const Vector3d& from =
          motion_.task.robot.bodies()[static_cast<size_t>(handle_.body)].inertia.com;
      const Vector3d axis = (head.linear() * (handle_.point - from)).normalized();
      const Vector3d seen = wish_.to - head * from;
      return seen - std::max(0.0, seen.dot(axis)) * axis;
    }
    // A sole on the ground stays at its height, so its height does not count as a deviation.
    if (handle_.kind == AuthorHandle::Kind::foot) off.z() = 0;
    // A trunk that leans comes down, so its height does not count as a deviation either. A trunk
    // that rises stays over the feet, so its level deviation does not count.
    if (handle_.kind == AuthorHandle::Kind::trunk && is_level(change_)) off.z() = 0;
    if (handle_.kind == AuthorHandle::Kind::trunk && is_upright(change_)) off.head<2>().setZero();
    return off;
  }

  std::string reason() const {
    if (handle_.kind == AuthorHandle::Kind::limb)
      return ": the joints that move this point are at their limits, or the place is too far away.";
    if (handle_.kind == AuthorHandle::Kind::gaze) return ": the neck cannot turn farther.";
    if (handle_.kind == AuthorHandle::Kind::foot)
      return ": other keys of the pattern move this foot too.";
    return ": the soles and the balance allow no more at this time, or other keys of the pattern "
           "move this point too.";
  }

  // Only the arm moves. The balance then moves the base a little, and the arm has to follow it.
  std::vector<PatternEdit> limb() {
    const RobotModel& robot = motion_.task.robot;
    const std::vector<int> dofs = limb_dofs(robot, handle_.body);
    RobotState state = now_.state;
    std::vector<PatternEdit> edits;
    for (int round = 0; round < 3; ++round) {
      const ReachSolution solution = reach(robot, state, handle_.body, handle_.point, wish_.to,
                                           dofs, robot.description().soft_limit_margin + kLimbRoom);
      KeyEdits keys(motion_);
      for (const int dof : dofs)
        if (std::abs(solution.theta[dof] - now_.state.theta[dof]) > 1e-4)
          set_joint(motion_, wish_.time, dof, solution.theta[dof], keys);
      edits = keys.edits();
      const Tried tried = sampled(edits);
      state = sample_near(tried.series, wish_.time).state;
      if (missed(tried).norm() < 5e-4 || solution.missing > 1e-3) break;
    }
    return edits;
  }

  // The target that leads this limb or the gaze. It is that of the last keyframe with a target,
  // unless this keyframe sets the limb free or a later one has keys of the joints.
  const LinkTarget* leading_target() const {
    const RobotModel& robot = motion_.task.robot;
    const Pattern& pattern = motion_.task.pattern;
    const std::vector<int> dofs = limb_dofs(robot, handle_.body);
    const auto moves = [&](const auto& joints) {
      return std::any_of(joints.begin(), joints.end(), [&](const auto& joint) {
        return std::count(dofs.begin(), dofs.end(), robot.find_dof(joint.first)) > 0;
      });
    };
    for (auto key = pattern.keyframes.rbegin(); key != pattern.keyframes.rend(); ++key) {
      if (key->t > wish_.time + kSameTime) continue;
      const LinkTarget* const found = target_in(*key);
      if (found) return found->position ? found : nullptr;
      if (moves(key->joints) ||
          (key->posture && moves(posture_joints(robot, pattern, *key->posture, key->place))))
        return nullptr;
    }
    return nullptr;
  }

  const LinkTarget* target_in(const Keyframe& key) const {
    if (handle_.kind == AuthorHandle::Kind::gaze) return key.gaze ? &*key.gaze : nullptr;
    const auto found = key.hands.find(handle_.link);
    return found == key.hands.end() ? nullptr : &found->second;
  }

  // A key of the target at this time, in the frame of the leading target. The trunk moves a little
  // with the arm, so a few rounds are needed for a place in the frame of the trunk.
  std::vector<PatternEdit> target(const LinkTarget& leads) {
    const bool in_trunk = leads.frame == LinkTarget::Frame::trunk;
    Vector3d to = wish_.to;
    std::vector<PatternEdit> edits;
    for (int round = 0; round < 3; ++round) {
      Isometry3d frame = Isometry3d::Identity();
      if (in_trunk) frame = body_pose(motion_, now_, motion_.task.robot.trunk_body());
      edits = target_edits(leads, frame.inverse() * to);
      const Vector3d off = missed(sampled(edits));
      if (!in_trunk || off.norm() < 5e-4) break;
      to += off;
    }
    return edits;
  }

  std::vector<PatternEdit> target_edits(const LinkTarget& leads, const Vector3d& place) const {
    const Pattern& pattern = motion_.task.pattern;
    const bool gaze = handle_.kind == AuthorHandle::Kind::gaze;
    std::vector<PatternEdit> edits;
    for (size_t i = 0; i < pattern.keyframes.size(); ++i) {
      const Keyframe& key = pattern.keyframes[i];
      const LinkTarget* const there = target_in(key);
      if (std::abs(key.t - wish_.time) > kSameTime || !there || !there->position) continue;
      set_target(motion_,
                 pointer_of_keyframe(pattern, i) +
                     (gaze ? "/gaze" : "/hands/" + json_pointer_token(handle_.link)),
                 place, edits);
      return edits;
    }
    OrderedJson value = {metres(place.x()), metres(place.y()), metres(place.z())};
    if (leads.direction || leads.frame == LinkTarget::Frame::trunk) {
      value = OrderedJson{{"position", value}};
      if (leads.direction)
        value["direction"] = {rounded(leads.direction->x(), 4), rounded(leads.direction->y(), 4),
                              rounded(leads.direction->z(), 4)};
      if (leads.frame == LinkTarget::Frame::trunk) value["frame"] = "trunk";
    }
    KeyEdits keys(motion_);
    keys.set(
        wish_.time,
        gaze ? std::vector<std::string>{"gaze"} : std::vector<std::string>{"hands", handle_.link},
        value);
    return keys.edits();
  }

  // The base moves back under a leaning trunk, so that the COG keeps its place. So the trunk has to
  // lean farther.
  std::vector<PatternEdit> trunk() {
    std::vector<PatternEdit> best;
    double least = std::numeric_limits<double>::infinity();
    Vector3d change = change_;
    for (int round = 0; round < kTrunkRounds; ++round) {
      KeyEdits keys(motion_);
      drag_trunk(motion_, wish_.time, handle_, change, keys);
      try {
        const Vector3d off = missed(sampled(keys.edits()));
        if (off.norm() >= least) break;
        least = off.norm();
        change += off;
      } catch (const Error&) {
        if (best.empty()) throw;
        break;  // a larger change is out of reach
      }
      best = keys.edits();
      if (least < kWorthSaying) break;
    }
    return best;
  }

  std::vector<PatternEdit> cog() {
    const Pattern& pattern = motion_.task.pattern;
    KeyEdits keys(motion_);
    if (std::abs(change_.z()) > kStill) drag_height(motion_, wish_.time, change_.z(), keys);
    bool led = false;
    for (int axis = 0; axis < 2; ++axis)
      if (std::abs(change_[axis]) > kStill && zmp_leads(pattern, axis)) led = true;
    const Vector3d level(change_.x(), change_.y(), 0);
    if (level.norm() < kStill) return keys.edits();
    if (!led || (!has_zmp_keys(pattern) && stands_still(pattern))) {
      const char* const names[] = {"x", "y"};
      for (int axis = 0; axis < 2; ++axis) {
        if (std::abs(change_[axis]) < kStill) continue;
        hold_around(
            motion_, wish_.time, 0, [&](const Keyframe& key) { return has_cog_key(key, axis); },
            [&](double t) {
              keys.set(t, {"cog", names[axis]},
                       metres(sample_near(motion_.task.series, t).cog[axis]));
            });
        keys.set(wish_.time, {"cog", names[axis]}, metres(now_.cog[axis] + change_[axis]));
      }
      return keys.edits();
    }
    if (!has_zmp_keys(pattern)) {
      message_ =
          "The COG follows the ZMP, and Ayumi moves the ZMP from foot to foot. So only the height "
          "of the COG can be dragged here. To move the COG horizontally, write keys of the ZMP.";
      return keys.edits();
    }
    return led_cog(keys, level);
  }

  // Moves the ZMP so far that the COG comes to its place.
  std::vector<PatternEdit> led_cog(const KeyEdits& height, const Vector3d& level) {
    // Largest factor of the change of the ZMP. Chosen: with a larger one, the ZMP would leave every
    // support.
    constexpr double kMost = 6;
    double factor = 1;
    for (int round = 0; round < 2; ++round) {
      const Tried tried = sampled(with_zmp(height, factor * level).edits());
      const Vector3d moved = sample_near(tried.series, wish_.time).cog - now_.cog;
      const double share = moved.head<2>().dot(level.head<2>()) / level.squaredNorm();
      if (share < 0.02 * factor) break;  // a key here hardly moves the COG
      factor = std::min(kMost, factor / share);
    }
    return with_zmp(height, factor * level).edits();
  }

  // The keys with the changed ZMP, which is kept inside the soles, because it cannot be elsewhere.
  KeyEdits with_zmp(const KeyEdits& keys, const Vector3d& change) const {
    const SupportPlane plane = support_plane(motion_.task.robot, now_.support, now_.feet);
    Vector3d place = now_.zmp + change;
    if (!plane.empty()) {
      const Vector3d inside = plane.frame.inverse() * place;
      const Eigen::Vector2d kept = plane.polygon.shrunk(kInsideSole).project(inside.head<2>());
      place = plane.frame * Vector3d(kept.x(), kept.y(), 0);
    }
    KeyEdits with = keys;
    with.set(wish_.time, {"zmp"}, {metres(place.x()), metres(place.y())});
    return with;
  }

  const AuthorMotion& motion_;
  const std::string& text_;
  const AuthorSetting& setting_;
  const PoseWish& wish_;
  AuthorHandle handle_;
  const CommandSample& now_;
  Vector3d change_;
  std::string message_;
};

// Moves the place of a key's target, wherever the target is shown in the picture.
std::vector<PatternEdit> moved_target(const AuthorMotion& motion, const PoseWish& wish) {
  for (const AuthorTarget& target : targets_of(motion)) {
    if (target.pointer != wish.target || std::abs(target.time - wish.time) > kSameTime) continue;
    const OrderedJson& written = motion.document.at(OrderedJson::json_pointer(target.pointer));
    const OrderedJson& place = written.is_array() ? written : written.at("position");
    const std::string pointer = target.pointer + (written.is_array() ? "" : "/position");
    Vector3d now;
    for (size_t i = 0; i < 3; ++i)
      now[static_cast<Eigen::Index>(i)] = written_value(motion, pointer + "/" + std::to_string(i));
    std::vector<PatternEdit> edits;
    if (place.size() == 3)
      set_place(motion, pointer, now + target.axes.transpose() * (wish.to - target.place), edits);
    return edits;
  }
  fail(ErrorCode::usage, "the pattern has no target '" + wish.target + "' at this time");
}

std::vector<PatternEdit> joint_edits(const AuthorMotion& motion, const PoseWish& wish) {
  KeyEdits keys(motion);
  for (const auto& [name, value] : wish.joints) {
    const int dof = motion.task.robot.find_dof(name);
    if (dof < 0) fail(ErrorCode::usage, "the robot has no joint '" + name + "'");
    set_joint(motion, wish.time, dof, value, keys);
  }
  return keys.edits();
}

}  // namespace

PoseAnswer posed(const AuthorMotion& motion, const std::string& text, const AuthorSetting& setting,
                 const PoseWish& wish) {
  try {
    if (!wish.drag.empty()) {
      // The picture has fewer samples than the motion. So the distance of the drag is used, and not
      // the place.
      PoseWish exact = wish;
      if (wish.from)
        exact.to += place_of(motion, handle_named(motion, wish.drag),
                             sample_near(motion.task.series, wish.time)) -
                    *wish.from;
      return Drag(motion, text, setting, exact).answer();
    }
    PoseAnswer out;
    out.edits = wish.target.empty() ? joint_edits(motion, wish) : moved_target(motion, wish);
    out.row = row_of(motion, sampled_with(motion, text, setting, out.edits, wish.time));
    return out;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_pattern) throw;
    // If the point is out of reach, the message says by how much.
    return {{}, {}, without_file(error, setting.file)};
  }
}

std::vector<PatternEdit> captured(const AuthorMotion& motion, double time, const std::string& name,
                                  bool mirror, const std::map<std::string, double>& angles) {
  if (name.empty()) fail(ErrorCode::usage, "the posture needs a name");
  const RobotModel& robot = motion.task.robot;
  Eigen::VectorXd theta = sample_near(motion.task.series, time).state.theta;
  for (const auto& [joint, angle] : angles)
    if (const int dof = robot.find_dof(joint); dof >= 0) theta[dof] = angle;
  Eigen::VectorXd shown = theta;
  if (mirror) {
    const MirrorMap map = mirror_map(robot);
    for (Eigen::Index i = 0; i < theta.size(); ++i)
      shown[map.dof[static_cast<size_t>(i)]] = map.sign[static_cast<size_t>(i)] * theta[i];
  }
  OrderedJson posture = OrderedJson::object();
  for (int dof = 0; dof < robot.dof_count(); ++dof)
    posture[robot.dofs()[static_cast<size_t>(dof)].name] =
        in_unit(motion, robot.dofs()[static_cast<size_t>(dof)], shown[dof]);
  return {{PatternEdit::Kind::set, "/postures/" + json_pointer_token(name), posture.dump()}};
}

namespace {

// The keyframes of a pattern as they are written.
OrderedJson written_keyframes(const Pattern& pattern) {
  return OrderedJson::parse(pattern_text(pattern), nullptr, true, true).at("keyframes");
}

// The edits that turn `from` into `to`, in whatever form the author's text states `from`.
void difference(const OrderedJson& from, const OrderedJson& to, const std::string& pointer,
                const OrderedJson& written, std::vector<PatternEdit>& edits) {
  for (const auto& [name, value] : from.items())
    if (!to.contains(name) && written.contains(name))
      edits.push_back({PatternEdit::Kind::remove, pointer + "/" + json_pointer_token(name), ""});
  for (const auto& [name, value] : to.items()) {
    const std::string place = pointer + "/" + json_pointer_token(name);
    if (from.contains(name) && from[name] == value) continue;
    const bool inside = value.is_object() && from.contains(name) && from[name].is_object() &&
                        written.contains(name) && written[name].is_object();
    if (inside)
      difference(from[name], value, place, written[name], edits);
    else
      edits.push_back({PatternEdit::Kind::set, place, value.dump()});
  }
}

size_t keyframe_at(const Pattern& pattern, const std::string& pointer) {
  for (size_t i = 0; i < pattern.keyframes.size(); ++i)
    if (pointer_of_keyframe(pattern, i) == pointer) return i;
  fail(ErrorCode::usage, "the pattern has no keyframe " + pointer);
}

}  // namespace

MirroredKeyframe mirrored_keyframe(const AuthorMotion& motion, const std::string& text,
                                   const AuthorSetting& setting, const std::string& pointer) {
  Pattern before = motion.task.pattern;
  // A table would get another name, and parameters that are set from outside would be written.
  const bool may_keep_text = !before.table && setting.set.empty();
  before.table.reset();
  const size_t i = keyframe_at(before, pointer);
  const Pattern after =
      with_key_edited(motion.task.robot, before, {.at = before.keyframes[i].t, .mirror = true});
  const OrderedJson& written = motion.document.at(OrderedJson::json_pointer(pointer));
  OrderedJson from = written_keyframes(before).at(i), to = written_keyframes(after).at(i);
  for (OrderedJson* const frame : {&from, &to}) {
    frame->erase("t");
    // Angles of joints are a posture without a name; the author may have written them as "joints".
    if (!written.contains("joints") || !frame->contains("posture") ||
        !frame->at("posture").is_object())
      continue;
    (*frame)["joints"] = frame->at("posture");
    frame->erase("posture");
  }
  MirroredKeyframe result;
  difference(from, to, pointer, written, result.edits);
  if (result.edits.empty() || !may_keep_text) return result;
  if (auto own = rewritten(text, before, after, {.out = setting.file}))
    result.text = std::move(own->text);
  return result;
}

}  // namespace ayumi::app
