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

/// What a change would leave, such as "no error would remain" or "2 of 4 errors would remain".
template <class Count>
std::string remaining(Count left, Count all, const std::string& noun) {
  return (left == 0 ? "no " + noun : std::to_string(left) + " of " + counted(all, noun)) +
         " would remain";
}

}  // namespace ayumi::text
