#include "ayumi/base/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
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

// Time given to a process to end by itself, and pause between two checks whether it has ended.
// Chosen: a process that ends by itself does so within milliseconds.
constexpr std::chrono::milliseconds kGrace(1000), kPause(1);
// Time for which an exchange waits before it checks whether it should stop [ms]. Chosen: nobody
// notices it, and it costs nothing.
constexpr long kStopPause = 50;

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

// Runs in the child, which still uses the memory of this process: it may only make system calls.
// Returns the reason why the program was not started.
int become(const char* program, char* const* words, char* const* variables, int input, int nowhere,
           int errors, pid_t parent) {
  for (int signal = 1; signal < NSIG; ++signal) {
    struct sigaction usual {};
    usual.sa_handler = SIG_DFL;
    sigaction(signal, &usual, nullptr);  // fails for signals that have their usual effect anyway
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // This process had ended before the line above was reached.
  if (getppid() != parent) return ECHILD;
  setpgid(0, 0);
  if (dup2(input, STDIN_FILENO) < 0 || dup2(nowhere, STDOUT_FILENO) < 0 ||
      dup2(errors, STDERR_FILENO) < 0)
    return errno;
  close_range(STDERR_FILENO + 1, ~0U, 0);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  execvpe(program, words, variables);
  return errno;
}

}  // namespace

std::string ChildEnding::words() const {
  if (by_us) return "the process closed its connection but kept running";
  if (signal != 0)
    return "signal " + std::to_string(signal) + ", " + std::string(strsignal(signal));
  return exit_code < 0 ? "for an unknown reason" : "exit code " + std::to_string(exit_code);
}

pid_t start_child(const ChildStart& start) {
  std::vector<std::string> words = {start.program}, variables = start.environment;
  words.insert(words.end(), start.arguments.begin(), start.arguments.end());
  const std::vector<char*> argv = pointers_to(words), envp = pointers_to(variables);
  // The descriptor is above those of the standard streams, even if one of these is closed.
  const int opened = open("/dev/null", O_RDWR | O_CLOEXEC);
  const int nowhere = opened < 0 ? -1 : fcntl(opened, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  int reason = errno;
  if (opened >= 0) close(opened);
  if (nowhere < 0) {
    errno = reason;
    return -1;
  }
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);  // no handler of this process runs in the child
  volatile int failed = 0;
  const pid_t parent = getpid();
  const pid_t child = vfork();  // a copy of the memory might be refused if this process is large
  if (child == 0) {
    failed = become(argv[0], argv.data(), envp.data(), start.input, nowhere,
                    start.errors < 0 ? nowhere : start.errors, parent);
    _exit(127);
  }
  reason = child < 0 ? errno : failed;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  close(nowhere);
  if (child > 0 && reason != 0)
    while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
  errno = reason;
  return reason == 0 ? child : -1;
}

ChildProcess::ChildProcess(const std::filesystem::path& program,
                           const std::vector<std::string>& environment, bool errors) {
  ChildStart start{.program = program.string()};
  for (const std::string& variable : environment)
    if (const char* value = std::getenv(variable.c_str()))
      start.environment.push_back(variable + "=" + value);
  const auto refuse = [&](int reason) {
    fail(ErrorCode::bad_file,
         start.program + ": the program cannot be started (" + std::strerror(reason) + ")");
  };
  int ends[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) refuse(errno);
  // The descriptor 0 of this process may be closed, and the child's end would then have the number
  // 0. A copy to the same number would keep the close-on-exec flag.
  const int connection = fcntl(ends[1], F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  const int no_copy = errno;
  close(ends[1]);
  if (connection < 0) {
    close(ends[0]);
    refuse(no_copy);
  }
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  start.input = connection;
  if (errors) start.errors = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  process_ = start_child(start);
  const int reason = errno;
  close(connection);
  if (start.errors >= 0) close(start.errors);
  if (process_ < 0) {
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
  // Longest time of exchanges [s]. Chosen: a year, which stands for no limit; the clock cannot
  // count to infinity.
  constexpr double kLongest = 3.2e7;
  deadline_ =
      steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(
                                std::chrono::duration<double>(std::clamp(seconds, 0.0, kLongest)));
}

// Returns false if the time is over.
bool ChildProcess::wait_for(short events) {
  while (true) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline_ - steady_clock::now()).count();
    if (left <= 0 || (stop_ && *stop_)) return false;
    pollfd waiting = {socket_, events, 0};
    const long longest = stop_ ? kStopPause : 1'000'000;
    const int ready = poll(&waiting, 1, static_cast<int>(std::min<long>(left, longest)));
    if (ready > 0) return true;
    // The next exchange finds the reason for the failure.
    if (ready < 0 && errno != EINTR) return true;
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
  // ended < 0 means that this program ignores SIGCHLD; then nobody knows how the child ended.
  if (ended < 0 || ending.by_us) return ending;
  if (WIFEXITED(status)) ending.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) ending.signal = WTERMSIG(status);
  return ending;
}

}  // namespace ayumi
