#include "ayumi/io/table/number_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/io/table/comma_cells.hpp"

namespace ayumi {

namespace {

// A cell as it may appear in a message: short and printable.
std::string shown(std::string_view cell) {
  std::string text(cell.substr(0, 24));
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32 || c > 126; }, '?');
  return "'" + text + (cell.size() > 24 ? "...'" : "'");
}

class CsvParser {
 public:
  CsvParser(const std::string& bytes, const std::string& file) : rest_(bytes), file_(file) {}

  NumberTable whole() {
    if (rest_.find('\0') != std::string_view::npos)
      fail(ErrorCode::bad_file, {file_}, "this is a binary file, but a CSV table is needed");
    for (std::string_view line; next(line);) {
      if (line.empty()) continue;
      if (line.front() == '#') {
        if (table_.columns.empty()) header(line.substr(1));
      } else if (table_.columns.empty()) {
        head_row(line);
      } else {
        data_row(line);
      }
    }
    if (table_.columns.empty())
      fail(ErrorCode::bad_file, {file_},
           "the head row is missing; the first line must name the "
           "columns (t[s],theta.<joint>[rad],...)");
    if (cells_.empty())
      fail(ErrorCode::bad_file, {file_}, "there is no data row below the head row");
    const auto width = static_cast<Eigen::Index>(table_.columns.size());
    table_.values = Eigen::Map<const decltype(table_.values)>(
        cells_.data(), static_cast<Eigen::Index>(cells_.size()) / width, width);
    return std::move(table_);
  }

 private:
  [[noreturn]] void stop(const std::string& reason) const {
    fail(ErrorCode::bad_file, {file_, "", static_cast<long>(line_)}, reason);
  }

  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    line = take_line(rest_);
    ++line_;
    return true;
  }

  void header(std::string_view line) {
    const size_t colon = line.find(':');
    if (colon == std::string_view::npos) return;
    table_.header[std::string(trimmed(line.substr(0, colon)))] = trimmed(line.substr(colon + 1));
  }

  void head_row(std::string_view line) {
    std::set<std::string> seen;
    for_each_cell(line, [&](std::string_view cell) {
      const std::string name(cell);
      double number = 0;
      if (std::from_chars(cell.data(), cell.data() + cell.size(), number).ec == std::errc())
        stop("the head row is missing: the first line has the number " + shown(cell) +
             ", but it must name the columns (t[s],theta.<joint>[rad],...)");
      if (name.empty()) stop("column " + std::to_string(seen.size() + 1) + " has no name");
      if (!seen.insert(name).second) stop("the column " + shown(cell) + " appears twice; keep one");
      table_.columns.push_back(name);
    });
  }

  void data_row(std::string_view line) {
    const size_t begin = cells_.size();
    for_each_cell(line, [&](std::string_view cell) {
      const size_t column = cells_.size() - begin;
      if (column >= table_.columns.size()) stop(width_message(line));
      double number = 0;
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
      const std::string name = "column '" + table_.columns[column] + "': ";
      if (error != std::errc() || end != cell.data() + cell.size())
        stop(name + shown(cell) + " is not a number");
      if (!std::isfinite(number)) stop(name + shown(cell) + " is not a finite number");
      cells_.push_back(number);
    });
    if (cells_.size() - begin != table_.columns.size()) stop(width_message(line));
  }

  std::string width_message(std::string_view line) const {
    return "the row has " + text::counted(std::count(line.begin(), line.end(), ',') + 1, "value") +
           ", but the head row names " + text::counted(table_.columns.size(), "column");
  }

  std::string_view rest_;
  const std::string& file_;
  NumberTable table_;
  std::vector<double> cells_;
  size_t line_ = 0;
};

}  // namespace

int NumberTable::find(const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

NumberTable parse_csv(const std::string& bytes, const std::string& file) {
  if (bytes.empty()) fail(ErrorCode::bad_file, {file}, "the file is empty");
  return CsvParser(bytes, file).whole();
}

}  // namespace ayumi
