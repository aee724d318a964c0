#include "ayumi/io/formats/motion_file.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/table/comma_cells.hpp"

namespace ayumi {

namespace fs = std::filesystem;

std::optional<std::string> MotionInput::beside(const std::string& extension) const {
  const fs::path other = fs::path(file).replace_extension(extension);
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored) || !fs::is_regular_file(other, ignored)) return {};
  return read_file(other);
}

void MotionInput::refuse(size_t line, const std::string& reason, bool names_remedy) const {
  SourcePlace place{file, "", static_cast<long>(line)};
  place.names_remedy = names_remedy;
  fail(ErrorCode::bad_file, place, reason);
}

double MotionInput::number(std::string_view cell, size_t line, const std::string& where) const {
  std::string shown(cell.substr(0, 24));
  std::replace_if(
      shown.begin(), shown.end(), [](unsigned char c) { return c < 32 || c > 126; }, '?');
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const std::string place = where.empty() ? "" : where + ": ";
  if (cell.empty() || error != std::errc() || end != cell.data() + cell.size()) {
    const bool comma = shown.find(',') != std::string::npos;
    refuse(line,
           place + "'" + shown + "' is not a number" + (comma ? "; write a decimal point" : ""),
           comma);
  }
  if (!std::isfinite(value)) refuse(line, place + "'" + shown + "' is not a finite number");
  return value;
}

size_t MotionInput::chosen_motion(const std::vector<std::string>& names,
                                  const std::vector<size_t>& numbers, MotionFile& motion) const {
  std::vector<std::string> shown;
  size_t chosen = options.motion.empty() ? 0 : names.size();
  for (size_t i = names.size(); i-- > 0;) {
    const std::string number = std::to_string(numbers.empty() ? i + 1 : numbers[i]);
    if (options.motion == number && chosen == names.size()) chosen = i;
    shown.insert(shown.begin(), number + (names[i].empty() ? "" : " '" + names[i] + "'"));
  }
  for (size_t i = names.size(); i-- > 0;)
    if (!options.motion.empty() && options.motion == names[i]) chosen = i;
  if (chosen == names.size())
    refuse(0, "there is no motion '" + options.motion + "'; the motions of the file are " +
                  text::join(shown, ", "));
  motion.name = names[chosen];
  motion.chosen = true;
  if (names.size() > 1)
    motion.notes.push_back("the motion " + shown[chosen] +
                           " is read; the motions of the file are " + text::join(shown, ", ") +
                           " (--motion chooses one)");
  return chosen;
}

namespace {

bool has_same_letters(const std::string& a, const std::string& b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

int find_joint(const RobotModel& model, const std::string& name) {
  const int dof = model.find_dof(name);
  if (dof >= 0) return dof;
  const auto& aliases = model.description().aliases;
  const auto found = aliases.find(name);
  if (found != aliases.end()) return model.find_dof(found->second);
  int same = -1;  // the only joint with this name in other letters, such as capital ones
  for (int i = 0; i < model.dof_count(); ++i)
    if (has_same_letters(model.dofs()[static_cast<size_t>(i)].name, name)) {
      if (same >= 0) return -1;
      same = i;
    }
  return same;
}

double repeatable(double value) { return std::round(1e12 * value) / 1e12 + 0.0; }

NumberRows number_rows(const MotionInput& source, std::string_view text,
                       const std::string& separators) {
  NumberRows result;
  for (size_t line = 1; !text.empty(); ++line) {
    std::string_view rest = take_line(text);
    if (rest.empty() || is_comment(rest)) continue;
    std::vector<double> row;
    if (!result.rows.empty()) row.reserve(result.rows.front().size());
    while (!rest.empty()) {
      const size_t end = std::min(rest.find_first_of(separators), rest.size());
      const std::string_view cell = trimmed(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
      if (cell.empty() && separators.find(' ') != std::string::npos) continue;
      row.push_back(source.number(cell, line, "value " + std::to_string(row.size() + 1)));
    }
    if (!result.rows.empty() && row.size() != result.rows.front().size())
      source.refuse(line, "the row has " + text::counted(row.size(), "value") +
                              ", but the first row has " +
                              std::to_string(result.rows.front().size()));
    result.rows.push_back(std::move(row));
    result.lines.push_back(line);
  }
  if (result.rows.empty())
    source.refuse(
        0, "the file has no row of numbers, so there is no motion to read; write the file again");
  return result;
}

}  // namespace ayumi
