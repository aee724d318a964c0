#pragma once
// A pattern whose motion is a table beside it.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"
#include "ayumi/motion/table_caution.hpp"

namespace ayumi {

/// The place of the table of a pattern that is written to `path`: the same name, ending in .csv.
std::filesystem::path table_beside(const std::filesystem::path& path);

/// The place of the sequence from which this table was imported: the same name, ending in
/// .sequence.csv.
std::filesystem::path sequence_beside(const std::filesystem::path& path);

/// The pattern file, its posture libraries and its table, as far as the pattern names them. Throws
/// the same errors as read_pattern if the file is missing or is not JSON.
std::vector<std::filesystem::path> pattern_files(const std::filesystem::path& path);

/// Writes as write_pattern() does. The data of a table are written to table_beside(path), and the
/// pattern names that file. The bytes of the `sequence` from which the table was imported are
/// written to sequence_beside(path), and the head of the table names that file. A table that
/// already names a sequence keeps this name as long as its angles are those of the import.
/// Afterwards, either all files are there or none. The head of the table has the caution of the run
/// from which the table comes. If `text` is not empty, it is the text of the pattern.
void write_pattern_and_table(const std::filesystem::path& path, const Pattern& pattern,
                             const std::vector<std::string>& comments = {},
                             const TableCaution& caution = {}, const std::string& sequence = {},
                             const std::string& text = {});

/// The bytes of the sequence from which the pattern's table was imported. Throws Error(bad_file) if
/// the file is missing or is not the imported one.
std::string kept_sequence(const DenseTable& table);

/// Checksum of what determines the angles that this unit's encoders report: device, counts and zero
/// of each.
std::string encoders_of(const RobotModel& model);

/// Whether the sequence of the table was read with the encoders of this robot unit. Then the robot
/// makes the motion of the table when it receives the bytes of the sequence. Tables of versions
/// that did not know the zeros of encoders were read with zeros of 0.
bool read_with_encoders_of(const RobotModel& model, const DenseTable& table);

/// The caution in the head of the pattern's table about the run from which the table comes; nothing
/// for a pattern without a table.
TableCaution caution_of(const Pattern& pattern);

}  // namespace ayumi
