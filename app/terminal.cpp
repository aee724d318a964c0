#include "terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
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

// The sequence of painted() that the text begins with, or nothing.
std::string_view own_sequence(std::string_view text) {
  for (const std::string_view own :
       {kPlain, colour(Paint::good), colour(Paint::bad), colour(Paint::caution)})
    if (text.starts_with(own)) return own;
  return "";
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

void clear_screen() {
  if (is_terminal()) std::fputs("\x1b[H\x1b[2J\x1b[3J", stdout);
}

}  // namespace ayumi::app
