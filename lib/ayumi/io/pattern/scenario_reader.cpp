// Reads the world and the disturbances of a pattern file.

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_scope.hpp"

namespace ayumi {

using Eigen::Vector2d;

namespace {

// Largest height of the ground over its origin, and largest shift of the floor [m]. Chosen: a
// larger one is a mistake.
constexpr double kHighest = 10;
// Largest number of nodes along a side of a height field. Source: docs/formats.md.
constexpr size_t kLargestField = 512;

Vector2d read_vector2(const JsonNode& node, PatternScope& scope) {
  const std::vector<double> values = read_numbers(node, scope, 2, 2, "[x, y]");
  return {values[0], values[1]};
}

void read_range(const JsonNode& node, PatternScope& scope, double& low, double& high) {
  const std::vector<double> ends = read_numbers(node, scope, 2, 2, "[from, to]");
  if (!(ends[1] > ends[0]))
    node.complain("the range is empty: [from, to] needs from < to, but " + text::exact(ends[0]) +
                  " is not below " + text::exact(ends[1]));
  low = ends[0];
  high = ends[1];
}

void read_rectangle(const JsonNode& node, PatternScope& scope, Vector2d& low, Vector2d& high) {
  read_range(node.at("x"), scope, low.x(), high.x());
  read_range(node.at("y"), scope, low.y(), high.y());
}

double read_positive(const JsonNode& node, PatternScope& scope, double upper) {
  const double value = read_number(node, scope, 0, upper);
  if (!(value > 0)) node.complain("this value must be above 0, but it is " + text::exact(value));
  return value;
}

double read_tilt(const JsonNode& node, PatternScope& scope) {
  const double angle = read_angle(node, scope);
  if (std::abs(angle) > 1)
    node.complain("a slope must be at most 1 rad (57 deg), but it is " +
                  text::brief(std::abs(angle)) + " rad (" +
                  text::brief(std::abs(angle) * 180 / M_PI, 3) + " deg)");
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
        node.at(key).complain(
            "the block has keys of a rectangle (x, y) and also keys of a disc (position, radius); "
            "keep the keys of one of these shapes");
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
      rows[i].complain("this row has " + std::to_string(row.size()) +
                       " heights, but the first row has " + std::to_string(field.heights.cols()));
    for (size_t j = 0; j < row.size(); ++j) {
      if (std::abs(row[j]) > kHighest)
        rows[i].complain("a height must be at most 10 m, but it is " + text::exact(row[j]) + " m");
      field.heights(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = row[j];
    }
  }
  return field;
}

FloorMotion read_motion(const JsonNode& node, PatternScope& scope) {
  FloorMotion motion;
  FloorPath& path = motion.path;
  const std::string shape =
      node.has("shape") ? node.at("shape").one_of({"ramp", "half_sine", "sine"}) : "ramp";
  path.shape = shape == "ramp"   ? MotionShape::ramp
               : shape == "sine" ? MotionShape::sine
                                 : MotionShape::half_sine;
  motion.at = read_time(node.at("at"), scope);
  motion.duration = read_time(node.at("duration"), scope);
  if (!(motion.duration > 0))
    node.at("duration").complain("a motion of the floor needs a duration above 0 s");
  if (path.shape == MotionShape::sine)
    path.frequency = read_positive(node.at("frequency"), scope, 100);
  else if (const auto frequency = node.find("frequency"))
    frequency->complain("only a sine has a frequency; remove this key");
  read_tilts(node, scope, path.tilt);
  if (const auto shift = node.find("shift")) path.shift = read_vector3(*shift, scope);
  if (path.shift.norm() > kHighest)
    node.at("shift").complain("the shift must be at most 10 m, but it is " +
                              text::brief(path.shift.norm()) + " m");
  if (path.tilt.isZero(0) && path.shift.isZero(0))
    node.complain("the floor does not move: give roll, pitch or shift");
  return motion;
}

using What = decltype(Disturbance::what);

template <PushKind kind>
What read_push(const JsonNode& node, PatternScope& scope) {
  Push push{.kind = kind};
  push.magnitude = read_number(node.at(name_of(kind)), scope, 0, kLargestNumber);
  if (const auto on = node.find("on")) push.on = on->string();
  if (const auto point = node.find("point")) {
    if (push.on == "cog")
      point->complain("a push at a point needs a link: set \"on\" to a link name");
    push.point = read_vector3(*point, scope);
  }
  if (const auto frame = node.find("frame"))
    push.frame = frame->one_of({"world", "link"}) == "world" ? PushFrame::world : PushFrame::link;
  if (push.frame == PushFrame::link && push.on == "cog")
    node.at("frame").complain("the frame \"link\" needs a link: set \"on\" to a link name");
  push.direction = read_vector3(node.at("direction"), scope);
  const double length = push.direction.norm();
  if (!(length > 1e-9))
    node.at("direction")
        .complain("the vector has no direction; give a vector whose length is above 0");
  // A unit vector is not normalized again, so that a scenario is the same after writing and
  // reading.
  if (std::abs(length - 1) > 1e-15) push.direction /= length;
  if (const auto shape = node.find("shape"))
    push.shape = shape->one_of({"rectangle", "half_sine"}) == "rectangle" ? PushShape::rectangle
                                                                          : PushShape::half_sine;
  return push;
}

What read_payload(const JsonNode& node, PatternScope& scope) {
  Payload payload{.on = node.at("on").string()};
  if (payload.on == "cog")
    node.at("on").complain("a payload needs a link: set \"on\" to a link name");
  if (const auto point = node.find("point")) payload.point = read_vector3(*point, scope);
  payload.mass = read_number(node.at("mass"), scope, 0, 1000);
  return payload;
}

What read_floor(const JsonNode& node, PatternScope& scope) {
  return read_motion(node, scope).path;  // its times are those of its disturbance
}

What read_friction(const JsonNode& node, PatternScope& scope) {
  return FrictionChange{read_number(node.at("friction"), scope, 0, 100)};
}

What read_bump(const JsonNode& node, PatternScope& scope) {
  Bump bump;
  if (const auto foot = node.find("foot"))
    bump.foot = foot->one_of({"left", "right"}) == "left" ? Side::left : Side::right;
  if (const auto place = node.find("position"))
    bump.place = read_vector2(*place, scope);
  else if (!bump.foot)
    node.complain("a bump needs a foot, or a position on the ground");
  if (const auto radius = node.find("radius")) bump.radius = read_positive(*radius, scope, 100);
  bump.height = read_number(node.at("height"), scope, 0, 1);
  return bump;
}

What read_latency(const JsonNode& node, PatternScope& scope) {
  return Latency{read_number(node.at("latency"), scope, 0, 1)};
}

What read_bias(const JsonNode& node, PatternScope& scope) {
  SensorBias bias;
  read_tilts(node, scope, bias.tilt);
  if (const auto gyro = node.find("gyro")) {
    read_numbers(*gyro, scope, 3, 3, "[x, y, z]");
    for (int i = 0; i < 3; ++i)
      bias.gyro[i] = read_angle(gyro->items()[static_cast<size_t>(i)], scope);
  }
  if (const auto load = node.find("load")) bias.load = read_number(*load, scope);
  return bias;
}

/// An empty name means all joints.
std::string read_joint(const JsonNode& node) {
  const auto joint = node.find("joint");
  return joint ? joint->string() : "";
}

What read_encoder(const JsonNode& node, PatternScope& scope) {
  return EncoderOffset{.joint = read_joint(node), .offset = read_angle(node.at("offset"), scope)};
}

What read_joint_friction(const JsonNode& node, PatternScope& scope) {
  JointFriction friction{.joint = read_joint(node)};
  if (!node.has("coulomb") && !node.has("viscous"))
    node.complain("joint friction needs \"coulomb\" or \"viscous\"");
  if (const auto coulomb = node.find("coulomb"))
    friction.coulomb = read_number(*coulomb, scope, 0, kLargestNumber);
  if (const auto viscous = node.find("viscous"))
    friction.viscous = read_number(*viscous, scope, 0, kLargestNumber);
  return friction;
}

What read_gain_loss(const JsonNode& node, PatternScope& scope) {
  return GainLoss{.joint = read_joint(node), .share = read_number(node.at("share"), scope, 0, 1)};
}

/// How the disturbances of one type are read.
struct DisturbanceFormat {
  std::string type;
  bool ends;                      ///< whether it needs a duration; other types may omit it
  std::vector<std::string> keys;  ///< keys in addition to type, at and duration
  What (*read)(const JsonNode&, PatternScope&);
};

const std::vector<DisturbanceFormat>& disturbance_formats() {
  static const std::vector<DisturbanceFormat> formats = {
      {"impulse",
       true,
       {"on", "point", "frame", "direction", "shape", "impulse"},
       read_push<PushKind::impulse>},
      {"force",
       true,
       {"on", "point", "frame", "direction", "shape", "force"},
       read_push<PushKind::force>},
      {"torque",
       true,
       {"on", "point", "frame", "direction", "shape", "torque"},
       read_push<PushKind::torque>},
      {"payload", false, {"on", "point", "mass"}, read_payload},
      {"floor", true, {"shape", "frequency", "roll", "pitch", "shift"}, read_floor},
      {"friction", false, {"friction"}, read_friction},
      {"bump", false, {"foot", "position", "radius", "height"}, read_bump},
      {"latency", false, {"latency"}, read_latency},
      {"sensor_bias", false, {"roll", "pitch", "gyro", "load"}, read_bias},
      {"encoder_offset", false, {"joint", "offset"}, read_encoder},
      {"joint_friction", false, {"joint", "coulomb", "viscous"}, read_joint_friction},
      {"gain_loss", false, {"joint", "share"}, read_gain_loss}};
  return formats;
}

const DisturbanceFormat& read_format(const JsonNode& node) {
  const std::vector<DisturbanceFormat>& formats = disturbance_formats();
  std::vector<std::string> types;
  for (const DisturbanceFormat& format : formats) types.push_back(format.type);
  const std::string type = node.at("type").one_of(types);
  const DisturbanceFormat& format =
      formats[static_cast<size_t>(std::find(types.begin(), types.end(), type) - types.begin())];
  for (const auto& [key, value] : node.members())
    if (key != "type" && key != "at" && key != "duration" &&
        std::find(format.keys.begin(), format.keys.end(), key) == format.keys.end())
      value.complain("a disturbance of type \"" + type +
                     "\" does not have this key; its keys are \"at\", \"duration\", " +
                     text::join(format.keys, ", "));
  return format;
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
  const DisturbanceFormat& format = read_format(node);
  Disturbance d;
  d.at = read_time(node.at("at"), scope);
  d.duration =
      format.ends || node.has("duration") ? read_time(node.at("duration"), scope) : kLongestPattern;
  d.what = format.read(node, scope);
  return d;
}

}  // namespace ayumi
