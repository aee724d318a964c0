#include <CLI/CLI.hpp>
#include <algorithm>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "commands.hpp"

namespace ayumi::app {

namespace {

// The names of the words that can stand after a command or a kind of it.
std::vector<std::string> subcommand_names(const CLI::App& level) {
  std::vector<std::string> names;
  for (const CLI::App* command : level.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

// Prints the same text as `ayumi COMMAND --help`.
void print_help(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* level = &app;
  std::string before = "ayumi";
  for (const std::string& word : words) {
    const std::vector<std::string> names = subcommand_names(*level);
    if (std::find(names.begin(), names.end(), word) == names.end()) {
      std::string hint = text::suggestion(word, names);
      for (const std::string& name : names) {
        const std::vector<std::string> below = subcommand_names(*level->get_subcommand(name));
        if (std::find(below.begin(), below.end(), word) != below.end())
          hint = "; did you mean '" + name + " " + word + "'?";
      }
      fail(ErrorCode::usage, "help: " + before + " has no command '" + word + "'" + hint);
    }
    level = level->get_subcommand(word);
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
