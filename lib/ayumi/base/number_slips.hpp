#pragma once
// Guesses what a person may have meant by a mistyped number. Messages name these numbers.

#include <string>
#include <vector>

#include "ayumi/base/text.hpp"

namespace ayumi {

/// The guesses assume one of these mistakes: the decimal point is one or two places too far to the
/// right or one place too far to the left; the number is in thousandths of its unit; two
/// neighbouring digits are exchanged; there is a superfluous zero after the point ("2.03" for
/// "2.3"). The number itself is never among the results.
inline std::vector<double> number_slips(double value) {
  std::vector<double> slips = {value / 1000, value / 100, value / 10, value * 10};
  const std::string digits = text::exact(value);
  if (digits.find_first_of("en") != std::string::npos) return slips;  // "1e-09", "nan"
  for (size_t i = 0; i + 1 < digits.size(); ++i) {
    const size_t j = digits[i + 1] == '.' ? i + 2 : i + 1;
    if (digits[i] == '-' || digits[i] == '.' || j >= digits.size() || digits[i] == digits[j])
      continue;
    std::string other = digits;
    std::swap(other[i], other[j]);
    slips.push_back(std::stod(other));
  }
  for (size_t i = digits.find('.'); i != std::string::npos && i + 2 < digits.size(); ++i)
    if (digits[i + 1] == '0') {
      std::string other = digits;
      other.erase(i + 1, 1);
      slips.push_back(std::stod(other));
    }
  return slips;
}

}  // namespace ayumi
