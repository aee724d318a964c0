#include "signals.hpp"

#include <unistd.h>

#include <csignal>
#include <ctime>

#include "ayumi/base/unfinished_files.hpp"

namespace ayumi::app {

namespace {

// Time in which work has to stop. Chosen: work asks several times per second whether it may
// continue. Work that does not ask, such as a computing library, is ended well within a second of
// Ctrl-C.
constexpr long kPatience = 700'000'000;  // longest wait for the work to stop [ns]

volatile std::sig_atomic_t stop_signal = 0;
timer_t impatience;
bool has_timer = false;
volatile std::sig_atomic_t is_stop_expected = 0;

void on_signal(int signal) {
  // The shell and the system both send SIGHUP when a terminal is closed, so a second SIGHUP is no
  // wish to end at once. A second one of any other signal is.
  const bool is_second = stop_signal == signal && signal != SIGHUP;
  stop_signal = signal;
  if (signal == SIGHUP) std::signal(signal, SIG_IGN);
  if (is_second) {
    remove_unfinished();
    std::signal(signal, SIG_DFL);
    std::raise(signal);  // it ends the process when this function returns
    return;
  }
  const itimerspec once = {{0, 0}, {0, kPatience}};
  if (has_timer) timer_settime(impatience, 0, &once, nullptr);
}

// Runs if the work has not stopped in time after Ctrl-C. No result is lost: a file is renamed to
// its final name only when it is complete, and child processes end with this process.
void on_impatience(int) {
  remove_unfinished();
  if (is_stop_expected) _exit(0);
  constexpr char kMessage[] = "ayumi: stopped\n";
  static_cast<void>(!write(STDERR_FILENO, kMessage, sizeof kMessage - 1));
  _exit(kStoppedExitCode);
}

// None of the handlers interrupts another one, because a second removal of files would end the
// first one half-way.
void handle(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  for (const int other : {SIGALRM, SIGINT, SIGTERM, SIGHUP}) sigaddset(&action.sa_mask, other);
  sigaction(signal, &action, nullptr);
}

}  // namespace

void watch_for_signals() {
  sigevent event = {};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGALRM;
  handle(SIGALRM, on_impatience);
  has_timer = timer_create(CLOCK_MONOTONIC, &event, &impatience) == 0;
  handle(SIGINT, on_signal);
  handle(SIGTERM, on_signal);
  // A closed terminal stops the work as Ctrl-C does, unless nohup has made the program ignore it.
  if (std::signal(SIGHUP, SIG_IGN) != SIG_IGN) handle(SIGHUP, on_signal);
  std::signal(SIGXFSZ, SIG_IGN);
}

void expect_to_be_stopped() { is_stop_expected = 1; }

bool stop_requested() { return stop_signal != 0; }

}  // namespace ayumi::app
