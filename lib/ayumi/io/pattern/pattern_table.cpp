#include "ayumi/io/pattern/pattern_table.hpp"

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/table/table.hpp"
#include "ayumi/model/encoder_angles.hpp"

namespace ayumi {

namespace fs = std::filesystem;

fs::path table_beside(const fs::path& path) { return fs::path(path).replace_extension(".csv"); }

fs::path sequence_beside(const fs::path& path) {
  return fs::path(path).replace_extension(".sequence.csv");
}

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
                             const std::vector<std::string>& comments, const TableCaution& caution,
                             const std::string& sequence, const std::string& text) {
  const auto write_text = [&](const Pattern& named) {
    if (text.empty())
      write_pattern(path, named, comments);
    else
      write_file(path, text);
  };
  if (!pattern.table) {
    write_text(pattern);
    return;
  }
  const fs::path table = table_beside(path);
  if (table == path)
    fail(ErrorCode::bad_file, {path.string()},
         "the command writes two files, the pattern and its table, and the table gets this name. "
         "Give the pattern a name with another ending, such as .json");
  Pattern named = pattern;
  // The path is relative to the pattern's old folder here. write_pattern() makes it relative to the
  // new one.
  const fs::path from = fs::absolute(pattern.file.empty() ? path : fs::path(pattern.file));
  named.table->file = fs::relative(fs::absolute(table), from.parent_path()).string();
  std::optional<KeptSequence>& kept = named.table->sequence;
  std::vector<fs::path> written;
  try {
    if (!sequence.empty()) {
      const fs::path copy = sequence_beside(path);
      kept = {copy.filename().string(), sha256(sequence), theta_sha256(*named.table)};
      write_file(copy, sequence);
      written.push_back(copy);
    } else if (kept && kept->theta_sha256 != theta_sha256(*named.table)) {
      kept.reset();
    } else if (kept) {
      const fs::path folder = fs::absolute(table).parent_path();
      kept->file = fs::relative(fs::absolute(kept->file), folder).string();
    }
    write_file(table, dense_table_csv(*named.table, caution));
    written.push_back(table);
    write_text(named);
  } catch (...) {
    std::error_code ignored;
    for (const fs::path& file : written) fs::remove(file, ignored);
    throw;
  }
}

std::string kept_sequence(const DenseTable& table) {
  std::string bytes = read_file(table.sequence->file);
  if (sha256(bytes) != table.sequence->sha256)
    fail(ErrorCode::bad_file, table.sequence->file +
                                  ": this file has changed since the import; import the changed "
                                  "sequence again");
  return bytes;
}

std::string encoders_of(const RobotModel& model) {
  const Eigen::VectorXd zeros = encoder_zeros(model);
  std::string text;
  for (int j = 0; j < model.dof_count(); ++j) {
    const Dof& dof = model.dofs()[static_cast<size_t>(j)];
    text += dof.name + " " + std::to_string(dof.encoder.device) + " " +
            text::exact(dof.encoder.counts_per_degree) + " " + text::exact(zeros[j]) + "\n";
  }
  return sha256(text);
}

bool read_with_encoders_of(const RobotModel& model, const DenseTable& table) {
  return table.encoders.empty() ? encoder_zeros(model).isZero(0)
                                : table.encoders == encoders_of(model);
}

TableCaution caution_of(const Pattern& pattern) {
  if (!pattern.table) return {};
  return read_table_caution(fs::path(pattern.file).parent_path() / pattern.table->file);
}

}  // namespace ayumi
