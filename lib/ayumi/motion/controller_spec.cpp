#include "ayumi/motion/controller_spec.hpp"

#include "ayumi/base/error.hpp"
#include "ayumi/base/largest_number.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {

namespace {

struct NamedController {
  std::string name;
  ControllerType type;
};

const std::vector<NamedController>& named_controllers() {
  static const std::vector<NamedController> table = {
      {"none", ControllerKind::none},
      {"dtad", ControllerKind::dtad},
      {"dtad-literal", {ControllerKind::dtad, Demonstration::literal}},
      {"viip", ControllerKind::viip},
      {"viip-landings", {ControllerKind::viip, Demonstration::landings_only}},
      {"viip-nofeedback", {ControllerKind::viip, Demonstration::no_feedback}},
      {"preview", ControllerKind::preview},
      {"foot-guided", ControllerKind::foot_guided},
      {"dcm-step", ControllerKind::dcm_step}};
  return table;
}

}  // namespace

bool is_baseline(ControllerKind kind) {
  return kind == ControllerKind::preview || kind == ControllerKind::foot_guided ||
         kind == ControllerKind::dcm_step;
}

const std::string& name_of(const ControllerType& type) {
  for (const NamedController& each : named_controllers())
    if (each.type == type) return each.name;
  fail(ErrorCode::internal, "this controller does not have this demonstration");
}

const std::vector<std::string>& controller_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const NamedController& each : named_controllers()) list.push_back(each.name);
    return list;
  }();
  return names;
}

ControllerType controller_type(const std::string& name) {
  for (const NamedController& each : named_controllers())
    if (each.name == name) return each.type;
  const std::vector<std::string>& names = controller_names();
  fail(ErrorCode::usage, "unknown controller '" + name + "'" + text::suggestion(name, names) +
                             " (known: " + text::join(names, ", ") + ")");
}

std::string gain_out_of_range(const std::string& name, double value) {
  if (value >= 0 && value <= kLargestNumber) return {};
  return "gain " + name + " is " + text::brief(value) + "; a gain must be from 0 to " +
         text::brief(kLargestNumber);
}

}  // namespace ayumi
