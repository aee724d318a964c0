#pragma once
// Files whose changes are followed.

#include <chrono>
#include <filesystem>

namespace ayumi::app {

/// Properties of a file that change when it is written: times [s, ns], size and number of the file.
/// A missing file has the size -1.
struct FileStamp {
  long seconds = 0, nanoseconds = 0, size = -1;
  unsigned long number = 0;
  bool operator==(const FileStamp&) const = default;
};

FileStamp stamp_of(const std::filesystem::path& file);

/// Time between two looks at files. Chosen: a small part of the time that an answer takes, with a
/// load of a few thousandths of a core.
inline constexpr std::chrono::milliseconds kFileLook(5);
/// Clocks of file systems advance in steps of up to 10 ms (jiffies of 100 Hz). Two saves with the
/// same size within one step have the same stamp, so the bytes are compared once after this time.
inline constexpr std::chrono::milliseconds kFileClockStep(30);
/// A file that is missing for longer counts as removed. Chosen: editors that replace a file do so
/// within 0.1 s.
inline constexpr std::chrono::milliseconds kFileGone(500);
/// A text that is no JSON counts only after it has stayed the same for the first of these times,
/// because an editor may empty a file and write it in several steps; a file that changes all the
/// time counts after the second one. Chosen: editors write within some milliseconds.
inline constexpr std::chrono::milliseconds kFileWritten(100), kFileBusy(500);

/// Waits while an editor writes a JSON file, as described for kFileWritten. Returns at once if the
/// text is JSON, or if there is no file.
void await_written(const std::filesystem::path& file);

}  // namespace ayumi::app
