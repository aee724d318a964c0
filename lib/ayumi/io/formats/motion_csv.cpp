#include "ayumi/io/formats/motion_csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/io/table/comma_cells.hpp"
#include "ayumi/io/table/csv_dialect.hpp"

namespace ayumi {

namespace {

constexpr size_t kRootColumns = 7;

bool has_blanks_only(std::string_view bytes) {
  std::string_view first;
  while (!bytes.empty() && (first.empty() || is_comment(first))) first = take_line(bytes);
  return first.find_first_of(",;\t") == std::string_view::npos;
}

// Comments become empty lines, so that the other lines keep their numbers.
std::string without_comments(std::string_view bytes) {
  std::string text;
  while (!bytes.empty()) {
    const size_t end = std::min(bytes.find('\n'), bytes.size() - 1) + 1;
    const std::string_view line = bytes.substr(0, end);
    text.append(is_comment(trimmed(line)) ? "\n" : line);
    bytes.remove_prefix(end);
  }
  return text;
}

// The text with commas between its cells, which may be separated by blanks only.
std::string plain_rows(const std::string& bytes, const std::string& file) {
  if (!has_blanks_only(bytes)) return plain_table_text(without_comments(bytes), file);
  std::string text;
  for (std::string_view rest = bytes; !rest.empty();) {
    std::string_view line = take_line(rest);
    while (!line.empty() && line.front() != '#') {
      const size_t end = std::min(line.find(' '), line.size());
      text.append(line.substr(0, end));
      line = trimmed(line.substr(end));
      if (!line.empty()) text += ',';
    }
    text += '\n';
  }
  return text;
}

// The first rows of numbers; none if a row has other cells or too few.
std::vector<std::vector<double>> first_rows(const MotionInput& source) {
  constexpr size_t kRows = 5;
  std::string_view rest = source.bytes;
  std::string head;
  for (size_t rows = 0; rows < kRows && !rest.empty();) {
    const std::string_view line = take_line(rest);
    const bool row = !line.empty() && !is_comment(line);
    if (row) head.append(line);
    head.push_back('\n');
    rows += row;
  }
  if (head.find_first_not_of("0123456789+-.eE,; \t\"\n") != std::string::npos) return {};
  const std::string plain = plain_rows(head, source.file);
  std::vector<std::vector<double>> numbers;
  for (std::string_view text = plain; !text.empty();) {
    const std::string_view line = take_line(text);
    if (line.empty()) continue;
    std::vector<double>& row = numbers.emplace_back();
    for (std::string_view cell : cells_of(line)) {
      double value = 0;
      if (cell.starts_with('+')) cell.remove_prefix(1);
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc() || end != cell.data() + cell.size()) return {};
      row.push_back(value);
    }
    if (row.size() <= kRootColumns) return {};
  }
  return numbers;
}

}  // namespace

std::string recognize_motion_csv(const MotionInput& source) {
  const std::vector<std::vector<double>> rows = first_rows(source);
  if (rows.empty()) return "";
  // Rows of numbers between blanks may also be a log with times.
  if (has_blanks_only(source.bytes) &&
      rows.front().size() != kRootColumns + static_cast<size_t>(source.model.dof_count()))
    return "";
  for (const std::vector<double>& row : rows)
    if (!(std::abs(Eigen::Map<const Eigen::Vector4d>(row.data() + 3).norm() - 1) < kUnitQuaternion))
      return "";
  return "the rows have " + std::to_string(rows.front().size()) +
         " numbers, there is no head row, and columns 4 to 7 are a unit quaternion";
}

MotionFile read_motion_csv(const MotionInput& source) {
  const NumberRows table = number_rows(source, plain_rows(source.bytes, source.file), ",");
  const size_t width = table.rows.front().size();
  if (width <= kRootColumns)
    source.refuse(table.lines.front(),
                  "the row has " + std::to_string(width) +
                      " values, but 7 values of the root and the angles of the joints are needed");
  MotionFile motion;
  motion.values.resize(static_cast<Eigen::Index>(table.rows.size()),
                       static_cast<Eigen::Index>(width - kRootColumns));
  for (size_t k = 0; k < table.rows.size(); ++k) {
    const std::vector<double>& row = table.rows[k];
    const Eigen::Quaterniond q(row[6], row[3], row[4], row[5]);
    if (!(std::abs(q.norm() - 1) < kUnitQuaternion))
      source.refuse(table.lines[k], "the quaternion in columns 4 to 7 has length " +
                                        text::brief(q.norm()) + ", but 1 is needed");
    motion.base.push_back({{row[0], row[1], row[2]}, q});
    for (size_t i = kRootColumns; i < width; ++i)
      motion.values(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i - kRootColumns)) =
          row[i];
  }
  motion.unit = MotionFile::Unit::assumed;
  motion.notes = {"quaternion order: x y z w (assumed, as in LAFAN1)"};
  return motion;
}

std::vector<WrittenFile> write_motion_csv(const RobotModel&, const MotionFile& motion) {
  std::string text;
  for (Eigen::Index k = 0; k < motion.rows(); ++k) {
    const BasePose& base = motion.base[static_cast<size_t>(k)];
    const Eigen::Quaterniond& q = base.attitude;
    for (const double value :
         {base.position.x(), base.position.y(), base.position.z(), q.x(), q.y(), q.z()})
      text += text::exact(value) + ",";
    text += text::exact(q.w());
    for (const double value : motion.values.row(k)) text += "," + text::exact(value);
    text += "\n";
  }
  return {{"", text}};
}

}  // namespace ayumi
