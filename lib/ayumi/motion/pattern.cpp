#include "ayumi/motion/pattern.hpp"

#include <algorithm>

namespace ayumi {

const char* name_of(Support support) {
  switch (support) {
    case Support::both:
      return "both";
    case Support::left:
      return "left";
    case Support::right:
      return "right";
    case Support::none:
      return "none";
  }
  return "?";
}

const char* name_of(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::linear:
      return "linear";
    case Interpolation::cubic:
      return "cubic";
    case Interpolation::minimum_jerk:
      return "minimum_jerk";
    case Interpolation::hold:
      return "hold";
    case Interpolation::spline:
      return "spline";
  }
  return "?";
}

const char* name_of(Trust trust) {
  constexpr const char* kNames[] = {"posture", "cog", "zmp"};
  return kNames[static_cast<int>(trust)];
}

bool RepairPreferences::empty() const {
  return joints.empty() && !feet[0] && !feet[1] && keyframes.empty() && windows.empty() &&
         weights.empty() && !trust && !margin && !safety;
}

double Pattern::duration() const {
  double end = 0;
  if (!phases.empty()) end = std::max(end, phases.back().until);
  if (!keyframes.empty()) end = std::max(end, keyframes.back().t);
  if (table && table->theta.rows() > 0)
    end = std::max(end, table->dt * static_cast<double>(table->theta.rows() - 1));
  return end;
}

}  // namespace ayumi
