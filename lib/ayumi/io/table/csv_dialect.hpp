#pragma once
// Changes tables that other programs wrote into a plain form: commas between cells, points in
// numbers, and no mark before the first column.

#include <string>

namespace ayumi {

/// The text may be UTF-8 with or without a byte order mark. Its cells are separated by commas,
/// semicolons or tabs, and may be in quotes. If semicolons or tabs separate them, numbers may have
/// decimal commas. A first column without a name, as pandas writes it, and a separator at the end
/// of every row are left out. JSON stays as it is, and lines keep their numbers. Throws
/// Error(bad_file) for UTF-16 and for cells that are only separated by blanks.
std::string plain_table_text(const std::string& bytes, const std::string& file);

}  // namespace ayumi
