#pragma once
// Pieces of HTML as text.

#include <string>
#include <vector>

#include "ayumi/plot/drawing.hpp"

namespace ayumi::html {

using ayumi::escaped;

/// Base64 without line breaks.
std::string base64(const std::string& bytes);

/// A text in JSON quotes that is safe inside a <script> element.
std::string quoted(const std::string& text);

struct Table {
  std::string caption;
  std::vector<std::string> head;               ///< heads of the columns as text
  std::vector<std::vector<std::string>> rows;  ///< cells as HTML; numbers are aligned to the right
};
/// A table of HTML. The first cell of each row is its heading.
std::string table(const Table& table);

/// A time [s] with three digits. A click on it moves the replay to this time.
std::string time_link(double t);

/// A section of the page: <section id=...><h2>title</h2>contents</section>.
std::string section(const std::string& id, const std::string& title, const std::string& contents);

}  // namespace ayumi::html
