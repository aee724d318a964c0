#pragma once
// Numbers with their nouns in the right form.

#include <string>

namespace ayumi::text {

/// "1 row", "2 rows"; the plural is the noun with an s where none is given.
template <class Count>
std::string counted(Count count, const std::string& noun, const std::string& plural = "") {
  return std::to_string(count) + " " + (count == 1 ? noun : plural.empty() ? noun + "s" : plural);
}

/// "no error remains", "1 of 4 errors remains", "2 of 4 errors remain".
template <class Count>
std::string remaining(Count left, Count all, const std::string& noun) {
  if (left == 0) return "no " + noun + " remains";
  return std::to_string(left) + " of " + counted(all, noun) + (left == 1 ? " remains" : " remain");
}

}  // namespace ayumi::text
