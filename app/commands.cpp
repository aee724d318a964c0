#include "commands.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <system_error>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/in_parallel.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/io/bundled_data.hpp"
#include "ayumi/render/shader_cache.hpp"
#include "describe.hpp"
#include "help.hpp"
#include "libraries.hpp"
#include "names.hpp"
#include "option_checks.hpp"
#include "signals.hpp"
#include "terminal.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

constexpr AddCommand kCommands[] = {
#define AYUMI_COMMAND(name) &add_##name,
#include "commands/list.def"
#undef AYUMI_COMMAND
};

// Options that must not appear in written files, and whether each has a value.
constexpr std::pair<const char*, bool> kUnrecorded[] = {{"-o", true},
                                                        {"--out", true},
                                                        {"--threads", true},
                                                        {"--robot-path", true},
                                                        {"--package-path", true},
                                                        {"--json", false},
                                                        {"--quiet", false},
                                                        {"-q", false},
                                                        {"--force", false}};

std::string recorded_command_line(int argc, char** argv) {
  std::string line = "ayumi";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto unrecorded =
        std::find_if(std::begin(kUnrecorded), std::end(kUnrecorded), [&](const auto& option) {
          return word == option.first ||
                 (option.second && word.starts_with(std::string(option.first) + "="));
        });
    if (unrecorded == std::end(kUnrecorded))
      line += " " + word;
    else if (unrecorded->second && word == unrecorded->first)
      ++i;
  }
  return line;
}

int exit_code_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage:
      return 2;
    case ErrorCode::solver:
      return 4;
    case ErrorCode::internal:
      return 5;
    default:
      return 3;
  }
}

void add_global_options(CLI::App& app, Command& command_line, Context& context) {
  app.set_help_flag("-h,--help", "Print this page.");
  app.set_version_flag("--version",
                       std::string("ayumi ") + version() + " (" + library_versions() + ")",
                       "Print the versions of Ayumi and of its libraries.");
  command_line.add_flag("--json", context.json, "Print one JSON object in place of text.");
  command_line.add_flag("-q,--quiet", context.quiet, "Print no progress.");
  command_line.add_flag("--force", context.force, "Overwrite existing results.");
  command_line
      .add_option("--threads", context.threads,
                  "Number of threads; 0 = one for each processor. The results do not depend on "
                  "this number.")
      ->check(whole_number_within(kThreadBounds).description(""))
      ->type_name("N");
  command_line.add_option("--seed", context.seed, "Seed of noise and random choices.")
      ->check(seed_number())
      ->type_name("N");
  app.add_option_function<std::string>(
         "--describe",
         [&app](const std::string& kind) {
           std::fputs(described(app, kind, version()).c_str(), stdout);
           throw CLI::Success();
         },
         "Print the manual page (man) or the script for shell completion (bash, zsh, fish).")
      ->type_name("KIND")
      ->trigger_on_parse()
      ->group("");
  command_line
      .add_option("--robot-path", context.robot_path,
                  "Folder with robots. Ayumi searches this folder before the bundled robots.")
      ->type_name("DIR")
      ->allow_extra_args(false);
  command_line
      .add_option("--package-path", context.package_path,
                  "Folder in which Ayumi looks for a package when a robot file names a file as "
                  "package://PACKAGE/... The folder contains packages, or it is a package itself.")
      ->type_name("DIR")
      ->allow_extra_args(false);
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* level = &app; level; level = level->get_parent())
    for (const CLI::Option* option : level->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// The words that can stand after `new` or `edit`, if none of them was given; otherwise nothing.
std::vector<std::string> kinds_of(const CLI::App& command) {
  std::vector<std::string> kinds;
  if (command.get_parent() && command.get_subcommands().empty())
    for (const CLI::App* kind : command.get_subcommands(nullptr)) kinds.push_back(kind->get_name());
  return kinds;
}

// Makes a whole sentence of CLI11's message about one option: what is wrong, and what the option
// expects.
std::string option_message(const CLI::App& app, const CLI::ParseError& error) {
  const std::string words = error.what();
  std::vector<const CLI::App*> levels = {&app};
  while (!levels.back()->get_subcommands().empty())
    levels.push_back(levels.back()->get_subcommands().front());
  for (const CLI::App* level : levels)
    for (const CLI::Option* option : level->get_options()) {
      const std::string name = option->get_name();
      std::string type = option->get_type_name();
      type = type.substr(0, type.find(':'));
      const bool argument = option->get_positional(), plain = type.starts_with("TEXT");
      const std::string shown = argument ? (plain ? name : type) : name + (plain ? "" : " " + type);
      const std::string help = "\n  " + shown + "  " + option->get_description();
      if (words == name + " is required")
        return (argument ? "the argument " : "the option ") + (argument ? shown : name) +
               " is missing" + help;
      const std::string conversion = "Could not convert: " + name + " = ";
      if (words.starts_with(conversion)) {
        // A number that does not fit the option fails because the option takes whole numbers.
        const std::string given = words.substr(conversion.size());
        double number = 0;
        return name + ": '" + given +
               (CLI::detail::lexical_cast(given, number) ? "' is not a whole number"
                                                         : "' is not a number") +
               help;
      }
      if (words.starts_with(name + " excludes "))
        return name + " and " + words.substr(name.size() + 10) + " cannot be given together";
      if (!words.starts_with(name + ": ")) continue;
      const std::string rest = words.substr(name.size() + 2);
      if (rest.ends_with(" missing")) return name + ": the value is missing" + help;
      if (!rest.starts_with("At least ") && !rest.starts_with("At Most ")) continue;
      const int least = option->get_items_expected_min(), most = option->get_items_expected_max();
      const int given = std::atoi(rest.c_str() + rest.rfind(' '));
      return name + ": " + text::counted(given, "value") + (given == 1 ? " is" : " are") +
             " given, but " +
             (given >= least ? "at most "
              : least < most ? "at least "
                             : "") +
             (given < least ? std::to_string(least) + (least == 1 ? " is" : " are") + " needed"
                            : std::to_string(most) + (most == 1 ? " is" : " are") + " allowed") +
             help;
    }
  return words;
}

// CLI11's message, or a better one that names the nearest command or option.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* deepest = &app;
  while (!deepest->get_subcommands().empty()) deepest = deepest->get_subcommands().front();
  const CLI::App& level = *deepest;
  for (const std::string& word : app.remaining(true)) {
    if (word.size() > 1 && word[0] == '-')
      return "unknown option '" + word + "'" +
             text::suggestion(word.substr(0, word.find('=')), option_names(level));
    if (&level == &app) return "unknown command '" + word + "'" + subcommand_suggestion(app, word);
    if (!kinds_of(level).empty())
      return level.get_name() + ": unknown kind '" + word + "'. Choose one of " +
             text::join(kinds_of(level), ", ") + text::suggestion(word, kinds_of(level));
    return "unexpected argument '" + word + "'";
  }
  if (!kinds_of(level).empty() && level.get_require_subcommand_min() > 0)
    return level.get_name() + ": choose one of " + text::join(kinds_of(level), ", ");
  return option_message(app, error);
}

// Reports the error on standard error for people and, with --json, as an object on standard output.
int failed(const Context& context, const std::string& text, int exit_code,
           const SourcePlace& place = {}) {
  // Largest length of a place [bytes]. Chosen: longer than every place of a valid file.
  constexpr size_t kMostPlace = 200;
  complain(text);
  nlohmann::ordered_json object = {{"error", shortened(text, kLongestMessage)},
                                   {"exit_code", exit_code}};
  if (!place.file.empty()) object["file"] = place.file;
  if (place.line > 0) object["line"] = place.line;
  if (!place.inside.empty()) object["place"] = shortened(place.inside, kMostPlace);
  context.print_json(object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  return exit_code;
}

bool is_among(int argc, char** argv, const std::string& option) {
  return std::find(argv + 1, argv + argc, option) != argv + argc;
}

int parse_and_run(CLI::App& app, Context& context, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::string command;
    for (auto chosen = app.get_subcommands(); !chosen.empty();
         chosen = chosen.front()->get_subcommands())
      command += chosen.front()->get_name() + " ";
    // What follows an option that cannot be read is not parsed, not even --json.
    context.json = is_among(argc, argv, "--json");
    return failed(context, usage_message(app, error) + "\nSee ayumi " + command + "--help", 2);
  } catch (const Interrupted&) {
    return failed(context, "stopped", kStoppedExitCode);
  } catch (const Error& error) {
    return failed(context, error.what(), exit_code_of(error.code()), error.place());
  } catch (const std::bad_alloc&) {
    return failed(
        context,
        "there is not enough memory for this command. Take a shorter motion, fewer samples or "
        "a machine with more memory",
        exit_code_of(ErrorCode::bad_file));
  } catch (const fs::filesystem_error& error) {
    return failed(context, error.path1().string() + ": " + error.code().message(),
                  exit_code_of(ErrorCode::bad_file));
  } catch (const std::system_error& error) {
    return failed(context,
                  std::string("the system refused a thread or another resource (") +
                      error.code().message() +
                      "). End other programs, or raise the limits of the system (ulimit)",
                  exit_code_of(ErrorCode::bad_file));
  } catch (const std::exception& error) {
    return failed(context, std::string("internal error: ") + error.what(), 5);
  }
  return context.exit_code;
}

}  // namespace

void Context::print(const std::string& text) const {
  if (json) return;
  const std::string shown = safe_for_terminal(text);
  std::fwrite(shown.data(), 1, shown.size(), stdout);
}

void Context::print_json(const std::string& object) const {
  if (json) std::printf("%s\n", object.c_str());
}

fs::path data_folder(const std::string& name) {
  std::error_code ignored;
  return bundled_data(fs::read_symlink("/proc/self/exe", ignored), name);
}

RobotSearch robot_search(const Context& context) {
  RobotSearch search;
  for (const std::string& folder : context.robot_path) {
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored))
      fail(ErrorCode::bad_file, "--robot-path " + folder + ": this is not a folder");
    search.folders.emplace_back(folder);
  }
  search.folders.push_back(data_folder("robots"));
  for (const std::string& folder : context.package_path) {
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored))
      fail(ErrorCode::bad_file, "--package-path " + folder + ": this is not a folder");
    search.packages.emplace_back(folder);
  }
  return search;
}

namespace {

bool is_utf8(const std::string& word) {
  try {
    return !nlohmann::json(word).dump().empty();
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

// Refuses words that are not UTF-8, because names and texts are written into files of UTF-8 text.
// Also refuses an empty name of a file, which usually is a variable of a script without a value.
void refuse_words(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const std::string place = "argument " + std::to_string(i) +
                              (i > 1 ? ", after '" + std::string(argv[i - 1]) + "'" : "");
    if (word.empty() || (word.starts_with("-") && word.ends_with("=")))
      fail(ErrorCode::usage, {"", place},
           "an empty text was given" + (word.empty() ? "" : " in '" + word + "'") +
               ", but a value is needed");
    if (!is_utf8(word))
      fail(ErrorCode::usage, {"", place},
           "'" + word +
               "' is not UTF-8 text, so Ayumi cannot write it into results. "
               "Give UTF-8 text (if this is the name of a file, rename the file)");
  }
}

// If a standard stream is closed, a file that is opened later would get its number, and what the
// program prints would go into that file. So the stream is opened first. Writing to a closed
// standard output still fails.
void fill_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
      static_cast<void>(::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY));
}

// A command has failed if nobody receives its result.
int exit_code_after_printing(int exit_code) {
  errno = 0;
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  if (!failed || exit_code > 1) return exit_code;
  complain("standard output cannot be written" +
           (errno ? std::string(" (") + std::strerror(errno) + ")" : std::string()));
  return exit_code_of(ErrorCode::bad_file);
}

// Ends the program if there is not even memory for the message of an error.
[[noreturn]] void end_without_memory() {
  constexpr char kMessage[] = "ayumi: there is not enough memory\n";
  static_cast<void>(!::write(STDERR_FILENO, kMessage, sizeof kMessage - 1));
  ::_exit(exit_code_of(ErrorCode::bad_file));
}

int parse_and_run(int argc, char** argv) {
  Context context;
  context.command_line = recorded_command_line(argc, argv);
  CLI::App app("", "ayumi");
  app.formatter(std::make_shared<HelpFormatter>());
  app.fallthrough();
  Command command_line(app);
  add_global_options(app, command_line, context);
  for (const AddCommand add : kCommands) add(command_line, context);
  if (argc == 1) {
    std::fputs(app.help().c_str(), stdout);
    return 2;
  }
  // Completion of shells calls the program in this way; the words after --names are not a command
  // line that can be parsed.
  if (argc > 2 && std::string(argv[1]) == "--names") {
    print_names(context, argv[2], {argv + 3, argv + argc});
    return 0;
  }
  app.require_subcommand(1);
  try {
    refuse_words(argc, argv);
  } catch (const Error& error) {
    context.json = is_among(argc, argv, "--json");
    return failed(context, error.what(), exit_code_of(error.code()), error.place());
  }
  return parse_and_run(app, context, argc, argv);
}

}  // namespace

int run(int argc, char** argv) {
  fill_closed_streams();
  watch_for_signals();
  disable_shader_cache_on_full_disk();  // before the first thread
  // Libraries also allocate memory while they clean up after an error, where no exception may be
  // thrown.
  std::set_terminate([] {
    try {
      if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
    } catch (const std::bad_alloc&) {
      end_without_memory();
    } catch (...) {
    }
    std::abort();
  });
  try {
    return exit_code_after_printing(parse_and_run(argc, argv));
  } catch (const std::bad_alloc&) {
    end_without_memory();
  }
}

}  // namespace ayumi::app
