#pragma once

namespace ayumi::app {

/// Definition: 128 and the number of SIGINT, as shells say that Ctrl-C has ended a program.
constexpr int kStoppedExitCode = 130;

/// From now on Ctrl-C (and SIGTERM) asks for a stop instead of ending the process. The process ends
/// with the second one, or where its work has not stopped within 0.7 s. A limit on the size of
/// files
/// (`ulimit -f`) does not end the process either: writing fails there as on a full disk.
void watch_for_signals();

/// A stop is how this command ends: what is still at work 0.7 s after it is ended with exit code 0
/// and without a message.
void expect_to_be_stopped();

/// Whether Ctrl-C was pressed.
bool stop_requested();

}  // namespace ayumi::app
