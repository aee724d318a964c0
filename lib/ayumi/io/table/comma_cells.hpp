#pragma once
// Lines and comma-separated cells of a text, as views into it; blanks around them are left out.

#include <algorithm>
#include <string_view>
#include <vector>

namespace ayumi {

/// The end of a message about a list with more numbers than it should have.
inline constexpr const char* kDecimalCommas =
    "; if the commas are decimal commas, write decimal points";

inline std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

/// The first line of `rest`, trimmed; `rest` then begins after it.
inline std::string_view take_line(std::string_view& rest) {
  const size_t end = std::min(rest.find('\n'), rest.size());
  const std::string_view line = trimmed(rest.substr(0, end));
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return line;
}

/// Calls use(cell) for every cell of the line.
template <typename Use>
void for_each_cell(std::string_view line, const Use& use) {
  while (true) {
    const size_t comma = line.find(',');
    use(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

inline std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for_each_cell(line, [&](std::string_view cell) { cells.push_back(cell); });
  return cells;
}

}  // namespace ayumi
