#pragma once

namespace ayumi {

// Calls visit(key, text) for every field of a Provenance (const or not), in file order. Both
// run.json and the header of a log are read and written by this list.
template <typename Value, typename Visit>
void for_each_provenance(Value& p, const Visit& visit) {
  visit("robot", p.robot);
  visit("robot_sha256", p.robot_sha256);
  visit("pattern", p.pattern);
  visit("pattern_sha256", p.pattern_sha256);
  visit("profile", p.profile);
  visit("controller", p.controller);
  visit("command_line", p.command_line);
}

}  // namespace ayumi
