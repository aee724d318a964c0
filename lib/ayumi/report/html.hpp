#pragma once
// Pieces of HTML as text.

#include <string>
#include <vector>

#include "ayumi/plot/drawing.hpp"

namespace ayumi::html {

using ayumi::escaped;

/// Base64 without line breaks.
std::string base64(const std::string& bytes);

/// Text in JSON quotes, safe inside a <script> element.
std::string quoted(const std::string& text);

struct Table {
  std::string caption;
  std::vector<std::string> head;               ///< text
  std::vector<std::vector<std::string>> rows;  ///< HTML; numbers are aligned to the right
};
/// The first cell of a row is its heading.
std::string table(const Table& table);

/// A time [s] with three digits. A click on it moves the replay to this time.
std::string time_link(double t);

/// <section id=...><h2>title</h2>contents</section>
std::string section(const std::string& id, const std::string& title, const std::string& contents);

}  // namespace ayumi::html
