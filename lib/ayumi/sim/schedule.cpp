#include "ayumi/sim/schedule.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/overloaded.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/sim/run_caution.hpp"
#include "ayumi/sim/step_check.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Time in which a bump rises [s]. Chosen: 20 steps of 1 ms, so that the rate of its height is
/// smooth and short against a step of a walk. No measured case changes between half and twice the
/// value (constants.md).
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

/// Factor on the rectangle's value in step i of n. For impulses, its mean over the steps is 1.
double shape_factor(const Push& push, long i, long n) {
  if (push.shape == PushShape::rectangle) return 1.0;
  const double phase = M_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
  if (push.kind != PushKind::impulse) return elementary::sin(phase);
  // The sum of the sine over midpoints is 1 / sin(pi / 2n).
  return static_cast<double>(n) * elementary::sin(M_PI / (2.0 * static_cast<double>(n))) *
         elementary::sin(phase);
}

/// The force or torque of a push of rectangular shape over `time` [N] or [N m].
double level(const Push& push, const Disturbance& d, double time) {
  const double value = push.kind == PushKind::impulse ? push.magnitude / time : push.magnitude;
  if (!(std::abs(value) < kLargestNumber))
    fail(ErrorCode::bad_pattern,
         "scenario: the push at " + text::brief(d.at) + " s has the size " + text::brief(value) +
             " N (or N m), but the size must be below 1e6; give the push a smaller "
             "magnitude, or an impulse a longer duration");
  return value;
}

bool is_push(const Disturbance& d) { return std::holds_alternative<Push>(d.what); }

void add_fault(const EncoderOffset& d, JointFault& joint) { joint.encoder += d.offset; }
void add_fault(const GainLoss& d, JointFault& joint) { joint.gain *= 1 - d.share; }
void add_fault(const JointFriction& d, JointFault& joint) {
  joint.coulomb += d.coulomb;
  joint.viscous += d.viscous;
}

/// A disturbance in words, for the log.
struct Words {
  std::string operator()(const Push& d) const {
    static constexpr const char* units[] = {" N s on ", " N on ", " N m on "};
    return text::brief(d.magnitude) + units[static_cast<int>(d.kind)] + d.on;
  }
  std::string operator()(const Payload& d) const {
    return "payload of " + text::brief(d.mass) + " kg on " + d.on;
  }
  std::string operator()(const FloorPath& d) const {
    return "floor tilts by " + degrees(d.tilt.norm()) + " and shifts by " +
           text::brief(d.shift.norm()) + " m";
  }
  std::string operator()(const FrictionChange& d) const {
    return "friction " + text::brief(d.friction);
  }
  std::string operator()(const Bump& d) const {
    return "bump of " + text::brief(d.height) + " m" +
           (d.foot ? std::string(" under the ") + name_of(*d.foot) + " foot" : std::string());
  }
  std::string operator()(const Latency& d) const {
    return "latency of " + text::brief(d.latency) + " s";
  }
  std::string operator()(const SensorBias& d) const {
    return "sensor bias: attitude " + degrees(d.tilt.norm()) + ", gyro " +
           text::brief(d.gyro.norm()) + " rad/s, load cells " + text::brief(d.load) + " N";
  }
  std::string operator()(const EncoderOffset& d) const {
    return "encoder offset of " + text::brief(d.offset) + on_joint(d.joint);
  }
  std::string operator()(const JointFriction& d) const {
    return "joint friction of " + text::brief(d.coulomb) + ", viscous " + text::brief(d.viscous) +
           on_joint(d.joint);
  }
  std::string operator()(const GainLoss& d) const {
    return "servo gain reduced by " + text::fixed(100 * d.share, 0) + " %" + on_joint(d.joint);
  }

 private:
  static std::string degrees(double angle) { return text::brief(angle * 180 / M_PI) + " deg"; }
  static std::string on_joint(const std::string& joint) {
    return joint.empty() ? " at all joints" : " at " + joint;
  }
};

std::string words(const Disturbance& d) { return std::visit(Words(), d.what); }

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
  motions_ = floor_motions(scenario);
  for (const Disturbance& d : scenario) {
    Entry entry{.source = d};
    entry.first = std::lround(d.at / step_);
    entry.count = std::max(1l, std::lround(d.duration / step_));
    if (const auto* push = std::get_if<Push>(&d.what)) {
      entry.per_step = level(*push, d, static_cast<double>(entry.count) * step_);
      entry.link = find_pushed_link(*model_, push->on);
    } else if (const auto* payload = std::get_if<Payload>(&d.what)) {
      if (payload->on.empty() || payload->on == "cog")
        fail(ErrorCode::bad_pattern, "scenario: a payload needs a link that carries it");
      entry.link = find_pushed_link(*model_, payload->on);
    }
    std::visit(
        [&](const auto& what) {
          if constexpr (requires { what.joint; }) entry.joint = find_joint(*model_, what.joint);
        },
        d.what);
    entries_.push_back(entry);
  }
}

bool Schedule::acts(const Entry& entry, long k) const {
  const bool before = k < 0 && entry.first == 0 && !is_push(entry.source);
  return before || (k >= entry.first && k < entry.first + entry.count);
}

ExternalWrench Schedule::wrench(const Entry& entry, const Push& push, long k,
                                const RobotData& data) const {
  ExternalWrench w;
  Vector3d direction = push.direction;
  if (entry.link >= 0) {
    const Isometry3d pose = link_pose(*model_, data, entry.link);
    w.body = model_->links()[entry.link].body;
    w.point = pose * push.point;
    if (push.frame == PushFrame::link) direction = pose.linear() * direction;
  } else if (push.frame == PushFrame::link) {
    direction = data.rotation[model_->trunk_body()] * direction;
  }
  const Vector3d value =
      entry.per_step * shape_factor(push, k - entry.first, entry.count) * direction;
  (push.kind == PushKind::torque ? w.torque : w.force) = value;
  return w;
}

RisingDisc Schedule::disc(Entry& entry, const Bump& bump, long k, const RobotData& data) const {
  if (!entry.place) {
    entry.place = bump.place;
    if (bump.foot) {
      const Vector3d p =
          sole_pose(*model_, data, *bump.foot) * Vector3d(bump.place.x(), bump.place.y(), 0);
      const double t = static_cast<double>(k) * step_;
      entry.place = (floor_pose(world_, motions_, t).inverse() * p).head<2>();
    }
  }
  const auto height = [&](long i) {
    const double s = std::clamp(static_cast<double>(i) * step_ / kBumpRise, 0.0, 1.0);
    return bump.height * s * s * s * (10 - 15 * s + 6 * s * s);
  };
  // A bump that begins at 0 existed before the start and does not rise.
  const long since = entry.first == 0 ? 1l << 30 : k - entry.first;
  RisingDisc result;
  result.block.kind = GroundBlock::Kind::disc;
  result.block.center = *entry.place;
  result.block.radius = bump.radius;
  result.block.height = world_.height + height(since);
  result.rate = (height(since + 1) - height(since)) / step_;
  return result;
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
    const auto fault = [&](const auto& d) {
      const int n = model_->dof_count();
      if (input.joints.empty()) input.joints.resize(static_cast<size_t>(n));
      for (int j = std::max(entry.joint, 0); j < (entry.joint < 0 ? n : entry.joint + 1); ++j)
        add_fault(d, input.joints[static_cast<size_t>(j)]);
    };
    std::visit(
        Overloaded{
            [&](const Push& d) { input.wrenches.push_back(wrench(entry, d, k, data)); },
            [&](const Payload& d) {
              input.payloads.push_back({entry.link, d.point, d.mass});
            },
            [&](const FrictionChange& d) { input.friction = d.friction; },
            [&](const Bump& d) { input.bumps.push_back(disc(entry, d, k, data)); },
            [&](const EncoderOffset& d) { fault(d); }, [&](const JointFriction& d) { fault(d); },
            [&](const GainLoss& d) { fault(d); }, [](const FloorPath&) {},  // see input.floor
            [](const Latency&) {},                                          // see sensor_fault()
            [](const SensorBias&) {},                                       // see sensor_fault()
        },
        entry.source.what);
  }
}

SensorFault Schedule::sensor_fault(long k) const {
  SensorFault fault;
  for (const Entry& entry : entries_) {
    if (!acts(entry, k)) continue;
    if (const auto* late = std::get_if<Latency>(&entry.source.what)) fault.latency += late->latency;
    if (const auto* bias = std::get_if<SensorBias>(&entry.source.what)) {
      fault.tilt += bias->tilt;
      fault.gyro += bias->gyro;
      fault.force += bias->load;
    }
  }
  return fault;
}

double Schedule::largest_latency() const {
  double sum = 0;
  for (const Entry& entry : entries_)
    if (const auto* late = std::get_if<Latency>(&entry.source.what)) sum += late->latency;
  return sum;
}

std::vector<SimulationEvent> Schedule::events() const {
  std::vector<SimulationEvent> events;
  for (const Entry& entry : entries_) {
    const bool push = is_push(entry.source);
    const bool floor = std::holds_alternative<FloorPath>(entry.source.what);
    const std::string text = words(entry.source);
    events.push_back({static_cast<double>(entry.first) * step_,
                      push ? EventKind::push : EventKind::disturbance, text});
    if (!push)
      events.push_back({static_cast<double>(entry.first + entry.count) * step_,
                        EventKind::disturbance, text + (floor ? ": done" : ": over")});
  }
  return events;
}

}  // namespace ayumi
