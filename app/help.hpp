#pragma once
// What --help prints: the path as one screen, and for each command its examples first.

#include <CLI/CLI.hpp>
#include <string>

namespace ayumi::app {

/// The footer of a command, which holds its examples. A subcommand without a footer of its own has
/// the examples of its command that call the subcommand, or the whole footer where none does.
std::string examples_of(const CLI::App& app);

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
};

}  // namespace ayumi::app
