#include "option_checks.hpp"

#include "ayumi/base/text.hpp"

namespace ayumi::app {

CLI::Validator number_within(double least, double most) {
  const std::string least_text = text::brief(least), most_text = text::brief(most);
  const auto complaint = [=](const std::string& word) -> std::string {
    double value = 0;
    const bool fits = CLI::detail::lexical_cast(word, value) && value >= least && value <= most;
    return fits ? ""
                : word + " is not a number in the range from " + least_text + " to " + most_text;
  };
  return {complaint, "in [" + least_text + " - " + most_text + "]"};
}

}  // namespace ayumi::app
