#pragma once
// Checks of option values beyond those of CLI11.

#include <CLI/CLI.hpp>

namespace ayumi::app {

/// A number from `least` to `most`. CLI::Range lets nan pass.
CLI::Validator number_within(double least, double most);

}  // namespace ayumi::app
