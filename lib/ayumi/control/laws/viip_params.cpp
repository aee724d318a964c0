// Gains of VIIP: defaults, the robot's sidecar, the pattern.
#include <cmath>
#include <map>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/laws/viip.hpp"

namespace ayumi {

ViipParams viip_params(const RobotModel& model, const ControllerSpec& spec) {
  ViipParams p;
  const std::map<std::string, double*> fields = {
      {"q", &p.q},         {"goal", &p.goal},      {"ka", &p.ka},         {"av", &p.av},
      {"ax", &p.ax},       {"tau_z", &p.tau_z},    {"margin", &p.margin}, {"kz", &p.kz},
      {"dz", &p.dz},       {"ankle", &p.ankle},    {"single", &p.single}, {"both", &p.both},
      {"lift", &p.lift},   {"reach", &p.reach},    {"hold", &p.hold},     {"inside", &p.inside},
      {"hurry", &p.hurry}, {"soonest", &p.soonest}};
  std::vector<std::string> names;
  for (const auto& [name, field] : fields) names.push_back(name);
  auto set = [&](const std::string& name, double value, const std::string& where) {
    if (!std::isfinite(value) || value < 0)
      fail(ErrorCode::usage, where + ": gain " + name + " is " + text::brief(value) +
                                 "; gains are finite and not negative");
    const auto found = fields.find(name);
    if (found == fields.end())
      fail(ErrorCode::usage, where + ": viip has no gain '" + name + "'" +
                                 text::suggestion(name, names) +
                                 " (known: " + text::join(names, ", ") + ")");
    *found->second = value;
  };
  for (const auto& [name, value] : model.description().control.viip)
    set(name, value, model.name() + " sidecar");
  if (spec.type.kind == ControllerKind::viip)
    for (const auto& [name, value] : spec.gains) set(name, value, "controller gains");
  for (const char* name : {"q", "goal", "tau_z", "kz", "single", "both", "lift"})
    if (!(*fields.at(name) > 0))
      fail(ErrorCode::usage, std::string("controller gains: ") + name + " must be positive");
  if (p.dz < 1 - 1e-9)
    fail(ErrorCode::usage, "controller gains: dz = " + text::brief(p.dz) +
                               " overshoots; (25) asks for K_Dz^2 >= 4 m K_Pz, dz >= 1");
  if (p.hold > 1) fail(ErrorCode::usage, "controller gains: hold is a share, at most 1");
  p.landings = spec.type.demonstration != Demonstration::no_feedback;
  p.feedback = p.landings && spec.type.demonstration != Demonstration::landings_only;
  return p;
}

}  // namespace ayumi
