#pragma once
// Limits the depth to which arrays and objects of a JSON text may be nested. The library that reads
// JSON accepts any depth, but it copies, compares and writes by recursion. If a text is nested too
// deeply, the use of its value would overflow the stack and end the program. So every reader of
// JSON refuses such a text first.

#include <cstddef>
#include <optional>
#include <string>

namespace ayumi {

// Largest number of arrays and objects inside each other. Chosen: Ayumi's files need ten; functions
// that descend by recursion need less than 1 kB of the 8 MB stack for each.
inline constexpr int kDeepestNesting = 200;

/// The place at which the text opens the first array or object that is nested too deeply; nothing
/// if there is none. Strings and comments are skipped.
inline std::optional<size_t> nested_too_deep(const std::string& bytes) {
  int depth = 0;
  bool in_string = false;
  for (size_t i = 0; i < bytes.size(); ++i) {
    const char c = bytes[i];
    if (in_string) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '/' && i + 1 < bytes.size() && (bytes[i + 1] == '/' || bytes[i + 1] == '*')) {
      const bool line = bytes[i + 1] == '/';
      const size_t end = bytes.find(line ? "\n" : "*/", i + 2);
      if (end == std::string::npos) return {};
      i = line ? end : end + 1;
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepestNesting) return i;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return {};
}

/// The value of a JSON text whose form is not certain, as Json or OrderedJson. It is a discarded
/// value if the text is not JSON or is nested too deeply. A discarded value has no members: reading
/// one throws an exception of the library, as for a value of the wrong type.
template <typename Value>
Value shallow_json(const std::string& bytes, bool with_comments = false) {
  if (nested_too_deep(bytes)) return Value(Value::value_t::discarded);
  return Value::parse(bytes, nullptr, false, with_comments);
}

}  // namespace ayumi
