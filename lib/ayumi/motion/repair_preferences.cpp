#include "ayumi/motion/repair_preferences.hpp"

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/motion/pattern_context.hpp"

namespace ayumi {

void require_repair_wishes(const RobotModel& model, const Pattern& pattern) {
  const RepairWishes& wishes = pattern.repair;
  for (size_t i = 0; i < wishes.joints.size(); ++i)
    find_joint(model, wishes.joints[i],
               in_file(pattern, "repair/lock/joints/" + std::to_string(i)));
  for (const auto& entry : wishes.weights)
    find_joint(model, entry.first, in_file(pattern, "repair/weights/" + entry.first));
  const double end = pattern.duration();
  for (size_t i = 0; i < wishes.windows.size(); ++i)
    if (wishes.windows[i].first > end)
      fail(ErrorCode::bad_pattern, in_file(pattern, "repair/lock/windows/" + std::to_string(i)) +
                                       ": begins at " + text::exact(wishes.windows[i].first) +
                                       " s, after the motion's end at " + text::exact(end) + " s");
}

RepairWishes without_keyframes(const Pattern& pattern) {
  RepairWishes wishes = pattern.repair;
  for (const int key : wishes.keyframes) {
    const double t = pattern.keyframes.at(static_cast<size_t>(key)).t;
    wishes.windows.emplace_back(t, t);
  }
  wishes.keyframes.clear();
  return wishes;
}

}  // namespace ayumi
