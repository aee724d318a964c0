#pragma once
// Functions for text on a terminal: its colours, and a filter that keeps names in files from
// controlling the terminal.

#include <string>

namespace ayumi::app {

enum class Paint { good, bad, caution };

/// Whether standard output is a terminal that shows colours. False for a file or a pipe, and if the
/// environment has NO_COLOR (no-color.org) or TERM=dumb.
bool shows_colours();

/// The words in a colour if standard output shows colours, otherwise unchanged.
std::string painted(Paint paint, const std::string& words);

/// The text in a form that can be printed safely. The colours of painted() are kept if standard
/// output shows them; every other control character is written out (text::printable).
std::string safe_for_terminal(const std::string& text);

/// Width of a line on standard output: COLUMNS in the environment, or else the width of the
/// terminal; 0 if standard output is not a terminal.
size_t terminal_columns();

/// The number of columns that a text takes on a terminal: a colour takes none, a character of
/// several bytes takes one.
size_t columns_of(const std::string& text);

/// The number of bytes of a text that fill this many columns, or of all of it.
size_t bytes_within(const std::string& text, size_t columns);

/// The text in lines of at most `columns` columns. Longer lines are broken at blanks; words that
/// fill more than a line are broken after a comma. The rest of a line is indented like its
/// description. Commands in examples stay whole, so that they can be pasted. With 0 columns, no
/// line is broken.
std::string broken_at(const std::string& text, size_t columns);

/// A line without its end, broken in the same way; its rest is indented by `indent` columns.
std::string broken_line(std::string line, size_t indent, size_t columns);

/// The text with blanks after it, so that it has at least `width` bytes.
std::string padded(std::string text, size_t width);

/// Largest length of a message [bytes]. Chosen: a screen of 25 lines.
inline constexpr size_t kLongestMessage = 2000;

/// A message without its middle, if it contains long words of a file, such as a name of a megabyte,
/// and therefore has more than `most` bytes.
std::string shortened(const std::string& message, size_t most);

/// Prints a message on standard error, shortened to kLongestMessage.
void complain(const std::string& message);

/// Clears the screen and its history if standard output is a terminal.
void clear_screen();

}  // namespace ayumi::app
