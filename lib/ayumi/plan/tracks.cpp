#include "ayumi/plan/tracks.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/quintic.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/motion/servo_feedforward.hpp"

namespace ayumi {

using Eigen::Vector3d;

namespace {

// Times closer than this are equal [s]. Chosen: above rounding. No measured case changes between
// half and twice the value (constants.md).
constexpr double kSameTime = 1e-9;

// Time of the weight shift at both ends of the motion [s]. Chosen: 3/omega for a COG at 0.22 m. No
// measured case changes between half and twice the value (constants.md).
constexpr double kShift = 0.45;

using Keys = std::vector<TrackKey>;

// Collects the keys of every quantity in the order of the keyframes.
struct KeyReader {
  const RobotModel& model;
  const Pattern& pattern;
  const FootPlan& feet;
  const std::vector<bool>& solved;
  double height;
  std::vector<Keys> joints;
  std::array<Keys, 3> cog, zmp, torso;
  Keys fz;
  bool leg_joints = false, leg_postures = false;
  std::string first_leg_key;

  void read(const Keyframe& key);
  void read_joints(const Keyframe& key, Interpolation interpolation);
  void add(Keys& keys, const Keyframe& key, double value, double start,
           Interpolation interpolation);
  Vector3d zmp_point(const ZmpKey& key, const Keyframe& at) const;
};

[[noreturn]] void complain(const Keyframe& key, const std::string& message) {
  fail(ErrorCode::bad_pattern, key.place, message);
}

void KeyReader::add(Keys& keys, const Keyframe& key, double value, double start,
                    Interpolation interpolation) {
  if (!std::isfinite(value)) complain(key, "a value is not a finite number");
  if (keys.empty() && key.t > 0) keys.push_back({0, start, Interpolation::hold});
  keys.push_back({key.t, value, interpolation});
}

Vector3d KeyReader::zmp_point(const ZmpKey& key, const Keyframe& at) const {
  switch (key.place) {
    case ZmpKey::Place::left:
      return feet.sole_center(Side::left, at.t);
    case ZmpKey::Place::right:
      return feet.sole_center(Side::right, at.t);
    case ZmpKey::Place::center:
      return feet.support_center(at.t);
    case ZmpKey::Place::point:
      break;
  }
  return {key.point.x(), key.point.y(), feet.support_center(at.t).z()};
}

void KeyReader::read_joints(const Keyframe& key, Interpolation interpolation) {
  const Eigen::VectorXd start = default_posture(model, pattern);
  std::map<int, double> values;
  if (key.posture)
    for (const auto& [joint, angle] : posture_joints(model, pattern, *key.posture, key.place)) {
      const int dof = model.find_dof(joint);
      values[dof] = angle;
      leg_postures = leg_postures || (solved[dof] && std::abs(angle - start[dof]) > 1e-12);
    }
  for (const auto& [joint, angle] : key.joints) {
    const int dof = find_joint(model, joint, key.place);
    values[dof] = angle;
    if (solved[dof] && !leg_joints) {
      leg_joints = true;
      first_leg_key = "keys of " + joint;
    }
  }
  for (const auto& [dof, angle] : values) add(joints[dof], key, angle, start[dof], interpolation);
}

void KeyReader::read(const Keyframe& key) {
  const Interpolation interpolation = key.interpolation.value_or(pattern.interpolation);
  if (!std::isfinite(key.t) || key.t < 0)
    complain(key, "the key is at " + text::exact(key.t) + " s, but key times begin at 0 s");
  if (key.t > feet.duration() + kSameTime)
    complain(key, "the key is at " + text::exact(key.t) +
                      " s, after the end of the last phase at " + text::exact(feet.duration()) +
                      " s. Move the key, or add a phase");
  read_joints(key, interpolation);
  const Vector3d middle = feet.support_center(0);
  if (key.zmp) {
    const Vector3d point = zmp_point(*key.zmp, key);
    for (int i = 0; i < 3; ++i) add(zmp[i], key, point[i], middle[i], interpolation);
  }
  if (key.cog_x) add(cog[0], key, *key.cog_x, middle.x(), interpolation);
  if (key.cog_y) add(cog[1], key, *key.cog_y, middle.y(), interpolation);
  if (key.cog_height) add(cog[2], key, *key.cog_height, height, interpolation);
  if (key.fz) add(fz, key, *key.fz, model.mass() * kGravity, interpolation);
  if (key.torso)
    for (int i = 0; i < 3; ++i) add(torso[i], key, (*key.torso)[i], 0, interpolation);
}

bool same(double a, double b) { return std::abs(a - b) < kSameTime; }

// If a flight has keys of a coordinate at lift-off and touchdown, this coordinate follows a
// parabola in flight, and the motion before and after has the parabola's rate and acceleration.
// Keys inside the flight are kept as they are.
Keys with_flights(const FootPlan& feet, const Keys& keys, double acceleration) {
  std::vector<QuinticEnd> ends;
  std::vector<bool> moving(keys.size(), false);
  for (const TrackKey& key : keys) ends.push_back({key.t, key.value, 0, 0});
  const auto& phases = feet.phases();
  for (size_t i = 0; i < phases.size(); ++i) {
    if (phases[i].support != Support::none) continue;
    for (size_t k = 0; k + 1 < keys.size(); ++k) {
      if (!same(keys[k].t, feet.begin(static_cast<int>(i))) ||
          !same(keys[k + 1].t, phases[i].until))
        continue;
      const double length = keys[k + 1].t - keys[k].t;
      const double mean = (keys[k + 1].value - keys[k].value) / length;
      ends[k] = {keys[k].t, keys[k].value, mean - acceleration * length / 2, acceleration};
      ends[k + 1] = {keys[k + 1].t, keys[k + 1].value, mean + acceleration * length / 2,
                     acceleration};
      moving[k] = moving[k + 1] = true;
    }
  }
  Keys result;
  for (size_t k = 0; k < keys.size(); ++k) {
    if (k > 0 && (moving[k - 1] || moving[k])) {
      const Keys dense = quintic_keys({ends[k - 1], ends[k]});
      result.insert(result.end(), dense.begin() + 1, dense.end());
    } else {
      result.push_back(keys[k]);
    }
  }
  return result;
}

// A weight holds until a later key gives the joint another one.
std::vector<std::pair<double, Eigen::VectorXd>> read_weights(const RobotModel& model,
                                                             const Pattern& pattern) {
  std::vector<std::pair<double, Eigen::VectorXd>> result = {{0, model.joint_weight()}};
  for (const Keyframe& key : pattern.keyframes) {
    Eigen::VectorXd weight = result.back().second;
    for (const auto& [joint, value] : key.weights) {
      const int dof = find_joint(model, joint, key.place + "/weights");
      if (!(value > 0) || !std::isfinite(value))
        complain(key, "weight of " + joint + " must be above 0");
      weight[dof] = value;
    }
    if (key.weights.empty()) continue;
    if (key.t <= result.back().first)
      result.back().second = weight;
    else
      result.emplace_back(key.t, weight);
  }
  return result;
}

void check_keyframe_order(const Pattern& pattern) {
  for (size_t i = 1; i < pattern.keyframes.size(); ++i)
    if (!(pattern.keyframes[i].t > pattern.keyframes[i - 1].t))
      complain(pattern.keyframes[i],
               text::exact(pattern.keyframes[i].t) + " s does not come after " +
                   text::exact(pattern.keyframes[i - 1].t) + " s. Key times must increase");
}

// The rows of a table as one smooth track: a cubic spline through all rows.
Track table_track(double dt, size_t rows, const std::function<double(size_t)>& value) {
  Keys keys;
  for (size_t k = 0; k < rows; ++k)
    keys.push_back({dt * static_cast<double>(k), value(k), Interpolation::spline});
  return Track(keys);
}

[[noreturn]] void complain_table(const Pattern& pattern, const std::string& message) {
  fail(ErrorCode::bad_pattern, in_file(pattern, "table " + pattern.table->file), message);
}

void check_table(const Pattern& pattern, const FootPlan& feet) {
  const DenseTable& table = *pattern.table;
  const auto rows = static_cast<size_t>(table.theta.rows());
  if (rows < 2)
    complain_table(pattern, "the table has fewer than two rows. Give at least two rows");
  if (!(table.dt > 0)) complain_table(pattern, "the time step is not above 0");
  if (!table.theta.allFinite()) complain_table(pattern, "a joint angle is not a finite number");
  const double end = table.dt * static_cast<double>(rows - 1);
  if (end > feet.duration() + 0.5 * table.dt)
    complain_table(pattern, "the table ends at " + text::exact(end) + " s, after the last phase (" +
                                text::exact(feet.duration()) + " s). Extend the phases");
  if (static_cast<size_t>(table.theta.cols()) != table.joints.size())
    complain_table(pattern, "the table has " + std::to_string(table.theta.cols()) +
                                " joint columns, but " + std::to_string(table.joints.size()) +
                                " joint names");
  for (const size_t count :
       {table.base.size(), table.cog.size(), table.zmp.size(), table.fz.size()})
    if (count != 0 && count != rows)
      complain_table(pattern,
                     "the columns differ in length. Give every column the same number of rows");
}

void read_table(const RobotModel& model, const Pattern& pattern, KeyReader& reader,
                PatternTracks& tracks) {
  check_table(pattern, reader.feet);
  const DenseTable table = postures_of(model, model.limits(pattern.profile), *pattern.table);
  const auto rows = static_cast<size_t>(table.theta.rows());
  tracks.rest_ends = false;
  for (size_t j = 0; j < table.joints.size(); ++j) {
    const int dof = find_joint(model, table.joints[j], in_file(pattern, "table " + table.file));
    if (!reader.joints[dof].empty())
      complain_table(pattern, "the joint '" + table.joints[j] +
                                  "' has a column and also keys. Remove the keys or the column");
    tracks.joints[dof] = table_track(table.dt, rows, [&](size_t k) {
      return table.theta(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j));
    });
    if (reader.solved[dof]) {
      tracks.joint_driven = true;
      tracks.driver = "the table " + table.file;
    }
  }
  const auto vectors = [&](const std::vector<Vector3d>& column) {
    std::array<Track, 3> result;
    for (int i = 0; i < 3; ++i)
      result[i] = table_track(table.dt, rows, [&](size_t k) { return column[k][i]; });
    return result;
  };
  if (!table.base.empty()) {
    tracks.base.emplace();
    tracks.attitude.emplace();
    for (int i = 0; i < 3; ++i)
      (*tracks.base)[i] =
          table_track(table.dt, rows, [&](size_t k) { return table.base[k].position[i]; });
    std::vector<Eigen::Vector4d> q;  // quaternions w, x, y, z with continuous sign
    for (const BasePose& pose : table.base) {
      const Eigen::Quaterniond& a = pose.attitude;
      Eigen::Vector4d v(a.w(), a.x(), a.y(), a.z());
      q.push_back(!q.empty() && v.dot(q.back()) < 0 ? Eigen::Vector4d(-v) : v);
    }
    for (int i = 0; i < 4; ++i)
      (*tracks.attitude)[i] = table_track(table.dt, rows, [&](size_t k) { return q[k][i]; });
    tracks.origin["base"] = "table " + table.file;
  }
  if (!table.cog.empty()) {
    const auto cog = vectors(table.cog);
    for (int i = 0; i < 3; ++i)
      if (!tracks.cog[i]) tracks.cog[i] = cog[i];
    tracks.origin["cog"] = "table " + table.file;
  }
  if (!table.zmp.empty() && !tracks.zmp) {
    tracks.zmp = vectors(table.zmp);
    tracks.origin["zmp"] = "table " + table.file;
  }
  if (!table.fz.empty() && !tracks.fz) {
    tracks.fz = table_track(table.dt, rows, [&](size_t k) { return table.fz[k]; });
    tracks.origin["fz"] = "table " + table.file;
  }
}

}  // namespace

PatternTracks read_tracks(const RobotModel& model, const Pattern& pattern, const FootPlan& feet,
                          const std::vector<bool>& solved) {
  check_keyframe_order(pattern);
  const double height = default_cog_height(model, pattern) + feet.ground(0);
  KeyReader reader{model, pattern, feet, solved, height, {}, {}, {}, {}, {}, false, false, {}};
  reader.joints.resize(model.dof_count());
  for (size_t i = 0; i < pattern.keyframes.size(); ++i)
    at_place(place_of_keyframe(pattern, i), [&] { reader.read(pattern.keyframes[i]); });
  for (int i = 0; i < 3; ++i)
    reader.cog[i] = with_flights(feet, reader.cog[i], i == 2 ? -kGravity : 0.0);

  PatternTracks tracks;
  tracks.weight = read_weights(model, pattern);
  const Eigen::VectorXd start = default_posture(model, pattern);
  for (int dof = 0; dof < model.dof_count(); ++dof)
    tracks.joints.push_back(reader.joints[dof].empty() ? Track(start[dof])
                                                       : Track(reader.joints[dof]));
  for (int i = 0; i < 3; ++i)
    if (!reader.cog[i].empty()) tracks.cog[i] = Track(reader.cog[i]);
  const auto vector_of = [](const std::array<Keys, 3>& keys) {
    return std::array<Track, 3>{Track(keys[0]), Track(keys[1]), Track(keys[2])};
  };
  if (!reader.zmp[0].empty()) tracks.zmp = vector_of(reader.zmp);
  if (!reader.torso[0].empty()) tracks.torso = vector_of(reader.torso);
  if (!reader.fz.empty()) tracks.fz = Track(reader.fz);
  if (tracks.cog[0] || tracks.cog[1] || tracks.cog[2]) tracks.origin["cog"] = "keys";
  if (tracks.zmp) tracks.origin["zmp"] = "keys";
  if (tracks.fz) tracks.origin["fz"] = "keys";

  const bool body_given = tracks.zmp || tracks.torso || tracks.cog[0] || tracks.cog[1] ||
                          tracks.cog[2] ||
                          std::any_of(pattern.phases.begin(), pattern.phases.end(),
                                      [](const Phase& phase) { return phase.swing.has_value(); });
  if (reader.leg_joints) {
    tracks.joint_driven = true;
    tracks.driver = reader.first_leg_key;
  } else if (reader.leg_postures && !body_given) {
    tracks.joint_driven = true;
    tracks.driver = "posture keys";
  }
  if (pattern.table) read_table(model, pattern, reader, tracks);
  return tracks;
}

std::array<Track, 3> default_zmp(const FootPlan& feet) {
  return default_zmp(feet, {feet.support_center(0), feet.support_center(feet.duration())});
}

std::array<Track, 3> default_zmp(const FootPlan& feet, const std::array<Vector3d, 2>& ends) {
  std::array<Keys, 3> keys;
  const auto add = [&](double t, const Vector3d& point) {
    if (!keys[0].empty() && t <= keys[0].back().t + kSameTime) t = keys[0].back().t + 1e-3;
    for (int i = 0; i < 3; ++i) keys[i].push_back({t, point[i], Interpolation::minimum_jerk});
  };
  add(0, ends[0]);
  const auto& phases = feet.phases();
  for (size_t i = 0; i < phases.size(); ++i) {
    if (phases[i].support == Support::both) continue;
    if (phases[i].support == Support::none) {
      add(feet.begin(static_cast<int>(i)), feet.support_center(feet.begin(static_cast<int>(i))));
      add(phases[i].until, feet.support_center(phases[i].until));
      continue;
    }
    const Side side = phases[i].support == Support::left ? Side::left : Side::right;
    const double begin = feet.begin(static_cast<int>(i));
    if (keys[0].size() == 1 && begin > kShift) add(begin - kShift, ends[0]);
    if (begin > 0) add(begin, feet.sole_center(side, begin));
    add(phases[i].until, feet.sole_center(side, phases[i].until));
  }
  const double end = feet.duration();
  if (keys[0].size() == 1 && ends[1] != ends[0])  // no step: the whole motion leads there
    add(end, ends[1]);
  else if (keys[0].size() > 1 && end > keys[0].back().t + 1e-3)
    add(std::min(end, keys[0].back().t + kShift), ends[1]);
  return {Track(keys[0]), Track(keys[1]), Track(keys[2])};
}

void lead_by_zmp(const FootPlan& feet, PatternTracks& tracks) {
  std::array<Vector3d, 2> ends = {feet.support_center(0), feet.support_center(feet.duration())};
  std::array<bool, 2> given = {false, false};
  for (int axis = 0; axis < 2; ++axis) {
    if (!tracks.cog[axis]) continue;
    given[axis] = true;
    ends[0][axis] = tracks.cog[axis]->at(0).value;
    ends[1][axis] = tracks.cog[axis]->at(feet.duration()).value;
    tracks.cog[axis].reset();
  }
  if (!tracks.zmp) {
    tracks.zmp = default_zmp(feet, ends);
    return;
  }
  // After the last key of the ZMP, the COG goes on to its own last place, if there is time for it.
  for (int axis = 0; axis < 2; ++axis) {
    Keys keys = (*tracks.zmp)[axis].keys();
    const double end = keys.back().t + kShift;
    if (!given[axis] || end > feet.duration() + kSameTime) continue;
    keys.push_back({end, ends[1][axis], Interpolation::minimum_jerk});
    (*tracks.zmp)[axis] = Track(keys);
  }
}

}  // namespace ayumi
