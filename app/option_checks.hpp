#pragma once
// Checks of option values beyond those of CLI11.

#include <string>
#include <vector>

#include "ayumi/base/bounds.hpp"
#include "options.hpp"

namespace ayumi::app {

/// Accepts a number from `least` to `most`. CLI::Range would accept nan.
ValueCheck number_within(double least, double most);
inline ValueCheck number_within(const Bounds& b) { return number_within(b.least, b.most); }

/// Accepts a whole number from `least` to `most`.
ValueCheck whole_number_within(int least, int most);
inline ValueCheck whole_number_within(const Bounds& b) {
  return whole_number_within(static_cast<int>(b.least), static_cast<int>(b.most));
}

/// Accepts a whole number from 0 to 2^64 - 1 that does not begin with 0. CLI11 alone takes -1 and
/// 2^64 for the largest one, and reads 010 as an octal number.
ValueCheck seed_number();

/// Accepts one of these words. The message of CLI::IsMember would have braces.
ValueCheck one_of(const std::vector<std::string>& words);
/// Accepts the name of a file, of a command that also has these subcommands. A single word without
/// a dot that names no file is refused, because it is a mistyped subcommand.
ValueCheck file_or_subcommand(const std::vector<std::string>& subcommands);

/// The words of the one_of() that checks the option; empty if it has no such check.
std::vector<std::string> choices_of(const CLI::Option& option);

}  // namespace ayumi::app
