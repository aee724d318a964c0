#pragma once
// Tables as other programs write them, made plain: commas between cells, points in numbers, no
// marks before the first column.

#include <string>

namespace ayumi {

/// The text may be UTF-8 with or without its mark. Its cells are between commas, semicolons or
/// tabs, in quotes or not, and may have decimal commas where semicolons or tabs separate them. JSON
/// stays as it is, and lines keep their numbers. Throws Error(bad_file) for UTF-16 and for cells
/// that only blanks part.
std::string plain_table_text(const std::string& bytes, const std::string& file);

}  // namespace ayumi
