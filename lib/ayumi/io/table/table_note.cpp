#include "ayumi/io/table/table_note.hpp"

#include <sstream>

#include "ayumi/base/file.hpp"

namespace ayumi {

namespace {

constexpr const char* kHead = "About the joint table beside this file, by ayumi export\n";
constexpr const char *kDisturbances = "disturbances: ", *kUnfit = "unfit: ";

}  // namespace

std::filesystem::path note_beside(const std::filesystem::path& table) {
  return table.string() + ".txt";
}

std::string table_note(const TableCaution& caution) {
  std::string text = kHead;
  if (!caution.disturbances.empty()) text += kDisturbances + caution.disturbances + "\n";
  if (!caution.unfit.empty()) text += kUnfit + caution.unfit + "\n";
  return text;
}

bool has_table_note(const std::filesystem::path& table) {
  const std::filesystem::path note = note_beside(table);
  return std::filesystem::is_regular_file(note) && read_file(note).starts_with(kHead);
}

TableCaution read_table_note(const std::filesystem::path& table) {
  TableCaution caution;
  if (!has_table_note(table)) return caution;
  std::istringstream lines(read_file(note_beside(table)));
  const auto value = [](const std::string& line, const std::string& key) {
    return line.starts_with(key) ? line.substr(key.size()) : std::string();
  };
  for (std::string line; std::getline(lines, line);)
    add_caution(caution, {value(line, kDisturbances), value(line, kUnfit)});
  return caution;
}

}  // namespace ayumi
