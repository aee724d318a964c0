#pragma once
// How deep arrays and objects of a JSON text may be nested. The library that reads JSON reads any
// depth, but copies, compares and writes by recursion, so a text that is nested deeply enough ends
// the program where its value is used. Every reader of JSON refuses such a text first.

#include <cstddef>
#include <optional>
#include <string>

namespace ayumi {

// Nested arrays and objects. Chosen: Ayumi's files need ten; functions that descend by recursion
// need less than 1 kB of the 8 MB stack for each.
inline constexpr int kDeepestNesting = 200;

/// Where the text opens the first array or object that lies too deep; nothing where none does.
/// Use it alone only for texts without comments: brackets and quotes in comments count as well.
inline std::optional<size_t> nested_too_deep(const std::string& bytes) {
  int depth = 0;
  bool in_string = false;
  for (size_t i = 0; i < bytes.size(); ++i) {
    if (in_string && bytes[i] == '\\')
      ++i;
    else if (bytes[i] == '"')
      in_string = !in_string;
    else if (in_string)
      continue;
    else if (bytes[i] == '[' || bytes[i] == '{') {
      if (++depth > kDeepestNesting) return i;
    } else if (bytes[i] == ']' || bytes[i] == '}')
      --depth;
  }
  return {};
}

}  // namespace ayumi
