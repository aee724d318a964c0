#pragma once
// The "servos" groups of a sidecar, and the parameter files of BAM (Better Actuator Models of
// Rhoban, friction models M1 to M6) that they may name. docs/formats.md, "Servos".

#include <map>
#include <string>
#include <vector>

#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// Servos by joint name, and the joints to which a group has given a motor (or kp 0: none).
struct ServoGroups {
  std::map<std::string, ServoDescription> servos;
  std::map<std::string, bool> stated;
  std::string files;  ///< bytes of the parameter files that were read, in this order
};

/// Reads one group into the servos of `joints`; a later group changes what it names. A parameter
/// file is looked for beside the file in which the group stands. Complains about constants that no
/// servo can have, with the limit.
void read_servo_group(const JsonNode& group, const std::vector<std::string>& joints,
                      ServoGroups& out);

}  // namespace ayumi
