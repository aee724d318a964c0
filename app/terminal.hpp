#pragma once
// Colours on a terminal.

#include <string>

namespace ayumi::app {

enum class Paint { good, bad, caution };

/// Whether standard output is a terminal that shows colours: not for a file or a pipe, not where
/// the environment has NO_COLOR (no-color.org) or TERM=dumb.
bool shows_colours();

/// The words in a colour where standard output shows colours, else as they are.
std::string painted(Paint paint, const std::string& words);

/// Clears the screen and its history where standard output is a terminal.
std::string clear_screen();

}  // namespace ayumi::app
