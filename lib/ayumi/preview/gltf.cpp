#include "ayumi/preview/gltf.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/preview/log_reading.hpp"
#include "ayumi/preview/robot_surface.hpp"
#include "ayumi/preview/simplify.hpp"
#include "ayumi/preview/texture.hpp"

// Nodes: 0 the world, whose z becomes glTF's y; 1 + i body i, the root below the world. Triangles
// of a body are gathered by colour and by whether they are seen from both sides; equal vertices are
// one. Colours are sRGB bytes in the model and linear factors in the file.

namespace ayumi {
namespace {

using Color = std::array<std::uint8_t, 4>;
constexpr int kByte4 = 5126, kUnsigned = 5125;              // FLOAT, UNSIGNED_INT
constexpr int kVertexTarget = 34962, kIndexTarget = 34963;  // ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER

std::string number(double value) { return text::exact(value); }

template <typename Values>
std::string list(const Values& values) {
  std::string out = "[";
  for (const auto& value : values) out += (out.size() > 1 ? "," : "") + number(value);
  return out + "]";
}

std::string quoted(const std::string& text) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += {'\\', c};
    else if (byte < 0x20)
      out += std::string("\\u00") + kDigits[byte / 16] + kDigits[byte % 16];
    else
      out += c;
  }
  return out + '"';
}

double linear(std::uint8_t srgb) {
  const double c = srgb / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// Six digits are more than eight bits of colour hold.
double rounded(double value) { return std::round(1e6 * value) / 1e6; }

/// The members of the file as they grow.
class Writer {
 public:
  int add_floats(const std::vector<float>& values, int components, bool vertices, bool with_bounds);
  int add_indices(const std::vector<std::uint32_t>& values);
  int material(const Color& color, bool double_sided);
  /// With the picture of a mesh; as `material` where there is none to embed.
  int material(const Color& color, const std::string& texture);

  std::string file(const std::string& nodes, const std::string& animations) const;
  std::vector<std::string> meshes;

 private:
  std::string binary_;
  std::vector<std::string> views_, accessors_, materials_, images_, textures_;
  std::map<std::pair<Color, bool>, int> known_materials_;
  std::map<std::pair<Color, std::string>, int> known_textured_;

  int add_view(const void* data, size_t bytes, int target);
};

std::string joined(const std::string& key, const std::vector<std::string>& items) {
  return items.empty() ? "" : ",\"" + key + "\":[" + text::join(items, ",") + "]";
}

int Writer::add_view(const void* data, size_t bytes, int target) {
  std::string view = "{\"buffer\":0,\"byteOffset\":" + std::to_string(binary_.size()) +
                     ",\"byteLength\":" + std::to_string(bytes);
  if (target) view += ",\"target\":" + std::to_string(target);
  views_.push_back(view + "}");
  binary_.append(static_cast<const char*>(data), bytes);
  binary_.append((4 - bytes % 4) % 4, '\0');
  return static_cast<int>(views_.size()) - 1;
}

int Writer::add_floats(const std::vector<float>& values, int components, bool vertices,
                       bool with_bounds) {
  const int view =
      add_view(values.data(), values.size() * sizeof(float), vertices ? kVertexTarget : 0);
  constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  const auto width = static_cast<size_t>(components);
  std::string accessor = "{\"bufferView\":" + std::to_string(view) +
                         ",\"componentType\":" + std::to_string(kByte4) +
                         ",\"count\":" + std::to_string(values.size() / width) + ",\"type\":\"" +
                         kTypes[components] + "\"";
  if (with_bounds) {
    std::vector<double> low(values.begin(), values.begin() + components), high = low;
    for (size_t i = 0; i < values.size(); ++i) {
      low[i % width] = std::min(low[i % width], double(values[i]));
      high[i % width] = std::max(high[i % width], double(values[i]));
    }
    accessor += ",\"min\":" + list(low) + ",\"max\":" + list(high);
  }
  accessors_.push_back(accessor + "}");
  return static_cast<int>(accessors_.size()) - 1;
}

int Writer::add_indices(const std::vector<std::uint32_t>& values) {
  const int view = add_view(values.data(), 4 * values.size(), kIndexTarget);
  accessors_.push_back("{\"bufferView\":" + std::to_string(view) +
                       ",\"componentType\":" + std::to_string(kUnsigned) +
                       ",\"count\":" + std::to_string(values.size()) + ",\"type\":\"SCALAR\"}");
  return static_cast<int>(accessors_.size()) - 1;
}

int Writer::material(const Color& color, bool double_sided) {
  const auto [entry, fresh] =
      known_materials_.emplace(std::pair(color, double_sided), static_cast<int>(materials_.size()));
  if (!fresh) return entry->second;
  const std::array<double, 4> factor = {rounded(linear(color[0])), rounded(linear(color[1])),
                                        rounded(linear(color[2])), rounded(color[3] / 255.0)};
  std::string words = "{\"pbrMetallicRoughness\":{\"baseColorFactor\":" + list(factor) +
                      ",\"metallicFactor\":0,\"roughnessFactor\":0.7}";
  if (color[3] < 255) words += ",\"alphaMode\":\"BLEND\"";
  if (double_sided) words += ",\"doubleSided\":true";
  materials_.push_back(words + "}");
  return entry->second;
}

int Writer::material(const Color& color, const std::string& texture) {
  const auto known = known_textured_.find({color, texture});
  if (known != known_textured_.end()) return known->second;
  std::vector<std::string> notes;
  const std::string bytes = texture_bytes(texture, notes);
  const bool png = bytes.starts_with("\x89PNG");
  if (!png && !bytes.starts_with("\xff\xd8")) return material(color, true);
  const int view = add_view(bytes.data(), bytes.size(), 0);
  textures_.push_back("{\"source\":" + std::to_string(images_.size()) + "}");
  images_.push_back("{\"bufferView\":" + std::to_string(view) + ",\"mimeType\":\"image/" +
                    (png ? "png" : "jpeg") + "\"}");
  materials_.push_back("{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":" +
                       std::to_string(textures_.size() - 1) +
                       "},\"metallicFactor\":0,\"roughnessFactor\":0.7},\"doubleSided\":true}");
  return known_textured_[{color, texture}] = static_cast<int>(materials_.size()) - 1;
}

std::string Writer::file(const std::string& nodes, const std::string& animations) const {
  std::string json =
      "{\"asset\":{\"version\":\"2.0\",\"generator\":\"ayumi\"},\"scene\":0,"
      "\"scenes\":[{\"nodes\":[0]}],\"nodes\":" +
      nodes + animations + joined("meshes", meshes) + joined("materials", materials_) +
      joined("textures", textures_) + joined("images", images_) + joined("accessors", accessors_) +
      joined("bufferViews", views_);
  if (!binary_.empty())
    json += ",\"buffers\":[{\"byteLength\":" + std::to_string(binary_.size()) + "}]";
  json += "}";
  json.append((4 - json.size() % 4) % 4, ' ');
  std::string bytes;
  const auto word = [&](size_t value) {
    const auto small = static_cast<std::uint32_t>(value);
    bytes.append(reinterpret_cast<const char*>(&small), 4);
  };
  const size_t binary_chunk = binary_.empty() ? 0 : 8 + binary_.size();
  word(0x46546C67);  // "glTF"
  word(2);
  word(12 + 8 + json.size() + binary_chunk);
  word(json.size());
  word(0x4E4F534A);  // "JSON"
  bytes += json;
  if (binary_chunk == 0) return bytes;
  word(binary_.size());
  word(0x004E4942);  // "BIN"
  return bytes + binary_;
}

// ---- surfaces

/// Triangles of one colour with each vertex once.
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
    key[7] = 1 - vertex.uv.y();  // downwards in glTF
    const auto [entry, fresh] = known.emplace(key, static_cast<std::uint32_t>(known.size()));
    indices.push_back(entry->second);
    if (!fresh) return;
    positions.insert(positions.end(), key.begin(), key.begin() + 3);
    normals.insert(normals.end(), key.begin() + 3, key.begin() + 6);
    uvs.insert(uvs.end(), key.begin() + 6, key.end());
  }
};

/// `material` of a colour gives its number.
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

/// Mesh of each body; -1 where there is nothing to see.
std::vector<int> add_meshes(Writer& writer, const RobotModel& model, size_t max_triangles) {
  std::vector<BodySurface> surface = robot_surface(model);
  if (max_triangles > 0) simplify(surface, max_triangles);
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

/// Pose of a body in its parent.
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

/// Pose of a body in its parent, the root in the world.
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
  // The shorter way from the key before.
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
    fail(ErrorCode::usage, "the motion " + motion.name + " has no postures, or not one per time");
  if (motion.theta.rows() != model.dof_count())
    fail(ErrorCode::usage, "the motion " + motion.name + " has " +
                               std::to_string(motion.theta.rows()) + " joints, the robot " +
                               model.name() + " has " + std::to_string(model.dof_count()) +
                               ": they do not belong together");
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

std::string glb_bytes(const RobotModel& model, const std::vector<Motion>& motions,
                      const GltfOptions& options) {
  for (const Motion& motion : motions) check(model, motion);
  Writer writer;
  const std::vector<int> meshes = add_meshes(writer, model, options.max_triangles);
  std::vector<std::string> animations;
  for (const Motion& motion : motions) animations.push_back(animation_text(writer, model, motion));
  const std::string nodes = nodes_text(model, motions.empty() ? nullptr : &motions.front(), meshes);
  return writer.file(nodes, joined("animations", animations));
}

}  // namespace ayumi
