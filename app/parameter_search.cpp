#include "parameter_search.hpp"

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern_file.hpp"

namespace ayumi::app {

namespace {

class Search {
 public:
  Search(const Context& context, const std::string& pattern, const PatternOptions& options,
         const std::vector<std::string>& tolerances)
      : context_(context), pattern_(pattern), options_(options), tolerances_(tolerances) {}

  bool passes(const std::string& parameter, double value) {
    report(context_.progress(), {"parameters", -1, parameter + " = " + text::brief(value)});
    PatternOptions options = options_;
    options.set.push_back(parameter + "=" + text::exact(value));
    Context silent = context_;
    silent.quiet = true;
    try {
      const PatternInput input = load_pattern(silent, pattern_, options);
      return check_consistency(input.model, input.series, check_options(input, tolerances_))
          .consistent;
    } catch (const Interrupted&) {
      throw;
    } catch (const Error&) {
      return false;
    }
  }

  // Steps to both sides, wider and wider, then the gap before the first that passes in halves.
  bool nearest(const std::string& parameter, double given, double& passing) {
    double tried = 0;
    for (const double share : {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0}) {
      for (const double sign : {-1.0, 1.0}) {
        if (sign < 0 && share >= 1) continue;
        double good = given * (1 + sign * share), bad = given * (1 + sign * tried);
        if (!passes(parameter, good)) continue;
        for (int i = 0; i < 4; ++i) {
          const double middle = 0.5 * (good + bad);
          (passes(parameter, middle) ? good : bad) = middle;
        }
        passing = good;
        return true;
      }
      tried = share;
    }
    return false;
  }

 private:
  const Context& context_;
  const std::string& pattern_;
  const PatternOptions& options_;
  const std::vector<std::string>& tolerances_;
};

}  // namespace

std::vector<PassingValue> passing_parameters(const Context& context, const std::string& pattern,
                                             const PatternOptions& options,
                                             const std::vector<std::string>& tolerances) {
  std::vector<PassingValue> result;
  Search search(context, pattern, options, tolerances);
  const Pattern given = read_pattern(pattern, read_pairs(options.set, "--set"));
  for (const auto& [name, value] : given.parameters) {
    double passing = 0;
    if (value != 0 && search.nearest(name, value, passing))
      result.push_back({name, value, passing});
  }
  return result;
}

}  // namespace ayumi::app
