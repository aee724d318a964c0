#pragma once
// A pattern whose motion is a table beside it.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/motion/pattern.hpp"
#include "ayumi/motion/table_caution.hpp"

namespace ayumi {

/// Where the table of a pattern written to `path` goes: the same name, ending in .csv.
std::filesystem::path table_beside(const std::filesystem::path& path);

/// The pattern file, its posture libraries and its table, as far as it names them. Throws as
/// read_pattern when it is missing or no JSON.
std::vector<std::filesystem::path> pattern_files(const std::filesystem::path& path);

/// As write_pattern; a table's data go to table_beside(path), and the pattern names it. Either both
/// files are there afterwards or none. The head of the table says what there is to say of the run
/// that it is from.
void write_pattern_and_table(const std::filesystem::path& path, const Pattern& pattern,
                             const std::vector<std::string>& comments = {},
                             const TableCaution& caution = {});

/// What the head of the pattern's table says of the run that it is from; nothing for a pattern
/// without a table.
TableCaution caution_of(const Pattern& pattern);

}  // namespace ayumi
