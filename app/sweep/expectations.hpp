#pragma once
// Expectations on the results of a sweep ("falls == 0"), and the results for other tools: JSON and
// JUnit.

#include <nlohmann/json.hpp>

#include "sweep/results_database.hpp"

namespace ayumi::app {

/// Confidence of the intervals of failure rates. Definition.
inline constexpr double kRateConfidence = 0.95;

struct Expectation {
  std::string text;  ///< the expectation as it was given
  bool met = false;
  std::string found;  ///< the values of the names in it, such as "falls = 3"
};

/// Each expectation is an SQL expression over the view "summary". "errors == 0" is always expected.
/// Throws Error(usage) for an expression that SQLite cannot evaluate.
std::vector<Expectation> judge_expectations(const ResultsDatabase& results,
                                            const std::vector<std::string>& texts);

/// Settings and figures of the worst cases, in order from the worst one.
nlohmann::ordered_json worst_cases(const ResultsDatabase& results, int count);
nlohmann::ordered_json results_json(const ResultsDatabase& results,
                                    const std::vector<Expectation>& expectations);
/// The results as JUnit text, with one test case for each expectation.
std::string junit_text(const ResultsDatabase& results,
                       const std::vector<Expectation>& expectations);

}  // namespace ayumi::app
