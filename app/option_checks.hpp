#pragma once
// Checks of option values beyond those of CLI11.

#include <string>
#include <vector>

#include "options.hpp"

namespace ayumi::app {

/// A number from `least` to `most`. CLI::Range lets nan pass.
ValueCheck number_within(double least, double most);

/// A whole number from `least` to `most`.
ValueCheck whole_number_within(int least, int most);
/// A whole number from 0 to 2^64 - 1. CLI11 alone takes -1 and 2^64 for the largest one.
ValueCheck seed_number();

/// One of these words. CLI::IsMember answers in braces.
ValueCheck one_of(const std::vector<std::string>& words);
/// The words of the one_of() by which the option is checked; none: it has no such check.
std::vector<std::string> choices_of(const CLI::Option& option);

}  // namespace ayumi::app
