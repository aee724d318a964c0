// A live page beside the author's editor.

#include <sys/wait.h>
#include <unistd.h>

#include "author/author_server.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/report/page.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "signals.hpp"

namespace ayumi::app {

namespace {

struct AuthorCommand {
  std::string pattern, profile;
  std::vector<std::string> set;
  int port = 0;
  bool open = false;
};

// The output and the exit code of the browser do not matter here.
void open_in_browser(const std::string& address) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (::fork() == 0) ::execlp("xdg-open", "xdg-open", address.c_str(), nullptr);
    ::_exit(0);
  }
  if (child > 0) ::waitpid(child, nullptr, 0);
}

void author(Context& context, const AuthorCommand& options) {
  if (kAuthorPage.empty())
    fail(ErrorCode::usage,
         "author: this program was built without npm, so it has no page. To get the page: sudo "
         "apt-get install nodejs npm, then configure and build again (cmake -S . -B build/release "
         "&& cmake --build build/release)");
  if (options.pattern == "-")
    fail(ErrorCode::usage, "author: standard input cannot be edited. Name a file");
  // If the file is a link, its target is edited, and the link stays.
  std::error_code missing;
  std::filesystem::path file = std::filesystem::canonical(options.pattern, missing);
  if (missing && !std::filesystem::exists(options.pattern))
    fail(ErrorCode::bad_file, {options.pattern},
         "no such file. `ayumi new stand -o " + options.pattern +
             "` writes a pattern to begin with, and `ayumi new --list` names "
             "other kinds of motion");
  if (missing) file = options.pattern;
  AuthorSession session(context, {file, read_pairs(options.set, "--set"), options.profile});
  serve_author(
      session, {options.port},
      [&](const std::string& address) {
        expect_to_be_stopped();
        context.print(
            options.pattern + " is shown at\n  " + address +
            "\n  The page follows every change of the file, and can itself change the file. "
            "Ctrl-C ends the server.\n");
        context.print_json(nlohmann::ordered_json{{"address", address}}.dump());
        std::fflush(stdout);
        if (options.open) open_in_browser(address);
      },
      [] { return stop_requested(); });
}

}  // namespace

void add_author(Command& app, Context& context) {
  Command* command = app.add_subcommand("author",
                                        "show a pattern on a live page that shows each change of "
                                        "the file and can also edit the file");
  command->footer(
      "Examples:\n  ayumi author walk.json\n  ayumi author walk.json --open\n"
      "  ayumi author walk.json --profile hoap1-strong --port 8080\n"
      "Only programs on this machine can open the page. Each user of this machine who knows the "
      "address can change the file, so keep the address secret.");
  auto options = std::make_shared<AuthorCommand>();
  command->add_option("PATTERN", options->pattern, "Pattern file.")->required();
  command->add_option("--set", options->set, "Set a parameter that the pattern declares.")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option("--profile", options->profile,
                   "Actuator profile of the robot (default: the profile of the pattern).")
      ->type_name("NAME");
  command->add_option("--port", options->port, "Port of the server (default: a free port).")
      ->check(whole_number_within(1, 65535).description(""))
      ->type_name("N");
  command->add_flag("--open", options->open, "Open the page in the browser.");
  command->callback([options, &context] { author(context, *options); });
}

}  // namespace ayumi::app
