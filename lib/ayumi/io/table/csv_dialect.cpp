#include "ayumi/io/table/csv_dialect.hpp"

#include <algorithm>
#include <string_view>

#include "ayumi/base/error.hpp"
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

// The character between the cells of the head row, which has no decimal commas.
char separator_of(std::string_view row, const std::string& file) {
  for (const char candidate : {';', ',', '\t'})
    if (row.find(candidate) != std::string_view::npos) return candidate;
  if (std::count(row.begin(), row.end(), ' ') > 1)
    fail(ErrorCode::bad_file, {file},
         "only blanks separate the columns; use commas, semicolons or tabs");
  return ',';
}

// The rows without their first cell, and without an empty cell at their end.
std::string without_outer_cells(std::string_view text, bool first, bool last) {
  std::string kept;
  while (!text.empty()) {
    std::string_view line = take_line(text);
    if (!line.empty() && line.front() != '#') {
      if (first) line.remove_prefix(std::min(line.find(',') + 1, line.size()));
      if (last && line.ends_with(',')) line.remove_suffix(1);
    }
    kept.append(line).push_back('\n');
  }
  return kept;
}

}  // namespace

std::string plain_table_text(const std::string& bytes, const std::string& file) {
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF"))
    fail(ErrorCode::bad_file, {file}, "this is UTF-16 text; save it as UTF-8");
  std::string text = bytes.starts_with("\xEF\xBB\xBF") ? bytes.substr(3) : bytes;
  const std::string_view head = first_row(text);
  if (head.empty() || head.front() == '{') return text;
  const char separator = separator_of(head, file);
  const bool unnamed = head.front() == separator, open = head.back() == separator;
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
  return unnamed || open ? without_outer_cells(text, unnamed, open) : text;
}

}  // namespace ayumi
