#include "screen.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "terminal.hpp"

namespace ayumi::app {

namespace {

// A line that is too long continues at column `hang`, or at its own indentation if this is larger.
std::string broken(const std::string& text, size_t hang, size_t columns) {
  std::string out;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    out += broken_line(line, std::max(hang, std::min(line.find_first_not_of(' '), line.size())),
                       columns) +
           "\n";
    begin = end + 1;
  }
  return out;
}

size_t rows_of(const std::string& text) {
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

// The first words of the line that fit into this many columns.
std::string beginning(const std::string& line, size_t most) {
  if (columns_of(line) <= most) return line + "\n";
  const size_t blank = line.rfind(' ', bytes_within(line, most - 4));
  return line.substr(0, blank) + " ...\n";
}

// The form in which each part is shown.
class Choice {
 public:
  Choice(const std::vector<AnswerPart>& parts, const Room& room)
      : parts_(parts), room_(room), form_(parts.size(), 0) {}

  std::string text(size_t columns) const {
    std::string out;
    for (size_t i = 0; i < parts_.size(); ++i)
      out += broken(parts_[i].forms[form_[i]], parts_[i].hang, columns);
    return out;
  }

  bool fits(const std::string& more) const {
    return rows_of(text(room_.columns)) + rows_of(broken(more, 4, room_.columns)) <= room_.rows;
  }

  /// Shortens one more part. Returns false if nothing can be shortened.
  bool shorten() {
    size_t found = parts_.size();
    const auto before = [&](size_t a, size_t b) {
      if (form_[a] != form_[b]) return form_[a] < form_[b];
      return parts_[a].worth < parts_[b].worth;
    };
    // Of parts that are equally important, the last one is shortened.
    for (size_t i = 0; i < parts_.size(); ++i)
      if (form_[i] + 1 < parts_[i].forms.size() && (found == parts_.size() || !before(found, i)))
        found = i;
    if (found == parts_.size()) return false;
    ++form_[found];
    return true;
  }

 private:
  const std::vector<AnswerPart>& parts_;
  const Room& room_;
  std::vector<size_t> form_;
};

}  // namespace

Room room_of(size_t rows) {
  Room room;
  room.rows = rows;
  if (const size_t columns = terminal_columns()) room.columns = columns;
  return room;
}

std::string fitted(const std::vector<AnswerPart>& parts, const Room& room,
                   const std::string& more) {
  Choice choice(parts, room);
  if (choice.fits("")) return choice.text(terminal_columns());
  while (!choice.fits(more) && choice.shorten()) {
  }
  return choice.text(terminal_columns()) + broken(more, 4, terminal_columns());
}

void append(std::vector<AnswerPart>& parts, std::vector<AnswerPart> more) {
  std::move(more.begin(), more.end(), std::back_inserter(parts));
}

std::string in_full(const std::vector<AnswerPart>& parts) {
  std::string out;
  for (const AnswerPart& part : parts)
    out += broken(part.forms.front(), part.hang, terminal_columns());
  return out;
}

std::vector<std::string> shortened_line(const std::string& line) {
  // Number of columns in two rows and in one row of 80 columns. Two rows lose a few columns where a
  // line is broken and its rest is indented.
  constexpr size_t kTwoRows = 144, kOneRow = 78;
  return {line + "\n", beginning(line, kTwoRows), beginning(line, kOneRow)};
}

}  // namespace ayumi::app
