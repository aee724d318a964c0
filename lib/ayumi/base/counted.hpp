#pragma once
// A number with its noun in the right form.

#include <string>

namespace ayumi::text {

/// "1 row", "2 rows"; the plural is the noun with an s where none is given.
template <class Count>
std::string counted(Count count, const std::string& noun, const std::string& plural = "") {
  return std::to_string(count) + " " + (count == 1 ? noun : plural.empty() ? noun + "s" : plural);
}

}  // namespace ayumi::text
