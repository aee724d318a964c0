#pragma once

namespace ayumi::app {

/// From now on Ctrl-C (and SIGTERM) asks for a stop instead of ending the process; the second time
/// it ends it.
void watch_for_stop();

/// Whether Ctrl-C was pressed.
bool stop_requested();

}  // namespace ayumi::app
