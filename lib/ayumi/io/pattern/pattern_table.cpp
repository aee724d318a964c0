#include "ayumi/io/pattern/pattern_table.hpp"

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/table/table.hpp"

namespace ayumi {

namespace fs = std::filesystem;

fs::path table_beside(const fs::path& path) { return fs::path(path).replace_extension(".csv"); }

std::vector<fs::path> pattern_files(const fs::path& path) {
  std::vector<fs::path> files = {path};
  const Json document = parse_json(read_file(path), path.string(), ErrorCode::bad_pattern);
  if (!document.is_object()) return files;
  for (const char* const key : {"include", "table"}) {
    const auto found = document.find(key);
    if (found == document.end()) continue;
    for (const Json& name : found->is_array() ? *found : Json::array({*found}))
      if (name.is_string()) files.push_back(path.parent_path() / name.get<std::string>());
  }
  return files;
}

void write_pattern_and_table(const fs::path& path, const Pattern& pattern,
                             const std::vector<std::string>& comments,
                             const TableCaution& caution) {
  if (!pattern.table) {
    write_pattern(path, pattern, comments);
    return;
  }
  const fs::path table = table_beside(path);
  if (table == path)
    fail(ErrorCode::bad_file,
         path.string() +
             ": the table of the pattern is written to a .csv of the same name; give "
             "the pattern another ending, such as .json");
  Pattern named = pattern;
  // Written as it holds from the pattern's old folder, which write_pattern turns into the new one.
  const fs::path from = fs::absolute(pattern.file.empty() ? path : fs::path(pattern.file));
  named.table->file = fs::absolute(table).lexically_relative(from.parent_path()).string();
  write_file(table, dense_table_csv(*pattern.table, caution));
  try {
    write_pattern(path, named, comments);
  } catch (...) {
    std::error_code ignored;
    fs::remove(table, ignored);
    throw;
  }
}

TableCaution caution_of(const Pattern& pattern) {
  if (!pattern.table) return {};
  return read_table_caution(fs::path(pattern.file).parent_path() / pattern.table->file);
}

}  // namespace ayumi
