// World and disturbances of a pattern file.

#include <cmath>
#include <map>

#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_scope.hpp"

namespace ayumi {

using Eigen::Vector2d;

namespace {

// Ground over its origin, and shift of the floor [m]. Chosen: more is a mistake.
constexpr double kHighest = 10;
// Nodes along a side of a field of heights. Source: docs/formats.md.
constexpr size_t kLargestField = 512;

Vector2d read_vector2(const JsonNode& node, PatternScope& scope) {
  const std::vector<double> values = read_numbers(node, scope, 2, 2, "[x, y]");
  return {values[0], values[1]};
}

void read_range(const JsonNode& node, PatternScope& scope, double& low, double& high) {
  const std::vector<double> ends = read_numbers(node, scope, 2, 2, "[from, to]");
  if (!(ends[1] > ends[0])) node.complain("the range is empty: [from, to] needs from < to");
  low = ends[0];
  high = ends[1];
}

void read_rectangle(const JsonNode& node, PatternScope& scope, Vector2d& low, Vector2d& high) {
  read_range(node.at("x"), scope, low.x(), high.x());
  read_range(node.at("y"), scope, low.y(), high.y());
}

double read_positive(const JsonNode& node, PatternScope& scope, double upper) {
  const double value = read_number(node, scope, 0, upper);
  if (!(value > 0)) node.complain("must be above 0");
  return value;
}

double read_tilt(const JsonNode& node, PatternScope& scope) {
  const double angle = read_angle(node, scope);
  if (std::abs(angle) > 1) node.complain("a slope above 1 rad is not a ground");
  return angle;
}

void read_tilts(const JsonNode& node, PatternScope& scope, Vector2d& tilt) {
  const char* const names[] = {"roll", "pitch"};
  for (int i = 0; i < 2; ++i)
    if (const auto angle = node.find(names[i])) tilt[i] = read_tilt(*angle, scope);
}

GroundBlock read_block(const JsonNode& node, PatternScope& scope) {
  only_pattern_keys(node, "block");
  GroundBlock block;
  block.height = read_number(node.at("height"), scope, -kHighest, kHighest);
  if (node.has("radius") || node.has("position")) {
    for (const char* const key : {"x", "y"})
      if (node.has(key))
        node.at(key).complain("a block is a rectangle (x, y) or a disc (position, radius)");
    block.kind = GroundBlock::Kind::disc;
    block.center = read_vector2(node.at("position"), scope);
    block.radius = read_positive(node.at("radius"), scope, 100);
    return block;
  }
  read_rectangle(node, scope, block.low, block.high);
  return block;
}

HeightField read_field(const JsonNode& node, PatternScope& scope) {
  only_pattern_keys(node, "field");
  HeightField field;
  field.origin = read_vector2(node.at("origin"), scope);
  field.spacing = read_positive(node.at("spacing"), scope, 100);
  const std::vector<JsonNode> rows = node.at("heights").items();
  if (rows.size() < 2 || rows.size() > kLargestField)
    node.at("heights").complain("a field has 2 to 512 rows, found " + std::to_string(rows.size()));
  for (size_t i = 0; i < rows.size(); ++i) {
    const std::vector<double> row =
        read_numbers(rows[i], scope, 2, kLargestField, "2 to 512 heights");
    if (i == 0)
      field.heights.resize(static_cast<Eigen::Index>(rows.size()),
                           static_cast<Eigen::Index>(row.size()));
    if (static_cast<Eigen::Index>(row.size()) != field.heights.cols())
      rows[i].complain(std::to_string(row.size()) + " heights, the first row has " +
                       std::to_string(field.heights.cols()));
    for (size_t j = 0; j < row.size(); ++j) {
      if (std::abs(row[j]) > kHighest) rows[i].complain("a height is beyond 10 m");
      field.heights(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = row[j];
    }
  }
  return field;
}

FloorMotion read_motion(const JsonNode& node, PatternScope& scope) {
  FloorMotion motion;
  const std::string shape =
      node.has("shape") ? node.at("shape").one_of({"ramp", "half_sine", "sine"}) : "ramp";
  motion.shape = shape == "ramp"   ? MotionShape::ramp
                 : shape == "sine" ? MotionShape::sine
                                   : MotionShape::half_sine;
  motion.at = read_time(node.at("at"), scope);
  motion.duration = read_time(node.at("duration"), scope);
  if (!(motion.duration > 0)) node.at("duration").complain("a motion of the floor takes time");
  if (motion.shape == MotionShape::sine)
    motion.frequency = read_positive(node.at("frequency"), scope, 100);
  else if (const auto frequency = node.find("frequency"))
    frequency->complain("only a sine has a frequency");
  read_tilts(node, scope, motion.tilt);
  if (const auto shift = node.find("shift")) motion.shift = read_vector3(*shift, scope);
  if (motion.shift.norm() > kHighest) node.at("shift").complain("a shift beyond 10 m");
  if (motion.tilt.isZero(0) && motion.shift.isZero(0))
    node.complain("the floor does not move: give roll, pitch or shift");
  return motion;
}

/// Keys of each type besides type, at, duration; the first ones are required up to the "|".
const std::map<std::string, std::vector<std::string>>& keys_of_types() {
  static const std::map<std::string, std::vector<std::string>> keys = {
      {"impulse", {"on", "point", "frame", "direction", "shape", "impulse"}},
      {"force", {"on", "point", "frame", "direction", "shape", "force"}},
      {"torque", {"on", "point", "frame", "direction", "shape", "torque"}},
      {"payload", {"on", "point", "mass"}},
      {"floor", {"shape", "frequency", "roll", "pitch", "shift"}},
      {"friction", {"friction"}},
      {"bump", {"foot", "position", "radius", "height"}},
      {"latency", {"latency"}},
      {"sensor_bias", {"roll", "pitch", "gyro", "load"}},
      {"encoder_offset", {"joint", "offset"}},
      {"joint_friction", {"joint", "coulomb", "viscous"}},
      {"gain_loss", {"joint", "share"}}};
  return keys;
}

DisturbanceType read_type(const JsonNode& node) {
  std::vector<std::string> names;
  for (int i = 0; i <= static_cast<int>(DisturbanceType::gain_loss); ++i)
    names.emplace_back(name_of(static_cast<DisturbanceType>(i)));
  const std::string type = node.at("type").one_of(names);
  const std::vector<std::string>& keys = keys_of_types().at(type);
  for (const auto& [key, value] : node.members())
    if (key != "type" && key != "at" && key != "duration" &&
        std::find(keys.begin(), keys.end(), key) == keys.end())
      value.complain("the type is \"" + type + "\", which takes " + text::join(keys, ", ") +
                     " only");
  return static_cast<DisturbanceType>(std::find(names.begin(), names.end(), type) - names.begin());
}

void read_push(const JsonNode& node, PatternScope& scope, Disturbance& push) {
  push.magnitude = read_number(node.at(name_of(push.type)), scope, 0, kLargestNumber);
  if (const auto on = node.find("on")) push.on = on->string();
  if (const auto point = node.find("point")) {
    if (push.on == "cog")
      point->complain("a point needs a link to be on: set \"on\" to a link name");
    push.point = read_vector3(*point, scope);
  }
  if (const auto frame = node.find("frame"))
    push.frame = frame->one_of({"world", "link"}) == "world" ? DisturbanceFrame::world
                                                             : DisturbanceFrame::link;
  if (push.frame == DisturbanceFrame::link && push.on == "cog")
    node.at("frame").complain("\"link\" needs a link: set \"on\" to a link name");
  push.direction = read_vector3(node.at("direction"), scope);
  const double length = push.direction.norm();
  if (!(length > 1e-9)) node.at("direction").complain("the direction is zero");
  // A unit vector stays as it is, so that writing and reading is the identity.
  if (std::abs(length - 1) > 1e-15) push.direction /= length;
  if (const auto shape = node.find("shape"))
    push.shape = shape->one_of({"rectangle", "half_sine"}) == "rectangle"
                     ? DisturbanceShape::rectangle
                     : DisturbanceShape::half_sine;
}

void read_payload(const JsonNode& node, PatternScope& scope, Disturbance& d) {
  d.on = node.at("on").string();
  if (d.on == "cog") node.at("on").complain("a payload needs a link: set \"on\" to a link name");
  if (const auto point = node.find("point")) d.point = read_vector3(*point, scope);
  d.magnitude = read_number(node.at("mass"), scope, 0, 1000);
}

void read_bump(const JsonNode& node, PatternScope& scope, Disturbance& d) {
  if (const auto foot = node.find("foot"))
    d.foot = foot->one_of({"left", "right"}) == "left" ? Side::left : Side::right;
  if (const auto place = node.find("position"))
    d.place = read_vector2(*place, scope);
  else if (!d.foot)
    node.complain("a bump needs a foot, or a position on the ground");
  if (const auto radius = node.find("radius")) d.radius = read_positive(*radius, scope, 100);
  d.magnitude = read_number(node.at("height"), scope, 0, 1);
}

void read_bias(const JsonNode& node, PatternScope& scope, Disturbance& d) {
  read_tilts(node, scope, d.tilt_bias);
  if (const auto gyro = node.find("gyro")) {
    read_numbers(*gyro, scope, 3, 3, "[x, y, z]");
    for (int i = 0; i < 3; ++i)
      d.gyro_bias[i] = read_angle(gyro->items()[static_cast<size_t>(i)], scope);
  }
  if (const auto load = node.find("load")) d.force_bias = read_number(*load, scope);
}

void read_joint_fault(const JsonNode& node, PatternScope& scope, Disturbance& d) {
  if (const auto joint = node.find("joint")) d.joint = joint->string();
  if (d.type == DisturbanceType::gain_loss)
    d.magnitude = read_number(node.at("share"), scope, 0, 1);
  else if (d.type == DisturbanceType::encoder_offset)
    d.magnitude = read_angle(node.at("offset"), scope);
  else if (!node.has("coulomb") && !node.has("viscous"))
    node.complain("joint friction needs coulomb or viscous");
  if (const auto coulomb = node.find("coulomb"))
    d.magnitude = read_number(*coulomb, scope, 0, kLargestNumber);
  if (const auto viscous = node.find("viscous"))
    d.viscous = read_number(*viscous, scope, 0, kLargestNumber);
}

}  // namespace

World read_world(const JsonNode& node, PatternScope& scope) {
  only_pattern_keys(node, "world");
  World world;
  if (const auto friction = node.find("friction"))
    world.friction = read_number(*friction, scope, 0, 100);
  const auto ground = node.find("ground");
  if (ground && ground->value().is_string()) {
    ground->one_of({"flat"});
  } else if (ground) {
    only_pattern_keys(*ground, "ground");
    read_tilts(*ground, scope, world.slope);
    if (const auto height = ground->find("height"))
      world.height = read_number(*height, scope, -kHighest, kHighest);
  }
  if (const auto blocks = node.find("blocks"))
    for (const JsonNode& block : blocks->items()) world.blocks.push_back(read_block(block, scope));
  if (const auto field = node.find("field")) world.fields.push_back(read_field(*field, scope));
  if (const auto patches = node.find("patches"))
    for (const JsonNode& item : patches->items()) {
      only_pattern_keys(item, "patch");
      FrictionPatch patch;
      read_rectangle(item, scope, patch.low, patch.high);
      patch.friction = read_number(item.at("friction"), scope, 0, 100);
      world.patches.push_back(patch);
    }
  if (const auto motions = node.find("motion"))
    for (const JsonNode& item : motions->items()) {
      only_pattern_keys(item, "motion");
      world.motions.push_back(read_motion(item, scope));
    }
  return world;
}

Disturbance read_disturbance(const JsonNode& node, PatternScope& scope) {
  only_pattern_keys(node, "disturbance");
  Disturbance d;
  d.type = read_type(node);
  const bool push = d.type <= DisturbanceType::torque;
  d.at = read_time(node.at("at"), scope);
  d.duration = push || d.type == DisturbanceType::floor || node.has("duration")
                   ? read_time(node.at("duration"), scope)
                   : kLongestPattern;
  switch (d.type) {
    case DisturbanceType::impulse:
    case DisturbanceType::force:
    case DisturbanceType::torque:
      read_push(node, scope, d);
      break;
    case DisturbanceType::payload:
      read_payload(node, scope, d);
      break;
    case DisturbanceType::floor:
      d.floor = read_motion(node, scope);
      d.floor.at = d.floor.duration = 0;  // they are the disturbance's own
      break;
    case DisturbanceType::friction:
      d.magnitude = read_number(node.at("friction"), scope, 0, 100);
      break;
    case DisturbanceType::bump:
      read_bump(node, scope, d);
      break;
    case DisturbanceType::latency:
      d.magnitude = read_number(node.at("latency"), scope, 0, 1);
      break;
    case DisturbanceType::sensor_bias:
      read_bias(node, scope, d);
      break;
    case DisturbanceType::encoder_offset:
    case DisturbanceType::joint_friction:
    case DisturbanceType::gain_loss:
      read_joint_fault(node, scope, d);
      break;
  }
  return d;
}

}  // namespace ayumi
