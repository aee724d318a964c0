#pragma once
// A log that is written while the simulation runs, so that its samples need not be held in memory.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/base/scratch_file.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "ayumi/io/run/written_log.hpp"

namespace ayumi {

/// Writes one log. The header stands at the beginning of the file, but it is only known at the end.
/// So the blocks of samples first go to a scratch file. The log file only appears when it is
/// complete.
class LogWriter {
 public:
  /// The scratch file is made in `folder`, the folder of the log. Throws the same errors as
  /// ScratchFile.
  LogWriter(const std::filesystem::path& folder, const std::vector<std::string>& joints);

  /// Throws Error(bad_file) if the disk is full.
  void add(const SimulationSample& sample) { blocks_.add(sample); }

  /// Writes the file `path`; nothing may be added afterwards. The samples of `about` are ignored.
  /// The bytes are those of write_log() with all samples. Throws the same errors as
  /// write_file_with(), and Interrupted.
  WrittenLog finish(SimulationLog about, const std::filesystem::path& path,
                    const Progress& progress = {});

 private:
  struct Block {
    size_t begin, size, rows;  // place and size in the scratch file [bytes], number of rows
  };
  ScratchFile scratch_;
  std::vector<Block> written_;
  LogBlocks blocks_;
  size_t columns_;
};

/// The hash of a log that is not kept. Its rows are kept in a scratch file, because they are hashed
/// after the header. The first block of rows stays in memory, so short logs need no file. If no
/// scratch file can be made, all rows stay in memory.
class LogHash {
 public:
  /// `folder` is where the scratch file is made if it is needed.
  LogHash(std::filesystem::path folder, size_t joints);
  /// Throws Error(bad_file) if the disk is full.
  void add(const SimulationSample& sample);
  /// Nothing may be added afterwards. The samples of `about` are ignored.
  WrittenLog finish(SimulationLog about);

 private:
  std::filesystem::path folder_;
  size_t joints_;
  std::optional<ScratchFile> scratch_;
  std::string rows_;  // rows that are not in the scratch file
  size_t count_ = 0;
  bool in_memory_ = false;
};

}  // namespace ayumi
