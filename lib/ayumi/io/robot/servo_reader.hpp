#pragma once
// Reads the "servos" groups of a sidecar, and the parameter files of BAM that they may name (Better
// Actuator Models of Rhoban, friction models M1 to M6). See docs/formats.md, "Servos".

#include <map>
#include <set>
#include <string>
#include <vector>

#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// Servos by joint name, and the joints to which a group has given a motor (or kp = 0, which means
/// no motor).
struct ServoGroups {
  std::map<std::string, ServoDescription> servos;
  std::map<std::string, bool> stated;
  std::string files;  ///< bytes of the parameter files that were read, in this order
  /// Entries of these files that have no counterpart in a servo, one sentence for each file.
  std::set<std::string> unused;
};

/// Reads one group into the servos of `joints`; a later group changes the values that it names. A
/// parameter file is searched beside the file that contains the group. Complains about constants
/// that no servo can have, with the limit.
void read_servo_group(const JsonNode& group, const std::vector<std::string>& joints,
                      ServoGroups& out);

}  // namespace ayumi
