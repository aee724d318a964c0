#include "describe.hpp"

#include <map>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "help.hpp"
#include "option_checks.hpp"

namespace ayumi::app {

namespace {

/// A command with the words before it, such as "new walk".
struct Level {
  std::string words;
  const CLI::App* app;
};

void add_levels(const CLI::App& app, const std::string& words, std::vector<Level>& levels) {
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    levels.push_back({words + command->get_name(), command});
    add_levels(*command, words + command->get_name() + " ", levels);
  }
}

std::vector<Level> levels_of(const CLI::App& app) {
  std::vector<Level> levels;
  add_levels(app, "", levels);
  return levels;
}

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
  std::vector<const CLI::Option*> options;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty()) options.push_back(option);
  return options;
}

/// The flags of an option, such as "-o" and "--out".
std::vector<std::string> flags_of(const CLI::Option& option) {
  std::vector<std::string> flags;
  for (const std::string& name : option.get_snames()) flags.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) flags.push_back("--" + name);
  return flags;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// The name of the value, such as "NAME" or "F", as the help shows it.
std::string value_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(':'));
}

// The kind of names that `ayumi --names` lists for the value of an option or for a word of a
// command; "" for files and numbers.
std::string names_kind(const CLI::Option& option) {
  static const std::map<std::string, std::string> kinds = {{"robot", "robots"},
                                                           {"ROBOT", "robots"},
                                                           {"profile", "profiles"},
                                                           {"posture", "postures"},
                                                           {"POSTURE", "postures"},
                                                           {"gain", "gains"},
                                                           {"gains", "gains"},
                                                           {"joint", "joints"},
                                                           {"joints", "joints"},
                                                           {"lock", "joints"},
                                                           {"weight", "joints"},
                                                           {"tolerance", "findings"},
                                                           {"EQ", "equations"},
                                                           {"plant", "plants"},
                                                           {"controller", "controllers"},
                                                           {"against-controller", "controllers"}};
  const std::string name = option.get_positional() && flags_of(option).empty()
                               ? option.get_name(true)
                           : option.get_lnames().empty() ? ""
                                                         : option.get_lnames().front();
  if (value_of(option).starts_with("ROBOT|")) return "robots";
  const auto known = kinds.find(name);
  return known == kinds.end() ? "" : known->second;
}

// The kinds of the words after the command, separated by commas; "" for files.
std::string word_kinds(const CLI::App& app) {
  std::vector<std::string> kinds;
  for (const CLI::Option* option : options_of(app))
    if (option->get_positional() && flags_of(*option).empty() && !names_kind(*option).empty())
      kinds.push_back(names_kind(*option));
  return text::join(kinds, ",");
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
  return text;
}

// --- the manual page -----------------------------------------------------------------------------

std::string roff(std::string text) {
  text = replaced(std::move(text), "\\", "\\e");
  text = replaced(std::move(text), "-", "\\-");
  text = replaced(std::move(text), "\n.", "\n\\&.");
  text = replaced(std::move(text), "\n'", "\n\\&'");
  if (text.starts_with('.') || text.starts_with('\'')) text = "\\&" + text;
  return text;
}

std::string manual_options(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : options_of(app)) {
    if (!option->get_positional() && flags_of(*option).empty()) continue;
    text += ".TP\n";
    if (option->get_positional() && flags_of(*option).empty())
      text += "\\fI" + roff(option->get_name(true)) + "\\fR";
    else {
      text += "\\fB" + roff(text::join(flags_of(*option), ", ")) + "\\fR";
      if (takes_value(*option)) text += " \\fI" + roff(value_of(*option)) + "\\fR";
    }
    text += "\n" + roff(option->get_description()) + "\n";
  }
  return text;
}

std::string manual(const CLI::App& app, const std::string& version) {
  std::string text = ".TH AYUMI 1 \"\" \"Ayumi " + version + "\" \"User Commands\"\n";
  text +=
      ".SH NAME\nayumi \\- make motions of humanoid robots consistent, stable and safe\n"
      ".SH SYNOPSIS\n.B ayumi\n[\\fIOPTIONS\\fR] \\fICOMMAND\\fR [\\fIARGUMENTS\\fR]\n"
      ".SH DESCRIPTION\nAyumi reads a robot (URDF and sidecar) and a motion pattern, checks "
      "whether the motion is physically consistent, repairs the motion, simulates the robot with a "
      "balance "
      "controller and disturbances, and writes joint tables for the robot.\n"
      ".SH OPTIONS\n";
  text += manual_options(app) + ".SH COMMANDS\n";
  for (const Level& level : levels_of(app)) {
    text += ".SS ayumi " + roff(level.words) + "\n" + roff(level.app->get_description()) + "\n";
    text += manual_options(*level.app);
    const std::string examples = examples_of(*level.app);
    if (!examples.empty()) text += ".PP\n.nf\n" + roff(examples) + "\n.fi\n";
  }
  return text +
         ".SH EXIT STATUS\n0: done. 1: the verdict is negative. 2: wrong usage. 3: bad input. 4: "
         "no solution was found, for example no repair. 5: internal error. 130: stopped by "
         "Ctrl-C.\n";
}

// --- completion ----------------------------------------------------------------------------------

std::string all_flags(const CLI::App& app) {
  std::vector<std::string> all;
  for (const CLI::Option* option : options_of(app))
    for (const std::string& flag : flags_of(*option)) all.push_back(flag);
  return text::join(all, " ");
}

std::string names_below(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return text::join(names, " ");
}

/// The words that may follow a command and are known here. If there are none, those of word_kinds()
/// may follow.
std::string words_after(const Level& level, const CLI::App& app) {
  return level.words == "help" ? names_below(app) : names_below(*level.app);
}

std::string bash_completion(const CLI::App& app) {
  std::string text =
      "# Completion of ayumi for bash.\n"
      "_ayumi() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} path= kind= i\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    case \"$path ${COMP_WORDS[i]}\" in\n";
  for (const Level& level : levels_of(app))
    text += "      ' " + level.words + "') path=' " + level.words + "' ;;\n";
  text += "    esac\n  done\n  local flags='" + all_flags(app) + "' names=\n  case $path in\n";
  text += "    '') names='" + names_below(app) + "' ;;\n";
  for (const Level& level : levels_of(app))
    text += "    ' " + level.words + "') flags+=' " + all_flags(*level.app) + "' names='" +
            words_after(level, app) + "' kind='" + word_kinds(*level.app) + "' ;;\n";
  text += "  esac\n  case \"$path $before\" in\n";
  for (const Level& level : levels_of(app))
    for (const CLI::Option* option : options_of(*level.app))
      if (takes_value(*option) && !flags_of(*option).empty())
        for (const std::string& flag : flags_of(*option)) {
          const std::string choices = text::join(choices_of(*option), " ");
          const std::string kind = names_kind(*option);
          text += "    ' " + level.words + " " + flag + "') kind=" +
                  (!choices.empty() ? ""
                   : kind.empty()   ? "files"
                                    : kind) +
                  " names='" + choices + "' ;;\n";
        }
  text += "    *' --describe') kind= names='" + text::join(description_kinds(), " ") + "' ;;\n";
  return text +
         "  esac\n"
         "  if [[ -n $kind && $kind != files && $word != -* ]]; then\n"
         "    names=$(ayumi --names $kind \"${COMP_WORDS[@]:1:COMP_CWORD-1}\" 2>/dev/null)\n"
         "    mapfile -t COMPREPLY < <(compgen -W \"$names\" -- \"$word\")\n"
         "    [[ $kind == robots || $kind == equations || ( $kind == robots,* && $names == "
         "\"$(ayumi "
         "--names robots 2>/dev/null)\" ) ]] && mapfile -t -O ${#COMPREPLY[@]} "
         "COMPREPLY < <(compgen -f -- "
         "\"$word\")\n"
         "  elif [[ $word == -* ]]; then\n"
         "    mapfile -t COMPREPLY < <(compgen -W \"$flags\" -- \"$word\")\n"
         "  elif [[ -n $names ]]; then\n"
         "    mapfile -t COMPREPLY < <(compgen -W \"$names\" -- \"$word\")\n"
         "  else\n"
         "    mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n"
         "  fi\n"
         "}\n"
         "complete -o filenames -F _ayumi ayumi\n";
}

/// A text between apostrophes for zsh; zsh requires a backslash before the characters `marks` in
/// it.
std::string zsh_text(std::string text, const std::vector<std::string>& marks) {
  text = replaced(std::move(text), "\\", "\\\\");
  for (const std::string& mark : marks) text = replaced(std::move(text), mark, "\\" + mark);
  text = replaced(std::move(text), "'", "'\\''");
  return replaced(std::move(text), "\n", " ");
}

/// A text between apostrophes for fish.
std::string fish_text(std::string text) {
  text = replaced(std::move(text), "\\", "\\\\");
  text = replaced(std::move(text), "'", "\\'");
  return replaced(std::move(text), "\n", " ");
}

std::string zsh_action(const std::string& kind, const std::string& words) {
  if (!words.empty()) return "(" + words + ")";
  // The space before it keeps _arguments from adding arguments of its own.
  return kind.empty() ? "_files" : " _ayumi_names " + kind;
}

std::string zsh_options(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : options_of(app))
    for (const std::string& flag : flags_of(*option))
      text += " \\\n        '*" + flag + "[" +
              zsh_text(option->get_description(), {"[", "]", ":"}) + "]" +
              (takes_value(*option)
                   ? ":" + zsh_text(value_of(*option), {":"}) + ":" +
                         zsh_action(names_kind(*option), text::join(choices_of(*option), " "))
                   : "") +
              "'";
  return text;
}

std::string zsh_names(const CLI::App& app) {
  std::string text;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    text += " '" + command->get_name() + ":" + zsh_text(command->get_description(), {}) + "'";
  return text;
}

std::string zsh_completion(const CLI::App& app) {
  std::string text =
      "#compdef ayumi\n# Completion of ayumi for zsh.\n"
      "_ayumi_names() {\n"
      "  local -a known\n"
      "  known=(${(f)\"$(ayumi --names $1 ${words[2,CURRENT-1]} 2>/dev/null)\"})\n"
      "  compadd -a known\n"
      "  [[ $1 == robots || $1 == equations || ( $1 == robots,* && \"${(F)known}\" == \"$(ayumi "
      "--names robots 2>/dev/null)\" ) ]] && _files\n"
      "}\n"
      "# The variable path of zsh is the search path of programs.\n"
      "_ayumi() {\n  local command= word\n  local -a names\n"
      "  for word in ${words[2,CURRENT-1]}; do\n    case \"$command $word\" in\n";
  for (const Level& level : levels_of(app))
    text += "      ' " + level.words + "') command=' " + level.words + "' ;;\n";
  text += "    esac\n  done\n  case $command in\n";
  std::vector<Level> levels = levels_of(app);
  levels.insert(levels.begin(), {"", &app});
  for (const Level& level : levels) {
    text += "    '" + (level.words.empty() ? "" : " " + level.words) + "')\n";
    const std::string names = zsh_names(*level.app);
    if (!names.empty())
      text += "      if [[ $PREFIX != -* ]]; then\n        names=(" + names +
              ")\n        _describe command names\n        return\n      fi\n";
    text += "      _arguments -S" + zsh_options(*level.app) +
            (level.words.empty() ? "" : zsh_options(app)) + " \\\n        '*:file:" +
            (level.words.empty() ? zsh_action("", "")
                                 : zsh_action(word_kinds(*level.app), words_after(level, app))) +
            "' ;;\n";
  }
  return text + "  esac\n}\n_ayumi \"$@\"\n";
}

// Each name has an empty description of its own, so that the help of the option is not repeated for
// it.
std::string fish_names(const std::string& kind) {
  return " -a '(ayumi --names " + kind +
         " (commandline -opc)[2..] 2>/dev/null | string replace -r \\$ \\t)'";
}

// Whether a word may also be a file. Robots, patterns and runs may be files; the parts of a robot
// that is named before may not.
bool may_be_file(const std::string& kind) {
  return kind.empty() || kind.starts_with("robots") || kind == "equations";
}

std::string fish_options(const CLI::App& app, const std::string& condition) {
  std::string text;
  for (const CLI::Option* option : options_of(app)) {
    if (flags_of(*option).empty()) continue;
    text += "complete -c ayumi" + condition;
    for (const std::string& name : option->get_snames()) text += " -s " + name;
    for (const std::string& name : option->get_lnames()) text += " -l " + name;
    const std::string choices = text::join(choices_of(*option), " ");
    if (takes_value(*option))
      text += choices.empty() && may_be_file(names_kind(*option)) ? " -r" : " -x";
    if (!choices.empty())
      text += " -a '(printf %s\\t\\n " + choices + ")'";
    else if (!names_kind(*option).empty())
      text += fish_names(names_kind(*option));
    text += " -d '" + fish_text(option->get_description()) + "'\n";
  }
  return text;
}

std::string fish_completion(const CLI::App& app) {
  std::string text = "# Completion of ayumi for fish.\n" + fish_options(app, "") +
                     "complete -c ayumi -n 'string match -q -- \"*--describe*\" (commandline -pc)' "
                     "-l describe -x -a '" +
                     text::join(description_kinds(), " ") + "'\n";
  std::vector<Level> levels = levels_of(app);
  levels.insert(levels.begin(), {"", &app});
  for (const Level& level : levels) {
    std::string seen;
    for (const char c : level.words)
      seen += c == ' ' ? std::string("; and __fish_seen_subcommand_from ") : std::string(1, c);
    const std::string within =
        seen.empty() ? "__fish_use_subcommand" : "__fish_seen_subcommand_from " + seen;
    // A command is only offered until one is chosen.
    const std::string open =
        level.words.empty() || names_below(*level.app).empty()
            ? within
            : within + "; and not __fish_seen_subcommand_from " + names_below(*level.app);
    for (const CLI::App* command : level.app->get_subcommands([](const CLI::App*) { return true; }))
      text += "complete -c ayumi -f -n '" + open + "' -a " + command->get_name() + " -d '" +
              fish_text(command->get_description()) + "'\n";
    if (level.words.empty()) continue;
    if (level.words == "help")
      text += "complete -c ayumi -f -n '" + within + "' -a '" + names_below(app) + "'\n";
    text += fish_options(*level.app, " -n '" + within + "'");
    const std::string kind = word_kinds(*level.app);
    if (kind.empty()) continue;
    text += "complete -c ayumi -n '" + within + "'" + fish_names(kind) + "\n";
    if (kind.starts_with("robots,"))
      text +=
          "complete -c ayumi -f -n '" + within + "; and test \"$(ayumi --names " + kind +
          " (commandline -opc)[2..] 2>/dev/null)\" != \"$(ayumi --names robots 2>/dev/null)\"'\n";
  }
  return text;
}

}  // namespace

const std::vector<std::string>& description_kinds() {
  static const std::vector<std::string> kinds = {"man", "bash", "zsh", "fish"};
  return kinds;
}

std::string described(const CLI::App& app, const std::string& kind, const std::string& version) {
  if (kind == "man") return manual(app, version);
  if (kind == "bash") return bash_completion(app);
  if (kind == "zsh") return zsh_completion(app);
  if (kind == "fish") return fish_completion(app);
  fail(ErrorCode::usage, "--describe: unknown kind '" + kind + "'" +
                             text::suggestion(kind, description_kinds()) +
                             " (known: " + text::join(description_kinds(), ", ") + ")");
}

}  // namespace ayumi::app
