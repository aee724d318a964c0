#include "ayumi/io/pattern/scenario_text.hpp"

namespace ayumi {

using Eigen::Vector2d;

namespace {

void add_rectangle(Members& members, const Vector2d& low, const Vector2d& high) {
  members.add("x", vector_text(Vector2d(low.x(), high.x())));
  members.add("y", vector_text(Vector2d(low.y(), high.y())));
}

void add_path(Members& members, const FloorPath& path, bool in_degrees) {
  static constexpr const char* kShapes[] = {"ramp", "half_sine", "sine"};
  members.add("shape", quoted(kShapes[static_cast<int>(path.shape)]));
  if (path.shape == MotionShape::sine) members.add("frequency", number(path.frequency));
  if (!path.tilt.isZero(0))
    members.add("roll", angle_text(path.tilt.x(), in_degrees))
        .add("pitch", angle_text(path.tilt.y(), in_degrees));
  if (!path.shift.isZero(0)) members.add("shift", vector_text(path.shift));
}

template <typename Item, typename Text>
void add_list(Members& members, const char* key, const std::vector<Item>& items, const Text& text) {
  if (items.empty()) return;
  Members list;
  for (const Item& item : items) list.item(text(item).object());
  members.add(key, list.array());
}

std::string field_text(const HeightField& field) {
  Members rows;
  for (Eigen::Index i = 0; i < field.heights.rows(); ++i)
    rows.item(vector_text(field.heights.row(i).transpose()));
  return Members()
      .add("origin", vector_text(field.origin))
      .add("spacing", number(field.spacing))
      .add("heights", rows.array())
      .object();
}

/// Adds the members that a kind of disturbance has in addition to type, at and duration.
struct WhatText {
  Members& members;
  bool in_degrees;

  void operator()(const Push& d) {
    members.add("on", quoted(d.on));
    if (d.on != "cog" && !d.point.isZero(0)) members.add("point", vector_text(d.point));
    if (d.frame == PushFrame::link) members.add("frame", quoted("link"));
    members.add("direction", vector_text(d.direction)).add(name_of(d.kind), number(d.magnitude));
    if (d.shape == PushShape::half_sine) members.add("shape", quoted("half_sine"));
  }
  void operator()(const Payload& d) {
    members.add("on", quoted(d.on));
    if (!d.point.isZero(0)) members.add("point", vector_text(d.point));
    members.add("mass", number(d.mass));
  }
  void operator()(const FloorPath& d) { add_path(members, d, in_degrees); }
  void operator()(const FrictionChange& d) { members.add("friction", number(d.friction)); }
  void operator()(const Bump& d) {
    if (d.foot) members.add("foot", quoted(name_of(*d.foot)));
    members.add("position", vector_text(d.place));
    members.add("radius", number(d.radius)).add("height", number(d.height));
  }
  void operator()(const Latency& d) { members.add("latency", number(d.latency)); }
  void operator()(const SensorBias& d) {
    members.add("roll", angle_text(d.tilt.x(), in_degrees));
    members.add("pitch", angle_text(d.tilt.y(), in_degrees));
    Members gyro;
    for (const double rate : d.gyro) gyro.item(angle_text(rate, in_degrees));
    members.add("gyro", gyro.array()).add("load", number(d.load));
  }
  void operator()(const EncoderOffset& d) {
    add_joint(d.joint);
    members.add("offset", angle_text(d.offset, in_degrees));
  }
  void operator()(const JointFriction& d) {
    add_joint(d.joint);
    members.add("coulomb", number(d.coulomb)).add("viscous", number(d.viscous));
  }
  void operator()(const GainLoss& d) {
    add_joint(d.joint);
    members.add("share", number(d.share));
  }
  void add_joint(const std::string& joint) {
    if (!joint.empty()) members.add("joint", quoted(joint));
  }
};

}  // namespace

std::string world_text(const World& world, bool in_degrees) {
  Members members;
  members.add("friction", number(world.friction));
  Members ground;
  if (!world.slope.isZero(0))
    ground.add("roll", angle_text(world.slope.x(), in_degrees))
        .add("pitch", angle_text(world.slope.y(), in_degrees));
  if (world.height != 0) ground.add("height", number(world.height));
  members.add("ground", ground.empty() ? quoted("flat") : ground.object());
  Members blocks;
  for (const GroundBlock& block : world.blocks) {
    Members item;
    if (block.kind == GroundBlock::Kind::rectangle)
      add_rectangle(item, block.low, block.high);
    else
      item.add("position", vector_text(block.center)).add("radius", number(block.radius));
    blocks.item(item.add("height", number(block.height)).object());
  }
  if (!blocks.empty()) members.add("blocks", blocks.array());
  if (!world.fields.empty()) members.add("field", field_text(world.fields.front()));
  add_list(members, "patches", world.patches, [](const FrictionPatch& patch) {
    Members item;
    add_rectangle(item, patch.low, patch.high);
    return item.add("friction", number(patch.friction));
  });
  add_list(members, "motion", world.motions, [&](const FloorMotion& motion) {
    Members item;
    item.add("at", number(motion.at)).add("duration", number(motion.duration));
    add_path(item, motion.path, in_degrees);
    return item;
  });
  return members.object();
}

std::string disturbance_text(const Disturbance& d, bool in_degrees) {
  Members members;
  members.add("type", quoted(name_of(d))).add("at", number(d.at));
  members.add("duration", number(d.duration));
  std::visit(WhatText{members, in_degrees}, d.what);
  return members.object();
}

}  // namespace ayumi
