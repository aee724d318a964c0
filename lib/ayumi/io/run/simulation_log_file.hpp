#pragma once
// SimulationLog as one binary file ("ayumi.log/3"): 8 bytes "AYUMILOG", a 32-bit version, a 32-bit
// header length and CRC-32, the header as JSON text (columns with units, joints, events, result,
// provenance), then rows of 64-bit floats as compress_samples() writes them, all little-endian.
// Every number survives bit for bit. A log of more than kLogBlockRows rows ("ayumi.log/4") has them
// in blocks of kLogBlockRows rows, so that it can be written while it grows. Version 1 has no CRC,
// and its rows are not compressed.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// Number of rows of a block. Chosen: the longest log of a bundled pattern (20.5 s at 1 kHz) is one
/// block. Writing a block takes about three times the memory of its rows before compression, which
/// are 78 MB for HOAP-1; half or twice the rows take half or twice the memory. A log of 80 s is 0.7
/// % larger than in one block.
inline constexpr size_t kLogBlockRows = size_t{1} << 15;

/// Number of values in a row of a log with these joints.
size_t log_columns(const std::vector<std::string>& joints);

/// Largest number of rows of a log with these joints: no reader accepts more.
size_t most_log_rows(const std::vector<std::string>& joints);

/// The samples of a log in the form that its file has, block by block.
class LogBlocks {
 public:
  /// Receives the bytes of a block and the number of its rows.
  using Write = std::function<void(const std::string& bytes, size_t rows)>;
  LogBlocks(const std::vector<std::string>& joints, Write write);
  /// Throws Error(internal) if a joint vector does not have the size of the joints.
  void add(const SimulationSample& sample);
  /// Writes the remaining rows; nothing may be added afterwards. A log without samples has one
  /// empty block.
  void finish();
  size_t rows() const { return rows_; }
  /// The rows that are not written yet, as plain_log_bytes() has them.
  const std::string& waiting() const { return block_; }

 private:
  void write_block();
  size_t joints_, columns_;
  std::vector<std::vector<size_t>> sources_;
  Write write_;
  std::string block_;  // rows that are not written yet
  size_t rows_ = 0, rows_in_block_ = 0;
};

/// The part of the file before its samples. There are `rows` samples; those of `about` are ignored.
std::string log_head(const SimulationLog& about, size_t rows);
/// The part before the samples of the file whose SHA-256 is log_hash().
std::string hashed_log_head(const SimulationLog& about, size_t rows);

/// The bytes of the file. Throws Error(internal) if a sample's joint vectors do not have the size
/// of `joints`.
std::string log_bytes(const SimulationLog& log);

/// The bytes of the log as a file of version 1.
std::string plain_log_bytes(const SimulationLog& log);

/// Reads all versions. Throws Error(bad_file) that names the file if it is not a log, has another
/// version, or is damaged or truncated.
SimulationLog parse_log(const std::string& bytes, const std::string& file);
/// Whether the file exists and begins as a log does.
bool is_log_file(const std::filesystem::path& path);
SimulationLog read_log(const std::filesystem::path& path);
/// Gives the next bytes of a file: `count`, or fewer at its end.
using NextBytes = std::function<std::string(size_t count)>;
/// Reads the log of which `next` gives the `size` bytes; `file` is its name in messages.
SimulationLog read_log(const NextBytes& next, size_t size, const std::string& file);
void write_log(const std::filesystem::path& path, const SimulationLog& log);

/// SHA-256 of plain_log_bytes without the command line. It is the same for the same motion of the
/// same robot under the same controller, world and scenario, however the file is compressed.
std::string log_hash(const SimulationLog& log);

}  // namespace ayumi
