#pragma once
// The text of --help: the usual course of work as one screen, and for each command its examples
// first. Also what is proposed in place of an unknown command.

#include <CLI/CLI.hpp>
#include <string>

namespace ayumi::app {

/// The footer of a command, which contains its examples. A subcommand without a footer of its own
/// gets the examples of its command that call the subcommand, or the whole footer if there are
/// none.
std::string examples_of(const CLI::App& app);

/// The text "; did you mean 'x'?" for a word that is no subcommand of `level`: its nearest
/// subcommand, or else the subcommands of its subcommands with this name, each with the words
/// before it, such as 'edit mirror' or 'posture mirror'. Otherwise "".
std::string subcommand_suggestion(const CLI::App& level, const std::string& word);

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
};

}  // namespace ayumi::app
