#pragma once
// The subcommands and options of the command line, as a command declares them. Only options.cpp and
// the sources that print help or read the command line include CLI11 itself, because its templates
// take long to compile.

#include <cstdint>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace ayumi::app {

/// A condition for the value of an option.
class ValueCheck {
 public:
  /// Says what is wrong with a word; empty if nothing is wrong.
  using Complaint = std::function<std::string(const std::string& word)>;

  /// The help shows `description` after the option, and `name` identifies the check.
  ValueCheck(Complaint complaint, std::string description, std::string name = "");
  /// The same check with another description.
  ValueCheck description(std::string description) const;

 private:
  friend class Option;
  Complaint complaint_;
  std::string description_, name_;
};

/// An option or argument of a command. The members that change it return it, and have the meaning
/// of CLI11's members of the same names.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  Option(const Option&) = delete;
  Option& operator=(const Option&) = delete;

  Option* required();
  Option* type_name(std::string name);
  Option* capture_default_str();  ///< the help states the value that the variable has now
  Option* check(const ValueCheck& check);
  Option* allow_extra_args(bool allowed);
  Option* delimiter(char character);
  Option* expected(int count);
  Option* expected(int least, int most);
  Option* excludes(Option* other);
  Option* group(const std::string& heading);
  Option* trigger_on_parse();

  size_t count() const;          ///< number of times that the command line has it
  std::string get_name() const;  ///< name as it is typed, for example "--rate"
  bool get_positional() const;   ///< whether it is an argument, which has no dashes
  /// "--rate" for the option "-r,--rate"; for an argument, its name.
  std::string shown_name() const;

 private:
  CLI::Option* option_;
};

/// The program's command line or one of its subcommands.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(app) {}
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  Command* add_subcommand(std::string name, std::string description);

  /// `value` receives the value in the command line, and does not change if there is none.
  Option* add_option(std::string name, std::string& value, std::string description);
  Option* add_option(std::string name, double& value, std::string description);
  Option* add_option(std::string name, int& value, std::string description);
  Option* add_option(std::string name, std::int64_t& value, std::string description);
  Option* add_option(std::string name, std::uint64_t& value, std::string description);
  Option* add_option(std::string name, std::optional<double>& value, std::string description);
  Option* add_option(std::string name, std::vector<std::string>& values, std::string description);
  Option* add_option(std::string name, std::vector<double>& values, std::string description);
  Option* add_flag(std::string name, bool& value, std::string description);
  Option* add_flag_callback(std::string name, std::function<void()> given, std::string description);

  /// The function that runs after the whole command line was read.
  void callback(std::function<void()> run);
  void footer(std::string text);  ///< the examples in the help
  void require_subcommand(int count);

  std::string get_name() const;
  std::string get_description() const;
  /// The subcommands that the command line has.
  std::vector<std::string> given_subcommands() const;
  /// Names and descriptions of all subcommands, in their order.
  std::vector<std::pair<std::string, std::string>> all_subcommands() const;
  /// The options of this command itself.
  const std::list<Option>& own_options() const { return options_; }
  const CLI::App& cli11() const { return app_; }

 private:
  Option* keep(CLI::Option* option);
  /// Keeps an option or argument with a value, which must not be an option of the command.
  Option* keep_value(CLI::Option* option, bool is_text);
  CLI::App& app_;
  std::list<Option> options_;
  std::list<Command> subcommands_;
};

/// Is called from a callback of an option that is triggered while the command line is read. The
/// program ends with exit code 0.
[[noreturn]] void end_with_success();

}  // namespace ayumi::app
