#pragma once
// Sentences that are put together from parts.

#include <string>

namespace ayumi::text {

/// The first part, a full stop, and the second part with a capital letter: "r_knee is locked" and
/// "unlock it" become "r_knee is locked. Unlock it".
inline std::string two_sentences(const std::string& first, std::string second) {
  if (!second.empty() && second[0] >= 'a' && second[0] <= 'z')
    second[0] = static_cast<char>(second[0] - 'a' + 'A');
  return first + ". " + second;
}

}  // namespace ayumi::text
