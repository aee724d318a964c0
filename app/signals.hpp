#pragma once

namespace ayumi::app {

/// Definition: 128 and the number of SIGINT, as shells say that Ctrl-C has ended a program.
constexpr int kStoppedExitCode = 130;

/// From now on Ctrl-C (and SIGTERM) asks for a stop instead of ending the process. The process ends
/// with the second one, or where its work has not stopped within 0.7 s.
void watch_for_stop();

/// Whether Ctrl-C was pressed.
bool stop_requested();

}  // namespace ayumi::app
