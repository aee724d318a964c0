#pragma once
// SimulationLog as one binary file ("ayumi.log/1"): 8 bytes "AYUMILOG", a 32-bit version, a 32-bit
// header length, the header as JSON text (columns with units, joints, events, result, provenance),
// then rows of 64-bit floats, all little-endian. Every number survives bit for bit.

#include <filesystem>
#include <string>

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// The bytes of the file. Throws Error(internal) when a sample's joint vectors have another size
/// than `joints`.
std::string log_bytes(const SimulationLog& log);

/// Throws Error(bad_file) naming the file: not a log, another version, damaged header, truncated.
SimulationLog parse_log(const std::string& bytes, const std::string& file);
SimulationLog read_log(const std::filesystem::path& path);
void write_log(const std::filesystem::path& path, const SimulationLog& log);

/// SHA-256 of log_bytes without the command line: the same for the same motion of the same robot
/// under the same controller, world and scenario.
std::string log_hash(const SimulationLog& log);

}  // namespace ayumi
