#pragma once
// Places in JSON documents as JSON pointers (RFC 6901).

#include <string>

namespace ayumi {

/// A key in the form that it has in a JSON pointer.
inline std::string json_pointer_token(const std::string& key) {
  std::string text;
  for (const char c : key) text += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return text;
}

}  // namespace ayumi
