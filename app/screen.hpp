#pragma once
// Answers that fit on a screen. Their least important parts are shortened first.

#include <string>
#include <vector>

namespace ayumi::app {

/// Importance of a part of an answer, the least important first. Every part is shortened once
/// before any part is shortened a second time, each time in the order of importance.
enum class Worth { origin, info, warning, remark, error, figure, verdict };

struct AnswerPart {
  Worth worth = Worth::verdict;
  std::vector<std::string> forms = {};  ///< whole lines; each form is shorter than the previous one
  size_t hang = 4;                      ///< column at which the rest of a broken line begins
};

/// Number of rows of an answer. Chosen: the smallest terminal in use has 24 rows of 80 columns. An
/// answer about a motion with errors may take as many rows as fit on half of a large screen.
inline constexpr size_t kRowsWhenGood = 22, kRowsWhenBad = 40;

/// Room for an answer beside the command above it and the prompt below it.
struct Room {
  size_t rows = kRowsWhenGood;
  size_t columns = 80;
};

/// A room of this many rows, as wide as standard output, or 80 columns if it is not a terminal.
Room room_of(size_t rows);

/// The parts in this order, each in the longest form for which there is room. If something was
/// shortened, the text ends with the line `more`.
std::string fitted(const std::vector<AnswerPart>& parts, const Room& room, const std::string& more);

/// Appends parts to other parts.
void append(std::vector<AnswerPart>& parts, std::vector<AnswerPart> more);

/// All parts in their longest form.
std::string in_full(const std::vector<AnswerPart>& parts);

/// The forms of a line for a terminal of 80 columns: as it is, in two rows, and in one row.
std::vector<std::string> shortened_line(const std::string& line);

}  // namespace ayumi::app
