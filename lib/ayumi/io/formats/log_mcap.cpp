#include "ayumi/io/formats/log_mcap.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/formats/mcap_writer.hpp"
#include "ayumi/io/run/log_about.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using OrderedJson = nlohmann::ordered_json;

constexpr const char* kWorld = "world";
// Rate of the messages that are drawn [Hz]. Chosen: fewer rows per second than the numbers have,
// and about as many as a screen shows. With half of it, a file of the bundled walk is 1.4 %
// smaller; with twice, 2.7 % larger.
constexpr double kDrawRate = 50;

std::uint64_t nanoseconds(double t) { return static_cast<std::uint64_t>(std::llround(1e9 * t)); }

// ---- JSON schemas, with only the fields that are written ----

OrderedJson object(const OrderedJson& properties) {
  return {{"type", "object"}, {"properties", properties}};
}
OrderedJson list_of(const OrderedJson& items) { return {{"type", "array"}, {"items", items}}; }
OrderedJson number() { return {{"type", "number"}}; }
OrderedJson whole() { return {{"type", "integer"}}; }
OrderedJson word() { return {{"type", "string"}}; }
OrderedJson seconds_schema() { return object({{"sec", whole()}, {"nsec", whole()}}); }
OrderedJson vector_schema() { return object({{"x", number()}, {"y", number()}, {"z", number()}}); }
OrderedJson quaternion_schema() {
  return object({{"x", number()}, {"y", number()}, {"z", number()}, {"w", number()}});
}
OrderedJson pose_schema() {
  return object({{"position", vector_schema()}, {"orientation", quaternion_schema()}});
}
OrderedJson color_schema() {
  return object({{"r", number()}, {"g", number()}, {"b", number()}, {"a", number()}});
}

OrderedJson joint_states_schema() {
  return object({{"timestamp", seconds_schema()},
                 {"joints", list_of(object({{"name", word()},
                                            {"position", number()},
                                            {"velocity", number()},
                                            {"effort", number()}}))}});
}

OrderedJson transforms_schema() {
  return object({{"transforms", list_of(object({{"timestamp", seconds_schema()},
                                                {"parent_frame_id", word()},
                                                {"child_frame_id", word()},
                                                {"translation", vector_schema()},
                                                {"rotation", quaternion_schema()}}))}});
}

OrderedJson scene_schema() {
  const OrderedJson deletion =
      object({{"timestamp", seconds_schema()}, {"type", whole()}, {"id", word()}});
  const OrderedJson arrow = object({{"pose", pose_schema()},
                                    {"shaft_length", number()},
                                    {"shaft_diameter", number()},
                                    {"head_length", number()},
                                    {"head_diameter", number()},
                                    {"color", color_schema()}});
  const OrderedJson sphere =
      object({{"pose", pose_schema()}, {"size", vector_schema()}, {"color", color_schema()}});
  const OrderedJson triangles = object({{"pose", pose_schema()},
                                        {"points", list_of(vector_schema())},
                                        {"color", color_schema()},
                                        {"colors", list_of(color_schema())},
                                        {"indices", list_of(whole())}});
  const OrderedJson nothing = list_of(object(OrderedJson::object()));
  const OrderedJson entity =
      object({{"timestamp", seconds_schema()},
              {"frame_id", word()},
              {"id", word()},
              {"lifetime", seconds_schema()},
              {"frame_locked", {{"type", "boolean"}}},
              {"metadata", list_of(object({{"key", word()}, {"value", word()}}))},
              {"arrows", list_of(arrow)},
              {"cubes", nothing},
              {"spheres", list_of(sphere)},
              {"cylinders", nothing},
              {"lines", nothing},
              {"triangles", list_of(triangles)},
              {"texts", nothing},
              {"models", nothing}});
  return object({{"deletions", list_of(deletion)}, {"entities", list_of(entity)}});
}

OrderedJson event_schema() {
  return object({{"timestamp", seconds_schema()},
                 {"level", whole()},
                 {"message", word()},
                 {"name", word()},
                 {"file", word()},
                 {"line", whole()}});
}

// ---- messages ----

OrderedJson json_time(std::uint64_t time) {
  return {{"sec", time / 1'000'000'000}, {"nsec", time % 1'000'000'000}};
}
OrderedJson json_of(const Vector3d& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }
OrderedJson json_of(const Eigen::Quaterniond& q) {
  return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}};
}
OrderedJson json_pose(const Vector3d& position, const Eigen::Quaterniond& q) {
  return {{"position", json_of(position)}, {"orientation", json_of(q)}};
}
OrderedJson json_color(double r, double g, double b, double a) {
  return {{"r", r}, {"g", g}, {"b", b}, {"a", a}};
}

OrderedJson entity(const std::string& id, const std::string& frame, std::uint64_t time) {
  OrderedJson made = {{"timestamp", json_time(time)},
                      {"frame_id", frame},
                      {"id", id},
                      {"lifetime", json_time(0)},
                      {"frame_locked", true}};
  for (const char* list : {"metadata", "arrows", "cubes", "spheres", "cylinders", "lines",
                           "triangles", "texts", "models"})
    made[list] = OrderedJson::array();
  return made;
}

bool finite(const Vector3d& v) { return v.allFinite(); }

OrderedJson ball(const std::string& id, const Vector3d& at, double size, const OrderedJson& color,
                 std::uint64_t time) {
  OrderedJson made = entity(id, kWorld, time);
  if (finite(at))
    made["spheres"].push_back({{"pose", json_pose(at, Eigen::Quaterniond::Identity())},
                               {"size", json_of(Vector3d(size, size, size))},
                               {"color", color}});
  return made;
}

OrderedJson arrow(const std::string& id, const Vector3d& at, const Vector3d& vector,
                  double thickness, const OrderedJson& color, std::uint64_t time) {
  OrderedJson made = entity(id, kWorld, time);
  const double length = vector.norm();
  if (finite(at) && std::isfinite(length) && length > thickness)
    made["arrows"].push_back(
        {{"pose", json_pose(at, rotation_between(Vector3d::UnitX(), vector))},
         {"shaft_length", length - 2 * thickness > 0 ? length - 2 * thickness : 0},
         {"shaft_diameter", thickness},
         {"head_length", 2 * thickness},
         {"head_diameter", 2 * thickness},
         {"color", color}});
  return made;
}

// The marks of the scene. Their sizes follow from the height of the COG, and those of forces from
// the weight.
class Marks {
 public:
  Marks(const RobotModel& model, const SimulationLog& log)
      : size_(std::max(0.01, 0.1 * std::abs(log.samples.front().cog.z()))),
        per_newton_(5 * size_ / (model.mass() * kGravity)) {}

  std::string scene(const SimulationSample& s, const Vector3d& dcm, std::uint64_t time) const {
    OrderedJson all = OrderedJson::array();
    all.push_back(ball("cog", s.cog, size_, json_color(1, 0.6, 0, 1), time));
    all.push_back(ball("zmp", s.zmp, size_ / 2, json_color(1, 0, 0, 1), time));
    all.push_back(ball("ref.zmp", s.reference_zmp, size_ / 2, json_color(0, 0.4, 1, 1), time));
    all.push_back(ball("dcm", dcm, size_ / 2, json_color(0, 0.7, 0.2, 1), time));
    for (size_t side = 0; side < 2; ++side)
      all.push_back(arrow(std::string(name_of(static_cast<Side>(side))) + ".force",
                          s.foot_cop[side], per_newton_ * s.foot_force[side], size_ / 5,
                          json_color(0.2, 0.8, 0.2, 0.8), time));
    all.push_back(arrow("push", s.push_point, per_newton_ * s.push_force, size_ / 4,
                        json_color(1, 0, 1, 1), time));
    return OrderedJson({{"deletions", OrderedJson::array()}, {"entities", all}}).dump();
  }

 private:
  double size_, per_newton_;
};

std::string robot_scene(const RobotModel& model, const std::vector<ColoredMesh>& surface) {
  OrderedJson all = OrderedJson::array();
  for (size_t body = 0; body < surface.size(); ++body) {
    const ColoredMesh& mesh = surface[body];
    OrderedJson made = entity(model.bodies()[body].name, model.bodies()[body].name, 0);
    if (!mesh.indices.empty()) {
      OrderedJson points = OrderedJson::array(), colors = OrderedJson::array();
      for (const Eigen::Vector3f& p : mesh.points) {
        OrderedJson point;
        for (const auto& [axis, value] : {std::pair{"x", p.x()}, {"y", p.y()}, {"z", p.z()}})
          point[axis] = std::round(1e5 * static_cast<double>(value)) / 1e5;
        points.push_back(std::move(point));
      }
      const auto color = [](const Eigen::Vector4f& c) {
        const auto rounded = [](float share) { return std::round(255.0 * share) / 255.0; };
        return json_color(rounded(c[0]), rounded(c[1]), rounded(c[2]), rounded(c[3]));
      };
      const bool one = std::all_of(mesh.colors.begin(), mesh.colors.end(),
                                   [&](const auto& c) { return c == mesh.colors.front(); });
      if (!one)
        for (const Eigen::Vector4f& c : mesh.colors) colors.push_back(color(c));
      made["triangles"].push_back(
          {{"pose", json_pose(Vector3d::Zero(), Eigen::Quaterniond::Identity())},
           {"points", points},
           {"color", color(mesh.colors.front())},
           {"colors", colors},
           {"indices", mesh.indices}});
    }
    all.push_back(std::move(made));
  }
  return OrderedJson({{"deletions", OrderedJson::array()}, {"entities", all}}).dump();
}

class Transforms {
 public:
  explicit Transforms(const RobotModel& model) : model_(model), data_(model) {}

  std::string message(const RobotState& state, std::uint64_t time) {
    update_positions(model_, state, data_);
    OrderedJson all = OrderedJson::array();
    const auto add = [&](const std::string& parent, const std::string& child,
                         const Isometry3d& pose) {
      all.push_back({{"timestamp", json_time(time)},
                     {"parent_frame_id", parent},
                     {"child_frame_id", child},
                     {"translation", json_of(Vector3d(pose.translation()))},
                     {"rotation", json_of(Eigen::Quaterniond(pose.linear()).normalized())}});
    };
    const std::vector<Body>& bodies = model_.bodies();
    for (size_t i = 0; i < bodies.size(); ++i) {
      const Isometry3d pose = data_.pose(static_cast<int>(i));
      const int parent = bodies[i].parent;
      if (parent < 0)
        add(kWorld, bodies[i].name, pose);
      else
        add(bodies[static_cast<size_t>(parent)].name, bodies[i].name,
            data_.pose(parent).inverse() * pose);
    }
    for (const Link& link : model_.links()) {
      const std::string& body = bodies[static_cast<size_t>(link.body)].name;
      if (link.name != body) add(body, link.name, link.pose);
    }
    return OrderedJson({{"transforms", all}}).dump();
  }

 private:
  const RobotModel& model_;
  RobotData data_;
};

std::string joint_states(const SimulationLog& log, const SimulationSample& s, std::uint64_t time) {
  OrderedJson joints = OrderedJson::array();
  for (size_t j = 0; j < log.joints.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    OrderedJson joint = {{"name", log.joints[j]}};
    for (const auto& [key, value] : {std::pair{"position", s.state.theta[i]},
                                     {"velocity", s.state.dtheta[i]},
                                     {"effort", s.torque[i]}})
      if (std::isfinite(value)) joint[key] = value;
    joints.push_back(std::move(joint));
  }
  return OrderedJson({{"timestamp", json_time(time)}, {"joints", joints}}).dump();
}

// ---- the columns of the table as objects in objects ----

struct Node {
  std::string key;
  int column = -1;  ///< column of a number; -1 for an object
  std::string unit = {};
  std::vector<Node> inside = {};

  Node& at(const std::string& name) {
    const auto found = std::find_if(inside.begin(), inside.end(),
                                    [&](const Node& node) { return node.key == name; });
    if (found != inside.end()) return *found;
    inside.push_back({name});
    return inside.back();
  }
};

OrderedJson schema_of(const Node& node) {
  if (node.column >= 0) return {{"type", "number"}, {"description", "[" + node.unit + "]"}};
  OrderedJson properties = OrderedJson::object();
  for (const Node& part : node.inside) properties[part.key] = schema_of(part);
  return object(properties);
}

// A number without a value is left out.
void write(const Node& node, const LogTable& table, size_t row, std::string& text) {
  if (node.column >= 0) {
    text += text::exact(table.at(row, static_cast<size_t>(node.column)));
    return;
  }
  text += '{';
  bool first = true;
  for (const Node& part : node.inside) {
    if (part.column >= 0 && !std::isfinite(table.at(row, static_cast<size_t>(part.column))))
      continue;
    text += first ? "" : ",";
    first = false;
    text += OrderedJson(part.key).dump(-1, ' ', false, OrderedJson::error_handler_t::replace) + ":";
    write(part, table, row, text);
  }
  text += '}';
}

// The columns by topic: "measured.cog" is the field "cog" of the topic "/measured", and "cog" is a
// field of the topic "/state".
std::vector<Node> topics_of(const LogTable& table) {
  static const std::set<std::string> groups = {"measured", "cmd",     "ref",  "left",       "right",
                                               "push",     "contact", "work", "disturbance"};
  Node root;
  int column = 0;
  for (const LogQuantity& quantity : table.quantities) {
    const size_t dot = quantity.name.find('.');
    const std::string begin = quantity.name.substr(0, dot);
    std::string path = quantity.name;
    Node* node = &root.at(groups.contains(begin) ? begin : "state");
    if (groups.contains(begin)) path = dot == std::string::npos ? "" : path.substr(dot + 1);
    while (!path.empty()) {
      const size_t next = path.find('.');
      node = &node->at(path.substr(0, next));
      path = next == std::string::npos ? "" : path.substr(next + 1);
    }
    for (size_t i = 0; i < quantity.columns(); ++i, ++column) {
      Node& leaf = quantity.parts.empty() ? *node : node->at(quantity.parts[i]);
      require(leaf.column < 0 && leaf.inside.empty(), "two columns of a log have one name");
      leaf.column = column;
      leaf.unit = quantity.units[i];
    }
  }
  return root.inside;
}

std::string text_of(const OrderedJson& json) {
  return json.is_string() ? json.get<std::string>() : json.dump();
}

McapWriter::Metadata about(const SimulationLog& log) {
  McapWriter::Metadata values;
  const OrderedJson json = about_log(log);
  for (const auto& [key, value] : json.items()) {
    if (value.is_object())
      for (const auto& [inside, text] : value.items()) values[inside] = text_of(text);
    else
      values[key] = text_of(value);
  }
  return values;
}

int level_of(const SimulationEvent& event) {
  constexpr int info = 2, warning = 3, error = 4;  // Source: the schema foxglove.Log
  if (event.kind == EventKind::fell) return error;
  return event.kind == EventKind::saturation || event.kind == EventKind::contact ? warning : info;
}

}  // namespace

McapLog log_mcap(const RobotModel& model, const std::vector<ColoredMesh>& surface,
                 const SimulationLog& log, const LogTable& table) {
  McapWriter writer(std::string("ayumi ") + version());
  writer.add_metadata("ayumi", about(log));
  McapLog made;
  const auto channel = [&](const std::string& topic, const std::string& name,
                           const OrderedJson& schema) {
    made.topics.push_back({topic, name});
    return writer.add_channel(topic, name, schema.dump());
  };
  const std::vector<Node> topics = topics_of(table);
  std::vector<std::uint16_t> channels;
  for (const Node& topic : topics)
    channels.push_back(channel("/" + topic.key, "ayumi." + topic.key, schema_of(topic)));
  const auto joints = channel("/joint_states", "foxglove.JointStates", joint_states_schema());
  const auto frames = channel("/tf", "foxglove.FrameTransforms", transforms_schema());
  const auto robot = channel("/robot", "foxglove.SceneUpdate", scene_schema());
  const auto scene = channel("/scene", "foxglove.SceneUpdate", scene_schema());
  const auto events = channel("/events", "foxglove.Log", event_schema());

  const std::vector<std::string> names = table.column_names();
  const auto dcm =
      static_cast<size_t>(std::find(names.begin(), names.end(), "dcm.x[m]") - names.begin());
  Transforms transforms(model);
  const Marks marks(model, log);
  const auto drawn = static_cast<size_t>(std::max(1.0, std::round(1 / (kDrawRate * log.dt))));
  if (!surface.empty()) writer.add_message(robot, 0, robot_scene(model, surface));
  size_t event = 0;
  for (size_t k = 0; k < table.rows; ++k) {
    const SimulationSample& s = log.samples[k];
    const std::uint64_t time = nanoseconds(static_cast<double>(k) * log.dt);
    const bool last = k + 1 == table.rows;
    for (; event < log.events.size() && (nanoseconds(log.events[event].t) <= time || last);
         ++event) {
      const SimulationEvent& e = log.events[event];
      writer.add_message(events, time,
                         OrderedJson({{"timestamp", json_time(nanoseconds(std::max(0.0, e.t)))},
                                      {"level", level_of(e)},
                                      {"message", e.text},
                                      {"name", name_of(e.kind)},
                                      {"file", ""},
                                      {"line", 0}})
                             .dump(-1, ' ', false, OrderedJson::error_handler_t::replace));
    }
    for (size_t i = 0; i < topics.size(); ++i) {
      std::string text;
      write(topics[i], table, k, text);
      writer.add_message(channels[i], time, text);
    }
    writer.add_message(joints, time, joint_states(log, s, time));
    if (k % drawn != 0 && !last) continue;
    writer.add_message(frames, time, transforms.message(s.state, time));
    writer.add_message(scene, time,
                       marks.scene(s, {table.at(k, dcm), table.at(k, dcm + 1), s.zmp.z()}, time));
  }
  for (const auto& [id, count] : writer.counts()) made.topics[id - 1u].messages = count;
  made.bytes = writer.finish();
  return made;
}

}  // namespace ayumi
