#include "ayumi/io/formats/log_csv.hpp"

#include "ayumi/base/text.hpp"

namespace ayumi {

std::string log_csv(const LogTable& table) {
  std::string text = text::join(table.column_names(), ",") + "\n";
  for (size_t row = 0; row < table.rows; ++row) {
    for (size_t column = 0; column < table.columns; ++column) {
      if (column > 0) text += ',';
      text += text::exact(table.at(row, column));
    }
    text += '\n';
  }
  return text;
}

}  // namespace ayumi
