#pragma once
// The text of --help: the usual course of work as one screen, and for each command its examples
// first.

#include <CLI/CLI.hpp>
#include <string>

namespace ayumi::app {

/// The footer of a command, which contains its examples. A subcommand without a footer of its own
/// gets the examples of its command that call the subcommand, or the whole footer if there are
/// none.
std::string examples_of(const CLI::App& app);

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
};

}  // namespace ayumi::app
