#include "help.hpp"

#include <CLI/CLI.hpp>

#include "ayumi/base/error.hpp"
#include "commands.hpp"

namespace ayumi::app {

namespace {

// Prints the same text as `ayumi COMMAND --help`.
void print_help(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* level = &app;
  std::string before = "ayumi";
  for (const std::string& word : words) {
    const auto named = level->get_subcommands(
        [&word](const CLI::App* command) { return command->get_name() == word; });
    if (named.empty())
      fail(ErrorCode::usage, "help: " + before + " has no command '" + word + "'" +
                                 subcommand_suggestion(*level, word));
    level = named.front();
    before += " " + word;
  }
  // App::help() of the program would print the help of the running command, which is this one.
  std::fputs(level->get_formatter()->make_help(level, before, CLI::AppFormatMode::Normal).c_str(),
             stdout);
}

}  // namespace

void add_help(Command& app, Context&) {
  Command* command = app.add_subcommand("help", "print the help of a command");
  command->footer("Examples:\n  ayumi help check\n  ayumi help new walk");
  static std::vector<std::string> words;
  command->add_option("COMMAND", words,
                      "Name of a command, and of one of its subcommands if the command has any.");
  command->callback([&app] { print_help(app.cli11(), words); });
}

}  // namespace ayumi::app
