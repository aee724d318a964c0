#include "ayumi/motion/merge_keyframes.hpp"

namespace ayumi {

void merge(Keyframe& key, const Keyframe& later) {
  const auto take = [](auto& to, const auto& from) {
    if (from) to = from;
  };
  take(key.interpolation, later.interpolation);
  take(key.posture, later.posture);
  for (const auto& [joint, angle] : later.joints) key.joints[joint] = angle;
  take(key.zmp, later.zmp);
  take(key.cog_x, later.cog_x);
  take(key.cog_y, later.cog_y);
  take(key.cog_height, later.cog_height);
  take(key.fz, later.fz);
  take(key.torso, later.torso);
  for (size_t i = 0; i < 2; ++i) take(key.feet[i], later.feet[i]);
  for (const auto& [link, target] : later.hands) key.hands[link] = target;
  take(key.gaze, later.gaze);
  for (const auto& [joint, weight] : later.weights) key.weights[joint] = weight;
}

}  // namespace ayumi
