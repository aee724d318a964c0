#pragma once
// Tables as other programs write them, made plain: commas between cells, points in numbers, no
// marks before the first column.

#include <string>

namespace ayumi {

/// UTF-8 with or without its mark; cells between commas, semicolons or tabs, in quotes or not;
/// decimal commas where semicolons or tabs stand between the cells. JSON stays as it is, and lines
/// keep their numbers. Throws Error(bad_file) for UTF-16 and for cells that only blanks part.
std::string plain_table_text(const std::string& bytes, const std::string& file);

}  // namespace ayumi
