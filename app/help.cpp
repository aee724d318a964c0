#include "help.hpp"

#include <algorithm>
#include <sstream>

#include "ayumi/base/text.hpp"
#include "terminal.hpp"

namespace ayumi::app {

namespace {

std::string overview(const CLI::App& app) {
  std::string text =
      "Ayumi checks, stabilizes and exports motion patterns of humanoid robots.\n\n"
      "  robot + pattern -> check -> repair -> simulate -> tables, clips, report\n\n"
      "Usage: ayumi COMMAND ...   For the options of one command: ayumi COMMAND --help\n\n";
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

// The subcommands of this name below `level` at any depth, each with the words before it.
std::vector<std::string> paths_to(const CLI::App& level, const std::string& name) {
  std::vector<std::string> paths;
  for (const CLI::App* command : level.get_subcommands(nullptr)) {
    if (command->get_name() == name) paths.push_back(name);
    for (const std::string& path : paths_to(*command, name))
      paths.push_back(command->get_name() + " " + path);
  }
  return paths;
}

}  // namespace

std::string subcommand_suggestion(const CLI::App& level, const std::string& word) {
  const std::vector<std::string> paths = paths_to(level, word);
  if (!paths.empty()) return "; did you mean '" + text::join(paths, "' or '") + "'?";
  std::vector<std::string> names;
  for (const CLI::App* command : level.get_subcommands(nullptr))
    names.push_back(command->get_name());
  return text::suggestion(word, names);
}

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
