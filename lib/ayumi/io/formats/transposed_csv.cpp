#include "ayumi/io/formats/transposed_csv.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/table_motion.hpp"
#include "ayumi/io/table/comma_cells.hpp"
#include "ayumi/io/table/csv_dialect.hpp"
#include "ayumi/io/table/table_columns.hpp"

namespace ayumi {

namespace {

bool is_number(std::string_view cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return !cell.empty() && error == std::errc() && end == cell.data() + cell.size();
}

// Rows of words, such as comments on the key postures, contain no number at all.
bool has_words_only(const std::vector<std::string_view>& cells) {
  bool words = false;
  for (size_t i = 1; i < cells.size(); ++i) {
    if (is_number(cells[i])) return false;
    words = words || std::any_of(cells[i].begin(), cells[i].end(), [](char c) {
              return std::isalpha(static_cast<unsigned char>(c)) ||
                     static_cast<unsigned char>(c) >= 0x80;
            });
  }
  return words;
}

// The first line in plain form; "" if only blanks separate its cells.
std::string first_line(const MotionInput& source) {
  std::string_view rest = source.bytes;
  const std::string line(take_line(rest));
  return line.find_first_of(",;\t") == std::string::npos ? "" : plain_table_text(line, source.file);
}

}  // namespace

std::string recognize_transposed_csv(const MotionInput& source) {
  const std::string text = first_line(source);
  const std::vector<std::string_view> head = cells_of(text);
  const bool times =
      head.size() > 1 && seconds_of_time_column(std::string(head[0])) && is_number(head[1]);
  return times ? "the first row has times, so each further row is a joint" : "";
}

MotionFile read_transposed_csv(const MotionInput& source) {
  const std::string plain = plain_table_text(source.bytes, source.file);
  std::string_view rest = plain;
  MotionFile motion;
  std::vector<std::vector<double>> joints;
  for (size_t line = 1; !rest.empty(); ++line) {
    const std::string_view text = take_line(rest);
    if (text.empty() || text.front() == '#') continue;
    const std::vector<std::string_view> cells = cells_of(text);
    if (!motion.times.empty() && has_words_only(cells) &&
        find_joint(source.model, std::string(cells[0])) < 0) {
      motion.notes.push_back("row '" + std::string(cells[0].substr(0, 48)) + "' (line " +
                             std::to_string(line) +
                             ") has words and no numbers, so it is left out");
      continue;
    }
    std::vector<double> row;
    for (size_t i = 1; i < cells.size(); ++i)
      row.push_back(source.number(cells[i], line, "value " + std::to_string(i)));
    if (motion.times.empty()) {
      const double seconds = seconds_of_time_column(std::string(cells[0])).value_or(1);
      for (double& time : row) time *= seconds;
      for (size_t i = 1; i < row.size(); ++i)
        if (!(row[i] > row[i - 1]))
          source.refuse(line, "time " + text::brief(row[i]) + " s does not come after " +
                                  text::brief(row[i - 1]) +
                                  " s; times must increase, so correct or remove this column");
      if (row.empty())
        source.refuse(line, "the first row has no time; give the times of the columns");
      motion.times = std::move(row);
      continue;
    }
    if (row.size() != motion.times.size())
      source.refuse(line, "the row of '" + std::string(cells[0].substr(0, 48)) + "' has " +
                              text::counted(row.size(), "value") + ", but the first row has " +
                              text::counted(motion.times.size(), "time"));
    motion.joints.emplace_back(cells[0]);
    joints.push_back(std::move(row));
  }
  if (joints.empty())
    source.refuse(0, "the file has no row of a joint below the row of times; write the file again");
  motion.values.resize(static_cast<Eigen::Index>(motion.times.size()),
                       static_cast<Eigen::Index>(joints.size()));
  for (size_t i = 0; i < joints.size(); ++i)
    motion.values.col(static_cast<Eigen::Index>(i)) =
        Eigen::Map<Eigen::VectorXd>(joints[i].data(), static_cast<Eigen::Index>(joints[i].size()));
  motion.keys = true;
  motion.unit = MotionFile::Unit::assumed;
  return motion;
}

std::vector<WrittenFile> write_transposed_csv(const RobotModel&, const MotionFile& motion) {
  std::string text = "time";
  for (const double time : motion.times) text += "," + text::exact(time);
  text += "\n";
  for (size_t i = 0; i < motion.joints.size(); ++i) {
    text += motion.joints[i];
    for (const double value : motion.values.col(static_cast<Eigen::Index>(i)))
      text += "," + text::exact(value);
    text += "\n";
  }
  return {{"", text}};
}

}  // namespace ayumi
