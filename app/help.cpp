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
      "Usage: ayumi COMMAND ...     ayumi COMMAND --help begins with examples.\n\n";
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    std::string line = "  " + command->get_name();
    line.resize(std::max<size_t>(line.size() + 1, 14), ' ');
    text += line + command->get_description() + "\n";
  }
  text += "\nOptions of every command:\n";
  for (const CLI::Option* option : app.get_options()) {
    // CLI11 has no name for an option that the pages of commands do not list.
    const std::string name = option->get_name(false, true);
    std::string line = "  " + (name.empty() ? "--" + option->get_lnames().front() : name);
    if (option->get_type_size() > 0) line += " " + option->get_type_name();
    line.resize(std::max<size_t>(line.size() + 1, 26), ' ');
    text += line + option->get_description() + "\n";
  }
  return text +
         "\nExit code: 0 done, 1 the verdict is negative, 2 wrong usage, 3 bad input, 4 a solver "
         "failed, 5 internal error, 130 stopped by Ctrl-C\n";
}

// Where the description in a line begins: behind the names, and two blanks or more. In a line
// without names: where the line begins.
size_t indent_of(const std::string& line) {
  const size_t word = std::min(line.find_first_not_of(' '), line.size());
  const size_t gap = line.rfind("  ");
  if (gap != std::string::npos && gap > word) return line.find_first_not_of(' ', gap);
  return word < line.size() && line[word] == '-' ? 6 : word;
}

// Where a line that is too long is broken: the end of its first part.
size_t break_of(const std::string& line, size_t indent, size_t columns) {
  const size_t blank = line.rfind(' ', columns), comma = line.rfind(',', columns - 1);
  const bool at_blank = blank != std::string::npos && blank > indent;
  const size_t next = at_blank ? std::min(line.find(' ', blank + 1), line.size()) - blank - 1 : 0;
  if (at_blank && next <= columns - indent) return blank;
  if (comma != std::string::npos && comma > indent) return comma + 1;
  return at_blank ? blank : line.find(' ', columns);
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

std::string broken_at(const std::string& text, size_t columns) {
  // Chosen: a description needs this much room beside the names [characters].
  constexpr size_t kLeastRoom = 20;
  if (columns == 0) return text;
  std::string broken;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line); broken += line + "\n") {
    if (line.starts_with("  ayumi ")) continue;
    const size_t indent =
        std::min(indent_of(line), columns > kLeastRoom ? columns - kLeastRoom : 0);
    while (line.size() > columns) {
      const size_t end = break_of(line, indent, columns);
      if (end == std::string::npos) break;
      broken += line.substr(0, end) + "\n";
      line = std::string(indent, ' ') + line.substr(line[end] == ' ' ? end + 1 : end);
    }
  }
  return broken;
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  if (!app->get_parent()) return broken_at(overview(*app), terminal_columns());
  std::string text = app->get_description() + "\n\n";
  const std::string examples = examples_of(*app);
  if (!examples.empty()) text += examples + "\n\n";
  text += make_usage(app, name) + make_positionals(app) + make_groups(app, mode);
  text += "\nayumi --help lists the options that every command takes.\n";
  return broken_at(text, terminal_columns());
}

}  // namespace ayumi::app
