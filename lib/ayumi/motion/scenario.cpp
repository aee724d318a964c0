#include "ayumi/motion/scenario.hpp"

namespace ayumi {

const char* name_of(PushKind kind) {
  static constexpr const char* names[] = {"impulse", "force", "torque"};
  return names[static_cast<int>(kind)];
}

const char* name_of(const Disturbance& disturbance) {
  if (const auto* push = std::get_if<Push>(&disturbance.what)) return name_of(push->kind);
  // The names are in the order of the variant's alternatives, of which Push is the first.
  static constexpr const char* names[] = {"payload",        "floor",          "friction",
                                          "bump",           "latency",        "sensor_bias",
                                          "encoder_offset", "joint_friction", "gain_loss"};
  static_assert(std::size(names) + 1 == std::variant_size_v<decltype(disturbance.what)>);
  return names[disturbance.what.index() - 1];
}

std::vector<FloorMotion> floor_motions(const std::vector<Disturbance>& scenario) {
  std::vector<FloorMotion> motions;
  for (const Disturbance& d : scenario)
    if (const auto* path = std::get_if<FloorPath>(&d.what))
      motions.push_back({.at = d.at, .duration = d.duration, .path = *path});
  return motions;
}

}  // namespace ayumi
