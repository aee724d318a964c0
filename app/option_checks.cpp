#include "option_checks.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "ayumi/base/text.hpp"

namespace ayumi::app {

namespace {

// The beginning of the name of the check; its words follow.
const std::string kOneOf = "one of|";

}  // namespace

ValueCheck number_within(double least, double most) {
  const auto plain = [](double x) {
    return std::abs(x) >= 1e3 ? text::fixed(x, 0) : text::brief(x);
  };
  const std::string least_text = plain(least), most_text = plain(most);
  const auto complaint = [=](const std::string& word) -> std::string {
    double value = 0;
    const bool fits = CLI::detail::lexical_cast(word, value) && value >= least && value <= most;
    return fits ? "" : "'" + word + "' is not a number from " + least_text + " to " + most_text;
  };
  return {complaint, "in [" + least_text + " - " + most_text + "]"};
}

ValueCheck whole_number_within(int least, int most) {
  const std::string least_text = std::to_string(least), most_text = std::to_string(most);
  const auto complaint = [=](const std::string& word) -> std::string {
    int value = 0;
    const bool fits = CLI::detail::lexical_cast(word, value) && value >= least && value <= most;
    return fits ? ""
                : "'" + word + "' is not a whole number from " + least_text + " to " + most_text;
  };
  return {complaint, "INT in [" + least_text + " - " + most_text + "]"};
}

ValueCheck seed_number() {
  const auto complaint = [](const std::string& word) -> std::string {
    std::uint64_t value = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (stop != end || error != std::errc())
      return "'" + word + "' is not a whole number from 0 to " + std::to_string(UINT64_MAX);
    // The option itself would read such a number as an octal one.
    return word.size() > 1 && word[0] == '0'
               ? "'" + word + "' begins with 0. Write " + std::to_string(value)
               : "";
  };
  return {complaint, ""};
}

ValueCheck one_of(const std::vector<std::string>& words) {
  const auto complaint = [words](const std::string& word) -> std::string {
    if (std::find(words.begin(), words.end(), word) != words.end()) return "";
    return "'" + word + "' is not one of " + text::join(words, ", ") +
           text::suggestion(word, words);
  };
  return {complaint, "{" + text::join(words, ",") + "}", kOneOf + text::join(words, "|")};
}

ValueCheck file_or_subcommand(const std::vector<std::string>& subcommands) {
  const auto complaint = [subcommands](const std::string& word) -> std::string {
    std::error_code ignored;
    if (word.find_first_of("./") != std::string::npos || std::filesystem::exists(word, ignored))
      return "";
    return "'" + word + "' is neither a file nor a subcommand. The subcommands are " +
           text::join(subcommands, ", ") + text::suggestion(word, subcommands);
  };
  return {complaint, ""};
}

std::vector<std::string> choices_of(const CLI::Option& option) {
  // CLI11 2.1 only gives access to the checks of an option that may be changed, and does not state
  // their number.
  auto& changeable = const_cast<CLI::Option&>(option);
  for (int i = 0;; ++i) try {
      const std::string& name = changeable.get_validator(i)->get_name();
      if (!name.starts_with(kOneOf)) continue;
      std::istringstream each(name.substr(kOneOf.size()));
      std::vector<std::string> words;
      for (std::string word; std::getline(each, word, '|');) words.push_back(word);
      return words;
    } catch (const CLI::OptionNotFound&) {
      return {};
    }
}

}  // namespace ayumi::app
