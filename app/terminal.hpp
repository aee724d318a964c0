#pragma once
// Text on a terminal: its colours, and what keeps names in files from steering it.

#include <string>

namespace ayumi::app {

enum class Paint { good, bad, caution };

/// Whether standard output is a terminal that shows colours: not for a file or a pipe, not where
/// the environment has NO_COLOR (no-color.org) or TERM=dumb.
bool shows_colours();

/// The words in a colour where standard output shows colours, else as they are.
std::string painted(Paint paint, const std::string& words);

/// The text as it may be printed: the colours of painted() stay where standard output shows them,
/// and every other control character is written out (text::printable).
std::string safe_for_terminal(const std::string& text);

/// Width of a line on standard output: the environment's COLUMNS, else the width of the terminal;
/// 0 where standard output is no terminal.
size_t terminal_columns();

/// Columns that a text takes on a terminal: colours take none, a character of several bytes one.
size_t columns_of(const std::string& text);

/// The bytes of a text that fill so many columns, or all of it.
size_t bytes_within(const std::string& text, size_t columns);

/// Text whose lines are at most `columns` long: longer ones are broken at blanks, and within words
/// that fill more than a line after a comma. What follows is indented as the description in the
/// line. Commands of examples stay whole, so that they can be pasted. 0 columns: no line is broken.
std::string broken_at(const std::string& text, size_t columns);

/// A line without its end, broken in the same way; what follows is indented by `indent` columns.
std::string broken_line(std::string line, size_t indent, size_t columns);

/// The text with blanks behind it, at least `width` bytes long.
std::string padded(std::string text, size_t width);

/// Clears the screen and its history where standard output is a terminal.
void clear_screen();

}  // namespace ayumi::app
