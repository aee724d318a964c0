#include "ayumi/motion/pattern_context.hpp"

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

SourcePlace in_file(const Pattern& pattern, const std::string& inside) {
  return {pattern.file, inside};
}

std::string pointer_of_phase(const Pattern& pattern, size_t i) {
  const std::string& pointer = pattern.phases[i].pointer;
  return pointer.empty() ? "/phases/" + std::to_string(i) : pointer;
}

std::string pointer_of_keyframe(const Pattern& pattern, size_t i) {
  const std::string& pointer = pattern.keyframes[i].pointer;
  return pointer.empty() ? "/keyframes/" + std::to_string(i) : pointer;
}

SourcePlace place_of_phase(const Pattern& pattern, size_t i) {
  return in_file(pattern, pointer_of_phase(pattern, i));
}

SourcePlace place_of_keyframe(const Pattern& pattern, size_t i) {
  return in_file(pattern, pointer_of_keyframe(pattern, i));
}

int find_joint(const RobotModel& model, const std::string& joint, const SourcePlace& place) {
  const int dof = model.find_dof(joint);
  if (dof >= 0) return dof;
  for (const JointDescription& each : model.description().joints)
    if (each.name == joint)
      fail_unknown_name(place,
                        "joint '" + joint + "' " +
                            (each.mimic.empty() ? "does not move. Remove the key"
                                                : "follows '" + each.mimic + "' (mimic). Set '" +
                                                      each.mimic + "' in place of this joint"));
  fail_unknown_name(place, "the robot '" + model.name() + "' has no joint '" + joint + "'" +
                               text::suggestion(joint, model.dof_names()));
}

std::map<std::string, double> posture_joints(const RobotModel& model, const Pattern& pattern,
                                             const std::string& name, const SourcePlace& place) {
  const auto own = pattern.postures.find(name);
  if (own != pattern.postures.end()) {
    const auto included = pattern.posture_files.find(name);
    for (const auto& [joint, angle] : own->second) {
      SourcePlace where = in_file(
          pattern, "/postures/" + json_pointer_token(name) + "/" + json_pointer_token(joint));
      if (included != pattern.posture_files.end()) where.file = included->second;
      find_joint(model, joint, where);
      if (!std::isfinite(angle))
        fail(ErrorCode::bad_pattern, where, "the angle is not a finite number");
    }
    return own->second;
  }
  std::map<std::string, double> joints;
  if (model.has_posture(name)) {
    const Eigen::VectorXd theta = model.posture(name);
    for (int dof = 0; dof < model.dof_count(); ++dof) joints[model.dofs()[dof].name] = theta[dof];
    return joints;
  }
  std::vector<std::string> known;
  for (const auto& entry : pattern.postures) known.push_back(entry.first);
  for (const auto& entry : model.description().postures) known.push_back(entry.first);
  fail_unknown_name(place, "neither the pattern nor the robot '" + model.name() +
                               "' has a posture '" + name + "'; known: " + text::join(known, ", ") +
                               text::suggestion(name, known));
}

Eigen::VectorXd default_posture(const RobotModel& model, const Pattern& pattern) {
  Eigen::VectorXd theta =
      model.has_posture("home") ? model.posture("home") : Eigen::VectorXd::Zero(model.dof_count());
  for (const auto& [joint, angle] : posture_joints(model, pattern, pattern.default_posture,
                                                   in_file(pattern, "/defaults/posture")))
    theta[model.find_dof(joint)] = angle;
  return theta;
}

double default_cog_height(const RobotModel& model, const Pattern& pattern) {
  if (pattern.cog_height != 0) {
    if (!(pattern.cog_height > 0) || !std::isfinite(pattern.cog_height))
      fail(ErrorCode::bad_pattern, in_file(pattern, "/defaults/cog_height"),
           "the COG height is " + text::exact(pattern.cog_height) + " m, but must be above 0 m");
    return pattern.cog_height;
  }
  RobotState state = model.rest_state();
  state.theta = default_posture(model, pattern);
  RobotData data(model);
  update_positions(model, state, data);
  return data.cog.z() - 0.5 * (sole_pose(model, data, Side::left).translation().z() +
                               sole_pose(model, data, Side::right).translation().z());
}

}  // namespace ayumi
