#include "ayumi/io/table/csv_dialect.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "ayumi/base/error.hpp"
#include "ayumi/base/utf8.hpp"
#include "ayumi/io/table/comma_cells.hpp"

namespace ayumi {

namespace {

// The first line that is neither empty nor a comment.
std::string_view first_row(std::string_view rest) {
  while (!rest.empty()) {
    const std::string_view line = take_line(rest);
    if (!line.empty() && line.front() != '#') return line;
  }
  return {};
}

// Whether every comma is between two digits.
bool has_decimal_commas_only(std::string_view row) {
  const auto digit = [&](size_t i) {
    return i < row.size() && std::isdigit(static_cast<unsigned char>(row[i])) != 0;
  };
  for (size_t at = row.find(','); at != std::string_view::npos; at = row.find(',', at + 1))
    if (at == 0 || !digit(at - 1) || !digit(at + 1)) return false;
  return true;
}

// The character between the cells of the first row, which may have decimal commas. Tabs count as
// blanks if there are also commas that are not decimal commas.
char separator_of(std::string_view row, const std::string& file) {
  const bool decimal = has_decimal_commas_only(row);
  for (const char candidate : {';', decimal ? '\t' : ',', ','})
    if (row.find(candidate) != std::string_view::npos) return candidate;
  if (std::count(row.begin(), row.end(), ' ') > 1)
    fail(ErrorCode::bad_file, {file},
         "the columns are separated by blanks; use commas, semicolons or tabs");
  return ',';
}

// The rows without their first cell, which must be the number of the row, and without an empty cell
// at their end.
std::string without_outer_cells(std::string_view text, bool first, bool last,
                                const std::string& file) {
  std::string kept;
  bool names = false;  // the first row has more than numbers
  long head_line = 0, row = -1;
  for (long number = 1; !text.empty(); ++number) {
    std::string_view line = take_line(text);
    if (!line.empty() && line.front() != '#') {
      const std::string_view cell = trimmed(line.substr(0, line.find(',')));
      if (head_line == 0) {
        head_line = number;
        names = line.find_first_not_of("0123456789+-.eE, \t") != std::string_view::npos;
      } else {
        if (row < 0) row = cell == "1" ? 1 : 0;
        if (first && !(names && cell == std::to_string(row)))
          fail(ErrorCode::bad_file, {file, "", head_line},
               "the first cell is empty, but only a column that counts the rows (0, 1, 2, ... or "
               "1, 2, 3, ...) needs no name. If the column has the times, write t into this cell; "
               "otherwise remove the column");
        ++row;
      }
      if (first) line.remove_prefix(std::min(line.find(',') + 1, line.size()));
      if (last && line.ends_with(',')) line.remove_suffix(1);
    }
    kept.append(line).push_back('\n');
  }
  return kept;
}

}  // namespace

std::string plain_table_text(const std::string& bytes, const std::string& file,
                             std::vector<std::string>* notes) {
  if (const std::string refusal = text::wide_encoding_refusal(bytes); !refusal.empty())
    fail(ErrorCode::bad_file, {file}, refusal);
  std::string text = bytes.starts_with("\xEF\xBB\xBF") ? bytes.substr(3) : bytes;
  const std::string_view head = first_row(text);
  if (head.empty() || head.front() == '{') return text;
  const char separator = separator_of(head, file);
  const bool quoted = head.find('"') != std::string_view::npos;
  bool comment = false, begins = true;
  for (char& c : text) {
    if (begins) comment = c == '#';
    begins = c == '\n';
    if (comment) continue;
    if (quoted && c == '"') c = ' ';
    if (separator == ',') continue;
    if (c == ',') {
      c = '.';
    } else if (c == separator) {
      c = ',';
    }
  }
  // Tabs at the ends of the row are commas now.
  const std::string_view plain_head = first_row(text);
  const bool unnamed = plain_head.starts_with(','), open = plain_head.ends_with(',');
  if (unnamed && notes)
    notes->push_back("the first column has no name and counts the rows, so it is left out");
  return unnamed || open ? without_outer_cells(text, unnamed, open, file) : text;
}

}  // namespace ayumi
