#pragma once

namespace ayumi::app {

/// Definition: 128 plus the number of SIGINT; shells use this code for a program that Ctrl-C has
/// ended.
constexpr int kStoppedExitCode = 130;

/// From now on, Ctrl-C (and SIGTERM) asks for a stop instead of ending the process. The process
/// ends at the second Ctrl-C, or if its work has not stopped within 0.7 s. A terminal that is
/// closed (SIGHUP) also asks for a stop. A limit on the size of files (`ulimit -f`) does not end
/// the process either: writing then fails as on a full disk.
void watch_for_signals();

/// This command normally ends by being stopped. If it is still working 0.7 s after the stop, it is
/// ended with exit code 0 and without a message.
void expect_to_be_stopped();

/// Whether Ctrl-C was pressed.
bool stop_requested();

}  // namespace ayumi::app
