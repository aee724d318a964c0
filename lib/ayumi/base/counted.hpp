#pragma once
// Numbers with their nouns in the right form.

#include <string>

namespace ayumi::text {

/// A number with its noun, such as "1 row" or "2 rows". If no plural is given, it is the noun with
/// an s.
template <class Count>
std::string counted(Count count, const std::string& noun, const std::string& plural = "") {
  return std::to_string(count) + " " + (count == 1 ? noun : plural.empty() ? noun + "s" : plural);
}

/// A text such as "no error remains", "1 of 4 errors remains" or "2 of 4 errors remain".
template <class Count>
std::string remaining(Count left, Count all, const std::string& noun) {
  if (left == 0) return "no " + noun + " remains";
  return std::to_string(left) + " of " + counted(all, noun) + (left == 1 ? " remains" : " remain");
}

}  // namespace ayumi::text
