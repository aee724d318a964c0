#include "ayumi/report/replay.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/render/gltf.hpp"
#include "ayumi/render/log_reading.hpp"
#include "ayumi/render/robot_surface.hpp"
#include "ayumi/render/scenery.hpp"
#include "ayumi/report/html.hpp"
#include "ayumi/sim/has_zmp.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using html::quoted;

// Largest number of nodes along a side of a height field; 9216 heights keep the page small.
constexpr int kFieldNodes = 96;

const std::vector<std::string> kColumns = {"t",
                                           "cog.x",
                                           "cog.y",
                                           "cog.z",
                                           "zmp.x",
                                           "zmp.y",
                                           "zmp.z",
                                           "ref_zmp.x",
                                           "ref_zmp.y",
                                           "ref_zmp.z",
                                           "fz",
                                           "left_force.x",
                                           "left_force.y",
                                           "left_force.z",
                                           "left_cop.x",
                                           "left_cop.y",
                                           "left_cop.z",
                                           "left_planned",
                                           "right_force.x",
                                           "right_force.y",
                                           "right_force.z",
                                           "right_cop.x",
                                           "right_cop.y",
                                           "right_cop.z",
                                           "right_planned"};

std::string list(const std::vector<std::string>& items) {
  return "[" + text::join(items, ",") + "]";
}

std::string list(const Vector3d& v) {
  return list({text::exact(v.x()), text::exact(v.y()), text::exact(v.z())});
}

/// Columns for the pose of a moving floor, after the columns above.
const std::vector<std::string> kFloorColumns = {"floor.x",  "floor.y",  "floor.z", "floor.qx",
                                                "floor.qy", "floor.qz", "floor.qw"};

std::string pose_words(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  return "{\"position\":" + list(Vector3d(pose.translation())) + ",\"quaternion\":" +
         list({text::exact(q.x()), text::exact(q.y()), text::exact(q.z()), text::exact(q.w())}) +
         "}";
}

/// A table with rows of 32-bit floats.
struct FloatRows {
  std::string bytes;

  void add(double value) {
    const auto single = static_cast<float>(value);
    bytes.append(reinterpret_cast<const char*>(&single), sizeof single);
  }
  void add(const Vector3d& v) {
    for (const double value : v) add(value);
  }
  void add(const Eigen::Quaterniond& q) {
    for (const double value : q.coeffs()) add(value);
  }
  /// Adds the columns kColumns of a sample.
  void add(double t, const SimulationSample& s) {
    add(t);
    add(s.cog);
    add(s.zmp);
    add(s.reference_zmp);
    add(s.fz);
    for (size_t side = 0; side < 2; ++side) {
      add(s.foot_force[side]);
      add(s.foot_cop[side]);
      add(s.planned_contact[side] ? 1.0 : 0.0);
    }
  }
};

std::string series_bytes(const SimulationLog& log, const std::vector<double>& times) {
  const bool moving = floor_moves(log);
  FloatRows rows;
  for (const double t : times) {
    rows.add(t, sample_at(log, t));
    if (!moving) continue;
    const Eigen::Isometry3d floor = floor_at(log, t);
    rows.add(Vector3d(floor.translation()));
    rows.add(Eigen::Quaterniond(floor.linear()));
  }
  return std::move(rows.bytes);
}

std::string soles_words(const RobotModel& model) {
  if (!model.has_soles()) return "[]";
  std::vector<std::string> soles;
  for (const Side side : {Side::left, Side::right}) {
    const Sole& sole = model.sole(side);
    std::vector<std::string> corners;
    for (const Eigen::Vector2d& corner : sole.polygon)
      corners.push_back(list(Vector3d(sole.frame * Vector3d(corner.x(), corner.y(), 0))));
    soles.push_back("{\"side\":" + quoted(name_of(side)) + ",\"body\":" +
                    std::to_string(sole.body) + ",\"corners\":" + list(corners) + "}");
  }
  return list(soles);
}

std::string pushes_words(const SimulationLog& log) {
  std::vector<std::string> words;
  for (const PushRecord& push : pushes(log)) {
    const Vector3d along = push.impulse.norm() > 0 ? push.impulse : push.peak;
    words.push_back("{\"begin\":" + text::exact(push.begin) + ",\"end\":" + text::exact(push.end) +
                    ",\"from_cog\":" + list(push.from_cog) +
                    ",\"direction\":" + list(Vector3d(along.normalized())) +
                    ",\"text\":" + quoted(push_text(push)) + "}");
  }
  return list(words);
}

/// The triangles of the ground: for each corner its place and colour, in the floor's frame.
std::string scenery_bytes(const World& world) {
  const Triangles scenery = make_scenery(world, kFieldNodes);
  std::string bytes;
  const auto add = [&](float value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const std::uint32_t index : scenery.indices) {
    const RenderVertex& vertex = scenery.vertices[index];
    for (const float x : vertex.position) add(x);
    for (size_t c = 0; c < 3; ++c) add(float(vertex.color[c]) / 255);
  }
  return bytes;
}

std::string bumps_words(const RobotModel& model, const SimulationLog& log) {
  std::vector<std::string> words;
  for (const RisingBump& bump : rising_bumps(model, log)) {
    const GroundBlock& block = bump.block;
    words.push_back("{\"begin\":" + text::exact(bump.begin) +
                    ",\"end\":" + text::exact(std::min(bump.end, duration(log) + 1)) +
                    ",\"rise\":" + text::exact(kBumpRise) +
                    ",\"radius\":" + text::exact(block.radius) +
                    ",\"center\":" + list(Vector3d(block.center.x(), block.center.y(), 0)) +
                    ",\"height\":" + text::exact(block.height - log.world.height) + "}");
  }
  return list(words);
}

/// The data about the robot and the world that the script needs, as JSON without the outer braces.
std::string common_words(const RobotModel& model, double height, const SimulationLog& log,
                         double rate, double start, const std::string& label) {
  return "\"rate\":" + text::exact(rate) + ",\"height\":" + text::exact(height) +
         ",\"weight\":" + text::exact(9.80665 * model.mass()) +
         ",\"least_zmp_force\":" + text::exact(kLeastZmpForce) +
         ",\"floor\":" + pose_words(floor_at(log, 0)) +
         ",\"ground_height\":" + text::exact(log.world.height) +
         ",\"bumps\":" + bumps_words(model, log) + ",\"start\":" + text::exact(start) +
         ",\"view\":\"iso\",\"label\":" + quoted(label) + ",\"soles\":" + soles_words(model) +
         ",\"pushes\":" + pushes_words(log);
}

std::string quoted_list(const std::vector<std::string>& names) {
  std::vector<std::string> items;
  for (const std::string& name : names) items.push_back(quoted(name));
  return list(items);
}

/// The place of each body relative to its parent, in the order of the bodies' numbers.
std::string bodies_words(const RobotModel& model) {
  std::vector<std::string> words;
  for (const Body& body : model.bodies()) {
    const std::string pose = pose_words(body.placement);
    words.push_back("{\"joint\":" + std::to_string(body.dof) +
                    ",\"ratio\":" + text::exact(body.ratio) +
                    ",\"offset\":" + text::exact(body.offset) + ",\"axis\":" + list(body.axis) +
                    ",\"prismatic\":" + (body.prismatic ? "true" : "false") + "," + pose.substr(1));
  }
  return list(words);
}

bool has_command(const SimulationLog& log) {
  return log.samples.front().command_theta.size() == log.samples.front().state.theta.size();
}

}  // namespace

ReplayData make_replay(const RobotModel& model, const RobotLook& look, const ReportInput& input,
                       const ReplayPlan& plan) {
  const SimulationLog& log = *input.runs.back().log;
  ReplayData data;
  std::vector<Motion> motions = {motion_of(log, MotionSource::run, plan.rate)};
  if (has_command(log)) motions.push_back(motion_of(log, MotionSource::command, plan.rate));
  for (size_t i = 0; i + 1 < input.runs.size(); ++i) {
    motions.push_back(motion_of(*input.runs[i].log, MotionSource::run, plan.rate));
    motions.back().name = input.runs[i].name;
  }
  for (size_t i = 1; i < motions.size(); ++i) data.ghosts.push_back(motions[i].name);
  data.duration = duration(log);
  data.start = telling_instant(log);
  data.model = glb_bytes(model, motions, {.look = &look, .max_triangles = plan.triangles});
  data.series = series_bytes(log, motions.front().times);
  std::vector<std::string> columns = kColumns;
  if (floor_moves(log)) columns.insert(columns.end(), kFloorColumns.begin(), kFloorColumns.end());
  data.scenery = scenery_bytes(log.world);
  data.config = "{\"columns\":" + quoted_list(columns) + "," +
                common_words(model, robot_extent(look.surface, model, log.samples.front().state),
                             log, plan.rate, data.start,
                             "3-D replay of " + input.title +
                                 ". The space key plays, the arrow keys step, and Home and End go "
                                 "to the ends") +
                "}";
  return data;
}

std::string live_model(const RobotModel& model, const SimulationLog& log, size_t triangles) {
  const SimulationSample& first = log.samples.front();
  const Motion pose = {"pose", {0}, {first.state.base}, first.state.theta};
  return glb_bytes(model, {pose}, {.max_triangles = triangles});
}

std::string live_config(const RobotModel& model, const std::vector<BodySurface>& surface,
                        const SimulationLog& log, double rate) {
  std::vector<std::string> columns = kColumns;
  for (const char* const name : {"x", "y", "z", "qx", "qy", "qz", "qw"})
    columns.push_back(std::string("base.") + name);
  for (const char* const quantity : {"q.", "dq.", "tau."})
    for (const std::string& joint : model.dof_names()) columns.push_back(quantity + joint);
  return "{\"columns\":" + quoted_list(columns) + "," +
         common_words(model, robot_extent(surface, model, log.samples.front().state), log, rate, 0,
                      "The robot in 3-D") +
         ",\"joints\":" + quoted_list(model.dof_names()) + ",\"bodies\":" + bodies_words(model) +
         "}";
}

std::string live_series(const SimulationLog& log, double rate) {
  const double end = duration(log);
  std::vector<double> times;
  for (int k = 0; k / rate < end - 1e-9; ++k) times.push_back(k / rate);
  times.push_back(end);
  FloatRows rows;
  for (const double t : times) {
    const SimulationSample s = sample_at(log, t);
    rows.add(t, s);
    rows.add(s.state.base.position);
    rows.add(s.state.base.attitude);
    for (const Eigen::VectorXd* joints : {&s.state.theta, &s.state.dtheta, &s.torque})
      for (const double value : *joints) rows.add(value);
  }
  return std::move(rows.bytes);
}

std::string live_scenery(const World& world) { return scenery_bytes(world); }

}  // namespace ayumi
