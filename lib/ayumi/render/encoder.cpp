#include "ayumi/render/encoder.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/render/planar_yuv.hpp"

extern char** environ;

namespace ayumi {
namespace {

using Arguments = std::vector<std::string>;

/// What to_yuv420 makes; players assume it for video of this size.
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
    fail(ErrorCode::usage, path.string() + ": size " + std::to_string(width) + "x" +
                               std::to_string(height) + ": " + extension +
                               " needs an even width and height");
  Arguments arguments;
  if (extension == ".mp4") {
    // A finer search of motion (me, subme) costs two thirds more time for 0.4 dB and 6 % of size.
    arguments = {
        "-c:v",      "libx264",   "-preset",      "veryfast",
        "-crf",      "20",        "-x264-params", "threads=1:lookahead-threads=1:me=dia:subme=1",
        "-movflags", "+faststart"};
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
    fail(ErrorCode::usage,
         path.string() + ": the format '" + extension +
             "' is not one of .mp4, .webm, .gif, .apng, .png, .glb, or a folder for PNG "
             "frames");
  }
  arguments.insert(arguments.end(), kVideoColor.begin(), kVideoColor.end());
  return arguments;
}

Arguments all_arguments(const std::string& program, const std::filesystem::path& path, int width,
                        int height, double fps) {
  Arguments all = {program,
                   "-nostdin",
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
  // A path that begins with a dash or holds a colon is still a file.
  all.push_back("file:" + path.string());
  return all;
}

}  // namespace

ClipEncoder::ClipEncoder(const std::filesystem::path& path, int width, int height, double fps,
                         const std::string& program)
    : path_(path), program_(program), width_(width), height_(height) {
  const Arguments arguments = all_arguments(program, path, width, height, fps);
  std::vector<char*> words;
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  // A socket instead of a pipe: a write to a dead process then reports instead of raising a signal.
  int ends[2] = {-1, -1};
  require(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0,
          "a pipe to the video encoder could not be opened");
  log_ = memfd_create("encoder", MFD_CLOEXEC);
  pipe_ = ends[0];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, log_, STDERR_FILENO);
  // Its own process group: Ctrl-C reaches us alone, and we end it.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int error =
      posix_spawnp(&process_, program.c_str(), &actions, &attributes, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  close(ends[1]);
  if (error == 0) return;
  process_ = -1;
  close(pipe_);
  close(log_);
  fail(ErrorCode::bad_file, path.string() + ": the program '" + program + "' cannot be started (" +
                                std::strerror(error) +
                                "); install ffmpeg, or write PNG frames into a folder instead");
}

ClipEncoder::~ClipEncoder() {
  if (process_ > 0) kill(process_, SIGKILL);
  wait();
  if (log_ >= 0) close(log_);
}

int ClipEncoder::wait() {
  if (pipe_ >= 0) close(pipe_);
  pipe_ = -1;
  int status = 0;
  if (process_ > 0)
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
  process_ = -1;
  return status;
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
  fail(ErrorCode::bad_file, path_.string() + ": " + program_ + " could not write the clip: " +
                                (words.empty() ? "it ended without a message" : words));
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
    if (sent <= 0) fail_with_log();
    data += sent;
    left -= static_cast<size_t>(sent);
  }
}

void ClipEncoder::finish() {
  const int status = wait();
  // Some versions say that the disk is full and still end as if all were well.
  const bool silent = lseek(log_, 0, SEEK_END) <= 0;
  if (!silent || !WIFEXITED(status) || WEXITSTATUS(status) != 0) fail_with_log();
}

}  // namespace ayumi
