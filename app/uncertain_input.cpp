#include "uncertain_input.hpp"

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/assumed_study.hpp"

namespace ayumi::app {

Study load_study(const Task& input, const std::string& file) {
  if (!file.empty()) {
    Study study = read_study(file);
    if (study.uncertainty.empty())
      fail(ErrorCode::bad_pattern, {file},
           "the study has no uncertainty. Add \"uncertainty\" to it");
    return study;
  }
  if (!input.pattern.uncertainty.empty())
    return {.name = input.pattern.name,
            .file = input.pattern.file,
            .sha256 = input.pattern.sha256,
            .uncertainty = input.pattern.uncertainty};
  const std::filesystem::path standard = default_study(input.robot);
  if (standard.empty()) return assumed_study(input.robot);
  return read_study(standard);
}

std::string fit_to_plant(Study& study, const RobotModel& robot, const std::string& plant,
                         bool stated) {
  if (plant != "mujoco") return "";
  // Soles whose softness no file states have the stiffness and the damping of MuJoCo's contacts
  // (mujoco_ground.cpp).
  if (robot.description().states_softness_of_soles()) return "";
  const auto unused = [](const UncertainQuantity& q) {
    return q.kind == UncertainKind::sole_stiffness || q.kind == UncertainKind::sole_damping;
  };
  std::vector<std::string> names;
  std::vector<UncertainQuantity>& all = study.uncertainty.quantities;
  for (const UncertainQuantity& q : all) {
    if (!unused(q)) continue;
    if (stated)
      fail(ErrorCode::bad_pattern, q.place,
           "this quantity has no effect. With --plant mujoco, soles whose stiffness the robot's "
           "sidecar does not state have the stiffness and the damping of MuJoCo's contacts. Remove "
           "the quantity, or state the stiffness in the sidecar");
    names.push_back(q.name);
  }
  std::erase_if(all, unused);
  if (names.empty()) return "";
  return "  these quantities are not varied, because --plant mujoco does not use them: " +
         text::join(names, ", ") + "\n";
}

}  // namespace ayumi::app
