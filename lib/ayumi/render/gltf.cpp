#include "ayumi/render/gltf.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/render/ghost_color.hpp"
#include "ayumi/render/glb_writer.hpp"
#include "ayumi/render/log_reading.hpp"
#include "ayumi/render/simplify.hpp"

// Node 0 is the world, whose z becomes glTF's y. Node 1 + i is body i; the root is below the world.
// Triangles of a body are grouped by colour and by whether they are seen from both sides; equal
// vertices become one. Colours are sRGB bytes in the model and linear factors in the file.

namespace ayumi {
namespace {

using namespace glb;

// ---- surfaces

/// Triangles of one colour, with each vertex only once.
struct Batch {
  std::vector<float> positions, normals, uvs;
  std::vector<std::uint32_t> indices;
  std::map<std::array<float, 8>, std::uint32_t> known;

  void add(const RenderVertex& vertex) {
    std::array<float, 8> key;
    for (size_t i = 0; i < 3; ++i) {
      key[i] = vertex.position[Eigen::Index(i)] + 0.0f;
      key[3 + i] = vertex.normal[Eigen::Index(i)] + 0.0f;
    }
    key[6] = vertex.uv.x() + 0.0f;
    key[7] = 1 - vertex.uv.y();  // v points downwards in glTF
    const auto [entry, fresh] = known.emplace(key, static_cast<std::uint32_t>(known.size()));
    indices.push_back(entry->second);
    if (!fresh) return;
    positions.insert(positions.end(), key.begin(), key.begin() + 3);
    normals.insert(normals.end(), key.begin() + 3, key.begin() + 6);
    uvs.insert(uvs.end(), key.begin() + 6, key.end());
  }
};

/// `material` gives the number of a colour.
template <typename Material>
void add_batches(Writer& writer, const Triangles& surface, bool with_uvs, const Material& material,
                 std::vector<std::string>& primitives) {
  std::map<Color, Batch> batches;
  for (const std::uint32_t index : surface.indices) {
    const RenderVertex& vertex = surface.vertices[index];
    batches[vertex.color].add(vertex);
  }
  for (const auto& [color, batch] : batches) {
    std::string words = "{\"attributes\":{\"POSITION\":" +
                        std::to_string(writer.add_floats(batch.positions, 3, true, true));
    words += ",\"NORMAL\":" + std::to_string(writer.add_floats(batch.normals, 3, true, false));
    if (with_uvs)
      words += ",\"TEXCOORD_0\":" + std::to_string(writer.add_floats(batch.uvs, 2, true, false));
    words += "},\"indices\":" + std::to_string(writer.add_indices(batch.indices));
    primitives.push_back(words + ",\"material\":" + std::to_string(material(color)) + "}");
  }
}

/// The mesh of each body; -1 if nothing of the body is visible.
std::vector<int> add_meshes(Writer& writer, const std::vector<BodySurface>& surface) {
  std::vector<int> meshes;
  for (const BodySurface& body : surface) {
    std::vector<std::string> primitives;
    for (const bool open : {false, true})
      add_batches(
          writer, open ? body.open : body.closed, false,
          [&](const Color& color) { return writer.material(color, open); }, primitives);
    for (const TexturedSurface& part : body.textured)
      add_batches(
          writer, part.triangles, true,
          [&](const Color& color) { return writer.material(color, part.texture); }, primitives);
    meshes.push_back(primitives.empty() ? -1 : static_cast<int>(writer.meshes.size()));
    if (!primitives.empty())
      writer.meshes.push_back("{\"primitives\":[" + text::join(primitives, ",") + "]}");
  }
  return meshes;
}

// ---- nodes and animations

/// The pose of a body in the frame of its parent.
Eigen::Isometry3d joint_pose(const Body& body, double theta) {
  const double q = body.ratio * theta + body.offset;
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (body.prismatic)
    motion.translation() = q * body.axis;
  else
    motion.linear() = Eigen::AngleAxisd(q, body.axis).toRotationMatrix();
  return body.placement * motion;
}

BasePose as_base(const Eigen::Isometry3d& pose) {
  return {pose.translation(), Eigen::Quaterniond(pose.linear()).normalized()};
}

/// The pose of a body in the frame of its parent; the root's pose is in the world.
BasePose node_pose(const RobotModel& model, const Motion& motion, size_t body, size_t k) {
  if (model.bodies()[body].parent < 0) return motion.base[k];
  const Body& b = model.bodies()[body];
  return as_base(joint_pose(b, motion.theta(b.dof, static_cast<Eigen::Index>(k))));
}

std::string pose_words(const BasePose& pose) {
  const Eigen::Quaternionf q = pose.attitude.cast<float>().normalized();
  return ",\"translation\":" + list(Eigen::Vector3f(pose.position.cast<float>())) +
         ",\"rotation\":" + list(q.coeffs());
}

std::string nodes_text(const RobotModel& model, const Motion* shown,
                       const std::vector<int>& meshes) {
  const double half = std::sqrt(0.5);
  std::string nodes = "[{\"name\":\"world\",\"rotation\":" +
                      list(std::array<float, 4>{float(-half), 0, 0, float(half)}) +
                      ",\"children\":[1]}";
  const RobotState rest = model.rest_state();
  for (size_t i = 0; i < model.bodies().size(); ++i) {
    const Body& body = model.bodies()[i];
    const BasePose still =
        body.parent < 0 ? rest.base : as_base(joint_pose(body, rest.theta[body.dof]));
    std::vector<std::string> children;
    for (size_t j = 0; j < model.bodies().size(); ++j)
      if (model.bodies()[j].parent == static_cast<int>(i))
        children.push_back(std::to_string(1 + j));
    nodes += ",{\"name\":" + quoted(body.name) +
             pose_words(shown ? node_pose(model, *shown, i, 0) : still);
    nodes += ",\"extras\":{\"body\":" + std::to_string(i) + "}";
    if (meshes[i] >= 0) nodes += ",\"mesh\":" + std::to_string(meshes[i]);
    if (!children.empty()) nodes += ",\"children\":[" + text::join(children, ",") + "]";
    nodes += "}";
  }
  return nodes + "]";
}

/// A track of an animation; a body that never moves gets one key.
struct Channel {
  int node;
  const char* path;
  int components;
  std::vector<float> values;
};

void add_rotation(std::vector<float>& values, Eigen::Quaternionf q) {
  // Of the two rotations, the shorter one from the previous key is taken.
  const size_t n = values.size();
  if (n >= 4 && q.x() * values[n - 4] + q.y() * values[n - 3] + q.z() * values[n - 2] +
                        q.w() * values[n - 1] <
                    0)
    q.coeffs() = -q.coeffs();
  values.insert(values.end(), {q.x(), q.y(), q.z(), q.w()});
}

std::vector<Channel> channels_of(const RobotModel& model, const Motion& motion) {
  std::vector<Channel> channels;
  for (size_t i = 0; i < model.bodies().size(); ++i) {
    Channel turn = {static_cast<int>(1 + i), "rotation", 4, {}};
    Channel shift = {static_cast<int>(1 + i), "translation", 3, {}};
    for (size_t k = 0; k < motion.times.size(); ++k) {
      const BasePose pose = node_pose(model, motion, i, k);
      add_rotation(turn.values, pose.attitude.cast<float>().normalized());
      for (const double x : pose.position) shift.values.push_back(static_cast<float>(x));
    }
    const Body& body = model.bodies()[i];
    if (body.parent < 0 || !body.prismatic) channels.push_back(std::move(turn));
    if (body.parent < 0 || body.prismatic) channels.push_back(std::move(shift));
  }
  return channels;
}

std::string animation_text(Writer& writer, const RobotModel& model, const Motion& motion) {
  const std::vector<float> times(motion.times.begin(), motion.times.end());
  const std::string input = std::to_string(writer.add_floats(times, 1, false, true));
  std::vector<std::string> samplers, channels;
  for (const Channel& channel : channels_of(model, motion)) {
    const int output = writer.add_floats(channel.values, channel.components, false, false);
    channels.push_back("{\"sampler\":" + std::to_string(samplers.size()) +
                       ",\"target\":{\"node\":" + std::to_string(channel.node) + ",\"path\":\"" +
                       channel.path + "\"}}");
    samplers.push_back("{\"input\":" + input + ",\"output\":" + std::to_string(output) + "}");
  }
  return "{\"name\":" + quoted(motion.name) + ",\"channels\":[" + text::join(channels, ",") +
         "],\"samplers\":[" + text::join(samplers, ",") + "]}";
}

void check(const RobotModel& model, const Motion& motion) {
  const auto count = static_cast<Eigen::Index>(motion.times.size());
  if (motion.times.empty() || motion.theta.cols() != count ||
      motion.base.size() != motion.times.size())
    fail(ErrorCode::usage,
         "the motion " + motion.name + " needs at least one time, and one posture for each time");
  if (motion.theta.rows() != model.dof_count())
    fail(ErrorCode::usage, "the motion " + motion.name + " has " +
                               std::to_string(motion.theta.rows()) + " joints, but the robot " +
                               model.name() + " has " + std::to_string(model.dof_count()) +
                               ": this is a motion of another robot");
}

}  // namespace

const char* name_of(MotionSource source) {
  constexpr const char* kNames[] = {"run", "command", "reference"};
  return kNames[static_cast<size_t>(source)];
}

Motion motion_of(const SimulationLog& log, MotionSource source, double rate, double begin,
                 double end) {
  const double last = end < 0 ? duration(log) : std::min(end, duration(log));
  if (!(rate > 0)) fail(ErrorCode::usage, "the rate of a motion must be above 0");
  Motion motion;
  motion.name = name_of(source);
  for (long k = 0; begin + double(k) / rate < last - 1e-9; ++k)
    motion.times.push_back(begin + double(k) / rate);
  motion.times.push_back(last);
  for (size_t k = 0; k < motion.times.size(); ++k) {
    const SimulationSample sample = sample_at(log, motion.times[k]);
    const BasePose& base = source == MotionSource::run       ? sample.state.base
                           : source == MotionSource::command ? sample.command_base
                                                             : sample.reference_base;
    const Eigen::VectorXd& theta = source == MotionSource::run       ? sample.state.theta
                                   : source == MotionSource::command ? sample.command_theta
                                                                     : sample.reference_theta;
    if (k == 0) motion.theta.resize(theta.size(), static_cast<Eigen::Index>(motion.times.size()));
    if (theta.size() == 0 && sample.state.theta.size() > 0)
      fail(ErrorCode::bad_file, std::string("the log does not hold the ") + name_of(source) +
                                    " posture; simulate again");
    motion.theta.col(static_cast<Eigen::Index>(k)) = theta;
    motion.base.push_back(base);
  }
  return motion;
}

Motion motion_of(const ReferenceTrajectory& table, double rate) {
  if (!(rate > 0)) fail(ErrorCode::usage, "the rate of a motion must be above 0");
  if (table.rows.empty()) fail(ErrorCode::usage, "the table has no rows");
  Motion motion;
  motion.name = name_of(MotionSource::reference);
  const size_t last = table.rows.size() - 1;
  std::vector<size_t> rows;
  for (size_t k = 0; rows.empty() || rows.back() < last; ++k)
    rows.push_back(
        std::min(last, std::max(rows.empty() ? 0 : rows.back() + 1,
                                static_cast<size_t>(std::llround(double(k) / (rate * table.dt))))));
  motion.theta.resize(table.rows[0].theta.size(), static_cast<Eigen::Index>(rows.size()));
  for (size_t i = 0; i < rows.size(); ++i) {
    const ReferenceRow& row = table.rows[rows[i]];
    motion.times.push_back(double(rows[i]) * table.dt);
    motion.base.push_back(row.base);
    motion.theta.col(static_cast<Eigen::Index>(i)) = row.theta;
  }
  return motion;
}

std::string glb_bytes(const RobotModel& model, const std::vector<Motion>& motions,
                      const GltfOptions& options) {
  for (const Motion& motion : motions) check(model, motion);
  Writer writer;
  std::vector<BodySurface> surface = options.look ? options.look->surface : robot_surface(model);
  const Eigen::Vector3f ghost =
      (options.look ? options.look->ghost : ghost_colors(surface)).beside_robot;
  if (options.max_triangles > 0) simplify(surface, options.max_triangles);
  const std::vector<int> meshes = add_meshes(writer, surface);
  std::vector<std::string> animations;
  for (const Motion& motion : motions) animations.push_back(animation_text(writer, model, motion));
  const std::string nodes = nodes_text(model, motions.empty() ? nullptr : &motions.front(), meshes);
  return writer.file(nodes, joined("animations", animations) + ",\"extras\":{\"ghost_color\":\"" +
                                hex_text(ghost) + "\"}");
}

}  // namespace ayumi
