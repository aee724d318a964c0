#pragma once
// Shortens text that has to fit into a picture.

#include <string>

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

}  // namespace ayumi::text
