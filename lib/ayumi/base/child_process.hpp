#pragma once
// A program that runs beside this one, shares nothing with it but one connection, and can be ended
// at any time.

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace ayumi {

/// What a child process is started with.
struct ChildStart {
  std::string program;                        ///< a path, or a name that is looked up in PATH
  std::vector<std::string> arguments = {};    ///< arguments after the name of the program
  std::vector<std::string> environment = {};  ///< variables as "NAME=value"
  int input = -1;  ///< becomes the child's standard input and must be above 2
  /// Becomes the child's standard error and must be above 2; with -1, errors are discarded.
  int errors = -1;
};

/// Starts the program and returns its process id, or -1 with the reason in errno. Its standard
/// output is discarded, and no other file of this process is open in it. It is in a process group
/// of its own, so that Ctrl-C on a terminal does not reach it. The kernel ends it when the thread
/// that has started it ends, however that happens. Signals that this process blocks or ignores have
/// their usual effect in it.
pid_t start_child(const ChildStart& start);

/// The way in which a child process ended.
struct ChildEnding {
  int exit_code = -1;         ///< -1 if a signal or this process ended it
  int signal = 0;             ///< number of the signal; 0 if there was none
  bool by_us = false;         ///< the child did not end by itself and was killed
  std::string words() const;  ///< a text such as "signal 11, Segmentation fault" or "exit code 7"
};

/// A child process. Its standard input is one end of a socket on which it reads and writes; its
/// standard output and standard error are discarded; every other open file of this process is
/// closed in it. It is in a process group of its own, so that Ctrl-C on a terminal reaches only
/// this process. Signals that this process blocks or ignores have their usual effect in the child.
class ChildProcess {
 public:
  /// The outcome of an exchange of bytes.
  enum class Exchange {
    done,
    closed,   ///< the child closed the connection, usually because it has ended
    too_late  ///< the time ended first, or a stop was requested
  };

  /// Starts `program` without arguments. Its environment has the variables of this process that
  /// `environment` names, and no others. With `errors`, its standard error is that of this process.
  /// Throws Error(bad_file) with the program and the reason if it cannot be started.
  ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& environment,
               bool errors = false);
  ~ChildProcess();  ///< kills the child if it still runs
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// From now on, all exchanges together may take `seconds` [s]; after that time, they return
  /// too_late.
  void set_time(double seconds);
  /// From now on, an exchange that waits returns too_late soon after `stop` has become true.
  void set_stop(const std::atomic<bool>& stop) { stop_ = &stop; }
  Exchange send(const void* bytes, size_t size);
  /// Receives exactly `size` bytes.
  Exchange receive(void* bytes, size_t size);
  /// Closes the connection and waits at most one second for the child to end; after that the child
  /// is killed.
  ChildEnding end();

 private:
  bool wait_for(short events);

  int socket_ = -1;
  pid_t process_ = -1;
  std::chrono::steady_clock::time_point deadline_;
  const std::atomic<bool>* stop_ = nullptr;
};

}  // namespace ayumi
