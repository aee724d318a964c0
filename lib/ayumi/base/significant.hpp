#pragma once
// Numbers with few digits, for people.

#include <charconv>
#include <string>

#include "ayumi/base/text.hpp"

namespace ayumi::text {

/// As brief(), but a large number has no exponent, such as "114000" for 114213 with three digits.
inline std::string significant(double value, int digits) {
  const std::string words = brief(value, digits);
  if (words.find("e+") == std::string::npos) return words;
  double rounded = value;
  std::from_chars(words.data(), words.data() + words.size(), rounded);
  return fixed(rounded, 0);
}

}  // namespace ayumi::text
