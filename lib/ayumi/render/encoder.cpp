#include "ayumi/render/encoder.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "ayumi/base/child_process.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/render/planar_yuv.hpp"

extern char** environ;

namespace ayumi {
namespace {

using Arguments = std::vector<std::string>;

// Period at which the end of ffmpeg is tested, and the longest wait before `alive` is called.
// Chosen: a clip is delayed by less than the time of a frame, and Ctrl-C is answered at once.
constexpr std::chrono::milliseconds kPause(2), kPatience(50);

/// The colour standard of to_yuv420(). Players assume it for video of this size.
const Arguments kVideoColor = {"-pix_fmt",         "yuv420p", "-colorspace", "bt709",
                               "-color_primaries", "bt709",   "-color_trc",  "bt709",
                               "-color_range",     "tv"};

bool is_video(const std::filesystem::path& path) {
  return path.extension() == ".mp4" || path.extension() == ".webm";
}

Arguments format_arguments(const std::filesystem::path& path, int width, int height) {
  const std::string extension = path.extension().string();
  const bool even = width % 2 == 0 && height % 2 == 0;
  if (is_video(path) && !even)
    fail(ErrorCode::usage, {path.string()},
         "the size is " + std::to_string(width) + "x" + std::to_string(height) + ", but " +
             extension + " needs an even width and height");
  Arguments arguments;
  if (extension == ".mp4") {
    // Without small partitions and motion of half a pixel, a fifth of the time is saved, the file
    // is 16 % larger, and its PSNR is the same. A still finer search of motion (me, subme) would
    // cost two thirds more time for 0.4 dB and 6 % of size. Large transforms (8x8dct) would cost a
    // quarter more time, and the file would be 1 % larger and 0.06 dB worse: most of a picture is
    // even, and the rest consists of sharp edges.
    arguments = {
        "-c:v",         "libx264",
        "-preset",      "veryfast",
        "-crf",         "20",
        "-x264-params", "threads=1:lookahead-threads=1:me=dia:subme=0:partitions=none:8x8dct=0",
        "-movflags",    "+faststart"};
  } else if (extension == ".webm") {
    arguments = {"-c:v", "libvpx-vp9", "-deadline", "realtime", "-cpu-used", "6",
                 "-crf", "30",         "-b:v",      "0",        "-threads",  "1"};
  } else if (extension == ".apng") {
    return {"-f", "apng", "-plays", "0", "-pred", "mixed"};
  } else if (extension == ".gif") {
    return {"-vf",
            "split[a][b];[a]palettegen=stats_mode=single[p];"
            "[b][p]paletteuse=new=1:dither=bayer:bayer_scale=4"};
  } else {
    fail(ErrorCode::usage, {path.string()},
         "the format '" + extension +
             "' is not possible; give .mp4, .webm, .gif, .apng, .png or .glb, or "
             "a folder for PNG frames");
  }
  arguments.insert(arguments.end(), kVideoColor.begin(), kVideoColor.end());
  return arguments;
}

Arguments all_arguments(const std::filesystem::path& path, int width, int height, double fps) {
  Arguments all = {"-nostdin",
                   "-hide_banner",
                   "-loglevel",
                   "error",
                   "-y",
                   "-f",
                   "rawvideo",
                   "-pix_fmt",
                   is_video(path) ? "yuv420p" : "rgb24",
                   "-s:v",
                   std::to_string(width) + "x" + std::to_string(height),
                   "-framerate",
                   text::exact(fps),
                   "-i",
                   "pipe:0",
                   "-an",
                   "-filter_threads",
                   "1"};
  const Arguments format = format_arguments(path, width, height);
  all.insert(all.end(), format.begin(), format.end());
  for (const char* word : {"-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact"})
    all.emplace_back(word);
  // With this prefix, a path that begins with a dash or contains a colon is still a file.
  all.push_back("file:" + path.string());
  return all;
}

}  // namespace

void require_encoder(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::string folders = path ? path : "/usr/bin:/bin";  // as in execvp() if PATH is not set
  for (size_t begin = 0; begin <= folders.size();) {
    const size_t end = std::min(folders.find(':', begin), folders.size());
    const std::string folder = folders.substr(begin, end - begin);
    std::error_code ignored;
    const std::string file = (folder.empty() ? "." : folder) + "/" + program;
    if (access(file.c_str(), X_OK) == 0 && !std::filesystem::is_directory(file, ignored)) return;
    begin = end + 1;
  }
  fail(ErrorCode::bad_file, "the program '" + program +
                                "', which makes the clip, is not in any folder of PATH; install "
                                "ffmpeg, or do not ask for pictures");
}

ClipEncoder::ClipEncoder(const std::filesystem::path& path, int width, int height, double fps,
                         const std::string& program, std::function<void()> alive)
    : path_(path), program_(program), width_(width), height_(height), alive_(std::move(alive)) {
  ChildStart start{.program = program, .arguments = all_arguments(path, width, height, fps)};
  for (char** variable = environ; *variable; ++variable) start.environment.emplace_back(*variable);
  // This is a socket instead of a pipe: a write to a dead process then returns an error instead of
  // raising a signal.
  int ends[2] = {-1, -1};
  const bool paired = socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0;
  const int made = paired ? memfd_create("encoder", MFD_CLOEXEC) : -1;
  const int reserved = STDERR_FILENO + 1;  // above the standard streams, which may be closed
  start.input = fcntl(ends[1], F_DUPFD_CLOEXEC, reserved);
  log_ = start.errors = fcntl(made, F_DUPFD_CLOEXEC, reserved);
  pipe_ = ends[0];
  if (start.input >= 0 && log_ >= 0) process_ = start_child(start);
  const int reason = errno;
  for (const int file : {ends[1], made, start.input})
    if (file >= 0) close(file);
  if (process_ > 0) {
    fcntl(pipe_, F_SETFL, O_NONBLOCK);
    return;
  }
  for (const int file : {pipe_, log_})
    if (file >= 0) close(file);
  fail(ErrorCode::bad_file, {path.string()},
       "the program '" + program + "' cannot be started (" + std::strerror(reason) +
           "); install ffmpeg, or write PNG frames into a folder instead");
}

ClipEncoder::~ClipEncoder() {
  if (process_ > 0) {
    kill(-process_, SIGKILL);
    alive_ = {};
    wait();
  }
  if (pipe_ >= 0) close(pipe_);
  if (log_ >= 0) close(log_);
}

// Closes the connection and returns how the process has ended.
int ClipEncoder::wait() {
  if (pipe_ >= 0) close(pipe_);
  pipe_ = -1;
  int status = 0;
  while (process_ > 0) {
    const pid_t ended = waitpid(process_, &status, alive_ ? WNOHANG : 0);
    if (ended == process_ || (ended < 0 && errno != EINTR)) break;
    if (!alive_) continue;
    alive_();
    std::this_thread::sleep_for(kPause);
  }
  process_ = -1;
  return status;
}

void ClipEncoder::wait_until_ready() {
  pollfd waiting = {pipe_, POLLOUT, 0};
  while (poll(&waiting, 1, static_cast<int>(kPatience.count())) == 0 || (waiting.revents == 0))
    if (alive_) alive_();
}

void ClipEncoder::fail_with_log() {
  wait();
  std::string words(4096, '\0');
  const off_t size = std::max<off_t>(0, lseek(log_, 0, SEEK_END));
  const ssize_t got = pread(log_, words.data(), words.size(),
                            std::max<off_t>(0, size - static_cast<off_t>(words.size())));
  words.resize(static_cast<size_t>(std::max<ssize_t>(0, got)));
  while (!words.empty() && std::isspace(static_cast<unsigned char>(words.back()))) words.pop_back();
  const size_t line = words.size() > 400 ? words.find('\n', words.size() - 400) : std::string::npos;
  if (line != std::string::npos) words.erase(0, line + 1);
  fail(ErrorCode::bad_file, {path_.string()},
       program_ +
           " could not write the clip: " + (words.empty() ? "the program gave no reason" : words));
}

void ClipEncoder::add(const Image& frame) {
  require(frame.width == width_ && frame.height == height_, "frames of one clip differ in size");
  if (is_video(path_)) to_yuv420(frame, planes_);
  const std::vector<std::uint8_t>& bytes = is_video(path_) ? planes_ : frame.rgb;
  const std::uint8_t* data = bytes.data();
  size_t left = bytes.size();
  while (left > 0) {
    const ssize_t sent = send(pipe_, data, left, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && errno == EAGAIN) {
      wait_until_ready();
      continue;
    }
    if (sent <= 0) fail_with_log();
    data += sent;
    left -= static_cast<size_t>(sent);
  }
}

void ClipEncoder::finish() {
  const int status = wait();
  // Some versions report that the disk is full, and still end with exit code 0.
  const bool silent = lseek(log_, 0, SEEK_END) <= 0;
  if (!silent || !WIFEXITED(status) || WEXITSTATUS(status) != 0) fail_with_log();
}

}  // namespace ayumi
