#include "ayumi/motion/scenario.hpp"

namespace ayumi {

const char* name_of(DisturbanceType type) {
  static constexpr const char* names[] = {
      "impulse", "force",   "torque",      "payload",        "floor",          "friction",
      "bump",    "latency", "sensor_bias", "encoder_offset", "joint_friction", "gain_loss"};
  return names[static_cast<int>(type)];
}

FloorMotion floor_motion(const Disturbance& disturbance) {
  FloorMotion motion = disturbance.floor;
  motion.at = disturbance.at;
  motion.duration = disturbance.duration;
  return motion;
}

}  // namespace ayumi
