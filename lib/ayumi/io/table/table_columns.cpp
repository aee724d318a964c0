#include "ayumi/io/table/table_columns.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/io/table/comma_cells.hpp"
#include "ayumi/model/validate.hpp"

namespace ayumi {

namespace {

std::string lower(std::string_view text) {
  std::string lowered(text);
  std::transform(lowered.begin(), lowered.end(), lowered.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lowered;
}

bool is_time(std::string_view column) {
  const std::string name = lower(column);
  return name == "t" || name == "time" || name == "timestamp" || name == "stamp";
}

[[noreturn]] void stop(const std::string& file, const std::string& reason) {
  fail(ErrorCode::bad_file, {file}, reason);
}

std::vector<std::string> known_columns() {
  std::vector<std::string> known = {"t[s]", "theta.<joint>[rad]", "fz[N]"};
  for (const auto* group : {&kCogColumns, &kZmpColumns, &kBaseColumns, &kContactColumns})
    known.insert(known.end(), group->begin(), group->end());
  return known;
}

std::vector<int> group_of(const NumberTable& table, const std::vector<std::string>& names,
                          const std::string& file) {
  std::vector<int> found;
  std::string present, missing;
  for (const std::string& name : names) {
    const int at = table.find(name);
    found.push_back(at);
    (at < 0 ? missing : present) = name;
  }
  if (present.empty()) return {};
  if (!missing.empty())
    stop(file, "the table has the column '" + present + "', but the column '" + missing +
                   "' is missing; add the missing column");
  return found;
}

void require_known(const std::string& column, const std::string& file) {
  const std::vector<std::string> known = known_columns();
  if (!joint_of_column(column).empty() ||
      std::find(known.begin(), known.end(), column) != known.end())
    return;
  const std::string hint = text::suggestion(column, known);
  stop(file, "unknown column '" + column + "'" +
                 (hint.empty() ? "; the known columns are " + text::join(known, ", ") : hint));
}

// The header values of a JSON table as text, with objects flattened: robot.name,
// provenance.pattern, ...
void flatten(const Json& value, const std::string& prefix,
             std::map<std::string, std::string>& header) {
  for (const auto& [key, item] : value.items()) {
    if (prefix.empty() && (key == "columns" || key == "data")) continue;
    if (item.is_object()) {
      flatten(item, prefix + key + ".", header);
    } else if (item.is_string()) {
      header[prefix + key] = item.get<std::string>();
    } else if (item.is_number()) {
      header[prefix + key] = text::exact(item.get<double>());
    }
  }
}

NumberTable parse_json_table(const std::string& bytes, const std::string& file) {
  const Json document = parse_json(bytes, file, ErrorCode::bad_file);
  const JsonNode root = root_of(document, file, ErrorCode::bad_file);
  root.expect_object();
  NumberTable table;
  flatten(document, "", table.header);
  table.columns = root.at("columns").strings();
  const JsonNode data = root.at("data");
  data.expect_array();
  if (data.size() == 0) data.complain("the table has no data row; add one");
  const auto width = static_cast<Eigen::Index>(table.columns.size());
  table.values.resize(static_cast<Eigen::Index>(data.size()), width);
  const std::vector<JsonNode> rows = data.items();
  for (size_t r = 0; r < rows.size(); ++r) {
    rows[r].expect_array();
    if (rows[r].size() != table.columns.size())
      rows[r].complain("the row has " + text::counted(rows[r].size(), "value") +
                       ", but \"columns\" names " + std::to_string(table.columns.size()));
    for (Eigen::Index c = 0; c < width; ++c) {
      const Json& cell = rows[r].value()[static_cast<size_t>(c)];
      if (!cell.is_number()) rows[r].items()[static_cast<size_t>(c)].number();
      table.values(static_cast<Eigen::Index>(r), c) = cell.get<double>();
    }
  }
  return table;
}

}  // namespace

std::string theta_column(const std::string& joint) { return "theta." + joint + "[rad]"; }

std::string joint_of_column(const std::string& column) {
  if (column.size() < 12 || !column.starts_with("theta.") || !column.ends_with("[rad]")) return "";
  return column.substr(6, column.size() - 11);
}

ColumnName column_name(const std::string& column) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const size_t at = column.find(open);
    if (at == std::string::npos || column.back() != close) continue;
    return {std::string(trimmed(std::string_view(column).substr(0, at))),
            lower(trimmed(std::string_view(column).substr(at + 1, column.size() - at - 2)))};
  }
  for (const std::string unit : {"s", "ms", "us", "ns", "deg", "rad"})
    if (lower(column).ends_with("_" + unit))
      return {column.substr(0, column.size() - unit.size() - 1), unit};
  return {column, ""};
}

bool is_time_column(const std::string& column) { return is_time(column_name(column).name); }

std::optional<double> seconds_of_time_column(const std::string& column) {
  const ColumnName named = column_name(column);
  if (!is_time(named.name)) return {};
  if (named.unit.empty() || named.unit == "s") return 1.0;
  if (named.unit == "ms") return 1e-3;
  if (named.unit == "us") return 1e-6;
  if (named.unit == "ns") return 1e-9;
  return {};
}

TableLayout layout_of(const NumberTable& table, const std::string& file) {
  TableLayout layout;
  for (size_t i = 0; i < table.columns.size(); ++i) {
    require_known(table.columns[i], file);
    const std::string joint = joint_of_column(table.columns[i]);
    if (joint.empty()) continue;
    layout.joints.push_back(joint);
    layout.theta.push_back(static_cast<int>(i));
  }
  layout.time = table.find("t[s]");
  if (layout.time < 0) stop(file, "the column 't[s]' is missing");
  layout.fz = table.find("fz[N]");
  layout.cog = group_of(table, kCogColumns, file);
  layout.zmp = group_of(table, kZmpColumns, file);
  layout.base = group_of(table, kBaseColumns, file);
  layout.contact = group_of(table, kContactColumns, file);
  return layout;
}

double tick_of(const NumberTable& table, const TableLayout& layout, const std::string& file) {
  const auto t = table.values.col(layout.time);
  const Eigen::Index rows = t.size();
  double dt = 0.001;
  if (const auto given = table.header.find("dt"); given != table.header.end()) {
    const std::string& text = given->second;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), dt);
    if (error != std::errc() || end != text.data() + text.size() || !(dt > 0) || dt > 1e3)
      stop(file, "dt '" + text + "' is not a time step in seconds");
  } else if (rows > 1) {
    dt = (t[rows - 1] - t[0]) / static_cast<double>(rows - 1);
    const double rate = std::round(1 / dt);
    if (std::abs(1 / dt - rate) < 1e-6 * rate) dt = 1 / rate;
  }
  for (Eigen::Index k = 0; k < rows; ++k) {
    if (k > 0 && t[k] <= t[k - 1])
      stop(file, "row " + std::to_string(k + 1) + ": time " + text::exact(t[k]) +
                     " s does not come after " + text::exact(t[k - 1]) +
                     " s of the row before; times must increase");
    if (std::abs(t[k] - static_cast<double>(k) * dt) > 1e-6 + 1e-4 * dt)
      stop(file, "row " + std::to_string(k + 1) + ": time " + text::exact(t[k]) + " s, but " +
                     text::exact(static_cast<double>(k) * dt) +
                     " s is expected, because the rows start at 0 s and are evenly spaced");
  }
  if (rows > 1 && !(dt >= kShortestServoPeriod && dt <= kLongestServoPeriod))
    stop(file, "the time between two rows is " + text::brief(dt) + " s, but it must be from " +
                   text::brief(kShortestServoPeriod) + " to " + text::brief(kLongestServoPeriod) +
                   " s");
  return dt;
}

bool holds_commands(const NumberTable& table) {
  const auto says = [&](const char* key, const char* value) {
    const auto found = table.header.find(key);
    return found != table.header.end() && found->second == value;
  };
  return says("format", kReferenceFormat) || says("theta", "commands");
}

std::string read_header_value(const std::string& text) {
  if (text.empty() || text.front() != '"') return text;
  const Json value = Json::parse(text, nullptr, false);
  return value.is_string() ? value.get<std::string>() : text;
}

Eigen::VectorXd zeros_of(const NumberTable& table, const TableLayout& layout,
                         const std::string& file) {
  const auto found = table.header.find("servo_offset");
  if (found == table.header.end()) return {};
  std::istringstream words(read_header_value(found->second));
  std::vector<double> zeros;
  for (double zero; words >> zero;) zeros.push_back(zero);
  const size_t joints = layout.joints.size();
  if (!words.eof() || zeros.size() != joints)
    fail(ErrorCode::bad_file, {file},
         "servo_offset in the head must have " + std::to_string(joints) +
             " numbers, one for each joint [rad], but the head has '" + found->second +
             "'; export the table again");
  return Eigen::Map<const Eigen::VectorXd>(zeros.data(), static_cast<Eigen::Index>(joints));
}

TableCaution caution_of(const NumberTable& table) {
  const auto line = [&](const char* key) {
    const auto found = table.header.find(key);
    return found == table.header.end() ? std::string() : read_header_value(found->second);
  };
  return {line("disturbances"), line("unfit")};
}

BasePose base_of(const NumberTable& table, const TableLayout& layout, Eigen::Index row,
                 const std::string& file) {
  const auto cell = [&](size_t i) { return table.values(row, layout.base[i]); };
  BasePose base;
  base.position = {cell(0), cell(1), cell(2)};
  base.attitude = Eigen::Quaterniond(cell(3), cell(4), cell(5), cell(6));
  const double norm = base.attitude.norm();
  if (std::abs(norm - 1) > 1e-6)
    stop(file, "row " + std::to_string(row + 1) + ": base.qw...qz has length " + text::exact(norm) +
                   ", but a unit quaternion (w, x, y, z) is needed");
  return base;
}

NumberTable number_table(const std::string& bytes, const std::string& file) {
  const size_t first = bytes.find_first_not_of(" \t\r\n");
  const bool json = first != std::string::npos && bytes[first] == '{';
  return json ? parse_json_table(bytes, file) : parse_csv(bytes, file);
}

NumberTable read_number_table(const std::filesystem::path& path) {
  return number_table(read_file(path), path.string());
}

}  // namespace ayumi
