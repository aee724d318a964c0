#pragma once
// The description of an exported log: the program, the conventions and the origin of the run.

#include <nlohmann/json.hpp>

#include "ayumi/base/version.hpp"
#include "ayumi/io/run/provenance_fields.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

inline nlohmann::ordered_json about_log(const SimulationLog& log) {
  nlohmann::ordered_json json = {{"tool", std::string("ayumi ") + version()},
                                 {"gravity", kGravity},
                                 {"frame", "world: x forward, y left, z up"},
                                 {"quaternion_order", "w x y z, base to world"},
                                 {"dt", log.dt},
                                 {"controller", log.controller ? name_of(*log.controller) : ""},
                                 {"plant", log.plant}};
  for_each_provenance(log.provenance, [&](const char* key, const std::string& value) {
    json["provenance"][key] = value;
  });
  return json;
}

}  // namespace ayumi
