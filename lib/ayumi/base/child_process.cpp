#include "ayumi/base/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "ayumi/base/error.hpp"

namespace ayumi {

namespace {

using std::chrono::steady_clock;

// Chosen: a process that ends by itself does so within milliseconds.
constexpr std::chrono::milliseconds kGrace(1000), kPause(1);

// What posix_spawn does in the child, and how the child starts.
class SpawnPlan {
 public:
  SpawnPlan(int connection, bool errors) {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, connection, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (!errors)
      posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
    posix_spawnattr_init(&attributes);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(
        &attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnPlan() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
};

}  // namespace

std::string ChildEnding::words() const {
  if (by_us) return "it closed its connection and did not end";
  if (signal != 0)
    return "signal " + std::to_string(signal) + ", " + std::string(strsignal(signal));
  return exit_code < 0 ? "for an unknown reason" : "exit code " + std::to_string(exit_code);
}

ChildProcess::ChildProcess(const std::filesystem::path& program,
                           const std::vector<std::string>& environment, bool errors) {
  std::vector<std::string> variables;
  for (const std::string& name : environment)
    if (const char* value = std::getenv(name.c_str())) variables.push_back(name + "=" + value);
  std::vector<char*> kept;
  for (std::string& variable : variables) kept.push_back(variable.data());
  kept.push_back(nullptr);
  std::string name = program.string();
  char* words[] = {name.data(), nullptr};

  const auto refuse = [&](int reason) {
    fail(ErrorCode::bad_file, name + ": cannot be started (" + std::strerror(reason) + ")");
  };
  int ends[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) refuse(errno);
  // The descriptor 0 of this process may be closed, and the child's end then have that number: the
  // copy to it would keep the mark that closes it.
  const int connection = fcntl(ends[1], F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  const int no_copy = errno;
  close(ends[1]);
  if (connection < 0) {
    close(ends[0]);
    refuse(no_copy);
  }
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  const SpawnPlan plan(connection, errors);
  const int reason =
      posix_spawn(&process_, name.c_str(), &plan.actions, &plan.attributes, words, kept.data());
  close(connection);
  if (reason != 0) {
    close(ends[0]);
    refuse(reason);
  }
  socket_ = ends[0];
  set_time(HUGE_VAL);
}

ChildProcess::~ChildProcess() {
  if (process_ > 0) kill(-process_, SIGKILL);
  end();
}

void ChildProcess::set_time(double seconds) {
  // Chosen: a year, where no limit is wanted; the clock cannot count to infinity.
  constexpr double kLongest = 3.2e7;
  deadline_ =
      steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(
                                std::chrono::duration<double>(std::clamp(seconds, 0.0, kLongest)));
}

// False: the time is over.
bool ChildProcess::wait_for(short events) {
  while (true) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline_ - steady_clock::now()).count();
    if (left <= 0) return false;
    pollfd waiting = {socket_, events, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(std::min<long>(left, 1'000'000)));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return true;  // the next exchange finds the reason
  }
}

ChildProcess::Exchange ChildProcess::send(const void* bytes, size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t sent = ::send(socket_, at, size, MSG_NOSIGNAL);
    if (sent > 0) {
      at += sent;
      size -= static_cast<size_t>(sent);
    } else if (sent < 0 && errno == EAGAIN) {
      if (!wait_for(POLLOUT)) return Exchange::too_late;
    } else if (sent == 0 || errno != EINTR) {
      return Exchange::closed;
    }
  }
  return Exchange::done;
}

ChildProcess::Exchange ChildProcess::receive(void* bytes, size_t size) {
  char* at = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t got = recv(socket_, at, size, 0);
    if (got > 0) {
      at += got;
      size -= static_cast<size_t>(got);
    } else if (got < 0 && errno == EAGAIN) {
      if (!wait_for(POLLIN)) return Exchange::too_late;
    } else if (got == 0 || errno != EINTR) {
      return Exchange::closed;
    }
  }
  return Exchange::done;
}

ChildEnding ChildProcess::end() {
  ChildEnding ending;
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
  if (process_ <= 0) return ending;
  int status = 0;
  pid_t ended = 0;
  const auto until = steady_clock::now() + kGrace;
  while ((ended = waitpid(process_, &status, WNOHANG)) == 0 || (ended < 0 && errno == EINTR)) {
    if (!ending.by_us && steady_clock::now() >= until) {
      ending.by_us = true;
      kill(-process_, SIGKILL);
    }
    std::this_thread::sleep_for(kPause);
  }
  process_ = -1;
  // ended < 0: this program ignores SIGCHLD, so nobody knows how the child ended.
  if (ended < 0 || ending.by_us) return ending;
  if (WIFEXITED(status)) ending.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) ending.signal = WTERMSIG(status);
  return ending;
}

}  // namespace ayumi
