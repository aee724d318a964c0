#include "help.hpp"

#include <algorithm>
#include <sstream>

#include "terminal.hpp"

namespace ayumi::app {

namespace {

std::string overview(const CLI::App& app) {
  std::string text =
      "Ayumi checks, stabilizes and exports motion patterns of humanoid robots.\n\n"
      "  robot + pattern -> check -> repair -> simulate -> tables, clips, report\n\n"
      "Usage: ayumi COMMAND ...     Options and examples of a command: ayumi COMMAND --help\n\n";
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    std::string line = "  " + command->get_name();
    line.resize(std::max<size_t>(line.size() + 1, 14), ' ');
    text += line + command->get_description() + "\n";
  }
  text += "\nOptions of every command:\n";
  for (const CLI::Option* option : app.get_options()) {
    // CLI11 has no public name for an option that is not listed in the help of commands.
    const std::string name = option->get_name(false, true);
    std::string line = "  " + (name.empty() ? "--" + option->get_lnames().front() : name);
    if (option->get_type_size() > 0) line += " " + option->get_type_name();
    line.resize(std::max<size_t>(line.size() + 1, 26), ' ');
    text += line + option->get_description() + "\n";
  }
  return text +
         "\nExit code: 0 done, 1 the verdict is negative, 2 wrong usage, 3 bad input, 4 no "
         "solution was found (for example no repair), 5 internal error, 130 stopped by Ctrl-C\n";
}

}  // namespace

std::string examples_of(const CLI::App& app) {
  const CLI::App* const command = app.get_parent();
  const std::string footer = app.get_footer();
  if (!command || !command->get_parent() || footer != command->get_footer()) return footer;
  const std::string call = "ayumi " + command->get_name() + " " + app.get_name() + " ";
  std::string own;
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("  ") && line.find(call) != std::string::npos) own += "\n" + line;
  return own.empty() ? footer : "Examples:" + own;
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  if (!app->get_parent()) return broken_at(overview(*app), terminal_columns());
  std::string text = app->get_description() + "\n\n";
  const std::string examples = examples_of(*app);
  if (!examples.empty()) text += examples + "\n\n";
  text += make_usage(app, name) + make_positionals(app) + make_subcommands(app, mode) +
          make_groups(app, mode);
  text += "\nayumi --help lists the options that every command takes.\n";
  return broken_at(text, terminal_columns());
}

}  // namespace ayumi::app
