#include "terminal.hpp"

#include <unistd.h>

#include <cstdlib>
#include <cstring>

namespace ayumi::app {

namespace {

bool is_terminal() {
  const char* const kind = std::getenv("TERM");
  return ::isatty(STDOUT_FILENO) && kind && *kind && std::strcmp(kind, "dumb") != 0;
}

}  // namespace

bool shows_colours() {
  const char* const refused = std::getenv("NO_COLOR");
  return is_terminal() && !(refused && *refused);
}

std::string painted(Paint paint, const std::string& words) {
  if (!shows_colours()) return words;
  const char* const code = paint == Paint::good ? "32" : paint == Paint::bad ? "1;31" : "33";
  return std::string("\x1b[") + code + "m" + words + "\x1b[0m";
}

std::string clear_screen() { return is_terminal() ? "\x1b[H\x1b[2J\x1b[3J" : ""; }

}  // namespace ayumi::app
