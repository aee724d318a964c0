#pragma once
// Warnings that a person needs before a robot receives a joint table.

#include <string>
#include <vector>

namespace ayumi {

struct TableCaution {
  /// The scripted disturbances of the run that the table is from; empty for an undisturbed run. The
  /// table holds the reactions to them, which no robot should repeat.
  std::string disturbances;
  /// The reason why no robot should receive the table, such as "the run fell at 2.31 s"; empty if
  /// there is no such reason.
  std::string unfit;
};

/// Adds the warnings for one part of a table to those for the whole table.
inline void add_caution(TableCaution& caution, const TableCaution& more) {
  const auto add = [](std::string& text, const std::string& other) {
    if (!other.empty()) text += (text.empty() ? "" : "; ") + other;
  };
  add(caution.disturbances, more.disturbances);
  add(caution.unfit, more.unfit);
}

/// The warnings as sentences of one line each; empty if there are none.
inline std::vector<std::string> words_of(const TableCaution& caution) {
  std::vector<std::string> words;
  if (!caution.unfit.empty())
    words.push_back("the table is not for a robot, because " + caution.unfit);
  if (!caution.disturbances.empty())
    words.push_back("the table contains the reactions of the robot to disturbances: " +
                    caution.disturbances);
  return words;
}

}  // namespace ayumi
