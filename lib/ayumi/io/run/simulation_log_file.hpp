#pragma once
// SimulationLog as one binary file ("ayumi.log/2"): 8 bytes "AYUMILOG", a 32-bit version, a 32-bit
// header length and CRC-32, the header as JSON text (columns with units, joints, events, result,
// provenance), then rows of 64-bit floats as compress_samples() writes them, all little-endian.
// Every number survives bit for bit. Version 1 has no CRC, and its rows are not compressed.

#include <filesystem>
#include <string>

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// The bytes of the file. Throws Error(internal) when a sample's joint vectors have another size
/// than `joints`.
std::string log_bytes(const SimulationLog& log);

/// The same log as a file of version 1.
std::string plain_log_bytes(const SimulationLog& log);

/// Reads both versions. Throws Error(bad_file) naming the file: not a log, another version,
/// damaged, truncated.
SimulationLog parse_log(const std::string& bytes, const std::string& file);
/// Whether the file is there and begins as a log does.
bool is_log_file(const std::filesystem::path& path);
SimulationLog read_log(const std::filesystem::path& path);
void write_log(const std::filesystem::path& path, const SimulationLog& log);

/// SHA-256 of plain_log_bytes without the command line: the same for the same motion of the same
/// robot under the same controller, world and scenario, however the file is compressed.
std::string log_hash(const SimulationLog& log);

}  // namespace ayumi
