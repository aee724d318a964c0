#include "ayumi/io/table/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/table/table_columns.hpp"
#include "ayumi/model/encoder_angles.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

namespace {

constexpr const char* kFrame = "world: x forward, y left, z up";
constexpr const char* kUnits = "m, rad, s, N";
constexpr const char* kQuaternion = "w x y z, base to world";

void append(std::vector<std::string>& list, const std::vector<std::string>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

std::vector<std::string> reference_columns(const ReferenceTrajectory& reference) {
  std::vector<std::string> columns = {"t[s]"};
  for (const std::string& joint : reference.joints) columns.push_back(theta_column(joint));
  append(columns, kCogColumns);
  append(columns, kZmpColumns);
  columns.push_back("fz[N]");
  append(columns, kBaseColumns);
  append(columns, kContactColumns);
  return columns;
}

void add(std::vector<double>& row, const Eigen::Vector3d& v) {
  row.insert(row.end(), {v.x(), v.y(), v.z()});
}

void add(std::vector<double>& row, const BasePose& base) {
  add(row, base.position);
  const Eigen::Quaterniond& q = base.attitude;
  row.insert(row.end(), {q.w(), q.x(), q.y(), q.z()});
}

std::vector<double> cells_of(const ReferenceTrajectory& reference, size_t k) {
  const ReferenceRow& row = reference.rows[k];
  require(row.theta.size() == static_cast<Eigen::Index>(reference.joints.size()),
          "a reference row has another number of joints than the table");
  std::vector<double> cells = {static_cast<double>(k) * reference.dt};
  const Eigen::VectorXd targets = encoder_angles(row.theta, reference.servo.zeros);
  cells.insert(cells.end(), targets.begin(), targets.end());
  add(cells, row.cog);
  add(cells, row.zmp);
  cells.push_back(row.fz);
  add(cells, row.base);
  for (const bool contact : row.contact) cells.push_back(contact ? 1 : 0);
  return cells;
}

// Numbers in the form "1,2,3". Negative zero is "-0" in CSV, but JSON needs "-0.0" to read it back
// as such.
void append_cells(std::string& text, const std::vector<double>& cells, bool json) {
  for (size_t i = 0; i < cells.size(); ++i) {
    require(std::isfinite(cells[i]), "a table value is not finite");
    if (i > 0) text += ',';
    text += json && cells[i] == 0 && std::signbit(cells[i]) ? "-0.0" : text::exact(cells[i]);
  }
}

// A header value is one line; a value that is not plain text is quoted as in JSON.
std::string header_value(const std::string& value) {
  const bool plain = value.find_first_of("\n\r\"\\") == std::string::npos &&
                     (value.empty() || (value.front() != ' ' && value.back() != ' '));
  return plain ? value : Json(value).dump(-1, ' ', true, Json::error_handler_t::replace);
}

// The keys and values of the lines above a table, in order.
using HeaderLines = std::vector<std::pair<std::string, std::string>>;

std::string csv_header(const HeaderLines& lines) {
  std::string text;
  for (const auto& [key, value] : lines) text += "# " + key + ": " + header_value(value) + "\n";
  return text;
}

HeaderLines common_header(const char* format, double dt) {
  return {{"format", format},
          {"tool", std::string("ayumi ") + version()},
          {"units", kUnits},
          {"frame", kFrame},
          {"quaternion_order", kQuaternion},
          {"gravity", text::exact(kGravity)},
          {"dt", text::exact(dt)},
          {"rate_hz", text::exact(1 / dt)}};
}

HeaderLines provenance_lines(const Provenance& p) {
  return {{"robot", p.robot},
          {"robot_sha256", p.robot_sha256},
          {"pattern", p.pattern},
          {"pattern_sha256", p.pattern_sha256},
          {"profile", p.profile},
          {"controller", p.controller},
          {"command_line", p.command_line}};
}

// The servo for which the table was made, if it is known, and the zeros of the encoders.
HeaderLines servo_lines(const TableServo& servo) {
  HeaderLines lines;
  if (!servo.content.empty())
    lines = {{"servo", servo.content},
             {"servo_profile", servo.profile},
             {"servo_delay", servo.delay},
             {"servo_lag", servo.lag}};
  if (servo.zeros.isZero(0)) return lines;
  std::vector<std::string> zeros;
  for (const double zero : servo.zeros) zeros.push_back(text::exact(zero));
  lines.emplace_back("servo_offset", text::join(zeros, " "));
  return lines;
}

// What a person has to know before a robot receives the table; most tables have no such caution.
HeaderLines caution_lines(const TableCaution& caution) {
  HeaderLines lines;
  if (!caution.disturbances.empty()) lines.emplace_back("disturbances", caution.disturbances);
  if (!caution.unfit.empty()) lines.emplace_back("unfit", caution.unfit);
  return lines;
}

Provenance provenance_of(const std::map<std::string, std::string>& header) {
  const auto value = [&](const char* key) {
    for (const std::string& name : {std::string(key), "provenance." + std::string(key)})
      if (const auto found = header.find(name); found != header.end())
        return read_header_value(found->second);
    return std::string();
  };
  return {value("robot"),   value("robot_sha256"), value("pattern"),     value("pattern_sha256"),
          value("profile"), value("controller"),   value("command_line")};
}

TableServo servo_of(const std::map<std::string, std::string>& header) {
  const auto value = [&](const char* key) {
    const auto found = header.find(key);
    return found == header.end() ? std::string() : read_header_value(found->second);
  };
  return {value("servo"), value("servo_profile"), value("servo_delay"), value("servo_lag"), {}};
}

void require_format(const NumberTable& table, const char* format, const std::string& file) {
  const auto found = table.header.find("format");
  if (found == table.header.end())
    fail(ErrorCode::bad_file, {file},
         std::string("the format line is missing; add '# format: ") + format + "'");
  if (found->second != format)
    fail(ErrorCode::bad_file, {file},
         "format '" + found->second + "' cannot be read; this version of Ayumi reads '" + format +
             "'");
}

Eigen::Vector3d vector_of(const NumberTable& table, Eigen::Index row, const std::vector<int>& at) {
  return {table.values(row, at[0]), table.values(row, at[1]), table.values(row, at[2])};
}

Eigen::VectorXd theta_of(const NumberTable& table, Eigen::Index row, const std::vector<int>& at) {
  Eigen::VectorXd theta(static_cast<Eigen::Index>(at.size()));
  for (size_t j = 0; j < at.size(); ++j)
    theta[static_cast<Eigen::Index>(j)] = table.values(row, at[j]);
  return theta;
}

// Reads what the head of a table says about the sequence that was imported.
void read_import(const std::map<std::string, std::string>& header,
                 const std::filesystem::path& table, DenseTable& dense) {
  const auto line = [&](const char* key) {
    const auto found = header.find(key);
    return found == header.end() ? std::string() : read_header_value(found->second);
  };
  const std::string interval = line("interval_ms");
  std::from_chars(interval.data(), interval.data() + interval.size(), dense.interval_ms);
  const std::string file = line("sequence");
  if (file.empty()) return;
  // The name is the one that write_pattern_and_table() gives: relative to the real folder, whatever
  // links lead there.
  const std::filesystem::path named = std::filesystem::absolute(table).parent_path() / file;
  dense.sequence = {std::filesystem::weakly_canonical(named), line("sequence_sha256"),
                    line("theta_sha256")};
  dense.encoders = line("encoders_sha256");
}

}  // namespace

std::string reference_csv(const ReferenceTrajectory& reference, const TableCaution& caution) {
  std::string text = csv_header(common_header(kReferenceFormat, reference.dt)) +
                     csv_header(provenance_lines(reference.provenance)) +
                     csv_header(servo_lines(reference.servo)) + csv_header(caution_lines(caution)) +
                     text::join(reference_columns(reference), ",") + "\n";
  for (size_t k = 0; k < reference.rows.size(); ++k) {
    append_cells(text, cells_of(reference, k), false);
    text += '\n';
  }
  return text;
}

std::string reference_json(const ReferenceTrajectory& reference, const TableCaution& caution) {
  const auto quoted = [](const std::string& value) {
    return Json(value).dump(-1, ' ', false, Json::error_handler_t::replace);
  };
  std::string text = "{\n";
  for (const auto& [key, value] : common_header(kReferenceFormat, reference.dt)) {
    const bool number = key == "gravity" || key == "dt" || key == "rate_hz";
    text += "  " + quoted(key) + ": " + (number ? value : quoted(value)) + ",\n";
  }
  for (const auto& [key, value] : servo_lines(reference.servo))
    text += "  " + quoted(key) + ": " + quoted(value) + ",\n";
  for (const auto& [key, value] : caution_lines(caution))
    text += "  " + quoted(key) + ": " + quoted(value) + ",\n";
  std::vector<std::string> members;
  for (const auto& [key, value] : provenance_lines(reference.provenance))
    members.push_back("    " + quoted(key) + ": " + quoted(value));
  text += "  \"provenance\": {\n" + text::join(members, ",\n") + "\n  },\n";
  std::vector<std::string> columns;
  for (const std::string& column : reference_columns(reference)) columns.push_back(quoted(column));
  text += "  \"columns\": [" + text::join(columns, ", ") + "],\n  \"data\": [";
  for (size_t k = 0; k < reference.rows.size(); ++k) {
    text += k > 0 ? ",\n    [" : "\n    [";
    append_cells(text, cells_of(reference, k), true);
    text += ']';
  }
  return text + "\n  ]\n}\n";
}

ReferenceTrajectory read_reference(const std::filesystem::path& path) {
  return parse_reference(read_file(path), path.string());
}

ReferenceTrajectory parse_reference(const std::string& bytes, const std::string& file) {
  const NumberTable table = number_table(bytes, file);
  require_format(table, kReferenceFormat, file);
  const TableLayout layout = layout_of(table, file);
  if (layout.joints.empty() || layout.cog.empty() || layout.zmp.empty() || layout.fz < 0 ||
      layout.base.empty() || layout.contact.empty())
    fail(
        ErrorCode::bad_file, {file},
        "a reference table needs the columns of theta, cog, zmp, fz, base and contact, but some of "
        "these columns are missing; export the table again");
  ReferenceTrajectory reference;
  reference.dt = tick_of(table, layout, file);
  reference.joints = layout.joints;
  reference.provenance = provenance_of(table.header);
  reference.servo = servo_of(table.header);
  const Eigen::VectorXd zeros = zeros_of(table, layout, file);
  reference.servo.zeros = zeros;
  for (Eigen::Index k = 0; k < table.values.rows(); ++k) {
    ReferenceRow row;
    row.theta = joint_angles(theta_of(table, k, layout.theta), zeros);
    row.base = base_of(table, layout, k, file);
    row.cog = vector_of(table, k, layout.cog);
    row.zmp = vector_of(table, k, layout.zmp);
    row.fz = table.values(k, layout.fz);
    for (size_t i = 0; i < 2; ++i) {
      const double contact = table.values(k, layout.contact[i]);
      if (contact != 0 && contact != 1)
        fail(ErrorCode::bad_file, {file},
             "row " + std::to_string(k + 1) + ": " + kContactColumns[i] + " is " +
                 text::exact(contact) + ", but 0 or 1 is needed");
      row.contact[i] = contact == 1;
    }
    reference.rows.push_back(std::move(row));
  }
  return reference;
}

TableCaution read_table_caution(const std::filesystem::path& path) {
  return parse_table_caution(read_file(path), path.string());
}

TableCaution parse_table_caution(const std::string& bytes, const std::string& file) {
  if (!bytes.starts_with('#')) return caution_of(number_table(bytes, file));
  std::string head;
  for (size_t at = 0; at < bytes.size() && bytes[at] == '#';) {
    const size_t end = std::min(bytes.find('\n', at), bytes.size() - 1) + 1;
    head += bytes.substr(at, end - at);
    at = end;
  }
  return caution_of(parse_csv(head + "\nt[s]\n0\n", file));
}

void require_joints(const ReferenceTrajectory& reference, const std::vector<std::string>& joints,
                    const std::string& file) {
  if (reference.joints.size() != joints.size())
    fail(ErrorCode::bad_file, {file},
         "the table has " + std::to_string(reference.joints.size()) +
             " joints, but the robot has " + std::to_string(joints.size()) +
             "; name the robot of the table");
  for (size_t i = 0; i < joints.size(); ++i)
    if (reference.joints[i] != joints[i])
      fail(ErrorCode::bad_file, {file},
           "joint " + std::to_string(i + 1) + " of the table is '" + reference.joints[i] +
               "', but joint " + std::to_string(i + 1) + " of the robot is '" + joints[i] + "'");
}

std::string theta_sha256(const DenseTable& table) {
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = table.theta;
  std::string text;
  for (const std::string& joint : table.joints) text += joint + "\n";
  text.append(reinterpret_cast<const char*>(rows.data()),
              static_cast<size_t>(rows.size()) * sizeof(double));
  return sha256(text);
}

DenseTable read_dense_table(const std::filesystem::path& path) {
  const std::string file = path.string();
  const NumberTable table = read_number_table(path);
  const TableLayout layout = layout_of(table, file);
  DenseTable dense;
  dense.file = file;
  dense.dt = tick_of(table, layout, file);
  dense.joints = layout.joints;
  dense.commands = holds_commands(table);
  read_import(table.header, path, dense);
  const Eigen::Index rows = table.values.rows();
  if (static_cast<double>(rows) * dense.dt > 3600)
    fail(ErrorCode::bad_file, {file},
         "the table lasts " + text::exact(static_cast<double>(rows) * dense.dt) +
             " s, but Ayumi reads at most 3600 s");
  const Eigen::VectorXd zeros = zeros_of(table, layout, file);
  dense.theta.resize(rows, static_cast<Eigen::Index>(layout.joints.size()));
  for (Eigen::Index k = 0; k < rows; ++k) {
    dense.theta.row(k) = joint_angles(theta_of(table, k, layout.theta), zeros).transpose();
    if (!layout.base.empty()) dense.base.push_back(base_of(table, layout, k, file));
    if (!layout.cog.empty()) dense.cog.push_back(vector_of(table, k, layout.cog));
    if (!layout.zmp.empty()) dense.zmp.push_back(vector_of(table, k, layout.zmp));
    if (layout.fz >= 0) dense.fz.push_back(table.values(k, layout.fz));
  }
  return dense;
}

std::string dense_table_csv(const DenseTable& table, const TableCaution& caution) {
  std::vector<std::string> columns = {"t[s]"};
  for (const std::string& joint : table.joints) columns.push_back(theta_column(joint));
  if (!table.cog.empty()) append(columns, kCogColumns);
  if (!table.zmp.empty()) append(columns, kZmpColumns);
  if (!table.fz.empty()) columns.push_back("fz[N]");
  if (!table.base.empty()) append(columns, kBaseColumns);
  auto header = common_header(kMotionFormat, table.dt);
  if (table.commands) header.emplace_back("theta", "commands");
  if (table.interval_ms > 0) header.emplace_back("interval_ms", std::to_string(table.interval_ms));
  if (const auto& kept = table.sequence) {
    header.emplace_back("sequence", kept->file);
    header.emplace_back("sequence_sha256", kept->sha256);
    header.emplace_back("theta_sha256", kept->theta_sha256);
    if (!table.encoders.empty()) header.emplace_back("encoders_sha256", table.encoders);
  }
  for (const auto& line : caution_lines(caution)) header.push_back(line);
  std::string text = csv_header(header) + text::join(columns, ",") + "\n";
  for (Eigen::Index k = 0; k < table.theta.rows(); ++k) {
    const auto at = static_cast<size_t>(k);
    std::vector<double> cells = {static_cast<double>(k) * table.dt};
    for (const double value : table.theta.row(k)) cells.push_back(value);
    if (!table.cog.empty()) add(cells, table.cog[at]);
    if (!table.zmp.empty()) add(cells, table.zmp[at]);
    if (!table.fz.empty()) cells.push_back(table.fz[at]);
    if (!table.base.empty()) add(cells, table.base[at]);
    append_cells(text, cells, false);
    text += '\n';
  }
  return text;
}

}  // namespace ayumi
