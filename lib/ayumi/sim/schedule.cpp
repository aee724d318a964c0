#include "ayumi/sim/schedule.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/sim/run_caution.hpp"
#include "ayumi/sim/step_check.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Time in which a bump rises [s]. Chosen: 20 steps of 1 ms, so that the rate of its height is
/// smooth and short against a step of a walk. No measured case changes from half to twice
/// (constants.md).
constexpr double kBumpRise = 0.02;

int find_pushed_link(const RobotModel& model, const std::string& name) {
  if (name == "cog") return -1;
  const int link = model.find_link(name);
  if (link >= 0) return link;
  std::vector<std::string> names;
  for (const Link& l : model.links()) names.push_back(l.name);
  fail(ErrorCode::bad_pattern, "scenario: " + model.name() + " has no link '" + name + "'" +
                                   text::suggestion(name, names) +
                                   " ('cog' pushes through the centre of gravity)");
}

int find_joint(const RobotModel& model, const std::string& name) {
  if (name.empty()) return -1;
  const std::vector<std::string> names = model.dof_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    fail(ErrorCode::bad_pattern, "scenario: " + model.name() + " has no joint '" + name + "'" +
                                     text::suggestion(name, names));
  return static_cast<int>(found - names.begin());
}

/// Factor on the rectangle's value in step i of n; its mean over the steps is 1 for impulses.
double shape_factor(const Disturbance& d, long i, long n) {
  if (d.shape == DisturbanceShape::rectangle) return 1.0;
  const double phase = M_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
  if (d.type != DisturbanceType::impulse) return std::sin(phase);
  // The sum of sin over midpoints is 1 / sin(pi / 2n).
  return static_cast<double>(n) * std::sin(M_PI / (2.0 * static_cast<double>(n))) * std::sin(phase);
}

bool is_push(DisturbanceType type) {
  return type == DisturbanceType::impulse || type == DisturbanceType::force ||
         type == DisturbanceType::torque;
}

std::string degrees(double angle) { return text::brief(angle * 180 / M_PI) + " deg"; }

std::string on_joint(const Disturbance& d) {
  return d.joint.empty() ? " at all joints" : " at " + d.joint;
}

/// A disturbance in words, for the log.
std::string words(const Disturbance& d) {
  const std::string size = text::brief(d.magnitude);
  switch (d.type) {
    case DisturbanceType::impulse:
      return size + " N s on " + d.on;
    case DisturbanceType::force:
      return size + " N on " + d.on;
    case DisturbanceType::torque:
      return size + " N m on " + d.on;
    case DisturbanceType::payload:
      return "payload of " + size + " kg on " + d.on;
    case DisturbanceType::floor:
      return "floor tilts by " + degrees(d.floor.tilt.norm()) + " and shifts by " +
             text::brief(d.floor.shift.norm()) + " m";
    case DisturbanceType::friction:
      return "friction " + size;
    case DisturbanceType::bump:
      return "bump of " + size + " m" +
             (d.foot ? std::string(" under the ") + name_of(*d.foot) + " foot" : std::string());
    case DisturbanceType::latency:
      return "latency of " + size + " s";
    case DisturbanceType::sensor_bias:
      return "sensor bias: attitude " + degrees(d.tilt_bias.norm()) + ", gyro " +
             text::brief(d.gyro_bias.norm()) + " rad/s, load cells " + text::brief(d.force_bias) +
             " N";
    case DisturbanceType::encoder_offset:
      return "encoder offset of " + size + on_joint(d);
    case DisturbanceType::joint_friction:
      return "joint friction of " + size + ", viscous " + text::brief(d.viscous) + on_joint(d);
    case DisturbanceType::gain_loss:
      return "servo gain less by " + text::fixed(100 * d.magnitude, 0) + " %" + on_joint(d);
  }
  return "";
}

}  // namespace

std::string words_of(const std::vector<Disturbance>& scenario) {
  std::vector<std::string> parts;
  for (const Disturbance& d : scenario)
    parts.push_back(words(d) + " at " + text::brief(d.at) + " s");
  return text::join(parts, "; ");
}

FloorPose moving_floor(const World& world, const std::vector<FloorMotion>& motions, double t,
                       double step) {
  FloorPose floor{.pose = floor_pose(world, motions, t)};
  const Isometry3d next = floor_pose(world, motions, t + step);
  floor.velocity = (next.translation() - floor.pose.translation()) / step;
  floor.angular_velocity =
      log_rotation(Eigen::Quaterniond(next.linear() * floor.pose.linear().transpose())) / step;
  return floor;
}

Schedule::Schedule(const RobotModel& model, const World& world, double step)
    : model_(&model), world_(world), step_(step) {}

void Schedule::set(const std::vector<Disturbance>& scenario) {
  entries_.clear();
  motions_.clear();
  for (const Disturbance& d : scenario) {
    Entry entry{.source = d};
    entry.first = std::lround(d.at / step_);
    entry.count = std::max(1l, std::lround(d.duration / step_));
    entry.per_step = d.type == DisturbanceType::impulse
                         ? d.magnitude / (static_cast<double>(entry.count) * step_)
                         : d.magnitude;
    if (is_push(d.type) && !(std::abs(entry.per_step) < kLargestNumber))
      fail(ErrorCode::bad_pattern,
           "scenario: the push at " + text::brief(d.at) + " s has " + text::brief(entry.per_step) +
               " N (N m); give a smaller one than 1e6 or a longer duration");
    entry.link = find_pushed_link(*model_, d.on);
    entry.joint = find_joint(*model_, d.joint);
    if (d.type == DisturbanceType::payload && entry.link < 0)
      fail(ErrorCode::bad_pattern, "scenario: a payload needs a link that carries it");
    if (d.type == DisturbanceType::floor) motions_.push_back(floor_motion(d));
    entries_.push_back(entry);
  }
}

bool Schedule::acts(const Entry& entry, long k) const {
  const bool before = k < 0 && entry.first == 0 && !is_push(entry.source.type);
  return before || (k >= entry.first && k < entry.first + entry.count);
}

ExternalWrench Schedule::wrench(const Entry& entry, long k, const RobotData& data) const {
  const Disturbance& d = entry.source;
  ExternalWrench w;
  Vector3d direction = d.direction;
  if (entry.link >= 0) {
    const Isometry3d pose = link_pose(*model_, data, entry.link);
    w.body = model_->links()[entry.link].body;
    w.point = pose * d.point;
    if (d.frame == DisturbanceFrame::link) direction = pose.linear() * direction;
  } else if (d.frame == DisturbanceFrame::link) {
    direction = data.rotation[model_->trunk_body()] * direction;
  }
  const Vector3d value = entry.per_step * shape_factor(d, k - entry.first, entry.count) * direction;
  (d.type == DisturbanceType::torque ? w.torque : w.force) = value;
  return w;
}

Bump Schedule::bump(Entry& entry, long k, const RobotData& data) const {
  const Disturbance& d = entry.source;
  if (!entry.placed) {
    entry.placed = true;
    entry.place = d.place;
    if (d.foot) {
      const Vector3d p = sole_pose(*model_, data, *d.foot) * Vector3d(d.place.x(), d.place.y(), 0);
      const double t = static_cast<double>(k) * step_;
      entry.place = (floor_pose(world_, motions_, t).inverse() * p).head<2>();
    }
  }
  const auto height = [&](long i) {
    const double s = std::clamp(static_cast<double>(i) * step_ / kBumpRise, 0.0, 1.0);
    return d.magnitude * s * s * s * (10 - 15 * s + 6 * s * s);
  };
  // A bump that begins at 0 was there before the start and does not rise.
  const long since = entry.first == 0 ? 1l << 30 : k - entry.first;
  Bump result;
  result.block.kind = GroundBlock::Kind::disc;
  result.block.center = entry.place;
  result.block.radius = d.radius;
  result.block.height = world_.height + height(since);
  result.rate = (height(since + 1) - height(since)) / step_;
  return result;
}

void Schedule::fault(const Entry& entry, std::vector<JointFault>& joints) const {
  const Disturbance& d = entry.source;
  const int n = model_->dof_count();
  if (joints.empty()) joints.resize(static_cast<size_t>(n));
  for (int j = std::max(entry.joint, 0); j < (entry.joint < 0 ? n : entry.joint + 1); ++j) {
    JointFault& joint = joints[static_cast<size_t>(j)];
    if (d.type == DisturbanceType::encoder_offset) joint.encoder += d.magnitude;
    if (d.type == DisturbanceType::gain_loss) joint.gain *= 1 - d.magnitude;
    if (d.type != DisturbanceType::joint_friction) continue;
    joint.coulomb += d.magnitude;
    joint.viscous += d.viscous;
  }
}

void Schedule::fill(long k, const RobotData& data, StepInput& input) {
  input.wrenches.clear();
  input.payloads.clear();
  input.joints.clear();
  input.bumps.clear();
  input.friction.reset();
  input.floor.reset();
  if (!motions_.empty() || !world_.motions.empty()) {
    input.floor = moving_floor(world_, motions_, static_cast<double>(k) * step_, step_);
  }
  for (Entry& entry : entries_) {
    if (!acts(entry, k)) continue;
    const Disturbance& d = entry.source;
    switch (d.type) {
      case DisturbanceType::impulse:
      case DisturbanceType::force:
      case DisturbanceType::torque:
        input.wrenches.push_back(wrench(entry, k, data));
        break;
      case DisturbanceType::payload:
        input.payloads.push_back({entry.link, d.point, d.magnitude});
        break;
      case DisturbanceType::friction:
        input.friction = d.magnitude;
        break;
      case DisturbanceType::bump:
        input.bumps.push_back(bump(entry, k, data));
        break;
      case DisturbanceType::encoder_offset:
      case DisturbanceType::joint_friction:
      case DisturbanceType::gain_loss:
        fault(entry, input.joints);
        break;
      default:
        break;
    }
  }
}

SensorFault Schedule::sensor_fault(long k) const {
  SensorFault fault;
  for (const Entry& entry : entries_) {
    if (!acts(entry, k)) continue;
    const Disturbance& d = entry.source;
    if (d.type == DisturbanceType::latency) fault.latency += d.magnitude;
    if (d.type != DisturbanceType::sensor_bias) continue;
    fault.tilt += d.tilt_bias;
    fault.gyro += d.gyro_bias;
    fault.force += d.force_bias;
  }
  return fault;
}

double Schedule::largest_latency() const {
  double sum = 0;
  for (const Entry& entry : entries_)
    if (entry.source.type == DisturbanceType::latency) sum += entry.source.magnitude;
  return sum;
}

std::vector<SimulationEvent> Schedule::events() const {
  std::vector<SimulationEvent> events;
  for (const Entry& entry : entries_) {
    const bool push = is_push(entry.source.type);
    const std::string text = words(entry.source);
    events.push_back(
        {static_cast<double>(entry.first) * step_, push ? "push" : "disturbance", text});
    if (!push)
      events.push_back(
          {static_cast<double>(entry.first + entry.count) * step_, "disturbance",
           text + (entry.source.type == DisturbanceType::floor ? ": done" : ": over")});
  }
  return events;
}

}  // namespace ayumi
