#pragma once
// Changes tables that other programs wrote into a plain form: commas between cells, points in
// numbers, and no mark before the first column.

#include <string>
#include <vector>

namespace ayumi {

/// The text may be UTF-8 with or without a byte order mark. Its cells are separated by commas,
/// semicolons or tabs, and may be in quotes. If semicolons or tabs separate them, numbers may have
/// decimal commas. A separator at the end of every row is left out, and so is a first column
/// without a name that counts the rows from 0 or 1, as pandas writes it; `notes` then gets a line
/// about it. JSON stays as it is, and lines keep their numbers. Throws Error(bad_file) for UTF-16,
/// for cells that are only separated by blanks, and for another first column without a name.
std::string plain_table_text(const std::string& bytes, const std::string& file,
                             std::vector<std::string>* notes = nullptr);

}  // namespace ayumi
