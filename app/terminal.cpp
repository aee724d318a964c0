#include "terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string_view>

#include "ayumi/base/text.hpp"

namespace ayumi::app {

namespace {

bool is_terminal() {
  const char* const kind = std::getenv("TERM");
  return ::isatty(STDOUT_FILENO) && kind && *kind && std::strcmp(kind, "dumb") != 0;
}

constexpr std::string_view kPlain = "\x1b[0m";

std::string_view colour(Paint paint) {
  return paint == Paint::good ? "\x1b[32m" : paint == Paint::bad ? "\x1b[1;31m" : "\x1b[33m";
}

// The sequence of painted() with which the text begins, or nothing.
std::string_view own_sequence(std::string_view text) {
  for (const std::string_view own :
       {kPlain, colour(Paint::good), colour(Paint::bad), colour(Paint::caution)})
    if (text.starts_with(own)) return own;
  return "";
}

// The number of bytes of the colour or of the UTF-8 character that begins here.
struct Step {
  size_t bytes;
  size_t columns;
};

Step step_at(const std::string& text, size_t at) {
  if (text[at] == '\x1b')
    if (const size_t bytes = own_sequence(std::string_view(text).substr(at)).size())
      return {bytes, 0};
  constexpr unsigned char kMarked = 0xC0, kContinued = 0x80;
  size_t end = at + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & kMarked) == kContinued)
    ++end;
  return {end - at, 1};
}

// The column at which the description in a line begins, after the names and two or more blanks. In
// a line without names, it is the column at which the line begins.
size_t indent_of(const std::string& line) {
  const size_t word = std::min(line.find_first_not_of(' '), line.size());
  const size_t gap = line.rfind("  ");
  if (gap != std::string::npos && gap > word) return line.find_first_not_of(' ', gap);
  return word < line.size() && line[word] == '-' ? 6 : word;
}

// The place at which a line that is too long is broken: the end of its first part.
size_t break_of(const std::string& line, size_t indent, size_t columns) {
  const size_t last = bytes_within(line, columns);
  const size_t blank = line.rfind(' ', last), comma = line.rfind(',', last - 1);
  const bool at_blank = blank != std::string::npos && blank > indent;
  const std::string next =
      at_blank ? line.substr(blank + 1, line.find(' ', blank + 1) - blank - 1) : std::string();
  if (at_blank && columns_of(next) <= columns - indent) return blank;
  if (comma != std::string::npos && comma > indent) return comma + 1;
  return at_blank ? blank : line.find(' ', last);
}

}  // namespace

bool shows_colours() {
  const char* const refused = std::getenv("NO_COLOR");
  return is_terminal() && !(refused && *refused);
}

std::string painted(Paint paint, const std::string& words) {
  if (!shows_colours()) return words;
  return std::string(colour(paint)) + words + std::string(kPlain);
}

std::string safe_for_terminal(const std::string& text) {
  if (!shows_colours()) return text::printable(text);
  std::string shown;
  for (size_t begin = 0; begin < text.size();) {
    const size_t escape = std::min(text.find('\x1b', begin), text.size());
    shown += text::printable(text.substr(begin, escape - begin));
    if (escape == text.size()) break;
    const std::string_view own = own_sequence(std::string_view(text).substr(escape));
    shown += own.empty() ? text::printable("\x1b") : std::string(own);
    begin = escape + std::max<size_t>(1, own.size());
  }
  return shown;
}

size_t terminal_columns() {
  const char* const stated = std::getenv("COLUMNS");
  const std::string_view word = stated ? stated : "";
  size_t columns = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), columns);
  if (error == std::errc() && end == word.data() + word.size() && columns > 0) return columns;
  winsize size{};
  return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

size_t columns_of(const std::string& text) {
  size_t columns = 0;
  for (size_t at = 0; at < text.size();) {
    const Step step = step_at(text, at);
    columns += step.columns;
    at += step.bytes;
  }
  return columns;
}

size_t bytes_within(const std::string& text, size_t columns) {
  size_t at = 0;
  while (at < text.size()) {
    const Step step = step_at(text, at);
    if (step.columns > columns) break;
    columns -= step.columns;
    at += step.bytes;
  }
  return at;
}

std::string broken_line(std::string line, size_t indent, size_t columns) {
  // Smallest width of a description beside the names [characters]. Chosen: a description needs this
  // much room.
  constexpr size_t kLeastRoom = 20;
  if (columns == 0) return line;
  indent = std::min(indent, columns > kLeastRoom ? columns - kLeastRoom : 0);
  std::string broken;
  while (columns_of(line) > columns) {
    const size_t end = break_of(line, indent, columns);
    if (end == std::string::npos) break;
    broken += line.substr(0, line.find_last_not_of(' ', end - 1) + 1) + "\n";
    line = std::string(indent, ' ') + line.substr(line[end] == ' ' ? end + 1 : end);
  }
  return broken + line;
}

std::string broken_at(const std::string& text, size_t columns) {
  if (columns == 0) return text;
  std::string broken;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    broken +=
        (line.starts_with("  ayumi ") ? line : broken_line(line, indent_of(line), columns)) + "\n";
  return broken;
}

std::string padded(std::string text, size_t width) {
  text.resize(std::max(text.size(), width), ' ');
  return text;
}

std::string shortened(const std::string& message, size_t most) {
  if (message.size() <= most) return message;
  const auto whole = [&](size_t at) {  // the cut is not inside a character of UTF-8
    while ((static_cast<unsigned char>(message[at]) & 0xc0) == 0x80 && at + 1 < message.size())
      ++at;
    return at;
  };
  const size_t begin = whole(most / 2), end = whole(message.size() - most / 2);
  return message.substr(0, begin) + " ... (" + std::to_string(end - begin) + " bytes more) ... " +
         message.substr(end);
}

void complain(const std::string& message) {
  std::fprintf(stderr, "ayumi: %s\n", text::printable(shortened(message, kLongestMessage)).c_str());
}

void clear_screen() {
  if (is_terminal()) std::fputs("\x1b[H\x1b[2J\x1b[3J", stdout);
}

}  // namespace ayumi::app
