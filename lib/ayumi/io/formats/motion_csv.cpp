#include "ayumi/io/formats/motion_csv.hpp"

#include <charconv>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/io/table/comma_cells.hpp"

namespace ayumi {

namespace {

constexpr size_t kRootColumns = 7;

std::vector<double> first_rows(std::string_view text, size_t& columns) {
  std::vector<double> lengths;
  for (int rows = 0; rows < 5 && !text.empty();) {
    const std::string_view line = take_line(text);
    if (line.empty() || line.front() == '#') continue;
    std::vector<double> row;
    for (const std::string_view cell : cells_of(line)) {
      double value = 0;
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc() || end != cell.data() + cell.size()) return {};
      row.push_back(value);
    }
    if (row.size() <= kRootColumns) return {};
    columns = row.size();
    lengths.push_back(
        std::sqrt(row[3] * row[3] + row[4] * row[4] + row[5] * row[5] + row[6] * row[6]));
    ++rows;
  }
  return lengths;
}

}  // namespace

std::string recognize_motion_csv(const MotionInput& source) {
  size_t columns = 0;
  const std::vector<double> lengths = first_rows(source.bytes, columns);
  if (lengths.empty()) return "";
  for (const double length : lengths)
    if (!(std::abs(length - 1) < kUnitQuaternion)) return "";
  return "the rows have " + std::to_string(columns) +
         " numbers, there is no head row, and columns 4 to 7 are a unit quaternion";
}

MotionFile read_motion_csv(const MotionInput& source) {
  const NumberRows table = number_rows(source, source.bytes, ",");
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
