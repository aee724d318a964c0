#include "option_checks.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"

namespace ayumi::app {

CLI::Validator number_within(double least, double most) {
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

CLI::Validator whole_number_within(int least, int most) {
  const std::string least_text = std::to_string(least), most_text = std::to_string(most);
  const auto complaint = [=](const std::string& word) -> std::string {
    int value = 0;
    const bool fits = CLI::detail::lexical_cast(word, value) && value >= least && value <= most;
    return fits ? ""
                : "'" + word + "' is not a whole number from " + least_text + " to " + most_text;
  };
  return {complaint, "INT in [" + least_text + " - " + most_text + "]"};
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  const auto complaint = [words](const std::string& word) -> std::string {
    if (std::find(words.begin(), words.end(), word) != words.end()) return "";
    return "'" + word + "' is not one of " + text::join(words, ", ") +
           text::suggestion(word, words);
  };
  return {complaint, "{" + text::join(words, ",") + "}"};
}

}  // namespace ayumi::app
