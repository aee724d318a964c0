#include "ayumi/io/run/log_writer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/io/run/log_fields.hpp"
#include "ayumi/io/run/sample_compression.hpp"
#include "ayumi/io/run/sha256_stream.hpp"

namespace ayumi {

namespace {

// Number of bytes of rows that wait in memory before a scratch file is used [bytes]. Chosen: 14 s
// of HOAP-1 at 1 kHz, so that most runs need no scratch file.
constexpr size_t kWaitingBytes = size_t{32} << 20;

}  // namespace

LogWriter::LogWriter(const std::filesystem::path& folder, const std::vector<std::string>& joints)
    : scratch_(folder),
      blocks_(joints,
              [this](const std::string& bytes, size_t rows) {
                written_.push_back({scratch_.size(), bytes.size(), rows});
                scratch_.append(bytes);
              }),
      columns_(log_columns(joints)) {}

WrittenLog LogWriter::finish(SimulationLog about, const std::filesystem::path& path,
                             const Progress& progress) {
  WrittenLog log;
  log.rows = blocks_.rows();
  Sha256Stream file_hash, hash;
  hash.add(hashed_log_head(about, log.rows));
  // The rows are hashed after the head, which needs their number. Rows of the first block are still
  // there; later blocks are read back.
  const bool one_block = written_.empty();
  if (one_block) hash.add(blocks_.waiting());
  blocks_.finish();
  write_file_with(path, [&](const std::filesystem::path& temporary) {
    errno = 0;
    std::ofstream stream(temporary, std::ios::binary);
    const auto require_written = [&] {
      if (!stream)
        fail(ErrorCode::bad_file, {path.string()},
             std::string("the file cannot be written (") + std::strerror(errno) + ")");
    };
    const auto write = [&](const std::string& bytes) {
      stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      require_written();
      file_hash.add(bytes);
    };
    write(log_head(about, log.rows));
    for (size_t i = 0; i < written_.size(); ++i) {
      const double done = static_cast<double>(i) / static_cast<double>(written_.size());
      if (i > 0) report(progress, {"writing the log", done, ""});
      const auto& [begin, size, rows] = written_[i];
      const std::string block = scratch_.read(begin, size);
      write(block);
      if (!one_block) hash.add(decompress_samples(block, columns_, rows, path.string()));
    }
    stream.close();
    require_written();
  });
  log.about = std::move(about);
  log.log_hash = hash.digits();
  log.file_hash = file_hash.digits();
  return log;
}

LogHash::LogHash(std::filesystem::path folder, size_t joints)
    : folder_(std::move(folder)), joints_(joints) {}

void LogHash::add(const SimulationSample& sample) {
  append_values(sample, joints_, rows_);
  ++count_;
  if (rows_.size() < kWaitingBytes || in_memory_) return;
  try {
    if (!scratch_) scratch_.emplace(folder_);
  } catch (const Error&) {
    in_memory_ = true;
    return;
  }
  scratch_->append(rows_);
  rows_.clear();
}

WrittenLog LogHash::finish(SimulationLog about) {
  WrittenLog log;
  log.rows = count_;
  Sha256Stream hash;
  hash.add(hashed_log_head(about, count_));
  for (size_t at = 0; scratch_ && at < scratch_->size(); at += kWaitingBytes)
    hash.add(scratch_->read(at, std::min(kWaitingBytes, scratch_->size() - at)));
  hash.add(rows_);
  log.about = std::move(about);
  log.log_hash = hash.digits();
  return log;
}

}  // namespace ayumi
