#pragma once
// The note beside a joint table. Formats that the programs of robots read, such as HOAP sequences,
// have no head that these programs would skip, so the cautions about the table are written into a
// text file beside it.

#include <filesystem>
#include <string>

#include "ayumi/motion/table_caution.hpp"

namespace ayumi {

/// The note of this table: "walk.csv.txt" for "walk.csv".
std::filesystem::path note_beside(const std::filesystem::path& table);

/// The text of a note about these cautions.
std::string table_note(const TableCaution& caution);

/// Whether there is a note beside the table, and not another text.
bool has_table_note(const std::filesystem::path& table);

/// The cautions in the note beside the table; none if there is no note.
TableCaution read_table_note(const std::filesystem::path& table);

}  // namespace ayumi
