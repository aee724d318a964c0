#pragma once
// Shortens text that has to fit into a picture or a message.

#include <string>
#include <string_view>

namespace ayumi::text {

/// The UTF-8 text if `fits(text)` is true; otherwise its longest beginning that fits with dots
/// behind it, or the dots alone.
template <typename Fits>
std::string shortened(std::string text, const Fits& fits) {
  const std::string dots = "…";
  if (fits(text)) return text;
  while (!text.empty() && !fits(text + dots)) {
    while ((static_cast<unsigned char>(text.back()) & 0xC0) == 0x80) text.pop_back();
    text.pop_back();
  }
  return text + dots;
}

/// The text as a message quotes it: its first 100 bytes, with dots behind them if there are more.
/// Chosen: the names and expressions of people are shorter, and a terminal shows this in two lines.
inline std::string quotable(std::string_view text) {
  constexpr size_t kMostQuoted = 100;
  if (text.size() <= kMostQuoted) return std::string(text);
  size_t end = kMostQuoted;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return std::string(text.substr(0, end)) + "…";
}

}  // namespace ayumi::text
