#include "ayumi/motion/repair_preferences.hpp"

#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/motion/pattern_context.hpp"

namespace ayumi {

void require_repair_preferences(const RobotModel& model, const Pattern& pattern) {
  const RepairPreferences& preferences = pattern.repair;
  for (size_t i = 0; i < preferences.joints.size(); ++i)
    find_joint(model, preferences.joints[i],
               in_file(pattern, "/repair/lock/joints/" + std::to_string(i)));
  for (const auto& entry : preferences.weights)
    find_joint(model, entry.first,
               in_file(pattern, "/repair/weights/" + json_pointer_token(entry.first)));
  const double end = pattern.duration();
  for (size_t i = 0; i < preferences.windows.size(); ++i)
    if (preferences.windows[i].first > end)
      fail(ErrorCode::bad_pattern, in_file(pattern, "/repair/lock/windows/" + std::to_string(i)),
           "this window begins at " + text::exact(preferences.windows[i].first) +
               " s, after the end of the motion at " + text::exact(end) + " s");
}

RepairPreferences without_keyframes(const Pattern& pattern) {
  RepairPreferences preferences = pattern.repair;
  for (const int key : preferences.keyframes) {
    const double t = pattern.keyframes.at(static_cast<size_t>(key)).t;
    preferences.windows.emplace_back(t, t);
  }
  preferences.keyframes.clear();
  return preferences;
}

}  // namespace ayumi
