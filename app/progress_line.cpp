// Progress on stderr: on a terminal a bar with the remaining time, otherwise plain lines.

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>

#include "ayumi/base/text.hpp"
#include "commands.hpp"
#include "signals.hpp"

namespace ayumi::app {

namespace {

using Clock = std::chrono::steady_clock;

/// Time between two plain lines of one stage. Chosen: the log of an hour has a few hundred lines.
constexpr std::chrono::seconds kBetweenLines(10);

struct ProgressLine {
  std::mutex mutex;
  bool terminal = isatty(STDERR_FILENO) != 0;
  std::string stage;
  int shown = -1;  // the shown percentage, or tens of per cent in plain lines
  Clock::time_point begin, last;

  void show(const ProgressEvent& event) {
    const std::lock_guard lock(mutex);
    const Clock::time_point now = Clock::now();
    const bool fresh = event.stage != stage;
    if (fresh) {
      finish();
      stage = event.stage;
      shown = -1;
      begin = now;
    }
    if (terminal)
      draw(event, now);
    else if (fresh || event.detail.starts_with("iteration ") || now - last > kBetweenLines) {
      last = now;
      std::fprintf(
          stderr, "%s\n",
          text::printable(event.stage + (event.detail.empty() ? "" : ": ") + event.detail).c_str());
    }
    if (event.fraction >= 1) finish();
  }

  void draw(const ProgressEvent& event, Clock::time_point now) {
    const int percent = static_cast<int>(100 * std::clamp(event.fraction, 0.0, 1.0));
    if (percent == shown && now - last < std::chrono::milliseconds(200)) return;
    shown = percent;
    last = now;
    const double spent = std::chrono::duration<double>(now - begin).count();
    std::string bar(20, ' ');
    std::fill_n(bar.begin(), percent / 5, '#');
    std::string line = stage;
    if (event.fraction >= 0) line += " [" + bar + "] " + std::to_string(percent) + " %";
    if (event.fraction > 0.02 && event.fraction < 1 && spent > 0.5)
      line += ", " + text::fixed(spent * (1 / event.fraction - 1), 0) + " s left";
    if (!event.detail.empty()) line += "  " + event.detail;
    std::fprintf(stderr, "\r%s\033[K", text::printable(line).c_str());
    std::fflush(stderr);
  }

  void finish() {
    if (terminal && !stage.empty()) std::fputc('\n', stderr);
    stage.clear();
  }

  ~ProgressLine() { finish(); }
};

}  // namespace

Progress Context::progress() const {
  if (quiet) return [](const ProgressEvent&) { return !stop_requested(); };
  auto line = std::make_shared<ProgressLine>();
  return [line](const ProgressEvent& event) {
    line->show(event);
    return !stop_requested();
  };
}

}  // namespace ayumi::app
