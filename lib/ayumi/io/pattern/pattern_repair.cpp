// Reads "repair" of a pattern file: what its author wants a repair to keep, to weigh and to trust.
#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_scope.hpp"

namespace ayumi {

namespace {

// Largest margin of the ZMP [m]. Chosen: twice the margin of HOAP-1 standing on both feet (48 mm).
constexpr double kWidestMargin = 0.1;

std::pair<double, double> read_window(const JsonNode& node, PatternScope& scope) {
  const std::vector<double> ends = read_numbers(node, scope, 2, 2, "[begin, end]");
  for (const double t : ends)
    if (t < 0 || t > kLongestPattern)
      node.complain(text::exact(t) + " s is outside the range of times, 0 to 3600 s");
  if (ends[1] < ends[0])
    node.complain("the window must end after it begins, but it begins at " + text::exact(ends[0]) +
                  " s and ends at " + text::exact(ends[1]) + " s");
  return {ends[0], ends[1]};
}

int read_keyframe_number(const JsonNode& node, int keyframes) {
  const int number = node.integer();
  if (number < 0 || number >= keyframes)
    node.complain(std::to_string(number) + " is not the number of a keyframe; " +
                  (keyframes == 0
                       ? "the pattern has no keyframes"
                       : "keyframes are numbered from 0 to " + std::to_string(keyframes - 1)));
  return number;
}

void read_lock(const JsonNode& node, int keyframes, PatternScope& scope,
               RepairPreferences& preferences) {
  only_pattern_keys(node, "lock");
  if (const auto joints = node.find("joints")) preferences.joints = joints->strings();
  if (const auto feet = node.find("feet"))
    for (const JsonNode& foot : feet->items())
      preferences.feet[foot.one_of({"left", "right"}) == "left" ? 0 : 1] = true;
  if (const auto keys = node.find("keyframes"))
    for (const JsonNode& key : keys->items())
      preferences.keyframes.push_back(read_keyframe_number(key, keyframes));
  if (const auto windows = node.find("windows"))
    for (const JsonNode& window : windows->items())
      preferences.windows.push_back(read_window(window, scope));
}

Trust read_trust(const JsonNode& node) {
  const std::string name = node.one_of({"posture", "cog", "zmp"});
  for (const Trust each : {Trust::cog, Trust::zmp})
    if (name == name_of(each)) return each;
  return Trust::posture;
}

}  // namespace

RepairPreferences read_repair(const JsonNode& node, int keyframes, PatternScope& scope) {
  only_pattern_keys(node, "repair");
  RepairPreferences preferences;
  if (const auto lock = node.find("lock")) read_lock(*lock, keyframes, scope, preferences);
  if (const auto weights = node.find("weights"))
    for (const auto& [joint, weight] : weights->members()) {
      preferences.weights[joint] = read_number(weight, scope);
      if (preferences.weights[joint] <= 0)
        weight.complain("a weight must be above 0, but it is " +
                        text::exact(preferences.weights[joint]) +
                        ". If the joint must not change, lock the joint");
    }
  if (const auto trust = node.find("trust")) preferences.trust = read_trust(*trust);
  if (const auto margin = node.find("margin"))
    preferences.margin = read_number(*margin, scope, 0, kWidestMargin);
  if (const auto safety = node.find("safety"))
    preferences.safety = read_number(*safety, scope, 0, kLargestNumber);
  return preferences;
}

}  // namespace ayumi
