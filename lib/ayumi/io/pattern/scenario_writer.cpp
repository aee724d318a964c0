#include "ayumi/io/pattern/scenario_text.hpp"

namespace ayumi {

using Eigen::Vector2d;

namespace {

void add_rectangle(Members& members, const Vector2d& low, const Vector2d& high) {
  members.add("x", vector_text(Vector2d(low.x(), high.x())));
  members.add("y", vector_text(Vector2d(low.y(), high.y())));
}

void add_motion(Members& members, const FloorMotion& motion, bool in_degrees) {
  static constexpr const char* kShapes[] = {"ramp", "half_sine", "sine"};
  members.add("shape", quoted(kShapes[static_cast<int>(motion.shape)]));
  if (motion.shape == MotionShape::sine) members.add("frequency", number(motion.frequency));
  if (!motion.tilt.isZero(0))
    members.add("roll", angle_text(motion.tilt.x(), in_degrees))
        .add("pitch", angle_text(motion.tilt.y(), in_degrees));
  if (!motion.shift.isZero(0)) members.add("shift", vector_text(motion.shift));
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

void add_push(Members& members, const Disturbance& d) {
  members.add("on", quoted(d.on));
  if (d.on != "cog" && !d.point.isZero(0)) members.add("point", vector_text(d.point));
  if (d.frame == DisturbanceFrame::link) members.add("frame", quoted("link"));
  members.add("direction", vector_text(d.direction)).add(name_of(d.type), number(d.magnitude));
  if (d.shape == DisturbanceShape::half_sine) members.add("shape", quoted("half_sine"));
}

void add_joint(Members& members, const Disturbance& d) {
  if (!d.joint.empty()) members.add("joint", quoted(d.joint));
}

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
    add_motion(item, motion, in_degrees);
    return item;
  });
  return members.object();
}

std::string disturbance_text(const Disturbance& d, bool in_degrees) {
  Members members;
  members.add("type", quoted(name_of(d.type))).add("at", number(d.at));
  members.add("duration", number(d.duration));
  switch (d.type) {
    case DisturbanceType::impulse:
    case DisturbanceType::force:
    case DisturbanceType::torque:
      add_push(members, d);
      break;
    case DisturbanceType::payload:
      members.add("on", quoted(d.on));
      if (!d.point.isZero(0)) members.add("point", vector_text(d.point));
      members.add("mass", number(d.magnitude));
      break;
    case DisturbanceType::floor:
      add_motion(members, d.floor, in_degrees);
      break;
    case DisturbanceType::friction:
      members.add("friction", number(d.magnitude));
      break;
    case DisturbanceType::bump:
      if (d.foot) members.add("foot", quoted(name_of(*d.foot)));
      members.add("position", vector_text(d.place));
      members.add("radius", number(d.radius)).add("height", number(d.magnitude));
      break;
    case DisturbanceType::latency:
      members.add("latency", number(d.magnitude));
      break;
    case DisturbanceType::sensor_bias: {
      members.add("roll", angle_text(d.tilt_bias.x(), in_degrees));
      members.add("pitch", angle_text(d.tilt_bias.y(), in_degrees));
      Members gyro;
      for (const double rate : d.gyro_bias) gyro.item(angle_text(rate, in_degrees));
      members.add("gyro", gyro.array()).add("load", number(d.force_bias));
      break;
    }
    case DisturbanceType::encoder_offset:
      add_joint(members, d);
      members.add("offset", angle_text(d.magnitude, in_degrees));
      break;
    case DisturbanceType::joint_friction:
      add_joint(members, d);
      members.add("coulomb", number(d.magnitude)).add("viscous", number(d.viscous));
      break;
    case DisturbanceType::gain_loss:
      add_joint(members, d);
      members.add("share", number(d.magnitude));
      break;
  }
  return members.object();
}

}  // namespace ayumi
