#include "options.hpp"

#include <CLI/CLI.hpp>

namespace ayumi::app {

ValueCheck::ValueCheck(Complaint complaint, std::string description, std::string name)
    : complaint_(std::move(complaint)),
      description_(std::move(description)),
      name_(std::move(name)) {}

ValueCheck ValueCheck::description(std::string description) const {
  return {complaint_, std::move(description), name_};
}

Option* Option::required() {
  option_->required();
  return this;
}

Option* Option::type_name(std::string name) {
  option_->type_name(std::move(name));
  return this;
}

Option* Option::capture_default_str() {
  option_->capture_default_str();
  return this;
}

Option* Option::check(const ValueCheck& check) {
  const ValueCheck::Complaint& complaint = check.complaint_;
  option_->check(CLI::Validator([complaint](std::string& word) { return complaint(word); },
                                check.description_, check.name_));
  return this;
}

Option* Option::allow_extra_args(bool allowed) {
  option_->allow_extra_args(allowed);
  return this;
}

Option* Option::delimiter(char character) {
  option_->delimiter(character);
  return this;
}

Option* Option::expected(int count) {
  option_->expected(count);
  return this;
}

Option* Option::expected(int least, int most) {
  option_->expected(least, most);
  return this;
}

Option* Option::excludes(Option* other) {
  option_->excludes(other->option_);
  return this;
}

Option* Option::group(const std::string& heading) {
  option_->group(heading);
  return this;
}

Option* Option::trigger_on_parse() {
  option_->trigger_on_parse();
  return this;
}

size_t Option::count() const { return option_->count(); }

std::string Option::get_name() const { return option_->get_name(); }

bool Option::get_positional() const { return option_->get_positional(); }

std::string Option::shown_name() const {
  return (option_->get_positional() ? "" : "--") + option_->get_single_name();
}

Option* Command::keep(CLI::Option* option) { return &options_.emplace_back(option); }

namespace {

// Whether a word is the name of an option of the command or of the program.
bool names_option(const CLI::App* command, const std::string& word) {
  for (; command != nullptr; command = command->get_parent())
    if (command->get_option_no_throw(word) != nullptr) return true;
  return false;
}

// Says that a result is not written to the standard output.
std::string complaint_of_dash(const std::string& word) {
  return word != "-" ? "" : "results are written to files only. For a file named '-', write ./-";
}

}  // namespace

Option* Command::keep_value(CLI::Option* option, bool is_output) {
  if (option->get_positional()) return keep(option);
  // CLI11 takes the next word as the value, even if it is an option.
  option->check(CLI::Validator(
      [is_output, command = &app_](std::string& word) -> std::string {
        const bool is_option = word.size() > 1 && word[0] == '-' && names_option(command, word);
        if (!is_option && !(is_output && word.starts_with("--"))) return "";
        return (is_option ? "'" + word + "' is an option, but a value is needed"
                          : "'" + word + "' looks like an option") +
               std::string(is_output ? ". For a file of this name, write ./" + word : "");
      },
      "", ""));
  return keep(option);
}

Command* Command::add_subcommand(std::string name, std::string description) {
  return &subcommands_.emplace_back(*app_.add_subcommand(std::move(name), std::move(description)));
}

Option* Command::add_option(std::string name, std::string& value, std::string description) {
  const bool is_output = name.starts_with("-o,");
  Option* const option =
      keep_value(app_.add_option(std::move(name), value, std::move(description)), is_output);
  if (is_output) option->check({complaint_of_dash, "", ""});
  return option;
}

Option* Command::add_option(std::string name, double& value, std::string description) {
  return keep_value(app_.add_option(std::move(name), value, std::move(description)));
}

Option* Command::add_option(std::string name, int& value, std::string description) {
  return keep_value(app_.add_option(std::move(name), value, std::move(description)));
}

Option* Command::add_option(std::string name, std::int64_t& value, std::string description) {
  return keep_value(app_.add_option(std::move(name), value, std::move(description)));
}

Option* Command::add_option(std::string name, std::uint64_t& value, std::string description) {
  return keep_value(app_.add_option(std::move(name), value, std::move(description)));
}

Option* Command::add_option(std::string name, std::optional<double>& value,
                            std::string description) {
  return keep_value(app_.add_option(std::move(name), value, std::move(description)));
}

Option* Command::add_option(std::string name, std::vector<std::string>& values,
                            std::string description) {
  return keep_value(app_.add_option(std::move(name), values, std::move(description)));
}

Option* Command::add_option(std::string name, std::vector<double>& values,
                            std::string description) {
  return keep_value(app_.add_option(std::move(name), values, std::move(description)));
}

Option* Command::add_flag(std::string name, bool& value, std::string description) {
  return keep(app_.add_flag(std::move(name), value, std::move(description)));
}

Option* Command::add_flag_callback(std::string name, std::function<void()> given,
                                   std::string description) {
  return keep(app_.add_flag_callback(std::move(name), std::move(given), std::move(description)));
}

void Command::callback(std::function<void()> run) { app_.callback(std::move(run)); }

void Command::footer(std::string text) { app_.footer(std::move(text)); }

void Command::require_subcommand(int count) { app_.require_subcommand(count); }

std::string Command::get_name() const { return app_.get_name(); }

std::string Command::get_description() const { return app_.get_description(); }

std::vector<std::string> Command::given_subcommands() const {
  std::vector<std::string> names;
  for (const CLI::App* command : app_.get_subcommands()) names.push_back(command->get_name());
  return names;
}

std::vector<std::pair<std::string, std::string>> Command::all_subcommands() const {
  std::vector<std::pair<std::string, std::string>> all;
  for (const Command& command : subcommands_)
    all.emplace_back(command.get_name(), command.get_description());
  return all;
}

void end_with_success() { throw CLI::Success(); }

}  // namespace ayumi::app
