#pragma once
// Clips are made by the program `ffmpeg`, which runs as a child process and receives frames through
// a pipe.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ayumi/render/image.hpp"

namespace ayumi {

/// Throws Error(bad_file) if there is no such program in the folders of PATH.
void require_encoder(const std::string& program = "ffmpeg");

/// Feeds frames to one ffmpeg process. The destructor ends a process that is not finished.
class ClipEncoder {
 public:
  /// The extension of `path` gives the format: .mp4 (H.264), .webm (VP9), .gif, .apng. Throws
  /// Error(usage) for another extension, or for an odd size if the format needs an even one, and
  /// Error(bad_file) if ffmpeg cannot be started. The same frames give the same bytes. While ffmpeg
  /// is waited for, `alive` is called several times per second; an exception that it throws ends
  /// the wait.
  ClipEncoder(const std::filesystem::path& path, int width, int height, double fps,
              const std::string& program = "ffmpeg", std::function<void()> alive = {});
  ~ClipEncoder();
  ClipEncoder(const ClipEncoder&) = delete;
  ClipEncoder& operator=(const ClipEncoder&) = delete;

  /// Throws Error(bad_file) with ffmpeg's last words if it has stopped.
  void add(const Image& frame);
  /// Waits until the file is complete. Throws the same errors as add().
  void finish();

 private:
  std::filesystem::path path_;  ///< path of the file; its extension gives the format
  std::string program_;
  int width_, height_;
  int pipe_ = -1, log_ = -1;
  int process_ = -1;
  std::vector<std::uint8_t> planes_;  ///< planes of the last frame

  std::function<void()> alive_;

  void wait_until_ready();
  int wait();
  [[noreturn]] void fail_with_log();
};

}  // namespace ayumi
