#pragma once
// A pattern whose motion is a table beside it.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/motion/pattern.hpp"
#include "ayumi/motion/table_caution.hpp"

namespace ayumi {

/// The place of the table of a pattern that is written to `path`: the same name, ending in .csv.
std::filesystem::path table_beside(const std::filesystem::path& path);

/// The place of the sequence from which this table was imported: the same name, ending in
/// .sequence.csv.
std::filesystem::path sequence_beside(const std::filesystem::path& path);

/// The pattern file, its posture libraries and its table, as far as it names them. Throws as
/// read_pattern when it is missing or no JSON.
std::vector<std::filesystem::path> pattern_files(const std::filesystem::path& path);

/// Writes as write_pattern() does. The data of a table go to table_beside(path), and the pattern
/// names that file. The bytes of the `sequence` that the table was imported from go to
/// sequence_beside(path), and the head of the table names it; a table that names one already keeps
/// the name as long as its angles are those of the import. Either all files are there afterwards or
/// none. The head of the table says what there is to say of the run that it is from.
void write_pattern_and_table(const std::filesystem::path& path, const Pattern& pattern,
                             const std::vector<std::string>& comments = {},
                             const TableCaution& caution = {}, const std::string& sequence = {});

/// The bytes of the sequence that the pattern's table was imported from. Throws Error(bad_file)
/// where the file is missing or is not the one that was imported.
std::string kept_sequence(const DenseTable& table);

/// What the head of the pattern's table says of the run that it is from; nothing for a pattern
/// without a table.
TableCaution caution_of(const Pattern& pattern);

}  // namespace ayumi
